//! What a file is: by `--from`, else by its suffix, else by its first lines.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use clap::ValueEnum;

use super::failure::{Exit, Failure};
use super::source;
use crate::formats::gcode::words;

/// What a source is.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(super) enum Kind {
    /// A 3B program
    #[value(name = "3b")]
    ThreeB,
    /// A 4B program
    #[value(name = "4b")]
    FourB,
    /// A G-code program without macros
    Gcode,
    /// A macro program, expanded as it is read
    Macro,
    /// A drawing
    Dxf,
    /// A part file, generated on demand
    Part,
}

impl Kind {
    /// Every kind, in the order of their names on the command line.
    const ALL: [Self; 6] = [Self::ThreeB, Self::FourB, Self::Gcode, Self::Macro, Self::Dxf, Self::Part];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::ThreeB => "3b",
            Self::FourB => "4b",
            Self::Gcode => "gcode",
            Self::Macro => "macro",
            Self::Dxf => "dxf",
            Self::Part => "part",
        }
    }

    /// What it is called in a sentence.
    pub(super) fn title(self) -> &'static str {
        match self {
            Self::ThreeB => "3B",
            Self::FourB => "4B",
            Self::Gcode => "G-code",
            Self::Macro => "a macro program",
            Self::Dxf => "a drawing",
            Self::Part => "a part file",
        }
    }

    pub(super) fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// What a word on the command line stands for: by what `--from` says, else as [`Kind::of`].
    pub(super) fn asked(word: &str, from: Option<Self>) -> Result<Self, Failure> {
        if word == "-" {
            return from.ok_or_else(|| {
                Failure::new(Exit::Usage, "what comes from standard input must be named with --from")
                    .help("for example `--from 3b`")
            });
        }
        let metadata = std::fs::metadata(word).map_err(|error| source::unreadable(word, &error))?;
        if metadata.is_dir() {
            let message = format!("{word} is a directory, not a program");
            return Err(Failure::new(Exit::Program, message).help("name one of the files in it"));
        }
        from.or_else(|| Self::of(word, metadata.is_file())).ok_or_else(|| {
            Failure::new(Exit::Usage, format!("what {word} is cannot be told from its name"))
                .help("name a .3b, .4b, .nc, .dxf or .toml file, or say what it is with --from")
        })
    }

    /// What the name of a file says it is; failing that, its first bytes. What can be read only once is not looked into.
    pub(super) fn of(word: &str, is_file: bool) -> Option<Self> {
        let path = Path::new(word);
        let suffix = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
        match suffix.as_deref() {
            Some("3b") => Some(Self::ThreeB),
            Some("4b") => Some(Self::FourB),
            Some("nc" | "iso" | "ngc" | "gcode" | "cnc" | "tap" | "mpf" | "min" | "eia") => {
                let has_macros =
                    is_file && head_of(path, MACROS_WITHIN).is_some_and(|head| has_macros(&head));
                Some(if has_macros { Self::Macro } else { Self::Gcode })
            }
            Some("dxf") => Some(Self::Dxf),
            Some("toml") => Some(Self::Part),
            _ if !is_file => None,
            _ => of_content(&head_of(path, 4096)?),
        }
    }
}

/// A program of plain blocks is not searched for macros behind this; where it has one it is told when it is read.
const MACROS_WITHIN: u64 = 1 << 20;

/// How a file begins.
fn head_of(path: &Path, bytes: u64) -> Option<Vec<u8>> {
    let mut head = Vec::new();
    File::open(path).and_then(|file| file.take(bytes).read_to_end(&mut head)).ok()?;
    Some(head)
}

/// Whether a line of a text is one of macro programs.
fn has_macros(text: &[u8]) -> bool {
    let mut words = Vec::new();
    text.split(|&b| b == b'\n' || b == b'\r').any(|line| {
        words::cut(line, &mut words).is_ok()
            && words.iter().any(|word| {
                let whole = word.whole();
                word.kind == words::Kind::Macro
                    || (word.kind == words::Kind::Word
                        && matches!((word.letter, whole), (b'G', Some(65..=67)) | (b'M', Some(97))))
            })
    })
}

/// What the first lines of a text look like.
fn of_content(head: &[u8]) -> Option<Kind> {
    let head = head.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(head);
    let mut lines = head.split(|&b| b == b'\n' || b == b'\r').map(<[u8]>::trim_ascii);
    if lines.clone().any(|line| line == b"[part]") {
        return Some(Kind::Part);
    }
    if head.starts_with(b"AutoCAD Binary DXF") {
        return Some(Kind::Dxf);
    }
    let mut significant = lines.clone().filter(|line| !line.is_empty());
    if significant.next() == Some(b"0") && significant.next() == Some(b"SECTION") {
        return Some(Kind::Dxf);
    }
    // The first line that is a block of either grammar decides; for G-code, whether macros follow.
    let kind = lines.find_map(|line| match blocks_in(line) {
        Some(letters) if letters >= 4 => Some(Kind::FourB),
        Some(_) => Some(Kind::ThreeB),
        None => (is_gcode(line) || is_assignment(line)).then_some(Kind::Gcode),
    });
    if kind == Some(Kind::Gcode) && has_macros(head) { Some(Kind::Macro) } else { kind }
}

/// How many B words begin the first block in a line, if it holds a 3B or 4B block.
fn blocks_in(line: &[u8]) -> Option<usize> {
    let mut count = 0;
    for byte in line {
        match byte.to_ascii_uppercase() {
            b'B' => count += 1,
            b'0'..=b'9' | b' ' | b'\t' | b'.' => {}
            b'G' | b'X' | b'Y' | b'D' if count >= 3 => return Some(count),
            _ => count = 0,
        }
    }
    None
}

/// Whether a line begins as `#1=`, `#[1]=` or `#<name>=`, and not as a remark of some other language.
fn is_assignment(line: &[u8]) -> bool {
    let behind = line.strip_prefix(b"#").map(<[u8]>::trim_ascii_start);
    behind.and_then(|behind| behind.first()).is_some_and(|b| b.is_ascii_digit() || matches!(b, b'[' | b'<'))
        && line.contains(&b'=')
}

/// Whether a line begins as a block of G-code.
fn is_gcode(line: &[u8]) -> bool {
    let line = line.strip_prefix(b"/").unwrap_or(line).trim_ascii_start();
    let numbered = |line: &[u8]| -> Option<usize> {
        let digits = line.get(1..)?.iter().take_while(|b| b.is_ascii_digit()).count();
        (digits > 0).then_some(digits + 1)
    };
    match line.first().map(u8::to_ascii_uppercase) {
        Some(b'N') => numbered(line).is_some_and(|end| is_gcode(line[end..].trim_ascii_start())),
        Some(b'G' | b'M' | b'O') => numbered(line).is_some(),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_block_tells_what_a_text_is() {
        for (text, kind) in [
            ("***\nStart Point = 0 ; X , Y\nN   1: B 5000 B 0 B 5000 GX L1\n", Some(Kind::ThreeB)),
            ("%\nbbb9900gxl1b0", Some(Kind::ThreeB)),
            ("B5000B0B5000B2000DDGXNR1\n", Some(Kind::FourB)),
            ("%\nO0001 (PUNCH)\nG92 X0 Y0\n", Some(Kind::Gcode)),
            ("%\nO0001\n#101=25\nWHILE[#101GT20]DO1\n", Some(Kind::Macro)),
            ("#110=0.02 (INCREMENT)\n", Some(Kind::Macro)),
            ("# a list of things\n", None),
            ("G90 (SEE #5)\nG01 X1. Y2.\n", Some(Kind::Gcode)),
            ("(PUNCH)\n/N10 G90 G1X1.\n", Some(Kind::Gcode)),
            ("  0\r\nSECTION\r\n  2\r\nHEADER\r\n", Some(Kind::Dxf)),
            ("# a part\n[part]\nkind = \"gear\"\n", Some(Kind::Part)),
            ("hello world\nNothing here\n", None),
            ("", None),
        ] {
            assert_eq!(of_content(text.as_bytes()), kind, "{text}");
        }
    }
}
