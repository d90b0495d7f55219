//! The amplitudes of a known force, and runs that begin anew.

use super::spectrum::Spectrum;
use super::*;
use crate::contact::{
    Contact, ContactLaw, DeviceSpec, FeltSurface, Friction, Hand, Relief, Sampling, Stepper, Tip,
};
use selvedge_textile::surface::{Profile, ProfileSet};
use selvedge_textile::tactile::Band;
use std::f64::consts::TAU;

/// Amplitudes of a steady sine of 1 N, by 10 µm/N at 1 kHz.
fn of_sine(hz: f64) -> [f64; 2] {
    let mut spectrum = Spectrum::new(25, 10.0, &Filters::default());
    let mut n = 0;
    for _ in 0..3 {
        for sample in spectrum.next_tick() {
            n += 1;
            *sample = (TAU * hz * f64::from(n) / 1000.0 + 0.3).sin();
        }
    }
    spectrum.amplitudes_um()
}

#[test]
fn a_sine_of_one_newton_has_the_amplitude_that_the_setting_says() {
    for (band, hz) in [(0, 40.0), (1, 320.0)] {
        let um = of_sine(hz)[band];
        assert!((um / 10.0 - 1.0).abs() < 0.12, "{hz} Hz: {um} µm");
    }
    let [low, high] = of_sine(320.0);
    assert!(low < 0.05 * high, "the bands are apart: {low} {high}");
    // As the filters say, at a frequency where they change slowly over the window's three bins.
    let share = Filters::default().power_gain(Band::High, 200.0).sqrt();
    let um = of_sine(200.0)[1];
    assert!((um / (10.0 * share) - 1.0).abs() < 0.02, "{um} {share}");
}

#[test]
fn a_constant_force_vibrates_not_at_all() {
    let mut spectrum = Spectrum::new(25, 10.0, &Filters::default());
    for _ in 0..2 {
        spectrum.next_tick().fill(4.0);
    }
    let um = spectrum.amplitudes_um();
    assert!(um.iter().all(|um| *um < 1e-12), "{um:?}");
}

#[test]
fn a_run_that_begins_anew_is_as_a_new_one() {
    let tip = Tip::stylus(0.1);
    let contact = Contact::new(
        &Relief::flat(),
        tip,
        ContactLaw::default(),
        Friction::coulomb(0.3),
    );
    for sampling in [
        None,
        Some(Sampling {
            delay_ticks: 2,
            ..Sampling::default()
        }),
    ] {
        let setup = StylusSetup {
            contact: contact.clone().unwrap(),
            device: DeviceSpec {
                damping_n_s_per_m: 5.0,
                ..DeviceSpec::default()
            },
            hand: Hand {
                press_n: 0.5,
                leads: Some([300.0, 2.0]),
            },
            method: Stepper::Auto,
            rate_hz: 1000.0,
            sampling,
        };
        let start = StylusStart::Above(0.2);
        let rows = |run: &mut StylusRun| -> Vec<_> {
            (0..200)
                .map(|n| *run.step([0.01 * f64::from(n), 0.0]).unwrap())
                .collect()
        };
        let mut run = StylusRun::new(setup.clone(), [0.0; 2], start).unwrap();
        let first = rows(&mut run);
        assert!(first.iter().any(|row| row.tangential_n > 0.01), "it rubs");
        assert!(run.begin([0.0; 2], start));
        assert_eq!(rows(&mut run), first);
        assert!(!run.begin([f64::NAN, 0.0], start) && run.begin([0.0; 2], start));
    }
}

#[test]
fn what_is_given_as_force_alone_vibrates_not_at_all() {
    let waves = |i: u32| 20.0 * (TAU * f64::from(i) / 100.0).sin();
    let profile = Profile::new(1.0 / 125.0, (0..5000).map(waves).collect()).unwrap();
    let mut profiles = ProfileSet::default();
    profiles[0] = Some(profile);
    let surface = Arc::new(Surface::from_profiles(profiles, 0.0).unwrap());
    let felt = FeltSurface::rigid(Relief::of_surface(&surface));
    let contact = felt.contact(Tip::stylus(0.1)).unwrap();
    let settings = StylusSettings::default();
    let led_um = |setup: StylusSetup| {
        let on = vec![(Arc::clone(&surface), Some(setup))];
        let mut drive = settings.drive(on, &Filters::default()).unwrap();
        let mut n_steps = 0;
        for nth in 0..8 {
            n_steps += drive.follow(Some((0, [2.5 * f64::from(nth), 0.0])));
        }
        assert_eq!((drive.state(), n_steps), (StylusState::Led, 7 * 25));
        drive.driven().1
    };
    let setup = settings.setup(contact);
    assert!(led_um(setup.clone()).iter().any(|um| *um > 0.1));
    assert_eq!(led_um(setup.by_force_alone()), [0.0; 2]);
}
