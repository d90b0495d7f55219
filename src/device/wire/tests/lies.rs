//! Devices that are not what they say: refused with a line, and never armed.

use super::*;
use crate::device::{FirmwareLie, Miswiring};
use crate::message::{Ident, Message as _};

fn read(lies: &[&str]) -> Vec<FirmwareLie> {
    let read = lies.iter().map(|lie| FirmwareLie::read(lie));
    read.collect::<Result<_, _>>().unwrap()
}

fn liar(lies: &[&str]) -> Simulation {
    let faults = Faults {
        lies: read(lies),
        ..Faults::default()
    };
    let mut trial = Simulation::of(DeviceModel::default(), &faults);
    trial.run(1000);
    assert!(!trial.host.arm(trial.now()));
    trial.run(6000);
    assert_eq!(trial.arms_written, 0);
    assert!(trial.is_at_rest());
    trial
}

#[test]
fn every_lie_is_refused_with_its_reason() {
    for (lie, words) in [
        ("caps.version=0", "version"),
        ("caps.version=2", "version"),
        ("caps.rows=5", "5 rows"),
        ("caps.cols=5", "5 columns"),
        ("caps.channels=25", "25 channels"),
        ("caps.components=1", "components"),
        ("caps.tick-us=20000", "20000 µs"),
        ("caps.low-mhz=50000", "50"),
        ("caps.high-mhz=250000", "250"),
        ("caps.max-body=107", "107 bytes"),
    ] {
        let trial = liar(&[lie]);
        let reason = trial.refused().unwrap_or_default();
        assert!(reason.contains(words), "{lie:?}: {reason}");
        assert!(!reason.contains('\n'));
        assert_eq!(trial.host.state(), BridgeState::Refused, "{lie:?}");
    }
}

#[test]
fn a_device_of_another_shape_that_agrees_with_itself_is_refused_too() {
    let trial = liar(&["caps.rows=5", "caps.cols=5", "caps.channels=25"]);
    assert!(trial.refused().unwrap().contains("24 contactors"));
}

#[test]
fn caps_that_are_cut_short_at_any_byte_are_no_answer() {
    for length in (1..78).step_by(13) {
        let trial = liar(&[&format!("caps.cut={length}")]);
        assert_eq!(trial.host.state(), BridgeState::Lost, "{length}");
        assert!(trial.lost().unwrap().contains("no answer"), "{length}");
        assert!(trial.bad_texts_received() >= 19, "one for each HELLO");
    }
    let trial = Simulation::streaming_over(
        &Faults {
            lies: read(&["caps.cut=78", "caps.cut=255"]),
            ..Faults::default()
        },
        500,
    );
    assert_eq!(trial.host.state(), BridgeState::Streaming, "78 is all");
}

#[test]
fn a_dead_channel_moves_nothing_and_swapped_ones_move_each_other() {
    let faults = Faults {
        wiring: Miswiring {
            dead: vec![3],
            swapped: vec![[5, 6]],
        },
        ..Faults::default()
    };
    let mut trial = Simulation::of(DeviceModel::default(), &faults);
    trial.run(100);
    assert!(trial.host.arm(trial.now()));
    trial.run(2);
    for (channel, moves) in [(3, None), (5, Some(6)), (6, Some(5)), (7, Some(7))] {
        let ident = Ident {
            channel,
            ms: 5,
            amp: 9000,
        };
        trial.host_writes(&ident.packet(900 + channel).unwrap());
        let output = trial.device.core().output();
        let moving = output.iter().position(|codes| *codes != [0; 2]);
        assert_eq!(moving, moves, "channel {channel}");
        trial.run(1);
    }
}

/// What becomes of a session with a device that lies so: armed as soon as it may be, three seconds
/// of frames, then STOP.
fn outcome(lie: &FirmwareLie) -> String {
    let faults = Faults {
        lies: vec![*lie],
        ..Faults::default()
    };
    let mut trial = Simulation::of(DeviceModel::default(), &faults);
    trial.run_until(6000, |it| {
        it.host.state() == BridgeState::Ready || !it.host.state().is_open()
    });
    let armed = trial.host.arm(trial.now());
    trial.run(3000);
    let before_stop = trial.host.state();
    trial.host.stop(trial.now(), crate::message::StopHow::Ramp);
    trial.run(4000);
    let one_line = |line: &str| {
        assert!(!line.is_empty() && !line.contains('\n'), "{line}");
        line.to_owned()
    };
    let found = match (trial.refused(), trial.disarmed_by(), trial.lost()) {
        (Some(line), ..) => format!("refused: {}", one_line(line)),
        (_, Some((DisarmedBy::Device, line)), _) => format!("ended: {}", one_line(line)),
        (_, _, Some(line)) => format!("lost: {}", one_line(line)),
        _ if !armed => format!("never armed: {}", before_stop.label()),
        _ => {
            let counters = trial.host.counters();
            let (astray, bad) = (counters.stray_status > 0, trial.bad_texts_received() > 0);
            let counted = match (astray, bad) {
                (true, _) => ", STATUS astray counted",
                (_, true) => ", broken bytes counted",
                _ => "",
            };
            format!("played and stopped{counted}")
        }
    };
    let loud = if trial.is_loud() {
        "; the device ignores STOP"
    } else {
        ""
    };
    format!("{found}{loud}")
}

/// `lie | outcome` of every lie of the table with every value to try it with.
#[test]
fn every_lie_ends_as_it_is_written() {
    let rows = FirmwareLie::examples().map(|lie| format!("{lie} | {}\n", outcome(&lie)));
    let table: String = rows.collect();
    let written = include_str!("lies.txt");
    if table != written {
        let place = std::env::temp_dir().join("selvedge-lies.txt");
        std::fs::write(&place, &table).unwrap();
        let differs = |(new, old): &(&str, &str)| new != old;
        let first = table.lines().zip(written.lines()).find(differs);
        panic!("{first:?}; all of it is in {}", place.display());
    }
}
