//! How contours are cut: start holes, leads, passes, overcut and tabs, as they are said on the command line.
//!
//! A drawing, or a program whose contours close, gives its outlines; [`crate::cutting`] leads the wire to them and round
//! them. What was chosen is told before a block is written.

use clap::{Args, ValueEnum};

use super::failure::{Exit, Failure};
use super::motions::Places;
use crate::cutting::{
    self, Contour, CutTabs, Cutting, Entry, Holes, Kept, Lead, Pass, Plan, Refusal, Rethread, Skim, Stops,
    Tabs,
};
use crate::drawing::dxf::Drawing;
use crate::geometry::offset::Corners;
use crate::geometry::{Path, Point};
use crate::motion::{Act, Side, Stop};
use crate::place::Spot;

/// How contours are cut.
#[derive(Args, Debug, Default)]
#[command(next_help_heading = "Cutting plan (for the contours of a drawing)")]
pub(super) struct CuttingPlan {
    /// How the wire comes to a contour: direct (from the start hole), straight:MM, or arc:RADIUS:DEGREES [default: direct where every contour has its --start, else straight:1]
    #[arg(long, value_name = "LEAD")]
    lead_in: Option<Lead>,
    /// How it leaves a contour; none to stay on it [default: as it came]
    #[arg(long, value_name = "LEAD", value_parser = lead_out)]
    lead_out: Option<LeadOut>,
    /// How far the wire goes on past the closing point, mm [default: 0]
    #[arg(long, value_name = "MM", value_parser = length)]
    overcut: Option<f64>,
    /// Bridges that hold the piece and are cut last: COUNT:MM, or @FROM+MM,@FROM+MM along the contour [default: none]
    #[arg(long, value_name = "TABS")]
    tabs: Option<Tabs>,
    /// Passes, in place of --offset: OFFSET=WORDS,OFFSET:back=WORDS,OFFSET:again=WORDS
    #[arg(long, value_name = "PASSES", value_parser = passes)]
    passes: Option<Passes>,
    /// Which side of every contour is the part [default: inside outlines, outside holes]
    #[arg(long, value_name = "SIDE")]
    kept: Option<KeptWord>,
    /// What the control is told before and behind a way between start holes, such as M50,M60; stops for formats without a word
    #[arg(long, value_name = "CUT,THREAD", value_parser = rethread)]
    rethread: Option<Words>,
}

/// How the wire leaves, which may be not at all.
#[derive(Clone, Copy, Debug)]
struct LeadOut(Option<Lead>);

#[derive(Clone, Debug)]
struct Passes(Pass, Vec<Skim>);

#[derive(Clone, Debug)]
struct Words {
    cut: String,
    thread: String,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum KeptWord {
    /// Punches: what falls out is the part
    Inside,
    /// Dies: what falls out is waste
    Outside,
}

/// What else the plan needs.
pub(super) struct Wire<'a> {
    /// How far from the contour, mm.
    pub(super) offset: Option<f64>,
    /// The side of every contour, where it is said.
    pub(super) side: Option<Side>,
    pub(super) corners: Corners,
    pub(super) starts: &'a [Point],
    /// Whether the format has no word for threading and needs stops.
    pub(super) stops: bool,
}

impl CuttingPlan {
    /// The first of them that is said.
    pub(super) fn first_given(&self) -> Option<&'static str> {
        let given = [
            (self.lead_in.is_some(), "--lead-in"),
            (self.lead_out.is_some(), "--lead-out"),
            (self.overcut.is_some(), "--overcut"),
            (self.tabs.is_some(), "--tabs"),
            (self.passes.is_some(), "--passes"),
            (self.kept.is_some(), "--kept"),
            (self.rethread.is_some(), "--rethread"),
        ];
        given.into_iter().find_map(|(is_given, word)| is_given.then_some(word))
    }

    /// The motions that cut a drawing's contours; tells what was chosen.
    pub(super) fn cut(
        &self,
        drawing: &Drawing,
        wire: &Wire<'_>,
        places: &mut Places,
    ) -> Result<Cutting, Failure> {
        let contours = self.contours(drawing, wire)?;
        let plan = self.plan(wire, contours.iter().all(|contour| contour.holes != Holes::AtLeadIn))?;
        let cutting = Cutting::new(contours, plan).map_err(|refusal| refused(&refusal, places))?;
        say!("{}", cutting.summary().to_string().trim_end());
        Ok(cutting)
    }

    fn plan(&self, wire: &Wire<'_>, has_holes: bool) -> Result<Plan, Failure> {
        let (rough, skims) = match (&self.passes, wire.offset) {
            (Some(_), Some(_)) => {
                return Err(Failure::new(Exit::Usage, "--passes states the offsets, and so does --offset")
                    .help("leave one of them out"));
            }
            (Some(Passes(rough, skims)), None) => (rough.clone(), skims.clone()),
            (None, Some(offset)) if offset >= 0.0 => {
                (Pass { distance: cutting::Distance::Offset(offset), words: Vec::new() }, Vec::new())
            }
            (None, Some(_)) => {
                return Err(Failure::new(Exit::Usage, "the offset of a plan is not negative")
                    .help("say on which side with --side, or what is the part with --kept"));
            }
            (None, None) => {
                return Err(Failure::new(Exit::Usage, "how far the wire runs from the contours is not said")
                    .help("say it with --offset MM (half the wire and the gap) or --passes"));
            }
        };
        let lead_in =
            self.lead_in.unwrap_or(if has_holes { Lead::Direct } else { Lead::Straight { length: 1.0 } });
        let rethread = match (&self.rethread, wire.stops) {
            (Some(Words { cut, thread }), _) => Rethread { cut: word(cut), thread: word(thread) },
            (None, true) => {
                Rethread { cut: vec![Act::Stop(Stop::Pause)], thread: vec![Act::Stop(Stop::Pause)] }
            }
            (None, false) => Rethread { cut: Vec::new(), thread: Vec::new() },
        };
        Ok(Plan {
            rough,
            skims,
            corners: wire.corners,
            lead_in,
            lead_out: self.lead_out.map_or(Some(lead_in), |lead| lead.0),
            overcut: self.overcut.unwrap_or(0.0),
            tabs: self.tabs.clone().unwrap_or(Tabs::None),
            cut_tabs: CutTabs::Last,
            stops: Stops::BeforeLast(Stop::Pause),
            rethread,
            from: wire.starts.first().copied().unwrap_or_else(Point::origin),
        })
    }

    /// The contours, each with the start holes that are nearest to it.
    fn contours(&self, drawing: &Drawing, wire: &Wire<'_>) -> Result<Vec<Contour>, Failure> {
        if self.kept.is_some() && wire.side.is_some() {
            return Err(Failure::new(Exit::Usage, "--kept and --side say the same thing")
                .help("leave one of them out"));
        }
        let kept = |path: &Path, depth: usize| match (self.kept, wire.side) {
            (Some(KeptWord::Inside), _) => Kept::Inside,
            (Some(KeptWord::Outside), _) => Kept::Outside,
            (None, Some(side)) => Kept::beside(path, side),
            (None, None) if depth.is_multiple_of(2) => Kept::Inside,
            (None, None) => Kept::Outside,
        };
        let nearest = |hole: &Point| {
            let distance = |n: &usize| drawing.contours[*n].path.distance(*hole);
            (0..drawing.contours.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))
        };
        let holes: Vec<(Option<usize>, Point)> =
            wire.starts.iter().map(|hole| (nearest(hole), *hole)).collect();
        let contours = drawing.contours.iter().enumerate().map(|(n, contour)| {
            let own: Vec<Point> =
                holes.iter().filter(|(of, _)| *of == Some(n)).map(|(_, hole)| *hole).collect();
            Contour {
                path: contour.path.clone(),
                kept: kept(&contour.path, contour.depth),
                entry: own.first().map_or(Entry::Beginning, |hole| Entry::Nearest(*hole)),
                holes: if own.is_empty() { Holes::AtLeadIn } else { Holes::Given(own) },
                spot: Spot { line: contour.line, column: u64::from(contour.line > 0), byte: 0 },
            }
        });
        Ok(contours.collect())
    }
}

/// Why the contours cannot be cut so.
pub(super) fn refused(refusal: &Refusal, places: &mut Places) -> Failure {
    let line = if refusal.spot.line > 0 { format!(", line {}", refusal.spot.line) } else { String::new() };
    let at = refusal.at.map_or_else(String::new, |at| format!(" at X{:.3} Y{:.3}", at.x, at.y));
    let message = match refusal.contour {
        0 => refusal.fault.to_string(),
        contour => format!("{}: contour {contour}{line}{at}: {}", places.name, refusal.fault),
    };
    Failure::new(Exit::Program, message).help(refusal.help())
}

fn word(text: &str) -> Vec<Act> {
    if text.is_empty() { Vec::new() } else { vec![Act::Word(text.as_bytes().into())] }
}

fn lead_out(text: &str) -> Result<LeadOut, String> {
    if text == "none" {
        return Ok(LeadOut(None));
    }
    let lead = text.parse::<Lead>().map_err(|error| format!("{error}: {}, or none", error.help))?;
    Ok(LeadOut(Some(lead)))
}

fn passes(text: &str) -> Result<Passes, String> {
    let (rough, skims) = cutting::passes(text).map_err(|error| format!("{error}: {}", error.help))?;
    Ok(Passes(rough, skims))
}

fn rethread(text: &str) -> Result<Words, String> {
    match text.split_once(',') {
        Some((cut, thread)) if text.bytes().all(|b| b.is_ascii_alphanumeric() || b == b',') => {
            Ok(Words { cut: cut.to_owned(), thread: thread.to_owned() })
        }
        _ => Err("two words with a comma between, such as M50,M60; either may be left out".to_owned()),
    }
}

fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.0..=1000.0).contains(&value) => Ok(value),
        _ => Err("a length in mm, from 0 to 1000".to_owned()),
    }
}
