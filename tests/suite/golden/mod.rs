//! Golden references: what the program makes today, stored, so that every later difference is
//! either meant and looked at, or a mistake.

mod charts;
mod commands;
mod compare;
mod condense;
#[cfg(unix)]
mod devices;
mod participants;
mod pictures;
mod samples;
mod script;
mod sessions;
mod stage;
mod windows;

use std::path::Path;

/// Every folder of references, each with one test that makes them.
const GROUPS: [&str; 26] = [
    "charts/panes",
    "charts/sheets",
    "commands/devices",
    "commands/drape",
    "commands/experiment",
    "commands/help",
    "commands/import",
    "commands/library",
    "commands/make",
    "commands/picture-and-mds",
    "commands/render",
    "commands/report",
    "commands/report-and-bridge",
    "pictures/analysis",
    "pictures/armed",
    "pictures/drape",
    "pictures/felt",
    "pictures/friction",
    "pictures/made",
    "pictures/overlays",
    "pictures/perspectives",
    "pictures/questions",
    "pictures/ranking",
    "pictures/screenshot",
    "pictures/stage",
    "sessions",
];

#[test]
fn no_reference_lies_where_no_test_looks() {
    for file in script::files_in(Path::new(compare::STORED)) {
        let (group, _) = file.rsplit_once('/').unwrap_or_default();
        let is_known = GROUPS.contains(&group);
        assert!(is_known, "tests/golden/{file}: no test makes this any more");
    }
}
