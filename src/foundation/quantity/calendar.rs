//! Dates and times of day, UTC, in the Gregorian calendar; leap seconds are nowhere.

use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Year, month and day of a number of days since 1970-01-01, in the Gregorian calendar.
pub fn date_of(days: u64) -> (u64, u64, u64) {
    // Counted from 0000-03-01, so that a leap day is the last of its year.
    let shifted = days + 719_468;
    let (era, of_era) = (shifted / 146_097, shifted % 146_097);
    let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted_month = (5 * of_year + 2) / 153;
    let day = of_year - (153 * shifted_month + 2) / 5 + 1;
    let month = if shifted_month < 10 {
        shifted_month + 3
    } else {
        shifted_month - 9
    };
    let year = year_of_era + 400 * era + u64::from(month <= 2);
    (year, month, day)
}

/// A moment as RFC 3339 with microseconds, UTC: `2026-03-01T14:05:06.000000Z`. Times before 1970
/// are shown as its first.
pub fn rfc3339(at: SystemTime) -> String {
    let since = at.duration_since(UNIX_EPOCH).unwrap_or_default();
    let s = since.as_secs();
    let (year, month, day) = date_of(s / 86_400);
    let (hour, minute, second) = (s / 3600 % 24, s / 60 % 60, s % 60);
    let us = since.subsec_micros();
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{us:06}Z")
}

/// The moment that [`rfc3339`] wrote; `None` where the text is none of its.
pub fn moment_of(text: &str) -> Option<SystemTime> {
    let (date, time) = text.strip_suffix('Z')?.split_once('T')?;
    let [year, month, day] = numbers(date, '-')?;
    let (time, us) = time.split_once('.')?;
    let [hour, minute, second] = numbers(time, ':')?;
    let is_time = hour < 24 && minute < 60 && second < 60 && us.len() == 6;
    let (is_month, is_year) = ((1..=12).contains(&month), (1970..10_000).contains(&year));
    if !(is_time && is_month && is_year && us.bytes().all(|b| b.is_ascii_digit())) {
        return None;
    }
    // From 0000-03-01 on, as in `date_of`.
    let (shifted_year, shifted_month) = if month > 2 {
        (year, month - 3)
    } else {
        (year - 1, month + 9)
    };
    let leap_days = shifted_year / 4 - shifted_year / 100 + shifted_year / 400;
    let of_year = (153 * shifted_month + 2) / 5 + day.checked_sub(1)?;
    let days = (365 * shifted_year + leap_days + of_year).checked_sub(719_468)?;
    if date_of(days) != (year, month, day) {
        return None;
    }
    let seconds = 86_400 * days + 3600 * hour + 60 * minute + second;
    let since = Duration::from_secs(seconds) + Duration::from_micros(us.parse().ok()?);
    UNIX_EPOCH.checked_add(since)
}

/// Three numbers between two separators.
fn numbers(text: &str, separator: char) -> Option<[u64; 3]> {
    let parts: Option<Vec<u64>> = text
        .split(separator)
        .map(|part| part.parse().ok())
        .collect();
    parts?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_become_dates() {
        assert_eq!(date_of(0), (1970, 1, 1));
        assert_eq!(date_of(11_016), (2000, 2, 29));
        assert_eq!(date_of(11_017), (2000, 3, 1));
        assert_eq!(date_of(20_453), (2025, 12, 31));
    }

    #[test]
    fn moments_are_written_as_the_standard_says() {
        let at = UNIX_EPOCH + Duration::from_micros(951_827_696_000_789);
        assert_eq!(rfc3339(at), "2000-02-29T12:34:56.000789Z");
        let before = UNIX_EPOCH - Duration::from_secs(5);
        assert_eq!(rfc3339(before), "1970-01-01T00:00:00.000000Z");
    }

    #[test]
    fn moments_are_read_back_and_what_is_none_is_not() {
        for us in [
            0,
            951_827_696_000_789,
            951_868_799_999_999,
            1_798_761_600_000_001,
        ] {
            let at = UNIX_EPOCH + Duration::from_micros(us);
            assert_eq!(moment_of(&rfc3339(at)), Some(at), "{us}");
        }
        for text in [
            "",
            "2000-02-30T12:34:56.000789Z",
            "2000-13-01T12:34:56.000789Z",
            "1969-12-31T23:59:59.000000Z",
            "2000-02-29T24:00:00.000000Z",
            "2000-02-00T12:34:56.000000Z",
            "2000-02-29T12:34:56Z",
            "2000-02-29 12:34:56.000789Z",
        ] {
            assert_eq!(moment_of(text), None, "{text}");
        }
    }
}
