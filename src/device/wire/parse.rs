//! Faults as people write them: `5s`, `300ms`, `0.1%`, `5s+2s`. Each refusal is one line
//! that says what was expected.

use std::time::Duration;

use super::faults::{Latency, OneOff, OneOffKind};

/// The longest time that can be asked for.
const LONGEST: Duration = Duration::from_hours(1000);

/// A time in µs: `5s`, `300ms`, `250us`, `2min`, `1h`.
pub(super) fn time_us(text: &str) -> Result<u64, String> {
    let refused = || format!("\"{text}\" is no time: write for example 5s, 300ms or 250us");
    let split = text.find(|letter: char| letter.is_ascii_alphabetic());
    let (number, unit) = text.split_at(split.ok_or_else(refused)?);
    let s_each = match unit {
        "us" => 1e-6,
        "ms" => 1e-3,
        "s" => 1.0,
        "min" => 60.0,
        "h" => 3600.0,
        _ => return Err(refused()),
    };
    let number: Option<f64> = number.trim().parse().ok();
    let s = number.ok_or_else(refused)? * s_each;
    let time = Duration::try_from_secs_f64(s).ok();
    let time = time.filter(|time| *time <= LONGEST);
    time.and_then(|time| u64::try_from(time.as_micros()).ok())
        .ok_or_else(|| format!("\"{text}\": choose a time from 0 to 1000h"))
}

/// A share: `0.001` or `0.1%`.
pub(super) fn rate(text: &str) -> Result<f64, String> {
    let (number, scale) = match text.strip_suffix('%') {
        Some(number) => (number, 0.01),
        None => (text, 1.0),
    };
    let rate = number.trim().parse::<f64>().ok().map(|rate| rate * scale);
    rate.filter(|rate| (0.0..=1.0).contains(rate))
        .ok_or_else(|| format!("\"{text}\" is no share: write 0 to 1, or for example 0.1%"))
}

/// A share and, if it is said, for how long: `1%`, `0.1%:50ms`.
pub(super) fn rate_and_time(text: &str, usual_us: u64) -> Result<(f64, u64), String> {
    match text.split_once(':') {
        Some((share, time)) => Ok((rate(share)?, time_us(time)?)),
        None => Ok((rate(text)?, usual_us)),
    }
}

/// How long bytes take: towards the device and towards the host. `none`, `cdc`, `ftdi`, or a mean
/// and a standard deviation such as `5ms~2ms`.
pub(super) fn latency(text: &str) -> Result<[Latency; 2], String> {
    match text {
        "none" => return Ok([Latency::None; 2]),
        "cdc" => return Ok([Latency::UsbFrame; 2]),
        "ftdi" => return Ok([Latency::UsbFrame, Latency::Timer(16_000)]),
        _ => {}
    }
    let (mean, deviation) = text.split_once('~').unwrap_or((text, "0ms"));
    let short = |part: &str| time_us(part).ok().and_then(|us| u32::try_from(us).ok());
    match (short(mean), short(deviation)) {
        (Some(mean_us), Some(deviation_us)) => Ok([Latency::Normal {
            mean_us,
            deviation_us,
        }; 2]),
        _ => Err(format!(
            "\"{text}\" is no latency: write none, cdc, ftdi, or mean~deviation such as 5ms~2ms"
        )),
    }
}

/// When something happens and for how long: `5s`, `5s+300ms`.
pub(super) fn one_off(kind: OneOffKind, text: &str) -> Result<OneOff, String> {
    let (at_us, for_us) = match text.split_once('+') {
        Some((at, long)) => (time_us(at)?, time_us(long)?),
        None => (time_us(text)?, kind.usual_us()),
    };
    Ok(OneOff {
        at_us,
        for_us,
        kind,
    })
}

/// Two channels that move each other's contactor: `3,7`.
pub(super) fn swap(text: &str) -> Result<[u16; 2], String> {
    let channels = text.split_once(',');
    let both = channels.and_then(|(a, b)| Some([a.trim().parse().ok()?, b.trim().parse().ok()?]));
    both.ok_or_else(|| format!("\"{text}\": write two channels such as 3,7"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_and_shares_are_read_with_their_units() {
        assert_eq!(time_us("5s"), Ok(5_000_000));
        assert_eq!(time_us("1.5s"), Ok(1_500_000));
        assert_eq!(time_us("300ms"), Ok(300_000));
        assert_eq!(time_us("250us"), Ok(250));
        assert_eq!(time_us("1h"), Ok(3_600_000_000));
        assert_eq!(rate("0.25"), Ok(0.25));
        assert_eq!(rate("25%"), Ok(0.25));
        assert_eq!(rate_and_time("50%:20ms", 7), Ok((0.5, 20_000)));
        assert_eq!(rate_and_time("50%", 7), Ok((0.5, 7)));
        let stall = one_off(OneOffKind::StallReading, "5s+1s").unwrap();
        assert_eq!((stall.at_us, stall.for_us), (5_000_000, 1_000_000));
        assert_eq!(
            one_off(OneOffKind::Unplug, "2min").unwrap().for_us,
            2_000_000
        );
        assert_eq!(latency("ftdi").unwrap()[1], Latency::Timer(16_000));
        assert_eq!(swap("3, 7"), Ok([3, 7]));
    }

    #[test]
    fn what_is_not_understood_is_refused_in_one_line_that_shows_how() {
        let refusals = [
            (time_us("5").unwrap_err(), "300ms"),
            (time_us("5 parsecs").unwrap_err(), "300ms"),
            (time_us("-1s").unwrap_err(), "from 0"),
            (time_us("9999999h").unwrap_err(), "1000h"),
            (time_us("NaNs").unwrap_err(), "300ms"),
            (rate("2").unwrap_err(), "0 to 1"),
            (rate("NaN").unwrap_err(), "0 to 1"),
            (rate("often").unwrap_err(), "0.1%"),
            (latency("slow").unwrap_err(), "5ms~2ms"),
            (swap("3").unwrap_err(), "3,7"),
        ];
        for (line, word) in refusals {
            assert!(line.contains(word) && !line.contains('\n'), "{line}");
        }
    }
}
