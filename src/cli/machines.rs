//! `dripfeed machines [show NAME] [check FILE]`: the machine profiles.
//!
//! A profile is a TOML file; every value of a built-in one has its source beside it.

use clap::{Args, Subcommand};

use super::failure::{Exit, Failure};
use super::{print, print_json};
use crate::profile::{BUILT_IN, Profile, ProfileFile};

/// List, show and check machine profiles
#[derive(Args, Debug)]
pub(super) struct Options {
    #[command(subcommand)]
    action: Option<Action>,
    /// Print as JSON
    #[arg(long, global = true)]
    json: bool,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Print a profile with the source of every value
    Show {
        /// A built-in profile, or a file
        name: String,
    },
    /// Check a profile file
    Check {
        /// A built-in profile, or a file
        name: String,
    },
}

pub(super) fn run(options: &Options) -> Result<(), Failure> {
    match &options.action {
        None => list(options.json),
        Some(Action::Show { name }) => {
            let text = text(name)?;
            parse(name, &text)?;
            print(text.as_bytes())
        }
        Some(Action::Check { name }) => {
            let file = parse(name, &text(name)?)?;
            if options.json {
                return print_json(&summary(&file.profile));
            }
            let keys = [file.assumed, file.assumed_of_macros].concat();
            let assumed = match keys.as_slice() {
                [] => String::new(),
                keys => format!("; taken from generic-iso: {}", keys.join(", ")),
            };
            print(format!("{name}: in order{assumed}\n").as_bytes())
        }
    }
}

fn list(json: bool) -> Result<(), Failure> {
    let mut profiles = Vec::new();
    for (name, text) in BUILT_IN {
        profiles.push(parse(name, text)?.profile);
    }
    if json {
        return print_json(&profiles.iter().map(summary).collect());
    }
    let mut lines = String::new();
    for profile in profiles {
        lines
            .push_str(&format!("{:16} dc-codes, {} baud, {}\n", profile.name, profile.baud, profile.framing));
    }
    lines.push_str("`dripfeed machines show NAME` prints one with the source of every value\n");
    print(lines.as_bytes())
}

fn summary(profile: &Profile) -> serde_json::Value {
    serde_json::json!({
        "name": profile.name,
        "protocol": "dc-codes",
        "baud": profile.baud,
        "framing": profile.framing.to_string(),
        "overrun_limit": profile.overrun_limit,
        "pacing": if profile.strict { "strict" } else { "free" },
    })
}

/// The text of a profile by name or file.
fn text(name: &str) -> Result<String, Failure> {
    if let Some((_, text)) = BUILT_IN.iter().find(|(built_in, _)| *built_in == name) {
        return Ok((*text).to_owned());
    }
    std::fs::read_to_string(name).map_err(|error| {
        let known: Vec<&str> = BUILT_IN.iter().map(|(name, _)| *name).collect();
        Failure::new(
            Exit::Profile,
            format!("{name} is neither a built-in profile nor a readable file: {error}"),
        )
        .help(format!("built in: {}", known.join(", ")))
    })
}

fn parse(name: &str, text: &str) -> Result<ProfileFile, Failure> {
    Profile::parse(text).map_err(|error| Failure::keys(Exit::Profile, name, error))
}

/// A profile by name or file, with what it leaves to the generic one.
pub(super) fn load(name: &str) -> Result<ProfileFile, Failure> {
    parse(name, &text(name)?)
}
