//! An offset as a control works it out: element by element, with nothing known but the next corner.
//!
//! Every element is moved sideways on its own; outside corners are gone round, at inside corners both neighbours end
//! where they meet. What lies farther along the contour is not seen: where an element would be run backwards, or an
//! arc's radius is used up, there is no such path.

use crate::geometry::offset::{Corners, Origin};
use crate::geometry::{Element, Point, Sense, Vector, sweep};

/// An element of which the offset leaves nothing, by its index from 0.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Vanishes(pub usize);

/// The wire's way beside elements that follow one another, to their left by a distance, mm, and what each part of it
/// runs beside. It begins and ends square beside the first and last element's ends.
///
/// # Errors
///
/// When nothing is left of an element.
pub fn beside(elements: &[Element], left: f64, corners: Corners) -> Result<Vec<(Element, Origin)>, Vanishes> {
    let mut shifted = Vec::with_capacity(elements.len());
    for (n, element) in elements.iter().enumerate() {
        shifted.push(shift(element, left).ok_or(Vanishes(n))?);
    }
    let mut ways = Vec::with_capacity(elements.len() + elements.len() / 2);
    for n in 0..elements.len() {
        let mut around = Vec::new();
        if n + 1 < elements.len() {
            let corner = elements[n].end();
            let (before, after) = (elements[n].heading_at_end(), elements[n + 1].heading_at_start());
            let (ends, begins) = (shifted[n].end(), shifted[n + 1].start());
            let turns_away =
                (before.x * after.y - before.y * after.x) * left < 0.0 || before.dot(&after) < -ONE;
            if (ends - begins).norm() <= SAME {
                shifted[n + 1] = snapped(&shifted[n + 1], ends);
            } else if turns_away {
                around = round(corner, ends, begins, left, corners);
            } else {
                let whole = |m: usize| shift(&elements[m], left).unwrap_or(elements[m]);
                let at = meeting(&whole(n), &whole(n + 1), corner)
                    .or_else(|| ((ends - begins).norm() <= TRACE).then(|| ends + (begins - ends) * 0.5));
                let shorter = if elements[n].length() <= elements[n + 1].length() { n } else { n + 1 };
                let at = at.ok_or(Vanishes(shorter))?;
                shifted[n] = with_end(&shifted[n], at);
                shifted[n + 1] = with_start(&shifted[n + 1], at);
            }
        }
        if !goes_the_same_way(&shifted[n], &elements[n]) {
            return Err(Vanishes(n));
        }
        ways.push((shifted[n], Origin::Element(n)));
        ways.extend(around.into_iter().map(|way| (way, Origin::Corner(n))));
    }
    Ok(ways)
}

/// An element moved sideways; none of an arc whose radius is used up.
fn shift(element: &Element, left: f64) -> Option<Element> {
    let aside = |heading: Vector| Vector::new(-heading.y, heading.x) * left;
    match *element {
        Element::Line { start, end } => {
            let by = aside(element.heading_at_start());
            Some(Element::Line { start: start + by, end: end + by })
        }
        Element::Arc { start, end, centre, sense } => {
            let grows = if sense == Sense::CounterClockwise { -left } else { left };
            if (start - centre).norm() + grows <= SAME || (end - centre).norm() + grows <= SAME {
                return None;
            }
            let begin = start + aside(element.heading_at_start());
            let finish = if start == end { begin } else { end + aside(element.heading_at_end()) };
            Some(Element::Arc { start: begin, end: finish, centre, sense })
        }
    }
}

/// The way round an outside corner.
fn round(corner: Point, from: Point, to: Point, left: f64, corners: Corners) -> Vec<Element> {
    let sense = if left > 0.0 { Sense::Clockwise } else { Sense::CounterClockwise };
    if let Corners::Sharp { limit } = corners {
        let half = (from - corner) + (to - corner);
        // Both radii and the half between them: the point lies at radius / cos(half the turn).
        let tip = corner + half * (2.0 * left * left / half.norm_squared());
        if (tip - corner).norm() <= limit * left.abs() {
            return vec![Element::Line { start: from, end: tip }, Element::Line { start: tip, end: to }];
        }
    }
    vec![Element::Arc { start: from, end: to, centre: corner, sense }]
}

/// Where two ways beside an inside corner meet, nearest to the corner.
fn meeting(before: &Element, after: &Element, corner: Point) -> Option<Point> {
    let candidates = match (*before, *after) {
        (Element::Line { start, end }, Element::Line { start: from, end: to }) => lines(start, end, from, to),
        (Element::Line { start, end }, Element::Arc { start: on, centre, .. })
        | (Element::Arc { start: on, centre, .. }, Element::Line { start, end }) => {
            line_and_circle(start, end, centre, (on - centre).norm())
        }
        (Element::Arc { start: on, centre, .. }, Element::Arc { start: other, centre: second, .. }) => {
            circles(centre, (on - centre).norm(), second, (other - second).norm())
        }
    };
    candidates
        .into_iter()
        .flatten()
        .filter(|point| before.distance(*point) <= SAME && after.distance(*point) <= SAME)
        .min_by(|a, b| (a - corner).norm_squared().total_cmp(&(b - corner).norm_squared()))
}

fn lines(start: Point, end: Point, from: Point, to: Point) -> [Option<Point>; 2] {
    let (way, other) = (end - start, to - from);
    let across = way.x * other.y - way.y * other.x;
    let between = from - start;
    let t = (between.x * other.y - between.y * other.x) / across;
    [t.is_finite().then(|| start + way * t), None]
}

fn line_and_circle(start: Point, end: Point, centre: Point, radius: f64) -> [Option<Point>; 2] {
    let heading = (end - start).normalize();
    let foot = start + heading * (centre - start).dot(&heading);
    let under = radius * radius - (foot - centre).norm_squared();
    if under < 0.0 {
        return [None, None];
    }
    let reach = under.sqrt();
    [Some(foot - heading * reach), Some(foot + heading * reach)]
}

fn circles(centre: Point, radius: f64, second: Point, other: f64) -> [Option<Point>; 2] {
    let way = second - centre;
    let distance = way.norm();
    if distance <= SAME {
        return [None, None];
    }
    let along = (distance * distance + radius * radius - other * other) / (2.0 * distance);
    let under = radius * radius - along * along;
    if under < 0.0 {
        return [None, None];
    }
    let (heading, reach) = (way / distance, under.sqrt());
    let foot = centre + heading * along;
    let across = Vector::new(-heading.y, heading.x) * reach;
    [Some(foot + across), Some(foot - across)]
}

/// Whether what is left of an element runs as it did: no line backwards, no arc the long way round.
fn goes_the_same_way(way: &Element, element: &Element) -> bool {
    match (*way, *element) {
        (Element::Line { start, end }, _) => (end - start).dot(&element.heading_at_start()) > 0.0,
        (Element::Arc { start, end, centre, sense }, Element::Arc { start: from, .. }) => {
            if start == end && element.start() != element.end() {
                return false;
            }
            // Both ends still stand in the sector of the element, in their order.
            let at = |p: Point| {
                let turned = sweep(from - centre, p - centre, sense);
                let slack = 2.0 * TRACE / (from - centre).norm().min((start - centre).norm());
                if turned > std::f64::consts::TAU - slack { 0.0 } else { turned }
            };
            let whole = element.sweep();
            let turned = if start == end { whole } else { way.sweep() };
            at(start) + turned <= whole + 4.0 * TRACE / (start - centre).norm()
        }
        (Element::Arc { .. }, Element::Line { .. }) => false,
    }
}

/// The element begun on a point it begins on but for a rounding: a full circle stays one.
fn snapped(element: &Element, at: Point) -> Element {
    match with_start(element, at) {
        Element::Arc { centre, sense, .. } if element.start() == element.end() => {
            Element::Arc { start: at, end: at, centre, sense }
        }
        other => other,
    }
}

fn with_start(element: &Element, at: Point) -> Element {
    match *element {
        Element::Line { end, .. } => Element::Line { start: at, end },
        Element::Arc { end, centre, sense, .. } => Element::Arc { start: at, end, centre, sense },
    }
}

fn with_end(element: &Element, at: Point) -> Element {
    match *element {
        Element::Line { start, .. } => Element::Line { start, end: at },
        Element::Arc { start, centre, sense, .. } => Element::Arc { start, end: at, centre, sense },
    }
}

/// Points nearer than this are one, mm: a nanometre.
const SAME: f64 = 1e-6;
/// Neighbours whose ends are nearer than this are joined half-way when their ways never meet, mm: half a micron.
const TRACE: f64 = 5e-4;
/// The cosine of a turn right back, less a rounding.
const ONE: f64 = 1.0 - 1e-12;
