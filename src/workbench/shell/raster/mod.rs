//! Draws tessellated shapes into pixels on the processor, so that the window can be pictured
//! where there is no display, no driver and no graphics card.
//!
//! It follows the rules of a graphics card closely enough that nobody sees the difference:
//! sub-pixel vertices, the top-left rule, premultiplied blending in gamma space, bilinear and
//! mip-mapped textures, clipping to rectangles. It knows nothing of widgets, and it does not
//! anti-alias: the tessellator's own feathering does that.

#[cfg(test)]
mod tests;
pub(crate) mod texture;
pub(crate) mod triangle;

use std::collections::HashMap;

use eframe::egui::{self, ClippedPrimitive, Color32, TextureId, TexturesDelta};
use eframe::epaint::Primitive;

use crate::shell::raster::texture::Texture;
use crate::shell::raster::triangle::{Corner, Span};

/// A picture of 8-bit red, green, blue and alpha, row by row from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green, blue and alpha of every pixel (opaque, so premultiplied or not is the same).
    pub rgba: Vec<u8>,
}

/// The textures of one context, and the drawing of its frames.
#[derive(Debug, Default)]
pub struct Rasteriser {
    textures: HashMap<TextureId, Texture>,
}

impl Rasteriser {
    /// Takes in new, changed and retired textures and leaves `delta` empty.
    #[expect(
        clippy::iter_over_hash_type,
        reason = "every texture stands for itself: any order"
    )]
    pub fn apply(&mut self, delta: &mut TexturesDelta) {
        for (id, changes) in delta.set.drain() {
            for change in changes {
                match change.pos {
                    None => drop(self.textures.insert(id, Texture::new(&change))),
                    Some(corner) => {
                        if let Some(texture) = self.textures.get_mut(&id) {
                            texture.patch(corner, &change);
                        }
                    }
                }
            }
        }
        for id in delta.free.drain() {
            self.textures.remove(&id);
        }
    }

    /// Draws a frame of `width` × `height` pixels over an opaque `background`.
    pub fn draw(
        &self,
        primitives: &[ClippedPrimitive],
        [width, height]: [usize; 2],
        pixels_per_point: f32,
        background: Color32,
    ) -> Picture {
        let mut canvas = Canvas {
            width,
            height,
            pixels: vec![background.to_opaque(); width * height],
        };
        for ClippedPrimitive {
            clip_rect,
            primitive,
        } in primitives
        {
            let Primitive::Mesh(mesh) = primitive else {
                continue;
            };
            let Some(texture) = self.textures.get(&mesh.texture_id) else {
                continue;
            };
            let clip = canvas.clip(*clip_rect, pixels_per_point);
            for indices in mesh.triangles() {
                let corners = indices.map(|index| {
                    let vertex = mesh.vertices[index as usize];
                    Corner::new(vertex.pos * pixels_per_point, vertex.uv, vertex.color)
                });
                canvas.fill(corners, clip, texture);
            }
        }
        canvas.into_picture()
    }
}

/// Pixel columns and rows that may be drawn on: from (inclusive), to (exclusive).
#[derive(Debug, Clone, Copy)]
struct Clip {
    columns: [i64; 2],
    rows: [i64; 2],
}

struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<Color32>,
}

impl Canvas {
    fn clip(&self, points: egui::Rect, pixels_per_point: f32) -> Clip {
        let edge = |at: f32, limit: usize| whole(at * pixels_per_point).clamp(0, signed(limit));
        Clip {
            columns: [
                edge(points.min.x, self.width),
                edge(points.max.x, self.width),
            ],
            rows: [
                edge(points.min.y, self.height),
                edge(points.max.y, self.height),
            ],
        }
    }

    fn fill(&mut self, corners: [Corner; 3], clip: Clip, texture: &Texture) {
        let Some(triangle) = triangle::Triangle::new(corners) else {
            return;
        };
        let sampler = texture.sampler(triangle.uv_per_pixel());
        let [top, bottom] = triangle.rows();
        for row in top.max(clip.rows[0])..bottom.min(clip.rows[1]) {
            let Some(Span { from, to }) = triangle.span(row, clip.columns) else {
                continue;
            };
            let mut at = triangle.at(from, row);
            let first = index(row) * self.width + index(from);
            for pixel in &mut self.pixels[first..first + index(to - from)] {
                let colour = sampler.sample(at.uv);
                *pixel = over(*pixel, at.colour, colour);
                at.advance();
            }
        }
    }

    fn into_picture(self) -> Picture {
        let rgba = self.pixels.iter().flat_map(Color32::to_array).collect();
        Picture {
            width: self.width,
            height: self.height,
            rgba,
        }
    }
}

/// `tint · texel` laid over `below`, all premultiplied: `c = s + d (1 − s_a)`.
fn over(below: Color32, tint: [f32; 4], texel: [f32; 4]) -> Color32 {
    let source: [f32; 4] = std::array::from_fn(|i| tint[i] * texel[i] * (1.0 / 255.0));
    let keep = 1.0 - source[3] * (1.0 / 255.0);
    let [r, g, b, a] = below.to_array();
    let below = [r, g, b, a];
    let mixed: [u8; 4] =
        std::array::from_fn(|i| texture::byte(source[i] + f32::from(below[i]) * keep));
    Color32::from_rgba_premultiplied(mixed[0], mixed[1], mixed[2], mixed[3])
}

/// The nearest whole pixel edge.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the cast saturates and callers clamp"
)]
fn whole(at: f32) -> i64 {
    at.round() as i64
}

/// A count as a pixel coordinate.
fn signed(count: usize) -> i64 {
    i64::try_from(count).unwrap_or(i64::MAX)
}

/// A pixel coordinate that clipping has made non-negative, as an index.
fn index(at: i64) -> usize {
    usize::try_from(at).unwrap_or(0)
}
