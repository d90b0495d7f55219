//! The device in virtual time, on a bench that decodes what it sends and logs.

mod frames;
mod lies;
mod random;
mod requests;
mod silence;

use super::*;
use crate::message::{
    Ack, AckCode, Arm, Caps, ChannelMask, Clear, DeviceMessage, Hello, Ident, MAGIC, NEXT_TICK,
    Ping, Stop, StopHow, frame, kind,
};

pub(crate) const SESSION: u32 = 0x00c0_ffee;

/// A device on a bench: what it sends and logs, decoded.
struct Bench {
    core: DeviceCore,
    sink: Collected,
    seq: u16,
}

#[derive(Default)]
struct Collected {
    bytes: Vec<u8>,
    applied: Vec<(u32, u16)>,
    changes: Vec<(u64, DeviceState)>,
}

impl DeviceSink for Collected {
    fn packet(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    fn applied(&mut self, frame: &AppliedFrame<'_>) {
        self.applied.push((frame.moment.tick, frame.seq));
    }

    fn changed(&mut self, moment: &Moment) {
        self.changes.push((moment.dev_us, moment.state));
    }
}

/// What a host of 24 contactors asks for.
pub(crate) fn wish() -> Config {
    Config {
        mode: 0,
        flags: 0,
        hold_ms: 60,
        ramp_ms: 40,
        slew: 0,
        hv_dv: 500,
        comp_limit: [65535; 2],
        mask: ChannelMask::first(24),
    }
}

/// HELLO, CONFIG and ARM of such a host.
pub(crate) fn opening() -> [Packet; 3] {
    let packets = [
        Hello::new(SESSION).packet(1),
        wish().request(2, 24),
        Arm::new(SESSION).packet(3),
    ];
    packets.map(Option::unwrap)
}

impl Bench {
    fn new() -> Self {
        Self::of(DeviceModel::default())
    }

    fn of(model: DeviceModel) -> Self {
        Self {
            core: DeviceCore::new(model),
            sink: Collected::default(),
            seq: 0,
        }
    }

    fn ready() -> Self {
        let mut bench = Self::new();
        bench.send(&Hello::new(SESSION));
        bench.configure(&wish());
        bench.take();
        bench
    }

    fn armed() -> Self {
        Self::armed_with(&wish())
    }

    fn armed_with(config: &Config) -> Self {
        let mut bench = Self::ready();
        bench.configure(config);
        assert_eq!(bench.ack_of(&Arm::new(SESSION)), Some(AckCode::Ok));
        bench
    }

    fn now(&self) -> u64 {
        self.core.now_us
    }

    fn bytes(&mut self, bytes: &[u8]) {
        let now = self.now();
        self.core.receive(now, bytes, &mut self.sink);
    }

    fn send(&mut self, message: &impl Message) -> u16 {
        self.seq += 1;
        let packet = message.packet(self.seq).unwrap();
        self.bytes(packet.as_bytes());
        self.seq
    }

    fn configure(&mut self, config: &Config) {
        self.seq += 1;
        let packet = config
            .request(self.seq, self.core.model.n_channels())
            .unwrap();
        self.bytes(packet.as_bytes());
    }

    fn frame(&mut self, tick: u32, codes: [u16; 2]) -> u16 {
        self.seq += 1;
        let packet = frame::packet(self.seq, tick, &[codes; 24]).unwrap();
        self.bytes(packet.as_bytes());
        self.seq
    }

    fn at(&mut self, now_us: u64) -> &mut Self {
        self.core.advance(now_us, &mut self.sink);
        self
    }

    fn take(&mut self) -> Vec<DeviceMessage> {
        let mut decoder = Decoder::new(1024);
        let mut messages = Vec::new();
        for byte in std::mem::take(&mut self.sink.bytes) {
            if let Some(packet) = decoder.push(byte) {
                messages.push(DeviceMessage::decode(&packet, 24).unwrap());
            }
        }
        assert_eq!(decoder.bad(), 0);
        messages
    }

    fn last_ack(&mut self) -> Option<Ack> {
        let mut acks = self.take().into_iter().filter_map(|message| match message {
            DeviceMessage::Ack(ack) => Some(ack),
            _ => None,
        });
        acks.next_back()
    }

    /// The code of the ACK for `message`, checking that it names it.
    fn ack_of<M: Message>(&mut self, message: &M) -> Option<AckCode> {
        self.take();
        let seq = self.send(message);
        let ack = self.last_ack()?;
        assert_eq!((ack.kind, ack.seq), (M::KIND, seq));
        Some(ack.code)
    }

    fn frame_ack(&mut self, tick: u32) -> Option<AckCode> {
        self.take();
        self.frame(tick, [1, 1]);
        self.last_ack().map(|ack| ack.code)
    }

    fn last_status(&mut self) -> Option<Status> {
        let mut statuses = self.take().into_iter().filter_map(|message| match message {
            DeviceMessage::Status(status) => Some(status),
            _ => None,
        });
        statuses.next_back()
    }

    fn is_silent(&self) -> bool {
        self.core.output().iter().all(|codes| *codes == [0, 0])
    }
}
