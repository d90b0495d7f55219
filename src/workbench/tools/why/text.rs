//! The explanation as text to be copied, and as a table to be saved.

use crate::bench::export::Sheet;
use crate::bench::on_finger::OnFinger;
use crate::bench::perceptual_level::felt_words;
use crate::tools::why::explanation::Explanation;
use selvedge_device::{Calibration, FULL_CODE};
use selvedge_foundation::quantity::{fixed, with_unit};
use selvedge_render::GainTerms;
use selvedge_render::array::DirectionTrace;
use selvedge_textile::Uncertainty;

/// The line of the output limits: views mark it when one bites.
pub(crate) const LIMITS: &str = "Limits";

/// What is felt where a stylus drives the display.
const STYLUS: &str = "the stylus’ vibration, not the array’s rendering";

/// The terms of a gain with their names, dB.
pub(crate) fn gain_terms(terms: &GainTerms) -> [(&'static str, f64); 5] {
    [
        ("master", terms.master_db),
        ("band", terms.band_db),
        ("manifest", terms.manifest_db),
        ("scene", terms.scene_db),
        ("compression", terms.compression_db),
    ]
}

/// The lines that explain: what, and what it is for 40 Hz and 320 Hz or as a whole.
pub(crate) fn lines(why: &Explanation) -> Vec<(String, String)> {
    let mut lines = vec![("Position".to_owned(), place(why))];
    let Some(touch) = why.touch() else {
        let words = if why.is_stylus {
            STYLUS
        } else {
            "none: silent"
        };
        lines.push(("Textile".to_owned(), words.to_owned()));
        lines.push(("Drive codes".to_owned(), codes(why)));
        return lines;
    };
    let name = why.textile.clone().unwrap_or_default();
    let [u, w] = touch.place_mm.map(|mm| fixed(mm, 1));
    lines.push(("Textile".to_owned(), format!("{name}, at {u} / {w} mm")));
    let [warp, weft] = touch.velocity_mm_per_s.map(|v| fixed(v, 1));
    lines.push(("Warp / weft".to_owned(), format!("{warp} / {weft} mm/s")));
    for direction in touch.directions.iter().flatten() {
        lines.push(spectrum(direction));
    }
    if touch.directions.iter().all(Option::is_none) {
        let words = if why.is_stylus {
            STYLUS
        } else {
            "below 0.01 mm/s, or too fast: silent"
        };
        lines.push(("Spectra".to_owned(), words.to_owned()));
    }
    let both = |values: [f64; 2], decimals, unit: &str| {
        let [low, high] = values.map(|value| fixed(value, decimals));
        format!("{low} / {high} {unit}")
    };
    if !why.is_stylus {
        lines.push(("Without gain".to_owned(), both(why.bare_um(), 3, "µm")));
    }
    let [low, high] = touch.gains.map(|terms| gain_terms(&terms));
    for ((name, low_db), (_, high_db)) in low.into_iter().zip(high) {
        lines.push((format!("+ {name}"), both([low_db, high_db], 2, "dB")));
    }
    let totals = touch.gains.map(|terms| terms.total_db());
    lines.push(("= gain".to_owned(), both(totals, 2, "dB")));
    let amplitudes = both(why.trace.amplitudes_um, 3, "µm");
    lines.push(("Amplitudes".to_owned(), amplitudes));
    lines.extend(why.known_db.map(|ends| {
        let [low, high] = ends.map(Uncertainty::range_words);
        (
            "Known to".to_owned(),
            format!("{low} / {high} dB of that: heights from a picture"),
        )
    }));
    lines.extend(felt(why));
    lines.push((LIMITS.to_owned(), limits(why)));
    lines.extend(calibration(why));
    lines.push(("Drive codes".to_owned(), codes(why)));
    lines
}

/// What it feels like, by the model: this contactor's levels above threshold, and the display.
fn felt(why: &Explanation) -> [(String, String); 2] {
    let above = why.perceptual_level.above_db(why.trace.amplitudes_um);
    let [low, high] = above.map(|above_db| {
        if above_db.is_finite() {
            fixed(above_db, 1)
        } else {
            "silent".to_owned()
        }
    });
    let above = format!("{low} / {high} dB SL (model)");
    let display = format!("{} (model)", felt_words(&why.perceptual_level.whole));
    [("Sensation", above), ("Display feels", display)].map(|(name, value)| (name.to_owned(), value))
}

fn place(why: &Explanation) -> String {
    let at = why.trace.position;
    format!("{} / {} mm", fixed(at.x_mm, 1), fixed(at.y_mm, 1))
}

fn spectrum(direction: &DirectionTrace) -> (String, String) {
    let name = direction.direction.label();
    let [low, high] = direction.band_powers_um2.map(|um2| fixed(um2, 3));
    let words = format!("point {}, {low} / {high} µm²", direction.point);
    let mut letters = name.chars();
    let first = letters.next().map(|letter| letter.to_ascii_uppercase());
    (first.into_iter().chain(letters).collect(), words)
}

fn limits(why: &Explanation) -> String {
    let limits = why.output.limits;
    let [low, high] = limits.map(|limit| fixed(limit.um, 1));
    let numbers = match limits.map(|limit| limit.is_of_device) {
        [false, false] => format!("{low} / {high} µm"),
        [true, false] => format!("{low} (device) / {high} µm"),
        [false, true] => format!("{low} / {high} µm (device)"),
        [true, true] => format!("{low} / {high} µm (both the device's)"),
    };
    let limiter = why.output.limiter;
    let words = match (limiter.limited, limiter.guarded) {
        _ if limiter.off => "switched off in the array profile",
        ([false, false], false) => "not met",
        ([false, false], true) => "both scaled down to share full drive",
        ([true, false], _) => "40 Hz is capped",
        ([false, true], _) => "320 Hz is capped",
        ([true, true], _) => "both are capped",
    };
    format!("{numbers}, {words}")
}

/// What the array profile says of the contactor, where it differs from the nominal.
fn calibration(why: &Explanation) -> Option<(String, String)> {
    let output = &why.output;
    let is_nominal = output.calibration == Calibration::default();
    if is_nominal && output.channel == why.contactor {
        return None;
    }
    let [low, high] = output.calibration.drive_gain.map(|gain| fixed(gain, 2));
    let words = format!("{low} / {high} × drive, on channel {}", output.channel);
    Some(("Calibration".to_owned(), words))
}

fn codes(why: &Explanation) -> String {
    let [low, high] = why.output.codes;
    let state = match why.on_finger.map(OnFinger::label) {
        [None, None] => format!("sent at {}", with_unit(why.output.gain * 100.0, 0, "%")),
        [low, high] if low == high => low.unwrap_or_default().to_owned(),
        of_bands => of_bands.map(|label| label.unwrap_or("sent")).join(" / "),
    };
    format!("{low} / {high} of {FULL_CODE}, {state}")
}

/// All of it as text.
pub(crate) fn to_text(why: &Explanation) -> String {
    let cell = why.cell.map_or_else(String::new, |(row, column)| {
        format!(", row {row}, column {column}")
    });
    let head = format!(
        "Contactor {}{cell}, tick {} (40 Hz / 320 Hz)",
        why.contactor, why.tick
    );
    let lines = lines(why).into_iter();
    let lines = lines.map(|(name, value)| format!("{name:<13} {value}"));
    joined([head].into_iter().chain(lines))
}

/// A row of the table: quantity, axis, bin, its values for 40 and 320 Hz, unit.
type TableRow = (String, &'static str, Option<u64>, [f64; 2], &'static str);

/// Every number and every bin as a table: `quantity,axis,bin,value_40,value_320,unit`.
pub(crate) fn sheet(why: &Explanation) -> Sheet {
    let rows = rows(why);
    let words = |of: &dyn Fn(&TableRow) -> String| -> Vec<String> { rows.iter().map(of).collect() };
    let bin = |row: &TableRow| row.2.map_or_else(String::new, |k| k.to_string());
    let value = |band: usize| -> Vec<f64> { rows.iter().map(|row| row.3[band]).collect() };
    Sheet::default()
        .with("quantity", words(&|row| row.0.clone()))
        .with("axis", words(&|row| row.1.to_owned()))
        .with("bin", words(&bin))
        .with("value_40", value(0))
        .with("value_320", value(1))
        .with("unit", words(&|row| row.4.to_owned()))
}

fn rows(why: &Explanation) -> Vec<TableRow> {
    let mut rows = Vec::new();
    let mut row = |quantity: &str, axis, bin, values, unit| {
        rows.push((quantity.to_owned(), axis, bin, values, unit));
    };
    let at = why.trace.position;
    row("x", "", None, [at.x_mm; 2], "mm");
    row("y", "", None, [at.y_mm; 2], "mm");
    if let Some(touch) = why.touch() {
        for (axis, name) in ["warp", "weft"].into_iter().enumerate() {
            let [place, speed] = [touch.place_mm[axis], touch.velocity_mm_per_s[axis]];
            row("place", name, None, [place; 2], "mm");
            row("velocity", name, None, [speed; 2], "mm/s");
        }
        for direction in touch.directions.iter().flatten() {
            let name = direction.direction.label();
            row("band power", name, None, direction.band_powers_um2, "um2");
            for (k, bin) in (1..).zip(&direction.bins) {
                row("frequency", name, Some(k), [bin.frequency_hz; 2], "Hz");
                row("power", name, Some(k), [bin.power_um2; 2], "um2");
                row("filter gain", name, Some(k), bin.filter_gains, "1");
            }
        }
        let [low, high] = touch.gains.map(|terms| gain_terms(&terms));
        for ((name, low_db), (_, high_db)) in low.into_iter().zip(high) {
            row(&format!("gain {name}"), "", None, [low_db, high_db], "dB");
        }
    }
    let amplitudes = why.trace.amplitudes_um;
    row("amplitude", "", None, amplitudes, "um");
    let above_db = why.perceptual_level.above_db(amplitudes);
    row("sensation level by model", "", None, above_db, "dB");
    let limits = why.output.limits;
    row("limit", "", None, limits.map(|limit| limit.um), "um");
    let of_device = limits.map(|limit| f64::from(u8::from(limit.is_of_device)));
    row("limit is the device's", "", None, of_device, "1");
    row("soft-start gain", "", None, [why.output.gain; 2], "1");
    let codes = why.output.codes.map(f64::from);
    row("drive code", "", None, codes, "1");
    rows
}

/// Lines, each with its end.
fn joined(lines: impl Iterator<Item = String>) -> String {
    lines.map(|line| line + "\n").collect()
}
