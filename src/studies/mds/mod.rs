//! The study of maps from dissimilarities: stress against run time by way downhill, starts, ties
//! and loss, beside the lowest that another program finds of the same numbers.

use std::path::Path;

use selvedge_foundation::files::Table;
use selvedge_foundation::progress::Progress;
use selvedge_statistics::mds::{Descent, Dissimilarities, Loss, Map, Mds, Ties};

use super::{Bench, Findings, ReportError, Row, Study};

const TRUTH: &str = include_str!("../../../tests/truth/maps.csv");
/// Objects of every case: as many as there are textiles in the study that maps are made for.
const N_OBJECTS: usize = 16;
/// Stress above the best known against run time.
pub(crate) const STUDY: Study = Study {
    name: "mds",
    chapter: "evidence",
    question: "How far above the best known stress does each way to make a map end, and at what \
               cost?",
    reference: "The lowest loss of the same numbers by SciPy's L-BFGS-B from 100 starts, on a line \
                with objects moved from place to place, or by any way here where that is lower.",
    error: ("loss above the best known", ""),
    cost_of: "map",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let mut findings = Findings::default();
    let dims = bench.effort.pick(vec![2], vec![1, 2, 3]);
    let all_ties = bench.effort.pick(&Ties::ALL[..1], &Ties::ALL[..2]);
    let data = whole_numbers();
    let n_cases = (dims.len() * all_ties.len()) as f64;
    let mut n_done = 0.0;
    for &k in &dims {
        for &ties in all_ties {
            bench.step(n_done / n_cases, &format!("{k} dimensions"))?;
            n_done += 1.0;
            for loss in Loss::ALL {
                findings
                    .rows
                    .extend(of_case(bench, &data, (k, ties, loss))?);
            }
        }
    }
    findings.notes.push(
        "Sixteen objects and whole numbers from 1 to 23 between them, so many ties: \
         tests/truth/maps.py makes both the numbers and outside, the lowest loss that SciPy \
         found. Classical scaling is one start without descent. On one thread; a map that ends on \
         the best known has no place in the plot."
            .to_owned(),
    );
    Ok(findings)
}

/// A way to make a map: its name, how it goes downhill, and from how many starts.
type Way = (&'static str, Descent, usize);

/// A case: dimensions, ties, and what is made small.
type Case = (usize, Ties, Loss);

/// Every way on one case; rows by loss against the lowest that is known.
fn of_case(bench: &Bench<'_>, data: &Dissimilarities, case: Case) -> Result<Vec<Row>, ReportError> {
    let (k, ties, loss) = case;
    // As many starts as the program takes when nobody says how many.
    let promised_from = if k == 1 { 1000 } else { 50 };
    let outside = outside(case)?;
    let mut found = Vec::new();
    for way in ways(k, loss) {
        let (_, descent, n_starts) = way;
        let mds = Mds {
            ties,
            loss,
            descent,
            n_starts,
            n_starts_on_a_line: n_starts,
            seed: bench.seed,
            n_threads: 1,
            ..Mds::default()
        };
        let n_repeats = bench.effort.pick(1, 2);
        let cost = bench.time_repeated(n_repeats, 1, || made(&mds, data, k));
        found.extend(made(&mds, data, k).map(|map| (way, cost, map)));
    }
    let losses = found.iter().map(|(_, _, map)| map.loss(loss));
    let best = losses.fold(outside, f64::min);
    let row = |((name, descent, n_starts), cost, map): (Way, _, Map)| {
        let starts = if n_starts == 1 { "start" } else { "starts" };
        let case = format!("{k} dimensions, {} ties", ties.name());
        let is_promised = n_starts >= promised_from && descent == Descent::Polish;
        Row::of(name, format!("{n_starts} {starts}"), case)
            .error(map.loss(loss) - best)
            .promised(is_promised.then_some(1e-5))
            .cost(cost)
            .number("stress1", 6, map.stress1)
            .number("sstress", 6, map.sstress)
            .number("outside", 6, outside)
            .with(
                "reached_best",
                format!("{} of {}", map.n_reached, map.n_starts),
            )
    };
    Ok(found.into_iter().map(row).collect())
}

/// The lowest loss of a case that another program found.
fn outside((k, ties, loss): Case) -> Result<f64, ReportError> {
    let columns = ["dims", "ties", "loss", "value"];
    let table = Table::read(TRUTH, Path::new("tests/truth/maps.csv"), &columns, &[])?;
    let [dims, of_ties, of_loss] =
        ["dims", "ties", "loss"].map(|name| table.text(name).unwrap_or_default());
    let is_it = |nth: &usize| {
        let asked = [&k.to_string(), ties.name(), loss.name()];
        [dims[*nth], of_ties[*nth], of_loss[*nth]] == asked
    };
    let value = table.required_numbers("value")?;
    let nth = (0..value.len()).find(is_it);
    nth.map(|nth| value[nth])
        .ok_or_else(|| ReportError::Study("no truth from outside is stored".to_owned()))
}

fn ways(k: usize, loss: Loss) -> Vec<Way> {
    let counts = if k == 1 { [1, 100, 1000] } else { [1, 10, 50] };
    let polished = |name| counts.map(|n| (name, Descent::Polish, n));
    match loss {
        Loss::Stress1 => {
            let counts = if k == 1 { &counts[..2] } else { &counts[..] };
            let majorised = counts.iter().map(|&n| ("SMACOF", Descent::Majorise, n));
            let mut ways = vec![("Torgerson", Descent::None, 1)];
            ways.extend(majorised);
            ways.extend(polished("SMACOF + polish"));
            ways
        }
        Loss::SStress => polished("S-stress").into(),
    }
}

fn made(mds: &Mds, data: &Dissimilarities, k: usize) -> Option<Map> {
    let maps = Progress::unheard(|progress| mds.maps(data, k..=k, progress));
    maps.ok().and_then(|mut maps| maps.pop())
}

/// Whole numbers by a rule: distances of places in four dimensions, disturbed, on a coarse scale.
///
/// # Panics
/// They are no dissimilarities: those of this study are.
#[expect(clippy::expect_used, reason = "made here, whole and positive")]
fn whole_numbers() -> Dissimilarities {
    let n = N_OBJECTS;
    let place = |n: usize| (7919 * n * n + 3 * n) % 1009;
    let mut values = vec![None; n * n];
    for i in 0..n {
        for j in i + 1..n {
            let squares =
                (0..4).map(|axis| place(4 * i + axis).abs_diff(place(4 * j + axis)).pow(2));
            let disturbed =
                squares.sum::<usize>().isqrt() + (31 * i * i + 17 * j * j + 7 * i * j) % 301;
            values[i * n + j] = Some((disturbed.saturating_sub(150) / 60).max(1) as f64);
        }
    }
    let names = (0..n).map(|i| format!("object {}", i + 1)).collect();
    Dissimilarities::new(names, &values).expect("whole and positive")
}

#[cfg(test)]
mod tests;
