//! The modified cycloid (clock) gear: parameters to the wire's path, tooth by tooth.
//!
//! Li Yanzun, "Application of IBM-PC Microcomputer to the Design of a Machining Program for the NC WEDM Machine
//! Tool" (1990). A tooth, cut from the bottom of the space on its left, is seven elements: half a root arc, a radial
//! flank, the tip flank arc, the tip rounding, and the mirror images back down; the gear is that tooth turned by
//! −k·2π/z. The wire's offset changes radii and shifts flanks; where it makes an element vanish, the neighbours are
//! trimmed to their intersection or the gear is refused. The paper's lost figures were worked out again from its
//! printed table; where its text and table disagree, the table is right.
//!
//! Internal gears and other tooth forms are not here.

mod bounds;
mod lead_in;

use std::sync::Arc;

use crate::geometry::{Element, Point, Rotation, Sense};

pub use bounds::Impossible;
pub use lead_in::LeadIn;

/// The parameters of a gear, in the paper's symbols; lengths in millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CycloidGear {
    /// m: the module, mm.
    pub module: f64,
    /// z: the number of teeth.
    pub teeth: u64,
    /// kp: the tip flank's radius is kp·m.
    pub kp: f64,
    /// kr: the tip flanks' centres lie kr·m inside the pitch circle.
    pub kr: f64,
    /// ks: the tooth is ks·m thick on the pitch circle.
    pub ks: f64,
    /// knf: the root circle lies knf·m inside the pitch circle.
    pub knf: f64,
    /// R': the radius of the tip rounding, mm.
    pub tip_radius: f64,
}

impl Default for CycloidGear {
    /// The gear of the paper's printed run.
    fn default() -> Self {
        Self { module: 0.4, teeth: 36, kp: 2.0, kr: 0.15, ks: 1.57, knf: 1.57, tip_radius: 0.04 }
    }
}

/// The direction in which the outline is cut.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Direction {
    /// Clockwise, as in the paper.
    #[default]
    Clockwise,
    /// Counter-clockwise: the mirror image.
    CounterClockwise,
}

/// What to do when the wire is too thick for the tooth space.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Trim {
    /// Refuse, naming the largest offset that fits.
    #[default]
    Refuse,
    /// Trim the two flanks to their intersection and leave material in the root.
    Allow,
}

/// Lengths and angles that follow from the parameters, for the nominal tooth; mm and radians.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Derived {
    /// r_c: the circle of the tip flanks' centres.
    pub(crate) r_c: f64,
    /// r_f: the root radius.
    pub(crate) r_f: f64,
    /// ρ: the tip flank's radius.
    pub(crate) rho: f64,
    /// β: polar angle of the tip flank's centre from the tooth's axis.
    pub(crate) beta: f64,
    /// θ: half the angle between the two radial flanks.
    pub(crate) theta: f64,
    /// φ: half the angle of the tooth space.
    pub(crate) phi: f64,
    /// ρ_f: the root arc's radius.
    pub(crate) rho_f: f64,
}

/// One tooth of the wire's path, symmetrical about +Y, ready to be turned into any other.
#[derive(Clone, Debug)]
pub struct Outline {
    teeth: u64,
    mirrored: bool,
    /// The nodes in order of cut and, between each two, the arc's centre and sense if it is one.
    nodes: Vec<Point>,
    bends: Vec<Option<(Point, Sense)>>,
    sharp_tip: bool,
    trimmed_root: bool,
}

impl CycloidGear {
    /// The path of the wire's centre for a wire offset in millimetres: positive outside (a punch), negative inside (a die).
    ///
    /// # Errors
    ///
    /// When no such tooth exists, or the wire does not fit.
    pub fn outline(&self, offset: f64, direction: Direction, trim: Trim) -> Result<Arc<Outline>, Impossible> {
        let Derived { r_c, r_f, rho, beta, theta, phi, rho_f } = self.derived()?;
        bounds::offset(self, offset, trim)?;

        let quarter = std::f64::consts::FRAC_PI_2;
        let polar = |radius: f64, angle: f64| {
            let (sin, cos) = libm::sincos(angle);
            Point::new(radius * cos, radius * sin)
        };
        // The left flank's outward normal: to the left of a tooth that points up.
        let flank_angle = quarter + theta;
        let normal = polar(1.0, flank_angle + quarter).coords;
        let tip_centre = polar(r_c, quarter - beta);
        let tip_flank_radius = rho + offset;
        // The left flank touches the tip flank's circle at right angles to the radius from its centre.
        let flank_top = tip_centre + normal * tip_flank_radius;

        let mut left = Vec::with_capacity(4);
        let mut bends = Vec::with_capacity(4);
        let trimmed_root = rho_f - offset <= 0.0;
        if trimmed_root {
            // The shifted flanks of two neighbouring teeth meet on the axis of the space between them.
            left.push(polar(offset / libm::sin(phi), flank_angle + phi));
        } else {
            let root_centre = polar(r_f + rho_f, flank_angle + phi);
            let root_radius = rho_f - offset;
            left.push(root_centre - polar(root_radius, flank_angle + phi).coords);
            left.push(root_centre - normal * root_radius);
            bends.push(Some((root_centre, Sense::CounterClockwise)));
        }
        left.push(flank_top);
        bends.push(None);

        let tip_radius = self.tip_radius + offset;
        let sharp_tip = tip_radius <= 0.0;
        let across = tip_centre.x;
        bends.push(Some((tip_centre, Sense::Clockwise)));
        if sharp_tip {
            let height = (tip_flank_radius * tip_flank_radius - across * across).sqrt();
            left.push(Point::new(0.0, tip_centre.y + height));
        } else {
            // The rounding touches the tip flank from inside, so its centre is nearer by the nominal difference.
            let between = rho - self.tip_radius;
            let rise = (between * between - across * across).sqrt();
            let rounding_centre = Point::new(0.0, tip_centre.y + rise);
            let direction = (rounding_centre - tip_centre) / between;
            left.push(tip_centre + direction * tip_flank_radius);
            bends.push(Some((rounding_centre, Sense::Clockwise)));
        }

        Ok(Arc::new(Outline::from_left_half(self.teeth, left, bends, sharp_tip, trimmed_root, direction)))
    }
}

impl Outline {
    /// Completes a tooth from its left half: the right half is the mirror image, run down again.
    fn from_left_half(
        teeth: u64,
        left: Vec<Point>,
        left_bends: Vec<Option<(Point, Sense)>>,
        sharp_tip: bool,
        trimmed_root: bool,
        direction: Direction,
    ) -> Self {
        let flip = |p: Point| Point::new(-p.x, p.y);
        let (mut nodes, mut bends) = (left.clone(), left_bends.clone());
        // With a sharp tip the last node lies on the axis and is its own image; else the tip arc crosses the axis.
        let on_axis = usize::from(sharp_tip);
        nodes.extend(left.iter().rev().skip(on_axis).copied().map(flip));
        let crossing = usize::from(!sharp_tip);
        bends.extend(
            left_bends
                .iter()
                .rev()
                .skip(crossing)
                .map(|bend| bend.map(|(centre, sense)| (flip(centre), sense))),
        );
        Self {
            teeth,
            mirrored: direction == Direction::CounterClockwise,
            nodes,
            bends,
            sharp_tip,
            trimmed_root,
        }
    }

    /// The number of elements of one tooth.
    #[must_use]
    pub fn elements_per_tooth(&self) -> usize {
        self.bends.len()
    }

    /// The number of elements of the whole outline.
    #[must_use]
    pub fn len(&self) -> u64 {
        self.teeth * self.bends.len() as u64
    }

    /// Always false: an outline has elements.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Whether the tip's rounding vanished and the tip flanks were trimmed to a corner.
    #[must_use]
    pub fn has_sharp_tip(&self) -> bool {
        self.sharp_tip
    }

    /// Whether the root arc vanished and the flanks were trimmed to a corner.
    #[must_use]
    pub fn has_trimmed_root(&self) -> bool {
        self.trimmed_root
    }

    /// Where the outline begins and ends: the bottom of the tooth space.
    #[must_use]
    pub fn start(&self) -> Point {
        self.place(Rotation::clockwise_step(0, self.teeth).apply(self.nodes[0]))
    }

    fn place(&self, p: Point) -> Point {
        if self.mirrored { Point::new(-p.x, p.y) } else { p }
    }

    /// The outline once round, tooth by tooth.
    #[must_use]
    pub fn elements(self: &Arc<Self>) -> Elements {
        let rotation = Rotation::clockwise_step(0, self.teeth);
        Elements { outline: Arc::clone(self), tooth: 0, index: 0, rotation, from: self.start() }
    }
}

/// The elements of an [`Outline`], made one at a time.
#[derive(Clone, Debug)]
pub struct Elements {
    outline: Arc<Outline>,
    tooth: u64,
    index: usize,
    rotation: Rotation,
    from: Point,
}

impl Iterator for Elements {
    type Item = Element;

    fn next(&mut self) -> Option<Element> {
        let outline = &*self.outline;
        if self.tooth == outline.teeth {
            return None;
        }
        let bend = outline.bends[self.index];
        let centre = bend.map(|(centre, sense)| (outline.place(self.rotation.apply(centre)), sense));
        self.index += 1;
        if self.index == outline.bends.len() {
            // The last node of a tooth is the first of the next, computed the same way, so that the bits agree.
            self.index = 0;
            self.tooth += 1;
            self.rotation = Rotation::clockwise_step(self.tooth, outline.teeth);
        }
        let end = outline.place(self.rotation.apply(outline.nodes[self.index]));
        let start = std::mem::replace(&mut self.from, end);
        Some(match centre {
            None => Element::Line { start, end },
            Some((centre, sense)) => {
                let sense = if outline.mirrored { sense.reversed() } else { sense };
                Element::Arc { start, end, centre, sense }
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_paper_gear_has_seven_elements_a_tooth_and_closes() {
        let outline = CycloidGear::default().outline(0.07, Direction::Clockwise, Trim::Refuse).unwrap();
        let elements: Vec<_> = outline.elements().collect();
        assert_eq!(elements.len(), 252);
        assert_eq!(elements[251].end(), outline.start());
        for pair in elements.windows(2) {
            assert_eq!(pair[0].end(), pair[1].start());
        }
    }

    #[test]
    fn a_thick_wire_in_a_cavity_leaves_a_sharp_tip() {
        let outline = CycloidGear::default().outline(-0.07, Direction::Clockwise, Trim::Refuse).unwrap();
        assert!(outline.has_sharp_tip());
        assert_eq!(outline.elements_per_tooth(), 6);
    }

    #[test]
    fn a_wire_too_thick_for_the_space_is_trimmed_only_when_asked() {
        let gear = CycloidGear::default();
        assert!(gear.outline(0.3, Direction::Clockwise, Trim::Refuse).is_err());
        let outline = gear.outline(0.3, Direction::Clockwise, Trim::Allow).unwrap();
        assert!(outline.has_trimmed_root());
        assert_eq!(outline.elements_per_tooth(), 5);
    }

    #[test]
    fn the_other_direction_is_the_mirror_image() {
        let gear = CycloidGear::default();
        let cw = gear.outline(0.07, Direction::Clockwise, Trim::Refuse).unwrap();
        let ccw = gear.outline(0.07, Direction::CounterClockwise, Trim::Refuse).unwrap();
        for (a, b) in cw.elements().zip(ccw.elements()) {
            assert_eq!(a.mirrored(), b);
        }
    }
}
