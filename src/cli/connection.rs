//! Where a job goes and how: the options of the line, the machine's profile, the pacing, the open port.

use std::time::Duration;

use clap::Args;

use super::failure::{Exit, Failure};
use super::machines;
use crate::link::serial::{Latency, SerialLink};
use crate::link::tcp::TcpLink;
use crate::link::{Link, Port};
use crate::profile::{Framing, Profile};
use crate::protocol::pacing::Pace;

/// Options of the line; what they change of the machine's profile.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Line")]
pub(super) struct LineOptions {
    /// Protocol, instead of the profile's
    #[arg(long, value_parser = ["dc-codes"])]
    pub(super) protocol: Option<String>,
    /// Speed of the line, instead of the profile's; over TCP it turns pacing on
    #[arg(long, value_name = "N", conflicts_with = "unpaced")]
    pub(super) baud: Option<u32>,
    /// Do not pace a pseudo-terminal: hand over what it takes
    #[arg(long)]
    pub(super) unpaced: bool,
    /// Data bits, parity, stop bits, such as 7E2, instead of the profile's
    #[arg(long, value_name = "7E2")]
    pub(super) framing: Option<String>,
    /// Any other value of the profile
    #[arg(long, value_name = "KEY=VALUE")]
    pub(super) set: Vec<String>,
}

impl LineOptions {
    /// As words, to be written down and read back.
    pub(super) fn words(&self) -> Vec<String> {
        let mut words = Vec::new();
        words.extend(self.protocol.iter().map(|v| format!("protocol={v}")));
        words.extend(self.baud.iter().map(|v| format!("baud={v}")));
        words.extend(self.unpaced.then(|| "unpaced".to_owned()));
        words.extend(self.framing.iter().map(|v| format!("framing={v}")));
        words.extend(self.set.iter().map(|v| format!("set {v}")));
        words
    }

    /// As options of a command line.
    pub(super) fn options(&self) -> Vec<(&'static str, String)> {
        let mut options = Vec::new();
        options.extend(self.protocol.iter().map(|v| ("--protocol", v.clone())));
        options.extend(self.baud.iter().map(|v| ("--baud", v.to_string())));
        options.extend(self.framing.iter().map(|v| ("--framing", v.clone())));
        options.extend(self.set.iter().map(|v| ("--set", v.clone())));
        options
    }

    /// From words written down, what is given here winning over them.
    pub(super) fn or(mut self, words: &[String]) -> Self {
        let mut set = Vec::new();
        for word in words {
            match word.split_once('=') {
                Some(("protocol", value)) => self.protocol = self.protocol.or_else(|| Some(value.to_owned())),
                Some(("baud", value)) if !self.unpaced => {
                    self.baud = self.baud.or_else(|| value.parse().ok())
                }
                Some(("framing", value)) => self.framing = self.framing.or_else(|| Some(value.to_owned())),
                _ if word == "unpaced" => self.unpaced |= self.baud.is_none(),
                _ => set.extend(word.strip_prefix("set ").map(str::to_owned)),
            }
        }
        set.append(&mut self.set);
        Self { set, ..self }
    }
}

/// A machine's profile with everything the command line changes, and what the file left to `generic-iso`.
pub(super) fn resolve(machine: &str, line: &LineOptions) -> Result<(Profile, Vec<&'static str>), Failure> {
    let file = machines::load(machine)?;
    let mut profile = file.profile;
    for pair in &line.set {
        let Some((key, value)) = pair.split_once('=') else {
            return Err(Failure::new(Exit::Usage, format!("--set {pair} is not KEY=VALUE")).help(
                "for example --set pacing=strict; `dripfeed machines show generic-iso` lists the keys",
            ));
        };
        let name = key.trim().rsplit('.').next().unwrap_or_default();
        if (name == "baud" && line.baud.is_some()) || (name == "framing" && line.framing.is_some()) {
            return Err(Failure::new(
                Exit::Usage,
                format!("--{name} and --set {pair} say the same thing twice"),
            ));
        }
        set(&mut profile, key.trim(), value.trim(), "--set")?;
    }
    if let Some(baud) = line.baud {
        set(&mut profile, "baud", &baud.to_string(), "--baud")?;
    }
    if let Some(framing) = &line.framing {
        if Framing::parse(framing).is_none() {
            return Err(Failure::new(
                Exit::Usage,
                format!("--framing {framing} is not data bits 5-8, parity N, E or O, and stop bits 1 or 2"),
            )
            .help("typical is --framing 7E2"));
        }
        set(&mut profile, "framing", framing, "--framing")?;
    }
    Ok((profile, file.assumed))
}

/// As [`resolve`], for a macro program: says how it is run and spelled where nobody has.
pub(super) fn of_macros(machine: Option<&str>, line: &LineOptions) -> Result<Profile, Failure> {
    let Some(name) = machine else {
        say!("macros are run and blocks spelled as generic-iso has them, for want of a machine");
        return Ok(resolve("generic-iso", line)?.0);
    };
    let assumed = machines::load(name)?.assumed_of_macros;
    if !assumed.is_empty() {
        say!("{name}: of macro programs not given, taken from generic-iso: {}", assumed.join(", "));
    }
    Ok(resolve(name, line)?.0)
}

/// As [`resolve`], and says what was not stated: the whole of `generic-iso` when no machine is named.
pub(super) fn profile(machine: Option<&str>, line: &LineOptions) -> Result<Profile, Failure> {
    let name = machine.unwrap_or("generic-iso");
    let (profile, assumed) = resolve(name, line)?;
    if machine.is_none() {
        say!("no --machine is named; feeding as generic-iso:\n\n{}", crate::profile::GENERIC_ISO);
    } else if !assumed.is_empty() {
        say!("{name}: not given, taken from generic-iso: {}", assumed.join(", "));
    }
    Ok(profile)
}

fn set(profile: &mut Profile, key: &str, value: &str, option: &str) -> Result<(), Failure> {
    profile.set(key, value).map_err(|error| {
        let failure = Failure::new(Exit::Usage, format!("{option}: {error}"));
        match error.help {
            Some(help) => failure.help(help),
            None => failure,
        }
    })
}

/// Where a job goes and how the line is paced.
#[derive(Debug)]
pub(super) struct Connection {
    pub(super) port: Port,
    pub(super) profile: Profile,
    pub(super) pace: Pace,
}

impl Connection {
    /// Works out the pacing and says what it means, before the port is opened.
    pub(super) fn plan(port: Port, profile: Profile, options: &LineOptions) -> Self {
        let (paced, latency, source) = match (&port, profile.receive_latency) {
            (Port::Tcp(_), Some(latency)) => (options.baud.is_some(), latency, "from the profile"),
            (Port::Tcp(_), None) => (options.baud.is_some(), Duration::ZERO, "the network's is not known"),
            (Port::Serial(_), Some(latency)) => (!options.unpaced, latency, "from the profile"),
            (Port::Serial(device), None) => match Latency::of(device) {
                Latency::Nothing => (!options.unpaced, Duration::ZERO, "a pseudo-terminal adds none"),
                Latency::Adapter(latency) => {
                    (!options.unpaced, latency, "the adapter's latency timer and 1 ms")
                }
                Latency::Assumed(latency) => {
                    (!options.unpaced, latency, "ASSUMED: the adapter does not say; set receive_latency_ms")
                }
            },
        };
        let pace = if paced { profile.pace(latency) } else { Pace::unpaced() };
        let line = Self { port, profile, pace };
        line.say(source);
        line
    }

    fn say(&self, latency_source: &str) {
        let Profile { baud, framing, overrun_limit, .. } = self.profile;
        let Some(_) = self.pace.character else {
            say!("{}: not paced; bytes under way when the control says stop cannot be recalled", self.port);
            return;
        };
        let worst = self.pace.worst_overrun();
        let latency = self.pace.latency.as_secs_f64() * 1e3;
        say!("{}: {baud} baud {framing}, window {} bytes", self.port, self.pace.window);
        say!("receive latency {latency:.1} ms, {latency_source}");
        let spare =
            self.pace.character.unwrap_or_default() * overrun_limit.saturating_sub(self.pace.window) as u32;
        if self.pace.gaps.is_none() && worst <= overrun_limit && spare < SPARE {
            say!(
                "warning: the control's {overrun_limit} characters take {:.1} ms here; this system may be later than that to hear DC3, and no setting prevents it but a lower baud",
                self.pace.character.unwrap_or_default().as_secs_f64() * 1e3 * overrun_limit as f64
            );
        }
        if self.pace.gaps.is_some() {
            say!(
                "strict pacing: at most {worst} characters after DC3, by listening gaps; at most {:.0} % of the line's time is used",
                100.0 * self.pace.best_utilisation()
            );
        } else if worst > overrun_limit {
            say!(
                "warning: up to {worst} characters may follow the control's DC3, and it allows {overrun_limit}; lower the adapter's latency timer, the baud, or keep the rule with --set pacing=strict"
            );
        }
    }

    /// Opens the port.
    pub(super) fn open(&self) -> Result<Box<dyn Link>, Failure> {
        Ok(match &self.port {
            Port::Serial(device) => Box::new(
                SerialLink::open(device, self.profile.baud, self.profile.framing)
                    .map_err(|error| Failure::link(&error))?,
            ),
            Port::Tcp(address) => Box::new(TcpLink::open(address).map_err(|error| Failure::link(&error))?),
        })
    }
}

/// The profile's values in one digest, so that a changed profile is noticed.
pub(super) fn profile_digest(profile: &Profile) -> String {
    blake3::hash(format!("{profile:?}").as_bytes()).to_hex().to_string()
}

/// Below this much time between DC3 and the alarm, a system that is not real-time may well be too late. A guess.
const SPARE: Duration = Duration::from_millis(2);
