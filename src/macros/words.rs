//! The words of a block: a letter with its number, and what blocks a macro program acts upon itself.
//!
//! Most blocks are made as they stand, with computed numbers put in. Those that call (G65, G66, M97, M98) and return
//! (M99) are run and not made; what else stands in an M98 or M99 block is made before. G31 ends where a signal comes: no
//! program without macros can say that.

use super::arguments::Arguments;
use super::code::{Call, Kind, Op, Template, TemplateWord, Value};
use super::expression::Parser;
use super::findings::{At, Fault};
use super::options::Skip;
use super::reader::Reader;
use super::statement::Statements;
use crate::formats::gcode::numbers::Number as Written;

/// A word as it was read.
#[derive(Clone, Copy, Debug)]
pub(super) struct Word {
    pub letter: u8,
    pub value: Value,
    pub at: At,
}

impl Word {
    /// Tenths of its number, where that is written: 900 for `G90`, 541 for `G54.1`.
    fn code(&self) -> Option<u32> {
        let Value::Written(number, _) = self.value else { return None };
        tenths(number)
    }
}

/// Tenths of a code; none where it is not one.
pub(super) fn tenths(number: Written) -> Option<u32> {
    let value = match number.decimals {
        0 => number.mantissa.checked_mul(10)?,
        1 => number.mantissa,
        _ => return None,
    };
    u32::try_from(value).ok().filter(|v| *v < 100_000)
}

impl Reader<'_> {
    /// One word.
    pub(super) fn word(&mut self, parser: &mut Parser<'_>, read: &mut Statements) -> Result<(), Fault> {
        let from = parser.at;
        let letter = parser.line.bytes[from];
        if matches!(letter, b'N' | b'O') {
            let message = format!("{} within a block", letter as char);
            return Err(Fault::syntax(parser.here(), message, "it stands in front"));
        }
        parser.at += 1;
        let negative = match parser.peek() {
            Some(b'-') => {
                parser.at += 1;
                true
            }
            Some(b'+') => {
                parser.at += 1;
                false
            }
            _ => false,
        };
        parser.letter = letter;
        let value = match parser.peek() {
            Some(b'0'..=b'9' | b'.') => {
                let (digits, decimals) = parser.digits()?;
                let point = parser.line.bytes[from..parser.at].contains(&b'.');
                let mantissa = if negative { -digits } else { digits };
                let at = parser.since(from + 1);
                Value::Written(Written { mantissa, decimals, point }, (at.start, at.end))
            }
            Some(b'#' | b'[') => {
                let cell =
                    if parser.peek() == Some(b'#') { parser.variable()? } else { parser.bracket("")?.cell };
                if negative {
                    let at = parser.since(from);
                    let to = parser.result(at)?;
                    parser.code.push(Op::Negate { to, from: cell }, at);
                    Value::Cell(to)
                } else {
                    Value::Cell(cell)
                }
            }
            _ => {
                parser.at = from;
                let text = parser.next_text();
                parser.at = from + text.len();
                return Err(if text.len() > 1 {
                    let message = format!("`{text}` is no word of the language");
                    Fault::syntax(parser.since(from), message, "calculations stand in brackets: X[SIN[#1]]")
                } else {
                    let message = format!("`{text}`: a letter without its number");
                    Fault::syntax(parser.since(from), message, "write the number behind it")
                });
            }
        };
        parser.letter = 0;
        if let Some(byte @ (b'+' | b'-' | b'*' | b'/')) = parser.peek() {
            return Err(Fault::syntax(
                parser.here(),
                format!("`{}` behind a word", byte as char),
                "put the calculation in brackets: X[#1+1]",
            ));
        }
        read.words.push(Word { letter, value, at: parser.since(from) });
        Ok(())
    }

    /// What the words of a line come to.
    pub(super) fn block(&mut self, parser: &mut Parser<'_>, read: &mut Statements) -> Result<(), Fault> {
        if read.words.is_empty() {
            self.remark_line(parser, read);
            return Ok(());
        }
        for word in &read.words {
            if word.letter == b'G' {
                match word.code() {
                    Some(310..=319) => {
                        return Err(Fault::new(
                            "machine-word",
                            word.at,
                            "G31 ends where a signal comes: only the machine knows",
                            "run the program in the control",
                        ));
                    }
                    Some(661) => {
                        let message = "G66.1 calls with every block's words as arguments: not expanded";
                        return Err(Fault::syntax(word.at, message, "write G65 in the blocks"));
                    }
                    _ => {}
                }
            }
        }
        let of = |letter: u8, codes: &[u32]| {
            read.words.iter().position(|w| w.letter == letter && w.code().is_some_and(|c| codes.contains(&c)))
        };
        if let Some(at) = of(b'G', &[650, 660]) {
            read.acts = true;
            // A call is a macro statement: ROUND makes whole numbers there as in an assignment. Unverified: the manuals speak
            // of "NC statement addresses" only.
            for op in &mut parser.code.ops[read.first as usize..] {
                if let Op::Round { letter, .. } = op {
                    *letter = 0;
                }
            }
            return self.macro_call(parser, &read.words, at);
        }
        if let Some(at) = of(b'M', &[970, 980]) {
            read.acts = true;
            return self.subprogram_call(parser, read, at);
        }
        if let Some(at) = of(b'M', &[990]) {
            read.acts = true;
            return self.return_(parser, read, at);
        }
        // Behind an end there is nothing; whether it is one is then for the switch to say.
        read.acts |= of(b'M', &[20, 300]).is_some() && read.skip > 0;
        let cancel = of(b'G', &[670]).map(|at| read.words.remove(at).at);
        self.template(parser, read)?;
        if let Some(at) = cancel {
            read.acts = true;
            parser.code.push(Op::CancelModal, at);
        }
        Ok(())
    }

    /// G65 and G66: program, count and arguments.
    fn macro_call(&mut self, parser: &mut Parser<'_>, words: &[Word], at: usize) -> Result<(), Fault> {
        let kind = if words[at].code() == Some(650) { Kind::Macro } else { Kind::Modal };
        let name = super::statement::name_of_call(kind);
        if let Some(word) = words[..at].first() {
            let message = format!("a word in front of {name}");
            return Err(Fault::syntax(word.at, message, "the words in front belong to another block"));
        }
        let call_at = words[at].at;
        let (mut program, mut count, mut arguments) = (None, None, Vec::new());
        let mut letters = Arguments::default();
        for word in &words[at + 1..] {
            match word.letter {
                b'P' if program.is_none() => program = Some(*word),
                b'L' if count.is_none() => count = Some(*word),
                b'P' | b'L' => return Err(twice(word)),
                letter => {
                    let variable = letters.variable(letter, word.at)?;
                    arguments.push((variable, letter, word.value));
                }
            }
        }
        let call = self.call(kind, call_at, program, count, arguments)?;
        let code = &mut *parser.code;
        code.calls.push(Call { pc: code.next(), ..call });
        let call = code.calls.len() as u32 - 1;
        code.push(if kind == Kind::Macro { Op::Call { call } } else { Op::SetModal { call } }, call_at);
        Ok(())
    }

    /// M98 and M97; what else stands in the block is made before.
    fn subprogram_call(
        &mut self,
        parser: &mut Parser<'_>,
        read: &mut Statements,
        at: usize,
    ) -> Result<(), Fault> {
        let word = read.words.remove(at);
        let kind = if word.code() == Some(980) { Kind::Subprogram } else { Kind::Local };
        let program = taken(&mut read.words, b'P')?;
        let count = taken(&mut read.words, b'L')?;
        if let Some(q) = read.words.iter().find(|w| w.letter == b'Q') {
            return Err(Fault::syntax(
                q.at,
                "Q in a call of a subprogram is not known here",
                "call it from its start",
            ));
        }
        let call = self.call(kind, word.at, program, count, Vec::new())?;
        self.template(parser, read)?;
        if kind == Kind::Local && matches!(call.program, Value::Cell(_)) {
            parser.code.computed_jumps = true;
        }
        let code = &mut *parser.code;
        code.calls.push(Call { pc: code.next(), ..call });
        let call = code.calls.len() as u32 - 1;
        code.push(Op::Call { call }, word.at);
        Ok(())
    }

    fn call(
        &mut self,
        kind: Kind,
        at: At,
        program: Option<Word>,
        count: Option<Word>,
        arguments: Vec<(u16, u8, Value)>,
    ) -> Result<Call, Fault> {
        let name = super::statement::name_of_call(kind);
        let Some(program) = program else {
            let message = format!("{name} without P");
            return Err(Fault::syntax(at, message, format!("write {name} P1000")));
        };
        let whole = |word: Word| match word.value {
            Value::Written(number, _) if number.mantissa < 0 || number.decimals > 0 => {
                let message = format!("{} of {name} is a whole number", word.letter as char);
                Err(Fault::syntax(word.at, message, "leave out the point and the sign"))
            }
            value => Ok(value),
        };
        let one = Value::Written(Written { mantissa: 1, decimals: 0, point: false }, (0, 0));
        let count_value = count.map_or(Ok(one), whole)?;
        if let (Some(word), Value::Written(Written { mantissa: 0, .. }, _)) = (count, count_value) {
            return Err(Fault::syntax(word.at, "L0: called no times", "L counts from 1"));
        }
        Ok(Call {
            kind,
            program: whole(program)?,
            entry: None,
            count: count_value,
            has_count: count.is_some(),
            pc: 0,
            arguments,
            at: At { end: program.at.end.max(at.end), ..at },
        })
    }

    /// M99, alone or to an N number.
    fn return_(&mut self, parser: &mut Parser<'_>, read: &mut Statements, at: usize) -> Result<(), Fault> {
        let word = read.words.remove(at);
        let target = taken(&mut read.words, b'P')?;
        if let Some(l) = read.words.iter().find(|w| w.letter == b'L') {
            let message = "L behind M99 changes a count on some controls and means nothing on others";
            return Err(Fault::syntax(l.at, message, "leave it out"));
        }
        self.template(parser, read)?;
        let op = match target {
            None => Op::Return,
            Some(target) => Op::ReturnTo {
                cell: match target.value {
                    Value::Written(number, _) if number.decimals == 0 && number.mantissa >= 0 => {
                        self.returns.insert(number.mantissa as u64);
                        parser.code.constant(number.mantissa, 0, target.at)?
                    }
                    Value::Written(..) => {
                        let message = "P of M99 is an N number";
                        return Err(Fault::syntax(target.at, message, "write it without point and sign"));
                    }
                    Value::Cell(cell) => {
                        parser.code.computed_jumps = true;
                        cell
                    }
                },
            },
        };
        parser.code.push(op, word.at);
        Ok(())
    }

    /// The block that is made of the words left.
    fn template(&mut self, parser: &mut Parser<'_>, read: &Statements) -> Result<(), Fault> {
        if read.words.is_empty() {
            return Ok(());
        }
        for (n, word) in read.words.iter().enumerate() {
            let may_repeat = matches!(word.letter, b'G' | b'M');
            if !may_repeat && read.words[..n].iter().any(|w| w.letter == word.letter) {
                return Err(twice(word));
            }
        }
        let codes = |letter: u8| read.words.iter().filter(move |w| w.letter == letter).filter_map(Word::code);
        let is_motion = codes(b'G').any(|c| matches!(c, 0 | 10 | 20 | 30));
        let is_setting = codes(b'G').any(|c| NOT_MOVING.contains(&c));
        let template = Template {
            source: self.source(parser.line, read),
            first: parser.code.words.len() as u32,
            count: read.words.len() as u16,
            sure: read.words.iter().any(|w| matches!(w.value, Value::Written(..))),
            moves: is_motion || !is_setting,
            ends: codes(b'M').any(|c| matches!(c, 20 | 300)),
            computed_code: read
                .words
                .iter()
                .any(|w| matches!(w.letter, b'G' | b'M') && matches!(w.value, Value::Cell(_))),
            is_remark: false,
        };
        let words = read.words.iter().map(|w| TemplateWord { letter: w.letter, value: w.value });
        parser.code.words.extend(words);
        self.push_template(parser, template, read.words[0].at);
        Ok(())
    }

    fn push_template(&mut self, parser: &mut Parser<'_>, template: Template, at: At) {
        let code = &mut *parser.code;
        code.templates.push(template);
        let template = code.templates.len() as u32 - 1;
        code.push(Op::Block { template }, at);
    }

    /// A line of remarks alone.
    fn remark_line(&mut self, parser: &mut Parser<'_>, read: &Statements) {
        if !self.options.remarks || read.acts || parser.line.remarks.is_empty() {
            return;
        }
        let (start, end, _) = parser.line.remarks[0];
        let template = Template {
            source: self.source(parser.line, read),
            first: 0,
            count: 0,
            sure: false,
            moves: false,
            ends: false,
            computed_code: false,
            is_remark: true,
        };
        let at = At { start, end, ..parser.line.at(0, 1) };
        self.push_template(parser, template, at);
    }

    /// The M00 of `#3006`, with its text for a remark.
    pub(super) fn stop(&mut self, parser: &mut Parser<'_>, text: Option<At>) -> u32 {
        let source = self.source_with(parser.line, text.map(|t| (t.start, t.end)).into_iter(), 0, None);
        let code = &mut *parser.code;
        let first = code.words.len() as u32;
        let number = Written { mantissa: 0, decimals: 0, point: false };
        code.words.push(TemplateWord { letter: b'M', value: Value::Written(number, (0, 0)) });
        code.templates.push(Template {
            source,
            first,
            count: 1,
            sure: true,
            moves: false,
            ends: false,
            computed_code: false,
            is_remark: false,
        });
        code.templates.len() as u32 - 1
    }

    fn source(&mut self, line: &super::line::Line, read: &Statements) -> u32 {
        let skip = if self.options.skip == Skip::Kept { read.skip } else { 0 };
        let remarks = line.remarks.iter().map(|(start, end, _)| (*start, *end));
        self.source_with(line, remarks, skip, read.number)
    }
}

/// G codes whose axis words are no motion of their own, in tenths: dwell, data, limits, scaling or taper, rotation,
/// presets.
const NOT_MOVING: [u32; 9] = [40, 100, 110, 220, 500, 510, 520, 680, 920];

/// Takes a word out of a block; it may stand there once.
fn taken(words: &mut Vec<Word>, letter: u8) -> Result<Option<Word>, Fault> {
    let found = words.iter().position(|w| w.letter == letter).map(|at| words.remove(at));
    match words.iter().find(|w| w.letter == letter && found.is_some()) {
        Some(again) => Err(twice(again)),
        None => Ok(found),
    }
}

fn twice(word: &Word) -> Fault {
    let message = format!("{}: the block has this word already", word.letter as char);
    Fault::syntax(word.at, message, "leave one out, or write two blocks")
}
