//! Arbitrary bytes, and texts that look like 4B, into the 4B reader.

use dripfeed::formats::four_b::{Entry, Reader};
use dripfeed::formats::three_b::motions::Motions;
use dripfeed::interpolator::Model;

use crate::three_b::{account, text_of};

fn read(bytes: &[u8]) {
    let mut reader = Reader::new(bytes);
    let entries = account(bytes, || {
        Ok(reader.next_entry()?.map(|entry| (entry, reader.spot().byte, reader.end_byte())))
    });
    let blocks = entries.iter().filter(|entry| matches!(entry, Entry::Block(_))).count();
    let motions = Motions::of_four_b(bytes, Model::Strict).take(10_000).map_while(Result::ok);
    assert!(motions.map(|motion| motion.block).max().unwrap_or(0) <= blocks as u64);
}

#[test]
fn arbitrary_bytes_are_read_or_refused_and_none_is_lost() {
    bolero::check!().for_each(|bytes: &[u8]| read(bytes));
}

#[test]
fn pieces_of_programs_in_any_order_are_read_or_refused_and_none_is_lost() {
    bolero::check!().for_each(|choice: &[u8]| read(&text_of(choice)));
}
