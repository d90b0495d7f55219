//! The charts of the pane and their numbers: how accurate rendering was found to be, what ticks
//! cost, and every method on the scene.

use crate::bench::export::Exported;
use crate::bench::export::ink;
use crate::bench::export::origin::Origin;
use crate::tools::accuracy::AccuracyView;
use crate::tools::accuracy::checker::{ERRORS_DB, ROUNDING_DB, edges_db};
use selvedge_chart::{At, Axis, Bars, Chart, Columns, Extent, Ink, Row, Rule, Series};
use selvedge_foundation::quantity;
use selvedge_render::array::Method;
use selvedge_textile::tactile::Band;

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
pub(crate) fn exported(view: &AccuracyView<'_>, origin: Origin) -> Exported {
    let found: Vec<Found> = errors(view)
        .chain(costs(view))
        .chain(methods(view))
        .collect();
    let mut panels = vec![error_chart(view), cost_chart(view)];
    if found.iter().any(|one| one.of == "method") {
        panels.push(method_chart(&found));
    }
    let row = Row {
        panels,
        height_px: 340.0,
        bar: None,
    };
    let checked = quantity::with_unit(view.found.n_ticks as f64, 0, "ticks");
    let late = format!("{} late, {} missed", view.cost.late, view.cost.missed);
    let origin = origin
        .and("ticks_checked", &view.found.n_ticks.to_string(), &checked)
        .and("deadlines", &late, &late);
    let note = "Level errors against reference (f64, every bin) in the normative measure; wall \
                time of every tick; methods by CPU time.";
    let title = "Accuracy and cost of rendering".to_owned();
    Exported::new(title, columns(&found), vec![row], note, origin)
}

fn errors<'a>(view: &'a AccuracyView<'_>) -> impl Iterator<Item = Found> + 'a {
    let edges = edges_db();
    Band::ALL.into_iter().flat_map(move |band| {
        let counts = view.found.counts[band.index()].iter();
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

fn costs<'a>(view: &'a AccuracyView<'_>) -> impl Iterator<Item = Found> + 'a {
    view.cost.costs.buckets().map(|bucket| Found {
        of: "time a tick",
        ends: [bucket.from.as_secs_f64(), bucket.to.as_secs_f64()],
        unit: "s",
        count: f64::from(bucket.count),
        ..Found::default()
    })
}

fn methods<'a>(view: &'a AccuracyView<'_>) -> impl Iterator<Item = Found> + 'a {
    let rows = view
        .measured
        .into_iter()
        .flat_map(|measured| &measured.rows);
    rows.filter_map(|row| {
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
pub(crate) fn error_chart(view: &AccuracyView<'_>) -> Chart {
    let found: Vec<Found> = errors(view).collect();
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
        rules: error_rules(view),
        ..Chart::default()
    }
}

fn error_rules(view: &AccuracyView<'_>) -> Vec<Rule> {
    let rule = |db: f64, label: &str, ink, extent| Rule {
        at: At::X(db),
        label: label.to_owned(),
        ink,
        extent,
    };
    let mut rules = vec![rule(ROUNDING_DB, "rounding", Ink::Grey, Extent::Dashed)];
    let (bound_db, budget_db) = (view.bound_db, view.rendering.budget_db);
    let has_budget = matches!(view.rendering.method, Method::Auto | Method::Table);
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
pub(crate) fn cost_chart(view: &AccuracyView<'_>) -> Chart {
    let found: Vec<Found> = costs(view).collect();
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

fn method_chart(found: &[Found]) -> Chart {
    let methods = found.iter().filter(|one| one.of == "method");
    let series = methods.map(|one| Series {
        name: one.name.clone(),
        points: vec![[one.cost_s, one.error_db.max(ERRORS_DB[0])]],
        ..Series::default()
    });
    Chart {
        title: "Methods on this scene".to_owned(),
        x: Axis::log("CPU time a tick, s"),
        y: Axis::log("level error, dB").within(ERRORS_DB),
        series: series.collect(),
        ..Chart::default()
    }
}
