//! The mock control, fed with a text; what it cut, pulse by pulse; and whether two cuts are the same.
//!
//! Two cuts are the same to so many µm when the wire ends within that distance, the extents agree within it, the area
//! that the path encloses agrees within it along the whole path (sense included), and no place of either cut is farther
//! than that from the other cut. That does not depend on how a path is divided into blocks.

use std::collections::HashSet;
use std::time::Duration;

use mock_controller::{BlockEnd, Controller, Dialect, Model, Observer, Report, Settings};

pub(crate) const MODELS: [Model; 4] = [Model::Rotated, Model::Mirrored, Model::Strict, Model::Exact];

/// A place of the wire, µm.
pub(crate) type Place = [i64; 2];

/// What a control cut.
#[derive(Debug)]
pub(crate) struct Cut {
    pub(crate) report: Report,
    /// Where the wire was after each pulse, from where it stood at first.
    pub(crate) pulses: Vec<Place>,
    /// Where each block ended.
    pub(crate) ends: Vec<Place>,
}

#[derive(Debug, Default)]
struct Watch {
    pulses: Vec<Place>,
    ends: Vec<Place>,
}

impl Observer for Watch {
    fn pulse(&mut self, _at: Duration, _block: u64, x_um: i64, y_um: i64) {
        self.pulses.push([x_um, y_um]);
    }

    fn block_end(&mut self, end: &BlockEnd) {
        self.ends.push(end.end_um);
    }
}

/// A control of a model that reads 3B.
pub(crate) fn three_b(model: Model) -> Settings {
    Settings { interpolator: model, ..Settings::unpaced() }
}

/// A control that reads 4B with this offset keyed in, µm.
pub(crate) fn four_b(offset_um: f64) -> Settings {
    Settings { dialect: Dialect::FourB, wire_offset_um: offset_um, ..Settings::unpaced() }
}

/// A control that reads G-code; every register but D0 holds this offset, µm.
pub(crate) fn gcode(offset_um: f64) -> Settings {
    Settings { dialect: Dialect::Gcode, wire_offset_um: offset_um, ..Settings::unpaced() }
}

/// The cut of a 3B program by a control of the first model.
pub(crate) fn cut_3b(program: &str) -> Cut {
    cut(three_b(Model::Rotated), program)
}

/// Feeds a program to a control, which must cut it without an alarm.
pub(crate) fn cut(settings: Settings, program: &str) -> Cut {
    let cut = feed(settings, program);
    assert_eq!(cut.report.alarm, None, "{:?}\n{program}", cut.report.alarm_detail);
    assert!(cut.report.programs >= 1, "no end of the program was reached\n{program}");
    cut
}

/// Feeds a program to a control on a line where characters take no time.
pub(crate) fn feed(settings: Settings, program: &str) -> Cut {
    let mut watch = Watch::default();
    let mut control = Controller::observed(settings, &mut watch).unwrap();
    let (hour, mut now) = (Duration::from_secs(3600), Duration::ZERO);
    control.link_opened(now);
    let text = format!("%\n{program}\n%\n");
    let (text, mut sent, mut may_send) = (text.as_bytes(), 0, false);
    loop {
        for byte in control.receive(now) {
            match byte & 0x7F {
                0x11 => may_send = true,
                0x13 | 0x15 | 0x16 => may_send = false,
                other => panic!("the control said {other:#04x}"),
            }
        }
        while may_send && sent < text.len() && control.queued() < 4096 {
            sent += control.send(&text[sent..=sent], now);
        }
        match control.next_wakeup() {
            Some(next) if next <= hour => now = now.max(next),
            _ => break,
        }
    }
    let report = control.report();
    drop(control);
    Cut { report, pulses: watch.pulses, ends: watch.ends }
}

impl Cut {
    pub(crate) fn end(&self) -> Place {
        self.report.end_um
    }

    /// Left, right, bottom, top of all places, the first included.
    pub(crate) fn extents(&self) -> [i64; 4] {
        self.extents_where(|_| true)
    }

    /// Left, right, bottom, top of the places that are looked at.
    pub(crate) fn extents_where(&self, is_looked_at: impl Fn(Place) -> bool) -> [i64; 4] {
        let mut found: Option<[i64; 4]> = None;
        for [x, y] in self.pulses.iter().copied().filter(|place| is_looked_at(*place)) {
            let [left, right, bottom, top] = found.unwrap_or([x, x, y, y]);
            found = Some([left.min(x), right.max(x), bottom.min(y), top.max(y)]);
        }
        found.unwrap_or_default()
    }

    /// The area that the path from the start encloses, mm², positive counter-clockwise.
    pub(crate) fn area(&self) -> f64 {
        let mut twice = 0_i128;
        let mut last = [0, 0];
        for place in self.pulses.iter().copied().chain([[0, 0]]) {
            twice += i128::from(last[0]) * i128::from(place[1]) - i128::from(place[0]) * i128::from(last[1]);
            last = place;
        }
        twice as f64 / 2e6
    }

    /// The farthest that any place of this cut is from the other, as far as `most` µm tell.
    fn stray(&self, other: &HashSet<Place>, most: i64) -> Result<i64, Place> {
        let mut farthest = 0;
        'places: for &[x, y] in &self.pulses {
            for ring in 0..=most {
                let is_near = (-ring..=ring).any(|a| {
                    [[x + a, y - ring], [x + a, y + ring], [x - ring, y + a], [x + ring, y + a]]
                        .iter()
                        .any(|place| other.contains(place))
                });
                if is_near {
                    farthest = farthest.max(ring);
                    continue 'places;
                }
            }
            return Err([x, y]);
        }
        Ok(farthest)
    }
}

/// Two cuts are the same to so many µm.
pub(crate) fn assert_same_cut(one: &Cut, other: &Cut, um: i64, what: &str) {
    let off = |a: i64, b: i64| (a - b).abs();
    let apart = [0, 1].map(|axis| off(one.end()[axis], other.end()[axis]));
    assert!(apart.iter().all(|&apart| apart <= um), "{what}: ends {:?} {:?}", one.end(), other.end());
    let (a, b) = (one.extents(), other.extents());
    assert!(a.iter().zip(b).all(|(&a, b)| off(a, b) <= um), "{what}: extents {a:?} {b:?}");
    assert_lies_on(one, other, um, what);
    assert_lies_on(other, one, um, what);
    let slack = um as f64 / 1000.0 * one.report.path_length_mm + 1e-4;
    let (a, b) = (one.area(), other.area());
    assert!((a - b).abs() <= slack, "{what}: areas {a} {b}, within {slack}");
}

/// No place of a cut is farther than so many µm, counted along the axes, from another.
pub(crate) fn assert_lies_on(one: &Cut, other: &Cut, um: i64, what: &str) {
    let places: HashSet<Place> = other.pulses.iter().copied().chain([[0, 0]]).collect();
    if let Err([x, y]) = one.stray(&places, um) {
        panic!("{what}: only one of the two cuts at {x}, {y} µm, over {um} µm from the other");
    }
}

#[test]
fn cuts_that_differ_are_told_apart() {
    let square = "B5000B0B5000GXL1\nB0B5000B5000GYL2\nB5000B0B5000GXL3\nB0B5000B5000GYL4\nDD\n";
    let lain = |program: &str| {
        let (one, other) = (cut_3b(square), cut_3b(program));
        std::panic::catch_unwind(|| assert_same_cut(&one, &other, 2, "")).is_ok()
    };
    assert!(lain(square));
    // A dent of 3 µm, a corner cut off, the other sense, an end 3 µm off.
    assert!(!lain(&square.replacen("B0B5000B5000GYL2", "B3B0B3GXL1\nB0B5000B5000GYL2\nB3B0B3GXL3", 1)));
    assert!(!lain(&square.replacen("B0B5000B5000GYL2\nB5000B0B5000GXL3", "B5000B5000B5000GXL2", 1)));
    let backwards = "B0B5000B5000GYL2\nB5000B0B5000GXL1\nB0B5000B5000GYL4\nB5000B0B5000GXL3\nDD\n";
    assert!(!lain(backwards));
    assert!(!lain(&square.replacen("B0B5000B5000GYL4", "B0B4997B4997GYL4", 1)));
}
