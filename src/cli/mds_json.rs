//! The file that `selvedge mds` writes.

use serde::Serialize;

use selvedge_statistics::mds::{Dissimilarities, Elbow, Map, Mds, Null};

/// What data without structure gave; empty where nobody asked.
#[derive(Debug, Default)]
pub(super) struct Chance {
    pub(super) random_data: Vec<Null>,
    pub(super) permutations: Vec<Null>,
}

/// The whole file.
#[derive(Debug, Serialize)]
pub(super) struct Document<'a> {
    program: &'static str,
    names: &'a [String],
    n_pairs: usize,
    n_missing: usize,
    ties: &'static str,
    loss: &'static str,
    seed: u64,
    definitions: Definitions,
    dimensions: Vec<Dimension<'a>>,
    elbow: ElbowOut<'a>,
}

/// What the numbers are, for who reads the file alone.
#[derive(Debug, Serialize)]
struct Definitions {
    stress1: &'static str,
    sstress: &'static str,
    points: &'static str,
    reached_best: &'static str,
    stress_per_point: &'static str,
    share_per_point: &'static str,
    p: &'static str,
    elbow: &'static str,
}

const DEFINITIONS: Definitions = Definitions {
    stress1: "sqrt(sum (d - dhat)^2 / sum d^2) over pairs of the points given here; dhat is the \
              monotone regression of d on the order of the dissimilarities",
    sstress: "the same with d^2 in the place of d (ALSCAL)",
    points: "rows as in names; centred, principal axes, the coordinate farthest from 0 of each \
             axis positive, mean square distance 1",
    reached_best: "starts that came within 1e-5 of the best loss by themselves: before the last \
                   polish and, on a line, before objects were exchanged",
    stress_per_point: "the loss over the pairs of each object alone",
    share_per_point: "its share of what is left over; shares add up to 1",
    p: "(b + 1)/(N + 1), b sets without structure with a loss as low",
    elbow: "first difference: fall of the loss on the way to these dimensions; second: this fall \
            less the next; bends_at: largest second difference. before: mean loss of random data \
            on a line, where it is known. below_chance_from: fewest dimensions below the 5 % point \
            of random data",
};

#[derive(Debug, Serialize)]
struct Dimension<'a> {
    dims: usize,
    stress1: f64,
    sstress: f64,
    points: &'a [Vec<f64>],
    starts: usize,
    reached_best: usize,
    reached_best_share: f64,
    stress_per_point: &'a [f64],
    share_per_point: Option<&'a [f64]>,
    spearman: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    spearman_reason: Option<&'a str>,
    warnings: &'a [String],
    #[serde(skip_serializing_if = "Option::is_none")]
    random_data: Option<ChanceOut>,
    #[serde(skip_serializing_if = "Option::is_none")]
    permutations: Option<ChanceOut>,
    shepard: Vec<PairOut<'a>>,
}

#[derive(Debug, Serialize)]
struct PairOut<'a> {
    a: &'a str,
    b: &'a str,
    dissimilarity: f64,
    distance: f64,
    disparity: f64,
}

#[derive(Debug, Serialize)]
struct ChanceOut {
    n: usize,
    mean: f64,
    five_percent: f64,
    p: f64,
}

#[derive(Debug, Serialize)]
struct ElbowOut<'a> {
    dims: &'a [usize],
    loss: &'a [f64],
    before: Option<f64>,
    first_differences: &'a [Option<f64>],
    second_differences: &'a [Option<f64>],
    bends_at: Option<usize>,
    below_chance_from: Option<usize>,
}

impl<'a> Document<'a> {
    pub(super) fn of(
        data: &'a Dissimilarities,
        mds: &Mds,
        maps: &'a [Map],
        chance: &Chance,
        elbow: &'a Elbow,
    ) -> Self {
        let dimension = |map: &'a Map| {
            let own = |all: &[Null]| {
                let null = all.iter().find(|null| null.dims == map.dims);
                null.map(|null| chance_out(null, map.loss(mds.loss)))
            };
            Dimension {
                random_data: own(&chance.random_data),
                permutations: own(&chance.permutations),
                ..Dimension::of(map, data.names())
            }
        };
        Self {
            program: selvedge_foundation::PROGRAM,
            names: data.names(),
            n_pairs: data.pairs().len(),
            n_missing: data.n_missing(),
            ties: mds.ties.name(),
            loss: mds.loss.name(),
            seed: mds.seed,
            definitions: DEFINITIONS,
            dimensions: maps.iter().map(dimension).collect(),
            elbow: ElbowOut {
                dims: &elbow.dims,
                loss: &elbow.loss,
                before: elbow.before,
                first_differences: &elbow.first_differences,
                second_differences: &elbow.second_differences,
                bends_at: elbow.by_bend,
                below_chance_from: elbow.below_chance,
            },
        }
    }
}

fn chance_out(null: &Null, loss: f64) -> ChanceOut {
    ChanceOut {
        n: null.losses.len(),
        mean: null.mean(),
        five_percent: null.five_percent(),
        p: null.p_value(loss),
    }
}

impl<'a> Dimension<'a> {
    fn of(map: &'a Map, names: &'a [String]) -> Self {
        let pair = |point: &selvedge_statistics::mds::ShepardPoint| PairOut {
            a: &names[point.objects[0]],
            b: &names[point.objects[1]],
            dissimilarity: point.delta,
            distance: point.distance,
            disparity: point.disparity,
        };
        Self {
            dims: map.dims,
            stress1: map.stress1,
            sstress: map.sstress,
            points: &map.points,
            starts: map.n_starts,
            reached_best: map.n_reached,
            reached_best_share: map.n_reached as f64 / map.n_starts as f64,
            stress_per_point: &map.stress_per_point,
            share_per_point: map.share_per_point.as_deref(),
            spearman: map.spearman.as_ref().ok().copied(),
            spearman_reason: map.spearman.as_ref().err().map(|why| why.reason.as_str()),
            warnings: &map.warnings,
            random_data: None,
            permutations: None,
            shepard: map.shepard.iter().map(pair).collect(),
        }
    }
}
