//! What a worse picture, or a smaller one, costs the friction that is read from it.

use crate::chart::{chart, lines_by};
use crate::{Bench, Findings, ReportError, Row, Study};
use selvedge_chart::{Axis, Chart};
use selvedge_foundation::numerics::{Grid, Random, n_threads, to_index, to_single};
use selvedge_foundation::quantity::fixed;
use selvedge_friction::{Measure, PredictedFriction, Predictor, Split, Taken};

/// Worse pictures, and extreme ones.
pub(crate) const STUDY: Study = Study {
    name: "friction-pictures",
    chapter: "friction",
    question: "What does a worse picture cost the friction that is read from it?",
    reference: "Procedural cloths that were held back, and the friction that was felt on them.",
    error: ("distance of spectra, mean", "dB"),
    cost_of: "picture of 100 mm",
    run: pictures,
};

/// What is done to a picture before it is read, or to what stands for its cloth.
#[derive(Debug, Clone, Copy)]
enum Spoilt {
    /// Noise of a standard deviation, of white.
    Noisy(f64),
    /// The same, then means of 3 × 3 pixels.
    Smoothed(f64),
    /// Pixels so many times as large.
    Coarser(usize),
    /// A latent that is shaken by so much of its own size.
    Latent(f64),
    /// Cut after so many mm.
    Shorter(u32),
}

/// What is drawn: a name, the methods in it, the axis of what was changed.
const CURVES: [(&str, &[&str], &str); 4] = [
    (
        "noise",
        &["as it is", "mean of 3 x 3"],
        "noise, share of white",
    ),
    ("scale", &["coarser"], "pixels to a millimetre"),
    ("length", &["shorter"], "length of the picture, mm"),
    (
        "latent",
        &["latent shaken"],
        "shaken by, share of the latent's size",
    ),
];

impl Spoilt {
    fn all(bench: &Bench<'_>) -> Vec<Self> {
        let noise = bench
            .effort
            .pick(&[0.0, 0.05][..], &[0.0, 0.01, 0.02, 0.05, 0.1, 0.2]);
        let coarser = bench.effort.pick(&[1, 2][..], &[1, 2, 4]);
        let shorter = bench.effort.pick(&[40, 100][..], &[40, 60, 80, 100]);
        let shaken = bench
            .effort
            .pick(&[0.0, 0.1][..], &[0.0, 0.01, 0.1, 0.3, 1.0]);
        let noisy = noise.iter().copied().map(Self::Noisy);
        let smoothed = noise.iter().copied().map(Self::Smoothed);
        let coarser = coarser.iter().copied().map(Self::Coarser);
        let latent = shaken.iter().copied().map(Self::Latent);
        let shorter = shorter.iter().copied().map(Self::Shorter);
        let of_picture = noisy.chain(smoothed).chain(coarser).chain(shorter);
        of_picture.chain(latent).collect()
    }

    fn method(self) -> &'static str {
        match self {
            Self::Noisy(_) => "as it is",
            Self::Smoothed(_) => "mean of 3 x 3",
            Self::Coarser(_) => "coarser",
            Self::Latent(_) => "latent shaken",
            Self::Shorter(_) => "shorter",
        }
    }

    fn setting(self) -> String {
        match self {
            Self::Noisy(sd) | Self::Smoothed(sd) => format!("noise {sd}"),
            Self::Coarser(_) => format!("{} px/mm", self.px_per_mm()),
            Self::Latent(share) => format!("by {share}"),
            Self::Shorter(mm) => format!("{mm} mm"),
        }
    }

    /// Where it stands on the axis of its curve.
    fn place(self) -> f64 {
        match self {
            Self::Noisy(sd) | Self::Smoothed(sd) => sd,
            Self::Coarser(_) => self.px_per_mm(),
            Self::Latent(share) => share,
            Self::Shorter(mm) => f64::from(mm),
        }
    }

    /// Columns of a strip, and samples of what was felt, that are left.
    fn n_left(self, n: usize) -> usize {
        match self {
            Self::Shorter(mm) => n.min(to_index(f64::from(mm) * PredictedFriction::PER_MM)),
            _ => n,
        }
    }

    fn px_per_mm(self) -> f64 {
        match self {
            Self::Coarser(n) => PredictedFriction::PER_MM / n as f64,
            _ => PredictedFriction::PER_MM,
        }
    }

    fn shaken(self) -> f64 {
        match self {
            Self::Latent(share) => share,
            _ => 0.0,
        }
    }

    fn picture(self, strip: &Grid<f32>, random: &mut Random) -> Grid<f32> {
        let mut noisy =
            |sd: f64| strip.map(|v| (v + to_single(sd * random.normal())).clamp(0.0, 1.0));
        match self {
            Self::Noisy(sd) => noisy(sd),
            Self::Smoothed(sd) => smoothed(&noisy(sd)),
            Self::Coarser(n) => {
                let size = [strip.width(), strip.height()].map(|pixels| pixels / n);
                Grid::from_fn(size[0], size[1], |x, y| mean_of(strip, [n * x, n * y], n))
            }
            Self::Latent(_) => strip.clone(),
            Self::Shorter(_) => {
                let n = self.n_left(strip.width());
                Grid::from_fn(n, strip.height(), |x, y| strip.row(y)[x])
            }
        }
    }
}

/// Mean of a square of pixels.
fn mean_of(picture: &Grid<f32>, [left, top]: [usize; 2], n: usize) -> f32 {
    let rows = (top..top + n).flat_map(|y| &picture.row(y)[left..left + n]);
    rows.sum::<f32>() / (n * n) as f32
}

/// Means over a pixel and its eight neighbours.
fn smoothed(picture: &Grid<f32>) -> Grid<f32> {
    let [last_x, last_y] = [picture.width() - 1, picture.height() - 1];
    Grid::from_fn(picture.width(), picture.height(), |x, y| {
        let rows = [y.saturating_sub(1), y, (y + 1).min(last_y)].map(|y| picture.row(y));
        let columns = [x.saturating_sub(1), x, (x + 1).min(last_x)];
        rows.iter()
            .flat_map(|row| columns.map(|x| row[x]))
            .sum::<f32>()
            / 9.0
    })
}

fn pictures(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    // Nothing is seen where errors are not asked for.
    let n_cloths = bench.effort.pick(4, 20);
    let (taken, all) = if bench.wants_errors() {
        let taken = Taken::held_back(Split::Cloths, n_cloths, n_threads());
        (taken, Spoilt::all(bench))
    } else {
        (Taken::held_back(Split::Cloths, 1, 1), Vec::new())
    };
    let predictor = Predictor::shipped()?;
    let mut rows = Vec::new();
    for (nth, spoilt) in all.iter().enumerate() {
        let setting = spoilt.setting();
        bench.step(nth as f64 / all.len() as f64, &setting)?;
        let mut random = Random::new(bench.seed).branch(&setting);
        let (mut distances, mut levels) = (Vec::new(), Vec::new());
        for (_, strip, felt) in taken.pictures() {
            let picture = spoilt.picture(strip, &mut random);
            let (scale, share) = (spoilt.px_per_mm(), spoilt.shaken());
            let found = predictor.shaken(&picture, scale, share, &mut random);
            let scores = found?.scores(&felt[..spoilt.n_left(felt.len())]);
            distances.push(Measure::LogSpectral.of(&scores));
            levels.push(Measure::LevelError.of(&scores));
        }
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        rows.push(Row {
            error: Some(mean(&distances)),
            size: Some(spoilt.place()),
            more: vec![("level error, %", fixed(mean(&levels), 2))],
            ..Row::of(spoilt.method(), setting, "held-back cloths")
        });
    }
    let plots = CURVES.map(|curve| (curve.0.to_owned(), drawn(&rows, curve)));
    rows.extend(extreme(bench, &predictor)?);
    rows.extend(costs(bench)?);
    let notes = [
        "The networks learnt from pictures with the noise of a camera, and of one scale.",
        "A picture without a strip of 40 mm x 10 mm is refused.",
    ];
    Ok(Findings::new(rows, plots.into(), notes))
}

/// One of [`CURVES`].
fn drawn(rows: &[Row], (_, methods, axis): (&str, &[&str], &str)) -> Chart {
    let shown = rows.iter().filter(|row| methods.contains(&&*row.method));
    let lines = lines_by(
        shown,
        |row| &row.method,
        |row| Some([row.size?, row.error?]),
    );
    chart(
        "Distance of spectra",
        Axis::linear(axis),
        Axis::linear("distance of spectra, mean, dB"),
        lines,
        "Procedural cloths that were held back; the networks that are shipped, together.",
    )
}

/// Pictures that show next to nothing, and what an answer costs.
fn extreme(bench: &mut Bench<'_>, predictor: &Predictor) -> Result<Vec<Row>, ReportError> {
    let side = bench.effort.pick(2000, 8000);
    let per_mm = PredictedFriction::PER_MM;
    let stripes = |x: usize, _: usize| to_single((x % 2) as f64);
    let cases = [
        ("black", Grid::filled(1280, 128, 0.0), per_mm),
        ("white", Grid::filled(1280, 128, 1.0), per_mm),
        ("one grey", Grid::filled(1280, 128, 0.5), per_mm),
        (
            "stripes of a pixel",
            Grid::from_fn(1280, 128, stripes),
            per_mm,
        ),
        ("as small as it may be", Grid::filled(512, 128, 0.5), per_mm),
        (
            "huge",
            Grid::from_fn(side, side, stripes),
            side as f64 / 100.0,
        ),
    ];
    let mut rows = Vec::new();
    for (case, picture, px_per_mm) in cases {
        let found = predictor.of_picture(&picture, px_per_mm)?;
        let is_friction = found.mu.iter().all(|mu| mu.is_finite() && *mu >= 0.0);
        let told = if is_friction {
            "finite, not negative"
        } else {
            "no friction"
        };
        let cost = bench.time(1, || predictor.of_picture(&picture, px_per_mm));
        rows.push(Row {
            cost: Some(cost),
            more: vec![
                ("level error, %", String::new()),
                ("friction", told.to_owned()),
            ],
            ..Row::of("extreme", "four networks", case)
        });
    }
    Ok(rows)
}

/// What loading costs, and an answer of networks of other sizes, to pictures of other lengths: they
/// are not taught, which no cost hangs on.
fn costs(bench: &mut Bench<'_>) -> Result<Vec<Row>, ReportError> {
    let loading = Row {
        cost: Some(bench.time(1, Predictor::shipped)),
        ..Row::of("loading", "four networks", "the shipped weights")
    };
    let mut rows = vec![loading];
    let lengths_mm = bench.effort.pick(&[100][..], &[40, 100, 200]);
    for &width in bench.effort.pick(&[16][..], &[4, 8, 16, 32]) {
        let predictor = Predictor::untaught(width);
        for &mm in lengths_mm {
            bench.step(1.0, &format!("{width} channels"))?;
            let n_columns = to_index(f64::from(mm) * PredictedFriction::PER_MM);
            let picture = Grid::filled(n_columns, 128, 0.5);
            let answer = || predictor.of_picture(&picture, PredictedFriction::PER_MM);
            let case = format!("{mm} mm");
            rows.push(Row {
                cost: Some(bench.time(1, answer)),
                ..Row::of("one network, untaught", format!("{width} channels"), case)
            });
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::quick;

    #[test]
    fn noise_costs_and_extreme_pictures_give_friction() {
        let findings = quick(&STUDY, 1);
        let error = |method: &str, setting: &str| {
            let is_it = |row: &&Row| row.method == method && row.setting == setting;
            findings
                .rows
                .iter()
                .find(is_it)
                .and_then(|row| row.error)
                .unwrap()
        };
        assert!(error("as it is", "noise 0.05") > error("as it is", "noise 0"));
        // The whole picture, not shaken, is the same three times.
        let whole = error("as it is", "noise 0");
        for (method, setting) in [
            ("shorter", "100 mm"),
            ("coarser", "12.8 px/mm"),
            ("latent shaken", "by 0"),
        ] {
            assert!((error(method, setting) - whole).abs() < 1e-9, "{method}");
        }
        assert!(error("shorter", "40 mm") > 0.0);
        let drawn: Vec<(&str, usize)> = findings
            .plots
            .iter()
            .map(|(name, chart)| {
                (
                    name.as_str(),
                    chart.series.iter().map(|s| s.points.len()).sum(),
                )
            })
            .collect();
        assert_eq!(
            drawn,
            [("noise", 4), ("scale", 2), ("length", 2), ("latent", 2)]
        );
        let extreme: Vec<_> = findings
            .rows
            .iter()
            .filter(|row| row.method == "extreme")
            .collect();
        assert_eq!(extreme.len(), 6);
        assert!(
            extreme
                .iter()
                .all(|row| row.more[1].1 == "finite, not negative")
        );
    }
}
