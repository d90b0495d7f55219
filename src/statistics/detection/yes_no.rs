//! Yes/no trials: sensitivity and bias of one subject.

use super::choice::Correction;
use super::relation::{GroupDPrime, Shares};
use crate::distribution::{normal_density, normal_quantile, t_quantile_upper};
use crate::{Computed, Interval, Summary, Undefined, undefined};

/// Counts of one subject.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Answers {
    /// Yes to a signal.
    pub hits: u64,
    /// Trials with the signal.
    pub n_signal: u64,
    /// Yes without it.
    pub false_alarms: u64,
    /// Trials without it.
    pub n_noise: u64,
}

/// Sensitivity and bias.
#[derive(Debug, Clone, PartialEq)]
pub struct YesNo {
    /// The counts as they are.
    pub answers: Answers,
    /// How their shares were kept from 0 and 1.
    pub correction: Correction,
    /// Share of hits after correction.
    pub hit_rate: f64,
    /// Share of false alarms after correction.
    pub false_alarm_rate: f64,
    /// z(H) − z(F).
    pub d_prime: f64,
    /// −½(z(H) + z(F)): positive for a subject who rather says no.
    pub criterion: f64,
    /// c·d′, the logarithm of the likelihood ratio at the criterion.
    pub ln_beta: f64,
    /// d′ of the counts as they are; not computable with a share of 0 or 1.
    pub uncorrected_d_prime: Computed,
    /// Of d′: H(1 − H)/(S·φ(z(H))²) + F(1 − F)/(N·φ(z(F))²) with S signals and N other trials
    /// (Gourevitch & Galanter 1967).
    pub variance: f64,
    /// d′ ± 1.96 √variance.
    pub interval: Interval,
}

impl YesNo {
    /// d′, c and ln β of one subject (Macmillan & Creelman 2005). The log-linear correction enters
    /// every share, as Hautus advises; the clip only those of 0 and 1.
    ///
    /// # Errors
    /// No trials of one kind, more answers than trials.
    pub fn of(answers: Answers, correction: Correction) -> Computed<Self> {
        let Answers {
            hits,
            n_signal,
            false_alarms,
            n_noise,
        } = answers;
        if n_signal == 0 || n_noise == 0 || hits > n_signal || false_alarms > n_noise {
            return undefined(format!(
                "{hits} of {n_signal} signals and {false_alarms} of {n_noise} others give no d′"
            ));
        }
        let hit_rate = correction.share(hits, n_signal);
        let false_alarm_rate = correction.share(false_alarms, n_noise);
        let (z_hit, z_false) = (
            normal_quantile(hit_rate)?,
            normal_quantile(false_alarm_rate)?,
        );
        let (d_prime, criterion) = (z_hit - z_false, -0.5 * (z_hit + z_false));
        let part = |share: f64, z: f64, n: u64| {
            share * (1.0 - share) / (n as f64 * normal_density(z).powi(2))
        };
        let variance = part(hit_rate, z_hit, n_signal) + part(false_alarm_rate, z_false, n_noise);
        let level = 0.95;
        let half = normal_quantile(0.5 + 0.5 * level)? * variance.sqrt();
        let plain = |count: u64, n: u64| normal_quantile(count as f64 / n as f64);
        let uncorrected_d_prime = plain(hits, n_signal)
            .and_then(|z_hit| Ok(z_hit - plain(false_alarms, n_noise)?))
            .map_err(|_infinite| Undefined::because("a share of 0 or 1 has no z"));
        Ok(Self {
            answers,
            correction,
            hit_rate,
            false_alarm_rate,
            d_prime,
            criterion,
            ln_beta: criterion * d_prime,
            uncorrected_d_prime,
            variance,
            interval: Interval::about(d_prime, half, level),
        })
    }
}

impl GroupDPrime {
    /// d′ of a group, from the answers of each subject.
    ///
    /// The mean of subjects' own d′ is too small where trials are few: the correction draws shares
    /// to one half, 5 % at d′ = 2.7 of 16 trials each. Here both rates are means over subjects,
    /// uncorrected, and z of each is less what subjects who differ bend it by, as in
    /// [`super::Relation::group`]. The interval is Student's, of what every subject's rates move it
    /// by.
    ///
    /// # Errors
    /// Fewer than two subjects, one without two trials of each kind, a rate that is 0 or 1 in all.
    pub fn of_yes_no(subjects: &[Answers]) -> Computed<Self> {
        let rates = |of: &dyn Fn(&Answers) -> [u64; 2]| {
            let counts: Vec<[u64; 2]> = subjects.iter().map(of).collect();
            Rate::of(&counts)
        };
        let hits = rates(&|own| [own.hits, own.n_signal])?;
        let alarms = rates(&|own| [own.false_alarms, own.n_noise])?;
        let apart: Vec<f64> = hits.z.iter().zip(&alarms.z).map(|(h, f)| h - f).collect();
        let apart = Summary::of(&apart)?;
        let mean = hits.middle - alarms.middle;
        let variance = apart.sd * apart.sd - hits.by_chance - alarms.by_chance;
        let t = t_quantile_upper(0.025, subjects.len() as f64 - 1.0)?;
        Ok(Self {
            mean,
            spread: variance.max(0.0).sqrt(),
            interval: Interval::about(mean, t * apart.se, 0.95),
            se: apart.se,
        })
    }
}

/// One rate over subjects, as z.
struct Rate {
    middle: f64,
    /// Of every subject, on the tangent at the mean.
    z: Vec<f64>,
    /// The variance of these by the chance of few trials.
    by_chance: f64,
}

impl Rate {
    fn of(counts: &[[u64; 2]]) -> Computed<Self> {
        let Shares { own, by_chance } = Shares::of(counts)?;
        let shares = Summary::of(&own)?;
        let z = normal_quantile(shares.mean)?;
        let slope = normal_density(z);
        let by_chance = by_chance / (slope * slope);
        let variance = (shares.sd * shares.sd / (slope * slope) - by_chance).max(0.0);
        Ok(Self {
            // Φ″ = −z φ.
            middle: z + 0.5 * variance * z,
            z: own
                .iter()
                .map(|share| (share - shares.mean) / slope)
                .collect(),
            by_chance,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::Random;

    fn answers(hits: u64, false_alarms: u64, n: u64) -> Answers {
        Answers {
            hits,
            n_signal: n,
            false_alarms,
            n_noise: n,
        }
    }

    #[test]
    fn a_hit_rate_above_and_a_false_alarm_rate_below_by_one_sigma_are_two_apart() -> Computed<()> {
        // Φ(1) of a hundred thousand, rounded to whole answers.
        let found = YesNo::of(answers(84_134, 15_866, 100_000), Correction::Clip)?;
        assert!((found.d_prime - 2.0).abs() < 1e-4, "{found:?}");
        assert!(
            found.criterion.abs() < 1e-10 && found.ln_beta.abs() < 1e-10,
            "{found:?}"
        );
        assert_eq!(found.uncorrected_d_prime, Ok(found.d_prime));
        Ok(())
    }

    #[test]
    fn bias_is_the_likelihood_ratio_at_the_criterion() -> Computed<()> {
        let found = YesNo::of(answers(60, 10, 100), Correction::LogLinear)?;
        let place = -normal_quantile(found.false_alarm_rate)?;
        let ratio = normal_density(place - found.d_prime) / normal_density(place);
        assert!((found.ln_beta - ratio.ln()).abs() < 1e-12, "{found:?}");
        assert!(found.criterion > 0.0, "says no rather");
        Ok(())
    }

    #[test]
    fn extreme_shares_are_corrected_and_the_result_says_how() -> Computed<()> {
        let logged = YesNo::of(answers(20, 0, 20), Correction::default())?;
        assert_eq!(logged.correction.name(), "log-linear");
        assert_eq!(logged.hit_rate, 20.5 / 21.0);
        assert_eq!(logged.false_alarm_rate, 0.5 / 21.0);
        let clipped = YesNo::of(answers(20, 0, 20), Correction::Clip)?;
        assert_eq!([clipped.hit_rate, clipped.false_alarm_rate], [0.975, 0.025]);
        assert!(
            (clipped.d_prime - 2.0 * 1.959_963_984_540_054).abs() < 1e-12,
            "{clipped:?}"
        );
        assert!(clipped.uncorrected_d_prime.is_err(), "infinite");
        assert!(
            YesNo::of(answers(0, 0, 0), Correction::Clip).is_err(),
            "no trials"
        );
        assert!(
            YesNo::of(answers(3, 0, 2), Correction::Clip).is_err(),
            "too many"
        );
        Ok(())
    }

    #[test]
    fn the_variance_is_that_of_simulated_subjects() -> Computed<()> {
        let mut random = Random::new(9);
        let (n, d, criterion) = (200, 1.2, 0.8);
        let mut found = Vec::new();
        let mut stated = 0.0;
        for _ in 0..2000 {
            let mut count = |mean: f64| {
                let yes = (0..n)
                    .filter(|_| random.normal() + mean > criterion)
                    .count();
                yes as u64
            };
            let seen = YesNo::of(answers(count(d), count(0.0), n), Correction::LogLinear)?;
            found.push(seen.d_prime);
            stated += seen.variance / 2000.0;
        }
        let summary = Summary::of(&found)?;
        assert!((summary.mean - d).abs() < 0.02, "{summary:?}");
        assert!(
            (stated / summary.sd.powi(2) - 1.0).abs() < 0.1,
            "{stated} {summary:?}"
        );
        Ok(())
    }
}
