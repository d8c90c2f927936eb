//! What a drawing says that its contours do not show: what was left out, assumed, mended, or stands in the way of cutting.

use std::borrow::Cow;
use std::fmt;

use crate::geometry::Point;

/// One thing found in a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// How much it matters.
    pub severity: Severity,
    /// Its name, for scripts.
    pub code: &'static str,
    /// What was found, with coordinates in mm.
    pub message: String,
    /// What to do about it; may be empty.
    pub help: Cow<'static, str>,
    /// Where in the drawing, mm, when it is at a place.
    pub at: Option<Point>,
    /// The line of the file that the first entity concerned begins on; 0 for none.
    pub line: u64,
}

/// How much a finding matters.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub enum Severity {
    /// As it should be, and good to know.
    Note,
    /// To be looked at before cutting.
    Warning,
    /// The drawing says no single thing to cut: it is not to be cut as it is.
    Fault,
}

impl Finding {
    pub(crate) fn new(severity: Severity, code: &'static str, message: String) -> Self {
        Self { severity, code, message, help: Cow::Borrowed(""), at: None, line: 0 }
    }

    pub(crate) fn help(self, help: impl Into<Cow<'static, str>>) -> Self {
        Self { help: help.into(), ..self }
    }

    pub(crate) fn at(self, point: Point) -> Self {
        Self { at: Some(point), ..self }
    }

    pub(crate) fn line(self, line: u64) -> Self {
        Self { line, ..self }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        if self.line > 0 {
            write!(f, " (line {})", self.line)?;
        }
        Ok(())
    }
}

/// A point as a message names it.
pub(crate) fn named(point: Point) -> String {
    // Never -0: a place is not negative when it is nought.
    let clean = |v: f64| if v.abs() < 0.000_05 { 0.0 } else { v };
    format!("({:.4}, {:.4})", clean(point.x), clean(point.y))
}
