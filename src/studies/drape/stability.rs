//! What every integrator holds, by stiffness, weight, step and what is done: all of it comes out
//! finite and without more energy than was given, or is refused with the limit.

use super::{Sample, drift, left_j, pinch};
use crate::chart::chart;
use crate::{Bench, Findings, ReportError, Row, Study};
use selvedge_chart::{Axis, Chart, Ink, Series, Style};
use selvedge_drape::{Drape, Hand, Integrator};

/// The map of stability.
pub(crate) const STABILITY: Study = Study {
    name: "drape-stability",
    chapter: "cloth",
    question: "Which stiffness, weight and step does each way of stepping a cloth hold?",
    reference: "The energy at the start and the hands' work: no more is to be there.",
    error: ("energy from nowhere", "of what was there or put in"),
    cost_of: "step",
    run,
};

/// What may come from nowhere, as part of weight times length, of what was there and of what
/// hands had put in.
pub(super) const MOST_GAINED: f64 = 0.01;
/// How far pads come to be past each other where the pulp of both yields and the cloth holds, mm:
/// without it they would be 20 mm.
const MOST_PASSED_MM: f64 = 16.0;
/// Steps of a case.
const N_STEPS: usize = 25;
/// Ways of stepping; those for pictures promise nothing but numbers.
const WAYS: [(Integrator, bool); 5] = [
    (Integrator::Explicit, true),
    (Integrator::ImplicitEuler, true),
    (Integrator::Bdf2, true),
    (Integrator::Xpbd, false),
    (Integrator::Projective, false),
];

/// What is done with a cloth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Deed {
    Swing,
    Fall,
    PadsCross,
    NoNumber,
    FarTarget,
    Stiffens,
    Smallest,
    Torn,
}

impl Deed {
    pub(crate) const ALL: [Self; 8] = [
        Self::Swing,
        Self::Fall,
        Self::PadsCross,
        Self::NoNumber,
        Self::FarTarget,
        Self::Stiffens,
        Self::Smallest,
        Self::Torn,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::Swing => "swing",
            Self::Fall => "drape",
            Self::PadsCross => "pads cross",
            Self::NoNumber => "a hand that is no number",
            Self::FarTarget => "a hand 1e9 mm away",
            Self::Stiffens => "ten times stiffer at once",
            Self::Smallest => "2 × 2 grid",
            Self::Torn => "corners three times as far apart",
        }
    }

    pub(crate) fn sample(self) -> Sample {
        Sample {
            n: if self == Self::Smallest { 2 } else { 8 },
            pins: match self {
                Self::Fall | Self::Torn => "corners",
                _ => "top",
            },
            n_fingers: match self {
                Self::PadsCross | Self::NoNumber | Self::FarTarget => 2,
                _ => 0,
            },
            ..Sample::SHIRTING
        }
    }

    /// The cloth as it begins: softer where it is to stiffen, but not beyond what files may say.
    fn start(self, sample: Sample) -> Sample {
        let softer = sample.stiffness_n_per_m.map(|k| (0.1 * k).max(2.0));
        Sample {
            stiffness_n_per_m: softer
                .filter(|_| self == Self::Stiffens)
                .or(sample.stiffness_n_per_m),
            ..sample
        }
    }

    fn hands(self) -> [Hand; 2] {
        match self {
            Self::NoNumber => pinch([100.0, 80.0, f64::NAN], 20.0),
            Self::FarTarget => pinch([1e9, 80.0, 0.0], 20.0),
            // Past each other by 20 mm.
            _ => pinch([100.0, 80.0, 0.0], -20.0),
        }
    }
}

/// What became of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Standing {
    Held,
    OutOfBudget,
    Refused,
}

impl Standing {
    const ALL: [Self; 3] = [Self::Held, Self::OutOfBudget, Self::Refused];

    fn word(self) -> &'static str {
        match self {
            Self::Held => "held",
            Self::OutOfBudget => "held, not solved within budget",
            Self::Refused => "refused",
        }
    }
}

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let stiffnesses = bench
        .effort
        .pick(&[1e1, 1e4, 1e6][..], &[1e1, 1e2, 1e3, 1e4, 1e5, 1e6]);
    let densities = bench.effort.pick(&[0.02, 1.0][..], &[0.02, 0.1, 0.3, 1.0]);
    let steps_ms = bench.effort.pick(
        &[0.1, 4.0, 50.0][..],
        &[0.1, 0.3, 1.0, 2.0, 4.0, 10.0, 20.0, 50.0],
    );
    let (mut rows, mut counts) = (Vec::new(), [0_usize; 3]);
    let mut maps = vec![Vec::new(); WAYS.len()];
    for (nth, deed) in Deed::ALL.into_iter().enumerate() {
        bench.step(nth as f64 / Deed::ALL.len() as f64, deed.name())?;
        for (way, map) in WAYS.into_iter().zip(&mut maps) {
            for (k, rho, ms) in grid(stiffnesses, densities, steps_ms) {
                let sample = Sample {
                    stiffness_n_per_m: Some(k),
                    density_kg_per_m2: rho,
                    ..deed.sample()
                };
                let (row, standing) = case((deed, sample, 80.0), way, ms)?;
                counts[standing as usize] += 1;
                // Losses on one weight only: what they could break is the same.
                if way.1 && rho >= densities[densities.len() - 1] {
                    let lossy = Sample {
                        is_lossy: true,
                        ..sample
                    };
                    let (row, standing) = case((deed, lossy, 80.0), way, ms)?;
                    counts[standing as usize] += 1;
                    rows.push(row);
                }
                if deed == Deed::Swing && rho <= densities[0] {
                    map.push((standing, [ms, k]));
                }
                rows.push(row);
            }
        }
    }
    bench.step(1.0, "drift")?;
    rows.extend(drift::rows(bench.effort)?);
    let n_lost = rows.iter().filter(|row| row.error.is_none()).count();
    let counted = Standing::ALL.map(|one| format!("{} {}", counts[one as usize], one.word()));
    let note = format!(
        "{} cases: {}; {n_lost} end in no numbers, beyond the cloth, or in a refusal without its \
         limit.",
        rows.len(),
        counted.join(", ")
    );
    let plots = WAYS.into_iter().zip(&maps).map(|((integrator, _), map)| {
        let name = integrator.name();
        (
            format!("drape-stability-{name}"),
            picture(name, map, densities[0]),
        )
    });
    Ok(Findings::new(rows, plots.collect(), [note]))
}

fn grid<'a>(
    stiffnesses: &'a [f64],
    densities: &'a [f64],
    steps_ms: &'a [f64],
) -> impl Iterator<Item = (f64, f64, f64)> + 'a {
    stiffnesses.iter().flat_map(move |k| {
        let of_rho = move |rho: &'a f64| steps_ms.iter().map(move |ms| (*k, *rho, *ms));
        densities.iter().flat_map(of_rho)
    })
}

/// The energy from nowhere of a case that begins at a tilt, as a share of what is allowed; 0 of one
/// that is refused in good order, and no number of one that comes out as none.
pub(crate) fn held(
    begun: (Deed, Sample, f64),
    way: (Integrator, bool),
    step_ms: f64,
) -> Result<f64, ReportError> {
    let (row, standing) = case(begun, way, step_ms)?;
    Ok(match (row.error, standing) {
        (Some(_), Standing::Refused) => 0.0,
        (Some(gained), _) => gained / MOST_GAINED,
        (None, _) => f64::NAN,
    })
}

/// Steps a case to its end; its row, and what became of it.
fn case(
    (deed, sample, tilt_deg): (Deed, Sample, f64),
    (integrator, promises): (Integrator, bool),
    step_ms: f64,
) -> Result<(Row, Standing), ReportError> {
    let [k, rho] = [
        sample.stiffness_n_per_m.unwrap_or_default(),
        sample.density_kg_per_m2,
    ];
    let losses = if sample.is_lossy {
        ", air and hysteresis"
    } else {
        ""
    };
    let what = format!("{}, K {k:e} N/m, {rho} kg/m²{losses}", deed.name());
    let row = Row::of(integrator.name(), format!("{step_ms} ms"), what);
    let stepped = (integrator, Some(1e-3 * step_ms));
    let mut drape = deed.start(sample).drape(tilt_deg, stepped)?;
    if deed == Deed::Torn {
        drape.pull(3.0);
    }
    let mut start_j = left_j(&mut drape);
    let hands = deed.hands();
    let (mut gained, mut put_in_j) = (0.0_f64, 0.0_f64);
    for nth in 0..N_STEPS {
        if deed == Deed::Stiffens && nth == N_STEPS / 2 {
            drape.refit(&sample.scene(stepped)?)?;
            start_j = left_j(&mut drape);
        }
        if let Err(refused) = drape.step(&hands[..sample.n_fingers]) {
            // Nothing has moved; what comes back names the limit.
            let limit = format!("at most {:.3} ms", 1e3 * drape.limit_s());
            let is_told = refused.to_string().contains(&limit);
            let row = row
                .error(is_told.then_some(0.0))
                .promised(0.0)
                .with("standing", Standing::Refused.word());
            return Ok((row.with("came_back", refused), Standing::Refused));
        }
        put_in_j = put_in_j.max(drape.energy_j()[1]);
        let scale_j = drape.scale_j() + start_j.abs() + put_in_j;
        gained = gained.max((left_j(&mut drape) - start_j) / scale_j);
    }
    let standing = if drape.counters().unconverged > 0 {
        Standing::OutOfBudget
    } else {
        Standing::Held
    };
    let is_finite = drape.places_mm().flatten().all(f64::is_finite);
    let is_through = promises && deed == Deed::PadsCross && passed_mm(&drape) > MOST_PASSED_MM;
    let word = match () {
        () if !is_finite => "no numbers",
        () if is_through => "through the cloth",
        () => standing.word(),
    };
    let is_whole = is_finite && !is_through;
    let row = row
        .error(is_whole.then_some(gained))
        .promised((promises || !is_whole).then_some(MOST_GAINED))
        .with("standing", word)
        .with("unconverged", drape.counters().unconverged);
    Ok((
        row.with("targets_held", drape.counters().targets_held),
        standing,
    ))
}

/// How far the first pad is behind the second, mm.
fn passed_mm(drape: &Drape) -> f64 {
    let tips: Vec<f64> = drape.pads().map(|pad| pad.tip_mm[2]).collect();
    tips[1] - tips[0]
}

/// Stiffness over step, by what became of it.
fn picture(name: &str, map: &[(Standing, [f64; 2])], density: f64) -> Chart {
    let series = Standing::ALL.map(|standing| {
        let points = map
            .iter()
            .filter(|(is, _)| *is == standing)
            .map(|(_, at)| *at);
        let ink = [Ink::Violet, Ink::Grey, Ink::Rose][standing as usize];
        Series {
            ink,
            ..Series::of(standing.word(), Style::Dots, points)
        }
    });
    let is_there = |series: &Series| !series.points.is_empty();
    chart(
        format!("What {name} holds"),
        Axis::log("step, ms"),
        Axis::log("stiffness of the yarns, N/m"),
        series.into_iter().filter(is_there).collect(),
        format!("A cloth of {density} kg/m² and 8 × 8 vertices, 29 mm apart, let go at 80°."),
    )
}
