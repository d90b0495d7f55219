//! Chance that hangs on a place alone: the same at the same place, whatever is looked at around it.

/// Uniform in [0, 1) for a cell of a lattice (`SplitMix64`'s finalizer over seed and place).
pub(super) fn cell(seed: u64, x: i64, y: i64) -> f64 {
    let mut bits = seed
        .wrapping_add(x.cast_unsigned().wrapping_mul(0x9e37_79b9_7f4a_7c15))
        .wrapping_add(y.cast_unsigned().wrapping_mul(0xc2b2_ae3d_27d4_eb4f));
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// Mean 0, standard deviation 1, within ±3: the sum of three uniform numbers, scaled.
pub(super) fn bell(seed: u64, x: i64, y: i64) -> f64 {
    let sum: f64 = (0..3).map(|n| cell(seed ^ (n << 60), x, y)).sum();
    2.0 * (sum - 1.5)
}

/// A surface without jumps through [`bell`] at whole places: cubic blending between four cells.
pub(super) fn smooth(seed: u64, x: f64, y: f64) -> f64 {
    let [x0, y0] = [x.floor(), y.floor()];
    let blend = |t: f64| t * t * (3.0 - 2.0 * t);
    let [s, t] = [blend(x - x0), blend(y - y0)];
    #[expect(clippy::cast_possible_truncation, reason = "places of cells are whole")]
    let [i, j] = [x0 as i64, y0 as i64];
    let along = |j: i64| (1.0 - s) * bell(seed, i, j) + s * bell(seed, i + 1, j);
    (1.0 - t) * along(j) + t * along(j + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_spread_evenly_and_neighbours_know_nothing_of_each_other() {
        let n = 40_000_i64;
        let values: Vec<f64> = (0..n).map(|i| bell(7, i % 200, i / 200)).collect();
        let mean = values.iter().sum::<f64>() / n as f64;
        let variance = values.iter().map(|x| x * x).sum::<f64>() / n as f64;
        // Standard errors: 0.005 and 0.006.
        assert!(
            mean.abs() < 0.02 && (variance - 1.0).abs() < 0.03,
            "{mean}, {variance}"
        );
        let pairs = values.windows(2).map(|pair| pair[0] * pair[1]);
        let correlation = pairs.sum::<f64>() / n as f64;
        assert!(correlation.abs() < 0.02, "{correlation}");
    }

    #[test]
    fn a_smooth_surface_goes_through_its_cells_without_jumps() {
        assert_eq!(smooth(3, 5.0, -2.0), bell(3, 5, -2));
        let mut before = smooth(3, -1.5, 0.3);
        for step in 1..4000 {
            let here = smooth(3, -1.5 + 1e-3 * f64::from(step), 0.3);
            assert!((here - before).abs() < 0.012, "{here} after {before}");
            before = here;
        }
    }
}
