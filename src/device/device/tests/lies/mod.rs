//! Every firmware lie against a truthful device: the same session leaves other bytes, other output
//! or another voltage.

mod chapters;

use std::hash::{DefaultHasher, Hash as _, Hasher as _};

use super::*;
use chapters::CHAPTERS;

/// All that can be seen of a device: what it sends and when, what it puts out, its voltage.
struct Trial {
    core: DeviceCore,
    sent: Sent,
    seq: u16,
    seen: DefaultHasher,
}

#[derive(Default)]
struct Sent(Vec<u8>);

impl DeviceSink for Sent {
    fn packet(&mut self, bytes: &[u8]) {
        self.0.extend_from_slice(bytes);
    }
}

impl Trial {
    /// What is seen of a device with these lies in all of [`CHAPTERS`].
    fn of(lies: &[FirmwareLie]) -> Vec<u64> {
        CHAPTERS
            .iter()
            .map(|chapter| Self::chapter(lies, *chapter))
            .collect()
    }

    fn chapter(lies: &[FirmwareLie], chapter: fn(&mut Self)) -> u64 {
        let model = DeviceModel {
            slew_max: 40_000,
            comp_limit: [60_000, 50_000],
            lies: lies.to_vec(),
            ..DeviceModel::default()
        };
        let mut trial = Self {
            core: DeviceCore::new(model),
            sent: Sent::default(),
            seq: 0,
            seen: DefaultHasher::new(),
        };
        chapter(&mut trial);
        trial.wait(60);
        trial.seen.finish()
    }

    /// Lets ms pass and looks at each.
    fn wait(&mut self, ms: u64) -> &mut Self {
        for _ in 0..ms {
            self.look();
            let next_us = (self.core.now_us / MS_US + 1) * MS_US;
            self.core.advance(next_us, &mut self.sent);
        }
        self.look();
        self
    }

    fn look(&mut self) {
        let sent = std::mem::take(&mut self.sent.0);
        if !sent.is_empty() {
            (self.core.now_us, sent).hash(&mut self.seen);
        }
        let halfway_us = self.core.now_us / MS_US * MS_US + MS_US / 2;
        self.core.advance(halfway_us, &mut self.sent);
        self.core.output().hash(&mut self.seen);
        self.core.rail_v().to_bits().hash(&mut self.seen);
        self.core.counters().bad.hash(&mut self.seen);
    }

    /// The next tick begins; the time is within it.
    fn tick(&mut self) -> &mut Self {
        let ms = self.core.now_us % TICK / MS_US;
        self.wait(TICK / MS_US - ms + 2)
    }

    fn bytes(&mut self, bytes: &[u8]) -> &mut Self {
        let now_us = self.core.now_us;
        self.core.receive(now_us, bytes, &mut self.sent);
        self.look();
        self
    }

    fn raw(&mut self, kind: u8, payload: &[u8]) -> &mut Self {
        self.seq += 1;
        let packet = Packet::encode(kind, self.seq, payload).unwrap();
        self.bytes(packet.as_bytes())
    }

    fn send(&mut self, message: &impl Message) -> &mut Self {
        self.seq += 1;
        let packet = message.packet(self.seq).unwrap();
        self.bytes(packet.as_bytes())
    }

    fn configure(&mut self, config: &Config) -> &mut Self {
        self.seq += 1;
        let packet = config.request(self.seq, 24).unwrap();
        self.bytes(packet.as_bytes())
    }

    /// A frame for a tick so far from the present one.
    fn frame(&mut self, ahead: u32, codes: [u16; 2]) -> &mut Self {
        self.seq += 1;
        self.frame_of_seq(self.seq, self.core.tick().wrapping_add(ahead), codes)
    }

    fn frame_of_seq(&mut self, seq: u16, tick: u32, codes: [u16; 2]) -> &mut Self {
        let mut all = [codes; 24];
        all[0] = [codes[0] / 2, codes[1]];
        let packet = frame::packet(seq, tick, &all).unwrap();
        self.bytes(packet.as_bytes())
    }

    fn stop(&mut self, how: StopHow) -> &mut Self {
        self.send(&Stop { reason: 0, how })
    }

    fn ident(&mut self, channel: u16, ms: u16, amp: u16) -> &mut Self {
        self.send(&Ident { channel, ms, amp })
    }

    fn ready(&mut self) -> &mut Self {
        self.send(&Hello::new(SESSION)).configure(&wish())
    }

    fn armed(&mut self) -> &mut Self {
        self.ready().send(&Arm::new(SESSION))
    }

    /// Armed and in RUN, one frame having been played.
    fn running(&mut self) -> &mut Self {
        self.armed().frame(1, [20_000, 10_000]).tick()
    }

    fn breaks_down(&mut self) -> &mut Self {
        self.core
            .raise_fault(fault_bit::OVER_CURRENT, 5, 42, &mut self.sent);
        self
    }
}

#[test]
fn every_lie_takes_effect() {
    let truth = Trial::of(&[]);
    let mut idle = Vec::new();
    for lie in FirmwareLie::examples() {
        if Trial::of(&[lie]) == truth {
            idle.push(lie.to_string());
        }
    }
    assert!(idle.is_empty(), "nothing is seen of {idle:?}");
}

#[test]
fn a_lie_that_has_not_begun_changes_nothing() {
    let truth = Trial::of(&[]);
    for lie in FirmwareLie::examples().filter(|lie| !lie.to_string().contains('@')) {
        let never = FirmwareLie::read(&format!("{lie}@4000000000")).unwrap();
        assert!(Trial::of(&[never]) == truth, "{never}");
    }
}
