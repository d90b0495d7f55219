//! Says which compiler makes the program and of which commit: times are theirs too.

use std::process::Command;

fn main() {
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let features = std::env::var("CARGO_CFG_TARGET_FEATURE").unwrap_or_default();
    println!(
        "cargo::rustc-env=SELVEDGE_COMPILER={}",
        said(&rustc, &["--version"])
    );
    println!("cargo::rustc-env=SELVEDGE_TARGET_FEATURES={features}");
    println!(
        "cargo::rustc-env=SELVEDGE_COMMIT={}",
        said("git", &["rev-parse", "HEAD"])
    );
    println!("cargo::rerun-if-changed=build.rs");
    // Programs that are measured know their commit; others need not be made anew with each one.
    let log = said("git", &["rev-parse", "--git-path", "logs/HEAD"]);
    let is_release = std::env::var("PROFILE").is_ok_and(|profile| profile == "release");
    if is_release && !log.is_empty() {
        println!("cargo::rerun-if-changed={log}");
    }
}

/// What a program prints; nothing where it cannot be had.
fn said(program: &str, words: &[&str]) -> String {
    let said = Command::new(program).args(words).output().ok();
    let said = said.filter(|output| output.status.success());
    let said = said.and_then(|output| String::from_utf8(output.stdout).ok());
    said.unwrap_or_default().trim().to_owned()
}
