//! Where positions come from, behind one trait.
//!
//! A source either hands over time-stamped samples, whose velocity is then estimated, or states the
//! pose of a tick itself, exactly as an offline rendering of the same path takes it.

mod error;
mod evdev;
mod feed;
mod lines;
mod live;
mod path;
mod pointer;
mod rate;
mod source;

pub use error::InputError;
pub use evdev::{Area, AxisRange, InputDevice};
pub(super) use feed::{FeedItem, FeedSender, feed};
pub(super) use lines::{Lines, Said};
pub use live::PointerSender;
pub(super) use live::{LiveInput, Touched, live_ring};
pub use pointer::{Control, InputLosses, Playback, PointerInput, Reading, SourceKind};
pub use rate::InputRate;
pub(super) use rate::RateMeter;
pub use source::InputSource;
pub(super) use source::playable;
