//! The contrast of the heatmaps: the scale that all views share, or each frame's own; chosen over
//! them.

use eframe::egui::{Align2, Painter, Rect, Ui, pos2};

use crate::bench::command::ShowCommand;
use crate::bench::tool::PaneContext;
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::theme::colour_map::ColourMap;
use crate::kit::widgets::bar::colour_bar;
use crate::kit::widgets::text::{paint_quiet, toggle};
use crate::tools::contactors::{Contactors, HeatmapStyle, digits};
use selvedge_textile::tactile::Band;

impl Contactors {
    /// What stands over the heatmaps: numbers, the contrast, the scale's top.
    pub(super) fn show_corner(&mut self, ui: &mut Ui, context: &mut PaneContext<'_>) {
        let bench = &mut *context.bench;
        let before = HeatmapStyle::of(bench);
        let (mut style, scale) = (before, before.scale);
        style.has_numbers ^= toggle(ui, "123", before.has_numbers, "Numbers in the cells (N)");
        let tip = "Hollow and grey what is below the threshold of detection, by a model";
        style.greys_below ^= toggle(ui, "SL", before.greys_below, tip);
        let (word, tip) = match (self.is_own_contrast, scale.is_locked()) {
            (true, _) => (
                "own",
                "Every frame in its own contrast, which shows the pattern inside a textile; click \
                 for the scale that all views share",
            ),
            (false, true) => (
                "fixed",
                "The scale of amplitudes is fixed everywhere; click to let it follow them",
            ),
            (false, false) => (
                "auto",
                "The scale of amplitudes follows them everywhere; click for the contrast of every \
                 frame alone",
            ),
        };
        if toggle(ui, word, self.is_own_contrast || scale.is_locked(), tip) {
            let is_auto = !self.is_own_contrast && !scale.is_locked();
            style.scale = scale.with_lock(self.is_own_contrast);
            self.is_own_contrast = is_auto;
            ui.ctx().request_repaint();
        }
        let tops = [
            ("−", 0.4, "A scale that ends lower, fixed"),
            ("+", 2.0, "A scale that ends higher, fixed"),
        ];
        for (sign, factor, tip) in tops.into_iter().rev() {
            if toggle(ui, sign, false, tip) {
                style.scale = scale.locked_at(scale.most_um() * factor);
                self.is_own_contrast = false;
            }
        }
        if style != before {
            bench.settings.preferences.has_numbers = style.has_numbers;
            bench.selection.greys_below = style.greys_below;
            bench.selection.scale = style.scale;
            ui.ctx().request_repaint();
        }
        if bench.selection.mute_solo.is_any()
            && toggle(
                ui,
                "all",
                false,
                "Feel everything again: end every mute and solo (H)",
            )
        {
            context.commands.push(ShowCommand::HearAll.into());
        }
    }
}

/// The bar of a frame's own contrast: what both ends stand for in each band.
pub(super) fn paint_own_bar(painter: &Painter, bar: Rect, map: ColourMap, ends_um: [[f64; 2]; 2]) {
    let palette = Palette::of(painter.ctx().theme());
    colour_bar(painter, bar, |share| map.colour(share));
    for band in Band::ALL {
        let down = f32::from(u8::from(band == Band::High)) * 11.0;
        let [least_um, most_um] = ends_um[band.index()];
        let places = [
            (most_um, bar.top() + 4.0 + down),
            (least_um, bar.bottom() - 15.0 + down),
        ];
        for (um, y) in places {
            let at = pos2(bar.right() + 4.0, y);
            let (font, ink) = (theme::small_number(), palette.band(band));
            painter.text(at, Align2::LEFT_CENTER, digits(um), font, ink);
        }
    }
    let at = pos2(bar.left() - 6.0, bar.top() - 11.0);
    paint_quiet(painter, at, Align2::LEFT_CENTER, "own µm");
}
