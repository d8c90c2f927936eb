//! What a plot makes of motions, before it is spelled.

use super::*;
use crate::drawing::text_width;
use crate::motion::Travel as Way;
use crate::place::Spot;

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

fn motions(acts: Vec<Act>) -> impl Iterator<Item = Motion> {
    (1..).zip(acts).map(|(block, act)| Motion { act, block, spot: Spot::default() })
}

fn go(travel: Way, from: (f64, f64), to: (f64, f64)) -> Act {
    let element = Element::Line { start: p(from.0, from.1), end: p(to.0, to.1) };
    Act::Move { travel, element, upper: None, flag: None }
}

fn drawn(acts: Vec<Act>, options: Options) -> Plotted {
    let mut plot = Plot::new(options);
    for motion in motions(acts) {
        plot.see(&motion, None).unwrap();
    }
    plot.finish()
}

fn square() -> Vec<Act> {
    let corners = [(-5.0, 0.0), (0.0, 0.0), (10.0, 0.0), (10.0, 8.0), (0.0, 8.0), (0.0, 0.0)];
    corners.windows(2).map(|pair| go(Way::Cut, pair[0], pair[1])).collect()
}

#[test]
fn the_lead_in_is_no_part_of_the_part() {
    let plotted = drawn(square(), Options::default());
    assert_eq!(plotted.part, Some(Extent::between([0.0, 0.0], [10.0, 8.0])));
    assert_eq!(plotted.extent, Some(Extent::between([-5.0, 0.0], [10.0, 8.0])));
    assert_eq!((plotted.thinned_um, plotted.pulses, plotted.deviation), (0.0, 0, None));
}

#[test]
fn a_program_that_moves_nothing_has_no_bounds_and_is_still_a_picture() {
    let plotted = drawn(vec![Act::Stop(Stop::End)], Options::default());
    assert_eq!((plotted.part, plotted.extent), (None, None));
    assert!(plotted.picture.to_svg().contains("</svg>"));
}

#[test]
fn a_start_is_marked_once_however_often_the_wire_is_threaded_there() {
    let mut plot = Plot::new(Options::default());
    let round = [square(), vec![go(Way::Rapid, (0.0, 0.0), (-5.0, 0.0))]].concat();
    for motion in motions([round.clone(), round.clone(), round].concat()) {
        plot.see(&motion, None).unwrap();
    }
    assert_eq!(plot.starts.marked, [p(-5.0, 0.0)]);
}

#[test]
fn a_chain_too_long_to_be_held_is_drawn_all_the_same() {
    // A spiral that closes nowhere, of more cuts than are held.
    let node = |n: usize| {
        let (sin, cos) = libm::sincos(n as f64 * 0.05);
        (n as f64 * 0.001 * cos, n as f64 * 0.001 * sin)
    };
    let mut plot = Plot::new(Options::default());
    let mut all: Option<Extent> = None;
    for n in 0..HELD_MAX + 1000 {
        let act = go(Way::Cut, node(n), node(n + 1));
        let Act::Move { element, .. } = &act else { unreachable!() };
        all = Some(grown(all, element));
        plot.see(&Motion { act, block: n as u64 + 1, spot: Spot::default() }, None).unwrap();
    }
    let plotted = plot.finish();
    assert_eq!(plotted.part, all);
    assert!(plotted.thinned_um > 0.0 && plotted.picture.to_svg().len() < 5_000_000);
}

#[test]
fn the_wires_own_path_widens_the_picture_and_not_the_part() {
    let mut plot = Plot::new(Options { wire: Some(0.2), ..Options::default() });
    for motion in motions(square()) {
        plot.see(&motion, None).unwrap();
    }
    for motion in motions(vec![go(Way::Cut, (-5.0, -1.0), (11.0, -1.0))]) {
        plot.see_wire(&motion);
    }
    let plotted = plot.finish();
    assert_eq!(plotted.part, Some(Extent::between([0.0, 0.0], [10.0, 8.0])));
    assert_eq!(plotted.extent, Some(Extent::between([-5.0, -1.0], [11.0, 8.0])));
}

#[test]
fn the_caption_finds_room_on_the_page() {
    let height = Class::Label.style().letters;
    let words =
        "blue: as programmed · orange: ways in and out · black: pulses of the mirrored model · wire 0.125 mm";
    assert!(text_width(words, height) < PART_SPAN);
}
