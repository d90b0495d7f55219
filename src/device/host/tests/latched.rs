//! Late latching end to end in virtual time: session and device over a link that takes time.

use super::*;
use crate::device::{AppliedFrame, DeviceCore, DeviceSink};
use crate::framing::Decoder;

/// What the device says, and at which ticks frames took effect.
#[derive(Default)]
struct Log {
    bytes: Vec<u8>,
    ticks: Vec<u32>,
}

impl DeviceSink for Log {
    fn packet(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    fn applied(&mut self, frame: &AppliedFrame<'_>) {
        self.ticks.push(frame.moment.tick);
    }
}

/// How long a packet takes, µs, by its number.
type Way = fn(u64) -> u64;

/// Session and device over a slow link; the host makes each frame when it is due and takes its
/// time for it.
struct Wired {
    host: HostSession,
    device: DeviceCore,
    start: Instant,
    us: u64,
    host_ppm: f64,
    /// Making a frame, the way to the device, the way back.
    ways: [Way; 3],
    n_packets: u64,
    to_device: VecDeque<(u64, Vec<u8>)>,
    to_host: VecDeque<(u64, Vec<u8>)>,
    decoder: Decoder,
    log: Log,
    due: Option<Instant>,
    /// From the making of each frame to the start of its tick, as told and as it was, µs.
    aheads_us: Vec<[f64; 2]>,
    depths: Vec<BridgeEvent>,
}

impl Wired {
    fn new(host_ppm: f64, ways: [Way; 3]) -> Self {
        let start = Instant::now();
        let mut host = session();
        host.opened(start);
        let mut wired = Self {
            host,
            device: DeviceCore::new(DeviceModel::default()),
            start,
            us: 0,
            host_ppm,
            ways,
            n_packets: 0,
            to_device: VecDeque::new(),
            to_host: VecDeque::new(),
            decoder: Decoder::new(1024),
            log: Log::default(),
            due: None,
            aheads_us: Vec::new(),
            depths: Vec::new(),
        };
        wired.run(2);
        assert!(wired.host.arm(wired.now()), "{}", wired.host.state());
        wired
    }

    fn now(&self) -> Instant {
        let us = self.us as f64 * (1.0 + self.host_ppm * 1e-6);
        self.start + Duration::from_secs_f64(us * 1e-6)
    }

    /// When it is `at` for the host, by the device's clock; at least 1 µs from now.
    fn us_of(&self, at: Instant) -> u64 {
        let us = at.duration_since(self.start).as_secs_f64() * 1e6;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a time"
        )]
        let us = (us / (1.0 + self.host_ppm * 1e-6)).ceil() as u64;
        us.max(self.us + 1)
    }

    fn run(&mut self, seconds: u64) {
        let end = self.us + seconds * 1_000_000;
        while self.us < end {
            let mut next = self.us + 20_000;
            let arrivals =
                [&self.to_device, &self.to_host].map(|way| way.front().map(|(at, _)| *at));
            for at in arrivals.into_iter().flatten() {
                next = next.min(at);
            }
            next = next.min(self.device.next_deadline_us().unwrap_or(next));
            next = next.min(self.due.map_or(next, |due| self.us_of(due)));
            self.us = next.max(self.us);
            self.step();
        }
    }

    fn step(&mut self) {
        self.device.advance(self.us, &mut self.log);
        while let Some((_, wire)) = self.to_device.pop_front_if(|(at, _)| *at <= self.us) {
            self.device.receive(self.us, &wire, &mut self.log);
        }
        let sent = std::mem::take(&mut self.log.bytes);
        if !sent.is_empty() {
            let at = self.us + self.way(2);
            let at = self.to_host.back().map_or(at, |(last, _)| at.max(*last));
            self.to_host.push_back((at, sent));
        }
        let now = self.now();
        while let Some((_, wire)) = self.to_host.pop_front_if(|(at, _)| *at <= self.us) {
            for byte in wire {
                if let Some(packet) = self.decoder.push(byte) {
                    let message = DeviceMessage::decode(&packet, 24).unwrap();
                    self.host.on_message(now, &message);
                }
            }
        }
        self.host.on_time(now);
        self.act(now);
    }

    fn act(&mut self, now: Instant) {
        while let Some(event) = self.host.next_event() {
            match event {
                BridgeEvent::Tick { due, .. } => self.due = Some(due),
                BridgeEvent::DepthRaised(_) | BridgeEvent::DepthLowered(_) => {
                    self.depths.push(event);
                }
                _ => {}
            }
        }
        if self.due.take_if(|due| *due <= now).is_some() {
            self.answer(now);
        }
        while let Some(packet) = self.host.take_stop().or_else(|| self.host.next_packet()) {
            self.write(0, packet.as_bytes());
        }
    }

    fn answer(&mut self, now: Instant) {
        let um = [[10.0, 20.0]; 24];
        let Some((sent, packet)) = self.host.frame(now, &um) else {
            return;
        };
        let starts_us = f64::from(sent.apply_tick) * 25_000.0;
        let told_us = sent.ahead.as_secs_f64() * 1e6;
        self.aheads_us.push([told_us, starts_us - self.us as f64]);
        let making_us = self.way(0);
        self.write(making_us, packet.as_bytes());
    }

    fn write(&mut self, after_us: u64, bytes: &[u8]) {
        let at = self.us + after_us + self.way(1);
        let at = self.to_device.back().map_or(at, |(last, _)| at.max(*last));
        self.to_device.push_back((at, bytes.to_vec()));
    }

    fn way(&mut self, which: usize) -> u64 {
        self.n_packets += 1;
        self.ways[which](self.n_packets)
    }

    fn mean_ahead_ms(&self, n_last: usize) -> f64 {
        let last = &self.aheads_us[self.aheads_us.len() - n_last..];
        last.iter().map(|[_, us]| us * 1e-3).sum::<f64>() / n_last as f64
    }
}

/// A number that looks random, 0…`below`.
fn some(n: u64, below: u64) -> u64 {
    let mixed = (n ^ 0x9e37).wrapping_mul(6_364_136_223_846_793_005);
    (mixed >> 33) % below
}

/// Render and write, USB to the device, and a reader that is slow now and then.
const USB: [Way; 3] = [
    |n| 200 + some(n, 400),
    |n| 400 + some(n, 1200),
    |n| 300 + some(n, 700) + if some(n, 50) == 0 { 6000 } else { 0 },
];

#[test]
fn an_hour_over_usb_at_100_ppm_is_young_and_loses_nothing() {
    for ppm in [-100.0, 100.0] {
        let mut wired = Wired::new(ppm, USB);
        wired.run(3600);
        assert_eq!(wired.host.state(), BridgeState::Streaming);
        let device = wired.host.counters().device;
        assert_eq!(device, DeviceCounters::default(), "{ppm} ppm");
        let ticks = &wired.log.ticks;
        assert!(ticks.windows(2).all(|pair| pair[1] == pair[0] + 1));
        assert!(ticks.len() > 143_900, "{}", ticks.len());
        let ms = wired.mean_ahead_ms(40_000);
        assert!((5.0..8.5).contains(&ms), "{ms} ms before its tick");
        assert!(wired.depths.is_empty());
        let rate = wired.host.clock().rate_ppm;
        assert!((rate + ppm).abs() < 20.0, "{rate}");
        let wrong = wired.aheads_us[400..]
            .iter()
            .map(|[described, is]| (described - is).abs());
        assert!(
            wrong.fold(0.0, f64::max) < 2000.0,
            "the age shown is the age"
        );
    }
}

#[test]
fn a_converter_that_keeps_bytes_for_16_ms_costs_no_age() {
    let ways: [Way; 3] = [|_| 300, |n| 1000 + some(n, 500), |n| 1000 + some(n, 15_000)];
    let mut wired = Wired::new(30.0, ways);
    wired.run(300);
    assert_eq!(wired.host.counters().device, DeviceCounters::default());
    let ms = wired.mean_ahead_ms(4000);
    assert!(ms < 12.0, "{ms}");
}

#[test]
fn a_link_that_needs_more_than_a_tick_is_used_two_ticks_ahead() {
    let ways: [Way; 3] = [|_| 300, |n| 26_000 + some(n, 2000), |_| 1000];
    let mut wired = Wired::new(0.0, ways);
    wired.run(120);
    assert_eq!(wired.host.depth(), 2);
    assert_eq!(wired.depths, [BridgeEvent::DepthRaised(2)]);
    let late = wired.host.counters().device.late;
    wired.run(120);
    let counters = wired.host.counters().device;
    assert_eq!(counters.late, late, "none came late once it was known");
    let ms = wired.mean_ahead_ms(2000);
    assert!(ms < 45.0, "{ms}");
}

#[test]
fn a_stall_makes_frames_early_again_at_once() {
    let mut wired = Wired::new(0.0, USB);
    wired.run(120);
    assert!(wired.host.lead() < Duration::from_millis(9));
    wired.ways[0] = |n| if n % 40 == 0 { 12_000 } else { 300 };
    wired.run(2);
    assert_eq!(wired.host.lead(), TICK);
    assert!(wired.host.counters().device.late > 0);
    let late = wired.host.counters().device.late;
    wired.run(60);
    let after = wired.host.counters().device.late;
    assert!(after <= late + 1, "{late} then {after}");
    assert_eq!(wired.host.depth(), 1);
}
