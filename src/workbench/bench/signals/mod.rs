//! What contactors feel and do, as it changes over time and over wavenumber: the histories and the
//! pure queries behind the plots.
//!
//! Nothing here paints, and nothing is computed before a pane asks for it.

pub(crate) mod amplitudes;
pub(crate) mod contact;
pub(crate) mod drive;
pub(crate) mod history;
pub(crate) mod ring;
pub(crate) mod rows;
pub(crate) mod spatial;
