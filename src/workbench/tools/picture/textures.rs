//! What every stage made as textures of the graphics card.

use std::collections::BTreeMap;
use std::sync::Arc;

use eframe::egui::{
    Color32, ImageData, Painter, Pos2, Rect, TextureFilter, TextureHandle, TextureOptions, pos2,
    vec2,
};

use crate::kit::widgets::relief3d::View3d;
use crate::tools::picture::found::Made;
use crate::tools::picture::images::Image;

/// Stages as textures, and from where the relief is looked at.
#[derive(Default)]
pub(crate) struct Textures {
    stages: BTreeMap<usize, (Image, TextureHandle)>,
    /// From where the relief is looked at.
    pub(crate) view: Option<View3d>,
    /// The relief that was shown last.
    pub(crate) made: Option<Arc<Made>>,
}

impl Textures {
    /// The texture of a card, made anew for another picture.
    fn texture(&mut self, painter: &Painter, card: usize, image: &Image) -> &TextureHandle {
        let make = || {
            let options = TextureOptions {
                magnification: TextureFilter::Nearest,
                ..TextureOptions::LINEAR
            };
            let data = ImageData::Color(Arc::clone(image));
            let name = format!("picture card {card}");
            (
                Arc::clone(image),
                painter.ctx().load_texture(name, data, options),
            )
        };
        let kept = self.stages.entry(card).or_insert_with(make);
        if !Arc::ptr_eq(&kept.0, image) {
            *kept = make();
        }
        &kept.1
    }

    /// Paints a picture as large as fits; says where.
    pub(crate) fn paint(
        &mut self,
        painter: &Painter,
        room: Rect,
        card: usize,
        image: &Image,
    ) -> Rect {
        let [w, h] = image.size.map(|n| n.max(1) as f32);
        let scale = (room.width() / w).min(room.height() / h);
        let rect = Rect::from_min_size(room.min, vec2(w, h) * scale);
        let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        let texture = self.texture(painter, card, image).id();
        painter.image(texture, rect, whole, Color32::WHITE);
        rect
    }
}
