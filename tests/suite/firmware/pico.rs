//! The port for RP2040: compiled, never run here. With `PICO_SDK_PATH` set and `CMake` there it is
//! built as its maker would; without, its sources are checked against the declarations in
//! `pico_stub`.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::tools;
use crate::program::Lab;

const COMPILER: &str = "arm-none-eabi-gcc";
const SOURCES: [&str; 4] = [
    "rp2040/main.c",
    "rp2040/converters.c",
    "rp2040/usb_descriptors.c",
    "hbp_core.c",
];

#[test]
fn the_port_for_rp2040_compiles_without_a_word() {
    if !tools::has(COMPILER, "the port for RP2040") {
        return;
    }
    match std::env::var_os("PICO_SDK_PATH") {
        Some(sdk) if tools::has("cmake", "the port for RP2040 with the real sdk") => {
            build_with(Path::new(&sdk));
        }
        _ => check_against_declarations(),
    }
}

fn check_against_declarations() {
    let firmware = tools::kit().join("firmware");
    let declared = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/suite/firmware/pico_stub");
    for source in SOURCES {
        let mut args: Vec<String> = [
            "-mcpu=cortex-m0plus",
            "-mthumb",
            "-std=c11",
            "-ffreestanding",
            "-fsyntax-only",
            "-Wall",
            "-Wextra",
            "-Werror",
            "-I",
        ]
        .map(String::from)
        .to_vec();
        args.push(firmware.join("rp2040").display().to_string());
        args.push(format!("-I{}", declared.display()));
        args.push(firmware.join(source).display().to_string());
        tools::compile(COMPILER, &args);
    }
}

fn build_with(sdk: &Path) {
    let lab = Lab::new();
    let build = lab.path("build");
    let run = |args: &[PathBuf]| {
        let output = Command::new("cmake").args(args).output().unwrap();
        let said = String::from_utf8_lossy(&output.stdout).into_owned()
            + &String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "cmake {args:?}:\n{said}");
        said
    };
    let source = tools::kit().join("firmware/rp2040");
    let path = format!("-DPICO_SDK_PATH={}", sdk.display());
    run(&["-S".into(), source, "-B".into(), build.clone(), path.into()]);
    let said = run(&["--build".into(), build.clone()]);
    let ours = said.lines().filter(|line| line.contains("bridge/firmware"));
    let warnings: Vec<&str> = ours.filter(|line| line.contains("warning:")).collect();
    assert!(warnings.is_empty(), "{warnings:?}");
    assert!(
        build.join("hbp.uf2").exists(),
        "what is copied to the board"
    );
}
