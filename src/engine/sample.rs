//! Pointer samples, and the rules that keep bad ones out.
//!
//! Knows nothing of velocity: what passes here is a series of places whose stamps rise.

use std::time::Instant;

use crate::geometry::Point;

/// Where the pointer was, and when.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointerSample {
    /// When the event arrived (or, from a stream with its own clock, when it says it happened).
    pub stamp: Instant,
    /// The place in the workspace, mm.
    pub position: Point,
}

/// What became of pointer samples since the source was chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SampleCounters {
    /// Samples that were used.
    pub accepted: u64,
    /// Samples whose time equalled the one before, which they replaced.
    pub replaced: u64,
    /// Samples dropped because their time went back by up to a second.
    pub went_back: u64,
    /// Times that the clock jumped: the estimator forgot everything.
    pub clock_jumps: u64,
    /// Samples dropped because a coordinate was NaN or infinite.
    pub not_finite: u64,
    /// Samples that the full ring had no room for.
    pub overflowed: u64,
    /// Lines of a stream that were not `x,y` or `t,x,y`.
    pub bad_lines: u64,
}
