//! What the foot of the window tells of what the pointer rests on: said while a frame is drawn,
//! shown at its end. It covers nothing, unlike a tip.

use eframe::egui::{Context, Id};

fn place() -> Id {
    Id::unique("told at the foot")
}

/// Tells something in this frame; lines become one.
pub(crate) fn tell(ctx: &Context, words: impl Into<String>) {
    let words = words.into().replace('\n', " · ");
    ctx.data_mut(|data| data.insert_temp(place(), words));
}

/// Takes what was told in this frame.
pub(crate) fn told(ctx: &Context) -> Option<String> {
    ctx.data_mut(|data| data.remove_temp(place()))
}
