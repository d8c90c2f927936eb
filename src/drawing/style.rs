//! The stylesheet: every colour, pen width, dash and letter height of every picture, in one table.
//!
//! A shape says what it *is*; only this file says how that looks, and both writers read it here. Colours are few and
//! quiet on white: dark for the cut, blue for the drawing it came from, orange for the way in, green for the start.
//! Letters stand as in ISO 3098-1 lettering B: the pen is a tenth of their height.
//!
//! It does not decide what is drawn, or in which order.

/// A colour of the stylesheet.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Colour {
    /// Red, green and blue, eight bits each, as in `0xRRGGBB`.
    pub rgb: u32,
    /// Opacity in percent, 100 hides what is beneath.
    pub opacity_percent: u8,
}

/// How one class looks. Lengths are page millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// The class name in the SVG.
    pub name: &'static str,
    /// The colour of lines, and of shapes asked for as solid.
    pub colour: Colour,
    /// The pen for lines.
    pub pen: f64,
    /// Dash and gap of broken lines.
    pub dash: Option<[f64; 2]>,
    /// The height of capital letters.
    pub letters: f64,
}

/// What a shape is.
#[derive(Clone, Copy, Debug, Eq, Hash, Ord, PartialEq, PartialOrd)]
pub enum Class {
    /// White paper: the background, and the halo that keeps letters clear of lines.
    Paper,
    /// The body of the part, meant as a solid beneath everything else.
    Part,
    /// The wire or its kerf, meant to be drawn at true width.
    Wire,
    /// The outline as drawn.
    Nominal,
    /// Motion without cutting.
    Rapid,
    /// The path that cuts.
    Cut,
    /// The way from the start to the outline, and back.
    LeadIn,
    /// The start point.
    Start,
    /// The sense of the cut.
    Direction,
    /// Dimension and centre lines.
    Dimension,
    /// What marks a region that another view enlarges.
    Callout,
    /// Frames and rules.
    Frame,
    /// The scale bar.
    ScaleBar,
    /// The title of the page.
    Title,
    /// The heading of a view or of a table.
    Heading,
    /// Words and figures to be read.
    Caption,
    /// Small quiet words: units, names of figures, labels inside a view.
    Label,
}

impl Class {
    /// Every class, in the order of the stylesheet.
    pub const ALL: [Self; 17] = [
        Self::Paper,
        Self::Part,
        Self::Wire,
        Self::Nominal,
        Self::Rapid,
        Self::Cut,
        Self::LeadIn,
        Self::Start,
        Self::Direction,
        Self::Dimension,
        Self::Callout,
        Self::Frame,
        Self::ScaleBar,
        Self::Title,
        Self::Heading,
        Self::Caption,
        Self::Label,
    ];

    /// Returns how the class looks.
    #[must_use]
    pub const fn style(self) -> Style {
        const SMALL: f64 = 2.2;
        match self {
            Self::Paper => line("paper", solid(0xff_ffff), 1.0, SMALL),
            Self::Part => line("part", solid(0xee_f1f4), 0.18, SMALL),
            Self::Wire => line("wire", Colour { rgb: 0xe3_b778, opacity_percent: 45 }, 1.6, SMALL),
            Self::Nominal => line("nominal", solid(0x2f_78b7), 0.18, SMALL),
            Self::Rapid => dashed(line("rapid", solid(0x8a_949e), 0.2, SMALL), 1.6, 1.2),
            Self::Cut => line("cut", solid(0x1d_2730), 0.3, SMALL),
            Self::LeadIn => line("lead-in", solid(0xe0_6a10), 0.4, SMALL),
            Self::Start => line("start", solid(0x1a_7a45), 0.35, SMALL),
            Self::Direction => line("direction", solid(0x1d_2730), 0.3, SMALL),
            Self::Dimension => line("dimension", solid(0x6b_7680), 0.15, SMALL),
            Self::Callout => dashed(line("callout", solid(0x8a_4f9e), 0.22, SMALL), 1.4, 0.9),
            Self::Frame => line("frame", solid(0xc3_cad0), 0.2, SMALL),
            Self::ScaleBar => line("scale-bar", solid(0x3a_454f), 0.35, SMALL),
            Self::Title => line("title", solid(0x1d_2730), 0.5, 5.0),
            Self::Heading => line("heading", solid(0x1d_2730), 0.32, 3.2),
            Self::Caption => line("caption", solid(0x1d_2730), 0.26, 2.6),
            Self::Label => line("label", solid(0x5b_6670), 0.22, SMALL),
        }
    }
}

const fn solid(rgb: u32) -> Colour {
    Colour { rgb, opacity_percent: 100 }
}

const fn line(name: &'static str, colour: Colour, pen: f64, letters: f64) -> Style {
    Style { name, colour, pen, dash: None, letters }
}

const fn dashed(style: Style, dash: f64, gap: f64) -> Style {
    Style { dash: Some([dash, gap]), ..style }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_class_has_a_name_of_its_own_fit_for_a_stylesheet() {
        let names: BTreeSet<&str> = Class::ALL.iter().map(|class| class.style().name).collect();
        assert_eq!(names.len(), Class::ALL.len());
        assert!(names.iter().all(|name| name.bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'-')));
    }

    #[test]
    fn the_list_of_classes_is_complete_and_in_order() {
        assert!(Class::ALL.is_sorted());
        assert_eq!(Class::ALL.last(), Some(&Class::Label));
        assert_eq!(Class::Label as usize + 1, Class::ALL.len());
    }
}
