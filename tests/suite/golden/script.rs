//! Commands run one after the other in one folder, told as one text: what was typed, what was said,
//! what was written.

use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::Stdio;

use super::compare::{Golden, PART};
use super::condense::{condensed, hash};
use crate::program::{Lab, Outcome};

/// Commands and what came of them.
pub(super) struct Script {
    pub(super) lab: Lab,
    described: String,
    unsteady: fn(&str) -> String,
}

impl Script {
    /// Commands in a folder.
    pub(super) fn in_lab(lab: Lab) -> Self {
        Self {
            lab,
            described: String::new(),
            unsteady: str::to_owned,
        }
    }

    /// Passes every line through a function that takes away what is another every time.
    pub(super) fn steadied_by(mut self, unsteady: fn(&str) -> String) -> Self {
        self.unsteady = unsteady;
        self
    }

    /// Runs a command of words without spaces in them.
    pub(super) fn run(&mut self, line: &str) -> &mut Self {
        self.run_on(line, "")
    }

    /// Runs a command that reads these lines.
    pub(super) fn run_on(&mut self, line: &str, typed: &str) -> &mut Self {
        let words: Vec<&str> = line.split_whitespace().collect();
        let mut command = self.lab.command(&words);
        let command = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        // A command that reads nothing may have ended before.
        drop(child.stdin.take().unwrap().write_all(typed.as_bytes()));
        let outcome = Outcome::of(&child.wait_with_output().unwrap());
        self.describe(&words.join(" "), &outcome);
        self
    }

    /// Tells what came of a command.
    pub(super) fn describe(&mut self, line: &str, outcome: &Outcome) {
        let Outcome { code, out, err } = outcome;
        let mut text = format!("exit {code}\n");
        if !err.is_empty() {
            write!(text, "--- stderr\n{err}--- stdout\n").unwrap();
        }
        text.push_str(out);
        self.part(&format!("$ selvedge {line}"), &text);
    }

    /// Tells what a file holds.
    pub(super) fn file(&mut self, name: &str) -> &mut Self {
        let path = self.lab.path(name);
        let text = content(&path, |text| self.steady(text));
        self.part(name, &text);
        self
    }

    /// Tells what all files of a folder hold.
    pub(super) fn folder(&mut self, name: &str) -> &mut Self {
        for file in files_in(&self.lab.path(name)) {
            self.file(&format!("{name}/{file}"));
        }
        self
    }

    /// Tells something of a file.
    pub(super) fn note(&mut self, name: &str, text: &str) {
        self.part(&format!("{name}, in part"), text);
    }

    /// Compares all that was told.
    pub(super) fn compare(&self, golden: &mut Golden, name: &str) {
        golden.text(name, &self.described);
    }

    /// A text without what depends on place, version and clock.
    fn steady(&self, text: &str) -> String {
        let place = self.lab.path("").display().to_string();
        let text = text
            .replace(place.trim_end_matches('/'), "LAB")
            .replace(env!("CARGO_PKG_VERSION"), "VERSION");
        let steady = |line: &str| match line.strip_suffix('\n') {
            Some(line) => (self.unsteady)(line) + "\n",
            None => (self.unsteady)(line),
        };
        text.split_inclusive('\n').map(steady).collect()
    }

    /// A part of what is told, steady.
    fn part(&mut self, head: &str, text: &str) {
        let mut head = format!("{PART}{head}\n");
        while self.described.contains(&head) {
            head.insert_str(head.len() - 1, " (again)");
        }
        self.described.push_str(&head);
        for line in self.steady(text).lines() {
            // A line of the text may look as the beginning of a part.
            writeln!(self.described, "{}", line.replace(PART.trim_end(), "= = =")).unwrap();
        }
    }
}

/// Every file below a folder by its place in it, in order.
pub(super) fn files_in(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            let inner = files_in(&path).into_iter();
            found.extend(inner.map(|file| format!("{name}/{file}")));
        } else {
            found.push(name);
        }
    }
    found.sort();
    found
}

/// A file as text that was made steady: what is no text, and drawings, by size and hash.
fn content(path: &Path, steady: impl Fn(&str) -> String) -> String {
    let bytes = fs::read(path).unwrap();
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    if ending == "png" {
        // How pixels are packed is no matter.
        let picture = image::load_from_memory(&bytes).unwrap();
        let hash = hash(picture.as_bytes());
        return format!("{} × {} px, {hash}", picture.width(), picture.height());
    }
    match String::from_utf8(bytes) {
        Err(error) => {
            let bytes = error.into_bytes();
            format!("{} bytes, {}", bytes.len(), hash(&bytes))
        }
        Ok(text) => {
            let steady = steady(&text);
            match ending.as_ref() {
                "svg" => format!(
                    "{} lines, {}",
                    text.lines().count(),
                    hash(steady.as_bytes())
                ),
                _ => condensed(&steady),
            }
        }
    }
}
