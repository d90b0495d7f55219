//! What contactors feel and do, as it changes over time and over wavenumber: the histories and the
//! pure queries behind the plots.
//!
//! Nothing here paints, and nothing is computed before a pane asks for it.

mod contact;
mod drive;
mod history;
mod ring;
mod rows;
mod spatial;

pub use contact::ContactColumns;
pub use drive::{DriveSpectrum, drive_um, wave_um};
pub use history::{Entry, History};
pub use ring::{ColumnRing, N_COLUMNS, N_SLOTS, slot_of};
pub use rows::{LEAST_HZ, MOST_HZ, N_ROWS, Rows, row_centre_hz, row_of};
pub use spatial::{Felt, SpatialCurve, SpatialView};
