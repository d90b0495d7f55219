//! The stage: the public face of the program. Four cloths to stroke, a question with four answers,
//! and a log of what visitors did.
//!
//! ```text
//! hand, keys ─▶ machine (watching, touching, guessing) ─▶ motion, tuning, sound ─▶ engine
//!                  │        └─▶ voltage: permission, a second of holding ─▶ arm, disarm
//!                  └─▶ visits that are over ─▶ records ─▶ disk
//! ```
//!
//! High voltage is never on by itself: see `voltage`. What notices would say stands on the
//! operator's page, behind a PIN.

mod act;
mod brush;
mod follow;
mod game;
mod ghost;
mod heartbeat;
mod input;
mod layout;
mod machine;
mod open_visit;
mod operator;
mod pace;
mod pictures;
mod pin;
mod records;
mod round;
mod shown;
#[cfg(test)]
mod tests;
mod view;
mod voltage;

use std::time::Duration;

use eframe::egui::{CursorIcon, Pos2, RawInput, Rect, Theme, Ui};

use crate::bench::Bench;
use crate::bench::clock::UNSEEN;
use crate::bench::command::{Command, DeviceCommand};
use crate::bench::stage::{StageOptions, StagePicture};
use crate::bench::tool::{PaneContext, PublicFace};
use crate::kit::pane::frame_as_armed;
use crate::kit::theme::Palette;
use crate::kit::view_transform::{Pointed, PointerGround, ViewTransform};
use act::{Act, Hand};
use brush::{Brush, Drawn};
use follow::Told;
use ghost::Ground;
use heartbeat::Heartbeat;
use input::{Heard, Senses};
use layout::Layout;
use machine::{Machine, Phase};
use operator::Wish;
use pace::Pace;
use pin::{Access, Lock};
use records::Records;
use selvedge_engine::SoundState;
use selvedge_experiment::visits::{N_CLOTHS, VisitEnd};
use voltage::Switch;

/// The stage in its window.
pub(crate) struct Stage {
    options: StageOptions,
    machine: Machine,
    records: Records,
    heartbeat: Heartbeat,
    pace: Pace,
    lock: Lock,
    senses: Senses,
    hand: Hand,
    /// Whether what is down came down on what is felt.
    is_down_on_ground: bool,
    /// Where it was when movement was counted last.
    counted_at: Option<Pos2>,
    /// The cloths: middles and half widths, mm.
    cloths: Vec<Ground>,
    told: Told,
    drawn: Drawn,
    may_close: bool,
    /// How far its clock is ahead of the bench's: in pictures, s.
    ahead_s: f64,
}

/// A sleeve that leans on a screen trembles by less, mm: that is no movement.
const TREMBLE_MM: f64 = 1.0;

impl Stage {
    /// The stage of a bench whose scene has four textiles.
    pub(crate) fn new(options: StageOptions, bench: &mut Bench) -> Self {
        let placed = &bench.document.scene().textiles;
        let ids = [0, 1, 2, 3].map(|nth| placed.get(nth).map_or(String::new(), |p| p.id.clone()));
        let cloths = bench.plain_scene_view().cloths;
        let ground = |cloth| (view::middle(cloth), 0.5 * cloth.size_mm[0]);
        let cloths = cloths.iter().take(N_CLOTHS).map(ground).collect();
        bench.device.ceiling = Some(options.ceiling());
        bench.selection.contactor = None;
        bench.past.is_paced = true;
        bench.settings.preferences.sound.is_on = true;
        bench.settings.preferences.stops_on_focus_loss = false;
        bench.ctx.set_theme(Theme::Dark);
        bench.ctx.set_zoom_factor(1.0);
        bench.ctx.options_mut(|all| all.zoom_with_keyboard = false);
        Self {
            machine: Machine::new(options.seed, ids),
            records: Records::in_folder(options.log.as_deref()),
            options,
            heartbeat: Heartbeat::of_process(),
            pace: Pace::default(),
            lock: Lock::default(),
            senses: Senses::default(),
            hand: Hand::default(),
            is_down_on_ground: false,
            counted_at: None,
            cloths,
            told: Told::default(),
            drawn: Drawn::default(),
            may_close: false,
            ahead_s: 0.0,
        }
    }

    /// Everything off; the screen goes on.
    fn stop(&mut self, bench: &mut Bench) {
        self.machine.act(Act::Stop, self.senses.input());
        self.is_down_on_ground = false;
        bench.commands.push(Command::AllOff);
        bench.commands.push(DeviceCommand::GoOn.into());
        // Silence holds a replay: the ghost begins anew.
        self.told.motion = None;
    }

    fn open_lock(&mut self, bench: &mut Bench) {
        self.stop(bench);
        self.lock.ask(self.machine.now_s());
    }

    fn layout(&self, whole: Rect) -> Layout {
        let is_large = self.machine.choices().is_large;
        Layout::of(whole, self.options.screen_width_mm(), is_large)
    }

    fn show_operator(&mut self, ui: &Ui, bench: &Bench) {
        let mut drawn = Drawn::default();
        let mut brush = Brush {
            painter: ui.painter().clone(),
            palette: Palette::in_ui(ui),
            layout: self.layout(ui.max_rect()),
            drawn: &mut drawn,
        };
        let told = [self.records.describe(), self.pace.describe()];
        let lines = operator::lines(bench, self.lock.access(), told, self.options.has_pin());
        let wishes = operator::show(ui, &mut brush, &self.lock, &lines, &self.machine);
        drawn.read_out(ui);
        self.drawn = drawn;
        let now_s = self.machine.now_s();
        for wish in wishes {
            self.lock.is_used(now_s);
            match wish {
                Wish::Digit(digit) => self.lock.digit(now_s, digit),
                Wish::Back => self.lock.back(),
                Wish::Enter => {
                    let options = &self.options;
                    self.lock.enter(now_s, |digits| options.is_pin(digits));
                }
                Wish::Close => self.lock.close(),
                Wish::Permit(is_permitted) if self.lock.access() == Access::Open => {
                    self.machine.voltage.permit(is_permitted);
                    self.told.is_resting = false;
                }
                Wish::End if self.lock.access() == Access::Open => {
                    self.may_close = true;
                    bench
                        .ctx
                        .send_viewport_cmd(eframe::egui::ViewportCommand::Close);
                }
                Wish::Permit(_) | Wish::End => {}
            }
        }
    }

    fn show_public(&mut self, ui: &mut Ui, heard: &Heard, context: &mut PaneContext<'_>) {
        let bench = &mut *context.bench;
        let mut drawn = Drawn::default();
        let now_s = self.machine.now_s();
        if let Some(stop) = self.drawn.stop
            && heard.touched.iter().any(|at| stop.contains(*at))
        {
            self.stop(bench);
        }
        self.press(ui, heard);
        let shown = shown::Shown {
            machine: &self.machine,
            scene: context.scene,
            live: &bench.live,
            trail: &bench.past.trail,
            selection: &bench.selection,
            tally: self.records.tally(),
            is_deaf: matches!(bench.device.sound.state(), Some(SoundState::Absent(_))),
            is_resting: self.told.is_resting,
            input: self.senses.input(),
            has_keyboard: self.senses.has_keyboard,
            rings: &self.senses.rings,
            options: &self.options,
        };
        let mut brush = Brush {
            painter: ui.painter().clone(),
            palette: if self.machine.choices().is_large {
                Palette::stark()
            } else {
                Palette::in_ui(ui)
            },
            layout: self.layout(ui.max_rect()),
            drawn: &mut drawn,
        };
        let wishes = view::show(ui, &mut brush, &shown);
        drawn.read_out(ui);
        self.drawn = drawn;
        let ground = wishes.ground;
        *context.ground = ground.map(|(rect, view)| PointerGround {
            window: Pointed::Workbench,
            view,
            rect,
            size_mm: context.scene.size_mm,
            pixels_per_point: ui.pixels_per_point(),
            feels: true,
        });
        self.sense(ui, ground, bench);
        for act in wishes.acts {
            self.act(act, bench);
        }
        if self.senses.hides_cursor(now_s) {
            ui.ctx().set_cursor_icon(CursorIcon::None);
        }
    }

    /// Something comes down on what is felt: answered in this very frame.
    fn press(&mut self, ui: &Ui, heard: &Heard) {
        let (is_pressed, is_down, at) = ui.input(|input| {
            let pointer = &input.pointer;
            let at = pointer.interact_pos();
            (pointer.primary_pressed(), pointer.primary_down(), at)
        });
        let is_on_ground = self
            .ground_of(ui)
            .is_some_and(|ground| at.is_some_and(|at| ground.contains(at)));
        // Of fingers any may feel: the toolkit makes the first of them its pointer, and that may
        // be a hand that rests beside the cloths.
        let comes_down = if self.senses.has_fingers() {
            self.is_down_on_ground = self.senses.feels();
            heard.feels
        } else {
            self.is_down_on_ground &= is_down;
            is_pressed && is_on_ground
        };
        if comes_down {
            self.is_down_on_ground = true;
            self.machine.act(Act::Touch, self.senses.input());
        }
        let holds = is_down
            || ui.input(|input| {
                use eframe::egui::Key;
                input.key_down(Key::Enter) || input.key_down(Key::Space)
            });
        if !holds {
            self.machine.act(Act::HoldFeel(false), self.senses.input());
            self.machine
                .act(Act::HoldRestart(false), self.senses.input());
        }
    }

    /// The part of the screen that is felt.
    fn ground_of(&self, ui: &Ui) -> Option<Rect> {
        let layout = self.layout(ui.max_rect());
        match self.machine.phase() {
            Phase::Guessing(game) if game.is_over() => None,
            Phase::Guessing(_) => Some(layout.round().0),
            Phase::Watching | Phase::Touching => Some(layout.square),
        }
    }

    /// What the hand does, for the next step of the machine.
    fn sense(&mut self, ui: &Ui, ground: Option<(Rect, ViewTransform)>, bench: &Bench) {
        let Some((_, view)) = ground else {
            self.hand = Hand::default();
            return;
        };
        let here = if self.senses.has_fingers() {
            self.senses.felt_at()
        } else {
            ui.input(|input| input.pointer.latest_pos())
        };
        self.hand.is_down = self.is_down_on_ground;
        let here = here.filter(|_| self.is_down_on_ground);
        let from = here.and(self.counted_at).or(here);
        let moved_mm = here.zip(from).map_or(0.0, |(here, from)| {
            f64::from(here.distance(from)) / view.points_per_mm.max(1e-6)
        });
        if moved_mm < TREMBLE_MM {
            self.counted_at = from;
        } else {
            self.hand.moved_mm += moved_mm;
            self.counted_at = here;
        }
        self.hand.cloth = bench.live.cloth_under_display();
    }

    fn act(&mut self, act: Act, bench: &mut Bench) {
        if act == Act::Stop {
            return self.stop(bench);
        }
        self.machine.act(act, self.senses.input());
    }
}

impl PublicFace for Stage {
    fn filter(&self, input: &mut RawInput) {
        let types = self.machine.game().is_some_and(game::Game::is_over);
        input::filter(input, self.lock.access(), types);
    }

    fn logic(&mut self, bench: &mut Bench) {
        if !bench.clock.is_seen() {
            // Nobody's hand is on it.
            self.hand = Hand::default();
            bench.ctx.request_repaint_after(UNSEEN);
        }
        let now_s = bench.clock.now_s() + self.ahead_s;
        let device = self.device_state(bench);
        let was_permitted = self.machine.voltage.is_permitted();
        self.lock.step(now_s);
        let switch = self.machine.step(now_s, self.hand, device);
        self.hand.moved_mm = 0.0;
        match switch {
            Some(Switch::Arm) => bench.commands.push(DeviceCommand::Arm.into()),
            Some(Switch::Disarm) => bench.commands.push(DeviceCommand::Disarm.into()),
            None => {}
        }
        self.told.is_resting |= was_permitted && !self.machine.voltage.is_permitted();
        self.ask_for_device(now_s, device, bench);
        self.follow(bench);
        let ended = self.machine.take_ended();
        self.records.take(ended, &bench.executor);
        self.heartbeat.beat(now_s, bench.live.tick);
    }

    fn ui(&mut self, ui: &mut Ui, context: &mut PaneContext<'_>) {
        let now_s = self.machine.now_s();
        let ground = self.ground_of(ui);
        let strays = &context.bench.pointer.strays;
        let heard = self.senses.take(ui, (strays, ground), now_s);
        if heard.asks_operator {
            self.open_lock(context.bench);
        } else if heard.escapes && self.lock.access() == Access::Closed && self.machine.is_armed() {
            self.stop(context.bench);
        }
        if self.lock.access() == Access::Closed {
            if let Some(nth) = heard.number {
                let act = match self.machine.game() {
                    Some(_) => Act::Choose(nth),
                    None => Act::Tour(nth),
                };
                self.act(act, context.bench);
            }
            self.show_public(ui, &heard, context);
        } else {
            self.show_operator(ui, context.bench);
        }
        if context.bench.live.is_armed() {
            frame_as_armed(ui.ctx());
        }
        let is_quiet =
            matches!(self.machine.phase(), Phase::Watching) && self.machine.fade() <= 0.0;
        let pause_s = self.pace.frame(now_s, is_quiet);
        (ui.ctx()).request_repaint_after(Duration::from_secs_f64(pause_s));
    }

    fn stop_area(&self) -> Option<Rect> {
        self.drawn.stop
    }

    fn is_closed_by(&mut self, asks: bool, bench: &mut Bench) -> bool {
        if asks && !self.may_close {
            self.open_lock(bench);
        }
        self.may_close
    }

    fn end(&mut self) {
        self.machine.end(VisitEnd::Stop);
        let ended = self.machine.take_ended();
        self.records.finish(ended);
    }

    fn go_to(&mut self, picture: StagePicture) {
        let before_s = self.machine.now_s();
        self.act_out(picture);
        self.ahead_s += self.machine.now_s() - before_s;
    }
}
