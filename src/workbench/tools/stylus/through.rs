//! The stylus through the device: felt in place of the array, as the drive of the whole display.
//!
//! The textiles of the scene are prepared one after the other; what is ready is felt, the rest is
//! silent. A setting that cannot be held never reaches a device. Another scene and a session of an
//! experiment switch it off.

use std::sync::Arc;

use crate::bench::Bench;
use crate::tools::stylus::ground::{GroundKey, Grounds};
use crate::tools::stylus::settings::StylusSettings;
use selvedge_foundation::quantity;
use selvedge_render::stylus::{StylusDrive, StylusState};
use selvedge_textile::Textile;
use selvedge_textile::tactile::Filters;

/// What the engine was given: the textiles, and which of them were ready.
#[derive(Debug)]
struct Given {
    settings: StylusSettings,
    filters: Filters,
    textiles: Vec<(Arc<Textile>, bool)>,
}

/// The switch, and what is felt through it.
#[derive(Debug, Default)]
pub(crate) struct ThroughDevice {
    pub(crate) is_on: bool,
    given: Option<Given>,
    /// How it stands with it, in lines.
    notes: Vec<String>,
}

impl ThroughDevice {
    /// What is to be said while it is on, the state of the moment last.
    pub(crate) fn notes(&self, state: Option<StylusState>) -> impl Iterator<Item = &str> {
        let words = state.map(|state| match state {
            StylusState::Led => "Felt now: the stylus’ vibration, on every contactor",
            StylusState::AtRest => "Silent: the display rests",
            StylusState::Away => "Silent: no textile that is ready lies under the display’s centre",
            StylusState::BrokenOff => {
                "Silent: its motion grew without end; rest, or move onto another textile"
            }
        });
        self.notes.iter().map(String::as_str).chain(words)
    }

    /// Gives the engine what is ready and new, or the array again. Once a frame.
    pub(crate) fn follow(
        &mut self,
        settings: StylusSettings,
        grounds: &mut Grounds,
        bench: &mut Bench,
    ) {
        self.notes.clear();
        if bench.has_session() {
            // It gave the array back, or feels a stylus of its own.
            (self.is_on, self.given) = (false, None);
        }
        if self.is_on && settings.warning().is_some() {
            let words = "The array is felt: this setting cannot be held and reaches no device";
            self.notes.push(words.to_owned());
        } else if self.is_on {
            self.give(settings, grounds, bench);
            return;
        }
        if self.given.take().is_some() {
            bench.feel_stylus(None);
        }
    }

    fn give(&mut self, settings: StylusSettings, grounds: &mut Grounds, bench: &mut Bench) {
        let loaded = &bench.engine_scene.loaded;
        let filters = loaded.scene().filters;
        grounds.make_room_for(loaded.textiles().len());
        let mut textiles = Vec::new();
        let (mut unready, mut setups) = (None, Vec::new());
        for textile in loaded.textiles() {
            let key = GroundKey {
                textile: Arc::clone(textile),
                radius_mm: settings.radius_mm,
            };
            let setup = match grounds.get(&key).map(|prepared| &prepared.0) {
                Some(Ok(ground)) => Some(settings.setup(ground.contact.clone())),
                Some(Err(why)) => {
                    self.notes.push(why.clone());
                    None
                }
                None => {
                    unready.get_or_insert(key);
                    None
                }
            };
            textiles.push((Arc::clone(textile), setup.is_some()));
            setups.push((Arc::clone(textile.surface()), setup));
        }
        self.tell(&settings, &textiles);
        let is_given = self.given.as_ref().is_some_and(|given| {
            let pairs = given.textiles.iter().zip(&textiles);
            let mut same = pairs.map(|(a, b)| Arc::ptr_eq(&a.0, &b.0) && a.1 == b.1);
            given.settings == settings
                && given.filters == filters
                && given.textiles.len() == textiles.len()
                && same.all(|same| same)
        });
        if !is_given {
            match settings.drive(setups, &filters) {
                Ok(drive) => bench.feel_stylus(Some((drive, settings.words()))),
                Err(error) => {
                    self.notes.push(error.to_string());
                    bench.feel_stylus(None);
                }
            }
            self.given = Some(Given {
                settings,
                filters,
                textiles,
            });
        }
        if let Some(key) = unready {
            grounds.follow(bench, &key);
        }
    }

    fn tell(&mut self, settings: &StylusSettings, textiles: &[(Arc<Textile>, bool)]) {
        let n_ready = textiles.iter().filter(|(_, is_ready)| *is_ready).count();
        if n_ready < textiles.len() {
            let n = textiles.len();
            (self.notes).push(format!(
                "{n_ready} of {n} textiles are ready; others are silent"
            ));
        }
        let rate_hz = StylusDrive::rate_hz(settings.rate_hz);
        if rate_hz < settings.rate_hz {
            let rate = quantity::with_unit(rate_hz, 0, "Hz");
            (self.notes).push(format!(
                "Driven at {rate}, the most that a tick has time for"
            ));
        }
    }
}
