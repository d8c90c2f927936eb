//! The closed form against stepping, written out from the tables of the method.

use super::*;
use crate::formats::three_b::{Axis, Quadrant};
use crate::geometry::Sense;
use crate::units::Micrometres;

/// Steps a block pulse by pulse under an integer model; the slow truth.
fn step(model: Model, block: &Block) -> Result<Position, Fault> {
    let mut left = block.j.0;
    let (sx, sy) = match block.motion {
        Motion::Line(q) | Motion::Arc(_, q) => q.signs(),
    };
    if let Motion::Line(quadrant) = block.motion {
        let (mut x, mut y, mut f) = (0, 0, 0i64);
        let x_leads = model == Model::Mirrored || quadrant == Quadrant::First || quadrant == Quadrant::Third;
        let (a, b) = if x_leads { (block.x.0, block.y.0) } else { (block.y.0, block.x.0) };
        let mut idle = 0;
        while left > 0 {
            let lead = f >= 0;
            f += if lead { -b } else { a };
            let on_x = lead == x_leads;
            if on_x {
                x += sx
            } else {
                y += sy
            }
            if on_x == (block.g == Axis::X) {
                left -= 1;
                idle = 0;
            } else {
                idle += 1;
                if idle > 10_000 {
                    return Err(Fault::Endless);
                }
            }
        }
        return Ok(Position::new(x, y));
    }
    let Motion::Arc(sense, _) = block.motion else { unreachable!() };
    let (x0, y0) = (sx * block.x.0, sy * block.y.0);
    let (mut x, mut y, mut f) = (x0, y0, 0i64);
    while left > 0 {
        let inward = if model == Model::Strict { f > 0 } else { f >= 0 };
        let (on_x, s) = match sense {
            Sense::CounterClockwise if x > 0 && y >= 0 => {
                if inward {
                    (true, -1)
                } else {
                    (false, 1)
                }
            }
            Sense::CounterClockwise if x <= 0 && y > 0 => {
                if inward {
                    (false, -1)
                } else {
                    (true, -1)
                }
            }
            Sense::CounterClockwise if x < 0 && y <= 0 => {
                if inward {
                    (true, 1)
                } else {
                    (false, -1)
                }
            }
            Sense::CounterClockwise if x >= 0 && y < 0 => {
                if inward {
                    (false, 1)
                } else {
                    (true, 1)
                }
            }
            Sense::Clockwise if x >= 0 && y > 0 => {
                if inward {
                    (false, -1)
                } else {
                    (true, 1)
                }
            }
            Sense::Clockwise if x > 0 && y <= 0 => {
                if inward {
                    (true, -1)
                } else {
                    (false, -1)
                }
            }
            Sense::Clockwise if x <= 0 && y < 0 => {
                if inward {
                    (false, 1)
                } else {
                    (true, -1)
                }
            }
            Sense::Clockwise if x < 0 && y >= 0 => {
                if inward {
                    (true, 1)
                } else {
                    (false, 1)
                }
            }
            _ => return Err(Fault::Centre),
        };
        let v = if on_x { &mut x } else { &mut y };
        f += 2 * s * *v + 1;
        *v += s;
        if on_x == (block.g == Axis::X) {
            left -= 1;
        }
    }
    Ok(Position::new(x - x0, y - y0))
}

/// The exact model by direct evaluation of circle and line in the table's own axes.
fn on_the_curve(block: &Block) -> Option<Position> {
    let Motion::Arc(sense, _) = block.motion else { return None };
    let start = block.signed();
    let (x0, y0) = (start.x.0 as f64, start.y.0 as f64);
    let radius = (x0 * x0 + y0 * y0).sqrt();
    let turn = match sense {
        Sense::CounterClockwise => 1.0,
        Sense::Clockwise => -1.0,
    };
    let at = |t: f64| {
        let a = libm::atan2(y0, x0) + turn * t;
        (radius * libm::cos(a), radius * libm::sin(a))
    };
    // Bisection on the travel along G, which grows with the angle.
    let travelled = |t: f64| {
        let phase = match block.g {
            Axis::X => libm::atan2(y0, x0),
            Axis::Y => libm::atan2(y0, x0) - std::f64::consts::FRAC_PI_2,
        };
        // ∫|sin| over the angle from `phase`, in the sense of the motion.
        let whole = |a: f64| {
            let k = (a / std::f64::consts::PI).floor();
            2.0 * k + 1.0 - libm::cos(a - k * std::f64::consts::PI)
        };
        radius * (whole(phase + turn * t) - whole(phase)).abs()
    };
    let (mut lo, mut hi) = (0.0, (block.j.0 as f64 / radius + 4.0) * 2.0);
    for _ in 0..200 {
        let mid = 0.5 * (lo + hi);
        if travelled(mid) < block.j.0 as f64 { lo = mid } else { hi = mid }
    }
    let (x, y) = at(lo);
    // Too near a half to tell by this route, or at a turning point where bisection cannot tell.
    let near_half = |v: f64| ((v - v.floor()) - 0.5).abs() < 1e-4;
    if near_half(x) || near_half(y) {
        return None;
    }
    Some(Position::new(x.round() as i64, y.round() as i64) - start)
}

/// A small generator of our own, so that a failure names its seed.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }
    fn below(&mut self, n: i64) -> i64 {
        (self.next() % n.max(1) as u64) as i64
    }
    fn log_uniform(&mut self, top: f64) -> i64 {
        let unit = (self.next() >> 11) as f64 / (1u64 << 53) as f64;
        libm::exp(unit * libm::log(top)) as i64
    }
}

fn random_block(dice: &mut Dice, largest: f64) -> Block {
    let radius = dice.log_uniform(largest);
    let (x, y) = match dice.below(8) {
        0 => (radius, 0),
        1 => (0, radius),
        _ => (dice.below(radius + 1), dice.below(radius + 1)),
    };
    let quadrant = Quadrant::from_digit(b"1234"[dice.below(4) as usize]).unwrap();
    let reach = if dice.below(4) == 0 { 12 * radius } else { 4 * radius };
    let j = if dice.below(16) == 0 { 4 * radius } else { dice.below(reach + 1) };
    let g = if dice.below(2) == 0 { Axis::X } else { Axis::Y };
    let motion = match dice.below(8) {
        0 => Motion::Line(quadrant),
        n if n % 2 == 0 => Motion::Arc(Sense::Clockwise, quadrant),
        _ => Motion::Arc(Sense::CounterClockwise, quadrant),
    };
    Block { x: Micrometres(x), y: Micrometres(y), j: Micrometres(j), g, motion }
}

#[test]
fn the_closed_form_agrees_with_stepping_on_a_million_random_blocks() {
    let mut dice = Dice(0x5eed_0001);
    let mut faults = 0u32;
    for n in 0..1_000_000 {
        let block = random_block(&mut dice, 3000.0);
        if block.j.0 > 0 && block.x.0 == 0 && block.y.0 == 0 && matches!(block.motion, Motion::Arc(..)) {
            continue;
        }
        let model = [Model::Rotated, Model::Mirrored, Model::Strict][n % 3];
        let stepped = step(model, &block);
        faults += u32::from(stepped.is_err());
        assert_eq!(model.displacement(&block), stepped, "block {n}: {block:?} under {model:?}");
    }
    assert!(faults > 100, "the campaign met only {faults} faults");
}

#[test]
fn the_closed_form_agrees_with_stepping_on_long_arcs() {
    let mut dice = Dice(0x5eed_0002);
    for n in 0..1000 {
        let block = random_block(&mut dice, 250_000.0);
        let model = [Model::Rotated, Model::Strict][n % 2];
        if matches!(block.motion, Motion::Arc(..)) && block.x.0 + block.y.0 > 0 {
            assert_eq!(model.displacement(&block), step(model, &block), "{block:?} under {model:?}");
        }
    }
}

#[test]
fn the_exact_model_lies_on_the_true_circle() {
    let mut dice = Dice(0x5eed_0003);
    let mut compared = 0;
    for _ in 0..20_000 {
        let block = random_block(&mut dice, 20_000.0);
        if block.j.0 == 0 || block.x.0 + block.y.0 < 3 {
            continue;
        }
        let Some(expected) = on_the_curve(&block) else { continue };
        let found = Model::Exact.displacement(&block).unwrap();
        assert_eq!(found, expected, "{block:?}");
        compared += 1;
    }
    assert!(compared > 10_000, "only {compared} arcs compared");
}

#[test]
fn the_pulses_of_a_block_end_where_the_closed_form_says_and_never_jump() {
    let mut dice = Dice(0x5eed_0004);
    let (mut stepped, mut faults) = (0u64, 0u32);
    for n in 0..100_000 {
        let block = random_block(&mut dice, 400.0);
        let model = Model::ALL[n % 4];
        let (pulses, end) = (model.pulses(&block), model.displacement(&block));
        let (Ok(pulses), Ok(end)) = (&pulses, &end) else {
            assert_eq!(pulses.as_ref().err(), end.as_ref().err(), "{block:?} under {model:?}");
            faults += 1;
            continue;
        };
        let mut at = Position::default();
        for pulse in pulses.clone() {
            let way = pulse - at;
            assert_eq!(way.x.0.abs() + way.y.0.abs(), 1, "{block:?} under {model:?}");
            at = pulse;
            stepped += 1;
        }
        assert_eq!(at, *end, "block {n}: {block:?} under {model:?}");
        // All at once they are the same ones.
        let mut again = pulses.clone();
        pulses.clone().for_each(|pulse| assert_eq!(again.next(), Some(pulse)));
        assert_eq!(again.next(), None);
    }
    assert!(stepped > 1_000_000 && faults > 100, "{stepped} pulses, {faults} faults");
}

#[test]
fn the_pulses_are_those_of_the_method_s_own_examples() {
    let steps = |block: Block| -> Vec<(i64, i64)> {
        let mut at = Position::default();
        let pulses = Model::Rotated.pulses(&block).unwrap();
        pulses
            .map(|pulse| {
                let way = pulse - at;
                at = pulse;
                (way.x.0, way.y.0)
            })
            .collect()
    };
    let (left, right, up, down) = ((-1, 0), (1, 0), (0, 1), (0, -1));
    let quarter = |x, y, sense, j| Block::arc(Position::new(x, y), sense, Axis::X, Micrometres(j));
    assert_eq!(steps(quarter(4, 0, Sense::CounterClockwise, 4)), [left, up, up, up, left, up, left, left]);
    let clockwise = steps(quarter(0, 6, Sense::Clockwise, 6));
    assert_eq!(clockwise[..8], [down, right, right, right, right, down, right, down]);
    assert_eq!(steps(Block::line(Position::new(2, 2))), [right, up, right, up]);
}

#[test]
fn the_pulses_of_each_model_stay_within_1_5_um_of_the_true_curve() {
    let mut dice = Dice(0x5eed_0005);
    for n in 0..4000 {
        let block = random_block(&mut dice, 3000.0);
        let model = Model::ALL[n % 4];
        let Motion::Arc(..) = block.motion else { continue };
        let Ok(pulses) = model.pulses(&block) else { continue };
        let start = block.signed();
        let radius = ((start.x.0 * start.x.0 + start.y.0 * start.y.0) as f64).sqrt();
        if radius < 5.0 {
            continue;
        }
        for pulse in pulses {
            let seen = pulse + start;
            let off = ((seen.x.0 * seen.x.0 + seen.y.0 * seen.y.0) as f64).sqrt() - radius;
            assert!(off.abs() < 1.5, "{off} µm: {block:?} under {model:?}");
        }
    }
}

fn walk_text(block: Block, model: Model) -> (i64, i64) {
    let end = model.displacement(&block).unwrap();
    (end.x.0, end.y.0)
}

#[test]
fn a_full_circle_with_the_wrong_axis_stops_140_um_short() {
    // Counting X from a point on the X axis ends where the circle is steepest in Y.
    let arc = |g| Block::arc(Position::new(9900, 0), Sense::CounterClockwise, g, Micrometres(39_600));
    assert_eq!(walk_text(arc(Axis::Y), Model::Rotated), (0, 0));
    let (x, y) = walk_text(arc(Axis::X), Model::Rotated);
    let short = ((x * x + y * y) as f64).sqrt();
    assert!((139.0..143.0).contains(&short), "{short}");
}

#[test]
fn the_mirrored_form_leaves_a_line_along_y_one_micron_off() {
    let line = Block::line(Position::new(0, 500));
    let mirrored_digit = Block { motion: Motion::Line(Quadrant::Second), ..line };
    assert_eq!(walk_text(mirrored_digit, Model::Rotated), (0, 500));
    assert_eq!(walk_text(mirrored_digit, Model::Mirrored), (-1, 500));
}

#[test]
fn a_block_that_can_never_end_is_a_fault() {
    let endless = Block {
        x: Micrometres(0),
        y: Micrometres(0),
        j: Micrometres(500),
        g: Axis::Y,
        motion: Motion::Line(Quadrant::First),
    };
    for model in Model::ALL {
        assert_eq!(model.displacement(&endless), Err(Fault::Endless), "{model:?}");
    }
    let centre = Block::arc(Position::new(1, 0), Sense::CounterClockwise, Axis::Y, Micrometres(3));
    assert_eq!(Model::Rotated.displacement(&centre), Err(Fault::Centre));
}

/// The quick question and the full answer agree: on every small block, and on large ones at random.
#[test]
fn a_block_comes_to_an_end_exactly_where_its_end_can_be_worked_out() {
    let agree = |block: &Block| {
        assert_eq!(comes_to_an_end(block), Model::Rotated.displacement(block).is_ok(), "{block:?}");
    };
    let quadrants = [Quadrant::First, Quadrant::Second, Quadrant::Third, Quadrant::Fourth];
    let motions: Vec<Motion> = quadrants
        .into_iter()
        .flat_map(|q| {
            let arcs = [Sense::Clockwise, Sense::CounterClockwise].map(|sense| Motion::Arc(sense, q));
            [Motion::Line(q), arcs[0], arcs[1]]
        })
        .collect();
    let blocks = |x: i64, y: i64, j: i64| {
        let [x, y, j] = [x, y, j].map(Micrometres);
        let both = [Axis::X, Axis::Y].into_iter();
        both.flat_map(|g| motions.iter().map(move |&motion| Block { x, y, j, g, motion })).collect::<Vec<_>>()
    };
    let mut refused = 0;
    for n in 0..6 * 6 * 12 {
        for block in blocks(n % 6, n / 6 % 6, n / 36) {
            agree(&block);
            refused += u32::from(!comes_to_an_end(&block));
        }
    }
    assert!(refused > 100, "blocks without an end are among them: {refused}");
    let mut state = 1u64;
    let mut random = |most: u64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as i64 % most as i64
    };
    for n in 0..20_000 {
        let most = [3, 100, 1_000_000, 1_000_000_000][n % 4];
        for block in blocks(random(most), random(most), random(1_000_000)) {
            agree(&block);
        }
    }
}
