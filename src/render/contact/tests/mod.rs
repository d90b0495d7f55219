//! The stylus against closed forms, against itself in finer steps, and against what is extreme.

mod surfaces;

use super::*;

const LAW: ContactLaw = ContactLaw {
    stiffness_n_per_m: 2000.0,
    damping_n_s_per_m: 0.5,
    ceiling_n: f64::INFINITY,
    parts: ForceParts::Both,
    cloth: None,
};

fn flat(law: ContactLaw) -> Contact {
    Contact::new(&Relief::flat(), Tip::stylus(0.0), law, Friction::none()).unwrap()
}

fn setup(law: ContactLaw, method: Stepper, rate_hz: f64) -> StylusSetup {
    StylusSetup::of(flat(law), method, rate_hz)
}

fn dropped(setup: StylusSetup, drop_mm: f64) -> StylusRun {
    StylusRun::new(setup, [0.0; 2], StylusStart::Above(drop_mm)).unwrap()
}

/// Height and force after a time of a fall of 5 mm onto a wall with a constant push, as long as
/// the first contact lasts: solved on paper.
fn closed_form(law: &ContactLaw, t_s: f64) -> [f64; 2] {
    let (m, push) = (0.075, 1.0_f64);
    let (k, b) = (law.stiffness_n_per_m, law.damping_n_s_per_m);
    let a = push / m;
    let fall_s = (2.0 * 0.005 / a).sqrt();
    if t_s < fall_s {
        return [0.005 - 0.5 * a * t_s * t_s, 0.0];
    }
    let (t, v) = (t_s - fall_s, -a * fall_s);
    let (alpha, rest) = (b / (2.0 * m), -push / k);
    let omega = (k / m - alpha * alpha).sqrt();
    let (sin, cos) = (omega * t).sin_cos();
    let (p, q) = (-rest, (v - alpha * rest) / omega);
    let decay = (-alpha * t).exp();
    let z = rest + decay * (p * cos + q * sin);
    let speed = decay * ((q * omega - alpha * p) * cos - (p * omega + alpha * q) * sin);
    [z, (-k * z - b * speed).max(0.0)]
}

#[test]
fn a_tip_that_falls_on_a_wall_is_the_closed_form() {
    let mut run = dropped(setup(LAW, Stepper::Exact, 1000.0), 5.0);
    for nth in 1..=38 {
        let row = *run.step([0.0; 2]).unwrap();
        let [z_m, force_n] = closed_form(&LAW, f64::from(nth) * 1e-3);
        assert!(
            (1e-3 * row.place_mm[2] - z_m).abs() < 1e-13,
            "{nth}: {row:?}"
        );
        assert!(
            (row.force_n - force_n).abs() < 1e-9,
            "{nth}: {force_n} {row:?}"
        );
    }
    assert!(
        run.row().place_mm[2] < 0.0,
        "the first contact lasts that long"
    );
}

#[test]
fn exact_steps_are_those_of_a_thousand_finer_ones() {
    for (k, b) in [(1e3, 0.0), (1e4, 3.0), (1e6, 0.0), (1e5, 200.0)] {
        let law = ContactLaw {
            stiffness_n_per_m: k,
            damping_n_s_per_m: b,
            ..LAW
        };
        let mut coarse = dropped(setup(law, Stepper::Exact, 1000.0), 2.0);
        let mut fine = dropped(setup(law, Stepper::Exact, 1e6), 2.0);
        for nth in 0..60 {
            let row = *coarse.step([0.0; 2]).unwrap();
            for _ in 0..1000 {
                fine.step([0.0; 2]).unwrap();
            }
            let away_mm = (row.place_mm[2] - fine.row().place_mm[2]).abs();
            assert!(away_mm < 1e-9 * 2.0, "{k} {b} {nth}: {away_mm}");
        }
    }
}

#[test]
fn every_method_comes_nearer_with_its_order() {
    let soft = ContactLaw {
        stiffness_n_per_m: 200.0,
        ..LAW
    };
    // Within contact from the start, where forces are smooth.
    let end = |method: Stepper, rate_hz: f64| {
        let mut run = dropped(setup(soft, method, rate_hz), -2.0);
        for _ in 0..selvedge_foundation::numerics::to_whole::<u32>(0.02 * rate_hz) {
            run.step([0.0; 2]).unwrap();
        }
        run.row().place_mm[2]
    };
    let truth = end(Stepper::Exact, 1000.0);
    for (method, order) in [
        (Stepper::ExplicitEuler, 1),
        (Stepper::SemiImplicitEuler, 1),
        (Stepper::ImplicitEuler, 1),
        (Stepper::Trapezoid, 2),
        (Stepper::RungeKutta4, 4),
    ] {
        let [coarse, fine] = [1000.0, 2000.0].map(|hz| (end(method, hz) - truth).abs());
        let found = (coarse / fine).log2();
        assert!(
            (found - f64::from(order)).abs() < 0.25,
            "{method:?}: {found}"
        );
    }
}

#[test]
fn the_limits_of_sampled_walls_are_the_known_ones() {
    // Mass, device's damping, wall's damping, largest stiffness without and with one tick of delay.
    let table = [
        (0.075, 0.02, 0.0, 40.0, 13.0),
        (0.075, 0.02, 2.0, 3934.0, 1307.0),
        (0.075, 0.02, 5.0, 9393.0, 3098.0),
        (0.075, 0.02, 20.0, 30621.0, 9305.0),
        (0.10, 0.10, 1.0, 2178.0, 725.0),
        (0.075, 1.0, 2.0, 5856.0, 1948.0),
    ];
    for (mass_kg, b, wall, at_once, late) in table {
        for (ticks, known) in [(0, at_once), (1, late)] {
            let found = sampled(mass_kg, b, wall, ticks).stiffness_limits(0.0, 0.0);
            assert!(
                (found.exact - known).abs() < 0.6,
                "{found:?}, known {known}"
            );
            let period_s = 1e-3 * (0.5 + f64::from(u8::try_from(ticks).unwrap()));
            assert!((found.rule - (b + wall) / period_s).abs() < 1e-9);
        }
    }
    let bare = sampled(0.075, 0.02, 0.0, 0).stiffness_limits(0.04, 0.03);
    // Without damping of the wall, in closed form: 2b/T as bT/m goes to 0.
    let (x, e) = (0.02 * 1e-3 / 0.075, f64::exp(-0.02 * 1e-3 / 0.075));
    let known = 0.02 * 0.02 / 0.075 * (1.0 - e) / (1.0 - e - x * e);
    assert!((known - 40.001_777_86).abs() < 1e-6, "{known}");
    assert!((bare.exact / known - 1.0).abs() < 1e-6, "{bare:?}");
    assert!((bare.passive - 40.0).abs() < 1e-9 && (bare.quiet - 40.0).abs() < 1e-9);
    let damped = sampled(0.05, 0.02, 40.0, 1).stiffness_limits(0.0, 0.0);
    assert!(
        (damped.exact - 1012.0).abs() < 60.0,
        "too much damping: {damped:?}"
    );
}

#[test]
fn limits_of_fast_and_late_loops_are_near_the_rule() {
    for (period_s, ticks) in [(1e-6, 0), (1e-6, 2), (2.5e-5, 0), (1e-4, 10), (1e-4, 32)] {
        let case = WallCase {
            period_s,
            ..sampled(0.075, 0.1, 0.05, ticks)
        };
        let limits = case.stiffness_limits(0.0, 0.0);
        let off = limits.exact / limits.rule - 1.0;
        assert!(off.abs() < 0.03, "{period_s} {ticks}: {limits:?}");
        assert_eq!(
            case.with_stiffness(0.9 * limits.passive).standing(),
            Standing::Stable
        );
        assert_eq!(
            case.with_stiffness(0.99 * limits.exact).standing(),
            Standing::Active
        );
        assert_eq!(
            case.with_stiffness(1.01 * limits.exact).standing(),
            Standing::Unstable
        );
    }
}

fn sampled(mass_kg: f64, b: f64, wall: f64, ticks: usize) -> WallCase {
    WallCase {
        mass_kg,
        damping_n_s_per_m: b,
        stiffness_n_per_m: 0.0,
        wall_damping_n_s_per_m: wall,
        period_s: 1e-3,
        delay_ticks: Some(ticks),
        method: Stepper::Exact,
    }
}

/// The largest energy above the start's in a run that is not driven, as a part of that.
fn largest_gain(mut run: StylusRun, n_steps: usize) -> f64 {
    let start_j = run.row().energy_j;
    let mut largest = f64::NEG_INFINITY;
    for _ in 0..n_steps {
        let row = run.step([0.0; 2]).unwrap();
        largest = largest.max(row.energy_j - start_j);
    }
    largest / start_j
}

#[test]
fn what_is_marked_stable_never_gains_energy() {
    let mut n_stable = 0;
    for method in Stepper::ALL {
        for (k, b, wall) in [
            (50.0, 0.0, 0.0),
            (200.0, 0.2, 0.3),
            (5e3, 0.0, 2.0),
            (5e3, 6.0, 0.0),
            (1e5, 0.02, 0.0),
            (1e9, 0.0, 0.0),
        ] {
            let law = ContactLaw {
                stiffness_n_per_m: k,
                damping_n_s_per_m: wall,
                ..LAW
            };
            let mut setup = setup(law, method, 1000.0);
            setup.device.damping_n_s_per_m = b;
            if setup.case().standing() == Standing::Stable {
                n_stable += 1;
                let gain = largest_gain(dropped(setup, 10.0), 20_000);
                assert!(gain < 1e-7, "{method:?} {k} {b} {wall}: {gain}");
            }
        }
    }
    assert!(n_stable > 20, "{n_stable}");
}

#[test]
fn a_million_steps_of_a_stable_method_gain_nothing() {
    for (method, k) in [
        (Stepper::Trapezoid, 1e4),
        (Stepper::ImplicitEuler, 1e6),
        (Stepper::Exact, 1e4),
    ] {
        let law = ContactLaw {
            stiffness_n_per_m: k,
            damping_n_s_per_m: 0.0,
            ..LAW
        };
        let gain = largest_gain(dropped(setup(law, method, 1000.0), 10.0), 1_000_000);
        assert!(gain < 1e-6, "{method:?}: {gain}");
    }
}

#[test]
fn explicit_methods_gain_where_they_are_said_to() {
    let law = ContactLaw {
        damping_n_s_per_m: 0.0,
        ..LAW
    };
    for (method, standing) in [
        (Stepper::ExplicitEuler, Standing::Unstable),
        (Stepper::SemiImplicitEuler, Standing::Active),
        (Stepper::RungeKutta4, Standing::Active),
    ] {
        let setup = setup(law, method, 1000.0);
        assert_eq!(setup.case().standing(), standing, "{method:?}");
        let mut run = dropped(setup, 10.0);
        let gains = (0..5000).map(|_| {
            let gained = run.step([0.0; 2]).map(|row| row.energy_j);
            gained.unwrap_or(f64::INFINITY)
        });
        let largest = gains.fold(0.0, f64::max);
        assert!(largest > 0.01 * 1.0003, "{method:?}: {largest}");
    }
}

/// A sampled wall that damps with 2 N·s/m, whose limit is 3934 N/m.
fn sampled_wall(k: f64, is_kept_passive: bool) -> StylusRun {
    let law = ContactLaw {
        stiffness_n_per_m: k,
        damping_n_s_per_m: 2.0,
        ..LAW
    };
    let mut setup = setup(law, Stepper::Exact, 1000.0);
    setup.device.damping_n_s_per_m = 0.02;
    setup.sampling = Some(Sampling {
        delay_ticks: 0,
        is_kept_passive,
    });
    dropped(setup, -0.5)
}

#[test]
fn a_sampled_wall_calms_down_below_its_limit_and_is_refused_above() {
    let mut run = sampled_wall(3000.0, false);
    (0..4000).for_each(|_| assert!(run.step([0.0; 2]).is_ok(), "below"));
    assert!(
        (run.row().place_mm[2] + 1.0 / 3.0).abs() < 1e-6,
        "{:?}",
        run.row()
    );

    let mut run = sampled_wall(4500.0, false);
    let error = (0..4000).find_map(|_| run.step([0.0; 2]).err()).unwrap();
    assert!(
        error.to_string().contains("grows above 3934 N/m"),
        "{error}"
    );
    assert!(run.observed_j().unwrap() < -1e-3, "the wall made energy");
}

#[test]
fn a_passive_sampled_wall_never_throws_a_tip_higher_than_it_fell() {
    let law = ContactLaw {
        stiffness_n_per_m: 35.0,
        damping_n_s_per_m: 0.002,
        ..LAW
    };
    let mut setup = setup(law, Stepper::Exact, 1000.0);
    setup.device.damping_n_s_per_m = 0.02;
    setup.sampling = Some(Sampling::default());
    assert_eq!(setup.case().standing(), Standing::Stable);
    let mut run = dropped(setup, 40.0);
    let mut high_mm = 0.0_f64;
    for nth in 0..200_000 {
        let z_mm = run.step([0.0; 2]).unwrap().place_mm[2];
        high_mm = if nth < 100 { 0.0 } else { high_mm.max(z_mm) };
    }
    assert!(high_mm > 10.0 && high_mm < 40.0, "{high_mm}");
}

#[test]
fn the_passivity_controller_holds_what_would_grow() {
    let mut run = sampled_wall(4500.0, true);
    for _ in 0..4000 {
        run.step([0.0; 2]).unwrap();
        let observed_j = run.observed_j().unwrap();
        assert!(observed_j > -1e-3, "{observed_j}");
    }
}

#[test]
fn extreme_settings_are_finite_or_refused_with_a_limit() {
    for method in Stepper::ALL {
        for k in [0.0, 1e-3, 1.0, 1e3, 1e6, 1e9] {
            for rate_hz in [1.0, 30.0, 1e3, 1e6] {
                for ticks in [None, Some(0), Some(3)] {
                    let law = ContactLaw {
                        stiffness_n_per_m: k,
                        ..LAW
                    };
                    let mut setup = setup(law, method, rate_hz);
                    setup.sampling = ticks.map(|delay_ticks| Sampling {
                        delay_ticks,
                        is_kept_passive: false,
                    });
                    let mut run = dropped(setup, 1.0);
                    for _ in 0..50 {
                        match run.step([0.0; 2]) {
                            Ok(row) => assert!(row.energy_j.is_finite(), "{row:?}"),
                            Err(error) => {
                                let text = error.to_string();
                                assert!(text.contains("N/m"), "{text}");
                                break;
                            }
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn what_is_no_setting_is_refused() {
    for k in [-1.0, f64::NAN, f64::INFINITY, 2e9] {
        let law = ContactLaw {
            stiffness_n_per_m: k,
            ..LAW
        };
        assert!(law.check().is_err(), "{k}");
    }
    for rate_hz in [0.0, 0.5, f64::NAN, 2e6] {
        let start = StylusStart::Above(1.0);
        let run = StylusRun::new(setup(LAW, Stepper::Exact, rate_hz), [0.0; 2], start);
        assert!(run.is_err(), "{rate_hz}");
    }
    let mut run = dropped(setup(LAW, Stepper::Exact, 1000.0), 1.0);
    assert!(run.step([f64::NAN, 0.0]).is_err(), "a place that is none");
    assert!(Relief::flat().under_sphere(f64::NAN).is_err());
}
