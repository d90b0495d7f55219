//! Ranking against a target (Philpott & Summers 2012): identification with a virtual and with a
//! real target, and how it changes with what is assumed.

use super::comparison::{
    DesignWithStimuli, Kind, Options, Replication, Spread, by_levels, guessing, practised,
    printed_line,
};
use super::printed;
use super::studies::{Case, Subjects, each_study, percents_right};
use crate::ExperimentError;
use crate::analysis::{Drawn, Section, Table, cells, scatter};
use crate::observer::{Observer, Strategy, Weighting};
use selvedge_chart::{Axis, Series, Style};
use selvedge_foundation::progress::Progress;
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

fn found(subjects: &Subjects, _laid: &DesignWithStimuli) -> Found {
    match Summary::of(&percents_right(subjects)) {
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
        progress.within([0.0, 0.4], |part| self.compare(all, part))?;
        let looks = progress.within([0.4, 0.75], |part| self.over_looks(part))?;
        let title = "A virtual target, over looks";
        section.table(table("looks", ("looks", "looks"), title, &looks));
        let nearest = nearest_looks(&looks);
        let errors = progress.within([0.75, 1.0], |part| self.over_errors(nearest, part))?;
        let title = "A real target, over the error of the model";
        let at = ("error_db", "real against virtual, sd in dB");
        section.table(table("model-error", at, title, &errors));
        section.figure(looks_plot(&looks));
        section.figure(errors_plot(&errors));
        section.note(
            "Published differences are those of one look at a steady vibration. How many looks \
             exploring a textile is worth is not published, so it is swept, not chosen; so is the \
             difference between a real cloth and its model.",
        );
        section.note(what_it_takes(nearest, &errors));
        Ok(section)
    }

    /// What is compared with what was printed.
    fn cases(&self) -> [(&'static str, Case<'_>, printed::Share); 5] {
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
        let virtually = |kind, printed| (VIRTUAL, (self.virtually, kind), printed);
        [
            virtually(by_levels, printed::VIRTUAL),
            virtually(practised, printed::VIRTUAL_PRACTISED),
            virtually(guessing(), printed::CHANCE),
            (REAL, (self.real, real), printed::REAL),
            (REAL, (self.real, real_practised), printed::REAL_PRACTISED),
        ]
    }

    fn compare(
        &self,
        all: &mut Replication,
        progress: &mut Progress<'_>,
    ) -> Result<(), ExperimentError> {
        let cases = self.cases();
        let held = cases.each_ref().map(|(_, case, _)| *case);
        let found = each_study(&held, "rankings", self.options, progress, found)?;
        for ((paper, (_, kind), printed), found) in cases.iter().zip(&found) {
            let is_printed = kind.observer.strategy != Strategy::None;
            let shown = is_printed.then_some(printed.percent);
            let means: Vec<f64> = found.iter().map(|study| study.0).collect();
            all.add((paper, kind), (printed.quantity, shown), &means);
            if printed.se.is_some() {
                let errors: Vec<f64> = found.iter().map(|study| study.1).collect();
                let quantity = "its standard error over subjects, %";
                all.add((paper, kind), (quantity, printed.se), &errors);
            }
        }
        Ok(())
    }

    /// Observers by name and by where they stand in a sweep, in studies of a design.
    fn swept(
        &self,
        laid: &DesignWithStimuli,
        (observers, doing): (&[(&'static str, f64, Observer)], &str),
        progress: &mut Progress<'_>,
    ) -> Result<Vec<Swept>, ExperimentError> {
        let case = |(_, _, observer): &(&'static str, f64, Observer)| {
            let kind = Kind {
                observer: *observer,
                ..by_levels()
            };
            (laid, kind)
        };
        let cases: Vec<Case<'_>> = observers.iter().map(case).collect();
        let found = each_study(&cases, doing, self.options, progress, found)?;
        let swept = observers
            .iter()
            .zip(found)
            .filter_map(|((observer, at, _), found)| {
                let means: Vec<f64> = found.iter().map(|study| study.0).collect();
                Some(Swept {
                    observer,
                    at: *at,
                    spread: Spread::of(&means).ok()?,
                })
            });
        Ok(swept.collect())
    }

    fn over_looks(&self, progress: &mut Progress<'_>) -> Result<Vec<Swept>, ExperimentError> {
        let kinds = [
            ("levels", Strategy::LevelOnly, Weighting::Equal),
            ("all cues alike", Strategy::All, Weighting::Equal),
            ("all cues by their worth", Strategy::All, Weighting::Learnt),
        ];
        let looking = |(name, strategy, weighting), looks: u32| {
            let observer = Observer {
                strategy,
                weighting,
                looks,
                ..Observer::default()
            };
            (name, f64::from(looks), observer)
        };
        let observers: Vec<_> = kinds
            .into_iter()
            .flat_map(|kind| LOOKS.map(|looks| looking(kind, looks)))
            .collect();
        self.swept(self.virtually, (&observers, "looks"), progress)
    }

    /// With one look, and with as many as experiment 2 would take.
    fn over_errors(
        &self,
        nearest: u32,
        progress: &mut Progress<'_>,
    ) -> Result<Vec<Swept>, ExperimentError> {
        let observer = |(name, looks), real_error_db: f64| {
            let observer = Observer {
                looks,
                real_error_db,
                ..Observer::default()
            };
            (name, real_error_db, observer)
        };
        let kinds = [("one look", 1), (AS_FITTED, nearest)];
        let observers: Vec<_> = kinds
            .into_iter()
            .flat_map(|kind| ERRORS_DB.map(|error_db| observer(kind, error_db)))
            .collect();
        self.swept(self.real, (&observers, "error of the model"), progress)
    }
}

const AS_FITTED: &str = "as many as experiment 2 takes";

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
    let columns = format!(
        "observer; {at}: {heading}; percent: target first, %; se: SE; low: 95 of 100 studies \
         from; high: to; studies"
    );
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

fn looks_plot(swept: &[Swept]) -> Drawn {
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
    scatter("looks-curves", title, [x, percent()], series)
}

fn errors_plot(swept: &[Swept]) -> Drawn {
    let ends = [0.0, ERRORS_DB[ERRORS_DB.len() - 1]];
    let mut series = lines(swept);
    series.extend([
        printed_line("printed: 41.3 %", printed::REAL.percent, ends),
        printed_line("chance", printed::CHANCE.percent, ends),
    ]);
    let title = "A real target: identification over the error of the model";
    let x = Axis::linear("real against virtual cloth, sd in dB");
    scatter("model-error-curves", title, [x, percent()], series)
}

fn percent() -> Axis {
    Axis::linear("target ranked first, %").within([0.0, 100.0])
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
