//! The real-time front ends. Only counters, states and the device's clock are asserted, never a
//! duration of ours.

use std::time::{Duration, Instant};

use super::*;
use crate::framing::Decoder;
use crate::message::{DeviceMessage, Hello, Message as _};
use crate::wire::{OneOff, OneOffKind};

/// Reads until a message satisfies `wanted`, for at most 20 s.
fn wait_for(port: &mut dyn Port, wanted: impl Fn(&DeviceMessage) -> bool) -> DeviceMessage {
    let deadline = Instant::now() + Duration::from_secs(20);
    let mut decoder = Decoder::new(1024);
    let mut buffer = [0; 256];
    while Instant::now() < deadline {
        let count = port.read(&mut buffer, Duration::from_millis(50)).unwrap();
        for &byte in &buffer[..count] {
            if let Some(packet) = decoder.push(byte)
                && let Ok(message) = DeviceMessage::decode(&packet, 24)
                && wanted(&message)
            {
                return message;
            }
        }
    }
    panic!("nothing came");
}

fn greet(port: &mut dyn Port, session: u32) {
    port.write(
        Hello::new(session).packet(1).unwrap().as_bytes(),
        Duration::from_secs(1),
    )
    .unwrap();
    wait_for(
        port,
        |m| matches!(m, DeviceMessage::Caps(caps) if caps.session == session),
    );
    wait_for(port, |m| matches!(m, DeviceMessage::Status(_)));
}

#[test]
fn an_emulator_in_process_answers_and_ticks() {
    let mut port = EmulatorThread::start(DeviceModel::default(), &Faults::default(), None).unwrap();
    greet(&mut port, 7);
}

#[test]
fn an_emulator_in_process_whose_cable_is_pulled_ends_its_link() {
    let unplug = OneOff {
        at_us: 200_000,
        for_us: 50_000,
        kind: OneOffKind::Unplug,
    };
    let faults = Faults {
        once: vec![unplug],
        ..Faults::default()
    };
    let mut port = EmulatorThread::start(DeviceModel::default(), &faults, None).unwrap();
    let mut buffer = [0; 256];
    let error = loop {
        match port.read(&mut buffer, Duration::from_millis(50)) {
            Ok(_) => {}
            Err(error) => break error,
        }
    };
    assert_eq!(error.kind(), io::ErrorKind::BrokenPipe);
}

#[cfg(unix)]
mod behind_a_pty {
    use std::fs;
    use std::path::PathBuf;
    use std::sync::Arc;
    use std::thread::JoinHandle;

    use super::*;
    use crate::BridgeError;
    use crate::port::SerialLink;
    use selvedge_scratch::ScratchFolder;

    type Running = (Arc<AtomicBool>, JoinHandle<Result<(), BridgeError>>);

    fn run(emulator: PtyEmulator) -> Running {
        let stop = Arc::new(AtomicBool::new(false));
        let seen = Arc::clone(&stop);
        let thread = Builder::new().spawn(move || emulator.run(&seen)).unwrap();
        (stop, thread)
    }

    #[test]
    fn a_host_finds_it_by_its_link_and_may_come_again() {
        let folder = ScratchFolder::made("again");
        let (link, log) = (folder.join("array"), folder.join("log.csv"));
        let emulator = PtyEmulator::new(DeviceModel::default(), &link, Some(&log)).unwrap();
        let (stop, thread) = run(emulator);
        for session in [7, 8] {
            let mut port = SerialLink::open(&link.display().to_string()).unwrap();
            greet(&mut port, session);
        }
        stop.store(true, Ordering::Release);
        thread.join().unwrap().unwrap();
        assert!(fs::symlink_metadata(&link).is_err(), "the link is removed");
        let log = fs::read_to_string(&log).unwrap();
        let mut lines = log.lines();
        let header = lines.next().unwrap();
        assert!(header.starts_with("dev_us,tick,event,state,seq,age_ms,gain,amp_sum,a40_0,a320_0"));
        assert!(lines.next().unwrap().contains(",state,READY,,65535,1,0,"));
        assert!(log.lines().all(|line| line.split(',').count() == 8 + 48));
    }

    #[test]
    fn a_pulled_cable_ends_the_port_and_the_device_comes_back_under_another_name() {
        let folder = ScratchFolder::made("replug");
        let (link, log) = (folder.join("array"), folder.join("log.csv"));
        let unplug = OneOff {
            at_us: 400_000,
            for_us: 300_000,
            kind: OneOffKind::Unplug,
        };
        let faults = Faults {
            once: vec![unplug],
            ..Faults::default()
        };
        let model = DeviceModel::default();
        let emulator = PtyEmulator::with_faults(model, &faults, &link, Some(&log)).unwrap();
        let mut port = SerialLink::open(&link.display().to_string()).unwrap();
        let (stop, thread) = run(emulator);
        let mut buffer = [0; 256];
        while port.read(&mut buffer, Duration::from_millis(50)).is_ok() {}
        assert!(port.write(&[0], Duration::ZERO).is_err());
        let again = folder.join("array-2");
        while fs::symlink_metadata(&again).is_err() {
            std::thread::sleep(Duration::from_millis(10));
        }
        assert!(fs::symlink_metadata(&link).is_err(), "the old name is gone");
        let mut port = SerialLink::open(&again.display().to_string()).unwrap();
        greet(&mut port, 9);
        stop.store(true, Ordering::Release);
        thread.join().unwrap().unwrap();
        assert!(fs::symlink_metadata(&again).is_err());
        let log = fs::read_to_string(&log).unwrap();
        let begins = log
            .lines()
            .find(|line| line.contains("fault unplug begins"));
        assert!(
            begins.unwrap().starts_with("400000,16,fault unplug"),
            "{log}"
        );
        assert!(log.contains(",fault unplug ends 300000 us,"), "{log}");
        assert!(log.lines().all(|line| line.split(',').count() == 8 + 48));
    }

    #[test]
    fn only_links_to_terminals_are_replaced() {
        let folder = ScratchFolder::made("taken");
        let (file, link) = (folder.join("file"), folder.join("link"));
        fs::write(&file, "precious").unwrap();
        let refused = |path: &std::path::Path| {
            PtyEmulator::new(DeviceModel::default(), path, None)
                .unwrap_err()
                .to_string()
        };
        assert!(refused(&file).contains("is not a link to a terminal"));
        std::os::unix::fs::symlink(&file, &link).unwrap();
        assert!(refused(&link).contains("is not a link to a terminal"));
        assert_eq!(fs::read_to_string(&file).unwrap(), "precious");
        assert!(refused(&folder.join("none/array")).contains("cannot make the link"));
        fs::remove_file(&link).unwrap();
        std::os::unix::fs::symlink("/dev/pts/999999", &link).unwrap();
        let emulator = PtyEmulator::new(DeviceModel::default(), &link, None).unwrap();
        assert_eq!(
            fs::read_link(&link).unwrap(),
            PathBuf::from(emulator.device_path())
        );
        drop(emulator);
        assert!(fs::symlink_metadata(&link).is_err());
    }
}
