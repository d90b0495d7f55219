//! A region of a picture that is turned: where its corners lie.

/// The corners of a region that is turned clockwise about its middle, upper left first; smaller by
/// as much as keeps them inside a picture of this size.
pub(crate) fn turned_corners(
    [x, y, w, h]: [usize; 4],
    turn_deg: f64,
    size: [usize; 2],
) -> [[f64; 2]; 4] {
    let [half_w, half_h] = [w, h].map(|n| 0.5 * n as f64);
    let middle = [x as f64 + half_w, y as f64 + half_h];
    let ends = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let away = ends.map(|[i, j]| turned_place([i * half_w, j * half_h], turn_deg));
    let room = [0, 1].map(|axis| middle[axis].min(size[axis] as f64 - middle[axis]));
    let fits = away
        .iter()
        .flat_map(|off| [0, 1].map(|axis| room[axis] / off[axis].abs()));
    let share = fits.fold(1.0, f64::min);
    away.map(|off| [0, 1].map(|axis| middle[axis] + share * off[axis]))
}

/// A place turned clockwise about the origin, y down.
pub(crate) fn turned_place([x, y]: [f64; 2], turn_deg: f64) -> [f64; 2] {
    let (s, c) = turn_deg.to_radians().sin_cos();
    [x * c - y * s, x * s + y * c]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_region_stays_inside() {
        let straight = turned_corners([10, 20, 40, 30], 0.0, [100, 80]);
        assert_eq!(
            straight,
            [[10.0, 20.0], [50.0, 20.0], [50.0, 50.0], [10.0, 50.0]]
        );
        let [first, ..] = turned_corners([10, 20, 40, 40], 90.0, [100, 80]);
        assert!(
            (first[0] - 50.0).abs() < 1e-9 && (first[1] - 20.0).abs() < 1e-9,
            "{first:?}"
        );
        for turn_deg in [-80.0, 13.0, 45.0, 170.0] {
            let corners = turned_corners([0, 0, 100, 80], turn_deg, [100, 80]);
            let is_inside = |[x, y]: [f64; 2]| x >= -1e-9 && y >= -1e-9 && x < 100.1 && y < 80.1;
            assert!(corners.into_iter().all(is_inside), "{corners:?}");
        }
    }
}
