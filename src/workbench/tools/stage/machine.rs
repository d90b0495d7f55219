//! What the stage does: watching, touching, guessing, and back to watching. Pure: told what time it
//! is and what the hand does; knows nothing of windows, engines and files.
//!
//! ```text
//! Watching ─ touch ─▶ Touching ─ "Guess" ─▶ Guessing ─ three answers, a face ─▶ Watching
//!     ▲                  │ 40 s without movement   │ 45 s without movement
//!     └──────────────────┴────── held restart, STOP, close ──┘
//! ```

use selvedge_experiment::visits::{Comment, N_CLOTHS, Visit, VisitEnd};
use selvedge_foundation::numerics::Random;

use crate::bench::settings::preferences::Loudness;
use crate::tools::stage::act::{Act, Choices, Hand, Motion};
use crate::tools::stage::game::{FACES, Game, WORDS};
use crate::tools::stage::open_visit::OpenVisit;
use crate::tools::stage::voltage::{DeviceState, Switch, Voltage};

/// Without movement the ghost hints, and the stage goes back to watching, s.
const HINT_S: f64 = 20.0;
const LEFT_TOUCHING_S: f64 = 40.0;
/// Without movement while guessing it is asked, and then it goes back, s.
const ASKED_S: f64 = 30.0;
const LEFT_GUESSING_S: f64 = 45.0;
/// How long "restart" is held, s.
const RESTART_S: f64 = 1.0;
/// How long going back fades, s.
const FADE_S: f64 = 0.3;
/// How long the words for sound stand, s.
const SOUND_WORDS_S: f64 = 4.0;
/// When guessing is offered: after so long, or so many cloths, s.
const OFFER_S: f64 = 20.0;
const OFFER_CLOTHS: usize = 3;
/// A cloth counts once it was stroked for so long, s.
const STROKED_S: f64 = 0.5;
/// A frame that came later is a pause of the program, not of the visitor, s.
const LONGEST_STEP_S: f64 = 1.0;

/// Where it stands.
#[derive(Debug, Clone)]
pub(crate) enum Phase {
    /// Nobody is there.
    Watching,
    /// Cloths are stroked.
    Touching,
    /// A cloth is to be found.
    Guessing(Box<Game>),
}

/// The stage.
#[derive(Debug)]
pub(crate) struct Machine {
    phase: Phase,
    now_s: f64,
    visit: Option<OpenVisit>,
    pub(crate) voltage: Voltage,
    choices: Choices,
    random: Random,
    names: [String; N_CLOTHS],
    device: DeviceState,
    restart_since_s: Option<f64>,
    watching_since_s: f64,
    fades_since_s: f64,
    ended: Vec<Visit>,
}

impl Machine {
    /// A stage with these textiles, by their ids, that nobody visits yet.
    pub(crate) fn new(seed: u64, names: [String; N_CLOTHS]) -> Self {
        Self {
            phase: Phase::Watching,
            now_s: 0.0,
            visit: None,
            voltage: Voltage::default(),
            choices: Choices::default(),
            random: Random::new(seed),
            names,
            device: DeviceState::Absent,
            restart_since_s: None,
            watching_since_s: 0.0,
            fades_since_s: f64::NEG_INFINITY,
            ended: Vec::new(),
        }
    }

    /// Lets time pass; what is to be asked of the device.
    pub(crate) fn step(&mut self, now_s: f64, hand: Hand, device: DeviceState) -> Option<Switch> {
        let passed_s = (now_s - self.now_s).clamp(0.0, LONGEST_STEP_S);
        self.now_s = now_s;
        self.device = device;
        if let Some(visit) = &mut self.visit {
            visit.was_armed |= device == DeviceState::Armed && self.voltage.has_asked();
            visit.count((now_s, passed_s), hand);
        }
        let held_s = self.restart_since_s.map_or(0.0, |since_s| now_s - since_s);
        if held_s >= RESTART_S {
            self.end(VisitEnd::Restart);
        }
        let idle_s = self.idle_s();
        if let Phase::Guessing(game) = &mut self.phase {
            game.step(now_s);
        }
        match &self.phase {
            Phase::Touching if idle_s >= LEFT_TOUCHING_S => self.end(VisitEnd::Idle),
            Phase::Guessing(game) if idle_s >= LEFT_GUESSING_S => {
                let end = if game.is_over() {
                    VisitEnd::Done
                } else {
                    VisitEnd::Idle
                };
                self.end(end);
            }
            _ => {}
        }
        let has_visitor = self.visit.is_some();
        self.voltage
            .step(now_s, device, (has_visitor, hand.is_down))
    }

    /// Does what a visitor wants with `input`: `touch`, `mouse` or `keys`.
    pub(crate) fn act(&mut self, act: Act, input: &'static str) {
        match act {
            Act::Stop => return self.end(VisitEnd::Stop),
            Act::HoldRestart(false) => return self.restart_since_s = None,
            Act::HoldFeel(false) => return self.voltage.hold(self.now_s, false),
            _ => {}
        }
        self.welcome(input);
        let now_s = self.now_s;
        match act {
            Act::Touch => {
                if let Some(visit) = &mut self.visit {
                    visit.tour = None;
                    visit.stroke_mm = 0.0;
                }
            }
            Act::Tour(cloth) => {
                if let Some(visit) = &mut self.visit {
                    visit.tour = Some((cloth.min(N_CLOTHS - 1), now_s));
                    visit.n_strokes += 1;
                }
            }
            Act::Guess => {
                if matches!(self.phase, Phase::Touching) {
                    let game = Game::new(now_s, &mut self.random);
                    self.phase = Phase::Guessing(Box::new(game));
                    self.end_tour();
                }
            }
            Act::Choose(place) => {
                let is_heard = self.is_heard();
                if let Phase::Guessing(game) = &mut self.phase {
                    game.choose(now_s, place, (&self.names, is_heard));
                    self.end_tour();
                }
            }
            Act::Face(_) | Act::Word(_) | Act::Comment(_) => self.comment(act),
            Act::Done => {
                if self.game().is_some_and(Game::is_over) {
                    self.end(VisitEnd::Done);
                }
            }
            Act::SameStrength => self.choices.same_strength = !self.choices.same_strength,
            Act::Large => self.choices.is_large = !self.choices.is_large,
            Act::Sound => {
                self.choices.loudness = match self.choices.loudness {
                    None => Some(Loudness::Quiet),
                    Some(Loudness::Quiet) => Some(Loudness::Middle),
                    Some(Loudness::Middle) => Some(Loudness::Loud),
                    Some(Loudness::Loud) => None,
                };
                if let Some(visit) = &mut self.visit {
                    visit.sound_s = now_s;
                }
            }
            Act::HoldRestart(_) => {
                self.restart_since_s.get_or_insert(now_s);
            }
            Act::HoldFeel(_) => self.voltage.hold(now_s, true),
            Act::Stop => {}
        }
    }

    /// Where it stands.
    pub(crate) fn phase(&self) -> &Phase {
        &self.phase
    }

    /// The game under way.
    pub(crate) fn game(&self) -> Option<&Game> {
        match &self.phase {
            Phase::Guessing(game) => Some(game),
            _ => None,
        }
    }

    /// What the visitor chose.
    pub(crate) fn choices(&self) -> Choices {
        self.choices
    }

    /// What moves the display.
    pub(crate) fn motion(&self) -> Motion {
        let tour = self.visit.as_ref().and_then(|visit| visit.tour);
        match (&self.phase, tour) {
            (Phase::Watching, _) => Motion::Ghost,
            (_, Some((cloth, _))) => Motion::Tour(cloth),
            (Phase::Touching, None) if self.idle_s() >= HINT_S => Motion::Ghost,
            _ => Motion::Finger,
        }
    }

    /// Whether the ghost shows how it is done.
    pub(crate) fn has_ghost(&self) -> bool {
        self.motion() == Motion::Ghost
    }

    /// Whether what is felt is heard: never while nobody is there, nor while an armed array is to
    /// be recognised by touch.
    pub(crate) fn is_heard(&self) -> bool {
        let is_armed = self.device == DeviceState::Armed;
        let gives_away = matches!(self.phase, Phase::Guessing(_)) && is_armed;
        self.choices.loudness.is_some() && self.visit.is_some() && !self.has_ghost() && !gives_away
    }

    /// Whether the device is armed.
    pub(crate) fn is_armed(&self) -> bool {
        self.device == DeviceState::Armed
    }

    /// Whether "Press to feel" is offered.
    pub(crate) fn offers_feeling(&self) -> bool {
        self.voltage.is_permitted() && self.visit.is_some() && self.device == DeviceState::Ready
    }

    /// Whether guessing is offered.
    pub(crate) fn offers_guessing(&self) -> bool {
        matches!(self.phase, Phase::Touching)
            && (self.visit_s() >= OFFER_S || self.n_stroked() >= OFFER_CLOTHS)
    }

    /// Cloths that were stroked in this visit.
    pub(crate) fn n_stroked(&self) -> usize {
        let cloths = self.visit.as_ref().map(|visit| visit.cloth_s);
        let stroked = cloths.iter().flatten().filter(|s| **s >= STROKED_S);
        stroked.count()
    }

    /// How long this visit is, s.
    pub(crate) fn visit_s(&self) -> f64 {
        self.visit
            .as_ref()
            .map_or(0.0, |visit| self.now_s - visit.began_s)
    }

    /// How long nobody has been there, s.
    pub(crate) fn watching_s(&self) -> f64 {
        self.now_s - self.watching_since_s
    }

    /// Whether sound was chosen just now.
    pub(crate) fn chose_sound(&self) -> bool {
        let visit = self.visit.as_ref();
        visit.is_some_and(|visit| self.now_s - visit.sound_s < SOUND_WORDS_S)
    }

    /// How much of "still here?" is over, 0…1, while it is asked.
    pub(crate) fn leaving_share(&self) -> Option<f64> {
        let over_s = self.idle_s() - ASKED_S;
        let is_asked = matches!(self.phase, Phase::Guessing(_)) && over_s >= 0.0;
        is_asked.then_some((over_s / (LEFT_GUESSING_S - ASKED_S)).min(1.0))
    }

    /// How much of the second that begins anew is over, 0…1.
    pub(crate) fn restart_share(&self) -> f64 {
        let held = self.restart_since_s.map(|since_s| self.now_s - since_s);
        held.map_or(0.0, |held_s| (held_s / RESTART_S).clamp(0.0, 1.0))
    }

    /// How far going back to watching is to be seen still, 1…0.
    pub(crate) fn fade(&self) -> f64 {
        (1.0 - (self.now_s - self.fades_since_s) / FADE_S).clamp(0.0, 1.0)
    }

    /// The time of the last step, s.
    pub(crate) fn now_s(&self) -> f64 {
        self.now_s
    }

    /// The visits that have ended since this was asked last.
    pub(crate) fn take_ended(&mut self) -> Vec<Visit> {
        std::mem::take(&mut self.ended)
    }

    /// Ends a visit that is under way, and goes back to watching.
    pub(crate) fn end(&mut self, end: VisitEnd) {
        let phase = std::mem::replace(&mut self.phase, Phase::Watching);
        self.voltage.release();
        self.restart_since_s = None;
        let choices = std::mem::take(&mut self.choices);
        let Some(visit) = self.visit.take() else {
            return;
        };
        self.watching_since_s = self.now_s;
        self.fades_since_s = self.now_s;
        let (guesses, comment) = match phase {
            Phase::Guessing(game) => game.into_answers(),
            _ => (Vec::new(), Comment::default()),
        };
        self.ended.push(Visit {
            duration_s: self.now_s - visit.began_s,
            input: visit.input,
            was_armed: visit.was_armed,
            sound: match choices.loudness {
                None => "off",
                Some(Loudness::Quiet) => "quiet",
                Some(Loudness::Middle) => "middle",
                Some(Loudness::Loud) => "loud",
            },
            cloth_s: visit.cloth_s,
            n_strokes: visit.n_strokes,
            guesses,
            comment,
            end,
        });
    }

    /// A visitor is there, or goes on.
    fn welcome(&mut self, input: &'static str) {
        let now_s = self.now_s;
        if let Some(visit) = &mut self.visit {
            visit.moved_s = now_s;
            return;
        }
        self.phase = Phase::Touching;
        self.fades_since_s = f64::NEG_INFINITY;
        self.visit = Some(OpenVisit::begun(now_s, input));
    }

    fn comment(&mut self, act: Act) {
        let Phase::Guessing(game) = &mut self.phase else {
            return;
        };
        if !game.is_over() {
            return;
        }
        let comment = &mut game.comment;
        match act {
            Act::Face(nth) => comment.face = FACES.get(nth).copied().unwrap_or_default(),
            Act::Word(nth) => {
                let Some(&word) = WORDS.get(nth) else { return };
                match comment.words.iter().position(|chosen| *chosen == word) {
                    Some(place) => drop(comment.words.remove(place)),
                    None => comment.words.push(word),
                }
            }
            Act::Comment(text) => comment.text = text.chars().take(Comment::LONGEST).collect(),
            _ => {}
        }
    }

    fn end_tour(&mut self) {
        if let Some(visit) = &mut self.visit {
            visit.tour = None;
        }
    }

    /// How long nothing has moved, s.
    fn idle_s(&self) -> f64 {
        self.visit
            .as_ref()
            .map_or(0.0, |visit| self.now_s - visit.moved_s)
    }
}
