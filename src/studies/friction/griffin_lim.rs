//! Griffin–Lim: from which phases, and in how many rounds, a trace is found from its spectra.

use crate::chart::{chart, lines_by};
use crate::readable::{largest, number};
use crate::{Bench, Findings, ReportError, Row, Study};
use selvedge_chart::Axis;
use selvedge_foundation::numerics::{Complex, GriffinLim, StartPhases, Stft, n_threads};
use selvedge_friction::{PredictedFriction, Split, Taken};

/// The study.
pub(crate) const STUDY: Study = Study {
    name: "griffin-lim",
    chapter: "friction",
    question: "From which phases, and in how many rounds, is friction found from its spectra?",
    reference: "The magnitudes that went in.",
    error: ("spectral error", "share of all magnitudes"),
    cost_of: "trace of 100 mm",
    run: spectra,
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
    let stft = PredictedFriction::spectra();
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
        [
            stft.spectral_error(&found, &magnitudes(trace)),
            stft.spectral_error(&PredictedFriction::rest_of(&found), &magnitudes(&rest)),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::quick;

    #[test]
    fn phases_by_chance_fail_on_a_whole_trace_and_not_on_what_is_not_slow() {
        let findings = quick(&STUDY, 1);
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
}
