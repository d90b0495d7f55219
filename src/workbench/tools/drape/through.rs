//! The cloth through the device: what its fingers touch, in place of the scene.
//!
//! Amplitudes go to the engine as they come of the cloth's steps. While the pane is out of sight,
//! or the past is looked at, nothing is stepped, and so nothing is felt.

use crate::bench::Bench;
use crate::tools::drape::hung::ClothFrame;
use selvedge_engine::{ClothDrive, ClothFeed, ClothTick};

/// Contactors of a finger's pad.
const N_CONTACTORS: usize = 24;

/// The switch, and the way to the engine while it is on.
#[derive(Default)]
pub(crate) struct ThroughDevice {
    pub(crate) is_on: bool,
    /// With the title of what hangs.
    feed: Option<(ClothFeed, String)>,
    /// The time of what was given last, s.
    given_s: f64,
}

impl ThroughDevice {
    /// Why it cannot be switched on.
    pub(crate) fn refusal(bench: &Bench) -> Option<&'static str> {
        if bench.has_session() {
            Some("A session chooses what is felt")
        } else if bench.live.play.is_recording {
            Some("What is recorded is felt on the scene: end the recording first")
        } else if bench.live.stylus.is_some() {
            Some("The stylus is felt: switch it off in its pane first")
        } else {
            None
        }
    }

    /// What is to be said while it is on.
    pub(crate) fn notes(bench: &Bench) -> Vec<String> {
        let displays = &bench.document.scene().displays;
        let mut notes: Vec<String> = (displays.iter().take(2).enumerate())
            .map(|(nth, display)| (nth + 1, display.geometry.n_contactors()))
            .filter(|(_, n)| *n != N_CONTACTORS)
            .map(|(nth, n)| {
                format!("Display {nth} has {n} contactors, a finger here {N_CONTACTORS}")
            })
            .collect();
        if displays.len() < 2 {
            let words = "The scene has one display: the first finger’s; a second one (Scene, \
                         Display) feels the other";
            notes.push(words.to_owned());
        }
        notes
    }

    /// Gives the engine what is new of the cloth that hangs at a time, or the scene again; a
    /// session says itself whether its cloth is felt. Once a frame.
    pub(crate) fn follow(&mut self, cloth: Option<(f64, &str, &ClothFrame)>, bench: &mut Bench) {
        self.is_on &= Self::refusal(bench).is_none();
        let hung = bench.hung();
        if !self.is_on && hung.is_none() {
            if self.feed.take().is_some() {
                bench.feel_cloth(None);
            }
            return;
        }
        let is_silent = hung.is_some_and(|hung| !hung.is_felt);
        // A session's trial may begin before its cloth is looked at.
        let title = match (hung, cloth) {
            (Some(hung), _) => hung.id.clone(),
            (None, Some((_, title, _))) => title.to_owned(),
            (None, None) => return,
        };
        if self.feed.as_ref().is_none_or(|(_, of)| *of != title) {
            let (feed, drive) = ClothDrive::new();
            bench.feel_cloth(Some((drive, format!("a hanging cloth: {title}"))));
            self.feed = Some((feed, title));
        }
        let Some((t_s, _, cloth)) = cloth else {
            return;
        };
        let is_new = self.given_s.to_bits() != t_s.to_bits();
        self.given_s = t_s;
        if let Some((feed, _)) = self.feed.as_mut().filter(|_| is_new) {
            let felt = if is_silent {
                ClothTick::default()
            } else {
                tick(cloth)
            };
            feed.give(&felt);
        }
    }
}

/// What both fingers' contactors are given; a finger that is not there is silent.
fn tick(cloth: &ClothFrame) -> ClothTick {
    let mut tick = ClothTick::default();
    for (finger, felt) in tick.iter_mut().zip(&cloth.amplitudes_um) {
        *finger = felt.map(Option::unwrap_or_default);
    }
    tick
}
