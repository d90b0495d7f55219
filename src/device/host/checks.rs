//! Why a device is refused: CAPS that this program cannot drive safely, each with one line for
//! people.

use crate::framing::{CRC_LEN, HEADER_LEN};
use crate::message::{Caps, TICK_US, frame};

/// The reason against arming a device with these CAPS, if there is one.
pub(super) fn refusal(caps: &Caps, n_contactors: usize) -> Option<String> {
    let n_ch = usize::from(caps.n_ch);
    let needed = HEADER_LEN + frame::payload_len(n_ch) + CRC_LEN;
    if caps.version != crate::message::VERSION {
        return Some(String::from(
            "the device does not speak protocol version 1: update its firmware",
        ));
    }
    if usize::from(caps.rows) * usize::from(caps.cols) != n_ch {
        return Some(format!(
            "the device says {} rows × {} columns but {n_ch} channels: check its firmware",
            caps.rows, caps.cols
        ));
    }
    if n_ch != n_contactors {
        return Some(format!(
            "the device has {n_ch} channels, the display {n_contactors} contactors: \
             choose a display that matches"
        ));
    }
    if caps.n_comp != 2 {
        return Some(format!(
            "the device has {} components per channel, not the 2 that 40 and 320 Hz need",
            caps.n_comp
        ));
    }
    if caps.tick_us != TICK_US {
        return Some(format!(
            "the device ticks every {} µs, not every {TICK_US} µs",
            caps.tick_us
        ));
    }
    if caps.freq_mhz != [40_000, 320_000] {
        let [low, high] = caps.freq_mhz.map(|mhz| f64::from(mhz) / 1000.0);
        return Some(format!(
            "the device's carriers are {low} and {high} Hz, not 40 and 320 Hz"
        ));
    }
    if usize::from(caps.max_body) < needed {
        return Some(format!(
            "the device takes packets of at most {} bytes, \
             a frame of {n_ch} channels needs {needed}",
            caps.max_body
        ));
    }
    None
}
