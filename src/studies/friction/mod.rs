//! Friction from a picture: how a trace is found from its spectra, and what a worse picture costs.

use super::chart::{chart, lines_by};
use super::readable::{largest, number};
use super::{Bench, Findings, ReportError, Row, Study};
use selvedge_chart::Axis;
use selvedge_foundation::numerics::{
    Complex, Grid, GriffinLim, Random, StartPhases, Stft, n_threads, to_index, to_single,
};
use selvedge_foundation::quantity::fixed;
use selvedge_friction::{PredictedFriction, Predictor, Scores, Split, Taken};

/// Samples of a frame, and from frame to frame.
const FRAME: [usize; 2] = [512, 128];

/// Griffin–Lim: from which phases and in how many rounds.
pub(crate) const SPECTRA: Study = Study {
    name: "griffin-lim",
    chapter: "friction",
    question: "From which phases, and in how many rounds, is friction found from its spectra?",
    reference: "The magnitudes that went in.",
    error: ("spectral error", "share of all magnitudes"),
    cost_of: "trace of 100 mm",
    run: spectra,
};

/// Worse pictures, and extreme ones.
pub(crate) const PICTURES: Study = Study {
    name: "friction-pictures",
    chapter: "friction",
    question: "What does a worse picture cost the friction that is read from it?",
    reference: "Procedural cloths that were held back, and the friction that was felt on them.",
    error: ("distance of spectra, mean", "dB"),
    cost_of: "picture of 100 mm",
    run: pictures,
};

/// How a trace is found again.
#[derive(Debug, Clone, Copy)]
struct Way {
    name: &'static str,
    /// Whether what is slow, the mean too, is taken off first and put back.
    is_rest: bool,
    start: fn(u64) -> StartPhases<'static>,
    momentum: f64,
}

const WAYS: [Way; 4] = [
    Way {
        name: "whole, phases by chance",
        is_rest: false,
        start: StartPhases::Random,
        momentum: 0.99,
    },
    Way {
        name: "whole, a constant's phases",
        is_rest: false,
        start: StartPhases::OfConstant,
        momentum: 0.99,
    },
    Way {
        name: "without what is slow, phases by chance",
        is_rest: true,
        start: StartPhases::Random,
        momentum: 0.99,
    },
    Way {
        name: "the same, no overshoot",
        is_rest: true,
        start: StartPhases::Random,
        momentum: 0.0,
    },
];

fn spectra(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let n_seeds = bench.effort.pick(5, 20);
    let rounds = bench
        .effort
        .pick(&[8, 32][..], &[1, 2, 4, 8, 16, 32, 64, 128]);
    let taken = Taken::held_back(Split::Cloths, 1, n_threads());
    let traces: Vec<&[f64]> = taken.pictures().map(|(.., felt)| felt).collect();
    let [n_window, hop] = FRAME;
    let stft = Stft::hamming(n_window, hop);
    let mut rows = Vec::new();
    for (nth, way) in WAYS.iter().enumerate() {
        bench.step(nth as f64 / WAYS.len() as f64, way.name)?;
        for &n_rounds in rounds {
            rows.push(way.row(bench, &stft, &traces, (n_rounds, n_seeds)));
        }
    }
    let lines = lines_by(
        &rows,
        |row| &row.method,
        |row| Some([row.size?, row.error?]),
    );
    let plot = chart(
        "Worst spectral error over seeds",
        Axis::log("rounds"),
        Axis::log("spectral error"),
        lines,
        "Traces of procedural cloth, one a family.",
    );
    let notes = [
        "A mean of 0.4 makes two rows of a spectrogram a hundred times as large as all others: \
         from phases by chance its frames take opposite signs and stay there.",
    ];
    Ok(Findings::new(
        rows,
        vec![("rounds".to_owned(), plot)],
        notes,
    ))
}

impl Way {
    /// Spectral errors of what is found from a trace's magnitudes: as a share of all of them, and
    /// of those without what is slow, which are what a finger feels.
    fn errors(self, stft: &Stft, trace: &[f64], seed: usize, how: GriffinLim) -> [f64; 2] {
        let magnitudes = |trace: &[f64]| stft.forward(trace).map(Complex::norm);
        let rest = PredictedFriction::rest_of(trace);
        let start = (self.start)(seed as u64);
        let target = magnitudes(if self.is_rest { &rest } else { trace });
        let mut found = stft.griffin_lim(&target, trace.len(), start, how);
        if self.is_rest {
            let slow = trace.iter().zip(&rest).map(|(mu, rest)| mu - rest);
            found
                .iter_mut()
                .zip(slow)
                .for_each(|(mu, slow)| *mu += slow);
        }
        let of_rest = magnitudes(&PredictedFriction::rest_of(&found));
        [
            missed(&magnitudes(&found), &magnitudes(trace)),
            missed(&of_rest, &magnitudes(&rest)),
        ]
    }

    /// The worst of so many seeds after so many rounds.
    fn row(
        self,
        bench: &mut Bench<'_>,
        stft: &Stft,
        traces: &[&[f64]],
        (n_iterations, n_seeds): (usize, usize),
    ) -> Row {
        let how = GriffinLim {
            n_iterations,
            momentum: self.momentum,
        };
        let n_run = if bench.wants_errors() { n_seeds } else { 1 };
        let errors: Vec<[f64; 2]> = (0..n_run)
            .map(|seed| self.errors(stft, traces[seed % traces.len()], seed, how))
            .collect();
        let worst = |nth: usize| largest(errors.iter().map(|error| error[nth]));
        let n_within = errors.iter().filter(|[of_all, _]| *of_all <= 0.01).count();
        Row {
            error: Some(worst(0)),
            cost: Some(bench.time(1, || self.errors(stft, traces[0], 0, how))),
            size: Some(n_iterations as f64),
            more: vec![
                ("worst error of the rest", number(worst(1))),
                ("seeds within 1 %", format!("{n_within} of {n_seeds}")),
            ],
            ..Row::of(
                self.name,
                format!("{n_iterations} rounds"),
                "procedural cloth",
            )
        }
    }
}

/// Root of the power of what differs, as a share of all.
fn missed(found: &Grid<f64>, target: &Grid<f64>) -> f64 {
    let pairs = found.values().iter().zip(target.values());
    let (off, all) = pairs.fold((0.0, 0.0), |(off, all), (a, b)| {
        (off + (a - b).powi(2), all + b * b)
    });
    (off / all).sqrt()
}

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
}

impl Spoilt {
    fn all(bench: &Bench<'_>) -> Vec<Self> {
        let noise = bench
            .effort
            .pick(&[0.0, 0.05][..], &[0.0, 0.01, 0.02, 0.05, 0.1, 0.2]);
        let coarser = bench.effort.pick(&[2][..], &[2, 4]);
        let shaken = bench.effort.pick(&[0.1][..], &[0.01, 0.1, 0.3, 1.0]);
        let noisy = noise.iter().copied().map(Self::Noisy);
        let smoothed = noise.iter().copied().map(Self::Smoothed);
        let coarser = coarser.iter().copied().map(Self::Coarser);
        let latent = shaken.iter().copied().map(Self::Latent);
        noisy.chain(smoothed).chain(coarser).chain(latent).collect()
    }

    fn method(self) -> &'static str {
        match self {
            Self::Noisy(_) => "as it is",
            Self::Smoothed(_) => "mean of 3 x 3",
            Self::Coarser(_) => "coarser",
            Self::Latent(_) => "latent shaken",
        }
    }

    fn setting(self) -> String {
        match self {
            Self::Noisy(sd) | Self::Smoothed(sd) => format!("noise {sd}"),
            Self::Coarser(_) => format!("{} px/mm", self.px_per_mm()),
            Self::Latent(share) => format!("by {share}"),
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
    let n_cloths = bench.effort.pick(4, 40);
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
            let scores = found?.scores(felt);
            distances.push(scores[Scores::LOG_SPECTRAL]);
            levels.push(scores[Scores::LEVEL]);
        }
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        rows.push(Row {
            error: Some(mean(&distances)),
            more: vec![("level error, %", fixed(mean(&levels), 2))],
            ..Row::of(spoilt.method(), setting, "held-back cloths")
        });
    }
    rows.extend(extreme(bench, &predictor)?);
    rows.extend(costs(bench)?);
    let notes = [
        "The networks learnt from pictures with the noise of a camera, and of one scale.",
        "A picture without a strip of 40 mm x 10 mm is refused.",
        "What wider networks and longer learning gain: selvedge friction train --width, --rounds, \
         --cloths; evaluate lists such runs.",
    ];
    Ok(Findings::new(rows, Vec::new(), notes))
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
    use crate::Effort;
    use selvedge_foundation::progress::Progress;

    #[test]
    fn phases_by_chance_fail_on_a_whole_trace_and_not_on_what_is_not_slow() {
        let findings = Progress::unheard(|progress| {
            (SPECTRA.run)(&mut Bench::new(Effort::Quick, 1, progress))
        })
        .unwrap();
        let error = |method: &str| {
            let is_it = |row: &&Row| row.method == method && row.size == Some(32.0);
            findings
                .rows
                .iter()
                .find(is_it)
                .and_then(|row| row.error)
                .unwrap()
        };
        assert!(error(WAYS[0].name) > 0.3, "frames lock to opposite signs");
        assert!(error(WAYS[1].name) < 0.05 && error(WAYS[2].name) < 0.05);
    }

    #[test]
    fn noise_costs_and_extreme_pictures_give_friction() {
        let findings = Progress::unheard(|progress| {
            (PICTURES.run)(&mut Bench::new(Effort::Quick, 1, progress))
        })
        .unwrap();
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
