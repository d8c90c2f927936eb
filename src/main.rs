//! scratch
use dripfeed::part::*;
use dripfeed::rounding::audit::Audit;
use dripfeed::rounding::Aim;
use dripfeed::shapes::cycloid_gear::*;
fn run(name: &str, part: Part) {
    let t = std::time::Instant::now();
    let p = match part.prepare() { Ok(p) => p, Err(e) => { println!("{name}: {e}"); return } };
    let mut a = Audit::new(p.origin());
    let elements = p.element_count();
    for m in p.blocks() { a.add(&m).unwrap(); }
    let dt = t.elapsed().as_secs_f64();
    print!("{name}: {elements} el {} bl {:.2} M/s", a.blocks, a.blocks as f64 / dt / 1e6);
    for (m, d) in a.deviations() { print!(" {} {:.2}/{:.2}", m.name(), d.node_um, d.closure_um) }
    println!();
}
fn main() {
    let base = Part { repeat: 200, ..Part::default() };
    run("paper", Part { rounding: Rounding::PerBlock, repeat: 1, ..base.clone() });
    for aim in ["rotated", "mirrored", "strict", "exact", "any"] {
        let aim = aim_named(aim).unwrap();
        run(aim_name(aim), Part { aim, ..base.clone() });
        run("  once", Part { aim, repeat: 1, ..base.clone() });
        run("  z17", Part { aim, gear: CycloidGear { teeth: 17, module: 1.0, ..CycloidGear::default() }, ..base.clone() });
        run("  z120", Part { aim, offset: -0.1, gear: CycloidGear { teeth: 120, module: 0.2, tip_radius: 0.03, ..CycloidGear::default() }, ..base.clone() });
        run("  z8", Part { aim, offset: 0.01, gear: CycloidGear { teeth: 8, module: 0.15,kp:1.6, ..CycloidGear::default() }, ..base.clone() });
        run("  z5000", Part { aim, repeat: 4, gear: CycloidGear { teeth: 5000, ..CycloidGear::default() }, ..base.clone() });
        run("  z10 m20", Part { aim, repeat: 4, gear: CycloidGear { teeth: 10, module: 20., ..CycloidGear::default() }, ..base.clone() });
        run("  z100 m20", Part { aim, repeat: 4, gear: CycloidGear { teeth: 100, module: 20., ..CycloidGear::default() }, ..base.clone() });
    }
}
