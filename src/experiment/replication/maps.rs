//! The map of experiment 2 of Philpott & Summers 2012, turned to the levels of both bands.

use super::comparison::{DesignWithStimuli, Kind, Options, Replication, bar, by_levels, practised};
use super::printed;
use super::ranking::VIRTUAL;
use super::studies::{Subjects, each_study};
use crate::ExperimentError;
use crate::analysis::{Drawn, MapDrawing, Section, Table, bars, cells, or_undefined, rank_trial};
use crate::observer::Jnd;
use selvedge_foundation::progress::Progress;
use selvedge_foundation::quantity::level_db;
use selvedge_statistics::mds::{Dissimilarities, Loss, Map, Mds, Null, NullKind, Ties};
use selvedge_statistics::procrustes::Procrustes;
use selvedge_statistics::properties::{BestTurn, Ellipse};
use selvedge_statistics::ranking::{MeanRanks, RankTrial};
use selvedge_statistics::{Computed, Undefined, mean};
use selvedge_textile::tactile::Band;

/// Starts of a map of one study of many, in two dimensions and more, and on a line.
const N_STARTS: usize = 20;
const N_STARTS_ON_A_LINE: usize = 100;
/// As many as an analysis takes.
const N_STARTS_OF_ONE: usize = 50;
/// As many as the paper's figure goes to.
const MOST_DIMENSIONS: usize = 5;

/// What one study's maps came to.
struct Mapped {
    /// In the plane.
    map: Map,
    turn: BestTurn,
    /// What is left over once the map is laid over the places of the levels, m² of Procrustes.
    m2: f64,
    /// S-stress from one dimension on.
    losses: Vec<f64>,
    /// The trials, for one study by other losses.
    trials: Vec<RankTrial>,
}

/// Correlations of the plane map over studies, and one study by every loss and rule for ties.
///
/// # Errors
/// A study cannot be held, or it was cancelled.
pub(super) fn section(
    laid: &DesignWithStimuli,
    options: &Options,
    all: &mut Replication,
    progress: &mut Progress<'_>,
) -> Result<Section, ExperimentError> {
    let mut section = Section::new("maps", "The map of a virtual target's rankings");
    section.note(
        "S-stress with secondary ties, as ALSCAL makes it by default, of mean ranks made \
         symmetric; the plane map is turned, reflection allowed, so that r(dimension 1, A40) + \
         r(dimension 2, A320) is largest. Levels are those felt through the session's tuning, dB \
         at 100 mm/s.",
    );
    section.note(
        "The paper's figure 3b is the plane map of experiment 2. What its figure 3a shows is not \
         known here: the loss in one to five dimensions, which the paper fits too, stands in its \
         place. Ellipses and intervals hold 95 of 100 studies.",
    );
    for (nth, kind) in [by_levels(), practised()].into_iter().enumerate() {
        let how = mds(Loss::SStress, Ties::Secondary, N_STARTS);
        let part = [0.4 * nth as f64, 0.4 * (nth + 1) as f64];
        let map = |subjects: &Subjects, laid: &DesignWithStimuli| {
            mapped(rank_trials(subjects), laid, &how)
        };
        let found = progress.within(part, |part| {
            each_study(&[(laid, kind)], "maps", options, part, map)
        })?;
        let found: Vec<Computed<Mapped>> = found.into_iter().flatten().collect();
        let n_unmapped = found.iter().filter(|one| one.is_err()).count();
        if n_unmapped > 0 {
            let what = kind.description;
            section.note(format!("{what}: {n_unmapped} studies had no map."));
        }
        let found: Vec<Mapped> = found.into_iter().flatten().collect();
        compare(&found, &kind, all);
        let Some(first) = found.first().filter(|_| nth == 0) else {
            continue;
        };
        let names = laid.design.stimuli.iter().map(|one| one.id.clone());
        let chance = progress.within([0.8, 1.0], |part| {
            chance(
                &names.collect::<Vec<_>>(),
                &how,
                (MOST_DIMENSIONS, options.n_studies),
                part,
            )
        })?;
        section.figure(figure_3a(&found, &chance));
        section.figures.extend(figure_3b(&found, laid).ok());
        section.table(by_loss(&first.trials, laid));
    }
    section.note(
        "Who goes by the levels of both bands has a map of both bands, so that both correlations \
         come out high. A second dimension of people that follows A320 less than that says that \
         they felt it less well, or went by something else too.",
    );
    Ok(section)
}

fn rank_trials(subjects: &Subjects) -> Vec<RankTrial> {
    subjects.iter().flatten().filter_map(rank_trial).collect()
}

/// On one thread: studies are what threads share.
fn mds(loss: Loss, ties: Ties, n_starts: usize) -> Mds {
    Mds {
        loss,
        ties,
        n_starts,
        n_starts_on_a_line: N_STARTS_ON_A_LINE,
        n_exchanged: 2,
        n_threads: 1,
        ..Mds::default()
    }
}

/// Losses of random ranks of as many objects, dimension by dimension.
///
/// # Errors
/// There are too few to be mapped, or it was cancelled.
pub(super) fn chance(
    names: &[String],
    mds: &Mds,
    (most_dimensions, n_sets): (usize, usize),
    progress: &mut Progress<'_>,
) -> Result<Vec<Null>, ExperimentError> {
    let n = names.len();
    // Any dissimilarities of all pairs: random ranks take their places.
    let apart = |at: usize| Some((at / n).abs_diff(at % n) as f64).filter(|d| *d > 0.0);
    let any: Vec<Option<f64>> = (0..n * n).map(apart).collect();
    let data = Dissimilarities::new(names.to_vec(), &any)
        .map_err(|why| ExperimentError::value(why.reason, "take a design of more fabrics"))?;
    let mds = Mds {
        n_threads: Mds::default().n_threads,
        ..*mds
    };
    let of = |dims: usize| {
        let part = [dims - 1, dims].map(|at| at as f64 / most_dimensions as f64);
        let ranks = NullKind::RandomRanks;
        progress.within(part, |part| {
            Null::of(&mds, &data, ranks, (dims, n_sets), part)
        })
    };
    Ok((1..=most_dimensions).map(of).collect::<Result<_, _>>()?)
}

fn mapped(trials: Vec<RankTrial>, laid: &DesignWithStimuli, mds: &Mds) -> Computed<Mapped> {
    let names: Vec<String> = laid.design.stimuli.iter().map(|s| s.id.clone()).collect();
    let ranks = MeanRanks::of(names.len(), &trials)?;
    let data = Dissimilarities::new(names, &ranks.dissimilarities())?;
    let maps = Progress::unheard(|progress| mds.maps(&data, 1..=MOST_DIMENSIONS, progress));
    let maps = maps.map_err(|_stopped| Undefined::because("stopped"))?;
    let losses = maps.iter().map(|map| map.sstress).collect();
    let plane = maps.into_iter().find(|map| map.dims == 2);
    let map = plane.ok_or_else(|| Undefined::because("no plane map"))?;
    let [low, high] = levels_db(laid);
    let turn = BestTurn::of(&map.points, [&low, &high])?;
    let steps = |band: Band, db: &f64| Jnd::Published.steps(band, *db);
    let place = |(low, high): (&f64, &f64)| vec![steps(Band::Low, low), steps(Band::High, high)];
    let places: Vec<Vec<f64>> = low.iter().zip(&high).map(place).collect();
    let m2 = Procrustes::of(&map.points, &places)?.m2;
    Ok(Mapped {
        map,
        turn,
        m2,
        losses,
        trials,
    })
}

/// What is felt of every stimulus, dB by band.
fn levels_db(laid: &DesignWithStimuli) -> [Vec<f64>; 2] {
    let items = 0..laid.design.stimuli.len();
    [0, 1].map(|band| {
        let of = |item| level_db(laid.stimuli.felt_um(item)[band]);
        items.clone().map(of).collect()
    })
}

/// A number of a map.
type Of = fn(&Mapped) -> f64;

fn compare(found: &[Mapped], kind: &Kind, all: &mut Replication) {
    let [r1, r2] = printed::CORRELATIONS;
    let rows: [(&str, Option<f64>, Of); 5] = [
        ("r of dimension 1 and A40", Some(r1), |m| m.turn.r[0]),
        ("r of dimension 2 and A320", Some(r2), |m| m.turn.r[1]),
        ("m² of the map laid over the levels", None, |m| m.m2),
        ("S-stress of the plane map", None, |m| m.map.sstress),
        ("stress-1 of the same map", None, |m| m.map.stress1),
    ];
    for (quantity, printed, of) in rows {
        let values: Vec<f64> = found.iter().map(of).collect();
        all.add((VIRTUAL, kind), (quantity, printed), &values);
    }
}

/// S-stress over dimensions, beside that of random ranks.
fn figure_3a(found: &[Mapped], chance: &[Null]) -> Drawn {
    let mut shown = Vec::new();
    for (dims, null) in (1..).zip(chance) {
        let name = dimensions(dims);
        let own = found.iter().filter_map(|one| one.losses.get(dims - 1));
        shown.extend(bar(&name, "rankings", &own.copied().collect::<Vec<f64>>()));
        shown.extend(bar(&name, "random ranks", &null.losses));
    }
    let title = "Philpott & Summers 2012, in place of figure 3a: how well maps fit";
    let label = "S-stress (95 of 100 studies)";
    bars("figure-3a", title, label, (&shown, None), &[])
}

pub(super) fn dimensions(n: usize) -> String {
    format!("{n} dimension{}", if n == 1 { "" } else { "s" })
}

/// The mean of the turned maps of all studies.
fn figure_3b(found: &[Mapped], laid: &DesignWithStimuli) -> Computed<Drawn> {
    let names: Vec<String> = laid
        .design
        .stimuli
        .iter()
        .map(|one| one.id.clone())
        .collect();
    let maps: Vec<Vec<Vec<f64>>> = found.iter().map(|one| one.turn.points.clone()).collect();
    let middle = |item: usize, axis: usize| {
        mean(&maps.iter().map(|map| map[item][axis]).collect::<Vec<f64>>())
    };
    let points: Computed<Vec<Vec<f64>>> = (0..names.len())
        .map(|item| Ok(vec![middle(item, 0)?, middle(item, 1)?]))
        .collect();
    let points = points?;
    let ellipses = Ellipse::of_bootstrap(&points, &maps, 0.95)?;
    let drawing = MapDrawing {
        names: &names,
        points: &points,
        axes: ["dimension 1, towards A40", "dimension 2, towards A320"],
        ellipses: &ellipses,
        directions: &[],
    };
    let title = "As Philpott & Summers 2012, figure 3b: the plane map of experiment 2";
    let note = "The mean of the studies' maps; an ellipse holds 95 of 100 studies.";
    Ok(drawing.drawn("figure-3b", title, vec![note.to_owned()]))
}

fn by_loss(trials: &[RankTrial], laid: &DesignWithStimuli) -> Table {
    let columns = "loss: made small; ties; sstress: S-stress; stress1: stress-1; r1: r of \
        dimension 1 and A40; r2: r of dimension 2 and A320";
    let title = "One study of eight who go by levels, by loss and rule for ties";
    let mut table = Table::new("ties", title, columns);
    for loss in [Loss::SStress, Loss::Stress1] {
        for ties in [Ties::Secondary, Ties::Primary] {
            let one = mapped(trials.to_vec(), laid, &mds(loss, ties, N_STARTS_OF_ONE));
            let one = one.map(|one| cells![one.map.sstress, one.map.stress1, one.turn.r]);
            table.push(cells![loss.name(), ties.name(), or_undefined(one, 4)]);
        }
    }
    table
}
