//! The command line of `mock-controller`: words in, a job out. Nothing is opened here.

mod talk;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, CommandFactory as _, Parser, ValueEnum, error::ErrorKind};
use mock_controller::{
    ArcCentre, Dialect as Written, FaultKind, Framing, GcodeSettings, IgnoredWords, LabelSkip, Model, Pace,
    Register, Settings, Start, Taper, Torn, UnitWithoutPoint, Until,
};

pub(crate) use talk::CodeWord;
use talk::Talk;

/// A wire-EDM control to feed: receives 3B, 4B or G-code over a paced line, cuts it pulse by pulse, reports where it stood.
///
/// The first line on standard output is `ready` and where to connect. Exit codes: 0 done, 1 a failure of its own or the
/// system's, 2 wrong usage, 6 the control raised an alarm.
#[derive(Debug, Parser)]
#[command(version)]
pub(crate) struct Words {
    #[command(flatten)]
    place: Place,

    /// A file of these options, one `key = value` a line, keys without the dashes; the command line goes before it.
    #[arg(long, value_name = "FILE")]
    machine: Option<PathBuf>,

    #[command(flatten)]
    talk: Talk,

    /// Bits a second of the line [default: 9600].
    #[arg(long, value_name = "N", conflicts_with = "unpaced", value_parser = clap::value_parser!(u32).range(1..))]
    baud: Option<u32>,

    /// Characters take no time. During a hold nothing travels.
    #[arg(long)]
    unpaced: bool,

    /// Data bits, parity, stop bits: what a character's bits are, the start bit on top.
    #[arg(long, default_value = "7E2")]
    framing: Framing,

    /// What the programs are written in.
    #[arg(long, value_enum, default_value = "3b")]
    dialect: Dialect,

    /// The offset the control holds, mm. 4B: + wire outside (punch), - inside (die). G-code: the offset of G41 and G42
    /// without a number, and of every number but 0 if there are no registers; not negative.
    #[arg(long, value_name = "MM", default_value_t = 0.0, allow_negative_numbers = true)]
    wire_offset: f64,

    /// G-code: an offset keyed in by number, mm, not negative: `D1=0.127`, `H2=0.11`. May be repeated; then D and H with
    /// other numbers are the alarm `offset`.
    #[arg(long = "offset-register", value_name = "D1=MM", value_parser = register)]
    offset_registers: Vec<(Register, f64)>,

    /// 4B: the taper keyed in, degrees; the lead-in's flag declares its sense. An upper guide is cut as well.
    #[arg(long, value_name = "DEG")]
    taper: Option<f64>,

    /// H2, from the plane of the program to the upper guide, mm.
    #[arg(long, value_name = "MM", default_value_t = 100.0, requires = "taper")]
    taper_height: f64,

    /// G-code: what I and J are counted from.
    #[arg(long, value_enum, default_value = "incremental")]
    arc_centre: Centre,

    /// G-code: what a length without a point means, `um` being the least unit (0.001 mm, 0.0001 inch), `mm` the whole one
    /// (mm, inch); `error` is the alarm `number`.
    #[arg(long, value_enum, default_value = "error")]
    unit_without_point: Unit,

    /// G-code: pass over lines that begin with `/`.
    #[arg(long)]
    block_skip: bool,

    /// G-code: words to pass over, and to count: letters, words and ranges. Any other word that is not acted on is the
    /// alarm `word` [default: C,E,S,H,T,P,F,M03-M29,M31-M97].
    #[arg(long, value_name = "LIST")]
    ignore_words: Option<IgnoredWords>,

    /// How lines and arcs become pulses; unverified for any control.
    #[arg(long, value_enum, default_value = "rotated")]
    interpolator: Interpolator,

    /// Characters the input buffer holds: at least xoff-at, the overrun limit, and one.
    #[arg(long, value_name = "BYTES", default_value_t = Settings::default().buffer_bytes)]
    buffer: usize,

    /// The fill at which DC3 is sent.
    #[arg(long, value_name = "BYTES", default_value_t = Settings::default().xoff_at)]
    xoff_at: usize,

    /// The fill at which DC1 is sent again.
    #[arg(long, value_name = "BYTES", default_value_t = Settings::default().xon_at)]
    xon_at: usize,

    /// Characters allowed after DC3; one more is the alarm `overrun`.
    #[arg(long, value_name = "N", default_value_t = Settings::default().overrun_limit)]
    overrun_limit: u64,

    /// Send DC3, NAK and SYN with even parity in bit 8: 0x93, 0x95, 0x96.
    #[arg(long)]
    dc3_parity: bool,

    /// How late what the control sends reaches the sender's program, ms.
    #[arg(long, value_name = "MS", default_value_t = 0.0, value_parser = milliseconds)]
    latency: f64,

    /// How long a block takes to cut, as a multiple of the time its characters take on the line [default: 1.25].
    #[arg(long, value_name = "RATIO", conflicts_with = "unpaced")]
    cutting_time: Option<f64>,

    /// How long after the link opens the first DC1 is sent, in seconds, or `never`.
    #[arg(long, value_name = "S|never", default_value = "0", value_parser = start)]
    start_delay: Start,

    /// What becomes of an unfinished block when the link closes.
    #[arg(long, value_enum, default_value = "drop")]
    torn: TornWord,

    /// What is done with the text before the first end of block: `auto` discards it unless it is a block.
    #[arg(long, value_enum, default_value = "auto")]
    label_skip: LabelSkipWord,

    /// Raise the alarm `nak` (DC3, NAK) when block N is about to be cut.
    #[arg(long, value_name = "N")]
    alarm_at_block: Option<u64>,

    /// Reset (DC3, SYN), once, when block N is about to be cut.
    #[arg(long, value_name = "N")]
    reset_at_block: Option<u64>,

    /// A fault and its probability, 0 to 1: per character (flip drop double insert parity echo disconnect dsr-drop), per DC1
    /// or other answer
    /// (xon-lost xon-late xon-double), per DC3 or NAK (xoff-lost), per block (stall slow reset alarm nak-storm). May be repeated.
    #[arg(long = "fault", value_name = "KIND=RATE", value_parser = fault)]
    faults: Vec<(FaultKind, f64)>,

    /// The seed of the faults' dice.
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,

    /// Leave after a program's end.
    #[arg(long)]
    once: bool,

    /// Where the report goes at the end, as JSON.
    #[arg(long, value_name = "FILE.json")]
    report: Option<PathBuf>,

    /// Where the report goes every 0.2 s.
    #[arg(long, value_name = "FILE.json")]
    status: Option<PathBuf>,

    /// Where every pulse goes: t_s,block,x_um,y_um.
    #[arg(long, value_name = "FILE.csv")]
    trace: Option<PathBuf>,

    /// Where a picture of the wire's path goes at the end.
    #[arg(long, value_name = "FILE.svg")]
    picture: Option<PathBuf>,

    /// Where the decoded program text goes.
    #[arg(long, value_name = "FILE")]
    save: Option<PathBuf>,
}

#[derive(Args, Debug)]
#[group(required = true, multiple = false)]
struct Place {
    /// A new pseudo-terminal, with a symbolic link to it.
    #[arg(long, value_name = "LINK")]
    pty: Option<PathBuf>,

    /// A listening socket; port 0 picks one.
    #[arg(long, value_name = "HOST:PORT")]
    tcp: Option<String>,

    /// A serial device.
    #[arg(long, value_name = "DEVICE")]
    port: Option<String>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Dialect {
    /// B X B Y B J G Z.
    #[value(name = "3b")]
    ThreeB,
    /// B X B Y B J B R D|DD G Z among 3B blocks: the outline; the control holds the offset.
    #[value(name = "4b")]
    FourB,
    /// Lines of words, absolute or incremental; G41 and G42 put the wire beside the path.
    Gcode,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Centre {
    Incremental,
    Absolute,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Unit {
    Um,
    Mm,
    Error,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Interpolator {
    Rotated,
    Mirrored,
    Strict,
    Exact,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum TornWord {
    Drop,
    Keep,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum LabelSkipWord {
    Auto,
    On,
    Off,
}

/// What is to be done.
#[derive(Debug)]
pub(crate) struct Job {
    pub(crate) place: At,
    pub(crate) settings: Settings,
    pub(crate) code: CodeWord,
    pub(crate) baud: u32,
    pub(crate) framing: Framing,
    pub(crate) report: Option<PathBuf>,
    pub(crate) status: Option<PathBuf>,
    pub(crate) trace: Option<PathBuf>,
    pub(crate) picture: Option<PathBuf>,
    pub(crate) save: Option<PathBuf>,
}

/// Where the sender comes in.
#[derive(Debug)]
pub(crate) enum At {
    Pty(PathBuf),
    Tcp(String),
    Serial(String),
}

impl Words {
    /// The job, or the usage error.
    pub(crate) fn job(self) -> Result<Job, clap::Error> {
        let place = match (self.place.pty, self.place.tcp, self.place.port) {
            (Some(link), _, _) => At::Pty(link),
            (None, Some(address), _) => At::Tcp(address),
            (None, None, Some(device)) => At::Serial(device),
            (None, None, None) => return Err(wrong("one of --pty, --tcp and --port is needed")),
        };
        let baud = self.baud.unwrap_or(9600);
        let pace = if self.unpaced { Pace::Unpaced } else { Pace::Paced { baud, framing: self.framing } };
        let mut faults = BTreeMap::new();
        for (kind, rate) in self.faults {
            if faults.insert(kind, rate).is_some() {
                return Err(wrong(&format!("fault {kind} is given twice")));
            }
        }
        let mut offset_registers = BTreeMap::new();
        for (register, offset) in self.offset_registers {
            if offset_registers.insert(register, micrometres(offset)).is_some() {
                return Err(wrong(&format!("offset register {register} is given twice")));
            }
        }
        if matches!(place, At::Serial(_)) && faults.contains_key(&FaultKind::Disconnect) {
            return Err(wrong("fault disconnect: a real cable cannot be pulled from here"));
        }
        let settings = Settings {
            pace,
            protocol: self.talk.protocol().map_err(|error| wrong(&error))?,
            tv_check: self.talk.checks_tv(),
            handshake: self.talk.handshake(&place),
            dialect: match self.dialect {
                Dialect::ThreeB => Written::ThreeB,
                Dialect::FourB => Written::FourB,
                Dialect::Gcode => Written::Gcode,
            },
            wire_offset_um: micrometres(self.wire_offset),
            taper: self.taper.map(|degrees| Taper { degrees, height_um: self.taper_height * 1000.0 }),
            gcode: GcodeSettings {
                arc_centre: match self.arc_centre {
                    Centre::Incremental => ArcCentre::Incremental,
                    Centre::Absolute => ArcCentre::Absolute,
                },
                unit_without_point: match self.unit_without_point {
                    Unit::Um => UnitWithoutPoint::Least,
                    Unit::Mm => UnitWithoutPoint::Whole,
                    Unit::Error => UnitWithoutPoint::Error,
                },
                block_skip: self.block_skip,
                ignored_words: self.ignore_words.unwrap_or_default(),
                offset_registers,
            },
            interpolator: match self.interpolator {
                Interpolator::Rotated => Model::Rotated,
                Interpolator::Mirrored => Model::Mirrored,
                Interpolator::Strict => Model::Strict,
                Interpolator::Exact => Model::Exact,
            },
            buffer_bytes: self.buffer,
            xoff_at: self.xoff_at,
            xon_at: self.xon_at,
            overrun_limit: self.overrun_limit,
            dc3_parity: self.dc3_parity,
            latency: Duration::from_secs_f64(self.latency / 1000.0),
            torn: match self.torn {
                TornWord::Drop => Torn::Drop,
                TornWord::Keep => Torn::Keep,
            },
            label_skip: match self.label_skip {
                LabelSkipWord::Auto => LabelSkip::Auto,
                LabelSkipWord::On => LabelSkip::On,
                LabelSkipWord::Off => LabelSkip::Off,
            },
            start: self.start_delay,
            cutting_time: match self.cutting_time {
                Some(ratio) => ratio,
                None if self.unpaced => 0.0,
                None => Settings::default().cutting_time,
            },
            alarm_at_block: self.alarm_at_block,
            reset_at_block: self.reset_at_block,
            faults,
            seed: self.seed,
            until: if self.once { Until::ProgramEnd } else { Until::Stopped },
            ..Settings::default()
        };
        settings.validate().map_err(|error| wrong(&error.to_string()))?;
        Ok(Job {
            place,
            settings,
            code: self.talk.code(),
            baud,
            framing: self.framing,
            report: self.report,
            status: self.status,
            trace: self.trace,
            picture: self.picture,
            save: self.save,
        })
    }
}

fn wrong(message: &str) -> clap::Error {
    Words::command().error(ErrorKind::ValueValidation, message)
}

fn fault(word: &str) -> Result<(FaultKind, f64), String> {
    let (kind, rate) = word.split_once('=').ok_or("expected KIND=RATE")?;
    let kind = kind.parse::<FaultKind>().map_err(|error| error.to_string())?;
    let rate = rate.parse::<f64>().map_err(|_| "the rate is no number")?;
    if (0.0..=1.0).contains(&rate) {
        Ok((kind, rate))
    } else {
        Err("the rate is not between 0 and 1".to_owned())
    }
}

fn register(word: &str) -> Result<(Register, f64), String> {
    let (register, offset) = word.split_once('=').ok_or("expected D1=MM or H1=MM")?;
    let register = register.trim().parse::<Register>().map_err(|error| error.to_string())?;
    let offset = offset.trim().parse::<f64>().map_err(|_| "the offset is no number of mm")?;
    Ok((register, offset))
}

/// A decimal number of mm is no whole number of binary µm: 0.07 must be 70.
fn micrometres(length_mm: f64) -> f64 {
    (length_mm * 1e6).round() / 1e3
}

fn start(word: &str) -> Result<Start, String> {
    if word == "never" {
        return Ok(Start::Never);
    }
    let seconds = word.parse::<f64>().map_err(|_| "expected seconds or never")?;
    if !(0.0..=86_400.0).contains(&seconds) {
        return Err("not between 0 and 86400 s".to_owned());
    }
    Ok(Start::After(Duration::from_secs_f64(seconds)))
}

fn milliseconds(word: &str) -> Result<f64, String> {
    let latency = word.parse::<f64>().map_err(|_| "expected milliseconds")?;
    if (0.0..=60_000.0).contains(&latency) {
        Ok(latency)
    } else {
        Err("not between 0 and 60000 ms".to_owned())
    }
}
