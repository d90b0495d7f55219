//! The point of a profile nearest to a place: whole millimetres, repeated for ever.

/// Added to places before rounding, so that a place that a decimal number means to lie on the
/// border between two points does, mm.
const BORDER_MM: f64 = 1e-6;

/// `i = ⌊place + ½ + 1e-6⌋ mod n` for a fixed number of points n.
///
/// The remainder is taken by two multiplications with a precomputed reciprocal (Lemire, Kaser,
/// Kurz 2019), exact for 32-bit numbers: a division costs more than the rest of a contactor.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PointIndex {
    n_points: u64,
    reciprocal: u64,
}

impl PointIndex {
    pub(crate) fn new(n_points: usize) -> Self {
        let n_points = n_points.max(1) as u64;
        Self {
            n_points,
            reciprocal: (u64::MAX / n_points).wrapping_add(1),
        }
    }

    #[expect(clippy::cast_possible_truncation, reason = "it was made from a usize")]
    fn n_points(self) -> usize {
        self.n_points as usize
    }

    /// The point nearest to a place in mm, at or right of −½.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the result is below n_points"
    )]
    #[inline]
    pub(crate) fn nearest(self, place_mm: f64) -> usize {
        let whole = nearest_mm(place_mm);
        let fraction = self.reciprocal.wrapping_mul(u64::from(whole));
        ((u128::from(fraction) * u128::from(self.n_points)) >> 64) as usize
    }
}

/// The whole millimetre nearest to a place in mm, at or right of −½: where the point that it reads
/// lies on the cloth.
#[inline]
pub(crate) fn nearest_mm(place_mm: f64) -> u32 {
    whole_part(place_mm + 0.5 + BORDER_MM)
}

/// The point of spectra nearest to a place along and across their direction. Spectra along one
/// profile are repeated across.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PointGrid {
    pub along: PointIndex,
    across: PointIndex,
    n_along: usize,
}

impl PointGrid {
    /// For so many points along and across.
    pub(crate) fn new([n_along, n_across]: [usize; 2]) -> Self {
        Self {
            along: PointIndex::new(n_along),
            across: PointIndex::new(n_across),
            n_along,
        }
    }

    /// The number of the point nearest to a place in mm.
    #[inline]
    pub(crate) fn nearest(self, along_mm: f64, across_mm: f64) -> usize {
        self.number(self.indices(along_mm, across_mm))
    }

    /// The point nearest to a place in mm: which along, which across.
    #[inline]
    pub(crate) fn indices(self, along_mm: f64, across_mm: f64) -> [usize; 2] {
        [self.along.nearest(along_mm), self.across.nearest(across_mm)]
    }

    /// Points along and across.
    pub(crate) fn n_points(self) -> [usize; 2] {
        [self.along.n_points(), self.across.n_points()]
    }

    /// The number of a point: so many along, so many across.
    #[inline]
    pub(crate) fn number(self, [along, across]: [usize; 2]) -> usize {
        across * self.n_along + along
    }
}

/// `⌊x⌋` for 0 ≤ x < 2³²; some number beyond. A library's floor, and a cast that saturates, each
/// cost more than all this: adding 2⁵² rounds to a whole number that stands in the low bits.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the low bits are what is wanted"
)]
#[inline]
fn whole_part(x: f64) -> u32 {
    const SHIFT: f64 = 4_503_599_627_370_496.0;
    let shifted = x + SHIFT;
    let is_rounded_up = shifted - SHIFT > x;
    (shifted.to_bits() as u32).wrapping_sub(u32::from(is_rounded_up))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_round_to_the_nearest_millimetre_and_repeat() {
        let of_16 = PointIndex::new(16);
        let cases = [
            (-1e-6, 0),
            (0.0, 0),
            (0.499, 0),
            (0.499_999_5, 1),
            (0.5, 1),
            (15.5, 0),
            (37.4, 5),
        ];
        for (place_mm, point) in cases {
            assert_eq!(of_16.nearest(place_mm), point, "{place_mm} mm");
        }
        assert_eq!(PointIndex::new(1).nearest(1234.5), 0);
    }

    #[test]
    fn areal_points_are_numbered_row_by_row_and_repeat_both_ways() {
        let grid = PointGrid::new([5, 3]);
        assert_eq!(grid.nearest(0.0, 0.0), 0);
        assert_eq!(grid.nearest(4.4, 1.5), 2 * 5 + 4);
        assert_eq!(grid.nearest(7.0, 10.0), 5 + 2, "(2, 1)");
        let profile = PointGrid::new([5, 1]);
        assert_eq!(profile.nearest(7.0, 123.4), 2, "the same all across");
    }

    #[test]
    fn the_whole_part_is_the_floor() {
        for x in [
            0.0,
            0.499,
            0.5,
            0.999_999,
            1.0,
            1.5,
            2.5,
            7.0_f64.next_down(),
            4_294_967_295.9,
        ] {
            assert_eq!(f64::from(whole_part(x)), x.floor(), "{x}");
        }
    }

    #[test]
    fn the_reciprocal_gives_the_remainder() {
        for n in [1_u32, 2, 3, 7, 16, 17, 977, 65_537, 3_000_000_019] {
            let index = PointIndex::new(usize::try_from(n).unwrap());
            for whole in [
                0,
                1,
                n - 1,
                n,
                n.wrapping_add(1),
                4_000_000_000,
                u32::MAX - 1,
            ] {
                let found = index.nearest(f64::from(whole));
                assert_eq!(
                    found,
                    usize::try_from(whole % n).unwrap(),
                    "{whole} mod {n}"
                );
            }
        }
    }
}
