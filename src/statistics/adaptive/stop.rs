//! When a procedure is over, as an expression.

use crate::{Computed, undefined};

/// When to stop: a condition, any of several, or all of several.
#[derive(Debug, Clone, PartialEq)]
pub enum Stop {
    /// After so many trials.
    Trials(u32),
    /// After so many reversals of a staircase.
    Reversals(u32),
    /// Once the posterior of the threshold has this standard deviation or less.
    PosteriorSd(f64),
    /// As soon as one of these holds.
    Any(Vec<Self>),
    /// Once all of these hold.
    All(Vec<Self>),
}

/// How far a procedure is; `None` for what it does not have.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Reached {
    /// Trials.
    pub n_trials: u32,
    /// Reversals.
    pub n_reversals: Option<u32>,
    /// Standard deviation of the posterior of the threshold.
    pub(crate) posterior_sd: Option<f64>,
}

impl Stop {
    /// Whether the procedure is over.
    pub(crate) fn is_met(&self, reached: &Reached) -> bool {
        match self {
            Self::Trials(n) => reached.n_trials >= *n,
            Self::Reversals(n) => reached.n_reversals.is_some_and(|found| found >= *n),
            Self::PosteriorSd(sd) => reached.posterior_sd.is_some_and(|found| found <= *sd),
            Self::Any(of) => of.iter().any(|stop| stop.is_met(reached)),
            Self::All(of) => of.iter().all(|stop| stop.is_met(reached)),
        }
    }

    /// Refuses what makes no sense for a procedure with what `reached` has.
    pub(super) fn check(&self, reached: &Reached) -> Computed<()> {
        let reason = match self {
            Self::Trials(0) => "it stops after no trial".to_owned(),
            Self::Reversals(0) => "it stops after no reversal".to_owned(),
            Self::Reversals(_) if reached.n_reversals.is_none() => {
                "it waits for reversals, which only staircases have".to_owned()
            }
            Self::PosteriorSd(_) if reached.posterior_sd.is_none() => {
                "it waits for a posterior, which only QUEST+ has".to_owned()
            }
            Self::PosteriorSd(sd) if !(*sd > 0.0 && sd.is_finite()) => {
                format!("it waits for a posterior with a standard deviation of {sd}")
            }
            Self::Any(of) | Self::All(of) if of.is_empty() => "it stops by no condition".to_owned(),
            Self::Any(of) | Self::All(of) => {
                return of.iter().try_for_each(|stop| stop.check(reached));
            }
            _ => return Ok(()),
        };
        undefined(reason)
    }
}

impl std::fmt::Display for Stop {
    /// `30 trials or (8 reversals and 20 trials)`.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let joined = |of: &[Self], word: &str| {
            let each = |stop: &Self| match stop {
                Self::Any(inner) | Self::All(inner) if inner.len() > 1 => format!("({stop})"),
                _ => stop.to_string(),
            };
            of.iter().map(each).collect::<Vec<_>>().join(word)
        };
        match self {
            Self::Trials(n) => write!(f, "{n} trials"),
            Self::Reversals(n) => write!(f, "{n} reversals"),
            Self::PosteriorSd(sd) => write!(f, "posterior sd ≤ {sd}"),
            Self::Any(of) => f.write_str(&joined(of, " or ")),
            Self::All(of) => f.write_str(&joined(of, " and ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_expression_is_read_as_it_is_written() {
        let stop = Stop::Any(vec![
            Stop::Trials(30),
            Stop::All(vec![Stop::Reversals(8), Stop::Trials(20)]),
        ]);
        assert_eq!(stop.to_string(), "30 trials or (8 reversals and 20 trials)");
        let met = |n_trials, n: u32| {
            stop.is_met(&Reached {
                n_trials,
                n_reversals: Some(n),
                posterior_sd: None,
            })
        };
        assert!(
            !met(19, 9) && met(20, 8) && !met(29, 7) && met(30, 0),
            "or of and"
        );
    }

    #[test]
    fn what_can_never_come_true_is_refused() {
        let quest = Reached {
            posterior_sd: Some(1.0),
            ..Reached::default()
        };
        let staircase = Reached {
            n_reversals: Some(0),
            ..Reached::default()
        };
        assert!(Stop::Reversals(4).check(&quest).is_err(), "no reversals");
        assert!(
            Stop::PosteriorSd(0.1).check(&staircase).is_err(),
            "no posterior"
        );
        assert!(Stop::Any(Vec::new()).check(&quest).is_err(), "no condition");
        assert!(
            Stop::All(vec![Stop::Trials(0)]).check(&quest).is_err(),
            "no trial"
        );
        assert!(
            Stop::PosteriorSd(f64::NAN).check(&quest).is_err(),
            "no number"
        );
        assert!(Stop::Reversals(4).check(&staircase).is_ok(), "fine");
    }
}
