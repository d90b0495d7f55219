//! Lines of four points such that every two points lie on exactly one: the affine plane of order 4
//! (16 points, 20 lines) and the projective plane of order 3 (13 points, 13 lines).

/// Points of a line.
pub(crate) const LINE_POINTS: usize = 4;

/// Points numbered from 0, and lines of four of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Lines {
    /// Points in all.
    pub n_points: usize,
    /// The lines, each with its points in rising order.
    pub lines: Vec<[usize; LINE_POINTS]>,
}

/// A product in the field of four elements 0, 1, ω, ω + 1, written 0…3; sums are `^`.
pub(super) fn product(a: usize, b: usize) -> usize {
    // As polynomials over two elements, modulo ω² = ω + 1.
    let carried = ((a & 1) * b) ^ ((a >> 1) * (b << 1));
    if carried & 4 == 0 {
        carried
    } else {
        carried ^ 7
    }
}

impl Lines {
    /// The lines over so many points; `None` where no such plane is known here.
    pub(crate) fn over(n_points: usize) -> Option<Self> {
        let lines = match n_points {
            16 => affine(),
            13 => projective(),
            _ => return None,
        };
        Some(Self { n_points, lines })
    }

    /// Numbers of the lines through a point.
    pub(crate) fn through(&self, point: usize) -> impl Iterator<Item = usize> + '_ {
        let lines = self.lines.iter().enumerate();
        lines
            .filter(move |(_, line)| line.contains(&point))
            .map(|(number, _)| number)
    }
}

/// y = mx + c and x = c over the field of four elements; the point (x, y) is 4x + y.
fn affine() -> Vec<[usize; LINE_POINTS]> {
    let mut lines = Vec::with_capacity(20);
    for slope in 0..4 {
        for c in 0..4 {
            lines.push([0, 1, 2, 3].map(|x| 4 * x + (product(slope, x) ^ c)));
        }
    }
    lines.extend((0..4).map(|c| [0, 1, 2, 3].map(|y| 4 * c + y)));
    lines
}

/// The turns of the difference set 0, 1, 3, 9 modulo 13 (Singer 1938).
fn projective() -> Vec<[usize; LINE_POINTS]> {
    let turned = |by: usize| {
        let mut line = [0, 1, 3, 9].map(|point| (point + by) % 13);
        line.sort_unstable();
        line
    };
    (0..13).map(turned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_two_points_lie_on_exactly_one_line() {
        for (n_points, n_lines, n_through) in [(16, 20, 5), (13, 13, 4)] {
            let plane = Lines::over(n_points).unwrap();
            assert_eq!((plane.n_points, plane.lines.len()), (n_points, n_lines));
            for a in 0..n_points {
                assert_eq!(plane.through(a).count(), n_through);
                for b in 0..a {
                    let both = |line: &&[usize; 4]| line.contains(&a) && line.contains(&b);
                    assert_eq!(plane.lines.iter().filter(both).count(), 1, "{a} and {b}");
                }
            }
        }
        assert_eq!(Lines::over(15), None);
    }

    #[test]
    fn the_field_of_four_elements_divides() {
        for a in 1..4 {
            let row = [1, 2, 3].map(|b| product(a, b));
            let mut sorted = row;
            sorted.sort_unstable();
            assert_eq!(sorted, [1, 2, 3], "{a} times 1, 2, 3 is {row:?}");
            for (b, c) in [(1, 2), (2, 3), (3, 1)] {
                assert_eq!(product(a, b ^ c), product(a, b) ^ product(a, c));
            }
        }
        assert_eq!(product(2, 2), 3, "ω² = ω + 1");
    }
}
