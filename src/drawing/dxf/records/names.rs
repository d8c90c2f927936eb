//! Names of layers, blocks and kinds: the number each is known by, and how it is shown.

use std::collections::HashMap;

/// The number of a name, given in order of appearance; names differ by more than capitals.
pub(super) fn number_of(numbers: &mut HashMap<Vec<u8>, u32>, name: &[u8], add: impl FnOnce(String)) -> u32 {
    if let Some(&number) = numbers.get(name) {
        return number;
    }
    let key = name.to_ascii_uppercase();
    let next = numbers.len() as u32;
    if let Some(&number) = numbers.get(&key) {
        return number;
    }
    numbers.insert(key, next);
    add(shown(name));
    next
}

/// A name as text: UTF-8 as it is, `\U+XXXX` as its character, bytes of another code as `\xHH`.
fn shown(name: &[u8]) -> String {
    let Ok(text) = std::str::from_utf8(name) else {
        return name
            .iter()
            .map(|&b| if b.is_ascii() { (b as char).to_string() } else { format!("\\x{b:02X}") })
            .collect();
    };
    let mut shown = String::new();
    let mut parts = text.split("\\U+");
    shown.push_str(parts.next().unwrap_or_default());
    for part in parts {
        let character =
            part.get(..4).and_then(|hex| u32::from_str_radix(hex, 16).ok()).and_then(char::from_u32);
        match character {
            Some(character) => {
                shown.push(character);
                shown.push_str(&part[4..]);
            }
            None => {
                shown.push_str("\\U+");
                shown.push_str(part);
            }
        }
    }
    shown
}
