//! The textile lab: the profile that is looked at and the amplitudes over speed along it.

use crate::bench::export::origin::Origin;
use crate::bench::export::row;
use crate::bench::export::{Exported, Sheet};
use crate::kit::amplitude::AmplitudeScale;
use crate::tools::lab::preview::{Felt, Preview, speeds_mm_per_s};
use crate::tools::lab::state::Lab;
use crate::tools::lab::view::curves::chart as lab_chart;
use crate::tools::lab::view::profile::chart as profile_chart;
use selvedge_foundation::numerics::to_index;

/// A row of the table: a place of the profile, or a speed.
struct Line {
    over: &'static str,
    x: f64,
    height_um: f64,
    compared_um: f64,
    amplitudes_um: [[f64; 2]; 2],
}

/// The profile and the curves of a recipe, with what it is compared with.
pub(crate) fn curves(
    lab: &Lab,
    preview: &Preview,
    scale: AmplitudeScale,
    origin: Origin,
) -> Exported {
    let compared = lab.compared.as_ref().map(|compared| &compared.felt);
    let mut lines = heights(lab, &preview.felt, compared);
    lines.extend(amplitudes(lab, &preview.felt, compared));
    let direction = lab.look.direction.label();
    let rows = vec![
        row(profile_chart(lab, &preview.felt), 220.0),
        row(lab_chart(lab, preview, scale), 360.0),
    ];
    let kind = preview.manifest.source.kind();
    let mut origin = origin
        .and("recipe", &preview.manifest.name, &preview.manifest.name)
        .and("kind", kind, kind)
        .and("stroke", direction, direction);
    if let Some(compared) = &lab.compared {
        origin = origin.and("compared_with", &compared.id, &compared.name);
    }
    let note = "Without gains. Root mean square over all points along the stroke, shaded from the \
                least to the largest; thin and dashed: what is compared.";
    let title = format!("{}, {direction}", preview.manifest.name);
    Exported::new(title, sheet(&lines), rows, note, origin)
}

fn heights(lab: &Lab, felt: &Felt, compared: Option<&Felt>) -> Vec<Line> {
    let direction = lab.look.direction;
    let Some(profile) = felt.profile(direction) else {
        return Vec::new();
    };
    let other = compared.and_then(|compared| compared.profile(direction));
    let step_mm = profile.step_mm();
    let line = |(index, height): (usize, &f64)| {
        let x = index as f64 * step_mm;
        // The nearest sample of the other one, which may have another step.
        let there = other.and_then(|other| {
            let nearest = to_index((x / other.step_mm()).round());
            other.heights_um().get(nearest).copied()
        });
        Line {
            over: "place",
            x,
            height_um: *height,
            compared_um: there.unwrap_or(f64::NAN),
            amplitudes_um: [[f64::NAN; 2]; 2],
        }
    };
    profile.heights_um().iter().enumerate().map(line).collect()
}

fn amplitudes(lab: &Lab, felt: &Felt, compared: Option<&Felt>) -> Vec<Line> {
    let d = lab.look.direction.index();
    let line = |(nth, speed): (usize, f64)| {
        let at = |felt: &Felt| felt.over_speed[d].get(nth).map(|spread| spread.rms_um);
        let none = [f64::NAN; 2];
        Line {
            over: "speed",
            x: speed,
            height_um: f64::NAN,
            compared_um: f64::NAN,
            amplitudes_um: [
                at(felt).unwrap_or(none),
                compared.and_then(at).unwrap_or(none),
            ],
        }
    };
    speeds_mm_per_s().enumerate().map(line).collect()
}

fn sheet(lines: &[Line]) -> Sheet {
    let number = |of: &dyn Fn(&Line) -> f64| -> Vec<f64> { lines.iter().map(of).collect() };
    let only =
        |over: &'static str| number(&|line| if line.over == over { line.x } else { f64::NAN });
    let over: Vec<String> = lines.iter().map(|line| line.over.to_owned()).collect();
    Sheet::default()
        .with("over", over)
        .with("x_mm", only("place"))
        .with("height_um", number(&|line| line.height_um))
        .with("compared_height_um", number(&|line| line.compared_um))
        .with("speed_mm_per_s", only("speed"))
        .with("a40_um", number(&|line| line.amplitudes_um[0][0]))
        .with("a320_um", number(&|line| line.amplitudes_um[0][1]))
        .with("compared_a40_um", number(&|line| line.amplitudes_um[1][0]))
        .with("compared_a320_um", number(&|line| line.amplitudes_um[1][1]))
}
