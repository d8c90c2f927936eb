//! An entity's numbers made into elements in mm: lines and arcs as they are, all else within the tolerance.

use thiserror::Error;

use crate::geometry::biarc::{Fit, FitError, fit};
use crate::geometry::curve::Curve;
use crate::geometry::ellipse::Ellipse;
use crate::geometry::spline::{Spline, SplineError};
use crate::geometry::{Element, Point, Sense, Vector};

use super::entity::{Facing, Figure, Nurbs, Vertex};
use super::placement::{Placement, direction};

/// Why an entity has no elements.
#[derive(Clone, Debug, Error, PartialEq)]
pub(super) enum TraceError {
    #[error("its plane is tilted against the drawing's")]
    Tilted,
    #[error("{0}")]
    Spline(#[from] SplineError),
    #[error("it is a spline by {0} points to run through, without control points")]
    FitPoints(usize),
    #[error("{0}")]
    Fit(#[from] FitError),
    #[error("its radius {0} is not positive")]
    Radius(f64),
    #[error("the ratio of its axes, {0}, is not positive")]
    Ratio(f64),
    #[error("it lies more than {FAR} mm out, or is drawn with numbers that are too large")]
    Far,
}

/// Beyond this a coordinate has fewer digits than a micron needs, mm.
const FAR: f64 = 1e8;

/// The elements of a figure that is cut; empty when it has no length.
pub(super) fn trace(figure: &Figure, placement: &Placement, with: &Fit) -> Result<Vec<Element>, TraceError> {
    let elements = match figure {
        Figure::Line { start, end } => {
            vec![Element::Line { start: placement.point(*start), end: placement.point(*end) }]
        }
        Figure::Arc { centre, radius, from, to, facing } => {
            round(*centre, *radius, Some([*from, *to]), *facing, placement, with)?
        }
        Figure::Circle { centre, radius, facing } => round(*centre, *radius, None, *facing, placement, with)?,
        Figure::Ellipse { centre, major, ratio, from, to, facing } => {
            let left = match facing {
                Facing::Up => Vector::new(-major[1], major[0]),
                Facing::Down => Vector::new(major[1], -major[0]),
                Facing::Tilted => return Err(TraceError::Tilted),
            };
            // A ratio beyond 1 breaks the format's own rule, and means what it says.
            if *ratio <= 0.0 {
                return Err(TraceError::Ratio(*ratio));
            }
            let (a, b) = (Vector::new(major[0], major[1]), left * *ratio);
            ellipse(
                placement.point(*centre),
                placement.direction(a),
                placement.direction(b),
                [*from, *to],
                with,
            )?
        }
        Figure::Polyline { vertices, closed, facing } => {
            polyline(vertices, *closed, *facing, placement, with)?
        }
        Figure::Spline(nurbs) => spline(nurbs, placement, with)?,
        Figure::Insert(_) | Figure::Uncut(_) => Vec::new(),
    };
    // An arc may lead far out between ends that are near.
    let all_near = |e: &Element| e.radius().is_none_or(f64::is_finite) && e.extent().into_iter().all(is_near);
    if !elements.iter().all(all_near) {
        return Err(TraceError::Far);
    }
    Ok(elements.into_iter().filter(|e| matches!(e, Element::Arc { .. }) || e.start() != e.end()).collect())
}

/// A part of an ellipse; what lies too far out is not even tried.
fn ellipse(
    centre: Point,
    a: Vector,
    b: Vector,
    [from, to]: [f64; 2],
    with: &Fit,
) -> Result<Vec<Element>, TraceError> {
    if !(is_near(centre) && is_near(centre + a) && is_near(centre + b)) {
        return Err(TraceError::Far);
    }
    curve(&Ellipse::new(centre, a, b, from, to), with)
}

fn is_near(p: Point) -> bool {
    p.x.abs() <= FAR && p.y.abs() <= FAR
}

fn curve(of: &impl Curve, with: &Fit) -> Result<Vec<Element>, TraceError> {
    Ok(fit(of, with)?)
}

/// A circle, or a part of it between two angles in degrees; equal ones mean all of it.
fn round(
    centre: [f64; 2],
    radius: f64,
    angles: Option<[f64; 2]>,
    facing: Facing,
    placement: &Placement,
    with: &Fit,
) -> Result<Vec<Element>, TraceError> {
    if radius <= 0.0 {
        return Err(TraceError::Radius(radius));
    }
    let placement = placement.facing(facing).ok_or(TraceError::Tilted)?;
    let [from, to] = angles.unwrap_or([0.0, 360.0]);
    let image = placement.point(centre);
    if !placement.keeps_circles() {
        let (a, b) = (placement.direction(Vector::x()) * radius, placement.direction(Vector::y()) * radius);
        return ellipse(image, a, b, [from.to_radians(), to.to_radians()], with);
    }
    let at = |angle: f64| image + placement.direction(direction(angle) * radius);
    let sense = if placement.mirrors() { Sense::Clockwise } else { Sense::CounterClockwise };
    let start = at(from);
    let turn = libm::fmod(to - from, 360.0);
    let end = if turn == 0.0 { start } else { at(to) };
    // The ends of an arc so small or so far out may be one, and it would be a circle.
    if turn != 0.0 && start == end {
        return Ok(Vec::new());
    }
    Ok(vec![Element::Arc { start, end, centre: image, sense }])
}

fn polyline(
    vertices: &[Vertex],
    closed: bool,
    facing: Facing,
    placement: &Placement,
    with: &Fit,
) -> Result<Vec<Element>, TraceError> {
    let placement = placement.facing(facing).ok_or(TraceError::Tilted)?;
    let mut elements = Vec::with_capacity(vertices.len());
    let legs = if closed { vertices.len() } else { vertices.len().saturating_sub(1) };
    for n in 0..legs {
        let (from, to) = (vertices[n], vertices[(n + 1) % vertices.len()]);
        let [start, end] = [placement.point(from.at), placement.point(to.at)];
        if start == end {
            continue;
        }
        let bulge = from.bulge;
        if bulge.abs() < STRAIGHT {
            elements.push(Element::Line { start, end });
            continue;
        }
        // The centre lies beside the middle of the chord, to its left for a positive bulge less than 1.
        let chord = Vector::new(to.at[0] - from.at[0], to.at[1] - from.at[1]);
        let middle = Vector::new(from.at[0] + to.at[0], from.at[1] + to.at[1]) * 0.5;
        let beside = Vector::new(-chord.y, chord.x) * ((1.0 - bulge * bulge) / (4.0 * bulge));
        let centre = middle + beside;
        if placement.keeps_circles() {
            let left = (bulge > 0.0) != placement.mirrors();
            let sense = if left { Sense::CounterClockwise } else { Sense::Clockwise };
            elements.push(Element::Arc { start, end, centre: placement.point([centre.x, centre.y]), sense });
        } else {
            let seen = Vector::new(from.at[0], from.at[1]) - centre;
            let left = Vector::new(-seen.y, seen.x) * bulge.signum();
            let image = placement.point([centre.x, centre.y]);
            let (a, b) = (placement.direction(seen), placement.direction(left));
            let made = ellipse(image, a, b, [0.0, 4.0 * libm::atan(bulge.abs())], with)?;
            // The vertices themselves are the ends.
            extend_between(&mut elements, made, start, end);
        }
    }
    Ok(elements)
}

/// Adds elements whose ends are replaced by two points that are the same but for a rounding.
fn extend_between(elements: &mut Vec<Element>, mut made: Vec<Element>, from: Point, to: Point) {
    if let Some(Element::Line { start, .. } | Element::Arc { start, .. }) = made.first_mut() {
        *start = from;
    }
    if let Some(Element::Line { end, .. } | Element::Arc { end, .. }) = made.last_mut() {
        *end = to;
    }
    elements.append(&mut made);
}

fn spline(nurbs: &Nurbs, placement: &Placement, with: &Fit) -> Result<Vec<Element>, TraceError> {
    if nurbs.controls.is_empty() && nurbs.fit_points > 0 {
        return Err(TraceError::FitPoints(nurbs.fit_points));
    }
    let degree = usize::try_from(nurbs.degree).unwrap_or(0);
    let controls: Vec<Point> = nurbs.controls.iter().map(|&p| placement.point(p)).collect();
    if !controls.iter().all(|&p| is_near(p)) {
        return Err(TraceError::Far);
    }
    curve(&Spline::new(degree, nurbs.knots.clone(), &controls, &nurbs.weights)?, with)
}

/// A bulge smaller than this is none: on a metre, less than a tenth of a nanometre.
const STRAIGHT: f64 = 1e-10;
