//! Pictures of textile: luminance and colour, a part of one, one seen straight from the front.

use std::path::Path;

use super::PictureError;
use super::basis::{Place, length, mix};
use selvedge_foundation::files::{FileError, Rgb16Image};
use selvedge_foundation::numerics::{Grid, to_index, to_whole};

/// Channels that differ by more than this share of white are coloured.
const COLOURED: f64 = 0.02;
/// What red, green and blue do to the luminance.
pub(super) const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];
/// A rectified picture has at most this many pixels on a side.
const MAX_SIDE: f64 = 16_000.0;
/// And at most this many in all.
const MAX_PIXELS: f64 = 64e6;

/// A picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Luminance of the encoded values, 0…1, row by row from the top: 0.2126 R + 0.7152 G +
    /// 0.0722 B.
    pub luminance: Grid<f64>,
    /// The shares of red and of green in red + green + blue, of 65535, which light and shadow leave
    /// as they are; none if the picture is grey.
    pub colour: Option<Grid<[u16; 2]>>,
}

impl Picture {
    /// Decodes a picture (PNG, JPEG, TIFF, BMP). `path` only names it in errors.
    ///
    /// # Errors
    /// What is no picture, is damaged, or has more than 64 million pixels.
    pub fn load(bytes: &[u8], path: &Path) -> Result<Self, FileError> {
        let decoded = Rgb16Image::decode(bytes, path)?;
        let white = f64::from(u16::MAX);
        let [of_red, of_green, of_blue] = LUMINANCE;
        let luminance = |&[r, g, b]: &[u16; 3]| {
            (of_red * f64::from(r) + of_green * f64::from(g) + of_blue * f64::from(b)) / white
        };
        let is_coloured = decoded.pixels.iter().any(|p| {
            let max = p.iter().max().copied().unwrap_or(0);
            f64::from(max - p.iter().min().copied().unwrap_or(0)) > COLOURED * white
        });
        let share = |&[r, g, b]: &[u16; 3]| {
            // One step of 8 bits is added to each, so that black is grey.
            let [r, g, b] = [r, g, b].map(|x| f64::from(x) + 257.0);
            [r, g].map(|x| to_whole((x / (r + g + b) * white).round()))
        };
        let width = decoded.width;
        let empty =
            || FileError::whole(path, "the picture has no pixels", "give an intact picture");
        let grid = Grid::from_rows(width, decoded.pixels.iter().map(luminance).collect());
        let colour =
            is_coloured.then(|| Grid::from_rows(width, decoded.pixels.iter().map(share).collect()));
        Ok(Self {
            luminance: grid.ok_or_else(empty)?,
            colour: colour.flatten(),
        })
    }

    /// A grey picture.
    pub fn grey(luminance: Grid<f64>) -> Self {
        Self {
            luminance,
            colour: None,
        }
    }

    /// The part of a picture from x, y of this width and height, px.
    ///
    /// # Errors
    /// A part that is empty or not inside.
    pub fn part(&self, region: [usize; 4]) -> Result<Self, PictureError> {
        let (w, h) = (self.luminance.width(), self.luminance.height());
        let [x, y, width, height] = region;
        let outside = || {
            let what = format!(
                "the region {x},{y},{width},{height} is not inside the picture of {w} × {h} pixels"
            );
            PictureError::Input(format!("{what}; give X,Y,W,H in its pixels"))
        };
        Ok(Self {
            luminance: self.luminance.part(region).ok_or_else(outside)?,
            colour: self.colour.as_ref().and_then(|c| c.part(region)),
        })
    }

    /// What lies between four corners (upper left, upper right, lower right, lower left), drawn as
    /// a rectangle of their mean side lengths: a picture taken at a slant, seen from the front.
    ///
    /// # Errors
    /// Corners outside the picture, in another order, or a figure that is not convex.
    pub fn rectified(&self, corners: [Place; 4]) -> Result<Self, PictureError> {
        let (w, h) = (self.luminance.width(), self.luminance.height());
        let is_inside =
            |&[x, y]: &Place| (0.0..=w as f64).contains(&x) && (0.0..=h as f64).contains(&y);
        if !corners.iter().all(is_inside) {
            let what = format!("a corner is not inside the picture of {w} × {h} pixels");
            return Err(PictureError::Input(format!(
                "{what}; give x,y of four corners in its pixels"
            )));
        }
        let side = |a: usize, b: usize| length(mix(corners[a], 1.0, corners[b], -1.0));
        let turn = |i: usize| {
            let (a, b, c) = (corners[i], corners[(i + 1) % 4], corners[(i + 2) % 4]);
            (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])
        };
        let size = [
            0.5 * (side(0, 1) + side(3, 2)),
            0.5 * (side(0, 3) + side(1, 2)),
        ]
        .map(f64::round);
        let is_sound =
            (0..4).all(|i| turn(i) > 0.0) && size.iter().all(|n| (1.0..=MAX_SIDE).contains(n));
        if !is_sound || size[0] * size[1] > MAX_PIXELS {
            let what = "the four corners do not span a convex figure clockwise";
            let mend = "give upper left, upper right, lower right, lower left";
            return Err(PictureError::Input(format!("{what}; {mend}")));
        }
        let map = Projection::onto(corners);
        let n = size.map(to_index);
        let place = |i: usize, j: usize| {
            let at = [(i as f64 + 0.5) / size[0], (j as f64 + 0.5) / size[1]];
            map.at(at).map(|px| px - 0.5)
        };
        let luminance = Grid::from_fn(n[0], n[1], |i, j| {
            between(&self.luminance, place(i, j), |a, b, t| a + (b - a) * t)
        });
        let mixed = |[a, b]: [u16; 2], t: f64| {
            let [a, b] = [a, b].map(f64::from);
            to_whole((a + (b - a) * t).round())
        };
        let blend = |a: [u16; 2], b: [u16; 2], t: f64| [0, 1].map(|i| mixed([a[i], b[i]], t));
        let colour = self
            .colour
            .as_ref()
            .map(|colour| Grid::from_fn(n[0], n[1], |i, j| between(colour, place(i, j), blend)));
        Ok(Self { luminance, colour })
    }
}

/// A value between samples, bilinear; beyond the edges the edges' values.
pub(super) fn between<T: Copy>(grid: &Grid<T>, [x, y]: Place, blend: impl Fn(T, T, f64) -> T) -> T {
    let index = |at: f64, n: usize| {
        let at = at.clamp(0.0, n as f64 - 1.0);
        let first = to_index(at);
        (first, (first + 1).min(n - 1), at - first as f64)
    };
    let (i, next_i, s) = index(x, grid.width());
    let (j, next_j, t) = index(y, grid.height());
    let along = |row: &[T]| blend(row[i], row[next_i], s);
    blend(along(grid.row(j)), along(grid.row(next_j)), t)
}

/// The projection of the unit square onto four corners (Heckbert 1989).
struct Projection {
    x: [f64; 3],
    y: [f64; 3],
    w: [f64; 2],
}

impl Projection {
    fn onto([p0, p1, p2, p3]: [Place; 4]) -> Self {
        let sum = mix(mix(p0, 1.0, p1, -1.0), 1.0, mix(p2, 1.0, p3, -1.0), 1.0);
        let (d1, d2) = (mix(p1, 1.0, p2, -1.0), mix(p3, 1.0, p2, -1.0));
        let area = d1[0] * d2[1] - d1[1] * d2[0];
        let g = (sum[0] * d2[1] - sum[1] * d2[0]) / area;
        let h = (d1[0] * sum[1] - d1[1] * sum[0]) / area;
        let row = |i: usize| [p1[i] - p0[i] + g * p1[i], p3[i] - p0[i] + h * p3[i], p0[i]];
        Self {
            x: row(0),
            y: row(1),
            w: [g, h],
        }
    }

    fn at(&self, [s, t]: Place) -> Place {
        let w = self.w[0] * s + self.w[1] * t + 1.0;
        let on = |row: &[f64; 3]| (row[0] * s + row[1] * t + row[2]) / w;
        [on(&self.x), on(&self.y)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> Picture {
        let values = (0..40 * 30_usize).map(|i| (i % 40) as f64 + 100.0 * (i / 40) as f64);
        Picture::grey(Grid::from_rows(40, values.collect()).unwrap())
    }

    #[test]
    fn a_projection_takes_corners_to_corners() {
        let corners = [[3.0, 4.0], [33.0, 2.0], [38.0, 27.0], [1.0, 20.0]];
        let map = Projection::onto(corners);
        for (at, corner) in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
            .into_iter()
            .zip(corners)
        {
            let found = map.at(at);
            assert!(length(mix(found, 1.0, corner, -1.0)) < 1e-9, "{found:?}");
        }
    }

    #[test]
    fn the_whole_picture_rectified_is_itself() {
        let picture = ramp();
        let same = picture
            .rectified([[0.0, 0.0], [40.0, 0.0], [40.0, 30.0], [0.0, 30.0]])
            .unwrap();
        for (a, b) in same
            .luminance
            .values()
            .iter()
            .zip(picture.luminance.values())
        {
            assert!((a - b).abs() < 1e-9, "{a} and {b}");
        }
    }

    #[test]
    fn parts_and_corners_outside_are_refused() {
        let picture = ramp();
        assert_eq!(
            picture.part([1, 2, 3, 4]).unwrap().luminance.row(0),
            [201.0, 202.0, 203.0]
        );
        for region in [
            [0, 0, 41, 5],
            [39, 0, 2, 2],
            [0, 0, 0, 1],
            [usize::MAX, 0, 2, 2],
        ] {
            let error = picture.part(region).unwrap_err().to_string();
            assert!(
                error.contains("is not inside the picture of 40 × 30 pixels"),
                "{error}"
            );
        }
        let crossed = [[0.0, 0.0], [40.0, 30.0], [40.0, 0.0], [0.0, 30.0]];
        let error = picture.rectified(crossed).unwrap_err().to_string();
        assert!(error.contains("upper left, upper right"), "{error}");
        let outside = [[0.0, 0.0], [41.0, 0.0], [40.0, 30.0], [0.0, 30.0]];
        let error = picture.rectified(outside).unwrap_err().to_string();
        assert!(error.contains("a corner is not inside"), "{error}");
        let nothing = [[5.0, 5.0]; 4];
        assert!(picture.rectified(nothing).is_err(), "a point");
    }
}
