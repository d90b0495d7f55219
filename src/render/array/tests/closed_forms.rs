//! Surfaces whose amplitudes are known beforehand.

use super::*;
use selvedge_foundation::numerics::Random;

fn at_speed(surface: &Arc<Surface>, speed_mm_per_s: f64) -> [f64; 2] {
    let mut reference = renderer(&alone(surface), Method::Reference);
    amplitudes(&mut reference, &pose([7.0, 7.0], [speed_mm_per_s, 0.0]))[0]
}

#[test]
fn a_sine_at_its_carriers_speed_has_its_amplitude() {
    for wavelength_mm in [0.2, 0.4, 0.5, 0.65, 0.8] {
        let cloth = cloth::uniform(cloth::sine(3.0, wavelength_mm));
        for (b, carrier_hz) in [40.0, 320.0].into_iter().enumerate() {
            let a = at_speed(&cloth, carrier_hz * wavelength_mm)[b];
            assert!(
                (a / 3.0 - 1.0).abs() < 0.01,
                "{wavelength_mm} mm at {carrier_hz} Hz: {a} µm"
            );
        }
    }
}

#[test]
fn sines_between_the_carriers_and_longer_ones_have_their_golden_values() {
    // From an independent computation with the same window and filters.
    for (wavelength_mm, low, high) in [(0.5, 0.16, 0.85), (2.5, 0.92, 0.07)] {
        let [a40, a320] = at_speed(&cloth::uniform(cloth::sine(2.0, wavelength_mm)), 100.0);
        assert!(
            (a40 / 2.0 - low).abs() < 0.01,
            "{wavelength_mm} mm: A40 = {a40}"
        );
        assert!(
            (a320 / 2.0 - high).abs() < 0.01,
            "{wavelength_mm} mm: A320 = {a320}"
        );
    }
}

#[test]
fn a_brownian_surface_keeps_the_ratio_of_its_exponent() {
    let offsets = (0..16)
        .map(|i| Displacement::new(f64::from(i), 0.0))
        .collect();
    let array = ContactorArray {
        offsets,
        rotation_deg: 0.0,
    };
    for hurst in [0.2, 0.5] {
        let mut random = Random::new(4);
        let mut sums = [[0.0; 2]; 2];
        for _ in 0..16 {
            let cloth = cloth::along_warp(cloth::brownian(&mut random, 4600, hurst));
            let scene = scene_of(vec![placed(&cloth, [0.0, 0.0], 0.0)], array.clone());
            let mut reference = renderer(&scene, Method::Banded);
            for (sums, speed) in sums.iter_mut().zip([20.0, 50.0]) {
                for [low, high] in amplitudes(&mut reference, &pose([0.0, 5.0], [speed, 0.0])) {
                    sums[0] += low;
                    sums[1] += high;
                }
            }
        }
        for [low, high] in sums {
            let ratio = high / low;
            let expected = 8.0_f64.powf(-hurst);
            assert!(
                (ratio / expected - 1.0).abs() < 0.1,
                "H = {hurst}: {ratio} for {expected}"
            );
        }
    }
}

#[test]
fn warp_and_weft_add_as_powers() {
    let cloth = cloth::uniform(cloth::sine(1.0, 0.5));
    let mut reference = renderer(&alone(&cloth), Method::Reference);
    let one = amplitudes(&mut reference, &pose([3.0, 8.0], [90.0, 0.0]))[0];
    let other = amplitudes(&mut reference, &pose([3.0, 8.0], [0.0, -50.0]))[0];
    let both = amplitudes(&mut reference, &pose([3.0, 8.0], [90.0, -50.0]))[0];
    for b in 0..2 {
        assert!((both[b] - one[b].hypot(other[b])).abs() < 1e-12, "{both:?}");
    }
}

#[test]
fn only_bins_strictly_below_a_kilohertz_sound() {
    // Bin 20 reaches 1 kHz at 1000/4.6 mm/s; its neighbour 19 is 50 Hz below.
    let cloth = cloth::along_warp(cloth::line(20));
    let speed = 1000.0 / (0.23 * 20.0);
    let [_, below] = at_speed(&cloth, speed * (1.0 - 1e-9));
    let [_, above] = at_speed(&cloth, speed * (1.0 + 1e-9));
    assert!(below > 1.5 * above && above > 0.0, "{below} µm, {above} µm");
}
