//! The charts of the pane and their numbers: a textile's amplitudes over the direction and over the
//! speed of movement.

use crate::bench::export::Exported;
use crate::bench::export::ink;
use crate::bench::export::origin::Origin;
use crate::bench::probe::SPEEDS_MM_PER_S;
use crate::tools::response::curves::speeds_mm_per_s;
use crate::tools::response::shown::ResponseView;
use selvedge_chart::{Axis, Band as Area, Chart, Columns, Row, Series, Style, Weight};
use selvedge_foundation::quantity;
use selvedge_render::array::PointSpread;
use selvedge_textile::Uncertainty;
use selvedge_textile::tactile::Band;

/// One velocity and what it gives.
struct Asked {
    over: &'static str,
    direction_deg: f64,
    speed_mm_per_s: f64,
    given: PointSpread,
    /// By band from where to where it may lie, dB from that.
    known_db: Option<[[f64; 2]; 2]>,
}

impl Asked {
    fn of(
        view: &ResponseView<'_>,
        over: &'static str,
        [direction_deg, speed_mm_per_s]: [f64; 2],
        given: &PointSpread,
    ) -> Self {
        let known = |known: &Uncertainty| Band::ALL.map(|band| known.level_db(band, direction_deg));
        Self {
            over,
            direction_deg,
            speed_mm_per_s,
            given: given.scaled(view.factors),
            known_db: view.uncertainty.as_ref().map(known),
        }
    }
}

/// Level over speed, in the chosen direction.
pub(crate) fn over_speed(view: &ResponseView<'_>) -> Chart {
    let speeds = speeds_mm_per_s().zip(view.curves.over_speed());
    let asked: Vec<Asked> = speeds
        .map(|(speed, given)| Asked::of(view, "speed", [chosen_deg(view), speed], given))
        .collect();
    let x = Axis::log("speed, mm/s").within(SPEEDS_MM_PER_S);
    chart(&asked, (x, levels(view)), &|one| one.speed_mm_per_s)
}

/// Level over direction, at the chosen speed.
fn around(view: &ResponseView<'_>) -> Chart {
    let around = view.curves.around();
    let step_deg = 360.0 / around.len().max(1) as f64;
    let directions = around.iter().enumerate();
    let asked: Vec<Asked> = directions
        .map(|(i, given)| {
            let at = [i as f64 * step_deg, view.probe.speed_mm_per_s];
            Asked::of(view, "direction", at, given)
        })
        .collect();
    let x = Axis::linear("direction from the warp, ° counter-clockwise").within([0.0, 360.0]);
    chart(&asked, (x, levels(view)), &|one| one.direction_deg)
}

fn levels(view: &ResponseView<'_>) -> Axis {
    Axis::linear("level, dB re 1 µm").within(view.scale.level_ends_db())
}

/// Both curves of the pane with their numbers.
pub(crate) fn exported(view: &ResponseView<'_>, origin: Origin) -> Exported {
    let panels = vec![around(view), over_speed(view)];
    let [around, over_speed] = [&panels[0], &panels[1]].map(|chart| chart.columns.clone());
    let sheet = around.followed_by(over_speed);
    let row = Row {
        panels,
        height_px: 360.0,
        bar: None,
    };
    let note = "After gains, before output limits. Solid: at the points that the chosen contactor \
                reads; dashed: root mean square over all pairs of points; shaded: from the \
                least to the largest of them.";
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
        .and("textile", &view.textile, &view.textile)
        .and("place", &place, &place)
        .and("asked_at", &asked_at, &asked_at);
    let title = format!("Response of {}", view.textile);
    Exported::new(title, sheet, vec![row], note, origin)
}

/// Directions of the curve begin at the warp, the chosen one at the workspace's x.
pub(crate) fn chosen_deg(view: &ResponseView<'_>) -> f64 {
    (view.probe.direction_deg - view.rotation_deg).rem_euclid(360.0)
}

fn columns(asked: &[Asked]) -> Columns {
    let number = |of: &dyn Fn(&Asked) -> f64| -> Vec<f64> { asked.iter().map(of).collect() };
    let here = |band: usize| number(&|one| one.given.at_place_um.map_or(f64::NAN, |um| um[band]));
    let over: Vec<String> = asked.iter().map(|one| one.over.to_owned()).collect();
    let known = |band: usize, end: usize| {
        number(&move |one| one.known_db.map_or(f64::NAN, |db| db[band][end]))
    };
    let columns = Columns::default()
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
        .with("a320_most_um", number(&|one| one.given.max_um[1]));
    if asked.iter().all(|one| one.known_db.is_none()) {
        return columns;
    }
    columns
        .with("a40_low_db", known(0, 0))
        .with("a40_high_db", known(0, 1))
        .with("a320_low_db", known(1, 0))
        .with("a320_high_db", known(1, 1))
}

fn chart(asked: &[Asked], (x, y): (Axis, Axis), at: &dyn Fn(&Asked) -> f64) -> Chart {
    let (mut series, mut bands) = (Vec::new(), Vec::new());
    for band in Band::ALL {
        let (b, ink) = (band.index(), ink(band));
        let name = format!("{} Hz", quantity::fixed(band.carrier_hz(), 0));
        let line = |style, weight, um: &dyn Fn(&PointSpread) -> f64| Series {
            points: asked
                .iter()
                .map(|one| [at(one), quantity::level_db(um(&one.given))])
                .collect(),
            style,
            ink,
            weight,
            ..Series::default()
        };
        bands.push(Area {
            points: asked
                .iter()
                .map(|one| {
                    let range_um = [one.given.min_um[b], one.given.max_um[b]];
                    let [least, most] = range_um.map(quantity::level_db);
                    [at(one), least, most]
                })
                .collect(),
            ink,
            ..Area::default()
        });
        let known = asked.iter().filter_map(|one| {
            let [low, high] = one.known_db?[b];
            let mean = quantity::level_db(one.given.rms_um[b]);
            Some([at(one), mean + low, mean + high])
        });
        let known: Vec<[f64; 3]> = known.collect();
        if !known.is_empty() {
            bands.push(Area {
                name: format!("{name} is known to"),
                points: known,
                ink,
            });
        }
        series.push(line(Style::Dashed, Weight::Thin, &|given| given.rms_um[b]));
        let here = line(Style::Line, Weight::Normal, &|given| {
            given.at_place_um.map_or(f64::NAN, |um| um[b])
        });
        series.push(Series { name, ..here });
    }
    Chart {
        x,
        y,
        bands,
        series,
        columns: columns(asked),
        ..Chart::default()
    }
}
