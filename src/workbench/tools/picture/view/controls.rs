//! The steps: what is chosen and typed, and what came of it in words.

#[cfg(feature = "friction")]
use std::sync::Arc;

use eframe::egui::Ui;

use crate::bench::command::{Commands, FileCommand, Purpose};
use crate::bench::pane::Pane;
use crate::bench::source_file::SourceFile;
use crate::kit::theme::{Palette, STEP};
use crate::kit::widgets::fields::{Need, Tone, choose_of, note, note_if, row_of, step_title, text};
use crate::kit::widgets::fold::described_fold;
use crate::kit::widgets::scale::Scale;
use crate::kit::widgets::slider::{RowShape, slider_row_as};
use crate::kit::widgets::text::{button, paragraph, quiet, toggle, toggles};
use crate::tools::picture::draft::{Draft, Part, ScaleUnit};
use crate::tools::picture::found::{Found, Step};
use crate::tools::picture::state::Picture;
use crate::tools::picture::view::{repeats, turned};
#[cfg(feature = "friction")]
use selvedge_foundation::numerics::to_single;
use selvedge_foundation::quantity;
use selvedge_textile::picture::shading::{Light, Method};
use selvedge_textile::picture::{Relief, ReliefOf};

/// Room for the name of a field, points.
const NAME: f32 = 52.0;
/// Width of a typed number, points.
const NUMBER: f32 = 64.0;

/// Shows the steps.
pub(crate) fn show(ui: &mut Ui, picture: &mut Picture, commands: &mut Commands) {
    let found = picture.found().cloned();
    let found = found.as_deref();
    show_picture(ui, picture, found, commands);
    let cloth = found.and_then(|found| found.cloth.as_deref());
    repeats::show(ui, (&mut picture.draft, &mut picture.textures), cloth);
    let shaped = found.and_then(|found| found.shaped.as_deref());
    show_light(ui, &mut picture.draft, shaped);
    show_failure(ui, found, Step::Light);
    let words = "autocorrelation, directions, strokes";
    let head = described_fold(ui, ("Expert’s plots", picture.is_expert), words, |ui| {
        repeats::show_directions(ui, &mut picture.draft, cloth);
    });
    if head.clicked() {
        picture.is_expert = !picture.is_expert;
    }
}

fn show_failure(ui: &mut Ui, found: Option<&Found>, step: Step) {
    let failure = found.and_then(|found| found.failure.as_ref());
    let line = failure.filter(|(at, _)| *at == step);
    note_if(ui, line.map(|(_, line)| line.as_str()), Tone::Wrong);
}

fn show_picture(
    ui: &mut Ui,
    picture: &mut Picture,
    found: Option<&Found>,
    commands: &mut Commands,
) {
    let source = picture.draft.source.as_ref();
    let name = source.map(SourceFile::name);
    step_title(ui, 1, "File and scale", &name.unwrap_or_default());
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        if button(ui, "Another…", "Choose another picture", None) {
            commands.push(FileCommand::Ask(Purpose::OpenPicture(Pane::Picture)).into());
        }
        let tip = "Let go of the picture and of what was typed";
        if button(ui, "Begin anew", tip, None) {
            picture.clear();
        }
        #[cfg(feature = "friction")]
        show_friction(ui, &picture.draft, found, commands);
    });
    show_failure(ui, found, Step::Picture);
    let draft = &mut picture.draft;
    turned::show(ui, draft, found, commands);
    show_scale(ui, draft);
    let size = found
        .and_then(|found| found.loaded.as_deref())
        .map(|loaded| loaded.size);
    if let Some(size) = size.filter(|_| draft.unit == ScaleUnit::Ruler) {
        let [w, h] = size.map(|n| n as f64);
        let ends = || [0.25, 0.75].map(|share| [(share * w).round(), (0.5 * h).round()]);
        draft.ruler.get_or_insert_with(ends);
    }
    if let Some(size) = size {
        show_part(ui, draft, size);
    }
    let was_evened = found
        .and_then(|found| found.correlated.as_deref())
        .is_some_and(|correlated| correlated.was_evened);
    row_of(
        ui,
        NAME,
        ("light", if was_evened { "was evened out" } else { "" }),
        |ui, _| {
            let tip = "Divide out light that changes slowly over the picture";
            if toggle(ui, "even out", draft.is_evened, tip) {
                draft.is_evened = !draft.is_evened;
            }
        },
    );
}

/// The scale, and in what it is typed.
fn show_scale(ui: &mut Ui, draft: &mut Draft) {
    row_of(ui, NAME, ("scale", ""), |ui, label| {
        let need = Need::of(draft.picture_scale().is_none());
        let hint = match draft.unit {
            ScaleUnit::Dpi => "600",
            ScaleUnit::PxPerMm => "23.6",
            ScaleUnit::Ruler => "10 mm",
            ScaleUnit::Threads => "24 20",
        };
        text(ui, label, &mut draft.scale, (hint, NUMBER, need));
        let choices = [
            (ScaleUnit::Dpi, "dpi", "Dots to an inch, as scanners count"),
            (ScaleUnit::PxPerMm, "px/mm", "Pixels to a millimetre"),
            (
                ScaleUnit::Ruler,
                "ruler",
                "A line dragged on the picture; type its millimetres",
            ),
            (
                ScaleUnit::Threads,
                "per cm",
                "Threads to a centimetre, warp and weft, with the grid that is found",
            ),
        ];
        toggles(ui, &mut draft.unit, &choices);
    });
}

/// Hands what is looked at of the picture to the pane that shows friction.
#[cfg(feature = "friction")]
fn show_friction(ui: &mut Ui, draft: &Draft, found: Option<&Found>, commands: &mut Commands) {
    use crate::bench::command::friction::PictureAtHand;

    let correlated = found.and_then(|found| found.correlated.as_deref());
    let ready = correlated.zip(draft.px_per_mm(found.and_then(Found::lattice)));
    let refusal = ready.is_none().then_some("Type the picture’s scale first");
    let tip = "Its friction along the middle, felt on an electrovibration screen";
    let is_pressed = button(ui, "Friction…", tip, refusal);
    if let Some((correlated, px_per_mm)) = ready.filter(|_| is_pressed) {
        let brightness = correlated.picture.luminance.map(to_single);
        let picture = PictureAtHand {
            name: draft.final_name(),
            brightness: Arc::new(brightness),
            px_per_mm,
        };
        commands.push(picture.into());
    }
}

fn show_part(ui: &mut Ui, draft: &mut Draft, size: [usize; 2]) {
    row_of(ui, NAME, ("part", ""), |ui, _| {
        let quarter = size.map(|n| n / 4);
        let [w, h] = size.map(|n| n as f64);
        let corners = [[0.1, 0.1], [0.9, 0.1], [0.9, 0.9], [0.1, 0.9]];
        let corners = corners.map(|[x, y]| [(x * w).round(), (y * h).round()]);
        let [half_w, half_h] = size.map(|n| n / 2);
        let region = [quarter[0], quarter[1], half_w.max(1), half_h.max(1)];
        let is_region = matches!(draft.part, Part::Region(_));
        let is_corners = matches!(draft.part, Part::Corners(_));
        if toggle(ui, "all", draft.part == Part::Whole, "The whole picture") {
            draft.part = Part::Whole;
        }
        if toggle(
            ui,
            "region",
            is_region,
            "A rectangle, dragged on the picture",
        ) && !is_region
        {
            draft.part = Part::Region(region);
        }
        let tip = "Four corners, dragged on a picture that was taken at a slant";
        if toggle(ui, "corners", is_corners, tip) && !is_corners {
            draft.part = Part::Corners(corners);
        }
    });
    if let Part::Region(_) = draft.part {
        let scale = Scale::even([-180.0, 180.0], 0.0, 1.0, (1, "°"));
        draft.turn_deg = slider(ui, "turn", scale, draft.turn_deg).unwrap_or(draft.turn_deg);
    }
}

pub(super) fn slider(ui: &mut Ui, name: &str, scale: Scale, value: f64) -> Option<f64> {
    let shape = RowShape {
        name: NAME + STEP,
        takes_any: false,
    };
    let ink = Palette::in_ui(ui).line;
    slider_row_as(ui, (name, ink), (shape, scale), value).0
}

fn show_light(ui: &mut Ui, draft: &mut Draft, shaped: Option<&Relief>) {
    ui.add_space(STEP);
    let state = if draft.is_light_estimated {
        "estimated"
    } else {
        "as given"
    };
    step_title(ui, 4, "Light and relief", state);
    let light = draft.light_shown(shaped);
    let slants = Scale::even([5.0, 80.0], 45.0, 1.0, (0, "°"));
    let slant = slider(ui, "slant", slants, light.slant_deg);
    let tilts = Scale::even([-180.0, 180.0], 90.0, 1.0, (0, "°"));
    let tilt = slider(ui, "tilt", tilts, light.tilt_deg);
    if slant.is_some() || tilt.is_some() {
        draft.light = Light {
            slant_deg: slant.unwrap_or(light.slant_deg),
            tilt_deg: tilt.unwrap_or(light.tilt_deg),
        };
        draft.is_light_estimated = false;
    }
    let tip = "Estimate the light; or drag the sun over the picture";
    if toggle(ui, "estimate it", draft.is_light_estimated, tip) {
        draft.is_light_estimated = !draft.is_light_estimated;
    }
    show_method(ui, draft);
    if let Some(shaped) = shaped {
        show_trust(ui, shaped);
    }
}

fn show_method(ui: &mut Ui, draft: &mut Draft) {
    let choices = [
        (
            ReliefOf::Picture,
            "as scanned",
            "The picture as it is, yarn by yarn, over and over",
        ),
        (
            ReliefOf::Synthesized,
            "synthesized",
            "Cloth without a visible repetition: the mean cell, and what varies from cell to cell \
             drawn anew",
        ),
        (
            ReliefOf::Cell,
            "mean cell",
            "The cell that repeats: what varies from yarn to yarn is lost",
        ),
    ];
    row_of(ui, NAME, ("felt", ""), |ui, _| {
        toggles(ui, &mut draft.relief_of, &choices);
    });
    row_of(ui, NAME, ("method", ""), |ui, _| {
        let methods = Method::ALL.map(|method| {
            let label = match method {
                Method::TsaiShah => "Tsai & Shah, historical",
                Method::Linear => "linear, historical",
                Method::Variational | Method::DarkIsDeep => method.label(),
            };
            (method, label)
        });
        let usual = "by evidence";
        choose_of(
            ui,
            "How heights are found",
            &mut draft.method,
            (&methods, usual, Need::Optional),
        );
    });
}

/// How well the heights fit the brightness, and how far the method can be trusted.
fn show_trust(ui: &mut Ui, shaped: &Relief) {
    if let Some(residual) = shaped.shape.residuals.last() {
        let n = shaped.shape.n_iterations();
        let residual = quantity::fixed(*residual, 4);
        note(
            ui,
            &format!("residual {residual} after {n} iterations"),
            Tone::Quiet,
        );
    }
    let more = shaped
        .estimate
        .as_ref()
        .map_or("", |estimate| &estimate.words);
    let words = format!("{} {more}", shaped.shape.reliability);
    paragraph(ui, quiet(words.trim()));
}
