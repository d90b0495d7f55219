//! The controls that the toolkit does not have: a slider for gains, axes of plots, and small
//! pieces of text.
//!
//! They draw and report; they change nothing themselves.

pub(crate) mod axis;
pub(crate) mod bar;
pub(crate) mod card;
pub(crate) mod cells;
pub(crate) mod fields;
pub(crate) mod fold;
pub(crate) mod level_bar;
pub(crate) mod limit_mark;
pub(crate) mod list;
pub(crate) mod polyline;
pub(crate) mod relief;
pub(crate) mod relief3d;
pub(crate) mod scale;
pub(crate) mod slider;
pub(crate) mod text;

pub(crate) use crate::kit::widgets::card::card;
pub(crate) use crate::kit::widgets::fold::fold;
pub(crate) use crate::kit::widgets::list::list;
pub(crate) use crate::kit::widgets::relief3d::relief3d;
