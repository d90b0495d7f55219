//! What the pointer is told when it rests: about textiles and contactors.
//!
//! A tip under the finger would be in the way of feeling, so while exploring only tags speak.

use eframe::egui::{Label, Pos2, Response, Ui};

use crate::bench::on_finger::{is_muted, sentence_lines};
use crate::bench::perceptual_level::PerceptualLevel;
use crate::bench::view::{Cloth, Dot, SceneView};
use crate::kit::widgets::limit_mark::limit_words;
use crate::tools::workspace::stage::Stage;
use crate::tools::workspace::{arrange, drag, overlay};
use selvedge_foundation::quantity;

/// Tells what is under the resting pointer; `tag` is the textile whose tag is.
pub(crate) fn describe(ui: &Ui, stage: &Stage<'_>, tag: Option<usize>) {
    let Some(at) = stage.response.hover_pos() else {
        return;
    };
    if ui.input(|input| input.pointer.any_down()) || stage.response.context_menu_opened() {
        return;
    }
    if stage.arranges()
        && let Some(index) = drag::dot_at(stage, at)
    {
        return describe_dot(&stage.response, stage, index);
    }
    let covered = || covered_by(stage, at);
    if let Some(index) = tag.or_else(covered)
        && let Some(cloth) = stage.sight.scene.cloths.get(index)
    {
        let response = stage.response.clone();
        let place = stage.view.workspace(at);
        let map = overlay::words_at(stage, index, cloth, place);
        response.on_hover_ui_at_pointer(|ui| {
            ui.add(Label::new(of_cloth(cloth) + &map).extend());
        });
    }
}

/// Tells of a contactor; the lens does too.
pub(crate) fn describe_dot(response: &Response, stage: &Stage<'_>, index: usize) {
    if let Some(dot) = stage.sight.live.dots.get(index) {
        response.clone().on_hover_ui_at_pointer(|ui| {
            let words = of_dot(
                index,
                dot,
                stage.sight.scene,
                &stage.sight.live.perceptual_level,
            );
            ui.add(Label::new(words).extend());
        });
    }
}

fn covered_by(stage: &Stage<'_>, at: Pos2) -> Option<usize> {
    let place = stage.view.workspace(at);
    stage
        .arranges()
        .then(|| arrange::topmost(&stage.sight.scene.cloths, place))?
}

fn of_cloth(cloth: &Cloth) -> String {
    let [width, height] = cloth.size_mm.map(|mm| quantity::fixed(mm, 1));
    let label = if cloth.label.is_empty() {
        String::new()
    } else {
        format!("{}  ", cloth.label)
    };
    let muted = if cloth.is_muted { "\nMuted" } else { "" };
    format!(
        "{label}{}\n{}\n{width} × {height} mm, turned by {}\nGain {}{muted}",
        cloth.name,
        cloth.id,
        quantity::with_unit(cloth.rotation_deg, 1, "°").replace(' ', ""),
        quantity::with_unit(cloth.gain_db, 1, "dB"),
    )
}

fn of_dot(
    index: usize,
    dot: &Dot,
    scene: &SceneView,
    perceptual_level: &PerceptualLevel,
) -> String {
    let grid = match scene.grid {
        Some((_, n_columns)) if n_columns > 0 => {
            format!(", row {}, column {}", index / n_columns, index % n_columns)
        }
        _ => String::new(),
    };
    let on = match dot.cloth.and_then(|cloth| scene.cloths.get(cloth)) {
        Some(cloth) => format!("on {} {}", cloth.label, cloth.name),
        None => "off every textile".to_owned(),
    };
    let [x, y] = [dot.position.x_mm, dot.position.y_mm].map(|mm| quantity::fixed(mm, 2));
    let bands = perceptual_level.band_lines(dot.amplitude_um);
    let limited = limit_words(dot.limiter).filter(|_| !is_muted(dot.on_finger));
    let limited = limited.map_or_else(String::new, |words| format!("\n{words}"));
    let state = limited + &sentence_lines(dot.on_finger);
    format!(
        "Contactor {index}{grid}\n{on}, at {x}, {y} mm\n{bands}\nPeak, after gains, before output \
         limits{state}\nClick to look closer at it"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::geometry::{Frame, Point};

    #[test]
    fn a_tip_tells_what_where_and_how_much() {
        let cloth = Cloth {
            id: "felt".to_owned(),
            label: "2".to_owned(),
            name: "Wool felt".to_owned(),
            workspace_from_textile: Frame::default(),
            size_mm: [100.0, 50.0],
            rotation_deg: -15.0,
            is_muted: true,
            gain_db: -3.0,
            ..Cloth::default()
        };
        let expected = "2  Wool felt\nfelt\n100.0 × 50.0 mm, turned by −15.0°\nGain −3.0 dB\nMuted";
        assert_eq!(of_cloth(&cloth), expected);
        let scene = SceneView {
            grid: Some((6, 4)),
            cloths: vec![cloth],
            ..empty_scene()
        };
        let dot = Dot {
            position: Point::new(1.0, -2.0),
            cloth: Some(0),
            amplitude_um: [3.0, 0.5],
            ..Dot::default()
        };
        let words = of_dot(9, &dot, &scene, &PerceptualLevel::default());
        assert!(words.starts_with("Contactor 9, row 2, column 1\non 2 Wool felt"));
        assert!(words.contains("at 1.00, −2.00 mm"), "{words}");
        assert!(words.contains("320 Hz  0.50 µm"), "{words}");
    }

    fn empty_scene() -> SceneView {
        SceneView {
            name: String::new(),
            path: None,
            is_edited: false,
            size_mm: [0.0; 2],
            cloths: Vec::new(),
            tuning: selvedge_textile::tactile::Tuning::default(),
            default_tuning: selvedge_textile::tactile::Tuning::default(),
            reference_db: None,
            filters: selvedge_textile::tactile::Filters::default(),
            grid: None,
            library: Vec::new(),
            library_is_stale: false,
            marks: crate::bench::view::Marks::default(),
            picked: std::sync::Arc::default(),
        }
    }
}
