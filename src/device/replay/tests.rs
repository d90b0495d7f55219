//! Sessions in virtual time, recorded and replayed.

use super::*;
use crate::device::{DeviceModel, FirmwareLie};
use crate::host::BridgeState;
use crate::message::StopHow;
use crate::session_log::VirtualLog;
use crate::wire::{Faults, Latency, LinkFaults, Simulation};
use crate::{ArrayProfile, Bridge, BridgeEvent, SessionLog, Target};
use selvedge_foundation::numerics::Random;
use selvedge_scratch::ScratchFolder;
use std::time::{Duration, Instant};

fn recording(faults: &Faults, keeps_frames: bool) -> Simulation {
    let mut simulation = Simulation::of(DeviceModel::default(), faults);
    simulation.host.keep_notes();
    simulation.record = Some(VirtualLog::new(simulation.start, keeps_frames));
    simulation
}

fn arm(simulation: &mut Simulation) {
    simulation.run_until(5000, |it| it.host.state() == BridgeState::Ready);
    simulation.host.arm(simulation.now());
}

/// Frames, a pause that ends in a ramp, frames again, a STOP.
fn session(simulation: &mut Simulation) {
    arm(simulation);
    simulation.run(800);
    for um in [5.0, 12.0, 2.0] {
        simulation.amplitude_um = [um, 3.0];
        simulation.run(100);
    }
    simulation.run_without_frames(300);
    simulation.run(300);
    arm(simulation);
    simulation.run(700);
    simulation.host.stop(simulation.now(), StopHow::Ramp);
    simulation.run(300);
}

fn replayed(text: &str) -> (Vec<ReplayedLink>, Vec<ReplayedTick>) {
    let mut ticks = Vec::new();
    let contactors = ContactorModel::default();
    let each = |tick: &ReplayedTick| -> Result<(), String> {
        ticks.push(tick.clone());
        Ok(())
    };
    let mut desk = Desk::new(&contactors, each);
    desk.read(text.as_bytes(), |(line, reason)| {
        format!("{line}: {reason}")
    })
    .unwrap();
    let links = std::mem::take(&mut desk.links);
    drop(desk);
    (links, ticks)
}

fn agrees(links: &[ReplayedLink], text: &str) {
    for link in links {
        assert!(link.agrees() && link.counts.judged > 50, "{link}\n{text}");
    }
}

#[test]
fn a_truthful_device_agrees_with_its_twin_and_its_ticks_are_told() {
    let mut simulation = recording(&Faults::default(), true);
    session(&mut simulation);
    let played = simulation.log.frames.clone();
    let text = simulation.record.unwrap().finish();
    let (links, ticks) = replayed(&text);
    assert_eq!(links.len(), 1);
    agrees(&links, &text);
    assert!(played.len() > 50);
    for (tick, _, codes) in played {
        let replayed = ticks.iter().find(|it| it.tick == tick).unwrap();
        if replayed.gain == 1.0 {
            assert_eq!(replayed.codes, codes, "tick {tick}");
        }
        assert_eq!(replayed.peak_um.len(), 24);
    }
    let loudest = ticks.iter().flat_map(|tick| &tick.peak_um).copied();
    assert!(loudest.fold(0.0, f64::max) > 1.0);
    let rows: Vec<u32> = ticks.iter().map(|tick| tick.tick).collect();
    assert!(
        rows.windows(2).all(|pair| pair[1] == pair[0] + 1),
        "{rows:?}"
    );
    assert!(links[0].to_string().contains("agrees in"), "{}", links[0]);
}

#[test]
fn slow_and_broken_links_do_not_make_a_truthful_device_a_liar() {
    let slow = LinkFaults {
        latency: Latency::Timer(16_000),
        ..LinkFaults::default()
    };
    let broken = LinkFaults {
        latency: Latency::Normal {
            mean_us: 2000,
            deviation_us: 800,
        },
        drop_rate: 2e-4,
        flip_rate: 1e-4,
        garbage_every_us: Some(300_000),
        ..LinkFaults::default()
    };
    for link in [slow, broken] {
        for seed in 1..20 {
            let faults = Faults {
                seed,
                to_device: link,
                to_host: link,
                clock_ppm: 80,
                ..Faults::default()
            };
            let mut simulation = recording(&faults, true);
            session(&mut simulation);
            let text = simulation.record.unwrap().finish();
            let (links, _) = replayed(&text);
            for link in links {
                assert!(link.agrees(), "seed {seed}: {link}\n{text}");
            }
        }
    }
}

/// The log with the numbers of the STATUS of one tick changed.
fn with_lie(text: &str, tick: u32, lie: impl Fn(&str) -> String) -> String {
    let mut now = 0;
    let mut changed = String::new();
    for line in text.lines() {
        let numbers = line.split_once(",,s,").map(|(head, numbers)| {
            // One more than the last where none is written.
            now = head.rsplit(',').next().unwrap().parse().unwrap_or(now + 1);
            (head, numbers)
        });
        let lied = numbers.filter(|_| now == tick);
        let lied = lied.map(|(head, numbers)| [head, ",,s,", &lie(numbers)].concat());
        changed.push_str(lied.as_deref().unwrap_or(line));
        changed.push('\n');
    }
    changed
}

#[test]
fn a_lie_is_found_at_its_tick() {
    let mut simulation = recording(&Faults::default(), true);
    arm(&mut simulation);
    simulation.run(1500);
    let text = simulation.record.unwrap().finish();
    let change = |place: usize, by: i64| {
        move |numbers: &str| {
            let mut words: Vec<String> = numbers.split(' ').map(str::to_owned).collect();
            let told: i64 = words[place].parse().unwrap();
            words[place] = (told + by).to_string();
            words.join(" ")
        }
    };
    let sum = with_lie(&text, 40, change(1, 1));
    let (links, _) = replayed(&sum);
    let (tick, first) = links[0].first.clone().unwrap();
    assert_eq!((tick, first.what), (40, "amp_sum"), "{}", links[0]);
    let line = links[0].to_string();
    assert!(
        line.contains(&format!("amp_sum {}", first.device)),
        "{line}"
    );
    assert_eq!(links[0].disagreements.len(), 1, "{line}");
    for (what, words) in [
        ("state", " state=4"),
        ("queued", " queued=3"),
        ("underrun", " underrun=7"),
        ("late", " late=2"),
        ("clipped", " clipped=2"),
    ] {
        let lied = with_lie(&text, 44, |numbers| {
            let kept = numbers.split(' ');
            let name = words.split('=').next().unwrap().trim();
            let kept: Vec<&str> = kept.filter(|word| !word.starts_with(name)).collect();
            format!("{}{words}", kept.join(" "))
        });
        let (links, _) = replayed(&lied);
        let (tick, first) = links[0].first.clone().unwrap();
        assert_eq!((tick, first.what), (44, what), "{}", links[0]);
    }
}

#[test]
fn a_device_that_clamps_more_is_no_liar_and_one_that_grants_too_much_is() {
    let mut simulation = recording(&Faults::default(), true);
    arm(&mut simulation);
    simulation.run(300);
    let text = simulation.record.unwrap().finish();
    let cfg = text.lines().find(|line| line.contains("in,CFG")).unwrap();
    // mode, flags, hold u16, ramp u16: 65 s of hold.
    let payload = cfg.rsplit(' ').next().unwrap();
    let granted = format!("{}ffff{}", &payload[..4], &payload[8..]);
    let lied = text.replace(payload, &granted);
    let (links, _) = replayed(&lied);
    let (_, first) = links[0].first.clone().unwrap();
    assert_eq!(first.what, "CFG", "{}", links[0]);
    assert!(first.device.contains("hold 65535 ms"), "{}", links[0]);
}

#[test]
fn hashes_say_what_they_cannot_and_judge_the_rest() {
    let mut simulation = recording(&Faults::default(), false);
    session(&mut simulation);
    let text = simulation.record.unwrap().finish();
    assert!(text.contains(",frame-hash,") && !text.contains(",f,"));
    let (links, ticks) = replayed(&text);
    agrees(&links, &text);
    assert!(
        links[0].to_string().contains("are not known"),
        "{}",
        links[0]
    );
    assert!(
        ticks
            .iter()
            .all(|tick| tick.codes.is_empty() && tick.amp_sum.is_none())
    );
    let lied = with_lie(&text, 44, |numbers| format!("{numbers} state=5"));
    assert!(!replayed(&lied).0[0].agrees());
}

#[test]
fn several_sessions_of_a_file_are_replayed_each_in_turn() {
    let mut whole = String::new();
    for _ in 0..3 {
        let mut simulation = recording(&Faults::default(), true);
        arm(&mut simulation);
        simulation.run(1500);
        whole.push_str(&simulation.record.unwrap().finish());
    }
    let (links, _) = replayed(&whole);
    assert_eq!(links.len(), 3);
    agrees(&links, &whole);
}

#[test]
fn caps_that_no_emulator_can_have_are_said() {
    let faults = Faults {
        lies: vec![FirmwareLie::read("caps.rows=5").unwrap()],
        ..Faults::default()
    };
    let mut simulation = recording(&faults, true);
    simulation.run(1000);
    let (links, _) = replayed(&simulation.record.unwrap().finish());
    let line = links[0].to_string();
    assert!(!links[0].agrees() && line.contains("5 × 4"), "{line}");
}

#[test]
fn mutated_logs_are_replayed_or_refused() {
    let mut simulation = recording(&Faults::default(), true);
    arm(&mut simulation);
    simulation.run(400);
    simulation.host.stop(simulation.now(), StopHow::Now);
    simulation.run(100);
    let text = simulation.record.unwrap().finish();
    let contactors = ContactorModel::default();
    let mut random = Random::new(11);
    let mut n_refused = 0;
    for _ in 0..400 {
        let mut bytes = text.clone().into_bytes();
        for _ in 0..=random.index(4) {
            let at = random.index(bytes.len());
            bytes[at] = b"0123456789abcdef,= \"\nAZ"[random.index(22)];
        }
        let mut n_ticks = 0;
        let mut desk = Desk::new(&contactors, |_: &ReplayedTick| {
            n_ticks += 1;
            Ok::<(), String>(())
        });
        let read = desk.read(bytes.as_slice(), |(_, reason)| reason);
        n_refused += usize::from(read.is_err());
        drop(desk);
        assert!(n_ticks < 10_000, "{n_ticks}");
    }
    assert!((20..400).contains(&n_refused), "{n_refused}");
}

#[test]
fn a_log_of_an_earlier_version_is_replayed() {
    let text = include_str!("earlier_log.csv");
    assert!(text.contains(",status,") && text.contains(",frame,"));
    let (links, ticks) = replayed(text);
    assert!(links.iter().all(ReplayedLink::agrees), "{}", links[0]);
    assert!(
        links[0].counts.judged > 20 && ticks.len() > 20,
        "{}",
        links[0]
    );
    let loudest = ticks.iter().flat_map(|tick| &tick.peak_um).copied();
    assert!(loudest.fold(0.0, f64::max) > 1.0);
}

#[test]
fn a_link_that_is_told_the_time_replays_as_it_was_however_its_clock_lies() {
    let folder = ScratchFolder::made("told");
    // Told time has nothing to do with that of the log: it begins before or after it.
    for (nth, ahead_s) in [0_u64, 100].into_iter().enumerate() {
        let path = folder.join(format!("{nth}.csv"));
        let began = Instant::now() + Duration::from_secs(ahead_s);
        std::thread::sleep(Duration::from_millis(20));
        let log = SessionLog::append(&path, None).unwrap();
        let profile = ArrayProfile::default();
        let mut bridge = Bridge::open_stepped(Target::Emulator, profile, 24, began, || {});
        let feed = bridge.feed_of(&log);
        bridge.log_to(feed);
        let mut n_sent = 0;
        for tick in 1..400_u32 {
            bridge.tell(began + Duration::from_millis(25) * tick);
            while let Some(event) = bridge.poll() {
                match event {
                    BridgeEvent::Ready(_) => assert!(bridge.arm()),
                    BridgeEvent::Tick { .. } => {
                        let um = f32::from(u8::try_from(tick % 20).unwrap());
                        n_sent += u32::from(bridge.send(&[[um, 1.0]; 24], None).is_some());
                    }
                    _ => {}
                }
            }
            // The log has a thread of its own, for which told time is too fast.
            std::thread::sleep(Duration::from_millis(1));
        }
        assert!(n_sent > 350, "{n_sent}");
        drop(bridge);
        log.finish().unwrap();
        let mut ticks = Vec::new();
        let links = ReplayedLink::of_log(&path, &ContactorModel::default(), |tick| {
            ticks.push(tick.clone());
            Ok::<(), BridgeError>(())
        });
        let link = &links.unwrap()[0];
        assert!(link.agrees() && link.counts.judged > 350, "{link}");
        let is_felt = |tick: &&ReplayedTick| tick.peak_um.iter().all(|um| *um > 0.5);
        let n_felt = ticks.iter().filter(is_felt).count();
        assert!(
            n_felt > 300,
            "{n_felt} of {} ticks are felt, {link}",
            ticks.len()
        );
    }
}
