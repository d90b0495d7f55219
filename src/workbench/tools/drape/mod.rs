//! A hanging cloth under two fingers: touched by pointer or keys, or by hands that were recorded.
//!
//! ```text
//! scene, textiles, figures ─▶ Chosen ─┐                     ┌▶ paint (3-D), chart ─▶ view, export
//! pointer, keys ─▶ grasp ─▶ Lead ─────┴▶ stepper (background) ┴▶ motion: the last seconds
//! ```
//!
//! Nothing is stepped before the pane is looked at, nor while everything rests.

mod camera;
mod chart;
mod controls;
mod felt_rows;
mod grasp;
mod hand;
mod hung;
mod look;
mod motion;
mod paint;
mod stepper;
#[cfg(test)]
mod tests;
mod through;
mod touch;
mod view;

use std::path::PathBuf;
use std::sync::Arc;

use eframe::egui::Ui;

use crate::bench::Bench;
use crate::bench::command::{Command, FileCommand, Purpose, ShowCommand};
use crate::bench::export::{Exported, Origin, row};
use crate::bench::history::{History, Moment, StepList};
use crate::bench::library_shelf::plain_id;
use crate::bench::pane::Pane;
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::pane::framed;
use crate::tools::drape::chart::Seconds;
use crate::tools::drape::hand::Hands;
use crate::tools::drape::hung::{Base, Chosen, ClothChoice, OtherTextile, Second};
use crate::tools::drape::look::Look;
use crate::tools::drape::motion::Motion;
use crate::tools::drape::through::ThroughDevice;
use selvedge_drape::DrapeScene;

/// Most cloths side by side.
pub(crate) const MAX_CLOTHS: usize = 5;
/// Height of a row of charts in a file, pixels.
const CHART_PX: f64 = 200.0;
/// Why there is nothing to export.
const NOTHING: &str = "There is nothing to export yet: touch the cloth in the Drape pane";

/// The tool.
#[derive(Default)]
pub(crate) struct Draping {
    pub(crate) chosen: Chosen,
    pub(crate) look: Look,
    pub(crate) hands: Hands,
    pub(crate) motion: Motion,
    pub(crate) through: ThroughDevice,
    history: History<Chosen, &'static str>,
    /// What the user had chosen, while a session hangs its own.
    put_by: Option<Chosen>,
    /// What was asked for last.
    wanted: Arc<Chosen>,
}

impl Draping {
    /// Changes what is chosen, as a step.
    pub(crate) fn change(&mut self, moment: Moment, change: impl FnOnce(&mut Self)) {
        let before = self.chosen.clone();
        change(self);
        if self.chosen != before {
            let step = self.chosen.step_from(&before);
            self.history.begin(&before, step, step, moment);
            self.look.cloth = self.look.cloth.min(self.chosen.cloths.len() - 1);
        }
    }

    /// Hangs another scene's cloth in place of all.
    pub(crate) fn hang(&mut self, base: Base) {
        // What cannot be read is told where it is hung.
        if let Base::File(path) = &base
            && DrapeScene::read(path).is_ok_and(|scene| scene.has_second_device())
        {
            self.chosen.second = Second::Device;
        }
        self.chosen.base = base;
        self.chosen.cloths = vec![ClothChoice::default()];
        self.look = Look {
            camera: self.look.camera,
            shows_strain: self.look.shows_strain,
            ..Look::default()
        };
        self.hands = Hands::default();
    }

    /// Lets the scene go on: to be called while the pane is in sight.
    fn follow(&mut self, bench: &mut Bench) {
        if *self.wanted != self.chosen {
            self.wanted = Arc::new(self.chosen.clone());
        }
        self.hands.take_read(bench);
        self.take_answers();
        if self.look.looked_at_s.is_some() {
            return;
        }
        let second = (self.chosen.second, self.device_mm(bench));
        let lead = self.hands.lead(&self.motion, second, &bench.ctx);
        self.motion.follow(bench, &self.wanted, lead);
        self.take_answers();
    }

    /// Where the second display is on the cloth, mm, if the second finger goes with it: cloth and
    /// workspace have one middle.
    fn device_mm(&self, bench: &mut Bench) -> Option<[f64; 2]> {
        if self.chosen.second != Second::Device {
            return None;
        }
        let middle_mm = bench.document.scene().size_mm.map(|mm| 0.5 * mm);
        let cloth_mm = self.motion.facts.cloths.first()?.scene.size_mm();
        let at = bench.engine.snapshot().displays.get(1)?.pose.position;
        let off_mm = [at.x_mm - middle_mm[0], at.y_mm - middle_mm[1]];
        Some([0, 1].map(|axis| 0.5 * cloth_mm[axis] + off_mm[axis]))
    }

    /// Hangs what a session presents, and afterwards what hung before.
    fn follow_session(&mut self, bench: &Bench) {
        let hung = bench.hung().map(|hung| Chosen {
            cloths: vec![ClothChoice {
                textile: Some(OtherTextile {
                    key: hung.id.clone(),
                    name: String::new(),
                    id: hung.id.clone(),
                    library: hung.library.clone(),
                }),
                changes: Vec::new(),
            }],
            ..Chosen::default()
        });
        let next = match hung {
            Some(hung) => Some(hung),
            None if bench.has_session() => None,
            None => self.put_by.take(),
        };
        let Some(next) = next.filter(|next| *next != self.chosen) else {
            return;
        };
        let before = std::mem::replace(&mut self.chosen, next);
        if bench.has_session() {
            self.put_by.get_or_insert(before);
        }
        self.look = Look::default();
        self.hands = Hands::default();
        self.motion.restart();
    }

    /// Lets the engine feel the chosen cloth, if that is switched on.
    fn feel(&mut self, bench: &mut Bench) {
        let at = self.look.cloth;
        let frame = self.motion.frame_at(None);
        let frame = frame.filter(|_| self.look.looked_at_s.is_none());
        let cloth = frame.and_then(|frame| Some((frame.t_s, frame.cloths.get(at)?)));
        let facts = self.motion.facts.cloths.get(at);
        let title = facts.map_or("", |facts| facts.title.as_str());
        let cloth = cloth.map(|(t_s, cloth)| (t_s, title, cloth));
        self.through.follow(cloth, bench);
    }

    /// Takes what has come of the motion.
    fn take_answers(&mut self) {
        self.motion.poll();
        self.hands.meet(&self.motion, self.chosen.second);
    }

    /// A textile of a library as it is hung.
    pub(crate) fn textile(bench: &Bench, key: &str) -> OtherTextile {
        let view = &bench.library.view;
        let library = &view.shelf_of(key).library;
        let name = view.item(key).map(|item| item.name.clone());
        OtherTextile {
            key: key.to_owned(),
            name: name.unwrap_or_else(|| key.to_owned()),
            id: plain_id(key).to_owned(),
            library: (!library.is_shipped()).then(|| library.root()),
        }
    }

    /// The last seconds, to be drawn.
    pub(crate) fn seconds(&self) -> Seconds<'_> {
        let facts = &self.motion.facts;
        let titles = facts.cloths.iter().map(|cloth| cloth.title.as_str());
        Seconds {
            samples: &self.motion.samples,
            frames: &self.motion.frames,
            titles: titles.collect(),
            n_fingers: facts.hands.len(),
            looked_at_s: self.look.looked_at_s,
        }
    }

    fn origin(&self) -> Origin {
        let program = selvedge_foundation::PROGRAM;
        let file = self.chosen.base.name();
        let origin = Origin::default()
            .and("program", program, program)
            .and("file", &file, &file);
        let cloths = self.motion.facts.cloths.iter();
        cloths.fold(origin, |origin, cloth| {
            let words = format!("{}, {}", cloth.title, cloth.stepping);
            origin.and("cloth", &words, &words)
        })
    }
}

impl Tool for Draping {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Drape]
    }

    fn logic(&mut self, bench: &mut Bench) {
        self.follow_session(bench);
        if self.motion.is_under_way() {
            self.take_answers();
        }
        self.feel(bench);
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        self.follow(context.bench);
        let moment = context.bench.pointer.moment;
        framed(ui, 10, |ui| {
            self.change(moment, |draping| view::show(ui, draping, context));
        });
    }

    fn command(&mut self, command: &Command, bench: &mut Bench) {
        let Command::File(FileCommand::Use(purpose, path)) = command else {
            return;
        };
        match purpose {
            Purpose::OpenDrape => self.change(bench.pointer.moment, |draping| {
                draping.hang(Base::File(path.clone()));
            }),
            Purpose::OpenHands => self.hands.read(path, &self.motion.facts, bench),
            Purpose::SaveHands => return self.hands.save(path, bench),
            _ => return,
        }
        bench.commands.push(ShowCommand::Reveal(Pane::Drape).into());
    }

    fn steps(&self, _bench: &Bench) -> Option<StepList> {
        Some(self.history.steps(&self.chosen))
    }

    fn step_to(&mut self, n_done: usize, _bench: &mut Bench) {
        self.history.step_to(n_done, &mut self.chosen);
        self.look.cloth = self.look.cloth.min(self.chosen.cloths.len() - 1);
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        if bench.has_session() {
            return Err("A session hangs this cloth: what it is stays covered");
        }
        let seconds = self.seconds();
        let sheet = seconds.columns();
        if sheet.n_rows() == 0 {
            return Err(NOTHING);
        }
        let charts = seconds.charts().into_iter();
        let rows = charts.map(|chart| row(chart, CHART_PX));
        let note = "A simulated cloth; forces on the hand, energy of cloth and fingers. Broken \
                    lines: the second finger.";
        let title = "Hanging cloth under two fingers".to_owned();
        let (rows, origin) = (rows.collect(), self.origin());
        Ok(Exported::new(title, sheet, rows, note, origin))
    }

    fn known_path(&self, purpose: Purpose) -> Option<PathBuf> {
        match (&self.chosen.base, purpose) {
            (Base::File(path), Purpose::OpenDrape) => Some(path.clone()),
            (_, Purpose::OpenHands | Purpose::SaveHands) => self.hands.file.clone(),
            _ => None,
        }
    }
}
