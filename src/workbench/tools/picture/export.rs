//! A picture's directions by both measures, and what was found of its lattice.

use crate::bench::export::Exported;
use crate::bench::export::origin::Origin;
use crate::bench::source_file::SourceFile;
use crate::tools::picture::found::Found;
use selvedge_chart::{Axis, Chart, Columns, Ink, Series, Style};
use selvedge_foundation::numerics::to_index;
use selvedge_foundation::quantity;
use selvedge_textile::picture::{Directions, Measured};

/// The two curves over angle; nothing before they are there.
pub(crate) fn directions(found: &Found) -> Option<Exported> {
    let cloth = found.cloth.as_deref()?;
    let directions = cloth.directions.as_ref()?;
    let title = format!("Directions of the threads: {}", found.inputs.own_name());
    let note = "Directions in which maxima of the autocorrelation lie in lines; each measure as a \
                share of its highest value.";
    let chart = direction_chart(directions);
    Some(Exported::of_chart(
        &title,
        chart,
        320.0,
        note,
        origin(found),
    ))
}

/// Both measures over half a turn, each by its own highest value; chosen directions are marked.
pub(crate) fn direction_chart(directions: &Directions) -> Chart {
    let curves = [&directions.by_concentration, &directions.by_hough];
    let n = curves[0].curve.len();
    let angles: Vec<f64> = (0..n).map(|i| 180.0 * i as f64 / n as f64).collect();
    let shares = curves.map(|measured| {
        let most = measured.curve.iter().copied().fold(0.0, f64::max);
        let most = if most > 0.0 { most } else { 1.0 };
        measured
            .curve
            .iter()
            .map(|x| x / most)
            .collect::<Vec<f64>>()
    });
    let line = |nth: usize, name: &str, ink| Series {
        name: name.to_owned(),
        points: angles
            .iter()
            .zip(&shares[nth])
            .map(|(x, y)| [*x, *y])
            .collect(),
        marked: marked(curves[nth]),
        style: Style::Line,
        ink,
        ..Series::default()
    };
    let series = vec![
        line(0, "mean concentration", Ink::Black),
        line(1, "Hough transform", Ink::Grey),
    ];
    let [first, second] = shares;
    Chart {
        x: Axis::linear("direction, degrees clockwise from x").within([0.0, 180.0]),
        y: Axis::linear("share of the highest").within([0.0, 1.1]),
        series,
        columns: Columns::default()
            .with("direction_deg", angles)
            .with("mean_concentration_share", first)
            .with("hough_share", second),
        ..Chart::default()
    }
}

/// Where on its curve the directions are that a measure finds best.
fn marked(measured: &Measured) -> Vec<usize> {
    let n = measured.curve.len().max(1);
    let best = measured.best.into_iter().flatten();
    let index = |angle: f64| {
        let share = (angle / std::f64::consts::PI).rem_euclid(1.0);
        to_index((share * n as f64).round()) % n
    };
    best.map(index).collect()
}

fn origin(found: &Found) -> Origin {
    let program = selvedge_foundation::PROGRAM;
    let mut origin = Origin::default().and("program", program, program);
    let name = found.inputs.source.as_ref().map(SourceFile::name);
    if let (Some(name), Some(sha256)) = (name, found.sha256()) {
        let line = format!("{name}: {sha256}");
        origin = origin.and("file", &line, &name);
    }
    let tiled = found
        .cloth
        .as_deref()
        .and_then(|cloth| cloth.found.as_deref().ok());
    if let Some(tiled) = tiled {
        for (key, [x, y]) in [
            ("p1_px", tiled.lattice.p1_px),
            ("p2_px", tiled.lattice.p2_px),
        ] {
            let [short_x, short_y] = [x, y].map(|px| quantity::fixed(px, 2));
            let short = format!("{key} {short_x}, {short_y}");
            origin = origin.and(key, &format!("{x},{y}"), &short);
        }
        let share = tiled.explained_variance;
        let percent = quantity::with_unit(100.0 * share, 0, "%");
        origin = origin.and(
            "explained_variance",
            &share.to_string(),
            &format!("explains {percent}"),
        );
    }
    origin
}
