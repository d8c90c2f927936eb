//! What a control makes of a 4B program with an offset keyed in: the path of the wire.
//!
//! An adapter between readers and writers: motions with flags go in, motions of the wire without flags come out, one
//! contour held at a time. An arc flagged `D` gets the radius R + F, one flagged `DD` R − F, about the same centre, and
//! the lines between are shifted; so the outline has to run on without corners. With a taper keyed in, the wire's upper
//! end runs beside the same outline at F − A where the lead-in is flagged `D`, at F + A where it is flagged `DD`.
//!
//! *Unverified for any control:* the lead-in is the straight move before the outline, and goes from where the wire stands
//! to the shifted start; the lead-out goes from the shifted end to where it ends as programmed, so that the wire is back
//! in its start hole. Without a lead-out the wire goes on from where it stands. What is said of a wire outside or inside
//! is the source's; which end of the wire A belongs to is our reading.

use super::outline::{CORNER_HELP, Outlined, first_corner, side_of, size, told};
use crate::geometry::{Element, Point, Vector};
use crate::motion::runs::{Between, ContourError, Contourwise, Rework, Run};
use crate::motion::{Act, Flag, Motion, Side};

/// What an operator keys into the control, mm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Keyed {
    /// F, the offset: positive outside the outline (punch), negative inside (die).
    pub offset: f64,
    /// A, how far the taper sets the wire's upper end off against the lower one; none for a wire upright.
    pub taper: Option<f64>,
}

impl Keyed {
    /// F for a part's outline, mm: half the wire and the spark gap, less the clearance of the fit to one side.
    #[must_use]
    pub fn offset_for(wire_diameter: f64, gap: f64, clearance: f64) -> f64 {
        wire_diameter / 2.0 + gap - clearance
    }

    /// A for a taper of `degrees` between two guides `height` mm apart.
    #[must_use]
    pub fn taper_for(height: f64, degrees: f64) -> f64 {
        height * libm::tan(degrees.to_radians())
    }
}

/// The wire's path of a 4B program.
pub fn beside<I, E>(motions: I, keyed: Keyed) -> Contourwise<I, Beside>
where
    I: Iterator<Item = Result<Motion, E>>,
    E: Into<ContourError>,
{
    Contourwise::new(motions, Beside { keyed, standing: None })
}

/// Sets contours off.
#[derive(Debug)]
pub struct Beside {
    keyed: Keyed,
    /// Where the wire's ends stand, when that is not where the program is.
    standing: Option<Wire>,
}

/// The two ends of the wire; without a taper both stand alike.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Wire {
    lower: Point,
    upper: Option<Point>,
}

impl Rework for Beside {
    fn run(&mut self, run: Run) -> Result<Vec<Motion>, ContourError> {
        let keyed = self.keyed;
        if let (Some(first), false) =
            (run.motions.first(), keyed.offset.is_finite() && keyed.taper.is_none_or(f64::is_finite))
        {
            return Err(ContourError::at(first, "the offset keyed in is no number", "give it in mm"));
        }
        let parts = Outlined::of(&run);
        if parts.is_way() || keyed == Keyed::default() {
            return run.motions.into_iter().map(|motion| self.go_on(motion)).collect();
        }
        let mut ways = self.ways(&run, &parts)?.into_iter();
        let mut motions = Vec::with_capacity(run.motions.len());
        for mut motion in run.motions {
            if let Act::Move { element, upper, flag, .. } = &mut motion.act {
                *flag = None;
                // A move without length leaves the wire where it is.
                if element.length() > 0.0 {
                    if let Some(way) = ways.next() {
                        (*element, *upper) = (way.lower, way.upper);
                        let upper = way.upper.map(|upper| upper.end());
                        self.standing = Some(Wire { lower: way.lower.end(), upper });
                    }
                } else {
                    let at = self.standing.map_or(element.start(), |wire| wire.lower);
                    *element = Element::Line { start: at, end: at };
                }
            }
            motions.push(motion);
        }
        Ok(motions)
    }

    fn between(&mut self, motion: Motion) -> Result<Between, ContourError> {
        self.go_on(motion).map(Between::One)
    }
}

/// Where both ends of the wire go.
#[derive(Clone, Copy, Debug)]
struct Way {
    lower: Element,
    upper: Option<Element>,
}

impl Wire {
    fn upright(lower: Point) -> Self {
        Self { lower, upper: None }
    }
}

impl Beside {
    /// A motion that is beside no outline, from where the wire stands.
    fn go_on(&mut self, mut motion: Motion) -> Result<Motion, ContourError> {
        let place = motion.clone();
        if let Act::Move { element, upper, flag, .. } = &mut motion.act {
            *flag = None;
            let (lower, to) = (*element, element.end());
            let Some(wire) = self.standing.take().filter(|wire| *wire != Wire::upright(lower.start())) else {
                return Ok(motion);
            };
            let Element::Line { .. } = lower else { return Err(ContourError::at(&place, CURVED, LEAD_HELP)) };
            *element = Element::Line { start: wire.lower, end: to };
            *upper = wire.upper.map(|start| Element::Line { start, end: to });
        }
        Ok(motion)
    }

    /// The way of each move of a run that has a length.
    fn ways(&self, run: &Run, parts: &Outlined) -> Result<Vec<Way>, ContourError> {
        let motion = |cut: usize| &run.motions[parts.cuts[cut].0];
        let (from, to) = (parts.outline.start, parts.outline.end);
        if from == 0 {
            let message = "no straight move leads to the outline, so nothing brings the wire beside it";
            return Err(ContourError::at(motion(0), message, LEAD_HELP));
        }
        for lead in [from - 1, to] {
            if let Some((_, Element::Arc { .. })) = parts.cuts.get(lead) {
                return Err(ContourError::at(motion(lead), CURVED, LEAD_HELP));
            }
        }
        let side = told_side(run, parts)?;
        let upper = match (self.keyed.taper, flag(motion(from - 1))) {
            (None, _) => None,
            (Some(taper), Some(Flag::D)) => Some(self.keyed.offset - taper),
            (Some(taper), Some(Flag::DD)) => Some(self.keyed.offset + taper),
            (Some(_), None) => {
                return Err(ContourError::at(
                    motion(from - 1),
                    "a taper is keyed in, and the lead-in does not say its sense",
                    "write D (positive) or DD (inverse) on the straight move that leads to the outline",
                ));
            }
        };
        let lower = shifted(run, parts, side, self.keyed.offset)?;
        for (&(n, element), way) in parts.cuts[parts.outline.clone()].iter().zip(&lower) {
            let (Element::Arc { centre, .. }, Some(radius)) = (element, element.radius()) else { continue };
            // Beyond the centre an arc begins on the other side of it.
            let seen = (way.start() - centre).dot(&(element.start() - centre)) / radius;
            if seen < LEAST_RADIUS_MM {
                return Err(ContourError::at(
                    &run.motions[n],
                    format!("the radius of {radius:.3} mm becomes {seen:.3} mm"),
                    "the wire cannot enter this arc: make it larger, or key in a smaller offset",
                ));
            }
        }
        let upper = upper.map(|offset| shifted(run, parts, side, offset)).transpose()?;
        let mut standing = self.standing;
        let ways = parts.cuts.iter().enumerate().map(|(n, &(_, element))| {
            let stands = standing.take().unwrap_or(Wire::upright(element.start()));
            let way = if parts.outline.contains(&n) {
                Way { lower: lower[n - from], upper: upper.as_ref().map(|upper| upper[n - from]) }
            } else {
                let to = |beside: &[Element]| if n + 1 == from { beside[0].start() } else { element.end() };
                let tilted = upper.as_ref().filter(|_| n + 1 == from || n == parts.outline.end);
                Way {
                    lower: with_ends(element, stands.lower, to(&lower)),
                    upper: tilted
                        .map(|upper| with_ends(element, stands.upper.unwrap_or(stands.lower), to(upper))),
                }
            };
            standing = Some(Wire { lower: way.lower.end(), upper: way.upper.map(|upper| upper.end()) });
            way
        });
        Ok(ways.collect())
    }
}

/// The side on which the arcs of an outline put the wire at a positive offset.
fn told_side(run: &Run, parts: &Outlined) -> Result<Side, ContourError> {
    let mut told = None;
    for &(n, element) in &parts.cuts[parts.outline.clone()] {
        let Element::Arc { sense, .. } = element else { continue };
        let motion = &run.motions[n];
        let Some(flag) = flag(motion) else {
            return Err(ContourError::at(
                motion,
                "an arc without a flag, and an offset is keyed in",
                "write R and D (convex) or DD (concave); a 3B contour has its offset in its numbers already",
            ));
        };
        let side = side_of(flag, sense);
        if *told.get_or_insert(side) != side {
            return Err(ContourError::at(
                motion,
                "the flag of this arc puts the wire on the other side than those before it",
                "convex arcs of the outline are D, concave ones DD",
            ));
        }
    }
    told.ok_or_else(|| {
        ContourError::at(
            &run.motions[parts.cuts[parts.outline.start].0],
            "no arc of the contour tells on which side the wire runs",
            "only arcs take up an offset: put one of at least the offset into each corner",
        )
    })
}

/// The way beside an outline at an offset. An arc whose radius would be used up is run on the other side of its centre, as
/// the upper end does in a corner that comes to a point below it.
fn shifted(run: &Run, parts: &Outlined, side: Side, offset: f64) -> Result<Vec<Element>, ContourError> {
    let cuts = &parts.cuts[parts.outline.clone()];
    let right = if side == Side::Right { offset } else { -offset };
    let (Some(first), Some(last)) = (cuts.first(), cuts.last()) else { return Ok(Vec::new()) };
    let elements: Vec<Element> = cuts.iter().map(|cut| cut.1).collect();
    if let Some((n, turned)) = first_corner(&elements, parts.closed) {
        return Err(ContourError::at(&run.motions[cuts[n].0], told(turned), CORNER_HELP));
    }
    let mut beside: Vec<Element> = Vec::with_capacity(cuts.len());
    for (n, &(index, element)) in cuts.iter().enumerate() {
        let before = n.checked_sub(1).or_else(|| parts.closed.then(|| cuts.len() - 1)).map(|n| cuts[n].1);
        let after = cuts.get(n + 1).or(parts.closed.then_some(first)).map(|cut| cut.1);
        let start = match beside.last() {
            Some(previous) => previous.end(),
            None => element.start() + normal(before, Some(element)) * right,
        };
        let end = match element {
            Element::Arc { start: from, end: to, .. } if from == to => start,
            _ => element.end() + normal(Some(element), after) * right,
        };
        let way = with_ends(element, start, end);
        if let Element::Arc { centre, .. } = element {
            // A cone's tip: the wire's end only turns about it.
            if (start - centre).norm() < LEAST_RADIUS_MM {
                beside.push(Element::Line { start, end });
                continue;
            }
            if (way.sweep() - element.sweep()).abs() > std::f64::consts::PI {
                let message = "an arc whose ends are too near to tell how far it goes";
                return Err(ContourError::at(
                    &run.motions[index],
                    message,
                    "cut it as a full circle, or in two",
                ));
            }
        }
        beside.push(way);
    }
    // A contour that closed on the micron closes again.
    if let (true, Some(end)) = (first.1.start() == last.1.end(), beside.first().map(Element::start))
        && let Some(last) = beside.last_mut()
    {
        *last = with_ends(*last, last.start(), end);
    }
    Ok(beside)
}

/// The direction to the right of the way at a node, by the neighbour whose direction is known better.
fn normal(before: Option<Element>, after: Option<Element>) -> Vector {
    let known = |element: Option<Element>| element.as_ref().map_or(0.0, size);
    let right = |heading: Vector| Vector::new(heading.y, -heading.x);
    let leaving = before.map(|e| right(e.heading_at_end()));
    let entering = after.map(|e| right(e.heading_at_start()));
    if known(before) > known(after) { leaving.or(entering) } else { entering.or(leaving) }.unwrap_or_default()
}

fn with_ends(element: Element, start: Point, end: Point) -> Element {
    match element {
        Element::Line { .. } => Element::Line { start, end },
        Element::Arc { centre, sense, .. } => Element::Arc { start, end, centre, sense },
    }
}

fn flag(motion: &Motion) -> Option<Flag> {
    match motion.act {
        Act::Move { flag, .. } => flag,
        _ => None,
    }
}

/// Half a pulse: a smaller circle is none.
const LEAST_RADIUS_MM: f64 = 0.000_5;

const CURVED: &str = "the move that leads the wire to or from the outline is not straight";
const LEAD_HELP: &str =
    "lead in and out on a straight move of its own between the start hole and the outline";
