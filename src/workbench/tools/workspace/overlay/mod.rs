//! What can be drawn over the cloth: points 1 mm apart, what the contactors read, how they move,
//! and maps of what a textile would give. Each can be switched; none computes anything while off.

pub(crate) mod lattice;
pub(crate) mod map;
pub(crate) mod motion;

pub(crate) use crate::tools::workspace::overlay::lattice::Lattice;

pub(crate) use crate::tools::workspace::overlay::map::paint_legend;
pub(crate) use crate::tools::workspace::overlay::map::words_at;
pub(crate) use crate::tools::workspace::overlay::motion::paint_readings;
pub(crate) use crate::tools::workspace::overlay::motion::paint_velocities;

use eframe::egui::containers::menu::{MenuButton, MenuConfig};
use eframe::egui::{Button, Painter, PopupCloseBehavior, RichText, Ui, vec2};

use crate::bench::command::{Commands, ShowCommand};
use crate::bench::view::Cloth;
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::theme::colour_map::ColourMap;
use crate::kit::view_transform::ViewTransform;
use crate::shell::menu::choice as menu_choice;
use crate::tools::workspace::Stage;
use crate::tools::workspace::maps::Maps;
use crate::tools::workspace::state::WorkspaceState;
use selvedge_render::array::ContactorReading;
use selvedge_textile::tactile::Band;

/// Something that is drawn over the cloth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Overlay {
    /// The points of the profiles, 1 mm apart.
    Points,
    /// The points that the contactors read.
    ChosenPoints,
    /// How the contactors move, and along which directions that is felt.
    Motion,
    /// The amplitude of a band that textiles would give all over at the chosen velocity.
    Map(Band),
}

/// What is drawn over the cloth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Overlays {
    points: bool,
    chosen_points: bool,
    motion: bool,
    map: Option<Band>,
}

/// What settings call each overlay, in the order of [`Overlays::ALL`].
const WORDS: [&str; 5] = [
    "points",
    "chosen points",
    "motion",
    "map 40 Hz",
    "map 320 Hz",
];

impl Overlays {
    /// Every overlay with its name, in the order in which they are offered.
    pub(crate) const ALL: [(Overlay, &'static str); 5] = [
        (Overlay::Points, "Points, 1 mm apart"),
        (Overlay::ChosenPoints, "Points that contactors read"),
        (Overlay::Motion, "Velocities and directions"),
        (Overlay::Map(Band::Low), "Map of 40 Hz"),
        (Overlay::Map(Band::High), "Map of 320 Hz"),
    ];

    /// With one more or less; of the maps one at a time.
    pub(crate) fn toggled(mut self, overlay: Overlay) -> Self {
        match overlay {
            Overlay::Points => self.points = !self.points,
            Overlay::ChosenPoints => self.chosen_points = !self.chosen_points,
            Overlay::Motion => self.motion = !self.motion,
            Overlay::Map(band) => self.map = (self.map != Some(band)).then_some(band),
        }
        self
    }

    /// Whether it is drawn.
    pub(crate) fn shows(self, overlay: Overlay) -> bool {
        match overlay {
            Overlay::Points => self.points,
            Overlay::ChosenPoints => self.chosen_points,
            Overlay::Motion => self.motion,
            Overlay::Map(band) => self.map == Some(band),
        }
    }

    /// Whether anything is drawn that needs to know what contactors read.
    pub(crate) fn need_readings(self) -> bool {
        self.chosen_points || self.motion
    }

    /// The band whose map is drawn.
    pub(crate) fn map(self) -> Option<Band> {
        self.map
    }

    /// What settings keep.
    pub(crate) fn words(self) -> Vec<String> {
        let named = Self::ALL.into_iter().zip(WORDS);
        let shown = named.filter(|((overlay, _), _)| self.shows(*overlay));
        shown.map(|(_, word)| word.to_owned()).collect()
    }

    /// What settings kept; `None` when a word is not known.
    pub(crate) fn from_words(words: &[String]) -> Option<Self> {
        words.iter().try_fold(Self::default(), |overlays, word| {
            let place = WORDS.iter().position(|known| known == word)?;
            let (overlay, _) = Self::ALL[place];
            let is_new = !overlays.shows(overlay);
            Some(if is_new {
                overlays.toggled(overlay)
            } else {
                overlays
            })
        })
    }
}

/// What overlays are drawn from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Layers<'a> {
    /// What the contactors read and how they move; empty while that is not drawn.
    pub readings: &'a [ContactorReading],
    /// Maps of the textiles.
    pub maps: &'a Maps,
    /// Pictures of the points.
    pub lattice: &'a Lattice,
    /// The colours that stand for numbers.
    pub colours: ColourMap,
}

/// Draws what lies on a textile, below the contactors.
pub(crate) fn paint_on_cloth(
    painter: &Painter,
    view: &ViewTransform,
    stage: &Stage<'_>,
    (index, cloth): (usize, &Cloth),
) {
    let overlays = stage.state.overlays;
    if overlays.map.is_some()
        && let Some(picture) = stage.layers.maps.picture(index)
    {
        map::paint(painter, view, cloth, picture);
    }
    if overlays.points {
        stage.layers.lattice.paint(painter, view, cloth);
    }
}

/// The quiet menu in the row of tools.
pub(crate) fn show_menu(
    ui: &mut Ui,
    state: &WorkspaceState,
    points_per_mm: f64,
    commands: &mut Commands,
) {
    let palette = Palette::in_ui(ui);
    let is_any = state.overlays != Overlays::default();
    let ink = if is_any { palette.text } else { palette.dim };
    let text = RichText::new("Overlay").font(theme::small()).color(ink);
    let button = Button::selectable(is_any, text)
        .min_size(vec2(56.0, crate::tools::workspace::tools::BUTTON));
    let stays = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let (response, _) = MenuButton::from_button(button).config(stays).ui(ui, |ui| {
        ui.set_min_width(230.0);
        for (overlay, label) in Overlays::ALL {
            let command = ShowCommand::Overlay(overlay);
            menu_choice(ui, label, state.overlays.shows(overlay), command, commands);
            if overlay == Overlay::Points && state.overlays.points {
                show_hint(ui, points_per_mm);
            }
        }
        let words = "Maps are after gains, at the velocity chosen in the Response pane";
        let text = RichText::new(words).font(theme::small());
        ui.label(text.color(Palette::in_ui(ui).dim));
    });
    response.on_hover_text("What is drawn over the cloth: points, readings, velocities, maps");
}

/// Says why the points are not to be seen.
fn show_hint(ui: &mut Ui, points_per_mm: f64) {
    if !lattice::has_room(points_per_mm) {
        let text = RichText::new("Come closer: there are less than 6 pixels to a mm");
        let text = text.font(theme::small());
        ui.label(text.color(Palette::in_ui(ui).dim));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overlays_are_switched_one_by_one_and_maps_one_at_a_time() {
        let mut overlays = Overlays::default();
        for (overlay, _) in Overlays::ALL {
            assert!(!overlays.shows(overlay), "{overlay:?}");
            overlays = overlays.toggled(overlay);
            assert!(overlays.shows(overlay), "{overlay:?}");
        }
        assert_eq!(overlays.map(), Some(Band::High), "the last one chosen");
        assert_eq!(overlays.toggled(Overlay::Map(Band::High)).map(), None);
    }

    #[test]
    fn what_settings_keep_comes_back() {
        let mut overlays = Overlays::default();
        for (overlay, _) in Overlays::ALL {
            overlays = overlays.toggled(overlay);
            assert_eq!(Overlays::from_words(&overlays.words()), Some(overlays));
        }
        assert_eq!(Overlays::from_words(&["ghosts".to_owned()]), None);
        let twice = ["points".to_owned(), "points".to_owned()];
        assert!(Overlays::from_words(&twice).is_some_and(|o| o.shows(Overlay::Points)));
    }
}
