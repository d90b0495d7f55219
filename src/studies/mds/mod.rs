//! The study of maps from dissimilarities: stress against run time by way downhill, starts, ties
//! and loss; and how well known configurations come back from noise.

mod recovery;
#[cfg(test)]
mod tests;

use selvedge_foundation::numerics::Random;
use selvedge_foundation::progress::unheard;
use selvedge_statistics::mds::{Descent, Dissimilarities, Loss, Map, Mds, Ties};

use super::{Bench, Findings, ReportError, Row, Study};

/// Objects of every case: as many as there are textiles in the study that maps are made for.
const N_OBJECTS: usize = 16;
/// Starts of the longest search, which the others are measured against.
const N_LONGEST: usize = 200;
const N_LONGEST_ON_A_LINE: usize = 2000;

/// Stress above the best known against run time, and recovery against noise.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct MdsStudy;

/// A way to make a map.
struct Way {
    name: &'static str,
    descent: Descent,
    loss: Loss,
    n_starts: usize,
}

impl Study for MdsStudy {
    fn name(&self) -> &'static str {
        "mds"
    }

    fn question(&self) -> &'static str {
        "How far above the best known stress does each way to make a map end, and at what cost?"
    }

    fn reference(&self) -> &'static str {
        "The lowest loss that any way or the longest search found for the same data, ties and loss."
    }

    fn error_measure(&self) -> (&'static str, &'static str) {
        ("loss above the best known", "")
    }

    fn cost_of(&self) -> &'static str {
        "map"
    }

    fn run(&self, bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
        let mut findings = Findings::default();
        let dims = bench.effort.pick(vec![2], vec![1, 2, 3]);
        let all_ties = bench.effort.pick(&Ties::ALL[..1], &Ties::ALL[..2]);
        let data = ranked(&mut Random::new(bench.seed).branch("mds"));
        let n_cases = (dims.len() * all_ties.len()) as f64;
        let mut n_done = 0.0;
        for &k in &dims {
            for &ties in all_ties {
                bench.step(0.6 * n_done / n_cases, &format!("{k} dimensions"))?;
                n_done += 1.0;
                findings.rows.extend(of_case(bench, &data, k, ties));
            }
        }
        recovery::add(bench, &mut findings)?;
        findings.notes.push(
            "Sixteen objects, mean ranks of eight simulated subjects from 1 to 4, so many ties. \
             Classical scaling is one start without descent. S-stress has a reference of its own. \
             On one thread; a map that ends on the best known has no place in the plot."
                .to_owned(),
        );
        Ok(findings)
    }
}

/// Every way on one case; rows by loss against the lowest of that loss.
fn of_case(bench: &Bench<'_>, data: &Dissimilarities, k: usize, ties: Ties) -> Vec<Row> {
    let mut rows = Vec::new();
    for loss in Loss::ALL {
        let ways = ways(k, loss);
        let with = |way: &Way, seed: u64| Mds {
            ties,
            loss: way.loss,
            descent: way.descent,
            n_starts: way.n_starts,
            n_starts_on_a_line: way.n_starts,
            seed,
            n_threads: 1,
            ..Mds::default()
        };
        let longest = Way {
            name: "",
            descent: Descent::Polish,
            loss,
            n_starts: if k == 1 {
                N_LONGEST_ON_A_LINE
            } else {
                N_LONGEST
            },
        };
        let lowest = made(&with(&longest, bench.seed + 1), data, k);
        let mut found = Vec::new();
        for way in &ways {
            let mds = with(way, bench.seed);
            let n_repeats = bench.effort.pick(1, 2);
            let cost = bench.time_repeated(n_repeats, 1, || made(&mds, data, k));
            found.push((way, cost, made(&mds, data, k)));
        }
        let lowest = lowest.iter().map(|map| map.loss(loss));
        let others = found
            .iter()
            .flat_map(|(_, _, map)| map.iter().map(|map| map.loss(loss)));
        let best = lowest.chain(others).fold(f64::INFINITY, f64::min);
        for (way, cost, map) in found {
            let Some(map) = map else { continue };
            let starts = if way.n_starts == 1 { "start" } else { "starts" };
            rows.push(Row {
                method: way.name.to_owned(),
                setting: format!("{} {starts}", way.n_starts),
                case: format!("{k} dimensions, {} ties", ties.name()),
                error: Some(map.loss(loss) - best),
                promised: (way.n_starts >= promised_from(k) && way.descent == Descent::Polish)
                    .then_some(1e-5),
                cost: Some(cost),
                more: vec![
                    ("stress1", format!("{:.6}", map.stress1)),
                    ("sstress", format!("{:.6}", map.sstress)),
                    (
                        "reached_best",
                        format!("{} of {}", map.n_reached, map.n_starts),
                    ),
                ],
                ..Row::default()
            });
        }
    }
    rows
}

/// As many starts as the program takes when nobody says how many.
fn promised_from(k: usize) -> usize {
    if k == 1 { 1000 } else { 50 }
}

fn ways(k: usize, loss: Loss) -> Vec<Way> {
    let way = |name, descent, n_starts| Way {
        name,
        descent,
        loss,
        n_starts,
    };
    let counts = if k == 1 { [1, 100, 1000] } else { [1, 10, 50] };
    let [first, some, many] = counts;
    let polished = |name| [first, some, many].map(|n| way(name, Descent::Polish, n));
    let mut ways = Vec::new();
    match loss {
        Loss::Stress1 => {
            ways.push(way("Torgerson", Descent::None, 1));
            let counts = if k == 1 { &counts[..2] } else { &counts[..] };
            let majorised = |&n: &usize| way("SMACOF", Descent::Majorise, n);
            ways.extend(counts.iter().map(majorised));
            ways.extend(polished("SMACOF + polish"));
        }
        Loss::SStress => ways.extend(polished("S-stress")),
    }
    ways
}

fn made(mds: &Mds, data: &Dissimilarities, k: usize) -> Option<Map> {
    let maps = unheard(|progress| mds.maps(data, k..=k, progress));
    maps.ok().and_then(|mut maps| maps.pop())
}

/// Mean ranks that eight subjects give to sixteen objects, as in a ranking of four.
fn ranked(random: &mut Random) -> Dissimilarities {
    let x = recovery::thrown(N_OBJECTS, 4, random);
    let mut values = vec![None; N_OBJECTS * N_OBJECTS];
    for i in 0..N_OBJECTS {
        for j in i + 1..N_OBJECTS {
            let distance = recovery::apart(&x[i], &x[j]);
            let rank = |random: &mut Random| {
                let felt = distance * (0.3 * random.normal()).exp();
                (0.9 * felt).round().clamp(1.0, 4.0)
            };
            let sum: f64 = (0..8).map(|_| rank(random)).sum();
            values[i * N_OBJECTS + j] = Some(sum / 8.0);
        }
    }
    recovery::named(&values, N_OBJECTS)
}
