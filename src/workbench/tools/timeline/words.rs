//! What there is to say of a place on the line of time.

use eframe::egui::{Pos2, Rect};

use crate::bench::on_finger::OnFinger;
use crate::bench::recording::tiles::Tiles;
use crate::bench::signals::rows::{LEAST_HZ, row_at};
use crate::tools::timeline::code::{GAP, finger_of, level_of, speed_of};
use crate::tools::timeline::columns::{LIMITED, MISSING, N_LINES, ON_FINGER};
use crate::tools::timeline::lanes::{Lane, LaneStyle, frequency_at};
use crate::tools::timeline::scope::Scope;
use crate::tools::timeline::transport::TICK_MS;
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// What there is to say of a place.
pub(crate) fn words_at(
    scope: &Scope<'_>,
    style: &LaneStyle,
    (lane, rect): (Lane, Rect),
    at: Pos2,
) -> String {
    let tick = scope.span.tick_at(scope.layout.share_at(at.x), scope.all);
    let head = if scope.view.shown_take().is_some() {
        format!("{}   tick {tick}", quantity::clock(tick * TICK_MS))
    } else {
        let ago_s = (scope.all.end - 1.0 - tick as f64) * TICK_MS as f64 / 1000.0;
        let ago = quantity::with_unit(ago_s, 2, "s");
        format!("{ago} before the newest, in felt time")
    };
    let read = |tiles: &Tiles| {
        let mut rows = vec![GAP; tiles.n_rows];
        tiles.strongest_into(tick..tick + 1, &mut rows);
        rows
    };
    let share = f64::from((rect.bottom() - at.y) / rect.height()).clamp(0.0, 1.0);
    let felt = read(scope.felt);
    let rest = match lane {
        Lane::Spectrum => spectrum_words(&read(scope.spectrum), share, style),
        Lane::Raster(band) => raster_words(&felt, 1.0 - share, band),
        Lane::Lines => line_words(&felt),
    };
    let on_finger = felt.get(ON_FINGER).and_then(|code| finger_of(*code));
    let absent = on_finger.and_then(OnFinger::label);
    let absent = absent.map_or_else(String::new, |why| format!("\nNot on the finger: {why}"));
    format!("{head}\n{rest}{absent}")
}

fn level_words(code: u8) -> String {
    match level_of(code) {
        None => "nothing is known".to_owned(),
        Some(f64::NEG_INFINITY) => "silent".to_owned(),
        Some(level_db) => {
            let um = quantity::with_unit(quantity::factor_of_gain(level_db), 2, "µm");
            format!("{}   {um}", quantity::with_unit(level_db, 1, "dB re 1 µm"))
        }
    }
}

fn spectrum_words(rows: &[u8], share: f64, style: &LaneStyle) -> String {
    let frequency_hz = frequency_at(share, style.spectrum.is_linear).max(LEAST_HZ);
    let row = row_at(frequency_hz);
    let code = rows.get(row).copied().unwrap_or(GAP);
    format!(
        "{}\n{}\nPeak amplitude that arrives in a row 4.9 % of the frequency wide, before filters \
         and gains",
        quantity::with_unit(frequency_hz, 0, "Hz"),
        level_words(code)
    )
}

fn raster_words(rows: &[u8], share: f64, band: Band) -> String {
    let n_contactors = rows.len().saturating_sub(N_LINES) / 2;
    let places = (0..n_contactors).rev();
    let is_above = |nth: &usize| *nth as f64 <= share * n_contactors as f64;
    let contactor = places.into_iter().find(is_above).unwrap_or(0);
    let row = N_LINES + band.index() * n_contactors + contactor;
    let code = rows.get(row).copied().unwrap_or(GAP);
    format!(
        "contactor {contactor}, {} Hz\n{}\nPeak, after gains, before output limits",
        quantity::fixed(band.carrier_hz(), 0),
        level_words(code)
    )
}

fn line_words(rows: &[u8]) -> String {
    let Some(speed) = rows.first().and_then(|code| speed_of(*code)) else {
        return "nothing is known".to_owned();
    };
    let mut lines = vec![format!("speed  {}", quantity::with_unit(speed, 0, "mm/s"))];
    for band in Band::ALL {
        let carrier = quantity::fixed(band.carrier_hz(), 0);
        let level = level_words(rows[2 + 2 * band.index()]);
        lines.push(format!("{carrier} Hz  {level}"));
    }
    let which = "Mean peak of the contactors that vibrate, after gains, before limits";
    lines.push(which.to_owned());
    if rows[LIMITED] > 1 {
        lines.push(format!("{} contactors at a limit", rows[LIMITED] - 1));
    }
    if rows[MISSING] > 1 {
        lines.push("Ticks are missing before this one: it was held, or none came".to_owned());
    }
    lines.join("\n")
}
