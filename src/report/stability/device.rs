//! Devices that stall, garble, vanish, come back or lie, and amplitudes that are no numbers.
//!
//! Host and device are the state machines themselves, joined by a wire in told time.

use std::time::{Duration, Instant};

use super::{Case, Verdict, verdict};
use crate::bridge::{
    AppliedFrame, ArrayProfile, BridgeEvent, BridgeState, Coder, Decoder, DeviceCore,
    DeviceMessage, DeviceModel, DeviceSink, DisarmedBy, HostSession, Moment, Packet, Sequence,
};
use crate::numerics::Random;

const NONCE: u32 = 0x5e1f_ed9e;
const N_CONTACTORS: usize = 24;
/// Bytes of noise that a decoder is given.
const N_NOISE: usize = 1_000_000;

/// Devices and drive codes.
pub(super) fn cases() -> Vec<Case> {
    let cases = [
        (
            "a host that stalls for a second",
            "the device falls silent by itself",
            host_stalls as fn() -> Verdict,
        ),
        (
            "a device that stalls",
            "given up, with the reason",
            device_stalls,
        ),
        (
            "a device that vanishes and comes back",
            "told, not armed again by itself",
            comes_back,
        ),
        (
            "a device that garbles every byte",
            "no harm, never armed",
            garbled,
        ),
        (
            "a million random bytes",
            "counted as bad, none taken",
            random_bytes,
        ),
        (
            "a device of 25 contactors for a display of 24",
            "refused, with the reason",
            wrong_size,
        ),
        (
            "amplitudes of NaN, ∞, −1 and 1e30 µm",
            "0, 0, 0 and limited, all counted",
            no_numbers,
        ),
    ];
    cases
        .map(|(tried, should, run)| Case::new("device", tried, should, run))
        .into()
}

/// What the device writes.
#[derive(Default)]
struct Wire(Vec<u8>);

impl DeviceSink for Wire {
    fn packet(&mut self, bytes: &[u8]) {
        self.0.extend_from_slice(bytes);
    }

    fn applied(&mut self, _frame: &AppliedFrame<'_>) {}

    fn changed(&mut self, _moment: &Moment) {}
}

/// Host and device on one told clock.
struct Pair {
    host: HostSession,
    device: DeviceCore,
    decoder: Decoder,
    start: Instant,
    us: u64,
    wire: Wire,
    events: Vec<BridgeEvent>,
    /// Whether bytes of the host, and of the device, arrive.
    arrives: [bool; 2],
    /// Whether bytes of the device are changed on their way.
    is_garbled: bool,
}

impl Pair {
    fn new(model: DeviceModel) -> Self {
        let start = Instant::now();
        let profile = ArrayProfile::default();
        let mut host = HostSession::new(NONCE, profile, N_CONTACTORS, Sequence::default());
        host.opened(start);
        Self {
            host,
            device: DeviceCore::new(model),
            decoder: Decoder::new(1024),
            start,
            us: 0,
            wire: Wire::default(),
            events: Vec::new(),
            arrives: [true; 2],
            is_garbled: false,
        }
    }

    /// A pair whose device plays.
    fn streaming() -> Result<Self, String> {
        let mut pair = Self::new(DeviceModel::default());
        pair.run(60);
        let is_asked = pair.host.arm(pair.now());
        pair.run(500);
        let is_live = is_asked && pair.host.state() == BridgeState::Streaming && pair.is_loud();
        if is_live {
            Ok(pair)
        } else {
            Err("the trial itself failed: it never streamed".to_owned())
        }
    }

    fn now(&self) -> Instant {
        self.start + Duration::from_micros(self.us)
    }

    fn is_loud(&self) -> bool {
        self.device.output().iter().any(|codes| *codes != [0; 2])
    }

    /// Lets time pass; the host answers every tick with a frame.
    fn run(&mut self, ms: u64) {
        for _ in 0..ms {
            self.us += 1000;
            self.device.advance(self.us, &mut self.wire);
            self.deliver();
            self.host.on_time(self.now());
            self.answer();
        }
    }

    fn deliver(&mut self) {
        let mut bytes = std::mem::take(&mut self.wire.0);
        if !self.arrives[1] {
            return;
        }
        if self.is_garbled {
            for byte in &mut bytes {
                *byte = byte.rotate_left(3) ^ 0x5a;
            }
        }
        let now = self.now();
        for byte in bytes {
            let Some(packet) = self.decoder.push(byte) else {
                continue;
            };
            if let Ok(message) = DeviceMessage::decode(&packet, N_CONTACTORS) {
                self.host.on_message(now, &message);
            }
        }
    }

    fn answer(&mut self) {
        while let Some(event) = self.host.next_event() {
            if matches!(event, BridgeEvent::Tick { .. }) {
                let frame = self.host.frame(self.now(), &[[10.0, 20.0]; N_CONTACTORS]);
                if let Some((_, packet)) = frame {
                    self.host_writes(&packet);
                }
            } else {
                self.events.push(event);
            }
        }
        while let Some(packet) = self.host.take_stop().or_else(|| self.host.next_packet()) {
            self.host_writes(&packet);
        }
    }

    fn host_writes(&mut self, packet: &Packet) {
        if self.arrives[0] {
            self.device
                .receive(self.us, packet.as_bytes(), &mut self.wire);
            self.deliver();
        }
    }

    fn found<T>(&self, wanted: impl Fn(&BridgeEvent) -> Option<T>) -> Option<T> {
        self.events.iter().find_map(wanted)
    }
}

fn host_stalls() -> Verdict {
    let mut pair = Pair::streaming()?;
    pair.arrives[0] = false;
    pair.run(1000);
    let is_silent = !pair.is_loud();
    let reason = pair.found(|event| match event {
        BridgeEvent::Disarmed {
            by: DisarmedBy::Device,
            reason,
        } => Some(reason.clone()),
        _ => None,
    });
    let told = reason.clone().unwrap_or_else(|| "nothing told".to_owned());
    let sound = if is_silent { "silent" } else { "still loud" };
    verdict(
        is_silent && reason.is_some(),
        format!("{sound}; host: {told}"),
    )
}

fn lost(event: &BridgeEvent) -> Option<String> {
    match event {
        BridgeEvent::Lost(reason) => Some(reason.clone()),
        _ => None,
    }
}

fn device_stalls() -> Verdict {
    let mut pair = Pair::streaming()?;
    pair.arrives[1] = false;
    pair.run(5000);
    match pair.found(lost) {
        Some(reason) => verdict(
            pair.host.state() == BridgeState::Lost,
            format!("lost: {reason}"),
        ),
        None => Err(format!("state {} after 5 s", pair.host.state())),
    }
}

fn comes_back() -> Verdict {
    let mut pair = Pair::streaming()?;
    pair.arrives = [false; 2];
    pair.run(5000);
    let reason = pair.found(lost).ok_or("never told")?;
    pair.arrives = [true; 2];
    pair.run(5000);
    let (state, is_silent) = (pair.host.state(), !pair.is_loud());
    let is_kept = is_silent && !state.is_live();
    verdict(
        is_kept,
        format!("lost: {reason}; then {state}, silent until it is opened and armed anew"),
    )
}

fn garbled() -> Verdict {
    let mut pair = Pair::new(DeviceModel::default());
    pair.is_garbled = true;
    pair.run(10_000);
    let is_armed = pair.host.arm(pair.now());
    let (state, n_bad) = (pair.host.state(), pair.decoder.bad());
    verdict(
        !is_armed && !pair.is_loud(),
        format!("{state}, {n_bad} packets bad"),
    )
}

fn random_bytes() -> Verdict {
    let mut random = Random::new(1);
    let mut decoder = Decoder::new(1024);
    let mut n_taken = 0;
    for _ in 0..N_NOISE {
        let byte = u8::try_from(random.index(256)).unwrap_or(0);
        n_taken += u32::from(decoder.push(byte).is_some());
    }
    let n_bad = decoder.bad();
    verdict(
        n_taken == 0 && n_bad > 0,
        format!("{n_bad} packets bad, {n_taken} taken"),
    )
}

fn wrong_size() -> Verdict {
    let mut pair = Pair::new(DeviceModel {
        rows: 5,
        cols: 5,
        ..DeviceModel::default()
    });
    pair.run(1000);
    let reason = pair.found(|event| match event {
        BridgeEvent::Refused(reason) => Some(reason.clone()),
        _ => None,
    });
    let is_armed = pair.host.arm(pair.now());
    match reason {
        Some(reason) => verdict(!is_armed, format!("refused: {reason}")),
        None => Err(format!("state {}", pair.host.state())),
    }
}

fn no_numbers() -> Verdict {
    let mut coder = Coder::new(&ArrayProfile::default(), 4);
    let codes = coder.encode(
        &[[f32::NAN; 2], [f32::INFINITY; 2], [-1.0; 2], [1e30; 2]],
        1.0,
    );
    let counters = coder.counters();
    let limited = counters.limited[0] + counters.limited[1];
    let [low, high] = codes[3].map(u32::from);
    let is_kept = codes[..3] == [[0; 2]; 3] && low > 0 && low + high <= 65_535;
    verdict(
        is_kept && counters.non_finite == 6 && limited == 2,
        format!(
            "codes {codes:?}, {} no numbers, {limited} limited",
            counters.non_finite
        ),
    )
}
