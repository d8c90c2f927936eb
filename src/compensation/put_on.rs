//! An offset put on the contours of a program that has none.
//!
//! ```text
//! in:   hole ── lead-in ── outline ── lead-out
//! out:  hole ── ON, lead-in ── outline ── OFF, lead-out
//! ```
//!
//! The offset is switched on before the last straight move that leads to an outline and off behind the outline, as a
//! G-code program would do it; [`Compensated`](super::Compensated) then works out the wire's path. Where an outline has
//! no lead-in of its own, the way to it leads in. An outline that nothing leads to is refused: the wire would begin
//! beside its start hole.

use std::collections::VecDeque;

use crate::geometry::Element;
use crate::motion::runs::{ContourError, Portion, Run, Runs};
use crate::motion::{Act, Motion, Offset, Side, Travel};

/// Motions with an offset switched on at every closed contour.
#[derive(Debug)]
pub struct PutOn<I> {
    runs: Runs<I>,
    on: Offset,
    /// The last straight way, kept back: it may lead in.
    way: Vec<Motion>,
    ready: VecDeque<Motion>,
    is_over: bool,
}

impl<I, E> PutOn<I>
where
    I: Iterator<Item = Result<Motion, E>>,
    E: Into<ContourError>,
{
    /// Puts an offset on, mm to a side as seen in the direction of motion.
    pub fn new(motions: I, side: Side, distance: f64) -> Self {
        let on = Offset::On { side, distance: Some(distance), register: None };
        Self { runs: Runs::new(motions), on, way: Vec::new(), ready: VecDeque::new(), is_over: false }
    }

    fn take(&mut self, portion: Portion) -> Result<(), ContourError> {
        match portion {
            Portion::Between(motion) => match motion.act {
                Act::Move { travel: Travel::Rapid, .. } => {
                    self.let_go();
                    self.way.push(motion);
                }
                Act::Offset(Offset::On { .. }) => {
                    return Err(ContourError::at(&motion, "the program switches an offset on itself", TWICE));
                }
                _ if self.way.is_empty() => self.ready.push_back(motion),
                _ => self.way.push(motion),
            },
            Portion::Run(run) => {
                let said = run.motions.iter().find(|m| matches!(m.act, Act::Offset(Offset::On { .. })));
                if let Some(motion) = said {
                    return Err(ContourError::at(motion, "the program switches an offset on itself", TWICE));
                }
                self.run(run)?;
            }
        }
        Ok(())
    }

    fn run(&mut self, run: Run) -> Result<(), ContourError> {
        let layout = run.layout();
        let cuts: Vec<(usize, Element)> = run.cuts().collect();
        let straight = |cut: Option<&(usize, Element)>| matches!(cut, Some((_, Element::Line { .. })));
        let Some(&(first, _)) = cuts.first() else { return Ok(()) };
        if !layout.closed {
            if cuts.len() > 1 {
                let message = "an offset is put on a contour that does not come back to where it began";
                return Err(ContourError::at(&run.motions[first], message, OPEN));
            }
            // A straight way, as 3B writes it between two contours.
            self.let_go();
            self.way = run.motions;
            return Ok(());
        }
        let leads_in = layout.lead_in.checked_sub(1).and_then(|n| cuts.get(n));
        if layout.lead_in > 0 && !straight(leads_in) {
            let message = "the last move that leads to the outline is not straight";
            return Err(ContourError::at(&run.motions[first], message, HOLE));
        }
        let on_at = leads_in.map(|(at, _)| *at);
        let off_at = cuts.len().checked_sub(layout.lead_out).and_then(|n| cuts.get(n)).map(|(at, _)| *at);
        if on_at.is_none() {
            let Some(at) = self.way.iter().position(|m| matches!(m.act, Act::Move { .. })) else {
                let message = "nothing leads to the outline, so the wire has no way to stand beside it";
                return Err(ContourError::at(&run.motions[first], message, HOLE));
            };
            let switch = Motion { act: Act::Offset(self.on), ..self.way[at].clone() };
            self.way.insert(at, switch);
        }
        self.let_go();
        let count = run.motions.len();
        for (n, motion) in run.motions.into_iter().enumerate() {
            if on_at == Some(n) {
                self.ready.push_back(Motion { act: Act::Offset(self.on), ..motion.clone() });
            }
            if off_at == Some(n) {
                self.ready.push_back(Motion { act: Act::Offset(Offset::Off), ..motion.clone() });
            }
            let last = (n + 1 == count && off_at.is_none()).then(|| motion.clone());
            self.ready.push_back(motion);
            self.ready.extend(last.map(|motion| Motion { act: Act::Offset(Offset::Off), ..motion }));
        }
        Ok(())
    }

    fn let_go(&mut self) {
        self.ready.extend(self.way.drain(..));
    }
}

impl<I, E> Iterator for PutOn<I>
where
    I: Iterator<Item = Result<Motion, E>>,
    E: Into<ContourError>,
{
    type Item = Result<Motion, ContourError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(motion) = self.ready.pop_front() {
                return Some(Ok(motion));
            }
            if self.is_over {
                return None;
            }
            let taken = match self.runs.next() {
                Some(Ok(portion)) => self.take(portion),
                Some(Err(error)) => Err(error),
                None => {
                    self.is_over = true;
                    self.let_go();
                    Ok(())
                }
            };
            if let Err(error) = taken {
                self.is_over = true;
                self.ready.clear();
                return Some(Err(error));
            }
        }
    }
}

const TWICE: &str = "leave the side out: then its own offset is worked out, at the distance given";
const OPEN: &str = "close the contour, or put the offset on where the program is made";
const HOLE: &str = "lead in from a start hole with a straight move; for a drawing name one with --start X,Y";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compensation::Compensated;
    use crate::geometry::Point;
    use crate::geometry::offset::Corners;
    use crate::motion::Stop;
    use crate::place::Spot;

    fn said(act: Act) -> Motion {
        Motion { act, block: 1, spot: Spot::default() }
    }

    fn moves(travel: Travel, nodes: &[(f64, f64)]) -> Vec<Motion> {
        let point = |at: (f64, f64)| Point::new(at.0, at.1);
        let line = |pair: &[(f64, f64)]| Element::Line { start: point(pair[0]), end: point(pair[1]) };
        nodes
            .windows(2)
            .map(|pair| said(Act::Move { travel, element: line(pair), upper: None, flag: None }))
            .collect()
    }

    fn put_on(motions: Vec<Motion>) -> Result<Vec<Motion>, ContourError> {
        PutOn::new(motions.into_iter().map(Ok::<_, ContourError>), Side::Left, 0.1).collect()
    }

    /// Where the wire goes.
    fn nodes(motions: Vec<Motion>) -> Vec<(f64, f64)> {
        let wire = Compensated::new(
            PutOn::new(motions.into_iter().map(Ok::<_, ContourError>), Side::Left, 0.1),
            std::collections::BTreeMap::new(),
            Corners::Round,
        );
        let end = |motion: Motion| match motion.act {
            Act::Move { element, .. } => Some(element.end()),
            _ => None,
        };
        let round = |v: f64| (v * 1e6).round() / 1e6 + 0.0;
        wire.filter_map(|motion| end(motion.unwrap())).map(|p| (round(p.x), round(p.y))).collect()
    }

    const SQUARE: [(f64, f64); 5] = [(1.0, 1.0), (9.0, 1.0), (9.0, 9.0), (1.0, 9.0), (1.0, 1.0)];

    #[test]
    fn the_wire_runs_within_a_die_and_comes_home_to_its_hole() {
        let motions = moves(Travel::Cut, &[&[(5.0, 5.0)], &SQUARE[..], &[(5.0, 5.0)]].concat());
        let expected = [(1.1, 1.1), (8.9, 1.1), (8.9, 8.9), (1.1, 8.9), (1.1, 1.1), (5.0, 5.0)];
        assert_eq!(nodes(motions), expected);
    }

    #[test]
    fn the_way_to_an_outline_leads_in_where_nothing_else_does() {
        for way in [
            moves(Travel::Rapid, &[(0.0, 0.0), (1.0, 1.0)]),
            [
                vec![said(Act::Stop(Stop::Pause))],
                moves(Travel::Cut, &[(0.0, 0.0), (1.0, 1.0)]),
                vec![said(Act::Stop(Stop::Pause))],
            ]
            .concat(),
        ] {
            let motions = [way, moves(Travel::Cut, &SQUARE)].concat();
            assert_eq!(nodes(motions)[..2], [(1.1, 1.1), (8.9, 1.1)]);
        }
    }

    #[test]
    fn what_cannot_have_an_offset_is_refused() {
        let refusal = |motions| put_on(motions).unwrap_err().to_string();
        assert!(refusal(moves(Travel::Cut, &SQUARE)).contains("nothing leads to the outline"));
        assert!(refusal(moves(Travel::Cut, &SQUARE[..4])).contains("does not come back"));
        let twice = vec![said(Act::Offset(Offset::On { side: Side::Left, distance: None, register: None }))];
        assert!(refusal(twice).contains("switches an offset on itself"));
    }
}
