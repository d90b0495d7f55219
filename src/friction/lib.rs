//! Friction of a textile from its picture.
#![cfg_attr(
    test,
    expect(clippy::float_cmp, reason = "tests compare exact results on purpose")
)]

pub mod baseline;
pub mod cloth;
pub mod example;
pub mod network;
pub mod picture;
pub mod score;
pub mod signal;
