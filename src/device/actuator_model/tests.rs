//! Against the closed form, against Runge–Kutta with 32 steps a sample, and at the extremes.

use std::f64::consts::TAU;

use super::contactor::{Contact, U_AMP, V_BEAM, X_PIN};
use super::sample::{SAMPLE_S, State, Steps};
use super::synth::Synth;
use super::*;
use selvedge_foundation::numerics::{Random, RealTransform};

mod feed;

const LOADS: [Skin; 4] = [
    Skin::FREE,
    Skin::LIGHT,
    Skin::bonded(500.0, 0.2),
    Skin::FIRM,
];
/// Rails that hold nothing back.
const RAIL_V: f64 = 60.0;

fn loaded(skin: Skin) -> ContactorModel {
    ContactorModel {
        skin,
        ..ContactorModel::default()
    }
}

fn volts(code: u16) -> f64 {
    50.0 * f64::from(code) / 65_535.0
}

#[test]
fn displacement_at_40_and_320_hz_is_within_a_thousandth_of_the_closed_form() {
    for skin in LOADS {
        let model = loaded(skin);
        let mut actuators = ActuatorModel::new(&model, 24).unwrap();
        let codes = [[30_000, 20_000]; 24];
        for _ in 0..40 {
            actuators.tick(&codes, RAIL_V);
        }
        for (index, contactor) in actuators.reading().contactors.iter().enumerate() {
            for (band, frequency_hz) in [40.0, 320.0].into_iter().enumerate() {
                let of_path = model.response_um_per_v(frequency_hz).norm()
                    * ContactorModel::hold_droop(frequency_hz);
                let wanted = volts(codes[0][band]) * of_path;
                let off = contactor.amplitude_um[band] / wanted - 1.0;
                assert!(
                    off.abs() < 1e-3,
                    "{skin}, {index}, {frequency_hz} Hz: {off:e}"
                );
            }
            assert_eq!(
                (contactor.lost_share, contactor.saturated_share),
                (0.0, 0.0)
            );
        }
    }
}

#[test]
fn the_current_in_closed_form_is_the_plants_own() {
    for skin in LOADS {
        let model = loaded(skin);
        let mut actuators = ActuatorModel::new(&model, 24).unwrap();
        for codes in [[30_000, 20_000], [40_000, 0], [0, 40_000]] {
            for _ in 0..40 {
                actuators.tick(&[codes; 24], RAIL_V);
            }
            let found = model.load().ma(std::iter::repeat_n(codes, 24));
            let wanted = actuators.reading().current_ma();
            assert!(
                (found / wanted - 1.0).abs() < 5e-3,
                "{skin}, {codes:?}: {found} mA, the plant {wanted} mA"
            );
        }
    }
    let idle = loaded(Skin::LIGHT).load().ma([[0; 2]; 24].into_iter());
    assert!(idle.abs() < 1e-12);
}

#[test]
fn an_unchanging_frame_has_no_line_above_the_dac_but_the_images_of_its_hold() {
    const FINE: usize = 16;
    let (model, codes) = (loaded(Skin::LIGHT), [25_000, 17_000]);
    let (steps, synth) = (Steps::new(&model).unwrap(), Synth::new(50.0));
    let (mut state, mut contact) = ([0.0; 5], Contact::On);
    let mut way_um = Vec::new();
    for sample in 0..40 * SAMPLES_PER_TICK {
        let volts = synth.volts(codes, synth.phasors(sample));
        let drives = steps.drives(state[U_AMP], volts);
        assert!(!drives.is_slewing());
        for _ in 0..FINE {
            steps.advance_part(&mut state, &mut contact, drives, FINE);
            way_um.push(1e6 * state[X_PIN]);
        }
    }
    let tick = &way_um[39 * SAMPLES_PER_TICK * FINE..];
    let lines = RealTransform::new(tick.len()).forward(tick);
    let (mut n_lines, mut images) = (0, Vec::new());
    for (nth, line) in lines.iter().enumerate().skip(1) {
        let frequency_hz = 40.0 * nth as f64;
        let of_path = model.response_um_per_v(frequency_hz).norm()
            * ContactorModel::hold_droop(frequency_hz).abs();
        let counts = 2.0 * line.norm() / tick.len() as f64 / (of_path * synth.count_v());
        let from_rate_hz = (frequency_hz - 8000.0 * (frequency_hz / 8000.0).round()).abs();
        if [40.0, 320.0]
            .iter()
            .any(|carrier| (from_rate_hz - carrier).abs() < 1.0)
        {
            images.push(counts);
        } else if from_rate_hz > 1.0 {
            n_lines += 1;
            assert!(counts < 0.5, "{frequency_hz} Hz: {counts} counts");
        }
    }
    assert!(n_lines > 1500, "{n_lines} lines were looked at");
    assert!(
        images.len() > 30 && images.iter().all(|counts| *counts > 100.0),
        "{images:?}"
    );
}

/// The physics written out, with no matrix, no regime and no event.
struct Oracle {
    model: ContactorModel,
    state: State,
}

impl Oracle {
    fn rates(&self, [x, v, pin, w, u]: State, volts: f64) -> State {
        let (m, beam) = (&self.model, &self.model.bimorph);
        let (beam_kg, pin_kg) = (beam.mass_kg(), 1e-6 * m.pin_mg);
        let damping = (beam.stiffness_n_per_m() * beam_kg).sqrt() / m.quality;
        let both_kg = 1.0 / (1.0 / beam_kg + 1.0 / pin_kg);
        let stem_damping = (m.stem_n_per_m * both_kg).sqrt() / m.stem_quality;
        let stem_n = m.stem_n_per_m * (x - pin) + stem_damping * (v - w);
        let preload_n = m
            .skin
            .preload_um
            .map(|um| 1e-6 * um * m.skin.stiffness_n_per_m);
        let pushed_n = m.skin.stiffness_n_per_m * pin + m.skin.damping_n_s_per_m * w;
        let skin_n = match preload_n {
            Some(preload_n) => (pushed_n + preload_n).max(0.0) - preload_n,
            None => pushed_n,
        };
        let steepest = m.amplifier.steepest_v_per_s(beam.capacitance_f());
        let slope = ((volts - u) / m.amplifier.time_constant_s).clamp(-steepest, steepest);
        let beam_n = beam.force_n_per_v() * u - beam.stiffness_n_per_m() * x - damping * v;
        [
            v,
            (beam_n - stem_n) / beam_kg,
            w,
            (stem_n - skin_n) / pin_kg,
            slope,
        ]
    }

    /// One sample by the classical method with 32 steps.
    fn sample(&mut self, volts: f64) {
        let step_s = SAMPLE_S / 32.0;
        for _ in 0..32 {
            let at =
                |by_s: f64, rates: State| std::array::from_fn(|i| self.state[i] + by_s * rates[i]);
            let first = self.rates(self.state, volts);
            let second = self.rates(at(0.5 * step_s, first), volts);
            let third = self.rates(at(0.5 * step_s, second), volts);
            let fourth = self.rates(at(step_s, third), volts);
            for (i, x) in self.state.iter_mut().enumerate() {
                *x += step_s / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]);
            }
        }
    }
}

/// The largest difference of pins over five ticks of changing codes, over the largest way.
fn against_oracle(
    model: ContactorModel,
    codes: impl Fn(usize) -> [u16; 2],
) -> (f64, ActuatorModel) {
    let mut actuators = ActuatorModel::new(&model, 1).unwrap();
    let synth = Synth::new(model.full_scale_v);
    let mut oracle = Oracle {
        model,
        state: [0.0; 5],
    };
    let (mut off_um, mut max_um) = (0.0_f64, 0.0_f64);
    for sample in 0..5 * SAMPLES_PER_TICK {
        let codes = codes(sample / SAMPLES_PER_TICK);
        actuators.run(&[codes], 1e3, 1);
        oracle.sample(synth.volts(codes, synth.phasors(sample % SAMPLES_PER_TICK)));
        let wanted_um = 1e6 * oracle.state[X_PIN];
        off_um = off_um.max((actuators.displacement_um(0) - wanted_um).abs());
        max_um = max_um.max(wanted_um.abs());
    }
    (off_um / max_um, actuators)
}

fn changing(tick: usize) -> [u16; 2] {
    [
        [0, 40_000],
        [30_000, 0],
        [30_000, 35_535],
        [0, 0],
        [10_000, 50_000],
    ][tick]
}

#[test]
fn the_linear_contactor_agrees_with_runge_kutta() {
    for skin in LOADS {
        let (off, _) = against_oracle(loaded(skin), changing);
        assert!(off < 1e-5, "{skin}: {off:e}");
    }
}

#[test]
fn lifting_off_and_slewing_agree_with_runge_kutta() {
    for (preload_um, slew_v_per_us) in [(10.0, 2.2), (0.0, 2.2), (1e4, 0.05), (5.0, 0.05)] {
        let mut model = loaded(Skin {
            preload_um: Some(preload_um),
            ..Skin::bonded(500.0, 0.2)
        });
        model.amplifier.slew_v_per_us = slew_v_per_us;
        let (off, actuators) = against_oracle(model, changing);
        assert!(off < 2e-3, "{preload_um} µm, {slew_v_per_us} V/µs: {off:e}");
        let last = actuators.reading().contactors[0];
        assert_eq!(last.lost_share > 0.0, preload_um < 100.0, "{last:?}");
        assert_eq!(last.saturated_share > 0.0, slew_v_per_us < 1.0, "{last:?}");
    }
}

#[test]
fn skin_without_preload_is_off_for_about_half_of_the_time() {
    let model = loaded(Skin {
        preload_um: Some(0.0),
        ..Skin::bonded(200.0, 0.05)
    });
    let mut actuators = ActuatorModel::new(&model, 1).unwrap();
    for _ in 0..20 {
        actuators.tick(&[[40_000, 0]], RAIL_V);
    }
    let share = actuators.reading().contactors[0].lost_share;
    assert!((0.35..0.6).contains(&share), "{share}");
}

#[test]
fn the_current_is_what_capacitance_and_motion_take() {
    let model = loaded(Skin::LIGHT);
    let mut actuators = ActuatorModel::new(&model, 1).unwrap();
    let mut oracle = Oracle {
        model,
        state: [0.0; 5],
    };
    let synth = Synth::new(50.0);
    for _ in 0..8 {
        actuators.tick(&[[0, 65_535]], RAIL_V);
    }
    let (held_f, per_m) = (model.held_capacitance_f(), model.bimorph.force_n_per_v());
    let (mut squares, mut n) = (0.0, 0.0);
    for sample in 0..8 * SAMPLES_PER_TICK {
        let volts = synth.volts([0, 65_535], synth.phasors(sample % SAMPLES_PER_TICK));
        let before = oracle.state;
        oracle.sample(volts);
        if sample < 7 * SAMPLES_PER_TICK {
            continue;
        }
        // The slope of one pole after a step, at 100 times of the sample.
        for part in 0..100 {
            let t_s = SAMPLE_S * (f64::from(part) + 0.5) / 100.0;
            let slope = (volts - before[U_AMP]) / 20e-6 * (-t_s / 20e-6).exp();
            let along = t_s / SAMPLE_S;
            let speed = before[V_BEAM] + along * (oracle.state[V_BEAM] - before[V_BEAM]);
            squares += (held_f * slope + per_m * speed).powi(2);
            n += 1.0;
        }
    }
    let wanted_ma = 1e3 * (squares / n).sqrt();
    let found = actuators.reading().contactors[0];
    assert!(
        (found.current_rms_ma / wanted_ma - 1.0).abs() < 0.02,
        "{found:?}, {wanted_ma} mA"
    );
    // A smooth sine would take ωCV; steps of a DAC take more.
    let smooth_ma = 1e3 * TAU * 320.0 * 50.0 * model.bimorph.capacitance_f();
    assert!(
        found.current_peak_ma > smooth_ma && found.current_peak_ma < 10.0,
        "{found:?}"
    );
}

#[test]
fn rails_and_high_voltage_off_hold_the_amplifier_back() {
    let mut actuators = ActuatorModel::new(&loaded(Skin::LIGHT), 5).unwrap();
    for _ in 0..10 {
        actuators.tick(&[[65_535, 0]; 5], 25.0);
    }
    let half = actuators.reading().contactors[4];
    assert!(
        (0.6..0.7).contains(&half.saturated_share),
        "a sine above half its peak: {half:?}"
    );
    for _ in 0..40 {
        actuators.tick(&[[65_535, 0]; 5], 0.0);
    }
    let off = actuators.reading().contactors[4];
    assert!(
        off.peak_um < 1e-6,
        "nothing moves without high voltage: {off:?}"
    );
}

#[test]
fn everything_stays_finite_at_the_extremes() {
    let mut random = Random::new(9);
    for quality in [0.1, 40.0, ContactorModel::MAX_QUALITY] {
        for (ks, cs) in [(0.0, 0.0), (1e5, 0.0), (1e5, 100.0), (1e9, 0.0), (0.0, 1e4)] {
            for preload_um in [None, Some(0.0), Some(1.0), Some(1e4)] {
                let model = ContactorModel {
                    quality,
                    ..loaded(Skin {
                        preload_um,
                        ..Skin::bonded(ks, cs)
                    })
                };
                let mut actuators = ActuatorModel::new(&model, 5).unwrap();
                for _ in 0..2 {
                    let code = |random: &mut Random| u16::try_from(random.index(65_536)).unwrap();
                    let codes = [(); 5].map(|()| [code(&mut random), u16::MAX]);
                    let reading = actuators.tick(&codes, 1e3);
                    for one in &reading.contactors {
                        let numbers = [one.peak_um, one.current_rms_ma, one.current_peak_ma];
                        let is_bounded = numbers.iter().all(|n| n.is_finite() && *n < 1e5);
                        assert!(is_bounded, "Q {quality}, {ks} N/m, {cs} N s/m: {one:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_sharp_resonance_against_stiff_skin_meets_the_closed_form_to_a_billionth() {
    let model = ContactorModel {
        quality: ContactorModel::MAX_QUALITY,
        ..loaded(Skin::bonded(1e5, 0.0))
    };
    let step = *Steps::new(&model).unwrap().plain();
    let held = step.response(TAU * 320.0 * SAMPLE_S).unwrap()[X_PIN][0];
    let mut closed = selvedge_foundation::numerics::Complex::default();
    for image in -4000..=4000 {
        let frequency_hz = 320.0 + 8000.0 * f64::from(image);
        let half_turn = std::f64::consts::PI * frequency_hz / 8000.0;
        let hold = selvedge_foundation::numerics::Complex::from_polar(
            half_turn.sin() / half_turn,
            -half_turn,
        );
        closed += 1e-6 * model.response_um_per_v(frequency_hz) * hold;
    }
    let off = (held - closed).norm() / closed.norm();
    assert!(off < 1e-9, "{off:e}");
}

#[test]
fn what_rang_down_is_exactly_at_rest_and_moves_again_when_driven() {
    let mut actuators = ActuatorModel::new(&loaded(Skin::FREE), 3).unwrap();
    let loud = [[0, 0], [20_000, 20_000], [0, 0]];
    for _ in 0..4 {
        actuators.tick(&loud, RAIL_V);
    }
    for _ in 0..80 {
        actuators.tick(&[[0, 0]; 3], RAIL_V);
    }
    assert_eq!(
        actuators.reading().contactors,
        [ContactorReading::default(); 3]
    );
    assert_eq!(actuators.reading().n_ticks, 84, "ticks go on");
    actuators.tick(&loud, RAIL_V);
    let peaks = actuators
        .reading()
        .contactors
        .iter()
        .map(|one| one.peak_um > 1.0);
    assert_eq!(peaks.collect::<Vec<_>>(), [false, true, false]);
}
