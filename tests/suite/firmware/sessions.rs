//! The golden sessions: what a device answers, on ours and on the core in C.

use std::process::Command;

use selvedge_device::DeviceModel;

use super::reference::{Obedient as _, OurCore, bytes, hex};
use super::{tools, vectors};
use crate::program::Lab;

/// A session in progress.
struct Run {
    name: String,
    device: OurCore,
    /// The last answer.
    state: String,
    sent: Vec<u8>,
    /// Packets said in words since the last bytes.
    said: Vec<u8>,
    n_checks: usize,
}

impl Run {
    fn line(&mut self, line: &str) {
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        match word {
            "say" => self.said.extend(vectors::wire_of(rest)),
            "in" => {
                self.words_are(&bytes(rest), line);
                self.obey(line);
            }
            "out" => {
                self.words_are(&bytes(rest), line);
                let sent = std::mem::take(&mut self.sent);
                self.holds(line, &hex(&sent), &hex(&bytes(rest)));
            }
            "state" => {
                let state = self.state.clone();
                self.holds(line, &state, rest);
            }
            "drive" => self.drive(line, rest),
            _ => self.obey(line),
        }
    }

    fn obey(&mut self, line: &str) {
        let answer = self.device.obey(line);
        let (state, sent) = answer.rsplit_once(' ').unwrap();
        state.clone_into(&mut self.state);
        self.sent.extend(bytes(sent));
    }

    fn drive(&mut self, line: &str, rest: &str) {
        let mut numbers = rest.split_whitespace();
        let channel: usize = numbers.next().unwrap().parse().unwrap();
        let [low, high] = self.device.output()[channel];
        let wanted: Vec<&str> = numbers.collect();
        self.holds(line, &format!("{low} {high}"), &wanted.join(" "));
    }

    fn holds(&mut self, line: &str, found: &str, wanted: &str) {
        self.n_checks += 1;
        assert_eq!(found, wanted, "session {}: {line}", self.name);
    }

    /// What was said in words is what stands in hex; bytes without words are taken as they are.
    fn words_are(&mut self, wire: &[u8], line: &str) {
        let said = std::mem::take(&mut self.said);
        if !said.is_empty() {
            assert_eq!(hex(&said), hex(wire), "session {}: {line}", self.name);
        }
    }
}

#[test]
fn our_device_answers_the_golden_sessions_byte_by_byte() {
    let sessions = vectors::read().sessions;
    assert!(sessions.len() >= 15, "{}", sessions.len());
    for (name, lines) in sessions {
        let mut run = Run {
            name,
            device: OurCore::new(DeviceModel::default()),
            state: String::from("IDLE 0"),
            sent: Vec::new(),
            said: Vec::new(),
            n_checks: 0,
        };
        for line in lines {
            run.line(&line);
        }
        assert!(run.n_checks > 1, "{} checks hardly anything", run.name);
    }
}

#[test]
fn the_core_in_c_answers_the_golden_sessions_byte_by_byte() {
    if !tools::has("cc", "the golden sessions on the core in C") {
        return;
    }
    let lab = Lab::new();
    let program = lab.path("hbp_host");
    tools::build_host(&program, &[]);
    let path = tools::kit().join("vectors.txt");
    let output = Command::new(&program).arg(&path).output().unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{said}");
    let n_sessions = vectors::read().sessions.len();
    let summary = format!("{n_sessions} sessions, ");
    assert!(
        said.starts_with(&summary) && said.ends_with(" 0 wrong\n"),
        "{said}"
    );
}
