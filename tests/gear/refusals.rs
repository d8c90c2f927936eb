//! Teeth that cannot be, wires that do not fit, lead-ins that cut the part: refused or told, by name, with the bound.
//!
//! Each bound is found here by halving on the formulas of `gear/theory.rs`; the program must refuse on one side of
//! it, cut on the other, and say its number.

use crate::binary::{Run, dripfeed};
use crate::outlines::generate;
use crate::part::{LeadIn, PAPERS_PART, Part};
use crate::theory::{Gear, PAPER, Point, Root};

fn run(gear: Gear) -> Run {
    let arguments = Part { gear, ..PAPERS_PART }.arguments();
    dripfeed(&arguments.iter().map(String::as_str).collect::<Vec<_>>())
}

/// Refused as a fault of the part, nothing printed, a name said.
fn assert_refused(gear: Gear, name: &str) -> String {
    let run = run(gear);
    assert_eq!(run.code, Some(3), "{gear:?}\n{}", run.stderr);
    assert_eq!(run.stdout, "", "{gear:?}");
    let first = run.stderr.lines().next().unwrap_or_default();
    assert!(first.starts_with("error: ") && names(first, name), "no {name:?} in {first:?}");
    run.stderr
}

fn assert_cut(gear: Gear) {
    let run = run(gear);
    assert_eq!(run.code, Some(0), "{gear:?}\n{}", run.stderr);
}

/// Whether a text has a word of its own.
fn names(text: &str, name: &str) -> bool {
    text.split(|c: char| !(c.is_alphanumeric() || c == '-' || c == '_')).any(|word| word == name)
}

/// Whether a text has a number within a thousandth of one, or within what four decimals can say.
fn says_number(text: &str, wanted: f64) -> bool {
    let numbers = text.split(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-'));
    let numbers = numbers.filter_map(|word| word.trim_end_matches('.').parse::<f64>().ok());
    let close = (wanted.abs() * 1e-3).max(1e-4);
    numbers.into_iter().any(|number| (number - wanted).abs() <= close)
}

/// Where a condition of the formulas changes sign between two values of a parameter.
fn bound(mut positive: f64, mut negative: f64, condition: impl Fn(f64) -> f64) -> f64 {
    assert!(condition(positive) > 0.0 && condition(negative) <= 0.0);
    for _ in 0..100 {
        let middle = f64::midpoint(positive, negative);
        *(if condition(middle) > 0.0 { &mut positive } else { &mut negative }) = middle;
    }
    positive
}

fn margin_um(gear: Gear) -> f64 {
    gear.derived().margin_um(gear.root)
}

#[test]
fn a_tooth_too_thick_for_its_space_is_refused_naming_ks_and_its_bound() {
    let gear = |ks| Gear { ks, offset: 0.0, ..PAPER };
    let largest = bound(1.57, 4.0, |ks| gear(ks).derived().phi);
    assert!(gear(largest + 0.05).derived().beta > 0.0, "only φ is at fault");
    let stderr = assert_refused(gear(largest + 0.01), "ks");
    assert!(says_number(&stderr, largest), "{largest} is not in {stderr}");
    assert_refused(gear(largest + 0.5), "ks");
    assert_cut(gear(largest - 0.2));
}

#[test]
fn flank_centres_on_the_wrong_side_of_the_tooth_are_refused_naming_ks_and_its_bound() {
    let gear = |ks| Gear { ks, kp: 0.8, tip_radius: 0.002, offset: 0.0, knf: 1.9, ..PAPER };
    let largest = bound(1.2, 1.7, |ks| gear(ks).derived().beta);
    assert!(gear(largest + 0.05).derived().phi > 0.0, "only β is at fault");
    let stderr = assert_refused(gear(largest + 0.05), "ks");
    assert!(says_number(&stderr, largest), "{largest} is not in {stderr}");
    assert_cut(gear(largest - 0.2));
}

#[test]
fn a_tip_rounding_as_large_as_the_flank_radius_is_refused_naming_it() {
    for tip_radius in [0.8, 0.81, 5.0] {
        let stderr = assert_refused(Gear { tip_radius, ..PAPER }, "tip-radius");
        assert!(says_number(&stderr, 0.8), "{stderr}");
    }
}

#[test]
fn a_tip_rounding_that_does_not_fit_between_the_flanks_is_refused_naming_it_and_its_bound() {
    let gear = |tip_radius| Gear { tip_radius, ..PAPER };
    let room = |tip_radius| {
        let derived = gear(tip_radius).derived();
        derived.flank_arc_radius - derived.tip_radius - derived.across_um()
    };
    let largest = bound(0.04, 0.79, room);
    let stderr = assert_refused(gear(largest + 0.001), "tip-radius");
    assert!(says_number(&stderr, largest), "{largest} is not in {stderr}");
    assert_cut(gear(largest - 0.005));
}

#[test]
fn a_flank_radius_beyond_the_circle_of_its_centres_is_refused_naming_kp() {
    let largest = 18.0 - 0.15; // r_c / m
    let stderr = assert_refused(Gear { kp: largest + 0.1, ..PAPER }, "kp");
    assert!(says_number(&stderr, (18.0 - 0.15) * 0.4), "r_c is not in {stderr}");
    assert_refused(Gear { kp: 40.0, ..PAPER }, "kp");
}

#[test]
fn a_vanishing_flank_is_refused_naming_knf_and_its_bound() {
    let gear = |knf| Gear { knf, offset: 0.0, ..PAPER };
    let least = bound(1.57, 0.5, |knf| gear(knf).derived().flank_um());
    let stderr = assert_refused(gear(least - 0.01), "knf");
    assert!(says_number(&stderr, least), "{least} is not in {stderr}");
    assert_cut(gear(least + 0.05));
}

#[test]
fn a_root_inside_the_centre_is_refused_naming_knf_and_its_bound() {
    let stderr = assert_refused(Gear { knf: 18.5, ..PAPER }, "knf");
    assert!(says_number(&stderr, 18.0), "{stderr}");
}

#[test]
fn flanks_that_never_reach_the_pitch_circle_are_refused_naming_kp_and_kr() {
    let stderr = assert_refused(Gear { kp: 0.1, tip_radius: 0.01, ..PAPER }, "kp");
    assert!(names(&stderr, "kr"), "{stderr}");
    assert_refused(Gear { kr: 2.5, ..PAPER }, "kr");
}

#[test]
fn zero_negative_and_numbers_that_are_none_are_refused_by_name() {
    for name in ["module", "kp", "kr", "ks", "knf", "tip-radius", "teeth", "offset"] {
        let mut wrong = vec!["nan", "NaN", "inf", "-inf", "twelve", "", "0x10", "1,5"];
        if !matches!(name, "kr" | "tip-radius" | "offset") {
            wrong.push("0");
        }
        if name != "offset" {
            wrong.extend(["-1", "-0.01"]);
        }
        if name == "teeth" {
            wrong.extend(["12.5", "36.0", "1", "2", "1e2", "99999999999999999999"]);
        }
        for value in wrong {
            let run = dripfeed(&["generate", "gear", &format!("--{name}={value}")]);
            assert!(matches!(run.code, Some(2 | 3)), "--{name}={value}: {:?} {}", run.code, run.stderr);
            assert_eq!(run.stdout, "", "--{name}={value}");
            let named = names(&run.stderr, name) || names(&run.stderr, &format!("--{name}"));
            assert!(named, "--{name}={value}: {}", run.stderr);
        }
    }
}

/// As a newcomer types it, with a blank instead of an equals sign.
#[test]
fn a_negative_number_after_a_blank_is_refused_by_name_too() {
    for name in ["module", "teeth", "kp", "kr", "ks", "knf", "tip-radius"] {
        let run = dripfeed(&["generate", "gear", &format!("--{name}"), "-1"]);
        assert!(matches!(run.code, Some(2 | 3)), "--{name} -1: {:?}", run.code);
        let named = names(&run.stderr, name) || names(&run.stderr, &format!("--{name}"));
        assert!(named, "--{name} -1: {}", run.stderr);
    }
}

#[test]
fn a_wire_too_thick_for_the_tooth_space_is_refused_naming_the_largest_that_fits() {
    let largest = PAPER.derived().root_arc_radius / 1000.0;
    for offset in [largest + 0.001, 0.5, 3.0] {
        let stderr = assert_refused(Gear { offset, ..PAPER }, "offset");
        assert!(says_number(&stderr, largest), "{largest} is not in {stderr}");
    }
    assert_cut(Gear { offset: largest - 0.005, ..PAPER });
}

#[test]
fn a_wire_too_thick_for_the_tooth_space_is_cut_when_trimming_is_asked_for() {
    let largest = PAPER.derived().root_arc_radius / 1000.0;
    assert_cut(Gear { offset: largest + 0.004, root: Root::Trimmed, ..PAPER });
    assert_refused(Gear { offset: 0.5, root: Root::Trimmed, ..PAPER }, "offset");
}

#[test]
fn of_a_tip_sharper_than_the_wire_the_corner_radius_left_is_told() {
    for offset in [-0.07, -0.05, -0.1] {
        let run = run(Gear { offset, ..PAPER });
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let warning = run.stderr.lines().find(|line| line.starts_with("warning: ") && line.contains("tip"));
        let warning = warning.unwrap_or_else(|| panic!("{offset}: no warning in {}", run.stderr));
        assert!(says_number(warning, -offset) && warning.contains("radius"), "{warning}");
    }
    let blunt = run(Gear { offset: -0.03, ..PAPER });
    assert!(!blunt.stderr.contains("tip"), "{}", blunt.stderr);
}

#[test]
fn a_die_whose_tip_flank_has_no_room_for_the_wire_is_refused_naming_the_offset() {
    assert_refused(Gear { offset: -0.4, ..PAPER }, "offset");
    assert_refused(Gear { offset: -2.0, ..PAPER }, "offset");
    assert_refused(Gear { offset: -20.0, ..PAPER }, "offset");
}

/// In a die the wire runs inside the tooth. Where the tooth is narrower than the wire's path needs, the two offset
/// flanks cross, and the wire on the left would cut into the kept wall on the right.
#[test]
fn a_die_whose_tooth_is_too_narrow_for_the_wire_is_refused_naming_the_offset() {
    let gear = |offset| Gear { offset, ..PAPER };
    let thickest = bound(-0.2, -0.316, |offset| margin_um(gear(offset)));
    assert_cut(gear(thickest + 0.005));
    assert_refused(gear(thickest - 0.001), "offset");
    assert_refused(gear(-0.316), "offset");
}

/// The outline as a polygon fine enough to tell inside from outside to a µm or two.
fn is_inside(polygon: &[Point], point: Point) -> bool {
    let mut inside = false;
    for (a, b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        if (a.y > point.y) != (b.y > point.y) {
            let x = a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x);
            inside ^= x > point.x;
        }
    }
    inside
}

/// Whether the lead-in runs through what is kept: the inside of the cut of a punch, the outside of that of a die. Its
/// last 20 µm, where it meets the outline, are left out.
fn slits_the_part(part: &Part) -> bool {
    let path = part.path();
    if path.lead_in == 0 {
        return false;
    }
    let outline = part.gear.outline();
    let polygon: Vec<Point> = outline.iter().flat_map(|element| element.sampled(16)).collect();
    let lead_in = path.elements[0];
    let is_punch = part.gear.offset > 0.0;
    let places = lead_in.sampled(2000);
    let before_the_outline = places.iter().filter(|place| place.distance(lead_in.end) > 20.0);
    before_the_outline.into_iter().any(|place| is_inside(&polygon, *place) == is_punch)
}

#[test]
fn a_lead_in_through_the_part_that_is_kept_is_warned_of_by_name_and_no_other_is() {
    let mut warned = 0;
    for offset in [0.07, -0.03] {
        for lead_in in [
            LeadIn::Centre,
            LeadIn::None,
            LeadIn::From([0, 12_000]),
            LeadIn::From([12_000, 0]),
            LeadIn::From([-12_000, 0]),
            LeadIn::From([-579, 20_000]),
            LeadIn::From([-1000, 3000]),
            LeadIn::From([0, -6000]),
            LeadIn::From([300, 7750]),
            LeadIn::From([-660, 7700]),
            LeadIn::From([-2500, 9000]),
        ] {
            let part = Part { gear: Gear { offset, ..PAPER }, lead_in, repeat: 1 };
            let (_, run) = generate(&part, &[]);
            let warnings = run.stderr.lines().filter(|line| line.starts_with("warning: the lead-in")).count();
            assert_eq!(warnings, usize::from(slits_the_part(&part)), "{part:?}\n{}", run.stderr);
            warned += warnings;
        }
    }
    assert!((5..17).contains(&warned), "{warned} of 22 lead-ins: the list has lost one of its sides");
}

/// A punch's outline lies round its root circle: from the centre there is no other way than through the part.
#[test]
fn a_punch_entered_from_its_centre_is_warned_of_whatever_its_number_of_teeth() {
    let mut silent = Vec::new();
    for teeth in 6..=66 {
        let run = run(Gear { teeth, offset: 0.03, ..PAPER });
        assert_eq!(run.code, Some(0), "{teeth}: {}", run.stderr);
        if !run.stderr.contains("warning: the lead-in") {
            silent.push(teeth);
        }
    }
    assert!(silent.is_empty(), "slit without a warning with these numbers of teeth: {silent:?}");
}

/// Drawn at random; each runs 26 µm to 1.5 mm deep through the kept part.
const SLANTING: &str = "\
    --module 1.1 --teeth 180 --kp 2.2263 --kr 0.1645 --ks 1.3571 --knf 1.5584 --tip-radius 0.1009 \
      --offset 0.9489 --direction ccw --lead-in 13.574,225.610
    --module 0.3342 --teeth 73 --kp 1.3426 --kr 0.4746 --ks 1.4423 --knf 1.3941 --tip-radius 0.1424 \
      --offset 0.0598 --direction ccw --lead-in -3.014,18.047
    --module 1.3054 --teeth 47 --kp 2.6908 --kr 0.4876 --ks 1.6154 --knf 1.8782 --tip-radius 0.5545 \
      --offset -0.5598 --direction cw --lead-in -16.642,-25.769
    --module 2.7826 --teeth 38 --kp 2.5234 --kr 0.4534 --ks 1.5064 --knf 1.6002 --tip-radius 1.1285 \
      --offset 1.8925 --direction ccw --lead-in 29.727,84.819
    --module 0.3535 --teeth 69 --kp 2.9157 --kr 0.4654 --ks 1.435 --knf 1.4146 --tip-radius 0.1526 \
      --offset 0.1933 --direction ccw --lead-in -42.865,99.099
    --module 0.6524 --teeth 14 --kp 1.8627 --kr 0.302 --ks 1.7912 --knf 1.5549 --tip-radius 0.2686 \
      --offset -0.2593 --direction cw --lead-in 0.003,4.566
    --module 0.0809 --teeth 161 --kp 1.6839 --kr 0.2772 --ks 1.2822 --knf 1.5261 --tip-radius 0.0366 \
      --offset 0.0613 --direction cw --lead-in -2.079,10.210";

#[test]
fn a_slanting_lead_in_through_the_part_is_warned_of() {
    let mut silent = Vec::new();
    for words in SLANTING.lines() {
        let mut arguments = vec!["generate", "gear"];
        arguments.extend(words.split_whitespace());
        let run = dripfeed(&arguments);
        assert_eq!(run.code, Some(0), "{words}\n{}", run.stderr);
        if !run.stderr.contains("warning: the lead-in") {
            silent.push(words);
        }
    }
    assert_eq!(SLANTING.lines().count(), 7);
    assert!(silent.is_empty(), "{silent:#?}");
}
