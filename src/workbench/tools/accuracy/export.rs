//! How accurate rendering was found to be, what ticks cost, and every method on the scene.

use crate::bench::export::Exported;
use crate::bench::export::origin::Origin;
use crate::bench::export::sheet::Sheet;
use crate::tools::accuracy::AccuracyView;
use crate::tools::accuracy::checker::{ERRORS_DB, edges_db};
use crate::tools::spectra::export_spectrograms::ink;
use selvedge_chart::{At, Axis, Extent, Ink, Panel, Row, Rule, Series, Style};
use selvedge_foundation::quantity;
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
pub(crate) fn histograms(view: &AccuracyView<'_>, origin: Origin) -> Exported {
    let found: Vec<Found> = errors(view)
        .chain(costs(view))
        .chain(methods(view))
        .collect();
    let mut panels = vec![error_panel(&found, view), cost_panel(&found)];
    if found.iter().any(|one| one.of == "method") {
        panels.push(method_panel(&found));
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
    Exported::new(title, sheet(&found), vec![row], note, origin)
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

fn sheet(found: &[Found]) -> Sheet {
    let words = |of: &dyn Fn(&Found) -> String| -> Vec<String> { found.iter().map(of).collect() };
    let number = |of: &dyn Fn(&Found) -> f64| -> Vec<f64> { found.iter().map(of).collect() };
    let is_method = |one: &Found| one.of == "method";
    let measured = |one: &Found, value: f64| if is_method(one) { value } else { f64::NAN };
    Sheet::default()
        .with("of", words(&|one| one.of.to_owned()))
        .with("name", words(&|one| one.name.clone()))
        .with("from", number(&|one| one.ends[0]))
        .with("to", number(&|one| one.ends[1]))
        .with("unit", words(&|one| one.unit.to_owned()))
        .with("count", number(&|one| one.count))
        .with("cpu_s", number(&|one| measured(one, one.cost_s)))
        .with("level_error_db", number(&|one| measured(one, one.error_db)))
}

/// Bins as stems at their geometric middle.
fn stems(found: &[Found], of: &str, name: &str, ink: Ink) -> Series {
    let bins = found.iter().filter(|one| one.of == of && one.name == name);
    let heard = bins.filter(|one| one.count > 0.0);
    Series {
        name: name.to_owned(),
        points: heard
            .map(|one| [(one.ends[0] * one.ends[1]).sqrt(), one.count])
            .collect(),
        style: Style::Stems,
        ink,
        ..Series::default()
    }
}

fn most(series: &[Series]) -> f64 {
    let counts = series.iter().flat_map(|one| &one.points);
    counts.map(|[_, count]| *count).fold(1.0, f64::max)
}

fn error_panel(found: &[Found], view: &AccuracyView<'_>) -> Panel {
    let series = Band::ALL.map(|band| stems(found, "level error", &name_of(band), ink(band)));
    let rule = |db: f64, label: &str| Rule {
        at: At::X(db),
        label: label.to_owned(),
        ink: Ink::Black,
        extent: Extent::Dashed,
    };
    let is_on = |db: f64| (ERRORS_DB[0]..=ERRORS_DB[1]).contains(&db);
    let (bound_db, budget_db) = (view.bound_db, view.rendering.budget_db);
    // Tables are made to fill the budget: both names would lie over each other.
    let rules = if (bound_db / budget_db - 1.0).abs() < 0.5 {
        vec![(bound_db, "bound, budget")]
    } else {
        vec![(bound_db, "bound"), (budget_db, "budget")]
    };
    Panel {
        title: "Level error".to_owned(),
        x: Axis::log("level error, dB").within(ERRORS_DB),
        y: Axis::linear("amplitudes").within([0.0, 1.05 * most(&series)]),
        series: series.to_vec(),
        rules: rules
            .into_iter()
            .filter(|(db, _)| is_on(*db))
            .map(|(db, label)| rule(db, label))
            .collect(),
        ..Panel::default()
    }
}

fn cost_panel(found: &[Found]) -> Panel {
    let series = stems(found, "time a tick", "", Ink::Grey);
    let top = most(std::slice::from_ref(&series));
    Panel {
        title: "Time a tick".to_owned(),
        x: Axis::log("wall time, s").within([1e-7, 0.1]),
        y: Axis::linear("ticks").within([0.0, 1.05 * top]),
        series: vec![series],
        rules: vec![Rule {
            at: At::X(0.025),
            label: "deadline".to_owned(),
            ink: Ink::Black,
            extent: Extent::Dashed,
        }],
        ..Panel::default()
    }
}

fn method_panel(found: &[Found]) -> Panel {
    let methods = found.iter().filter(|one| one.of == "method");
    let series = methods.map(|one| Series {
        name: one.name.clone(),
        points: vec![[one.cost_s, one.error_db.max(ERRORS_DB[0])]],
        ..Series::default()
    });
    Panel {
        title: "Methods on this scene".to_owned(),
        x: Axis::log("CPU time a tick, s"),
        y: Axis::log("level error, dB").within(ERRORS_DB),
        series: series.collect(),
        ..Panel::default()
    }
}
