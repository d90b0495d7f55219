//! The device's own numbers against the emulator's, STATUS by STATUS.

use crate::device::Moment;
use crate::message::{Config, DeviceState, LARGEST_CHANNELS, Status};

/// Nearer than this to an edge of a ramp or of a state neither side of it is wrong, µs.
pub(super) const EDGE_US: u64 = 2000;
/// The same while the time of a request that matters is known to its tick only.
pub(super) const GUESS_US: u64 = 25_000;

/// One number on which device and emulator disagree.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Disagreement {
    pub(super) what: &'static str,
    pub(super) device: String,
    pub(super) emulator: String,
}

impl Disagreement {
    pub(super) fn new(
        what: &'static str,
        device: &impl ToString,
        emulator: &impl ToString,
    ) -> Self {
        Self {
            what,
            device: device.to_string(),
            emulator: emulator.to_string(),
        }
    }
}

/// What may be judged of a STATUS.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scope {
    /// The log has the codes of frames.
    pub(super) has_frames: bool,
    /// A packet of which nobody can tell whether it arrived may have changed what depends on it.
    pub(super) is_doubtful: bool,
    /// The time of a request is known to its tick only.
    pub(super) is_guessed: bool,
}

/// A STATUS of the device and of the emulator at the same tick.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub(super) device: Status,
    pub(super) emulator: Status,
}

impl Pair {
    /// On which numbers both disagree; `around` are the emulator's moments near this one.
    pub(super) fn disagreements(
        &self,
        before: Option<&Self>,
        scope: Scope,
        around: impl FnOnce() -> Vec<Moment>,
    ) -> Vec<Disagreement> {
        let (device, emulator) = (&self.device, &self.emulator);
        let mut found = Vec::new();
        if scope.is_doubtful {
            return found;
        }
        let is_same_sum = !scope.has_frames || device.amp_sum == emulator.amp_sum;
        if device.state != emulator.state || !is_same_sum {
            let around = around();
            found.extend(self.state(&around));
            if scope.has_frames {
                found.extend(self.amp_sum(&around, scope.is_guessed));
            }
        }
        if device.age_ms.abs_diff(emulator.age_ms) > 1 {
            found.push(Disagreement::new(
                "age_ms",
                &device.age_ms,
                &emulator.age_ms,
            ));
        }
        if device.queued != emulator.queued && !scope.is_guessed {
            found.push(Disagreement::new(
                "queued",
                &device.queued,
                &emulator.queued,
            ));
        }
        found.extend(
            before
                .into_iter()
                .flat_map(|before| self.counters(before, scope)),
        );
        found
    }

    fn state(&self, around: &[Moment]) -> Option<Disagreement> {
        let told = self.device.state;
        let is_near = around.iter().any(|moment| moment.state.code() == told);
        (told != self.emulator.state && !is_near).then(|| {
            Disagreement::new("state", &state_name(told), &state_name(self.emulator.state))
        })
    }

    /// Exactly alike while nothing but frames changes it; near an edge between what it is before
    /// and after.
    fn amp_sum(&self, around: &[Moment], is_guessed: bool) -> Option<Disagreement> {
        let (told, own) = (self.device.amp_sum, self.emulator.amp_sum);
        let is_edge =
            |moment: &Moment| moment.gain < 1.0 || moment.state.code() != self.emulator.state;
        let sums = around.iter().map(|moment| moment.amp_sum);
        let (least, most) = (sums.clone().min()?.min(own), sums.max()?.max(own));
        let is_near = is_guessed || around.iter().any(is_edge);
        let is_fine = told == own || is_near && (least..=most).contains(&told);
        (!is_fine).then(|| Disagreement::new("amp_sum", &told, &own))
    }

    /// What both counted since the STATUS before.
    fn counters(&self, before: &Self, scope: Scope) -> Vec<Disagreement> {
        let step = |of: fn(&Status) -> u16| {
            let since = |now: &Status, then: &Status| of(now).wrapping_sub(of(then));
            [
                since(&self.device, &before.device),
                since(&self.emulator, &before.emulator),
            ]
        };
        let mut steps = vec![
            ("underrun", step(|status| status.underrun)),
            ("late", step(|status| status.late)),
        ];
        if scope.has_frames {
            steps.push(("clipped", step(|status| status.clipped)));
        }
        // Whether a tick near a STOP or after an arming counts depends on the moment.
        steps.retain(|(_, [device, emulator])| device != emulator && !scope.is_guessed);
        let more = |(what, [device, emulator]): (&'static str, [u16; 2])| {
            Disagreement::new(what, &format!("+{device}"), &format!("+{emulator}"))
        };
        steps.into_iter().map(more).collect()
    }
}

/// The settings that the device says hold against those that the emulator makes of them.
pub(super) fn compare_config(
    device: &Config,
    emulator: &Config,
    n_channels: usize,
) -> Option<Disagreement> {
    let words = |config: &Config| {
        let is_on = |channel: &usize| config.mask.contains(*channel);
        let n_on = (0..n_channels.min(LARGEST_CHANNELS)).filter(is_on).count();
        let [low, high] = config.comp_limit;
        format!(
            "mode {}, flags {}, hold {} ms, ramp {} ms, slew {}, {} dV, limits {low}/{high}, \
             {n_on} on",
            config.mode, config.flags, config.hold_ms, config.ramp_ms, config.slew, config.hv_dv,
        )
    };
    let (device, emulator) = (words(device), words(emulator));
    (device != emulator).then(|| Disagreement::new("CFG", &device, &emulator))
}

pub(super) fn state_name(code: u8) -> String {
    let known = DeviceState::from_code(code);
    known.map_or_else(|| format!("state {code}"), |state| state.name().to_owned())
}
