//! What can be asked for as a source of positions, and the input that it becomes.

use std::fmt;
use std::io::BufRead;
use std::sync::Arc;

use super::lines::start_lines;
use super::path::{ReplayInput, StrokeInput};
use super::pointer::PointerInput;
use crate::EngineError;
use selvedge_render::scene::{ExplorationPath, Stroke};

/// Where positions come from.
pub enum InputSource {
    /// Live samples through a [`PointerSender`](super::PointerSender): the mouse.
    Pointer,
    /// A recorded exploration, tick for tick as an offline rendering takes it.
    Replay(Arc<ExplorationPath>),
    /// A generated stroke.
    Stroke(Stroke),
    /// Lines of text, `x_mm,y_mm` (stamped on arrival) or `t_s,x_mm,y_mm`, read on a thread of
    /// their own.
    Lines(Box<dyn BufRead + Send>),
    /// Whatever yields positions: a device, a connection.
    Live(Box<dyn PointerInput>),
}

/// A source as the engine polls it; `None` for live samples.
pub(crate) fn playable(source: InputSource) -> Result<Option<Box<dyn PointerInput>>, EngineError> {
    Ok(match source {
        InputSource::Pointer => None,
        InputSource::Replay(path) => Some(Box::new(ReplayInput::new(path))),
        InputSource::Stroke(stroke) => {
            stroke.check()?;
            Some(Box::new(StrokeInput::new(stroke)))
        }
        InputSource::Lines(lines) => Some(Box::new(start_lines(lines)?)),
        InputSource::Live(input) => Some(input),
    })
}

impl fmt::Debug for InputSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Pointer => "Pointer",
            Self::Replay(_) => "Replay",
            Self::Stroke(_) => "Stroke",
            Self::Lines(_) => "Lines",
            Self::Live(_) => "Live",
        })
    }
}
