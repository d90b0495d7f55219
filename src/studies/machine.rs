//! The machine and the program that a report was made with: times are theirs.

use std::fs;
use std::path::Path;
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
    /// What compiled it.
    pub compiler: String,
    /// The commit of the checkout that the program was made in, if it was.
    pub(crate) commit: Option<String>,
    /// What of the processor's instructions the program may use, and what it has.
    pub(crate) instructions: String,
    /// Processes that wanted the machine in the minute before the report, and before its end.
    pub(crate) loads: [Option<String>; 2],
    /// Whether it was compiled without optimisation, so that times say little.
    pub(crate) is_debug: bool,
}

impl Machine {
    /// This machine and this program.
    pub(crate) fn here() -> Self {
        let release = first_line(Path::new("/proc/sys/kernel/osrelease")).unwrap_or_default();
        let (os, arch) = (std::env::consts::OS, std::env::consts::ARCH);
        Self {
            cpu: cpu_model().unwrap_or_else(|| "unknown processor".to_owned()),
            n_cores: thread::available_parallelism().map_or(1, usize::from),
            system: format!("{os} {release} {arch}").replace("  ", " "),
            program: selvedge_foundation::PROGRAM.to_owned(),
            compiler: env!("SELVEDGE_COMPILER").to_owned(),
            commit: Some(env!("SELVEDGE_COMMIT").to_owned()).filter(|commit| !commit.is_empty()),
            instructions: instructions(),
            loads: [load(), None],
            is_debug: cfg!(debug_assertions),
        }
    }

    /// Looks at the machine's load once more.
    pub(crate) fn look_again(&mut self) {
        self.loads[1] = load();
    }
}

/// Instructions that numbers go faster by.
const VECTORS: [&str; 6] = ["sse2", "sse4_2", "avx", "fma", "avx2", "avx512f"];

/// What the program may use of the processor, and what that has beyond.
fn instructions() -> String {
    let used: Vec<&str> = env!("SELVEDGE_TARGET_FEATURES").split(',').collect();
    let flags = cpu_line("flags").unwrap_or_default();
    let flags: Vec<&str> = flags.split(' ').collect();
    let (mut made_for, mut unused) = (Vec::new(), Vec::new());
    for name in VECTORS {
        if used.contains(&name.replace('_', ".").as_str()) {
            made_for.push(name);
        } else if flags.contains(&name) {
            unused.push(name);
        }
    }
    let words = |names: Vec<&str>| match names.as_slice() {
        [] => "none known".to_owned(),
        _ => names.join(", "),
    };
    format!(
        "made for {}; the processor has beyond: {}",
        words(made_for),
        words(unused)
    )
}

/// How many processes wanted to run at once over the last minute.
fn load() -> Option<String> {
    let line = first_line(Path::new("/proc/loadavg"))?;
    line.split(' ').next().map(str::to_owned)
}

fn cpu_model() -> Option<String> {
    cpu_line("model name")
}

/// What the system says of the first processor.
fn cpu_line(key: &str) -> Option<String> {
    let text = fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|line| line.starts_with(key))?;
    let (_, name) = line.split_once(':')?;
    Some(name.split_whitespace().collect::<Vec<_>>().join(" "))
}

fn first_line(path: &Path) -> Option<String> {
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
        assert!(machine.compiler.starts_with("rustc "), "{machine:?}");
        let is_checkout = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../.git")).exists();
        let commit = machine.commit.as_deref();
        let is_hash = commit.is_some_and(|commit| {
            commit.len() == 40 && commit.bytes().all(|byte| byte.is_ascii_hexdigit())
        });
        assert!(is_hash || !is_checkout, "{machine:?}");
    }
}
