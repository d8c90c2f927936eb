//! Corner arcs: what makes an outline with corners one that a 4B control can set off.
//!
//! An arc tangent to both sides goes into every corner, lines and arcs alike; both sides are cut back to where it touches
//! them. This changes the part: the corner is round by the radius asked for. Corners that are none stay as they are.

use super::outline::corner;
use crate::geometry::{Element, Point, Sense, Vector, sweep};

/// An outline with arcs in its corners: each element with the place it had among those given; a corner arc has the place
/// of the element before it, and the arc in the corner where a closed outline begins is the last.
///
/// # Errors
///
/// With the place of the first element behind a corner that has no room for the arc.
pub(super) fn rounded(
    elements: &[Element],
    closed: bool,
    radius: f64,
) -> Result<Vec<(usize, Element)>, NoRoom> {
    let count = elements.len();
    let mut cut: Vec<Element> = elements.to_vec();
    let mut arcs: Vec<Option<Element>> = vec![None; count];
    for n in 0..count {
        let next = if n + 1 < count { n + 1 } else { 0 };
        if next == 0 && !closed {
            break;
        }
        let (before, after) = (&elements[n], &elements[next]);
        let Some(turned) = corner(before, after) else { continue };
        let arc = fillet(before, after, turned, radius).ok_or(NoRoom { behind: next })?;
        cut[n] = with_ends(cut[n], cut[n].start(), arc.start());
        cut[next] = with_ends(cut[next], arc.end(), cut[next].end());
        arcs[n] = Some(arc);
    }
    let mut outline = Vec::with_capacity(2 * count);
    for (n, (whole, cut)) in elements.iter().zip(cut).enumerate() {
        // Both arcs of an element may want the same piece of it.
        if !runs_on(whole, &cut) {
            return Err(NoRoom { behind: n });
        }
        outline.push((n, cut));
        outline.extend(arcs[n].map(|arc| (n, arc)));
    }
    Ok(outline)
}

/// A corner without room for its arc.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) struct NoRoom {
    /// The place of the element behind the corner.
    pub(super) behind: usize,
}

/// The arc of a radius that touches two elements at the corner between them.
fn fillet(before: &Element, after: &Element, turned: f64, radius: f64) -> Option<Element> {
    let (sense, left) =
        if turned > 0.0 { (Sense::CounterClockwise, radius) } else { (Sense::Clockwise, -radius) };
    let at = before.end();
    let centres = meetings(Locus::beside(before, left)?, Locus::beside(after, left)?);
    let fits = |centre: Point| -> Option<(f64, Element)> {
        let (start, end) = (touch(before, centre)?, touch(after, centre)?);
        let arc = Element::Arc { start, end, centre, sense };
        let tangent = (arc.heading_at_start() - heading_at(before, start)).norm() < SQUARE
            && (arc.heading_at_end() - heading_at(after, end)).norm() < SQUARE;
        (tangent && start != end).then_some(((start - at).norm() + (end - at).norm(), arc))
    };
    let fitting = centres.into_iter().flatten().filter_map(fits);
    fitting.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, arc)| arc)
}

/// Where a circle's centre may lie that touches an element.
#[derive(Clone, Copy, Debug)]
enum Locus {
    Line { at: Point, heading: Vector },
    Circle { centre: Point, radius: f64 },
}

impl Locus {
    fn beside(element: &Element, left: f64) -> Option<Self> {
        match *element {
            Element::Line { start, .. } => {
                let heading = element.heading_at_start();
                Some(Self::Line { at: start + Vector::new(-heading.y, heading.x) * left, heading })
            }
            Element::Arc { centre, sense, .. } => {
                let grows = if sense == Sense::CounterClockwise { -left } else { left };
                let radius = element.radius()? + grows;
                (radius > 0.0).then_some(Self::Circle { centre, radius })
            }
        }
    }
}

fn meetings(a: Locus, b: Locus) -> [Option<Point>; 2] {
    match (a, b) {
        (Locus::Line { at, heading }, Locus::Line { at: other, heading: way }) => {
            let across = heading.x * way.y - heading.y * way.x;
            let between = other - at;
            let t = (between.x * way.y - between.y * way.x) / across;
            [t.is_finite().then(|| at + heading * t), None]
        }
        (Locus::Line { at, heading }, Locus::Circle { centre, radius })
        | (Locus::Circle { centre, radius }, Locus::Line { at, heading }) => {
            let foot = at + heading * (centre - at).dot(&heading);
            let reach = (radius * radius - (foot - centre).norm_squared()).sqrt();
            either(foot, heading, reach)
        }
        (Locus::Circle { centre, radius }, Locus::Circle { centre: second, radius: other }) => {
            let way = second - centre;
            let distance = way.norm();
            let along = (distance * distance + radius * radius - other * other) / (2.0 * distance);
            let reach = (radius * radius - along * along).sqrt();
            either(centre + way * (along / distance), Vector::new(-way.y, way.x) / distance, reach)
        }
    }
}

/// Two points on either side of one; none where they do not exist.
fn either(middle: Point, heading: Vector, reach: f64) -> [Option<Point>; 2] {
    let there = reach.is_finite() && middle.x.is_finite() && middle.y.is_finite();
    [there.then(|| middle - heading * reach), there.then(|| middle + heading * reach)]
}

/// Where a circle about a centre touches an element; none where that is off its ends.
fn touch(element: &Element, centre: Point) -> Option<Point> {
    let at = match *element {
        Element::Line { start, .. } => {
            let heading = element.heading_at_start();
            start + heading * (centre - start).dot(&heading)
        }
        Element::Arc { centre: own, .. } => {
            let way = centre - own;
            own + way * (element.radius()? / way.norm())
        }
    };
    (at.x.is_finite() && element.distance(at) < ON).then_some(at)
}

/// The direction of motion along an element at one of its points.
fn heading_at(element: &Element, at: Point) -> Vector {
    match element {
        Element::Line { .. } => element.heading_at_start(),
        Element::Arc { .. } => with_ends(*element, at, at).heading_at_start(),
    }
}

/// Whether what is left of an element runs as the whole did. Of a line nothing has to be left: its arcs touch.
fn runs_on(whole: &Element, cut: &Element) -> bool {
    if whole == cut {
        return true;
    }
    match (*whole, *cut) {
        (Element::Line { .. }, Element::Line { start, end }) => {
            (end - start).dot(&whole.heading_at_start()) > -SAME
        }
        (Element::Arc { start, centre, sense, .. }, Element::Arc { start: from, end: to, .. }) => {
            let turned = |p: Point| {
                let angle = sweep(start - centre, p - centre, sense);
                if angle > std::f64::consts::TAU - 1e-9 { 0.0 } else { angle }
            };
            let end = if to == whole.end() { whole.sweep() } else { turned(to) };
            (end - turned(from)) * (start - centre).norm() > LEAST
        }
        (Element::Line { .. }, Element::Arc { .. }) | (Element::Arc { .. }, Element::Line { .. }) => false,
    }
}

fn with_ends(element: Element, start: Point, end: Point) -> Element {
    match element {
        Element::Line { .. } => Element::Line { start, end },
        Element::Arc { centre, sense, .. } => Element::Arc { start, end, centre, sense },
    }
}

/// A touching point so near to an element lies on it, mm; drawn ends are whole microns.
const ON: f64 = 0.001;
/// What has to be left of an arc, mm: a pulse.
const LEAST: f64 = 0.001;
/// A nanometre is none, mm.
const SAME: f64 = 1e-6;
/// How far headings of length 1 may differ that are the same.
const SQUARE: f64 = 1e-3;
