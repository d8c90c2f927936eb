//! Arbitrary bytes, and texts that look like 4B, into the 4B reader, and what comes of them set off, reversed and written.

use dripfeed::formats::Writer as _;
use dripfeed::formats::four_b::offset::{Keyed, beside};
use dripfeed::formats::four_b::write::{Form, Writer};
use dripfeed::formats::four_b::{Entry, Reader};
use dripfeed::formats::three_b::motions::Motions;
use dripfeed::formats::three_b::write::{Numbers, Remarks};
use dripfeed::interpolator::Model;
use dripfeed::motion::reverse::reversed;
use dripfeed::motion::runs::ContourError;
use dripfeed::motion::{Act, Motion};
use dripfeed::rounding::Aim;

use crate::three_b::{account, text_of};

fn read(bytes: &[u8]) {
    let mut reader = Reader::new(bytes);
    let entries = account(bytes, || {
        Ok(reader.next_entry()?.map(|entry| (entry, reader.spot().byte, reader.end_byte())))
    });
    let blocks = entries.iter().filter(|entry| matches!(entry, Entry::Block(_))).count();
    let motions: Vec<Motion> =
        Motions::of_four_b(bytes, Model::Strict).take(3_000).map_while(Result::ok).collect();
    assert!(motions.iter().map(|motion| motion.block).max().unwrap_or(0) <= blocks as u64);
    let said = || motions.iter().cloned().map(Ok::<_, ContourError>);
    for keyed in [Keyed { offset: 0.1, taper: None }, Keyed { offset: -3.0, taper: Some(2.0) }] {
        for motion in beside(said(), keyed).map_while(Result::ok) {
            assert!(!matches!(motion.act, Act::Move { flag: Some(_), .. }));
        }
    }
    assert!(reversed(said()).map_while(Result::ok).count() <= 2 * motions.len());
    for corners in [None, Some(0.02)] {
        write(&motions, corners);
    }
}

/// What can be written can be read.
fn write(motions: &[Motion], corners: Option<f64>) {
    let mut form = Form { corners, ..Form::default() };
    form.plain.aim = Aim::One(Model::Exact);
    form.plain.remarks = Remarks::Semicolons;
    form.plain.numbers = Numbers::AsRead;
    let (mut writer, mut text) = (Writer::new(form), Vec::new());
    let done = motions.iter().try_for_each(|motion| writer.write(motion, &mut text));
    if done.is_ok() {
        let _ = writer.finish(&mut text);
    }
    let mut reader = Reader::new(&text[..]);
    let mut blocks = 0;
    loop {
        match reader.next_entry() {
            Ok(Some(Entry::Block(_))) => blocks += 1,
            Ok(Some(_)) => {}
            Ok(None) => break,
            Err(wrong) => panic!("{wrong}: {}", String::from_utf8_lossy(&text)),
        }
    }
    assert_eq!(blocks, writer.blocks());
}

#[test]
fn arbitrary_bytes_are_read_or_refused_and_none_is_lost() {
    bolero::check!().for_each(|bytes: &[u8]| read(bytes));
}

#[test]
fn pieces_of_programs_in_any_order_are_read_or_refused_and_none_is_lost() {
    bolero::check!().for_each(|choice: &[u8]| read(&text_of(choice)));
}
