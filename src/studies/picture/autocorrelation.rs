//! The autocorrelation of a picture: by transforms, by the definition, and by the short cut that
//! takes the picture for one that repeats.

use super::spoilt::Spoilt;
use crate::chart::{chart, lines_by};
use crate::readable::largest;
use crate::{Bench, Findings, ReportError, Row, Study};
use selvedge_chart::Axis;
use selvedge_foundation::numerics::{Grid, PlaneTransform, Random};
use selvedge_textile::picture::Autocorrelation;

/// The largest difference of ρ that the transforms promise.
const PROMISED: f64 = 1e-9;
/// Up to this side every shift is compared, of larger pictures as many at random.
const ALL_UP_TO: usize = 64;

/// Error and cost of the autocorrelation by the picture's side.
pub(crate) const STUDY: Study = Study {
    name: "autocorrelation",
    chapter: "pictures",
    question: "What do transforms save on the autocorrelation of a picture, and do they change \
               it?",
    reference: "The correlation coefficient of both overlaps, summed pixel by pixel.",
    error: ("largest difference of ρ", ""),
    cost_of: "picture",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let sides = bench.effort.pick(
        vec![24, 48, 96],
        vec![64, 96, 128, 192, 256, 512, 1024, 2362],
    );
    let most_by_definition = bench.effort.pick(48, 192);
    let mut rows = Vec::new();
    for (done, &n) in sides.iter().enumerate() {
        bench.step(done as f64 / sides.len() as f64, &format!("{n} × {n} px"))?;
        let spoilt = Spoilt {
            light_ratio: 3.0,
            ..Spoilt::usual(n)
        };
        let picture = spoilt.picture(0, &Random::new(bench.seed)).luminance;
        let shifts = shifts(n, bench);
        let truth = by_definition(&picture, &shifts);
        for way in WAYS {
            if way.0 != DEFINITION || n <= most_by_definition {
                rows.push(row(way, &picture, (&shifts, &truth), bench));
            }
        }
    }
    let plot = chart(
        "Autocorrelation: run time by the side of the picture",
        Axis::log("side of the picture, px"),
        Axis::log("CPU time a picture, s"),
        lines_by(&rows, |row| &row.method, time),
        "One thread; all shifts up to half the side.",
    );
    let plots = vec![("time".to_owned(), plot)];
    Ok(Findings {
        grows_with: Some("number of pixels"),
        ..Findings::new(rows, plots, notes(most_by_definition))
    })
}

/// A way to correlate a picture with itself: its name, and ρ at shifts after all that it computes
/// for a whole picture.
type Way = (&'static str, fn(&Grid<f64>, &[[isize; 2]]) -> Vec<f64>);

const TRANSFORMS: &str = "transforms, overlap alone";
const DEFINITION: &str = "by the definition";
const CIRCULAR: &str = "transforms, as if it repeated";

const WAYS: [Way; 3] = [
    (TRANSFORMS, by_transforms),
    (DEFINITION, by_definition),
    (CIRCULAR, circular),
];

fn by_transforms(picture: &Grid<f64>, shifts: &[[isize; 2]]) -> Vec<f64> {
    let rho = Autocorrelation::of(picture, 1);
    let at = |&[dx, dy]: &[isize; 2]| rho.at(dx, dy).unwrap_or(f64::NAN);
    shifts.iter().map(at).collect()
}

/// All shifts of half the plane up to half the side, or some of them.
fn shifts(n: usize, bench: &Bench<'_>) -> Vec<[isize; 2]> {
    let reach = (n / 2).cast_signed();
    if n <= ALL_UP_TO {
        return all_shifts(n);
    }
    let mut random = Random::new(bench.seed).branch("shifts");
    let mut draw = |n: usize| random.index(n).cast_signed();
    let n_drawn = if n > 1000 { 24 } else { 200 };
    (0..n_drawn)
        .map(|_| [draw(n / 2 * 2) - reach, draw(n / 2)])
        .collect()
}

/// Correlation coefficients of the two overlaps at shifts, pixel by pixel.
fn by_definition(picture: &Grid<f64>, shifts: &[[isize; 2]]) -> Vec<f64> {
    let (width, height) = (picture.width(), picture.height());
    let at = |&[dx, dy]: &[isize; 2]| {
        let (right, left) = (dx.max(0).cast_unsigned(), (-dx).max(0).cast_unsigned());
        let down = dy.cast_unsigned();
        let mut sums = [0.0; 5];
        for row in 0..height - down {
            let first = &picture.row(row)[left..width - right];
            let second = &picture.row(row + down)[right..width - left];
            for (a, b) in first.iter().zip(second) {
                for (sum, term) in sums.iter_mut().zip([*a, *b, a * a, b * b, a * b]) {
                    *sum += term;
                }
            }
        }
        let n = ((width - left - right) * (height - down)) as f64;
        let [a, b, aa, bb, ab] = sums.map(|sum| sum / n);
        (ab - a * b) / ((aa - a * a) * (bb - b * b)).sqrt()
    };
    shifts.iter().map(at).collect()
}

/// The textbook's short cut: the inverse transform of the power spectrum, one mean and one variance
/// for all shifts, what leaves at one edge coming in at the other.
fn circular(picture: &Grid<f64>, shifts: &[[isize; 2]]) -> Vec<f64> {
    let (width, height) = (picture.width(), picture.height());
    let mean = picture.values().iter().sum::<f64>() / (width * height) as f64;
    let mut centred = picture.clone();
    centred.values_mut().iter_mut().for_each(|x| *x -= mean);
    let plane = PlaneTransform::new(width, height);
    let mut spectrum = plane.forward(&centred);
    for bin in spectrum.values_mut() {
        *bin = (*bin * bin.conj()).re.into();
    }
    let products = plane.inverse(spectrum);
    let place = |d: isize, n: usize| d.rem_euclid(n.cast_signed()).cast_unsigned();
    let all = products.row(0)[0];
    let at = |&[dx, dy]: &[isize; 2]| products.row(place(dy, height))[place(dx, width)] / all;
    shifts.iter().map(at).collect()
}

fn row(
    (name, at): Way,
    picture: &Grid<f64>,
    (shifts, truth): (&[[isize; 2]], &[f64]),
    bench: &Bench<'_>,
) -> Row {
    let n = picture.width();
    let is_by_definition = name == DEFINITION;
    let every = if is_by_definition {
        all_shifts(n)
    } else {
        Vec::new()
    };
    let n_repeats = if n > 500 || is_by_definition { 1 } else { 3 };
    let cost = bench.time_repeated(n_repeats, 1, || at(picture, &every));
    Row::of(name, "f64, one thread", format!("{n} × {n} px"))
        .size((n * n) as f64)
        .error(largest_difference(&at(picture, shifts), truth))
        .promised((name == TRANSFORMS).then_some(PROMISED))
        .cost(cost)
        .with("side_px", n)
        .with("shifts_compared", shifts.len())
}

fn all_shifts(n: usize) -> Vec<[isize; 2]> {
    let reach = (n / 2).cast_signed();
    let rows = 0..=reach;
    rows.flat_map(|dy| (-reach..=reach).map(move |dx| [dx, dy]))
        .collect()
}

/// What is no number counts as infinitely far.
fn largest_difference(found: &[f64], truth: &[f64]) -> f64 {
    let pairs = found.iter().zip(truth).map(|(a, b)| (a - b).abs());
    largest(pairs.map(|x| if x.is_nan() { f64::INFINITY } else { x }))
}

/// Side and CPU time.
fn time(row: &Row) -> Option<[f64; 2]> {
    Some([row.size?.sqrt(), row.cost?.cpu_s])
}

fn notes(most_by_definition: usize) -> Vec<String> {
    vec![
        format!(
            "The definition takes the fourth power of the side, so it is run up to \
             {most_by_definition} px; at larger sides single shifts drawn at random are set \
             beside it."
        ),
        "As if it repeated: the inverse transform of the power spectrum, with one mean and one \
         variance for all shifts. It costs less and is wrong wherever a picture ends elsewhere \
         than it began, or light is uneven, which here is three to one: it is shown to be wrong."
            .to_owned(),
        "There is one precision, f64; with pictures of 8 or 16 bits f32 would be the first thing \
         to lose digits, in differences of large sums."
            .to_owned(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::tests::{n_drawn, quick};

    #[test]
    fn transforms_keep_their_promise_and_the_short_cut_shows_up_as_wrong() {
        let findings = quick(&STUDY);
        assert_eq!(findings.n_broken(), 0, "{:?}", findings.rows);
        for row in &findings.rows {
            let error = row.error.unwrap();
            if row.method == CIRCULAR {
                assert!(error > 0.05, "{row:?}");
            } else {
                assert!(error < PROMISED, "{row:?}");
            }
        }
        assert_eq!(n_drawn(&findings), findings.rows.len());
    }

    #[test]
    fn what_is_no_number_is_infinitely_wrong() {
        assert!(largest_difference(&[0.0, f64::NAN], &[0.0, 1.0]).is_infinite());
        assert!((largest_difference(&[0.5, 0.2], &[0.0, 0.1]) - 0.5).abs() < 1e-12);
    }
}
