//! Lines of text as strokes.
//!
//! Reads the [`glyphs`](super::glyphs) and sets them side by side. One line at a time, left to right; it breaks no
//! lines and knows no other direction.

use super::glyphs::{MISSING, glyph};
use super::ink::Step;

/// Returns the width of a line of text whose capitals have the given height, both in the same unit.
#[must_use]
pub fn text_width(text: &str, height: f64) -> f64 {
    let advances: f64 = text.chars().map(|character| glyph(character).unwrap_or(MISSING).0 + GAP).sum();
    (advances - GAP).max(0.0) * height / CAPITAL
}

/// Writes a line of text with its foot line beginning at `at`.
pub(super) fn strokes(text: &str, at: [f64; 2], height: f64) -> Vec<Step> {
    let scale = height / CAPITAL;
    let mut steps = Vec::new();
    let mut left = at[0];
    for character in text.chars() {
        let (width, strokes) = glyph(character).unwrap_or(MISSING);
        for stroke in strokes.split('|') {
            write_stroke(stroke, |[x, y]| [left + x * scale, at[1] + y * scale], &mut steps);
        }
        left += (width + GAP) * scale;
    }
    steps
}

/// Capital height on the glyphs' grid.
const CAPITAL: f64 = 20.0;

/// From one letter to the next: two pens, as ISO 3098-1 has it.
const GAP: f64 = 4.0;

/// How far a cubic's arms reach towards the corner for a quarter of an ellipse: 4/3·(√2 − 1).
const QUARTER: f64 = 0.552_284_749_830_793_4;

fn write_stroke(stroke: &str, place: impl Fn([f64; 2]) -> [f64; 2], steps: &mut Vec<Step>) {
    let mut here = None;
    let mut bend = None;
    for word in stroke.split_ascii_whitespace() {
        let point = point(word.trim_start_matches(['h', 'v', 'c']));
        let Some(from) = here else {
            steps.push(Step::Move(place(point)));
            here = Some(point);
            continue;
        };
        let towards = |from: [f64; 2], corner: [f64; 2], part: f64| {
            place([from[0] + (corner[0] - from[0]) * part, from[1] + (corner[1] - from[1]) * part])
        };
        match (word.as_bytes().first(), bend.take()) {
            (Some(b'c'), _) => {
                bend = Some(point);
                continue;
            }
            (Some(b'h'), _) => {
                let corner = [point[0], from[1]];
                steps.push(curve(
                    towards(from, corner, QUARTER),
                    towards(point, corner, QUARTER),
                    place(point),
                ));
            }
            (Some(b'v'), _) => {
                let corner = [from[0], point[1]];
                steps.push(curve(
                    towards(from, corner, QUARTER),
                    towards(point, corner, QUARTER),
                    place(point),
                ));
            }
            (_, Some(corner)) => {
                // A parabola as a cubic: both arms reach two thirds of the way to its control point.
                let part = 2.0 / 3.0;
                steps.push(curve(towards(from, corner, part), towards(point, corner, part), place(point)));
            }
            (_, None) => steps.push(Step::Line(place(point))),
        }
        here = Some(point);
    }
}

fn curve(first: [f64; 2], second: [f64; 2], to: [f64; 2]) -> Step {
    Step::Curve { controls: [first, second], to }
}

fn point(word: &str) -> [f64; 2] {
    let number = |text: &str| text.parse().ok();
    word.split_once(':')
        .and_then(|(x, y)| Some([number(x)?, number(y)?]))
        .unwrap_or_else(|| panic!("{word:?} in a glyph is not a point"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_glyph_reads_and_stays_within_its_width() {
        for character in (' '..='~').chain("µ°±·×Ø–中".chars()) {
            let width = text_width(&character.to_string(), CAPITAL);
            for step in strokes(&character.to_string(), [0.0, 0.0], CAPITAL) {
                let [x, y] = step.end().expect("letters close no outlines");
                assert!((-0.01..=width + 0.5).contains(&x), "{character:?} {x}");
                assert!((-6.01..=23.01).contains(&y), "{character:?} {y}");
            }
        }
    }

    #[test]
    fn a_text_is_as_wide_as_its_letters_and_the_gaps_between_them() {
        assert_eq!(text_width("", 2.0), 0.0);
        assert_eq!(text_width("00", 20.0), 11.0 + 4.0 + 11.0);
        assert_eq!(text_width("00", 2.0), 2.6);
        assert_eq!(text_width("µm", 20.0), 10.0 + 4.0 + 15.0);
    }

    #[test]
    fn columns_of_figures_stand_in_line() {
        assert_eq!(text_width("1.111", 3.0), text_width("8.888", 3.0));
    }

    #[test]
    fn letters_begin_at_their_point() {
        assert_eq!(strokes("I", [5.0, 7.0], 2.0), [Step::Move([5.0, 7.0]), Step::Line([5.0, 9.0])]);
    }
}
