//! Sweeps to where it breaks: each extreme that is a number goes from harmless to absurd, its error
//! stands beside its bound and its condition, and the worst place is named.

use std::sync::Arc;

use super::contactor::{TOO_FAR_UM, held_off, loaded, rattled};
use super::picture::{answer, waves as picture_of};
use super::scene::{METHODS, moving};
use super::stylus::{fall, fallen};
use crate::chart::{chart, lines_by};
use crate::picture::share_off;
use crate::readable::number;
use crate::rendering::{PROMISED_DB, PROMISED_SHARE};
use crate::textiles::{amplitudes_um, noise, of_heights, prepared, scene_with};
use crate::{Bench, Effort, Findings, ReportError, Row, Study};
use selvedge_chart::{Axis, Chart};
use selvedge_device::Skin;
use selvedge_foundation::numerics::to_whole;
use selvedge_render::ErrorMeter;
use selvedge_render::array::Method;
use selvedge_render::contact::{Standing, Stepper};
use selvedge_textile::picture::Basis;
use selvedge_textile::surface::{N_BINS, Surface, WINDOW_LENGTH_MM};
use selvedge_textile::tactile::MAX_SPEED_MM_PER_S;
use std::f64::consts::TAU;

/// Maps of what holds.
pub(crate) const SWEEPS: Study = Study {
    name: "stability-sweeps",
    chapter: "sweeps",
    question: "How do errors grow on the way to each extreme, and where is the worst of it?",
    reference: "Of heights the method reference, and for offsets itself without one; of contactors \
                the closed form of |H|; of energies what was there; of lattices the picture's.",
    error: ("error", "of its bound"),
    cost_of: "case",
    run,
};

/// What came out at a place by a method: the share of its bound, and the condition.
fn point(method: impl Into<String>, share: f64, condition: f64) -> Row {
    let row = Row::of(method, "", "").error(share).promised(1.0);
    row.with("condition", number(condition))
}

/// What is swept, from where to where, and what comes out at one of its values.
struct Sweep {
    name: &'static str,
    label: &'static str,
    /// Ends, and values in quick and in full.
    ends: [f64; 2],
    counts: [u32; 2],
    is_even: bool,
    at: fn(f64) -> Result<Vec<Row>, ReportError>,
    condition: &'static str,
}

const SWEEPS_OF: [Sweep; 8] = [
    Sweep {
        name: "offset",
        label: "height that is added, µm",
        ends: [1.0, 1e12],
        counts: [5, 25],
        is_even: false,
        at: offset,
        condition: "offset over amplitude",
    },
    Sweep {
        name: "tilt",
        label: "tilt, µm/mm",
        ends: [1e-3, 1e6],
        counts: [4, 28],
        is_even: false,
        at: tilt,
        condition: "rise over a window, of the amplitude",
    },
    Sweep {
        name: "dynamic range",
        label: "between two waves, dB",
        ends: [0.0, 240.0],
        counts: [5, 25],
        is_even: true,
        at: range,
        condition: "ratio of the waves",
    },
    Sweep {
        name: "crossing",
        label: "bins that cross 1 kHz, from the first of 25",
        ends: [1.0, 476.0],
        counts: [2, 20],
        is_even: true,
        at: crossing,
        condition: "largest jump, of the amplitude in it",
    },
    Sweep {
        name: "quality",
        label: "quality of a bimorph",
        ends: [1.0, 1000.0],
        counts: [3, 19],
        is_even: false,
        at: quality,
        condition: "samples that it rings for",
    },
    Sweep {
        name: "preload",
        label: "stiffness of the skin, N/m",
        ends: [1.0, 1e9],
        counts: [3, 19],
        is_even: false,
        at: preload,
        condition: "share of the time that skin is off",
    },
    Sweep {
        name: "wall",
        label: "stiffness of a wall, N/m",
        ends: [1.0, 1e9],
        counts: [4, 28],
        is_even: false,
        at: wall,
        condition: "radians of its swing in a step",
    },
    Sweep {
        name: "lattice",
        label: "angle between two waves of a picture, °",
        ends: [1.0, 90.0],
        counts: [3, 24],
        is_even: false,
        at: lattice,
        condition: "1/sin of the angle",
    },
];

impl Sweep {
    fn values(&self, effort: Effort) -> Vec<f64> {
        let last = f64::from(effort.pick(self.counts[0], self.counts[1]) - 1);
        let [from, to] = self.ends;
        let value = |nth: u32| match f64::from(nth) / last {
            share if self.is_even => from + (to - from) * share,
            share => from * (to / from).powf(share),
        };
        (0..).map(value).take(to_whole::<usize>(last) + 1).collect()
    }

    fn plot(&self, rows: &[Row]) -> Chart {
        let axis = if self.is_even {
            Axis::linear(self.label)
        } else {
            Axis::log(self.label)
        };
        let point = |row: &Row| Some([row.further_number("at")?, row.error?]);
        let lines = lines_by(rows.iter(), |row| &row.method, point);
        chart(
            format!("On the way to an extreme: {}", self.name),
            axis,
            Axis::log("error, of its bound"),
            lines,
            "An error of exactly 0, and what is refused, has no place.",
        )
    }
}

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let mut findings = Findings::default();
    for (nth, sweep) in SWEEPS_OF.iter().enumerate() {
        bench.step(nth as f64 / SWEEPS_OF.len() as f64, sweep.name)?;
        let mut rows = Vec::new();
        for value in sweep.values(bench.effort) {
            rows.extend((sweep.at)(value)?.into_iter().map(|row| Row {
                setting: number(value),
                case: sweep.name.to_owned(),
                ..row.with("at", value)
            }));
        }
        let name = format!("stability-{}", sweep.name.replace(' ', "-"));
        findings.plots.push((name, sweep.plot(&rows)));
        let size = |row: &Row| row.error.unwrap_or(f64::INFINITY);
        let worst = rows.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
        findings.notes.extend(worst.map(|row| {
            let (share, at) = (number(size(row)), &row.setting);
            format!(
                "{}: at worst {share} of the bound, at {at} ({}, {}); condition, {}: {}.",
                sweep.name,
                sweep.label,
                row.method,
                sweep.condition,
                row.further("condition")
            )
        }));
        findings.rows.extend(rows);
    }
    Ok(findings)
}

/// Amplitude of the waves that offsets and tilts are added to, µm.
const WAVE_UM: f64 = 3.0;
/// Speeds that surfaces are felt at, mm/s.
const SPEEDS_MM_PER_S: [f64; 6] = [1.0, 7.3, 40.0, 171.0, 600.0, 2000.0];

fn wave(x_mm: f64) -> f64 {
    WAVE_UM * (TAU * x_mm).sin()
}

/// What one contactor feels at some speeds along the warp, µm.
fn felt(
    surface: &Arc<Surface>,
    method: Method,
    speeds: &[f64],
) -> Result<Vec<[f64; 2]>, ReportError> {
    let mut renderer = prepared(&scene_with(surface), method)?;
    let mut at = |speed: &f64| amplitudes_um(&mut renderer, &[moving(*speed)]).next();
    Ok(speeds.iter().filter_map(&mut at).collect())
}

/// Each faster method beside the reference.
fn beside_reference(
    surface: &Arc<Surface>,
    speeds: &[f64],
    condition: f64,
) -> Result<Vec<Row>, ReportError> {
    let exact = felt(surface, METHODS[0], speeds)?;
    let largest = |b: usize| exact.iter().map(|um| um[b]).fold(0.0, f64::max);
    let mut points = Vec::new();
    for method in &METHODS[1..] {
        let mut meter = ErrorMeter::new([largest(0), largest(1)]);
        for (found, exact) in felt(surface, *method, speeds)?.iter().zip(&exact) {
            meter.add(*found, *exact);
        }
        let error = meter.finish();
        let share = (error.max_db / PROMISED_DB).max(error.max_share_below / PROMISED_SHARE);
        points.push(point(method.name(), share, condition));
    }
    Ok(points)
}

/// The reference with and without an offset: 16 roundings of its largest height are allowed.
fn offset(um: f64) -> Result<Vec<Row>, ReportError> {
    let method = METHODS[0];
    let plain = felt(&of_heights(wave)?, method, &SPEEDS_MM_PER_S)?;
    let raised = felt(&of_heights(|x| um + wave(x))?, method, &SPEEDS_MM_PER_S)?;
    let condition = 1.0 + um / WAVE_UM;
    let pairs = plain.iter().flatten().zip(raised.iter().flatten());
    let off = pairs.map(|(plain, raised)| (raised - plain).abs());
    let share = off.fold(0.0, f64::max) / (16.0 * f64::EPSILON * condition * WAVE_UM);
    Ok(vec![point(method.name(), share, condition)])
}

fn tilt(um_per_mm: f64) -> Result<Vec<Row>, ReportError> {
    let surface = of_heights(|x| um_per_mm * x + wave(x))?;
    let condition = um_per_mm * WINDOW_LENGTH_MM / WAVE_UM;
    beside_reference(&surface, &SPEEDS_MM_PER_S, condition)
}

fn range(db: f64) -> Result<Vec<Row>, ReportError> {
    let ratio = 10.0_f64.powf(db / 20.0);
    let surface = of_heights(|x| 100.0 * (TAU * 0.7 * x).sin() + 100.0 / ratio * wave(13.7 * x))?;
    beside_reference(&surface, &SPEEDS_MM_PER_S, ratio)
}

/// One unit of rounding before each crossing of a block of bins, on it, and after.
fn crossing(first: f64) -> Result<Vec<Row>, ReportError> {
    let surface = noise(1)?;
    let bins = (0..25).map(|nth| (first.round() + f64::from(nth)).min(N_BINS as f64));
    let speeds = bins.flat_map(|bin| {
        let speed = MAX_SPEED_MM_PER_S / bin;
        [speed.next_down(), speed, speed.next_up()]
    });
    let speeds: Vec<f64> = speeds.collect();
    let exact = felt(&surface, METHODS[0], &speeds)?;
    let jumps = exact
        .chunks_exact(3)
        .map(|at| (at[2][1] / at[0][1] - 1.0).abs());
    let condition = jumps.filter(|jump| jump.is_finite()).fold(0.0, f64::max);
    beside_reference(&surface, &speeds, condition)
}

/// Exact steps of a held sine, on light and on stiff skin: 1e-9 is allowed.
fn quality(quality: f64) -> Result<Vec<Row>, ReportError> {
    let at = |stiffness: f64| {
        let model = loaded(Skin::bonded(stiffness, 0.0), quality);
        let none = || ReportError::Study("there is no step, or a pole".to_owned());
        let [off, growth] = held_off(&model).ok_or_else(none)?;
        let rings = 1.0 / (1.0 - growth).max(f64::EPSILON);
        let name = format!("skin of {} N/m", number(stiffness));
        Ok(point(name, off / 1e-9, rings))
    };
    [0.0, 1e3, 1e5].into_iter().map(at).collect()
}

/// Full drive against skin that lifts off, pressed in by some µm: bounded by 0.1 m.
fn preload(stiffness: f64) -> Result<Vec<Row>, ReportError> {
    let at = |um: f64| {
        let [most_um, off_share] = rattled(stiffness, um).map_err(ReportError::Study)?;
        let name = format!("pressed in {um} µm");
        Ok(point(name, most_um / TOO_FAR_UM, off_share))
    };
    [0.0, 1.0, 100.0].into_iter().map(at).collect()
}

/// A fall on a wall: what came from nowhere, 1e-7 of what was put in is allowed; nothing is
/// promised of steps that are marked as growing.
fn wall(stiffness: f64) -> Result<Vec<Row>, ReportError> {
    let mut points = Vec::new();
    for (method, rate_hz) in [Stepper::Exact, Stepper::ImplicitEuler, Stepper::Trapezoid]
        .into_iter()
        .flat_map(|method| [250.0, 4e4].map(|rate_hz| (method, rate_hz)))
    {
        let setup = fall(stiffness, method, rate_hz, None)?;
        let n_steps = if setup.case().standing() == Standing::Stable {
            200
        } else {
            0
        };
        let (mut run, mut most) = (fallen(setup)?, 0.0_f64);
        for _ in 0..n_steps {
            let is_there = run.advance([0.0; 2]);
            let gained = run.gained_j() / run.put_in_j();
            most = most.max(if is_there { gained } else { f64::INFINITY });
        }
        let turn = (stiffness / 0.075).sqrt() / rate_hz;
        let name = format!("{}, {rate_hz} Hz", method.name());
        points.push(point(name, most / 1e-7, turn));
    }
    Ok(points)
}

/// Two waves of 9 px at an angle: a lattice that is given is within 5 % of the shorter vector,
/// where the picture holds two of the longer; where it holds fewer, nothing is promised.
fn lattice(degrees: f64) -> Result<Vec<Row>, ReportError> {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let picture = picture_of([[9.0, 0.0], [9.0 / cosine, 9.0 / sine]]);
    let truth = Basis::new([9.0, -9.0 * cosine / sine], [0.0, 9.0 / sine]).reduced();
    let found = answer(&picture).map_err(ReportError::Study)?;
    let share = found.map_or(0.0, |[p1, p2]| {
        share_off(&truth, Some(Basis::new(p1, p2))) / 0.05
    });
    let is_twice = 2.0 * truth.longer() <= picture.width() as f64;
    let row = point("pipeline", share, 1.0 / sine);
    Ok(vec![row.promised(is_twice.then_some(1.0))])
}
