//! The unit a drawing is drawn in, and how it is known.
//!
//! Source: Autodesk, *DXF Reference*, header variables `$INSUNITS` and `$MEASUREMENT`.

/// The unit of a drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// How many mm it is.
    pub millimetres: f64,
    /// How that is known.
    pub known: Known,
}

/// How a drawing's unit is known.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Known {
    /// By the caller.
    Given,
    /// By `$INSUNITS`.
    Stated,
    /// The drawing does not say; `$MEASUREMENT` (0 inches, 1 mm) makes it likely.
    Likely,
    /// Not at all: mm are assumed.
    Assumed,
}

/// The unit by its number in `$INSUNITS`, mm; none for 0 (no unit) and for numbers that are none.
pub(super) fn millimetres(number: i16) -> Option<f64> {
    Some(match number {
        1 => 25.4,
        2 => 304.8,
        3 => 1_609_344.0,
        4 => 1.0,
        5 => 10.0,
        6 => 1e3,
        7 => 1e6,
        8 => 25.4e-6,
        9 => 25.4e-3,
        10 => 914.4,
        11 => 1e-7,
        12 => 1e-6,
        13 => 1e-3,
        14 => 100.0,
        15 => 1e4,
        16 => 1e5,
        17 => 1e12,
        // US survey foot, inch, yard and mile.
        21 => 1_200_000.0 / 3937.0,
        22 => 100_000.0 / 3937.0,
        23 => 3_600_000.0 / 3937.0,
        24 => 5280.0 * 1_200_000.0 / 3937.0,
        _ => return None,
    })
}

impl Units {
    pub(super) fn of(given: Option<f64>, units: Option<i16>, measurement: Option<i16>) -> Self {
        if let Some(millimetres) = given {
            return Self { millimetres, known: Known::Given };
        }
        if let Some(millimetres) = units.and_then(millimetres) {
            return Self { millimetres, known: Known::Stated };
        }
        match measurement {
            Some(0) => Self { millimetres: 25.4, known: Known::Likely },
            Some(1) => Self { millimetres: 1.0, known: Known::Likely },
            _ => Self { millimetres: 1.0, known: Known::Assumed },
        }
    }
}
