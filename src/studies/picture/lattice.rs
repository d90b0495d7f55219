//! The lattice of a picture: who finds it, how exactly, and what spoils it.

use super::costs::of_costs;
use super::spoilt::Spoilt;
use super::sweeps::{SWEEPS, Sweep};
use super::{RIGHT, analysed, share_off};
use crate::chart::{chart, lines_by};
use crate::readable::mean;
use crate::{Bench, Findings, ReportError, Row, Study};
use selvedge_chart::{Axis, Chart};
use selvedge_foundation::numerics::{Random, median};
use selvedge_textile::picture::{Analysis, Basis, SignificantMaxima};

/// Lattices of pictures that are spoilt in seven ways, by five estimates.
pub(crate) const STUDY: Study = Study {
    name: "lattice",
    chapter: "pictures",
    question: "Which estimate finds the lattice of a picture, and what may be wrong with the \
               picture?",
    reference: "The two vectors that the picture was drawn by, whichever pair spans the same \
                lattice.",
    error: ("lattice error", "px"),
    cost_of: "picture",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    of_estimates(&ESTIMATES, bench)
}

/// An estimate of the lattice from an analysis, by its name.
pub(super) type Estimate = (&'static str, fn(&Analysis) -> Option<Basis>);

/// The estimates that are compared.
pub(super) const ESTIMATES: [Estimate; 5] = [
    ("whole pipeline", |analysis| {
        Some(analysis.found.as_ref().ok()?.lattice.basis())
    }),
    ("whole, before refining", |analysis| {
        let [p1, p2] = analysis.found.as_ref().ok()?.from_maxima;
        Some(Basis::new(p1, p2))
    }),
    ("mean concentration", |analysis| {
        let directions = &analysis.measured.as_ref()?.directions;
        directions.by_concentration.basis
    }),
    ("Hough", |analysis| {
        analysis.measured.as_ref()?.directions.by_hough.basis
    }),
    ("shortest vectors alone", |analysis| {
        shortest(&analysis.measured.as_ref()?.significant)
    }),
];

/// What the whole pipeline keeps within on usual pictures, in the mean, px.
const USUAL_PX: f64 = 0.25;
/// Vectors with a smaller sine of the angle between them are taken as parallel.
const PARALLEL: f64 = 0.2;

/// The nearest maximum that counts, and the nearest in another direction.
pub(super) fn shortest(significant: &SignificantMaxima) -> Option<Basis> {
    let first = significant.all().first()?.place;
    let mut pairs = significant.all().iter().map(|m| Basis::new(first, m.place));
    pairs.find(|pair| pair.sine() >= PARALLEL)
}

/// The study with other estimates.
pub(super) fn of_estimates(
    estimates: &[Estimate],
    bench: &mut Bench<'_>,
) -> Result<Findings, ReportError> {
    let n_px = bench.effort.pick(112, 160);
    let usual = Spoilt::usual(n_px);
    bench.step(0.0, "usual pictures")?;
    let mut rows = of_pictures(estimates, &usual, ("usual", f64::NAN), bench);
    of_costs(&usual, &mut rows, bench);
    let mut plots = Vec::new();
    let n_sweeps = SWEEPS.len() as f64;
    let n_wanted = if bench.wants_errors() {
        SWEEPS.len()
    } else {
        0
    };
    for (done, sweep) in SWEEPS[..n_wanted].iter().enumerate() {
        let [quick, full] = sweep.values;
        let values = bench.effort.pick(quick, full);
        for (n, &value) in values.iter().enumerate() {
            let share = (done as f64 + n as f64 / values.len() as f64) / n_sweeps;
            bench.step(0.05 + 0.95 * share, &format!("{} {value}", sweep.name))?;
            let mut spoilt = usual;
            (sweep.spoil)(&mut spoilt, value);
            rows.extend(of_pictures(estimates, &spoilt, (sweep.name, value), bench));
        }
        plots.push((format!("by-{}", sweep.name), plot(sweep, &rows)));
    }
    let notes = notes(&rows);
    Ok(Findings::new(rows, plots, notes))
}

/// A row for every estimate over several pictures that are spoilt alike.
fn of_pictures(
    estimates: &[Estimate],
    spoilt: &Spoilt,
    (name, value): (&str, f64),
    bench: &Bench<'_>,
) -> Vec<Row> {
    let n_trials = bench.effort.pick(4, 8);
    let random = Random::new(bench.seed);
    let mut tallies = vec![Tally::default(); estimates.len()];
    for number in 0..n_trials {
        let picture = spoilt.picture(number, &random);
        let analysis = analysed(&picture.luminance);
        for ((_, find), tally) in estimates.iter().zip(&mut tallies) {
            let found = analysis.as_ref().and_then(find);
            let off = share_off(&picture.truth, found);
            tally.add(off, off * picture.truth.shorter(), picture.is_weave);
            tally.n_finer += u32::from(found.is_some_and(|b| is_finer(&picture.truth, &b)));
        }
    }
    let case = if value.is_nan() {
        name.to_owned()
    } else {
        format!("{name} {value}").replace('-', "−")
    };
    let pairs = estimates.iter().zip(tallies);
    pairs
        .map(|((name, _), tally)| {
            let is_promised = *name == ESTIMATES[0].0 && value.is_nan();
            let row = tally.row(name, case.clone(), value);
            row.promised(is_promised.then_some(USUAL_PX))
        })
        .collect()
}

/// What an estimate got right and by how much it was off.
#[derive(Debug, Clone, Default)]
struct Tally {
    off_px: Vec<f64>,
    off_of_right_px: Vec<f64>,
    /// Oblique lattices and weaves: how many, how many right.
    n: [u32; 2],
    n_right: [u32; 2],
    n_finer: u32,
}

/// Whether every vector of the truth is one of the found lattice, which has more besides: that of
/// the threads, where the repeats of the weave were asked for.
fn is_finer(truth: &Basis, found: &Basis) -> bool {
    let is_on = |vector: [f64; 2]| {
        let [x, y] = found.place(found.coordinates(vector).map(f64::round));
        (x - vector[0]).hypot(y - vector[1]) < 0.1 * truth.shorter()
    };
    let is_smaller = found.area() > 1.0 && found.area() < 0.7 * truth.area();
    is_smaller && is_on(truth.p1) && is_on(truth.p2)
}

impl Tally {
    fn add(&mut self, off: f64, off_px: f64, is_weave: bool) {
        let kind = usize::from(is_weave);
        self.n[kind] += 1;
        self.off_px.push(off_px);
        if off <= RIGHT {
            self.n_right[kind] += 1;
            self.off_of_right_px.push(off_px);
        }
    }

    fn row(mut self, method: &str, case: String, value: f64) -> Row {
        let percent = |right: u32, of: u32| 100.0 * f64::from(right) / f64::from(of.max(1));
        let n = self.n.iter().sum();
        let value = if value.is_nan() {
            String::new()
        } else {
            value.to_string()
        };
        Row::of(method, format!("{} pictures", self.off_px.len()), case)
            .error(mean(&self.off_px))
            .with("value", value)
            .number("right_percent", 1, percent(self.n_right.iter().sum(), n))
            .number(
                "right_weaves_percent",
                1,
                percent(self.n_right[1], self.n[1]),
            )
            .number(
                "right_oblique_percent",
                1,
                percent(self.n_right[0], self.n[0]),
            )
            .number("finer_percent", 1, percent(self.n_finer, n))
            .number("median_of_right_px", 4, median(&mut self.off_of_right_px))
    }
}

fn plot(sweep: &Sweep, rows: &[Row]) -> Chart {
    let of_sweep = format!("{} ", sweep.name);
    let own = rows.iter().filter(|row| row.case.starts_with(&of_sweep));
    let point = |row: &Row| {
        let cell = |name| row.further_number(name);
        Some([cell("value")?, cell("right_percent")?])
    };
    let x = Axis {
        label: sweep.label.to_owned(),
        scale: sweep.scale,
        range: None,
    };
    chart(
        format!(
            "Lattice: share of pictures that are right, by {}",
            sweep.name
        ),
        x,
        Axis::linear("right, %").within([0.0, 100.0]),
        lines_by(own, |row| &row.method, point),
        format!(
            "Right: within {:.0} % of the shorter vector. Otherwise 6 dB over the noise, any turn, \
             blur 0.7 px, bend 0.3 px, light 1.5 to 1.",
            100.0 * RIGHT
        ),
    )
}

fn notes(rows: &[Row]) -> Vec<String> {
    let mut notes = vec![
        "Three of four pictures show weaves (plain, twills, satin of 5) with threads 7 to 15 px \
         apart, the fourth an oblique lattice of waves. The error is the distance between \
         vectors of one and points of the other lattice, both ways, after reduction; a lattice \
         that is missing or farther off than the shorter vector counts as that vector's length."
            .to_owned(),
        "The directions and the shortest vectors are set beside the pipeline as estimates of \
         their own, neither checked for finer and coarser lattices nor refined: on weaves they \
         tend to find \
         the lattice of the threads (finer_percent), not that of the weave. Costs hold from \
         the picture on, each with the autocorrelation that it needs."
            .to_owned(),
    ];
    let share = |row: &Row| {
        let share = row.further_number("right_percent")?;
        let finer = row.further_number("finer_percent");
        let finer = finer.filter(|finer| *finer > 0.0);
        let finer = finer.map_or_else(String::new, |x| format!(" (a finer one: {x:.0} %)"));
        Some(format!("{} {share:.0} %{finer}", row.method))
    };
    let usual = rows.iter().filter(|row| row.case == "usual");
    let shares: Vec<String> = usual.filter_map(share).collect();
    notes.push(format!("Right on usual pictures: {}.", shares.join(", ")));
    notes
}
