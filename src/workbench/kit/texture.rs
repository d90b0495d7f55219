//! A picture on the graphics card, made anew when what it shows has changed and then only.

use std::sync::Arc;

use eframe::egui::{
    Color32, Context, ImageData, Mesh, Painter, Pos2, Rect, Shape, TextureHandle, TextureId,
    TextureOptions, pos2,
};

/// All of a picture.
pub(crate) const WHOLE: Rect = Rect {
    min: Pos2::ZERO,
    max: pos2(1.0, 1.0),
};

/// Paints a part of a picture over an area.
pub(crate) fn paint(painter: &Painter, area: Rect, part: Rect, texture: TextureId) {
    let mut mesh = Mesh::with_texture(texture);
    mesh.add_rect_with_uv(area, part, Color32::WHITE);
    painter.add(Shape::mesh(mesh));
}

/// A shared value that is like no other, whatever the other holds.
#[derive(Debug)]
pub(crate) struct Same<T>(pub Arc<T>);

impl<T> PartialEq for Same<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// The picture of what `K` names.
pub(crate) struct Texture<K> {
    made: Option<(K, TextureHandle)>,
    /// How often it was made.
    pub(crate) n_made: u64,
}

impl<K> Default for Texture<K> {
    fn default() -> Self {
        Self {
            made: None,
            n_made: 0,
        }
    }
}

impl<K: PartialEq> Texture<K> {
    /// The picture of `key`; `image` makes it where it is another one than before.
    pub(crate) fn of<I: Into<ImageData>>(
        &mut self,
        ctx: &Context,
        (name, options): (&str, TextureOptions),
        key: K,
        image: impl FnOnce() -> I,
    ) -> TextureId {
        let texture = match self.made.take() {
            Some((before, texture)) if before == key => texture,
            Some((_, mut texture)) => {
                self.n_made += 1;
                texture.set(image(), options);
                texture
            }
            None => {
                self.n_made += 1;
                ctx.load_texture(name, image(), options)
            }
        };
        self.made.insert((key, texture)).1.id()
    }
}
