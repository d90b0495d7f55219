//! `selvedge doctor`: whether this machine can do what the program needs, and how to mend what it
//! cannot.
//!
//! Every check is a function that gives findings; what is asked of the system is handed to those
//! whose answers are worth a test. Nothing is changed: no file is set aside, no port opened.

mod machine;
mod program;
#[cfg(test)]
mod tests;

use std::fmt;
use std::path::Path;

use clap::Args;
use serde::Serialize;

use super::{CliError, output};
use selvedge_foundation::PROGRAM;
use selvedge_foundation::files::to_json_string;

/// How the findings are told.
#[derive(Debug, Args)]
pub(super) struct DoctorArgs {
    /// As JSON, for other programs
    #[arg(long)]
    json: bool,
}

/// How it stands with something.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
enum State {
    /// As it should be.
    Ok,
    /// The program does without, or not as well.
    Note,
    /// Something does not work that is expected to.
    Wrong,
}

impl State {
    fn word(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Note => "note",
            Self::Wrong => "WRONG",
        }
    }
}

/// What was found of one thing.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
struct Finding {
    name: &'static str,
    state: State,
    /// What there is, or what is wrong and how to mend it.
    what: String,
}

impl Finding {
    fn new(name: &'static str, state: State, what: impl Into<String>) -> Self {
        let what = what.into();
        Self { name, state, what }
    }

    /// What there is, or an error's own words.
    fn of(name: &'static str, outcome: Result<String, impl fmt::Display>) -> Self {
        match outcome {
            Ok(what) => Self::new(name, State::Ok, what),
            Err(error) => Self::new(name, State::Wrong, error.to_string()),
        }
    }

    fn line(&self) -> String {
        format!(
            "{:<10} {:<5}  {}\n",
            self.name,
            self.state.word(),
            self.what
        )
    }
}

/// All of it, for `--json`.
#[derive(Debug, Serialize)]
struct Told<'a> {
    program: &'static str,
    system: String,
    is_usable: bool,
    findings: &'a [Finding],
}

/// Every check, in the order in which it is told. The display is last: a process can try it once.
const CHECKS: [fn() -> Vec<Finding>; 12] = [
    machine::cores,
    machine::clock,
    machine::own_places,
    machine::arrays,
    machine::stage,
    machine::ports,
    machine::access_rule,
    program::library,
    program::rendering,
    program::emulator,
    program::sound,
    program::display,
];

/// Looks at everything, and tells each finding as it comes.
///
/// # Errors
/// Something does not work that is expected to.
pub(super) fn run(args: &DoctorArgs) -> Result<(), CliError> {
    let mut all = Vec::new();
    for check in CHECKS {
        let findings = check();
        if !args.json {
            let lines: String = findings.iter().map(Finding::line).collect();
            output::print(&lines)?;
        }
        all.extend(findings);
    }
    let n_wrong = n_wrong(&all);
    if args.json {
        let (os, machine) = (std::env::consts::OS, std::env::consts::ARCH);
        let told = Told {
            program: PROGRAM,
            system: format!("{os} {machine}"),
            is_usable: n_wrong == 0,
            findings: &all,
        };
        output::print(&to_json_string(&told, Path::new("findings"))?)?;
    }
    match n_wrong {
        0 => Ok(()),
        1 => Err(CliError::Failed("1 thing is wrong: see above".to_owned())),
        n => Err(CliError::Failed(format!("{n} things are wrong: see above"))),
    }
}

fn n_wrong(findings: &[Finding]) -> usize {
    let wrong = findings.iter().filter(|one| one.state == State::Wrong);
    wrong.count()
}
