//! What stands between the start of the program and the first tick: manifests read, a scene of
//! four textiles loaded, its tables prepared, and the whole program from start to exit.

#![expect(clippy::print_stdout, reason = "a bench prints its figures")]
#![expect(
    clippy::unwrap_used,
    reason = "a bench that cannot run says so by panicking"
)]

use std::process::Command;
use std::time::Instant;

use selvedge_engine::PreparedScene;
use selvedge_foundation::numerics::median;
use selvedge_foundation::quantity::time_span;
use selvedge_render::array::{Accuracy, Method};
use selvedge_render::scene::LoadedScene;
use selvedge_textile::Library;

const ROUNDS: usize = 11;

fn main() {
    show("manifests of the sixteen textiles read", || {
        let library = Library::shipped().unwrap();
        let n_read = library
            .ids()
            .iter()
            .filter(|id| library.manifest(id).is_ok())
            .count();
        assert_eq!(n_read, 16, "every manifest reads");
    });
    show("scene of four loaded (profiles, spectra)", || {
        LoadedScene::shipped().unwrap();
    });
    let scene = LoadedScene::shipped().unwrap();
    for method in [Method::Reference, Method::Banded, Method::Table] {
        show(&format!("the same prepared for {}", method.name()), || {
            PreparedScene::prepare(&scene, method, &Accuracy::default()).unwrap();
        });
    }
    show(
        "program started, one tick rendered with table, ended",
        whole_program,
    );
}

/// `selvedge render` of a path of one row on the shipped scene.
fn whole_program() {
    let folder = std::env::temp_dir();
    let path = folder.join(format!("selvedge-start-{}.csv", std::process::id()));
    std::fs::write(&path, "t_s,x_mm,y_mm\n0,60,60\n").unwrap();
    let scene = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/assets/scenes/four-alternatives.scene.toml"
    );
    let run = Command::new(env!("CARGO_BIN_EXE_selvedge"))
        .args(["render", scene, "--method", "table", "--path"])
        .arg(&path)
        .output();
    assert!(run.unwrap().status.success(), "the program renders");
    std::fs::remove_file(&path).unwrap();
}

fn show(what: &str, mut work: impl FnMut()) {
    let mut times_s: Vec<f64> = (0..ROUNDS)
        .map(|_| {
            let start = Instant::now();
            work();
            start.elapsed().as_secs_f64()
        })
        .collect();
    let middle = median(&mut times_s);
    let (fastest, slowest) = (times_s[0], times_s[ROUNDS - 1]);
    println!(
        "{what}: median {} ({} … {}, {ROUNDS} runs)",
        time_span(middle),
        time_span(fastest),
        time_span(slowest)
    );
}
