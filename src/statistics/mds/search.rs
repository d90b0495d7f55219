//! The best of many starts, whatever the number of threads.

use super::Mds;
use super::descend::{Until, descend, majorise};
use super::fit::{Fit, Loss, Problem};
use super::start::{raised, thrown, torgerson};
use selvedge_foundation::numerics::{Random, in_pieces};
use selvedge_foundation::progress::{Cancelled, Progress};

/// What an order is tried with before it is followed to the end.
const GLANCE: Until = Until {
    n_steps: 4,
    share: 1e-6,
};
/// An order is followed when a glance at it is within this factor of the best squared loss.
const WORTH: f64 = 1.15;

/// How a start is followed downhill.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Descent {
    /// Not at all: classical scaling (Torgerson) as it is.
    None,
    /// Majorisation alone (SMACOF), which lowers stress-1 whatever the loss.
    Majorise,
    /// A few steps of majorisation, then quasi-Newton steps on the loss itself.
    #[default]
    Polish,
}

/// A search in so many dimensions.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plan {
    pub(super) k: usize,
    pub(super) mds: Mds,
}

/// The lowest place that was found.
#[derive(Debug, Clone)]
pub(super) struct Lowest {
    pub(super) x: Vec<f64>,
    /// Loss (not squared).
    pub(super) loss: f64,
    pub(super) n_starts: usize,
    /// Starts that came within [`AS_GOOD`] of it.
    pub(super) n_reached: usize,
}

/// Losses that differ by less are the same place.
pub(super) const AS_GOOD: f64 = 1e-5;
/// Steps of majorisation before those of quasi-Newton.
const N_MAJORISED: usize = 12;
/// A start is followed until a step lowers the squared loss by less than this share.
const FOLLOWED: Until = Until {
    n_steps: 250,
    share: 1e-8,
};
const MAJORISED: Until = Until {
    n_steps: 5000,
    share: 1e-9,
};
const POLISHED: Until = Until {
    n_steps: 2000,
    share: 1e-14,
};
/// The best starts that are polished to the end.
const N_POLISHED: usize = 4;

struct Run {
    x: Vec<f64>,
    f: f64,
}

/// Follows a start downhill.
pub(super) fn downhill(fit: &mut Fit<'_>, plan: &Plan, x: &mut [f64]) -> f64 {
    match (plan.mds.descent, plan.mds.loss) {
        (Descent::None, loss) => {
            fit.problem.normalise(x, plan.k);
            fit.loss(loss, x)
        }
        (Descent::Majorise, loss) => {
            majorise(fit, x, MAJORISED);
            fit.loss(loss, x)
        }
        (Descent::Polish, Loss::Stress1) => {
            let until = Until {
                n_steps: N_MAJORISED,
                ..MAJORISED
            };
            majorise(fit, x, until);
            descend(fit, Loss::Stress1, x, FOLLOWED)
        }
        (Descent::Polish, Loss::SStress) => descend(fit, Loss::SStress, x, FOLLOWED),
    }
}

/// Where start number `i` begins.
fn begun(problem: &Problem, plan: &Plan, lower: Option<&[f64]>, i: usize) -> Vec<f64> {
    let mut random =
        Random::new(plan.mds.seed).branch(&format!("{} dimensions, start {i}", plan.k));
    match (i, lower) {
        (0, _) => torgerson(problem, plan.k),
        (1, Some(lower)) => raised(lower, plan.k, &mut random),
        _ => thrown(problem.n, plan.k, &mut random),
    }
}

/// Follows all starts and keeps the best. `lower` is the best map of one dimension less.
///
/// Starts are classical scaling, `lower` with a new axis, and chance. On a line the best orders are
/// improved by exchange besides.
pub(super) fn search(
    problem: &Problem,
    plan: &Plan,
    lower: Option<&[f64]>,
    progress: &mut Progress<'_>,
) -> Result<Lowest, Cancelled> {
    let mut runs: Vec<Option<Run>> = Vec::new();
    runs.resize_with(plan.mds.starts_in(plan.k).max(1), || None);
    // Between batches somebody may cancel: about a tenth of a second of work.
    let batch = (100_000 / (problem.pairs.len() * plan.k)).clamp(8, 500);
    let n_all = runs.len();
    let doing = format!("{} dimensions", plan.k);
    let [starts, exchanged] = work(&plan.mds, problem.n, plan.k);
    let followed = starts / (starts + exchanged);
    for (n_done, some) in runs.chunks_mut(batch).enumerate() {
        let first = n_done * batch;
        progress.step(followed * first as f64 / n_all as f64, &doing)?;
        let prepare = || Fit::new(problem, plan.k);
        in_pieces(some, 1, plan.mds.n_threads, prepare, |fit, number, run| {
            fit.reset();
            let mut x = begun(problem, plan, lower, first + number);
            let f = downhill(fit, plan, &mut x);
            run[0] = Some(Run { x, f });
        });
    }
    let mut runs: Vec<Run> = runs.into_iter().flatten().collect();
    runs.sort_by(|a, b| a.f.total_cmp(&b.f));
    let losses: Vec<f64> = runs.iter().map(|run| run.f.max(0.0).sqrt()).collect();
    runs.truncate(if plan.k == 1 {
        (10 * plan.mds.n_exchanged).max(N_POLISHED)
    } else {
        N_POLISHED
    });
    if plan.mds.descent == Descent::Polish {
        runs = progress.within([followed, 1.0], |progress| {
            finished(problem, plan, runs, progress)
        })?;
    }
    let best = runs.swap_remove(0);
    let loss = best.f.max(0.0).sqrt();
    let is_there = |reached: &&f64| **reached <= loss + AS_GOOD;
    Ok(Lowest {
        x: best.x,
        loss,
        n_starts: n_all,
        n_reached: losses.iter().filter(is_there).count(),
    })
}

/// How much following all starts takes, and how much exchanging objects on a line, in starts of as
/// many objects on a line. Where exchange ends nobody knows before; three rounds are usual.
pub(super) fn work(mds: &Mds, n: usize, k: usize) -> [f64; 2] {
    let starts = (mds.starts_in(k).max(1) * k) as f64;
    let is_exchanged = k == 1 && mds.n_exchanged > 0 && mds.descent == Descent::Polish;
    let glances = 3.0 * 1.5 * (n * n) as f64;
    let per_glance = 0.2;
    let exchanged = if is_exchanged {
        mds.n_exchanged as f64 * glances * per_glance
    } else {
        0.0
    };
    [starts, exchanged]
}

/// The best runs followed to the very end, the best first.
fn finished(
    problem: &Problem,
    plan: &Plan,
    mut runs: Vec<Run>,
    progress: &mut Progress<'_>,
) -> Result<Vec<Run>, Cancelled> {
    if plan.k == 1 {
        runs.dedup_by(|a, b| (a.f - b.f).abs() <= 1e-7 * b.f);
        runs.truncate(plan.mds.n_exchanged.max(1));
    }
    let is_exchanged = plan.k == 1 && plan.mds.n_exchanged > 0;
    let mut exchanges: Vec<Exchange<'_>> = runs
        .into_iter()
        .map(|run| Exchange::of(Fit::new(problem, plan.k), run))
        .collect();
    while is_exchanged && exchanges.iter().any(|one| !one.is_over) {
        let shares = exchanges.iter().map(Exchange::share_done);
        let share = shares.sum::<f64>() / exchanges.len() as f64;
        progress.step(share, "1 dimension, objects exchanged")?;
        let go_on = |(): &mut (), _: usize, one: &mut [Exchange<'_>]| one[0].go_on(plan);
        in_pieces(&mut exchanges, 1, plan.mds.n_threads, || (), go_on);
    }
    let polish = |(): &mut (), _: usize, one: &mut [Exchange<'_>]| {
        let Exchange { fit, run, .. } = &mut one[0];
        run.f = descend(fit, plan.mds.loss, &mut run.x, POLISHED);
    };
    in_pieces(&mut exchanges, 1, plan.mds.n_threads, || (), polish);
    let mut runs: Vec<Run> = exchanges.into_iter().map(|one| one.run).collect();
    runs.sort_by(|a, b| a.f.total_cmp(&b.f));
    Ok(runs)
}

/// A map on a line that is improved until no exchange of two objects and no move of one helps.
struct Exchange<'a> {
    fit: Fit<'a>,
    run: Run,
    tried: Vec<f64>,
    /// The rank whose object comes next, and the loss when the round began.
    from: usize,
    before: f64,
    n_rounds: usize,
    is_over: bool,
}

impl<'a> Exchange<'a> {
    fn of(fit: Fit<'a>, run: Run) -> Self {
        Self {
            fit,
            tried: run.x.clone(),
            from: 0,
            before: run.f,
            n_rounds: 0,
            is_over: false,
            run,
        }
    }

    /// How far it is, if a round that helped is followed by one more that does not.
    fn share_done(&self) -> f64 {
        if self.is_over {
            return 1.0;
        }
        let rounds = self.n_rounds as f64 + self.from as f64 / self.run.x.len() as f64;
        let is_helped = self.run.f < self.before || self.n_rounds == 0;
        let all = self.n_rounds as f64 + if is_helped { 2.0 } else { 1.0 };
        (rounds / all).min(1.0)
    }

    /// Exchanges and moves the object at one rank.
    fn go_on(&mut self, plan: &Plan) {
        if self.is_over {
            return;
        }
        let (n, from) = (self.run.x.len(), self.from);
        for to in 0..n {
            for is_swap in [true, false] {
                // Moving to the next place is an exchange, and so is every swap backwards.
                let is_new = if is_swap {
                    from < to
                } else {
                    from.abs_diff(to) > 1
                };
                if is_new {
                    self.try_one(plan, (from, to), is_swap);
                }
            }
        }
        self.from += 1;
        if self.from == n {
            self.is_over = self.run.f >= self.before;
            (self.from, self.before) = (0, self.run.f);
            self.n_rounds += 1;
        }
    }

    fn try_one(&mut self, plan: &Plan, (from, to): (usize, usize), is_swap: bool) {
        rearranged(&self.run.x, from, to, is_swap, &mut self.tried);
        if majorise(&mut self.fit, &mut self.tried, GLANCE) > WORTH * self.run.f {
            return;
        }
        let next = downhill(&mut self.fit, plan, &mut self.tried);
        if next < self.run.f * (1.0 - 1e-9) - 1e-15 {
            self.run.f = next;
            self.run.x.copy_from_slice(&self.tried);
        }
    }
}

/// The objects at two ranks exchanged, or one moved to the other's rank and those between shifted;
/// the places on the line stay.
fn rearranged(x: &[f64], from: usize, to: usize, is_swap: bool, out: &mut [f64]) {
    let mut order: Vec<usize> = (0..x.len()).collect();
    order.sort_by(|&a, &b| x[a].total_cmp(&x[b]));
    let places: Vec<f64> = order.iter().map(|&i| x[i]).collect();
    if is_swap {
        order.swap(from, to);
    } else {
        let moved = order.remove(from);
        order.insert(to, moved);
    }
    for (&object, place) in order.iter().zip(places) {
        out[object] = place;
    }
}
