//! The controls that the toolkit does not have: a slider for gains, axes of plots, and small
//! pieces of text.
//!
//! They draw and report; they change nothing themselves.

mod axis;
mod bar;
mod card;
mod fold;
mod limit_mark;
mod list;
mod polyline;
mod relief;
mod relief3d;
mod scale;
mod slider;
mod text;

pub(crate) use axis::{Axis, Side, Tick};
pub(crate) use axis::{paint_label, paint_outer_ticks, paint_ticks, paint_unit, round_step};
pub(crate) use bar::{amplitude_bar, colour_bar};
pub(crate) use card::card;
pub(crate) use card::{DROP as CARD_DROP, MARGIN as CARD_MARGIN};
pub(crate) use fold::fold;
pub(crate) use fold::told_fold;
pub(crate) use limit_mark::{LIMIT_MARK, limit_words, limits_band, paint_limit_mark};
pub(crate) use list::list;
pub(crate) use polyline::corners;
pub(crate) use relief::Relief;
pub(crate) use relief::{BAR_ROOM, ReliefPicture, paint_height_bar};
pub(crate) use relief3d::{Relief3d, View3d, relief3d};
pub(crate) use scale::{Curve, Scale};
pub(crate) use slider::{
    RowShape, asked_value, declare, key_steps, slider_row, slider_row_as, tip_beside,
};
pub(crate) use text::{button, choice, mark, row, section};
pub(crate) use text::{field_row, paint_line, quiet_pair, toggle};
