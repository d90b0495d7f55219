//! Magnitude estimation: the exponent of a power law between stimulus and sensation (Stevens
//! 1957), with every subject's own modulus made the same.

use std::collections::BTreeMap;

use crate::distribution::t_quantile_upper;
use crate::{Computed, Interval, Summary, Undefined, undefined};
use selvedge_foundation::numerics::LineFit;

/// One answer: who gave which number to which stimulus.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimate {
    /// The subject.
    pub subject: String,
    /// The stimulus, in any unit, above zero.
    pub stimulus: f64,
    /// The number given, above zero.
    pub value: f64,
}

/// A straight line between logarithms: value = constant · stimulus^exponent.
#[derive(Debug, Clone, PartialEq)]
pub struct PowerLaw {
    /// The exponent.
    pub exponent: f64,
    /// The value at a stimulus of 1.
    pub constant: f64,
    /// Interval of the exponent by the scatter about the line, k − 2 degrees of freedom.
    pub interval: Computed<Interval>,
    /// Share of the variance of logarithms that the line explains.
    pub r_squared: Computed,
}

/// What magnitude estimates come to.
#[derive(Debug, Clone, PartialEq)]
pub struct Stevens {
    /// The stimuli, ascending.
    pub stimuli: Vec<f64>,
    /// Geometric means over subjects and repeats, after each subject's modulus was made that of
    /// the group.
    pub means: Vec<f64>,
    /// The line through them.
    pub group: PowerLaw,
    /// Every subject's own line, in the order of their names.
    pub subjects: Vec<(String, PowerLaw)>,
    /// Mean and spread of the subjects' exponents.
    pub exponents: Computed<Summary>,
    /// Interval of the mean exponent by Student's t over subjects.
    pub interval: Computed<Interval>,
}

/// A subject and the logarithms of its geometric means, one a stimulus.
type Subject = (String, Vec<f64>);

impl Stevens {
    /// Fits power laws to estimates in any order, several a stimulus where they were repeated.
    ///
    /// # Errors
    /// No estimates, stimuli or estimates that are not above zero (with subject and stimulus),
    /// fewer than two stimuli, a subject that lacks a stimulus (with their list): its modulus could
    /// not be told from what it was asked.
    pub fn fit(estimates: &[Estimate], level: f64) -> Computed<Self> {
        let (stimuli, subjects) = collected(estimates)?;
        let ln_stimuli: Vec<f64> = stimuli.iter().map(|x| x.ln()).collect();
        let n = subjects.len() as f64;
        // Moduli are equal once every subject's mean logarithm is the group's; the means over
        // subjects are the same before and after, their scatter is not.
        let ln_mean = |place: usize| subjects.iter().map(|(_, logs)| logs[place]).sum::<f64>() / n;
        let ln_means: Vec<f64> = (0..stimuli.len()).map(ln_mean).collect();
        let group = power_law(&ln_stimuli, &ln_means, level)?;
        let mut own = Vec::with_capacity(subjects.len());
        for (name, logs) in subjects {
            own.push((name, power_law(&ln_stimuli, &logs, level)?));
        }
        let values: Vec<f64> = own.iter().map(|(_, law)| law.exponent).collect();
        let exponents = Summary::of(&values);
        Ok(Self {
            interval: exponents
                .clone()
                .and_then(|summary| summary.interval(level)),
            exponents,
            stimuli,
            means: ln_means.into_iter().map(f64::exp).collect(),
            group,
            subjects: own,
        })
    }
}

/// Stimuli ascending, and mean logarithms of each subject at each of them.
fn collected(estimates: &[Estimate]) -> Computed<(Vec<f64>, Vec<Subject>)> {
    let mut stimuli: Vec<f64> = estimates.iter().map(|e| e.stimulus).collect();
    stimuli.sort_by(f64::total_cmp);
    stimuli.dedup();
    let mut sums: BTreeMap<&str, Vec<[f64; 2]>> = BTreeMap::new();
    for estimate in estimates {
        let Estimate {
            subject,
            stimulus,
            value,
        } = estimate;
        let has_logarithm = |x: f64| x > 0.0 && x.is_finite();
        if !(has_logarithm(*value) && has_logarithm(*stimulus)) {
            let reason = format!("{subject} gave {value} to {stimulus}: no logarithm");
            return undefined(reason);
        }
        let cells = sums
            .entry(subject)
            .or_insert_with(|| vec![[0.0; 2]; stimuli.len()]);
        let place = stimuli.partition_point(|x| x < stimulus);
        cells[place][0] += value.ln();
        cells[place][1] += 1.0;
    }
    if stimuli.len() < 2 {
        let reason = format!("{} stimuli give no exponent, 2 are needed", stimuli.len());
        return undefined(reason);
    }
    let missing: Vec<String> = sums
        .iter()
        .flat_map(|(name, cells)| {
            let empty = cells.iter().zip(&stimuli).filter(|(cell, _)| cell[1] < 1.0);
            empty.map(move |(_, stimulus)| format!("{name} at {stimulus}"))
        })
        .collect();
    if !missing.is_empty() {
        return undefined(format!("missing estimates: {}", missing.join(", ")));
    }
    let logs = |cells: Vec<[f64; 2]>| cells.into_iter().map(|[sum, n]| sum / n).collect();
    let subjects = sums
        .into_iter()
        .map(|(name, cells)| (name.to_owned(), logs(cells)));
    Ok((stimuli, subjects.collect()))
}

fn power_law(ln_stimuli: &[f64], ln_values: &[f64], level: f64) -> Computed<PowerLaw> {
    let pairs = ln_stimuli.iter().zip(ln_values);
    let points: Vec<[f64; 2]> = pairs.map(|(x, y)| [*x, *y]).collect();
    let line =
        LineFit::through(&points).ok_or_else(|| Undefined::because("the stimuli do not differ"))?;
    let df = points.len() as f64 - 2.0;
    let interval = t_quantile_upper(0.5 * (1.0 - level), df)
        .map_err(|_no_freedom| Undefined::because("two stimuli leave no scatter about a line"))
        .map(|t| Interval::about(line.slope, t * line.slope_error, level));
    Ok(PowerLaw {
        exponent: line.slope,
        constant: line.offset.exp(),
        interval,
        r_squared: r_squared(&points, &line),
    })
}

fn r_squared(points: &[[f64; 2]], line: &LineFit) -> Computed {
    let values: Vec<f64> = points.iter().map(|p| p[1]).collect();
    let (mean, n) = (
        values.iter().sum::<f64>() / values.len() as f64,
        values.len(),
    );
    let all: f64 = values.iter().map(|y| (y - mean).powi(2)).sum();
    let left: f64 = points
        .iter()
        .map(|[x, y]| (y - line.offset - line.slope * x).powi(2))
        .sum();
    let varies = all > n as f64 * (1e-12 * mean.abs().max(1.0)).powi(2);
    varies
        .then(|| 1.0 - left / all)
        .ok_or_else(|| Undefined::because("every stimulus was given the same number"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::Random;

    fn estimates(exponents: &[f64], noise: f64, seed: u64) -> Vec<Estimate> {
        let mut random = Random::new(seed);
        let mut all = Vec::new();
        for (i, exponent) in exponents.iter().enumerate() {
            let modulus = (2.0 * random.normal()).exp();
            for stimulus in [1.0, 2.0, 5.0, 10.0, 30.0_f64] {
                for _ in 0..3 {
                    let scatter = (noise * random.normal()).exp();
                    let value = modulus * stimulus.powf(*exponent) * scatter;
                    all.push(Estimate {
                        subject: format!("S{i}"),
                        stimulus,
                        value,
                    });
                }
            }
        }
        all
    }

    #[test]
    fn exact_power_laws_come_back_whatever_the_moduli() -> Computed<()> {
        let found = Stevens::fit(&estimates(&[0.5, 0.7, 0.9], 0.0, 1), 0.95)?;
        for ((_, law), exponent) in found.subjects.iter().zip([0.5, 0.7, 0.9]) {
            assert!((law.exponent - exponent).abs() < 1e-12, "{law:?}");
            assert!((law.r_squared.clone()? - 1.0).abs() < 1e-12, "{law:?}");
        }
        assert!(
            (found.group.exponent - 0.7).abs() < 1e-12,
            "{:?}",
            found.group
        );
        // ±4.303·0.2/√3.
        let half = 4.302_652_729_911_275 * 0.2 / 3.0_f64.sqrt();
        assert!(
            (found.interval?.high - 0.7 - half).abs() < 1e-9,
            "t over subjects"
        );
        Ok(())
    }

    #[test]
    fn zeros_missing_stimuli_and_one_stimulus_alone_are_refused() {
        let reason = |all: &[Estimate]| Stevens::fit(all, 0.95).map(|_| ()).map_err(|e| e.reason);
        let mut zero = estimates(&[0.5, 0.6], 0.1, 3);
        zero[4].value = 0.0;
        assert!(
            reason(&zero).is_err_and(|r| r.contains("S0 gave 0 to 2")),
            "zero"
        );
        let mut missing = estimates(&[0.5, 0.6], 0.1, 3);
        missing.retain(|e| !(e.subject == "S1" && e.stimulus == 10.0));
        assert_eq!(
            reason(&missing),
            Err("missing estimates: S1 at 10".to_owned())
        );
        missing.retain(|e| e.stimulus == 1.0);
        assert!(reason(&missing).is_err(), "one stimulus");
        assert!(reason(&[]).is_err(), "none");
    }

    #[test]
    fn one_subject_has_its_own_line_and_no_interval_over_subjects() -> Computed<()> {
        let found = Stevens::fit(&estimates(&[0.8], 0.05, 4), 0.95)?;
        assert!(
            found.exponents.is_err() && found.interval.is_err(),
            "{found:?}"
        );
        assert!(
            found.group.interval?.holds(0.8),
            "by scatter about the line"
        );
        Ok(())
    }
}
