//! Pictures that repeat, as textures: resampled to sides that are powers of two, so that every
//! halved copy that the graphics card makes of them is the mean of the whole.
//!
//! Copies of other sides drop or blend a line here and there, each driver in its own way, and a
//! fine weave seen from afar shows that as dark arcs that its cloth does not have.

use eframe::egui::{Color32, ColorImage, TextureFilter, TextureOptions};
use selvedge_foundation::numerics::to_byte;

/// How a repeating picture is read: blended between pixels and between its halved copies.
pub(crate) const TILED: TextureOptions = TextureOptions {
    mipmap_mode: Some(TextureFilter::Linear),
    ..TextureOptions::LINEAR_REPEAT
};

/// The longest side of a texture that every graphics card takes, px.
const MAX_SIDE: usize = 2048;

/// A repeating picture with sides that are powers of two: the next above its own. Every new pixel
/// is the mean of the area that it covers, so that the picture as a whole is as bright as before.
pub(crate) fn tile(image: &ColorImage) -> ColorImage {
    let [width, height] = image.size;
    if width == 0 || height == 0 {
        return image.clone();
    }
    let [new_width, new_height] = [width, height].map(side);
    let across = shares(width, new_width);
    let rows = image.pixels.chunks_exact(width);
    let wide: Vec<[f32; 4]> = rows
        .flat_map(|row| {
            across
                .iter()
                .map(|shares| mean(shares, |x| channels(row[x])))
        })
        .collect();
    let column = |x: usize, shares: &Shares| mean(shares, |y| wide[y * new_width + x]);
    let down = shares(height, new_height);
    let pixels = down
        .iter()
        .flat_map(|shares| (0..new_width).map(move |x| (x, shares)))
        .map(|(x, shares)| pixel(column(x, shares)))
        .collect();
    ColorImage::new([new_width, new_height], pixels)
}

/// The power of two that a side becomes.
fn side(length: usize) -> usize {
    length.next_power_of_two().min(MAX_SIDE)
}

/// Old pixels and how much each gives to a new one; the shares of a new pixel add up to 1.
type Shares = Vec<(usize, f32)>;

/// What every new pixel along a side is made of.
fn shares(n_old: usize, n_new: usize) -> Vec<Shares> {
    let scale = n_old as f32 / n_new as f32;
    let of = |new: usize| {
        let (from, to) = (new as f32 * scale, (new + 1) as f32 * scale);
        let share = |old: usize| {
            let overlap = to.min((old + 1) as f32) - from.max(old as f32);
            (old, overlap / scale)
        };
        let first = new * n_old / n_new;
        let all = (first..n_old).map(share);
        all.take_while(|(old, _)| (*old as f32) < to)
            .filter(|(_, share)| *share > 0.0)
            .collect()
    };
    (0..n_new).map(of).collect()
}

fn mean(shares: &[(usize, f32)], value: impl Fn(usize) -> [f32; 4]) -> [f32; 4] {
    let mut sum = [0.0; 4];
    for &(old, share) in shares {
        let value = value(old);
        sum = std::array::from_fn(|c| sum[c] + share * value[c]);
    }
    sum
}

fn channels(colour: Color32) -> [f32; 4] {
    colour.to_array().map(f32::from)
}

fn pixel(channels: [f32; 4]) -> Color32 {
    let [r, g, b, a] = channels.map(|value| to_byte(f64::from(value) + 0.5));
    Color32::from_rgba_premultiplied(r, g, b, a)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Diagonal stripes three pixels wide, as a twill has them.
    fn twill([width, height]: [usize; 2]) -> ColorImage {
        let at = |i: usize| {
            let grey = if (i % width + i / width) % 6 < 3 {
                40
            } else {
                220
            };
            Color32::from_gray(grey)
        };
        ColorImage::new([width, height], (0..width * height).map(at).collect())
    }

    fn mean_grey(image: &ColorImage) -> f64 {
        let sum: u64 = image.pixels.iter().map(|one| u64::from(one.r())).sum();
        sum as f64 / image.pixels.len() as f64
    }

    #[test]
    fn sides_are_powers_of_two_and_the_brightness_stays() {
        for (size, expected) in [
            ([233, 231], [256, 256]),
            ([200, 129], [256, 256]),
            ([64, 256], [64, 256]),
            ([1, 3], [1, 4]),
            ([3000, 5], [2048, 8]),
        ] {
            let image = twill(size);
            let tile = tile(&image);
            assert_eq!(tile.size, expected);
            let change = mean_grey(&tile) - mean_grey(&image);
            assert!(change.abs() < 0.6, "{size:?}: {change}");
        }
        assert_eq!(tile(&twill([64, 256])), twill([64, 256]), "nothing to do");
    }

    /// A halved copy as graphics cards make it: each new pixel is read between the four old ones
    /// around its middle, which are its own only where both sides are even.
    fn halved(image: &ColorImage) -> ColorImage {
        let [width, height] = image.size;
        let size = image.size.map(|side| side / 2);
        let around = |new: usize, n_old: usize, n_new: usize| {
            let at = (new as f32 + 0.5) * n_old as f32 / n_new as f32 - 0.5;
            let share = at - at.floor();
            let first = (0..n_old).rfind(|old| *old as f32 <= at).unwrap();
            [(first, 1.0 - share), ((first + 1) % n_old, share)]
        };
        let grey = |x: usize, y: usize| {
            let [columns, rows] = [around(x, width, size[0]), around(y, height, size[1])];
            let four = rows
                .iter()
                .flat_map(|row| columns.map(|column| (column, *row)));
            let parts = four.map(|((x, across), (y, down))| {
                f32::from(image.pixels[y * width + x].r()) * across * down
            });
            pixel([parts.sum(); 4])
        };
        let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
        ColorImage::new(size, pixels.map(|(x, y)| grey(x, y)).collect())
    }

    /// From the darkest to the brightest pixel of the third halved copy.
    fn spread(image: &ColorImage) -> u8 {
        let seen = halved(&halved(&halved(image)));
        let greys = || seen.pixels.iter().map(Color32::r);
        greys().max().unwrap() - greys().min().unwrap()
    }

    #[test]
    fn a_fine_twill_is_even_from_afar() {
        let twill = twill([234, 228]);
        let (before, after) = (spread(&twill), spread(&tile(&twill)));
        assert!(after < 24, "{after} of 180 between dark and bright stripes");
        assert!(before > 2 * after, "what it mends: {before}, {after}");
    }
}
