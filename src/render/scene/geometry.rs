//! Where the contactors of a display sit, seen from its centre.
//!
//! Named arrays are laid out row by row: contactor index = row · columns + column, row 0 at the
//! fingertip end (+y), column 0 at the left (−x). Turning is not done here: see `Display`.

use serde::{Deserialize, Serialize};

use selvedge_foundation::geometry::Displacement;
use selvedge_foundation::named;

/// Most contactors that a display may have.
pub const MAX_CONTACTORS: usize = 16_384;

/// The layout of a display's contactors.
#[derive(Debug, Clone, PartialEq)]
pub enum Geometry {
    /// A named rectangular array.
    Array(ArrayLayout),
    /// Contactors at these offsets from the display's centre, mm.
    Contactors(Vec<Displacement>),
}

named! {
    /// The named arrays.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum ArrayLayout {
        /// 6 rows × 4 columns at 2 mm: the stimulator of the HAPTEX project.
        #[serde(rename = "exeter-24")]
        Exeter24 = "exeter-24",
        /// 5 × 5 at 2 mm, as in the first of Brady's devices (2010).
        #[serde(rename = "5x5")]
        Square5 = "5x5",
        /// 10 × 10 at 1 mm, as in the array of Summers and Chanter (2002).
        #[serde(rename = "10x10")]
        Square10 = "10x10",
    }
    /// The name in scene files.
    pub fn name;
}

impl ArrayLayout {
    /// The array of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|layout| layout.name() == name)
    }

    /// Rows and columns.
    pub fn grid(self) -> (usize, usize) {
        match self {
            Self::Exeter24 => (6, 4),
            Self::Square5 => (5, 5),
            Self::Square10 => (10, 10),
        }
    }

    /// Distance between neighbours in a row or a column, mm.
    pub fn pitch_mm(self) -> f64 {
        match self {
            Self::Exeter24 | Self::Square5 => 2.0,
            Self::Square10 => 1.0,
        }
    }

    fn contactors(self) -> Vec<Displacement> {
        let (n_rows, n_columns) = self.grid();
        let middle = |count: usize| (count as f64 - 1.0) / 2.0;
        let offset = |row: usize, column: usize| {
            Displacement::new(
                (column as f64 - middle(n_columns)) * self.pitch_mm(),
                (middle(n_rows) - row as f64) * self.pitch_mm(),
            )
        };
        (0..n_rows)
            .flat_map(|row| (0..n_columns).map(move |column| offset(row, column)))
            .collect()
    }
}

impl Geometry {
    /// Offsets of the contactors from the display's centre in index order, mm, before turning.
    pub fn contactors(&self) -> Vec<Displacement> {
        match self {
            Self::Array(layout) => layout.contactors(),
            Self::Contactors(offsets) => offsets.clone(),
        }
    }

    /// How many contactors there are.
    pub fn n_contactors(&self) -> usize {
        match self {
            Self::Array(layout) => layout.grid().0 * layout.grid().1,
            Self::Contactors(offsets) => offsets.len(),
        }
    }

    /// Rows and columns, if the contactors form a grid in index order.
    pub fn grid(&self) -> Option<(usize, usize)> {
        match self {
            Self::Array(layout) => Some(layout.grid()),
            Self::Contactors(_) => None,
        }
    }

    /// What people call it: the array's name, or how many contactors it has.
    pub fn label(&self) -> String {
        match self {
            Self::Array(layout) => layout.name().to_owned(),
            Self::Contactors(offsets) => format!("{} contactors", offsets.len()),
        }
    }
}

impl Default for Geometry {
    fn default() -> Self {
        Self::Array(ArrayLayout::Exeter24)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exeter_array_starts_at_the_fingertips_left() {
        let offsets = Geometry::default().contactors();
        assert_eq!(offsets.len(), 24);
        assert_eq!(offsets[0], Displacement::new(-3.0, 5.0));
        assert_eq!(offsets[3], Displacement::new(3.0, 5.0));
        assert_eq!(offsets[4], Displacement::new(-3.0, 3.0));
        assert_eq!(offsets[23], Displacement::new(3.0, -5.0));
    }

    #[test]
    fn every_named_array_is_centred_and_has_its_pitch() {
        for layout in ArrayLayout::ALL {
            let offsets = Geometry::Array(layout).contactors();
            let sum = offsets
                .iter()
                .fold((0.0, 0.0), |s, o| (s.0 + o.x_mm, s.1 + o.y_mm));
            assert_eq!(sum, (0.0, 0.0), "{layout:?}");
            assert_eq!(
                offsets[1].x_mm - offsets[0].x_mm,
                layout.pitch_mm(),
                "{layout:?}"
            );
            assert_eq!(ArrayLayout::named(layout.name()), Some(layout));
        }
    }
}
