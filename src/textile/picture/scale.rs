//! The scale of a picture, by what is known of it.

use serde::{Deserialize, Serialize};

use super::PictureError;
use super::basis::length;
use super::lattice::Lattice;

/// Millimetres to an inch.
const MM_PER_INCH: f64 = 25.4;
/// Threads that are counted may be off by this factor from one way to the other.
const MAX_UNLIKE: f64 = 1.25;

/// What is known of the scale of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PictureScale {
    /// Pixels to a millimetre.
    PxPerMm(f64),
    /// Dots to an inch, as scanners count.
    Dpi(f64),
    /// A known length on the picture: x and y of either end, px, and how long it is, mm.
    Ruler([f64; 5]),
    /// Threads to a centimetre, warp and weft.
    ThreadsPerCm([f64; 2]),
}

impl PictureScale {
    /// Pixels to a millimetre where no threads need to be found; `None` where they must.
    pub fn stated_px_per_mm(self) -> Option<f64> {
        match self {
            Self::PxPerMm(px_per_mm) => Some(px_per_mm),
            Self::Dpi(dpi) => Some(dpi / MM_PER_INCH),
            Self::Ruler([x0, y0, x1, y1, mm]) => Some(length([x1 - x0, y1 - y0]) / mm),
            Self::ThreadsPerCm(_) => None,
        }
    }

    /// Pixels to a millimetre on a picture with this lattice, or with none. A warp of a and a weft
    /// of b threads to a centimetre cross a·b/100 times on a square millimetre; the thread grid
    /// says on how many pixels they cross once, whichever of its vectors is the warp.
    ///
    /// # Errors
    /// Threads were counted, and no grid of them was found, or one that is denser one way by
    /// another factor.
    pub fn px_per_mm(self, lattice: Option<&Lattice>) -> Result<f64, PictureError> {
        let Self::ThreadsPerCm([a, b]) = self else {
            return Ok(self.stated_px_per_mm().unwrap_or(f64::NAN));
        };
        let grid = lattice.and_then(|lattice| Some((lattice, lattice.thread_grid?)));
        let (lattice, grid) = grid.ok_or_else(|| {
            let what = "no grid of threads finer than the repeat is found to count them on";
            PictureError::Input(format!("{what}; give the scale as --dpi or --px-per-mm"))
        })?;
        let found = grid.longer() / grid.shorter();
        let counted = a.max(b) / a.min(b);
        if !(found / MAX_UNLIKE..=found * MAX_UNLIKE).contains(&counted) {
            let what = format!(
                "the threads found lie {found:.2} times as dense one way as the other, those \
                 counted {counted:.2} times"
            );
            let mend = "count both ways and give WARP,WEFT, or give --dpi or --px-per-mm";
            return Err(PictureError::Input(format!("{what}; {mend}")));
        }
        // The repeat was refined on the whole picture; the grid goes with it.
        let repeat = lattice.basis().area();
        let n_crossings = (repeat / grid.area()).round().max(1.0);
        Ok((repeat / n_crossings * a * b / 100.0).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::super::basis::Basis;
    use super::*;

    fn lattice(thread_grid: Option<Basis>) -> Lattice {
        Lattice {
            p1_px: [10.1, 8.08],
            p2_px: [-10.1, 8.08],
            confidence: 0.98,
            false_alarm_rate: 0.0,
            method: "hough",
            thread_grid,
            held_out: None,
            level: 0.9,
            level_between: 0.1,
            cover: 1.0,
            hit: 1.0,
        }
    }

    #[test]
    fn threads_counted_are_a_scale_whichever_way_the_warp_lies() {
        let plain = lattice(Some(Basis::new([0.0, 8.0], [10.0, 0.0])));
        for counts in [[20.0, 25.0], [25.0, 20.0]] {
            let px_per_mm = PictureScale::ThreadsPerCm(counts).px_per_mm(Some(&plain));
            // 25 a centimetre lie 0.4 mm apart: 8.08 px.
            assert!((px_per_mm.unwrap() - 20.2).abs() < 1e-9, "{counts:?}");
        }
        for counts in [[20.0, 40.0], [20.0, 15.0 / 1.3]] {
            let error = PictureScale::ThreadsPerCm(counts).px_per_mm(Some(&plain));
            let line = error.unwrap_err().to_string();
            assert!(line.contains("1.25 times as dense"), "{line}");
        }
        for lattice in [None, Some(&lattice(None))] {
            let none = PictureScale::ThreadsPerCm([20.0, 25.0]).px_per_mm(lattice);
            let line = none.unwrap_err().to_string();
            assert!(line.contains("no grid of threads"), "{line}");
        }
    }

    #[test]
    fn a_ruler_and_dots_to_an_inch_need_no_lattice() {
        let ruler = PictureScale::Ruler([10.0, 20.0, 40.0, 60.0, 2.0]);
        assert_eq!(ruler.stated_px_per_mm(), Some(25.0));
        assert_eq!(PictureScale::Dpi(508.0).stated_px_per_mm(), Some(20.0));
        assert_eq!(
            PictureScale::ThreadsPerCm([1.0; 2]).stated_px_per_mm(),
            None
        );
        assert_eq!(ruler.px_per_mm(None).unwrap(), 25.0);
    }
}
