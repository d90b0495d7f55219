//! What a row of tabs has room for: a narrow one shortens its titles before it scrolls.

use eframe::egui::{Color32, Ui};

use crate::bench::export::button::SIZE as EXPORT_SIZE;
use crate::bench::pane::Pane;
use crate::kit::theme;

/// Space on both sides of a title, points.
pub(crate) const TITLE_SPACING: f32 = 8.0;

/// What a row of tabs has room for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum TabRow {
    /// Titles, and beside them what belongs to the pane in front.
    #[default]
    Roomy,
    /// Short titles, and beside them what belongs to the pane in front.
    Short,
    /// Titles alone.
    Titles,
    /// Short titles alone.
    ShortTitles,
}

impl TabRow {
    /// For a row this wide, points.
    pub(crate) fn of(ui: &Ui, titles: &[Pane], corner: f32) -> Self {
        let width = |title: &str| {
            let ink = Color32::PLACEHOLDER;
            let galley = ui
                .painter()
                .layout_no_wrap(title.to_owned(), theme::small(), ink);
            galley.size().x + 2.0 * TITLE_SPACING
        };
        let needed: f32 = titles.iter().map(|pane| width(pane.title())).sum();
        let least: f32 = titles.iter().map(|pane| width(pane.short_title())).sum();
        let room = ui.available_width();
        if needed + corner <= room {
            Self::Roomy
        } else if least + corner <= room {
            Self::Short
        } else if needed <= room {
            Self::Titles
        } else {
            Self::ShortTitles
        }
    }

    /// Whether what belongs to the pane in front stands beside the titles.
    pub(crate) fn has_corner(self) -> bool {
        matches!(self, Self::Roomy | Self::Short)
    }
}

/// Width of what stands at the right end of a row of tabs, points.
pub(crate) fn corner_width(pane: Pane) -> f32 {
    let export = if pane.has_export() {
        EXPORT_SIZE + TITLE_SPACING
    } else {
        0.0
    };
    pane.corner_width() + export
}
