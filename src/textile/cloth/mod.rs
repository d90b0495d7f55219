//! A model cloth: yarns in space, the surface they form, the stroke of the probe over it, and its
//! picture. Weaves and knits differ only in where their yarns run.

mod fibre;
mod portrait;
mod relief;
mod side;
mod strand;
mod stroke;
pub mod usual;
mod variation;
mod yarn;

pub use fibre::add_hairs;
pub use portrait::{PX_PER_MM, portrait};
pub use relief::relief_map;
pub use side::Side;
pub use side::turn_over;
pub use strand::{Cloth, Node, Strand};
pub use stroke::profiles;
pub use variation::{Drift, Field, count};
pub use yarn::NUMBERS as YARN_NUMBERS;
pub use yarn::Yarn;
pub use yarn::YarnRun;
