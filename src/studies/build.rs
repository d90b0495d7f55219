//! Says which compiler makes the program: times are that one's too.

use std::process::Command;

fn main() {
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let said = Command::new(rustc).arg("--version").output().ok();
    let said = said.and_then(|output| String::from_utf8(output.stdout).ok());
    let features = std::env::var("CARGO_CFG_TARGET_FEATURE").unwrap_or_default();
    println!(
        "cargo::rustc-env=SELVEDGE_COMPILER={}",
        said.unwrap_or_default().trim()
    );
    println!("cargo::rustc-env=SELVEDGE_TARGET_FEATURES={features}");
    println!("cargo::rerun-if-changed=build.rs");
}
