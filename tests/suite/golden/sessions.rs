//! One simulated session of every design that is shipped, and its whole analysis.

use super::compare::Golden;
use super::script::Script;
use crate::program::Lab;

fn compare(golden: &mut Golden, design: &str) {
    let mut script = Script::in_lab(Lab::named("session"));
    script
        .run(&format!(
            "experiment simulate {design} --observers 2 --seed 7 --out logs"
        ))
        .folder("logs")
        .run("experiment analyse logs --out found --maps 2 --permutations 99 --random-data 2")
        .folder("found");
    script.compare(golden, design);
}

#[test]
fn golden_sessions() {
    let mut golden = Golden::of("sessions");
    let list = Lab::new().print(&["experiment", "designs"]);
    let names = list
        .lines()
        .filter_map(|line| line.split_whitespace().next());
    for design in names {
        compare(&mut golden, design);
    }
    golden.finish();
}
