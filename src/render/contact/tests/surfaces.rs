//! The stylus on ripples, on cloth, with friction, with many contacts.

use super::*;
use selvedge_foundation::geometry::Displacement;
use selvedge_foundation::numerics::{Grid, Random};
use selvedge_textile::surface::HeightMap;
use std::f64::consts::TAU;

/// A ripple of 0.05 mm along u, which repeats after 2 mm.
fn ripple() -> Relief {
    let height_um = |column: usize, _| 50.0 * (TAU * column as f64 / 80.0).sin();
    let map = HeightMap::new(Grid::from_fn(80, 4, height_um), [0.025, 0.025]).unwrap();
    Relief::of_map(&map.periodic())
}

#[test]
fn a_stylus_pressed_on_a_slope_is_pushed_along_its_normal() {
    let law = ContactLaw {
        damping_n_s_per_m: 0.0,
        ..LAW
    };
    let contact = Contact::new(&ripple(), Tip::stylus(0.0), law, Friction::none()).unwrap();
    let mut device = SimulatedDevice::new(
        DeviceSpec::default(),
        Hand::default(),
        (Stepper::Exact, 1e-3),
        [0.25, 0.0, 0.0],
    )
    .unwrap();
    let mut haptic = HapticLoop::new(contact, (1000.0, Sampling::default()), 0.075, 0.0).unwrap();
    let tick = haptic.tick(&mut device).unwrap();
    let (height_mm, slope) = (0.05 * 0.5_f64.sqrt(), TAU / 2.0 * 0.05 * 0.5_f64.sqrt());
    let [x_n, y_n, z_n] = tick.force_n;
    assert!((z_n - 2.0 * height_mm).abs() < 1e-4, "{tick:?}");
    assert!(
        (x_n + z_n * slope).abs() < 1e-3 * z_n && y_n.abs() < 1e-12,
        "{tick:?}"
    );
    assert!((tick.normal_n - z_n.hypot(x_n)).abs() < 1e-12);
    let lifted_mm = device.read_mm().unwrap()[2];
    assert!(
        lifted_mm > 0.0,
        "the held force moved the device: {lifted_mm}"
    );
}

#[test]
fn going_over_a_ripple_there_and_back_gives_no_energy() {
    for method in [Stepper::Trapezoid, Stepper::Exact, Stepper::ImplicitEuler] {
        let law = ContactLaw {
            damping_n_s_per_m: 0.0,
            ..LAW
        };
        let mut setup = setup(law, method, 10_000.0);
        setup.contact = Contact::new(&ripple(), Tip::stylus(0.1), law, Friction::none()).unwrap();
        let mut run = StylusRun::new(setup, [0.0; 2], StylusStart::Resting).unwrap();
        let (mut high_mm, mut low_mm) = (f64::NEG_INFINITY, f64::INFINITY);
        for nth in 0..40_000 {
            let u_mm = 20.0 * (TAU * f64::from(nth) / 40_000.0).sin();
            let z_mm = run.step([u_mm, 0.0]).unwrap().place_mm[2];
            (high_mm, low_mm) = (high_mm.max(z_mm), low_mm.min(z_mm));
        }
        assert!(run.gained_j() < 1e-6, "{method:?}: {}", run.gained_j());
        assert!(
            high_mm > -0.5 && low_mm < -0.5,
            "{method:?}: {low_mm} to {high_mm}"
        );
    }
}

/// A relief of every wavelength from 0.05 to 10 mm, their amplitudes alike their lengths.
fn rough() -> Relief {
    let mut random = Random::new(3);
    let waves: Vec<[f64; 2]> = (0..200)
        .map(|_| [random.normal(), random.normal()])
        .collect();
    let height_um = |column: usize, _| {
        let numbered = (1_u16..).map(f64::from).zip(&waves);
        let waves = numbered.map(|(k, [a, b])| {
            let (sin, cos) = (TAU * k * column as f64 / 2000.0).sin_cos();
            (a * cos + b * sin) / k
        });
        15.0 * waves.sum::<f64>()
    };
    let map = HeightMap::new(Grid::from_fn(2000, 1, height_um), [0.005, 0.005]).unwrap();
    Relief::of_map(&map.periodic())
}

#[test]
fn what_is_marked_stable_gains_nothing_on_a_rough_relief_either() {
    let relief = rough();
    let mut n_stable = 0;
    for method in Stepper::ALL {
        for k in [10.0, 1e3, 1e5, 1e7] {
            let law = ContactLaw {
                stiffness_n_per_m: k,
                damping_n_s_per_m: 0.2 * (k * 0.075_f64).sqrt(),
                ..LAW
            };
            for rate_hz in [250.0, 1000.0, 4000.0, 40_000.0] {
                let mut setup = setup(law, method, rate_hz);
                setup.contact =
                    Contact::new(&relief, Tip::stylus(0.0), law, Friction::none()).unwrap();
                if setup.case().standing() != Standing::Stable {
                    continue;
                }
                n_stable += 1;
                let mut run = StylusRun::new(setup, [0.0; 2], StylusStart::Resting).unwrap();
                for nth in 1..=2000 {
                    run.step([50.0 * f64::from(nth) / rate_hz, 0.0]).unwrap();
                    let gained = run.gained_j() / run.put_in_j();
                    assert!(gained < 1e-10, "{method:?} {k} {rate_hz} {nth}: {gained}");
                }
            }
        }
    }
    assert!(n_stable >= 48, "{n_stable}");
}

#[test]
fn exact_and_implicit_steps_agree_on_a_ripple_as_steps_get_finer() {
    let end = |method: Stepper, rate_hz: f64| {
        let mut setup = setup(LAW, method, rate_hz);
        setup.contact = Contact::new(&ripple(), Tip::stylus(0.0), LAW, Friction::none()).unwrap();
        setup.device.damping_n_s_per_m = 1.0;
        let mut run = StylusRun::new(setup, [0.0; 2], StylusStart::Resting).unwrap();
        let n = selvedge_foundation::numerics::to_whole::<u32>(0.3 * rate_hz);
        for nth in 1..=n {
            run.step([20.0 * f64::from(nth) / rate_hz, 0.0]).unwrap();
        }
        run.row().place_mm[2]
    };
    let truth = end(Stepper::RungeKutta4, 40_000.0);
    for method in Stepper::ALL {
        let [coarse, fine] = [4e3, 16e3].map(|hz| (end(method, hz) - truth).abs());
        assert!(
            fine < 5e-4 && fine <= 0.5 * coarse + 1e-9,
            "{method:?}: {coarse} {fine}"
        );
    }
}

#[test]
fn a_slow_hand_makes_dry_friction_stick_and_slip() {
    let friction = Friction {
        at_rest: 0.6,
        sliding: 0.3,
        ..Friction::none()
    };
    let mut setup = setup(LAW, Stepper::Exact, 1000.0);
    setup.contact = Contact::new(&Relief::flat(), Tip::stylus(0.0), LAW, friction).unwrap();
    setup.hand.leads = Some([200.0, 0.1]);
    let mut run = StylusRun::new(setup, [0.0; 2], StylusStart::Resting).unwrap();
    let (mut n_slips, mut was_fast, mut most_n) = (0, false, 0.0_f64);
    let mut before_mm = 0.0;
    for nth in 0..10_000 {
        let row = *run.step([2e-3 * f64::from(nth), 0.0]).unwrap();
        let speed = 1e3 * (row.place_mm[0] - before_mm);
        before_mm = row.place_mm[0];
        let is_fast = if was_fast { speed > 1.0 } else { speed > 5.0 };
        n_slips += u32::from(is_fast && !was_fast);
        was_fast = is_fast;
        most_n = most_n.max(row.tangential_n);
    }
    assert!(run.gained_j() < 0.0, "friction takes: {}", run.gained_j());
    assert!((4..200).contains(&n_slips), "{n_slips}");
    assert!(
        (0.55..=0.6 + 1e-9).contains(&most_n),
        "held by 0.6 of 1 N: {most_n}"
    );
}

#[test]
fn a_hand_that_leads_a_mass_over_a_ripple_gives_and_takes_all_of_its_energy() {
    for (method, friction) in [(Stepper::Exact, 0.0), (Stepper::Trapezoid, 0.3)] {
        let law = ContactLaw {
            stiffness_n_per_m: 500.0,
            ..LAW
        };
        let friction = Friction::coulomb(friction);
        let mut setup = setup(law, method, 10_000.0);
        setup.contact = Contact::new(&ripple(), Tip::stylus(0.1), law, friction).unwrap();
        setup.hand.leads = Some([300.0, 1.0]);
        let mut run = StylusRun::new(setup, [0.0; 2], StylusStart::Resting).unwrap();
        for nth in 0..20_000 {
            let u_mm = 10.0 * (TAU * f64::from(nth) / 20_000.0).sin();
            run.step([u_mm, 0.0]).unwrap();
            assert!(
                run.gained_j() < 2e-5,
                "{method:?} {nth}: {}",
                run.gained_j()
            );
        }
        assert!(run.gained_j() < -1e-4, "{method:?}: {}", run.gained_j());
    }
}

#[test]
fn a_devices_own_friction_holds_it_along_the_surface_and_takes_energy() {
    let mut setup = setup(LAW, Stepper::Exact, 1000.0);
    setup.device.friction_n = 0.4;
    setup.hand = Hand {
        press_n: 0.0,
        leads: Some([200.0, 5.0]),
    };
    let mut run = StylusRun::new(setup, [0.0; 2], StylusStart::Above(5.0)).unwrap();
    let place = |run: &mut StylusRun, [x_mm, y_mm]: [f64; 2]| {
        let [x_mm, y_mm, _] = run.step([x_mm, y_mm]).unwrap().place_mm;
        x_mm.hypot(y_mm)
    };
    for nth in 0..1000 {
        let along_mm = 1.9e-3 * f64::from(nth);
        let gone_mm = place(&mut run, [0.6 * along_mm, 0.8 * along_mm]);
        assert_eq!(
            gone_mm, 0.0,
            "0.4 N hold what 200 N/m pull over {along_mm} mm"
        );
    }
    let mut gone_mm = 0.0;
    for nth in 1000..6000 {
        let along_mm = 1.9e-3 * f64::from(nth);
        gone_mm = place(&mut run, [0.6 * along_mm, 0.8 * along_mm]);
    }
    // The hand's damper takes its part of 1.9 mm/s.
    let lag_mm = (0.4 + 5.0 * 1.9e-3) / 0.2;
    assert!(
        (1.9e-3 * 5999.0 - gone_mm - lag_mm).abs() < 0.01,
        "{gone_mm}"
    );
    assert!(run.gained_j() < -1e-4, "{}", run.gained_j());
}

#[test]
fn surfaces_that_are_known_over_an_area_are_felt_over_it() {
    use selvedge_textile::Library;
    let brownian = std::path::Path::new("../../textiles/brownian");
    let felt = |library: Library, id: &str| {
        let textile = library.load(id).unwrap();
        (
            FeltSurface::of_textile(&textile, &Tip::stylus(0.0))
                .unwrap()
                .relief,
            textile,
        )
    };
    let (relief, textile) = felt(Library::open(brownian).unwrap(), "brownian-h5");
    assert_eq!(relief.reading(), "heights over an area");
    let h = |u: f64, w: f64| 1e3 * relief.height_mm([u, w]);
    let twist_um = h(3.0, 3.0) - h(3.0, 12.0) - h(12.0, 3.0) + h(12.0, 12.0);
    assert!(twist_um.abs() > 0.1, "no sum of profiles: {twist_um}");
    let profile = textile
        .surface()
        .profile(selvedge_textile::surface::Direction::WarpForward);
    let heights = profile.unwrap().heights_um();
    for i in [100_usize, 400, 900] {
        let rise_um = h(0.02 * i as f64, 10.0) - h(0.0, 10.0);
        assert!(
            (rise_um - heights[i] + heights[0]).abs() < 1e-3,
            "{i}: {rise_um}"
        );
    }
    let flat = Relief::flat();
    assert_eq!(flat.reading(), "a plane");
}

#[test]
fn friction_is_bounded_by_the_load_at_any_step() {
    for rate_hz in [1.0, 1e3, 1e6] {
        let contact = Contact::new(
            &Relief::flat(),
            Tip::stylus(0.0),
            LAW,
            Friction::coulomb(0.4),
        )
        .unwrap();
        let setup = StylusSetup {
            contact,
            ..setup(LAW, Stepper::Exact, rate_hz)
        };
        let mut run = StylusRun::new(setup, [0.0; 2], StylusStart::Resting).unwrap();
        for nth in 1..2000 {
            let row = run.step([50.0 * f64::from(nth) / rate_hz, 0.0]).unwrap();
            assert!(
                row.tangential_n <= 0.44 * row.force_n + 1e-9,
                "{rate_hz}: {row:?}"
            );
        }
        let row = run.row();
        let expected = if rate_hz > 1e5 { 0.0..0.45 } else { 0.39..0.41 };
        assert!(expected.contains(&row.tangential_n), "{rate_hz}: {row:?}");
    }
}

#[test]
fn a_cloths_compression_takes_the_work_of_its_figures() {
    let cloth = Compression {
        yield_mm: 0.5,
        linearity: 0.4,
        resilience: 0.6,
        area_mm2: 100.0,
    };
    let law = ContactLaw {
        cloth: Some(cloth),
        damping_n_s_per_m: 0.0,
        ..LAW
    };
    let contact = flat(law);
    let mut device = SimulatedDevice::new(
        DeviceSpec {
            axes: [true; 3],
            ..DeviceSpec::default()
        },
        Hand::default(),
        (Stepper::Exact, 1e-3),
        [0.0; 3],
    )
    .unwrap();
    let mut haptic = HapticLoop::new(contact, (1000.0, Sampling::default()), 0.075, 0.0).unwrap();
    let mut work_j = [0.0; 2];
    let mut before_n = 0.0;
    for nth in 0..=10_000 {
        let down_mm = 0.5 * (1.0 - (f64::from(nth) / 5000.0 - 1.0).abs());
        device.upright.z_m = -1e-3 * down_mm;
        let force_n = haptic.sense(&mut device).unwrap().normal_n;
        work_j[usize::from(nth > 5000)] += 0.5 * (force_n + before_n) * 0.5e-3 / 5000.0;
        before_n = force_n;
        if nth == 5000 {
            let most_n = 50.0 * 98.0665e-6 * 100.0;
            assert!((force_n - most_n).abs() < 1e-9, "50 gf/cm²: {force_n}");
            assert!((work_j[0] - 0.4 * 0.5 * most_n * 0.5e-3).abs() < 1e-6 * work_j[0]);
        }
    }
    assert!((work_j[1] / work_j[0] - 0.6).abs() < 1e-4, "{work_j:?}");
}

#[test]
fn auto_chooses_by_stiffness_and_step_and_says_why() {
    let cloth = Compression {
        yield_mm: 0.5,
        linearity: 0.4,
        resilience: 0.6,
        area_mm2: 100.0,
    };
    for (k, cloth, method, why) in [
        (1e9, None, Stepper::Exact, "piecewise linear"),
        (1e3, Some(cloth), Stepper::Trapezoid, "h √(K/m) = 0.1155"),
        (1e9, Some(cloth), Stepper::ImplicitEuler, "too stiff"),
    ] {
        let law = ContactLaw {
            stiffness_n_per_m: k,
            cloth,
            ..LAW
        };
        let setup = setup(law, Stepper::Auto, 1000.0);
        let (chosen, said) = setup.chosen();
        assert!(chosen == method && said.contains(why), "{k}: {said}");
        let mut run = StylusRun::new(setup, [0.0; 2], StylusStart::Resting).unwrap();
        for _ in 0..1000 {
            run.step([0.0; 2]).unwrap();
        }
        assert!(
            (run.row().force_n - 1.0).abs() < 1e-3,
            "{k}: {:?}",
            run.row()
        );
    }
}

#[test]
fn tips_of_many_contacts_share_the_load() {
    let offset = |i: u8| Displacement::new(2.0 * f64::from(i % 4), 2.0 * f64::from(i / 4));
    let array: Vec<_> = (0..24).map(offset).collect();
    for (tip, n) in [(Tip::array(&array, 0.5), 24), (Tip::fingertip(), 19)] {
        assert_eq!(tip.contacts_mm.len(), n);
        for method in Stepper::ALL {
            let mut setup = setup(LAW, method, 2000.0);
            setup.device.damping_n_s_per_m = 3.0;
            setup.contact = Contact::new(&ripple(), tip.clone(), LAW, Friction::none()).unwrap();
            let mut run = StylusRun::new(setup, [0.0; 2], StylusStart::Resting).unwrap();
            for _ in 0..2000 {
                run.step([0.0; 2]).unwrap();
            }
            let up_n = run.row().force_n;
            assert!((up_n - 1.0).abs() < 0.02, "{n} {method:?}: {up_n}");
        }
    }
}

#[test]
fn what_a_device_cannot_show_it_does_not_show() {
    let shown = |parts: ForceParts| {
        let law = ContactLaw { parts, ..LAW };
        let contact = Contact::new(&ripple(), Tip::stylus(0.0), law, Friction::coulomb(0.3));
        let setup = StylusSetup {
            contact: contact.unwrap(),
            ..setup(law, Stepper::Exact, 1000.0)
        };
        let mut run = StylusRun::new(setup, [0.3, 0.0], StylusStart::Resting).unwrap();
        for nth in 0..200 {
            run.step([0.3 + 0.02 * f64::from(nth), 0.0]).unwrap();
        }
        *run.row()
    };
    assert_eq!(shown(ForceParts::Normal).tangential_n, 0.0);
    let lateral = shown(ForceParts::Lateral);
    assert!(lateral.tangential_n > 0.2, "{lateral:?}");
    assert!(
        (lateral.force_n - 1.0).abs() < 0.02,
        "rests under 1 N: {lateral:?}"
    );
}
