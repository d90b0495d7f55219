//! One contactor at one tick, explained: every number from its place to its drive code, in order.
//!
//! The numbers come from the functions that render and encode ([`ContactInspector`], [`Coder`]);
//! nothing is computed a second time here.
//!
//! [`ContactInspector`]: selvedge_render::array::ContactInspector

use crate::bench::Bench;
use crate::bench::on_finger::OnFinger;
use crate::bench::perceptual_level::PerceptualLevel;
use crate::bench::view::Source;
use selvedge_device::{ArrayProfile, Calibration, Coder, Limit, LimiterState, LinkScale};
use selvedge_foundation::numerics::to_single;
use selvedge_render::array::{ContactTrace, Touch};
use selvedge_textile::tactile::Band;

/// One contactor at one tick, explained.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Explanation {
    /// Which contactor of the first display.
    pub contactor: usize,
    /// Its row and column, if the display is a grid.
    pub cell: Option<(usize, usize)>,
    /// The tick, counted by the engine, or by the recording that is replayed.
    pub tick: u64,
    /// From place to amplitudes.
    pub trace: ContactTrace,
    /// What the textile is called in the scene: label and name.
    pub textile: Option<String>,
    /// By band, from where to where it may lie, dB from what is given, where a textile's levels are
    /// not measured.
    pub(crate) known_db: Option<[[f64; 2]; 2]>,
    /// What the finger gets of both bands.
    pub(crate) on_finger: [OnFinger; 2],
    /// What the whole display feels like, by a model.
    pub(crate) perceptual_level: PerceptualLevel,
    /// Whether its amplitudes are the stylus' vibration, and not the array's rendering.
    pub(crate) is_stylus: bool,
    /// What becomes of the amplitudes at the output.
    pub output: Output,
}

/// From amplitudes to drive codes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Output {
    /// Whether a device is armed; otherwise these are the codes it would get at full gain.
    pub(crate) is_sent: bool,
    /// The soft-start gain.
    pub gain: f64,
    /// Limits of both bands that come first, and whose they are.
    pub limits: [Limit; 2],
    /// How the contactor answers its drive.
    pub calibration: Calibration,
    /// The channel that drives it.
    pub channel: usize,
    /// What the limits did.
    pub limiter: LimiterState,
    /// Codes of both bands, 0…65535.
    pub codes: [u16; 2],
}

impl Output {
    /// What a contactor of this array is told for these amplitudes, µm. The device makes
    /// `scale` of codes; `gain` is the soft-start gain of one that is armed.
    pub(crate) fn of(
        (profile, contactor): (&ArrayProfile, usize),
        amplitudes_um: [f64; 2],
        (gain, scale): (Option<f64>, Option<LinkScale>),
        on_finger: [OnFinger; 2],
    ) -> Self {
        let single = amplitudes_um.map(to_single);
        let played = |band: usize| !on_finger[band].is_silence();
        let felt = [0, 1].map(|band| if played(band) { single[band] } else { 0.0 });
        let mut coder = Coder::of_contactor(profile, contactor);
        coder.set_link(scale);
        let codes = coder.encode(&[felt], gain.unwrap_or(1.0));
        Self {
            is_sent: gain.is_some(),
            gain: gain.unwrap_or(1.0),
            limits: coder.limits(0),
            calibration: profile.calibration_of(contactor),
            channel: profile.channel_of(contactor),
            limiter: coder.limited().first().copied().unwrap_or_default(),
            codes: codes.first().copied().unwrap_or_default(),
        }
    }
}

impl Explanation {
    /// The chosen contactor as it is now; `None` if none is chosen.
    pub(crate) fn of_chosen(bench: &mut Bench) -> Option<Self> {
        let contactor = bench.selection.contactor?;
        let live = &bench.live;
        let display = bench.display();
        let inspector = &mut bench.inspection.inspector;
        let mut trace = inspector.trace(display, contactor, &live.pose)?;
        // What a stylus drives is the first display.
        let is_stylus = live.stylus.is_some() && display == 0;
        let cloths = &bench.document.scene().textiles;
        let cloth = trace
            .touch
            .as_ref()
            .and_then(|touch| cloths.get(touch.textile));
        let textile = cloth.map(|cloth| {
            let item = bench.library.view.item(&cloth.id);
            let name = item.map_or(&cloth.id, |item| &item.name);
            format!("{} {name}", cloth.label)
        });
        let known = trace.touch.as_ref().and_then(|touch| {
            let known = bench.engine_scene.uncertainty(touch.textile)?;
            let [u, w] = touch.velocity_mm_per_s;
            let direction_deg = w.atan2(u).to_degrees();
            Some(Band::ALL.map(|band| known.level_db(band, direction_deg)))
        });
        let display = bench.document.scene().displays.get(display)?;
        let cell = display.geometry.grid().map(|(_, n_columns)| {
            let n_columns = n_columns.max(1);
            (contactor / n_columns, contactor % n_columns)
        });
        let dot = live.dots.get(contactor);
        if let Some(dot) = dot.filter(|_| is_stylus) {
            trace.amplitudes_um = dot.amplitude_um;
            // No spectrum of the textile has a part in it.
            if let Some(touch) = &mut trace.touch {
                touch.directions = Default::default();
            }
        }
        let on_finger = dot.map_or([live.on_finger; 2], |dot| dot.on_finger);
        let bridge = live.bridge.as_ref();
        let gain = bridge.and_then(|bridge| bridge.gain);
        let scale = bridge.and_then(|bridge| bridge.scale);
        let amplitudes_um = trace.amplitudes_um;
        let output = Output::of(
            (bench.engine.profile(), contactor),
            amplitudes_um,
            (gain, scale),
            on_finger,
        );
        Some(Self {
            contactor,
            cell,
            tick: match live.play.source {
                Source::Recording | Source::Stroke => live.play.tick,
                Source::Pointer | Source::Lines | Source::Device => live.tick,
            },
            trace,
            textile,
            known_db: known,
            on_finger,
            perceptual_level: live.perceptual_level,
            is_stylus,
            output,
        })
    }

    /// The contact with a textile, if there is one.
    pub(crate) fn touch(&self) -> Option<&Touch> {
        self.trace.touch.as_ref()
    }

    /// The share of each band's power that comes along warp and weft, µm².
    pub(crate) fn powers_um2(&self) -> [[f64; 2]; 2] {
        let along = |axis: usize| {
            let direction = self
                .touch()
                .and_then(|touch| touch.directions[axis].as_ref());
            direction.map_or([0.0; 2], |direction| direction.band_powers_um2)
        };
        [along(0), along(1)]
    }

    /// Amplitudes before any gain: `√(2 Σ P H²)`, µm.
    pub(crate) fn bare_um(&self) -> [f64; 2] {
        let [warp, weft] = self.powers_um2();
        [0, 1].map(|band| (2.0 * (warp[band] + weft[band])).sqrt())
    }

    /// The bins that sound below 1 kHz: frequency, Hz, and what each band takes of it, µm².
    pub(crate) fn energies(&self) -> Vec<(f64, [f64; 2])> {
        let directions = self.touch().into_iter().flat_map(|touch| &touch.directions);
        let bins = directions.flatten().flat_map(|direction| &direction.bins);
        let heard = bins.filter(|bin| bin.filter_gains.iter().any(|gain| *gain > 0.0));
        heard
            .map(|bin| {
                let taken = bin.filter_gains.map(|gain| bin.power_um2 * gain * gain);
                (bin.frequency_hz, taken)
            })
            .collect()
    }
}
