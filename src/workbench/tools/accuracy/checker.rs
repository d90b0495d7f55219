//! Ticks that the engine rendered, rendered once more by `reference`: how far off they were.
//!
//! Pure: samples in, errors out. A sample carries all that it was rendered with, so nothing that
//! changed meanwhile can be taken for an error. Amplitudes reach the window in single precision,
//! so an exact method shows errors up to [`ROUNDING_DB`].

use std::sync::Arc;

use selvedge_render::array::{Accuracy, ArrayRenderer, Method};
use selvedge_render::scene::Pose;
use selvedge_render::{ErrorMeter, LevelError, RenderScene};

/// The level error of an amplitude rounded to single precision, at most: `20 log₁₀(1 + 2⁻²⁴)` dB.
pub(crate) const ROUNDING_DB: f64 = 5.2e-7;
/// The ends of the axis that errors are counted on, dB.
pub(crate) const ERRORS_DB: [f64; 2] = [1e-8, 10.0];
/// Bins a decade of that axis.
const BINS_PER_DECADE: f64 = 8.0;

/// What ticks are rendered with: scene, filters, gains.
#[derive(Debug, Clone)]
pub(crate) struct Setting {
    /// The scene with the gains in force.
    pub scene: RenderScene,
    /// The change of the scene that it is of.
    pub(crate) n_edits: u64,
}

impl Setting {
    /// Whether this is the setting of a scene after so many edits.
    pub(crate) fn is_of(&self, scene: &RenderScene, n_edits: u64) -> bool {
        let gains = |scene: &RenderScene| -> Vec<u64> {
            let of_textiles = scene.textiles.iter().map(|placed| placed.scene_gain_db);
            of_textiles.map(f64::to_bits).collect()
        };
        self.n_edits == n_edits
            && self.scene.tuning == scene.tuning
            && gains(&self.scene) == gains(scene)
    }
}

/// A tick as the engine rendered it.
#[derive(Debug, Clone)]
pub(crate) struct TickSample {
    /// The run of the statistics that it belongs to.
    pub run: u64,
    /// What it was rendered with.
    pub setting: Arc<Setting>,
    /// The pose of every display that was rendered.
    pub(crate) poses: Vec<Pose>,
    /// Which contactors of the first display are felt; those beyond its end are.
    pub is_felt: Vec<bool>,
    /// Amplitudes [A40, A320] of every contactor, display by display, after gains and before output
    /// limits, µm.
    pub(crate) displays_um: Vec<Vec<[f32; 2]>>,
}

/// What was found so far.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct ErrorView {
    /// The run that it is of.
    pub run: u64,
    /// Ticks checked.
    pub n_ticks: u64,
    /// The largest level error of the last tick, by band, dB; `None` where nothing was loud enough.
    pub(crate) now_db: [Option<f64>; 2],
    /// The errors of the run, by band.
    pub bands: [LevelError; 2],
    /// How many amplitudes of each band lie in each bin between [`edges_db`].
    pub counts: [Vec<u64>; 2],
}

/// The ends of the bins that errors are counted in, dB.
pub(crate) fn edges_db() -> Vec<f64> {
    let [least, most] = ERRORS_DB;
    let edge = |n: u16| least * 10.0_f64.powf(f64::from(n) / BINS_PER_DECADE);
    let edges = (0..=u16::MAX).map(edge);
    edges.take_while(|db| *db <= most * 1.000_001).collect()
}

/// Renders samples anew and collects their errors.
#[derive(Debug, Default)]
pub(crate) struct Checker {
    run: u64,
    reference: Option<(Arc<Setting>, ArrayRenderer)>,
    error: ErrorMeter,
    now_db: [Option<f64>; 2],
    n_ticks: u64,
}

impl Checker {
    /// Checks a tick.
    pub(crate) fn take(&mut self, sample: &TickSample) {
        if sample.run != self.run {
            *self = Self {
                run: sample.run,
                reference: self.reference.take(),
                ..Self::default()
            };
        }
        self.prepare(&sample.setting);
        let Some((_, reference)) = &mut self.reference else {
            return;
        };
        let frames = reference.tick(&sample.poses);
        let felt = frames.iter().zip(&sample.displays_um).enumerate();
        let pairs: Vec<[[f64; 2]; 2]> = felt
            .flat_map(|(display, (frame, found_um))| {
                let is_felt = move |contactor: usize| {
                    display > 0 || sample.is_felt.get(contactor).is_none_or(|felt| *felt)
                };
                let n_contactors = frame.n_contactors().min(found_um.len());
                (0..n_contactors)
                    .filter(move |contactor| is_felt(*contactor))
                    .map(|i| [found_um[i].map(f64::from), frame.amplitude_um(i)])
            })
            .collect();
        // The whole tick is judged by the strength that it reaches itself.
        for [_, exact] in &pairs {
            self.error.reach(*exact);
        }
        self.now_db = [None; 2];
        for [found, exact] in pairs {
            let judged = self.error.judge(found, exact);
            for (now, db) in self.now_db.iter_mut().zip(judged) {
                *now = match (*now, db) {
                    (Some(before), Some(db)) => Some(before.max(db)),
                    (before, db) => before.or(db),
                };
            }
            self.error.add(found, exact);
        }
        self.n_ticks += 1;
    }

    /// What was found so far.
    pub(crate) fn view(&self) -> ErrorView {
        let edges = edges_db();
        ErrorView {
            run: self.run,
            n_ticks: self.n_ticks,
            now_db: self.now_db,
            bands: [0, 1].map(|band| self.error.of_band(band)),
            counts: [0, 1].map(|band| self.error.levels_db(band).between(&edges)),
        }
    }

    /// Makes a reference for a setting, unless it is the one at hand.
    fn prepare(&mut self, setting: &Arc<Setting>) {
        if let Some((known, _)) = &self.reference {
            if Arc::ptr_eq(known, setting) {
                return;
            }
            self.error.begin_section();
        }
        let exact = (Method::Reference, Accuracy::default());
        // The engine renders this very scene, so it can be rendered.
        self.reference = ArrayRenderer::prepare(&setting.scene, exact.0, &exact.1)
            .ok()
            .map(|reference| (Arc::clone(setting), reference));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::geometry::{Point, Velocity};
    use selvedge_render::scene::LoadedScene;

    fn setting(gain_db: f64) -> Arc<Setting> {
        let mut scene = RenderScene::of(&LoadedScene::shipped().unwrap());
        scene.tuning.gain_db += gain_db;
        Arc::new(Setting { scene, n_edits: 0 })
    }

    fn pose(n: u16) -> Pose {
        Pose {
            position: Point::new(30.0 + 0.7 * f64::from(n), 60.0),
            velocity: Velocity::new(28.0, 3.0 + f64::from(n)),
            ..Pose::default()
        }
    }

    /// What a renderer makes of a tick, as the engine hands it on.
    fn sample(renderer: &mut ArrayRenderer, setting: &Arc<Setting>, n: u16) -> TickSample {
        let frames = renderer.tick(&[pose(n)]);
        TickSample {
            run: 0,
            setting: Arc::clone(setting),
            poses: vec![pose(n)],
            is_felt: Vec::new(),
            displays_um: frames.iter().map(|f| f.amplitudes_um().to_vec()).collect(),
        }
    }

    fn renderer(setting: &Setting, method: Method) -> ArrayRenderer {
        ArrayRenderer::prepare(&setting.scene, method, &Accuracy::default()).unwrap()
    }

    #[test]
    fn a_run_of_the_reference_is_off_by_its_rounding_alone() {
        let setting = setting(0.0);
        let mut reference = renderer(&setting, Method::Reference);
        let mut checker = Checker::default();
        (0..60).for_each(|n| checker.take(&sample(&mut reference, &setting, n)));
        let view = checker.view();
        assert_eq!(view.n_ticks, 60);
        for band in view.bands {
            assert!(band.n_amplitudes > 1000, "{band:?}");
            assert!(band.max_db <= ROUNDING_DB, "{band:?}");
        }
        let counted: u64 = view.counts[0].iter().sum();
        assert_eq!(counted, view.bands[0].n_amplitudes);
    }

    #[test]
    fn a_table_is_off_by_more_than_rounding_and_within_its_bound() {
        let setting = setting(-7.0);
        let mut table = renderer(&setting, Method::Table);
        let mut checker = Checker::default();
        (0..60).for_each(|n| checker.take(&sample(&mut table, &setting, n)));
        let most_db = f64::max(
            checker.view().bands[0].max_db,
            checker.view().bands[1].max_db,
        );
        assert!(most_db > 10.0 * ROUNDING_DB, "{most_db}");
        assert!(most_db <= table.bound().level_db, "{most_db}");
    }

    #[test]
    fn a_wrong_amplitude_shows_and_a_masked_one_does_not() {
        let setting = setting(0.0);
        let mut reference = renderer(&setting, Method::Reference);
        let mut wrong = sample(&mut reference, &setting, 3);
        wrong.displays_um[0][5][1] *= 1.1;
        let mut checker = Checker::default();
        checker.take(&wrong);
        let [low, high] = checker.view().now_db;
        assert!(low.unwrap() <= ROUNDING_DB, "{low:?}");
        assert!((high.unwrap() - 0.8279).abs() < 1e-3, "{high:?}");
        wrong.is_felt = (0..24).map(|contactor| contactor != 5).collect();
        wrong.run = 1;
        checker.take(&wrong);
        let view = checker.view();
        assert!(view.now_db[1].unwrap() <= ROUNDING_DB, "{view:?}");
        assert_eq!((view.run, view.n_ticks), (1, 1), "a new run begins anew");
    }

    #[test]
    fn another_gain_is_no_error_once_the_sample_says_so() {
        let (quiet, loud) = (setting(0.0), setting(12.0));
        let mut checker = Checker::default();
        for (n, setting) in [(0, &quiet), (1, &loud), (2, &quiet)] {
            let mut reference = renderer(setting, Method::Reference);
            checker.take(&sample(&mut reference, setting, n));
        }
        assert!(checker.view().bands[0].max_db <= ROUNDING_DB);
        assert!(quiet.is_of(&quiet.scene, 0) && !quiet.is_of(&loud.scene, 0));
        assert!(!quiet.is_of(&quiet.scene, 1), "the scene was edited");
    }
}
