//! What was chosen for each contour, for a person to read before the wire is threaded.

use std::fmt;

use super::{Kept, Lead};
use crate::geometry::Point;
use crate::geometry::offset::Unreached;
use crate::motion::Side;

/// What was chosen, contour by contour.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// In the order in which they are cut.
    pub contours: Vec<ContourSummary>,
}

/// What was chosen for a contour.
#[derive(Clone, Debug, PartialEq)]
pub struct ContourSummary {
    /// Which side of it is the part.
    pub kept: Kept,
    /// On which side the wire runs in the first pass, seen in its direction.
    pub side: Side,
    /// Where the wire comes to the contour: the point of the contour, mm.
    pub entry: Point,
    /// The start holes in the order of their stretches, mm.
    pub holes: Vec<Point>,
    /// Whether the holes were put where the lead-in begins, and are still to be drilled.
    pub holes_chosen: bool,
    /// How the wire is led in.
    pub lead_in: Lead,
    /// How it is led out; none where it stays on its path.
    pub lead_out: Option<Lead>,
    /// How far it goes on past the closing point and the ends of tabs, mm.
    pub overcut: f64,
    /// The passes.
    pub passes: Vec<PassSummary>,
    /// The tabs, in their order along the contour.
    pub tabs: Vec<TabSummary>,
    /// The way the wire cuts, with leads and overcuts, mm.
    pub cut: f64,
    /// The way it is positioned, mm.
    pub rapid: f64,
    /// How many moves that takes.
    pub moves: u64,
    /// How many times the wire is threaded.
    pub threadings: u64,
    /// How many times the control stops before a tab.
    pub stops: u64,
}

/// What was chosen for a pass.
#[derive(Clone, Debug, PartialEq)]
pub struct PassSummary {
    /// How far from the contour the wire runs, mm.
    pub offset: f64,
    /// The length of the whole path beside the contour, mm.
    pub path: f64,
    /// The way cut beside the contour, with overcuts and without leads, mm.
    pub cut: f64,
    /// What of the contour the wire does not touch, with the largest offset that would.
    pub unreached: Vec<Unreached>,
    /// How many sharp inside corners get the wire's radius.
    pub filled_corners: usize,
}

/// What was chosen for a tab.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TabSummary {
    /// Where on the contour it begins, mm.
    pub from: Point,
    /// Where on the contour it ends, mm.
    pub to: Point,
    /// Its length along the contour, mm.
    pub length: f64,
    /// What holds the piece between the kerfs on its two sides, at its narrowest, mm.
    pub bridge: f64,
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (n, contour) in self.contours.iter().enumerate() {
            write!(f, "contour {}: {contour}", n + 1)?;
        }
        Ok(())
    }
}

impl fmt::Display for ContourSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self.kept {
            Kept::Inside => "punch (the inside is kept)",
            Kept::Outside => "die (the outside is kept)",
        };
        let side = match self.side {
            Side::Left => "left",
            Side::Right => "right",
        };
        writeln!(f, "{what}, wire on the {side}, entry at {}", shown(self.entry))?;
        let origin = if self.holes_chosen { "where the lead-in begins, to be drilled" } else { "given" };
        let holes: Vec<String> = self.holes.iter().map(|hole| shown(*hole)).collect();
        writeln!(f, "  start hole {}, {origin}", holes.join(", "))?;
        let out = self.lead_out.map_or_else(|| "none, the wire stays".to_owned(), |lead| lead.to_string());
        writeln!(f, "  lead-in {}, lead-out {out}, overcut {:.3} mm", self.lead_in, self.overcut)?;
        for (n, pass) in self.passes.iter().enumerate() {
            let PassSummary { offset, path, cut, .. } = pass;
            writeln!(f, "  pass {}: offset {offset:.4} mm, path {path:.3} mm, cut {cut:.3} mm", n + 1)?;
            for part in &pass.unreached {
                let (at, largest) = (shown(part.at), part.largest);
                writeln!(f, "    not reached at {at}: the largest offset that does is {largest:.3} mm")?;
            }
            if pass.filled_corners > 0 {
                writeln!(
                    f,
                    "    {} sharp inside corners get the radius {offset:.4} mm",
                    pass.filled_corners
                )?;
            }
        }
        for (n, tab) in self.tabs.iter().enumerate() {
            let TabSummary { from, to, length, bridge } = *tab;
            let (from, to) = (shown(from), shown(to));
            writeln!(f, "  tab {}: {from} to {to}, {length:.3} mm, holds by {bridge:.3} mm", n + 1)?;
        }
        let Self { moves, cut, rapid, threadings, stops, .. } = self;
        let threaded = if *threadings == 1 { "once".to_owned() } else { format!("{threadings} times") };
        let stops = if *stops == 1 { "1 stop".to_owned() } else { format!("{stops} stops") };
        writeln!(
            f,
            "  {moves} moves, {cut:.3} mm cut, {rapid:.3} mm rapid, threaded {threaded}, {stops} before tabs"
        )
    }
}

impl fmt::Display for Lead {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Direct => f.write_str("direct"),
            Self::Straight { length } => write!(f, "straight {length:.3} mm"),
            Self::Arc { radius, sweep } => write!(f, "arc of radius {radius:.3} mm over {sweep:.1} degrees"),
        }
    }
}

fn shown(at: Point) -> String {
    format!("X{:.3} Y{:.3}", at.x, at.y)
}
