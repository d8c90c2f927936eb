//! Contours that no one drew: stars with fillets, combs, dumbbells, keys; counter-clockwise, from a seed.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use dripfeed::geometry::{Element, Path, Point, Sense};

/// Numbers from a seed, the same everywhere.
pub(crate) struct Dice(u64);

impl Dice {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        low + (high - low) * ((self.0 >> 11) as f64 / (1u64 << 53) as f64)
    }

    pub(crate) fn up_to(&mut self, most: usize) -> usize {
        (self.between(0.0, most as f64) as usize).min(most - 1)
    }
}

/// A contour and what it is.
pub(crate) fn any(seed: u64) -> (&'static str, Path) {
    let mut dice = Dice::new(seed);
    match seed % 4 {
        0 => ("star", star(&mut dice)),
        1 => ("comb", comb(&mut dice)),
        2 => ("dumbbell", dumbbell(&mut dice)),
        _ => ("key", key(&mut dice)),
    }
}

/// A star: rays of any length, each corner sharp or filleted, inside ones too.
pub(crate) fn star(dice: &mut Dice) -> Path {
    let count = 5 + dice.up_to(12);
    let nodes: Vec<Point> = (0..count)
        .map(|n| {
            let angle = std::f64::consts::TAU * (n as f64 + dice.between(-0.3, 0.3)) / count as f64;
            let radius = dice.between(2.0, 10.0);
            Point::new(radius * libm::cos(angle), radius * libm::sin(angle))
        })
        .collect();
    let radii: Vec<f64> =
        (0..count).map(|_| if dice.up_to(3) == 0 { 0.0 } else { dice.between(0.02, 2.0) }).collect();
    filleted(&nodes, &radii)
}

/// A block with slots of any width from its top, corners sharp or filleted.
pub(crate) fn comb(dice: &mut Dice) -> Path {
    let mut nodes = vec![Point::new(0.0, 0.0)];
    let mut top = Vec::new();
    let mut x = 1.0;
    for _ in 0..2 + dice.up_to(6) {
        let (width, depth) = (dice.between(0.1, 2.0), dice.between(0.5, 7.0));
        top.extend([(x, 8.0), (x, 8.0 - depth), (x + width, 8.0 - depth), (x + width, 8.0)]);
        x += width + dice.between(0.15, 2.0);
    }
    nodes.push(Point::new(x, 0.0));
    nodes.push(Point::new(x, 8.0));
    nodes.extend(top.iter().rev().map(|&(x, y)| Point::new(x, y)));
    nodes.push(Point::new(0.0, 8.0));
    let radii: Vec<f64> =
        nodes.iter().map(|_| if dice.up_to(2) == 0 { 0.0 } else { dice.between(0.01, 0.8) }).collect();
    filleted(&nodes, &radii)
}

/// Two blocks joined by a neck, all turned by any angle.
pub(crate) fn dumbbell(dice: &mut Dice) -> Path {
    let half = dice.between(0.05, 1.5);
    let (a, b) = (dice.between(2.0, 5.0), dice.between(2.0, 5.0));
    let neck = dice.between(1.0, 6.0);
    let angle = dice.between(0.0, 6.0);
    let corners = [
        (-a, -a),
        (0.0, -a),
        (0.0, -half),
        (neck, -half),
        (neck, -b),
        (neck + b, -b),
        (neck + b, b),
        (neck, b),
        (neck, half),
        (0.0, half),
        (0.0, a),
        (-a, a),
    ];
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    let nodes: Vec<Point> =
        corners.iter().map(|&(x, y)| Point::new(x * cos - y * sin, x * sin + y * cos)).collect();
    let radii: Vec<f64> =
        nodes.iter().map(|_| if dice.up_to(2) == 0 { 0.0 } else { dice.between(0.02, 1.0) }).collect();
    filleted(&nodes, &radii)
}

/// A round head, a shank and a bit: a great arc of more than half a circle, and a keyhole slot.
pub(crate) fn key(dice: &mut Dice) -> Path {
    let (head, half) = (dice.between(2.0, 5.0), dice.between(0.3, 1.2));
    let length = dice.between(4.0, 12.0);
    let slot = dice.between(0.05, 0.9) * half;
    let from = (head * head - half * half).sqrt();
    let p = Point::new;
    let line = |start, end| Element::Line { start, end };
    let centre = p(0.0, 0.0);
    let end = from + length;
    // The slot comes in from the end of the shank and has a round bottom, clockwise as seen along the contour.
    let bottom = end - dice.between(0.3, 0.9) * length;
    let elements = vec![
        line(p(from, -half), p(end, -half)),
        line(p(end, -half), p(end, -slot)),
        line(p(end, -slot), p(bottom, -slot)),
        Element::Arc {
            start: p(bottom, -slot),
            end: p(bottom, slot),
            centre: p(bottom, 0.0),
            sense: Sense::Clockwise,
        },
        line(p(bottom, slot), p(end, slot)),
        line(p(end, slot), p(end, half)),
        line(p(end, half), p(from, half)),
        Element::Arc { start: p(from, half), end: p(from, -half), centre, sense: Sense::CounterClockwise },
    ];
    Path::new(elements).unwrap()
}

/// Where a corner's arc begins and ends, and about what it turns, if it has one.
type Rounded = (Point, Point, Option<(Point, Sense)>);

/// A polygon whose corners are rounded with arcs, each as far as the sides have room.
pub(crate) fn filleted(nodes: &[Point], radii: &[f64]) -> Path {
    let count = nodes.len();
    // For each corner: where the arc begins and ends, and about what.
    let corners: Vec<Rounded> = (0..count)
        .map(|n| {
            let (before, here, after) = (nodes[(n + count - 1) % count], nodes[n], nodes[(n + 1) % count]);
            let (back, ahead) = (before - here, after - here);
            let room = 0.45 * back.norm().min(ahead.norm());
            let (back, ahead) = (back / back.norm(), ahead / ahead.norm());
            // The tangent of half the angle between the sides.
            let half = ((1.0 - back.dot(&ahead)) / (1.0 + back.dot(&ahead))).sqrt();
            let radius = radii[n].min(room * half);
            if radius < 0.01 {
                return (here, here, None);
            }
            let reach = radius / half;
            let turn = ahead.x * back.y - ahead.y * back.x;
            let middle = (back + ahead) / (back + ahead).norm();
            let centre = here + middle * (radius * radius + reach * reach).sqrt();
            let sense = if turn > 0.0 { Sense::CounterClockwise } else { Sense::Clockwise };
            (here + back * reach, here + ahead * reach, Some((centre, sense)))
        })
        .collect();
    let mut elements = Vec::new();
    for n in 0..count {
        let (start, end, arc) = corners[n];
        if let Some((centre, sense)) = arc {
            elements.push(Element::Arc { start, end, centre, sense });
        }
        elements.push(Element::Line { start: end, end: corners[(n + 1) % count].0 });
    }
    Path::new(elements).unwrap()
}
