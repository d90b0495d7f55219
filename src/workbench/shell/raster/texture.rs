//! Textures: pixels with their smaller copies, and reading a colour at a place.

use eframe::egui::{
    Color32, ImageData, Pos2, TextureFilter, TextureOptions, TextureWrapMode, Vec2,
};
use eframe::epaint::ImageDelta;
use selvedge_foundation::numerics::to_byte;

/// A texture and, when it asks for them, its halved copies down to one pixel.
#[derive(Debug)]
pub(crate) struct Texture {
    levels: Vec<Level>,
    options: TextureOptions,
}

#[derive(Debug, Clone)]
struct Level {
    size: [usize; 2],
    pixels: Vec<Color32>,
}

/// A texture seen at one scale.
#[derive(Debug)]
pub(crate) struct Sampler<'a> {
    fine: &'a Level,
    coarse: &'a Level,
    /// How much of `coarse` to mix in, 0…1.
    mix: f32,
    filter: TextureFilter,
    wrap: TextureWrapMode,
}

impl Texture {
    /// A texture of the whole picture in `delta`.
    pub(crate) fn new(delta: &ImageDelta) -> Self {
        let ImageData::Color(image) = &delta.image;
        let whole = Level {
            size: image.size,
            pixels: image.pixels.clone(),
        };
        let mut texture = Self {
            levels: vec![whole],
            options: delta.options,
        };
        texture.rebuild_copies();
        texture
    }

    /// Replaces the pixels from `corner` (column, row) on. What lies outside is left out.
    pub(crate) fn patch(&mut self, [column, row]: [usize; 2], delta: &ImageDelta) {
        let ImageData::Color(image) = &delta.image;
        self.options = delta.options;
        let whole = &mut self.levels[0];
        let [width, height] = whole.size;
        let n_columns = image.size[0].min(width.saturating_sub(column));
        for (y, source) in image.pixels.chunks_exact(image.size[0].max(1)).enumerate() {
            if row + y < height {
                let first = (row + y) * width + column;
                whole.pixels[first..first + n_columns].copy_from_slice(&source[..n_columns]);
            }
        }
        self.rebuild_copies();
    }

    /// The texture as it is to be read when one screen pixel steps over `uv_per_pixel`.
    pub(crate) fn sampler(&self, uv_per_pixel: Vec2) -> Sampler<'_> {
        let whole = &self.levels[0];
        let [width, height] = whole.size.map(|n| n as f32);
        let texels = (uv_per_pixel.x * width)
            .max(uv_per_pixel.y * height)
            .max(1e-6);
        let filter = if texels > 1.0 {
            self.options.minification
        } else {
            self.options.magnification
        };
        let deepest = self.levels.len() - 1;
        let depth = texels.log2().clamp(0.0, deepest as f32);
        let fine = (0..deepest)
            .rev()
            .find(|&level| level as f32 <= depth)
            .unwrap_or(0);
        Sampler {
            fine: &self.levels[fine],
            coarse: &self.levels[(fine + 1).min(deepest)],
            mix: (depth - fine as f32).clamp(0.0, 1.0),
            filter,
            wrap: self.options.wrap_mode,
        }
    }

    fn rebuild_copies(&mut self) {
        self.levels.truncate(1);
        if self.options.mipmap_mode.is_none() {
            return;
        }
        while let Some(half) = self.levels.last().and_then(Level::halved) {
            self.levels.push(half);
        }
    }
}

impl Level {
    /// Half as many pixels each way, each the mean of four; `None` below two pixels.
    fn halved(&self) -> Option<Self> {
        let [width, height] = self.size;
        if width < 2 || height < 2 {
            return None;
        }
        let size = [width / 2, height / 2];
        let mean = |x: usize, y: usize| {
            let corner = 2 * y * width + 2 * x;
            let four = [corner, corner + 1, corner + width, corner + width + 1];
            let channel = |c: usize| {
                let sum: u16 = four
                    .iter()
                    .map(|&i| u16::from(self.pixels[i].to_array()[c]))
                    .sum();
                byte(f32::from(sum) * 0.25)
            };
            Color32::from_rgba_premultiplied(channel(0), channel(1), channel(2), channel(3))
        };
        let pixels = (0..size[1])
            .flat_map(|y| (0..size[0]).map(move |x| mean(x, y)))
            .collect();
        Some(Self { size, pixels })
    }

    fn texel(&self, column: i64, row: i64, wrap: TextureWrapMode) -> [f32; 4] {
        let [width, height] = self.size.map(super::signed);
        let at = |i: i64, n: i64| match wrap {
            TextureWrapMode::ClampToEdge => i.clamp(0, n - 1),
            TextureWrapMode::Repeat => i.rem_euclid(n),
            TextureWrapMode::MirroredRepeat => {
                let folded = i.rem_euclid(2 * n);
                folded.min(2 * n - 1 - folded)
            }
        };
        let place = super::index(at(row, height) * width + at(column, width));
        self.pixels
            .get(place)
            .map_or([0.0; 4], |colour| colour.to_array().map(f32::from))
    }

    fn nearest(&self, uv: Pos2, wrap: TextureWrapMode) -> [f32; 4] {
        let [width, height] = self.size.map(|n| n as f32);
        self.texel(floor(uv.x * width), floor(uv.y * height), wrap)
    }

    fn bilinear(&self, uv: Pos2, wrap: TextureWrapMode) -> [f32; 4] {
        let [width, height] = self.size.map(|n| n as f32);
        let (x, y) = (uv.x * width - 0.5, uv.y * height - 0.5);
        let (column, row) = (floor(x), floor(y));
        let (right, down) = (x - x.floor(), y - y.floor());
        let upper = mix(
            self.texel(column, row, wrap),
            self.texel(column + 1, row, wrap),
            right,
        );
        let lower = mix(
            self.texel(column, row + 1, wrap),
            self.texel(column + 1, row + 1, wrap),
            right,
        );
        mix(upper, lower, down)
    }
}

impl Sampler<'_> {
    /// The colour at `uv` (0…1 across the picture), channels 0…255, premultiplied.
    pub(crate) fn sample(&self, uv: Pos2) -> [f32; 4] {
        let read = |level: &Level| match self.filter {
            TextureFilter::Nearest => level.nearest(uv, self.wrap),
            TextureFilter::Linear => level.bilinear(uv, self.wrap),
        };
        if self.mix > 0.0 {
            mix(read(self.fine), read(self.coarse), self.mix)
        } else {
            read(self.fine)
        }
    }
}

fn mix(a: [f32; 4], b: [f32; 4], share: f32) -> [f32; 4] {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * share)
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "the cast saturates; texels are wrapped after"
)]
fn floor(at: f32) -> i64 {
    at.floor() as i64
}

/// The nearest byte.
pub(crate) fn byte(value: f32) -> u8 {
    to_byte(f64::from(value) + 0.5)
}
