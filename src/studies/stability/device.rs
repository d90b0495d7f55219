//! Devices that stall, garble, vanish, come back or lie, and amplitudes that are no numbers.
//!
//! Host and device are the state machines themselves, joined by a wire in told time.

use super::case::{Case, Verdict, cases, verdict};
use selvedge_device::{
    ArrayProfile, BridgeState, Coder, Decoder, DeviceModel, Faults, LinkFaults, OneOff, OneOffKind,
    Simulation,
};
use selvedge_foundation::numerics::Random;

/// Bytes of noise that a decoder is given.
const N_NOISE: usize = 1_000_000;

/// Devices and drive codes.
pub(super) fn cases() -> Vec<Case> {
    cases! { "device";
        "a host that stalls for a second" => "the device falls silent by itself", host_stalls;
        "a device that stalls" => "given up, with the reason", device_stalls;
        "a device that vanishes and comes back" =>
            "told, not armed again by itself", comes_back;
        "a device that garbles every byte" => "no harm, never armed", garbled;
        "a million random bytes" => "counted as bad, none taken", random_bytes;
        "a device of 25 contactors for a display of 24" =>
            "refused, with the reason", wrong_size;
        "amplitudes of NaN, ∞, −1 and 1e30 µm" =>
            "0, 0, 0 and limited, all counted", no_numbers;
    }
}

/// A simulation whose device plays.
fn streaming() -> Result<Simulation, String> {
    let simulation = Simulation::streaming(500);
    let is_live = simulation.host.state() == BridgeState::Streaming && simulation.is_loud();
    if is_live {
        Ok(simulation)
    } else {
        Err("the trial itself failed: it never streamed".to_owned())
    }
}

fn host_stalls() -> Verdict {
    let faults = once(OneOffKind::StallReading, 1000);
    let mut trial = Simulation::streaming_over(&faults, 2000);
    let is_silent = !trial.is_loud();
    let reason = trial.disarmed_by().map(|(_, reason)| reason.to_owned());
    trial.run(5000);
    let is_kept = !trial.is_loud();
    let described = reason.clone().unwrap_or_else(|| "nothing told".to_owned());
    let sound = if is_silent && is_kept {
        "silent"
    } else {
        "still loud"
    };
    let came_back = format!("{sound}; host: {described}");
    verdict(is_silent && is_kept && reason.is_some(), came_back)
}

/// Something that happens once, 800 ms after the start, for so many ms.
pub(super) fn once(kind: OneOffKind, for_ms: u64) -> Faults {
    let once = OneOff {
        at_us: 800_000,
        for_us: for_ms * 1000,
        kind,
    };
    Faults {
        once: vec![once],
        ..Faults::default()
    }
}

fn device_stalls() -> Verdict {
    let trial = Simulation::streaming_over(&once(OneOffKind::StallWriting, 60_000), 5000);
    match trial.lost() {
        Some(reason) => verdict(
            trial.host.state() == BridgeState::Lost,
            format!("lost: {reason}"),
        ),
        None => Err(format!("state {} after 5 s", trial.host.state())),
    }
}

fn comes_back() -> Verdict {
    let mut trial = streaming()?;
    trial.cut = true;
    trial.run(5000);
    let reason = trial.lost().ok_or("never told")?.to_owned();
    trial.cut = false;
    trial.run(5000);
    let (state, is_silent) = (trial.host.state(), !trial.is_loud());
    let is_kept = is_silent && !state.is_live();
    let came_back =
        format!("lost: {reason}; then {state}, silent until it is opened and armed anew");
    verdict(is_kept, came_back)
}

fn garbled() -> Verdict {
    let garbling = LinkFaults {
        flip_rate: 1.0,
        ..LinkFaults::default()
    };
    let faults = Faults {
        to_host: garbling,
        ..Faults::default()
    };
    let mut trial = Simulation::of(DeviceModel::default(), &faults);
    trial.run(10_000);
    let is_armed = trial.host.arm(trial.now());
    let (state, n_bad) = (trial.host.state(), trial.bad_texts_received());
    let came_back = format!("{state}, {n_bad} packets bad");
    verdict(!is_armed && !trial.is_loud(), came_back)
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
    let came_back = format!("{n_bad} packets bad, {n_taken} taken");
    verdict(n_taken == 0 && n_bad > 0, came_back)
}

fn wrong_size() -> Verdict {
    let model = DeviceModel {
        rows: 5,
        cols: 5,
        ..DeviceModel::default()
    };
    refused_by_host(Simulation::of(model, &Faults::default()))
}

/// A device that the host refuses, with the reason, and does not arm.
pub(super) fn refused_by_host(mut trial: Simulation) -> Verdict {
    trial.run(1000);
    let is_armed = trial.host.arm(trial.now());
    match trial.refused() {
        Some(reason) => verdict(!is_armed, format!("refused: {reason}")),
        None => Err(format!("state {}", trial.host.state())),
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
