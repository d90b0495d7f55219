//! The odd one of three (Allerkamp et al.): seven similar fabrics in three sessions.

use super::comparison::{DesignWithStimuli, Kind, Options, Replication, by_levels, guessing};
use super::studies::{Studies, Subjects, percent_right, planned};
use crate::ExperimentError;
use crate::analysis::{Cell, Section, Table, cells, grade_weights, percent_of, triad_answer};
use crate::design::{self, Design};
use selvedge_foundation::progress::{Progress, unheard};
use selvedge_statistics::mds::{Dissimilarities, Elbow, Loss, Mds, Null, NullKind, Ties};
use selvedge_statistics::ranking::{Grade, OddOneOut, TriadAnswer};
use selvedge_statistics::{Computed, Undefined};

const PAPER: &str = "Allerkamp et al., odd one out";
/// The paper ends with this many dimensions for virtual fabrics, by the elbow.
const PRINTED_DIMENSIONS: f64 = 1.0;
/// Sessions of every subject.
const N_SESSIONS: u32 = 3;
/// Starts of maps: few objects, so that few are needed.
const N_STARTS: usize = 20;
const N_STARTS_ON_A_LINE: usize = 200;
/// Sets of random ranks that stress is compared with.
const N_RANDOM_DATA: usize = 40;
/// More dimensions than these leave seven fabrics nothing to fit.
const MOST_DIMENSIONS: usize = 4;

/// How often each subject comes.
pub(super) fn sessions_of(design: &Design) -> u32 {
    match design.composition.kind() {
        design::Kind::OddOneOut => N_SESSIONS,
        _ => 1,
    }
}

/// What one study came to.
struct Found {
    percent: f64,
    /// Of right answers, %: easy, normal, hard.
    grades: [f64; 3],
    /// Pairs at the ceiling and at the floor.
    ends: [f64; 2],
    data: Computed<Dissimilarities>,
}

/// Right answers, how easy they were, and how many dimensions the elbow finds.
///
/// # Errors
/// A study cannot be held, or it was cancelled.
pub(super) fn section(
    laid: &DesignWithStimuli,
    options: &Options,
    all: &mut Replication,
    progress: &mut Progress<'_>,
) -> Result<Section, ExperimentError> {
    let title = "The odd one of three: seven similar fabrics, three sessions";
    let mut section = Section::new("odd-one-out", title);
    section.note(format!(
        "{} observers, {N_SESSIONS} sessions, every pair once a session. The distance of a pair is \
         the sum of weights of its right answers; stress-1 with primary ties, since sums pile up \
         at their ends. The paper's shares of right answers are not known here, so there is \
         nothing printed beside those.",
        planned(&laid.design)
    ));
    let mut chosen = Table::new(
        "elbow",
        "How many dimensions the elbow finds, share of studies, %",
        &[
            ("observer", "observer"),
            ("one", "one"),
            ("two", "two"),
            ("more", "more"),
            ("below_chance", "a map below the 5 % point of random ranks"),
            ("studies", "studies"),
        ],
    );
    let chance = progress.within([0.0, 0.4], |part| chance(laid, part))?;
    for (nth, kind) in [by_levels(), guessing()].into_iter().enumerate() {
        let studies = Studies::of(laid, kind.observer, N_SESSIONS, options);
        let part = [0.4 + 0.3 * nth as f64, 0.7 + 0.3 * nth as f64];
        let found = progress.within(part, |part| {
            studies.each((options.n_maps, "triads"), part, |s| found(s, laid))
        })?;
        let elbows: Vec<Elbow> = found
            .iter()
            .filter_map(|f| elbow(f, &chance).ok())
            .collect();
        compare(&found, &elbows, &kind, all);
        chosen.push(shares(&kind, &elbows));
    }
    section.table(chosen);
    Ok(section)
}

fn found(subjects: &Subjects, laid: &DesignWithStimuli) -> Found {
    let rows = || subjects.iter().flatten();
    let answers: Vec<TriadAnswer> = rows().filter_map(triad_answer).collect();
    let percents: Vec<f64> = subjects.iter().map(|own| percent_right(own)).collect();
    let right: Vec<&TriadAnswer> = answers.iter().filter(|a| a.is_correct).collect();
    let grades = Grade::ALL.map(|grade| {
        let n = right.iter().filter(|a| a.grade == grade).count();
        100.0 * n as f64 / right.len() as f64
    });
    let names: Vec<String> = laid.design.stimuli.iter().map(|s| s.id.clone()).collect();
    let tally = OddOneOut::of(
        names.len(),
        &answers,
        grade_weights(&laid.design.composition),
    );
    let ends = tally.as_ref().map_or([f64::NAN; 2], |tally| {
        [tally.n_ceiling as f64, tally.n_floor as f64]
    });
    Found {
        percent: percents.iter().sum::<f64>() / percents.len() as f64,
        grades,
        ends,
        data: tally.and_then(|tally| Dissimilarities::new(names, &tally.distances())),
    }
}

fn mds() -> Mds {
    Mds {
        loss: Loss::Stress1,
        ties: Ties::Primary,
        n_starts: N_STARTS,
        n_starts_on_a_line: N_STARTS_ON_A_LINE,
        ..Mds::default()
    }
}

/// Stress of random ranks of as many fabrics, dimension by dimension.
///
/// # Errors
/// There are too few fabrics to be mapped, or it was cancelled.
pub(super) fn chance(
    laid: &DesignWithStimuli,
    progress: &mut Progress<'_>,
) -> Result<Vec<Null>, ExperimentError> {
    let names: Vec<String> = laid.design.stimuli.iter().map(|s| s.id.clone()).collect();
    let n = names.len();
    // Any dissimilarities of all pairs: random ranks take their places.
    let apart = |at: usize| Some((at / n).abs_diff(at % n) as f64).filter(|d| *d > 0.0);
    let any: Vec<Option<f64>> = (0..n * n).map(apart).collect();
    let data = Dissimilarities::new(names, &any)
        .map_err(|why| ExperimentError::value(why.reason, "take a design of more fabrics"))?;
    let of = |dims: usize| {
        let part = [dims - 1, dims].map(|at| at as f64 / MOST_DIMENSIONS as f64);
        let sets = (dims, N_RANDOM_DATA);
        let ranks = NullKind::RandomRanks;
        progress.within(part, |part| Null::of(&mds(), &data, ranks, sets, part))
    };
    Ok((1..=MOST_DIMENSIONS).map(of).collect::<Result<_, _>>()?)
}

fn elbow(found: &Found, chance: &[Null]) -> Computed<Elbow> {
    let data = found.data.as_ref().map_err(Clone::clone)?;
    let maps = unheard(|progress| mds().maps(data, 1..=MOST_DIMENSIONS, progress));
    let maps = maps.map_err(|_stopped| Undefined::because("stopped"))?;
    let losses: Vec<(usize, f64)> = maps.iter().map(|map| (map.dims, map.stress1)).collect();
    let five: Vec<f64> = chance.iter().map(Null::five_percent).collect();
    Ok(Elbow::of(&losses, chance.first().map(Null::mean), &five))
}

fn compare(found: &[Found], elbows: &[Elbow], kind: &Kind, all: &mut Replication) {
    let mut add = |quantity: &str, printed: Option<f64>, values: Vec<f64>| {
        let finite: Vec<f64> = values.into_iter().filter(|v| v.is_finite()).collect();
        all.add((PAPER, kind), (quantity, printed), &finite);
    };
    let of = |of: &dyn Fn(&Found) -> f64| found.iter().map(of).collect::<Vec<f64>>();
    add("right answers, %", None, of(&|f| f.percent));
    for (nth, name) in ["easy", "normal", "hard"].into_iter().enumerate() {
        let quantity = format!("right answers called {name}, %");
        add(&quantity, None, of(&|f| f.grades[nth]));
    }
    add("pairs at the ceiling, of 21", None, of(&|f| f.ends[0]));
    add("pairs at the floor, of 21", None, of(&|f| f.ends[1]));
    let dims = elbows.iter().filter_map(|elbow| elbow.by_bend);
    let quantity = "dimensions by the elbow";
    let dims = dims.map(|k| k as f64).collect();
    add(quantity, Some(PRINTED_DIMENSIONS), dims);
}

fn shares(kind: &Kind, elbows: &[Elbow]) -> Vec<Cell> {
    let n = elbows.len();
    let percent = |is_it: &dyn Fn(&Elbow) -> bool| {
        let n_such = elbows.iter().filter(|elbow| is_it(elbow)).count();
        percent_of(n_such as u64, n as u64, "no study had a map")
    };
    let found = [
        percent(&|elbow| elbow.by_bend == Some(1)),
        percent(&|elbow| elbow.by_bend == Some(2)),
        percent(&|elbow| elbow.by_bend > Some(2)),
        percent(&|elbow| elbow.below_chance.is_some()),
    ];
    cells![kind.description, found, n]
}
