//! The table that says what is adapted, as files have it.

use serde::Deserialize;

use super::adaptation::unity;
use super::{Adaptation, QuestPlusTrack, Seeks, StaircaseTrack, Stopping, Track, Tunable};
use selvedge_foundation::files::{Flaw, Place};
use selvedge_textile::tactile::Band;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AdaptationKeys {
    pub(super) parameter: Tunable,
    pub(super) band_hz: Option<f64>,
    pub(super) reference: Option<f64>,
    pub(super) range: [f64; 2],
    #[serde(default)]
    pub(super) seeks: Seeks,
    pub(super) staircase: Option<StaircaseTrack>,
    pub(super) quest_plus: Option<QuestPlusKeys>,
    pub(super) constant: Option<ConstantKeys>,
    #[serde(default)]
    pub(super) stop: Stopping,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct QuestPlusKeys {
    #[serde(default = "unity", alias = "grid_db")]
    grid: f64,
    #[serde(alias = "widths_db")]
    widths: Option<Vec<f64>>,
    widths_ln: Option<Vec<f64>>,
    #[serde(default = "lapses")]
    lapses: Vec<f64>,
}

fn lapses() -> Vec<f64> {
    vec![0.0, 0.02, 0.04]
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ConstantKeys {
    #[serde(alias = "levels_db")]
    values: Vec<f64>,
    repeats: usize,
}

impl AdaptationKeys {
    /// What they adapt.
    ///
    /// # Errors
    /// None or several ways of finding the next value, or a band that there is not.
    pub(super) fn adaptation(self, alternatives: usize) -> Result<Adaptation, Flaw> {
        let is_difference = self.reference.is_some() && self.seeks == Seeks::Difference;
        let quest_plus = self.quest_plus.map(|keys| keys.track(is_difference));
        let constant = self.constant.map(|keys| Track::Constant {
            values: keys.values,
            repeats: keys.repeats,
        });
        let staircase = self.staircase.map(Track::Staircase);
        let tracks = [staircase, quest_plus.transpose()?, constant];
        let mut tracks: Vec<Track> = tracks.into_iter().flatten().collect();
        let n = tracks.len();
        let track = tracks.pop().filter(|_| n == 1).ok_or_else(|| {
            let what = format!("{n} tables say how the next value is found");
            let mend = "keep one of [adaptation.staircase], [adaptation.quest_plus], \
                        [adaptation.constant]";
            Flaw::new(("adaptation", 0, "range"), what, mend)
        })?;
        let place = ("adaptation", 0, "band_hz");
        let band = match (self.parameter, self.band_hz) {
            (Tunable::Level, Some(hz)) => band(place, hz)?,
            (Tunable::Level, None) => {
                let (what, mend) = ("a level without a band", "add band_hz = 40 or 320");
                return Err(Flaw::new(("adaptation", 0, "parameter"), what, mend));
            }
            (_, None) => Band::Low,
            (other, Some(_)) => {
                let what = format!("{} has no band", other.name());
                return Err(Flaw::new(place, what, "take band_hz away"));
            }
        };
        Ok(Adaptation {
            parameter: self.parameter,
            band,
            alternatives,
            reference: self.reference,
            range: self.range,
            seeks: self.seeks,
            track,
            stopping: self.stop,
        })
    }
}

impl QuestPlusKeys {
    fn track(self, is_difference: bool) -> Result<Track, Flaw> {
        let (stated, other, usual) = if is_difference {
            (self.widths_ln, self.widths, vec![1.5, 2.0, 3.0, 4.0])
        } else {
            (self.widths, self.widths_ln, vec![2.0, 4.0, 8.0, 16.0])
        };
        if other.is_some() {
            let (key, mend) = if is_difference {
                (
                    "widths",
                    "with a reference give widths_ln: logarithms of the difference",
                )
            } else {
                ("widths_ln", "without a reference give widths")
            };
            let place = ("adaptation.quest_plus", 0, key);
            return Err(Flaw::new(place, format!("{key} has no meaning here"), mend));
        }
        Ok(Track::QuestPlus(QuestPlusTrack {
            grid: self.grid,
            widths: stated.unwrap_or(usual),
            lapses: self.lapses,
        }))
    }
}

/// The band of a carrier.
///
/// # Errors
/// There is none.
pub(super) fn band(place: Place, hz: f64) -> Result<Band, Flaw> {
    let found = Band::ALL
        .into_iter()
        .find(|band| (band.carrier_hz() - hz).abs() < 1e-9);
    found.ok_or_else(|| {
        Flaw::new(
            place,
            format!("there is no band at {hz} Hz"),
            "give 40 or 320",
        )
    })
}
