//! The charts of the pane and their numbers: how accurate rendering was found to be, what ticks
//! cost, and every method on the scene.

use crate::bench::export::Exported;
use crate::bench::export::ink;
use crate::bench::export::origin::Origin;
use crate::bench::rendering::Rendering;
use crate::tools::accuracy::checker::{ERRORS_DB, ErrorView, ROUNDING_DB, edges_db};
use crate::tools::accuracy::measuring::Measured;
use crate::tools::accuracy::sampling::{Accuracy, CostView};
use selvedge_chart::{
    At, Axis, Bars, Chart, Columns, Extent, Ink, Row, Rule, Series, Style, Tone, Weight, Words,
};
use selvedge_foundation::quantity;
use selvedge_studies::Row as Method;
use selvedge_textile::tactile::Band;

/// The axis of the errors of methods, dB. Smaller ones, and none at all, stand at its left end.
const METHOD_ERRORS_DB: [f64; 2] = [1e-8, 100.0];

/// One bin of a histogram, or one method.
#[derive(Default)]
struct Found {
    of: &'static str,
    name: String,
    ends: [f64; 2],
    unit: &'static str,
    count: f64,
    cost_s: f64,
    error_db: f64,
}

/// Both histograms of the pane, and the methods if they were measured.
pub(crate) fn exported(accuracy: &Accuracy, rendering: Rendering, origin: Origin) -> Exported {
    let (errors_found, cost) = (accuracy.found(), accuracy.cost());
    let found: Vec<Found> = errors(errors_found)
        .chain(costs(&cost))
        .chain(accuracy.measured.iter().flat_map(methods))
        .collect();
    let mut panels = vec![error_chart(accuracy, rendering), cost_chart(&cost)];
    panels.extend(accuracy.measured.as_ref().map(method_chart));
    let row = Row {
        panels,
        height_px: 340.0,
        bar: None,
    };
    let n_ticks = errors_found.n_ticks;
    let checked = quantity::with_unit(n_ticks as f64, 0, "ticks");
    let late = format!("{} late, {} missed", cost.late, cost.missed);
    let origin = origin
        .and("ticks_checked", &n_ticks.to_string(), &checked)
        .and("deadlines", &late, &late);
    let note = "Level errors against reference (f64, every bin) in the normative measure; wall \
                time of every tick; methods by CPU time.";
    let title = "Accuracy and cost of rendering".to_owned();
    Exported::new(title, columns(&found), vec![row], note, origin)
}

fn errors(found: &ErrorView) -> impl Iterator<Item = Found> + '_ {
    let edges = edges_db();
    Band::ALL.into_iter().flat_map(move |band| {
        let counts = found.counts[band.index()].iter();
        let bins: Vec<Found> = edges
            .windows(2)
            .zip(counts)
            .map(|(ends, count)| Found {
                of: "level error",
                name: name_of(band),
                ends: [ends[0], ends[1]],
                unit: "dB",
                count: *count as f64,
                ..Found::default()
            })
            .collect();
        bins
    })
}

fn costs(cost: &CostView) -> impl Iterator<Item = Found> + '_ {
    cost.costs.buckets().map(|bucket| Found {
        of: "time a tick",
        ends: [bucket.from.as_secs_f64(), bucket.to.as_secs_f64()],
        unit: "s",
        count: f64::from(bucket.count),
        ..Found::default()
    })
}

fn methods(measured: &Measured) -> impl Iterator<Item = Found> + '_ {
    measured.rows.iter().filter_map(|row| {
        Some(Found {
            of: "method",
            name: format!("{} {}", row.method, row.setting).trim().to_owned(),
            cost_s: row.cost?.cpu_s,
            error_db: row.error?,
            ends: [f64::NAN; 2],
            count: f64::NAN,
            ..Found::default()
        })
    })
}

fn name_of(band: Band) -> String {
    format!("{} Hz", quantity::fixed(band.carrier_hz(), 0))
}

fn columns(found: &[Found]) -> Columns {
    let words = |of: &dyn Fn(&Found) -> String| -> Vec<String> { found.iter().map(of).collect() };
    let number = |of: &dyn Fn(&Found) -> f64| -> Vec<f64> { found.iter().map(of).collect() };
    let is_method = |one: &Found| one.of == "method";
    let measured = |one: &Found, value: f64| if is_method(one) { value } else { f64::NAN };
    Columns::default()
        .with("of", words(&|one| one.of.to_owned()))
        .with("name", words(&|one| one.name.clone()))
        .with("from", number(&|one| one.ends[0]))
        .with("to", number(&|one| one.ends[1]))
        .with("unit", words(&|one| one.unit.to_owned()))
        .with("count", number(&|one| one.count))
        .with("cpu_s", number(&|one| measured(one, one.cost_s)))
        .with("level_error_db", number(&|one| measured(one, one.error_db)))
}

fn bars<'a>(name: &str, found: impl Iterator<Item = &'a Found>, ink: Ink) -> Bars {
    Bars {
        name: name.to_owned(),
        bins: found
            .map(|one| [one.ends[0], one.ends[1], one.count])
            .collect(),
        ink,
    }
}

/// An axis of counts with a little room above the highest bar.
fn counts(what: &str, bars: &[Bars]) -> Axis {
    let bins = bars.iter().flat_map(|bars| &bars.bins);
    let most = bins.map(|bin| bin[2]).fold(1.0, f64::max);
    Axis::linear(what).within([0.0, 1.05 * most])
}

/// How level errors are distributed, with what the method promises and what it was given.
pub(crate) fn error_chart(accuracy: &Accuracy, rendering: Rendering) -> Chart {
    let found: Vec<Found> = errors(accuracy.found()).collect();
    let bars = Band::ALL.map(|band| {
        let name = name_of(band);
        let own = found.iter().filter(|one| one.name == name);
        bars(&name, own, ink(band))
    });
    Chart {
        title: "Level error".to_owned(),
        x: Axis::log("level error, dB").within(ERRORS_DB),
        y: counts("amplitudes", &bars),
        bars: bars.to_vec(),
        rules: error_rules(accuracy.bound_db, rendering),
        ..Chart::default()
    }
}

fn error_rules(bound_db: f64, rendering: Rendering) -> Vec<Rule> {
    let rule = |db: f64, label: &str, ink, extent| Rule {
        at: At::X(db),
        label: label.to_owned(),
        ink,
        extent,
    };
    let mut rules = vec![rule(ROUNDING_DB, "rounding", Ink::Grey, Extent::Dashed)];
    let budget_db = rendering.budget_db;
    let has_budget = rendering.has_budget();
    // Tables are made to fill the budget: both names would lie over each other.
    let is_full = has_budget && (bound_db / budget_db - 1.0).abs() < 0.5;
    if bound_db > ROUNDING_DB {
        let name = if is_full { "bound, budget" } else { "bound" };
        rules.push(rule(bound_db, name, Ink::Black, Extent::Across));
    }
    if has_budget && budget_db > 0.0 {
        let name = if is_full { "" } else { "budget" };
        rules.push(rule(budget_db, name, Ink::Black, Extent::Dashed));
    }
    rules
}

/// How the times of ticks are distributed, with the time that a tick has.
pub(crate) fn cost_chart(cost: &CostView) -> Chart {
    let found: Vec<Found> = costs(cost).collect();
    let bars = [bars("", found.iter(), Ink::Grey)];
    Chart {
        title: "Time a tick".to_owned(),
        x: Axis::log("wall time, s").within([1e-7, 0.1]),
        y: counts("ticks", &bars),
        bars: bars.to_vec(),
        rules: vec![Rule {
            at: At::X(0.025),
            label: "deadline".to_owned(),
            ink: Ink::Black,
            extent: Extent::Dashed,
        }],
        ..Chart::default()
    }
}

/// Where a method stands, error and CPU time; no error and one beyond the axis stand at its ends.
pub(crate) fn method_point(row: &Method) -> Option<[f64; 2]> {
    let cost_s = row.cost?.cpu_s;
    let error_db = row.error?.clamp(METHOD_ERRORS_DB[0], METHOD_ERRORS_DB[1]);
    (cost_s > 0.0 && cost_s.is_finite()).then_some([error_db, cost_s])
}

/// Every method, with those that nothing beats joined and the one that runs marked; each is named
/// once, where it runs or first stands.
pub(crate) fn method_chart(measured: &Measured) -> Chart {
    let running = measured.running();
    let all = measured.rows.iter().zip(&measured.front).enumerate();
    let all: Vec<_> = all
        .filter_map(|(index, (row, is_front))| Some((index, *is_front, method_point(row)?)))
        .collect();
    let dots = |front: bool, ink| {
        let own = || all.iter().filter(|one| one.1 == front);
        Series {
            points: own().map(|one| one.2).collect(),
            marked: own()
                .position(|one| Some(one.0) == running)
                .into_iter()
                .collect(),
            ink,
            ..Series::default()
        }
    };
    let front = dots(true, Ink::Black);
    let mut steps = front.points.clone();
    steps.sort_by(|a, b| a[0].total_cmp(&b[0]).then(b[1].total_cmp(&a[1])));
    let steps = Series {
        points: steps
            .windows(2)
            .flat_map(|pair| [pair[0], [pair[1][0], pair[0][1]], pair[1]])
            .collect(),
        style: Style::Line,
        ink: Ink::Grey,
        weight: Weight::Thin,
        ..Series::default()
    };
    let costs = all.iter().map(|one| one.2[1]);
    let [min_s, max_s] = costs.fold([f64::INFINITY, 0.0], |[min, max], s| {
        [s.min(min), s.max(max)]
    });
    Chart {
        title: "Methods on this scene".to_owned(),
        x: Axis::log("level error, dB").within(METHOD_ERRORS_DB),
        y: Axis::log("CPU time a tick, s").within([0.4 * min_s, 1.8 * max_s]),
        series: vec![steps, dots(false, Ink::Grey), front],
        words: names(measured),
        ..Chart::default()
    }
}

/// The name of each method, at the one that runs or the first of its settings.
fn names(measured: &Measured) -> Vec<Words> {
    let running = measured
        .running()
        .and_then(|index| measured.rows.get(index));
    let mut named: Vec<&str> = Vec::new();
    let mut words = Vec::new();
    for (nth, row) in running.into_iter().chain(&measured.rows).enumerate() {
        let Some(at) = method_point(row).filter(|_| !named.contains(&&*row.method)) else {
            continue;
        };
        let runs = if nth == 0 && running.is_some() {
            ", runs now"
        } else {
            ""
        };
        named.push(&row.method);
        words.push(Words {
            at,
            text: format!("{}{runs}", row.method),
            tone: Tone::Aside,
        });
    }
    words
}
