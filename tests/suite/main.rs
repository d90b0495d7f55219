//! The integration tests, in one binary so that they link once.
#![expect(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::float_cmp,
    reason = "a test that fails says so by panicking, and compares exact results on purpose"
)]

mod bad_input;
#[cfg(target_os = "linux")]
mod bounded;
mod bridge_arrays;
mod bridge_device;
mod bridge_end_to_end;
mod bridge_ends;
mod bridge_faults;
mod certify;
mod command_line;
mod commands;
mod doctor;
mod evidence;
mod experiment;
mod experiment_analyse;
mod firmware;
mod friction;
mod golden;
mod import;
mod import_kes;
mod mds;
mod model_surfaces;
mod no_allocation;
mod no_allocation_engine;
mod old_designs;
mod picture;
mod picture_folder;
mod picture_scale;
mod picture_turned;
mod picture_variation;
mod probe;
mod program;
mod programs;
mod render;
mod report;
mod sinks;
mod watched;
mod window;

/// Aborts when something allocates inside `assert_no_alloc`.
#[global_allocator]
static GUARD: assert_no_alloc::AllocDisabler = assert_no_alloc::AllocDisabler;
