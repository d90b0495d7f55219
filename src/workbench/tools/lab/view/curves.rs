//! Amplitudes over speed along one stroke: amber at 40 Hz, cyan at 320 Hz; what is compared is
//! thin and dashed, a family is drawn from faint (its first) to full (its last).

use eframe::egui::{Margin, Rect, Ui};

use crate::bench::export::ink;
use crate::kit::amplitude::AmplitudeScale;
use crate::kit::plot;
use crate::kit::plot::{Setting, Shown};
use crate::kit::widgets::axis::Tick;
use crate::tools::lab::family::Family;
use crate::tools::lab::preview::{Felt, Preview, SPEEDS_MM_PER_S, speeds_mm_per_s};
use crate::tools::lab::state::{Lab, Page};
use crate::tools::lab::view::parts::title;
use selvedge_chart::{Axis, Band as Area, Chart, Series, Style, Weight};
use selvedge_foundation::quantity;
use selvedge_render::array::PointSpread;
use selvedge_textile::surface::Direction;
use selvedge_textile::tactile::Band;

/// How much of its ink the first of a family lacks.
const FAINTEST: f32 = 0.7;

/// Shows the plot.
pub(crate) fn show(ui: &Ui, rect: Rect, (lab, preview): (&Lab, &Preview), scale: AmplitudeScale) {
    let direction = lab.look.direction;
    let family = lab.family.as_ref();
    let family = family.filter(|_| lab.page == Page::Family);
    let words = match family {
        Some(family) => format!(
            "amplitudes, {}: {} from {} (faint) to {}",
            direction.label(),
            family.parameter[0],
            ends_of(family)[0],
            ends_of(family)[1]
        ),
        None => format!("amplitudes over speed, {}", direction.label()),
    };
    let below = title(ui, rect, &words);
    let name = format!("Amplitudes over speed, {}", direction.label());
    let setting = Setting {
        name: &name,
        margin: Margin {
            left: 34,
            right: 8,
            top: 12,
            bottom: 16,
        },
        link: Some("speed, mm/s"),
        hover: false,
        ..Setting::default()
    };
    let chart = match family {
        Some(family) => family_chart(lab, family, scale),
        None => chart(lab, preview, scale),
    };
    if let Some(shown) = plot::show(ui, below, &chart, &setting) {
        describe(&shown, lab, preview);
    }
}

/// Amplitudes over speed of a recipe with the range over all points, and of what it is compared
/// with.
pub(crate) fn chart(lab: &Lab, preview: &Preview, scale: AmplitudeScale) -> Chart {
    let direction = lab.look.direction;
    let band = |band: Band| {
        let ends = [
            levels(&preview.felt, direction, |spread| {
                spread.min_um[band.index()]
            }),
            levels(&preview.felt, direction, |spread| {
                spread.max_um[band.index()]
            }),
        ];
        Area {
            points: std::iter::zip(&ends[0], &ends[1])
                .map(|(least, most)| [least[0], least[1], most[1]])
                .collect(),
            ink: ink(band),
            ..Area::default()
        }
    };
    let lines = Band::ALL.map(|band| line(&preview.felt, direction, band));
    Chart {
        bands: Band::ALL.map(band).to_vec(),
        series: compared(lab).into_iter().chain(lines).collect(),
        ..axes(scale)
    }
}

/// The same of a family, from faint (its first) to full (its last).
fn family_chart(lab: &Lab, family: &Family, scale: AmplitudeScale) -> Chart {
    let direction = lab.look.direction;
    let last = family.members.len().saturating_sub(1).max(1) as f32;
    let members = family.members.iter().enumerate().flat_map(|(nth, member)| {
        let is_last = nth + 1 == family.members.len();
        Band::ALL.map(|band| {
            let line = line(&member.felt, direction, band);
            Series {
                name: if is_last { line.name } else { String::new() },
                faintness: FAINTEST * (1.0 - nth as f32 / last),
                ..line
            }
        })
    });
    Chart {
        series: compared(lab).into_iter().chain(members).collect(),
        ..axes(scale)
    }
}

fn axes(scale: AmplitudeScale) -> Chart {
    Chart {
        x: Axis::log("speed, mm/s").within(SPEEDS_MM_PER_S),
        y: Axis::linear("level, dB re 1 µm").within(scale.level_ends_db()),
        ..Chart::default()
    }
}

/// What is compared, thin and dashed behind the rest.
fn compared(lab: &Lab) -> Vec<Series> {
    let compared = lab.compared.iter();
    let lines = compared
        .flat_map(|compared| Band::ALL.map(|band| line(&compared.felt, lab.look.direction, band)));
    let behind = |line: Series| Series {
        name: String::new(),
        style: Style::Dashed,
        weight: Weight::Thin,
        ..line
    };
    lines.map(behind).collect()
}

fn line(felt: &Felt, direction: Direction, band: Band) -> Series {
    Series {
        name: format!("{} Hz", quantity::fixed(band.carrier_hz(), 0)),
        points: levels(felt, direction, |spread| spread.rms_um[band.index()]),
        style: Style::Line,
        ink: ink(band),
        ..Series::default()
    }
}

fn levels(felt: &Felt, direction: Direction, um: impl Fn(&PointSpread) -> f64) -> Vec<[f64; 2]> {
    let curve = speeds_mm_per_s().zip(&felt.over_speed[direction.index()]);
    let level = |(speed, spread)| [speed, quantity::level_db(um(spread))];
    curve.map(level).collect()
}

fn ends_of(family: &Family) -> [String; 2] {
    let ends = [family.members.first(), family.members.last()];
    let unit = family.parameter[1];
    ends.map(|end| {
        end.map_or_else(String::new, |member| {
            let tick = Tick::number(member.value);
            format!("{} {unit}", tick.label).trim_end().to_owned()
        })
    })
}

fn describe(shown: &Shown, lab: &Lab, preview: &Preview) {
    let Some(at) = shown.pointer().filter(|_| !shown.response.dragged()) else {
        return;
    };
    let [pointed_mm_per_s, _] = shown.values_at(at);
    let direction = lab.look.direction;
    let distance = |speed: f64| (speed / pointed_mm_per_s).ln().abs();
    let all = speeds_mm_per_s().enumerate();
    let nearest = all.min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
    let Some((nth, speed_mm_per_s)) = nearest else {
        return;
    };
    let words_of = |felt: &Felt| {
        let spread = felt.over_speed[direction.index()].get(nth).copied();
        let spread = spread.unwrap_or_default();
        let band_words = Band::ALL.map(|band| {
            let um = spread.rms_um[band.index()];
            let db = quantity::fixed(quantity::level_db(um), 1);
            format!("A{} {db} dB", quantity::fixed(band.carrier_hz(), 0))
        });
        band_words.join("   ")
    };
    let compared = lab.compared.as_ref().map_or_else(String::new, |compared| {
        format!("\n{}: {}", compared.name, words_of(&compared.felt))
    });
    let decimals = usize::from(speed_mm_per_s < 9.95);
    shown.response.clone().on_hover_text_at_pointer(format!(
        "{}\n{}{compared}\nRoot mean square over all points, re 1 µm peak, before gains; the \
         shade is from the least to the largest",
        quantity::with_unit(speed_mm_per_s, decimals, "mm/s"),
        words_of(&preview.felt)
    ));
}
