//! Numbers of a report: what many come to, and how people read them, with three digits that count
//! and times with their prefix.

pub(super) use selvedge_foundation::numerics::to_index as whole;
use selvedge_foundation::quantity::{fixed, time_span, with_unit};

/// The mean; NaN of none, and of what is not finite.
pub(super) fn mean(values: &[f64]) -> f64 {
    selvedge_statistics::mean(values).unwrap_or(f64::NAN)
}

/// Root mean square; NaN of none.
pub(super) fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt()
}

/// Standard deviation of all that there are.
pub(super) fn deviation(values: &[f64]) -> f64 {
    let mean = mean(values);
    rms(&values.iter().map(|x| x - mean).collect::<Vec<f64>>())
}

/// The largest of numbers that are not negative; 0 of none.
pub(super) fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, f64::max)
}

/// The level of a ratio of powers, dB.
pub(super) fn power_level_db(ratio: f64) -> f64 {
    10.0 * ratio.log10()
}

/// Rms of the difference of two series as a share of the second's rms, %.
pub(super) fn apart_percent(found: &[f64], truth: &[f64]) -> f64 {
    let off: Vec<f64> = found.iter().zip(truth).map(|(a, b)| a - b).collect();
    100.0 * rms(&off) / rms(truth)
}

/// A number with three digits that count: `0.0123`, `4.50`, `230`, `1.2e−9`.
pub(super) fn number(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude == 0.0 {
        return "0".to_owned();
    }
    if !magnitude.is_finite() || (100.0..1e6).contains(&magnitude) {
        return fixed(value, 0);
    }
    if !(1e-4..1e6).contains(&magnitude) {
        return format!("{value:.1e}").replace('-', "−");
    }
    let decimals = whole((2.0 - magnitude.log10().floor()).min(6.0));
    fixed(value, decimals)
}

/// A time: `6.3 ns`, `250 ns`, `1.20 µs`.
pub(super) fn time(seconds: f64) -> String {
    if seconds.abs() < 1e-7 {
        with_unit(seconds * 1e9, 1, "ns")
    } else {
        time_span(seconds)
    }
}

/// An amount of memory: `640 B`, `12.3 kB`, `1.50 MB`.
pub(super) fn bytes(n: u64) -> String {
    let n = n as f64;
    if n < 1e3 {
        with_unit(n, 0, "B")
    } else if n < 1e6 {
        with_unit(n / 1e3, 1, "kB")
    } else {
        with_unit(n / 1e6, 2, "MB")
    }
}

/// Units that names of columns end with, and how they are written.
const UNITS: [(&str, &str); 12] = [
    ("mm_per_s", "mm/s"),
    ("rad_per_s", "rad/s"),
    ("deg", "°"),
    ("db", "dB"),
    ("percent", "%"),
    ("um", "µm"),
    ("mm", "mm"),
    ("px", "px"),
    ("hz", "Hz"),
    ("ms", "ms"),
    ("us", "µs"),
    ("s", "s"),
];

/// The name of a column as a heading: `mean_offset_db` is `mean offset, dB`.
pub(super) fn heading(name: &str) -> String {
    let with_unit = UNITS.iter().find_map(|(key, unit)| {
        let stem = name.strip_suffix(key)?.strip_suffix('_')?;
        Some(format!("{}, {unit}", stem.replace('_', " ")))
    });
    with_unit.unwrap_or_else(|| name.replace('_', " "))
}

/// A cell as it stands in the CSV, as people read it: long numbers with three digits that count.
pub(super) fn cell(text: &str) -> String {
    match text {
        "true" => return "yes".to_owned(),
        "false" => return "no".to_owned(),
        _ => {}
    }
    match text.parse::<f64>() {
        Ok(value) if !value.is_finite() => String::new(),
        Ok(value) if text.len() > 7 || text.contains('e') => number(value),
        Ok(_) => text.replace('-', "−"),
        Err(_) => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_columns_and_cells_of_the_table_become_readable() {
        let names = ["mean_offset_db", "right_percent", "points", "bound_db", "s"].map(heading);
        assert_eq!(
            names,
            ["mean offset, dB", "right, %", "points", "bound, dB", "s"]
        );
        let cells = [
            "2.204e-7",
            "1.3000000000000001",
            "-1.5",
            "4794",
            "inf",
            "true",
            "2026-11",
            "wool",
        ];
        let said = cells.map(cell);
        assert_eq!(
            said,
            [
                "2.2e−7", "1.30", "−1.5", "4794", "", "yes", "2026-11", "wool"
            ]
        );
    }

    #[test]
    fn numbers_have_three_digits_that_count() {
        let said = [0.0, 0.012_34, -4.5, 230.4, 1.234e-9, f64::NAN, 2e9].map(number);
        assert_eq!(
            said,
            ["0", "0.0123", "−4.50", "230", "1.2e−9", "none", "2.0e9"]
        );
        assert_eq!(time(6.3e-9), "6.3 ns");
        assert_eq!(time(2.5e-7), "250 ns");
        assert_eq!(bytes(1_500_000), "1.50 MB");
    }
}
