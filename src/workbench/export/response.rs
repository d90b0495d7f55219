//! A textile's amplitudes over the direction and over the speed of movement.

use super::spectrograms::ink;
use super::{Exported, Origin, Sheet};
use crate::curves::speeds_mm_per_s;
use crate::panes::{ResponseView, response_ends_db};
use crate::probe::SPEEDS_MM_PER_S;
use selvedge_chart::{Axis, Panel, Row, Series, Style, Weight};
use selvedge_foundation::quantity;
use selvedge_render::array::PointSpread;
use selvedge_textile::tactile::Band;

/// One velocity and what it gives.
struct Asked {
    over: &'static str,
    direction_deg: f64,
    speed_mm_per_s: f64,
    given: PointSpread,
}

/// Both curves of the pane.
pub(super) fn curves(view: &ResponseView<'_>, origin: Origin) -> Exported {
    let asked = asked(view);
    let ends_db = response_ends_db(view.scale);
    let level = |label: &str| Axis::linear(label).within(ends_db);
    let around = Axis::linear("direction from the warp, ° counter-clockwise").within([0.0, 360.0]);
    let speed = Axis::log("speed, mm/s").within(SPEEDS_MM_PER_S);
    let of = |over: &str, x: Axis, at: &dyn Fn(&Asked) -> f64| {
        let chosen: Vec<&Asked> = asked.iter().filter(|one| one.over == over).collect();
        panel(&chosen, (x, level("level, dB re 1 µm")), at)
    };
    let row = Row {
        panels: vec![
            of("direction", around, &|one| one.direction_deg),
            of("speed", speed, &|one| one.speed_mm_per_s),
        ],
        height_px: 360.0,
        bar: None,
    };
    let note = "After gains, before output limits. Solid: at the points that the chosen contactor \
                reads; dashed: root mean square over all pairs of points.";
    let probe = view.probe;
    let place = view.place.map_or_else(String::new, |(contactor, _)| {
        format!("at contactor {contactor}")
    });
    let asked_at = format!(
        "{} mm/s, {}°",
        quantity::fixed(probe.speed_mm_per_s, 0),
        quantity::fixed(probe.direction_deg, 0)
    );
    let origin = origin
        .and("textile", view.textile, view.textile)
        .and("place", &place, &place)
        .and("asked_at", &asked_at, &asked_at);
    let title = format!("Response of {}", view.textile);
    Exported::new(title, sheet(&asked), vec![row], note, origin)
}

fn asked(view: &ResponseView<'_>) -> Vec<Asked> {
    let around = view.curves.around();
    let step_deg = 360.0 / around.len().max(1) as f64;
    // Directions of the curve begin at the warp, the chosen one at the workspace's x.
    let chosen_deg = (view.probe.direction_deg - view.rotation_deg).rem_euclid(360.0);
    let by_direction = around.iter().enumerate().map(|(i, given)| Asked {
        over: "direction",
        direction_deg: i as f64 * step_deg,
        speed_mm_per_s: view.probe.speed_mm_per_s,
        given: given.scaled(view.factors),
    });
    let by_speed = speeds_mm_per_s().zip(view.curves.over_speed());
    let by_speed = by_speed.map(|(speed_mm_per_s, given)| Asked {
        over: "speed",
        direction_deg: chosen_deg,
        speed_mm_per_s,
        given: given.scaled(view.factors),
    });
    by_direction.chain(by_speed).collect()
}

fn sheet(asked: &[Asked]) -> Sheet {
    let number = |of: &dyn Fn(&Asked) -> f64| -> Vec<f64> { asked.iter().map(of).collect() };
    let here = |band: usize| number(&|one| one.given.at_place_um.map_or(f64::NAN, |um| um[band]));
    let over: Vec<String> = asked.iter().map(|one| one.over.to_owned()).collect();
    Sheet::default()
        .with("over", over)
        .with("direction_from_warp_deg", number(&|one| one.direction_deg))
        .with("speed_mm_per_s", number(&|one| one.speed_mm_per_s))
        .with("a40_here_um", here(0))
        .with("a320_here_um", here(1))
        .with("a40_rms_um", number(&|one| one.given.rms_um[0]))
        .with("a320_rms_um", number(&|one| one.given.rms_um[1]))
        .with("a40_least_um", number(&|one| one.given.min_um[0]))
        .with("a320_least_um", number(&|one| one.given.min_um[1]))
        .with("a40_most_um", number(&|one| one.given.max_um[0]))
        .with("a320_most_um", number(&|one| one.given.max_um[1]))
}

fn panel(asked: &[&Asked], (x, y): (Axis, Axis), at: &dyn Fn(&Asked) -> f64) -> Panel {
    let mut series = Vec::new();
    for band in Band::ALL {
        let name = format!("{} Hz", quantity::fixed(band.carrier_hz(), 0));
        let line = |name: String, style, weight, um: &dyn Fn(&PointSpread) -> Option<f64>| Series {
            name,
            points: asked
                .iter()
                .filter_map(|one| {
                    let um = um(&one.given).filter(|um| *um > 0.0)?;
                    Some([at(one), quantity::level_db(um)])
                })
                .collect(),
            style,
            ink: ink(band),
            weight,
            ..Series::default()
        };
        let b = band.index();
        series.push(line(String::new(), Style::Dashed, Weight::Thin, &|given| {
            Some(given.rms_um[b])
        }));
        series.push(line(name, Style::Line, Weight::Normal, &|given| {
            given.at_place_um.map(|um| um[b])
        }));
    }
    Panel {
        x,
        y,
        series,
        ..Panel::default()
    }
}
