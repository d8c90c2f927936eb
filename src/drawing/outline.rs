//! Lines and true circular arcs, one after the other, in millimetres.
//!
//! Arcs stay arcs as far as the output can carry them, so a circle in the SVG is as round as on the part. All of it is
//! done with products and square roots, which give the same numbers on every platform; no angle is ever computed.
//!
//! It checks nothing about the shape: an outline may cross itself or end in the air.

use super::Extent;

/// The sense of an arc, seen with Y up.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Turn {
    /// Clockwise, G02.
    Clockwise,
    /// Counter-clockwise, G03.
    CounterClockwise,
}

/// A run of lines and arcs, open or closed.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    pub(super) start: [f64; 2],
    pub(super) legs: Vec<Leg>,
    pub(super) closed: bool,
}

/// A point on an outline and the way it runs there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The point.
    pub at: [f64; 2],
    /// The heading, a vector of length one.
    pub heading: [f64; 2],
}

/// One piece of an outline, from the end of the one before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Leg {
    Line { to: [f64; 2] },
    Arc { to: [f64; 2], centre: [f64; 2], turn: Turn },
}

/// An arc with both ends; equal ends are a whole turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Arc {
    pub(super) from: [f64; 2],
    pub(super) to: [f64; 2],
    pub(super) centre: [f64; 2],
    pub(super) turn: Turn,
}

impl Outline {
    /// Begins an outline at a point.
    #[must_use]
    pub fn from(start: [f64; 2]) -> Self {
        Self { start, legs: Vec::new(), closed: false }
    }

    /// Joins points by lines; nothing for no points.
    #[must_use]
    pub fn through(points: impl IntoIterator<Item = [f64; 2]>) -> Option<Self> {
        let mut points = points.into_iter();
        let start = points.next()?;
        Some(Self { start, legs: points.map(|to| Leg::Line { to }).collect(), closed: false })
    }

    /// Goes on by a line.
    #[must_use]
    pub fn line_to(mut self, to: [f64; 2]) -> Self {
        self.legs.push(Leg::Line { to });
        self
    }

    /// Goes on by an arc about `centre`; an arc that ends where it begins is a whole turn.
    #[must_use]
    pub fn arc_to(mut self, to: [f64; 2], centre: [f64; 2], turn: Turn) -> Self {
        self.legs.push(Leg::Arc { to, centre, turn });
        self
    }

    /// Closes the outline by a line to its start.
    #[must_use]
    pub fn closed(self) -> Self {
        Self { closed: true, ..self }
    }

    /// Returns the outline's bounds, the bellies of its arcs included.
    #[must_use]
    pub fn extent(&self) -> Extent {
        self.pieces().fold(Extent { min: self.start, max: self.start }, |all, (from, leg)| {
            all.united(leg.extent(from))
        })
    }

    /// Returns the length in millimetres; arcs count by chords of at most a sixteenth of a turn or so.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.chords().windows(2).map(|pair| distance(pair[0], pair[1])).sum()
    }

    /// Returns the place that lies the given fraction of the length, 0 to 1, behind the start.
    ///
    /// An outline without length has no heading and so no place.
    #[must_use]
    pub fn along(&self, fraction: f64) -> Option<Place> {
        let mut left = self.length() * fraction.clamp(0.0, 1.0);
        let mut last = None;
        for pair in self.chords().windows(2) {
            let length = distance(pair[0], pair[1]);
            if length <= 0.0 {
                continue;
            }
            let heading = [(pair[1][0] - pair[0][0]) / length, (pair[1][1] - pair[0][1]) / length];
            if left <= length {
                return Some(Place { at: moved(pair[0], heading, left), heading });
            }
            left -= length;
            last = Some(Place { at: pair[1], heading });
        }
        last
    }

    /// Walks the legs, each with the point it begins at; the closing line comes last.
    pub(super) fn pieces(&self) -> impl Iterator<Item = ([f64; 2], Leg)> + '_ {
        let closing = self.closed.then_some(Leg::Line { to: self.start });
        self.legs.iter().copied().chain(closing).scan(self.start, |here, leg| {
            let from = *here;
            *here = leg.end();
            Some((from, leg))
        })
    }

    fn chords(&self) -> Vec<[f64; 2]> {
        let mut points = vec![self.start];
        for (from, leg) in self.pieces() {
            match leg {
                Leg::Line { to } => points.push(to),
                Leg::Arc { to, centre, turn } => {
                    let halves = |arcs: Vec<Arc>| arcs.iter().flat_map(Arc::halves).collect::<Vec<_>>();
                    let sixteenths = halves(halves(Arc { from, to, centre, turn }.quarters()));
                    points.extend(sixteenths.iter().map(|arc| arc.to));
                }
            }
        }
        points
    }
}

impl Leg {
    pub(super) fn end(&self) -> [f64; 2] {
        match *self {
            Self::Line { to } | Self::Arc { to, .. } => to,
        }
    }

    pub(super) fn extent(&self, from: [f64; 2]) -> Extent {
        match *self {
            Self::Line { to } => Extent::between(from, to),
            Self::Arc { to, centre, turn } => Arc { from, to, centre, turn }.extent(),
        }
    }
}

impl Arc {
    pub(super) fn radius(&self) -> f64 {
        distance(self.centre, self.from)
    }

    /// Says whether the arc turns by more than half a turn.
    pub(super) fn is_large(&self) -> bool {
        self.is_whole() || self.sine(self.arm(self.from), self.arm(self.to)) < 0.0
    }

    /// Cuts the arc into pieces of at most a quarter turn each.
    pub(super) fn quarters(&self) -> Vec<Self> {
        let (from, to) = (self.arm(self.from), self.arm(self.to));
        if !self.is_whole() && !self.is_large() && dot(from, to) >= 0.0 {
            return vec![*self];
        }
        self.halves().iter().flat_map(Self::quarters).collect()
    }

    /// Returns the two control points of the cubic for an arc of at most a quarter turn.
    ///
    /// The arms are 4/3·tan(θ/4) of the radius, which is off the circle by less than 3 in 10 000 of it.
    pub(super) fn controls(&self) -> [[f64; 2]; 2] {
        let (from, to) = (self.arm(self.from), self.arm(self.to));
        let square = dot(from, from);
        if square <= 0.0 {
            return [self.from, self.to];
        }
        let half = (self.sine(from, to) / square) / (1.0 + dot(from, to) / square);
        let arm = 4.0 / 3.0 * half / (1.0 + (1.0 + half * half).sqrt());
        [moved(self.from, self.ahead(from), arm), moved(self.to, self.ahead(to), -arm)]
    }

    /// Returns the bounds, from the ends and those of the four outermost points that the arc passes.
    fn extent(&self) -> Extent {
        let radius = self.radius();
        [[radius, 0.0], [0.0, radius], [-radius, 0.0], [0.0, -radius]]
            .into_iter()
            .filter(|arm| self.passes(*arm))
            .map(|arm| moved(self.centre, arm, 1.0))
            .fold(Extent::between(self.from, self.to), |all, point| {
                all.united(Extent { min: point, max: point })
            })
    }

    fn passes(&self, arm: [f64; 2]) -> bool {
        let (from, to) = (self.arm(self.from), self.arm(self.to));
        if self.is_large() {
            return self.is_whole() || !(self.sine(to, arm) > 0.0 && self.sine(arm, from) > 0.0);
        }
        self.sine(from, arm) > 0.0 && self.sine(arm, to) > 0.0
    }

    fn halves(&self) -> [Self; 2] {
        let (from, to) = (self.arm(self.from), self.arm(self.to));
        let radius = self.radius();
        let sum = [from[0] + to[0], from[1] + to[1]];
        let length = dot(sum, sum).sqrt();
        let middle = if self.is_whole() {
            moved(self.centre, from, -1.0)
        } else if length <= radius * 1e-9 {
            // Opposite ends: half a turn, and its middle is a quarter turn ahead.
            moved(self.centre, self.ahead(from), 1.0)
        } else if self.is_large() {
            moved(self.centre, sum, -radius / length)
        } else {
            moved(self.centre, sum, radius / length)
        };
        [Self { to: middle, ..*self }, Self { from: middle, ..*self }]
    }

    fn is_whole(&self) -> bool {
        self.from == self.to
    }

    fn arm(&self, point: [f64; 2]) -> [f64; 2] {
        [point[0] - self.centre[0], point[1] - self.centre[1]]
    }

    /// Returns the cross product of two arms, positive when the second lies ahead of the first in the arc's sense.
    fn sine(&self, a: [f64; 2], b: [f64; 2]) -> f64 {
        let cross = a[0] * b[1] - a[1] * b[0];
        match self.turn {
            Turn::CounterClockwise => cross,
            Turn::Clockwise => -cross,
        }
    }

    /// Returns an arm turned by a quarter in the arc's sense.
    fn ahead(&self, arm: [f64; 2]) -> [f64; 2] {
        match self.turn {
            Turn::CounterClockwise => [-arm[1], arm[0]],
            Turn::Clockwise => [arm[1], -arm[0]],
        }
    }
}

/// Returns the point reached from `from` by `times` the vector.
pub(super) fn moved(from: [f64; 2], vector: [f64; 2], times: f64) -> [f64; 2] {
    [from[0] + vector[0] * times, from[1] + vector[1] * times]
}

/// Returns the distance of two points.
pub(super) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let way = [b[0] - a[0], b[1] - a[1]];
    dot(way, way).sqrt()
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arc_bulges_out_of_the_box_of_its_ends() {
        let over = Outline::from([1.0, 0.0]).arc_to([-1.0, 0.0], [0.0, 0.0], Turn::CounterClockwise);
        assert_eq!(over.extent(), Extent::between([-1.0, 0.0], [1.0, 1.0]));
        let under = Outline::from([1.0, 0.0]).arc_to([-1.0, 0.0], [0.0, 0.0], Turn::Clockwise);
        assert_eq!(under.extent(), Extent::between([-1.0, -1.0], [1.0, 0.0]));
        let most = Outline::from([1.0, 0.0]).arc_to([0.0, 1.0], [0.0, 0.0], Turn::Clockwise);
        assert_eq!(most.extent(), Extent::between([-1.0, -1.0], [1.0, 1.0]));
        let quarter = Outline::from([1.0, 0.0]).arc_to([0.0, 1.0], [0.0, 0.0], Turn::CounterClockwise);
        assert_eq!(quarter.extent(), Extent::between([0.0, 0.0], [1.0, 1.0]));
    }

    #[test]
    fn equal_ends_are_a_whole_turn() {
        let circle = Outline::from([3.0, 1.0]).arc_to([3.0, 1.0], [1.0, 1.0], Turn::Clockwise);
        assert_eq!(circle.extent(), Extent::around([1.0, 1.0], 4.0, 4.0));
        assert!((circle.length() - 4.0 * core::f64::consts::PI).abs() < 0.1);
    }

    #[test]
    fn an_arc_falls_into_pieces_that_join_and_stay_on_the_circle() {
        for (to, turn) in [
            ([0.6, 0.8], Turn::Clockwise),
            ([-1.0, 0.0], Turn::CounterClockwise),
            ([1.0, 0.0], Turn::Clockwise),
        ] {
            let arc = Arc { from: [1.0, 0.0], to, centre: [0.0, 0.0], turn };
            let pieces = arc.quarters();
            assert_eq!((pieces[0].from, pieces[pieces.len() - 1].to), (arc.from, arc.to));
            assert!(pieces.windows(2).all(|pair| pair[0].to == pair[1].from));
            for piece in pieces {
                let [a, b] = piece.controls();
                let middle = [0, 1].map(|i| (piece.from[i] + 3.0 * a[i] + 3.0 * b[i] + piece.to[i]) / 8.0);
                assert!((distance(middle, [0.0, 0.0]) - 1.0).abs() < 3e-4, "{piece:?}");
            }
        }
    }

    #[test]
    fn a_place_along_the_way_has_a_heading() {
        let bent = Outline::from([0.0, 0.0]).line_to([2.0, 0.0]).line_to([2.0, 2.0]);
        assert_eq!(bent.along(0.25), Some(Place { at: [1.0, 0.0], heading: [1.0, 0.0] }));
        assert_eq!(bent.along(1.0), Some(Place { at: [2.0, 2.0], heading: [0.0, 1.0] }));
        assert_eq!(Outline::from([1.0, 1.0]).along(0.5), None);
    }

    #[test]
    fn a_closed_outline_ends_where_it_began() {
        let square =
            Outline::through([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]).expect("four points").closed();
        assert_eq!(square.pieces().last().map(|(_, leg)| leg.end()), Some([0.0, 0.0]));
        assert_eq!(square.length(), 4.0);
    }
}
