//! The whole library at once: what of it is shown, on which axes, and which of it is selected.
//!
//! ```text
//! library ─▶ measuring (a thread: levels at the chosen speed) ─┐
//! choice (speed, axes, tuned or raw, search, order) ───────────┼▶ CollectionView ─▶ pane, export
//! tuning, manifests' gains, reference level ───────────────────┘
//! ```
//!
//! Neither saved nor undone. Gains are applied when it is drawn, so that no slider computes
//! anything.

pub(crate) mod dispatch;
pub(crate) mod export;
pub(crate) mod listing;
pub(crate) mod measure;
pub(crate) mod measuring;
#[cfg(test)]
mod tests;
pub(crate) mod view;

pub(crate) use crate::tools::collection::listing::Only;
pub(crate) use crate::tools::collection::listing::Sort;
#[cfg(test)]
pub(crate) use crate::tools::collection::listing::SortBy;
pub(crate) use crate::tools::collection::measure::Measure;
pub(crate) use crate::tools::collection::measuring::Asked;
pub(crate) use crate::tools::collection::measuring::Figures;
pub(crate) use crate::tools::collection::measuring::Measurements;

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::bench::command::Command;
use crate::bench::view::{SceneView, ShelfItem};
use selvedge_foundation::quantity::factor_of_gain;
use selvedge_render::GainTerms;
use selvedge_textile::tactile::{Band, LEVEL_SPEED_MM_PER_S};

/// Least and largest speed that can be chosen, mm/s.
pub(crate) const SPEEDS_MM_PER_S: [f64; 2] = [1.0, 1000.0];

/// How the library is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Mode {
    /// As points of a plot, with a table beside it.
    #[default]
    Plot,
    /// As pieces of cloth.
    Cloths,
}

/// What is shown of the library, and how.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Choice {
    /// As a plot or as pieces of cloth.
    pub mode: Mode,
    /// The speed along one axis at which textiles are felt, mm/s.
    pub speed_mm_per_s: f64,
    /// What the horizontal and the vertical axis show.
    pub axes: [Measure; 2],
    /// Whether gains and compression are applied.
    pub(crate) is_tuned: bool,
    /// The order of table and pieces.
    pub sort: Sort,
    /// Which textiles are shown.
    pub only: Only,
}

impl Default for Choice {
    fn default() -> Self {
        Self {
            mode: Mode::default(),
            speed_mm_per_s: LEVEL_SPEED_MM_PER_S,
            axes: [Band::Low, Band::High].map(Measure::Amplitude),
            is_tuned: true,
            sort: Sort::default(),
            only: Only::All,
        }
    }
}

/// How a textile joins what is selected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Joining {
    /// In the place of what was selected.
    Alone,
    /// Beside it, or taken away from it if it was.
    Toggled,
    /// Beside it.
    Also,
}

/// What can be done with the library as a whole. Never undoable.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum CollectionCommand {
    /// Show this of it.
    Choose(Choice),
    /// Select these textiles, by their ids.
    Select(Vec<String>, Joining),
    /// Carry a textile into the workspace, which comes in sight.
    Carry,
    /// Stop measuring.
    Stop,
    /// Go on with it.
    GoOn,
}

impl From<CollectionCommand> for Command {
    fn from(command: CollectionCommand) -> Self {
        Self::Collection(command)
    }
}

/// What the window knows of the library as a whole.
#[derive(Debug, Default)]
pub(crate) struct Collection {
    /// What is shown, and how.
    pub choice: Choice,
    /// What is typed in the field that searches it.
    pub search: String,
    /// The ids of the textiles that are selected.
    pub selected: Arc<BTreeSet<String>>,
    /// The textile under the pointer in the pane, for the next frame.
    pub pointed: Option<String>,
    /// What was measured.
    pub(crate) measurements: Measurements,
}

/// A textile of the library as the pane draws it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entry<'a> {
    /// What it is.
    pub item: &'a ShelfItem,
    /// What it gives without any gain; `None` until it is measured.
    pub figures: Option<&'a Figures>,
    /// What the present tuning adds to both bands, dB.
    pub gains_db: [f64; 2],
    /// Its first place in the scene's list.
    pub placed: Option<usize>,
    /// Whether it is selected.
    pub(crate) is_selected: bool,
    /// Whether the pointer rests on it or it is chosen, in whichever view.
    pub(crate) is_marked: bool,
}

/// The library as the pane draws it.
#[derive(Debug, Clone)]
pub(crate) struct CollectionView<'a> {
    /// What is shown, and how.
    pub choice: &'a Choice,
    /// The textiles that match search and filter, in the chosen order.
    pub entries: Vec<Entry<'a>>,
    /// All textiles of the library, in its own order.
    pub items: &'a [ShelfItem],
    /// How many of them are measured, while that goes on.
    pub progress: Option<usize>,
    /// Whether measuring was stopped before its end.
    pub(crate) is_halted: bool,
    /// How many textiles are selected, shown or not.
    pub(crate) n_selected: usize,
}

impl Entry<'_> {
    /// The value of a measure, with the tuning or without; `None` where there is none.
    pub(crate) fn value(&self, measure: &Measure, is_tuned: bool) -> Option<f64> {
        let gains_db = if is_tuned { self.gains_db } else { [0.0; 2] };
        measure.value(self.item, self.figures, gains_db)
    }

    /// Mean amplitudes [A40, A320] with the tuning or without, µm; zeros for silence.
    pub(crate) fn mean_um(&self, is_tuned: bool) -> Option<[f64; 2]> {
        let gains_db = if is_tuned { self.gains_db } else { [0.0; 2] };
        let mean_um = self.figures?.levels.mean_um;
        Some([0, 1].map(|b| mean_um[b] * factor_of_gain(gains_db[b])))
    }
}

impl<'a> CollectionView<'a> {
    /// The entries that are selected, or all where none of them is.
    pub(crate) fn listed(&self) -> Vec<Entry<'a>> {
        let selected: Vec<Entry<'a>> = self.selected().collect();
        if selected.is_empty() {
            return self.entries.clone();
        }
        selected
    }

    /// The entries that are selected.
    pub(crate) fn selected(&self) -> impl Iterator<Item = Entry<'a>> {
        self.entries.iter().filter(|one| one.is_selected).copied()
    }

    /// What can be chosen for an axis.
    pub(crate) fn measures(&self) -> Vec<Measure> {
        Measure::all(self.items)
    }
}

impl Collection {
    /// What is asked of every textile: the chosen speed and the scene's filters.
    pub(crate) fn asked(&self, scene: &SceneView) -> Asked {
        Asked {
            speed_mm_per_s: self.choice.speed_mm_per_s,
            filters: scene.filters,
        }
    }

    /// Makes the choice, with a speed that can be chosen.
    pub(crate) fn choose(&mut self, choice: Choice) {
        let [least, most] = SPEEDS_MM_PER_S;
        let speed_mm_per_s = if choice.speed_mm_per_s.is_nan() {
            self.choice.speed_mm_per_s
        } else {
            choice.speed_mm_per_s.clamp(least, most)
        };
        self.choice = Choice {
            speed_mm_per_s,
            ..choice
        };
    }

    /// Selects textiles.
    pub(crate) fn select(&mut self, ids: Vec<String>, joining: Joining) {
        let selected = Arc::make_mut(&mut self.selected);
        match joining {
            Joining::Alone => *selected = ids.into_iter().collect(),
            Joining::Also => selected.extend(ids),
            Joining::Toggled => {
                for id in ids {
                    if !selected.remove(&id) {
                        selected.insert(id);
                    }
                }
            }
        }
    }

    /// Forgets what belongs to a library that is left.
    pub(crate) fn leave_library(&mut self) {
        self.selected = Arc::default();
        self.pointed = None;
        self.measurements = Measurements::default();
        self.choice.only = Only::All;
        for (axis, default) in self.choice.axes.iter_mut().zip(Choice::default().axes) {
            if matches!(axis, Measure::Figure(_)) {
                *axis = default;
            }
        }
    }

    /// The library as it is drawn in a scene. `search` is what is typed in the field.
    pub(crate) fn view<'a>(
        &'a self,
        items: &'a [ShelfItem],
        scene: &SceneView,
        search: &str,
    ) -> CollectionView<'a> {
        let asked = self.asked(scene);
        let entry = |item: &'a ShelfItem| {
            let figures = self.measurements.figures(&asked, &item.id);
            let is_pointed = self.pointed.as_ref() == Some(&item.id);
            Entry {
                item,
                figures,
                gains_db: gains_db(scene, item, figures),
                placed: scene.placed(&item.id),
                is_selected: self.selected.contains(&item.id),
                is_marked: is_pointed || scene.is_placed_and_marked(&item.id),
            }
        };
        let is_shown = |item: &&ShelfItem| self.choice.only.takes(item) && item.matches(search);
        let mut entries: Vec<Entry<'a>> = items.iter().filter(is_shown).map(entry).collect();
        self.choice.sort.order(&mut entries, self.choice.is_tuned);
        CollectionView {
            choice: &self.choice,
            entries,
            items,
            progress: self.measurements.progress(&asked),
            is_halted: self.measurements.is_halted(&asked),
            n_selected: self.selected.len(),
        }
    }
}

/// What the present tuning adds to a textile of the library, by band, dB. Compression goes by the
/// level at 100 mm/s whatever speed is shown.
fn gains_db(scene: &SceneView, item: &ShelfItem, figures: Option<&Figures>) -> [f64; 2] {
    let tuning = &scene.tuning;
    let level_db = figures.and_then(|figures| figures.level_db);
    let compress = |reference_db| tuning.compression_gain_db(level_db, reference_db);
    let terms = GainTerms {
        master_db: tuning.gain_db,
        band_db: 0.0,
        manifest_db: item.gain_db,
        scene_db: 0.0,
        compression_db: scene.reference_db.map_or(0.0, compress),
    };
    [tuning.gain_40_db, tuning.gain_320_db].map(|band_db| GainTerms { band_db, ..terms }.total_db())
}
