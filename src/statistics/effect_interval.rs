//! Intervals of the sizes of effects, from what a test found.

use super::noncentral;
use super::variance::Effect;
use super::{Computed, Freedom, Interval, Named, Outcome, normal_quantile, undefined};

/// Confidence of all intervals.
const LEVEL: f64 = 0.95;

impl Outcome {
    /// The 95 % interval of the effect, and how it was found: by the noncentral t, F or χ², by the
    /// interval of what is estimated, by the normal on Fisher's scale.
    ///
    /// # Errors
    /// No effect, or a test whose effect has none of these.
    pub fn effect_interval(&self) -> Computed<(Interval, &'static str)> {
        let effect = self.effect.clone()?;
        let n = self.n.iter().sum::<usize>() as f64;
        if self
            .estimate
            .as_ref()
            .is_ok_and(|own| own.symbol == effect.symbol)
        {
            let interval = self.interval.clone()?;
            return Ok((interval, "interval of the effect: that of the estimate"));
        }
        match (effect.symbol, self.df) {
            ("d" | "d_z", Freedom::One(df)) => self.of_d(effect, df),
            ("h", _) => self.of_h(effect),
            ("mean/rms", _) => Ok((of_mean_over_rms(effect.value, n), BY_T)),
            ("r_rb", _) => Ok((of_rank_biserial(effect.value, n)?, BY_NORMAL)),
            ("ω²" | "η²", Freedom::Two(df, df_error)) => {
                Ok((share_of_f([self.statistic.value, df, df_error], n), BY_F))
            }
            (_, Freedom::One(df)) if matches!(self.statistic.symbol, "χ²" | "H") => {
                let x = self.statistic.value;
                let ends = noncentral::of_chi_squared(x, df);
                let [low, high] = ends.map(|lambda| (lambda * effect.value / x).min(1.0));
                let is_some = x > 0.0;
                let interval = Interval::new([low, high], LEVEL);
                is_some.then_some((interval, BY_CHI_SQUARED)).map_or_else(
                    || undefined("nothing differs: the effect is 0 without an interval"),
                    Ok,
                )
            }
            _ => undefined(format!("no interval is known for {}", effect.symbol)),
        }
    }

    /// By the noncentral t, as many times d as t is.
    fn of_d(&self, effect: Named, df: f64) -> Computed<(Interval, &'static str)> {
        let t = self.statistic.value;
        if t.abs() <= 0.0 {
            return undefined("t is 0: its scale is not known");
        }
        let [low, high] = noncentral::of_t(t, df).map(|delta| delta * effect.value / t);
        Ok((Interval::new([low, high], LEVEL), BY_T))
    }

    /// Angles of the ends of the interval of the share.
    fn of_h(&self, effect: Named) -> Computed<(Interval, &'static str)> {
        let (share, interval) = (self.estimate.clone()?.value, self.interval.clone()?);
        let angle = |share: f64| 2.0 * share.clamp(0.0, 1.0).sqrt().asin();
        let [low, high] =
            [interval.low, interval.high].map(|end| effect.value + angle(end) - angle(share));
        let level = interval.level;
        Ok((
            Interval { low, high, level },
            "interval of the effect: that of the share",
        ))
    }
}

impl Effect {
    /// The 95 % interval of partial η² by the noncentral F (Steiger 2004).
    ///
    /// # Errors
    /// No F.
    pub fn partial_eta_squared_interval(&self) -> Computed<Interval> {
        let f = self.f.clone()?;
        let n = self.df + self.df_error + 1.0;
        Ok(share_of_f([f, self.df, self.df_error], n))
    }
}

const BY_T: &str = "interval of the effect: noncentral t";
const BY_F: &str = "interval of the effect: noncentral F";
const BY_CHI_SQUARED: &str = "interval of the effect: noncentral χ²";
const BY_NORMAL: &str = "interval of the effect: normal on Fisher's scale";

/// The share of variance that an F's noncentrality is, λ/(λ + n).
fn share_of_f([f, df, df_error]: [f64; 3], n: f64) -> Interval {
    let ends = noncentral::of_f(f, df, df_error).map(|lambda| lambda / (lambda + n));
    Interval::new(ends, LEVEL)
}

/// m/√(m² + s²(n − 1)/n) is a function of d = m/s alone.
fn of_mean_over_rms(effect: f64, n: f64) -> Interval {
    let rest = (n - 1.0) / n;
    let size = effect.abs().min(1.0 - 1e-12);
    let d = effect.signum() * size * (rest / (1.0 - size * size)).sqrt();
    let ends = noncentral::of_t(d * n.sqrt(), n - 1.0)
        .map(|delta| delta / n.sqrt())
        .map(|d| d / (d * d + rest).sqrt());
    Interval::new(ends, LEVEL)
}

/// tanh(atanh r ± z s), s the standard error where nothing differs (Kerby 2014); r no nearer to 1
/// than half of the smallest rank.
fn of_rank_biserial(effect: f64, n: f64) -> Computed<Interval> {
    let total = 0.5 * n * (n + 1.0);
    let se = ((2.0 * n.powi(3) + 3.0 * n * n + n) / 6.0).sqrt() / total;
    let most = 1.0 - 1.0 / total.max(2.0);
    let middle = effect.clamp(-most, most).atanh();
    let half = normal_quantile(0.5 * (1.0 + LEVEL))? * se;
    let [low, high] = [middle - half, middle + half].map(f64::tanh);
    let (low, high) = (low.min(effect), high.max(effect));
    Ok(Interval::new([low, high], LEVEL))
}

#[cfg(test)]
mod tests {
    use crate::variance::{friedman, kruskal_wallis, one_way, welch};
    use crate::{
        Computed, Outcome, Sides, Summary, TwoSamples, exact_binomial, one_sample_t, pearson,
        sign_flip, wilcoxon_signed_rank,
    };

    #[test]
    fn every_effect_has_an_interval_that_holds_it() -> Computed<()> {
        let a = [3.1, 2.0, 4.4, 3.9, 5.2, 2.8, 3.3, 4.1];
        let b = [4.2, 2.9, 4.1, 5.0, 6.3, 3.0, 4.4, 5.1];
        let [of_a, of_b] = [Summary::of(&a)?, Summary::of(&b)?];
        let groups = [a.to_vec(), b.to_vec(), a.iter().map(|x| x + 3.0).collect()];
        let rows: Vec<Vec<f64>> = (0..8).map(|i| vec![a[i], b[i], a[i] + 3.0]).collect();
        let all: Vec<Outcome> = vec![
            one_sample_t(&of_a, 2.5)?,
            TwoSamples::of(&of_a, &of_b)?.welch,
            TwoSamples::of(&of_a, &of_b)?.student,
            wilcoxon_signed_rank(&a, 2.5)?,
            wilcoxon_signed_rank(&a, 0.0)?,
            sign_flip(&a.map(|x| x - 3.0), 99, 1)?,
            exact_binomial(30, 80, 0.25, Sides::Greater)?,
            pearson(&a, &b)?,
            friedman(&rows)?,
            kruskal_wallis(&groups)?,
            welch(&groups)?,
            one_way(&groups)?,
        ];
        for outcome in all {
            let effect = outcome.effect.clone()?;
            let (interval, how) = outcome.effect_interval()?;
            let is_apart = interval.low < interval.high;
            assert!(
                interval.holds(effect.value) && is_apart,
                "{outcome:?} {interval:?} {how}"
            );
        }
        Ok(())
    }

    #[test]
    fn d_of_a_printed_t_has_the_interval_of_the_noncentral_t() -> Computed<()> {
        // By direct summation: of t = 2 with 7 degrees δ lies between −0.26723 and 4.15861.
        let sample = Summary::of_mean_and_se(8, 2.0, 1.0)?;
        let (interval, _) = one_sample_t(&sample, 0.0)?.effect_interval()?;
        let [low, high] = [interval.low, interval.high].map(|d| d * 8.0_f64.sqrt());
        assert!(
            (low + 0.267_23).abs() < 1e-4 && (high - 4.158_61).abs() < 1e-4,
            "{low} {high}"
        );
        Ok(())
    }
}
