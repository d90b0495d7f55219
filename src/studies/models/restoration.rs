//! Correlation and restoration: what noise and the number of harmonics do to it.

use std::f64::consts::TAU;

use crate::readable::apart_percent;
use crate::{Bench, Findings, ReportError, Row, Study, Timing};
use selvedge_foundation::numerics::Random;
use selvedge_textile::Reduced;
use selvedge_textile::surface::Profile;

const STEP_MM: f64 = 1.0 / 230.0;
const N_SAMPLES: usize = 4600;
/// Period of the waves, mm.
const PERIOD_MM: f64 = 0.617;
/// Amplitudes of harmonics 1 … 8, µm.
const AMPLITUDES_UM: [f64; 8] = [10.0, 4.0, 3.0, 2.0, 1.5, 1.0, 0.7, 0.5];

/// Errors of period, roughness and waves by harmonics and noise, and what reduction costs.
pub(crate) const STUDY: Study = Study {
    name: "restoration",
    chapter: "surfaces",
    question: "What does noise do to the restoration of a profile by its period and harmonics?",
    reference: "Eight harmonics of 0.617 mm with known amplitudes and phases, before noise was \
                added.",
    error: ("error", "%"),
    cost_of: "profile of 20 mm",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let mut rows = Vec::new();
    let all_db = bench
        .effort
        .pick(vec![0.0, 10.0], vec![-6.0, 0.0, 10.0, 40.0]);
    let n_levels = all_db.len() as f64;
    let settings = bench.effort.pick(vec![2, 8], vec![1, 2, 4, 8, 16]);
    for (done, snr_db) in all_db.into_iter().enumerate() {
        bench.step(done as f64 / n_levels, &format!("{snr_db} dB"))?;
        for &n in &settings {
            rows.extend(of_setting(snr_db, n, bench)?);
        }
    }
    let notes = [
        "Period and SMD are promised (1 % and 5 %) from 0 dB on; SMD is that of the restored \
         against the noisy profile, the waves are against those before noise. Errors are the \
         largest over the seeds.",
    ];
    Ok(Findings::new(rows, Vec::new(), notes))
}

fn wave_um(i: usize) -> f64 {
    let phase = TAU * i as f64 * STEP_MM / PERIOD_MM;
    let harmonics = AMPLITUDES_UM.iter().zip(1_u32..);
    harmonics
        .map(|(a, k)| a * (f64::from(k) * phase + f64::from(k * k)).cos())
        .sum()
}

fn of_setting(snr_db: f64, n: usize, bench: &mut Bench<'_>) -> Result<Vec<Row>, ReportError> {
    let truth: Vec<f64> = (0..N_SAMPLES).map(wave_um).collect();
    let power: f64 = AMPLITUDES_UM.iter().map(|a| 0.5 * a * a).sum();
    let noise_um = power.sqrt() * 10.0_f64.powf(-snr_db / 20.0);
    let mut worst = [0.0_f64; 3];
    let mut first = None;
    for seed in 0..bench.effort.pick(3, 12) {
        let mut random = Random::new(bench.seed).branch(&format!("noise {seed}"));
        let heights = truth
            .iter()
            .map(|z| z + noise_um * random.normal())
            .collect();
        let Ok(profile) = Profile::new(STEP_MM, heights) else {
            continue;
        };
        let reduced = Reduced::of(&profile, n)?;
        let period = reduced.period_mm.unwrap_or(0.0);
        let restored = reduced.restored_um(N_SAMPLES, STEP_MM, &mut random);
        let Ok(restored) = Profile::new(STEP_MM, restored) else {
            continue;
        };
        let waves = reduced.waves_um(N_SAMPLES, STEP_MM);
        let found = [
            100.0 * (period / PERIOD_MM - 1.0).abs(),
            100.0 * (restored.smd_um() / reduced.smd_um - 1.0).abs(),
            apart_percent(&waves, &truth),
        ];
        (0..3).for_each(|i| worst[i] = worst[i].max(found[i]));
        first.get_or_insert((profile, reduced));
    }
    let Some((profile, reduced)) = first else {
        return Ok(Vec::new());
    };
    let reduction = bench.time(1, || Reduced::of(&profile, n).map(|r| r.smd_um).ok());
    let random = Random::new(bench.seed);
    let restoration = bench.time(1, || {
        reduced.restored_um(N_SAMPLES, STEP_MM, &mut random.clone())
    });
    let row = |method: &str, error: f64, promised: Option<f64>, cost: Timing| {
        let case = format!("{snr_db:+} dB").replace('-', "−");
        Row::of(method, format!("{n} harmonics"), case)
            .error(error)
            .promised(promised.filter(|_| snr_db >= 0.0))
            .cost(cost)
    };
    Ok(vec![
        row("period", worst[0], Some(1.0), reduction),
        row("SMD of the restored", worst[1], Some(5.0), restoration),
        row("waves", worst[2], None, reduction),
    ])
}
