//! What touches: the point of a stylus, a fingertip, an array of contactors.
//!
//! All are spheres that stand rigidly beside each other and share the load; one is a stylus.

use selvedge_foundation::geometry::Displacement;

/// Radius of the curve of a fingertip, mm, and of the piece of skin that one of its contacts
/// stands for.
const FINGER_MM: [f64; 2] = [8.0, 1.0];
/// Rings of contacts around the middle of a fingertip, 2 mm apart.
const RINGS: i32 = 2;

/// A tip: equal spheres that share the load.
#[derive(Debug, Clone, PartialEq)]
pub struct Tip {
    /// Radius of each sphere, mm; 0 is a point.
    pub radius_mm: f64,
    /// Where their lowest points are from the tip's own place, u, w and up, mm.
    pub contacts_mm: Vec<[f64; 3]>,
}

impl Tip {
    /// The ball at the end of a stylus.
    pub fn stylus(radius_mm: f64) -> Self {
        Self {
            radius_mm,
            contacts_mm: vec![[0.0; 3]],
        }
    }

    /// A fingertip: 19 places of skin in a triangular grid on a curve of 8 mm radius.
    pub fn fingertip() -> Self {
        let [curve_mm, radius_mm] = FINGER_MM;
        let mut contacts_mm = Vec::new();
        for row in -RINGS..=RINGS {
            for column in -RINGS..=RINGS {
                if (row + column).abs() <= RINGS {
                    let u_mm = 2.0 * (f64::from(column) + 0.5 * f64::from(row));
                    let w_mm = 3.0_f64.sqrt() * f64::from(row);
                    let rise_mm =
                        curve_mm - (curve_mm * curve_mm - u_mm * u_mm - w_mm * w_mm).sqrt();
                    contacts_mm.push([u_mm, w_mm, rise_mm]);
                }
            }
        }
        Self {
            radius_mm,
            contacts_mm,
        }
    }

    /// The contactors of an array, each a ball of this radius, all equally high.
    pub fn array(offsets: &[Displacement], radius_mm: f64) -> Self {
        let flat = |offset: &Displacement| [offset.x_mm, offset.y_mm, 0.0];
        Self {
            radius_mm,
            contacts_mm: offsets.iter().map(flat).collect(),
        }
    }
}
