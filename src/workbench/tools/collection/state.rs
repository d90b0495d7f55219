//! The library as a whole: what is chosen of it, and the library as it is drawn by that.

use crate::bench::library_selection::LibrarySelection;
use crate::bench::view::{LibraryEntry, SceneView};
use crate::tools::collection::listing::{Only, Sort};
use crate::tools::collection::measure::Measure;
use crate::tools::collection::measuring::{Asked, Figures, Measurements};
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

impl Choice {
    /// Makes another choice, with a speed that can be chosen.
    pub(crate) fn take(&mut self, other: Self) {
        let [least, most] = SPEEDS_MM_PER_S;
        let speed_mm_per_s = if other.speed_mm_per_s.is_nan() {
            self.speed_mm_per_s
        } else {
            other.speed_mm_per_s.clamp(least, most)
        };
        *self = Self {
            speed_mm_per_s,
            ..other
        };
    }
}

/// The library as a whole.
#[derive(Debug, Default)]
pub(crate) struct Collection {
    /// What is shown, and how.
    pub choice: Choice,
    /// What is typed in the field that searches it.
    pub search: String,
    /// The textile under the pointer in the pane, for the next frame.
    pub pointed: Option<String>,
    /// What was measured.
    pub(crate) measurements: Measurements,
}

/// A textile of the library as the pane draws it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entry<'a> {
    /// What it is.
    pub item: &'a LibraryEntry,
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
    pub choice: Choice,
    /// The textiles that match search and filter, in the chosen order.
    pub entries: Vec<Entry<'a>>,
    /// All textiles of the library, in its own order.
    pub items: &'a [LibraryEntry],
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
    /// Forgets what belongs to a library that is left.
    pub(crate) fn leave_library(&mut self) {
        self.pointed = None;
        self.measurements = Measurements::default();
        self.choice.only = Only::All;
        for (axis, default) in self.choice.axes.iter_mut().zip(Choice::default().axes) {
            if matches!(axis, Measure::Figure(_)) {
                *axis = default;
            }
        }
    }

    /// The library as it is drawn in a scene.
    pub(crate) fn view<'a>(
        &'a self,
        items: &'a [LibraryEntry],
        scene: &SceneView,
        selection: &LibrarySelection,
    ) -> CollectionView<'a> {
        let asked = Asked {
            speed_mm_per_s: self.choice.speed_mm_per_s,
            filters: scene.filters,
        };
        let entry = |item: &'a LibraryEntry| {
            let figures = self.measurements.figures(&asked, &item.id);
            let is_pointed = self.pointed.as_ref() == Some(&item.id);
            Entry {
                item,
                figures,
                gains_db: gains_db(scene, item, figures),
                placed: scene.placed(&item.id),
                is_selected: selection.0.contains(&item.id),
                is_marked: is_pointed || scene.is_placed_and_marked(&item.id),
            }
        };
        let choice = self.choice.clone();
        let is_shown = |item: &&LibraryEntry| choice.only.takes(item) && item.matches(&self.search);
        let mut entries: Vec<Entry<'a>> = items.iter().filter(is_shown).map(entry).collect();
        choice.sort.order(&mut entries, choice.is_tuned);
        CollectionView {
            entries,
            items,
            progress: self.measurements.progress(&asked),
            is_halted: self.measurements.is_halted(&asked),
            n_selected: selection.0.len(),
            choice,
        }
    }
}

/// What the present tuning adds to a textile of the library, by band, dB. Compression goes by the
/// level at 100 mm/s whatever speed is shown.
fn gains_db(scene: &SceneView, item: &LibraryEntry, figures: Option<&Figures>) -> [f64; 2] {
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
