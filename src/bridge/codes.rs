//! Drive codes: the one place where amplitudes in µm become integers for a device.
//!
//! Every sink that speaks in codes (serial bridge, emulator, log) goes through [`Coder`], so limits
//! and counters are the same everywhere. It knows nothing of ticks, sessions or packets, and it
//! smooths nothing: slew belongs to the device.

/// The largest drive code: a component's drive peak is `code / 65535` of the device's full scale.
pub const FULL_CODE: u16 = u16::MAX;

/// What the host assumes of an array: shape, scale and limits.
///
/// The scale is an assumption of this program (50 µm at full drive), not a property that a device
/// reports.
#[derive(Clone, Debug, PartialEq)]
pub struct ArrayProfile {
    /// Name for people, `exeter-24`.
    pub name: String,
    /// Rows, the fingertip end first.
    pub rows: u8,
    /// Columns, left first.
    pub cols: u8,
    /// Distance of neighbouring contactors in µm.
    pub pitch_um: u16,
    /// `[F40, F320]`: peak displacement in µm that a code of 65535 stands for.
    pub full_scale_um: [f64; 2],
    /// Largest amplitude per band in µm.
    pub limit_um: [f64; 2],
    /// Time without an accepted frame before the device starts its ramp, in ms.
    pub hold_ms: u16,
    /// Duration of the device's ramp to silence, in ms.
    pub ramp_ms: u16,
    /// High voltage to ask for, in 0.1 V.
    pub hv_dv: u16,
}

impl ArrayProfile {
    /// `rows · cols`.
    pub fn n_contactors(&self) -> usize {
        usize::from(self.rows) * usize::from(self.cols)
    }
}

impl Default for ArrayProfile {
    fn default() -> Self {
        Self {
            name: String::from("exeter-24"),
            rows: 6,
            cols: 4,
            pitch_um: 2000,
            full_scale_um: [50.0, 50.0],
            limit_um: [50.0, 50.0],
            hold_ms: 60,
            ramp_ms: 40,
            hv_dv: 600,
        }
    }
}

/// How often each rule changed an amplitude, since the coder was made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CodeCounters {
    /// Amplitudes that were NaN, negative or infinite and became 0.
    pub non_finite: u64,
    /// Amplitudes above the limit, `[40 Hz, 320 Hz]`.
    pub limited: [u64; 2],
    /// Contactors whose two components together exceeded full drive.
    pub guarded: u64,
}

/// What happened to one contactor in the last call.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Bite {
    /// An amplitude was NaN, negative or infinite.
    pub non_finite: bool,
    /// The band's limit held, `[40 Hz, 320 Hz]`.
    pub limited: [bool; 2],
    /// Both components were scaled down to share full drive.
    pub guarded: bool,
}

impl Bite {
    /// Whether anything differs from what was asked for.
    pub fn any(self) -> bool {
        self.non_finite || self.guarded || self.limited.contains(&true)
    }
}

/// Full scale and limits, both in µm, made safe: no NaN, no negative limit, full scale above 0.
#[derive(Clone, Copy, Debug)]
struct Scale {
    full_scale_um: [f64; 2],
    limit_um: [f64; 2],
}

/// Turns amplitudes into drive codes and counts what had to be changed.
#[derive(Clone, Debug)]
pub struct Coder {
    profile: Scale,
    effective: Scale,
    counters: CodeCounters,
    bites: Vec<Bite>,
}

impl Coder {
    /// A coder with the limits of `profile` for `n_contactors` contactors.
    ///
    /// A full scale or limit that is not a positive finite number silences its band.
    pub fn new(profile: &ArrayProfile, n_contactors: usize) -> Self {
        let mut scale = Scale {
            full_scale_um: profile.full_scale_um,
            limit_um: profile.limit_um,
        };
        for (full_scale_um, limit_um) in scale.full_scale_um.iter_mut().zip(&mut scale.limit_um) {
            let usable = full_scale_um.is_finite() && *full_scale_um > 0.0 && *limit_um > 0.0;
            *limit_um = if usable { *limit_um } else { 0.0 };
            *full_scale_um = if usable { *full_scale_um } else { 1.0 };
        }
        Self {
            profile: scale,
            effective: scale,
            counters: CodeCounters::default(),
            bites: vec![Bite::default(); n_contactors],
        }
    }

    /// Lowers the limits to what the device accepts: `min(limit, comp_limit · F / 65535)` per band.
    pub fn set_link_limit(&mut self, comp_limit: [u16; 2]) {
        for (band, code) in comp_limit.into_iter().enumerate() {
            let link_um = f64::from(code) * self.profile.full_scale_um[band] / f64::from(FULL_CODE);
            self.effective.limit_um[band] = self.profile.limit_um[band].min(link_um);
        }
    }

    /// The component limits to ask a device for: the smallest codes that no allowed amplitude
    /// exceeds.
    pub fn comp_limit(&self) -> [u16; 2] {
        [0, 1].map(|band| {
            let share = self.profile.limit_um[band] / self.profile.full_scale_um[band];
            round_half_up((65535.0 * share).ceil().min(65535.0))
        })
    }

    /// Codes `[40 Hz, 320 Hz]` of every contactor, without allocating.
    ///
    /// `amplitudes_um` are peak amplitudes `[A40, A320]` in µm, `gain` the soft-start gain 0…1 (NaN
    /// counts as 0). Contactors without an amplitude get 0.
    pub fn encode_into(&mut self, amplitudes_um: &[[f32; 2]], gain: f64, codes: &mut [[u16; 2]]) {
        let gain = if gain.is_nan() {
            0.0
        } else {
            gain.clamp(0.0, 1.0)
        };
        self.bites.fill(Bite::default());
        for (contactor_index, slot) in codes.iter_mut().enumerate() {
            let Some(&amplitude_um) = amplitudes_um.get(contactor_index) else {
                *slot = [0, 0];
                continue;
            };
            let (code, bite) = drive_code(amplitude_um, gain, &self.effective);
            *slot = code;
            self.counters.count(amplitude_um, bite);
            if let Some(shown) = self.bites.get_mut(contactor_index) {
                *shown = bite;
            }
        }
    }

    /// As [`encode_into`](Self::encode_into), with one code pair for each amplitude pair.
    pub fn encode(&mut self, amplitudes_um: &[[f32; 2]], gain: f64) -> Vec<[u16; 2]> {
        let mut codes = vec![[0; 2]; amplitudes_um.len()];
        self.encode_into(amplitudes_um, gain, &mut codes);
        codes
    }

    /// Totals since the coder was made.
    pub fn counters(&self) -> CodeCounters {
        self.counters
    }

    /// Per contactor, what the last call changed.
    pub fn limited(&self) -> &[Bite] {
        &self.bites
    }
}

impl CodeCounters {
    fn count(&mut self, amplitude_um: [f32; 2], bite: Bite) {
        if bite.non_finite {
            self.non_finite += amplitude_um
                .iter()
                .filter(|a| !usable(**a))
                .map(|_| 1)
                .sum::<u64>();
        }
        for (total, limited) in self.limited.iter_mut().zip(bite.limited) {
            *total += u64::from(limited);
        }
        self.guarded += u64::from(bite.guarded);
    }
}

fn usable(amplitude_um: f32) -> bool {
    amplitude_um.is_finite() && amplitude_um >= 0.0
}

/// The code of one contactor: limit, share full drive, round half up, never
/// more than 65535 in all.
fn drive_code(amplitude_um: [f32; 2], gain: f64, scale: &Scale) -> ([u16; 2], Bite) {
    let mut bite = Bite::default();
    let mut driven_um = [0.0; 2];
    for band in 0..2 {
        if !usable(amplitude_um[band]) {
            bite.non_finite = true;
            continue;
        }
        let wanted_um = f64::from(amplitude_um[band]) * gain;
        bite.limited[band] = wanted_um > scale.limit_um[band];
        driven_um[band] = wanted_um.min(scale.limit_um[band]);
    }
    let share = driven_um[0] / scale.full_scale_um[0] + driven_um[1] / scale.full_scale_um[1];
    if share > 1.0 {
        bite.guarded = true;
        driven_um = driven_um.map(|a_um| a_um / share);
    }
    let [code_40, code_320] =
        [0, 1].map(|band| round_half_up(65535.0 * driven_um[band] / scale.full_scale_um[band]));
    // Rounding both halves up can exceed full drive by one.
    ([code_40, code_320.min(FULL_CODE - code_40)], bite)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the argument is finite and in 0…65535 by the limits; `as` saturates besides"
)]
fn round_half_up(code: f64) -> u16 {
    (code + 0.5).floor() as u16
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn coder() -> Coder {
        Coder::new(&ArrayProfile::default(), 1)
    }

    fn code(a40: f32, a320: f32) -> [u16; 2] {
        coder().encode(&[[a40, a320]], 1.0)[0]
    }

    #[test]
    fn codes_follow_the_closed_form() {
        assert_eq!(code(0.0, 0.0), [0, 0]);
        assert_eq!(code(50.0, 0.0), [65535, 0]);
        assert_eq!(code(0.0, 50.0), [0, 65535]);
        assert_eq!(code(10.0, 20.0), [13107, 26214]);
        // 65535 · 0.000381… rounds half up at exactly one half: 25 µm is 32767.5.
        assert_eq!(code(25.0, 0.0), [32768, 0]);
        assert_eq!(coder().encode(&[[20.0, 10.0]], 0.05)[0], [1311, 655]);
    }

    #[test]
    fn two_halves_never_exceed_full_drive() {
        let mut coder = coder();
        assert_eq!(coder.encode(&[[25.0, 25.0]], 1.0)[0], [32768, 32767]);
        assert_eq!(coder.counters().guarded, 0, "exactly full is not too much");
        assert_eq!(coder.encode(&[[50.0, 50.0]], 1.0)[0], [32768, 32767]);
        assert_eq!(coder.counters().guarded, 1);
        assert!(coder.limited()[0].guarded);
    }

    #[test]
    fn numbers_that_are_none_are_silent_and_counted() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0] {
            let mut coder = coder();
            assert_eq!(coder.encode(&[[bad, 10.0]], 1.0)[0], [0, 13107]);
            assert_eq!(coder.encode(&[[bad, bad]], 1.0)[0], [0, 0]);
            assert_eq!(coder.counters().non_finite, 3);
            assert!(coder.limited()[0].any());
        }
        assert_eq!(coder().encode(&[[10.0, 10.0]], f64::NAN)[0], [0, 0]);
        assert_eq!(coder().encode(&[[10.0, 0.0]], 7.0)[0], [13107, 0]);
    }

    #[test]
    fn limits_are_counted_per_band_and_the_link_lowers_them() {
        let profile = ArrayProfile {
            limit_um: [5.0, 40.0],
            ..ArrayProfile::default()
        };
        let mut coder = Coder::new(&profile, 2);
        assert_eq!(
            coder.encode(&[[6.0, 6.0], [5.0, 0.0]], 1.0),
            [[6554, 7864], [6554, 0]]
        );
        assert_eq!(coder.counters().limited, [1, 0]);
        assert_eq!(coder.limited()[0].limited, [true, false]);
        assert!(!coder.limited()[1].any());
        for limit in [0, 1, 999, 32768, 65535] {
            coder.set_link_limit([65535, limit]);
            let expected = limit.min(52428);
            assert_eq!(coder.encode(&[[0.0, 50.0]], 1.0)[0], [0, expected]);
        }
    }

    #[test]
    fn a_profile_that_makes_no_sense_is_silent() {
        for full_scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let profile = ArrayProfile {
                full_scale_um: [full_scale, 50.0],
                ..ArrayProfile::default()
            };
            assert_eq!(
                Coder::new(&profile, 1).encode(&[[10.0, 10.0]], 1.0)[0],
                [0, 13107]
            );
        }
    }

    #[test]
    fn missing_amplitudes_are_silent() {
        let mut codes = [[7, 7]; 3];
        coder().encode_into(&[[50.0, 0.0]], 1.0, &mut codes);
        assert_eq!(codes, [[65535, 0], [0, 0], [0, 0]]);
    }

    proptest! {
        #[test]
        fn the_sum_never_exceeds_full_drive(
            a in any::<f32>(), b in any::<f32>(), g in any::<f64>(),
        ) {
            let [low, high] = coder().encode(&[[a, b]], g)[0];
            prop_assert!(u32::from(low) + u32::from(high) <= 65535);
        }

        #[test]
        fn more_amplitude_is_never_less_code(a in 0f32..60.0, more in 0f32..60.0, g in 0.0..1.0) {
            let [low, _] = coder().encode(&[[a, 0.0]], g)[0];
            let [high, _] = coder().encode(&[[a + more, 0.0]], g)[0];
            prop_assert!(low <= high);
        }

        #[test]
        fn sharing_full_drive_keeps_the_ratio(a in 25f32..50.0, b in 25f32..50.0) {
            let [low, high] = coder().encode(&[[a, b]], 1.0)[0];
            let share = f64::from(a) / (f64::from(a) + f64::from(b));
            prop_assert!((f64::from(low) - 65535.0 * share).abs() <= 0.5 + 1e-6);
            prop_assert!(u32::from(low) + u32::from(high) >= 65534);
        }
    }
}
