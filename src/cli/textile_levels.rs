//! `selvedge textile levels`: how strong every textile of a library is and how sure that is, and
//! what the library spans.

use std::path::Path;
use std::sync::Arc;

use super::output::{Cell, TableOut, rows_to_json};
use super::terminal::with_meter;
use super::{CliError, output};
use selvedge_foundation::progress::Progress;
use selvedge_foundation::quantity::{factor_of_gain, fixed, level_db};
use selvedge_textile::tactile::{Band, Filters, Levels, Tuning};
use selvedge_textile::{Library, Textile};

/// A textile and its levels.
type Measured = (Arc<Textile>, Levels);

/// A textile whose directions differ by more is strongly anisotropic, dB.
const STRONG_DB: f64 = 10.0;

const LEVELS_HEADER: [&str; 14] = [
    "textile",
    "a40_um",
    "a320_um",
    "level_db",
    "cv40",
    "cv320",
    "anisotropy40_db",
    "anisotropy320_db",
    "tuned_a40_um",
    "tuned_a320_um",
    "low40_db",
    "high40_db",
    "low320_db",
    "high320_db",
];

/// Writes the table, and when it goes to a file what the library spans to standard output.
pub(super) fn levels(library: &Library, out: Option<&Path>) -> Result<(), CliError> {
    let load = |progress: &mut Progress<'_>| library.load_all(library.ids(), progress);
    let textiles = with_meter("reading", load)??;
    let all: Vec<Measured> = textiles
        .into_iter()
        .map(|textile| {
            let levels = Levels::of(textile.surface(), &Filters::default());
            (textile, levels)
        })
        .collect();
    let tuning = library.default_tuning();
    let known: Vec<f64> = all
        .iter()
        .filter_map(|(_, levels)| levels.level_db())
        .collect();
    let mean_db = known.iter().sum::<f64>() / known.len().max(1) as f64;
    let reference_db = tuning.compression_reference_db.unwrap_or(mean_db);
    let rows = all.iter().map(|one| cells(one, (&tuning, reference_db)));
    let is_json = |file: &&Path| file.extension().is_some_and(|ending| ending == "json");
    if let Some(file) = out.filter(is_json) {
        let rows: Vec<_> = rows.collect();
        output::write_text(Some(file), &rows_to_json(LEVELS_HEADER, &rows, file)?)?;
        return output::print(&spread(&all, (&tuning, reference_db)));
    }
    let mut table = TableOut::new(out, &LEVELS_HEADER)?;
    for cells in rows {
        let row = table.rows();
        for cell in cells {
            match cell {
                Cell::Text(text) => row.text(&text),
                Cell::Number(number) => row.optional(number),
            };
        }
        row.end_row()?;
    }
    table.finish()?;
    match output::named_file(out) {
        // The table itself is on standard output.
        None => Ok(()),
        Some(_) => output::print(&spread(&all, (&tuning, reference_db))),
    }
}

/// The row of a textile.
fn cells((textile, levels): &Measured, tuning: (&Tuning, f64)) -> [Cell; LEVELS_HEADER.len()] {
    let known = textile.manifest().uncertainty.as_ref();
    let known = known.filter(|known| !known.levels.is_empty());
    let [low, high] = Band::ALL.map(|band| known.map(|known| known.mean_level_db(band)));
    let end = |of: Option<[f64; 2]>, end: usize| Cell::Number(of.map(|ends| ends[end]));
    let number = Cell::number;
    let [tuned_low, tuned_high] = Band::ALL.map(|band| tuned_um(textile, levels, tuning, band));
    [
        Cell::text(textile.id()),
        number(levels.mean_um[0]),
        number(levels.mean_um[1]),
        Cell::Number(levels.level_db()),
        number(levels.cv[0]),
        number(levels.cv[1]),
        number(levels.anisotropy_db[0]),
        number(levels.anisotropy_db[1]),
        number(tuned_low),
        number(tuned_high),
        end(low, 0),
        end(low, 1),
        end(high, 0),
        end(high, 1),
    ]
}

/// What a library spans: ranges before and after its tuning, variation, anisotropy.
fn spread(all: &[Measured], tuning: (&Tuning, f64)) -> String {
    let range_db = |of: &dyn Fn(&Measured) -> f64| {
        let levels = all.iter().map(|one| level_db(of(one)));
        let audible: Vec<f64> = levels.filter(|db| db.is_finite()).collect();
        let highest = audible.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let lowest = audible.iter().copied().fold(f64::INFINITY, f64::min);
        fixed((highest - lowest).max(0.0), 1)
    };
    let [plain40, plain320] = [0, 1].map(|b| range_db(&|(_, levels)| levels.mean_um[b]));
    let [tuned40, tuned320] = Band::ALL
        .map(|band| range_db(&|(textile, levels)| tuned_um(textile, levels, tuning, band)));
    let n_strong = all
        .iter()
        .filter(|(_, levels)| levels.anisotropy_db.into_iter().any(|db| db > STRONG_DB))
        .count();
    let n = all.len();
    format!(
        "{n} surfaces; A40 spans {plain40} dB and A320 {plain320} dB, tuned {tuned40} and \
         {tuned320} dB; {n_strong} differ by more than {STRONG_DB} dB from direction to direction\n"
    )
}

/// The mean amplitude of a band with a tuning and the textile's own gain, µm.
fn tuned_um(
    textile: &Textile,
    levels: &Levels,
    (tuning, reference_db): (&Tuning, f64),
    band: Band,
) -> f64 {
    let gain_db = tuning.band_gain_db(band)
        + textile.manifest().gain_db
        + tuning.compression_gain_db(levels.level_db(), reference_db);
    levels.mean_um[band.index()] * factor_of_gain(gain_db)
}
