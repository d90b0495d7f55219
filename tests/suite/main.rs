//! The integration tests, in one binary so that they link once.
#![expect(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::float_cmp,
    clippy::print_stderr,
    reason = "a test that fails says so by panicking, and compares exact results on purpose"
)]
