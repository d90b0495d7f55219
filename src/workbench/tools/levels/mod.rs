//! Levels of the scene's textiles above threshold, what they are to be, and how far the library is
//! from clipping: as a matrix of numbers, and in the plane of both bands.
//!
//! Levels are means at 100 mm/s by the model of perception; what is dragged or typed becomes the
//! gain of the textile.

pub(crate) mod matrix;
pub(crate) mod plane;
pub(crate) mod proposal;
#[cfg(test)]
mod tests;

use eframe::egui::{Align, Label, Layout, Ui};

use crate::bench::Bench;
use crate::bench::command::edit::Edit;
use crate::bench::export::Exported;
use crate::bench::gain_set::{GainSet, band_gain_mut};
use crate::bench::pane::Pane;
use crate::bench::perceptual_level::{SOURCE, mean_um, noticed_db, tuned_factors};
use crate::bench::tool::{PaneContext, Tool};
use crate::bench::view::{Cloth, LibraryDot, SceneView};
use crate::kit::pane::framed;
use crate::kit::theme::STEP;
use crate::kit::widgets::scale::Scale;
use crate::kit::widgets::text::{button, line, paragraph, quiet, toggle};
use crate::tools::levels::proposal::{Change, Peaks, Row, propose};
use selvedge_foundation::quantity::{factor_of_gain, with_unit};
use selvedge_textile::tactile::{Band, Perception};

/// Height of a line, points.
const LINE: f32 = 24.0;

/// A textile of the scene with its levels.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Placed {
    /// Its place in the scene's list.
    pub(crate) index: usize,
    /// Its label and name.
    pub(crate) name: String,
    /// The scene's gain, dB.
    pub(crate) gain_db: f64,
    /// Levels, targets and what is loudest.
    pub(crate) row: Row,
    /// By band, from where to where its level may lie, dB from that, where it is not measured.
    pub(crate) known_db: Option<[[f64; 2]; 2]>,
}

impl Placed {
    /// The edit that moves its level by so much.
    pub(crate) fn moved(&self, by_db: f64) -> Edit {
        Edit::TextileGain(self.index, in_tenths(self.gain_db + by_db))
    }
}

/// A gain as sliders have it: within their ends, in tenths.
pub(crate) fn in_tenths(gain_db: f64) -> f64 {
    Scale::gain(0.0).stepped(gain_db)
}

/// Levels of the scene's textiles.
#[derive(Debug, Default)]
pub(crate) struct LevelBench {
    shows_plane: bool,
    /// Whether the proposal is shown beside what is in force.
    is_proposing: bool,
}

impl Tool for LevelBench {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Levels]
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        framed(ui, 10, |ui| self.show(ui, context));
    }

    fn corner(&mut self, _pane: Pane, ui: &mut Ui, _context: &mut PaneContext<'_>) {
        let tip = "Both bands as a plane: drag a textile in it";
        if toggle(ui, "plane", self.shows_plane, tip) {
            self.shows_plane = !self.shows_plane;
            ui.ctx().request_repaint();
        }
    }

    fn leave_scene(&mut self, _bench: &mut Bench) {
        self.is_proposing = false;
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        bench.follow_library_levels();
        let scene = bench.plain_scene_view();
        let placed = placed(bench, &scene);
        if placed.is_empty() {
            return Err("There is nothing to export: no textile of the scene has a level yet");
        }
        let note = "Mean levels at 100 mm/s above the threshold of detection, by a model, with all \
                    gains.";
        let chart = plane::chart(&placed, None);
        let origin = bench.origin();
        Ok(Exported::of_chart(
            "Levels of the scene",
            chart,
            420.0,
            note,
            origin,
        ))
    }
}

impl LevelBench {
    fn show(&mut self, ui: &mut Ui, context: &mut PaneContext<'_>) {
        let placed = placed(context.bench, context.scene);
        if placed.is_empty() {
            let words = "No textile of the scene has a level: place one from the library";
            ui.add(Label::new(quiet(words)).wrap());
            return;
        }
        let rows: Vec<Row> = placed.iter().map(|one| one.row.clone()).collect();
        let library = library(context);
        let is_other = |id: &str| context.scene.cloths.iter().all(|cloth| cloth.id != id);
        let others = library.iter().filter(|(dot, _)| is_other(&dot.id));
        let change = propose(&rows, others.map(|(_, peaks)| peaks));
        let is_change = change
            != Change {
                own_db: vec![0.0; rows.len()],
                ..Change::default()
            };
        self.is_proposing &= is_change;
        line(ui, LINE, |ui| {
            show_headroom(ui, &library);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let none = "Nothing clips and every level is where it is wanted, as far as \
                            anybody would notice";
                let refusal = (!is_change).then_some(none);
                let tip = "The smallest change that ends clipping and brings the textiles to \
                           their targets, or without any to one level: shown before it is taken";
                if !self.is_proposing && button(ui, "Propose", tip, refusal) {
                    self.is_proposing = true;
                }
            });
        });
        let shown = self.is_proposing.then_some(&change);
        if let Some(change) = shown {
            let taken = show_proposal(ui, context, change);
            self.is_proposing &= !taken;
        }
        if self.shows_plane {
            plane::show(ui, &placed, shown, context);
        } else {
            matrix::show(ui, &placed, shown, context);
        }
    }
}

/// What a proposal comes to, to be taken or left; says whether either was done.
fn show_proposal(ui: &mut Ui, context: &mut PaneContext<'_>, change: &Change) -> bool {
    let before = context.bench.gain_set();
    let after = changed(&before, change);
    let names = context.scene.titles();
    let words = before.differences(&after, &names).join(", ");
    paragraph(ui, quiet(words));
    let mut is_done = false;
    line(ui, LINE, |ui| {
        ui.spacing_mut().item_spacing.x = STEP;
        if button(ui, "Take", "Put it into force, as one step of undo", None) {
            context.commands.push(Edit::Gains(after.clone()).into());
            is_done = true;
        }
        is_done |= button(ui, "Leave", "Stay with the gains in force", None);
    });
    is_done
}

/// Gains after a change; `change` has a part for every textile that has a level, by its place in
/// the scene.
fn changed(before: &GainSet, change: &Change) -> GainSet {
    let mut after = before.clone();
    after.tuning.gain_db += change.master_db;
    for band in Band::ALL {
        *band_gain_mut(&mut after.tuning, band) += change.band_db[band.index()];
    }
    for (gain_db, by_db) in after.gains_db.iter_mut().zip(&change.own_db) {
        *gain_db += by_db;
    }
    after
}

/// The textiles of the scene, those without a level silent.
fn placed(bench: &Bench, scene: &SceneView) -> Vec<Placed> {
    let n_contactors = bench.n_contactors();
    let of_scene = &bench.document.scene().textiles;
    let all = scene.cloths.iter().zip(of_scene).enumerate();
    let placed: Vec<Placed> = all
        .map(|(index, (cloth, placed))| {
            let um = mean_um(scene, index, (&scene.tuning, cloth.gain_db)).unwrap_or_default();
            let felt = Perception::of(um, n_contactors);
            Placed {
                index,
                name: cloth.title(),
                gain_db: cloth.gain_db,
                known_db: bench
                    .engine_scene
                    .uncertainty(index)
                    .map(|known| Band::ALL.map(|band| known.mean_level_db(band))),
                row: Row {
                    level_db: felt.perceptual_level_db,
                    target_db: Band::ALL.map(|band| placed.target_db_sl(band)),
                    noticed_db: noticed_db(&felt, None).unwrap_or(0.0),
                    peaks: peaks(bench, scene, &cloth.id, own_gains_db(cloth)),
                },
            }
        })
        .collect();
    let has_level = placed
        .iter()
        .any(|one| one.row.level_db.iter().any(|db| db.is_finite()));
    if has_level { placed } else { Vec::new() }
}

/// What the scene gives a textile, by band, dB.
fn own_gains_db(cloth: &Cloth) -> [f64; 2] {
    cloth.band_gains_db.map(|band_db| cloth.gain_db + band_db)
}

/// The loudest amplitudes of a textile of the library with the tuning in force and gains of the
/// scene, by band.
fn peaks(bench: &Bench, scene: &SceneView, id: &str, gains_db: [f64; 2]) -> Peaks {
    let profile = bench.engine.profile();
    let [full, limit] = [profile.full_scale_um, profile.limit_um];
    let limits = [0, 1].map(|band| (limit[band] / full[band]).min(1.0));
    let levels = &bench.library.levels;
    let dot = scene.library.iter().find(|dot| dot.id == id);
    let (Some(loudest), Some(dot)) = (levels.loudest_um(id, &scene.filters), dot) else {
        return Peaks::default();
    };
    let factors = tuned_factors(scene, dot, (&scene.tuning, 0.0));
    let own = gains_db.map(factor_of_gain);
    let share =
        |pair: &[f64; 2]| [0, 1].map(|band| factors[band] * own[band] * pair[band] / full[band]);
    Peaks {
        shares: loudest.iter().map(share).collect(),
        limits,
    }
}

/// The textiles of the library and how loud they become, by the scene's gains.
fn library<'a>(context: &PaneContext<'a>) -> Vec<(&'a LibraryDot, Peaks)> {
    let scene = context.scene;
    let gain_of = |id: &str| {
        let placed = scene.cloths.iter().filter(|cloth| cloth.id == id);
        let gains_db: Vec<[f64; 2]> = placed.map(own_gains_db).collect();
        [0, 1].map(|band| {
            let of_band = gains_db.iter().map(|own| own[band]);
            let most_db = of_band.fold(f64::NEG_INFINITY, f64::max);
            if most_db.is_finite() { most_db } else { 0.0 }
        })
    };
    let with_peaks =
        |dot: &'a LibraryDot| (dot, peaks(context.bench, scene, &dot.id, gain_of(&dot.id)));
    scene.library.iter().map(with_peaks).collect()
}

/// How far the loudest textile of the library is from clipping.
fn show_headroom(ui: &mut Ui, library: &[(&LibraryDot, Peaks)]) {
    let of_library = library.iter();
    let of_library =
        of_library.filter_map(|(dot, peaks)| Some((peaks.headroom_db([0.0; 2])?, &dot.name)));
    let least = of_library.min_by(|one, other| one.0.total_cmp(&other.0));
    let words = match least {
        None => "Headroom –".to_owned(),
        Some((db, _)) if db < 0.0 => format!("Clips by {}", with_unit(-db, 1, "dB")),
        Some((db, _)) => format!("Headroom {}", with_unit(db, 1, "dB")),
    };
    let first = least.map_or_else(
        || "Being measured".to_owned(),
        |(_, name)| format!("{name} is the loudest of the library’s {}", library.len()),
    );
    ui.label(words).on_hover_text(format!(
        "{first}: at its loudest place, in any of the four directions, from 25 to 400 mm/s along \
         one axis, against what the array may play of both bands together\n{SOURCE}"
    ));
}
