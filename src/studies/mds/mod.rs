//! The study of maps from dissimilarities: stress against run time by way downhill, starts, ties
//! and loss.

use selvedge_foundation::numerics::Random;
use selvedge_foundation::progress::Progress;
use selvedge_statistics::mds::{Descent, Dissimilarities, Loss, Map, Mds, Ties};

use super::{Bench, Findings, ReportError, Row, Study};

/// Objects of every case: as many as there are textiles in the study that maps are made for.
const N_OBJECTS: usize = 16;
/// Stress above the best known against run time.
pub(crate) const STUDY: Study = Study {
    name: "mds",
    chapter: "evidence",
    question: "How far above the best known stress does each way to make a map end, and at what \
               cost?",
    reference: "The lowest loss that any way or the longest search found for the same data, ties \
                and loss.",
    error: ("loss above the best known", ""),
    cost_of: "map",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let mut findings = Findings::default();
    let dims = bench.effort.pick(vec![2], vec![1, 2, 3]);
    let all_ties = bench.effort.pick(&Ties::ALL[..1], &Ties::ALL[..2]);
    let data = ranked(&mut Random::new(bench.seed).branch("mds"));
    let n_cases = (dims.len() * all_ties.len()) as f64;
    let mut n_done = 0.0;
    for &k in &dims {
        for &ties in all_ties {
            bench.step(n_done / n_cases, &format!("{k} dimensions"))?;
            n_done += 1.0;
            findings.rows.extend(of_case(bench, &data, k, ties));
        }
    }
    findings.notes.push(
        "Sixteen objects, mean ranks of eight simulated subjects from 1 to 4, so many ties. \
         Classical scaling is one start without descent. S-stress has a reference of its own. \
         On one thread; a map that ends on the best known has no place in the plot."
            .to_owned(),
    );
    Ok(findings)
}

/// A way to make a map: its name, how it goes downhill, and from how many starts.
type Way = (&'static str, Descent, usize);

/// Every way on one case; rows by loss against the lowest of that loss.
fn of_case(bench: &Bench<'_>, data: &Dissimilarities, k: usize, ties: Ties) -> Vec<Row> {
    // As many starts as the program takes when nobody says how many, and as the longest search.
    let (promised_from, n_longest) = if k == 1 { (1000, 2000) } else { (50, 200) };
    let mut rows = Vec::new();
    for loss in Loss::ALL {
        let with = |(_, descent, n_starts): Way, seed: u64| Mds {
            ties,
            loss,
            descent,
            n_starts,
            n_starts_on_a_line: n_starts,
            seed,
            n_threads: 1,
            ..Mds::default()
        };
        let longest = with(("", Descent::Polish, n_longest), bench.seed + 1);
        let lowest = made(&longest, data, k);
        let mut found = Vec::new();
        for way in ways(k, loss) {
            let mds = with(way, bench.seed);
            let n_repeats = bench.effort.pick(1, 2);
            let cost = bench.time_repeated(n_repeats, 1, || made(&mds, data, k));
            found.extend(made(&mds, data, k).map(|map| (way, cost, map)));
        }
        let maps = found.iter().map(|(_, _, map)| map).chain(&lowest);
        let best = maps.map(|map| map.loss(loss)).fold(f64::INFINITY, f64::min);
        for ((name, descent, n_starts), cost, map) in found {
            let starts = if n_starts == 1 { "start" } else { "starts" };
            let case = format!("{k} dimensions, {} ties", ties.name());
            let is_promised = n_starts >= promised_from && descent == Descent::Polish;
            let row = Row::of(name, format!("{n_starts} {starts}"), case)
                .error(map.loss(loss) - best)
                .promised(is_promised.then_some(1e-5))
                .cost(cost)
                .number("stress1", 6, map.stress1)
                .number("sstress", 6, map.sstress)
                .with(
                    "reached_best",
                    format!("{} of {}", map.n_reached, map.n_starts),
                );
            rows.push(row);
        }
    }
    rows
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

/// Mean ranks that eight subjects give to sixteen objects, as in a ranking of four.
///
/// # Panics
/// They are no dissimilarities: those of this study are.
#[expect(clippy::expect_used, reason = "made here, whole and positive")]
fn ranked(random: &mut Random) -> Dissimilarities {
    let n = N_OBJECTS;
    let mut place = || [0; 4].map(|_| random.normal());
    let places: Vec<[f64; 4]> = (0..n).map(|_| place()).collect();
    let mut values = vec![None; n * n];
    for i in 0..n {
        for j in i + 1..n {
            let squares = (0..4).map(|axis| (places[i][axis] - places[j][axis]).powi(2));
            let distance = squares.sum::<f64>().sqrt();
            let mut rank = || {
                let felt = distance * (0.3 * random.normal()).exp();
                (0.9 * felt).round().clamp(1.0, 4.0)
            };
            values[i * n + j] = Some((0..8).map(|_| rank()).sum::<f64>() / 8.0);
        }
    }
    let names = (0..n).map(|i| format!("object {}", i + 1)).collect();
    Dissimilarities::new(names, &values).expect("whole and positive")
}

#[cfg(test)]
mod tests;
