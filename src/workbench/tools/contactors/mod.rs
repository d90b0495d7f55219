//! Both bands of every contactor as two heatmaps on one scale, with its colour bar.

pub(crate) mod contrast;
pub(crate) mod export;

use eframe::egui::{
    self, Align2, Painter, Pos2, Rect, Response, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2,
    vec2,
};

use crate::bench::Bench;
use crate::bench::command::{Command, Commands, Part, ShowCommand};
use crate::bench::export::Exported;
use crate::bench::export::NOTHING_FELT;
use crate::bench::on_finger::{OnFinger, is_muted, sentence_lines};
use crate::bench::pane::Pane;
use crate::bench::perceptual_level::PerceptualLevel;
use crate::bench::tool::{PaneContext, Tool};
use crate::bench::view::{Dot, EngineView, SceneView};
use crate::kit::amplitude::AmplitudeScale;
use crate::kit::pane::framed;
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::theme::colour_map::ColourMap;
use crate::kit::widgets::bar::amplitude_bar;
use crate::kit::widgets::cells::{GAP, NUMBER_WIDTH, Places, TITLE};
use crate::kit::widgets::limit_mark::{LIMIT_MARK, limit_words, limits_band, paint_limit_mark};
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// How the heatmaps are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct HeatmapStyle {
    /// The colours.
    pub map: ColourMap,
    /// The scale.
    pub scale: AmplitudeScale,
    /// Whether numbers are written into the cells.
    pub(crate) has_numbers: bool,
    /// Whether cells below the threshold of detection are hollow and grey.
    pub(crate) greys_below: bool,
    /// The contactor that is looked at closer.
    pub selected: usize,
    /// The ends of what both bands show in this frame, µm, where the contrast is the frame's own.
    pub(crate) own_ends_um: Option<[[f64; 2]; 2]>,
}

impl HeatmapStyle {
    fn of(bench: &Bench) -> Self {
        Self {
            map: bench.settings.preferences.colour_map,
            scale: bench.selection.scale,
            has_numbers: bench.settings.preferences.has_numbers,
            greys_below: bench.selection.greys_below,
            selected: bench.selection.contactor.unwrap_or(usize::MAX),
            own_ends_um: None,
        }
    }

    /// Where an amplitude stands on the colours, 0…1.
    fn share(&self, band: Band, amplitude_um: f64) -> f64 {
        let Some([least_um, most_um]) = self.own_ends_um.map(|ends| ends[band.index()]) else {
            return self.scale.share(amplitude_um);
        };
        if most_um > least_um {
            (amplitude_um - least_um) / (most_um - least_um)
        } else {
            0.5
        }
    }
}

/// The least and the largest amplitude of each band on cloth, µm; `None` where nothing is.
fn ends_um(live: &EngineView) -> Option<[[f64; 2]; 2]> {
    let on_cloth = || live.dots.iter().filter(|dot| dot.cloth.is_some());
    on_cloth().next()?;
    Some([0, 1].map(|band| {
        let um = on_cloth().map(|dot| dot.amplitude_um[band]);
        um.fold([f64::INFINITY, 0.0], |[least, most], um| {
            [least.min(um), most.max(um)]
        })
    }))
}

/// The heatmaps, which show what all tools share.
#[derive(Debug, Default)]
pub(crate) struct Contactors {
    /// Whether each frame is shown in its own contrast, so that the pattern inside a textile is
    /// seen.
    is_own_contrast: bool,
}

impl Tool for Contactors {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Heatmaps]
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        let mut style = HeatmapStyle::of(context.bench);
        let is_own = self.is_own_contrast;
        style.own_ends_um = is_own.then(|| ends_um(&context.bench.live)).flatten();
        framed(ui, 10, |ui| show(ui, style, context));
    }

    fn corner(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        self.show_corner(ui, context);
    }

    fn command(&mut self, command: &Command, bench: &mut Bench) {
        if let Command::Show(ShowCommand::ToggleNumbers) = command {
            let has_numbers = &mut bench.settings.preferences.has_numbers;
            *has_numbers = !*has_numbers;
        }
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        let live = &bench.live;
        if live.dots.iter().all(|dot| dot.cloth.is_none()) {
            return Err(NOTHING_FELT);
        }
        let scene = bench.plain_scene_view();
        let grid = scene.grid.ok_or(
            "The contactors of this display form no grid: `selvedge render` writes them as a table",
        )?;
        let (style, origin) = (HeatmapStyle::of(bench), bench.origin());
        Ok(export::heatmaps(&scene, live, style, grid, origin))
    }
}

/// Shows both heatmaps and the colour bar.
fn show(ui: &mut Ui, style: HeatmapStyle, context: &mut PaneContext<'_>) {
    let palette = Palette::in_ui(ui);
    let (scene, live) = (context.scene, &context.bench.live);
    let Some(grid) = scene.grid else {
        ui.label("The contactors of this display form no grid: the workspace shows them");
        return;
    };
    let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click());
    response.widget_info(|| {
        let [least, most] = [style.scale.least_um(), style.scale.most_um()];
        let below = if style.greys_below {
            below_words(live)
        } else {
            String::new()
        };
        let on_finger = live
            .on_finger
            .label()
            .map_or_else(String::new, |label| format!(", {label}"));
        let words = format!("Heatmaps of both bands, {least} to {most} µm{on_finger}{below}");
        WidgetInfo::labeled(egui::Role::Canvas, true, words)
    });
    let places = Places::new(rect, grid);
    let painter = ui.painter_at(rect.expand(2.0));
    for band in Band::ALL {
        let corner = places.corners[band.index()];
        paint_title(&painter, corner, (band, band_on_finger(live, band)));
        for (index, dot) in live.dots.iter().enumerate() {
            let rect = places.cell(band.index(), index);
            let is_below = live.perceptual_level.is_below(dot.amplitude_um)[band.index()];
            let is_grey = style.greys_below && is_below;
            paint_cell(&painter, rect, (dot, band), is_grey, style);
        }
    }
    let pointed = scene.marks.hovered.contactor.unwrap_or(usize::MAX);
    for (marked, strength) in [(pointed, 0.6), (style.selected, 1.0)] {
        if marked < live.dots.len() {
            let edge = Stroke::new(1.5, palette.selection.gamma_multiply(strength));
            for band in 0..2 {
                let cell = places.cell(band, marked).expand(1.0);
                painter.rect_stroke(cell, 3, edge, StrokeKind::Inside);
            }
        }
    }
    let right = places.corners[1].x + grid.1 as f32 * places.cell.x + 10.0;
    let height = grid.0 as f32 * places.cell.y - GAP;
    let bar = Rect::from_min_size(pos2(right, places.corners[1].y), vec2(8.0, height));
    match style.own_ends_um {
        Some(ends_um) => contrast::paint_own_bar(&painter, bar, style.map, ends_um),
        None => amplitude_bar(&painter, bar, style.map, style.scale),
    }
    answer(&response, &places, (scene, live), context.commands);
}

/// What the finger gets of a band: where all contactors fare alike in it, what they do.
fn band_on_finger(live: &EngineView, band: Band) -> OnFinger {
    let mut dots = live.dots.iter().map(|dot| dot.on_finger[band.index()]);
    let is_muted = !live.dots.is_empty() && dots.all(|one| one == OnFinger::Muted);
    if is_muted {
        OnFinger::Muted
    } else {
        live.on_finger
    }
}

/// Writes a band's name above its heatmap, and why the finger gets nothing of it, if so.
fn paint_title(painter: &Painter, corner: Pos2, (band, on_finger): (Band, OnFinger)) {
    let palette = Palette::of(painter.ctx().theme());
    let title = format!("{} Hz", quantity::fixed(band.carrier_hz(), 0));
    let at = corner - vec2(0.0, 0.5 * TITLE + 1.0);
    let ink = palette.band(band);
    let name = painter.text(at, Align2::LEFT_CENTER, title, theme::body(), ink);
    if let Some(label) = on_finger.label() {
        let at = pos2(name.right() + 6.0, at.y + 1.0);
        painter.text(at, Align2::LEFT_CENTER, label, theme::small(), palette.dim);
    }
}

/// How many contactors on cloth are too weak to be felt in each band.
fn below_words(live: &EngineView) -> String {
    let on_cloth = || live.dots.iter().filter(|dot| dot.cloth.is_some());
    let [low, high] = Band::ALL.map(|band| {
        let is_below = |dot: &&Dot| live.perceptual_level.is_below(dot.amplitude_um)[band.index()];
        on_cloth().filter(is_below).count()
    });
    let n = on_cloth().count();
    format!(", of {n} on cloth {low} at 40 Hz and {high} at 320 Hz below threshold, by a model")
}

fn paint_cell(
    painter: &Painter,
    rect: Rect,
    (dot, band): (&Dot, Band),
    is_grey: bool,
    style: HeatmapStyle,
) {
    let palette = Palette::of(painter.ctx().theme());
    let on_finger = dot.on_finger[band.index()];
    let is_muted = on_finger == OnFinger::Muted;
    if dot.cloth.is_none() || is_muted {
        // Off every textile: an empty frame, which no amplitude looks like. Muted: crossed out.
        let edge = Stroke::new(1.0, palette.hovered);
        painter.rect_stroke(rect, 2, edge, StrokeKind::Inside);
        if is_muted {
            let stroke = Stroke::new(1.0, palette.line);
            painter.line_segment([rect.left_bottom(), rect.right_top()], stroke);
        }
        return;
    }
    let amplitude_um = dot.amplitude_um[band.index()];
    let share = style.share(band, amplitude_um);
    let colour = style.map.colour(share).gamma_multiply(on_finger.presence());
    if is_grey {
        // Hollow: the colour of its level is left at the edge.
        painter.rect_filled(rect, 2, palette.raised);
        let edge = Stroke::new(1.5, colour);
        painter.rect_stroke(rect, 2, edge, StrokeKind::Inside);
    } else {
        painter.rect_filled(rect, 2, colour);
    }
    if limits_band(dot.limiter, band.index()) && rect.width() >= 2.0 * LIMIT_MARK {
        paint_limit_mark(painter, rect.right_top() + vec2(-6.0, 6.0));
    }
    if style.has_numbers && rect.width() >= NUMBER_WIDTH {
        let digits = digits(amplitude_um);
        let ink = if is_grey {
            palette.dim
        } else {
            style.map.ink(share)
        };
        let font = theme::small_number();
        painter.text(rect.center(), Align2::CENTER_CENTER, digits, font, ink);
    }
}

/// An amplitude in µm as cells show it: three signs fit into the narrowest that holds numbers.
pub(crate) fn digits(amplitude_um: f64) -> String {
    let decimals = usize::from(amplitude_um < 9.95);
    quantity::fixed(amplitude_um, decimals)
}

/// Says what is under the pointer, and takes clicks on it.
fn answer(
    response: &Response,
    places: &Places,
    (scene, live): (&SceneView, &EngineView),
    commands: &mut Commands,
) {
    let at = response
        .hover_pos()
        .or_else(|| response.interact_pointer_pos());
    let hit = at.and_then(|at| places.at(at, live.dots.len()));
    if let (Some((_, index)), true) = (hit, response.clicked()) {
        commands.push(ShowCommand::SelectContactor(index).into());
    }
    if let (Some((_, index)), true) = (hit, response.secondary_clicked()) {
        response
            .ctx
            .data_mut(|data| data.insert_temp(response.id, index));
    }
    let chosen: Option<usize> = response.ctx.data(|data| data.get_temp(response.id));
    response.context_menu(|ui| {
        if let Some(index) = chosen {
            show_menu(ui, index, live, commands);
        }
    });
    let Some((index, dot)) = hit.and_then(|(_, i)| live.dots.get(i).map(|dot| (i, dot))) else {
        return;
    };
    if response.hovered() {
        commands.push(ShowCommand::Hover(Part::Contactor(index)).into());
    }
    if response.hovered() && !response.context_menu_opened() {
        let words = words(index, dot, scene, &live.perceptual_level);
        response.clone().on_hover_ui_at_pointer(|ui| {
            ui.label(words);
        });
    }
}

fn show_menu(ui: &mut Ui, index: usize, live: &EngineView, commands: &mut Commands) {
    ui.label(format!("Contactor {index}"));
    let part = Part::Contactor(index);
    let is_left_out = live
        .dots
        .get(index)
        .is_some_and(|dot| is_muted(dot.on_finger));
    let mute = if is_left_out {
        "Mute or unmute"
    } else {
        "Mute"
    };
    let choices = [
        (mute, ShowCommand::Mute(part)),
        (
            "Feel alone, or with the others again",
            ShowCommand::Solo(part),
        ),
        ("Feel everything", ShowCommand::HearAll),
        ("Look closer", ShowCommand::SelectContactor(index)),
    ];
    for (label, command) in choices {
        if ui.button(label).clicked() {
            commands.push(command.into());
            ui.close();
        }
    }
}

fn words(index: usize, dot: &Dot, scene: &SceneView, perceptual_level: &PerceptualLevel) -> String {
    let on = match dot.cloth.and_then(|cloth| scene.cloths.get(cloth)) {
        Some(cloth) => format!("on {} {}", cloth.label, cloth.name),
        None => "off every textile".to_owned(),
    };
    let bands = perceptual_level.band_lines(dot.amplitude_um);
    let limited = limit_words(dot.limiter).map_or_else(String::new, |words| format!("\n{words}"));
    let on_finger = sentence_lines(dot.on_finger);
    format!(
        "Contactor {index}, {on}\n{bands}\npeak, after gains, before output \
         limits{limited}{on_finger}\nclick to look closer"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frames_own_contrast_spreads_each_band_over_all_colours() {
        let dot = |cloth, amplitude_um| Dot {
            cloth,
            amplitude_um,
            ..Dot::default()
        };
        let on = Some(0);
        let dots = vec![
            dot(on, [4.0, 1.0]),
            dot(None, [0.0; 2]),
            dot(on, [5.0, 1.0]),
        ];
        let live = EngineView {
            dots,
            ..EngineView::default()
        };
        assert_eq!(
            ends_um(&live),
            Some([[4.0, 5.0], [1.0, 1.0]]),
            "on cloth alone"
        );
        let style = HeatmapStyle {
            map: ColourMap::default(),
            scale: AmplitudeScale::default(),
            has_numbers: false,
            greys_below: false,
            selected: 0,
            own_ends_um: ends_um(&live),
        };
        let low = [4.0, 4.5, 5.0].map(|um| style.share(Band::Low, um));
        assert_eq!(low, [0.0, 0.5, 1.0]);
        assert_eq!(style.share(Band::High, 1.0), 0.5, "all alike");
        assert_eq!(ends_um(&EngineView::default()), None);
    }
}
