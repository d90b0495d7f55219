//! A model cloth: yarns in space, the surface they form, the stroke of the probe over it, and its
//! picture. Weaves and knits differ only in where their yarns run.

mod fibre;
mod portrait;
mod relief;
mod side;
mod strand;
mod stroke;
pub(crate) mod usual;
mod variation;
mod yarn;

pub(crate) use fibre::add_hairs;
pub(crate) use portrait::{PX_PER_MM, portrait};
pub(crate) use relief::relief_map;
pub use side::Side;
pub(crate) use side::turn_over;
pub use strand::Cloth;
pub(crate) use strand::Node;
pub(crate) use strand::Strand;
pub(crate) use stroke::profiles;
pub(crate) use variation::Drift;
pub(crate) use variation::{Field, count};
pub(crate) use yarn::NUMBERS as YARN_NUMBERS;
pub use yarn::Yarn;
pub(crate) use yarn::YarnRun;
