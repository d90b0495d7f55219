//! Drive codes: the one place where amplitudes in µm become integers for a device.
//!
//! Every sink that speaks in codes (serial bridge, emulator, log) goes through [`Coder`], so
//! limits, calibration, wiring and counters are the same everywhere. Amplitudes come in contactor
//! order, codes leave in channel order. It knows nothing of ticks, sessions or packets, and it
//! smooths nothing: slew belongs to the device.

pub(super) use super::array::ArrayProfile;
use super::array::Calibration;
use selvedge_foundation::numerics::to_whole;

/// The largest drive code: a component's drive peak is `code / 65535` of the device's full scale.
pub const FULL_CODE: u16 = u16::MAX;

/// How often each rule changed an amplitude, since the coder was made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CodeCounters {
    /// Amplitudes that were NaN, negative or infinite and became 0.
    pub non_finite: u64,
    /// Amplitudes above the limit, `[40 Hz, 320 Hz]`.
    pub limited: [u64; 2],
    /// Contactors whose two components together exceeded full drive.
    pub guarded: u64,
    /// Contactors with an amplitude that the profile switches off.
    pub off: u64,
}

/// What happened to one contactor in the last call.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LimiterState {
    /// An amplitude was NaN, negative or infinite.
    pub non_finite: bool,
    /// The band's limit held, `[40 Hz, 320 Hz]`.
    pub limited: [bool; 2],
    /// That limit is the device's own, which is below the profile's.
    pub by_device: [bool; 2],
    /// Both components were scaled down to share full drive.
    pub guarded: bool,
    /// The profile switches the contactor off, and an amplitude was asked for.
    pub off: bool,
}

impl LimiterState {
    /// Whether anything differs from what was asked for.
    pub fn any(self) -> bool {
        self.non_finite || self.guarded || self.off || self.limited.contains(&true)
    }
}

/// The largest amplitude that a contactor is ever played with, before the bands share full drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// As what the contactor does, µm.
    pub um: f64,
    /// Whether it is the device's own rather than the profile's.
    pub is_of_device: bool,
}

/// What a device makes of codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinkScale {
    /// The largest code that it takes, `[40 Hz, 320 Hz]`.
    pub comp_limit: [u16; 2],
    /// Drive peak that a code of 65535 stands for, mV.
    pub fs_mv: u32,
}

/// Full scale and limits in µm, made safe: no NaN, no negative limit, full scale above 0.
#[derive(Clone, Copy, Debug)]
struct Scale {
    full_scale_um: [f64; 2],
    /// Of what a contactor does.
    limit_um: [f64; 2],
    /// Of its drive, as the amplitude that a contactor of nominal gain would have.
    drive_limit_um: [f64; 2],
    /// Drive peak at which full scale holds, mV.
    full_scale_mv: f64,
    /// The device's code for full drive, as a part of 65535.
    part: f64,
}

/// Where a contactor's codes go, and how strongly it is driven.
#[derive(Clone, Copy, Debug)]
struct Lead {
    channel: usize,
    calibration: Calibration,
}

/// Turns amplitudes into drive codes and counts what had to be changed.
#[derive(Clone, Debug)]
pub struct Coder {
    scale: Scale,
    /// What the device makes of codes, once it is known.
    link: Option<LinkScale>,
    leads: Vec<Lead>,
    counters: CodeCounters,
    limiters: Vec<LimiterState>,
}

impl Coder {
    /// A coder with the limits, the calibration and the wiring of `profile` for `n_contactors`
    /// contactors.
    ///
    /// A full scale or limit that is not a positive finite number silences its band, a drive gain
    /// that is none its contactor; a wiring that is no permutation of the contactors is left out.
    pub fn new(profile: &ArrayProfile, n_contactors: usize) -> Self {
        let lead = |contactor: usize| Lead {
            channel: contactor,
            calibration: sound(profile.calibration_of(contactor)),
        };
        let mut leads: Vec<Lead> = (0..n_contactors).map(lead).collect();
        let wiring = profile.wiring.as_ref();
        if let Some(wiring) = wiring.filter(|wiring| is_permutation(&wiring.channels, n_contactors))
        {
            for (lead, channel) in leads.iter_mut().zip(&wiring.channels) {
                lead.channel = usize::from(*channel);
            }
        }
        Self {
            scale: Scale::of(profile),
            link: None,
            leads,
            counters: CodeCounters::default(),
            limiters: vec![LimiterState::default(); n_contactors],
        }
    }

    /// A coder for one contactor of the profile alone, whatever its channel: to explain it.
    pub fn of_contactor(profile: &ArrayProfile, contactor: usize) -> Self {
        let mut coder = Self::new(profile, 1);
        for lead in &mut coder.leads {
            lead.channel = 0;
            lead.calibration = sound(profile.calibration_of(contactor));
        }
        coder
    }

    /// Goes on counting where another coder was, under the same limits of the device.
    pub fn go_on_from(&mut self, before: &Self) {
        self.counters = before.counters;
        if before.link.is_some() {
            self.set_link(before.link);
        }
    }

    /// Makes codes for this device: scaled by the profile's drive peak over the device's, limits
    /// lowered to what it accepts. `None`: a device of the profile's own voltage without limits.
    ///
    /// A device that cannot reach the profile's drive peak gets no more than it has.
    pub fn set_link(&mut self, link: Option<LinkScale>) {
        self.link = link;
        self.scale.drive_limit_um = [f64::INFINITY; 2];
        self.scale.part = 1.0;
        let Some(link) = link else { return };
        self.scale.part = self.scale.part_of(link.fs_mv).min(1.0);
        for (band, code) in link.comp_limit.into_iter().enumerate() {
            let full_code = f64::from(FULL_CODE) * self.scale.part;
            self.scale.drive_limit_um[band] =
                f64::from(code) * self.scale.full_scale_um[band] / full_code;
        }
    }

    /// The limits of a contactor in both bands, and whose they are.
    pub fn limits(&self, contactor: usize) -> [Limit; 2] {
        let lead = self.leads.get(contactor);
        let gains = lead.map_or([1.0; 2], |lead| lead.calibration.drive_gain);
        [0, 1].map(|band| {
            let is_of_device = self.scale.device_is_lower(band, gains[band]);
            let um = if is_of_device {
                self.scale.drive_limit_um[band] / gains[band]
            } else {
                self.scale.limit_um[band]
            };
            Limit { um, is_of_device }
        })
    }

    /// The component limits to ask a device for whose code of 65535 stands for `fs_mv`: the
    /// smallest codes that no allowed amplitude exceeds on any contactor.
    pub fn comp_limit(&self, fs_mv: u32) -> [u16; 2] {
        let part = self.scale.part_of(fs_mv).min(1.0);
        let driven = self.leads.iter().filter(|lead| !lead.calibration.is_off);
        let gains = driven.map(|lead| lead.calibration.drive_gain);
        let largest = gains.reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])]);
        let largest = largest.unwrap_or([1.0; 2]);
        [0, 1].map(|band| {
            let share = self.scale.limit_um[band] * largest[band] / self.scale.full_scale_um[band];
            round_half_up((65535.0 * part * share.min(1.0)).ceil())
        })
    }

    /// The code for a channel whose contactor is not known: this amplitude at 320 Hz, µm, within
    /// every limit, without calibration.
    pub(crate) fn ident_code(&self, amplitude_um: f32) -> u16 {
        let (code, _) = drive_code(
            [0.0, amplitude_um],
            1.0,
            &self.scale,
            Calibration::default(),
        );
        code[1]
    }

    /// Codes `[40 Hz, 320 Hz]` of every channel, without allocating.
    ///
    /// `amplitudes_um` are peak amplitudes `[A40, A320]` in µm of every contactor, `gain` the
    /// soft-start gain 0…1 (NaN counts as 0). Contactors without an amplitude get 0.
    pub fn encode_into(&mut self, amplitudes_um: &[[f32; 2]], gain: f64, codes: &mut [[u16; 2]]) {
        let gain = if gain.is_nan() {
            0.0
        } else {
            gain.clamp(0.0, 1.0)
        };
        self.limiters.fill(LimiterState::default());
        codes.fill([0, 0]);
        let asked = amplitudes_um.iter().take(codes.len()).enumerate();
        for (contactor, &amplitude_um) in asked {
            let straight = Lead {
                channel: contactor,
                calibration: Calibration::default(),
            };
            let lead = self.leads.get(contactor).copied().unwrap_or(straight);
            let (code, limiter) = drive_code(amplitude_um, gain, &self.scale, lead.calibration);
            if let Some(slot) = codes.get_mut(lead.channel) {
                *slot = code;
            }
            self.counters.count(amplitude_um, limiter);
            if let Some(shown) = self.limiters.get_mut(contactor) {
                *shown = limiter;
            }
        }
    }

    /// As [`encode_into`](Self::encode_into), with one code pair for each amplitude pair.
    pub fn encode(&mut self, amplitudes_um: &[[f32; 2]], gain: f64) -> Vec<[u16; 2]> {
        let mut codes = vec![[0; 2]; amplitudes_um.len()];
        self.encode_into(amplitudes_um, gain, &mut codes);
        codes
    }

    /// What the limits leave of a contactor's amplitude at full gain, µm: what it does itself,
    /// whatever drive that takes.
    pub fn limited_um(&self, contactor: usize, amplitude_um: [f32; 2]) -> [f32; 2] {
        let calibration = self.leads.get(contactor).map(|lead| lead.calibration);
        let calibration = calibration.unwrap_or_default();
        let (driven_um, _) = driven(amplitude_um, 1.0, &self.scale, calibration);
        [0, 1].map(|band| {
            let gain = calibration.drive_gain[band];
            #[expect(clippy::cast_possible_truncation, reason = "at most the limit")]
            let um = (driven_um[band] / gain) as f32;
            if um.is_finite() { um } else { 0.0 }
        })
    }

    /// Totals since the coder was made.
    pub fn counters(&self) -> CodeCounters {
        self.counters
    }

    /// Per contactor, what the last call changed.
    pub fn limited(&self) -> &[LimiterState] {
        &self.limiters
    }
}

impl CodeCounters {
    fn count(&mut self, amplitude_um: [f32; 2], limiter: LimiterState) {
        if limiter.non_finite {
            self.non_finite += amplitude_um
                .iter()
                .filter(|a| !usable(**a))
                .map(|_| 1)
                .sum::<u64>();
        }
        for (total, limited) in self.limited.iter_mut().zip(limiter.limited) {
            *total += u64::from(limited);
        }
        self.guarded += u64::from(limiter.guarded);
        self.off += u64::from(limiter.off);
    }
}

fn usable(amplitude_um: f32) -> bool {
    amplitude_um.is_finite() && amplitude_um >= 0.0
}

/// The drive of one contactor, µm of nominal gain: limit, calibrate, share full drive.
fn driven(
    amplitude_um: [f32; 2],
    gain: f64,
    scale: &Scale,
    calibration: Calibration,
) -> ([f64; 2], LimiterState) {
    let mut limiter = LimiterState::default();
    let mut driven_um = [0.0; 2];
    for band in 0..2 {
        if !usable(amplitude_um[band]) {
            limiter.non_finite = true;
            continue;
        }
        let wanted_um = f64::from(amplitude_um[band]) * gain;
        if calibration.is_off {
            limiter.off |= wanted_um > 0.0;
            continue;
        }
        let needed_um = wanted_um.min(scale.limit_um[band]) * calibration.drive_gain[band];
        limiter.limited[band] =
            wanted_um > scale.limit_um[band] || needed_um > scale.drive_limit_um[band];
        limiter.by_device[band] =
            limiter.limited[band] && scale.device_is_lower(band, calibration.drive_gain[band]);
        driven_um[band] = needed_um.min(scale.drive_limit_um[band]);
    }
    let share = driven_um[0] / scale.full_scale_um[0] + driven_um[1] / scale.full_scale_um[1];
    if share > 1.0 {
        limiter.guarded = true;
        driven_um = driven_um.map(|a_um| a_um / share);
    }
    (driven_um, limiter)
}

/// The code of one contactor: its drive, rounded half up, never more than 65535 in all.
fn drive_code(
    amplitude_um: [f32; 2],
    gain: f64,
    scale: &Scale,
    calibration: Calibration,
) -> ([u16; 2], LimiterState) {
    let (driven_um, limiter) = driven(amplitude_um, gain, scale, calibration);
    let full = f64::from(FULL_CODE) * scale.part;
    let [code_40, code_320] =
        [0, 1].map(|band| round_half_up(full * driven_um[band] / scale.full_scale_um[band]));
    // Rounding both halves up can exceed full drive by one.
    let most = round_half_up(full);
    ([code_40, code_320.min(most - code_40)], limiter)
}

impl Scale {
    fn of(profile: &ArrayProfile) -> Self {
        let mut scale = Self {
            full_scale_um: profile.full_scale_um,
            limit_um: profile.limit_um,
            drive_limit_um: [f64::INFINITY; 2],
            full_scale_mv: f64::from(profile.full_scale_mv),
            part: 1.0,
        };
        for (full_scale_um, limit_um) in scale.full_scale_um.iter_mut().zip(&mut scale.limit_um) {
            let usable = full_scale_um.is_finite() && *full_scale_um > 0.0 && *limit_um > 0.0;
            *limit_um = if usable { *limit_um } else { 0.0 };
            *full_scale_um = if usable { *full_scale_um } else { 1.0 };
        }
        scale
    }

    fn part_of(&self, fs_mv: u32) -> f64 {
        self.full_scale_mv / f64::from(fs_mv.max(1))
    }

    /// Whether the device's limit of a contactor with this drive gain is below the profile's. One
    /// that was asked for because of the profile is that rounded up, and within half a code of it.
    fn device_is_lower(&self, band: usize, drive_gain: f64) -> bool {
        let half_um = 0.5 * self.full_scale_um[band] / (f64::from(FULL_CODE) * self.part);
        self.drive_limit_um[band] + half_um < self.limit_um[band] * drive_gain
    }
}

/// The same with a contactor whose gains make no sense switched off.
fn sound(calibration: Calibration) -> Calibration {
    let [least, most] = Calibration::DRIVE_GAIN;
    let are_gains = calibration
        .drive_gain
        .iter()
        .all(|gain| (least..=most).contains(gain));
    Calibration {
        is_off: calibration.is_off || !are_gains,
        ..calibration
    }
}

fn is_permutation(channels: &[u16], n: usize) -> bool {
    let mut is_taken = vec![false; n];
    let mut takes = |channel: &u16| {
        let slot = is_taken.get_mut(usize::from(*channel));
        slot.is_some_and(|slot| !std::mem::replace(slot, true))
    };
    channels.len() == n && channels.iter().all(&mut takes)
}

fn round_half_up(code: f64) -> u16 {
    to_whole((code + 0.5).floor())
}

#[cfg(test)]
mod tests;
