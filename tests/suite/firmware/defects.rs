//! The core with one defect each: all build, all are found, and the core without one is not.
//!
//! The golden sessions are tried first; what they do not know, random scripts find by comparison
//! with our own device.

use std::process::Command;

use selvedge_device::DeviceModel;

use super::differential::first_difference;
use super::reference::CCore;
use super::tools;
use crate::program::Lab;

/// Random scripts that a defect must not survive; the core itself survives as many.
const N_SCRIPTS: u64 = 60;

/// The table of `hbp_defects.h`: the name of each defect, whose number is its place, from 1 on.
pub(crate) fn names() -> Vec<String> {
    let path = tools::kit().join("firmware/hbp_defects.h");
    let text = std::fs::read_to_string(path).unwrap();
    let mut names = Vec::new();
    for line in text.lines() {
        // "    CRC_UNREAD = 1,   /* a packet with a wrong CRC is taken */"
        let Some((name, rest)) = line.trim().split_once(" = ") else {
            continue;
        };
        let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
        names.push(name.to_owned());
        assert_eq!(digits.parse(), Ok(names.len()), "{line}");
        assert!(
            line.contains("/* ") && line.ends_with(" */"),
            "what is broken? {line}"
        );
    }
    names
}

/// Whether a build answers as it must: the golden sessions and the random scripts.
fn difference(defect: usize) -> Option<String> {
    let program = tools::host_with_defect(defect);
    let vectors = tools::kit().join("vectors.txt");
    let output = Command::new(&program).arg(vectors).output().unwrap();
    if !output.status.success() {
        return Some(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    let mut core = CCore::start(&program);
    first_difference(&mut core, &DeviceModel::default(), N_SCRIPTS).err()
}

#[test]
fn every_defect_of_the_core_is_found_and_the_core_without_one_is_not() {
    if !tools::has("cc", "the defects of the core in C") {
        return;
    }
    let names = names();
    assert!(names.len() >= 30, "{} defects", names.len());
    assert_eq!(difference(0), None);
    std::thread::scope(|scope| {
        for half in [0, 1] {
            let names = &names;
            scope.spawn(move || {
                for defect in (1..=names.len()).filter(|defect| defect % 2 == half) {
                    let name = &names[defect - 1];
                    assert!(
                        difference(defect).is_some(),
                        "{name} ({defect}) is not found"
                    );
                }
            });
        }
    });
}

/// Each rule that can be broken stands in one place, and stands there in a build that is not asked
/// to break one.
#[test]
fn every_defect_has_one_place_in_the_core() {
    let path = tools::kit().join("firmware/hbp_core.c");
    let source = std::fs::read_to_string(path).unwrap();
    let names = names();
    for name in &names {
        let n_places = source.matches(&format!("DEFECT({name})")).count();
        assert_eq!(n_places, 1, "{name}");
    }
    assert_eq!(
        source.matches("DEFECT(").count(),
        names.len() + 1,
        "one in a comment"
    );
}

/// In a build that is not asked for a defect, the places of the rules compile to what they were
/// before they were marked.
#[test]
fn a_core_without_a_defect_has_nothing_of_the_others_in_it() {
    if !tools::has("cc", "the object code of the core in C") {
        return;
    }
    let lab = Lab::new();
    let object = |name: &str, more: &[&str]| {
        let object = lab.path(name);
        let source = tools::kit().join("firmware/hbp_core.c");
        let mut args: Vec<String> = ["-std=c99", "-O1", "-c", "-o"].map(String::from).to_vec();
        args.extend([object.display().to_string(), source.display().to_string()]);
        args.extend(more.iter().map(|arg| String::from(*arg)));
        tools::compile("cc", &args);
        std::fs::read(object).unwrap()
    };
    let shipped = object("shipped.o", &[]);
    assert!(shipped == object("bare.o", &["-DHBP_DEFECTS_H", "-DDEFECT(name)=0"]));
    assert!(shipped != object("defect.o", &["-DHBP_DEFECT=1"]));
}
