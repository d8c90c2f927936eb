//! Plans on shapes one can reckon by hand.

use super::*;
use crate::formats::three_b::write::{Form, Writer as ThreeB};
use crate::formats::{Writer, gcode};
use crate::geometry::{Element, Path};
use crate::motion::Travel;

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

/// A rectangle, counter-clockwise from its lower left corner.
fn rectangle(low: Point, high: Point) -> Path {
    let nodes = [low, p(high.x, low.y), high, p(low.x, high.y)];
    let line = |n: usize| Element::Line { start: nodes[n], end: nodes[(n + 1) % 4] };
    Path::new((0..4).map(line).collect()).unwrap()
}

fn contour(path: Path, kept: Kept, holes: Holes) -> Contour {
    Contour { path, kept, entry: Entry::Beginning, holes, spot: Spot { byte: 90, line: 7, column: 1 } }
}

/// The block of 20 by 12 mm as a punch.
fn punch() -> Contour {
    contour(rectangle(p(0.0, 0.0), p(20.0, 12.0)), Kept::Inside, Holes::AtLeadIn)
}

/// The same as an opening, with a hole in its middle.
fn die() -> Contour {
    let holes = Holes::Given(vec![p(10.0, 6.0)]);
    contour(rectangle(p(0.0, 0.0), p(20.0, 12.0)), Kept::Outside, holes)
}

fn pass(offset: f64, word: &str) -> Pass {
    Pass { distance: Distance::Offset(offset), words: vec![word.as_bytes().into()] }
}

fn plan() -> Plan {
    Plan {
        rough: pass(0.1, "C1"),
        skims: Vec::new(),
        corners: Corners::Round,
        lead_in: Lead::Straight { length: 2.0 },
        lead_out: Some(Lead::Straight { length: 2.0 }),
        overcut: 0.0,
        tabs: Tabs::None,
        cut_tabs: CutTabs::Last,
        stops: Stops::BeforeLast(Stop::Pause),
        rethread: Rethread {
            cut: vec![Act::Word(b"M50"[..].into())],
            thread: vec![Act::Word(b"M60"[..].into())],
        },
        from: p(0.0, 0.0),
    }
}

fn motions(contours: &[Contour], plan: &Plan) -> Vec<Motion> {
    Cutting::new(contours.to_vec(), plan.clone()).unwrap().map(Result::unwrap).collect()
}

fn refusal(contours: &[Contour], plan: &Plan) -> Refusal {
    Cutting::new(contours.to_vec(), plan.clone()).unwrap_err()
}

/// Motions as a person reads them: R and L for ways, words and stops as they are.
fn told(motions: &[Motion]) -> Vec<String> {
    let at = |point: Point| format!("{:.3},{:.3}", point.x, point.y);
    motions
        .iter()
        .map(|motion| match &motion.act {
            Act::Move { travel: Travel::Rapid, element, .. } => format!("R {}", at(element.end())),
            Act::Move { element: Element::Line { end, .. }, .. } => format!("L {}", at(*end)),
            Act::Move { element: Element::Arc { end, .. }, .. } => format!("A {}", at(*end)),
            Act::Word(word) => String::from_utf8_lossy(word).into_owned(),
            other => format!("{other:?}"),
        })
        .collect()
}

#[test]
fn a_punch_without_tabs_is_led_in_cut_round_and_led_out_the_same_way() {
    let expected = [
        "R 0.000,-2.100",
        "C1",
        "L 0.000,-0.100",
        "L 20.000,-0.100",
        "A 20.100,0.000",
        "L 20.100,12.000",
        "A 20.000,12.100",
        "L 0.000,12.100",
        "A -0.100,12.000",
        "L -0.100,0.000",
        "A 0.000,-0.100",
        "L 0.000,-2.100",
        "Stop(End)",
    ];
    let all = motions(&[punch()], &plan());
    assert_eq!(told(&all), expected);
    // Only moves and the end are blocks; all say where the contour stands.
    let blocks: Vec<u64> = all.iter().map(|motion| motion.block).collect();
    assert_eq!(blocks, [1, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]);
    assert!(all[..12].iter().all(|motion| motion.spot.line == 7));
}

#[test]
fn a_die_begun_in_a_corner_is_led_in_along_the_half_of_its_angle() {
    let contour = Contour { holes: Holes::AtLeadIn, ..die() };
    let plan = Plan { lead_in: Lead::Straight { length: 8.0_f64.sqrt() }, lead_out: None, ..plan() };
    let all = told(&motions(&[contour], &plan));
    assert_eq!(&all[..3], ["R 2.100,2.100", "C1", "L 0.100,0.100"]);
    assert_eq!(
        &all[3..],
        ["L 19.900,0.100", "L 19.900,11.900", "L 0.100,11.900", "L 0.100,0.100", "Stop(End)"]
    );
}

#[test]
fn the_overcut_goes_on_past_the_closing_point_and_the_summary_says_so() {
    let plan = Plan { overcut: 0.25, lead_out: None, ..plan() };
    let all = told(&motions(&[punch()], &plan));
    assert_eq!(&all[all.len() - 3..], ["A 0.000,-0.100", "L 0.250,-0.100", "Stop(End)"]);
    let cutting = Cutting::new(vec![punch()], plan).unwrap();
    assert!(cutting.summary().to_string().contains("overcut 0.250 mm"), "{}", cutting.summary());
    let none = Cutting::new(vec![punch()], self::plan()).unwrap();
    assert!(none.summary().to_string().contains("overcut 0.000 mm"));
}

#[test]
fn two_tabs_of_a_die_are_cut_last_from_the_one_hole_with_a_stop_before_the_last() {
    let plan =
        Plan { tabs: Tabs::Even { count: 2, length: 2.0 }, lead_in: Lead::Direct, lead_out: None, ..plan() };
    let expected = [
        "R 10.000,6.000",
        "C1",
        "L 0.100,0.100",
        "L 19.900,0.100",
        "L 19.900,10.000",
        // The second stretch begins behind the first tab, in the upper right corner.
        "M50",
        "R 10.000,6.000",
        "M60",
        "C1",
        "L 19.900,11.900",
        "L 0.100,11.900",
        "L 0.100,2.000",
        // The wire stands at the second tab.
        "L 0.100,0.100",
        "M50",
        "R 10.000,6.000",
        "M60",
        "Stop(Pause)",
        "C1",
        "L 19.900,11.900",
        "L 19.900,10.000",
        "Stop(End)",
    ];
    assert_eq!(told(&motions(&[die()], &plan)), expected);
    let each = Plan { stops: Stops::BeforeEach(Stop::Optional), ..plan.clone() };
    let all = told(&motions(&[die()], &each));
    assert_eq!(all.iter().filter(|said| *said == "Stop(Optional)").count(), 2);
    let summary = Cutting::new(vec![die()], plan).unwrap().summary().contours[0].clone();
    assert_eq!((summary.stops, summary.threadings, summary.holes.len()), (1, 3, 2));
    assert!((summary.tabs[0].from - p(20.0, 10.0)).norm() < 1e-9);
    // 1.9 mm on the path, less the kerf on both sides.
    assert!((summary.tabs[0].bridge - 1.7).abs() < 1e-9);
}

#[test]
fn a_skim_runs_back_from_where_the_rough_pass_ended_and_the_tab_last() {
    let plan = Plan {
        skims: vec![Skim { pass: pass(0.08, "C2"), way: Way::Back }],
        tabs: Tabs::Even { count: 1, length: 2.0 },
        lead_in: Lead::Direct,
        lead_out: Some(Lead::Direct),
        ..plan()
    };
    let expected = [
        "R 10.000,6.000",
        "C1",
        "L 0.100,0.100",
        "L 19.900,0.100",
        "L 19.900,11.900",
        "L 0.100,11.900",
        "L 0.100,2.000",
        "C2",
        "L 0.080,2.000",
        "L 0.080,11.920",
        "L 19.920,11.920",
        "L 19.920,0.080",
        "L 0.080,0.080",
        "Stop(Pause)",
        "C1",
        "L 0.100,0.100",
        "L 0.100,2.000",
        "C2",
        "L 0.080,2.000",
        "L 0.080,0.080",
        "L 10.000,6.000",
        "Stop(End)",
    ];
    assert_eq!(told(&motions(&[die()], &plan)), expected);
}

#[test]
fn a_die_may_be_skimmed_all_round_once_its_waste_is_out() {
    let plan = Plan {
        skims: vec![Skim { pass: pass(0.08, "C2"), way: Way::Again }],
        tabs: Tabs::Even { count: 1, length: 2.0 },
        cut_tabs: CutTabs::BeforeSkims,
        lead_in: Lead::Direct,
        lead_out: Some(Lead::Direct),
        ..plan()
    };
    let all = told(&motions(&[die()], &plan));
    let stop = all.iter().position(|said| said == "Stop(Pause)").unwrap();
    assert_eq!(all[stop - 1], "L 0.100,2.000");
    let behind = ["L 0.100,0.100", "L 10.000,6.000", "C2", "L 0.080,0.080", "L 19.920,0.080"];
    assert_eq!(all[stop + 1..=stop + 5], behind);
    assert_eq!(&all[all.len() - 3..], ["L 0.080,0.080", "L 10.000,6.000", "Stop(End)"]);
}

#[test]
fn a_wire_with_gap_and_stock_runs_at_their_sum_and_the_kerf_is_without_the_stock() {
    let distance = Distance::Wire { diameter: 0.25, gap: 0.02, stock: 0.03 };
    assert!((distance.offset() - 0.175).abs() < 1e-15);
    assert!((distance.kerf_radius() - 0.145).abs() < 1e-15);
    let plan = Plan { rough: Pass { distance, words: Vec::new() }, ..plan() };
    assert_eq!(told(&motions(&[punch()], &plan))[1], "L 0.000,-0.175");
}

#[test]
fn the_side_of_the_wire_and_the_kept_side_are_one_choice() {
    let path = punch().path;
    for path in [path.clone(), path.reversed()] {
        for side in [Side::Left, Side::Right] {
            assert_eq!(Kept::beside(&path, side).wire_side(&path), side);
        }
    }
    assert_eq!(Kept::beside(&path, Side::Left), Kept::Outside);
}

#[test]
fn an_entry_is_put_where_the_contour_is_nearest() {
    let contour = Contour { entry: Entry::Nearest(p(7.0, -3.0)), ..punch() };
    let all = told(&motions(&[contour], &plan()));
    assert_eq!(&all[..3], ["R 7.000,-2.100", "C1", "L 7.000,-0.100"]);
}

#[test]
fn a_hole_before_the_outline_is_cut_from_its_own_start_hole() {
    let bore = Path::circle(p(10.0, 6.0), 3.0, Sense::CounterClockwise);
    let bore = contour(bore, Kept::Outside, Holes::Given(vec![p(10.0, 6.0)]));
    let all = told(&motions(&[bore, punch()], &plan()));
    let expected = [
        "R 10.000,6.000",
        "C1",
        "L 10.900,6.000",
        "L 12.900,6.000",
        "A 12.900,6.000",
        "L 10.900,6.000",
        "M50",
    ];
    assert_eq!(all[..7], expected);
    assert_eq!(&all[7..10], ["R 0.000,-2.100", "M60", "C1"]);
}

#[test]
fn a_start_hole_or_lead_in_the_part_is_refused_with_its_place() {
    let inside = Contour { holes: Holes::Given(vec![p(5.0, 5.0)]), ..punch() };
    let error = refusal(&[inside], &plan());
    let message = "contour 1: the start hole is in the kept part, inside the contour (at X5.0000 Y5.0000)";
    assert_eq!((error.to_string().as_str(), error.spot.line), (message, 7));
    assert_eq!(error.help(), "put the hole outside the contour, or keep what is outside");

    // The hole is in the waste, but the part lies between it and the entry.
    let behind = Contour { holes: Holes::Given(vec![p(10.0, 15.0)]), ..punch() };
    let error = refusal(&[behind], &plan());
    let part = |error: &Refusal| match error.fault {
        Fault::CutsPart { lane, other, .. } => (lane, other),
        _ => panic!("{error}"),
    };
    assert_eq!(part(&error), (Lane::Approach, 1));
    assert_eq!(error.at.map(|at| at.y > -0.2), Some(true));

    // A lead longer than the opening is wide.
    let long = Plan { lead_in: Lead::Straight { length: 30.0 }, ..plan() };
    let die = Contour { holes: Holes::AtLeadIn, ..die() };
    assert_eq!(part(&refusal(&[die], &long)), (Lane::LeadIn, 1));

    // Another part in the way of the lead-in.
    let other = contour(rectangle(p(-1.0, -3.0), p(1.0, -1.0)), Kept::Inside, Holes::AtLeadIn);
    assert_eq!(part(&refusal(&[punch(), other], &plan())), (Lane::LeadIn, 2));
}

#[test]
fn a_lead_over_a_tab_is_refused() {
    // A quarter arc comes from behind, over the tab that ends at the entry.
    let arc = Lead::Arc { radius: 2.0, sweep: 90.0 };
    let tabs = Tabs::At(vec![Tab { from: 2.0, length: 2.0 }, Tab { from: 60.0, length: 2.0 }]);
    let middle = Contour { entry: Entry::Nearest(p(10.0, 0.0)), ..punch() };
    let over = Plan { lead_in: arc, tabs: tabs.clone(), ..plan() };
    let error = refusal(std::slice::from_ref(&middle), &over);
    assert_eq!(error.fault, Fault::CutsTab { lane: Lane::LeadIn, tab: 1 });
    let straight = Plan { tabs, ..plan() };
    assert!(Cutting::new(vec![middle], straight).is_ok());
}

#[test]
fn parts_too_near_each_other_are_refused() {
    let near = contour(rectangle(p(20.15, 0.0), p(30.0, 12.0)), Kept::Inside, Holes::AtLeadIn);
    let error = refusal(&[punch(), near], &plan());
    assert!(matches!(error.fault, Fault::CutsOther { pass: 1, other: 2, .. }), "{error}");
    let clear = contour(rectangle(p(20.25, 0.0), p(30.0, 12.0)), Kept::Inside, Holes::AtLeadIn);
    let lead = Plan { lead_in: Lead::Straight { length: 0.5 }, ..plan() };
    assert!(
        Cutting::new(vec![punch(), Contour { entry: Entry::Nearest(p(25.0, 0.0)), ..clear }], lead).is_ok()
    );
}

#[test]
fn what_cannot_be_cut_is_refused_by_the_rule_it_breaks() {
    let fault = |contour: Contour, plan: Plan| refusal(&[contour], &plan).fault;
    let open = Path::new(punch().path.elements()[..3].to_vec()).unwrap();
    assert_eq!(fault(Contour { path: open, ..punch() }, plan()), Fault::Open);
    let wide = Plan { rough: pass(7.0, ""), ..plan() };
    assert_eq!(fault(die(), wide), Fault::NoRoom { pass: 1, offset: 7.0 });
    let holes = Contour { holes: Holes::Given(vec![p(1.0, 5.0), p(2.0, 5.0)]), ..die() };
    assert_eq!(fault(holes, plan()), Fault::Holes { given: 2, needed: 1 });
    assert_eq!(fault(punch(), Plan { lead_in: Lead::Direct, ..plan() }), Fault::NoHole);
    let short = Plan { tabs: Tabs::Even { count: 1, length: 0.2 }, lead_in: Lead::Direct, ..plan() };
    assert!(matches!(fault(die(), short), Fault::TabTooShort { tab: 1, .. }));
    let long = Plan { overcut: 65.0, ..plan() };
    assert!(matches!(fault(punch(), long), Fault::OvercutTooLong { .. }));
    for (what, plan) in [
        ("the offset", Plan { rough: pass(f64::NAN, ""), ..plan() }),
        ("the offset", Plan { rough: pass(-0.1, ""), ..plan() }),
        ("the overcut", Plan { overcut: -1.0, ..plan() }),
        ("the sweep of a lead", Plan { lead_in: Lead::Arc { radius: 1.0, sweep: 181.0 }, ..plan() }),
        ("the length of a lead", Plan { lead_out: Some(Lead::Straight { length: f64::INFINITY }), ..plan() }),
        ("the number of tabs", Plan { tabs: Tabs::Even { count: 0, length: 1.0 }, ..plan() }),
        ("the length of a tab", Plan { tabs: Tabs::At(vec![Tab { from: 0.0, length: -1.0 }]), ..plan() }),
        ("the place where the machine stands", Plan { from: p(f64::NAN, 0.0), ..plan() }),
    ] {
        let found = fault(punch(), plan);
        assert!(matches!(found, Fault::Number { what: named, .. } if named == what), "{what}: {found}");
    }
}

#[test]
fn a_path_that_comes_apart_names_the_throat_and_the_largest_offset() {
    let nodes = [
        p(0.0, 0.0),
        p(6.0, 0.0),
        p(6.0, 2.9),
        p(8.0, 2.9),
        p(8.0, 0.0),
        p(14.0, 0.0),
        p(14.0, 6.0),
        p(8.0, 6.0),
        p(8.0, 3.1),
        p(6.0, 3.1),
        p(6.0, 6.0),
        p(0.0, 6.0),
    ];
    let line = |n: usize| Element::Line { start: nodes[n], end: nodes[(n + 1) % nodes.len()] };
    let path = Path::new((0..nodes.len()).map(line).collect()).unwrap();
    let dumbbell = contour(path, Kept::Outside, Holes::AtLeadIn);
    let error = refusal(&[dumbbell], &Plan { rough: pass(0.15, ""), ..plan() });
    let Fault::ComesApart { pieces: 2, largest: Some(largest), .. } = error.fault else { panic!("{error}") };
    assert!((largest - 0.1).abs() < 2e-3, "{largest}");
    assert!(error.at.is_some_and(|at| (6.0..=8.0).contains(&at.x)), "{error}");
}

#[test]
fn a_full_circle_stays_one_arc_and_can_be_entered_anywhere() {
    let bore = Path::circle(p(0.0, 0.0), 5.0, Sense::CounterClockwise);
    let bore = contour(bore, Kept::Outside, Holes::Given(vec![p(0.0, 0.0)]));
    let plan = Plan { lead_in: Lead::Direct, lead_out: Some(Lead::Direct), ..plan() };
    let all = told(&motions(std::slice::from_ref(&bore), &plan));
    assert_eq!(all, ["C1", "L 4.900,0.000", "A 4.900,0.000", "L 0.000,0.000", "Stop(End)"]);
    let left = Contour { entry: Entry::Nearest(p(-9.0, 0.0)), ..bore };
    let all = told(&motions(&[left], &plan));
    assert_eq!(&all[..2], ["C1", "L -4.900,0.000"]);
    assert_eq!(&all[all.len() - 2..], ["L 0.000,0.000", "Stop(End)"]);
}

#[test]
fn a_plan_is_written_as_3b_and_as_gcode() {
    let plan =
        Plan { tabs: Tabs::Even { count: 2, length: 2.0 }, lead_in: Lead::Direct, lead_out: None, ..plan() };
    let all = motions(&[die()], &plan);
    let mut text = Vec::new();
    let mut writer = ThreeB::new(Form::default());
    all.iter().for_each(|motion| writer.write(motion, &mut text).unwrap());
    writer.finish(&mut text).unwrap();
    // The way to the first hole is the operator's; the two others are lines between pauses.
    assert_eq!(writer.start_hole(), Some(p(10.0, 6.0)));
    assert_eq!(writer.blocks(), 11);
    let mut text = Vec::new();
    let dialect = gcode::Dialect::generic().unwrap();
    let mut writer = gcode::Writer::new(dialect);
    all.iter().for_each(|motion| writer.write(motion, &mut text).unwrap());
    writer.finish(&mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    for word in ["M50", "M60", "M00", "C1", "M02"] {
        assert!(text.contains(word), "{word} in {text}");
    }
}

/// 10 mm square, to be led into from outside.
fn square() -> Contour {
    contour(rectangle(p(0.0, 0.0), p(10.0, 10.0)), Kept::Inside, Holes::AtLeadIn)
}

#[test]
fn with_an_offset_of_nothing_the_wire_runs_on_the_line_and_its_leads_keep_out_of_the_part() {
    for (kept, hole) in [(Kept::Inside, p(-2.0, -2.0)), (Kept::Outside, p(2.0, 2.0))] {
        let square = Contour { kept, ..square() };
        let plan = Plan { rough: pass(0.0, "C1"), ..plan() };
        let cutting = Cutting::new(vec![square.clone()], plan.clone()).unwrap();
        let shown = cutting.summary().to_string();
        assert!(shown.contains("offset 0.0000 mm, path 40.000 mm, cut 40.000 mm"), "{shown}");
        // The lead halves the angle of the corner at which the contour begins, in the waste.
        let lead = hole * std::f64::consts::FRAC_1_SQRT_2;
        let started = cutting.summary().contours[0].holes[0];
        assert!((started - lead).norm() < 1e-3, "{kept:?}: {started}");
        let through = Contour { holes: Holes::Given(vec![p(-hole.x, -hole.y)]), ..square };
        let error = refusal(&[through], &Plan { lead_in: Lead::Direct, lead_out: None, ..plan });
        assert!(matches!(error.fault, Fault::HoleInPart { .. }), "{error}");
    }
    // Led in from a hole in the waste, but through the part.
    let far = Contour { entry: Entry::Beginning, holes: Holes::Given(vec![p(5.0, 12.0)]), ..square() };
    let direct = Plan { rough: pass(0.0, "C1"), lead_in: Lead::Direct, lead_out: None, ..plan() };
    let error = refusal(&[far], &direct);
    assert!(matches!(error.fault, Fault::CutsPart { lane: Lane::LeadIn, .. }), "{error}");
}

#[test]
fn a_stop_before_a_tab_is_said_once_where_threading_ends_with_one() {
    let stop = || vec![Act::Stop(Stop::Pause)];
    let plan = Plan {
        tabs: Tabs::Even { count: 2, length: 1.0 },
        rethread: Rethread { cut: stop(), thread: stop() },
        stops: Stops::BeforeEach(Stop::Pause),
        ..plan()
    };
    let motions = motions(&[square()], &plan);
    let twice = motions.windows(2).filter(|pair| pair[0].act == pair[1].act).count();
    assert_eq!(twice, 0, "{motions:?}");
    // Cut, threaded and cut again: each tab is cut behind a stop of its own all the same.
    assert_eq!(Cutting::new(vec![square()], plan).unwrap().summary().contours[0].stops, 2);
}
