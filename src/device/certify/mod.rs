//! Certifies a device: tries it as its maker would fear, and says what held.
//!
//! ```text
//! checks ── says, wants ── client ── bytes ── Line ── the driver, or a device in virtual time
//!    └── predict: what is right    └── watch: what must hold in all that comes
//! ```
//!
//! The client speaks packets, good and bad, and trusts no clock but the device's: between two
//! PONGs it knows when something was heard, and STATUS tells what came of it. Where host or link
//! were too late to tell, a check is tried again; what cannot be told after that is not tested,
//! never passed. It knows nothing of folders and terminals.

mod answers;
mod checks;
mod client;
mod line;
mod link_times;
mod moments;
mod predict;
mod report;
mod say;
mod speech;
mod store;
mod tally;
#[cfg(test)]
mod tests;
mod verdict;
mod visit;
mod watch;

use std::sync::atomic::AtomicBool;

use checks::{Check, When};
use client::Client;
pub use line::{Line, VirtualLine};
pub use report::{Certificate, CheckOutcome, CheckResult};
pub use store::CertificateFolder;
use verdict::{Trouble, Verdict};

/// How often a check is tried when host or link were late.
const N_TRIES: u32 = 8;
/// All of it ends within a minute of the host's time, the last STOP included.
const LONGEST_US: u64 = 57_000_000;
/// How long a device may take to answer the first HELLO, µs.
const HANDSHAKE_US: u64 = 5_000_000;

/// How much of a device is tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// The quick half, a few seconds: what a user runs before a session.
    Quick,
    /// Everything.
    Full,
}

/// What is tried: how much, and the session numbers that it begins with.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// How much.
    pub extent: Extent,
    /// Where session numbers and tokens begin; another one for every trial.
    pub nonce: u32,
}

impl Certificate {
    /// Tries the device at the end of a line. `progress` hears the name of each section as it
    /// begins. Whatever happens, the last thing that the device hears is a STOP.
    pub fn of(
        line: &mut dyn Line,
        trial: Trial,
        stop: &AtomicBool,
        progress: &mut dyn FnMut(&str),
    ) -> Self {
        let end_us = line.now_us() + LONGEST_US;
        let mut client = Client::new(line, trial.nonce, end_us, stop);
        let opened = client.open(HANDSHAKE_US);
        let hello = [
            "handshake",
            "HELLO",
            "CAPS with the session of HELLO within 5 s",
        ];
        let mut results = vec![result(hello, &opened, 0)];
        let mut over = opened.err().map(|trouble| reason_of(&trouble));
        let mut section = "";
        for check in
            checks::all().filter(|check| check.when != When::Full || trial.extent == Extent::Full)
        {
            if section != check.section && over.is_none() {
                section = check.section;
                progress(section);
            }
            let (verdict, device_ms) = match &over {
                None => try_check(&mut client, check),
                Some(reason) => (Err(Trouble::Untested(reason.clone())), 0),
            };
            // No host would go on with a device that is refused by its CAPS.
            if matches!(verdict, Err(Trouble::Over(_)))
                || (check.when == When::First && matches!(verdict, Err(Trouble::Wrong(_))))
            {
                over = Some(format!("nothing more was tried: {}", came_of(&verdict)));
            }
            let names = [check.section, check.name, check.expects];
            results.push(result(names, &verdict, device_ms));
        }
        let ended = match over {
            None => client.end(),
            Some(reason) => {
                client.line.check(&reason);
                client.rest().and(Err(Trouble::Untested(reason)))
            }
        };
        results.push(result(["STOP", "the last STOP", "ACK 0"], &ended, 0));
        Self::new(&client.caps, trial.extent == Extent::Full, results)
    }
}

/// The verdict of a check, and how long it took, ms of the device's clock.
fn try_check(client: &mut Client<'_>, check: &Check) -> (Verdict, u64) {
    let from_ms = client.device_ms();
    let mut verdict = Err(Trouble::Late);
    for _ in 0..N_TRIES {
        client.line.check(check.name);
        let tried = client
            .begin_check()
            .and_then(|()| (check.run)(client))
            .and_then(|()| client.end_check());
        match tried {
            // A device that was wrong once is not right because host and link were late later.
            Err(Trouble::Late) => {}
            Err(Trouble::Wrong(what)) if client.times.is_late => {
                verdict = Err(Trouble::Wrong(what));
            }
            done => {
                verdict = done;
                break;
            }
        }
    }
    let came = came_of(&verdict);
    client.line.check(&format!("{}: {came}", check.name));
    (verdict, client.device_ms().saturating_sub(from_ms))
}

fn result([section, name, expected]: [&str; 3], verdict: &Verdict, device_ms: u64) -> CheckResult {
    CheckResult {
        section: section.to_owned(),
        name: name.to_owned(),
        outcome: match verdict {
            Ok(()) => CheckOutcome::Passed,
            Err(Trouble::Wrong(_)) => CheckOutcome::Failed,
            Err(_) => CheckOutcome::NotTested,
        },
        expected: expected.to_owned(),
        came: came_of(verdict),
        device_ms,
    }
}

fn came_of(verdict: &Verdict) -> String {
    match verdict {
        Ok(()) => String::from("as expected"),
        Err(trouble) => reason_of(trouble),
    }
}

fn reason_of(trouble: &Trouble) -> String {
    match trouble {
        Trouble::Wrong(what) | Trouble::Untested(what) | Trouble::Over(what) => what.clone(),
        Trouble::Late => format!("host or link were too late to tell, {N_TRIES} times running"),
    }
}
