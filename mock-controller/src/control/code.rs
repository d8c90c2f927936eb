//! Character codes: from what is on the line, or on a tape, to the characters of a program.
//!
//! ```text
//!   ascii   bit 8 is not looked at, NUL is ignored
//!   iso     even parity in bit 8; what is no character of ISO 840 is a TH alarm; NUL and DEL are ignored
//!   eia     odd parity by the table; a blank inside a block is a TH alarm, outside it is leader; DEL is ignored
//!   a file  each byte a token of one or more characters, as the file says
//! ```
//!
//! With the TV check a block with an odd number of characters, its end of block included, is a TV alarm. Ignored ones
//! (NUL, DEL, CR) do not count.
//!
//! Source: domain/4, "Character codes". That the end of block counts for TV is Fanuc's usage ([recall]).

use std::collections::BTreeMap;
use std::fmt;

/// A character code.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Code {
    /// Seven bits; the eighth may be anything.
    #[default]
    Ascii,
    /// ISO 840 (RS-358): ASCII with even parity in bit 8.
    Iso,
    /// EIA RS-244.
    Eia,
    /// A table of one's own, for controls with other codes, and for five channels.
    Table(CodeTable),
}

/// From a byte to what it stands for; nothing: it is ignored.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CodeTable {
    tokens: BTreeMap<u8, String>,
}

/// A line that is no entry of a table.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct NotACode(String);

impl fmt::Display for NotACode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for NotACode {}

impl CodeTable {
    /// Reads a table: a token, a blank and its byte in two hex digits a line; `EOB`, `SP`, `TAB`, `NUL` (ignored) by name;
    /// `#` alone or followed by a blank begins a comment line.
    ///
    /// # Errors
    ///
    /// [`NotACode`] with the line.
    pub fn parse(text: &str) -> Result<CodeTable, NotACode> {
        let mut table = CodeTable::default();
        for (index, line) in text.lines().enumerate() {
            let wrong = |found: &str| NotACode(format!("line {}: {found}", index + 1));
            let mut words = line.split_whitespace();
            let (token, byte) = match (words.next(), words.next(), words.next()) {
                (None, ..) => continue,
                (Some("#"), byte, _) if byte.is_none_or(|byte| byte.len() != 2) => continue,
                (Some(token), Some(byte), None) => (token, byte),
                _ if line.trim_start().starts_with("# ") => continue,
                _ => return Err(wrong("expected a token and its byte in hex")),
            };
            let byte = Some(byte)
                .filter(|byte| byte.len() == 2)
                .and_then(|byte| u8::from_str_radix(byte, 16).ok())
                .ok_or_else(|| wrong(&format!("{byte:?} is no byte in two hex digits")))?;
            let token = match token {
                "EOB" => "\n",
                "SP" => " ",
                "TAB" => "\t",
                "NUL" => "",
                token => token,
            };
            if table.tokens.insert(byte, token.to_owned()).is_some() {
                return Err(wrong(&format!("{byte:02X} stands for two tokens")));
            }
        }
        if !table.tokens.values().any(|token| token == "\n") {
            return Err(NotACode("no code for EOB".to_owned()));
        }
        Ok(table)
    }
}

impl Code {
    /// The byte that ends a block.
    #[must_use]
    pub fn end_of_block(&self) -> u8 {
        match self {
            Code::Ascii | Code::Iso => b'\n',
            Code::Eia => EIA_END_OF_BLOCK,
            Code::Table(table) => {
                table.tokens.iter().find(|(_, token)| *token == "\n").map_or(b'\n', |(&byte, _)| byte)
            }
        }
    }
}

/// Decodes one byte after the other.
#[derive(Clone, Debug)]
pub(super) struct Decoder {
    code: Code,
    checks_tv: bool,
    /// Characters of the block so far.
    count: u64,
}

/// Why a byte stands for nothing.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(super) struct NoCharacter {
    /// `th` or `tv`.
    pub(super) alarm: &'static str,
    pub(super) found: String,
}

impl Decoder {
    pub(super) fn new(code: Code, checks_tv: bool) -> Decoder {
        Decoder { code, checks_tv, count: 0 }
    }

    /// The block so far is forgotten.
    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// What a byte stands for: mostly one character, or none.
    pub(super) fn take(&mut self, byte: u8) -> Result<String, NoCharacter> {
        let th = |found: &str| NoCharacter { alarm: "th", found: format!("{byte:02X}: {found}") };
        let token = match &self.code {
            Code::Ascii => match byte & 0x7F {
                0 => return Ok(String::new()),
                c => char::from(c).to_string(),
            },
            Code::Iso => match byte & 0x7F {
                0 | 0x7F => return Ok(String::new()),
                _ if byte.count_ones() % 2 == 1 => return Err(th("odd parity")),
                c if !is_iso(c) => return Err(th("no character of ISO 840")),
                c => char::from(c).to_string(),
            },
            Code::Eia => match byte {
                0x00 if self.count == 0 => return Ok(String::new()),
                0x00 => return Err(th("a blank inside a block")),
                // BS moves nothing on a control (a reading).
                0x7F | 0x2A => return Ok(String::new()),
                _ if byte.count_ones().is_multiple_of(2) => return Err(th("even parity")),
                EIA_END_OF_BLOCK => "\n".to_owned(),
                _ => match EIA.iter().find(|&&(code, _)| code == byte) {
                    Some((_, c)) => c.to_string(),
                    None => return Err(th("no character of EIA RS-244")),
                },
            },
            Code::Table(table) => match table.tokens.get(&byte) {
                Some(token) => token.clone(),
                None => return Err(th("not in the table")),
            },
        };
        if token.is_empty() || token == "\r" {
            return Ok(token);
        }
        self.count += 1;
        if token == "\n" {
            let count = std::mem::take(&mut self.count);
            if self.checks_tv && count % 2 == 1 {
                return Err(NoCharacter { alarm: "tv", found: format!("{count} characters in a block") });
            }
        }
        Ok(token)
    }
}

/// What ISO 840 has no character for: small letters, and most punctuation.
fn is_iso(c: u8) -> bool {
    !c.is_ascii_lowercase() && !b"!@$^&_{}|\\;\"<>?'`~".contains(&c)
}

const EIA_END_OF_BLOCK: u8 = 0x80;

/// EIA RS-244 as domain/4 lists it, but for end of block, NUL, BS and DEL.
const EIA: [(u8, char); 48] = [
    (0x20, '0'),
    (0x01, '1'),
    (0x02, '2'),
    (0x13, '3'),
    (0x04, '4'),
    (0x15, '5'),
    (0x16, '6'),
    (0x07, '7'),
    (0x08, '8'),
    (0x19, '9'),
    (0x10, ' '),
    (0x6B, '.'),
    (0x40, '-'),
    (0x70, '+'),
    (0x31, '/'),
    (0x3B, ','),
    (0x0E, '&'),
    (0x61, 'A'),
    (0x62, 'B'),
    (0x73, 'C'),
    (0x64, 'D'),
    (0x75, 'E'),
    (0x76, 'F'),
    (0x67, 'G'),
    (0x68, 'H'),
    (0x79, 'I'),
    (0x1A, '('),
    (0x4A, ')'),
    (0x3E, '\t'),
    (0x0B, '%'),
    (0x51, 'J'),
    (0x52, 'K'),
    (0x43, 'L'),
    (0x54, 'M'),
    (0x45, 'N'),
    (0x46, 'O'),
    (0x57, 'P'),
    (0x58, 'Q'),
    (0x49, 'R'),
    (0x32, 'S'),
    (0x23, 'T'),
    (0x34, 'U'),
    (0x25, 'V'),
    (0x26, 'W'),
    (0x37, 'X'),
    (0x38, 'Y'),
    (0x29, 'Z'),
    // One source says 5B for `%` (ER).
    (0x5B, '%'),
];
