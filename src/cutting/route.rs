//! One contour's jobs as motions, each way through the waste checked before it is given out.

use super::clearance::{Nearest, between, crossings, nearest_within};
use super::division::{Division, Piece};
use super::jobs::{Begin, Job, What, jobs};
use super::lead::{Stand, Way, inwards, on_grid, outwards, rounded};
use super::refusal::{Fault, Lane, Refusal, check_point};
use super::summary::{ContourSummary, PassSummary, TabSummary};
use super::track::{self, Position, Track, begun_nearest, point_at};
use super::{Contour, Entry, Holes, Kept, Plan};
use crate::geometry::offset::offset;
use crate::geometry::{Element, Path, Point, Vector};
use crate::motion::{Act, Side, Travel};

/// What cuts one contour.
#[derive(Debug)]
pub(super) struct Route {
    pub(super) acts: Vec<Act>,
    pub(super) summary: ContourSummary,
    /// Where the wire stands behind it, on whole microns.
    pub(super) at: Point,
}

impl Route {
    /// The route of the contour with this number, from 0, when the wire stands at a point.
    pub(super) fn of(contours: &[Contour], number: usize, plan: &Plan, at: Point) -> Result<Self, Refusal> {
        let contour = &contours[number];
        let refuse = |at, fault| Refusal { contour: number + 1, spot: contour.spot, at, fault };
        let course = course(contour).map_err(|(at, fault)| refuse(at, fault))?;
        let division = Division::of(course.length(), &plan.tabs).map_err(|fault| refuse(None, fault))?;
        let side = contour.kept.wire_side(&course);
        let mut cutter = Cutter {
            contours,
            number,
            plan,
            summary: ContourSummary {
                kept: contour.kept,
                side,
                entry: course.start(),
                holes: Vec::new(),
                holes_chosen: contour.holes == Holes::AtLeadIn,
                lead_in: plan.lead_in,
                lead_out: plan.lead_out,
                overcut: plan.overcut,
                passes: Vec::new(),
                tabs: Vec::new(),
                cut: 0.0,
                rapid: 0.0,
                moves: 0,
                threadings: 0,
                stops: 0,
            },
            course,
            tracks: Vec::new(),
            division,
            uncut: Vec::new(),
            acts: Vec::new(),
            at,
            hole: at,
        };
        cutter.lay_tracks()?;
        cutter.lay_tabs()?;
        cutter.find_holes()?;
        cutter.cut()?;
        Ok(Self { acts: cutter.acts, summary: cutter.summary, at: cutter.at })
    }
}

/// A contour begun at its entry, without what has no length.
fn course(contour: &Contour) -> Result<Path, (Option<Point>, Fault)> {
    let path = &contour.path;
    // The offset by nothing is the contour itself, once its numbers are looked at.
    if let Err(reason) = offset(path, 0.0, crate::geometry::offset::Corners::Round) {
        return Err((None, Fault::Impossible { pass: 1, reason }));
    }
    if !path.is_closed() {
        return Err((Some(path.end()), Fault::Open));
    }
    let nothing = |element: &&Element| matches!(element, Element::Line { start, end } if start == end);
    let kept: Vec<Element> = path.elements().iter().filter(|element| !nothing(element)).copied().collect();
    let path = Path::new(kept).filter(|path| path.area() != 0.0);
    let path = path.ok_or((Some(contour.path.start()), Fault::EnclosesNothing))?;
    Ok(match contour.entry {
        Entry::Beginning => path,
        Entry::Nearest(to) => {
            check_point("the entry", to).map_err(|refusal| (None, refusal.fault))?;
            begun_nearest(&path, to)
        }
    })
}

struct Cutter<'a> {
    contours: &'a [Contour],
    number: usize,
    plan: &'a Plan,
    summary: ContourSummary,
    course: Path,
    /// One for each pass.
    tracks: Vec<Track>,
    division: Division,
    /// What must not be cut into while a tab holds the piece: its number, and the line from its middle into the waste.
    uncut: Vec<(usize, Element)>,
    acts: Vec<Act>,
    at: Point,
    /// The hole the wire was last threaded in.
    hole: Point,
}

impl Cutter<'_> {
    fn refusal(&self, at: Option<Point>, fault: Fault) -> Refusal {
        Refusal { contour: self.number + 1, spot: self.contours[self.number].spot, at, fault }
    }

    /// The wire's path for each pass.
    fn lay_tracks(&mut self) -> Result<(), Refusal> {
        for (n, pass) in self.plan.passes().enumerate() {
            let by = pass.distance.offset();
            let side = self.summary.side;
            let left = if side == Side::Left { by } else { -by };
            let found = offset(&self.course, left, self.plan.corners)
                .map_err(|reason| self.refusal(None, Fault::Impossible { pass: n + 1, reason }))?;
            let outline = match found.outlines.as_slice() {
                [] => return Err(self.refusal(None, Fault::NoRoom { pass: n + 1, offset: by })),
                [outline] => outline,
                outlines => {
                    let throat = found.unreached.iter().min_by(|a, b| a.largest.total_cmp(&b.largest));
                    let at = throat.map_or(outlines[1].path.start(), |throat| throat.at);
                    let (pieces, largest) = (outlines.len(), throat.map(|throat| throat.largest));
                    let fault = Fault::ComesApart { pass: n + 1, pieces, offset: by, largest };
                    return Err(self.refusal(Some(at), fault));
                }
            };
            let track = Track::new(&self.course, &outline.path, (side, by), &self.division.marks).map_err(
                |lost| {
                    let fault = match lost.mark {
                        0 => Fault::EntryLost { pass: n + 1 },
                        _ => Fault::TabLost { pass: n + 1 },
                    };
                    self.refusal(Some(lost.at), fault)
                },
            )?;
            let kerf = (pass.distance.kerf_radius() - TOUCH).max(CROSSES);
            for (other, contour) in self.contours.iter().enumerate().filter(|(n, _)| *n != self.number) {
                let elements = contour.path.elements();
                if !near(&self.course, &contour.path, by + kerf) {
                    continue;
                }
                let hit = track.elements().iter().find_map(|way| nearest_within(way, elements, kerf));
                if let Some(hit) = hit {
                    let (distance, least) = (hit.distance, kerf + TOUCH);
                    let fault = Fault::CutsOther { pass: n + 1, other: other + 1, distance, least };
                    return Err(self.refusal(Some(hit.at), fault));
                }
            }
            self.check_overcut(&track)?;
            self.summary.passes.push(PassSummary {
                offset: by,
                path: track.length,
                cut: 0.0,
                unreached: found.unreached,
                filled_corners: found.filled_corners,
            });
            self.tracks.push(track);
        }
        Ok(())
    }

    fn check_overcut(&self, track: &Track) -> Result<(), Refusal> {
        let room = |mark: usize| track.place(bare(mark + 1)) - track.place(bare(mark));
        let length = self.division.of_kind(Piece::Stretch).map(room).fold(f64::INFINITY, f64::min);
        if self.plan.overcut <= length {
            return Ok(());
        }
        Err(self.refusal(None, Fault::OvercutTooLong { overcut: self.plan.overcut, length }))
    }

    /// What holds the piece.
    fn lay_tabs(&mut self) -> Result<(), Refusal> {
        let kerf = self.plan.rough.distance.kerf_radius();
        for (n, mark) in self.division.of_kind(Piece::Tab).enumerate() {
            let marks = &self.division.marks;
            let (from, _) = point_at(&self.course, marks[mark]);
            let (to, _) = point_at(&self.course, marks[mark + 1]);
            let track = &self.tracks[0];
            let (begin, end) = (track.place(bare(mark)), track.place(bare(mark + 1)));
            let bridge = end - begin - 2.0 * kerf;
            if bridge <= 0.0 {
                let fault = Fault::TabTooShort { tab: n + 1, length: end - begin, kerf };
                return Err(self.refusal(Some(from), fault));
            }
            let (middle, heading) = track.leaving(0.5 * (begin + end));
            let away = self.away(middle, heading, 0, true);
            // Farther out than half its length, a way past the tab leaves it as broad as it is.
            let line = Element::Line { start: middle, end: middle + away * (0.5 * (end - begin)) };
            self.uncut.push((mark, line));
            let length = marks[mark + 1] - marks[mark];
            self.summary.tabs.push(TabSummary { from, to, length, bridge });
        }
        Ok(())
    }

    /// Where the wire is threaded for each stretch.
    fn find_holes(&mut self) -> Result<(), Refusal> {
        let stretches: Vec<usize> = self.division.of_kind(Piece::Stretch).collect();
        let mut holes = Vec::with_capacity(stretches.len());
        match &self.contours[self.number].holes {
            Holes::AtLeadIn => {
                for mark in &stretches {
                    let stand = self.stand(0, bare(*mark), Towards::Leaving, true);
                    let way = inwards(self.plan.lead_in, &stand, None);
                    holes.push(way.ok_or_else(|| self.refusal(None, Fault::NoHole))?.outer);
                }
            }
            Holes::Given(given) if given.len() == 1 || given.len() == stretches.len() => {
                for hole in given {
                    check_point("a start hole", *hole)?;
                }
                holes = stretches.iter().zip(given.iter().cycle()).map(|(_, hole)| *hole).collect();
            }
            Holes::Given(given) => {
                let fault = Fault::Holes { given: given.len(), needed: stretches.len() };
                return Err(self.refusal(None, fault));
            }
        }
        let kept = self.summary.kept;
        for hole in &mut holes {
            // A hole put where a lead begins is in the part only when the lead crosses it, which is looked at with the lead.
            let in_part = self.course.contains(*hole) == (kept == Kept::Inside);
            if in_part && !self.summary.holes_chosen {
                return Err(self.refusal(Some(*hole), Fault::HoleInPart { kept }));
            }
            *hole = on_grid(*hole);
        }
        self.summary.holes = holes;
        Ok(())
    }

    fn cut(&mut self) -> Result<(), Refusal> {
        let mut said = None;
        let mut before: Option<Job> = None;
        let jobs = jobs(&self.division, self.plan);
        for job in &jobs {
            let forwards = self.runs_forwards(job);
            let begin = self.stand(job.pass, job.from, Towards::Leaving, forwards);
            if let (Begin::LeadAgain { .. }, Some(last)) = (job.begin, &before) {
                self.lead_out(last)?;
            }
            if let Begin::Thread { stretch } = job.begin {
                self.thread(self.summary.holes[stretch]);
            }
            if let Some(stop) = job.stop {
                // Where threading ends with such a stop the control stands already.
                if self.acts.last() != Some(&Act::Stop(stop)) {
                    self.acts.push(Act::Stop(stop));
                }
                self.summary.stops += 1;
            }
            if said != Some(job.pass) || matches!(job.begin, Begin::Thread { .. }) {
                let pass = self.plan.passes().nth(job.pass);
                self.acts.extend(pass.into_iter().flat_map(|pass| &pass.words).cloned().map(Act::Word));
                said = Some(job.pass);
            }
            match job.begin {
                Begin::Thread { stretch } | Begin::LeadAgain { stretch } => {
                    let hole = self.summary.holes[stretch];
                    let way = inwards(self.plan.lead_in, &begin, Some(hole));
                    let way = way.ok_or_else(|| self.refusal(None, Fault::NoHole))?;
                    let threaded = matches!(job.begin, Begin::Thread { .. });
                    let lane = if threaded { Lane::Approach } else { Lane::Change };
                    let from = before.as_ref().filter(|_| !threaded).map_or(job.pass, |last| last.pass);
                    self.straight(way.outer, lane, [from, job.pass])?;
                    self.lead(&way, Lane::LeadIn, job.pass)?;
                }
                Begin::Step => {
                    let from = before.as_ref().map_or(job.pass, |last| last.pass);
                    self.straight(begin.at, Lane::Change, [from, job.pass])?;
                }
            }
            let track = &self.tracks[job.pass];
            let (from, to) = (track.place(job.from), track.place(job.to));
            self.summary.passes[job.pass].cut += (to - from).abs();
            for element in track.between(from, to) {
                self.go(Travel::Cut, element);
            }
            if let What::Tab(mark) = job.piece {
                self.uncut.retain(|(tab, _)| *tab != mark);
            }
            before = Some(*job);
        }
        match &before {
            Some(last) if self.plan.lead_out.is_some() => self.lead_out(last),
            _ => Ok(()),
        }
    }

    /// Positions the machine over a start hole.
    fn thread(&mut self, hole: Point) {
        self.hole = hole;
        let first = self.number == 0 && self.summary.threadings == 0;
        // A wire that was led back to the very hole is still threaded in it.
        if self.at == hole && !first {
            if self.summary.threadings == 0 {
                self.summary.threadings = 1;
            }
            return;
        }
        if !first {
            self.acts.extend(self.plan.rethread.cut.iter().cloned());
        }
        self.go(Travel::Rapid, Element::Line { start: self.at, end: hole });
        if !first {
            self.acts.extend(self.plan.rethread.thread.iter().cloned());
        }
        self.summary.threadings += 1;
    }

    fn lead_out(&mut self, last: &Job) -> Result<(), Refusal> {
        let stand = self.stand(last.pass, last.to, Towards::Arriving, self.runs_forwards(last));
        let Some(way) = self.plan.lead_out.and_then(|lead| outwards(lead, &stand, Some(self.hole))) else {
            return Ok(());
        };
        self.lead(&way, Lane::LeadOut, last.pass)
    }

    fn lead(&mut self, way: &Way, lane: Lane, pass: usize) -> Result<(), Refusal> {
        let Some(element) = way.element.and_then(|element| rounded(&element, self.at)) else { return Ok(()) };
        self.check(&element, lane, [pass; 2])?;
        self.go(Travel::Cut, element);
        Ok(())
    }

    /// Goes straight through the waste, between two passes.
    fn straight(&mut self, to: Point, lane: Lane, passes: [usize; 2]) -> Result<(), Refusal> {
        if on_grid(to) != self.at {
            let element = Element::Line { start: self.at, end: on_grid(to) };
            self.check(&element, lane, passes)?;
            self.go(Travel::Cut, element);
        }
        Ok(())
    }

    /// Refuses a way through the waste that cuts into a part, or into a tab that still holds it.
    fn check(&self, way: &Element, lane: Lane, passes: [usize; 2]) -> Result<(), Refusal> {
        let offset = passes.map(|pass| self.tracks[pass].by);
        let offset = offset[0].min(offset[1]);
        let kerf = passes.map(|pass| self.plan.passes().nth(pass).map_or(0.0, |p| p.distance.kerf_radius()));
        let kerf = kerf[0].max(kerf[1]);
        for (other, contour) in self.contours.iter().enumerate() {
            let own = other == self.number;
            let (elements, least) =
                if own { (self.course.elements(), offset) } else { (contour.path.elements(), kerf) };
            let hit = if own && least == 0.0 {
                self.through_part(way)
            } else {
                nearest_within(way, elements, (least - TOUCH.min(least / 2.0)).max(CROSSES))
            };
            if let Some(hit) = hit {
                let fault = Fault::CutsPart { lane, other: other + 1, distance: hit.distance, least };
                return Err(self.refusal(Some(hit.at), fault));
            }
        }
        for (n, (mark, line)) in self.uncut.iter().enumerate() {
            let hit = between(way, line);
            if hit.distance < (self.plan.rough.distance.kerf_radius() - TOUCH).max(CROSSES) {
                let tab = self.division.of_kind(Piece::Tab).position(|at| at == *mark).unwrap_or(n) + 1;
                return Err(self.refusal(Some(hit.at), Fault::CutsTab { lane, tab }));
            }
        }
        Ok(())
    }

    /// Where a way to or from the very contour leads through the part.
    fn through_part(&self, way: &Element) -> Option<Nearest> {
        let is_end = |at: Point| [way.start(), way.end()].iter().any(|end| (end - at).norm() <= 2.0 * TOUCH);
        let crossed = self.course.elements().iter().flat_map(|element| crossings(way, element));
        let middle = way.at(0.5);
        let in_part = self.course.contains(middle) == (self.summary.kept == Kept::Inside);
        let at = crossed.into_iter().find(|at| !is_end(*at)).or(in_part.then_some(middle));
        at.map(|at| Nearest { distance: 0.0, at })
    }

    fn go(&mut self, travel: Travel, element: Element) {
        let Some(element) = rounded(&element, self.at) else { return };
        self.at = element.end();
        let way = match travel {
            Travel::Cut => &mut self.summary.cut,
            Travel::Rapid => &mut self.summary.rapid,
        };
        *way += element.length();
        self.summary.moves += 1;
        self.acts.push(Act::Move { travel, element, upper: None, flag: None });
    }

    fn runs_forwards(&self, job: &Job) -> bool {
        let track = &self.tracks[job.pass];
        track.place(job.to) >= track.place(job.from)
    }

    /// How the wire stands on a pass, when it runs with the contour or against it.
    fn stand(&self, pass: usize, position: Position, towards: Towards, forwards: bool) -> Stand {
        let track = &self.tracks[pass];
        let place = track.place(position);
        let (at, heading) = match (towards, forwards) {
            (Towards::Leaving, true) | (Towards::Arriving, false) => track.leaving(place),
            (Towards::Arriving, true) | (Towards::Leaving, false) => track.arriving(place),
        };
        let waste_left = (track.side == Side::Left) == forwards;
        let heading = if forwards { heading } else { -heading };
        Stand { at, heading, away: self.away(at, heading, pass, forwards), waste_left }
    }

    /// The direction straight away from the contour at a point of the wire's path: from all that is as near as the offset,
    /// so that it halves the angle of an inside corner.
    fn away(&self, at: Point, heading: Vector, pass: usize, forwards: bool) -> Vector {
        let track = &self.tracks[pass];
        let mut sum = Vector::zeros();
        for element in self.course.elements() {
            let from = at - element.nearest(at);
            let distance = from.norm();
            if distance <= track.by + TOUCH {
                // On the contour itself it is square to it.
                let direction = if distance > TOUCH.min(track.by / 2.0) {
                    from / distance
                } else {
                    let along = track::heading(element, element.nearest(at));
                    let left = Vector::new(-along.y, along.x);
                    if track.side == Side::Left { left } else { -left }
                };
                // Neighbours that share the nearest point say the same thing twice.
                if (sum - direction).norm() > 1e-3 {
                    sum += direction;
                }
            }
        }
        if sum.norm() > 1e-3 {
            return sum.normalize();
        }
        let left = Vector::new(-heading.y, heading.x);
        if (track.side == Side::Left) == forwards { left } else { -left }
    }
}

/// Which side of a place on the path counts.
#[derive(Clone, Copy, Debug)]
enum Towards {
    /// The wire goes on from there.
    Leaving,
    /// The wire comes there.
    Arriving,
}

fn bare(mark: usize) -> Position {
    Position { mark, laps: 0, over: 0.0 }
}

/// Whether two paths come near each other, as far as their extents tell.
fn near(one: &Path, other: &Path, within: f64) -> bool {
    let ([min, max], [low, high]) = (one.extent(), other.extent());
    min.x < high.x + within && max.x > low.x - within && min.y < high.y + within && max.y > low.y - within
}

/// Ways may come nearer than they must by as much, mm: the rounding of their nodes, at most half a micron in X and in Y.
const TOUCH: f64 = 0.75e-3;
/// Ways so near to each other cross, mm: a nanometre.
const CROSSES: f64 = 1e-6;
