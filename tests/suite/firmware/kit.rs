//! The kit as the program writes it: whole, and good enough to build and check by itself.

use std::process::Command;

use super::tools;
use crate::program::Lab;

#[test]
fn the_kit_that_the_program_writes_checks_itself() {
    let lab = Lab::new();
    let said = lab.print(&["bridge", "kit", "--out", "kit"]);
    assert!(said.contains("files in kit"), "{said}");
    for name in ["protocol.md", "vectors.txt", "firmware/hbp_core.c"] {
        let shipped = std::fs::read_to_string(tools::kit().join(name)).unwrap();
        assert_eq!(lab.read(&format!("kit/{name}")), shipped, "{name}");
    }
    assert!(lab.read("kit/LICENSE-MIT").contains("MIT License"));
    assert!(lab.read("kit/LICENSE-APACHE").contains("Apache License"));
    if tools::has("cc", "the kit's own check") && tools::has("make", "the kit's own check") {
        let mut make = Command::new("make");
        make.args(["-C", "firmware/host", "check"]);
        let output = make.current_dir(lab.path("kit")).output().unwrap();
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(
            output.status.success() && said.contains(" 0 wrong"),
            "{said}"
        );
    }
}

#[test]
fn a_kit_is_not_written_over_anything() {
    let lab = Lab::new();
    lab.write("kit/notes.txt", "mine");
    let line = lab.refuse(&["bridge", "kit", "--out", "kit"]);
    assert!(line.contains("not empty"), "{line}");
    assert_eq!(lab.read("kit/notes.txt"), "mine");
    assert!(!lab.path("kit/protocol.md").exists());
    lab.refuse(&["bridge", "kit", "--out", "kit/notes.txt"]);
}

/// The core is what a person reads in an hour, and stands alone; every other file takes minutes.
#[test]
fn the_core_in_c_is_short_and_needs_no_library() {
    let firmware = tools::kit().join("firmware");
    let read = |name: &str| std::fs::read_to_string(firmware.join(name)).unwrap();
    let sources = ["hbp_core.c", "hbp_core.h", "hbp_defects.h"].map(read);
    let n_lines = sources[0].lines().count();
    assert!(n_lines <= 600, "{n_lines} lines");
    for text in &sources {
        assert!(text.contains("SPDX-License-Identifier: MIT OR Apache-2.0"));
        let includes = text.lines().filter(|line| line.starts_with("#include"));
        for include in includes {
            let known = ["hbp_core.h", "hbp_config.h", "hbp_defects.h", "<stdint.h>"];
            assert!(known.iter().any(|name| include.contains(name)), "{include}");
        }
        assert!(text.lines().all(|line| line.len() <= 100));
    }
}
