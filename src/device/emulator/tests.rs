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

    const BAUD: u32 = 1_000_000;

    type Running = (Arc<AtomicBool>, JoinHandle<Result<(), BridgeError>>);

    fn run(emulator: PtyEmulator) -> Running {
        let stop = Arc::new(AtomicBool::new(false));
        let seen = Arc::clone(&stop);
        let thread = Builder::new()
            .spawn(move || emulator.run(&seen, |_, _| {}))
            .unwrap();
        (stop, thread)
    }

    #[test]
    fn a_host_finds_it_by_its_link_and_may_come_again() {
        let folder = ScratchFolder::made("again");
        let (link, log) = (folder.join("array"), folder.join("log.csv"));
        let emulator = PtyEmulator::new(
            DeviceModel::default(),
            &Faults::default(),
            &link,
            Some(&log),
        )
        .unwrap();
        let (stop, thread) = run(emulator);
        for session in [7, 8] {
            let mut port = SerialLink::open(&link.display().to_string(), BAUD).unwrap();
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
        let emulator = PtyEmulator::new(model, &faults, &link, Some(&log)).unwrap();
        let mut port = SerialLink::open(&link.display().to_string(), BAUD).unwrap();
        let (stop, thread) = run(emulator);
        let mut buffer = [0; 256];
        while port.read(&mut buffer, Duration::from_millis(50)).is_ok() {}
        assert!(port.write(&[0], Duration::ZERO).is_err());
        let again = folder.join("array-2");
        while fs::symlink_metadata(&again).is_err() {
            std::thread::sleep(Duration::from_millis(10));
        }
        assert!(fs::symlink_metadata(&link).is_err(), "the old name is gone");
        let mut port = SerialLink::open(&again.display().to_string(), BAUD).unwrap();
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

    fn refused(path: &std::path::Path) -> String {
        let made = PtyEmulator::new(DeviceModel::default(), &Faults::default(), path, None);
        let words = made.unwrap_err().to_string();
        assert_eq!(words.lines().count(), 1, "{words}");
        words
    }

    fn lock_of(link: &std::path::Path) -> PathBuf {
        link.with_file_name("link.lock")
    }

    #[test]
    fn what_no_emulator_made_is_refused_and_stays() {
        let folder = ScratchFolder::made("taken");
        let (file, link) = (folder.join("file"), folder.join("link"));
        fs::write(&file, "precious").unwrap();
        assert!(refused(&file).contains("was not made by an emulator"));
        let (_master, slave) = serialport::TTYPort::pair().unwrap();
        let living = serialport::SerialPort::name(&slave).unwrap();
        for target in [
            file.display().to_string(),
            living,
            String::from("/dev/null"),
            folder.join("away").display().to_string(),
        ] {
            std::os::unix::fs::symlink(&target, &link).unwrap();
            assert!(refused(&link).contains("was not made by an emulator"));
            assert_eq!(fs::read_link(&link).unwrap(), PathBuf::from(&target));
            assert!(!lock_of(&link).exists(), "no lock is left");
            fs::remove_file(&link).unwrap();
        }
        assert_eq!(fs::read_to_string(&file).unwrap(), "precious");
        assert!(refused(&folder.join("none/array")).contains("cannot make the link"));
        fs::write(lock_of(&link), "precious").unwrap();
        assert!(refused(&link).contains("was not made by an emulator"));
        assert_eq!(fs::read_to_string(lock_of(&link)).unwrap(), "precious");
        fs::remove_file(lock_of(&link)).unwrap();
        std::os::unix::fs::symlink(&file, lock_of(&link)).unwrap();
        assert!(refused(&link).contains("was not made by an emulator"));
        assert_eq!(fs::read_to_string(&file).unwrap(), "precious");
    }

    #[test]
    fn a_link_that_was_left_behind_is_taken_over() {
        let folder = ScratchFolder::made("left");
        let link = folder.join("link");
        // A terminal that is gone, and one that another program was given since.
        let (_master, slave) = serialport::TTYPort::pair().unwrap();
        let given = serialport::SerialPort::name(&slave).unwrap();
        let record = format!("selvedge bridge emulate, process 7 on {given}\n");
        for (target, record) in [
            ("/dev/pts/999999", None),
            (given.as_str(), Some(record.as_str())),
        ] {
            std::os::unix::fs::symlink(target, &link).unwrap();
            if let Some(record) = record {
                fs::write(lock_of(&link), record).unwrap();
            }
            let emulator =
                PtyEmulator::new(DeviceModel::default(), &Faults::default(), &link, None).unwrap();
            let path = emulator.device_path().to_owned();
            assert_eq!(fs::read_link(&link).unwrap(), PathBuf::from(&path));
            let line = fs::read_to_string(lock_of(&link)).unwrap();
            let id = std::process::id();
            assert_eq!(
                line,
                format!("selvedge bridge emulate, process {id} on {path}\n")
            );
            drop(emulator);
            assert!(fs::symlink_metadata(&link).is_err());
            assert!(!lock_of(&link).exists());
        }
    }

    #[test]
    fn a_name_is_held_by_one_emulator_at_a_time() {
        let folder = ScratchFolder::made("held");
        let link = folder.join("link");
        let first =
            PtyEmulator::new(DeviceModel::default(), &Faults::default(), &link, None).unwrap();
        let words = refused(&link);
        let id = std::process::id();
        let wanted = format!(
            "held by another emulator, process {id} on {}",
            first.device_path()
        );
        assert!(words.contains(&wanted), "{words}");
        // Even when the link was removed by hand.
        fs::remove_file(&link).unwrap();
        assert!(refused(&link).contains("held by another emulator"));
        assert!(fs::symlink_metadata(&link).is_err());
        drop(first);
        drop(PtyEmulator::new(DeviceModel::default(), &Faults::default(), &link, None).unwrap());
    }
}
