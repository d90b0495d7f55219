//! Ranking against a target (Philpott & Summers 2012): identification with a virtual and with a
//! real target, and how it changes with what is assumed.

use super::comparison::{
    DesignWithStimuli, Kind, Options, Replication, Spread, by_levels, guessing, practised,
    printed_line,
};
use super::printed;
use super::studies::{Studies, Subjects, percent_right};
use crate::ExperimentError;
use crate::analysis::{Section, Table, cells, scatter};
use crate::observer::{Observer, Strategy, Weighting};
use selvedge_chart::{Axis, Chart, Series, Style};
use selvedge_foundation::progress::{Progress, unheard};
use selvedge_foundation::quantity::fixed;
use selvedge_statistics::{Computed, Summary, Undefined};

/// Looks that exploring is taken to be worth, from one to more than anybody would assume.
const LOOKS: [u32; 7] = [1, 2, 3, 4, 6, 8, 12];
/// Differences between real and virtual cloth, standard deviation in dB.
const ERRORS_DB: [f64; 7] = [0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0];
/// A difference between real and virtual cloth that is compared with the paper: of the size of
/// just noticeable differences.
const MODEL_ERROR_DB: f64 = 3.0;

pub(super) const VIRTUAL: &str = "Philpott & Summers 2012, experiment 2";
pub(super) const REAL: &str = "Philpott & Summers 2012, experiment 1";

/// Both experiments.
pub(super) struct Rankings<'a> {
    pub(super) real: &'a DesignWithStimuli,
    pub(super) virtually: &'a DesignWithStimuli,
    pub(super) options: &'a Options,
}

/// What one study found: the mean of its subjects and the SE of that, %.
type Found = (f64, f64);

fn found(subjects: &Subjects) -> Found {
    let percents: Vec<f64> = subjects.iter().map(|rows| percent_right(rows)).collect();
    match Summary::of(&percents) {
        Ok(summary) => (summary.mean, summary.se),
        Err(_) => (f64::NAN, f64::NAN),
    }
}

/// A point of a sweep.
struct Swept {
    observer: &'static str,
    at: f64,
    spread: Spread,
}

impl Rankings<'_> {
    fn studies(
        &self,
        laid: &DesignWithStimuli,
        observer: Observer,
        (n, doing): (usize, &str),
        progress: &mut Progress<'_>,
    ) -> Result<Vec<Found>, ExperimentError> {
        let studies = Studies::of(laid, observer, 1, self.options);
        studies.each((n, doing), progress, found)
    }

    /// Comparisons, sweeps, and what it would take.
    ///
    /// # Errors
    /// A study cannot be held, or it was cancelled.
    pub(super) fn section(
        &self,
        all: &mut Replication,
        progress: &mut Progress<'_>,
    ) -> Result<Section, ExperimentError> {
        let title = "Ranking against a target, and what is assumed";
        let mut section = Section::new("ranking", title);
        self.compare(all, progress)?;
        let looks = self.over_looks(progress)?;
        let title = "A virtual target, over looks";
        section.table(table("looks", ("looks", "looks"), title, &looks));
        let nearest = nearest_looks(&looks);
        let errors = self.over_errors(nearest, progress)?;
        let title = "A real target, over the error of the model";
        let at = ("error_db", "real against virtual, sd in dB");
        section.table(table("model-error", at, title, &errors));
        let drawn = [looks_plot(&looks), errors_plot(&errors)];
        for (name, plot) in drawn {
            let axes = [plot.x.clone(), plot.y.clone()];
            let key = format!("{name}-curves");
            section.figure(scatter(&key, &plot.title, axes, plot.series.clone()));
            all.sweeps.push((format!("replication-{name}"), plot));
        }
        section.note(
            "Published differences are those of one look at a steady vibration. How many looks \
             exploring a textile is worth is not published, so it is swept, not chosen; so is the \
             difference between a real cloth and its model.",
        );
        section.note(what_it_takes(nearest, &errors));
        Ok(section)
    }

    /// What is compared with what was printed.
    fn cases(&self) -> [(&'static str, &DesignWithStimuli, Kind, printed::Share); 5] {
        let with_error = |mut kind: Kind, assumed: &'static str| {
            kind.assumed = assumed;
            kind.observer.real_error_db = MODEL_ERROR_DB;
            kind
        };
        let differs = "real and virtual cloth differ by 3 dB in each band (sd)";
        let both = "cues beyond levels have the noise of levels; real and virtual differ by 3 dB";
        let (by_levels, practised) = (by_levels(), practised());
        let real = with_error(by_levels, differs);
        let real_practised = with_error(practised, both);
        [
            (VIRTUAL, self.virtually, by_levels, printed::VIRTUAL),
            (
                VIRTUAL,
                self.virtually,
                practised,
                printed::VIRTUAL_PRACTISED,
            ),
            (VIRTUAL, self.virtually, guessing(), printed::CHANCE),
            (REAL, self.real, real, printed::REAL),
            (REAL, self.real, real_practised, printed::REAL_PRACTISED),
        ]
    }

    fn compare(
        &self,
        all: &mut Replication,
        progress: &mut Progress<'_>,
    ) -> Result<(), ExperimentError> {
        let cases = self.cases();
        for (nth, (paper, laid, kind, printed)) in cases.into_iter().enumerate() {
            let n = self.options.n_studies;
            let part = [0.08 * nth as f64, 0.08 * (nth + 1) as f64];
            let found = progress.within(part, |part| {
                self.studies(laid, kind.observer, (n, paper), part)
            })?;
            let is_printed = kind.observer.strategy != Strategy::None;
            let shown = is_printed.then_some(printed.percent);
            let means: Vec<f64> = found.iter().map(|study| study.0).collect();
            all.add((paper, &kind), (printed.quantity, shown), &means);
            if printed.se.is_some() {
                let errors: Vec<f64> = found.iter().map(|study| study.1).collect();
                let quantity = "its standard error over subjects, %";
                all.add((paper, &kind), (quantity, printed.se), &errors);
            }
        }
        Ok(())
    }

    fn swept(
        &self,
        laid: &DesignWithStimuli,
        observer: Observer,
    ) -> Result<Vec<Found>, ExperimentError> {
        let n = self.options.n_swept;
        unheard(|progress| self.studies(laid, observer, (n, ""), progress))
    }

    fn over_looks(&self, progress: &mut Progress<'_>) -> Result<Vec<Swept>, ExperimentError> {
        let kinds = [
            ("levels", Strategy::LevelOnly, Weighting::Equal),
            ("all cues alike", Strategy::All, Weighting::Equal),
            ("all cues by their worth", Strategy::All, Weighting::Learnt),
        ];
        let mut swept = Vec::new();
        for (nth, (observer, strategy, weighting)) in kinds.into_iter().enumerate() {
            for (at, looks) in LOOKS.into_iter().enumerate() {
                let how = Observer {
                    strategy,
                    weighting,
                    looks,
                    ..Observer::default()
                };
                let part = (nth * LOOKS.len() + at) as f64 / (3 * LOOKS.len()) as f64;
                progress.step(0.4 + 0.35 * part, "looks")?;
                let found = self.swept(self.virtually, how)?;
                push(&mut swept, observer, f64::from(looks), &found);
            }
        }
        Ok(swept)
    }

    /// With one look, and with as many as experiment 2 would take.
    fn over_errors(
        &self,
        nearest: u32,
        progress: &mut Progress<'_>,
    ) -> Result<Vec<Swept>, ExperimentError> {
        let mut swept = Vec::new();
        let kinds = [("one look", 1), (AS_FITTED, nearest)];
        for (nth, (observer, looks)) in kinds.into_iter().enumerate() {
            for (at, real_error_db) in ERRORS_DB.into_iter().enumerate() {
                let how = Observer {
                    looks,
                    real_error_db,
                    ..Observer::default()
                };
                let part = (nth * ERRORS_DB.len() + at) as f64 / (2 * ERRORS_DB.len()) as f64;
                progress.step(0.75 + 0.25 * part, "error of the model")?;
                let found = self.swept(self.real, how)?;
                push(&mut swept, observer, real_error_db, &found);
            }
        }
        Ok(swept)
    }
}

const AS_FITTED: &str = "as many as experiment 2 takes";

fn push(swept: &mut Vec<Swept>, observer: &'static str, at: f64, found: &[Found]) {
    let means: Vec<f64> = found.iter().map(|study| study.0).collect();
    if let Ok(spread) = Spread::of(&means) {
        swept.push(Swept {
            observer,
            at,
            spread,
        });
    }
}

/// The looks with which levels alone come nearest to what experiment 2 printed.
fn nearest_looks(swept: &[Swept]) -> u32 {
    let away = |one: &Swept| (one.spread.mean - printed::VIRTUAL.percent).abs();
    let own = swept.iter().filter(|one| one.observer == "levels");
    let nearest = own.min_by(|a, b| away(a).total_cmp(&away(b)));
    let at = nearest.map_or(1.0, |one| one.at);
    let is_it = |looks: &u32| (f64::from(*looks) - at).abs() < 0.5;
    LOOKS.into_iter().find(is_it).unwrap_or(1)
}

/// What would have to be so for the printed numbers to come out: a fit, and called one.
fn what_it_takes(nearest: u32, errors: &[Swept]) -> String {
    let own: Vec<[f64; 2]> = errors
        .iter()
        .filter(|one| one.observer == AS_FITTED)
        .map(|one| [one.at, one.spread.mean])
        .collect();
    let error = crossing(&own, printed::REAL.percent);
    let described = match error {
        Ok(db) => format!(
            "then a difference of {} dB between real and virtual cloth gives experiment 1's {} %",
            fixed(db, 1),
            fixed(printed::REAL.percent, 1)
        ),
        Err(_) => format!(
            "then no difference of {} dB or less between real and virtual cloth gives experiment \
             1's {} %",
            fixed(ERRORS_DB[ERRORS_DB.len() - 1], 0),
            fixed(printed::REAL.percent, 1)
        ),
    };
    format!(
        "**What it would take, a fit and no replication**: experiment 2's {} % come nearest with \
         {nearest} looks and levels alone; {described}.",
        fixed(printed::VIRTUAL.percent, 1)
    )
}

/// Where a falling curve first crosses a value, between its points in a straight line.
pub(super) fn crossing(points: &[[f64; 2]], value: f64) -> Computed {
    let crosses = |pair: &&[[f64; 2]]| pair[0][1] >= value && pair[1][1] < value;
    let pair = points
        .windows(2)
        .find(crosses)
        .ok_or_else(|| Undefined::because("the curve does not cross the value"))?;
    let [[x0, y0], [x1, y1]] = [pair[0], pair[1]];
    Ok(x0 + (x1 - x0) * (y0 - value) / (y0 - y1))
}

fn table(key: &str, (at, heading): (&str, &str), title: &str, swept: &[Swept]) -> Table {
    let columns = [
        ("observer", "observer"),
        (at, heading),
        ("percent", "target first, %"),
        ("se", "SE"),
        ("low", "95 of 100 studies from"),
        ("high", "to"),
        ("studies", "studies"),
    ];
    let mut table = Table::new(key, title, &columns);
    for one in swept {
        let Spread {
            n,
            mean,
            se,
            low,
            high,
        } = one.spread;
        table.push(cells![one.observer, one.at, mean, se, low, high, n]);
    }
    table
}

fn looks_plot(swept: &[Swept]) -> (String, Chart) {
    let ends = [1.0, f64::from(LOOKS[LOOKS.len() - 1])];
    let practised = printed::VIRTUAL_PRACTISED.percent;
    let mut series = lines(swept);
    series.extend([
        printed_line("printed: 64.1 %", printed::VIRTUAL.percent, ends),
        printed_line("printed, practised: 91 %", practised, ends),
        printed_line("chance", printed::CHANCE.percent, ends),
    ]);
    let title = "A virtual target: identification over looks";
    let x = Axis::log("looks that exploring is worth");
    ("looks".to_owned(), plot(title, x, series))
}

fn errors_plot(swept: &[Swept]) -> (String, Chart) {
    let ends = [0.0, ERRORS_DB[ERRORS_DB.len() - 1]];
    let mut series = lines(swept);
    series.extend([
        printed_line("printed: 41.3 %", printed::REAL.percent, ends),
        printed_line("chance", printed::CHANCE.percent, ends),
    ]);
    let title = "A real target: identification over the error of the model";
    let x = Axis::linear("real against virtual cloth, sd in dB");
    ("model-error".to_owned(), plot(title, x, series))
}

fn plot(title: &str, x: Axis, series: Vec<Series>) -> Chart {
    Chart {
        title: title.to_owned(),
        x,
        y: Axis::linear("target ranked first, %").within([0.0, 100.0]),
        series,
        ..Chart::default()
    }
}

fn lines(swept: &[Swept]) -> Vec<Series> {
    let mut names: Vec<&str> = swept.iter().map(|one| one.observer).collect();
    names.dedup();
    let line = |name: &str| {
        let own = swept.iter().filter(|one| one.observer == name);
        let points = own.map(|one| [one.at, one.spread.mean]);
        Series::of(name, Style::LineAndDots, points)
    };
    names.into_iter().map(line).collect()
}
