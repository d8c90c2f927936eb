//! An arc's centre and sweep, from I and J or from R.

use std::f64::consts::{PI, TAU};

use super::{ArcCentre, Exact, Fault, GcodePlan, Said};
use crate::outline::{Point, Shape, Turn, swept};

impl GcodePlan {
    pub(super) fn arc(&self, turn: Turn, target: Exact, said: &Said) -> Result<Shape, Fault> {
        let has = |letter| said.lengths.contains_key(&letter);
        let (from, to) = (self.at.point(), target.point());
        let returns = self.at.rounded() == target.rounded();
        let centre = match (has('R'), has('I') || has('J')) {
            (true, true) => return Err(Fault::new("arc", "both R and I, J")),
            (false, false) => return Err(Fault::new("arc", "neither I, J nor R")),
            (true, false) if returns => {
                return Err(Fault::new("arc", "R with the end at the start: no circle is told"));
            }
            (true, false) => self.centre_of_radius(turn, from, to, said)?,
            (false, true) => self.centre_of_words(said)?,
        };
        let (start, end) = (from.minus(centre).length(), to.minus(centre).length());
        if start <= 0.0 || (start - end).abs() > RADIUS_SLACK_UM {
            let found = format!("radius {start:.1} µm at the start, {end:.1} µm at the end");
            return Err(Fault::new("arc", &found));
        }
        let sweep = if returns { TAU } else { swept(centre, turn, from, to, PI) };
        Ok(Shape::Arc { centre, turn, sweep })
    }

    fn centre_of_words(&self, said: &Said) -> Result<Point, Fault> {
        // A missing one is no distance from the start, or where the start is.
        let of = |letter, at: i64, zero: i64| match (said.lengths.get(&letter), self.reading.arc_centre) {
            (None, _) => Ok(at),
            (Some(word), ArcCentre::Incremental) => Ok(at + self.length(word)?),
            (Some(word), ArcCentre::Absolute) => Ok(zero + self.length(word)?),
        };
        let centre = Exact { x: of('I', self.at.x, self.zero.x)?, y: of('J', self.at.y, self.zero.y)? };
        Ok(centre.point())
    }

    /// R positive: the arc of at most half a turn; negative: the other.
    fn centre_of_radius(&self, turn: Turn, from: Point, to: Point, said: &Said) -> Result<Point, Fault> {
        let word = said.lengths.get(&'R').ok_or_else(|| Fault::new("arc", "no R"))?;
        let radius = Exact { x: self.length(word)?, y: 0 }.point().x;
        let chord = to.minus(from);
        let half = chord.length() / 2.0;
        if half > radius.abs() + RADIUS_SLACK_UM / 2.0 {
            let found = format!("{word}: the ends are {:.1} µm apart", 2.0 * half);
            return Err(Fault::new("arc", &found));
        }
        let away = (radius * radius - half * half).max(0.0).sqrt();
        let side = turn.sign() * radius.signum();
        Ok(from.plus(chord.times(0.5)).minus(chord.unit().right().times(away * side)))
    }
}

/// How far the radii at both ends may differ: three decimals of X, Y, I and J, and a little more (a guess).
const RADIUS_SLACK_UM: f64 = 5.0;
