//! Reading a dialect file.

use super::{ArcCentre, CODES, Code, Dialect, I, J, K, L, Label, R, Role, U, V, Written, X, Y};
use crate::formats::gcode::modal::Mode;
use crate::formats::gcode::numbers::Unit;
use crate::keys::{Document, KeyError, Section};
use crate::motion::Side;

impl Dialect {
    /// Reads a dialect file.
    ///
    /// # Errors
    ///
    /// When it is not TOML, a key is missing or unknown, or a value is none of those there are.
    pub fn parse(text: &str) -> Result<Self, KeyError> {
        let document = Document::parse(text)?;
        let [about, numbers, path, offset, program, words, written] =
            document.sections(["dialect", "numbers", "path", "offset", "program", "words", "written"])?;
        let mut dialect = Self {
            name: needed(&about, "name", about.text("name")?)?.to_owned(),
            unit_at_start: word(&numbers, "unit_at_start", &UNITS)?,
            incremental_at_start: word(&numbers, "distance_at_start", &DISTANCES)?,
            without_point: [
                word(&numbers, "without_point", &MM_RULES)?,
                word(&numbers, "without_point_inch", &INCH_RULES)?,
            ],
            angle_without_point: word(&numbers, "angle_without_point", &ANGLE_RULES)?,
            dwell_without_point: word(&numbers, "dwell_without_point", &DWELL_RULES)?,
            least_increment: [
                word(&numbers, "least_increment", &LEAST)?,
                word(&numbers, "least_increment_inch", &LEAST_INCH)?,
            ],
            arc_centre: word(&path, "arc_centre", &CENTRES)?,
            radius: switch(&path, "radius")?,
            upper: switch(&path, "u_v")?,
            upper_centre: switch(&path, "k_l")?,
            pairs: switch(&path, "pairs")?,
            heights: switch(&path, "g92_heights")?,
            lone_j: switch(&path, "lone_j")?,
            register: letter(&offset, "register")?,
            register_digits: needed(&offset, "register_digits", offset.whole("register_digits", 1..=6)?)?
                as usize,
            offset_value: letter(&offset, "value")?,
            assignments: switch(&offset, "assignments")?,
            taper_angle: letter(&offset, "taper_angle")?,
            subprograms: word(&program, "subprograms", &[("O", Label::O), ("N", Label::N)])?,
            packed_repeats: switch(&program, "packed_repeats")?,
            return_ends: switch(&program, "m99_ends")?,
            semicolon: switch(&program, "semicolon")?,
            brackets: switch(&program, "brackets")?,
            keeps_wrong_arcs: false,
            written: Written {
                micrometres: word(&written, "numbers", &[("point", false), ("um", true)])?,
                padded: needed(&written, "padded", written.whole("padded", 0..=9)?)? as usize,
                incremental: word(&written, "distance", &DISTANCES)?,
                blanks: switch(&written, "blanks")?,
                semicolon: switch(&written, "semicolon")?,
                unit_word: match needed(&written, "unit_word", written.whole("unit_word", 0..=99)?)? {
                    0 => None,
                    code => Some(code as u16),
                },
                carriage_return: switch(&written, "carriage_return")?,
            },
            program_letters: [false; 26],
            g_codes: shared_g_codes(),
            m_codes: shared_m_codes(),
            letters: [Role::Unknown; 26],
            long_words: Vec::new(),
            refused_words: Vec::new(),
            command_words: Vec::new(),
            arguments: Vec::new(),
        };
        for (letter, place) in [(b'X', X), (b'Y', Y), (b'I', I), (b'J', J)] {
            dialect.letters[usize::from(letter - b'A')] = Role::Length(place as u8);
        }
        let also = [(dialect.upper, b'U', U), (dialect.upper, b'V', V), (dialect.radius, b'R', R)];
        let more = [(dialect.upper_centre, b'K', K), (dialect.upper_centre, b'L', L)];
        for (is_there, letter, place) in also.into_iter().chain(more) {
            if is_there {
                dialect.letters[usize::from(letter - b'A')] = Role::Length(place as u8);
            }
        }
        dialect.letters[usize::from(b'N' - b'A')] = Role::Number;
        dialect.letters[usize::from(b'F' - b'A')] = Role::Feed;
        for (letter, role) in [
            (dialect.register, Role::Register),
            (dialect.offset_value, Role::OffsetValue),
            (dialect.taper_angle, Role::Angle),
        ] {
            if let Some(letter) = letter {
                dialect.letters[usize::from(letter - b'A')] = role;
            }
        }
        dialect.taper_words(&offset)?;
        dialect.lists(&numbers, &program, &words)?;
        for section in [&about, &numbers, &path, &offset, &program, &words, &written] {
            section.finish()?;
        }
        Ok(dialect)
    }

    fn taper_words(&mut self, offset: &Section<'_>) -> Result<(), KeyError> {
        if !switch(offset, "taper_words")? {
            return Ok(());
        }
        self.g_codes[50] = Code::Taper(None);
        self.g_codes[51] = Code::Taper(Some(Side::Left));
        self.g_codes[52] = Code::Taper(Some(Side::Right));
        Ok(())
    }

    /// The keys that are lists of words.
    fn lists(
        &mut self,
        numbers: &Section<'_>,
        program: &Section<'_>,
        words: &Section<'_>,
    ) -> Result<(), KeyError> {
        for (key, unit) in [("inch", Unit::Inch), ("mm", Unit::Millimetre)] {
            for (word, letter, code) in list(numbers, key)? {
                match (letter, code) {
                    (b'G', Some(code)) if self.g_codes[code] == Code::Unknown => {
                        self.g_codes[code] = Code::Unit(unit);
                    }
                    _ => return Err(numbers.error(key, format!("`{word}` is no G word that is free"), None)),
                }
            }
        }
        for (word, letter, code) in list(program, "names")? {
            match code {
                None if letter != 0 => self.program_letters[usize::from(letter - b'A')] = true,
                _ => return Err(program.error("names", format!("`{word}` is not a letter"), None)),
            }
        }
        for key in ["conditions", "wire", "flushing", "machine"] {
            for (word, letter, code) in list(words, key)? {
                self.meaning(words, key, word, letter, code, Code::Kept, Role::Kept)?;
            }
        }
        for (word, letter, code) in list(words, "refused")? {
            self.meaning(words, "refused", word, letter, code, Code::Refused, Role::Refused)?;
        }
        for (word, ..) in list(words, "commands")? {
            self.command_words.push(word.to_owned());
        }
        for (word, ..) in list(words, "arguments")? {
            let parts = word.split_once(':').and_then(|(owner, argument)| {
                let (letter, code) = parse_word(owner)?;
                match (parse_word(argument)?, code) {
                    ((argument, None), Some(code)) => Some((letter, code as u32, argument)),
                    _ => None,
                }
            });
            let wrong = || words.error("arguments", format!("`{word}` is not like `M15:P`"), None);
            self.arguments.push(parts.ok_or_else(wrong)?);
        }
        Ok(())
    }

    /// Gives a word a meaning that nothing else has.
    #[expect(clippy::too_many_arguments, reason = "a word, its place in the file, and its two meanings")]
    fn meaning(
        &mut self,
        section: &Section<'_>,
        key: &'static str,
        word: &str,
        letter: u8,
        code: Option<usize>,
        as_code: Code,
        as_letter: Role,
    ) -> Result<(), KeyError> {
        let taken = |is: String| Err(section.error(key, format!("`{word}` {is}"), None));
        match (letter, code) {
            (0, _) => {
                let list = if as_code == Code::Kept { &mut self.long_words } else { &mut self.refused_words };
                list.push(word.to_owned());
            }
            (b'G' | b'M', None) => return taken("needs a number".to_owned()),
            (b'G' | b'M', Some(code)) => {
                let codes = if letter == b'G' { &mut self.g_codes } else { &mut self.m_codes };
                if codes[code] != Code::Unknown {
                    return taken("has a meaning already".to_owned());
                }
                codes[code] = as_code;
            }
            (_, None) => {
                let role = &mut self.letters[usize::from(letter - b'A')];
                if *role != Role::Unknown {
                    return taken("has a meaning already".to_owned());
                }
                *role = as_letter;
            }
            (_, Some(_)) => return taken("is not a letter, or a G or M word".to_owned()),
        }
        Ok(())
    }
}

/// What G words mean everywhere.
fn shared_g_codes() -> [Code; CODES] {
    let mut codes = [Code::Unknown; CODES];
    codes[0] = Code::Travel(Mode::Rapid);
    codes[1] = Code::Travel(Mode::Line);
    codes[2] = Code::Travel(Mode::Clockwise);
    codes[3] = Code::Travel(Mode::CounterClockwise);
    codes[4] = Code::Dwell;
    codes[17] = Code::Plane;
    // The wire moves in no other plane.
    codes[18] = Code::Refused;
    codes[19] = Code::Refused;
    codes[40] = Code::Offset(None);
    codes[41] = Code::Offset(Some(Side::Left));
    codes[42] = Code::Offset(Some(Side::Right));
    for frame in 54..=59 {
        codes[usize::from(frame)] = Code::Frame(frame);
    }
    codes[65] = Code::Macro;
    codes[66] = Code::Macro;
    codes[67] = Code::Macro;
    codes[90] = Code::Incremental(false);
    codes[91] = Code::Incremental(true);
    codes[92] = Code::Position;
    codes
}

/// What M words mean everywhere.
fn shared_m_codes() -> [Code; CODES] {
    let mut codes = [Code::Unknown; CODES];
    codes[0] = Code::Pause;
    codes[1] = Code::OptionalStop;
    codes[2] = Code::End;
    codes[30] = Code::End;
    codes[98] = Code::Call;
    codes[99] = Code::Return;
    codes
}

const UNITS: [(&str, Unit); 2] = [("mm", Unit::Millimetre), ("inch", Unit::Inch)];
const DISTANCES: [(&str, bool); 2] = [("absolute", false), ("incremental", true)];
const MM_RULES: [(&str, Option<i64>); 5] = [
    ("error", None),
    ("mm", Some(1_000_000)),
    ("um", Some(1_000)),
    ("0.001mm", Some(1_000)),
    ("0.0001mm", Some(100)),
];
const INCH_RULES: [(&str, Option<i64>); 4] =
    [("error", None), ("inch", Some(25_400_000)), ("0.0001inch", Some(2_540)), ("0.00001inch", Some(254))];
const ANGLE_RULES: [(&str, Option<u16>); 3] = [("error", None), ("deg", Some(1000)), ("0.001deg", Some(1))];
const DWELL_RULES: [(&str, Option<u16>); 3] = [("error", None), ("s", Some(1000)), ("ms", Some(1))];
const LEAST: [(&str, i64); 2] = [("0.001mm", 1_000), ("0.0001mm", 100)];
const LEAST_INCH: [(&str, i64); 2] = [("0.0001inch", 2_540), ("0.00001inch", 254)];
const CENTRES: [(&str, ArcCentre); 3] = [
    ("from-start", ArcCentre::FromStart),
    ("absolute", ArcCentre::Absolute),
    ("to-start", ArcCentre::ToStart),
];

fn needed<T>(section: &Section<'_>, key: &'static str, value: Option<T>) -> Result<T, KeyError> {
    value.ok_or_else(|| {
        section.error(
            key,
            format!("`{key}` is missing"),
            Some("a dialect file says everything; see generic.toml"),
        )
    })
}

fn word<T: Copy>(
    section: &Section<'_>,
    key: &'static str,
    words: &[(&'static str, T)],
) -> Result<T, KeyError> {
    needed(section, key, section.word(key, words)?)
}

fn switch(section: &Section<'_>, key: &'static str) -> Result<bool, KeyError> {
    needed(section, key, section.switch(key)?)
}

/// A letter, or `none`.
fn letter(section: &Section<'_>, key: &'static str) -> Result<Option<u8>, KeyError> {
    let text = needed(section, key, section.text(key)?)?;
    match text.as_bytes() {
        b"none" => Ok(None),
        [letter @ b'A'..=b'Z'] if !b"GMNXYIJF".contains(letter) => Ok(Some(*letter)),
        _ => Err(section.error(key, format!("`{key}` must be a free capital letter or \"none\""), None)),
    }
}

/// A word with its letter and code; a letter 0 for a word of several letters.
type Listed<'a> = (&'a str, u8, Option<usize>);

/// The words of a text.
fn list<'a>(section: &Section<'a>, key: &'static str) -> Result<Vec<Listed<'a>>, KeyError> {
    let text = needed(section, key, section.text(key)?)?;
    Ok(text
        .split_ascii_whitespace()
        .map(|word| {
            let (letter, code) = parse_word(word).unwrap_or((0, None));
            (word, letter, code)
        })
        .collect())
}

/// A capital letter, with a number below 100 behind it or not.
fn parse_word(word: &str) -> Option<(u8, Option<usize>)> {
    let (letter, digits) = word.split_at_checked(1)?;
    let letter = letter.bytes().next().filter(u8::is_ascii_uppercase)?;
    if digits.is_empty() {
        return Some((letter, None));
    }
    let code = digits.parse().ok().filter(|code| *code < CODES)?;
    Some((letter, Some(code)))
}

#[cfg(test)]
mod tests {
    use super::super::BUILT_IN;
    use super::*;

    #[test]
    fn the_built_in_dialects_are_read_and_bear_their_names() {
        for (name, text) in BUILT_IN {
            let dialect = Dialect::parse(text).unwrap_or_else(|e| panic!("{name}: {e} {}", e.place));
            assert_eq!(dialect.name, name);
        }
        assert!(Dialect::named("heidenhain").is_none());
    }

    #[test]
    fn a_file_says_everything_and_nothing_twice() {
        let generic = BUILT_IN[0].1;
        let refused = |from: &str, to: &str| {
            assert!(generic.contains(from), "{from}");
            Dialect::parse(&generic.replacen(from, to, 1)).unwrap_err().message
        };
        assert_eq!(refused("radius = true", ""), "`radius` is missing");
        assert_eq!(
            refused("radius = true", "radius = true\nradios = true"),
            "unknown key `radios` in [path]"
        );
        assert!(refused("without_point = \"error\"", "without_point = \"inch\"").contains("is not one of"));
        assert_eq!(refused("wire = \"", "wire = \"G01 "), "`G01` has a meaning already");
        assert_eq!(refused("wire = \"", "wire = \"G "), "`G` needs a number");
        assert_eq!(
            refused("register = \"D\"", "register = \"X\""),
            "`register` must be a free capital letter or \"none\""
        );
        assert!(refused("arguments = \"", "arguments = \"M15 ").contains("is not like"));
    }
}
