//! `dripfeed plot`, judged by the pictures it makes.
//!
//! SVGs are read again by a reader of the tests' own and compared with what the parts are by formulas, and with pulses
//! that the mock's interpolators run.

#[path = "gear/binary.rs"]
#[expect(dead_code, reason = "the program is run with files of the tests' own")]
mod binary;
#[path = "plot/svg.rs"]
mod svg;
#[path = "gear/theory.rs"]
#[expect(dead_code, reason = "only the outline is asked for")]
mod theory;

use mock_controller::interpolator::run;
use mock_controller::{Model, parse_block};
use svg::{Bounds, Mark, Svg};
use tempfile::TempDir;
use theory::{Direction, Gear, PAPER};

/// Plots a program under a name; returns the picture and what was said of it.
fn plot(name: &str, program: &str, words: &[&str]) -> (Svg, serde_json::Value) {
    let directory = TempDir::new().expect("a directory");
    let svg = written(&directory, name, program, "out.svg", words);
    (Svg::read(&String::from_utf8(svg.0).expect("text")), svg.1)
}

fn written(
    directory: &TempDir,
    name: &str,
    program: &str,
    out: &str,
    words: &[&str],
) -> (Vec<u8>, serde_json::Value) {
    std::fs::write(directory.path().join(name), program).expect("a program");
    let mut command = binary::command(&["plot", name, "-o", out, "--json"]);
    let output = command.args(words).current_dir(directory.path()).output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{name} {words:?}: {said}");
    let report = serde_json::from_slice(&output.stdout).expect("one JSON object");
    (std::fs::read(directory.path().join(out)).expect("a picture"), report)
}

/// A die plate in G-code: a round hole and an outline of lines and arcs, with a rapid move between them.
const PLATE: &str = "G90 G21\nG92 X0. Y0.\nG41 D1 G01 X8. Y0.\nG03 X8. Y0. I-8. J0.\nG40 G01 X0. Y0.\n\
G00 X-30. Y0.\nG41 D1 G01 X-25. Y0.\nG02 X-15. Y20. I25. J0.\nG01 X15. Y20.\nG02 X25. Y0. I-15. J-20.\n\
G02 X15. Y-20. I-25. J0.\nG01 X-15. Y-20.\nG02 X-25. Y0. I15. J20.\nG40 G01 X-30. Y0.\nM02\n";

/// Two round holes in 3B; the way between them lies between two pauses.
const HOLES: &str = "B5000B0B005000GXL1\nB9900B0B039600GYNR3\nB5000B0B005000GXL3\nD\nB40000B0B040000GXL1\nD\n\
B5000B0B005000GXL1\nB9900B0B039600GYNR3\nDD\n";

fn bounds(min: [f64; 2], max: [f64; 2]) -> Bounds {
    Bounds { min, max }
}

#[test]
fn the_contour_is_as_large_as_the_gear_by_its_formulas_within_a_micron() {
    let gears: [(Gear, &[&str]); 4] = [
        (PAPER, &[]),
        (Gear { offset: -0.05, tip_radius: 0.2, ..PAPER }, &["--offset", "-0.05", "--tip-radius", "0.2"]),
        (Gear { direction: Direction::CounterClockwise, ..PAPER }, &["--direction", "ccw"]),
        (Gear { teeth: 61, module: 0.6, ..PAPER }, &["--teeth", "61", "--module", "0.6"]),
    ];
    for (gear, words) in gears {
        let program = binary::command(&["generate", "gear"]).args(words).output().expect("a gear").stdout;
        let (svg, report) = plot("gear.3b", &String::from_utf8(program).expect("text"), &[]);
        let points = gear.outline().into_iter().flat_map(|element| element.sampled(200));
        let part = Bounds::of(points.map(|point| [point.x / 1000.0, point.y / 1000.0]));
        let off = svg.bounds("nominal").off_um(&part);
        assert!(off <= 1.0, "{words:?}: {off} µm");
        // The simulated cut, which is thinned by less than it says, reaches as far, and one pulse farther at most.
        let thinned = report["thinned_um"].as_f64().expect("a number");
        let reached = Bounds::of(svg.of("cut").flat_map(svg::Mark::points));
        assert!(reached.off_um(&part) <= 2.0 + thinned, "{words:?}: {reached:?}");
        let [width, height] = [0, 1].map(|axis| format!("{:.3}", part.max[axis] - part.min[axis]));
        let near = |text: &str, size: &str| {
            let parse = |t: &str| t.parse::<f64>().ok();
            matches!((parse(text), parse(size)), (Some(a), Some(b)) if (a - b).abs() <= 0.0021)
        };
        for size in [&width, &height] {
            assert!(svg.words().iter().any(|word| near(word, size)), "{size} in {:?}", svg.words());
        }
    }
}

#[test]
fn the_picture_is_in_millimetres_of_the_program_and_every_kind_of_thing_has_its_class() {
    let (svg, _) = plot("plate.nc", PLATE, &["--register", "1=0.6", "--wire", "1"]);
    let part = bounds([-25.0, -20.0], [25.0, 20.0]);
    // The two arcs of 25 mm reach beyond the flats' corners to ±25 in X alone.
    assert!(svg.bounds("nominal").off_um(&part) <= 0.1, "{:?}", svg.bounds("nominal"));
    // G41 sets the wire off to the left: outside the outline, which is run clockwise, and inside the hole.
    let outside = bounds([-30.0, -20.6], [25.6, 20.6]);
    assert!(svg.bounds("wire").off_um(&outside) <= 0.2, "{:?}", svg.bounds("wire"));
    let hole = Bounds::of(svg.of("wire").flat_map(svg::Mark::points).filter(|p| length(p[0], p[1]) < 9.0));
    assert!(hole.off_um(&bounds([-7.4, -7.4], [7.4, 7.4])) <= 0.2, "{hole:?}");
    assert!(svg.of("wire").all(|mark| mark.pen == Some(1.0)), "the wire has its true width");
    assert!(svg.bounds("rapid").off_um(&bounds([-30.0, 0.0], [0.0, 0.0])) <= 0.1);
    assert!(svg.bounds("lead-in").off_um(&bounds([-30.0, 0.0], [8.0, 0.0])) <= 0.1);
    let starts: Vec<_> = svg.of("start").map(|mark| Bounds::of(mark.points())).collect();
    let middles: Vec<_> =
        starts.iter().map(|b| [0, 1].map(|axis| (b.min[axis] + b.max[axis]) / 2.0)).collect();
    assert_eq!(middles.len(), 2);
    for (middle, x) in middles.iter().zip([0.0, -30.0]) {
        assert!((middle[0] - x).abs() < 1e-3 && middle[1].abs() < 1e-3, "{middles:?}");
    }
    // A viewBox of as many user units as millimetres at the scale of the paper, with everything in it.
    let all = Bounds::of(svg.marks.iter().flat_map(svg::Mark::points));
    let [left, bottom, width, height] = svg.view;
    assert!(
        all.min[0] > left && all.min[1] > bottom && all.max[0] < left + width && all.max[1] < bottom + height
    );
    assert!((svg.size[0] / width - svg.size[1] / height).abs() < 1e-3);
}

#[test]
fn every_arrow_head_lies_on_the_contour_and_points_the_way_of_the_cut() {
    let (svg, _) = plot("plate.nc", PLATE, &[]);
    let mut count = 0;
    for head in svg.of("direction solid") {
        let [tip, left, right, _] = head.runs[0][..] else { panic!("{head:?}") };
        let middle = [(tip[0] + left[0] + right[0]) / 3.0, (tip[1] + left[1] + right[1]) / 3.0];
        assert!(svg.of("nominal").any(|mark| mark.distance(middle) < 0.3), "{middle:?}");
        let way = [tip[0] - middle[0], tip[1] - middle[1]];
        let turn = middle[0] * way[1] - middle[1] * way[0];
        // The hole is run counter-clockwise, the outline clockwise.
        assert_eq!(turn > 0.0, length(middle[0], middle[1]) < 10.0, "{middle:?}");
        count += 1;
    }
    assert!(count >= 5, "{count}");
}

#[test]
fn block_numbers_stand_at_the_density_that_was_asked_for() {
    let program = binary::command(&["generate", "gear"]).output().expect("a gear").stdout;
    let program = String::from_utf8(program).expect("text");
    let numbers = |words: &[&str]| -> Vec<u64> {
        let (svg, _) = plot("gear.3b", &program, words);
        svg.words().iter().filter_map(|word| word.parse().ok()).collect()
    };
    let mut fifty = numbers(&["--numbers", "50"]);
    fifty.sort_unstable();
    assert_eq!(fifty, [1, 50, 100, 150, 200, 250]);
    assert_eq!(numbers(&["--numbers", "0"]), [0u64; 0]);
    let own = numbers(&[]);
    assert!((10..=45).contains(&own.len()) && own.iter().all(|n| *n == 1 || n % 10 == 0), "{own:?}");
    // A number stands by its block: block 1 is the lead-in.
    let (svg, _) = plot("gear.3b", &program, &["--numbers", "1"]);
    let first = svg.marks.iter().find(|mark| mark.says.as_deref() == Some("1")).expect("a number 1");
    let at = Bounds::of(first.points());
    let lead_in = svg.of("lead-in").next().expect("a lead-in");
    assert!(lead_in.distance([at.min[0], at.min[1]]) < 0.5, "{at:?}");
}

#[test]
fn the_scale_bar_is_as_long_as_it_says() {
    for (name, program) in [("plate.nc", PLATE), ("holes.3b", HOLES)] {
        let (svg, _) = plot(name, program, &[]);
        let bar = svg.bounds("scale-bar");
        let words = svg.words();
        let said =
            words.iter().find_map(|word| word.strip_suffix(" mm")?.parse::<f64>().ok()).expect("a length");
        assert!((bar.max[0] - bar.min[0] - said).abs() < 1e-3, "{bar:?} says {said}");
    }
}

/// The places the wire stands on, as the mock's interpolators run a program, µm.
fn pulses(model: Model, program: &str) -> Vec<[i64; 2]> {
    let mut at = [0, 0];
    let mut places = vec![at];
    for line in program.lines().filter(|line| line.starts_with('B')) {
        let from = at;
        run(model, &parse_block(line).expect("a block"), |x, y| {
            at = [from[0] + x, from[1] + y];
            places.push(at);
        })
        .expect("it runs");
    }
    places
}

#[test]
fn the_simulated_cut_is_the_mocks_and_its_largest_deviation_is_marked_where_it_is() {
    const CIRCLE: &str = "B9900B0B039600GYNR1\nDD\n";
    for (name, model) in [("rotated", Model::Rotated), ("strict", Model::Strict), ("exact", Model::Exact)] {
        let (svg, report) = plot("circle.3b", CIRCLE, &["--interpolator", name]);
        let places = pulses(model, CIRCLE);
        let thinned = report["thinned_um"].as_f64().expect("a number");
        let cut = svg.of("cut").next().expect("a cut");
        let off = |place: &[i64; 2]| (length((place[0] + 9900) as f64, place[1] as f64) - 9900.0).abs();
        for place in places.iter().step_by(61) {
            let distance = cut.distance(place.map(|v| v as f64 / 1000.0)) * 1000.0;
            assert!(distance <= thinned + 0.2, "{name}: {place:?} is {distance} µm off");
        }
        // Which pulses these are depends on the model, so the farthest one does too.
        let worst = places.iter().map(off).fold(0.0, f64::max);
        let told = report["deviation"]["um"].as_f64().expect("a number");
        assert!((told - worst).abs() < 0.01, "{name}: {told} for {worst}");
        let at = ["x_mm", "y_mm"].map(|key| report["deviation"][key].as_f64().expect("a number"));
        let place = at.map(|v| (v * 1000.0).round() as i64);
        assert!(places.contains(&place) && (off(&place) - worst).abs() < 0.01, "{name}: {place:?}");
        let ring = svg.of("callout").next().expect("a ring");
        let ring = Bounds::of(ring.points());
        let middle = [0, 1].map(|axis| (ring.min[axis] + ring.max[axis]) / 2.0);
        assert!(length(middle[0] - at[0], middle[1] - at[1]) < 1e-3, "{name}: {middle:?} for {at:?}");
        assert!(svg.words().contains(&format!("largest deviation {told:.2} µm, block 1").as_str()));
        assert_eq!(report["pulses"].as_u64(), Some(places.len() as u64 - 1));
    }
    let (svg, report) = plot("circle.3b", CIRCLE, &["--no-simulation"]);
    assert!(svg.of("cut").next().is_none() && report["deviation"].is_null());
}

#[test]
fn a_way_between_two_pauses_of_a_3b_program_is_drawn_as_rapid_and_each_hole_has_its_start() {
    let (svg, _) = plot("holes.3b", HOLES, &[]);
    assert!(svg.bounds("rapid").off_um(&bounds([0.0, 0.0], [40.0, 0.0])) <= 0.1);
    assert!(svg.bounds("nominal").off_um(&bounds([5.0, -9.9], [64.8, 9.9])) <= 0.1);
    assert_eq!(svg.of("start").count(), 2);
    let between = [32.0, 0.0];
    assert!(svg.of("cut").all(|mark| mark.distance(between) > 5.0), "nothing is cut there");
}

#[test]
fn the_wire_of_a_4b_program_is_drawn_where_the_keyed_in_offset_puts_it() {
    // A die 10 mm wide with corners of 1 mm, led into from inside; the way back is the way there.
    let die = "B0B4000B4000GYL4\nB4000B0B4000GXL1\nB0B1000B1000B1000DGYNR4\nB0B8000B8000GYL2\nB1000B0B1000B1000DGXNR1\n\
               B8000B0B8000GXL3\nB0B1000B1000B1000DGYNR2\nB0B8000B8000GYL4\nB1000B0B1000B1000DGXNR3\n\
               B4000B0B4000GXL1\nB0B4000B4000GYL2\nDD\n";
    let wire = |words: &[&str]| {
        let (svg, _) = plot("die.4b", die, words);
        let width = svg.of("wire").find_map(|mark| mark.pen).expect("a wire");
        (Bounds::of(svg.of("wire").flat_map(Mark::points)), width)
    };
    for (f, width) in [("-0.12", 0.24), ("0.07", 0.14)] {
        let by: f64 = f.parse().unwrap();
        let (found, pen) = wire(&["--offset", f]);
        let expected = bounds([-5.0 - by, -4.0 - by], [5.0 + by, 6.0 + by]);
        assert!(found.off_um(&expected) < 1.0, "{f}: {found:?}");
        assert!((pen - width).abs() < 1e-9, "{f}: {pen}");
    }
    // Without it the programmed path is all that is known.
    assert!(wire(&[]).0.off_um(&bounds([-5.0, -4.0], [5.0, 6.0])) < 1.0);
}

#[test]
fn a_program_of_very_many_blocks_makes_a_picture_of_at_most_5_mb_that_is_as_large_as_its_part() {
    // A closed wave round a circle, every block another; 300 000 of them, and one contour.
    let count = 300_000i64;
    let node = |n: i64| {
        #[expect(clippy::disallowed_methods, reason = "any numbers will do")]
        let (sin, cos) = (std::f64::consts::TAU * (n % count) as f64 / count as f64).sin_cos();
        let radius = if n % 2 == 0 { 100_000.0 } else { 99_990.0 + (n % 7) as f64 };
        [(radius * cos).round() as i64, (radius * sin).round() as i64]
    };
    let mut program = String::new();
    let mut at = [0, 0];
    let mut nodes = vec![[0.0, 0.0]];
    for n in 0..count {
        let (from, to) = (node(n), node(n + 1));
        let (x, y) = (to[0] - from[0], to[1] - from[1]);
        let quadrant = match (x, y) {
            (1.., 0..) => 1,
            (..=0, 1..) => 2,
            (..0, ..=0) => 3,
            _ => 4,
        };
        let (x, y) = (x.abs(), y.abs());
        let (j, g) = if x > y { (x, 'X') } else { (y, 'Y') };
        let block = format!("B{x}B{y}B{j:06}G{g}L{quadrant}");
        // Where a control ends up decides, not the numbers: a tie of 45° ends a micron aside.
        let travel = run(Model::Rotated, &parse_block(&block).expect("a block"), |_, _| {}).expect("it runs");
        at = [at[0] + travel.dx, at[1] + travel.dy];
        nodes.push(at.map(|v| v as f64 / 1000.0));
        program.push_str(&block);
        program.push('\n');
    }
    program.push_str("DD\n");
    let (svg, report) = plot("wave.3b", &program, &[]);
    assert!(report["bytes"].as_u64().expect("a number") <= 5_000_000, "{report}");
    let off = svg.bounds("nominal").off_um(&Bounds::of(nodes));
    assert!(off <= 1.0, "{off} µm");
}

#[test]
fn the_png_shows_the_same_picture() {
    let directory = TempDir::new().expect("a directory");
    let words = ["--pixels", "600", "--wire", "0", "--numbers", "0"];
    let (png, _) = written(&directory, "holes.3b", HOLES, "out.png", &words);
    let (svg, _) = plot("holes.3b", HOLES, &words);
    let image = tiny_skia::Pixmap::decode_png(&png).expect("a PNG");
    assert_eq!(image.width(), 600);
    let [left, bottom, width, height] = svg.view;
    let scale = 600.0 / width;
    assert!((f64::from(image.height()) - height * scale).abs() <= 1.0);
    let darkest = |[x, y]: [f64; 2]| {
        let (x, y) = ((x - left) * scale, (bottom + height - y) * scale);
        let around = (-2..=2).flat_map(|dx| (-2..=2).map(move |dy| (x as i32 + dx, y as i32 + dy)));
        around.map(|(x, y)| image.pixel(x as u32, y as u32).expect("in it").red()).min().expect("some")
    };
    assert!(darkest([14.9, 9.9]) < 128 && darkest([54.9, -9.9]) < 128, "the circles are there");
    assert!(darkest([14.9, 5.0]) > 200 && darkest([35.0, 5.0]) > 200, "and nothing where nothing is");
}

fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}
