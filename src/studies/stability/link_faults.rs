//! Faults of link and device, one kind at a time: what was injected, what the counters say, and how
//! long after the last frame there was output.
//!
//! Each streams for half a minute of virtual time, most with the fault all along; silence is
//! measured on the device's clock.

use super::case::{Case, Verdict, verdict};
use super::device::{once, refused_by_host};
use selvedge_device::{
    BridgeState, DeviceModel, Faults, FirmwareLie, InjectionKind, Latency, LinkFaults, OneOffKind,
    Simulation,
};
use selvedge_foundation::quantity::fixed;

/// The longest that output may outlast the last frame, µs of the device's clock.
const SILENT_BY_US: u64 = 100_000;
const LASTING_MS: u64 = 30_000;

/// What a device and its link may do.
pub(super) fn cases() -> Vec<Case> {
    let goes_on = "streams on; silent within 100 ms of a last frame";
    let ends = "silent within 100 ms of the last frame, told, not armed again by itself";
    let mut cases: Vec<Case> = lasting()
        .into_iter()
        .map(|(tried, faults)| Case::new("link", tried, goes_on, move || streams_on(&faults)))
        .collect();
    cases.extend(OneOffKind::ALL.into_iter().map(|kind| {
        let tried = format!("{}, {} s", kind.name(), ms_of(kind) as f64 / 1000.0);
        Case::new("link", tried, ends, move || ends_safely(kind))
    }));
    cases.extend(lies().into_iter().map(|(tried, lie)| {
        let should = "refused, with the reason";
        Case::new("link", tried, should, move || {
            let faults = Faults {
                lies: FirmwareLie::read(lie).into_iter().collect(),
                ..Faults::default()
            };
            refused_by_host(Simulation::of(DeviceModel::default(), &faults))
        })
    }));
    cases
}

/// Faults that a link lives with: bytes that are harmed, bytes and ticks that come when they should
/// not.
fn lasting() -> Vec<(&'static str, Faults)> {
    let with = |set: fn(&mut LinkFaults)| {
        let mut lane = LinkFaults::default();
        set(&mut lane);
        Faults {
            seed: 1,
            to_device: lane,
            to_host: lane,
            ..Faults::default()
        }
    };
    let slow = with(|it| {
        it.latency = Latency::Normal {
            mean_us: 3000,
            deviation_us: 1000,
        };
        (it.hiccup_rate, it.hiccup_us) = (1e-2, 50_000);
    });
    let mut ftdi = with(|it| it.latency = Latency::UsbFrame);
    ftdi.to_host.latency = Latency::Timer(16_000);
    let clock = |clock_ppm, tick_jitter_us| Faults {
        clock_ppm,
        tick_jitter_us,
        ..Faults::default()
    };
    let garbage = with(|it| it.garbage_every_us = Some(500_000));
    vec![
        ("one byte in 10 000 lost", with(|it| it.drop_rate = 1e-4)),
        ("one byte in 10 000 changed", with(|it| it.flip_rate = 1e-4)),
        (
            "one byte too many in 10 000",
            with(|it| it.insert_rate = 1e-4),
        ),
        (
            "one USB packet in 100 lost",
            with(|it| it.usb_loss_rate = 1e-2),
        ),
        ("one write in 100 twice", with(|it| it.repeat_rate = 1e-2)),
        ("a burst of garbage every 0.5 s", garbage),
        ("3 ± 1 ms, one write in 100 by 50 ms late", slow),
        ("an adapter with a 16 ms timer", ftdi),
        ("a device's clock 100 ppm fast", clock(100, 0)),
        ("a device's clock 100 ppm slow", clock(-100, 0)),
        ("ticks 3 ms off their place", clock(0, 3000)),
    ]
}

fn lies() -> [(&'static str, &'static str); 6] {
    [
        ("CAPS without a common version", "caps.version=0"),
        ("CAPS with 5 rows of 24 channels", "caps.rows=5"),
        ("CAPS with three components", "caps.components=3"),
        ("CAPS with 20 ms ticks", "caps.tick-us=20000"),
        ("CAPS with a carrier of 50 Hz", "caps.low-mhz=50000"),
        ("CAPS with bodies too short for a frame", "caps.max-body=64"),
    ]
}

/// Long enough for the device to fall silent.
fn ms_of(kind: OneOffKind) -> u64 {
    kind.usual_us().max(1_000_000) / 1000
}

fn streams_on(faults: &Faults) -> Verdict {
    let mut trial = Simulation::streaming_over(faults, LASTING_MS / 2);
    // A burst of losses disarms the device, as it should; a person arms it again.
    trial.host.arm(trial.now());
    trial.run(LASTING_MS / 2);
    let state = trial.host.state();
    let is_open = state.is_open() && trial.loudest_age_us <= SILENT_BY_US;
    verdict(is_open, describe(&trial))
}

fn ends_safely(kind: OneOffKind) -> Verdict {
    let mut trial = Simulation::streaming_over(&once(kind, ms_of(kind)), 6000);
    let is_kept = trial.is_at_rest() && trial.arms_written == 1;
    // What was told first.
    let disarmed = trial.disarmed_by().map(|(_, reason)| reason);
    let reason = disarmed.or_else(|| trial.lost());
    let reason = reason.map(str::to_owned);
    trial.open_anew();
    let is_usable = trial.run_until(2000, |it| {
        matches!(it.host.state(), BridgeState::Ready | BridgeState::Faulted)
    });
    let is_safe = is_kept && trial.loudest_age_us <= SILENT_BY_US && reason.is_some();
    let message = reason.unwrap_or_else(|| "nothing told".to_owned());
    let came_back = format!("{}; {message}", describe(&trial));
    verdict(is_safe && is_usable, came_back)
}

/// Injected, counted, and the longest output after a last frame.
fn describe(trial: &Simulation) -> String {
    let injected = trial.log.injections.iter();
    let n_injected = injected
        .filter(|it| !matches!(it.kind, InjectionKind::Ends(_)))
        .count();
    let boots = trial.device.counters_of_boots();
    let sum = |pick: fn(&selvedge_device::CoreCounters) -> u16| -> u64 {
        boots.iter().map(|counters| u64::from(pick(counters))).sum()
    };
    format!(
        "{n_injected} injected; device: {} bad, {} late, {} twice, {} missed; host: {} bad; output \
         at most {} ms after a last frame",
        sum(|c| c.bad),
        sum(|c| c.late),
        sum(|c| c.dup),
        sum(|c| c.underrun),
        trial.bad_texts_received(),
        fixed(trial.loudest_age_us as f64 / 1000.0, 1),
    )
}
