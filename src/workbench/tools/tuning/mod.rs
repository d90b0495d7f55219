//! Gains, compression and what it does to the library, and the filters in force.

pub(crate) mod curve;
pub(crate) mod slots;

use eframe::egui::{self, ComboBox, Rect, RichText, Sense, Ui, UiBuilder, pos2, vec2};

use crate::bench::Bench;
use crate::bench::command::edit::Edit;
use crate::bench::command::{Commands, Part, ShowCommand};
use crate::bench::export::Exported;
use crate::bench::mute_solo::MuteSolo;
use crate::bench::pane::Pane;
use crate::bench::perceptual_level::{SOURCE, above_words, felt_words, noticed_db, of_textile};
use crate::bench::tool::{PaneContext, Tool};
use crate::bench::view::SceneView;
use crate::kit::pane::{inside, scrolled};
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::scale::{Curve, Scale};
use crate::kit::widgets::slider::{slider_row, tell};
use crate::kit::widgets::text::{row, toggle};
use crate::tools::tuning::slots::Slots;
use selvedge_foundation::quantity;
use selvedge_textile::tactile::{self, Band, Filters, Perception};

/// What every slider can do.
const SLIDER_TIP: &str = "Double click goes back, Shift moves finely, Ctrl+wheel by what is just \
                          noticed, a click on the number types";
/// How opaque figures of the library are that are of the filters before.
const STALE: f32 = 0.45;
/// A pane of this height shows list and curve below each other, points.
const HIGH: f32 = 292.0;
/// A lower one of this width shows them beside each other, points.
const WIDE: f32 = 480.0;
/// Bounds of the filters' width, octaves.
const OCTAVES: [f64; 2] = [0.5, 6.0];

/// Gains, compression and filters; what they are is the document's.
#[derive(Debug, Default)]
pub(crate) struct Tuning {
    /// How the textile felt that is under the display or was last, so that marks do not come and go
    /// while the display moves over gaps.
    last_felt: Option<Perception>,
    slots: Slots,
}

impl Tool for Tuning {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Tuning]
    }

    fn logic(&mut self, bench: &mut Bench) {
        self.slots.follow(bench);
    }

    fn leave_scene(&mut self, _bench: &mut Bench) {
        self.slots.leave_scene();
    }

    fn ui(&mut self, pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        let whole = ui.available_rect_before_wrap();
        let Some([list, beside]) = parts(whole) else {
            scrolled(ui, pane.title(), |ui| self.show(ui, context, true));
            return;
        };
        inside(ui, list, |ui| {
            scrolled(ui, pane.title(), |ui| self.show(ui, context, false));
        });
        show_curve(ui, beside, (context.scene, &mut *context.commands));
        ui.allocate_rect(whole, Sense::hover());
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        bench.follow_library_levels();
        let scene = bench.plain_scene_view();
        let is_there = !(scene.library.is_empty() || scene.library_is_stale);
        let reference_db = scene.reference_db.filter(|_| is_there);
        let reference_db = reference_db.ok_or(
            "There is nothing to export yet: levels are being computed, or the library has no \
             textile with a level",
        )?;
        Ok(curve::exported(&scene, reference_db, bench.origin()))
    }
}

impl Tuning {
    fn show(&mut self, ui: &mut Ui, context: &mut PaneContext<'_>, has_curve: bool) {
        self.slots.show(ui, context);
        let (scene, commands) = (context.scene, &mut *context.commands);
        let (live, mute_solo) = (&context.bench.live, &context.bench.selection.mute_solo);
        let palette = Palette::in_ui(ui);
        let (now, rest) = (scene.tuning, scene.default_tuning);
        let under = live.cloth_under_display();
        let display = (live.dots.len(), mute_solo);
        let felt = under.and_then(|cloth| of_textile(scene, cloth, display));
        self.last_felt = felt.or(self.last_felt);
        let marked = self.last_felt;
        let noticed = marked.and_then(|felt| noticed_db(&felt, None));
        let scale = Scale::gain(rest.gain_db).with_noticed(noticed);
        let (new, response) = slider_row(ui, "Master", palette.text, scale, now.gain_db);
        tell(&response, slider_tip(noticed));
        commands.extend(new.map(|db| Edit::MasterGain(db).into()));
        for band in Band::ALL {
            let noticed = marked.and_then(|felt| noticed_db(&felt, Some(band)));
            show_band(ui, band, noticed, (scene, mute_solo), commands);
        }
        show_textile(ui, scene, (under, noticed), commands);
        show_felt(ui, felt.as_ref());
        let scale = Scale::share(rest.compression);
        let (new, response) = slider_row(ui, "Compression", palette.text, scale, now.compression);
        let tip = "0 % leaves textiles as different as they are, 100 % makes all equal";
        tell(&response, tip);
        commands.extend(new.map(|share| Edit::Compression(share).into()));
        if has_curve {
            let size = vec2(ui.available_width(), curve::HEIGHT);
            let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
            show_curve(ui, rect, (scene, &mut *commands));
        }
        show_ranges(ui, scene);
        ui.add_space(theme::STEP);
        show_filters(ui, scene.filters, commands);
    }
}

/// Where the list and the curve stand in a pane that is too low for both below each other: beside
/// each other, or the curve below a list that scrolls.
fn parts(whole: Rect) -> Option<[Rect; 2]> {
    if whole.height() >= HIGH {
        return None;
    }
    let room = whole.shrink2(vec2(12.0, 8.0));
    if whole.width() >= WIDE {
        let left = whole.left() + (0.62 * whole.width()).round();
        let curve = Rect::from_min_max(pos2(left, room.top()), room.max);
        return Some([whole.with_max_x(left), curve]);
    }
    let top = (room.bottom() - curve::HEIGHT).max(room.center().y).round();
    Some([whole.with_max_y(top), room.with_min_y(top)])
}

/// Shows the curve; fainter while levels are being measured anew.
fn show_curve(ui: &mut Ui, rect: Rect, (scene, commands): (&SceneView, &mut Commands)) {
    inside(ui, rect, |ui| {
        if scene.library_is_stale {
            ui.multiply_opacity(STALE);
        }
        curve::show(ui, rect, scene, commands);
    });
}

/// A band's gain, with its mute and solo.
fn show_band(
    ui: &mut Ui,
    band: Band,
    noticed: Option<f64>,
    (scene, mute_solo): (&SceneView, &MuteSolo),
    commands: &mut Commands,
) {
    let palette = Palette::in_ui(ui);
    let name = format!("{} Hz", quantity::fixed(band.carrier_hz(), 0));
    let scale = Scale::gain(scene.default_tuning.own_band_gain_db(band)).with_noticed(noticed);
    let ink = palette.band(band);
    let value = scene.tuning.own_band_gain_db(band);
    let (new, response) = slider_row(ui, &name, ink, scale, value);
    commands.extend(new.map(|db| Edit::BandGain(band, db).into()));
    // Mute and solo stand between the name and the rail.
    let part = Part::Band(band);
    let middle = response.rect.left_center();
    let letters = [
        (
            "M",
            -42.0,
            mute_solo.is_muted(part),
            ShowCommand::Mute(part),
        ),
        ("S", -22.0, mute_solo.is_solo(part), ShowCommand::Solo(part)),
    ];
    for (letter, left, is_on, command) in letters {
        let corner = middle + vec2(left, -9.0);
        let rect = Rect::from_min_size(corner, vec2(18.0, 18.0));
        let label = match letter {
            "M" => format!("Mute {name}"),
            _ => format!("Feel {name} alone"),
        };
        let mut corner_ui = ui.new_child(UiBuilder::new().max_rect(rect));
        if toggle(&mut corner_ui, letter, is_on, &label) {
            commands.push(command.into());
        }
    }
    tell(&response, slider_tip(noticed));
}

/// What a gain's slider can do, and what its marks are.
fn slider_tip(noticed_db: Option<f64>) -> String {
    noticed_db.map_or_else(
        || SLIDER_TIP.to_owned(),
        |noticed_db| {
            let change = quantity::with_unit(noticed_db, 1, "dB");
            format!("{SLIDER_TIP}\nMarks: ±1, 2 … just noticeable differences of {change}, a model")
        },
    )
}

/// How the textile under the display feels on average; without one the row keeps its place.
fn show_felt(ui: &mut Ui, felt: Option<&Perception>) {
    let palette = Palette::in_ui(ui);
    let small = |words: &str| RichText::new(words).font(theme::small()).color(palette.dim);
    let response = row(ui, "Felt (model)", |ui| {
        ui.spacing_mut().item_spacing.x = theme::STEP;
        let Some(felt) = felt else {
            ui.label(small("no textile with a level"));
            return;
        };
        let balance = felt.balance().map_or_else(
            || "–".to_owned(),
            |balance| quantity::fixed(balance * 100.0, 0),
        );
        let number = |words: String| RichText::new(words).font(theme::number());
        ui.label(small("%"));
        ui.label(number(format!("{balance:>3}")));
        let intensity = quantity::fixed(felt.intensity(), 1);
        ui.label(number(format!("{intensity:>4}")));
        ui.label(small("int."));
        ui.label(small("dB SL"));
        for band in [Band::High, Band::Low] {
            let above_db = felt.perceptual_level_db[band.index()];
            let above_db = if above_db.is_finite() {
                quantity::fixed(above_db, 1)
            } else {
                "–".to_owned()
            };
            let words = number(format!("{above_db:>5}"));
            ui.label(words.color(palette.band(band)));
        }
    });
    let words = felt.map_or_else(String::new, |felt| {
        let [low, high] = felt.perceptual_level_db.map(above_words);
        format!("40 Hz  {low}\n320 Hz  {high}\n{}\n", felt_words(felt))
    });
    response.on_hover_text(format!(
        "The textile under the display, on average at 100 mm/s with these gains: levels above \
         threshold, intensity, share of the 320 Hz channel\n{words}{SOURCE}"
    ));
}

/// The gain of the textile under the display; without one the row keeps its place.
fn show_textile(
    ui: &mut Ui,
    scene: &SceneView,
    (under, noticed): (Option<usize>, Option<f64>),
    commands: &mut Commands,
) {
    let palette = Palette::in_ui(ui);
    let Some((index, cloth)) = under.and_then(|i| scene.cloths.get(i).map(|cloth| (i, cloth)))
    else {
        row(ui, "Textile", |ui| {
            ui.label(RichText::new("none under the display").color(palette.dim));
        });
        ui.add_space(theme::ROW - 20.0);
        return;
    };
    let name = format!("Textile {}", cloth.label);
    let scale = Scale::gain(0.0).with_noticed(noticed);
    let name = name.trim_end();
    let is_marked = scene.is_marked(index);
    let ground = ui.painter().add(egui::Shape::Noop);
    let row = ui
        .available_rect_before_wrap()
        .with_max_y(ui.cursor().top() + theme::ROW);
    let (new, response) = slider_row(ui, name, palette.text, scale, cloth.gain_db);
    if response.hovered() {
        commands.push(ShowCommand::Hover(Part::Cloth(index)).into());
    }
    if is_marked {
        let lit = egui::Shape::rect_filled(row.expand2(vec2(6.0, 0.0)), 4, palette.raised);
        ui.painter().set(ground, lit);
    }
    tell(
        &response,
        format!("Gain of {}\n{}", cloth.name, slider_tip(noticed)),
    );
    commands.extend(new.map(|db| Edit::TextileGain(index, db).into()));
}

fn show_ranges(ui: &mut Ui, scene: &SceneView) {
    let Some(reference_db) = scene.reference_db else {
        return;
    };
    let opacity = ui.opacity();
    if scene.library_is_stale {
        ui.multiply_opacity(STALE);
    }
    let plain = tactile::Tuning {
        compression: 0.0,
        ..scene.tuning
    };
    let before = curve::ranges_db(&scene.library, &plain, reference_db);
    let after = curve::ranges_db(&scene.library, &scene.tuning, reference_db);
    let response = row(ui, "Library range", |ui| {
        let palette = Palette::in_ui(ui);
        ui.spacing_mut().item_spacing.x = 2.0 * theme::STEP;
        ui.label(RichText::new("dB").font(theme::small()).color(palette.dim));
        for band in [Band::High, Band::Low] {
            let [from, to] = [before, after].map(|r| quantity::fixed(r[band.index()], 1));
            let words = RichText::new(format!("{from:>5} → {to:>4}"));
            ui.label(words.font(theme::number()).color(palette.band(band)));
        }
    });
    ui.set_opacity(opacity);
    let pending = if scene.library_is_stale {
        "\nBeing measured under the filters that were just chosen"
    } else {
        ""
    };
    response.on_hover_text(format!(
        "From the weakest to the strongest of the library’s {} textiles at 40 Hz and at 320 Hz, \
         mean over all points and directions at 100 mm/s: without compression → with it{pending}",
        scene.library.len()
    ));
}

/// Kind and width of the filters.
fn show_filters(ui: &mut Ui, filters: Filters, commands: &mut Commands) {
    let octaves = match filters {
        Filters::LogGaussian { octaves } => octaves,
        Filters::Receptor => 2.0,
    };
    let kinds = [Filters::LogGaussian { octaves }, Filters::Receptor];
    let is_gaussian = filters != Filters::Receptor;
    let mut chosen = filters;
    row(ui, "Filters", |ui| {
        let combo = ComboBox::from_id_salt("filters").selected_text(kind(filters));
        let response = combo.width(150.0).show_ui(ui, |ui| {
            for choice in kinds {
                ui.selectable_value(&mut chosen, choice, kind(choice));
            }
        });
        let label = "Kind of the filters";
        ui.ctx()
            .accesskit_node_builder(response.response.id, |node| node.set_label(label));
        response.response.on_hover_text(
            "How much of each frequency a band takes in. The original's filters are not published: \
             both kinds are ours",
        );
    });
    if chosen != filters {
        commands.push(Edit::Filters(chosen).into());
    }
    let scale = Scale {
        least: OCTAVES[0],
        most: OCTAVES[1],
        resting: 2.0,
        step: 0.1,
        decimals: 1,
        unit: "oct",
        factor: 1.0,
        noticed: None,
        curve: Curve::Even,
    };
    ui.add_enabled_ui(is_gaussian, |ui| {
        let ink = Palette::in_ui(ui).text;
        let (new, response) = slider_row(ui, "Width", ink, scale, octaves);
        if is_gaussian {
            tell(&response, "Width of both filters at half power");
            commands
                .extend(new.map(|octaves| Edit::Filters(Filters::LogGaussian { octaves }).into()));
        } else {
            response.on_disabled_hover_text("Receptor thresholds have the width that they have");
        }
    });
}

fn kind(filters: Filters) -> &'static str {
    match filters {
        Filters::LogGaussian { .. } => "log-Gaussian",
        Filters::Receptor => "receptor thresholds",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_low_pane_has_all_of_the_curve_beside_or_below_a_list_that_scrolls() {
        for (width, height) in [
            (512.0, 228.0),
            (480.0, 120.0),
            (316.0, 200.0),
            (316.0, 291.0),
        ] {
            let whole = Rect::from_min_size(pos2(10.0, 20.0), vec2(width, height));
            let [list, beside] = parts(whole).unwrap();
            let why = format!("{width} × {height}: {list} {beside}");
            assert!(
                whole.contains_rect(list) && whole.contains_rect(beside),
                "{why}"
            );
            assert!(
                beside.height() >= curve::HEIGHT && beside.width() >= 169.0,
                "{why}"
            );
            assert!(!list.shrink(0.5).intersects(beside), "{why}");
            assert!(list.width() >= 250.0 && list.height() >= 80.0, "{why}");
        }
        let high = Rect::from_min_size(pos2(0.0, 0.0), vec2(316.0, 306.0));
        assert_eq!(parts(high), None, "as they stand in a window of 1400 × 900");
    }
}
