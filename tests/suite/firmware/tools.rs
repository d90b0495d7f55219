//! The tools that these tests borrow, where the kit lies, and how the core is built.

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Mutex, PoisonError};

/// Where the kit lies.
pub(crate) fn kit() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/bridge")
}

/// Whether `tool` runs. If it does not, says on stderr what is skipped for want of it; directly,
/// because the harness keeps what passing tests print.
pub(crate) fn has(tool: &str, skipped: &str) -> bool {
    let mut command = Command::new(tool);
    command.arg("--version");
    command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    let found = command.status().is_ok_and(|status| status.success());
    if !found {
        let line = format!("skipped: {skipped}: no {tool} here\n");
        std::io::stderr().write_all(line.as_bytes()).unwrap();
    }
    found
}

/// Runs a compiler, which must succeed in silence.
pub(crate) fn compile(compiler: &str, args: &[String]) {
    let output = Command::new(compiler).args(args).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        output.status.success() && said.is_empty(),
        "{compiler} {args:?}:\n{said}"
    );
}

/// Compiles the core and its driver for this machine, with `defines` for `hbp_config.h`; it ends at
/// the first undefined behaviour where the compiler can watch for that.
pub(crate) fn build_host(program: &Path, defines: &[&str]) {
    let args = host_args(program, defines);
    let watched = ["-fsanitize=undefined", "-fno-sanitize-recover=all"].map(String::from);
    let all = [args.as_slice(), &watched].concat();
    let built = Command::new("cc").args(&all).output().unwrap();
    if !built.status.success() {
        compile("cc", &args);
    }
}

/// The core and its driver with one defect (0: none), compiled once in a run of the tests. Must
/// compile without a word.
pub(crate) fn host_with_defect(defect: usize) -> PathBuf {
    static BUILT: Mutex<BTreeMap<usize, PathBuf>> = Mutex::new(BTreeMap::new());
    let mut built = BUILT.lock().unwrap_or_else(PoisonError::into_inner);
    let program = built.entry(defect).or_insert_with(|| {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("firmware");
        std::fs::create_dir_all(&folder).unwrap();
        let program = folder.join(format!("hbp_host_{defect}"));
        // Another run of the tests may be at it: each compiles its own, and the name changes hands.
        let own = folder.join(format!("hbp_host_{defect}.{}", std::process::id()));
        compile("cc", &host_args(&own, &[&format!("HBP_DEFECT={defect}")]));
        std::fs::rename(&own, &program).unwrap();
        program
    });
    program.clone()
}

fn host_args(program: &Path, defines: &[&str]) -> Vec<String> {
    let folder = kit().join("firmware");
    let mut args: Vec<String> = [
        "-std=c99",
        "-Wall",
        "-Wextra",
        "-pedantic",
        "-Werror",
        "-O1",
    ]
    .map(String::from)
    .to_vec();
    args.push(String::from("-DHBP_UID=\"selvedge-emu\""));
    args.push(String::from("-DHBP_NAME=\"emulated array\""));
    args.extend(defines.iter().map(|define| format!("-D{define}")));
    args.extend(["-o".to_owned(), program.display().to_string()]);
    for source in ["host/hbp_host.c", "hbp_core.c"] {
        args.push(folder.join(source).display().to_string());
    }
    args
}
