//! Measurements that are imported: strokes of the tester with what is evaluated of them, or the
//! relief of a map with the strokes over it.

use crate::bench::export::origin::Origin;
use crate::bench::export::row;
use crate::bench::export::{Exported, Sheet, bar};
use crate::kit::theme::colour_map::ColourMap;
use crate::tools::import::view::curves::profile_chart;
use crate::tools::import::work::{Body, Found, Heights};
use selvedge_chart::{Axis, Chart, Ink, Raster, Row, Series, Style, Weight};
use selvedge_foundation::quantity;
use selvedge_textile::{KesImport, MarkKind};

/// Width of a figure's frames and the most that a relief is high, px.
const WIDTH_PX: f64 = 720.0;
const MOST_HIGH_PX: f64 = 620.0;

/// What the pane shows of what was read; nothing before anything was.
pub(crate) fn measurement(found: &Found, map: ColourMap) -> Option<Exported> {
    let name = found.own_name();
    match &found.body {
        Body::Nothing => None,
        Body::Strokes(strokes) => Some(crate::tools::import::export::strokes(
            strokes.import.as_ref()?,
            &name,
        )),
        Body::Heights(heights) => Some(crate::tools::import::export::heights(heights, &name, map)),
    }
}

fn program() -> Origin {
    let program = selvedge_foundation::PROGRAM;
    Origin::default().and("program", program, program)
}

fn strokes(import: &KesImport, name: &str) -> Exported {
    let figure = import.figure(name);
    let mut origin = program();
    for [file, sha256] in &import.reading().files {
        let line = format!("{file}: {sha256}");
        origin = origin.and("file", &line, file);
    }
    for (direction, smd_um) in &import.figures().smd_um {
        let smd = quantity::with_unit(*smd_um, 2, "µm");
        let line = format!("{} {smd_um}", direction.key());
        origin = origin.and("smd_um", &line, &format!("SMD {} {smd}", direction.label()));
    }
    let note = figure.notes.join(" ");
    Exported::new(
        figure.title.clone(),
        stroke_sheet(import),
        figure.rows,
        &note,
        origin,
    )
}

/// One row a sample: of every stroke, then of the friction.
fn stroke_sheet(import: &KesImport) -> Sheet {
    let (mut of, mut marks) = (Vec::new(), Vec::new());
    let (mut places, mut heights, mut mu) = (Vec::new(), Vec::new(), Vec::new());
    let mut evaluated = Vec::new();
    for stroke in &import.reading().strokes {
        let samples = import.samples(stroke);
        let first = of.len();
        for (i, height_um) in stroke.heights_um.iter().enumerate() {
            of.push(stroke.direction.key().to_owned());
            places.push(stroke.place_mm(i));
            heights.push(*height_um);
            mu.push(f64::NAN);
            evaluated.push(u64::from(samples.contains(&i)));
            marks.push(String::new());
        }
        for mark in &stroke.marks {
            for i in mark.samples.clone() {
                MarkKind::label(mark.kind).clone_into(&mut marks[first + i]);
            }
        }
    }
    if let (Some(friction), Some(section)) = (&import.reading().friction, import.friction_section())
    {
        for (i, value) in friction.mu.iter().enumerate() {
            let place_mm = friction.start_mm + i as f64 * friction.step_mm;
            of.push("friction".to_owned());
            places.push(place_mm);
            heights.push(f64::NAN);
            mu.push(*value);
            evaluated.push(u64::from(
                (section.from_mm..section.to_mm).contains(&place_mm),
            ));
            marks.push(String::new());
        }
    }
    Sheet::default()
        .with("stroke", of)
        .with("place_mm", places)
        .with("height_um", heights)
        .with("friction", mu)
        .with("is_evaluated", evaluated)
        .with("mark", marks)
}

fn heights(found: &Heights, name: &str, map: ColourMap) -> Exported {
    let measured = found.import.measured();
    let sha256 = found.import.sha256();
    let short: String = sha256.chars().take(12).collect();
    let mut origin = program()
        .and("format", measured.about.format, measured.about.format)
        .and("sha256", sha256, &format!("sha256 {short}"));
    for (nth, place) in found.places.iter().flatten().enumerate() {
        let [u, w] = place
            .place_mm
            .unwrap_or_else(|| found.import.map().size_mm().map(|mm| 0.5 * mm));
        let smd_um = place.smd_um();
        let smd = quantity::with_unit(smd_um, 2, "µm");
        let line = format!("{} at {u},{w} mm: smd_um {smd_um}", nth + 1);
        let [u, w] = [u, w].map(|mm| quantity::fixed(mm, 2));
        origin = origin.and(
            "place",
            &line,
            &format!("{} at {u}, {w} mm SMD {smd}", nth + 1),
        );
    }
    let note = "Heights without their best plane, as means over cells; white: missing. Lines: the \
                strokes of the virtual tester.";
    let (sheet, row) = match &found.relief {
        Some(relief) => (relief_sheet(relief), relief_row(found, relief, map)),
        None => profile_of(found),
    };
    Exported::new(
        format!("{name}: measured heights"),
        sheet,
        vec![row],
        note,
        origin,
    )
}

fn relief_sheet(relief: &crate::kit::widgets::relief::Relief) -> Sheet {
    let (grid, size_mm) = (relief.heights_um(), relief.size_mm);
    let n = [grid.width(), grid.height()];
    let place = |axis: usize, cell: usize| (cell as f64 + 0.5) * size_mm[axis] / n[axis] as f64;
    let cells = || (0..n[1]).flat_map(|row| (0..n[0]).map(move |column| (column, row)));
    Sheet::default()
        .with(
            "u_mm",
            cells()
                .map(|(column, _)| place(0, column))
                .collect::<Vec<f64>>(),
        )
        .with(
            "w_mm",
            cells().map(|(_, row)| place(1, row)).collect::<Vec<f64>>(),
        )
        .with("height_um", grid.values().to_vec())
}

fn relief_row(
    found: &Heights,
    relief: &crate::kit::widgets::relief::Relief,
    map: ColourMap,
) -> Row {
    let size_mm = relief.size_mm;
    let colours = relief.colours(map);
    let rows = (0..colours.height()).rev();
    let cell = |colour: &Option<eframe::egui::Color32>| {
        colour.map(|colour| {
            let [r, g, b, _] = colour.to_array();
            [r, g, b]
        })
    };
    let cells = rows
        .flat_map(|row| colours.row(row).iter().map(cell))
        .collect();
    let middle = size_mm.map(|mm| 0.5 * mm);
    let lines = found.places.iter().flatten().flat_map(|place| {
        let [u, w] = place.place_mm.unwrap_or(middle);
        [[[0.0, w], [size_mm[0], w]], [[u, 0.0], [u, size_mm[1]]]]
    });
    let series = lines.map(|ends| Series {
        points: ends.to_vec(),
        style: Style::Line,
        ink: Ink::Black,
        weight: Weight::Thin,
        ..Series::default()
    });
    let panel = Chart {
        x: Axis::linear("along the warp, mm").within([0.0, size_mm[0]]),
        y: Axis::linear("along the weft, mm").within([0.0, size_mm[1]]),
        raster: Some(Raster {
            n_columns: colours.width(),
            cells,
        }),
        series: series.collect(),
        ..Chart::default()
    };
    Row {
        panels: vec![panel],
        height_px: (WIDTH_PX * size_mm[1] / size_mm[0]).clamp(80.0, MOST_HIGH_PX),
        bar: Some(bar(map, Axis::linear("height, µm").within(relief.range_um))),
    }
}

fn profile_of(found: &Heights) -> (Sheet, Row) {
    let map = found.import.map();
    let heights_um = map.heights_um().values().to_vec();
    let step_mm = map.step_mm()[0];
    let places: Vec<f64> = (0..heights_um.len()).map(|i| i as f64 * step_mm).collect();
    let panel = found.profile.as_deref();
    let panel = panel.map_or_else(Chart::default, |envelope| profile_chart(map, envelope));
    let row = row(panel, 240.0);
    let sheet = Sheet::default()
        .with("place_mm", places)
        .with("height_um", heights_um);
    (sheet, row)
}
