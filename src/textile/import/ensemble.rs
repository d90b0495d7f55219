//! How sure a relief from a picture is: many reliefs that explain the picture, weighted by how well
//! they do, and what is felt of each.
//!
//! Two models compete, shading and dark is deep, and where the light is not known, lights. They are
//! drawn by a fixed rule (an additive recurrence, Roberts 2018), so that the same picture gives the
//! same bytes on any number of threads. Of a member only its levels are kept, not its relief: what
//! is in memory at once is one relief a thread.

use serde::{Deserialize, Serialize};

use super::height_scale::HeightScale;
use super::picture::PictureTextile;
use crate::error::TextileError;
use crate::manifest::Uncertainty;
use crate::picture::Relief;
use crate::picture::brightness::Brightness;
use crate::picture::shading::{Evidence, Light, Method, ShadingOptions, Shape};
use crate::tactile::Band;
use selvedge_foundation::numerics::{bisected, in_pieces};
use selvedge_foundation::progress::Progress;

/// Reliefs of shading, and of dark is deep.
const N_SHADED: usize = 16;
const N_DEEP: usize = 4;
/// Shares of the weight that a band leaves below either end.
const ENDS: [f64; 2] = [0.16, 0.84];
/// How far a route that knows its light is off by itself, dB, by band: standard deviations over the
/// known cloths of the study of routes. Every member may be off by as much.
const OWN_ERROR_DB: [f64; 2] = [4.0, 2.5];
/// Slants that an unknown light is drawn from, degrees: a scanner's lamp, a lamp on a table.
const SLANTS_DEG: [f64; 2] = [25.0, 65.0];
/// Weights of curvature of the variational method, powers of ten; powers of brightness by which
/// depth follows it, powers of two.
const LOG_SMOOTHNESS: [f64; 2] = [-4.0, -2.0];
const LOG_POWER: [f64; 2] = [-1.0, 1.0];
/// Unexplained shares of the picture count against a light from here on.
const NOISE_SHARE: f64 = 0.02;
/// How many independent readings the residual of a picture counts for.
const N_READINGS: f64 = 6.0;

/// What is known of the lamp over a picture.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Lamp {
    /// Where it stood, and within how many degrees that is right.
    Known {
        /// On the picture, y up.
        light: Light,
        /// Half of the interval that tilt and slant are drawn from, degrees.
        within_deg: f64,
    },
    /// Nothing.
    Unknown,
}

impl Lamp {
    /// Within so many degrees people say where a lamp stands, unless they say otherwise.
    pub const WITHIN_DEG: f64 = 5.0;

    /// The light at a place of the unit square.
    fn at(self, [a, b]: [f64; 2]) -> Light {
        let along = |[low, high]: [f64; 2], share: f64| low + (high - low) * share;
        match self {
            Self::Known { light, within_deg } => Light {
                slant_deg: (light.slant_deg + along([-within_deg, within_deg], b)).clamp(5.0, 80.0),
                tilt_deg: light.tilt_deg + along([-within_deg, within_deg], a),
            },
            Self::Unknown => Light {
                slant_deg: along(SLANTS_DEG, b),
                tilt_deg: along([-180.0, 180.0], a),
            },
        }
    }
}

/// A relief that was tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Member {
    /// The model.
    pub method: Method,
    /// The light on the picture, of shading.
    pub light: Light,
    /// What the method is tuned by: see [`ShadingOptions::regulariser`].
    regulariser: f64,
    /// Its share of the belief; all sum to 1.
    pub weight: f64,
    /// Levels of warp and weft by band, dB re 1 µm, at the standard stroke.
    pub levels_db: [[f64; 2]; 2],
}

/// What was tried on a picture, and which is kept.
#[derive(Debug, Clone)]
pub struct Ensemble {
    /// All whose levels could be had.
    pub members: Vec<Member>,
    /// The one whose levels are nearest to the median.
    pub kept: usize,
    lamp: Lamp,
}

/// What a member came to: levels, and the share of the picture that it does not explain.
type Tried = Option<Result<([[f64; 2]; 2], f64), TextileError>>;

impl Ensemble {
    /// Tries all members on a brightness, heights scaled as the textile's are to be.
    ///
    /// # Errors
    /// Heights without a scale, a picture without relief: the first member's error, if none could be
    /// scaled. Cancelled.
    pub fn of(
        brightness: &Brightness,
        about: &PictureTextile,
        lamp: Lamp,
        n_threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<Self, TextileError> {
        let mut members: Vec<Member> = drawn(lamp);
        let mut tried: Vec<Tried> = members.iter().map(|_| None).collect();
        let n = members.len();
        let round = n_threads.max(1);
        for (number, (some, members)) in tried
            .chunks_mut(round)
            .zip(members.chunks(round))
            .enumerate()
        {
            progress.step((number * round) as f64 / n as f64, "trying reliefs")?;
            in_pieces(
                some,
                1,
                n_threads,
                || (),
                |(), i, piece| {
                    piece[0] = Some(members[i].tried(brightness, about));
                },
            );
        }
        weigh(&mut members, &tried, brightness);
        let (mut felt, mut failed) = (Vec::new(), None);
        for (member, tried) in members.into_iter().zip(tried) {
            match tried {
                Some(Ok((levels_db, _))) => felt.push(Member {
                    levels_db,
                    ..member
                }),
                Some(Err(error)) => failed = failed.or(Some(error)),
                None => {}
            }
        }
        let sum: f64 = felt.iter().map(|member| member.weight).sum();
        match failed {
            Some(error) if felt.is_empty() => return Err(error),
            _ => felt.iter_mut().for_each(|member| member.weight /= sum),
        }
        let mut ensemble = Self {
            members: felt,
            kept: 0,
            lamp,
        };
        ensemble.kept = ensemble.nearest_to_median();
        Ok(ensemble)
    }

    /// The kept relief.
    ///
    /// # Errors
    /// Cancelled.
    pub fn shape(
        &self,
        brightness: &Brightness,
        progress: &mut Progress<'_>,
    ) -> Result<Shape, TextileError> {
        self.members[self.kept].shape(brightness, progress)
    }

    /// Puts the kept shape, and what it was found under, in the place of a relief's own.
    ///
    /// # Errors
    /// Cancelled.
    pub fn keep(
        &self,
        relief: &mut Relief,
        progress: &mut Progress<'_>,
    ) -> Result<(), TextileError> {
        relief.shape = self.shape(&relief.brightness, progress)?;
        relief.light = self.members[self.kept].light;
        if let Some(estimate) = &mut relief.estimate {
            estimate.light = relief.light;
            estimate.words = format!(
                "The light is not known: of {} reliefs, {:.0} % of the belief in shading, this one is \
                 nearest to what all feel like.",
                self.members.len(),
                100.0 * self.belief_in_shading()
            );
        }
        Ok(())
    }

    /// [`Self::levels`] about what is felt of a shape.
    ///
    /// # Errors
    /// A shape that has no height.
    pub fn levels_about(
        &self,
        shape: &Shape,
        about: &PictureTextile,
    ) -> Result<Vec<[f64; 4]>, TextileError> {
        Ok(self.levels(about.levels_db(shape)?))
    }

    /// What to do about a band that is too wide, by what makes it wide for this picture.
    pub fn advice(&self, levels: &[[f64; 4]], scale: HeightScale) -> Option<String> {
        let band = Uncertainty {
            levels: levels.to_vec(),
            ..Uncertainty::default()
        };
        let [hz, deg, low, high] = band.too_wide()?;
        let way = if deg < 45.0 { "warp" } else { "weft" };
        let b = usize::from(hz > 100.0);
        let level = |member: &Member| member.levels_db[usize::from(deg >= 45.0)][b];
        let is_deep = |member: &&Member| member.method == Method::DarkIsDeep;
        let [deep, deep_spread] = mean_and_variance(self.members.iter().filter(is_deep), level);
        let shaded = self.members.iter().filter(|member| !is_deep(member));
        let [shade, spread] = mean_and_variance(shaded, level);
        let p = self.belief_in_shading();
        let between = p * (1.0 - p) * (shade - deep).powi(2);
        let within = p * spread + (1.0 - p) * deep_spread;
        let percent = 100.0 * p;
        let why = if between > within {
            format!(
                "shading and dark-is-deep both explain this picture ({percent:.0} % to {:.0} %) and \
                 differ by {:.0} dB",
                100.0 - percent,
                (shade - deep).abs()
            )
        } else if self.lamp == Lamp::Unknown {
            "the light is not known, and lights from several sides explain this picture".to_owned()
        } else {
            "the light leaves that much open on this picture".to_owned()
        };
        let lamp = if self.lamp == Lamp::Unknown {
            "the light (--light), "
        } else {
            ""
        };
        let smd = match scale {
            HeightScale::SmdUm(_) => "",
            _ => "the SMD (--smd-um), ",
        };
        Some(format!(
            "A{hz} along the {way} may lie {low:+.1} to {high:+.1} dB from what is felt: {why}; give \
             {lamp}{smd}a stroke of the tester, or a picture with the lamp on another side"
        ))
    }

    /// The level of an axis (warp, weft) and band that a share of the belief lies below, dB.
    pub fn quantile_db(&self, axis: usize, band: usize, share: f64) -> f64 {
        let level = |member: &Member| member.levels_db[axis][band];
        let below = |db: f64| -> f64 {
            // Each member spread as a logistic distribution of its own error.
            let width = OWN_ERROR_DB[band] * 3.0_f64.sqrt() / std::f64::consts::PI;
            let of = |member: &Member| member.weight / (1.0 + ((level(member) - db) / width).exp());
            self.members.iter().map(of).sum()
        };
        let all = self.members.iter().map(level);
        let [low, high] = selvedge_foundation::numerics::extent(all);
        let far = 10.0 * OWN_ERROR_DB[band];
        bisected([low - far, high + far], 40, |db| below(db) < share)
    }

    /// The member whose levels are nearest to the medians: one relief, since the mean of reliefs
    /// under many lights is smoother than any.
    fn nearest_to_median(&self) -> usize {
        let medians = [0, 1].map(|axis| [0, 1].map(|band| self.quantile_db(axis, band, 0.5)));
        let off = |member: &Member| -> f64 {
            let pairs = member
                .levels_db
                .iter()
                .flatten()
                .zip(medians.iter().flatten());
            pairs.map(|(db, median)| (db - median).powi(2)).sum()
        };
        let all = self.members.iter().enumerate();
        all.min_by(|a, b| off(a.1).total_cmp(&off(b.1)))
            .map_or(0, |(i, _)| i)
    }

    /// What a manifest says: [Hz, degrees from the warp, low dB, high dB] from what is felt of a
    /// textile whose warp and weft have these levels.
    pub fn levels(&self, felt_db: [[f64; 2]; 2]) -> Vec<[f64; 4]> {
        let tenths = |db: f64| (10.0 * db).round() / 10.0;
        let mut all = Vec::new();
        for band in Band::ALL {
            for (axis, deg) in [0.0, 90.0].into_iter().enumerate() {
                let [low, high] = ENDS.map(|share| {
                    let db = self.quantile_db(axis, band.index(), share);
                    tenths(db - felt_db[axis][band.index()])
                });
                all.push([band.carrier_hz(), deg, low, high]);
            }
        }
        all
    }

    /// The belief in shading; the rest is in dark is deep.
    pub fn belief_in_shading(&self) -> f64 {
        let shaded = self
            .members
            .iter()
            .filter(|member| member.method != Method::DarkIsDeep);
        shaded.map(|member| member.weight).sum()
    }
}

/// Weighted mean and variance of a level, dB.
fn mean_and_variance<'a>(
    members: impl Iterator<Item = &'a Member> + Clone,
    level: impl Fn(&Member) -> f64,
) -> [f64; 2] {
    let sum =
        |of: &dyn Fn(&Member) -> f64| members.clone().map(|one| one.weight * of(one)).sum::<f64>();
    let all = sum(&|_| 1.0).max(f64::MIN_POSITIVE);
    let mean = sum(&level) / all;
    [mean, sum(&|one| (level(one) - mean).powi(2)) / all]
}

/// The design: members with even weights.
fn drawn(lamp: Lamp) -> Vec<Member> {
    // Powers of the inverse of the root of x⁴ = x + 1: three numbers that fill a cube evenly.
    let root = 1.220_744_084_605_759_5_f64;
    let place = |i: usize| [1, 2, 3].map(|power| (0.5 + (i + 1) as f64 / root.powi(power)).fract());
    let along = |[low, high]: [f64; 2], share: f64| low + (high - low) * share;
    let member = |method, light, regulariser| Member {
        method,
        light,
        regulariser,
        weight: 0.0,
        levels_db: [[0.0; 2]; 2],
    };
    let shaded = (0..N_SHADED).map(|i| {
        let [a, b, c] = place(i);
        member(
            Method::Variational,
            lamp.at([a, b]),
            10.0_f64.powf(along(LOG_SMOOTHNESS, c)),
        )
    });
    let deep = (0..N_DEEP).map(|i| {
        let share = (i as f64 + 0.5) / N_DEEP as f64;
        member(
            Method::DarkIsDeep,
            lamp.at([0.5; 2]),
            2.0_f64.powf(along(LOG_POWER, share)),
        )
    });
    shaded.chain(deep).collect()
}

impl Member {
    fn shape(
        &self,
        brightness: &Brightness,
        progress: &mut Progress<'_>,
    ) -> Result<Shape, TextileError> {
        let options = ShadingOptions {
            method: self.method,
            regulariser: Some(self.regulariser),
            ..ShadingOptions::default()
        };
        Ok(brightness.shape(self.light, &options, progress)?)
    }

    fn tried(
        &self,
        brightness: &Brightness,
        about: &PictureTextile,
    ) -> Result<([[f64; 2]; 2], f64), TextileError> {
        let shape = Progress::unheard(|progress| self.shape(brightness, progress))?;
        Ok((
            about.levels_db(&shape)?,
            shape.unexplained(&brightness.values),
        ))
    }
}

/// Gives every member its weight: half of the belief to each model before the picture is looked
/// at, then by its waves over direction and, among lights, by what the drawn picture leaves.
fn weigh(members: &mut [Member], tried: &[Tried], brightness: &Brightness) {
    let evidence = Evidence::of(&brightness.values);
    let unexplained = |i: usize| match &tried[i] {
        Some(Ok((_, share))) => Some(share + NOISE_SHARE),
        _ => None,
    };
    let best = (0..N_SHADED)
        .filter_map(unexplained)
        .fold(f64::INFINITY, f64::min);
    let logs: Vec<f64> = members
        .iter()
        .enumerate()
        .map(|(i, member)| match member.method {
            Method::DarkIsDeep => -(N_DEEP as f64).ln(),
            _ => {
                let tilt_deg = brightness.light(member.light).tilt_deg;
                let left = unexplained(i).map_or(f64::INFINITY, |share| share / best);
                evidence.log_odds(tilt_deg) - 0.5 * N_READINGS * left.ln() - (N_SHADED as f64).ln()
            }
        })
        .collect();
    let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    for (member, log) in members.iter_mut().zip(logs) {
        member.weight = (log - most).exp();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::shading::picture_of;
    use selvedge_foundation::numerics::{Grid, Random};
    use selvedge_foundation::progress::CancelFlag;

    const LIGHT: Light = Light {
        slant_deg: 45.0,
        tilt_deg: 30.0,
    };

    /// Bumps by chance that repeat, px, 20 px/mm.
    fn relief() -> Grid<f64> {
        let (n, mut random) = (160_usize, Random::new(5));
        let mut heights = Grid::filled(n, n, 0.0);
        for _ in 0..600 {
            let (x, y) = (random.index(n), random.index(n));
            let (up, wide) = (random.uniform_in(-0.6, 0.6), random.uniform_in(2.0, 6.0));
            for row in 0..n {
                for (column, z) in heights.row_mut(row).iter_mut().enumerate() {
                    let [dx, dy] =
                        [column.abs_diff(x), row.abs_diff(y)].map(|d| d.min(n - d) as f64);
                    *z += up * (-(dx * dx + dy * dy) / (wide * wide)).exp();
                }
            }
        }
        heights
    }

    fn brightness(values: &Grid<f64>) -> Brightness {
        Brightness::of_picture(&values.turned_over(), 0.0)
    }

    fn lit() -> Brightness {
        brightness(&picture_of(&relief(), LIGHT).map(|e| 0.8 * e))
    }

    fn about() -> PictureTextile {
        PictureTextile {
            name: "Bumps".to_owned(),
            px_per_mm: 20.0,
            scale: HeightScale::SmdUm(5.0),
            ..PictureTextile::default()
        }
    }

    fn known() -> Lamp {
        Lamp::Known {
            light: LIGHT,
            within_deg: 5.0,
        }
    }

    fn tried(brightness: &Brightness, lamp: Lamp, n_threads: usize) -> Ensemble {
        Progress::unheard(|progress| Ensemble::of(brightness, &about(), lamp, n_threads, progress))
            .unwrap()
    }

    #[test]
    fn members_are_the_same_on_any_number_of_threads_and_their_weights_sum_to_one() {
        let one = tried(&lit(), known(), 1);
        let three = tried(&lit(), known(), 3);
        assert!(one.members.len() >= 16, "{}", one.members.len());
        assert_eq!(one.members, three.members);
        assert_eq!(one.kept, three.kept);
        let sum: f64 = one.members.iter().map(|member| member.weight).sum();
        assert!((sum - 1.0).abs() < 1e-12, "{sum}");
    }

    #[test]
    fn a_picture_speaks_for_the_model_that_it_was_drawn_by() {
        let by_light = tried(&lit(), known(), 2).belief_in_shading();
        let heights = relief();
        let [low, high] = selvedge_foundation::numerics::extent(heights.values().iter().copied());
        let deep = brightness(&heights.map(|z| 0.2 + 0.7 * (z - low) / (high - low)));
        let by_depth = tried(&deep, known(), 2).belief_in_shading();
        assert!(
            by_light > 0.8 && by_depth < 0.2,
            "{by_light} and {by_depth}"
        );
    }

    #[test]
    fn a_band_widens_when_the_light_is_not_known_and_holds_its_median() {
        let width = |ensemble: &Ensemble| {
            let levels = ensemble.levels([[0.0; 2]; 2]);
            assert_eq!(levels.len(), 4, "two bands along two axes");
            levels.iter().map(|[.., low, high]| high - low).sum::<f64>()
        };
        let (sure, open) = (tried(&lit(), known(), 2), tried(&lit(), Lamp::Unknown, 2));
        assert!(
            width(&open) > width(&sure),
            "{} {}",
            width(&open),
            width(&sure)
        );
        let [low, middle, high] = [0.16, 0.5, 0.84].map(|share| open.quantile_db(0, 0, share));
        assert!(low < middle && middle < high, "{low} {middle} {high}");
    }

    #[test]
    fn lights_are_drawn_where_they_may_be_and_from_all_sides_if_that_is_not_known() {
        let shaded = |lamp: Lamp| {
            drawn(lamp)
                .into_iter()
                .filter(|one| one.method == Method::Variational)
        };
        for Member { light, .. } in shaded(known()) {
            let off = [light.slant_deg - 45.0, light.tilt_deg - 30.0];
            assert!(off.into_iter().all(|deg| deg.abs() <= 5.0), "{light:?}");
        }
        for quarter in [-180.0, -90.0, 0.0, 90.0] {
            let there = |one: &Member| (quarter..quarter + 90.0).contains(&one.light.tilt_deg);
            let n = shaded(Lamp::Unknown).filter(there).count();
            assert!((3..=5).contains(&n), "{n} of {N_SHADED} from {quarter}°");
        }
    }

    #[test]
    fn a_raised_flag_ends_it_and_a_picture_of_one_colour_has_no_relief() {
        let flag = CancelFlag::new();
        flag.cancel();
        let mut nobody = |_: f64, _: &str| {};
        let mut progress = Progress::new(&mut nobody, flag);
        let stopped = Ensemble::of(&lit(), &about(), known(), 2, &mut progress);
        assert!(
            matches!(stopped, Err(TextileError::Cancelled(_))),
            "{stopped:?}"
        );
        let flat = brightness(&Grid::filled(160, 160, 0.5));
        let none = Progress::unheard(|p| Ensemble::of(&flat, &about(), known(), 2, p)).unwrap_err();
        assert!(none.to_string().contains("relief"), "{none}");
    }
}

#[cfg(test)]
mod scratch {
    use super::*;
    use crate::picture::shading::picture_of;
    use crate::surface::{Direction, HeightMap, Probe, Surface};
    use crate::tactile::{Filters, Levels};
    use crate::{HeightScale, Library};
    use selvedge_foundation::numerics::{Grid, Random};
    use selvedge_foundation::quantity::level_db;

    fn truth(map: &HeightMap) -> [[f64; 2]; 2] {
        let mut out = [[0.0; 2]; 2];
        for place in [0.1, 0.3, 0.5, 0.7, 0.9] {
            let p = map
                .strokes(
                    &Probe::contactor(),
                    map.size_mm().map(|mm| mm * place),
                    &Random::new(0),
                )
                .unwrap();
            let l = Levels::of(
                &Surface::from_profiles(p, 0.0).unwrap(),
                &Filters::default(),
            )
            .direction_mean_um;
            for (a, d) in [Direction::WarpForward, Direction::WeftForward]
                .into_iter()
                .enumerate()
            {
                for b in 0..2 {
                    out[a][b] += l[d.index()][b] / 5.0;
                }
            }
        }
        out.map(|x| x.map(level_db))
    }

    #[test]
    #[ignore]
    fn show() {
        let ids = std::env::var("IDS").unwrap_or(
            "denim,polyamide-taffeta,wool-twill,silk-crepe,polyester-satin,polyamide-jersey".into(),
        );
        let side: usize = std::env::var("SIDE")
            .ok()
            .and_then(|x| x.parse().ok())
            .unwrap_or(240);
        let unknown = std::env::var("UNKNOWN").is_ok();
        let deep = std::env::var("DEEP").is_ok();
        let noise = 0.01;
        let light = Light {
            slant_deg: 45.0,
            tilt_deg: 30.0,
        };
        for id in ids.split(',') {
            let map = Library::shipped()
                .unwrap()
                .manifest(id)
                .unwrap()
                .source
                .height_map()
                .unwrap()
                .unwrap();
            let um = map.step_mm()[0] * 1000.0;
            let fine = if deep {
                let [lo, hi] = selvedge_foundation::numerics::extent(
                    map.heights_um().values().iter().copied(),
                );
                map.heights_um().map(|z| 0.2 + 0.8 * (z - lo) / (hi - lo))
            } else {
                picture_of(&map.heights_um().map(|z| z / um), light)
            };
            let ppp = 2;
            let sides = [fine.width(), fine.height()].map(|n| (n / ppp).min(side));
            let mut random = Random::new(3).branch(id);
            let lum = Grid::from_fn(sides[0], sides[1], |c, r| {
                let mut s = 0.0;
                for y in 0..ppp {
                    for x in 0..ppp {
                        s += fine.row(r * ppp + y)[c * ppp + x];
                    }
                }
                (0.8 * s / (ppp * ppp) as f64 + noise * random.normal()).clamp(0.0, 1.0)
            });
            let strokes = map
                .strokes(
                    &Probe::default(),
                    map.size_mm().map(|mm| mm * 0.5),
                    &Random::new(1),
                )
                .unwrap();
            let smd = crate::smd_um(&strokes);
            let brightness = Brightness::of_picture(&lum.turned_over(), 0.0);
            let about = PictureTextile {
                name: id.into(),
                px_per_mm: 1000.0 / um / ppp as f64,
                scale: HeightScale::SmdUm(smd),
                ..Default::default()
            };
            let lamp = if unknown {
                Lamp::Unknown
            } else {
                Lamp::Known {
                    light,
                    within_deg: 5.0,
                }
            };
            let t0 = std::time::Instant::now();
            let e = Progress::unheard(|p| Ensemble::of(&brightness, &about, lamp, 2, p)).unwrap();
            let t = truth(&map);
            println!(
                "{id} step {um} um size {:?} smd {smd:.2} truth warp {:.1?} weft {:.1?}  {:.1} s",
                map.size_mm(),
                t[0],
                t[1],
                t0.elapsed().as_secs_f64()
            );
            for m in &e.members {
                println!(
                    "   {:12} slant {:5.1} tilt {:6.1} reg {:.5} w {:.4} off {:.1?}",
                    m.method.word(),
                    m.light.slant_deg,
                    m.light.tilt_deg,
                    m.regulariser,
                    m.weight,
                    [
                        m.levels_db[0][0] - t[0][0],
                        m.levels_db[0][1] - t[0][1],
                        m.levels_db[1][0] - t[1][0],
                        m.levels_db[1][1] - t[1][1]
                    ]
                );
            }
            println!(
                "   shading {:.3} kept {} levels off truth {:?}",
                e.belief_in_shading(),
                e.kept,
                e.levels(t)
            );
        }
    }
}
