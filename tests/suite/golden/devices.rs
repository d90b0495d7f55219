//! Commands that talk to a device, here an emulated one. It lives in real time: what is said is
//! compared without its numbers, and of logs what their columns are and what happens in them.

use std::collections::BTreeSet;
use std::fs;

use super::compare::Golden;
use super::script::Script;
use crate::bridge_device::Device;
use crate::program::{Lab, Outcome};

/// Every number becomes `#`, and times have one unit.
fn without_numbers(line: &str) -> String {
    let mut text = String::new();
    for letter in line.chars() {
        let is_number = letter.is_ascii_digit() || (letter == '.' && text.ends_with('#'));
        if !is_number {
            text.push(letter);
        } else if !text.ends_with('#') {
            text.push('#');
        }
    }
    let text = text.replace("# µs", "# ms").replace("# ns", "# ms");
    let text = text.replace("# s ", "# ms ").replace("# s,", "# ms,");
    match text.strip_suffix("# s") {
        Some(before) => format!("{before}# ms"),
        None => text,
    }
}

/// What happens, or is told of, only where the machine was busy, or only where it was not.
const OF_LOAD: [&str; 6] = [
    "delays",
    "depth",
    "device-counters",
    "device-log",
    "refused",
    "HOLD",
];

/// The header of a log, and every word that a column holds.
fn words_of(log: &str, column: &str) -> String {
    let mut lines = log.lines().filter(|line| !line.starts_with('#'));
    let header = lines.next().unwrap_or_default();
    let at = header.split(',').position(|name| name == column);
    let at = at.unwrap_or_else(|| panic!("no {column} in {header}"));
    let word = |line: &str| without_numbers(line.split(',').nth(at).unwrap_or_default());
    let words: BTreeSet<String> = lines.map(word).collect();
    let is_steady = |word: &String| !OF_LOAD.contains(&word.as_str());
    let words: Vec<String> = words.into_iter().filter(is_steady).collect();
    format!("{header}\n{column}: {}", words.join(", "))
}

/// What is said where the machine was too busy for a device that lives in real time.
const DISTURBED: [&str; 5] = [
    "no frame reached it",
    "no STATUS",
    "did not",
    "fell silent",
    "disarmed itself",
];
/// Attempts on a busy machine.
const N_ATTEMPTS: usize = 20;

/// Runs a command on a device of its own, again where the machine was too busy.
fn on_device(script: &mut Script, options: &[&str], line: &str) {
    let words: Vec<&str> = line.split_whitespace().collect();
    let attempt = || {
        // A log of a link is written on where there is one.
        for log in ["host.csv", "link.csv", "device.csv"] {
            drop(fs::remove_file(script.lab.path(log)));
        }
        let device = Device::start(&script.lab, options);
        let outcome = script.lab.run(&words);
        device.end(&script.lab);
        let said = format!("{}{}", outcome.out, outcome.err);
        let is_disturbed = DISTURBED.iter().any(|words| said.contains(words));
        (!is_disturbed).then_some(outcome)
    };
    let outcome = (0..N_ATTEMPTS).find_map(|_| attempt());
    let outcome = outcome.expect("a machine that is not too busy");
    let steady = |text: &str| {
        let lines = text
            .lines()
            .map(|line| format!("{}\n", without_numbers(line)));
        lines.collect::<String>()
    };
    let outcome = Outcome {
        code: outcome.code,
        out: steady(&outcome.out),
        err: steady(&outcome.err),
    };
    script.describe(line, &outcome);
}

#[test]
fn golden_devices() {
    let mut golden = Golden::of("commands/devices");
    let mut script = Script::in_lab(Lab::with_scene());
    let answers: Vec<String> = (0..24).map(|channel| channel.to_string()).collect();
    script.lab.write("answers.txt", answers.join("\n"));
    on_device(&mut script, &[], "bridge test --port array");
    let identify = "bridge identify --port array --out rig.toml --answers answers.txt";
    on_device(&mut script, &[], identify);
    script.file("rig.toml");
    let play = "play a.scene.toml --path a.csv --port array --log host.csv";
    on_device(&mut script, &[], &format!("{play} --session-log link.csv"));
    let header = |log: String| log.lines().next().unwrap_or_default().to_owned();
    script.note("host.csv", &header(script.lab.read("host.csv")));
    script.note("link.csv", &words_of(&script.lab.read("link.csv"), "event"));
    script.note(
        "device.csv",
        &words_of(&script.lab.read("device.csv"), "state"),
    );
    on_device(&mut script, &[], &format!("{play} --array 5x5"));
    script.run("play a.scene.toml --path a.csv --port nowhere");
    script.compare(&mut golden, "devices");
    golden.finish();
}
