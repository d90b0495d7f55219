//! Random scripts for a device: a host that mostly knows what it does, on a link that mostly works.

use selvedge_device::{Packet, kind};

use super::reference::hex;

/// Splitmix64: a script is the same on every machine.
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// 0…`below` − 1.
    pub(crate) fn below(&mut self, below: u64) -> u64 {
        self.next() % below
    }

    fn byte(&mut self) -> u8 {
        self.next().to_le_bytes()[0]
    }

    fn u16(&mut self) -> u16 {
        let [low, high, ..] = self.next().to_le_bytes();
        u16::from_le_bytes([low, high])
    }

    fn u32(&mut self) -> u32 {
        let [a, b, c, d, ..] = self.next().to_le_bytes();
        u32::from_le_bytes([a, b, c, d])
    }

    fn of<T: Copy>(&mut self, values: &[T]) -> T {
        let index = usize::try_from(self.next() % 1_000_000).unwrap();
        values[index % values.len()]
    }
}

const SESSION: u32 = 0x1234_5678;
const TICK_US: u64 = 25_000;

/// A host and its link, throwing dice.
pub(crate) struct Script {
    pub(crate) dice: Dice,
    n_channels: usize,
    now_us: u64,
    seq: u16,
    lines: Vec<String>,
}

impl Script {
    /// A script of `length` steps for a device with `n_channels` channels.
    pub(crate) fn lines(seed: u64, n_channels: usize, length: usize) -> Vec<String> {
        let mut script = Self {
            dice: Dice(seed),
            n_channels,
            now_us: 0,
            seq: 0,
            lines: vec![String::from("boot")],
        };
        for _ in 0..length {
            script.step();
        }
        script.lines
    }

    fn step(&mut self) {
        match self.dice.below(100) {
            0..=3 => self.greet(),
            4..=6 => self.configure(),
            7..=10 => self.arm(),
            11..=44 => self.frame(),
            45..=47 => self.small(kind::STOP, &[0, 1, 0, 0]),
            48..=51 => self.small(kind::PING, &[1, 2, 3, 4, 5]),
            52..=53 => self.clear(),
            54..=56 => self.ident(),
            57..=59 => self.stray(),
            60..=62 => self.damage(),
            63 => self.fault(),
            64..=70 => self.open(),
            _ => self.wait(),
        }
        if self.dice.below(4) == 0 {
            self.lines.push(String::from("codes"));
        }
    }

    /// What leads to frames.
    fn open(&mut self) {
        self.lines.push(String::from("cured 65535"));
        self.send(kind::CLEAR, &[0xff, 0xff]);
        self.greet();
        self.configure();
        self.arm();
    }

    fn wait(&mut self) {
        let longest_us = self
            .dice
            .of(&[900, 3000, 26_000, 26_000, 120_000, 1_200_000]);
        self.now_us += self.dice.below(longest_us);
        if self.dice.below(4) == 0 {
            self.now_us = self.now_us.next_multiple_of(self.dice.of(&[1000, TICK_US]));
        }
        self.lines.push(format!("at {}", self.now_us));
    }

    fn wire(&mut self, bytes: &[u8]) {
        self.lines.push(format!("in {}", hex(bytes)));
    }

    fn send(&mut self, kind: u8, payload: &[u8]) {
        self.seq = self.seq.wrapping_add(1);
        let packet = Packet::encode(kind, self.seq, payload).unwrap();
        self.wire(packet.as_bytes());
    }

    fn greet(&mut self) {
        let mut hello = b"HBP1".to_vec();
        if self.dice.below(20) == 0 {
            hello[3] = b'2';
        }
        let session = self.dice.of(&[SESSION, SESSION, SESSION, 0]);
        hello.extend(session.to_le_bytes());
        hello.extend(self.dice.of(&[[1, 1], [1, 1], [0, 9], [1, 1], [2, 3]]));
        // Bits that nobody knows are ignored; bit 1 wants LOG, whose text is each device's own.
        hello.extend(self.dice.of(&[1u16, 1, 5, 0]).to_le_bytes());
        let lease_ms = self.dice.of(&[0u16, 1000, 30, 200, u16::MAX]);
        hello.extend(lease_ms.to_le_bytes());
        hello.extend([0, 0]);
        self.send(kind::HELLO, &hello);
    }

    fn configure(&mut self) {
        let mut config = vec![self.dice.of(&[0, 1]), self.dice.of(&[0, 1, 255])];
        let (hold, ramp) = (
            self.dice.of(&[60u16, 20, 100, 0, 99, 300]),
            self.dice.u16() % 120,
        );
        let slew = self.dice.of(&[0u16, 500, 20_000, u16::MAX]);
        for value in [
            hold,
            self.dice.of(&[40, 0, 1, ramp]),
            slew,
            self.dice.u16() % 900,
        ] {
            config.extend(value.to_le_bytes());
        }
        for _ in 0..2 {
            let limit = self.dice.of(&[u16::MAX, u16::MAX, 30_000, 0]);
            config.extend(limit.to_le_bytes());
        }
        config.extend([0, 0]);
        for _ in 0..self.n_channels.div_ceil(32) {
            let mask = [u32::MAX, u32::MAX, self.dice.u32()];
            config.extend(self.dice.of(&mask).to_le_bytes());
        }
        self.send(kind::CONFIG, &config);
    }

    fn arm(&mut self) {
        let session = self.dice.of(&[SESSION, SESSION, SESSION, SESSION, 7]);
        let key = SESSION ^ self.dice.of(&[0xa5c3_0f96, 0xa5c3_0f96, 0xa5c3_0f96, 0]);
        let payload = [session.to_le_bytes(), key.to_le_bytes()].concat();
        self.send(kind::ARM, &payload);
    }

    fn frame(&mut self) {
        let tick = u32::try_from(self.now_us / TICK_US).unwrap();
        let ahead = self
            .dice
            .of(&[1, 1, 1, 2, 3, 4, 5, 0, u32::MAX, u32::MAX - 2]);
        let far = tick.wrapping_add(self.dice.of(&[1 << 31, (1 << 31) - 1, (1 << 31) + 1]));
        let stamps = [u32::MAX, far, self.dice.u32()];
        let stamp = match self.dice.below(12) {
            0 => self.dice.of(&stamps),
            _ => tick.wrapping_add(ahead),
        };
        let mut payload = stamp.to_le_bytes().to_vec();
        let level = self.dice.of(&[0u16, 20_000, 65_535]);
        for _ in 0..2 * self.n_channels {
            let random = self.dice.u16();
            payload.extend(self.dice.of(&[level, level, random]).to_le_bytes());
        }
        match self.dice.below(40) {
            0 => payload.push(0),
            1 => drop(payload.pop()),
            _ => {}
        }
        self.send(kind::FRAME, &payload);
        if self.dice.below(12) == 0 {
            let again = self.lines.last().cloned().unwrap();
            self.lines.push(again);
        }
        if self.dice.below(3) > 0 {
            self.now_us += TICK_US - self.dice.below(200);
            self.lines.push(format!("at {}", self.now_us));
        }
    }

    /// A short message of some of `bytes`; often too short, sometimes longer than its table.
    fn small(&mut self, kind: u8, bytes: &[u8]) {
        let cut = self.dice.below(8) == 0;
        let length = if cut { 1 } else { bytes.len() };
        let mut payload = bytes[..length].to_vec();
        if let Some(how) = payload.get_mut(1) {
            *how = self.dice.of(&[0, 0, 1, 9]);
        }
        self.send(kind, &payload);
    }

    fn clear(&mut self) {
        let bits = self.dice.of(&[0xffffu16, 1, 2, 32]);
        self.send(kind::CLEAR, &bits.to_le_bytes());
    }

    fn ident(&mut self) {
        let channels = u16::try_from(self.n_channels).unwrap();
        let mut payload = (self.dice.u16() % (channels + 1)).to_le_bytes().to_vec();
        let ms = self.dice.of(&[0u16, 1, 40, 1000, 1001]);
        payload.extend(ms.to_le_bytes());
        payload.extend(self.dice.u16().to_le_bytes());
        self.send(kind::IDENT, &payload);
    }

    /// A type that the device does not take, or any type with a random payload.
    fn stray(&mut self) {
        let known = self.dice.byte() % 12;
        let kind = self
            .dice
            .of(&[0, known, kind::SAMPLES, 0x7f, 0x80, 0x84, 0xff]);
        let length = self.dice.below(30);
        let payload: Vec<u8> = (0..length).map(|_| self.dice.byte()).collect();
        // A random ARM is no ARM: the key would have to fit.
        self.send(kind, &payload);
    }

    /// Garbage, an oversize text, or a packet cut or bent on its way.
    fn damage(&mut self) {
        let mut bytes = Packet::encode(kind::PING, 1, &[0; 4])
            .unwrap()
            .as_bytes()
            .to_vec();
        match self.dice.below(5) {
            0 => bytes = (0..40).map(|_| self.dice.byte()).collect(),
            1 => bytes = vec![self.dice.of(&[1, 7, 255]); 700],
            2 => bytes.truncate(usize::from(self.dice.byte()) % 12),
            3 => bytes = b"AT+GCAP\r\n".to_vec(),
            _ => {
                let at = usize::from(self.dice.byte()) % bytes.len();
                bytes[at] ^= 1 << (self.dice.byte() % 8);
            }
        }
        self.wire(&bytes);
    }

    fn fault(&mut self) {
        let bits = self.dice.of(&[1u16, 2, 64]);
        let line = match self.dice.below(3) {
            0 => format!("fault {bits} {} -7", self.dice.of(&[3, 65_535])),
            1 => "lost".to_owned(),
            _ => format!("cured {bits}"),
        };
        self.lines.push(line);
    }
}
