//! An hour of everything at once, after which every counter is explained.

use super::ledger::{Ledger, ledger};
use super::*;
use crate::device::FirmwareLie;
use crate::host::BridgeEvent;
use crate::session_log::VirtualLog;
use selvedge_foundation::numerics::Random;

const HOUR_MS: u64 = 3_600_000;
/// Between two faults that happen once, so that each has ended before the next.
const APART_US: u64 = 40_000_000;

/// Rare harm of every kind all along, and every half minute something worse.
fn everything(seed: u64) -> Faults {
    let mut random = Random::new(seed).branch("soak");
    let link = LinkFaults {
        latency: Latency::Normal {
            mean_us: 2000,
            deviation_us: 800,
        },
        baud: Some(1_000_000),
        hiccup_rate: 2e-4,
        hiccup_us: 50_000,
        drop_rate: 1e-5,
        flip_rate: 1e-5,
        insert_rate: 1e-5,
        usb_loss_rate: 2e-4,
        repeat_rate: 1e-3,
        garbage_every_us: Some(20_000_000),
        chatter: true,
    };
    let n_faults = HOUR_MS * 1000 / APART_US - 1;
    let once = (1..=n_faults)
        .map(|nth| {
            let kind = OneOffKind::ALL[random.index(OneOffKind::ALL.len())];
            let within_us = random.index(10_000_000) as u64;
            let for_us = 50_000 + random.index(3_000_000) as u64;
            OneOff {
                at_us: nth * APART_US + within_us,
                for_us,
                kind,
            }
        })
        .collect();
    Faults {
        seed,
        to_device: link,
        to_host: link,
        clock_ppm: 100,
        tick_jitter_us: 500,
        once,
        ..Faults::default()
    }
}

/// Somebody who connects, clears and arms again whenever that is possible, every 300 ms.
fn attend(trial: &mut Simulation, ms: u64) -> u32 {
    let mut n_armed = 0;
    for _ in 0..ms / 300 {
        trial.run(300);
        match trial.host.state() {
            BridgeState::Lost | BridgeState::Refused => trial.open_anew(),
            BridgeState::Faulted => trial.host.clear_faults(trial.now()),
            BridgeState::Ready => n_armed += u32::from(trial.host.arm(trial.now())),
            _ => {}
        }
    }
    n_armed
}

/// How often something was injected on the way to the device.
fn harm_to_device(trial: &Simulation) -> [u64; 3] {
    let way = Direction::ToDevice;
    let mut counts = [0; 3];
    for injection in &trial.log.injections {
        let kind = injection.kind;
        let bytes = [
            InjectionKind::Dropped(way),
            InjectionKind::Flipped(way),
            InjectionKind::Inserted(way),
        ];
        if bytes.contains(&kind) {
            counts[0] += injection.amount;
        } else if [InjectionKind::UsbLost(way), InjectionKind::Overflow(way)].contains(&kind) {
            counts[0] += 1;
        } else if kind == InjectionKind::Repeated(way) {
            counts[1] += 1;
        } else if [InjectionKind::Garbage(way), InjectionKind::Chatter(way)].contains(&kind) {
            counts[2] += injection.amount;
        }
    }
    counts
}

fn begun(trial: &Simulation, kinds: &[OneOffKind]) -> u64 {
    let begins = |injection: &&Injection| match injection.kind {
        InjectionKind::Begins(kind) => kinds.contains(&kind),
        _ => false,
    };
    trial.log.injections.iter().filter(begins).count() as u64
}

#[test]
fn after_an_hour_of_everything_every_counter_is_explained() {
    let faults = everything(11);
    let mut trial = Simulation::of(DeviceModel::default(), &faults);
    trial.device.tap.is_open = true;
    let n_armed = attend(&mut trial, HOUR_MS);
    let ledger = ledger(&trial.device.tap.entries);
    let boots = trial.device.counters_of_boots();
    let sum = |pick: fn(&crate::CoreCounters) -> u16| -> u64 {
        boots.iter().map(|counters| u64::from(pick(counters))).sum()
    };
    let counted = Ledger {
        bad: sum(|c| c.bad),
        late: sum(|c| c.late),
        dup: sum(|c| c.dup),
        underrun: sum(|c| c.underrun),
        ..ledger
    };
    // What the device counted is what arrived at it, text for text and frame for frame.
    assert_eq!(counted, ledger);
    check_against_injections(&trial, &ledger);
    // Silence, always; and never armed but by a person.
    assert!(trial.loudest_age_us <= 100_000, "{}", trial.loudest_age_us);
    assert!(ledger.armed <= u64::from(n_armed), "{ledger:?}, {n_armed}");
    assert!(ledger.armed > 60, "it was worth an hour: {ledger:?}");
    let streamed = ledger.frames as f64 / (HOUR_MS as f64 / 25.0);
    assert!(streamed > 0.8, "most of the hour was played: {streamed}");
}

/// Each loss has its injection, each injection its bound.
fn check_against_injections(trial: &Simulation, ledger: &Ledger) {
    let [harms, repeats, foreign_bytes] = harm_to_device(trial);
    let sent = trial.sent.len() as u64;
    // A repeated write is one more frame; a harmed one is one less, twice if it was repeated too.
    let arrived_once = ledger.frames + ledger.frames_lost;
    assert!(arrived_once <= sent + repeats, "{ledger:?}");
    assert!(
        sent <= arrived_once + harms,
        "{sent} sent, {harms} harms, {ledger:?}"
    );
    assert!(ledger.dup > 0 && ledger.dup <= repeats, "{ledger:?}");
    // A harm splits a text in two at most; foreign text is bad at most once in two bytes. A cable
    // or a boot cuts one text each.
    let cuts = begun(trial, &OneOffKind::ALL);
    let most_bad = 2 * harms + foreign_bytes.div_ceil(2) + cuts + 2 * repeats;
    assert!(ledger.bad > 0 && ledger.bad <= most_bad, "{ledger:?}");
    let boots = begun(trial, &[OneOffKind::Reboot, OneOffKind::Watchdog]);
    assert_eq!(ledger.boots, boots);
    let faults = begun(
        trial,
        &[
            OneOffKind::Watchdog,
            OneOffKind::OverTemperature,
            OneOffKind::OverCurrent,
            OneOffKind::HvSag,
        ],
    );
    assert_eq!(ledger.faulted, faults, "each fault once, and cleared");
    assert!(ledger.late > 0 && ledger.underrun > 0 && ledger.refused > 0);
}

#[test]
fn without_faults_the_ledger_is_clean() {
    let mut trial = Simulation::of(DeviceModel::default(), &Faults::default());
    trial.device.tap.is_open = true;
    attend(&mut trial, 60_000);
    let found = ledger(&trial.device.tap.entries);
    let frames = trial.sent.len() as u64;
    assert!(frames > 2300);
    let clean = Ledger {
        frames,
        armed: 1,
        ..Ledger::default()
    };
    assert_eq!(found, clean);
}

/// A link that mostly works.
fn worn() -> LinkFaults {
    LinkFaults {
        latency: Latency::Normal {
            mean_us: 2000,
            deviation_us: 800,
        },
        drop_rate: 1e-5,
        flip_rate: 1e-5,
        usb_loss_rate: 2e-4,
        repeat_rate: 1e-3,
        ..LinkFaults::default()
    }
}

/// Somebody tries for 35 s to feel something on a device that lies so. Gives how often the session
/// ended for a reason of the device; the log has the words of each.
fn ends_of(lie: FirmwareLie, seed: u64) -> usize {
    let faults = Faults {
        seed,
        to_device: worn(),
        to_host: worn(),
        lies: vec![lie],
        ..Faults::default()
    };
    let mut trial = Simulation::of(DeviceModel::default(), &faults);
    trial.host.keep_notes();
    trial.record = Some(VirtualLog::new(trial.start, false));
    let n_armed = attend(&mut trial, EACH_MS);
    // ARM is sent again eight times at most; nobody else arms.
    assert!(trial.arms_written <= 9 * n_armed, "{lie}");
    let log = trial.record.take().unwrap().finish();
    let ends = trial.events.iter().filter_map(|event| match event {
        BridgeEvent::Disarmed {
            by: DisarmedBy::Device,
            reason,
        } => Some(reason),
        _ => None,
    });
    let ends: Vec<&String> = ends.collect();
    let told = log.matches(",disarmed-itself,").count();
    assert_eq!(told, ends.len(), "{lie}: {ends:?}");
    for reason in &ends {
        assert!(log.contains(reason.as_str()), "{lie}: {reason}");
    }
    ends.len()
}

/// How long each lie is tried: all of them take four hours.
const EACH_MS: u64 = 35_000;

#[test]
fn in_four_hours_of_lies_over_a_worn_link_the_log_has_the_reason_of_every_end() {
    let (mut n_lies, mut n_ends) = (0, 0);
    for (seed, lie) in (1..).zip(FirmwareLie::examples()) {
        n_ends += ends_of(lie, seed);
        n_lies += 1;
    }
    assert!(n_lies * EACH_MS >= 4 * HOUR_MS, "{n_lies} lies");
    assert!(n_ends > 200, "it was worth four hours: {n_ends}");
}
