//! What every stage made as textures of the graphics card.

use std::collections::BTreeMap;
use std::sync::Arc;

use eframe::egui::{Color32, ColorImage, Painter, Rect, TextureFilter, TextureOptions, vec2};

use crate::kit::texture::{Same, Texture, WHOLE};
use crate::kit::widgets::relief3d::View3d;
use crate::tools::picture::found::Made;
use crate::tools::picture::images::Image;

/// Pictures of stages; what is numbered from here on is none.
pub(crate) const N_CARDS: usize = 10;

/// Stages as textures, and from where the relief is looked at.
pub(crate) struct Textures {
    stages: BTreeMap<usize, Texture<Same<ColorImage>>>,
    /// From where the relief is looked at.
    pub(crate) view: Option<View3d>,
    /// The relief that was shown last.
    pub(crate) made: Option<Arc<Made>>,
    /// Where the photograph ends and its relief begins, share of the width.
    pub(crate) divided_at: f32,
}

impl Default for Textures {
    fn default() -> Self {
        Self {
            stages: BTreeMap::new(),
            view: None,
            made: None,
            divided_at: 0.5,
        }
    }
}

impl Textures {
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
        let options = TextureOptions {
            magnification: TextureFilter::Nearest,
            ..TextureOptions::LINEAR
        };
        let name = format!("picture card {card}");
        let stage = self.stages.entry(card).or_default();
        let texture = stage.of(
            painter.ctx(),
            (&name, options),
            Same(Arc::clone(image)),
            || Arc::clone(image),
        );
        painter.image(texture, rect, WHOLE, Color32::WHITE);
        rect
    }
}
