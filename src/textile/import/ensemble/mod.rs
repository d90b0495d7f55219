//! How sure a relief from a picture is: many reliefs that explain the picture, weighted by how well
//! they do, and what is felt of each.
//!
//! Two models compete, shading and dark is deep, and where the light is not known, lights. They are
//! drawn by a fixed rule, so that the same picture gives the same bytes on any number of threads.
//! Of the reliefs one is kept, of all others their levels.

mod design;
#[cfg(test)]
mod tests;
mod words;

pub use design::Lamp;

use super::picture::PictureTextile;
use crate::error::TextileError;
use crate::picture::Relief;
use crate::picture::brightness::Brightness;
use crate::picture::shading::{Evidence, Shape, Turns};
use crate::tactile::Band;
use design::{Member, N_DEEP, N_SHADED, drawn};
use selvedge_foundation::numerics::{bisected, extent, in_pieces};
use selvedge_foundation::progress::Progress;

/// Shares of the belief below either end of a band.
const ENDS: [f64; 2] = [0.16, 0.84];
/// How far a member is off by itself, dB, by band: a standard deviation. With [`TRUST`] bands hold
/// 61, 73 and 64 % of the truths of the cloths that it was chosen on, in the study of routes, the
/// light known, told wrong by 15° and unknown; of fresh cloths 67, 64 and 54 %.
const OWN_ERROR_DB: [f64; 2] = [3.0, 2.5];
/// Shading under slopes too steep for it and dark is deep err to opposite sides, so that the truth
/// is rather between them: members' distances from their mean count by this share.
const TRUST: f64 = 0.75;
/// Shares of the picture that are left unexplained count against a light from here on.
const NOISE_SHARE: f64 = 0.02;
/// How many independent readings a picture's residual counts for: it falls with smoothness too.
const N_READINGS: f64 = 1.0;
/// Rounds that bring the kept relief's levels to the medians, and how much one may change, dB.
const N_ROUNDS: usize = 3;
const MOST_DB: f64 = 12.0;

/// What was tried on a picture, and which is kept.
#[derive(Debug, Clone)]
pub struct Ensemble {
    /// All whose levels could be had.
    members: Vec<Member>,
    /// Of the model that is believed more the one whose levels are nearest to the medians, and its
    /// relief.
    kept: usize,
    shape: Shape,
    lamp: Lamp,
}

/// Levels of warp and weft by band, dB re 1 µm.
type AxisLevels = [[f64; 2]; 2];

/// What a member came to: levels, the share of the picture that it does not explain, its relief.
type Tried = Option<Result<(AxisLevels, f64, Shape), TextileError>>;

/// Members that each thread tries before progress is told.
const N_AT_ONCE: usize = 4;

impl Ensemble {
    /// Tries all members on a brightness, heights scaled as the textile's are to be.
    ///
    /// # Errors
    /// Heights without a scale, a picture without relief: the first member's error, if none could
    /// be scaled. Cancelled.
    pub fn of(
        brightness: &Brightness,
        about: &PictureTextile,
        lamp: Lamp,
        n_threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<Self, TextileError> {
        let turns = brightness.turns();
        let lamp = match &turns {
            Some(turns) if lamp == Lamp::Unknown => Lamp::Turned {
                tilt_deg: brightness.light_on_picture(turns.light()).tilt_deg,
                within_deg: turns.within_deg,
            },
            _ => lamp,
        };
        let mut members = drawn(lamp);
        let mut tried: Vec<Tried> = members.iter().map(|_| None).collect();
        let n = members.len();
        let at_once = N_AT_ONCE * n_threads.max(1);
        for first in (0..n).step_by(at_once) {
            progress.step(first as f64 / n as f64, "trying reliefs")?;
            let end = (first + at_once).min(n);
            let work = |(): &mut (), i: usize, one: &mut [Tried]| {
                one[0] = Some(members[first + i].tried(brightness, about));
            };
            in_pieces(&mut tried[first..end], 1, n_threads, || (), work);
        }
        weigh(&mut members, &tried, (brightness, turns.as_ref()));
        let (mut felt, mut shapes, mut failed) = (Vec::new(), Vec::new(), None);
        for (member, tried) in members.into_iter().zip(tried) {
            match tried {
                Some(Ok((levels_db, _, shape))) => {
                    felt.push(Member {
                        levels_db,
                        ..member
                    });
                    shapes.push(shape);
                }
                Some(Err(error)) => failed = failed.or(Some(error)),
                None => {}
            }
        }
        let sum: f64 = felt.iter().map(|member| member.weight).sum();
        for member in &mut felt {
            member.weight /= sum;
        }
        let kept = nearest_to_median(&felt);
        match failed {
            Some(error) if felt.is_empty() => Err(error),
            _ => Ok(Self {
                members: felt,
                kept,
                shape: shapes.swap_remove(kept),
                lamp,
            }),
        }
    }

    /// The kept relief: of the model that is believed more, which says what lies high, the member
    /// whose levels are nearest to the medians of both, its waves weighed until
    /// its own levels are. One relief, not the mean of many under many lights, which would be
    /// smoother than any.
    ///
    /// # Errors
    /// Heights without a scale.
    pub fn shape(&self, about: &PictureTextile) -> Result<Shape, TextileError> {
        let mut shape = self.shape.clone();
        let medians = medians_db(&self.members);
        let n = [shape.height_px.width(), shape.height_px.height()];
        for _ in 0..N_ROUNDS {
            let felt_db = about.levels_db(&shape)?;
            let gains_db = [0, 1].map(|axis| {
                let off = |band: usize| medians[axis][band] - felt_db[axis][band];
                [0, 1].map(|band| off(band).clamp(-MOST_DB, MOST_DB))
            });
            shape = shape.weighed(about.step_mm(n), gains_db);
        }
        Ok(shape)
    }

    /// Tries all members on a relief's brightness. The relief becomes the one that is nearest to
    /// what all feel like, unless its method was chosen, and the textile keeps how far its levels
    /// may be off. What to do if that is far.
    ///
    /// # Errors
    /// As [`Self::of`].
    pub fn believe(
        (relief, is_chosen): (&mut Relief, bool),
        about: &mut PictureTextile,
        lamp: Lamp,
        n_threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<Option<String>, TextileError> {
        let ensemble = Self::of(&relief.brightness, about, lamp, n_threads, progress)?;
        if !is_chosen {
            ensemble.keep(relief, about)?;
        }
        about.levels = ensemble.levels_about(&relief.shape, about)?;
        Ok(ensemble.advice(&about.levels, about.scale))
    }

    /// Puts the kept shape, and what it was found under, in the place of a relief's own.
    fn keep(&self, relief: &mut Relief, about: &PictureTextile) -> Result<(), TextileError> {
        relief.shape = self.shape(about)?;
        relief.light = self.members[self.kept].light;
        if let Some(estimate) = &mut relief.estimate {
            estimate.light = relief.light;
            let percent = 100.0 * self.belief_in_shading();
            let known = match self.lamp {
                Lamp::Turned { within_deg, .. } => {
                    format!("The turned pictures put the tilt within {within_deg:.0}°")
                }
                _ => "The light is not known".to_owned(),
            };
            estimate.words = format!(
                "{known}: of {} reliefs, {percent:.0} % of the belief in shading, \
                 this one is nearest to what all feel like.",
                self.members.len()
            );
        }
        Ok(())
    }

    /// What a manifest says of a textile of a shape: Hz, degrees from the warp, and from where to
    /// where the amplitude may lie, dB from what is felt.
    fn levels_about(
        &self,
        shape: &Shape,
        about: &PictureTextile,
    ) -> Result<Vec<[f64; 4]>, TextileError> {
        Ok(self.levels(about.levels_db(shape)?))
    }

    /// The same of a textile whose warp and weft have these levels.
    pub fn levels(&self, felt_db: AxisLevels) -> Vec<[f64; 4]> {
        let tenths = |db: f64| (10.0 * db).round() / 10.0;
        let mut all = Vec::new();
        for band in Band::ALL {
            for (axis, deg) in [0.0, 90.0].into_iter().enumerate() {
                let [low, high] = ENDS.map(|share| {
                    let db = quantile_db(&self.members, [axis, band.index()], share);
                    tenths(db - felt_db[axis][band.index()])
                });
                all.push([band.carrier_hz(), deg, low, high]);
            }
        }
        all
    }

    fn belief_in_shading(&self) -> f64 {
        belief_in_shading(&self.members)
    }
}

/// The level of an axis (warp, weft) and band that a share of the belief lies below, dB.
fn quantile_db(members: &[Member], [axis, band]: [usize; 2], share: f64) -> f64 {
    let level = |member: &Member| member.levels_db[axis][band];
    let mean: f64 = members.iter().map(|one| one.weight * level(one)).sum();
    // Each member is spread as a logistic distribution of its own error.
    let width = OWN_ERROR_DB[band] * 3.0_f64.sqrt() / std::f64::consts::PI;
    let below = |db: f64| -> f64 {
        let of = |member: &Member| {
            let middle = mean + TRUST * (level(member) - mean);
            member.weight / (1.0 + ((middle - db) / width).exp())
        };
        members.iter().map(of).sum()
    };
    let [low, high] = extent(members.iter().map(level));
    let far = 10.0 * OWN_ERROR_DB[band];
    bisected([low - far, high + far], 40, |db| below(db) < share)
}

fn medians_db(members: &[Member]) -> AxisLevels {
    [0, 1].map(|axis| [0, 1].map(|band| quantile_db(members, [axis, band], 0.5)))
}

/// The belief in shading; the rest is in dark is deep.
fn belief_in_shading(members: &[Member]) -> f64 {
    let shaded = members.iter().filter(|one| one.is_shaded());
    shaded.map(|member| member.weight).sum()
}

fn nearest_to_median(members: &[Member]) -> usize {
    let is_shaded = belief_in_shading(members) >= 0.5;
    let medians = medians_db(members);
    let off = |member: &Member| -> f64 {
        let levels = member.levels_db.iter().flatten();
        let pairs = levels.zip(medians.iter().flatten());
        pairs.map(|(db, median)| (db - median).powi(2)).sum()
    };
    let all = members.iter().enumerate();
    let believed = all.filter(|(_, member)| member.is_shaded() == is_shaded);
    let nearest = believed.min_by(|a, b| off(a.1).total_cmp(&off(b.1)));
    nearest.map_or(0, |(i, _)| i)
}

/// Gives every member its weight: half of the belief to each model before the picture is looked
/// at, then by its waves over direction and, among lights, by what the drawn picture leaves.
fn weigh(
    members: &mut [Member],
    tried: &[Tried],
    (brightness, turns): (&Brightness, Option<&Turns>),
) {
    let evidence = Evidence::of(&brightness.values);
    let unexplained = |i: usize| match &tried[i] {
        Some(Ok((_, share, _))) => Some(share + NOISE_SHARE),
        _ => None,
    };
    let shares = (0..N_SHADED).filter_map(unexplained);
    let best = shares.fold(f64::INFINITY, f64::min);
    let log_belief = |(i, member): (usize, &Member)| {
        if !member.is_shaded() {
            return -(N_DEEP as f64).ln();
        }
        let tilt_deg = brightness.light(member.light).tilt_deg;
        let left = unexplained(i).map_or(f64::INFINITY, |share| share / best);
        let odds = turns.map(|turns| turns.log_odds(tilt_deg));
        let odds = odds.unwrap_or_else(|| evidence.log_odds(tilt_deg));
        odds - 0.5 * N_READINGS * left.ln() - (N_SHADED as f64).ln()
    };
    let logs: Vec<f64> = members.iter().enumerate().map(log_belief).collect();
    let [_, most] = extent(logs.iter().copied());
    for (member, log) in members.iter_mut().zip(logs) {
        member.weight = (log - most).exp();
    }
}
