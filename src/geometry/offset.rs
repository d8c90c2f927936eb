//! Outlines at a distance: the wire beside the contour it cuts.
//!
//! The offset is worked out by `cavalier_contours`, which keeps arcs arcs and cuts off what the wire cannot reach; a
//! contour may come apart into several outlines or vanish. What is added here is what a machinist must know besides:
//! which elements of the contour the wire never touches, where, and which wire would; and which element each part of
//! an outline comes from. Arcs get back the very centres of the contour, so that radii differ by the offset exactly.
//!
//! The library computes with the platform's own trigonometry, so nodes may differ in the last bits between platforms:
//! what becomes blocks goes through [`Outline::rounded`] first. A contour that meets itself has no inside and is refused.

mod attribution;
mod mitre;
mod reach;
mod source;
mod unreached;

use cavalier_contours::core::Control;
use cavalier_contours::polyline::{
    PlineIntersect, PlineOffsetOptions, PlineSelfIntersectOptions, PlineSource, Polyline,
};
use thiserror::Error;

use super::{Element, Path, Point};
use crate::units::Micrometres;
use source::Source;

/// What stands at a distance from a contour.
#[derive(Clone, Debug, PartialEq)]
pub struct Offset {
    /// The outlines: one, several where the contour comes apart, none where nothing of it is left.
    ///
    /// Each runs as the contour runs, and begins with its part nearest to the contour's beginning.
    pub outlines: Vec<Outline>,
    /// The parts of the contour that the wire never touches and where more than a micron of material stays.
    pub unreached: Vec<Unreached>,
    /// How many inside corners get the wire's own radius, because they are sharp and no wire is.
    pub filled_corners: usize,
}

/// One outline, and where each of its elements comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// The way of the wire's centre.
    pub path: Path,
    /// For each element of the way, what it runs beside.
    pub origins: Vec<Origin>,
}

/// What an element of an outline runs beside.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Origin {
    /// The element of the contour with this index, from 0.
    Element(usize),
    /// The outside corner at the end of the element with this index.
    Corner(usize),
}

/// A part of a contour that the wire does not touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unreached {
    /// The middle of the part, on the contour, mm.
    pub at: Point,
    /// The index of the first element that is not touched, or not all along.
    pub first: usize,
    /// The index of the last one; smaller than `first` where the part runs over the contour's beginning.
    pub last: usize,
    /// The largest offset with which each of these elements is still touched somewhere, mm, to a micron; for a
    /// throat that only closes, the largest that passes it.
    pub largest: f64,
}

/// How the wire goes round an outside corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Corners {
    /// On an arc about the corner: the corner stays sharp, and the wire never farther from it than the offset.
    Round,
    /// On straight, along both tangents to where they meet.
    Sharp {
        /// How far the meeting point may lie from the corner, in offsets; beyond it the arc stays. √2 is a square corner.
        limit: f64,
    },
}

/// Why a contour has no offset.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum Impossible {
    /// The contour crosses or touches itself.
    #[error("the contour meets itself at X{:.4} Y{:.4}, in its elements {} and {}{}",
        .0[0].at.x, .0[0].at.y, .0[0].first + 1, .0[0].second + 1, others(.0.len()))]
    MeetsItself(Vec<Meeting>),
    /// A number of the contour, the offset or the corners' limit is not finite.
    #[error("{0} is not a number to reckon with")]
    NotFinite(&'static str),
    /// A number of the contour is so large that a micron is lost in it.
    #[error("the contour lies farther than 100 m from the origin")]
    TooFar,
}

/// A place where a contour meets itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// Where, mm.
    pub at: Point,
    /// The index of the one element, from 0.
    pub first: usize,
    /// The index of the other.
    pub second: usize,
}

/// The outlines at a distance from a contour, mm: to its left where it is positive, to its right where it is negative,
/// seen in the direction of motion. A distance of 0 is the contour itself.
///
/// An open contour has an outline from square beside its start to square beside its end.
///
/// # Errors
///
/// When the contour meets itself or a number is not one.
pub fn offset(path: &Path, left: f64, corners: Corners) -> Result<Offset, Impossible> {
    check_numbers(path, left, corners)?;
    if left == 0.0 {
        let origins = (0..path.elements().len()).map(Origin::Element).collect();
        let outlines = vec![Outline { path: path.clone(), origins }];
        return Ok(Offset { outlines, unreached: Vec::new(), filled_corners: 0 });
    }
    let source = Source::new(path, left);
    let options = PlineOffsetOptions { aabb_index: Some(&source.index), ..PlineOffsetOptions::new() };
    let found: Vec<Polyline> = source.polyline.parallel_offset_opt(left, &options);
    let mut outlines: Vec<_> =
        found.iter().filter_map(|outline| attribution::outline(&source, outline)).collect();
    outlines.sort_by_key(|outline| outline.origins.first().map(|origin| origin.order()));
    // An outline that keeps its distance and runs beside every element in turn, all along it, is the offset: where one
    // part of the contour went through another, the wire beside it would have been cut off.
    let whole = unreached::corners_of_whole(path, &source, &outlines);
    if whole != Some(0) {
        check_meetings(&source)?;
    }
    let (unreached, filled_corners) =
        whole.map_or_else(|| unreached::find(path, &source, &outlines), |filled| (Vec::new(), filled));
    if let Corners::Sharp { limit } = corners {
        outlines = outlines.into_iter().map(|outline| mitre::sharpened(outline, &source, limit)).collect();
    }
    Ok(Offset { outlines, unreached, filled_corners })
}

impl Origin {
    /// Its place in the order of the contour.
    fn order(self) -> usize {
        match self {
            Self::Element(n) => 2 * n,
            Self::Corner(n) => 2 * n + 1,
        }
    }

    /// The element it is, or whose end it goes round.
    #[must_use]
    pub fn element(self) -> usize {
        match self {
            Self::Element(n) | Self::Corner(n) => n,
        }
    }
}

impl Outline {
    /// The same outline with its nodes on whole microns, each by [`Micrometres::nearest`]; centres stay where they are.
    ///
    /// Elements shorter than that vanish; none is returned when nothing is left.
    #[must_use]
    pub fn rounded(&self) -> Option<Self> {
        let mut elements = Vec::with_capacity(self.path.elements().len());
        let mut origins = Vec::with_capacity(self.origins.len());
        for (element, origin) in self.path.elements().iter().zip(&self.origins) {
            let (start, end) = (on_grid(element.start()), on_grid(element.end()));
            let kept = match *element {
                Element::Line { .. } if start == end => None,
                Element::Line { .. } => Some(Element::Line { start, end }),
                // An arc shrunk to nothing must not become a full circle, nor a full circle nothing.
                Element::Arc { .. } if start == end && element.sweep() <= std::f64::consts::PI => None,
                Element::Arc { centre, sense, .. } => Some(Element::Arc { start, end, centre, sense }),
            };
            if let Some(kept) = kept {
                elements.push(kept);
                origins.push(*origin);
            }
        }
        Path::new(elements).map(|path| Self { path, origins })
    }
}

fn on_grid(point: Point) -> Point {
    Point::new(Micrometres::nearest(point.x).millimetres(), Micrometres::nearest(point.y).millimetres())
}

fn check_numbers(path: &Path, left: f64, corners: Corners) -> Result<(), Impossible> {
    if !left.is_finite() {
        return Err(Impossible::NotFinite("the offset"));
    }
    if matches!(corners, Corners::Sharp { limit } if !limit.is_finite()) {
        return Err(Impossible::NotFinite("the limit of sharp corners"));
    }
    let centre = |element: &Element| match *element {
        Element::Line { start, .. } => start,
        Element::Arc { centre, .. } => centre,
    };
    let numbers = |element: &Element| {
        let (start, end, centre) = (element.start(), element.end(), centre(element));
        [start.x, start.y, end.x, end.y, centre.x, centre.y]
    };
    let fits = |number: f64| number.abs() <= FARTHEST;
    if fits(left) && path.elements().iter().all(|element| numbers(element).into_iter().all(fits)) {
        return Ok(());
    }
    if path.elements().iter().any(|element| !numbers(element).into_iter().all(f64::is_finite)) {
        return Err(Impossible::NotFinite("a coordinate of the contour"));
    }
    Err(Impossible::TooFar)
}

fn check_meetings(source: &Source) -> Result<(), Impossible> {
    let mut meetings = Vec::new();
    // By themselves the options include every kind of meeting.
    let options =
        PlineSelfIntersectOptions { aabb_index: Some(&source.index), ..PlineSelfIntersectOptions::new() };
    let mut visitor = |meeting: PlineIntersect<f64>| {
        let (first, second, at) = match meeting {
            PlineIntersect::Basic(it) => (it.start_index1, it.start_index2, it.point),
            PlineIntersect::Overlapping(it) => (it.start_index1, it.start_index2, it.point1),
        };
        let element = |piece: usize| source.pieces[piece].element;
        meetings.push(Meeting {
            at: Point::new(at.x, at.y),
            first: element(first).min(element(second)),
            second: element(first).max(element(second)),
        });
        if meetings.len() < MEETINGS_MOST { Control::Continue } else { Control::Break(()) }
    };
    let _ = source.polyline.visit_self_intersects_opt(&mut visitor, &options);
    if meetings.is_empty() {
        return Ok(());
    }
    meetings.sort_by_key(|meeting| (meeting.first, meeting.second));
    Err(Impossible::MeetsItself(meetings))
}

fn others(count: usize) -> String {
    match count {
        0 | 1 => String::new(),
        2 => " (and in one more place)".to_owned(),
        more if more < MEETINGS_MOST => format!(" (and in {} more places)", more - 1),
        more => format!(" (and in {} more places at least)", more - 1),
    }
}

/// Meetings told at most: a scribble has one for every pair of strokes.
const MEETINGS_MOST: usize = 100;
/// Beyond 100 m a coordinate in mm has less than 10⁻¹¹ of a millimetre to spare for the library's comparisons.
const FARTHEST: f64 = 1e5;
/// Points nearer than this are one point to the library, mm: a hundredth of a micron.
const ONE_POINT: f64 = 1e-5;
/// Material that no one measures, mm: what is left uncut below it is not told.
const NEGLIGIBLE: f64 = 1e-3;

#[cfg(test)]
mod tests;
