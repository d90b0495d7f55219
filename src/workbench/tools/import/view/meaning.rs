//! The second step for the tester's files: what was detected, by what, and what must be said.

use eframe::egui::Ui;

use crate::kit::widgets::fields::{Need, Tone, choose_of, note, row, text};
use crate::tools::import::Import;
use crate::tools::import::draft::StrokesDraft;
use crate::tools::import::failure::Failure;
use crate::tools::import::view::table;
use crate::tools::import::work::{Found, Strokes};
use selvedge_foundation::quantity::fixed;
use selvedge_textile::{
    DecimalSign, KesAsk, KesColumn, KesKnown, KesLook, LengthUnit, ReturnOrder, Unit,
};

/// Width of a field for a number, points.
const NUMBER: f32 = 104.0;

/// Shows the step.
pub(crate) fn show(
    ui: &mut Ui,
    importing: &mut Import,
    found: Option<&Found>,
    failure: Option<&Failure>,
) {
    let Some(strokes) = found.and_then(Found::strokes) else {
        return;
    };
    let ask = failure.and_then(|failure| failure.ask);
    let described = &mut importing.draft.described;
    // The file that something is asked about, or else the first.
    let shown = failure.and_then(|failure| failure.file).unwrap_or(0);
    match strokes.looks.get(shown) {
        Some(Ok(look)) => {
            if strokes.looks.len() > 1 {
                let name = described.files.get(shown).map(|file| file.source.name());
                note(ui, &format!("{}:", name.unwrap_or_default()), Tone::Quiet);
            }
            let is_asked = ask == Some(KesAsk::Columns);
            if let Some(roles) = table::show(ui, look, is_asked) {
                described.strokes.columns = Some(roles);
            }
            show_fields(ui, &mut described.strokes, (look, strokes), ask);
        }
        Some(Err(line)) if failure.is_none_or(|failure| failure.line != *line) => {
            note(ui, line, Tone::Wrong);
        }
        Some(Err(_)) | None => {}
    }
    if let Some(reading) = &strokes.reading {
        for unit in &reading.assumed {
            note(
                ui,
                &format!("assumed: {unit}, no unit is stated"),
                Tone::Wrong,
            );
        }
        for words in &reading.notes {
            note(ui, words, Tone::Quiet);
        }
    }
}

fn show_fields(
    ui: &mut Ui,
    typed: &mut StrokesDraft,
    (look, strokes): (&KesLook, &Strokes),
    ask: Option<KesAsk>,
) {
    let need = |wanted: &[KesAsk]| Need::of(ask.is_some_and(|ask| wanted.contains(&ask)));
    let place = look.columns.iter().find(|column| is_place(column));
    let height = look.columns.iter().find(|column| is_height(column));
    show_spelling(ui, typed, look, need(&[KesAsk::Decimal]));
    let unit = |column: Option<&KesColumn>, usual: &str| match column {
        Some(column) if !column.unit.is_empty() => format!("{}, as its name says", column.unit),
        Some(_) => format!("{usual}, not stated"),
        None => "no such column".to_owned(),
    };
    row(ui, "unit of places", "", |ui, _| {
        let units = [
            (LengthUnit::Millimetre, "mm"),
            (LengthUnit::Centimetre, "cm"),
            (LengthUnit::Micrometre, "µm"),
        ];
        let by_file = unit(place, "mm");
        let name = "Unit of places";
        choose_of(
            ui,
            name,
            &mut typed.x_unit,
            (&units, &by_file, need(&[KesAsk::XUnit])),
        );
    });
    row(ui, "unit of heights", "", |ui, _| {
        let units = [
            (Unit::Length(LengthUnit::Micrometre), "µm"),
            (Unit::Length(LengthUnit::Millimetre), "mm"),
            (Unit::Volt, "V"),
        ];
        let by_file = unit(height, "µm");
        let need = need(&[KesAsk::HeightUnit]);
        let name = "Unit of heights";
        choose_of(ui, name, &mut typed.height_unit, (&units, &by_file, need));
    });
    show_numbers(ui, typed, strokes, need);
}

/// Sensitivity, step, speed and rate, and how return rows are ordered.
fn show_numbers(
    ui: &mut Ui,
    typed: &mut StrokesDraft,
    strokes: &Strokes,
    need: impl Fn(&[KesAsk]) -> Need,
) {
    row(ui, "sensitivity", "µm of height for 1 V", |ui, label| {
        let hint = "for volts";
        let need = need(&[KesAsk::UmPerVolt]);
        text(ui, label, &mut typed.um_per_volt, (hint, NUMBER, need));
    });
    let step = step_words(strokes);
    row(ui, "step", &format!("mm {step}"), |ui, label| {
        let need = need(&[KesAsk::Step]);
        text(ui, label, &mut typed.step_mm, ("by column", NUMBER, need));
    });
    row(ui, "speed", "mm/s, with a rate or times", |ui, label| {
        let need = need(&[KesAsk::Step, KesAsk::Speed]);
        text(ui, label, &mut typed.speed_mm_per_s, ("", NUMBER, need));
    });
    row(ui, "rate", "samples a second", |ui, label| {
        let need = need(&[KesAsk::Step]);
        text(ui, label, &mut typed.rate_hz, ("", NUMBER, need));
    });
    row(ui, "return rows", "", |ui, _| {
        let orders = [
            (ReturnOrder::Travel, "as measured"),
            (ReturnOrder::Mirrored, "by place"),
        ];
        let need = need(&[KesAsk::ReturnOrder]);
        let by = "as the cloth tells";
        choose_of(
            ui,
            "Return rows",
            &mut typed.return_order,
            (&orders, by, need),
        );
    });
}

fn show_spelling(ui: &mut Ui, typed: &mut StrokesDraft, look: &KesLook, need: Need) {
    let sign = match look.decimal {
        DecimalSign::Point => "point",
        DecimalSign::Comma => "comma",
    };
    let by_file = format!("{sign}, as the numbers show");
    row(ui, "decimal sign", "", |ui, _| {
        let signs = [(DecimalSign::Point, "point"), (DecimalSign::Comma, "comma")];
        choose_of(
            ui,
            "Decimal sign",
            &mut typed.decimal,
            (&signs, &by_file, need),
        );
    });
    let how = how_columns(look);
    let is_said = typed.columns.is_some();
    row(ui, "columns", "", |ui, _| {
        note(ui, &how, Tone::Quiet);
        if is_said
            && crate::kit::widgets::text::toggle(ui, "by file", false, "Columns as the file says")
        {
            typed.columns = None;
        }
    });
}

/// By what the columns are known, in words.
fn how_columns(look: &KesLook) -> String {
    let n = look.columns.len();
    let mut how: Vec<&str> = look
        .columns
        .iter()
        .map(|column| column.known.label())
        .collect();
    how.dedup();
    let columns = if n == 1 { "column" } else { "columns" };
    format!(
        "{n} {columns} between {}, {}; {} rows",
        look.separator,
        how.join(", "),
        look.n_rows
    )
}

/// The step that was found.
fn step_words(strokes: &Strokes) -> String {
    let Some(reading) = &strokes.reading else {
        return String::new();
    };
    let steps = reading.strokes.iter().map(|stroke| stroke.step_mm);
    let all: Vec<String> = steps.map(|mm| fixed(mm, 5)).collect();
    match &all[..] {
        [first, rest @ ..] if rest.iter().all(|other| other == first) => format!("found {first}"),
        _ => "found several".to_owned(),
    }
}

fn is_place(column: &KesColumn) -> bool {
    use selvedge_textile::ColumnRole::{Distance, Time};

    matches!(column.role, Distance | Time) && column.known != KesKnown::Unknown
}

fn is_height(column: &KesColumn) -> bool {
    matches!(column.role, selvedge_textile::ColumnRole::Height(..))
}
