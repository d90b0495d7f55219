//! The map of experiment 2 of Philpott & Summers 2012, turned to the levels of both bands.

use super::comparison::{DesignWithStimuli, Kind, Options, Replication, by_levels, practised};
use super::printed;
use super::ranking::VIRTUAL;
use super::studies::{Studies, Subjects};
use crate::ExperimentError;
use crate::analysis::{Section, Table, cells, or_undefined, rank_trial};
use crate::observer::Jnd;
use selvedge_foundation::progress::{Progress, unheard};
use selvedge_foundation::quantity::level_db;
use selvedge_statistics::mds::{Dissimilarities, Loss, Map, Mds, Ties};
use selvedge_statistics::procrustes::Procrustes;
use selvedge_statistics::properties::BestTurn;
use selvedge_statistics::ranking::{MeanRanks, RankTrial};
use selvedge_statistics::{Computed, Undefined};
use selvedge_textile::tactile::Band;

/// Starts of a plane map of one study of many.
const N_STARTS: usize = 20;
/// As many as an analysis takes.
const N_STARTS_OF_ONE: usize = 50;

/// What one study's map came to.
struct Mapped {
    map: Map,
    turn: BestTurn,
    /// What is left over once the map is laid over the places of the levels, m² of Procrustes.
    m2: f64,
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
    for (nth, kind) in [by_levels(), practised()].into_iter().enumerate() {
        let studies = Studies::of(laid, kind.observer, 1, options);
        let n = options.n_maps;
        let mds = mds(Loss::SStress, Ties::Secondary, N_STARTS);
        let part = [0.45 * nth as f64, 0.45 * (nth + 1) as f64];
        let found = progress.within(part, |part| {
            let map = |subjects: &Subjects| mapped(&rank_trials(subjects), laid, &mds);
            studies.each((n, "maps"), part, map)
        })?;
        let n_mapped = found.iter().filter(|one| one.is_ok()).count();
        if n_mapped < n {
            section.note(format!(
                "{}: {} studies had no map.",
                kind.description,
                n - n_mapped
            ));
        }
        let found: Vec<Mapped> = found.into_iter().flatten().collect();
        compare(&found, &kind, all);
    }
    progress.step(0.9, "one study by every loss and rule for ties")?;
    let studies = Studies::of(laid, by_levels().observer, 1, options);
    let one = unheard(|progress| studies.each((1, ""), progress, rank_trials))?;
    let trials: Vec<RankTrial> = one.into_iter().flatten().collect();
    section.table(by_loss(&trials, laid));
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
        n_threads: 1,
        ..Mds::default()
    }
}

fn mapped(trials: &[RankTrial], laid: &DesignWithStimuli, mds: &Mds) -> Computed<Mapped> {
    let names: Vec<String> = laid.design.stimuli.iter().map(|s| s.id.clone()).collect();
    let ranks = MeanRanks::of(names.len(), trials)?;
    let data = Dissimilarities::new(names, &ranks.dissimilarities())?;
    let maps = unheard(|progress| mds.maps(&data, 2..=2, progress));
    let plane = maps.ok().and_then(|maps| maps.into_iter().next());
    let map = plane.ok_or_else(|| Undefined::because("no plane map"))?;
    let [low, high] = levels_db(laid);
    let turn = BestTurn::of(&map.points, [&low, &high])?;
    let steps = |band: Band, db: &f64| Jnd::Published.steps(band, *db);
    let place = |(low, high): (&f64, &f64)| vec![steps(Band::Low, low), steps(Band::High, high)];
    let places: Vec<Vec<f64>> = low.iter().zip(&high).map(place).collect();
    let m2 = Procrustes::of(&map.points, &places)?.m2;
    Ok(Mapped { map, turn, m2 })
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

fn by_loss(trials: &[RankTrial], laid: &DesignWithStimuli) -> Table {
    let columns = [
        ("loss", "made small"),
        ("ties", "ties"),
        ("sstress", "S-stress"),
        ("stress1", "stress-1"),
        ("r1", "r of dimension 1 and A40"),
        ("r2", "r of dimension 2 and A320"),
    ];
    let title = "One study of eight who go by levels, by loss and rule for ties";
    let mut table = Table::new("ties", title, &columns);
    for loss in [Loss::SStress, Loss::Stress1] {
        for ties in [Ties::Secondary, Ties::Primary] {
            let one = mapped(trials, laid, &mds(loss, ties, N_STARTS_OF_ONE));
            let one = one.map(|one| cells![one.map.sstress, one.map.stress1, one.turn.r]);
            table.push(cells![loss.name(), ties.name(), or_undefined(one, 4)]);
        }
    }
    table
}
