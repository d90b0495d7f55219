//! `selvedge probe`, run as a user runs it: the closed form, and what cannot be held.

use crate::program::{Lab, Rows};

/// A tip that falls 2 mm onto a wall under 1 N.
const DROP: &str = "probe --surface flat --drop 2 --hand-force 1 --mass 0.05";

#[test]
fn a_probe_that_falls_on_a_wall_is_its_closed_form() {
    let lab = Lab::new();
    let line = [
        DROP,
        "--seconds 0.02 --stiffness 3000 --damping 2 --rate 2000",
    ]
    .join(" ");
    let outcome = lab.run(&line.split_whitespace().collect::<Vec<_>>());
    assert!(
        outcome.err.contains("method exact: h √(K/m) = 0.1225"),
        "{outcome:?}"
    );
    let rows = Rows::parse(&outcome.out);
    assert_eq!(
        rows.header(),
        "t_s,x_mm,y_mm,z_mm,depth_um,force_n,tangential_n,vibration_n,energy_j"
    );
    assert_eq!(rows.len(), 41, "one at every 1/rate from t = 0");
    let [t_s, z_mm, force_n] = ["t_s", "z_mm", "force_n"].map(|name| rows.numbers(name));
    let (m, k, b, g) = (0.05_f64, 3000.0, 2.0, 1.0 / 0.05);
    let fall_s = (2.0_f64 * 0.002 / g).sqrt();
    for ((t_s, z_mm), force_n) in t_s.into_iter().zip(z_mm).zip(force_n) {
        let t = t_s - fall_s;
        if t < 0.0 {
            assert!(
                (z_mm - (2.0 - 500.0 * g * t_s * t_s)).abs() < 1e-9,
                "{t_s}: {z_mm}"
            );
            assert_eq!(force_n, 0.0);
            continue;
        }
        let (alpha, rest, v) = (b / (2.0 * m), -1.0 / k, -g * fall_s);
        let omega = (k / m - alpha * alpha).sqrt();
        let (sin, cos) = (omega * t).sin_cos();
        let (p, q) = (-rest, (v - alpha * rest) / omega);
        let decay = (-alpha * t).exp();
        let z = rest + decay * (p * cos + q * sin);
        let speed = decay * ((q * omega - alpha * p) * cos - (p * omega + alpha * q) * sin);
        assert!((z_mm - 1e3 * z).abs() < 1e-9, "{t_s}: {z_mm}");
        assert!(
            (force_n - (-k * z - b * speed).max(0.0)).abs() < 1e-8,
            "{t_s}: {force_n}"
        );
    }
}

#[test]
fn a_probe_that_cannot_be_held_is_refused_with_the_limit() {
    let lab = Lab::new();
    let refused = |more: &str, parts: &[&str]| {
        let line = [DROP, more, "--out f.csv"].join(" ");
        let outcome = lab.run(&line.split_whitespace().collect::<Vec<_>>());
        assert_eq!(outcome.code, 2, "{more}: {outcome:?}");
        let is_told = parts.iter().all(|part| outcome.err.contains(part));
        assert!(is_told, "{more}: {outcome:?}");
        assert!(!lab.path("f.csv").exists(), "nothing is written: {more}");
    };
    refused(
        "--seconds 3 --controller sampled --device-damping 0.02 --stiffness 9000 --rate 2000",
        &["no method can hold 9000 N/m", "above 80"],
    );
    refused(
        "--method explicit-euler --stiffness 1e9",
        &["explicit-euler cannot hold", "N/m"],
    );
    refused("--stiffness nan", &["the stiffness is NaN N/m", "1e9"]);
    for rate in ["0", "-5", "nan", "inf", "1e9"] {
        let line = [DROP, &format!("--rate={rate}")].join(" ");
        let outcome = lab.run(&line.split_whitespace().collect::<Vec<_>>());
        assert_eq!(outcome.code, 2, "{rate}: {outcome:?}");
        let is_told = outcome.err.contains("the rate is") && !outcome.err.contains("method");
        assert!(is_told, "before its method is named: {outcome:?}");
    }
    refused("--stroke 0,0:9,0 --speed 0", &["the speed is 0 mm/s"]);
    refused("--delay 3", &["--controller sampled"]);
    refused("--method magic", &["no method \"magic\""]);
}

#[test]
fn a_textiles_own_friction_and_compression_are_felt() {
    let lab = Lab::with_scene();
    let manifest = lab.read("textiles/fine/textile.toml");
    let friction = "x_mm,mu\n0,0.25\n0.1,0.25\n0.2,0.25\n";
    lab.write("textiles/fine/friction.csv", friction);
    let source = "[source]\nfriction = \"friction.csv\"";
    let rubbing = manifest.replace("[source]", source);
    let figures = "[measured]\nt0_mm = 1.5\ntm_mm = 1.0\nlc = 0.4\nrc_percent = 50.0\n";
    let probe = |manifest: &str, more: &str| {
        lab.write("textiles/fine/textile.toml", manifest);
        let line = "probe --surface fine --library textiles --stroke 0,0:10,0 --damping 2 ";
        let line = [line, more].concat();
        let outcome = lab.run(&line.split_whitespace().collect::<Vec<_>>());
        assert_eq!(outcome.code, 0, "{outcome:?}");
        let rows = Rows::parse(&outcome.out);
        (rows, outcome.err)
    };
    let (rows, _) = probe(&rubbing, "");
    let [force_n, tangential_n] = ["force_n", "tangential_n"].map(|name| rows.numbers(name));
    let there = force_n.iter().zip(tangential_n).take(190).skip(10);
    for (force_n, tangential_n) in there {
        let mu = tangential_n / force_n;
        assert!((mu - 0.25).abs() < 0.03, "{tangential_n} of {force_n}");
    }
    let soft = [rubbing.as_str(), "\n", figures].concat();
    let (rows, told) = probe(&soft, "--tip-radius 3");
    assert!(told.contains("the cloth is not linear"), "{told}");
    let deep_um = rows.numbers("depth_um")[5];
    assert!(
        deep_um > 500.0 && deep_um < 1600.0,
        "the wall is below 0.5 mm: {deep_um}"
    );
    let (_, told) = probe(&soft, "--tip-radius 3 --rigid");
    assert!(told.contains("piecewise linear"), "{told}");
}
