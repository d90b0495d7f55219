//! A surface as textures: its relief in shade, and its local spectra.
//!
//! A picture is made when what it shows has changed, and then only.

use std::sync::Arc;

use eframe::egui::{self, Color32, ColorImage, TextureFilter, TextureId, TextureOptions};

use crate::bench::signals::spatial::{DENSITIES_DB, density_db};
use crate::kit::texture::{Same, Texture};
use crate::kit::theme::colour_map::ColourMap;
use crate::kit::widgets::axis::Axis;
use crate::tools::lab::preview::Preview;
use selvedge_foundation::numerics::to_index;
use selvedge_textile::lit;
use selvedge_textile::surface::{BIN_SPACING_PER_MM, LocalSpectra};

/// Rows of the picture of spectra.
const N_ROWS: u8 = 96;
/// Wavenumbers at its ends, cycles/mm: beyond, cloth has nothing that is felt.
const WAVENUMBERS: [f64; 2] = [BIN_SPACING_PER_MM, 50.0];
/// How the relief is read: smooth however far away it is.
const READ: TextureOptions = TextureOptions {
    mipmap_mode: Some(TextureFilter::Linear),
    ..TextureOptions::LINEAR
};

/// The pictures as they were drawn last.
#[derive(Default)]
pub(crate) struct Pictures {
    relief: Texture<Same<Preview>>,
    spectra: Texture<(Same<LocalSpectra>, ColourMap)>,
}

impl Pictures {
    /// The relief in shade.
    pub(crate) fn relief(&mut self, ctx: &egui::Context, preview: &Arc<Preview>) -> TextureId {
        let key = Same(Arc::clone(preview));
        self.relief.of(ctx, ("lab relief", READ), key, || {
            let picture = lit(preview.relief.heights_um());
            let pixels = picture.pixels.iter();
            let pixels = pixels.map(|&[r, g, b]| Color32::from_rgb(r, g, b));
            ColorImage::new([picture.width, picture.height], pixels.collect())
        })
    }

    /// Local spectra over place and wavenumber.
    pub(crate) fn spectra(
        &mut self,
        ctx: &egui::Context,
        spectra: &Arc<LocalSpectra>,
        map: ColourMap,
    ) -> TextureId {
        let colour = |db: &f64| {
            if db.is_finite() {
                map.colour(share(*db))
            } else {
                // Finer than the samples: nothing is known there.
                Color32::TRANSPARENT
            }
        };
        let key = (Same(Arc::clone(spectra)), map);
        let how = ("lab spectra", TextureOptions::NEAREST);
        self.spectra.of(ctx, how, key, || {
            let rows = rows_db(spectra);
            let n_points = rows.first().map_or(0, Vec::len);
            // The top row of a picture holds the highest wavenumbers.
            let pixels = rows.iter().rev().flat_map(|row| row.iter().map(colour));
            ColorImage::new([n_points, rows.len()], pixels.collect())
        })
    }
}

fn share(db: f64) -> f64 {
    let [least, most] = DENSITIES_DB;
    ((db - least) / (most - least)).clamp(0.0, 1.0)
}

/// The axis of wavenumbers.
pub(crate) fn wavenumbers() -> Axis {
    Axis::log(WAVENUMBERS[0], WAVENUMBERS[1])
}

/// Densities in dB re 1 µm² per cycle/mm, a row for every band of wavenumbers from the lowest up,
/// in it a value for every point along the stroke; of areal spectra those across the middle.
fn rows_db(spectra: &LocalSpectra) -> Vec<Vec<f64>> {
    let [n_along, n_across] = spectra.shape();
    let first = n_along * (n_across / 2);
    let axis = wavenumbers();
    let edge = |row: u8| axis.value(f64::from(row) / f64::from(N_ROWS)) / BIN_SPACING_PER_MM;
    let n_bins = spectra.n_bins();
    let row = |row: u8| -> Vec<f64> {
        // Bins whose middle lies in the row; where none does, the nearest one.
        let (from, to) = (edge(row), edge(row + 1));
        let bin = |k: f64| to_index(k).clamp(1, n_bins) - 1;
        let least = bin((0.5 * (from + to)).round()).min(bin(from.ceil()));
        let most = bin(to.floor()).max(least);
        let at = |point: usize| {
            let powers = &spectra.powers_um2(first + point)[least..=most];
            let mean = powers.iter().sum::<f64>() / powers.len() as f64;
            density_db(mean / BIN_SPACING_PER_MM)
        };
        (0..n_along).map(at).collect()
    };
    (0..N_ROWS).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_textile::surface::{Direction, Profile, ProfileSet, Surface};

    #[test]
    fn a_sine_is_brightest_in_the_row_of_its_wavenumber() {
        let sine = |i: u32| (f64::from(i) / 230.0 * 3.0 * std::f64::consts::TAU).sin();
        let mut profiles = ProfileSet::default();
        profiles[0] = Some(Profile::new(1.0 / 230.0, (0..4600).map(sine).collect()).unwrap());
        let surface = Surface::from_profiles(profiles, 0.0).unwrap();
        let rows = rows_db(surface.spectra(Direction::WarpForward));
        assert_eq!(rows.len(), usize::from(N_ROWS));
        let brightest = (0..rows.len()).max_by(|a, b| rows[*a][5].total_cmp(&rows[*b][5]));
        let share = (brightest.unwrap() as f64 + 0.5) / f64::from(N_ROWS);
        let found = wavenumbers().value(share);
        assert!((found / 3.0 - 1.0).abs() < 0.1, "{found}");
    }
}
