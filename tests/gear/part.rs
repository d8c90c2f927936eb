//! A gear with its lead-in and repetitions: the words for the command line, and the path they ask for.

use crate::execution::{Path, Place};
use crate::theory::{Curve, Direction, Element, Gear, PAPER, Point, Root};

/// What `generate gear` is asked for, apart from how it rounds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    pub(crate) gear: Gear,
    pub(crate) lead_in: LeadIn,
    pub(crate) repeat: u32,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum LeadIn {
    Centre,
    None,
    /// From here, whole µm from the gear's centre.
    From(Place),
}

pub(crate) const PAPERS_PART: Part = Part { gear: PAPER, lead_in: LeadIn::Centre, repeat: 1 };

impl Part {
    /// The arguments, without `--interpolator` and `--rounding`.
    pub(crate) fn arguments(&self) -> Vec<String> {
        let Gear { module, teeth, kp, kr, ks, knf, tip_radius, offset, direction, root } = self.gear;
        let mut arguments: Vec<String> = ["generate", "gear"].map(str::to_owned).to_vec();
        let mut say = |name: &str, value: String| arguments.push(format!("--{name}={value}"));
        say("module", module.to_string());
        say("teeth", teeth.to_string());
        say("kp", kp.to_string());
        say("kr", kr.to_string());
        say("ks", ks.to_string());
        say("knf", knf.to_string());
        say("tip-radius", tip_radius.to_string());
        say("offset", offset.to_string());
        if direction == Direction::CounterClockwise {
            say("direction", "ccw".to_owned());
        }
        match self.lead_in {
            LeadIn::Centre => {}
            LeadIn::None => say("lead-in", "none".to_owned()),
            LeadIn::From(place) => say("lead-in", in_mm(place)),
        }
        if self.repeat != 1 {
            say("repeat", self.repeat.to_string());
        }
        if root == Root::Trimmed {
            arguments.push("--trim".to_owned());
        }
        arguments
    }

    /// The path asked for. Without a lead-in the wire stands on the whole µm nearest to the outline's beginning.
    pub(crate) fn path(&self) -> Path {
        let outline = self.gear.outline();
        let begin = outline[0].start;
        let mut elements = Vec::new();
        let start = match self.lead_in {
            LeadIn::Centre => [0, 0],
            LeadIn::From(place) => place,
            LeadIn::None => nearest(begin),
        };
        let lead_in = match self.lead_in {
            LeadIn::None => 0,
            LeadIn::Centre | LeadIn::From(_) => {
                let from = crate::execution::point(start);
                elements.push(Element { start: from, end: begin, curve: Curve::Line });
                1
            }
        };
        for _ in 0..self.repeat {
            elements.extend_from_slice(&outline);
        }
        Path { start, lead_in, elements }
    }
}

#[expect(clippy::cast_possible_truncation, reason = "a gear is far smaller than 2^52 µm")]
fn nearest(point: Point) -> Place {
    [point.x.round() as i64, point.y.round() as i64]
}

/// `X,Y` with three decimals.
fn in_mm([x, y]: Place) -> String {
    let mm = |um: i64| format!("{}{}.{:03}", if um < 0 { "-" } else { "" }, um.abs() / 1000, um.abs() % 1000);
    format!("{},{}", mm(x), mm(y))
}
