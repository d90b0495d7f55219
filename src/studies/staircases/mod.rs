//! The study of thresholds: how near each way to find one comes, by trials, lapses and slope.

#[cfg(test)]
mod tests;
mod ways;

use selvedge_chart::Axis;
use selvedge_foundation::numerics::{in_pieces, n_threads};
use selvedge_foundation::quantity;

use super::chart::{chart, lines_by};
use super::readable::{mean, rms};
use super::{Bench, Findings, ReportError, Row, Study, Timing};
use ways::{Observer, WAYS, Way, large_quest};

/// Trials after which every way is asked for its threshold.
const CHECKPOINTS: [u32; 5] = [20, 40, 80, 160, 320];

/// Threshold error against trials.
pub(crate) const STUDY: Study = Study {
    name: "staircases",
    chapter: "evidence",
    question: "How near does each way to find a threshold come, after how many trials, if \
               observers lapse or are less steep than assumed?",
    reference: "The simulated observer's own function, at the share right that the way looks \
                for.",
    error: ("rms error of the threshold", "dB"),
    cost_of: "trial",
    run,
};

fn run(bench: &mut Bench<'_>) -> Result<Findings, ReportError> {
    let n_runs = bench.effort.pick(16, 150);
    let n_checkpoints = bench.effort.pick(3, CHECKPOINTS.len());
    let checkpoints = &CHECKPOINTS[..n_checkpoints];
    let observers = Observer::all();
    let mut findings = Findings::default();
    let costs: Vec<Cost> = (WAYS.iter().map(|way| cost(bench, *way))).collect::<Result<_, _>>()?;
    for (number, observer) in observers.iter().enumerate() {
        for (nth, (way, cost)) in WAYS.into_iter().zip(&costs).enumerate() {
            let n_done = number * WAYS.len() + nth;
            let share = n_done as f64 / (observers.len() * WAYS.len()) as f64;
            bench.step(share, way.name)?;
            let n_runs = if bench.wants_errors() { n_runs } else { 1 };
            let errors = errors(way, observer, checkpoints, n_runs, bench.seed);
            for (at, n_trials) in checkpoints.iter().enumerate() {
                let tally = Tally::of(errors.iter().map(|run| run[at]));
                let row = tally.row(way, observer, *n_trials, *cost);
                findings.rows.push(row);
            }
        }
    }
    findings.rows.push(large_grid(bench)?);
    plots(&mut findings, &observers);
    findings.notes.push(notes());
    Ok(findings)
}

fn notes() -> String {
    "Three alternatives; the function of decibels is a Gumbel function 10 dB wide from 5 % to \
     95 %, its threshold anywhere within ±3 dB, staircases start 20 dB above. Reversals estimate \
     the stimulus at which steps balance; fits and QUEST+ the one at which F is ½, freed of \
     guesses and lapses. Runs without enough reversals, or whose answers were all equal, have no \
     threshold and are counted as undefined. A fit costs once a session what is said as \
     estimate."
        .to_owned()
}

/// Errors of one run at every checkpoint, dB; `None` without a threshold.
type Run = Vec<Option<f64>>;

fn errors(way: Way, observer: &Observer, at: &[u32], n_runs: usize, seed: u64) -> Vec<Run> {
    let mut runs: Vec<Run> = vec![Vec::new(); n_runs];
    let all = |(): &mut (), number, piece: &mut [Run]| {
        for run in piece {
            *run = way.errors_db(observer, at, (seed, number));
        }
    };
    in_pieces(&mut runs, 1, n_threads(), || (), all);
    runs
}

/// What the errors of many runs come to.
#[derive(Debug, Clone, Copy)]
struct Tally {
    n_runs: usize,
    n_undefined: usize,
    bias_db: f64,
    rms_db: f64,
}

impl Tally {
    fn of(errors: impl Iterator<Item = Option<f64>>) -> Self {
        let errors: Vec<Option<f64>> = errors.collect();
        let known: Vec<f64> = errors.iter().copied().flatten().collect();
        Self {
            n_runs: errors.len(),
            n_undefined: errors.len() - known.len(),
            bias_db: mean(&known),
            rms_db: rms(&known),
        }
    }

    fn row(&self, way: Way, observer: &Observer, n_trials: u32, [trial, estimate]: Cost) -> Row {
        let n_known = self.n_runs - self.n_undefined;
        let is_known = 2 * n_known > self.n_runs;
        let scatter = (self.rms_db.powi(2) - self.bias_db.powi(2)).max(0.0).sqrt();
        let known = |value: f64| if is_known { value } else { f64::NAN };
        let undefined = format!("{} of {}", self.n_undefined, self.n_runs);
        Row::of(way.name, format!("{n_trials} trials"), observer.name)
            .size(f64::from(n_trials))
            .error(is_known.then_some(self.rms_db))
            .cost(trial)
            .number("bias_db", 3, known(self.bias_db))
            .number("bias_error_db", 3, known(scatter / (n_known as f64).sqrt()))
            .with("undefined", undefined)
            .number("estimate_ms", 4, 1e3 * estimate.cpu_s)
    }
}

/// What a trial costs, and the threshold at the end.
type Cost = [Timing; 2];

/// Eighty trials of one observer, and the threshold that they come to.
fn cost(bench: &Bench<'_>, way: Way) -> Result<Cost, ReportError> {
    let observer = &Observer::all()[0];
    let n_trials = 80;
    let run = || way.run(observer, n_trials, (3, 0));
    let done = run()?;
    let making = || (way.session)((3, 0), n_trials).is_ok();
    let trial = bench.time_beyond(n_trials as usize, || run().is_ok(), making);
    let estimate = bench.time_repeated(3, 1, || way.threshold_db(&done).is_ok());
    Ok([trial, estimate])
}

/// QUEST+ on as large a grid as anybody asks for: cost alone.
fn large_grid(bench: &Bench<'_>) -> Result<Row, ReportError> {
    let fresh = large_quest()?;
    let observer = &Observer::all()[0];
    let n_trials = 4;
    let cost = bench.time_repeated(bench.effort.pick(1, 5), n_trials, || {
        let mut quest = fresh.clone();
        ways::answer(&mut quest, observer, 0.0, (n_trials, 3)).is_ok()
    });
    let setting = "100 stimuli × 50 thresholds × 50 widths × 6 lapse rates";
    Ok(Row::of("QUEST+, large grid", setting, "cost alone").cost(cost))
}

/// Error and bias over trials, a plot of each for every observer.
fn plots(findings: &mut Findings, observers: &[Observer]) {
    let files = ["steady", "lapses", "shallow", "shallow-lapses"];
    for (file, observer) in files.iter().zip(observers) {
        let kinds = [
            ("error", Axis::log("rms error, dB"), rms_db as Value),
            ("bias", Axis::linear("mean error, dB"), bias_db),
        ];
        for (kind, axis, value) in kinds {
            let of_observer = findings.rows.iter().filter(|row| row.case == observer.name);
            let point = |row: &Row| Some([row.size?, value(row)?]);
            let plot = chart(
                format!("Staircases: {kind} of the threshold over trials"),
                Axis::log("trials"),
                axis,
                lines_by(of_observer, |row| &row.method, point),
                format!("{}. Numbers: staircases.csv.", observer.name),
            );
            let name = format!("staircases-{kind}-{file}");
            findings.plots.push((name, plot));
        }
    }
    let least = |observer| least(&findings.rows, observer);
    let notes: Vec<String> = observers.iter().filter_map(least).collect();
    findings.notes.extend(notes);
}

/// What of a row is drawn.
type Value = fn(&Row) -> Option<f64>;

fn rms_db(row: &Row) -> Option<f64> {
    row.error
}

fn bias_db(row: &Row) -> Option<f64> {
    row.further_number("bias_db")
}

/// Which way came nearest after eighty trials.
fn least(rows: &[Row], observer: &Observer) -> Option<String> {
    let of_observer = rows.iter().filter(|row| row.case == observer.name);
    let at_eighty = of_observer.filter(|row| row.setting == "80 trials");
    let (error_db, way) = at_eighty
        .filter_map(|row| Some((row.error?, &row.method)))
        .min_by(|a, b| a.0.total_cmp(&b.0))?;
    let error_db = quantity::fixed(error_db, 2);
    Some(format!(
        "{}: least error after 80 trials {error_db} dB, {way}.",
        observer.name
    ))
}
