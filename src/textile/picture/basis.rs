//! Lattices of the plane: two vectors that span one, which other pairs span the same, and coarser
//! ones inside.

use selvedge_foundation::numerics::to_whole;

/// A place or a shift in pixels: x to the right, y down.
pub type Place = [f64; 2];

/// Steps of a reduction; each makes the longer vector shorter, so that few are ever needed.
const MAX_STEPS: usize = 200;

/// Two vectors in pixels that span a lattice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Basis {
    /// The first vector, the shorter one once reduced.
    pub p1: Place,
    /// The second vector.
    pub p2: Place,
}

/// The length of a shift.
pub(super) fn length([x, y]: Place) -> f64 {
    x.hypot(y)
}

pub(super) fn dot(a: Place, b: Place) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// `a·s + b·t`.
pub(super) fn mix(a: Place, s: f64, b: Place, t: f64) -> Place {
    [a[0] * s + b[0] * t, a[1] * s + b[1] * t]
}

/// The nearest whole number of one that is finite and small.
pub(super) fn whole(x: f64) -> isize {
    to_whole(x.round())
}

impl Basis {
    /// A basis of two vectors.
    pub const fn new(p1: Place, p2: Place) -> Self {
        Self { p1, p2 }
    }

    /// The area of a cell, px²; negative when p2 lies to the left of p1 (y down).
    pub(crate) fn signed_area(&self) -> f64 {
        self.p1[0] * self.p2[1] - self.p1[1] * self.p2[0]
    }

    /// The area of a cell, px².
    pub fn area(&self) -> f64 {
        self.signed_area().abs()
    }

    /// The length of the longer vector.
    pub fn longer(&self) -> f64 {
        length(self.p1).max(length(self.p2))
    }

    /// The length of the shorter vector.
    pub fn shorter(&self) -> f64 {
        length(self.p1).min(length(self.p2))
    }

    /// The sine of the angle between the vectors; 0 if either vanishes.
    pub fn sine(&self) -> f64 {
        let product = length(self.p1) * length(self.p2);
        if product > 0.0 {
            self.area() / product
        } else {
            0.0
        }
    }

    /// The angle between the vectors, radians, 0…π.
    pub fn angle_rad(&self) -> f64 {
        self.area().atan2(dot(self.p1, self.p2))
    }

    /// The two waves that are in step with the lattice, turns a pixel; of waves, the lattice.
    #[must_use]
    pub(super) fn dual(&self) -> Self {
        let area = self.signed_area();
        Self::new(
            [self.p2[1] / area, -self.p2[0] / area],
            [-self.p1[1] / area, self.p1[0] / area],
        )
    }

    /// `u·p1 + v·p2`.
    pub fn place(&self, [u, v]: Place) -> Place {
        mix(self.p1, u, self.p2, v)
    }

    /// `(u, v)` of a place; not finite where the vectors are parallel.
    pub fn coordinates(&self, [x, y]: Place) -> Place {
        let area = self.signed_area();
        [
            (x * self.p2[1] - y * self.p2[0]) / area,
            (y * self.p1[0] - x * self.p1[1]) / area,
        ]
    }

    /// The two shortest vectors of the lattice (Gauss and Lagrange): `|p1| ≤ |p2|` and
    /// `|p1·p2| ≤ |p1|²/2`, signs chosen so that p1 points right (or straight down) and p2 lies
    /// clockwise of it as seen in the picture.
    #[must_use]
    pub fn reduced(&self) -> Self {
        let (mut a, mut b) = (self.p1, self.p2);
        for _ in 0..MAX_STEPS {
            if dot(a, a) > dot(b, b) {
                std::mem::swap(&mut a, &mut b);
            }
            let squared = dot(a, a);
            let n = if squared > 0.0 {
                (dot(a, b) / squared).round()
            } else {
                0.0
            };
            let shorter = mix(b, 1.0, a, -n);
            if n.abs() < 0.5 || dot(shorter, shorter) >= dot(b, b) {
                break;
            }
            b = shorter;
        }
        if dot(a, a) > dot(b, b) {
            std::mem::swap(&mut a, &mut b);
        }
        let is_left = a[0] < 0.0 || (a[0] <= 0.0 && a[1] < 0.0);
        if is_left {
            a = [-a[0], -a[1]];
        }
        let turned = Self::new(a, b);
        if turned.signed_area() < 0.0 {
            return Self::new(a, [-b[0], -b[1]]);
        }
        turned
    }

    /// How far the vectors of another basis are from lattice points of this one, and back: the
    /// largest distance, px. Small for two bases of one lattice only, whichever vectors span it.
    pub fn distance_to(&self, other: &Self) -> f64 {
        let off = |of: &Self, vector: Place| {
            let at = of.coordinates(vector).map(f64::round);
            let is_none = at.iter().all(|x| x.abs() < 0.5) || !at.iter().all(|x| x.is_finite());
            if is_none {
                return f64::INFINITY;
            }
            length(mix(of.place(at), -1.0, vector, 1.0))
        };
        let both = [(self, other), (other, self)];
        let distances = both
            .iter()
            .flat_map(|(of, from)| [off(of, from.p1), off(of, from.p2)]);
        distances.fold(0.0, f64::max)
    }

    /// The coarser lattice that `rows` of whole combinations span.
    #[must_use]
    pub(super) fn coarser(&self, rows: [[isize; 2]; 2]) -> Self {
        let vector = |[i, j]: [isize; 2]| self.place([i as f64, j as f64]);
        Self::new(vector(rows[0]), vector(rows[1])).reduced()
    }

    /// Indices of half of the lattice points (of d and −d one) within `reach`, without the origin.
    pub(super) fn indices_within(&self, reach: f64) -> Vec<[isize; 2]> {
        let area = self.area();
        if area.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
            return Vec::new();
        }
        let max = |other: Place| whole((reach * length(other) / area).ceil());
        let (max_i, max_j) = (max(self.p2), max(self.p1));
        let mut found = Vec::new();
        for j in 0..=max_j {
            for i in -max_i..=max_i {
                let is_half = j > 0 || i > 0;
                if is_half && length(self.place([i as f64, j as f64])) <= reach {
                    found.push([i, j]);
                }
            }
        }
        found
    }
}

/// The lattice of whole numbers that some index vectors generate, as rows `[[a, b], [0, d]]` with
/// `a, d > 0` and `0 ≤ b < d` (Hermite's normal form); `None` if they all lie on one line.
pub(super) fn generated(vectors: &[[isize; 2]]) -> Option<[[isize; 2]; 2]> {
    let (mut first, mut second) = ([0_isize, 0], 0_isize);
    for &vector in vectors {
        let mut other = vector;
        while other[0] != 0 {
            let n = first[0].div_euclid(other[0]);
            let rest = [first[0] - n * other[0], first[1] - n * other[1]];
            (first, other) = (other, rest);
        }
        second = greatest_divisor(second, other[1]);
    }
    if first[0] < 0 {
        first = [-first[0], -first[1]];
    }
    (first[0] > 0 && second > 0).then(|| [[first[0], first[1].rem_euclid(second)], [0, second]])
}

pub(super) fn greatest_divisor(a: isize, b: isize) -> isize {
    let (mut a, mut b) = (a.abs(), b.abs());
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn signs_and_order_of_a_reduced_basis_are_fixed() {
        let basis = Basis::new([0.0, -10.0], [-12.0, 1.0]).reduced();
        assert_eq!(basis, Basis::new([0.0, 10.0], [-12.0, 1.0]));
        let other = Basis::new([12.0, -11.0], [0.0, 10.0]).reduced();
        assert!(basis.distance_to(&other) < 1e-12, "{other:?}");
    }

    #[test]
    fn index_vectors_generate_their_lattice() {
        assert_eq!(generated(&[[5, 0], [0, 5]]), Some([[5, 0], [0, 5]]));
        assert_eq!(generated(&[[1, 1], [1, -1]]), Some([[1, 1], [0, 2]]));
        assert_eq!(generated(&[[2, 0], [3, 0], [0, 1]]), Some([[1, 0], [0, 1]]));
        assert_eq!(generated(&[[2, 4], [-1, -2]]), None);
        assert_eq!(generated(&[]), None);
    }

    #[test]
    fn half_of_the_points_within_reach_are_listed() {
        let square = Basis::new([1.0, 0.0], [0.0, 1.0]);
        let found = square.indices_within(1.5);
        assert_eq!(found, [[1, 0], [-1, 1], [0, 1], [1, 1]]);
        assert!(
            Basis::new([1.0, 0.0], [2.0, 0.0])
                .indices_within(9.0)
                .is_empty()
        );
    }

    fn vector() -> impl Strategy<Value = Place> {
        [-50.0..50.0_f64, -50.0..50.0_f64]
    }

    proptest! {
        #[test]
        fn a_reduced_basis_is_short_and_spans_the_same(p1 in vector(), p2 in vector()) {
            let basis = Basis::new(p1, p2);
            prop_assume!(basis.sine() > 1e-3 && basis.shorter() > 0.1);
            let reduced = basis.reduced();
            let (a, b) = (reduced.p1, reduced.p2);
            prop_assert!(length(a) <= length(b) * (1.0 + 1e-12));
            prop_assert!(dot(a, b).abs() <= 0.5 * dot(a, a) * (1.0 + 1e-9));
            prop_assert!((reduced.area() - basis.area()).abs() <= 1e-9 * basis.area());
            prop_assert!(reduced.signed_area() > 0.0);
            prop_assert!(basis.distance_to(&reduced) < 1e-6, "{:?}", reduced);
            // No vector of the lattice is shorter than the first.
            for i in -6..=6_i8 {
                for j in -6..=6_i8 {
                    if (i, j) != (0, 0) {
                        let other = basis.place([f64::from(i), f64::from(j)]);
                        prop_assert!(length(other) >= length(a) * (1.0 - 1e-9));
                    }
                }
            }
        }

        #[test]
        fn any_other_basis_of_a_lattice_reduces_to_it(
            p1 in vector(), p2 in vector(), shears in proptest::collection::vec(-3..=3_i8, 4),
        ) {
            let basis = Basis::new(p1, p2);
            prop_assume!(basis.sine() > 0.05 && basis.shorter() > 1.0);
            let mut other = basis;
            for (k, n) in shears.iter().enumerate() {
                let n = f64::from(*n);
                if k % 2 == 0 {
                    other.p1 = mix(other.p1, 1.0, other.p2, n);
                } else {
                    other.p2 = mix(other.p2, 1.0, other.p1, n);
                }
            }
            prop_assert!(basis.reduced().distance_to(&other.reduced()) < 1e-6);
            // Twice as coarse is another lattice.
            let coarse = Basis::new(mix(p1, 2.0, p2, 0.0), p2);
            prop_assert!(basis.distance_to(&coarse) > 0.1 * basis.reduced().shorter());
        }

        #[test]
        fn generated_lattices_hold_their_vectors(
            vectors in proptest::collection::vec([-20..=20_isize, -20..=20_isize], 1..6),
        ) {
            if let Some([[a, b], [zero, d]]) = generated(&vectors) {
                prop_assert_eq!(zero, 0);
                for [i, j] in vectors {
                    prop_assert_eq!(i % a, 0);
                    prop_assert_eq!((j - i / a * b) % d, 0);
                }
            }
        }
    }
}
