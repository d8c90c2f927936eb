//! Machine profiles: how one control wants to be fed, as a TOML file with the source of every value.
//!
//! A profile file states what differs from `generic-iso`; what it leaves out is taken from there and named. Unknown keys,
//! values out of range and pairs that cannot go together are errors with their place.

mod gcode;

pub use gcode::Arithmetic;

use std::time::Duration;

use crate::check::Travel;
use crate::keys::{Document, KeyError, Section};
use crate::macros::form::Form;
use crate::protocol::pacing::{Pace, WINDOW_MAX};
use crate::tape::{Code, Tape};

/// The profile that is used when none is named, in full.
pub const GENERIC_ISO: &str = include_str!("profile/generic-iso.toml");

/// The built-in profiles by name, with their text.
pub const BUILT_IN: [(&str, &str); 1] = [("generic-iso", GENERIC_ISO)];

/// How a control wants to be fed.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// The profile's name.
    pub name: String,
    /// Speed of the line, baud.
    pub baud: u32,
    /// Bits of a character.
    pub framing: Framing,
    /// How long what the control sends takes to be seen here; none asks the adapter.
    pub receive_latency: Option<Duration>,
    /// Whether the control asks (DC1) before the first byte.
    pub wait_for_start: bool,
    /// How long to wait for it; none waits without limit.
    pub start_timeout: Option<Duration>,
    /// Whether to leave listening gaps where free running would break the limit.
    pub strict: bool,
    /// Characters the control takes after its DC3.
    pub overrun_limit: usize,
    /// Most bytes in the driver; none: as many as the limit and the latency allow.
    pub window: Option<usize>,
    /// Code, end of block, leader, trailer.
    pub tape: Tape,
    /// How much the control may have accepted and not executed.
    pub buffer_bytes: u64,
    /// The dialect of G-code the control speaks, where the profile says: a built-in one or a file.
    pub dialect: Option<String>,
    /// How blocks made of macro programs are spelled.
    pub form: Form,
    /// How macro programs are read and run.
    pub macros: crate::macros::options::Options,
    /// What they count with.
    pub arithmetic: Arithmetic,
    /// How far the machine travels, where the profile says.
    pub travel: Travel,
    /// The most the machine tilts its wire, degrees, where the profile says.
    pub taper_max_degrees: Option<f64>,
}

/// Data bits, parity and stop bits.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Framing {
    /// 5 to 8.
    pub data_bits: u8,
    /// None, even or odd.
    pub parity: Parity,
    /// 1 or 2.
    pub stop_bits: u8,
}

/// The parity bit of a character.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Parity {
    /// N.
    None,
    /// E.
    Even,
    /// O.
    Odd,
}

impl Framing {
    /// Reads `7E2` and the like.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let &[data, parity, stop] = text.as_bytes() else { return None };
        let parity = match parity.to_ascii_uppercase() {
            b'N' => Parity::None,
            b'E' => Parity::Even,
            b'O' => Parity::Odd,
            _ => return None,
        };
        let in_range = (b'5'..=b'8').contains(&data) && (b'1'..=b'2').contains(&stop);
        in_range.then_some(Self { data_bits: data - b'0', parity, stop_bits: stop - b'0' })
    }

    /// Bits of a character on the wire, start bit included.
    #[must_use]
    pub fn bits(self) -> u32 {
        1 + u32::from(self.data_bits) + u32::from(self.parity != Parity::None) + u32::from(self.stop_bits)
    }

    /// How long a character takes at a speed.
    #[must_use]
    pub fn character(self, baud: u32) -> Duration {
        Duration::from_nanos(u64::from(self.bits()) * 1_000_000_000 / u64::from(baud.max(1)))
    }
}

impl std::fmt::Display for Framing {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let parity = match self.parity {
            Parity::None => 'N',
            Parity::Even => 'E',
            Parity::Odd => 'O',
        };
        write!(f, "{}{parity}{}", self.data_bits, self.stop_bits)
    }
}

/// A profile that has been read, and what it did not say.
#[derive(Clone, Debug, PartialEq)]
pub struct ProfileFile {
    /// The profile.
    pub profile: Profile,
    /// Keys taken from `generic-iso`.
    pub assumed: Vec<&'static str>,
    /// The same of what matters to macro programs alone.
    pub assumed_of_macros: Vec<&'static str>,
}

impl Profile {
    /// The built-in profile every other one starts from.
    ///
    /// # Errors
    ///
    /// Never in a tested build: the text is part of the program.
    pub fn generic_iso() -> Result<Self, KeyError> {
        let mut profile = Self {
            name: String::new(),
            baud: 4800,
            framing: Framing { data_bits: 7, parity: Parity::Even, stop_bits: 2 },
            receive_latency: None,
            wait_for_start: true,
            start_timeout: None,
            strict: false,
            overrun_limit: 10,
            window: None,
            tape: Tape {
                code: Code::Ascii,
                end_of_block: b"\n",
                leader: String::new(),
                trailer: String::new(),
            },
            buffer_bytes: 0,
            dialect: None,
            form: Form::default(),
            macros: crate::macros::options::Options::default(),
            arithmetic: Arithmetic::default(),
            travel: Travel::default(),
            taper_max_degrees: None,
        };
        profile.apply(GENERIC_ISO)?;
        Ok(profile)
    }

    /// Reads a profile file.
    ///
    /// # Errors
    ///
    /// With the place of whatever is wrong.
    pub fn parse(text: &str) -> Result<ProfileFile, KeyError> {
        let mut profile = Self::generic_iso()?;
        let (assumed, assumed_of_macros) = profile.apply(text)?;
        Ok(ProfileFile { profile, assumed, assumed_of_macros })
    }

    /// Changes one value, as `--set KEY=VALUE` does.
    ///
    /// # Errors
    ///
    /// When there is no such key or the value does not suit it; the place is within `[section] key = value`.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), KeyError> {
        let name = key.rsplit('.').next().unwrap_or(key);
        let Some((section, _)) =
            KEYS.iter().find(|(s, k)| *k == name && (key == name || key == format!("{s}.{k}")))
        else {
            let names: Vec<&str> = KEYS.iter().map(|(_, k)| *k).collect();
            return Err(KeyError {
                message: format!("a profile has no key `{key}`"),
                place: crate::place::Place::in_text(key, 0, key.len()),
                help: crate::keys::nearest(name, &names),
            });
        };
        let number = !value.is_empty() && value.chars().all(|c| c.is_ascii_digit() || c == '.' || c == '-');
        let number = number || matches!(value, "true" | "false");
        let quoted = if number || value.starts_with('"') { value.to_owned() } else { format!("{value:?}") };
        self.apply(&format!("[{section}]\n{name} = {quoted}\n")).map(|_| ())
    }

    /// Takes over every key the text gives; returns those it does not, those of macro programs apart.
    fn apply(&mut self, text: &str) -> Result<(Vec<&'static str>, Vec<&'static str>), KeyError> {
        let document = Document::parse(text)?;
        let sections = document.sections([
            "machine", "link", "protocol", "tape", "control", "gcode", "macros", "travel", "taper",
        ])?;
        let [machine, link, protocol, tape, control, gcode, macros, travel, taper] = &sections;
        let mut assumed = Vec::new();
        let mut given = |key: &'static str, is_given: bool| {
            if !is_given {
                assumed.push(key);
            }
        };

        if let Some(name) = machine.text("name")? {
            self.name = name.to_owned();
        }
        let baud = link.whole("baud", 50..=4_000_000)?;
        given("baud", baud.is_some());
        self.baud = baud.map_or(self.baud, |b| b as u32);
        let framing = link.text("framing")?;
        given("framing", framing.is_some());
        if let Some(text) = framing {
            self.framing = Framing::parse(text).ok_or_else(|| {
                let message = format!(
                    "`framing = \"{text}\"` is not data bits 5-8, parity N, E or O, and stop bits 1 or 2"
                );
                link.error("framing", message, Some("typical is \"7E2\""))
            })?;
        }
        let latency = latency(link)?;
        given("receive_latency_ms", latency.is_some());
        self.receive_latency = latency.unwrap_or(self.receive_latency);

        protocol.word("name", &[("dc-codes", ())])?;
        let start = protocol.word("start", &[("dc1", true), ("at-once", false)])?;
        given("start", start.is_some());
        self.wait_for_start = start.unwrap_or(self.wait_for_start);
        let timeout = protocol.whole("start_timeout_s", 0..=86_400)?;
        given("start_timeout_s", timeout.is_some());
        if let Some(seconds) = timeout {
            self.start_timeout = (seconds > 0).then(|| Duration::from_secs(seconds));
        }
        let strict = protocol.word("pacing", &[("free", false), ("strict", true)])?;
        given("pacing", strict.is_some());
        self.strict = strict.unwrap_or(self.strict);
        let limit = protocol.whole("overrun_limit", 1..=100_000)?;
        given("overrun_limit", limit.is_some());
        self.overrun_limit = limit.map_or(self.overrun_limit, |n| n as usize);
        let window = protocol.whole("window", 0..=WINDOW_MAX as u64)?;
        given("window", window.is_some());
        if let Some(window) = window {
            self.window = (window > 0).then_some(window as usize);
        }

        let code = tape.word("code", &[("ascii", Code::Ascii), ("iso", Code::Iso)])?;
        given("code", code.is_some());
        self.tape.code = code.unwrap_or(self.tape.code);
        let ends: [(&str, &'static [u8]); 3] = [("lf", b"\n"), ("cr", b"\r"), ("crlf", b"\r\n")];
        let end = tape.word("end_of_block", &ends)?;
        given("end_of_block", end.is_some());
        self.tape.end_of_block = end.unwrap_or(self.tape.end_of_block);
        let leader = tape.text("leader")?;
        given("leader", leader.is_some());
        self.tape.leader = leader.map_or_else(|| self.tape.leader.clone(), str::to_owned);
        let trailer = tape.text("trailer")?;
        given("trailer", trailer.is_some());
        self.tape.trailer = trailer.map_or_else(|| self.tape.trailer.clone(), str::to_owned);

        let buffer = control.whole("buffer_bytes", 0..=1 << 30)?;
        given("buffer_bytes", buffer.is_some());
        self.buffer_bytes = buffer.unwrap_or(self.buffer_bytes);

        let mut of_macros = Vec::new();
        let mut given = |key: &'static str, is_given: bool| {
            if !is_given {
                of_macros.push(key);
            }
        };
        gcode::form(&mut self.form, gcode, &mut given)?;
        let arithmetic = gcode::macros(&mut self.macros, &mut self.form, macros, &mut given)?;
        self.arithmetic = arithmetic.unwrap_or(self.arithmetic);

        self.dialect = control.text("dialect")?.map(str::to_owned).or(self.dialect.take());
        // What a profile does not say of the machine itself is not assumed: it is then not checked.
        self.travel.x = within(travel, "x_mm", 100_000.0)?.or(self.travel.x);
        self.travel.y = within(travel, "y_mm", 100_000.0)?.or(self.travel.y);
        self.taper_max_degrees = within(taper, "max_degrees", 90.0)?.or(self.taper_max_degrees);

        for section in &sections {
            section.finish()?;
        }
        for (key, result) in [("leader", self.tape.leader()), ("trailer", self.tape.trailer())] {
            if let Err(error) = result {
                return Err(tape.error(key, format!("`{key}`: {error}"), None));
            }
        }
        if self.tape.code == Code::Iso && self.framing.data_bits < 8 {
            let message = "`code = \"iso\"` makes parity in bit 8, and the framing has no bit 8";
            return Err(tape.error(
                "code",
                message,
                Some("use code = \"ascii\" with 7E2, or framing = \"8N2\" with \"iso\""),
            ));
        }
        if self.framing.data_bits < 7 {
            let message = "3B needs seven data bits or more";
            return Err(link.error("framing", message, Some("typical is \"7E2\"")));
        }
        Ok((assumed, of_macros))
    }

    /// How the line is paced, given the latency found or assumed; none of it when unpaced.
    #[must_use]
    pub fn pace(&self, latency: Duration) -> Pace {
        let character = self.framing.character(self.baud);
        let kind = if self.strict { Pace::strict } else { Pace::free };
        kind(character, latency, self.overrun_limit, self.window)
    }
}

/// Milliseconds, or `"auto"`.
fn latency(link: &Section<'_>) -> Result<Option<Option<Duration>>, KeyError> {
    if let Ok(Some(word)) = link.text("receive_latency_ms") {
        return match word {
            "auto" => Ok(Some(None)),
            _ => Err(link.error(
                "receive_latency_ms",
                "`receive_latency_ms` must be milliseconds or \"auto\"",
                None,
            )),
        };
    }
    match link.number("receive_latency_ms")? {
        Some(ms) if (0.0..=1000.0).contains(&ms) => Ok(Some(Some(Duration::from_secs_f64(ms / 1000.0)))),
        Some(_) => Err(link.error("receive_latency_ms", "`receive_latency_ms` must be from 0 to 1000", None)),
        None => Ok(None),
    }
}

/// A positive number up to a limit.
fn within(section: &Section<'_>, key: &'static str, most: f64) -> Result<Option<f64>, KeyError> {
    match section.number(key)? {
        Some(value) if value > 0.0 && value <= most => Ok(Some(value)),
        Some(_) => Err(section.error(key, format!("`{key}` must be more than 0 and at most {most}"), None)),
        None => Ok(None),
    }
}

/// Every key of a profile with its section.
const KEYS: [(&str, &str); 33] = [
    ("machine", "name"),
    ("link", "baud"),
    ("link", "framing"),
    ("link", "receive_latency_ms"),
    ("protocol", "start"),
    ("protocol", "start_timeout_s"),
    ("protocol", "pacing"),
    ("protocol", "overrun_limit"),
    ("protocol", "window"),
    ("tape", "code"),
    ("tape", "end_of_block"),
    ("tape", "leader"),
    ("tape", "trailer"),
    ("control", "buffer_bytes"),
    ("control", "dialect"),
    ("gcode", "decimals"),
    ("gcode", "decimals_inch"),
    ("gcode", "point"),
    ("gcode", "trailing_zeros"),
    ("gcode", "leading_zero"),
    ("gcode", "blanks"),
    ("gcode", "comments"),
    ("gcode", "n_numbers"),
    ("gcode", "n_step"),
    ("gcode", "n_last"),
    ("gcode", "line_max"),
    ("macros", "numbers"),
    ("macros", "control"),
    ("macros", "without_point"),
    ("macros", "semicolon"),
    ("travel", "x_mm"),
    ("travel", "y_mm"),
    ("taper", "max_degrees"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::macros::form::Numbering;

    #[test]
    fn the_generic_profile_states_every_key() {
        let file = Profile::parse(GENERIC_ISO).unwrap();
        assert_eq!((file.assumed, file.assumed_of_macros), (Vec::<&str>::new(), Vec::new()));
        assert_eq!((file.profile.baud, file.profile.framing.bits()), (4800, 11));
        assert_eq!(file.profile.tape.leader().unwrap(), b"%\n");
    }

    #[test]
    fn a_profile_says_what_it_leaves_to_the_generic_one() {
        let file = Profile::parse("[link]\nbaud = 9600\n").unwrap();
        assert_eq!(file.profile.baud, 9600);
        assert!(file.assumed.contains(&"framing") && !file.assumed.contains(&"baud"));
    }

    #[test]
    fn what_a_machine_can_do_is_known_only_where_it_is_said() {
        let file = Profile::parse("[travel]\nx_mm = 350\n[taper]\nmax_degrees = 3.5\n").unwrap();
        assert_eq!(file.profile.travel, Travel { x: Some(350.0), y: None });
        assert_eq!(file.profile.taper_max_degrees, Some(3.5));
        assert_eq!(Profile::generic_iso().unwrap().travel, Travel::default());
    }

    #[test]
    fn impossible_pairs_and_values_are_refused() {
        for text in [
            "[tape]\ncode = \"iso\"\n",
            "[link]\nbaud = 1\n",
            "[link]\nframing = \"9X1\"\n",
            "[protocol]\nname = \"morse\"\n",
            "[protocol]\nwindow = 99\n",
            "[tape]\nleader = \"?\"\n",
            "[prtocol]\n",
            "[travel]\nx_mm = 0\n",
            "[travel]\nz_mm = 100\n",
            "[taper]\nmax_degrees = 91\n",
        ] {
            assert!(Profile::parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn a_value_can_be_set_by_name() {
        let mut profile = Profile::generic_iso().unwrap();
        profile.set("pacing", "strict").unwrap();
        profile.set("link.baud", "9600").unwrap();
        assert!(profile.strict && profile.baud == 9600);
        profile.set("framing", "7E1").unwrap();
        profile.set("leader", "\"\"").unwrap();
        assert_eq!((profile.framing.stop_bits, profile.tape.leader.as_str()), (1, ""));
        profile.set("n_numbers", "count").unwrap();
        profile.set("n_step", "5").unwrap();
        profile.set("comments", "false").unwrap();
        assert_eq!(profile.form.numbers, Numbering::Count { step: 5, last: 9999 });
        assert!(!profile.form.remarks);
        assert!(Profile::generic_iso().unwrap().set("n_step", "5").is_err(), "nothing is counted");
        assert!(profile.set("n_last", "4").is_err(), "below the step");
        assert!(profile.set("bawd", "1").unwrap_err().help.unwrap().contains("baud"));
        assert!(profile.set("tape.baud", "1").is_err());
    }
}
