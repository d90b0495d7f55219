//! Staircases against their Markov chains, QUEST+ against Bayes' rule written out.

mod quest_plus;
mod staircases;
mod stationary;

use super::*;
use crate::psychometric::{Family, Psychometric};
use selvedge_foundation::numerics::Random;

fn observer() -> Psychometric {
    Psychometric {
        family: Family::Logistic,
        threshold: 0.0,
        width: 8.0,
        guess: 0.0,
        lapse: 0.0,
    }
}

fn answers(
    procedure: &mut dyn Procedure,
    curve: &Psychometric,
    random: &mut Random,
) -> Computed<()> {
    while let Some(stimulus) = procedure.stimulus() {
        let is_right = random.uniform() < curve.at(stimulus);
        procedure.answer(stimulus, is_right)?;
    }
    Ok(())
}
