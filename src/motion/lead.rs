//! A lead-in from a start hole, and back, for a first contour that has none.
//!
//! The wire cuts straight from the hole to where the contour begins, round it, and the same way back, so that the machine
//! stands where the wire can be threaded again. Everything else stays what it is.

use super::{Act, Motion, Travel};
use crate::geometry::{Element, Point};

/// Motions whose first contour is cut from a start hole.
#[derive(Debug)]
pub struct FromHole<I> {
    motions: I,
    hole: Point,
    state: State,
    waiting: Option<Motion>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum State {
    /// Nothing has moved.
    Before,
    /// Round the contour, which began here.
    Round {
        from: Point,
        at: Point,
    },
    /// Back in the hole, and the way on from the contour still to come.
    Home,
    Behind,
}

/// The way to the first contour becomes a cut from the hole; a closed contour has one back.
pub fn from_hole<I>(motions: I, hole: Point) -> FromHole<I> {
    FromHole { motions, hole, state: State::Before, waiting: None }
}

impl<I> FromHole<I> {
    fn cut(&self, like: &Motion, start: Point, end: Point) -> Motion {
        let element = Element::Line { start, end };
        Motion { act: Act::Move { travel: Travel::Cut, element, upper: None, flag: None }, ..like.clone() }
    }

    fn take(&mut self, motion: Motion) -> Motion {
        match (self.state, &motion.act) {
            (State::Before, &Act::Move { travel, element, .. }) => {
                let on_contour = if travel == Travel::Rapid { element.end() } else { element.start() };
                self.state = State::Round { from: on_contour, at: on_contour };
                let lead_in = self.cut(&motion, self.hole, on_contour);
                if travel == Travel::Cut {
                    self.state = State::Round { from: on_contour, at: element.end() };
                    self.waiting = Some(motion);
                }
                lead_in
            }
            (State::Round { from, .. }, Act::Move { travel: Travel::Cut, element, .. }) => {
                self.state = State::Round { from, at: element.end() };
                motion
            }
            (State::Round { from, at }, Act::Move { travel: Travel::Rapid, .. } | Act::Stop(_)) => {
                if from != at {
                    self.state = State::Behind;
                    return motion;
                }
                self.state = State::Home;
                let lead_out = self.cut(&motion, at, self.hole);
                self.waiting = Some(self.take(motion));
                lead_out
            }
            (State::Home, Act::Move { element: Element::Line { end, .. }, .. }) => {
                self.state = State::Behind;
                let element = Element::Line { start: self.hole, end: *end };
                let travel = Travel::Rapid;
                Motion { act: Act::Move { travel, element, upper: None, flag: None }, ..motion }
            }
            _ => motion,
        }
    }
}

impl<I, E> Iterator for FromHole<I>
where
    I: Iterator<Item = Result<Motion, E>>,
{
    type Item = Result<Motion, E>;

    fn next(&mut self) -> Option<Self::Item> {
        if let Some(waiting) = self.waiting.take() {
            return Some(Ok(waiting));
        }
        Some(self.motions.next()?.map(|motion| self.take(motion)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Stop;
    use crate::place::Spot;

    fn line(travel: Travel, from: (f64, f64), to: (f64, f64)) -> Motion {
        let element = Element::Line { start: Point::new(from.0, from.1), end: Point::new(to.0, to.1) };
        said(Act::Move { travel, element, upper: None, flag: None })
    }

    fn said(act: Act) -> Motion {
        Motion { act, block: 1, spot: Spot::default() }
    }

    type Way = (Travel, (f64, f64), (f64, f64));

    fn ways(motions: Vec<Motion>) -> Vec<Way> {
        let led = from_hole(motions.into_iter().map(Ok::<_, ()>), Point::new(5.0, 5.0));
        let way = |motion: Motion| match motion.act {
            Act::Move { travel, element, .. } => {
                let (a, b) = (element.start(), element.end());
                Some((travel, (a.x, a.y), (b.x, b.y)))
            }
            _ => None,
        };
        led.filter_map(|motion| way(motion.unwrap())).collect()
    }

    #[test]
    fn the_wire_leads_in_from_its_hole_and_back() {
        use Travel::{Cut, Rapid};
        let round = [(1.0, 1.0), (9.0, 1.0), (9.0, 9.0), (1.0, 1.0)];
        let mut motions = vec![line(Rapid, (0.0, 0.0), (1.0, 1.0))];
        motions.extend(round.windows(2).map(|pair| line(Cut, pair[0], pair[1])));
        motions.push(said(Act::Stop(Stop::Pause)));
        motions.push(line(Rapid, (1.0, 1.0), (20.0, 0.0)));
        motions.push(line(Cut, (20.0, 0.0), (21.0, 0.0)));
        motions.push(said(Act::Stop(Stop::End)));
        let expected = [
            (Cut, (5.0, 5.0), (1.0, 1.0)),
            (Cut, (1.0, 1.0), (9.0, 1.0)),
            (Cut, (9.0, 1.0), (9.0, 9.0)),
            (Cut, (9.0, 9.0), (1.0, 1.0)),
            (Cut, (1.0, 1.0), (5.0, 5.0)),
            (Rapid, (5.0, 5.0), (20.0, 0.0)),
            (Cut, (20.0, 0.0), (21.0, 0.0)),
        ];
        assert_eq!(ways(motions.clone()), expected);
        // Where the contour begins at the drawing's zero nothing positions to it.
        motions.remove(0);
        assert_eq!(ways(motions), expected);
    }

    #[test]
    fn an_open_contour_has_no_way_back() {
        let motions = vec![line(Travel::Cut, (0.0, 0.0), (1.0, 1.0)), said(Act::Stop(Stop::End))];
        assert_eq!(ways(motions).len(), 2);
    }
}
