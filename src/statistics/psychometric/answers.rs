//! Answers collected by stimulus.

use super::Family;
use crate::{Computed, undefined};

/// The answers to one stimulus.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block {
    /// The stimulus, in the caller's unit.
    pub x: f64,
    /// Trials with it.
    pub n: u32,
    /// Those answered right, or yes, or `stronger`.
    pub n_right: u32,
}

impl Block {
    /// Single trials as blocks, stimuli ascending, equal ones together.
    pub fn of_trials(trials: impl IntoIterator<Item = (f64, bool)>) -> Vec<Self> {
        let mut trials: Vec<(f64, bool)> = trials.into_iter().collect();
        trials.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut blocks: Vec<Self> = Vec::new();
        for (x, is_right) in trials {
            let is_new = blocks.last().is_none_or(|last| last.x < x || x.is_nan());
            if is_new {
                blocks.push(Self {
                    x,
                    n: 0,
                    n_right: 0,
                });
            }
            if let Some(last) = blocks.last_mut() {
                last.n += 1;
                last.n_right += u32::from(is_right);
            }
        }
        blocks
    }
}

/// Blocks in order, if they can say anything of a threshold.
pub(super) fn checked(family: Family, blocks: &[Block]) -> Computed<Vec<Block>> {
    let mut kept: Vec<Block> = Vec::with_capacity(blocks.len());
    let mut sorted: Vec<Block> = blocks.iter().copied().filter(|b| b.n > 0).collect();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x));
    for block in sorted {
        if block.n_right > block.n {
            let reason = format!("{} of {} right at {}", block.n_right, block.n, block.x);
            return undefined(reason);
        }
        if !family.place(block.x).is_finite() {
            let name = family.name();
            let reason = format!("a stimulus of {} has no place on the {name} scale", block.x);
            return undefined(reason);
        }
        match kept.last_mut().filter(|last| last.x >= block.x) {
            Some(last) => {
                last.n += block.n;
                last.n_right += block.n_right;
            }
            None => kept.push(block),
        }
    }
    refuse_silence(&kept)?;
    Ok(kept)
}

fn refuse_silence(blocks: &[Block]) -> Computed<()> {
    let n: u32 = blocks.iter().map(|b| b.n).sum();
    let n_right: u32 = blocks.iter().map(|b| b.n_right).sum();
    let reason = match blocks {
        [] => "no trials".to_owned(),
        [one] => format!("all {n} trials at one stimulus, {}", one.x),
        _ if n_right == 0 => format!("none of {n} answers is right: no threshold is bracketed"),
        _ if n_right == n => format!("all {n} answers are right: no threshold is bracketed"),
        _ => return Ok(()),
    };
    undefined(reason)
}
