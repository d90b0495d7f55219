//! The study of coding: what is left of an amplitude or a sine in drive codes, in WAV and MPEG
//! haptics files, behind a DAC of twelve bits, and of a carrier's phase after a thousand million
//! samples.

use std::f64::consts::TAU;
use std::fs;

use super::readable::{largest, rms};
use super::{Bench, Findings, ReportError, Row, Study};
use selvedge_device::{
    ActuatorModel, ArrayProfile, Coder, ContactorModel, FULL_CODE, HjifSpec, HjifWriter,
    SampleFormat, Skin, WavParts, WavSpec,
};
use selvedge_foundation::numerics::{Random, to_index};
use selvedge_foundation::progress::Progress;
use selvedge_render::array::{DriveSynth, single};

/// Samples a second of waveforms.
const RATE_HZ: u32 = 48_000;
/// Samples at the end of a run that are compared: whole periods and whole ticks.
const N_LAST: usize = 4800;
/// Steps of single precision in its largest values below 1.
const STEPS_OF_SINGLE: f64 = 16_777_216.0;
/// Bytes before the samples of a WAV file.
const WAV_HEADER: usize = 68;
/// Counts of the DAC for full drive, either way.
const DAC_COUNTS: f64 = 2047.0;
/// The largest first harmonic of an error that is never above half a step, steps.
const HARMONIC: f64 = 2.0 / std::f64::consts::PI;

/// Error of every coding against exact arithmetic.
pub(crate) const STUDY: Study = Study {
    name: "coding",
    chapter: "waveforms",
    question: "What do whole numbers, few digits and many samples leave of an amplitude, a sine \
               and a carrier's phase?",
    reference: "The same numbers before they are coded, in exact arithmetic: single precision \
                times a whole number has no rounding in double precision, and a carrier's phase \
                is the remainder of a division of whole numbers.",
    error: ("largest error", "steps"),
    cost_of: "number",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let n = bench.effort.pick(20_000, 400_000);
    let mut random = Random::new(bench.seed).branch("coding");
    let shares: Vec<f32> = (0..n).map(|_| single(random.uniform())).collect();
    bench.step(0.0, "codes")?;
    let mut rows = drive_codes(bench, &shares);
    bench.step(0.2, "files")?;
    rows.extend(wav(bench, &shares)?);
    rows.push(hjif(bench, &shares)?);
    bench.step(0.4, "DAC")?;
    rows.extend(dac()?);
    bench.step(0.5, "phases")?;
    for n_samples in [1_000_000, bench.effort.pick(10_000_000, 1_000_000_000)] {
        rows.extend(phases(bench, n_samples)?);
    }
    Ok(Findings::new(rows, Vec::new(), NOTES))
}

const NOTES: [&str; 5] = [
    "A step is one of the coding: a drive code, a count of 16 bits or of the DAC, of single \
     precision 2⁻²⁴ of full scale; of phases 2⁻²⁴ of the amplitude. Half a step is what rounding \
     costs; rms_steps beside it is 0.289 for errors that are even.",
    "A 16-bit sample is made in single precision, so that near the middle between two counts it \
     may round the other way: 0.002 steps more than half are promised.",
    "MPEG haptics: half a step is that of single precision, another half that of its shortest \
     digits, which a reader in double precision takes as they stand.",
    "The DAC's error is that of the line in the displacement of a free contactor, in counts: no \
     error of at most half a count has a first harmonic above 2/π of one, and as much is allowed \
     for the full drive that it is set against.",
    "Phases: sin 2πft of a time in double precision, and a phase that is added up in single or \
     double precision, stand beside the product's table of one common period.",
];

/// What a device or a file did not do.
fn failed(error: impl std::fmt::Display) -> ReportError {
    ReportError::Study(error.to_string())
}

/// A row of what codings are off by, steps.
fn row(method: &str, setting: &str, case: &str, errors: &[f64]) -> Row {
    let off = largest(errors.iter().map(|error| error.abs()));
    Row::of(method, setting, case)
        .error(off)
        .number("rms_steps", 4, rms(errors))
}

/// Drive codes at full gain in either band, and a soft start's.
fn drive_codes(bench: &mut Bench<'_>, shares: &[f32]) -> Vec<Row> {
    let profile = ArrayProfile::default();
    let mut coder = Coder::new(&profile, shares.len());
    let mut rows = Vec::new();
    for (band, name) in ["40 Hz", "320 Hz"].into_iter().enumerate() {
        let full_um = profile.full_scale_um[band];
        let um = |share: &f32| single(f64::from(*share) * full_um);
        let amplitudes: Vec<[f32; 2]> = shares
            .iter()
            .map(|share| [0, 1].map(|at| if at == band { um(share) } else { 0.0 }))
            .collect();
        for gain in [1.0, 0.25] {
            let codes = coder.encode(&amplitudes, gain);
            let errors: Vec<f64> = (codes.iter().zip(&amplitudes))
                .map(|(code, um)| {
                    let exact = f64::from(FULL_CODE) * f64::from(um[band]) * gain / full_um;
                    f64::from(code[band]) - exact
                })
                .collect();
            let mut codes = vec![[0; 2]; amplitudes.len()];
            let cost = bench.time(amplitudes.len(), || {
                coder.encode_into(&amplitudes, gain, &mut codes);
            });
            let setting = format!("gain {gain}");
            rows.push(
                row("drive code", &setting, name, &errors)
                    .promised(0.5)
                    .cost(cost),
            );
        }
    }
    rows
}

/// Samples of both formats, written and read.
fn wav(bench: &Bench<'_>, shares: &[f32]) -> Result<Vec<Row>, ReportError> {
    let folder = tempfile::tempdir().map_err(failed)?;
    let path = folder.path().join("coding.wav");
    let samples: Vec<f32> = shares.iter().map(|share| 2.0 * share - 1.0).collect();
    let mut rows = Vec::new();
    for (format, setting, step, promised) in [
        (SampleFormat::I16, "16 bits", 1.0 / 32_767.0, 0.502),
        (SampleFormat::F32, "32 bits", 1.0 / STEPS_OF_SINGLE, 0.0),
    ] {
        let spec = WavSpec {
            n_channels: 1,
            sample_rate_hz: RATE_HZ,
            format,
            full_scale_um: 50.0,
            part: None,
        };
        let write = || -> Result<(), ReportError> {
            let mut file = WavParts::create(&path, spec).map_err(failed)?;
            file.write(&samples).map_err(failed)?;
            file.finish().map_err(failed)?;
            Ok(())
        };
        write()?;
        let cost = bench.time_repeated(3, samples.len(), write);
        let bytes = fs::read(&path).map_err(failed)?;
        let data = &bytes[WAV_HEADER.min(bytes.len())..];
        let read: Vec<f64> = match format {
            SampleFormat::I16 => {
                let counts = data.as_chunks::<2>().0.iter();
                counts
                    .map(|two| f64::from(i16::from_le_bytes(*two)))
                    .collect()
            }
            SampleFormat::F32 => {
                let numbers = data.as_chunks::<4>().0.iter();
                numbers
                    .map(|four| f64::from(f32::from_le_bytes(*four)) / step)
                    .collect()
            }
        };
        let pairs = read.iter().zip(&samples);
        let errors: Vec<f64> = pairs
            .map(|(read, sample)| read - f64::from(*sample) / step)
            .collect();
        rows.push(
            row("WAV", setting, "even over ±1", &errors)
                .promised(promised)
                .cost(cost),
        );
    }
    Ok(rows)
}

/// Keyframes of MPEG haptics, written and read.
fn hjif(bench: &Bench<'_>, shares: &[f32]) -> Result<Row, ReportError> {
    let folder = tempfile::tempdir().map_err(failed)?;
    let path = folder.path().join("coding.hjif");
    let full_um = 50.0;
    let amplitudes: Vec<[f32; 2]> = shares.iter().map(|share| [50.0 * share, 0.0]).collect();
    let write = || -> Result<(), ReportError> {
        let spec = HjifSpec {
            n_channels: 1,
            full_scale_um: [full_um; 2],
            title: "coding".to_owned(),
        };
        let mut file = HjifWriter::create(&path, spec).map_err(failed)?;
        for um in &amplitudes {
            file.take(std::slice::from_ref(um)).map_err(failed)?;
        }
        Progress::unheard(|progress| file.finish(progress)).map_err(failed)?;
        Ok(())
    };
    write()?;
    let cost = bench.time_repeated(3, amplitudes.len(), write);
    let text = fs::read_to_string(&path).map_err(failed)?;
    let read = text.split("\"amplitude_modulation\":").skip(1).map(|rest| {
        let end = rest.find(',').unwrap_or(rest.len());
        rest[..end].parse::<f64>().unwrap_or(f64::NAN)
    });
    let off = |(read, um): (f64, &[f32; 2])| (read - f64::from(um[0]) / full_um) * STEPS_OF_SINGLE;
    let errors: Vec<f64> = read.zip(&amplitudes).map(off).collect();
    Ok(
        row("MPEG haptics", "shortest digits", "even over 0…1", &errors)
            .promised(1.0)
            .cost(cost),
    )
}

/// Displacements at ever lower drive, against that at full drive.
fn dac() -> Result<Vec<Row>, ReportError> {
    let model = ContactorModel {
        skin: Skin::FREE,
        ..ContactorModel::default()
    };
    let displaced_um = |code: u16| -> Result<f64, ReportError> {
        let mut one = ActuatorModel::new(&model, 1).map_err(failed)?;
        // A second, after which nothing rings any more.
        for _ in 0..40 {
            one.tick(&[[0, code]], 200.0);
        }
        Ok(one.reading().contactors[0].amplitude_um[1])
    };
    let full_um = displaced_um(FULL_CODE)?;
    let mut rows = Vec::new();
    for level_db in [-10.0, -20.0, -40.0, -60.0_f64] {
        let share = 10.0_f64.powf(level_db / 20.0);
        #[expect(clippy::cast_possible_truncation, reason = "a share of all codes")]
        let code = to_index((share * f64::from(FULL_CODE)).round()) as u16;
        let exact = f64::from(code) / f64::from(FULL_CODE);
        let off = DAC_COUNTS * (displaced_um(code)? / full_um - exact);
        let case = format!("320 Hz at {level_db} dB");
        let level_off_db =
            20.0 * (off / (DAC_COUNTS * exact)).abs().ln_1p() / std::f64::consts::LN_10;
        rows.push(
            Row::of("12-bit DAC", "free contactor", case)
                .error(off.abs())
                .promised(HARMONIC * (1.0 + exact))
                .number("level_off_db", 4, level_off_db),
        );
    }
    Ok(rows)
}

/// Samples of 320 Hz before so many, by several ways to carry a phase.
fn phases(bench: &mut Bench<'_>, at_least: u64) -> Result<Vec<Row>, ReportError> {
    let n_samples = at_least.next_multiple_of(N_LAST as u64);
    let from = n_samples - N_LAST as u64;
    let rate = f64::from(RATE_HZ);
    let errors = |sample: &dyn Fn(u64) -> f64| -> Vec<f64> {
        let exact = |m: u64| (TAU * (m * 320 % u64::from(RATE_HZ)) as f64 / rate).sin();
        let off = |m: u64| (sample(m) - exact(m)) * STEPS_OF_SINGLE;
        (from..n_samples).map(off).collect()
    };
    let case = format!("320 Hz after {n_samples} samples");
    let mut synth = DriveSynth::prepare(RATE_HZ, 1, 1.0)?;
    synth.set_amplitudes(&[[0.0, 1.0]]);
    let mut out = vec![0.0_f32; N_LAST];
    for _ in 0..n_samples / N_LAST as u64 {
        synth.fill(&mut out);
    }
    let found = errors(&|m| f64::from(out[to_index((m - from) as f64)]));
    let mut again = out.clone();
    let cost = bench.time(N_LAST, || synth.fill(&mut again));
    let mut rows = vec![
        row("table of a period", "single", &case, &found)
            .promised(1.0)
            .cost(cost),
    ];
    let of_time = |m: u64| (TAU * 320.0 * (m as f64 / rate)).sin();
    rows.push(row("sine of time", "double", &case, &errors(&of_time)));
    let (double_step, single_step) = (320.0 / rate, 320.0_f32 / 48_000.0);
    let (mut double, mut single) = (0.0_f64, 0.0_f32);
    for _ in 0..from {
        double = (double + double_step).fract();
        single = (single + single_step).fract();
    }
    let added =
        |first: f64, step: f64| move |m: u64| (TAU * (first + step * (m - from) as f64)).sin();
    rows.push(row(
        "phase added up",
        "double",
        &case,
        &errors(&added(double, double_step)),
    ));
    let (single, single_step) = (f64::from(single), f64::from(single_step));
    rows.push(row(
        "phase added up",
        "single",
        &case,
        &errors(&added(single, single_step)),
    ));
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::quick;

    #[test]
    fn codings_keep_half_a_step_and_the_table_keeps_its_phase() {
        let findings = quick(&STUDY, 1);
        assert_eq!(findings.rows.len(), 4 + 2 + 1 + 4 + 2 * 4);
        let broken: Vec<&Row> = findings.broken().collect();
        assert!(broken.is_empty(), "{broken:?}");
        let even = |row: &&Row| row.method == "drive code" && row.setting == "gain 1";
        for row in findings.rows.iter().filter(even) {
            let rms = row.further_number("rms_steps").unwrap();
            assert!((rms - 1.0 / 12.0_f64.sqrt()).abs() < 0.01, "{row:?}");
        }
        let added = findings.rows.last().unwrap().error.unwrap();
        assert!(added > 1e3, "single precision drifts: {added}");
    }
}
