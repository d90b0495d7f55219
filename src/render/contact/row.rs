//! What is known of a stylus at an instant, and how tables have it.

/// A run at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StylusRow {
    /// When, s from the start.
    pub t_s: f64,
    /// The tip's lowest point, mm.
    pub place_mm: [f64; 3],
    /// How deep the deepest contact is, µm; 0 in the air.
    pub depth_um: f64,
    /// Contact force along the surface's normal, N.
    pub force_n: f64,
    /// Friction along the surface, N.
    pub tangential_n: f64,
    /// The part of the contact force above the device's bandwidth, N.
    pub vibration_n: f64,
    /// Energy of tip, contact and hand, J: of motion, of what contact and leading hand give back,
    /// and of the pressing hand above height 0.
    pub energy_j: f64,
}

/// A column's name and its number.
type Figure = (&'static str, fn(&StylusRow) -> f64);

impl StylusRow {
    /// What a table says of it: the columns and their numbers, in order.
    pub const COLUMNS: [Figure; 9] = [
        ("t_s", |row| row.t_s),
        ("x_mm", |row| row.place_mm[0]),
        ("y_mm", |row| row.place_mm[1]),
        ("z_mm", |row| row.place_mm[2]),
        ("depth_um", |row| row.depth_um),
        ("force_n", |row| row.force_n),
        ("tangential_n", |row| row.tangential_n),
        ("vibration_n", |row| row.vibration_n),
        ("energy_j", |row| row.energy_j),
    ];
}
