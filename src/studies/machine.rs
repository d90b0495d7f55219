//! The machine and the program that a report was made with: times are theirs.

use std::fs;
use std::thread;
use std::time::{SystemTime, UNIX_EPOCH};

use selvedge_foundation::quantity;

/// What times were measured on, and with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Machine {
    /// The processor's name, where the system tells.
    pub(crate) cpu: String,
    /// Threads that run at once.
    pub n_cores: usize,
    /// Operating system and architecture.
    pub system: String,
    /// The program and its version.
    pub program: String,
    /// What compiled it, as far as it is known.
    pub compiler: String,
    /// Whether it was compiled without optimisation, so that times say little.
    pub(crate) is_debug: bool,
}

impl Machine {
    /// This machine and this program.
    pub(crate) fn here() -> Self {
        let release = first_line("/proc/sys/kernel/osrelease").unwrap_or_default();
        let (os, arch) = (std::env::consts::OS, std::env::consts::ARCH);
        Self {
            cpu: cpu_model().unwrap_or_else(|| "unknown processor".to_owned()),
            n_cores: thread::available_parallelism().map_or(1, usize::from),
            system: format!("{os} {release} {arch}").replace("  ", " "),
            program: selvedge_foundation::PROGRAM.to_owned(),
            compiler: option_env!("RUSTUP_TOOLCHAIN").map_or_else(
                || format!("Rust {} or later", env!("CARGO_PKG_RUST_VERSION")),
                |toolchain| format!("Rust {toolchain}"),
            ),
            is_debug: cfg!(debug_assertions),
        }
    }
}

fn cpu_model() -> Option<String> {
    let text = fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|line| line.starts_with("model name"))?;
    let (_, name) = line.split_once(':')?;
    Some(name.split_whitespace().collect::<Vec<_>>().join(" "))
}

fn first_line(path: &str) -> Option<String> {
    let text = fs::read_to_string(path).ok()?;
    text.lines().next().map(str::to_owned)
}

/// The date and time now, UTC: `2026-03-01 14:05 UTC`.
pub(super) fn now_utc() -> String {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    let s = since.map_or(0, |since| since.as_secs());
    let (days, minutes) = (s / 86_400, s / 60 % 1440);
    let (year, month, day) = quantity::date_of(days);
    format!(
        "{year:04}-{month:02}-{day:02} {:02}:{:02} UTC",
        minutes / 60,
        minutes % 60
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_machine_has_a_core_and_a_name() {
        let machine = Machine::here();
        assert!(
            machine.n_cores >= 1 && !machine.cpu.is_empty(),
            "{machine:?}"
        );
        assert!(machine.program.starts_with("selvedge "), "{machine:?}");
    }
}
