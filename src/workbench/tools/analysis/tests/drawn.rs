//! The pane as it is drawn: in both themes, wide and narrow, and covered while a session is held.

use eframe::egui::{Color32, Id, Theme, Vec2};
use egui_tiles::{Tiles, Tree};

use super::*;
use crate::shell::raster::{Picture, Rasteriser};

/// A window with nothing in it but the pane.
pub(crate) struct Drawn {
    pub(crate) window: Headless,
    rasteriser: Rasteriser,
    size: Vec2,
}

impl Drawn {
    pub(crate) fn new(size: Vec2, theme: Theme, asked: &Asked) -> Self {
        let window = Headless::new(None, size, 1.0).unwrap();
        window.ctx.set_theme(theme);
        let mut drawn = Self {
            window,
            rasteriser: Rasteriser::default(),
            size,
        };
        drawn.pass(2);
        let mut tiles = Tiles::default();
        let root = arrangement::tabs(&mut tiles, &[Pane::Analysis]);
        drawn.window.workbench.shell.tree = Tree::new(Id::unique("alone"), root, tiles);
        ask(&mut drawn.window, asked);
        drawn
    }

    pub(crate) fn pass(&mut self, n_frames: u32) {
        for _ in 0..n_frames {
            let mut output = self.window.run();
            self.rasteriser.apply(&mut output.textures_delta);
        }
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a window's size"
    )]
    pub(crate) fn picture(&mut self, name: &str) -> Picture {
        self.pass(4);
        let mut output = self.window.run();
        self.rasteriser.apply(&mut output.textures_delta);
        let primitives = self.window.ctx.tessellate(output.shapes, 1.0);
        let size = [self.size.x as usize, self.size.y as usize];
        let picture = self.rasteriser.draw(&primitives, size, 1.0, Color32::BLACK);
        if let Ok(out) = std::env::var("SELVEDGE_PICTURES") {
            let path = Path::new(&out).join(format!("{name}.png"));
            let bytes =
                selvedge_foundation::files::encode_png_rgba(&picture.rgba, size[0], size[1], &path);
            fs::write(path, bytes.unwrap()).unwrap();
        }
        picture
    }
}

/// Pixels that are brighter than so much.
fn n_brighter(picture: &Picture, least: u8) -> usize {
    let pixels = picture.rgba.chunks_exact(4);
    pixels
        .filter(|pixel| pixel[..3].iter().all(|c| *c > least))
        .count()
}

#[test]
fn sections_are_drawn_dark_and_light_wide_and_narrow() {
    let folder = Folder::new("drawn");
    study(&folder, 2);
    let asked = asked(&folder.0);
    for (word, theme, size) in [
        ("dark", Theme::Dark, vec2(1100.0, 820.0)),
        ("light", Theme::Light, vec2(1100.0, 820.0)),
        ("narrow", Theme::Dark, vec2(420.0, 820.0)),
    ] {
        let mut drawn = Drawn::new(size, theme, &asked);
        let empty = drawn.picture(&format!("empty-{word}"));
        open(&mut drawn.window, &folder.0);
        drawn.pass(2);
        let sections = analysis(&drawn.window)
            .found
            .as_ref()
            .unwrap()
            .analysis
            .sections
            .clone();
        let is_looked_at = std::env::var("SELVEDGE_PICTURES").is_ok();
        for (nth, section) in sections.iter().enumerate() {
            let is_drawn = section.figures.len() == 1 || section.notes.len() > 5;
            if !(is_drawn || is_looked_at) {
                continue;
            }
            analysis_mut(&mut drawn.window).section = nth;
            let picture = drawn.picture(&format!("{word}-{}", section.key));
            assert_ne!(picture.rgba, empty.rgba, "{}", section.key);
            // No white paper in a dark window.
            if theme == Theme::Dark {
                let n_pixels = picture.rgba.len() / 4;
                let n_white = n_brighter(&picture, 215);
                assert!(
                    n_white < n_pixels / 12,
                    "{n_white} bright in {}",
                    section.key
                );
            }
        }
    }
}
