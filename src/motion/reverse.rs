//! The same contours cut backwards (反割), each from its own start hole and back to it.
//!
//! A contour's elements are reversed and so is their order; what led in leads out. The side of an offset or a taper
//! changes; a 4B flag does not, for an arc that is convex stays so, and the flag of a lead-in stays with the move that
//! leads in. A cutting condition holds for the same moves as before. An offset or a taper is put on and taken off *along*
//! a move: what it was before that move, it is behind it when the move is run backwards, so the move that took it off
//! puts it on. The contours keep their order. One contour is held at a time.

use std::collections::BTreeMap;

use super::runs::{Between, ContourError, Contourwise, Layout, MEET_MM, Rework, Run};
use super::{Act, Flag, Motion, Offset, Stop, Taper};
use crate::geometry::{Element, Point};

/// A program cut backwards, contour by contour.
pub fn reversed<I, E>(motions: I) -> Contourwise<I, Reverse>
where
    I: Iterator<Item = Result<Motion, E>>,
    E: Into<ContourError>,
{
    Contourwise::new(motions, Reverse::default())
}

/// Turns contours round.
#[derive(Debug, Default)]
pub struct Reverse {
    /// What the program has said.
    settings: Settings,
    /// What has been said in turn, as the program says it forwards.
    in_force: Settings,
    /// The offset and the taper on the last move of the program.
    on_move: Settings,
}

impl Rework for Reverse {
    fn run(&mut self, run: Run) -> Result<Vec<Motion>, ContourError> {
        self.backwards(run)
    }

    fn between(&mut self, motion: Motion) -> Result<Between, ContourError> {
        match &motion.act {
            // Along which move it is put on or taken off is told by the next one.
            Act::Offset(_) | Act::Taper(_) => {
                note(&mut self.settings, &motion);
                Ok(Between::Several(Vec::new()))
            }
            Act::Move { .. } => self.behind_what_waits(motion),
            // Taken off behind the last move of all.
            Act::Stop(Stop::End) if !self.settings.values().any(is_on) => self.behind_what_waits(motion),
            _ => {
                if note(&mut self.settings, &motion) {
                    note(&mut self.in_force, &motion);
                }
                Ok(Between::One(motion))
            }
        }
    }
}

impl Reverse {
    /// A motion between runs behind the offset and the taper that hold for it.
    fn behind_what_waits(&mut self, motion: Motion) -> Result<Between, ContourError> {
        let mut motions = Vec::new();
        change(&mut self.in_force, &self.settings, &motion, &mut motions)?;
        self.on_move = path_of(&self.settings);
        motions.push(motion);
        Ok(Between::Several(motions))
    }
}

/// What stays in force until it is changed: by its address, the motion that set it.
type Settings = BTreeMap<Vec<u8>, Motion>;

/// Notes a setting; whether it is one.
fn note(settings: &mut Settings, motion: &Motion) -> bool {
    let Some(address) = address(&motion.act) else { return false };
    settings.insert(address, motion.clone());
    true
}

/// The address of a setting: of a word, its letters. An M function is done once, and a line number is no setting.
fn address(act: &Act) -> Option<Vec<u8>> {
    match act {
        Act::Offset(_) => Some(b"offset".to_vec()),
        Act::Taper(_) => Some(b"taper".to_vec()),
        Act::Word(word) | Act::Unknown(word) => {
            let letters: Vec<u8> =
                word.iter().take_while(|b| b.is_ascii_alphabetic()).map(u8::to_ascii_uppercase).collect();
            (!matches!(letters.as_slice(), b"" | b"M" | b"N" | b"O")).then_some(letters)
        }
        Act::Move { .. } | Act::Stop(_) | Act::Dwell(_) | Act::Comment(_) | Act::Header(_) => None,
    }
}

/// A move of a run, with what is in force on it and what stands around it.
struct Cut {
    motion: Motion,
    settings: Settings,
    /// The offset and the taper on the move before it.
    before: Settings,
    /// What is said just before the move and stays with it.
    remarks: Vec<Motion>,
    /// What happens at the node before the move: stops, functions.
    at_node: Vec<Motion>,
    backwards: bool,
}

impl Reverse {
    /// A run cut backwards.
    fn backwards(&mut self, run: Run) -> Result<Vec<Motion>, ContourError> {
        let layout = run.layout();
        // One straight move by itself is a way: between the pauses of a 3B program, or out behind a stop.
        let is_way = matches!(run.cuts().collect::<Vec<_>>()[..], [(_, Element::Line { .. })]);
        if let (false, false, Some((first, _))) = (layout.closed, is_way, run.cuts().next()) {
            return Err(ContourError::at(
                &run.motions[first],
                "a contour that does not come back to where it began",
                "backwards it would begin elsewhere, where there is no start hole; cut it forwards, or close it",
            ));
        }
        let settings = &mut self.settings;
        let (mut cuts, mut remarks, mut at_node): (Vec<Cut>, Vec<Motion>, Vec<Motion>) = Default::default();
        for motion in run.motions {
            match motion.act {
                Act::Move { .. } => cuts.push(Cut {
                    motion,
                    settings: settings.clone(),
                    before: std::mem::replace(&mut self.on_move, path_of(settings)),
                    remarks: std::mem::take(&mut remarks),
                    at_node: std::mem::take(&mut at_node),
                    backwards: false,
                }),
                Act::Comment(_) | Act::Header(_) => remarks.push(motion),
                _ if note(settings, &motion) => {}
                _ => at_node.push(motion),
            }
        }
        if !is_way {
            turn_round(&mut cuts, layout);
        }
        let mut motions = Vec::new();
        for cut in cuts {
            let wanted = if cut.backwards { with_path(cut.settings, cut.before) } else { cut.settings };
            change(&mut self.in_force, &wanted, &cut.motion, &mut motions)?;
            // A move run backwards comes to the node it began at.
            let (before, behind) =
                if cut.backwards { (Vec::new(), cut.at_node) } else { (cut.at_node, Vec::new()) };
            motions.extend(before.into_iter().chain(cut.remarks).chain([cut.motion]).chain(behind));
        }
        // What was said behind the last cut comes behind the last cut; an offset or a taper waits for the next.
        if let Some(last) = motions.last().cloned() {
            let wanted = with_path(settings.clone(), path_of(&self.in_force));
            change(&mut self.in_force, &wanted, &last, &mut motions)?;
        }
        motions.extend(remarks.into_iter().chain(at_node));
        Ok(motions)
    }
}

/// Whether it is an offset or a taper: what is put on and taken off along a move.
fn is_of_path(motion: &Motion) -> bool {
    matches!(motion.act, Act::Offset(_) | Act::Taper(_))
}

fn is_on(motion: &Motion) -> bool {
    matches!(motion.act, Act::Offset(Offset::On { .. }) | Act::Taper(Taper::On { .. }))
}

/// The offset and the taper alone.
fn path_of(settings: &Settings) -> Settings {
    let of_path = settings.iter().filter(|(_, motion)| is_of_path(motion));
    of_path.map(|(address, motion)| (address.clone(), motion.clone())).collect()
}

/// The settings with another offset and taper.
fn with_path(mut settings: Settings, path: Settings) -> Settings {
    settings.retain(|_, motion| !is_of_path(motion));
    settings.extend(path);
    settings
}

/// Puts in force what holds for a move.
fn change(
    in_force: &mut Settings,
    wanted: &Settings,
    motion: &Motion,
    motions: &mut Vec<Motion>,
) -> Result<(), ContourError> {
    for (address, now) in in_force.iter() {
        let off = match now.act {
            Act::Offset(Offset::On { .. }) => Act::Offset(Offset::Off),
            Act::Taper(Taper::On { .. }) => Act::Taper(Taper::Off),
            _ => continue,
        };
        if !wanted.contains_key(address) {
            motions.push(Motion { act: off, ..motion.clone() });
        }
    }
    let never_set = |(address, now): (&Vec<u8>, &Motion)| {
        !wanted.contains_key(address) && matches!(now.act, Act::Word(_) | Act::Unknown(_))
    };
    if let Some((_, set)) = in_force.iter().find(|&entry| never_set(entry)) {
        return Err(ContourError::at(
            set,
            "a word set for the first time within a contour",
            "backwards it would hold from the start, and what held before it is not said: set it before the contour too",
        ));
    }
    for (address, set) in wanted {
        let now = in_force.get(address).map(|now| &now.act);
        let off = matches!(set.act, Act::Offset(Offset::Off) | Act::Taper(Taper::Off));
        if now != Some(&set.act) && !(off && now.is_none()) {
            motions.push(Motion { act: other_side(set.act.clone()), ..set.clone() });
        }
    }
    in_force.clone_from(wanted);
    Ok(())
}

/// Turns the moves round: the whole run if it ends where it began, else the outline between its leads.
fn turn_round(cuts: &mut [Cut], layout: Layout) {
    let (Some(first), Some(last)) = (cuts.first(), cuts.last()) else { return };
    let (begins, ends) = (of(first).start(), of(last).end());
    let count = cuts.len();
    let whole = (begins - ends).norm() <= MEET_MM;
    let range = if whole { 0..count } else { layout.lead_in..count - layout.lead_out };
    let (from, to) = match cuts.get(range.clone()) {
        Some([only]) => (of(only).start(), of(only).end()),
        Some([first, .., last]) => (of(first).start(), of(last).end()),
        Some([]) | None => return,
    };
    cuts[range.clone()].reverse();
    for cut in &mut cuts[range.clone()] {
        cut.backwards = true;
        if let Act::Move { element, upper, .. } = &mut cut.motion.act {
            *element = element.reversed();
            *upper = upper.map(Element::reversed);
        }
    }
    // A contour that closed a few microns off begins and ends where it did.
    if let Act::Move { element, .. } = &mut cuts[range.start].motion.act {
        *element = with_start(*element, from);
    }
    if let Act::Move { element, .. } = &mut cuts[range.end - 1].motion.act {
        *element = with_start(element.reversed(), to).reversed();
    }
    if whole {
        for n in 0..layout.lead_in.min(count / 2) {
            let leading_out = count - 1 - n;
            let (a, b) = (flag_of(&cuts[n]), flag_of(&cuts[leading_out]));
            set_flag(&mut cuts[n], b);
            set_flag(&mut cuts[leading_out], a);
        }
    }
}

fn of(cut: &Cut) -> Element {
    match cut.motion.act {
        Act::Move { element, .. } => element,
        _ => unreachable!("only moves are cuts"),
    }
}

fn flag_of(cut: &Cut) -> Option<Flag> {
    match cut.motion.act {
        Act::Move { flag, element: Element::Line { .. }, .. } => flag,
        _ => None,
    }
}

fn set_flag(cut: &mut Cut, to: Option<Flag>) {
    if let Act::Move { flag, element: Element::Line { .. }, .. } = &mut cut.motion.act {
        *flag = to;
    }
}

fn with_start(element: Element, start: Point) -> Element {
    match element {
        Element::Line { end, .. } => Element::Line { start, end },
        // A full circle stays one.
        Element::Arc { start: own, end, .. } if own == end => element,
        Element::Arc { end, centre, sense, .. } => Element::Arc { start, end, centre, sense },
    }
}

/// The same thing seen the other way.
fn other_side(act: Act) -> Act {
    match act {
        Act::Offset(Offset::On { side, distance, register }) => {
            Act::Offset(Offset::On { side: side.opposite(), distance, register })
        }
        Act::Taper(Taper::On { side, angle }) => Act::Taper(Taper::On { side: side.opposite(), angle }),
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Sense;
    use crate::motion::{Side, Travel};
    use crate::place::Spot;

    fn said(act: Act) -> Motion {
        Motion { act, block: 1, spot: Spot::default() }
    }

    fn point(at: (f64, f64)) -> Point {
        Point::new(at.0, at.1)
    }

    fn cut(from: (f64, f64), to: (f64, f64), flag: Option<Flag>) -> Motion {
        let element = Element::Line { start: point(from), end: point(to) };
        said(Act::Move { travel: Travel::Cut, element, upper: None, flag })
    }

    /// From the hole at the origin to a half disc, round it, and back.
    fn half_disc() -> Vec<Motion> {
        let arc = Element::Arc {
            start: point((6.0, 2.0)),
            end: point((2.0, 2.0)),
            centre: point((4.0, 2.0)),
            sense: Sense::CounterClockwise,
        };
        vec![
            cut((0.0, 0.0), (2.0, 2.0), Some(Flag::D)),
            cut((2.0, 2.0), (6.0, 2.0), None),
            said(Act::Move { travel: Travel::Cut, element: arc, upper: None, flag: Some(Flag::D) }),
            cut((2.0, 2.0), (0.0, 0.0), None),
        ]
    }

    fn reverse(motions: Vec<Motion>) -> Result<Vec<Motion>, ContourError> {
        reversed(motions.into_iter().map(Ok::<_, ContourError>)).collect()
    }

    /// What is done, briefly.
    fn brief(motions: &[Motion]) -> Vec<String> {
        let of = |motion: &Motion| match &motion.act {
            Act::Move { element: Element::Line { end, .. }, flag, .. } => {
                format!("{},{} {flag:?}", end.x, end.y)
            }
            Act::Move { element: Element::Arc { end, sense, .. }, flag, .. } => {
                format!("{sense:?} {},{} {flag:?}", end.x, end.y)
            }
            Act::Offset(Offset::On { side, .. }) => format!("{side:?}"),
            Act::Word(word) | Act::Comment(word) => String::from_utf8_lossy(word).into_owned(),
            other => format!("{other:?}"),
        };
        motions.iter().map(of).collect()
    }

    fn offset(side: Side) -> Motion {
        said(Act::Offset(Offset::On { side, distance: Some(0.1), register: None }))
    }

    #[test]
    fn a_contour_is_cut_backwards_from_its_own_hole() {
        let mut motions = vec![offset(Side::Left)];
        motions.extend(half_disc());
        motions.insert(4, said(Act::Offset(Offset::Off)));
        motions.push(said(Act::Stop(Stop::End)));
        let backwards = reverse(motions.clone()).unwrap();
        assert_eq!(
            brief(&backwards),
            [
                "Right",
                "2,2 Some(D)",
                "Clockwise 6,2 Some(D)",
                "2,2 None",
                "Offset(Off)",
                "0,0 None",
                "Stop(End)"
            ]
        );
        assert_eq!(reverse(backwards).unwrap(), motions);
    }

    #[test]
    fn a_way_between_pauses_is_gone_as_it_is() {
        let mut motions = half_disc();
        motions.push(said(Act::Stop(Stop::Pause)));
        motions.push(cut((0.0, 0.0), (30.0, 0.0), None));
        motions.push(said(Act::Stop(Stop::Pause)));
        let told = brief(&reverse(motions).unwrap());
        assert_eq!(told[4..], ["Stop(Pause)", "30,0 None", "Stop(Pause)"]);
    }

    #[test]
    fn a_contour_without_a_way_out_keeps_its_way_in() {
        let backwards = reverse(half_disc()[..3].to_vec()).unwrap();
        assert_eq!(brief(&backwards), ["2,2 Some(D)", "Clockwise 6,2 Some(D)", "2,2 None"]);
    }

    #[test]
    fn what_holds_for_a_move_holds_for_it_backwards() {
        let word = |text: &str| said(Act::Word(text.as_bytes().into()));
        let [lead_in, line, arc, lead_out]: [Motion; 4] = half_disc().try_into().unwrap();
        let motions = vec![
            word("C001"),
            lead_in,
            offset(Side::Left),
            word("C002"),
            line,
            said(Act::Stop(Stop::Pause)),
            said(Act::Comment(b"the round side".as_slice().into())),
            arc,
            said(Act::Offset(Offset::Off)),
            word("M50"),
            lead_out,
            word("M02"),
        ];
        let backwards = reverse(motions).unwrap();
        assert_eq!(
            brief(&backwards),
            [
                "C001",
                "C002",
                "Right",
                "2,2 Some(D)",
                "M50",
                "the round side",
                "Clockwise 6,2 Some(D)",
                "Stop(Pause)",
                "Offset(Off)",
                "2,2 None",
                "C001",
                "0,0 None",
                "C002",
                "M02"
            ]
        );
    }

    #[test]
    fn what_cannot_be_cut_backwards_is_refused() {
        let open = reverse(half_disc()[..2].to_vec()).unwrap_err().to_string();
        assert!(open.contains("block 1: a contour that does not come back"), "{open}");
        let mut motions = half_disc();
        motions.insert(2, said(Act::Word(b"C002".as_slice().into())));
        let unset = reverse(motions).unwrap_err().to_string();
        assert!(unset.contains("set for the first time"), "{unset}");
    }
}
