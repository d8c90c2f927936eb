//! TOML read strictly: every key is known, every value is of its kind and in its range, every error has its place.
//!
//! Part files and machine profiles are both read through [`Section`]. A key nobody asked for is an error, with the
//! nearest known key as help; so nothing a person wrote is ever ignored.

use std::cell::RefCell;
use std::ops::Range;

use thiserror::Error;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::place::Place;

/// What is wrong with a file of keys.
#[derive(Clone, Debug, Error)]
#[error("{message}")]
pub struct KeyError {
    /// The rule broken, in words.
    pub message: String,
    /// Where.
    pub place: Place,
    /// What to do about it.
    pub help: Option<String>,
}

/// A TOML document, parsed.
#[derive(Debug)]
pub struct Document<'a> {
    text: &'a str,
    root: Spanned<DeTable<'a>>,
}

impl<'a> Document<'a> {
    /// Parses a document.
    ///
    /// # Errors
    ///
    /// When it is not TOML.
    pub fn parse(text: &'a str) -> Result<Self, KeyError> {
        let root = DeTable::parse(text).map_err(|error| {
            let span = error.span().unwrap_or(0..0);
            KeyError {
                message: error.message().lines().next().unwrap_or("not TOML").to_owned(),
                place: Place::in_text(text, span.start, span.end),
                help: Some("the file is TOML: `key = value` lines under `[section]` headings".to_owned()),
            }
        })?;
        Ok(Self { text, root })
    }

    /// The sections by name, those that are not in the file empty.
    ///
    /// # Errors
    ///
    /// When the file has a section or a top-level key that is not named here.
    pub fn sections<const N: usize>(&self, names: [&'static str; N]) -> Result<[Section<'_>; N], KeyError> {
        for (key, _) in self.root.get_ref() {
            let name = key.get_ref().as_ref();
            if !names.contains(&name) {
                let message = format!("unknown section or key `{name}`");
                return Err(self.error(key.span(), message, nearest(name, &names)));
            }
        }
        let mut sections = names.map(|name| Section {
            text: self.text,
            name,
            span: 0..0,
            table: None,
            asked: RefCell::new(Vec::new()),
        });
        for section in &mut sections {
            if let Some((key, value)) = self.root.get_ref().get_key_value(section.name) {
                section.span = key.span();
                match value.get_ref() {
                    DeValue::Table(table) => section.table = Some(table),
                    _ => {
                        let message = format!("`{}` must be a section: `[{0}]`", section.name);
                        return Err(self.error(key.span(), message, None));
                    }
                }
            }
        }
        Ok(sections)
    }

    fn error(&self, span: Range<usize>, message: String, help: Option<String>) -> KeyError {
        KeyError { message, place: Place::in_text(self.text, span.start, span.end), help }
    }
}

/// One `[section]`: its keys are asked for by name, and what was not asked for is an error in the end.
#[derive(Debug)]
pub struct Section<'a> {
    text: &'a str,
    name: &'static str,
    span: Range<usize>,
    table: Option<&'a DeTable<'a>>,
    asked: RefCell<Vec<&'static str>>,
}

impl<'a> Section<'a> {
    /// Whether the file has this section.
    #[must_use]
    pub fn is_present(&self) -> bool {
        self.table.is_some()
    }

    fn get(&self, key: &'static str) -> Option<&'a Spanned<DeValue<'a>>> {
        self.asked.borrow_mut().push(key);
        self.table?.get(key)
    }

    /// An error about a key of this section, or about its heading when the key is not there.
    #[must_use]
    pub fn error(&self, key: &str, message: impl Into<String>, help: Option<&str>) -> KeyError {
        let span =
            self.table.and_then(|table| table.get(key)).map_or_else(|| self.span.clone(), Spanned::span);
        KeyError {
            message: message.into(),
            place: Place::in_text(self.text, span.start, span.end),
            help: help.map(str::to_owned),
        }
    }

    fn wrong(&self, key: &'static str, wanted: &str) -> KeyError {
        self.error(key, format!("`{key}` must be {wanted}"), None)
    }

    /// A number, whole or with a point.
    ///
    /// # Errors
    ///
    /// When the value is anything else, or not finite.
    pub fn number(&self, key: &'static str) -> Result<Option<f64>, KeyError> {
        let Some(value) = self.get(key) else { return Ok(None) };
        self.as_number(value.get_ref()).map(Some).ok_or_else(|| self.wrong(key, "a finite number"))
    }

    fn as_number(&self, value: &DeValue<'_>) -> Option<f64> {
        let text = value
            .as_float()
            .map(|f| f.as_str())
            .or_else(|| value.as_integer().filter(|i| i.radix() == 10).map(|i| i.as_str()))?;
        text.parse().ok().filter(|v: &f64| v.is_finite())
    }

    /// A whole number within a range.
    ///
    /// # Errors
    ///
    /// When the value is anything else.
    pub fn whole(
        &self,
        key: &'static str,
        range: std::ops::RangeInclusive<u64>,
    ) -> Result<Option<u64>, KeyError> {
        let Some(value) = self.get(key) else { return Ok(None) };
        let number =
            value.get_ref().as_integer().and_then(|i| u64::from_str_radix(i.as_str(), i.radix()).ok());
        match number {
            Some(number) if range.contains(&number) => Ok(Some(number)),
            _ => Err(self.wrong(key, &format!("a whole number from {} to {}", range.start(), range.end()))),
        }
    }

    /// Yes or no.
    ///
    /// # Errors
    ///
    /// When the value is anything but `true` or `false`.
    pub fn switch(&self, key: &'static str) -> Result<Option<bool>, KeyError> {
        let Some(value) = self.get(key) else { return Ok(None) };
        value.get_ref().as_bool().map(Some).ok_or_else(|| self.wrong(key, "true or false"))
    }

    /// Any text.
    ///
    /// # Errors
    ///
    /// When the value is not a string.
    pub fn text(&self, key: &'static str) -> Result<Option<&'a str>, KeyError> {
        let Some(value) = self.get(key) else { return Ok(None) };
        value.get_ref().as_str().map(Some).ok_or_else(|| self.wrong(key, "text in quotes"))
    }

    /// One of a few words, translated by a table.
    ///
    /// # Errors
    ///
    /// When the value is not one of the words.
    pub fn word<T: Copy>(
        &self,
        key: &'static str,
        words: &[(&'static str, T)],
    ) -> Result<Option<T>, KeyError> {
        let Some(text) = self.text(key)? else { return Ok(None) };
        match words.iter().find(|(word, _)| *word == text) {
            Some((_, value)) => Ok(Some(*value)),
            None => {
                let names: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
                let message = format!("`{key} = \"{text}\"` is not one of {}", names.join(", "));
                Err(self.error(key, message, nearest(text, &names).as_deref()))
            }
        }
    }

    /// Two numbers in brackets, or a word.
    ///
    /// # Errors
    ///
    /// When the value is neither.
    pub fn point_or_word(&self, key: &'static str) -> Result<Option<PointOrWord<'a>>, KeyError> {
        let Some(value) = self.get(key) else { return Ok(None) };
        if let Some(word) = value.get_ref().as_str() {
            return Ok(Some(PointOrWord::Word(word)));
        }
        let numbers: Option<Vec<f64>> = value
            .get_ref()
            .as_array()
            .and_then(|array| array.iter().map(|v| self.as_number(v.get_ref())).collect());
        match numbers.as_deref() {
            Some(&[x, y]) => Ok(Some(PointOrWord::Point(x, y))),
            _ => Err(self.wrong(key, "a word in quotes or a point `[x, y]` in mm")),
        }
    }

    /// Checks that every key of the section was asked for.
    ///
    /// # Errors
    ///
    /// When one was not.
    pub fn finish(&self) -> Result<(), KeyError> {
        let asked = self.asked.borrow();
        for (key, _) in self.table.into_iter().flatten() {
            let name = key.get_ref().as_ref();
            if !asked.contains(&name) {
                let span = key.span();
                return Err(KeyError {
                    message: format!("unknown key `{name}` in [{}]", self.name),
                    place: Place::in_text(self.text, span.start, span.end),
                    help: nearest(name, &asked),
                });
            }
        }
        Ok(())
    }
}

/// A value that is a point or a word.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PointOrWord<'a> {
    /// `[x, y]`, mm.
    Point(f64, f64),
    /// A word.
    Word(&'a str),
}

/// "did you mean" or, when nothing is near, the words there are.
#[must_use]
pub fn nearest(word: &str, known: &[&str]) -> Option<String> {
    let best = known
        .iter()
        .map(|k| (strsim::damerau_levenshtein(&word.to_lowercase(), k), *k))
        .min_by_key(|(distance, _)| *distance)?;
    if best.0 <= 1 + word.len() / 3 {
        return Some(format!("did you mean `{}`?", best.1));
    }
    Some(format!("known here: {}", known.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_key_has_its_place_and_a_suggestion() {
        let document = Document::parse("[part]\nkind = \"gear\"\ntooth = 36\n").unwrap();
        let [part] = document.sections(["part"]).unwrap();
        part.text("kind").unwrap();
        part.whole("teeth", 3..=9).unwrap();
        let error = part.finish().unwrap_err();
        assert_eq!((error.place.line, error.place.column), (3, 1));
        assert_eq!(error.message, "unknown key `tooth` in [part]");
        assert_eq!(error.help.as_deref(), Some("did you mean `teeth`?"));
    }

    #[test]
    fn a_value_of_the_wrong_kind_or_out_of_range_is_refused() {
        let document = Document::parse("[p]\na = \"x\"\nb = 1.5\nc = inf\n").unwrap();
        let [p] = document.sections(["p"]).unwrap();
        assert!(p.number("a").is_err());
        assert!(p.whole("b", 0..=9).is_err());
        assert!(p.number("c").is_err());
        assert_eq!(p.number("b").unwrap(), Some(1.5));
        assert_eq!(p.number("absent").unwrap(), None);
    }

    #[test]
    fn an_unknown_section_is_refused() {
        let document = Document::parse("[prat]\n").unwrap();
        let error = document.sections(["part", "wire"]).unwrap_err();
        assert_eq!(error.help.as_deref(), Some("did you mean `part`?"));
    }
}
