//! Fourier templates: how many coefficients a profile takes, and how a drawn one stands beside the
//! original (as in figure 7 of Wall & Harwin 1999).

use crate::chart::chart;
use crate::readable::{apart_percent, rms};
use crate::{Bench, Findings, ReportError, Row, Study, Timing};
use selvedge_chart::{Axis, Chart, Series, Style};
use selvedge_foundation::numerics::{Random, without_line};
use selvedge_textile::surface::{Direction, Profile};
use selvedge_textile::{FourierSeries, FourierTemplate, Library, Reading};

/// Samples of a piece: 5 mm.
const N_PIECE: usize = 1150;
/// Harmonics of the fullest template: up to 20 cycles/mm.
const N_MOST: usize = 100;
/// Profiles drawn to tell how rough they are.
const N_DRAWS: u64 = 100;

/// Error by number of Fourier coefficients, and what a profile of them costs.
pub(crate) const STUDY: Study = Study {
    name: "fourier-coefficients",
    chapter: "surfaces",
    question: "How many Fourier coefficients does a profile take, and is a drawn one as rough?",
    reference: "The textile's own profile, limited to 20 cycles/mm.",
    error: ("rms error", "%"),
    cost_of: "profile of 5 mm",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let library = Library::shipped()?;
    let ids = ["denim", "wool-rib", "silk-crepe", "jute-plain"];
    let mut rows = Vec::new();
    let mut plots = Vec::new();
    let n_ids = bench.effort.pick(2, ids.len());
    for (done, id) in ids.iter().take(n_ids).enumerate() {
        bench.step(done as f64 / n_ids as f64, id)?;
        let textile = library.load(id)?;
        let pieces = pieces(textile.surface().profile(Direction::WarpForward));
        let whole = FourierTemplate::learn(id, &pieces, N_MOST)?;
        let own = FourierTemplate::learn(id, &[pieces[0].clone(), pieces[0].clone()], N_MOST)?;
        let all = heights(&own, N_MOST, 0);
        let truth = rms_of_pieces(&pieces)?;
        let counts = bench
            .effort
            .pick(vec![5, 20, 100], vec![2, 5, 10, 20, 50, 75, 100]);
        for n in counts {
            let cost = bench.time(1, || heights(&own, n, 0));
            let error = apart_percent(&heights(&own, n, 0), &all);
            // All of them give the profile back.
            let own_row = row("own coefficients", id, n, (error, cost));
            rows.push(own_row.promised((n == N_MOST).then_some(1e-9)));
            let seed = bench.seed;
            let draws = (0..N_DRAWS).map(|draw| seed.wrapping_add(draw));
            let drawn: Vec<f64> = draws.flat_map(|seed| heights(&whole, n, seed)).collect();
            let error = 100.0 * (rms(&drawn) / truth - 1.0).abs();
            let cost = bench.time(1, || heights(&whole, n, seed));
            rows.push(row("drawn from a template", id, n, (error, cost)));
        }
        if done == 0 {
            plots.push((
                "drawn".to_owned(),
                plot(id, &all, &heights(&whole, N_MOST, bench.seed)),
            ));
        }
    }
    let notes = [
        "With its own coefficients a profile is compared sample by sample; with drawn ones \
         only roughness can be compared: the rms of 100 drawn profiles against that of the \
         four pieces of 5 mm that the template was learnt from.",
        "A template of four pieces knows each standard deviation to about 40 %; drawn \
         harmonics have the right strength and no common phase, so what repeats sharply in \
         the cloth is smeared.",
    ];
    Ok(Findings::new(rows, plots, notes))
}

/// The first four pieces of 5 mm, without their lines.
fn pieces(profile: Option<&Profile>) -> Vec<Profile> {
    let Some(profile) = profile else {
        return Vec::new();
    };
    let chunks = profile.heights_um().chunks_exact(N_PIECE);
    let piece = |chunk: &[f64]| Profile::new(profile.step_mm(), without_line(chunk)).ok();
    chunks.filter_map(piece).collect()
}

/// Rms of the pieces together, limited to the band of the fullest template, µm.
fn rms_of_pieces(pieces: &[Profile]) -> Result<f64, ReportError> {
    let mut all = Vec::new();
    for piece in pieces {
        let own = FourierTemplate::learn("", &[piece.clone(), piece.clone()], N_MOST)?;
        all.extend(heights(&own, N_MOST, 0));
    }
    Ok(rms(&all))
}

/// What a template draws with its first `n` harmonics, µm.
fn heights(template: &FourierTemplate, n: usize, seed: u64) -> Vec<f64> {
    let band = [0.0, (n as f64 + 0.5) * template.fundamental_per_m];
    let mut random = Random::new(seed);
    let series = FourierSeries::draw(template, band, Reading::Corrected, &mut random);
    let step_mm = 1000.0 / (template.fundamental_per_m * N_PIECE as f64);
    (0..N_PIECE)
        .map(|i| series.height_um(i as f64 * step_mm))
        .collect()
}

fn row(method: &str, id: &str, n: usize, (error, cost): (f64, Timing)) -> Row {
    let n_bytes = 4 * n * size_of::<f64>();
    let row = Row::of(method, format!("{n} harmonics"), id);
    row.error(error).cost(cost).bytes(n_bytes)
}

fn plot(id: &str, original: &[f64], drawn: &[f64]) -> Chart {
    let line = |name: &str, heights: &[f64]| {
        let points = heights.iter().enumerate();
        let points = points.map(|(i, &z)| [i as f64 / 230.0, z]);
        Series::of(name, Style::Line, points)
    };
    chart(
        format!("A drawn profile beside the original: {id}"),
        Axis::linear("place, mm"),
        Axis::linear("height, µm"),
        vec![
            line("original, band-limited", original),
            line("drawn", drawn),
        ],
        "As rough, not the same: only the strengths of harmonics are learnt.",
    )
}
