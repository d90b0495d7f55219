//! What a device says of itself, and that it says the same again.

use super::check::checks;
use crate::certify::client::Client;
use crate::certify::verdict::{Verdict, ensure};
use crate::message::{Caps, MAGIC, TICK_US};

checks! { "handshake":
    First "CAPS" bounds, "CAPS keep the bounds of the protocol and agree with themselves";
    Quick "CAPS again" again, "every HELLO of this opening and of another gets the same CAPS";
    Quick "STATUS at READY" ready, "after HELLO: READY, no amplitude, no faults, age_ms 65535";
}

/// One bound of CAPS.
type Bound = (&'static str, fn(&Caps) -> bool);

const BOUNDS: &[Bound] = &[
    ("the magic is not HBP1", |caps| caps.magic == MAGIC),
    ("the version is not 1", |caps| caps.version == 1),
    ("n_comp is not 2", |caps| caps.n_comp == 2),
    ("rows · cols is not n_ch", |caps| {
        caps.n_ch > 0 && u16::from(caps.rows) * u16::from(caps.cols) == caps.n_ch
    }),
    ("the pitch is 0", |caps| caps.pitch_um > 0),
    ("tick_us is not 25000", |caps| caps.tick_us == TICK_US),
    ("the queue is 0", |caps| caps.queue > 0),
    ("dac_bits is not 8…16", |caps| {
        (8..=16).contains(&caps.dac_bits)
    }),
    ("modes lack A", |caps| caps.modes & Caps::MODE_A != 0),
    ("modes have bits that v1 does not know", |caps| {
        let known = Caps::MODE_A | Caps::MODE_IDENT | Caps::INTERPOLATES;
        caps.modes & !known == 0
    }),
    ("fs_mV is 0", |caps| caps.fs_mv > 0),
    ("hv_max_dV is 0", |caps| caps.hv_max_dv > 0),
    ("slew_max is 0", |caps| caps.slew_max > 0),
    ("max_body is not 256…1024", |caps| {
        (256..=1024).contains(&caps.max_body)
    }),
    ("max_body is too small for a FRAME", |caps| {
        u32::from(caps.max_body) >= 12 + 4 * u32::from(caps.n_ch)
    }),
    (
        "sample_hz is no whole number of samples a period of 320 Hz",
        |caps| caps.sample_hz >= 640 && caps.sample_hz % 320 == 0,
    ),
    ("the carriers are not 40 and 320 Hz", |caps| {
        caps.freq_mhz == [40_000, 320_000]
    }),
    ("a comp_limit is 0", |caps| !caps.comp_limit.contains(&0)),
    ("the uid is empty", |caps| {
        caps.uid != [0; 12] && caps.uid != [0xff; 12]
    }),
];

fn bounds(c: &mut Client<'_>) -> Verdict {
    for (what, holds) in BOUNDS {
        ensure!(holds(&c.caps), "{what}")?;
    }
    let payload = &c.caps_payload;
    let name_len = usize::from(payload.get(63).copied().unwrap_or(0));
    ensure!(name_len <= 32, "name_len is {name_len}")?;
    let name = payload.get(64..64 + name_len).unwrap_or(&[]);
    let is_text = std::str::from_utf8(name).is_ok_and(|name| !name.chars().any(char::is_control));
    ensure!(is_text, "the name is no UTF-8 text")
}

fn again(c: &mut Client<'_>) -> Verdict {
    let first = c.hello();
    c.tell_with(|c| [first.clone(), first, c.hello(), c.hello()])
        .map(drop)
}

fn ready(c: &mut Client<'_>) -> Verdict {
    let status = c.status()?;
    super::steps::expect(&status, crate::message::DeviceState::Ready, 0)?;
    ensure!(
        status.last_seq == 0,
        "last_seq {} before the first FRAME",
        status.last_seq
    )?;
    ensure!(
        status.age_ms == u16::MAX,
        "age_ms {} before the first FRAME",
        status.age_ms
    )
}
