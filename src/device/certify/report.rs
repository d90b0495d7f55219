//! The certificate: what was tried, what held, and of which device.

use std::fmt::{self, Write as _};
use std::path::Path;
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use crate::array::DeviceUid;
use crate::message::Caps;
use selvedge_foundation::PROGRAM;
use selvedge_foundation::files::{FileError, from_json_str, to_json_string};
use selvedge_foundation::named;
use selvedge_foundation::quantity::rfc3339;

named! {
    /// What became of a check.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum CheckOutcome {
        /// The device did what it must.
        Passed = "passed",
        /// It did something else.
        Failed = "failed",
        /// It could not be told.
        NotTested = "not tested",
    }
    fn name;
}

/// One check.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CheckResult {
    /// Which part of the protocol.
    pub section: String,
    /// What was tried.
    pub name: String,
    /// What became of it.
    pub outcome: CheckOutcome,
    /// What a right device does.
    pub expected: String,
    /// What came, in one line.
    pub came: String,
    /// How long it took by the device's clock, tries included, ms.
    pub device_ms: u64,
}

/// What was found of one device with one firmware.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Certificate {
    /// The program that tried, and its version.
    pub program: String,
    /// When, RFC 3339, UTC.
    pub date: String,
    /// The device, 24 hexadecimal digits; zeros where none answered.
    pub uid: String,
    /// Its firmware, `major.minor.patch`.
    pub firmware: String,
    /// The name in its CAPS.
    pub device_name: String,
    /// Whether everything was tried; otherwise the quick half was.
    pub is_full: bool,
    /// In the order in which they were tried.
    pub checks: Vec<CheckResult>,
}

impl Certificate {
    pub(super) fn new(caps: &Caps, is_full: bool, checks: Vec<CheckResult>) -> Self {
        let [major, minor, patch] = caps.firmware;
        Self {
            program: PROGRAM.to_owned(),
            date: rfc3339(SystemTime::now()),
            uid: DeviceUid(caps.uid).to_string(),
            firmware: format!("{major}.{minor}.{patch}"),
            device_name: caps.name().escape_debug().to_string(),
            is_full,
            checks,
        }
    }

    /// Whether every check passed.
    pub fn passed(&self) -> bool {
        self.checks
            .iter()
            .all(|check| check.outcome == CheckOutcome::Passed)
    }

    /// The first check that did not pass, in one line.
    pub fn first_trouble(&self) -> Option<String> {
        let is_trouble = |check: &&CheckResult| check.outcome != CheckOutcome::Passed;
        let first = self.checks.iter().find(is_trouble)?;
        let outcome = match first.outcome {
            CheckOutcome::NotTested => "was not tested",
            _ => "failed",
        };
        Some(format!(
            "{} \"{}\" {outcome}: {}",
            first.section, first.name, first.came
        ))
    }

    /// Whether it lets a device with this number and firmware be used without a mark: everything
    /// was tried, and all of it passed.
    pub fn covers(&self, uid: DeviceUid, firmware: [u8; 3]) -> bool {
        let [major, minor, patch] = firmware;
        self.is_full
            && self.passed()
            && self.uid == uid.to_string()
            && self.firmware == format!("{major}.{minor}.{patch}")
    }

    /// The name of its files without their ends: device and firmware.
    pub fn file_stem(&self) -> String {
        format!("certificate-{}-{}", self.uid, self.firmware)
    }

    /// The last line: how many checks came out how.
    pub fn verdict(&self) -> String {
        let count = |outcome| {
            self.checks
                .iter()
                .filter(|check| check.outcome == outcome)
                .count()
        };
        let [passed, failed, untested] = [
            CheckOutcome::Passed,
            CheckOutcome::Failed,
            CheckOutcome::NotTested,
        ]
        .map(count);
        let verdict = if self.passed() {
            "passed"
        } else {
            "not passed"
        };
        format!("{verdict}: {passed} checks passed, {failed} failed, {untested} not tested")
    }

    /// The report as Markdown.
    pub fn to_markdown(&self) -> String {
        let mut text = format!(
            "# Certificate of {}\n\n\
             | | |\n|---|---|\n| device | {} |\n| uid | {} |\n| firmware | {} |\n\
             | extent | {} |\n| program | {} |\n| date | {} |\n| verdict | {} |\n",
            self.uid,
            in_cell(&self.device_name),
            self.uid,
            self.firmware,
            if self.is_full {
                "everything"
            } else {
                "the quick half"
            },
            self.program,
            self.date,
            self.verdict()
        );
        let mut section = "";
        for check in &self.checks {
            if check.section != section {
                section = &check.section;
                let head = "| check | outcome | expected | came | device ms |";
                // Writing to a string cannot fail.
                let _head = write!(text, "\n## {section}\n\n{head}\n|---|---|---|---|---|\n");
            }
            let _row = writeln!(
                text,
                "| {} | {} | {} | {} | {} |",
                in_cell(&check.name),
                check.outcome.name(),
                in_cell(&check.expected),
                in_cell(&check.came),
                check.device_ms
            );
        }
        text
    }

    /// The report as JSON; `path` only names the file in errors.
    pub fn to_json(&self, path: &Path) -> Result<String, FileError> {
        to_json_string(self, path)
    }

    /// Reads what [`to_json`](Self::to_json) wrote; `path` only names the file in errors.
    pub fn from_json(text: &str, path: &Path) -> Result<Self, FileError> {
        from_json_str(text, path)
    }
}

/// A check a line, the verdict last.
impl fmt::Display for Certificate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for check in &self.checks {
            write!(
                f,
                "{:<10}  {}: {}",
                check.outcome.name(),
                check.section,
                check.name
            )?;
            if check.outcome != CheckOutcome::Passed {
                write!(f, ": {}; expected: {}", check.came, check.expected)?;
            }
            writeln!(f)?;
        }
        write!(f, "{}", self.verdict())
    }
}

/// Text for a cell of a Markdown table.
fn in_cell(text: &str) -> String {
    text.replace('|', "\\|").replace(['\n', '\r'], " ")
}
