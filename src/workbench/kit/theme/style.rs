//! The toolkit's own style, made from the palette, for both themes at once.

use eframe::egui::{
    self, Color32, CornerRadius, FontFamily, Margin, Stroke, TextStyle, Theme,
    style::WidgetVisuals, vec2,
};

use crate::kit::theme::{Palette, ROW, STEP};

/// Gives `ctx` the two themes. The theme itself follows the system until somebody chooses.
pub(crate) fn install(ctx: &egui::Context) {
    ctx.set_fonts(fonts());
    for theme in [Theme::Dark, Theme::Light] {
        ctx.style_mut_of(theme, |style| {
            style.visuals = visuals(theme);
            style.text_styles = [
                (TextStyle::Small, super::small()),
                (TextStyle::Body, super::body()),
                (TextStyle::Button, super::body()),
                (TextStyle::Heading, super::title()),
                (TextStyle::Monospace, super::number()),
            ]
            .into();
            let spacing = &mut style.spacing;
            spacing.item_spacing = vec2(2.0 * STEP, STEP);
            spacing.button_padding = vec2(2.5 * STEP, 0.5 * STEP);
            spacing.interact_size = vec2(10.0 * STEP, ROW);
            spacing.menu_margin = Margin::same(8);
            spacing.tooltip_width = 320.0;
            spacing.scroll = egui::style::ScrollStyle::thin();
            style.interaction.selectable_labels = false;
            style.animation_time = 0.0;
        });
    }
}

/// The toolkit's own fonts; signs that the proportional one lacks, as ′ and ₁, are taken from the
/// monospaced one, as in figures.
fn fonts() -> egui::FontDefinitions {
    let mut fonts = egui::FontDefinitions::default();
    let monospaced = fonts.families.get(&FontFamily::Monospace);
    let signs = monospaced.and_then(|names| names.first().cloned());
    let proportional = fonts.families.entry(FontFamily::Proportional);
    proportional.or_default().extend(signs);
    fonts
}

fn visuals(theme: Theme) -> egui::Visuals {
    let palette = Palette::of(theme);
    let mut visuals = match theme {
        Theme::Dark => egui::Visuals::dark(),
        Theme::Light => egui::Visuals::light(),
    };
    visuals.panel_fill = palette.panel;
    visuals.window_fill = palette.panel;
    visuals.window_stroke = Stroke::new(1.0, palette.hairline);
    visuals.extreme_bg_color = palette.floor;
    visuals.text_edit_bg_color = Some(palette.floor);
    visuals.faint_bg_color = palette.raised;
    visuals.weak_text_color = Some(palette.dim);
    visuals.hyperlink_color = palette.text;
    visuals.error_fg_color = palette.danger;
    visuals.warn_fg_color = palette.text;
    visuals.selection.bg_fill = palette.hovered;
    visuals.selection.stroke = Stroke::new(1.0, palette.selection);
    visuals.disabled_alpha = 0.75;
    visuals.window_corner_radius = CornerRadius::same(6);
    visuals.menu_corner_radius = CornerRadius::same(6);
    visuals.popup_shadow = egui::Shadow {
        offset: [0, 4],
        blur: 12,
        spread: 0,
        color: palette.shadow,
    };
    let widgets = &mut visuals.widgets;
    widgets.noninteractive = widget(palette.panel, palette.hairline, palette.text);
    widgets.inactive = widget(palette.raised, Color32::TRANSPARENT, palette.text);
    widgets.hovered = widget(palette.hovered, Color32::TRANSPARENT, palette.text);
    widgets.active = widget(palette.hovered, palette.selection, palette.text);
    widgets.open = widget(palette.hovered, Color32::TRANSPARENT, palette.text);
    visuals
}

fn widget(fill: Color32, edge: Color32, text: Color32) -> WidgetVisuals {
    WidgetVisuals {
        bg_fill: fill,
        weak_bg_fill: fill,
        bg_stroke: Stroke::new(1.0, edge),
        corner_radius: CornerRadius::same(4),
        fg_stroke: Stroke::new(1.0, text),
        expansion: 0.0,
    }
}
