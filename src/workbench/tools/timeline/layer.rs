//! What is drawn of a recording: tiles that are made anew in the background when what they show has
//! changed. The old ones stay until the new are there.

use std::ops::Range;
use std::sync::Arc;

use crate::bench::Bench;
use crate::bench::applied_gains::AppliedGains;
use crate::bench::recording::Recording;
use crate::bench::recording::tiles::{TILE, Tiles};
use crate::bench::rendering::Rendering;
use crate::bench::signals::contact::ContactColumns;
use crate::bench::signals::rows::N_ROWS;
use crate::tools::timeline::columns::{
    Amplitudes, FeltColumns, Limits, Rendered, SpectrumColumns, TickColumns, n_felt_rows,
};
use crate::tools::timeline::job::{Job, MakeColumns};
use selvedge_device::{ArrayProfile, Coder, LinkScale};
use selvedge_render::array::ArrayRenderer;
use selvedge_render::scene::{ExplorationPath, Pose};

/// What decides how strong a recording is on every contactor of the display that is shown.
#[derive(Debug, Clone, PartialEq)]
struct FeltKey {
    display: usize,
    is_as_recorded: bool,
    scenes: [u64; 2],
    gains: AppliedGains,
    rendering: Rendering,
    limits: (ArrayProfile, Option<LinkScale>),
}

/// What decides which vibration arrives: the scene, the display that is shown and its contactor.
type SpectrumKey = ([u64; 2], [usize; 2]);

/// Tiles of one kind.
struct Layer<K> {
    key: Option<K>,
    path: Option<Arc<ExplorationPath>>,
    tiles: Tiles,
    job: Option<Job>,
}

impl<K> Default for Layer<K> {
    fn default() -> Self {
        Self {
            key: None,
            path: None,
            tiles: Tiles::default(),
            job: None,
        }
    }
}

impl<K: PartialEq> Layer<K> {
    /// Begins to make tiles of a path anew if the key has changed, those around `focus` first, and
    /// takes what is made. Why it failed, once.
    fn follow(
        &mut self,
        bench: &Bench,
        (path, focus): (&Arc<ExplorationPath>, u64),
        (key, n_rows): (K, usize),
        make: impl FnOnce(&K) -> MakeColumns,
    ) -> Option<String> {
        let is_same_path = self
            .path
            .as_ref()
            .is_some_and(|known| Arc::ptr_eq(known, path));
        if !is_same_path || self.tiles.n_rows != n_rows {
            self.tiles = Tiles::new(n_rows, path.n_ticks());
            self.key = None;
        }
        let each = self.tiles.ticks_per_column();
        let focus = focus / each / TILE;
        if self.key.as_ref() != Some(&key) {
            let made = make(&key);
            self.job = Some(Job::start(
                &bench.executor,
                (Arc::clone(path), each),
                focus,
                made,
            ));
            self.path = Some(Arc::clone(path));
            self.key = Some(key);
        }
        let job = self.job.as_mut()?;
        job.look_at(focus);
        match job.take_into(&mut self.tiles) {
            Ok(true) => None,
            Ok(false) => {
                self.job = None;
                None
            }
            Err(why) => {
                self.job = None;
                Some(why)
            }
        }
    }

    /// How far the work is, 0…1; `None` when all is done.
    fn share(&self) -> Option<f32> {
        self.job.as_ref().map(Job::share)
    }
}

/// All that is drawn of a recording.
#[derive(Default)]
pub(crate) struct RecordedTiles {
    felt: Layer<FeltKey>,
    spectrum: Layer<SpectrumKey>,
}

impl RecordedTiles {
    /// Speed, levels and limits.
    pub(crate) fn felt(&self) -> &Tiles {
        &self.felt.tiles
    }

    /// What arrives at the contactor.
    pub(crate) fn spectrum(&self) -> &Tiles {
        &self.spectrum.tiles
    }

    /// How far the work is, 0…1; `None` when all is done.
    pub(crate) fn share(&self) -> Option<f32> {
        let shares = [self.felt.share(), self.spectrum.share()];
        shares.into_iter().flatten().min_by(f32::total_cmp)
    }

    /// Lets tiles follow a recording, the scene and the contactor; those around the tick `focus`
    /// are made first. Why that failed, once.
    pub(crate) fn follow(
        &mut self,
        bench: &Bench,
        recording: &Recording,
        (contactor, is_as_recorded): (usize, bool),
        focus: u64,
    ) -> Option<String> {
        let scenes = [bench.inspection.n_scenes, bench.inspection.n_edits];
        let scale = bench.live.bridge.as_ref().and_then(|bridge| bridge.scale);
        let display = bench.display();
        let (scene, path) = (bench.document.scene(), recording.path());
        let key = FeltKey {
            display,
            is_as_recorded: is_as_recorded && recording.has_display(scene, display),
            scenes,
            gains: bench.engine_scene.applied_gains.clone(),
            rendering: bench.engine_scene.rendering,
            limits: (bench.array(), scale),
        };
        let mut shown = scene.contactors_of(display);
        if key.is_as_recorded {
            shown.end = shown.end.min(recording.n_contactors());
        }
        let n_rows = n_felt_rows(shown.len());
        let felt = self
            .felt
            .follow(bench, (path, focus), (key, n_rows), |key| {
                felt_columns(bench, recording, (key, shown))
            });
        let key = (scenes, [display, contactor]);
        let spectrum = self
            .spectrum
            .follow(bench, (path, focus), (key, N_ROWS), |key| {
                spectrum_columns(bench, key.1)
            });
        felt.or(spectrum)
    }
}

fn felt_columns(
    bench: &Bench,
    recording: &Recording,
    (key, shown): (&FeltKey, Range<usize>),
) -> MakeColumns {
    let (key, recording) = (key.clone(), recording.clone());
    let scene = bench.inspection.scene.clone();
    let n_contactors = shown.len();
    Box::new(move || {
        let amplitudes = if key.is_as_recorded {
            Amplitudes::Recorded(recording.clone(), shown)
        } else {
            let (method, accuracy) = (key.rendering.method, key.rendering.accuracy());
            let renderer = ArrayRenderer::prepare(&scene, method, &accuracy);
            Amplitudes::Rendered(Box::new(Rendered {
                renderer: renderer.map_err(|error| error.to_string())?,
                mask: key.gains.contactor_mask().to_vec(),
                poses: vec![Pose::default(); scene.displays.len()],
            }))
        };
        let columns: Box<dyn TickColumns> = Box::new(FeltColumns {
            display: key.display,
            amplitudes,
            n_contactors,
            limits: limits(&key.limits, n_contactors),
            missing: recording.missing().to_vec(),
            apply_ticks: Arc::clone(recording.apply_ticks()),
        });
        Ok(columns)
    })
}

/// The limits of an array and a device for so many contactors.
pub(crate) fn limits(
    (profile, scale): &(ArrayProfile, Option<LinkScale>),
    n_contactors: usize,
) -> Limits {
    let mut coder = Coder::new(profile, n_contactors);
    coder.set_link(*scale);
    Limits::of(coder, n_contactors)
}

fn spectrum_columns(bench: &Bench, contactor: [usize; 2]) -> MakeColumns {
    let inspector = bench.inspection.inspector.clone();
    Box::new(move || {
        let columns: Box<dyn TickColumns> = Box::new(SpectrumColumns {
            inspector,
            contactor,
            columns: ContactColumns::default(),
        });
        Ok(columns)
    })
}
