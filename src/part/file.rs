//! Part files: one TOML a part, strict keys, lengths in mm.
//!
//! A key that is left out takes the value of the 1990 paper's printed run, and is named in [`PartFile::assumed`], so
//! that nothing defaults quietly.

use super::{Format, Part, Rounding, StopWord, aim_named, start_hole};
use std::sync::Arc;

use crate::formats::gcode::Dialect;
use crate::formats::gcode::dialect::BUILT_IN;
use crate::keys::{Document, KeyError, PointOrWord, Section};
use crate::rounding::Aim;
use crate::shapes::cycloid_gear::{Direction, LeadIn, Trim};

/// A part file that has been read.
#[derive(Clone, Debug)]
pub struct PartFile {
    /// What it says.
    pub part: Part,
    /// The keys it left out, with the values taken for them.
    pub assumed: Vec<String>,
}

/// Words of `direction`.
pub const DIRECTIONS: [(&str, Direction); 2] =
    [("cw", Direction::Clockwise), ("ccw", Direction::CounterClockwise)];
/// Words of `rounding`.
pub const ROUNDINGS: [(&str, Rounding); 2] =
    [("closed-loop", Rounding::ClosedLoop), ("per-block", Rounding::PerBlock)];
/// Words of `end`.
pub const STOP_WORDS: [(&str, StopWord); 4] =
    [("DD", StopWord::DD), ("D", StopWord::D), ("E", StopWord::E), ("none", StopWord::None)];
/// Words of `format`.
pub const FORMATS: [(&str, &str); 3] = [("3b", "3b"), ("4b", "4b"), ("gcode", "gcode")];
/// Words of `interpolator`.
pub const AIMS: [&str; 5] = ["any", "rotated", "mirrored", "strict", "exact"];

impl PartFile {
    /// Reads a part file.
    ///
    /// # Errors
    ///
    /// With the place of whatever is not known, not of its kind, or out of its range.
    pub fn parse(text: &str) -> Result<Self, KeyError> {
        let document = Document::parse(text)?;
        let [part, wire, output, machine] = document.sections(["part", "wire", "output", "machine"])?;
        if !part.is_present() {
            return Err(part.error("kind", "the part file has no `[part]` section", Some(EXPLAIN)));
        }
        match part.text("kind")? {
            Some("gear") => {}
            Some(other) => {
                let message = format!("`kind = \"{other}\"` is not one of gear");
                return Err(part.error("kind", message, Some(EXPLAIN)));
            }
            None => return Err(part.error("kind", "`kind` is missing in [part]", Some(EXPLAIN))),
        }

        let mut reader = Reader { assumed: Vec::new() };
        let mut made = Part::default();
        let gear = &mut made.gear;
        for (key, value) in [
            ("module", &mut gear.module),
            ("kp", &mut gear.kp),
            ("kr", &mut gear.kr),
            ("ks", &mut gear.ks),
            ("knf", &mut gear.knf),
            ("tip_radius", &mut gear.tip_radius),
        ] {
            reader.take(key, part.number(key)?, value);
        }
        reader.take("teeth", part.whole("teeth", 3..=1_000_000)?, &mut gear.teeth);
        reader.take_word("direction", part.word("direction", &DIRECTIONS)?, &mut made.direction, "cw");
        reader.take("repeat", part.whole("repeat", 1..=u64::MAX)?, &mut made.repeat);
        if part.switch("trim")? == Some(true) {
            made.trim = Trim::Allow;
        }
        match part.point_or_word("lead_in")? {
            Some(PointOrWord::Point(x, y)) => {
                made.lead_in = start_hole(x, y).ok_or_else(|| {
                    part.error("lead_in", "`lead_in` must lie within 100 m of the centre", None)
                })?;
            }
            Some(PointOrWord::Word("centre")) => made.lead_in = LeadIn::Centre,
            Some(PointOrWord::Word("none")) => made.lead_in = LeadIn::None,
            Some(PointOrWord::Word(_)) => {
                return Err(part.error(
                    "lead_in",
                    "`lead_in` must be \"centre\", \"none\" or a point `[x, y]` in mm",
                    None,
                ));
            }
            None => reader.assumed.push("lead_in = \"centre\"".to_owned()),
        }

        offset(&part, &wire, &mut reader, &mut made)?;

        let format = either(&part, &output, "format", |s| s.word("format", &FORMATS))?;
        let dialect = output.word("dialect", &BUILT_IN.map(|(name, _)| (name, name)))?;
        made.format = match (format, dialect) {
            (Some("gcode"), dialect) => {
                let name = dialect.unwrap_or(BUILT_IN[0].0);
                if dialect.is_none() {
                    reader.assumed.push(format!("dialect = \"{name}\""));
                }
                Format::Gcode(dialect_named(name)?)
            }
            (_, Some(_)) => {
                return Err(output.error("dialect", "`dialect` goes with `format = \"gcode\"`", None));
            }
            (Some("4b"), None) => Format::FourB,
            (_, None) => Format::ThreeB,
        };
        if let Some(rounding) = either(&part, &output, "rounding", |s| s.word("rounding", &ROUNDINGS))? {
            made.rounding = rounding;
        }
        let aim = either(&part, &output, "interpolator", |s| {
            s.word("interpolator", &AIMS.map(|name| (name, aim_named(name).unwrap_or(Aim::Any))))
        })?;
        if let Some(aim) = aim {
            made.aim = aim;
        }
        if made.rounding == Rounding::PerBlock && made.format != Format::ThreeB {
            return Err(output.error("rounding", "`rounding = \"per-block\"` goes with 3B", None));
        }
        if made.repeat > 1 && made.format == Format::FourB {
            return Err(part.error(
                "repeat",
                "4B takes an outline once: it is held whole for its flags",
                None,
            ));
        }
        if let Some(end) = either(&part, &output, "end", |s| s.word("end", &STOP_WORDS))? {
            made.stop_word = end;
        }
        if let Some(digits) = output.whole("j_digits", 1..=6)? {
            made.style.j_digits = digits as usize;
        }
        if let Some(letter) = output.word("g_word", &[("GX", true), ("X", false)])? {
            made.style.g_letter = letter;
        }
        if let Some(blanks) = output.switch("blanks")? {
            made.style.blanks = blanks;
        }
        made.machine = machine.text("name")?.map(str::to_owned);
        for section in [&part, &wire, &output, &machine] {
            section.finish()?;
        }
        Ok(Self { part: made, assumed: reader.assumed })
    }
}

/// The wire: an offset, or diameter, gap and side.
fn offset(
    part: &Section<'_>,
    wire: &Section<'_>,
    reader: &mut Reader,
    made: &mut Part,
) -> Result<(), KeyError> {
    let given = either(part, wire, "offset", |s| s.number("offset"))?;
    let (diameter, gap) = (wire.number("diameter")?, wire.number("gap")?);
    let side = wire.word("side", &[("outside", 1.0), ("inside", -1.0)])?;
    match (given, diameter, gap, side) {
        (given, None, None, None) => reader.take("offset", given, &mut made.offset),
        (None, Some(diameter), Some(gap), Some(side)) => {
            if !(diameter > 0.0 && gap >= 0.0) {
                return Err(wire.error("diameter", "`diameter` must be above 0 and `gap` not below 0", None));
            }
            made.offset = side * (diameter / 2.0 + gap);
        }
        _ => {
            let message =
                "the wire is given either by `offset` alone, or by `diameter`, `gap` and `side` together";
            return Err(wire.error("offset", message, Some("offset = diameter / 2 + gap, negative inside")));
        }
    }
    Ok(())
}

/// A built-in dialect.
///
/// # Errors
///
/// Never in a tested build: the names are those of the table.
pub fn dialect_named(name: &str) -> Result<Arc<Dialect>, KeyError> {
    Dialect::named(name).unwrap_or_else(Dialect::generic).map(Arc::new)
}

/// A key that may stand in [part] or in the section it belongs to, but not in both.
fn either<'a, T>(
    part: &Section<'a>,
    own: &Section<'a>,
    key: &'static str,
    read: impl Fn(&Section<'a>) -> Result<Option<T>, KeyError>,
) -> Result<Option<T>, KeyError> {
    match (read(part)?, read(own)?) {
        (Some(_), Some(_)) => {
            Err(own.error(key, format!("`{key}` is given twice, here and in [part]"), None))
        }
        (first, second) => Ok(first.or(second)),
    }
}

struct Reader {
    assumed: Vec<String>,
}

impl Reader {
    fn take<T: std::fmt::Display>(&mut self, key: &str, given: Option<T>, value: &mut T) {
        match given {
            Some(given) => *value = given,
            None => self.assumed.push(format!("{key} = {value}")),
        }
    }

    fn take_word<T>(&mut self, key: &str, given: Option<T>, value: &mut T, assumed: &str) {
        match given {
            Some(given) => *value = given,
            None => self.assumed.push(format!("{key} = \"{assumed}\"")),
        }
    }
}

const EXPLAIN: &str = "`dripfeed generate --explain gear` prints a part file to start from";

/// A commented part file for the gear, which builds as it stands.
pub const GEAR_TEMPLATE: &str = r#"# A modified cycloid (clock) gear. Lengths in mm. Source of the shape: Li Yanzun (1990).
# The numbers are those of the paper's printed run.

[part]
kind = "gear"
module = 0.4          # m; pitch diameter = m * teeth
teeth = 36            # z, a whole number from 3
kp = 2.0              # tip flank radius = kp * m
kr = 0.15             # the tip flanks' centres lie kr * m inside the pitch circle
ks = 1.57             # tooth thickness on the pitch circle = ks * m
knf = 1.57            # the root circle lies knf * m inside the pitch circle
tip_radius = 0.04     # rounding of the tip, R'
direction = "cw"      # direction of cut: "cw" or "ccw"
lead_in = "centre"    # from the gear's centre, "none", or a start hole: [x, y] from the centre
repeat = 1            # how many times the outline is cut
trim = false          # true: where the wire is too thick for the tooth space, cut what can be cut

[wire]
offset = 0.07         # wire radius + spark gap; + outside (punch), - inside (die cavity)
# or, instead of offset:
# diameter = 0.12
# gap = 0.01
# side = "outside"    # or "inside"

[output]
format = "3b"              # "3b", "4b" (the outline, flagged for an offset keyed in), or "gcode"
# dialect = "generic"      # of G-code: "generic", "fanuc", "charmilles", "sodick", "mitsubishi", "agie" or "integer-um"
rounding = "closed-loop"   # or "per-block", as the paper rounds
interpolator = "any"       # the control's method: "any", "rotated", "mirrored", "strict" or "exact"
end = "DD"                 # stop word: "DD", "D", "E" or "none"
j_digits = 6               # J padded with zeros to this many digits; 1 pads nothing
g_word = "GX"              # "GX", or "X" as in the paper
blanks = false             # a blank between words
"#;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_template_builds_unedited_and_is_the_default_part() {
        let file = PartFile::parse(GEAR_TEMPLATE).unwrap();
        assert_eq!(file.part, Part::default());
        assert_eq!(file.assumed, Vec::<String>::new());
        assert!(file.part.prepare().is_ok());
    }

    #[test]
    fn what_is_left_out_is_named() {
        let file = PartFile::parse(
            "[part]\nkind = \"gear\"\nteeth = 20\n[wire]\ndiameter = 0.12\ngap = 0.01\nside = \"inside\"\n",
        )
        .unwrap();
        assert_eq!(file.part.gear.teeth, 20);
        assert!((file.part.offset + 0.07).abs() < 1e-12);
        assert!(file.assumed.contains(&"module = 0.4".to_owned()));
        assert!(!file.assumed.iter().any(|a| a.starts_with("offset")));
    }

    #[test]
    fn half_a_wire_and_a_doubled_key_are_refused() {
        let wire = "[part]\nkind = \"gear\"\n[wire]\ndiameter = 0.12\n";
        assert!(PartFile::parse(wire).unwrap_err().message.contains("together"));
        let twice = "[part]\nkind = \"gear\"\noffset = 0.1\n[wire]\noffset = 0.1\n";
        assert!(PartFile::parse(twice).unwrap_err().message.contains("twice"));
        let teeth = "[part]\nkind = \"gear\"\nteeth = 36.5\n";
        assert_eq!(PartFile::parse(teeth).unwrap_err().place.line, 3);
    }
}
