//! The clock gear as the paper defines it, from formulas alone: nodes, centres, radii, for any parameters.
//!
//! Written from `domain/1` (Li Yanzun, 1990, with the mended formulas), apart from the program under test. Lengths are
//! µm, angles radians counter-clockwise from +X; the gear's centre is the origin, tooth 0 is symmetric about +Y.
//!
//! One tooth, cut clockwise from the bottom of the space on its left:
//!
//! ```text
//!            7 ─tip─ 8
//!   tip flank /       \ tip flank
//!            6         9
//!      flank |         | flank
//!            4         11
//!     root __/         \__ root
//!     B                    the next B
//! ```

#![expect(clippy::disallowed_methods, reason = "the system's trigonometry, apart from the program's own")]

use std::f64::consts::{FRAC_PI_2, PI};

/// The numbers a gear is made from; the offset, like all lengths given to the program, in mm.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gear {
    pub(crate) module: f64,
    pub(crate) teeth: u32,
    pub(crate) kp: f64,
    pub(crate) kr: f64,
    pub(crate) ks: f64,
    pub(crate) knf: f64,
    pub(crate) tip_radius: f64,
    pub(crate) offset: f64,
    pub(crate) direction: Direction,
    pub(crate) root: Root,
}

#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Direction {
    Clockwise,
    CounterClockwise,
}

/// What becomes of a tooth space too narrow for the wire.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Root {
    /// It is refused.
    Whole,
    /// The flanks on its two sides are cut up to where they meet.
    Trimmed,
}

/// The paper's printed run.
pub(crate) const PAPER: Gear = Gear {
    module: 0.4,
    teeth: 36,
    kp: 2.0,
    kr: 0.15,
    ks: 1.57,
    knf: 1.57,
    tip_radius: 0.04,
    offset: 0.07,
    direction: Direction::Clockwise,
    root: Root::Whole,
};

#[derive(Clone, Copy, Debug)]
pub(crate) struct Point {
    pub(crate) x: f64,
    pub(crate) y: f64,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Curve {
    Line,
    Arc { centre: Point, clockwise: bool },
}

/// A piece of the outline between two nodes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Element {
    pub(crate) start: Point,
    pub(crate) end: Point,
    pub(crate) curve: Curve,
}

/// What the formulas give before any outline is drawn, µm and radians.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Derived {
    pub(crate) root_radius: f64,
    pub(crate) flank_arc_radius: f64,
    pub(crate) centre_circle_radius: f64,
    pub(crate) beta: f64,
    pub(crate) theta: f64,
    pub(crate) phi: f64,
    pub(crate) root_arc_radius: f64,
    pub(crate) tip_radius: f64,
    pub(crate) offset: f64,
}

impl Gear {
    pub(crate) fn derived(&self) -> Derived {
        let module = self.module * 1000.0;
        let pitch = module * f64::from(self.teeth) / 2.0;
        let root_radius = pitch - self.knf * module;
        let rho = self.kp * module;
        let r_c = pitch - self.kr * module;
        let thickness = self.ks * module;
        let cosine = (pitch * pitch + r_c * r_c - rho * rho) / (2.0 * pitch * r_c);
        let beta = cosine.acos() - thickness / (2.0 * pitch);
        let theta = (rho / r_c).asin() - beta;
        let phi = PI / f64::from(self.teeth) - theta;
        Derived {
            root_radius,
            flank_arc_radius: rho,
            centre_circle_radius: r_c,
            beta,
            theta,
            phi,
            root_arc_radius: root_radius * phi.sin() / (1.0 - phi.sin()),
            tip_radius: self.tip_radius * 1000.0,
            offset: self.offset * 1000.0,
        }
    }

    /// The elements of one whole outline, in the order of the cut, from the bottom of a tooth space back to it.
    ///
    /// Only for a gear whose [`Derived::margin_um`] is above 0.
    pub(crate) fn outline(&self) -> Vec<Element> {
        let tooth = self.derived().tooth(self.root);
        let mut outline = Vec::new();
        for k in 0..self.teeth {
            let turn = -2.0 * PI * f64::from(k) / f64::from(self.teeth);
            outline.extend(tooth.iter().map(|element| element.rotated(turn)));
        }
        if self.direction == Direction::CounterClockwise {
            for element in &mut outline {
                *element = element.mirrored();
            }
        }
        outline
    }
}

impl Derived {
    /// How far the centres of the tip flanks lie from the tooth's axis.
    pub(crate) fn across_um(&self) -> f64 {
        self.centre_circle_radius * self.beta.sin()
    }

    /// From the gear's centre along the radial flank to where the tip flank begins.
    fn flank_end_um(&self) -> f64 {
        let (r_c, rho) = (self.centre_circle_radius, self.flank_arc_radius);
        (r_c * r_c - rho * rho).sqrt()
    }

    /// From the gear's centre along the radial flank to where the root arc ends.
    fn flank_start_um(&self) -> f64 {
        (self.root_radius + self.root_arc_radius) * self.phi.cos()
    }

    /// The length of the straight flank.
    pub(crate) fn flank_um(&self) -> f64 {
        self.flank_end_um() - self.flank_start_um()
    }

    /// How far the tooth is from being impossible: the smallest of the lengths that must be above 0, µm. NaN where an
    /// arc sine or cosine has no value.
    pub(crate) fn margin_um(&self, root: Root) -> f64 {
        let Derived { root_radius, flank_arc_radius: rho, centre_circle_radius: r_c, offset, .. } = *self;
        let across = self.across_um();
        let (flank_start, flank_end) = (self.flank_start_um(), self.flank_end_um());
        let mut lengths = vec![
            root_radius,
            // β and φ above 0, as lengths: of the centre's distance from the axis, of the half space at the root.
            across,
            root_radius * self.phi.sin(),
            rho - self.tip_radius,
            rho - self.tip_radius - across,
            r_c - rho,
            flank_end - flank_start,
        ];
        match root {
            Root::Whole => {
                lengths.push((self.root_arc_radius - offset) * (FRAC_PI_2 - self.phi));
                // With the wire inside, the two flanks of a tooth may not cross where they are nearest.
                lengths.push(-self.flank_point(flank_start).x);
            }
            Root::Trimmed => lengths.push(flank_end - offset / self.phi.tan()),
        }
        lengths.push(-self.flank_point(flank_end).x);
        let radius = rho + offset;
        lengths.push(radius * (PI + self.theta - self.tip_direction()));
        if self.has_tip() {
            lengths.push((self.tip_radius + offset) * (2.0 * self.tip_direction() - PI));
        }
        if lengths.iter().any(|length| length.is_nan()) {
            return f64::NAN;
        }
        lengths.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Whether the tip arc has a radius left; if not, the two tip flanks meet in a corner.
    pub(crate) fn has_tip(&self) -> bool {
        self.tip_radius + self.offset > 0.0
    }

    /// Where the left tip flank ends, as a direction from its centre.
    fn tip_direction(&self) -> f64 {
        let reach = if self.has_tip() {
            self.flank_arc_radius - self.tip_radius
        } else {
            self.flank_arc_radius + self.offset
        };
        (-self.across_um() / reach).acos()
    }

    /// The point of the offset left flank that stands beside the one `along` the radial flank.
    fn flank_point(&self, along: f64) -> Point {
        let direction = FRAC_PI_2 + self.theta;
        polar(along, direction).plus(polar(self.offset, direction + FRAC_PI_2))
    }

    /// Tooth 0, clockwise.
    fn tooth(&self, root: Root) -> Vec<Element> {
        let Derived { theta, phi, beta, offset, .. } = *self;
        let space = FRAC_PI_2 + theta + phi;
        let flank_end = self.flank_point(self.flank_end_um());
        let mut left = Vec::new();
        match root {
            Root::Whole => {
                let centre = polar(self.root_radius + self.root_arc_radius, space);
                let bottom = polar(self.root_radius + offset, space);
                let flank_start = self.flank_point(self.flank_start_um());
                let curve = Curve::Arc { centre, clockwise: false };
                left.push(Element { start: bottom, end: flank_start, curve });
                left.push(Element { start: flank_start, end: flank_end, curve: Curve::Line });
            }
            Root::Trimmed => {
                let bottom = polar(offset / phi.sin(), space);
                left.push(Element { start: bottom, end: flank_end, curve: Curve::Line });
            }
        }
        let centre = polar(self.centre_circle_radius, FRAC_PI_2 - beta);
        let tip_start = centre.plus(polar(self.flank_arc_radius + offset, self.tip_direction()));
        let curve = Curve::Arc { centre, clockwise: true };
        left.push(Element { start: flank_end, end: tip_start, curve });

        let mut tooth = left.clone();
        if self.has_tip() {
            let centre = centre.plus(polar(self.flank_arc_radius - self.tip_radius, self.tip_direction()));
            let curve = Curve::Arc { centre, clockwise: true };
            tooth.push(Element { start: tip_start, end: tip_start.mirrored(), curve });
        }
        tooth.extend(left.iter().rev().map(|element| element.mirrored().reversed()));
        tooth
    }
}

impl Element {
    fn rotated(&self, turn: f64) -> Element {
        self.moved(|point| point.rotated(turn), false)
    }

    fn mirrored(&self) -> Element {
        self.moved(Point::mirrored, true)
    }

    fn moved(&self, place: impl Fn(&Point) -> Point, turned_over: bool) -> Element {
        let curve = match &self.curve {
            Curve::Line => Curve::Line,
            Curve::Arc { centre, clockwise } => {
                Curve::Arc { centre: place(centre), clockwise: *clockwise != turned_over }
            }
        };
        Element { start: place(&self.start), end: place(&self.end), curve }
    }

    fn reversed(&self) -> Element {
        let curve = match self.curve {
            Curve::Line => Curve::Line,
            Curve::Arc { centre, clockwise } => Curve::Arc { centre, clockwise: !clockwise },
        };
        Element { start: self.end, end: self.start, curve }
    }

    /// How far a point lies from the element, µm.
    pub(crate) fn distance_um(&self, point: Point) -> f64 {
        let to_nodes = point.distance(self.start).min(point.distance(self.end));
        match self.curve {
            Curve::Line => {
                let along = self.end.minus(self.start);
                let length = along.x.hypot(along.y);
                let from = point.minus(self.start);
                let share = (from.x * along.x + from.y * along.y) / (length * length);
                if (0.0..=1.0).contains(&share) {
                    (from.x * along.y - from.y * along.x).abs() / length
                } else {
                    to_nodes
                }
            }
            Curve::Arc { centre, .. } => {
                if self.sweep_to(point) <= self.sweep_to(self.end) {
                    (point.distance(centre) - self.start.distance(centre)).abs()
                } else {
                    to_nodes
                }
            }
        }
    }

    /// Points along the element, its start included, its end not.
    pub(crate) fn sampled(&self, count: u32) -> Vec<Point> {
        let share = |i: u32| f64::from(i) / f64::from(count);
        match self.curve {
            Curve::Line => {
                let along = self.end.minus(self.start);
                (0..count)
                    .map(|i| self.start.plus(Point { x: along.x * share(i), y: along.y * share(i) }))
                    .collect()
            }
            Curve::Arc { centre, clockwise } => {
                let sense = if clockwise { -1.0 } else { 1.0 };
                let from = self.start.minus(centre);
                let sweep = self.sweep_to(self.end);
                (0..count).map(|i| centre.plus(from.rotated(sense * sweep * share(i)))).collect()
            }
        }
    }

    /// The angle from an arc's start to the direction of a point, in the arc's sense, in [0, 2π).
    fn sweep_to(&self, point: Point) -> f64 {
        let Curve::Arc { centre, clockwise } = self.curve else {
            return 0.0;
        };
        let (from, to) = (self.start.minus(centre), point.minus(centre));
        let turn = to.y.atan2(to.x) - from.y.atan2(from.x);
        (if clockwise { -turn } else { turn }).rem_euclid(2.0 * PI)
    }
}

impl Point {
    pub(crate) fn distance(self, other: Point) -> f64 {
        (self.x - other.x).hypot(self.y - other.y)
    }

    fn plus(self, other: Point) -> Point {
        Point { x: self.x + other.x, y: self.y + other.y }
    }

    fn minus(self, other: Point) -> Point {
        Point { x: self.x - other.x, y: self.y - other.y }
    }

    fn mirrored(&self) -> Point {
        Point { x: -self.x, y: self.y }
    }

    fn rotated(&self, turn: f64) -> Point {
        let (sin, cos) = turn.sin_cos();
        Point { x: self.x * cos - self.y * sin, y: self.x * sin + self.y * cos }
    }
}

fn polar(radius: f64, direction: f64) -> Point {
    Point { x: radius * direction.cos(), y: radius * direction.sin() }
}
