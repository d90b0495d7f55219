//! Logs as files: what is in them, how they grow, and what becomes of them when they are full.

use std::fs;

use super::*;
use crate::handle::tests::rested;
use crate::host::BridgeState;
use crate::message::{Message as _, Status, StopHow, frame, kind};
use crate::wire::{Faults, Simulation};
use crate::{ArrayProfile, Bridge, BridgeEvent, DeviceModel, Target};
use read::{Line, Unreadable};
use selvedge_foundation::numerics::Random;
use selvedge_scratch::ScratchFolder;

fn entry(note: Note) -> Entry {
    Entry {
        at: Instant::now(),
        tick: Some(1),
        device_us: Some(25_000),
        note,
    }
}

#[test]
fn a_log_is_continued_and_keeps_its_one_header() {
    let folder = ScratchFolder::new("continued");
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join("link.csv");
    for _ in 0..2 {
        let log = SessionLog::append(&path, None).unwrap();
        let mut feed = log.feed("emulator");
        feed.push(entry(Note::Arm));
        log.finish().unwrap();
    }
    let text = fs::read_to_string(&path).unwrap();
    let events: Vec<_> = text.lines().map(|line| line.split(',').nth(4)).collect();
    let expected = ["event", "link", "arm", "link", "arm"].map(Some);
    assert_eq!(events, expected, "{text}");
}

#[test]
fn a_link_tells_its_whole_life() {
    let folder = ScratchFolder::new("life");
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join("link.csv");
    let log = SessionLog::append(&path, None).unwrap();
    let mut bridge = Bridge::open(Target::Emulator, ArrayProfile::default(), 24, || {});
    bridge.log_to(log.feed(bridge.target()));
    let deadline = Instant::now() + Duration::from_secs(20);
    while bridge.counters().frames_sent < 3 {
        assert!(Instant::now() < deadline);
        match bridge.poll() {
            Some(BridgeEvent::Ready(_)) => assert!(bridge.arm()),
            Some(BridgeEvent::Tick { .. }) => drop(bridge.send(&[[1.0, 1.0]; 24], None)),
            Some(_) => {}
            None => thread::sleep(Duration::from_millis(1)),
        }
    }
    rested(bridge);
    log.finish().unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let events: Vec<_> = text
        .lines()
        .filter_map(|line| line.split(',').nth(4))
        .collect();
    let mut places = [
        "link", "hello", "caps", "config", "cfg", "arm", "armed", "stop", "stopped",
    ]
    .map(|wanted| events.iter().position(|event| *event == wanted));
    assert!(
        places.iter().all(Option::is_some) && places.is_sorted(),
        "{text}"
    );
    places.sort_unstable();
    let stopped = text.lines().nth(places[8].unwrap()).unwrap();
    let tick: u64 = stopped.split(',').nth(2).unwrap().parse().unwrap();
    let device_us: u64 = stopped.split(',').nth(3).unwrap().parse().unwrap();
    assert!(
        tick > 0 && device_us.abs_diff(tick * 25_000) < 60_000,
        "{stopped}"
    );
    assert!(
        text.contains("state=RUN") && text.contains("state=READY"),
        "{text}"
    );
}

#[test]
fn two_links_write_to_one_log_and_a_full_ring_says_how_much_is_missing() {
    let folder = ScratchFolder::new("two");
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join("link.csv");
    let log = SessionLog::append(&path, None).unwrap();
    let mut first = log.feed("a");
    log.feed("b").push(entry(Note::Stopped));
    // The writer sleeps: this many do not fit.
    let before = log.shared.sources();
    (0..400).for_each(|_| first.push(entry(Note::Arm)));
    drop(before);
    while first.entries.slots() < MAX_ENTRIES {
        thread::sleep(Duration::from_millis(5));
    }
    first.push(entry(Note::Armed));
    log.finish().unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let count = |event: &str| text.matches(&format!(",{event},")).count();
    assert_eq!((count("link"), count("stopped")), (2, 1));
    let n_lost: usize = text
        .split("entries-lost,\"n=")
        .nth(1)
        .unwrap()
        .split('"')
        .next()
        .unwrap()
        .parse()
        .unwrap();
    assert_eq!((count("arm") + n_lost, count("armed")), (400, 1));
}

#[test]
fn a_bounded_log_makes_way_and_forgets_the_oldest() {
    let folder = ScratchFolder::new("bounded");
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join("link.csv");
    let bound = LogBound {
        bytes: 400,
        n_older: 2,
    };
    let mut file = LogFile::open(&path, Some(bound)).unwrap();
    for number in 0..40 {
        file.add(&format!("line {number:03} of some length that fills it\n"))
            .unwrap();
        if file.is_full() {
            file.make_way().unwrap();
        }
    }
    let mut names: Vec<_> = fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["link-1.csv", "link-2.csv", "link.csv"]);
    for name in names {
        let text = fs::read_to_string(folder.join(name)).unwrap();
        assert!(text.len() < 450 && text.starts_with("utc,"), "{text}");
    }
    let newest = fs::read_to_string(&path).unwrap();
    assert!(!newest.contains("line 001"), "{newest}");
}

#[test]
fn a_log_that_cannot_be_written_says_so_at_once() {
    let folder = ScratchFolder::new("unwritable");
    fs::create_dir_all(&folder).unwrap();
    let error = SessionLog::append(&folder, None).unwrap_err().to_string();
    assert!(error.starts_with("cannot write the session log"), "{error}");
}

/// Every line of a text, as far as it is readable.
fn read(text: &[u8]) -> Result<Vec<Line>, Unreadable> {
    let mut reader = LogReader::new(text);
    let mut lines = Vec::new();
    while let Some(line) = reader.next()? {
        lines.push(line);
    }
    Ok(lines)
}

/// A session of a second and a half in virtual time, with equal frames and others.
fn short_log(keeps_frames: bool) -> String {
    let mut simulation = Simulation::of(DeviceModel::default(), &Faults::default());
    simulation.host.keep_notes();
    simulation.record = Some(VirtualLog::new(simulation.start, keeps_frames));
    simulation.run_until(5000, |it| it.host.state() == BridgeState::Ready);
    simulation.host.arm(simulation.now());
    simulation.run(1000);
    for um in [5.0, 7.0, 1.0] {
        simulation.amplitude_um = [um, 3.0];
        simulation.run(60);
    }
    simulation.host.stop(simulation.now(), StopHow::Ramp);
    simulation.run(200);
    simulation.record.unwrap().finish()
}

#[test]
fn a_link_s_packets_are_recorded_to_the_byte() {
    let folder = ScratchFolder::new("packets");
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join("link.csv");
    let log = SessionLog::append(&path, None).unwrap();
    let mut bridge = Bridge::open(Target::Emulator, ArrayProfile::default(), 24, || {});
    bridge.log_to(log.feed(bridge.target()));
    let deadline = Instant::now() + Duration::from_secs(20);
    let mut written = Vec::new();
    while bridge.counters().frames_sent < 30 {
        assert!(Instant::now() < deadline);
        match bridge.poll() {
            Some(BridgeEvent::Ready(_)) => assert!(bridge.arm()),
            Some(BridgeEvent::Tick { .. }) => {
                let um = f32::from(u8::try_from(written.len() / 4 % 100).unwrap());
                written.extend(bridge.send(&[[um, 1.0]; 24], None));
            }
            Some(_) => {}
            None => thread::sleep(Duration::from_millis(1)),
        }
    }
    let n_sent = bridge.counters().frames_sent;
    rested(bridge);
    log.finish().unwrap();
    let lines = read(&fs::read(&path).unwrap()).unwrap();
    let frames: Vec<&Body> = lines
        .iter()
        .filter_map(|line| match &line.seen {
            Seen::Sent(body) if body.kind == kind::FRAME => Some(body),
            _ => None,
        })
        .collect();
    assert!(frames.len() as u64 >= n_sent.min(30), "{}", frames.len());
    for body in frames {
        let sent = written.iter().find(|sent| sent.seq == body.seq).unwrap();
        assert_eq!(body.payload()[..4], sent.apply_tick.to_le_bytes());
        assert_eq!(body.payload().len(), 100);
    }
    let has = |wanted: u8| {
        lines
            .iter()
            .any(|line| matches!(&line.seen, Seen::Received(body) if body.kind == wanted))
    };
    assert!(
        [kind::CAPS, kind::CFG, kind::ACK, kind::STATUS]
            .iter()
            .all(|kind| has(*kind))
    );
    let text = fs::read_to_string(&path).unwrap();
    for event in [
        event::TELEMETRY,
        event::DEVICE_COUNTERS,
        event::HOST_COUNTERS,
    ] {
        assert!(text.contains(&format!(",{event},")), "{event}: {text}");
    }
    assert!(
        text.contains(" mask=00ffffff") && text.contains("freq_mhz=40000/320000"),
        "{text}"
    );
}

#[test]
fn a_log_that_ends_anywhere_is_readable_up_to_there() {
    for keeps_frames in [true, false] {
        let text = short_log(keeps_frames);
        let whole = read(text.as_bytes()).unwrap();
        assert!(whole.len() > 100, "{}", whole.len());
        let mut longest = 0;
        for length in 1..text.len() {
            let lines = read(&text.as_bytes()[..length]).unwrap();
            assert!(whole.starts_with(&lines), "cut at {length}");
            longest = longest.max(lines.len());
            // What is missing is the line that was cut, or a count of frames.
            let n_lines = text[..length].matches('\n').count().saturating_sub(1);
            assert!(lines.len() >= n_lines, "cut at {length}");
        }
    }
}

#[test]
fn a_log_that_was_cut_is_continued_and_its_cut_line_dropped() {
    let folder = ScratchFolder::new("cut");
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join("link.csv");
    let text = short_log(true);
    // In the middle of a number that would be one without its end too.
    let at = text.rfind(",s,").unwrap() + ",s,1".len();
    fs::write(&path, &text[..at]).unwrap();
    let log = SessionLog::append(&path, None).unwrap();
    drop(log.feed("again"));
    log.finish().unwrap();
    let lines = read(&fs::read(&path).unwrap()).unwrap();
    let (before, last) = (read(&text.as_bytes()[..at]).unwrap(), lines.last().unwrap());
    assert_eq!(lines.len(), before.len() + 1);
    assert!(matches!(&last.seen, Seen::Note(name, _) if name == event::LINK));
}

#[test]
fn equal_frames_stand_once_with_their_number_and_come_back_one_by_one() {
    let text = short_log(true);
    let n_again = text.matches(",frame-again,").count();
    assert!((1..=6).contains(&n_again), "{text}");
    let lines = read(text.as_bytes()).unwrap();
    let frames: Vec<&Line> = lines
        .iter()
        .filter(|line| matches!(&line.seen, Seen::Sent(body) if body.kind == kind::FRAME))
        .collect();
    assert!(frames.len() > 40 && frames.len() > text.matches(",f,").count());
    let ticks: Vec<u32> = frames
        .iter()
        .map(|line| match &line.seen {
            Seen::Sent(body) => u32::from_le_bytes(body.payload()[..4].try_into().unwrap()),
            _ => 0,
        })
        .collect();
    assert!(
        ticks.windows(2).all(|pair| pair[1] == pair[0] + 1),
        "{ticks:?}"
    );
}

#[test]
fn what_is_no_log_is_refused_in_one_line_and_bounded_memory() {
    let header = line::header();
    let endless = std::io::BufReader::new(std::io::repeat(b'x'));
    let error = LogReader::new(endless).next().unwrap_err();
    assert_eq!(error.number, 1);
    let cases: [(&str, u64, &str); 7] = [
        ("", 0, "is empty"),
        ("t_s,x_mm,y_mm\n0,1,2\n", 1, "is no session log"),
        (
            &format!("{header}nonsense\n"),
            2,
            "no line of a session log",
        ),
        (
            &format!("{header},1.5,,,frame,1 zz\n"),
            2,
            "\"frame\" that cannot be",
        ),
        (&format!("{header},1.5,,,frame-again,5\n"), 2, "cannot be"),
        (&format!("{header},+15,,,in,ACK 1\n"), 2, "cannot be"),
        (&format!("{header}{}", "y".repeat(40_000)), 2, "no end"),
    ];
    for (text, number, words) in cases {
        let error = read(text.as_bytes()).unwrap_err();
        assert_eq!(error.number, number, "{text:.60}");
        assert!(error.reason.contains(words), "{error:?}");
        assert_eq!(error.reason.lines().count(), 1);
    }
}

/// The log of an hour in which codes take steps of this standard deviation, in so many of three
/// stretches of 10 s; and the number of ticks in which they are equal.
fn hour(deviation: f64, n_of_three: u32) -> (String, usize) {
    let start = Instant::now();
    let mut log = VirtualLog::new(start, true);
    let mut random = Random::new(7);
    let mut codes = [[4000_u16, 2500]; 24];
    let (mut seq, mut n_equal) = (0_u16, 0);
    for tick in 0..144_000_u32 {
        let at = start + Duration::from_micros(u64::from(tick) * 25_000 + 1100);
        let status = Status {
            tick,
            dev_us: tick.wrapping_mul(25_000),
            last_seq: seq,
            state: 3,
            queued: 0,
            age_ms: 12 + u16::try_from(tick % 3).unwrap(),
            amp_sum: codes.iter().flatten().map(|code| u32::from(*code)).sum(),
            ..Status::default()
        };
        let packet = status
            .packet(u16::try_from(tick & 0xffff).unwrap())
            .unwrap();
        log.received(at, &Body::of_wire(packet.as_bytes()).unwrap());
        seq = seq.wrapping_add(1);
        if tick % 40 == 0 {
            let packet = crate::Ping { token: tick }.packet(seq).unwrap();
            log.sent(at, &packet);
            seq = seq.wrapping_add(1);
        }
        if tick / 400 % 3 < n_of_three {
            for code in codes.iter_mut().flatten() {
                let moved = f64::from(*code) + random.normal() * deviation;
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "clamped"
                )]
                let moved = moved.clamp(500.0, 9000.0) as u16;
                *code = moved;
            }
        } else {
            n_equal += 1;
        }
        let packet = frame::packet(seq, tick + 1, &codes).unwrap();
        log.sent(at + Duration::from_millis(12), &packet);
    }
    (log.finish(), n_equal)
}

#[test]
fn an_hour_takes_about_sixteen_megabytes_however_the_finger_moves() {
    // At rest a third of the time; always in motion; in motion so fast that neighbouring ticks have
    // little in common.
    for (deviation, n_of_three, largest) in [(150.0, 2, 13.0), (150.0, 3, 17.0), (1500.0, 3, 20.0)]
    {
        let (text, n_equal) = hour(deviation, n_of_three);
        let megabytes = text.len() as f64 / 1e6;
        println!("steps of {deviation} in {n_of_three} of 3 stretches: {megabytes:.1} MB an hour");
        assert!(megabytes < largest, "{deviation}: {megabytes} MB");
        let n_frames = text.matches(",f,").count();
        assert!(n_frames <= 144_000 - n_equal * 9 / 10, "{n_frames}");
        let mut reader = LogReader::new(text.as_bytes());
        let mut n_read = 0;
        while let Some(line) = reader.next().unwrap() {
            n_read +=
                usize::from(matches!(&line.seen, Seen::Sent(body) if body.kind == kind::FRAME));
        }
        assert_eq!(n_read, 144_000);
    }
}

#[test]
fn a_missing_folder_is_not_made() {
    let folder = ScratchFolder::new("missing");
    let path = folder.join("deep/link.csv");
    let error = SessionLog::append(&path, None).unwrap_err().to_string();
    assert!(error.contains("there is no folder"), "{error}");
    assert!(!folder.join("deep").exists());
}

#[test]
fn every_event_stands_in_the_guide() {
    let guide = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/guide/bridge.md");
    let guide = fs::read_to_string(guide).unwrap();
    for name in events::EVENTS {
        assert!(guide.contains(&format!("`{name}`")), "{name}");
    }
}
