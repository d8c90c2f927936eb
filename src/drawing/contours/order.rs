//! In which order contours are cut, where each begins and which way it is run.
//!
//! What lies in a contour is cut before it: once the outline is cut, the part hangs on nothing. Among those that may come
//! next, the one whose beginning is nearest to where the wire stands does; that shortens the way between contours, though
//! it does not find the shortest.

use crate::drawing::finding::{Finding, Severity, named};
use crate::geometry::{Element, Path, Point, Sense};

use super::nearest::Nearest;
use super::{Contour, Joining, Order, Start};

/// The contours in order; `parents` tells which contour each lies in.
pub(super) fn ordered(
    mut contours: Vec<Contour>,
    parents: &[Option<usize>],
    joining: &Joining,
    report: &mut Vec<Finding>,
) -> Vec<Contour> {
    for contour in contours.iter_mut().filter(|c| c.closed) {
        let wanted = if contour.depth.is_multiple_of(2) {
            joining.direction.outlines
        } else {
            joining.direction.holes
        };
        if wanted.is_some_and(|sense| sense != contour.path.sense()) {
            contour.path = contour.path.reversed();
        }
    }
    let mut fixed = vec![joining.start == Start::AsDrawn; contours.len()];
    if let Start::At(points) = &joining.start {
        for &point in points {
            begin_at(&mut contours, &mut fixed, point, joining.join, report);
        }
    }
    match joining.order {
        Order::HolesFirst => nearest_first(contours, parents, &fixed),
        Order::AsDrawn | Order::InSequence => {
            let mut at = Point::origin();
            for (contour, fixed) in contours.iter_mut().zip(fixed) {
                if contour.closed && !fixed {
                    let distance = |n: usize| (contour.path.elements()[n].start() - at).norm_squared();
                    let count = contour.path.elements().len();
                    let nearest = (0..count).min_by(|&a, &b| distance(a).total_cmp(&distance(b)));
                    contour.path = contour.path.clone().begun_at(nearest.unwrap_or(0));
                }
                at = contour.path.end();
            }
            contours
        }
    }
}

fn nearest_first(contours: Vec<Contour>, parents: &[Option<usize>], fixed: &[bool]) -> Vec<Contour> {
    // Every node of a closed contour may be its start. They are numbered on from contour to contour.
    let mut nodes = Vec::new();
    let mut owners = Vec::new();
    let mut firsts = vec![0];
    for (n, contour) in contours.iter().enumerate() {
        let count = if contour.closed && !fixed[n] { contour.path.elements().len() } else { 1 };
        nodes.extend(
            contour.path.elements()[..count].iter().zip(nodes.len() as u32..).map(|(e, k)| (e.start(), k)),
        );
        owners.resize(nodes.len(), n);
        firsts.push(nodes.len());
    }
    let mut tree = Nearest::of(nodes);
    let mut places = vec![0; owners.len()];
    for (place, node) in tree.places() {
        places[node as usize] = place;
    }
    let places = |n: usize| &places[firsts[n]..firsts[n + 1]];
    let mut inside = vec![0usize; contours.len()];
    for parent in parents.iter().flatten() {
        inside[*parent] += 1;
    }
    for n in (0..contours.len()).filter(|&n| inside[n] == 0) {
        places(n).iter().for_each(|&place| tree.set(place, true));
    }
    let mut left: Vec<Option<Contour>> = contours.into_iter().map(Some).collect();
    let mut ordered = Vec::with_capacity(left.len());
    let mut at = Point::origin();
    while let Some(node) = tree.find(at) {
        let n = owners[node as usize];
        places(n).iter().for_each(|&place| tree.set(place, false));
        if let Some(mut contour) = left[n].take() {
            contour.path = contour.path.begun_at(node as usize - firsts[n]);
            at = contour.path.end();
            ordered.push(contour);
        }
        if let Some(parent) = parents[n] {
            inside[parent] -= 1;
            if inside[parent] == 0 {
                places(parent).iter().for_each(|&place| tree.set(place, true));
            }
        }
    }
    ordered
}

/// Begins the closed contour nearest to a point there, in the middle of an element if need be.
fn begin_at(
    contours: &mut [Contour],
    fixed: &mut [bool],
    point: Point,
    join: f64,
    report: &mut Vec<Finding>,
) {
    let closed = contours.iter().enumerate().filter(|(_, c)| c.closed);
    let nearest = closed.map(|(n, c)| (c.path.distance(point), n)).min_by(|a, b| a.0.total_cmp(&b.0));
    let Some((distance, n)) = nearest else {
        let message = format!("no closed contour could begin at {}", named(point));
        report.push(Finding::new(Severity::Warning, "start-nowhere", message).at(point));
        return;
    };
    if distance > join {
        let message = format!("the start {} lies {distance:.4} mm beside the nearest contour", named(point));
        report.push(
            Finding::new(Severity::Warning, "start-beside", message)
                .help("the contour begins at its point nearest to it")
                .at(point)
                .line(contours[n].line),
        );
    }
    if fixed[n] {
        let message = format!("the contour at {} is given a second start", named(point));
        report.push(Finding::new(Severity::Warning, "start-twice", message).at(point).line(contours[n].line));
    }
    fixed[n] = true;
    contours[n].path = begun_near(&contours[n].path, point, join);
}

fn begun_near(path: &Path, point: Point, join: f64) -> Path {
    let elements = path.elements();
    let distance = |e: &Element| e.distance(point);
    let Some(n) =
        (0..elements.len()).min_by(|&a, &b| distance(&elements[a]).total_cmp(&distance(&elements[b])))
    else {
        return path.clone();
    };
    let element = elements[n];
    let foot = element.nearest(point);
    let near = |p: Point| (p - foot).norm() <= join;
    match element {
        // A circle begins anywhere.
        Element::Arc { start, end, centre, sense } if start == end && elements.len() == 1 => {
            Path::new(vec![Element::Arc { start: foot, end: foot, centre, sense }])
                .unwrap_or_else(|| path.clone())
        }
        _ if near(element.start()) => path.clone().begun_at(n),
        _ if near(element.end()) => path.clone().begun_at(n + 1),
        _ => {
            let [first, second] = split(element, foot);
            let mut begun = vec![second];
            begun.extend_from_slice(&elements[n + 1..]);
            begun.extend_from_slice(&elements[..n]);
            begun.push(first);
            Path::new(begun).unwrap_or_else(|| path.clone())
        }
    }
}

/// The two parts of an element before and after a point on it.
fn split(element: Element, at: Point) -> [Element; 2] {
    match element {
        Element::Line { start, end } => [Element::Line { start, end: at }, Element::Line { start: at, end }],
        Element::Arc { start, end, centre, sense } => {
            let part = |start: Point, end: Point, sense: Sense| Element::Arc { start, end, centre, sense };
            [part(start, at, sense), part(at, end, sense)]
        }
    }
}
