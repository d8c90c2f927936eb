//! Cutting plans judged by dense sampling: where the wire goes, when, how often, and through what.
//!
//! Nothing here asks the plan what it did. A move that lies at the offset of its pass all along runs beside the contour;
//! every other cut goes through the waste. What lies in a tab is told by the length along the contour.

use std::cell::Cell;

use dripfeed::cutting::{
    Contour, CutTabs, Cutting, Distance, Entry, Fault, Holes, Kept, Lead, Pass, Plan, Rethread, Skim, Stops,
    Tabs, Way,
};
use dripfeed::geometry::offset::{Corners, offset};
use dripfeed::geometry::{Element, Path, Point};
use dripfeed::motion::{Act, Motion, Stop, Travel};
use dripfeed::place::Spot;
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

use crate::contours;
use crate::measure::{Inside, distance, samples};

/// A micron.
const UM: f64 = 1e-3;

#[test]
fn every_plan_cuts_all_of_its_contour_at_its_offset_and_its_tabs_last() {
    let (judged, tabbed, skimmed, arcs) = (Cell::new(0), Cell::new(0), Cell::new(0), Cell::new(0));
    let config = Config { cases: 700, failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new(config);
    let cases = (any_contour(), any_plan());
    let outcome = runner.run(&cases, |(contour, plan)| {
        if a_lead_hugs_the_path(&contour, &plan) {
            return Ok(());
        }
        match Cutting::new(vec![contour.clone()], plan.clone()) {
            Ok(cutting) => {
                let motions: Vec<Motion> = cutting.map(|motion| motion.unwrap()).collect();
                if let Err(what) = fault(&contour, &plan, &motions) {
                    return Err(TestCaseError::fail(what));
                }
                judged.set(judged.get() + 1);
                tabbed.set(tabbed.get() + usize::from(plan.tabs != Tabs::None));
                skimmed.set(skimmed.get() + usize::from(!plan.skims.is_empty()));
                arcs.set(arcs.get() + usize::from(matches!(plan.lead_in, Lead::Arc { .. })));
                Ok(())
            }
            // Contours no one drew are often too narrow for the wire or the lead; they are refused, not cut.
            Err(refusal) => {
                let expected = matches!(
                    refusal.fault,
                    Fault::Impossible { .. }
                        | Fault::NoRoom { .. }
                        | Fault::ComesApart { .. }
                        | Fault::CutsPart { .. }
                        | Fault::CutsTab { .. }
                        | Fault::TabTooShort { .. }
                        | Fault::TabLost { .. }
                        | Fault::EntryLost { .. }
                        | Fault::OvercutTooLong { .. }
                        | Fault::TabsTooLong { .. }
                );
                prop_assert!(expected, "{refusal}");
                Ok(())
            }
        }
    });
    outcome.unwrap();
    let counts = [judged.get(), tabbed.get(), skimmed.get(), arcs.get()];
    assert!(counts[0] > 200 && counts[1] > 80 && counts[2] > 100 && counts[3] > 40, "{counts:?}");
}

#[test]
fn the_oracle_sees_what_is_lost_shifted_cut_twice_or_too_early() {
    let (contour, plan) = block();
    let motions: Vec<Motion> =
        Cutting::new(vec![contour.clone()], plan.clone()).unwrap().map(Result::unwrap).collect();
    assert_eq!(fault(&contour, &plan, &motions), Ok(()));
    let stop = motions.iter().position(|motion| motion.act == Act::Stop(Stop::Pause)).unwrap();
    let cuts: Vec<usize> = (0..motions.len()).filter(|n| cut(&motions[*n]).is_some()).collect();
    let check = |change: &dyn Fn(&mut Vec<Motion>)| {
        let mut changed = motions.clone();
        change(&mut changed);
        fault(&contour, &plan, &changed)
    };
    assert!(check(&|all| drop(all.remove(cuts[1]))).unwrap_err().contains("begins"));
    assert!(check(&|all| all.swap(stop, stop - 1)).unwrap_err().contains("tab"));
    assert!(check(&|all| drop(all.remove(stop))).unwrap_err().contains("tab"));
    let twice = |all: &mut Vec<Motion>| {
        let motion = all[cuts[2]].clone();
        let mut back = motion.clone();
        back.act = moved(cut(&motion).unwrap().reversed());
        all.splice(cuts[2]..=cuts[2], [motion.clone(), back, motion]);
    };
    assert!(check(&twice).unwrap_err().contains("beside the contour, not"));
    let shift = |all: &mut Vec<Motion>| {
        for motion in all {
            if let Act::Move { element, .. } = &mut motion.act {
                *element = element.placed(0.0, 1.0, Point::new(2.0 * UM, 0.0).coords);
            }
        }
    };
    assert!(check(&shift).is_err());
    let mut cuts = classified(&contour.path, &plan, &[0.15, 0.13], &motions).unwrap();
    let outline = offset(&contour.path, -0.15, Corners::Round).unwrap().outlines.remove(0).path;
    let judged = |cuts: &[Cut]| once(&contour.path, &plan, (0, 0.15), &outline, cuts);
    assert_eq!(judged(&cuts), Ok(()));
    let lost = cuts.remove(1);
    assert!(judged(&cuts).unwrap_err().contains("cut 0 times"));
    cuts.insert(1, lost);
    cuts.push(lost);
    assert!(judged(&cuts).unwrap_err().contains("cut 2 times"));
}

/// A block of 20 by 12 mm with two rounded corners, cut round from the middle of a side, with a tab.
fn block() -> (Contour, Plan) {
    let p = Point::new;
    let nodes = [p(0.0, 0.0), p(20.0, 0.0), p(20.0, 12.0), p(0.0, 12.0)];
    let path = contours::filleted(&nodes, &[0.0, 3.0, 0.0, 2.0]);
    let contour = Contour {
        path,
        kept: Kept::Inside,
        entry: Entry::Beginning,
        holes: Holes::AtLeadIn,
        spot: Spot::default(),
    };
    let plan = Plan {
        rough: pass(0, 0.15),
        skims: vec![Skim { pass: pass(1, 0.13), way: Way::Back }],
        corners: Corners::Round,
        lead_in: Lead::Straight { length: 2.0 },
        lead_out: Some(Lead::Straight { length: 1.0 }),
        overcut: 0.2,
        tabs: Tabs::Even { count: 1, length: 1.5 },
        cut_tabs: CutTabs::Last,
        stops: Stops::BeforeLast(Stop::Pause),
        rethread: Rethread { cut: Vec::new(), thread: Vec::new() },
        from: p(0.0, 0.0),
    };
    (contour, plan)
}

fn pass(number: usize, offset: f64) -> Pass {
    Pass { distance: Distance::Offset(offset), words: vec![format!("P{number}").into_bytes().into()] }
}

fn any_contour() -> impl Strategy<Value = Contour> {
    (0..100_000_u64, any::<bool>(), any::<bool>()).prop_map(|(seed, reversed, inside)| {
        let (_, path) = contours::any(seed);
        Contour {
            path: if reversed { path.reversed() } else { path },
            kept: if inside { Kept::Inside } else { Kept::Outside },
            entry: Entry::Beginning,
            holes: Holes::AtLeadIn,
            spot: Spot::default(),
        }
    })
}

fn any_lead() -> impl Strategy<Value = Lead> {
    prop_oneof![
        (0.05..1.0).prop_map(|length| Lead::Straight { length }),
        (0.05..0.4, 30.0..180.0).prop_map(|(radius, sweep)| Lead::Arc { radius, sweep }),
    ]
}

fn any_plan() -> impl Strategy<Value = Plan> {
    let ways = proptest::collection::vec(prop_oneof![Just(Way::Again), Just(Way::Back)], 0..3);
    let tabs = prop_oneof![
        Just(Tabs::None),
        (1..4_u32, 0.5..2.0).prop_map(|(count, length)| Tabs::Even { count, length })
    ];
    let last = prop_oneof![Just(CutTabs::Last), Just(CutTabs::BeforeSkims)];
    let out = prop_oneof![any_lead().prop_map(Some), Just(None)];
    (0.03..0.2, ways, any_lead(), out, prop_oneof![Just(0.0), 0.01..0.4], tabs, last).prop_map(
        |(offset, ways, lead_in, lead_out, overcut, tabs, cut_tabs)| Plan {
            rough: pass(0, offset),
            skims: ways
                .into_iter()
                .enumerate()
                .map(|(n, way)| Skim { pass: pass(n + 1, offset - 0.01 * (n + 1) as f64), way })
                .collect(),
            corners: Corners::Round,
            lead_in,
            lead_out,
            overcut,
            tabs,
            cut_tabs,
            stops: Stops::BeforeEach(Stop::Pause),
            rethread: Rethread { cut: Vec::new(), thread: Vec::new() },
            from: Point::origin(),
        },
    )
}

/// A cut beside the contour or through the waste, in which pass, and after how many stops.
#[derive(Clone, Copy)]
struct Cut {
    element: Element,
    pass: usize,
    stops: usize,
    beside: bool,
}

/// Whether an arc of a lead is so like a fillet of the path that one cannot be told from the other.
fn a_lead_hugs_the_path(contour: &Contour, plan: &Plan) -> bool {
    std::iter::once(plan.lead_in).chain(plan.lead_out).any(|lead| {
        let Lead::Arc { radius: lead, .. } = lead else { return false };
        let arcs = contour.path.elements().iter().filter_map(Element::radius);
        arcs.into_iter().any(|arc| {
            plan.passes().any(|pass| ((arc - pass.distance.offset()).abs() - lead).abs() < 20.0 * UM)
        })
    })
}

/// What is wrong with the motions of a plan for a contour.
fn fault(contour: &Contour, plan: &Plan, motions: &[Motion]) -> Result<(), String> {
    let path = &contour.path;
    let offsets: Vec<f64> = plan.passes().map(|pass| pass.distance.offset()).collect();
    let cuts = classified(path, plan, &offsets, motions)?;
    waste(contour, &offsets, &cuts)?;
    for (pass, by) in offsets.iter().enumerate() {
        let inside = (contour.kept == Kept::Outside) == (path.area() > 0.0);
        let left = if inside { *by } else { -by };
        let found = offset(path, left, Corners::Round).map_err(|error| error.to_string())?;
        let whole: f64 = found.outlines.iter().map(|outline| outline.path.length()).sum();
        lengths(plan, pass, whole, &cuts)?;
        once(path, plan, (pass, *by), &found.outlines[0].path, &cuts)?;
    }
    Ok(())
}

/// The cuts, each begun where the last motion ended.
fn classified(path: &Path, plan: &Plan, offsets: &[f64], motions: &[Motion]) -> Result<Vec<Cut>, String> {
    let (mut at, mut pass, mut stops) = (plan.from, 0, 0);
    let mut cuts = Vec::new();
    // What begins where the wire was threaded leads in, even if it happens to run beside a wall across.
    let mut holes = Vec::new();
    for (n, motion) in motions.iter().enumerate() {
        match &motion.act {
            Act::Move { travel, element, .. } => {
                if element.start() != at {
                    return Err(format!("motion {n} begins at {}, not at {at}", element.start()));
                }
                at = element.end();
                if *travel == Travel::Rapid {
                    holes.push(at);
                } else {
                    let off = |(p, _): &(Point, Point)| (distance(path, *p) - offsets[pass]).abs();
                    let mut beside = samples(element, 9).iter().all(|sample| off(sample) <= UM);
                    // A lead shorter than that would pass for one: ends count too.
                    let ends = [element.start(), element.end()];
                    beside &= ends.iter().all(|end| (distance(path, *end) - offsets[pass]).abs() <= UM);
                    beside &= !cuts.is_empty() && !holes.contains(&element.start());
                    cuts.push(Cut { element: *element, pass, stops, beside });
                }
            }
            Act::Word(word) => pass = usize::from(word[1] - b'0'),
            Act::Stop(Stop::Pause) => stops += 1,
            Act::Stop(Stop::End) if n + 1 == motions.len() => {}
            other => return Err(format!("{other:?} was not asked for")),
        }
    }
    Ok(cuts)
}

/// What does not run beside the contour goes through the waste, and keeps off the part.
fn waste(contour: &Contour, offsets: &[f64], cuts: &[Cut]) -> Result<(), String> {
    let inside = Inside::of(&contour.path);
    for (n, cut) in cuts.iter().enumerate().filter(|(_, cut)| !cut.beside) {
        let last = n.checked_sub(1).map_or(cut.pass, |last| cuts[last].pass);
        let least = offsets[cut.pass].min(offsets[last]);
        for (point, _) in samples(&cut.element, 40) {
            if inside.has(point) == (contour.kept == Kept::Inside) {
                return Err(format!("cut {n} is in the part at {point}"));
            }
            let near = distance(&contour.path, point);
            if near < least - UM {
                return Err(format!("cut {n} comes within {near} of the part at {point}, not {least}"));
            }
        }
    }
    Ok(())
}

/// The way beside the contour is as long as the path and the overcuts together.
fn lengths(plan: &Plan, pass: usize, whole: f64, cuts: &[Cut]) -> Result<(), String> {
    let tabs = match plan.tabs {
        Tabs::Even { count, .. } => f64::from(count),
        _ => 0.0,
    };
    let overcuts = match (pass, tabs > 0.0, plan.cut_tabs) {
        (0, true, _) => tabs,
        // Each later pass over a tab runs from past its one end to past the other.
        (_, true, CutTabs::Last) => 2.0 * tabs,
        _ => 1.0,
    };
    let own = || cuts.iter().filter(|cut| cut.pass == pass && cut.beside);
    let swept: f64 = own().map(|cut| cut.element.length()).sum();
    let expected = whole + overcuts * plan.overcut;
    // Each node is a rounding of at most 0.7 µm; an overcut may end within a micron of a node.
    let slack = 1.5 * UM * (own().count() as f64 + 2.0 * overcuts);
    if (swept - expected).abs() > slack {
        return Err(format!("pass {pass} cuts {swept} beside the contour, not {expected}"));
    }
    Ok(())
}

/// Every point of the path is cut once in each pass, but for overcuts: stretches before any stop, tabs behind theirs.
fn once(
    path: &Path,
    plan: &Plan,
    (pass, by): (usize, f64),
    outline: &Path,
    cuts: &[Cut],
) -> Result<(), String> {
    let tabs = tabs(path, plan);
    let whole = path.length();
    let mut over: Vec<f64> = tabs.iter().flat_map(|tab| [tab.0, tab.1]).collect();
    over.extend([0.0, whole]);
    let ways: Vec<Path> = outline.elements().iter().filter_map(|way| Path::new(vec![*way])).collect();
    for (n, element) in outline.elements().iter().enumerate() {
        let count = (element.length() / 0.1).clamp(3.0, 60.0) as usize;
        for (point, _) in samples(element, count) {
            let along = along(path, point);
            // Near an end of a piece, a hair to either side makes the difference; an overcut reaches past it.
            let reach =
                |end: &f64| (at(path, *end) - point).norm() - distance(outline, at(path, *end)).max(by);
            let near_end = over.iter().any(|end| reach(end) <= 6.0 * UM);
            if near_end || beside_itself(&ways, n, point) {
                continue;
            }
            let tab = tabs.iter().any(|(from, to)| *from < along && along < *to);
            let mut runs: Vec<&Cut> = Vec::new();
            let mut last: Option<usize> = None;
            for (n, cut) in cuts.iter().enumerate().filter(|(_, cut)| cut.pass == pass && cut.beside) {
                let one = Path::new(vec![cut.element]).ok_or("an empty element")?;
                if distance(&one, point) <= 1.5 * UM {
                    if last.is_none_or(|last| last + 1 != n || cuts[last].element == cut.element.reversed()) {
                        runs.push(cut);
                    }
                    last = Some(n);
                }
            }
            // A wire that stays on its path begins each pass where the last overcut ended.
            let overcuts = if plan.lead_out.is_none() { plan.passes().count() as f64 } else { 1.0 };
            let in_overcut = over.iter().any(|end| reach(end) <= plan.overcut * overcuts + 6.0 * UM);
            // A tab that ends where the wire does not come ends on its path at some place near by, and so does its overcut.
            let told = over.iter().all(|end| distance(outline, at(path, *end)) <= 1.5 * by);
            let most = if in_overcut || !told { 3 } else { 1 };
            if runs.is_empty() || runs.len() > most {
                return Err(format!("{point} is cut {} times in pass {pass}", runs.len()));
            }
            let held = told && (pass == 0 || plan.cut_tabs == CutTabs::Last);
            if tab && held && runs[0].stops == 0 {
                return Err(format!("{point} in a tab is cut before the stop"));
            }
            if !tab && held && runs[0].stops > 0 {
                return Err(format!(
                    "{point} outside the tabs {tabs:?} at {along} of {whole} is cut only after a stop"
                ));
            }
        }
    }
    Ok(())
}

/// Whether the path lies on itself at a point of one of its elements: in a slot as wide as the kerf, whose two sides meet at the
/// bottom in a point, or in an element of some microns.
fn beside_itself(ways: &[Path], n: usize, point: Point) -> bool {
    let ends = |way: &Path| [way.start(), way.end()];
    let is_near = |end: &Point| (*end - point).norm() <= 25.0 * UM;
    let doubled = ways.iter().enumerate().any(|(m, way)| {
        let joined = ends(way).iter().any(|end| is_near(end) && ends(&ways[n]).contains(end));
        m != n && !joined && distance(way, point) <= 5.0 * UM
    });
    // Near the bottom the sides are looked at a little way up.
    let mut sides = ways.iter().enumerate().filter(|(_, way)| ends(way).iter().any(is_near));
    doubled
        || sides.any(|(a, way)| {
            let up = 60.0 * UM / way.length();
            let at = way.elements()[0].at(if is_near(&way.start()) { up } else { 1.0 - up });
            up < 1.0 && ways.iter().enumerate().any(|(b, other)| a != b && distance(other, at) <= 5.0 * UM)
        })
}

/// Where tabs lie along the contour, mm.
fn tabs(path: &Path, plan: &Plan) -> Vec<(f64, f64)> {
    let whole = path.length();
    match plan.tabs {
        Tabs::Even { count, length } => (1..=count)
            .map(|n| whole * f64::from(n) / f64::from(count))
            .map(|end| (end - length, end))
            .collect(),
        _ => Vec::new(),
    }
}

/// How far along the contour its point nearest to another lies, mm.
fn along(path: &Path, point: Point) -> f64 {
    let mut before = 0.0;
    let mut best = (f64::INFINITY, 0.0);
    for element in path.elements() {
        let near = element.nearest(point);
        let distance = (near - point).norm();
        let length = element.length();
        if distance < best.0 {
            let within = match *element {
                Element::Line { start, .. } => (near - start).norm(),
                Element::Arc { start, centre, sense, .. } => {
                    let turn = dripfeed::geometry::sweep(start - centre, near - centre, sense);
                    if (near - start).norm() < 1e-9 { 0.0 } else { turn * (start - centre).norm() }
                }
            };
            best = (distance, before + within.min(length));
        }
        before += length;
    }
    best.1
}

/// The point of the contour at a length along it.
fn at(path: &Path, along: f64) -> Point {
    let mut left = along;
    for element in path.elements() {
        let length = element.length();
        if left <= length {
            return element.at(left / length);
        }
        left -= length;
    }
    path.end()
}

fn cut(motion: &Motion) -> Option<Element> {
    match motion.act {
        Act::Move { travel: Travel::Cut, element, .. } => Some(element),
        _ => None,
    }
}

fn moved(element: Element) -> Act {
    Act::Move { travel: Travel::Cut, element, upper: None, flag: None }
}
