//! What can be held over stiffness and damping, with the present setting as a dot.

use selvedge_chart::{Axis, Band, Chart, Ink, Series, Style, Tone, Words};
use selvedge_foundation::numerics::bisected;
use selvedge_render::contact::Standing;

use super::settings::{DAMPINGS, STIFFNESSES, StylusSettings};

/// Dampings at which limits are found, and halvings that find each.
const N_DAMPINGS: u32 = 40;
const HALVINGS: u32 = 14;

/// The largest stiffness, N/m, at which `holds` is so with a damping of the wall.
fn limit(settings: &StylusSettings, damping: f64, holds: fn(Standing) -> bool) -> f64 {
    let ends = STIFFNESSES.map(f64::log10);
    let is_so = |log: f64| {
        let with = StylusSettings {
            stiffness_n_per_m: 10_f64.powf(log),
            damping_n_s_per_m: damping,
            ..*settings
        };
        holds(with.case().standing())
    };
    match (is_so(ends[0]), is_so(ends[1])) {
        (false, _) => STIFFNESSES[0],
        (_, true) => STIFFNESSES[1],
        _ => 10_f64.powf(bisected(ends, HALVINGS, is_so)),
    }
}

/// The map with the settings of `settings`.
pub(crate) fn map(settings: &StylusSettings) -> Chart {
    let [least, most] = DAMPINGS;
    let floor = STIFFNESSES[0];
    let (mut stable, mut active) = (Vec::new(), Vec::new());
    for i in 0..=N_DAMPINGS {
        let share = f64::from(i) / f64::from(N_DAMPINGS);
        let damping = least * (most / least).powf(share);
        let passive = limit(settings, damping, |standing| standing == Standing::Stable);
        let held = limit(settings, damping, |standing| standing != Standing::Unstable);
        stable.push([damping, floor, passive]);
        active.push([damping, passive, held.max(passive)]);
    }
    let edge = |name: &str, area: &[[f64; 3]], ink| {
        let points = area.iter().map(|[damping, _, high]| [*damping, *high]);
        Series {
            ink,
            ..Series::of(name, Style::Line, points)
        }
    };
    let at = setting_at(settings);
    let dot = Series {
        ink: Ink::Black,
        ..Series::of("", Style::Dots, [at])
    };
    let series = vec![
        edge("stable below", &stable, Ink::Grey),
        edge("active below", &active, Ink::Violet),
        dot,
    ];
    let area = |points, ink| Band {
        points,
        ink,
        ..Band::default()
    };
    Chart {
        title: "What can be held".to_owned(),
        x: Axis::log("damping B, N·s/m").within(DAMPINGS),
        y: Axis::log("stiffness K, N/m").within(STIFFNESSES),
        bands: vec![area(stable, Ink::Grey), area(active, Ink::Violet)],
        series,
        words: vec![Words {
            at,
            text: settings.case().standing().word().to_owned(),
            tone: Tone::Aside,
        }],
        ..Chart::default()
    }
}

/// Where a setting lies on the map.
fn setting_at(settings: &StylusSettings) -> [f64; 2] {
    let [least, most] = DAMPINGS;
    let damping = settings.damping_n_s_per_m.clamp(least, most);
    [damping, settings.stiffness_n_per_m]
}
