//! How near one way comes to another: the smallest distance between two elements, and where it is.
//!
//! The nearest points of two lines or arcs are an end of one of them, a point they share, or lie where both are square to
//! the way between them. Each such point is tried; a point that is no nearest one does no harm.

use crate::geometry::{Element, Point, Vector};

/// The nearest place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    /// How near, mm.
    pub(super) distance: f64,
    /// Where, on the first way.
    pub(super) at: Point,
}

/// The smallest distance between two elements.
pub(super) fn between(a: &Element, b: &Element) -> Nearest {
    let mut best = Nearest { distance: f64::INFINITY, at: a.start() };
    let mut try_at = |near: Point| {
        let at = a.nearest(near);
        let distance = b.distance(at);
        if distance < best.distance {
            best = Nearest { distance, at };
        }
    };
    for end in [a.start(), a.end(), b.start(), b.end()] {
        try_at(end);
    }
    for place in shared(a, b).into_iter().flatten() {
        try_at(place);
    }
    for (arc, other) in [(a, b), (b, a)] {
        let Element::Arc { start, centre, .. } = *arc else { continue };
        let towards = match *other {
            Element::Line { .. } => {
                let way = other.heading_at_start();
                Vector::new(-way.y, way.x)
            }
            Element::Arc { centre: second, .. } if second == centre => continue,
            Element::Arc { centre: second, .. } => (second - centre).normalize(),
        };
        let by = towards * (start - centre).norm();
        try_at(centre + by);
        try_at(centre - by);
    }
    best
}

/// Where a way comes nearest to others, looking no farther than `within`, mm; none where it comes no nearer.
pub(super) fn nearest_within(way: &Element, others: &[Element], within: f64) -> Option<Nearest> {
    let [low, high] = way.extent();
    let reach = |element: &&Element| {
        let [min, max] = element.extent();
        min.x < high.x + within && max.x > low.x - within && min.y < high.y + within && max.y > low.y - within
    };
    let near = others.iter().filter(reach).map(|other| between(way, other));
    near.filter(|near| near.distance < within).min_by(|a, b| a.distance.total_cmp(&b.distance))
}

/// The points that two elements share, but for those along which they run together.
pub(super) fn crossings(a: &Element, b: &Element) -> impl Iterator<Item = Point> {
    let (a, b) = (*a, *b);
    let is_on = move |at: &Point| a.distance(*at).max(b.distance(*at)) <= ON;
    shared(&a, &b).into_iter().flatten().filter(is_on)
}

/// A point so near to an element is on it, mm: what working it out may be off by.
const ON: f64 = 1e-6;

/// The points in which the whole lines or circles of two elements meet.
fn shared(a: &Element, b: &Element) -> [Option<Point>; 2] {
    match (*a, *b) {
        (Element::Line { start, end }, Element::Line { start: from, end: to }) => {
            let (way, other, apart) = (end - start, to - from, from - start);
            let across = way.x * other.y - way.y * other.x;
            let t = (apart.x * other.y - apart.y * other.x) / across;
            [t.is_finite().then(|| start + way * t), None]
        }
        (Element::Line { start, .. }, Element::Arc { start: on, centre, .. })
        | (Element::Arc { start: on, centre, .. }, Element::Line { start, .. }) => {
            let heading = match a {
                Element::Line { .. } => a.heading_at_start(),
                Element::Arc { .. } => b.heading_at_start(),
            };
            let foot = start + heading * (centre - start).dot(&heading);
            either_side(foot, heading, (on - centre).norm_squared() - (foot - centre).norm_squared())
        }
        (Element::Arc { start: on, centre, .. }, Element::Arc { start: other, centre: second, .. }) => {
            let way = second - centre;
            let distance = way.norm();
            if distance == 0.0 {
                return [None, None];
            }
            let (radius2, other2) = ((on - centre).norm_squared(), (other - second).norm_squared());
            let along = (distance * distance + radius2 - other2) / (2.0 * distance);
            let heading = way / distance;
            either_side(centre + heading * along, Vector::new(-heading.y, heading.x), radius2 - along * along)
        }
    }
}

/// The two points on a line at the square root of a length from its foot.
fn either_side(foot: Point, heading: Vector, squared: f64) -> [Option<Point>; 2] {
    if squared < 0.0 {
        return [None, None];
    }
    let reach = heading * squared.sqrt();
    [Some(foot + reach), Some(foot - reach)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Sense;

    /// Every pair of points on two elements, a thousand of each.
    fn sampled(a: &Element, b: &Element) -> f64 {
        (0..=1000)
            .map(|n| b.distance(a.at(f64::from(n) / 1000.0)))
            .chain((0..=1000).map(|n| a.distance(b.at(f64::from(n) / 1000.0))))
            .fold(f64::INFINITY, f64::min)
    }

    proptest::proptest! {
        #[test]
        fn no_point_of_two_elements_is_nearer_than_told(
            numbers in proptest::collection::vec(-5.0..5.0f64, 8),
            turns in proptest::collection::vec(0.2..6.0f64, 4),
            kinds in proptest::collection::vec(proptest::bool::ANY, 4),
        ) {
            let element = |from: usize| {
                let start = Point::new(numbers[4 * from], numbers[4 * from + 1]);
                let other = Point::new(numbers[4 * from + 2], numbers[4 * from + 3]);
                let sense = if kinds[2 + from] { Sense::Clockwise } else { Sense::CounterClockwise };
                let (sin, cos) = libm::sincos(turns[from]);
                let seen = start - other;
                let turned = Vector::new(seen.x * cos - seen.y * sin, seen.x * sin + seen.y * cos);
                if kinds[from] {
                    Element::Line { start, end: other }
                } else {
                    Element::Arc { start, end: other + turned, centre: other, sense }
                }
            };
            let (a, b) = (element(0), element(1));
            let (told, seen) = (between(&a, &b), sampled(&a, &b));
            proptest::prop_assert!(told.distance <= seen + 1e-9, "{told:?} {seen}");
            // A crossing is missed by the samples by at most half of their steps.
            let step = a.length().max(b.length()) / 1000.0;
            proptest::prop_assert!(told.distance >= seen - step, "{told:?} {seen}");
            proptest::prop_assert!((b.distance(told.at) - told.distance).abs() < 1e-9);
            proptest::prop_assert!(a.distance(told.at) < 1e-9);
        }
    }
}
