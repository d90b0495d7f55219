//! The yarns of a model textile in space, the surface they form, the stroke of the probe over it,
//! and its picture. Weaves and knits differ only in where their yarns run.

mod fibre;
mod keys;
mod model;
mod path;
mod portrait;
mod relief;
mod variation;
mod yarn;

pub(crate) use fibre::add_hairs;
pub(crate) use keys::{touch_group, usual};
pub(crate) use model::model;
pub(crate) use path::YarnGeometry;
pub(crate) use path::{Node, YarnPath, turn_over};
pub(crate) use portrait::PX_PER_MM;
pub(crate) use variation::{Drift, Field, count};
pub(crate) use yarn::Yarn;
pub(crate) use yarn::YarnRun;
