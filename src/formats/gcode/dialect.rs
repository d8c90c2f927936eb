//! A dialect: what the words of one family of controls mean, as data.
//!
//! What is the same everywhere (G00-G03, G90-G92, M00-M02, M30, M98, M99) is written here; all else stands in a TOML
//! file a dialect, with the source of each value beside it or "unverified". A file says everything: no key is left to a
//! default. A control that differs gets a file of its own.

mod file;

use super::modal::Mode;
use super::numbers::Unit;
use super::words::Word;
use crate::keys::KeyError;
use crate::motion::Side;

/// What the words of a control mean.
#[derive(Clone, Debug)]
pub struct Dialect {
    /// Its name.
    pub name: String,
    /// The unit before the program names one.
    pub unit_at_start: Unit,
    /// Whether X and Y are increments before the program says so.
    pub incremental_at_start: bool,
    /// What a length without a point counts, nanometres, by unit: mm, inch; none: the dialect has no rule.
    pub without_point: [Option<i64>; 2],
    /// What an angle without a point counts, in thousandths of a degree; none: the dialect has no rule.
    pub angle_without_point: Option<u16>,
    /// What a dwell without a point counts, milliseconds; none: the dialect has no rule.
    pub dwell_without_point: Option<u16>,
    /// The least increment by unit, nanometres: mm, inch. A programmed arc may be off by so much.
    pub least_increment: [i64; 2],
    /// Where an arc's I and J count from.
    pub arc_centre: ArcCentre,
    /// Whether R in an arc block is the radius.
    pub radius: bool,
    /// Whether U and V tilt the wire, counted from X and Y.
    pub upper: bool,
    /// Whether K and L in an arc block are the centre of the upper arc, seen from that of the lower one.
    pub upper_centre: bool,
    /// Whether a `:` stands between the motions of the lower and the upper end.
    pub pairs: bool,
    /// Whether I and J in a G92 block are heights of planes.
    pub heights: bool,
    /// Whether a J by itself is a dimension of the machine.
    pub lone_j: bool,
    /// The letter that names an offset register; none: there are none.
    pub register: Option<u8>,
    /// Digits a register is written with.
    pub register_digits: usize,
    /// The letter whose number is the offset itself.
    pub offset_value: Option<u8>,
    /// Whether registers are set in the program: `H1 = …`.
    pub assignments: bool,
    /// The letter of the taper's angle.
    pub taper_angle: Option<u8>,
    /// How a subprogram is named in the program: by an O word or by an N word.
    pub subprograms: Label,
    /// Whether more than four digits of P in a call are repeats and number together.
    pub packed_repeats: bool,
    /// Whether an M99 outside of a subprogram ends the program.
    pub return_ends: bool,
    /// Whether a line may be a remark behind `;`.
    pub semicolon: bool,
    /// Whether remarks may stand in brackets.
    pub brackets: bool,
    /// Whether an arc whose radii disagree is read as it is, for someone else to judge; no dialect's, but its reader's.
    pub keeps_wrong_arcs: bool,
    /// How programs are written.
    pub written: Written,
    program_letters: [bool; 26],
    g_codes: [Code; CODES],
    m_codes: [Code; CODES],
    letters: [Role; 26],
    /// Words of several letters that are kept.
    long_words: Vec<String>,
    refused_words: Vec<String>,
    command_words: Vec<String>,
    /// A word and the letter that is its argument.
    arguments: Vec<(u8, u32, u8)>,
}

/// How programs of the dialect are written.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Written {
    /// Whether numbers are whole micrometres without a point.
    pub micrometres: bool,
    /// Digits a whole number is padded to, with its sign always written; 0 pads nothing.
    pub padded: usize,
    /// Whether X and Y are increments.
    pub incremental: bool,
    /// Blanks between words.
    pub blanks: bool,
    /// `;` at the end of a block.
    pub semicolon: bool,
    /// Whether the program says its unit, by a word such as G21.
    pub unit_word: Option<u16>,
    /// Whether lines end with CR LF.
    pub carriage_return: bool,
}

/// Where I and J of an arc count from.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum ArcCentre {
    /// The centre seen from the start of the arc.
    FromStart,
    /// The centre, as X and Y are the end.
    Absolute,
    /// The start of the arc seen from the centre.
    ToStart,
}

impl ArcCentre {
    /// Its name in dialect files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::FromStart => "from-start",
            Self::Absolute => "absolute",
            Self::ToStart => "to-start",
        }
    }
}

/// How a subprogram is named.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Label {
    /// `O2100`.
    O,
    /// `N0010`, the first block behind the end of a program.
    N,
}

/// What a G or M word does.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Code {
    /// G00-G03.
    Travel(Mode),
    /// G90, G91.
    Incremental(bool),
    /// G20, G21, in some dialects G70, G71.
    Unit(Unit),
    /// G40-G42.
    Offset(Option<Side>),
    /// G50-G52.
    Taper(Option<Side>),
    /// G54-G59.
    Frame(u8),
    /// G17.
    Plane,
    /// G04.
    Dwell,
    /// G92.
    Position,
    /// M00.
    Pause,
    /// M01.
    OptionalStop,
    /// M02, M30.
    End,
    /// M98.
    Call,
    /// M99.
    Return,
    /// A word of the machine: kept.
    Kept,
    /// Changes the path in a way that is not read.
    Refused,
    /// G65-G67.
    Macro,
    /// Not in the table.
    Unknown,
}

/// What a letter other than G and M is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Role {
    /// X, Y, I, J, U, V, and R, K, L where the dialect has them: lengths, by their place in a block's list.
    Length(u8),
    /// N.
    Number,
    /// A word of the machine: kept.
    Kept,
    /// F: kept, in millimetres.
    Feed,
    /// Names an offset register.
    Register,
    /// Is the offset.
    OffsetValue,
    /// The angle of the taper.
    Angle,
    /// Changes the path in a way that is not read.
    Refused,
    /// Not in the table.
    Unknown,
}

const CODES: usize = 100;

/// The built-in dialects by name, with their text.
pub const BUILT_IN: [(&str, &str); 7] = [
    ("generic", include_str!("dialects/generic.toml")),
    ("fanuc", include_str!("dialects/fanuc.toml")),
    ("charmilles", include_str!("dialects/charmilles.toml")),
    ("sodick", include_str!("dialects/sodick.toml")),
    ("mitsubishi", include_str!("dialects/mitsubishi.toml")),
    ("agie", include_str!("dialects/agie.toml")),
    ("integer-um", include_str!("dialects/integer-um.toml")),
];

impl Dialect {
    /// The dialect every control is assumed to share.
    ///
    /// # Errors
    ///
    /// Never in a tested build: the text is part of the program.
    pub fn generic() -> Result<Self, KeyError> {
        Self::parse(BUILT_IN[0].1)
    }

    /// A built-in dialect by name; none when there is no such.
    #[must_use]
    pub fn named(name: &str) -> Option<Result<Self, KeyError>> {
        BUILT_IN.iter().find(|(known, _)| *known == name).map(|(_, text)| Self::parse(text))
    }

    /// What a G word does.
    #[inline]
    #[must_use]
    pub fn g_code(&self, word: &Word) -> Code {
        self.g_codes.get(word.code()).copied().unwrap_or(Code::Unknown)
    }

    /// What an M word does.
    #[must_use]
    pub fn m_code(&self, word: &Word) -> Code {
        self.m_codes.get(word.code()).copied().unwrap_or(Code::Unknown)
    }

    /// What a letter other than G and M is.
    #[must_use]
    pub fn role(&self, letter: u8) -> Role {
        self.letters.get(usize::from(letter.wrapping_sub(b'A'))).copied().unwrap_or(Role::Unknown)
    }

    /// Whether a letter opens the line that names a program.
    #[inline]
    #[must_use]
    pub fn names_program(&self, letter: u8) -> bool {
        self.program_letters.get(usize::from(letter.wrapping_sub(b'A'))).copied().unwrap_or(false)
    }

    /// The letter that is the argument of a word.
    #[must_use]
    pub fn argument(&self, word: &Word) -> Option<u8> {
        let code = word.whole()?;
        self.arguments.iter().find(|(letter, n, _)| (*letter, *n) == (word.letter, code)).map(|a| a.2)
    }

    /// What a word of several letters is: kept, refused, a command of another kind of file, or unknown.
    #[must_use]
    pub fn long_word(&self, text: &[u8]) -> LongWord {
        let letters = text.iter().take_while(|b| b.is_ascii_alphabetic()).count();
        let is_in = |list: &[String]| list.iter().any(|w| text[..letters].eq_ignore_ascii_case(w.as_bytes()));
        if is_in(&self.long_words) {
            LongWord::Kept
        } else if is_in(&self.refused_words) {
            LongWord::Refused
        } else if is_in(&self.command_words) {
            LongWord::Command
        } else {
            LongWord::Unknown
        }
    }

    /// Whether G50 to G52 switch a taper.
    #[must_use]
    pub fn has_taper(&self) -> bool {
        matches!(self.g_codes[51], Code::Taper(_))
    }

    /// How far the radii of an arc may disagree in a unit, nanometres: 2 µm and the least increment.
    #[must_use]
    pub fn arc_tolerance(&self, unit: Unit) -> i64 {
        2_000 + self.least_increment[unit as usize]
    }
}

/// What a word of several letters is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum LongWord {
    /// A word of the machine.
    Kept,
    /// Changes the path in a way that is not read.
    Refused,
    /// Belongs to a command file.
    Command,
    /// Not in the table.
    Unknown,
}

/// Places of lengths in a block's list.
pub(super) const X: usize = 0;
/// See [`X`].
pub(super) const Y: usize = 1;
/// See [`X`].
pub(super) const I: usize = 2;
/// See [`X`].
pub(super) const J: usize = 3;
/// See [`X`].
pub(super) const U: usize = 4;
/// See [`X`].
pub(super) const V: usize = 5;
/// See [`X`].
pub(super) const R: usize = 6;
/// See [`X`].
pub(super) const K: usize = 7;
/// See [`X`].
pub(super) const L: usize = 8;
/// How many lengths a block may have.
pub(super) const LENGTHS: usize = 9;
