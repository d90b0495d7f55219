//! The study of drive updates: when new amplitudes should begin to sound.
//!
//! The product changes them at ticks, where both carriers cross zero; here that is set beside
//! changing at any time of a tick, and beside drawing a line from one tick's amplitudes to the
//! next.

mod amplitudes;
mod spectrum;
mod writer;

use selvedge_chart::{Axis, Chart, Series, Style};
use selvedge_foundation::numerics::{Random, quantile};
use selvedge_foundation::quantity::{level_db, with_unit};
use selvedge_render::RenderError;
use selvedge_render::array::DriveSynth;

use super::chart::chart;
use super::readable::{largest, power_level_db, rms};
use super::{Bench, Findings, ReportError, Row, Study, Timing};
use amplitudes::Case;
use spectrum::{Spectrum, sounded};
use writer::{Change, RATE_HZ, TICK_SAMPLES, Writer};

/// Channels of the runs that are timed.
const N_CHANNELS: usize = 24;
/// Levels are compared where an amplitude is at least this share of the largest.
const LEAST_SHARE: f64 = 1e-3;
/// A level error counts as at most this, dB: silence has no level.
const MOST_DB: f64 = 40.0;
/// The column of the energy above 640 Hz.
const ABOVE_640_HZ: &str = "above_640_hz_db";

/// When new amplitudes take effect.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Switching {
    /// At the tick, by the product's own synthesizer.
    ZeroCrossing,
    /// At a random sample of the tick, as they arrive.
    Immediate,
    /// Along a line over this many samples from the tick on.
    Interpolated(usize),
}

const SWITCHINGS: [Switching; 5] = [
    Switching::ZeroCrossing,
    Switching::Immediate,
    Switching::Interpolated(TICK_SAMPLES),
    Switching::Interpolated(TICK_SAMPLES / 5),
    Switching::Interpolated(TICK_SAMPLES / 25),
];

impl Switching {
    fn label_and_setting(self) -> (&'static str, String) {
        match self {
            Self::ZeroCrossing => ("zero crossing", "at the tick".to_owned()),
            Self::Immediate => ("immediate", "at any time".to_owned()),
            Self::Interpolated(n_samples) => {
                let ms = 1e3 * n_samples as f64 / RATE_HZ as f64;
                ("interpolated", format!("over {ms:.0} ms"))
            }
        }
    }

    fn name(self) -> String {
        let (label, setting) = self.label_and_setting();
        [label, &setting].join(" ")
    }
}

/// Out-of-band energy and level error of three ways to change amplitudes, and their cost.
pub(crate) const STUDY: Study = Study {
    name: "drive-updates",
    chapter: "waveforms",
    question: "When should new amplitudes begin to sound, so that nothing is felt but their \
               levels?",
    reference: "Energy within half an octave of 40 and 320 Hz; levels against those asked for at \
                the tick.",
    error: ("out-of-band energy", "of that in band"),
    cost_of: "sample of a channel",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let n_ticks = bench.effort.pick(80, 800);
    let random = Random::new(bench.seed);
    bench.step(0.0, "strokes over the shipped textiles")?;
    let mut cases = amplitudes::strokes(bench.effort.pick(1, 4), n_ticks)?;
    cases.push(amplitudes::steps(n_ticks, random.branch("steps")));
    let mut costs = Vec::new();
    for switching in SWITCHINGS {
        bench.step(0.1, switching.label_and_setting().0)?;
        costs.push(cost(switching, bench)?);
    }
    let mut findings = Findings::default();
    for (n_done, case) in cases.iter().enumerate() {
        bench.step(0.2 + 0.8 * n_done as f64 / cases.len() as f64, &case.0)?;
        let mut lines = Vec::new();
        for (switching, cost) in SWITCHINGS.iter().zip(&costs) {
            let samples = drive(*switching, &case.1, random.branch("arrival"))?;
            let spectrum = Spectrum::of(&samples);
            let row = row(*switching, case, &samples, &spectrum, *cost);
            findings.rows.push(row);
            lines.push((*switching, spectrum));
        }
        let name = format!("spectrum-{}", case.0.replace(' ', "-"));
        findings.plots.push((name, plot(&case.0, &lines)));
    }
    findings.notes = notes(&findings.rows);
    Ok(findings)
}

/// What writes a way's waveform, tick by tick.
enum Drive {
    Product(DriveSynth),
    Study(Writer),
}

impl Drive {
    fn of(switching: Switching, n_channels: usize) -> Result<Self, RenderError> {
        if switching != Switching::ZeroCrossing {
            return Ok(Self::Study(Writer::new(n_channels)));
        }
        let rate_hz = u32::try_from(RATE_HZ).unwrap_or(u32::MAX);
        Ok(Self::Product(DriveSynth::prepare(
            rate_hz, n_channels, 1.0,
        )?))
    }

    /// Writes a tick; where amplitudes change as they arrive, they do after `arrival` samples.
    fn write(
        &mut self,
        given: &[[f32; 2]],
        (switching, arrival): (Switching, usize),
        out: &mut [f32],
    ) {
        match (self, switching) {
            (Self::Product(synth), _) => {
                synth.set_amplitudes(given);
                synth.fill(out);
            }
            (Self::Study(writer), Switching::Interpolated(n_samples)) => {
                writer.write(given, Change::Over(n_samples), out);
            }
            (Self::Study(writer), _) => writer.write(given, Change::At(arrival), out),
        }
    }
}

/// One channel of samples in units of a µm.
fn drive(
    switching: Switching,
    amplitudes: &[[f32; 2]],
    mut random: Random,
) -> Result<Vec<f32>, RenderError> {
    let mut samples = vec![0.0; amplitudes.len() * TICK_SAMPLES];
    let mut drive = Drive::of(switching, 1)?;
    for (out, amplitudes) in samples.chunks_exact_mut(TICK_SAMPLES).zip(amplitudes) {
        let when = (switching, random.index(TICK_SAMPLES));
        drive.write(std::slice::from_ref(amplitudes), when, out);
    }
    Ok(samples)
}

/// The cost of one tick of every channel, whose amplitudes change each time.
fn cost(switching: Switching, bench: &mut Bench<'_>) -> Result<Timing, RenderError> {
    let mut drive = Drive::of(switching, N_CHANNELS)?;
    let mut out = vec![0.0; N_CHANNELS * TICK_SAMPLES];
    let levels = [[[1.0, 2.0]; N_CHANNELS], [[3.0, 0.5]; N_CHANNELS]];
    let mut n_ticks = 0_usize;
    Ok(bench.time(out.len(), || {
        n_ticks += 1;
        let when = (switching, n_ticks * 367 % TICK_SAMPLES);
        drive.write(&levels[n_ticks % 2], when, &mut out);
        out.last().copied()
    }))
}

fn row(
    switching: Switching,
    (case, amplitudes): &Case,
    samples: &[f32],
    spectrum: &Spectrum,
    cost: Timing,
) -> Row {
    let out_of_band = spectrum.out_of_band();
    let mut errors_db = level_errors_db(amplitudes, samples);
    let (label, setting) = switching.label_and_setting();
    Row::of(label, setting, case)
        .error(out_of_band)
        .cost(cost)
        .number("out_of_band_db", 2, power_level_db(out_of_band))
        .number("level_error_rms_db", 4, rms(&errors_db))
        .number(ABOVE_640_HZ, 2, power_level_db(spectrum.above_640_hz()))
        .number("level_error_p99_db", 4, quantile(&mut errors_db, 0.99))
        .number("level_error_max_db", 4, largest(errors_db))
}

/// `|20 log₁₀|` of what sounded in each tick over what was asked for, both bands.
fn level_errors_db(amplitudes: &[[f32; 2]], samples: &[f32]) -> Vec<f64> {
    let mut errors_db = Vec::new();
    let sounded = sounded(samples);
    for b in 0..2 {
        let asked = || amplitudes.iter().map(|pair| f64::from(pair[b]));
        let least = LEAST_SHARE * largest(asked());
        for (asked, sounded) in asked().zip(&sounded) {
            if asked > 0.0 && asked >= least {
                let error_db = level_db((sounded[b] / asked).abs()).abs();
                errors_db.push(error_db.min(MOST_DB));
            }
        }
    }
    errors_db
}

/// NaN where there is none.
fn above_640_hz_db(row: &Row) -> f64 {
    row.further_number(ABOVE_640_HZ).unwrap_or(f64::NAN)
}

fn plot(case: &str, lines: &[(Switching, Spectrum)]) -> Chart {
    let line = |(switching, spectrum): &(Switching, Spectrum)| {
        Series::of(switching.name(), Style::Line, spectrum.cells_db())
    };
    let level = Axis::linear("level of a twelfth of an octave, dB re the loudest");
    chart(
        format!("Spectrum of the drive waveform, {case}"),
        Axis::log("frequency, Hz").within([5.0, 20_000.0]),
        level.within([-120.0, 0.0]),
        lines.iter().map(line).collect(),
        "one channel at 48 kHz, Blackman window over the whole",
    )
}

/// The worst case of each way, a sentence each.
fn notes(rows: &[Row]) -> Vec<String> {
    let described = |switching: &Switching| {
        let (label, setting) = switching.label_and_setting();
        let is_its = |row: &&Row| row.method == label && row.setting == setting;
        let energies = rows.iter().filter(is_its).filter_map(|row| row.error);
        let worst_db = with_unit(power_level_db(largest(energies)), 1, "dB");
        let name = switching.name();
        format!("{name}: at worst {worst_db} of energy out of band re in band.")
    };
    let mut notes: Vec<String> = SWITCHINGS.iter().map(described).collect();
    let gains_db = rows.chunks_exact(SWITCHINGS.len()).map(|case| {
        let [zero_db, immediate_db] = [0, 1].map(|n| above_640_hz_db(&case[n]));
        immediate_db - zero_db
    });
    let least_db = with_unit(gains_db.fold(f64::INFINITY, f64::min), 1, "dB");
    notes.push(format!(
        "Most of the energy out of band lies beside the carriers: it is what changing a level \
         every 25 ms means, and comes to much the same whenever the change is made. Above 640 Hz, \
         where a click is heard, a change at the zero crossing leaves at least {least_db} less \
         than one at any time."
    ));
    notes.push(
        "Only a change at the tick gives every tick the levels that were asked for: a line, and a \
         change that comes late, give a part of the tick to the levels before it."
            .to_owned(),
    );
    notes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::quick;

    #[test]
    fn a_zero_crossing_is_quieter_above_the_bands_and_a_line_quieter_still() {
        let findings = quick(&STUDY, 7);
        assert_eq!(findings.rows.len(), 2 * SWITCHINGS.len());
        for case in findings.rows.chunks(SWITCHINGS.len()) {
            let [zero, immediate, line, ..] = case else {
                panic!("five rows a case")
            };
            let energies = [zero, line].map(|row| row.error.unwrap());
            assert!(
                energies[1] < 0.5 * energies[0],
                "{}: {energies:?}",
                zero.case
            );
            let above_db = [zero, immediate, line].map(above_640_hz_db);
            assert!(
                above_db[0] < above_db[1] - 5.0 && above_db[2] < above_db[0] - 20.0,
                "{}: {above_db:?}",
                zero.case
            );
        }
        assert_eq!(findings.plots.len(), 2);
    }

    #[test]
    fn only_a_change_at_the_tick_keeps_the_level_of_every_tick() {
        let (_, amplitudes) = amplitudes::steps(40, Random::new(3));
        let worst_db = |switching| {
            let samples = drive(switching, &amplitudes, Random::new(4)).unwrap();
            level_errors_db(&amplitudes, &samples)
                .into_iter()
                .fold(0.0, f64::max)
        };
        assert!(worst_db(Switching::ZeroCrossing) < 1e-4, "exact");
        assert!(
            worst_db(Switching::Immediate) > 1.0,
            "a part of the tick is the last one's"
        );
        // From silence, a line over the whole tick has half of the level: 6.02 dB.
        let line = drive(
            Switching::Interpolated(TICK_SAMPLES),
            &[[1.0, 0.0]],
            Random::new(4),
        );
        let error_db = level_errors_db(&[[1.0, 0.0]], &line.unwrap())[0];
        assert!((error_db - 6.02).abs() < 0.02, "{error_db}");
    }

    #[test]
    fn the_same_seed_gives_the_same_numbers() {
        let numbers = || {
            quick(&STUDY, 7)
                .rows
                .into_iter()
                .map(|row| (row.error, row.more))
                .collect::<Vec<_>>()
        };
        assert_eq!(numbers(), numbers());
    }
}
