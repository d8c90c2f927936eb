//! The longest line and the longest arc that stand for the first points of a chain.

use super::{Made, Thinning};
use crate::geometry::{Element, Point, Sense, Vector};

impl Thinning {
    /// How many of the first lines between the points one element stands for, and which; none where it is the first itself.
    pub(super) fn longest(&self, points: &[Point]) -> (usize, Option<Element>) {
        let most = points.len() - 1;
        let line = farthest(1, most, |count| self.line(&points[..=count]));
        // An arc is worth having where it stands for more.
        let arc = match self.made {
            Made::Lines => None,
            Made::LinesAndArcs => {
                farthest(line.map_or(1, |(count, _)| count), most, |count| self.arc(&points[..=count]))
            }
        };
        arc.or(line).map_or((1, None), |(count, element)| (count, Some(element)))
    }

    /// A hair less than the tolerance, so that rounding cannot exceed what was promised.
    fn limit(&self) -> f64 {
        self.tolerance * (1.0 - 1e-9)
    }

    /// The line from the first point to the last, where all points lie along it.
    ///
    /// Between two points the program is as near to it as at one of them, as both are straight.
    fn line(&self, points: &[Point]) -> Option<Element> {
        let (&start, &end) = (points.first()?, points.last()?);
        let way = end - start;
        let length = way.norm();
        if length == 0.0 {
            return None;
        }
        let off_max = self.limit() * length;
        let mut before = 0.0;
        for point in points {
            let seen = point - start;
            let along = seen.dot(&way);
            // Never backwards, or the cut would not run as the program has it.
            if along < before || cross(way, seen).abs() > off_max {
                return None;
            }
            before = along;
        }
        Some(Element::Line { start, end })
    }

    /// An arc of at most 170 degrees from the first point to the last, where all lines lie along it.
    ///
    /// Its centre is on the perpendicular of the chord, `height` to the left of the chord's middle. With bend = 1/(2·height),
    /// which is 0 for a straight line, a point `off` to the left of the chord is on the circle where off = bend·excess, the
    /// excess being the square of its distance from the middle less chord²/4.
    fn arc(&self, points: &[Point]) -> Option<Element> {
        let (&start, &end) = (points.first()?, points.last()?);
        let way = end - start;
        let chord = way.norm();
        if chord == 0.0 {
            return None;
        }
        let (direction, middle) = (way / chord, start + way / 2.0);
        let left = Vector::new(-direction.y, direction.x);
        let placed = points[1..points.len() - 1].iter().map(|point| {
            let seen = point - middle;
            (seen.norm_squared() - chord * chord / 4.0, seen.dot(&left))
        });
        // The bend that suits all points best.
        let (mut products, mut squares) = (0.0, 0.0);
        for (excess, off) in placed.clone() {
            products += excess * off;
            squares += excess * excess;
        }
        let bend = products / squares;
        // As near to it as may be, one that suits each. The distance from the circle is off - bend·excess, shortened as a
        // radius is longer than the height.
        let slack = self.limit() * (1.0 + chord * chord * bend * bend).sqrt();
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for (excess, off) in placed {
            let (one, other) = ((off - slack) / excess, (off + slack) / excess);
            if one.is_finite() && other.is_finite() {
                (low, high) = (low.max(one.min(other)), high.min(one.max(other)));
            }
        }
        if !bend.is_finite() || low > high {
            return None;
        }
        let height = 0.5 / bend.clamp(low, high);
        if !height.is_finite() || height.abs() < HALF_CIRCLE_NEAR * chord {
            return None;
        }
        let centre = middle + left * height;
        let sense = if height > 0.0 { Sense::CounterClockwise } else { Sense::Clockwise };
        let is_kept = self.keeps_to(points, centre, sense);
        is_kept.then_some(Element::Arc { start, end, centre, sense })
    }

    /// Whether the lines between the points run along the arc of less than half a circle round a centre.
    fn keeps_to(&self, points: &[Point], centre: Point, sense: Sense) -> bool {
        let sign = if sense == Sense::CounterClockwise { 1.0 } else { -1.0 };
        let (Some(first), Some(last)) = (points.first(), points.last()) else { return false };
        let (first, last) = (first - centre, last - centre);
        let radius = first.norm();
        if radius > self.radius_max || sign * cross(first, last) <= 0.0 {
            return false;
        }
        points.windows(2).all(|pair| {
            let (from, to) = (pair[0] - centre, pair[1] - centre);
            let turns_on = sign * cross(from, to) >= 0.0 && from.dot(&to) > 0.0;
            let is_between = sign * cross(first, to) >= 0.0 && sign * cross(to, last) >= 0.0;
            turns_on
                && is_between
                && to.norm() <= radius + self.limit()
                && nearest_to_origin(from, to) >= radius - self.limit()
        })
    }
}

/// An arc whose centre is nearer to its chord than this share of it, one of more than 170 degrees, is too nearly half a
/// circle: printed, its centre could lie on the chord's other side.
const HALF_CIRCLE_NEAR: f64 = 0.0437;

/// The greatest count above one that is good, up to the most, that something fits, by doubling and halving. Where a count
/// that does not fit is followed by ones that do, a smaller one may come of it.
fn farthest(good: usize, most: usize, fits: impl Fn(usize) -> Option<Element>) -> Option<(usize, Element)> {
    let (mut found, mut good, mut bad) = (None, good, most + 1);
    let mut step = 1;
    while good < most && bad > most {
        let count = (good + step).min(most);
        match fits(count) {
            Some(element) => (found, good) = (Some((count, element)), count),
            // Few points in whole micrometres may lie on a line or bend the wrong way where more of them make an arc.
            None if found.is_none() && step < FEW && count < most => {}
            None => bad = count,
        }
        step *= 2;
    }
    while bad - good > 1 {
        let count = good.midpoint(bad);
        match fits(count) {
            Some(element) => (found, good) = (Some((count, element)), count),
            None => bad = count,
        }
    }
    found
}

/// So many points more are tried before it is given up that something fits.
const FEW: usize = 16;

/// The distance of a line's nearest point from the origin.
fn nearest_to_origin(from: Vector, to: Vector) -> f64 {
    let way = to - from;
    let length2 = way.norm_squared();
    if length2 == 0.0 {
        return from.norm();
    }
    (from + way * (-from.dot(&way) / length2).clamp(0.0, 1.0)).norm()
}

fn cross(a: Vector, b: Vector) -> f64 {
    a.x * b.y - a.y * b.x
}
