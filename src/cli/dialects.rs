//! G-code dialects as they are named on the command line: built in, or a file.

use std::path::Path;

use super::failure::{Exit, Failure};
use crate::formats::gcode::Dialect;
use crate::formats::gcode::dialect::BUILT_IN;

/// The dialect of a name. When none is named it is the generic one, and what is done in it is told.
pub(super) fn load(name: Option<&str>, done: &str) -> Result<Dialect, Failure> {
    let name = name.unwrap_or_else(|| {
        say!("G-code is {done} in the dialect generic, for want of another");
        "generic"
    });
    if let Some(dialect) = Dialect::named(name) {
        return dialect.map_err(|error| Failure::keys(Exit::Ours, name, error));
    }
    if !name.contains(['.', '/', '\\']) && !Path::new(name).exists() {
        let known = BUILT_IN.map(|(name, _)| name);
        let help = crate::keys::nearest(name, &known).unwrap_or_default();
        return Err(Failure::new(Exit::Usage, format!("there is no dialect `{name}`")).help(help));
    }
    let text = std::fs::read_to_string(name).map_err(|error| {
        let known = BUILT_IN.map(|(name, _)| name).join(", ");
        Failure::new(Exit::Profile, format!("cannot read {name}: {error}"))
            .help(format!("name a dialect file, or one of {known}"))
    })?;
    Dialect::parse(&text).map_err(|error| Failure::keys(Exit::Profile, name, error))
}
