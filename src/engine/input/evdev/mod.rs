//! Tablets and touch frames, read directly: Linux' own reports, on a thread of its own.
//!
//! ```text
//! /dev/input/eventN ─ 24-byte reports ─ decode (contact, place) ─ area (mm) ─ feed ─ engine
//! ```
//!
//! A report carries the kernel's time of the event, on the clock that the engine keeps. What the
//! program does with a report is in `decode` and `area`, which know no device; `device` opens and
//! lists, on Linux only.

mod area;
mod decode;
#[cfg(all(target_os = "linux", target_pointer_width = "64"))]
mod device;
#[cfg(not(all(target_os = "linux", target_pointer_width = "64")))]
mod elsewhere;

use std::path::PathBuf;

pub use area::{Area, AxisRange};

/// A device that could move the display.
#[derive(Debug, Clone, PartialEq)]
pub struct InputDevice {
    /// Where it is.
    pub path: PathBuf,
    /// What it calls itself.
    pub name: String,
    /// What its driver tells of x and y.
    pub axes: [AxisRange; 2],
    /// How it tells that it is touched, for people.
    pub contact: &'static str,
}
