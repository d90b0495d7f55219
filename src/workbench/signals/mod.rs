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

pub(crate) use contact::ContactColumns;
pub(crate) use drive::wave_um;
pub(crate) use drive::{DriveSpectrum, drive_um};
pub(crate) use history::Entry;
pub(crate) use history::History;
pub(crate) use ring::{ColumnRing, N_COLUMNS, N_SLOTS, slot_of};
pub(crate) use rows::{LEAST_HZ, MOST_HZ, N_ROWS, row_centre_hz};
pub(crate) use rows::{Rows, row_of};
pub(crate) use spatial::Felt;
pub(crate) use spatial::{SpatialCurve, SpatialView};
