//! The block for a straight line: nearly always the difference between the goal and where the control stands.
//!
//! The models part on lines only where X leads with nothing to do: straight along Y, and at 45° in quadrants 2 and 4.
//! There a lattice point beside the goal serves them all, or, where that is too far off, two lines that lean a little.

use super::{Choice, Goal, NoneFits, Stand};
use crate::formats::three_b::Block;
use crate::geometry::Point;
use crate::interpolator::Model;
use crate::rounding::Aim;
use crate::units::Position;

/// The best line to the goal; `Ok(None)` when no motion brings the control nearer.
pub(super) fn choose(stand: Stand, goal: Goal) -> Result<Option<Choice>, NoneFits> {
    match nearest(stand, goal) {
        Some(choice) if goal.admits(choice.end, stand.limit_um()) => Ok(Some(choice)),
        None if goal.admits(stand.at, stand.limit_um()) => Ok(None),
        Some(_) | None => Err(NoneFits),
    }
}

/// The line that ends nearest to the goal, however near that is; none when no motion brings the control nearer.
pub(super) fn nearest(stand: Stand, goal: Goal) -> Option<Choice> {
    let straight = goal.at - stand.at;
    if straight == Position::default() {
        return None;
    }
    let mut best: Option<Choice> = None;
    for (dx, dy) in NEIGHBOURS {
        let way = straight + Position::new(dx, dy);
        if way == Position::default() {
            continue;
        }
        let block = Block::line(way);
        let Some(moved) = displacement(stand.aim, &block) else { continue };
        let end = stand.at + moved;
        let error = goal.error(end);
        if best.is_none_or(|b| error < b.error) {
            best = Some(Choice { block, end, error });
        }
        if end == goal.at {
            break;
        }
    }
    best.filter(|b| b.error < goal.error(stand.at))
}

/// A place to go by on the way to the goal where no single line serves, mm: a micron beside the middle, or, if it has to be
/// exact, the first lattice point from which both halves are.
pub(super) fn detour(stand: Stand, goal: Goal) -> Option<Point> {
    let way = goal.at - stand.at;
    let (x, y) = (way.x.0, way.y.0);
    let point = |at: Position| Point::new(at.x.millimetres(), at.y.millimetres());
    let beside = stand.at + Position::new(x / 2 + 1, y / 2);
    let runs = |from: Position, to: Position| {
        from != to && displacement(stand.aim, &Block::line(to - from)) == Some(to - from)
    };
    if goal.exactly {
        let middles = NEIGHBOURS.map(|(dx, dy)| stand.at + Position::new(x / 2 + dx, y / 2 + dy));
        let near = NEIGHBOURS.map(|(dx, dy)| stand.at + Position::new(dx, dy));
        let mut places = [beside].into_iter().chain(middles).chain(near);
        if let Some(by) = places.find(|&by| runs(stand.at, by) && runs(by, goal.at)) {
            return Some(point(by));
        }
    }
    // Shorter than this there is no middle to go by; the lattice point beside the goal has to do.
    if x.abs().max(y.abs()) < 4 {
        return None;
    }
    Some(point(beside))
}

/// Where the line ends, if every model aimed at agrees.
fn displacement(aim: Aim, block: &Block) -> Option<Position> {
    match aim {
        Aim::One(model) => model.displacement(block).ok(),
        Aim::Any => {
            let first = Model::Rotated.displacement(block).ok()?;
            let agree = |model: Model| model.displacement(block) == Ok(first);
            (agree(Model::Mirrored) && agree(Model::Exact)).then_some(first)
        }
    }
}

/// The difference itself, then the lattice points round it.
const NEIGHBOURS: [(i64, i64); 9] =
    [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)];
