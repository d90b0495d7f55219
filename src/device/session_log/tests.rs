//! Logs as files: what is in them, how they grow, and what becomes of them when they are full.

use std::fs;

use super::*;
use crate::{ArrayProfile, Bridge, BridgeEvent, Target};
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
    bridge.close(Duration::from_secs(20)).unwrap();
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
    let path = folder.join("link.csv");
    let log = SessionLog::append(&path, None).unwrap();
    let mut first = log.feed("a");
    log.feed("b").push(entry(Note::Stopped));
    // The writer sleeps: this many do not fit.
    let before = log.shared.feeds();
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
        .split("n=")
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
    let path = folder.join("link.csv");
    let bound = LogBound {
        bytes: 400,
        n_older: 2,
    };
    let mut file = LogFile::open(&path, Some(bound)).unwrap();
    for number in 0..40 {
        file.add(&format!("line {number:03} of some length that fills it\n"))
            .unwrap();
    }
    let mut names: Vec<_> = fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["link-1.csv", "link-2.csv", "link.csv"]);
    for name in names {
        let text = fs::read_to_string(folder.join(name)).unwrap();
        assert!(text.len() <= 400 && text.starts_with("utc,"), "{text}");
    }
    let newest = fs::read_to_string(&path).unwrap();
    assert!(newest.contains("line 039"), "{newest}");
}

#[test]
fn a_log_that_cannot_be_written_says_so_at_once() {
    let folder = ScratchFolder::new("unwritable");
    fs::create_dir_all(&folder).unwrap();
    let error = SessionLog::append(&folder, None).unwrap_err().to_string();
    assert!(error.starts_with("cannot write the session log"), "{error}");
}
