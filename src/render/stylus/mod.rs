//! A stylus in place of the array: what a tip vibrates with drives the whole first display.
//!
//! ```text
//! place on a textile ─▶ run of contact steps ─▶ force above the device's bandwidth ─▶ two bands
//! ```
//!
//! Of that force over the last two ticks, n samples `f_i` about their mean under a periodic Hann
//! window `w_i`, the one-sided power at 20 k Hz is `P_k = 2 |Σ w_i f_i e^{−2πi ik/n}|²/(n Σ w²)`.
//! The amplitudes are those of the array's formula (Philpott & Summers 2012),
//! `A_b = c √(2 Σ_k P_k H_b(20 k)²)` below 1 kHz, with the scene's filters and c in µm/N: a sine of
//! 1 N at 320 Hz is c µm there. They come before gains, so that gains, limits and all that follows
//! treat them as rendered ones.
//!
//! A tick makes the same number of steps whatever happens, and allocates nothing.

mod settings;
mod spectrum;
mod tick_path;

use std::sync::Arc;

use crate::RenderError;
use crate::contact::{Stepper, StylusRun, StylusSetup, StylusStart};
use crate::scene::TICKS_PER_S;
use selvedge_foundation::numerics::{to_index, to_whole};
use selvedge_textile::surface::Surface;
use selvedge_textile::tactile::Filters;
use spectrum::Spectrum;

pub use settings::StylusSettings;
pub use tick_path::TickPath;

/// Most steps of a tick: 10 kHz, half a millisecond of work.
const MAX_STEPS: usize = 250;
/// Most radians that an exact wall may ring within a tick: a millisecond of work or two.
const MAX_RINGING: f64 = 4000.0;
/// Most steps that a place which is gone to is made up for with.
const MAX_CATCH_UP: usize = 1000;
/// The same in ticks: a second.
const CATCH_UP_TICKS: usize = 40;
/// A display that stands for so many ticks is at rest.
const REST_TICKS: u32 = 8;

/// What a stylus that is felt does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StylusState {
    /// It is led over a textile.
    Led,
    /// It stands, or nothing is to be felt: silent.
    AtRest,
    /// No textile that is prepared lies under the display's centre: silent.
    Away,
    /// Its motion grew without end: silent until it rests, leaps or meets another textile.
    BrokenOff,
}

/// A run that is under way.
#[derive(Debug, Clone, Copy)]
struct Leg {
    textile: usize,
    before_mm: Option<[f64; 2]>,
    place_mm: [f64; 2],
    n_still: u32,
    is_broken: bool,
}

/// A stylus, ready for the textiles of a scene. Made off the engine's thread.
#[derive(Debug)]
pub struct StylusDrive {
    /// Surface and run of every textile in the scene's list; one without a run is silent.
    textiles: Vec<(Arc<Surface>, Option<StylusRun>)>,
    n_steps: usize,
    spectrum: Spectrum,
    leg: Option<Leg>,
    state: StylusState,
    /// The textile that is felt, and the amplitudes before its gains, µm.
    driven: (usize, [f64; 2]),
}

impl StylusDrive {
    /// Steps a second that a device is driven with at a rate: a whole number of them a tick, and at
    /// most 10 kHz.
    pub fn rate_hz(rate_hz: f64) -> f64 {
        let n_steps = (rate_hz / TICKS_PER_S).ceil();
        TICKS_PER_S * n_steps.clamp(1.0, MAX_STEPS as f64)
    }

    /// A stylus for the textiles of a scene in the order of its list, those that are ready with
    /// their setup, at a rate in Hz and with so many µm a N.
    ///
    /// # Errors
    /// A setup that is none or takes too long, a drive that is no number from 0 to 1e9.
    pub fn prepare(
        textiles: Vec<(Arc<Surface>, Option<StylusSetup>)>,
        (rate_hz, um_per_n): (f64, f64),
        filters: &Filters,
    ) -> Result<Self, RenderError> {
        RenderError::within(("drive", um_per_n, "µm/N"), [0.0, 1e9])?;
        let rate_hz = Self::rate_hz(rate_hz);
        let n_steps = to_index(rate_hz / TICKS_PER_S);
        let run = |(surface, setup): (Arc<Surface>, Option<StylusSetup>)| {
            let run = setup.map(|setup| {
                let setup = StylusSetup { rate_hz, ..setup };
                check_work(&setup)?;
                StylusRun::new(setup, [0.0; 2], StylusStart::Resting)
            });
            run.transpose().map(|run| (surface, run))
        };
        Ok(Self {
            textiles: textiles.into_iter().map(run).collect::<Result<_, _>>()?,
            n_steps,
            spectrum: Spectrum::new(n_steps, um_per_n, filters),
            leg: None,
            state: StylusState::Away,
            driven: (0, [0.0; 2]),
        })
    }

    /// Whether it was made for a scene with these surfaces.
    pub fn is_for<'a>(&self, surfaces: impl ExactSizeIterator<Item = &'a Arc<Surface>>) -> bool {
        let own = self.textiles.iter().map(|(surface, _)| surface);
        own.len() == surfaces.len() && own.zip(surfaces).all(|(a, b)| Arc::ptr_eq(a, b))
    }

    /// How many ticks before a place that is gone to are felt first.
    pub fn n_catch_up(&self) -> u64 {
        let n_ticks = (MAX_CATCH_UP / self.n_steps).clamp(1, CATCH_UP_TICKS);
        to_whole(n_ticks as f64)
    }

    /// What it does.
    pub fn state(&self) -> StylusState {
        self.state
    }

    /// What a display is driven with: a textile, and amplitudes before its gains, µm.
    pub fn driven(&self) -> (usize, [f64; 2]) {
        self.driven
    }

    /// Forgets where it was: what comes next begins at rest.
    pub fn leave(&mut self) {
        self.leg = None;
        self.silence(StylusState::AtRest);
    }

    /// Goes on to a place on a textile, mm, as the tick after the last, and says how many steps
    /// that took.
    pub fn follow(&mut self, place: Option<(usize, [f64; 2])>) -> usize {
        let is_ready =
            |(textile, _): &(usize, _)| self.textiles.get(*textile).is_some_and(|t| t.1.is_some());
        let Some((textile, place_mm)) = place.filter(is_ready) else {
            self.leg = None;
            self.silence(StylusState::Away);
            return 0;
        };
        let led = self.leg.filter(|leg| leg.textile == textile);
        let led = led.map(|leg| (leg, TickPath::new(leg.before_mm, leg.place_mm, place_mm)));
        let Some((mut leg, path)) = led.filter(|(_, path)| path.is_led()) else {
            self.begin(textile, place_mm);
            return 0;
        };
        let was_at_rest = leg.n_still >= REST_TICKS;
        leg.n_still = if path.stands() {
            leg.n_still.saturating_add(1)
        } else {
            0
        };
        (leg.before_mm, leg.place_mm) = (Some(leg.place_mm), place_mm);
        self.leg = Some(leg);
        if leg.n_still >= REST_TICKS {
            self.silence(StylusState::AtRest);
            0
        } else if was_at_rest {
            self.begin(textile, place_mm);
            0
        } else if leg.is_broken {
            0
        } else {
            self.advance(leg, &path)
        }
    }

    /// Begins a run at rest.
    fn begin(&mut self, textile: usize, place_mm: [f64; 2]) {
        let run = self.textiles.get_mut(textile).and_then(|t| t.1.as_mut());
        let is_broken = !run.is_some_and(|run| run.begin(place_mm, StylusStart::Resting));
        self.silence(if is_broken {
            StylusState::BrokenOff
        } else {
            StylusState::AtRest
        });
        self.leg = Some(Leg {
            textile,
            before_mm: None,
            place_mm,
            n_still: 0,
            is_broken,
        });
    }

    /// Steps through a tick.
    fn advance(&mut self, mut leg: Leg, path: &TickPath) -> usize {
        let n_steps = self.n_steps;
        let run = self
            .textiles
            .get_mut(leg.textile)
            .and_then(|t| t.1.as_mut());
        let Some(run) = run else { return 0 };
        for (nth, sample) in (1..).zip(self.spectrum.next_tick()) {
            let is_made = run.advance(path.at(f64::from(nth) / n_steps as f64));
            *sample = run.row().vibration_n;
            leg.is_broken |= !is_made || !sample.is_finite();
            if leg.is_broken {
                break;
            }
        }
        if leg.is_broken {
            self.leg = Some(leg);
            self.silence(StylusState::BrokenOff);
        } else {
            self.state = StylusState::Led;
            self.driven = (leg.textile, self.spectrum.amplitudes_um());
        }
        n_steps
    }

    fn silence(&mut self, state: StylusState) {
        self.state = state;
        self.driven.1 = [0.0; 2];
        self.spectrum.clear();
    }
}

/// Refuses what an exact wall has to be cut into too many pieces for.
fn check_work(setup: &StylusSetup) -> Result<(), RenderError> {
    let case = setup.case();
    let ringing = (case.stiffness_n_per_m / case.mass_kg).sqrt() / TICKS_PER_S;
    let is_exact = setup.chosen().0 == Stepper::Exact && setup.sampling.is_none();
    if is_exact && ringing > MAX_RINGING {
        return Err(RenderError::stylus(
            format!("the wall rings {ringing:.0} radians in a tick of 25 ms"),
            "take method implicit-euler, or a softer wall",
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests;
