//! Leads, tabs and passes as they are spelled on a command line.

use std::str::FromStr;

use thiserror::Error;

use super::{Distance, Lead, Pass, Skim, Tab, Tabs, Way};
use crate::motion::Text;

/// A spelling that is none.
#[derive(Clone, Debug, Eq, Error, PartialEq)]
#[error("`{found}` is not {what}")]
pub struct Misspelt {
    /// What stands there.
    pub found: String,
    /// What was expected.
    pub what: &'static str,
    /// How it is spelled.
    pub help: &'static str,
}

impl FromStr for Lead {
    type Err = Misspelt;

    /// `direct`, `straight:2` (mm) or `arc:1.5:90` (mm and degrees).
    fn from_str(text: &str) -> Result<Self, Misspelt> {
        let parts: Vec<&str> = text.split(':').collect();
        let lead = match parts.as_slice() {
            ["direct"] => Some(Self::Direct),
            ["straight", length] => number(length).map(|length| Self::Straight { length }),
            ["arc", radius, sweep] => {
                number(radius).zip(number(sweep)).map(|(radius, sweep)| Self::Arc { radius, sweep })
            }
            _ => None,
        };
        lead.ok_or_else(|| misspelt(text, "a lead", LEAD))
    }
}

impl FromStr for Tabs {
    type Err = Misspelt;

    /// `none`, `2:1.5` (how many, and the length of each in mm), or `@18.5+1.5,@38.5+1.5` (where each begins along the
    /// contour and its length, mm).
    fn from_str(text: &str) -> Result<Self, Misspelt> {
        let wrong = || misspelt(text, "a number of tabs and their length", TABS);
        if text == "none" {
            return Ok(Self::None);
        }
        if text.starts_with('@') {
            let tab = |part: &str| {
                let (from, length) = part.strip_prefix('@')?.split_once('+')?;
                Some(Tab { from: number(from)?, length: number(length)? })
            };
            return text.split(',').map(tab).collect::<Option<_>>().map(Self::At).ok_or_else(wrong);
        }
        let (count, length) = text.split_once(':').ok_or_else(wrong)?;
        let count = count.parse().map_err(|_| wrong())?;
        Ok(Self::Even { count, length: number(length).ok_or_else(wrong)? })
    }
}

/// The passes of a command line: `0.15=E2501,0.13:back=E2502,0.125:again=E2503+S1`.
///
/// Each is an offset in mm, for all but the first the direction, and behind an equals sign the condition words, joined by
/// plus signs.
///
/// # Errors
///
/// When it is spelled otherwise.
pub fn passes(text: &str) -> Result<(Pass, Vec<Skim>), Misspelt> {
    let wrong = || misspelt(text, "a list of passes", PASSES);
    let mut skims = Vec::new();
    let mut rough = None;
    for part in text.split(',') {
        let (run, words) = part.split_once('=').map_or((part, None), |(run, words)| (run, Some(words)));
        let (offset, way) = run.split_once(':').map_or((run, None), |(offset, way)| (offset, Some(way)));
        let distance = Distance::Offset(number(offset).ok_or_else(wrong)?);
        let words: Vec<Text> = words
            .map_or_else(Vec::new, |words| words.split('+').map(|word| word.as_bytes().into()).collect());
        if words.iter().any(|word| word.is_empty()) {
            return Err(wrong());
        }
        let pass = Pass { distance, words };
        match (&rough, way) {
            (None, None) => rough = Some(pass),
            (Some(_), Some("back")) => skims.push(Skim { pass, way: Way::Back }),
            (Some(_), Some("again")) => skims.push(Skim { pass, way: Way::Again }),
            _ => return Err(wrong()),
        }
    }
    rough.map(|rough| (rough, skims)).ok_or_else(wrong)
}

fn number(text: &str) -> Option<f64> {
    let plain = !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit() || b == b'.');
    text.parse().ok().filter(|_| plain)
}

fn misspelt(found: &str, what: &'static str, help: &'static str) -> Misspelt {
    Misspelt { found: found.to_owned(), what, help }
}

const LEAD: &str = "write direct, straight:LENGTH (mm) or arc:RADIUS:SWEEP (mm and degrees)";
const TABS: &str = "write none, COUNT:LENGTH (mm) or @FROM+LENGTH,@FROM+LENGTH (mm along the contour)";
const PASSES: &str =
    "write OFFSET=WORDS,OFFSET:back=WORDS,OFFSET:again=WORDS (mm; words joined by +, or left out)";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leads_and_tabs_are_read_as_they_are_told() {
        assert_eq!("direct".parse(), Ok(Lead::Direct));
        assert_eq!("straight:2".parse(), Ok(Lead::Straight { length: 2.0 }));
        assert_eq!("arc:1.5:90".parse(), Ok(Lead::Arc { radius: 1.5, sweep: 90.0 }));
        assert_eq!("none".parse(), Ok(Tabs::None));
        assert_eq!("2:1.5".parse(), Ok(Tabs::Even { count: 2, length: 1.5 }));
        let at = Tabs::At(vec![Tab { from: 18.5, length: 1.5 }, Tab { from: 38.5, length: 2.0 }]);
        assert_eq!("@18.5+1.5,@38.5+2".parse(), Ok(at));
    }

    #[test]
    fn passes_have_offsets_directions_and_words() {
        let (rough, skims) = passes("0.15=E2501,0.13:back=E2502+S1,0.125:again").unwrap();
        assert_eq!(rough.distance, Distance::Offset(0.15));
        assert_eq!(rough.words, [b"E2501"[..].into()]);
        assert_eq!((skims[0].way, skims[0].pass.words.len()), (Way::Back, 2));
        assert_eq!((skims[1].way, skims[1].pass.words.len()), (Way::Again, 0));
    }

    #[test]
    fn other_spellings_are_refused_with_what_is_right() {
        for wrong in
            ["", "straight", "straight:", "straight:-1", "straight:1e3", "arc:1", "arc:1:2:3", "Direct"]
        {
            let error = wrong.parse::<Lead>().unwrap_err();
            assert_eq!((error.found.as_str(), error.help), (wrong, LEAD));
        }
        for wrong in ["", "2", "2:", "2.5:1", "-1:1", "@1", "@1+2,3+4", "2:NaN"] {
            assert!(wrong.parse::<Tabs>().is_err(), "{wrong}");
        }
        for wrong in ["", "0.1:back", "0.1,0.1", "0.1,0.1:sideways", "0.1=", "0.1=E1+", "inf"] {
            assert!(passes(wrong).is_err(), "{wrong}");
        }
    }
}
