//! Maps of known configurations, and of chance.

use super::*;
use crate::procrustes::Procrustes;
use selvedge_foundation::numerics::{Random, median};
use selvedge_foundation::progress::Progress;

pub(super) fn named(n: usize) -> Vec<String> {
    (0..n).map(|i| format!("t{i}")).collect()
}

/// Random points in `k` dimensions.
fn thrown(n: usize, k: usize, random: &mut Random) -> Vec<Vec<f64>> {
    let mut point = || (0..k).map(|_| random.normal()).collect();
    (0..n).map(|_| point()).collect()
}

/// Distances of random points in `k` dimensions with a share of noise.
fn spread(n: usize, k: usize, noise: f64, seed: u64) -> Dissimilarities {
    let mut random = Random::new(seed);
    let x = thrown(n, k, &mut random);
    let mut values = vec![None; n * n];
    for i in 0..n {
        for j in i + 1..n {
            let d2: f64 = x[i].iter().zip(&x[j]).map(|(a, b)| (a - b).powi(2)).sum();
            values[i * n + j] = Some(d2.sqrt() * (noise * random.normal()).exp());
        }
    }
    Dissimilarities::new(named(n), &values).unwrap()
}

fn maps(data: &Dissimilarities, mds: Mds, dims: RangeInclusive<usize>) -> Vec<Map> {
    Progress::unheard(|progress| mds.maps(data, dims, progress)).unwrap()
}

fn pair_distances(points: &[Vec<f64>], data: &Dissimilarities) -> Vec<f64> {
    let apart = |pair: &Pair| {
        let [p, q] = pair.objects.map(|object| &points[object]);
        let squares = p.iter().zip(q).map(|(a, b)| (a - b).powi(2));
        squares.sum::<f64>().sqrt()
    };
    data.pairs().iter().map(apart).collect()
}

/// Without anything of this module: untied, so that the disparities are the max-min formula.
fn stress_again(points: &[Vec<f64>], data: &Dissimilarities, loss: Loss) -> f64 {
    let power = if loss == Loss::Stress1 { 1 } else { 2 };
    let distances = pair_distances(points, data);
    let mut by_delta: Vec<(f64, f64)> = data
        .pairs()
        .iter()
        .zip(distances)
        .map(|(pair, d)| (pair.delta, d.powi(power)))
        .collect();
    by_delta.sort_by(|a, b| a.0.total_cmp(&b.0));
    let d: Vec<f64> = by_delta.iter().map(|(_, d)| *d).collect();
    let m = d.len();
    let mean = |a: usize, b: usize| d[a..=b].iter().sum::<f64>() / (b - a + 1) as f64;
    let fitted = |i: usize| {
        let least = |a: usize| (i..m).map(|b| mean(a, b)).fold(f64::INFINITY, f64::min);
        (0..=i).map(least).fold(f64::NEG_INFINITY, f64::max)
    };
    let left: f64 = (0..m).map(|i| (d[i] - fitted(i)).powi(2)).sum();
    (left / d.iter().map(|x| x * x).sum::<f64>()).sqrt()
}

#[test]
fn the_stress_belongs_to_the_points_that_come_back() {
    let data = spread(9, 3, 0.4, 5);
    for loss in Loss::ALL {
        let mds = Mds {
            loss,
            n_starts: 10,
            n_starts_on_a_line: 100,
            ..Mds::default()
        };
        for map in maps(&data, mds, 1..=3) {
            for (which, said) in [(Loss::Stress1, map.stress1), (Loss::SStress, map.sstress)] {
                let again = stress_again(&map.points, &data, which);
                let what = format!("{loss:?}, {}: {said} or {again}", map.dims);
                assert!((said - again).abs() < 1e-10, "{which:?} of {what}");
            }
        }
    }
}

#[test]
fn no_way_downhill_ends_above_a_plainer_one_and_gradients_vanish() {
    let data = spread(12, 3, 0.5, 11);
    let with = |descent, loss| Mds {
        loss,
        descent,
        ..Mds::default()
    };
    for k in 2..=4 {
        let stress = |descent, loss| maps(&data, with(descent, loss), k..=k)[0].loss(loss);
        let classical = stress(Descent::None, Loss::Stress1);
        let majorised = stress(Descent::Majorise, Loss::Stress1);
        let polished = stress(Descent::Polish, Loss::Stress1);
        assert!(classical > majorised, "{k}: {classical} and {majorised}");
        assert!(
            polished <= majorised + 1e-7,
            "{k}: {polished} and {majorised}"
        );
        let both = [Descent::Majorise, Descent::Polish].map(|d| stress(d, Loss::SStress));
        assert!(both[1] <= both[0], "{k}: {both:?}");
    }
}

#[test]
fn the_gradient_is_that_of_the_loss() {
    let data = spread(7, 2, 0.5, 2);
    let problem = Problem::new(&data, Ties::Primary);
    let x = start::thrown(7, 2, &mut Random::new(1));
    for loss in Loss::ALL {
        let mut fit = fit::Fit::new(&problem, 2);
        let mut gradient = vec![0.0; x.len()];
        fit.gradient(loss, &x, &mut gradient);
        for i in 0..x.len() {
            let mut at = |h: f64| {
                let mut moved = x.clone();
                moved[i] += h;
                fit.loss(loss, &moved)
            };
            let slope = (at(1e-6) - at(-1e-6)) / 2e-6;
            assert!(
                (slope - gradient[i]).abs() < 1e-7,
                "{loss:?}: {slope} {}",
                gradient[i]
            );
        }
    }
}

#[test]
fn a_known_configuration_comes_back() {
    for k in 1..=3 {
        let data = spread(20, k, 0.0, 40 + k as u64);
        let map = maps(&data, Mds::default(), k..=k).remove(0);
        assert!(map.stress1 < 2e-3, "{k}: {}", map.stress1);
        assert!(
            map.spearman.clone().unwrap() > 0.9999,
            "{k}: {:?}",
            map.spearman
        );
    }
}

#[test]
fn a_map_without_noise_comes_back_and_noise_takes_from_it() {
    let lost = |noise: f64| {
        let mds = Mds {
            n_starts: 20,
            ..Mds::default()
        };
        let mut m2 = [1, 2, 3].map(|seed| {
            let map = maps(&spread(16, 2, noise, seed), mds, 2..=2).remove(0);
            let truth = thrown(16, 2, &mut Random::new(seed));
            Procrustes::of(&map.points, &truth).unwrap().m2
        });
        median(&mut m2)
    };
    let (clean, noisy) = (lost(0.0), lost(0.4));
    assert!(
        clean < 0.01 && noisy > clean && noisy < 0.5,
        "{clean}, {noisy}"
    );
}

/// All orders of eight objects, each followed downhill: nothing lies below what the search finds.
#[test]
fn on_a_line_the_best_of_all_orders_is_found() {
    for seed in 1..=3 {
        let data = spread(7, 3, 0.5, seed);
        let problem = Problem::new(&data, Ties::Primary);
        let mds = Mds::default();
        let found = maps(&data, mds, 1..=1)[0].stress1;
        let mut fit = fit::Fit::new(&problem, 1);
        let mut best = f64::INFINITY;
        for number in 0..5040 {
            let mut left: Vec<f64> = (0..7).map(f64::from).collect();
            let mut code = number;
            let mut x = Vec::new();
            for n in (1..=7).rev() {
                x.push(left.remove(code % n));
                code /= n;
            }
            best = best.min(search::downhill(&mut fit, &Plan { k: 1, mds }, &mut x).sqrt());
        }
        assert!(
            found <= best + 1e-6,
            "seed {seed}: {found}, yet {best} is possible"
        );
    }
}

#[test]
fn no_seed_finds_less_on_a_line_or_in_a_plane() {
    let data = spread(16, 4, 0.4, 21);
    for dims in [1, 2] {
        let stress = |seed| {
            let mds = Mds {
                seed,
                ..Mds::default()
            };
            maps(&data, mds, dims..=dims)[0].stress1
        };
        let found: Vec<f64> = (1..=6).map(stress).collect();
        let best = found.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(found.iter().all(|s| s - best < 1e-6), "{dims}: {found:?}");
    }
}

#[test]
fn same_bytes_whatever_the_number_of_threads_and_another_seed_the_same_map() {
    let data = spread(10, 2, 0.2, 8);
    let with = |n_threads| Mds {
        n_threads,
        n_starts_on_a_line: 200,
        ..Mds::default()
    };
    assert_eq!(maps(&data, with(1), 1..=3), maps(&data, with(3), 1..=3));
    let other = Mds {
        seed: 99,
        ..Mds::default()
    };
    let (a, b) = (maps(&data, with(2), 2..=2), maps(&data, other, 2..=2));
    for (p, q) in a[0]
        .points
        .iter()
        .flatten()
        .zip(b[0].points.iter().flatten())
    {
        assert!((p - q).abs() < 1e-4, "{p} or {q}");
    }
}

#[test]
fn missing_pairs_are_left_out_and_weights_count() {
    let whole = spread(12, 2, 0.0, 3);
    let mut values = vec![None; 144];
    let mut weights = vec![1.0; 144];
    for pair in whole.pairs() {
        let [i, j] = pair.objects;
        let is_spoilt = (i + 2 * j) % 9 == 0;
        let delta = if is_spoilt {
            10.0 - pair.delta
        } else {
            pair.delta
        };
        values[12 * i + j] = Some(delta.max(0.0));
        for at in [12 * i + j, 12 * j + i] {
            weights[at] = if is_spoilt { 0.0 } else { 1.0 + (i % 3) as f64 };
        }
    }
    let data = Dissimilarities::weighted(named(12), &values, &weights).unwrap();
    assert!(data.n_missing() > 3, "{}", data.n_missing());
    let map = maps(&data, Mds::default(), 2..=2).remove(0);
    assert!(map.stress1 < 5e-3, "{}", map.stress1);
    let majorised = Mds {
        descent: Descent::Majorise,
        ..Mds::default()
    };
    let majorised = maps(&data, majorised, 2..=2)[0].stress1;
    assert!(majorised < 2e-2, "{majorised}");
}

#[test]
fn ties_ask_for_more_when_secondary() {
    let exact = spread(10, 3, 0.5, 4);
    let coarse: Vec<f64> = exact.pairs().iter().map(|p| p.delta.round()).collect();
    let data = exact.with_deltas(&coarse);
    let stress = |ties| {
        let mds = Mds {
            ties,
            ..Mds::default()
        };
        maps(&data, mds, 2..=2)[0].stress1
    };
    let [primary, secondary, tertiary] = Ties::ALL.map(stress);
    assert!(
        primary < secondary && tertiary < secondary,
        "{primary} {secondary} {tertiary}"
    );
}

#[test]
fn too_many_dimensions_and_clusters_are_warned_of() {
    let few = maps(&spread(6, 3, 0.3, 1), Mds::default(), 2..=2);
    assert!(
        few[0]
            .warnings
            .iter()
            .any(|w| w.contains("almost whatever")),
        "{few:?}"
    );
    let near = maps(&spread(16, 5, 0.3, 1), Mds::default(), 3..=4);
    assert!(near[0].warnings.is_empty(), "{:?}", near[0].warnings);
    assert!(
        near[1].warnings[0].contains("at least 17"),
        "{:?}",
        near[1].warnings
    );
    let mut values = vec![None; 144];
    for i in 0..12 {
        for j in i + 1..12 {
            let is_apart = i / 4 != j / 4;
            values[12 * i + j] = Some(if is_apart { 9.0 } else { 1.0 } + 0.001 * (i * j) as f64);
        }
    }
    let data = Dissimilarities::new(named(12), &values).unwrap();
    let map = maps(&data, Mds::default(), 2..=2).remove(0);
    assert!(
        map.warnings.iter().any(|w| w.contains("degenerate")),
        "{map:?}"
    );
}

/// Means of Monte Carlo runs elsewhere: 16 objects, 2-D 0.270; 3-D 0.172; 7 objects, 2-D 0.111.
#[test]
fn chance_gives_what_is_known_and_structure_lies_below_it() {
    let mds = Mds {
        n_starts: 6,
        ..Mds::default()
    };
    let null = |data: &Dissimilarities, kind, dims| {
        Progress::unheard(|progress| Null::of(&mds, data, kind, (dims, 40), progress)).unwrap()
    };
    let data = spread(16, 2, 0.1, 9);
    for (n, dims, expected) in [(16, 2, 0.270), (16, 3, 0.172), (7, 2, 0.111)] {
        let null = null(&spread(n, 2, 0.1, 9), NullKind::RandomRanks, dims);
        println!("{n} {dims}: {} ({})", null.mean(), null.five_percent());
        let within = if n == 7 { 0.02 } else { 0.01 };
        assert!(
            (null.mean() - expected).abs() < within,
            "{n}, {dims}: {}",
            null.mean()
        );
        assert!(null.five_percent() < null.mean(), "{null:?}");
    }
    let found = maps(&data, mds, 2..=2)[0].stress1;
    let permuted = null(&data, NullKind::Permuted, 2);
    assert!(
        (permuted.p_value(found) - 1.0 / 41.0).abs() < 1e-12,
        "{found}: {permuted:?}"
    );
    assert_eq!(permuted.p_value(1.0), 1.0);
}

#[test]
fn few_starts_do_for_data_without_structure() {
    for (loss, dims) in [(Loss::Stress1, 1), (Loss::SStress, 1), (Loss::Stress1, 2)] {
        let many = Mds {
            loss,
            n_starts_on_a_line: 300,
            ..Mds::default()
        };
        let data = spread(7, 2, 0.1, 9);
        let null = |mds: &Mds| {
            let sets = (dims, 20);
            Progress::unheard(|p| Null::of(mds, &data, NullKind::RandomRanks, sets, p)).unwrap()
        };
        let (few, many) = (null(&many.for_chance()), null(&many));
        let higher = few.mean() - many.mean();
        assert!(
            (-1e-6..0.003).contains(&higher),
            "{loss:?} {dims}: {higher}"
        );
        let at_5 = few.five_percent() - many.five_percent();
        assert!((-1e-6..0.001).contains(&at_5), "{loss:?} {dims}: {at_5}");
    }
}

#[test]
fn a_raised_flag_stops_the_search() {
    let flag = selvedge_foundation::progress::CancelFlag::new();
    flag.cancel();
    let mut report = |_: f64, _: &str| {};
    let mut progress = Progress::new(&mut report, flag);
    let data = spread(8, 2, 0.1, 1);
    assert_eq!(
        Mds::default().maps(&data, 1..=2, &mut progress),
        Err(Cancelled)
    );
}
