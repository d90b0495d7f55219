//! Cloths in motion: so much time is asked to pass, and something comes of it.
//!
//! Reads no clock: the same asks give the same answers.

use std::sync::Arc;

use crate::tools::drape::hung::{
    Ask, Base, Chosen, ClothChoice, ClothFacts, ClothFrame, Facts, Frame, Lead, Sample, Second,
};
use selvedge_drape::{Drape, DrapeError, DrapeScene, Felt, Hand, HandPath};
use selvedge_foundation::numerics::{to_single, to_whole};
use selvedge_foundation::quantity::with_unit;

/// What of a step counts as one that is still to be taken.
const SLACK: f64 = 1e-6;

/// A cloth with what its contactors are given.
struct Rig {
    choice: ClothChoice,
    facts: ClothFacts,
    /// As it came to rest; `None` once its laws are others.
    rest: Option<Drape>,
    drape: Drape,
    felt: Option<Felt>,
    amplitudes_um: Vec<[Option<[f64; 2]>; 24]>,
}

/// All that hangs.
#[derive(Default)]
pub(crate) struct Hanging {
    wanted: Option<Arc<Chosen>>,
    base: Option<(Base, bool)>,
    rigs: Vec<Rig>,
    pub(crate) facts: Arc<Facts>,
    hands: Vec<Hand>,
    pub(crate) n_restarts: u64,
    /// Whether the path that was followed has ended.
    pub(crate) is_over: bool,
    t_s: f64,
    /// Steps since a time, s: multiples of a step are those of the command to the last bit.
    since: (f64, u64),
    /// What was asked for and is less than a step, s.
    owed_s: f64,
}

impl Hanging {
    /// Does what is asked for; says the steps that were taken.
    pub(crate) fn go_on(&mut self, ask: &Ask) -> Vec<Sample> {
        if self.wanted.as_ref() != Some(&ask.wanted) {
            let refused = self.hang(&ask.wanted, &ask.lead).err();
            self.wanted = Some(Arc::clone(&ask.wanted));
            self.since = (self.t_s, 0);
            self.tell(refused.map(|error| error.to_string()));
        }
        if self.n_restarts != ask.n_restarts {
            self.n_restarts = ask.n_restarts;
            self.restart(&ask.lead);
        }
        let mut samples = Vec::new();
        if let Err(error) = self.step(ask, &mut samples) {
            self.tell(Some(error.to_string()));
        }
        self.is_over = match &ask.lead {
            Lead::Towards(_) => false,
            Lead::Along(path) => self.t_s + self.step_s() > length_s(path) + SLACK,
        };
        samples
    }

    /// Whether all sleeps: nothing comes of asking for the same again.
    pub(crate) fn is_asleep(&self) -> bool {
        self.rigs.iter().all(|rig| rig.drape.is_asleep())
    }

    /// Hangs what is wanted; what hangs already takes up other figures where it is.
    fn hang(&mut self, wanted: &Chosen, lead: &Lead) -> Result<(), DrapeError> {
        let is_one_sided = wanted.second == Second::Beside;
        let base = (wanted.base.clone(), is_one_sided);
        let is_other = self.base.as_ref() != Some(&base);
        let n_before = self.rigs.len();
        let mut made = false;
        if is_other || wanted.cloths.len() != n_before {
            let rigs = wanted.cloths.iter();
            let rigs = rigs.map(|choice| Rig::new(&wanted.base, choice, is_one_sided));
            // What hangs stays until all of the new does.
            (self.rigs, made) = (rigs.collect::<Result<_, _>>()?, true);
            self.base = Some(base);
        } else {
            for (rig, choice) in self.rigs.iter_mut().zip(&wanted.cloths) {
                if rig.choice.textile != choice.textile {
                    *rig = Rig::new(&wanted.base, choice, is_one_sided)?;
                    made = true;
                } else if rig.choice.changes != choice.changes {
                    rig.refit(choice)?;
                }
            }
        }
        if made {
            let start = self.rigs.first().map(|rig| rig.drape.start_hands());
            let start = start.unwrap_or_default();
            if self.hands.len() != start.len() {
                self.hands = start;
            }
            self.restart(lead);
        }
        Ok(())
    }

    fn tell(&mut self, refused: Option<String>) {
        let start = self.rigs.first().map(|rig| rig.drape.start_hands());
        self.facts = Arc::new(Facts {
            cloths: self.rigs.iter().map(|rig| rig.facts.clone()).collect(),
            hands: start.unwrap_or_default(),
            refused,
        });
    }

    /// Every cloth at rest, fingers where they are led first; those that follow a hand are open, so
    /// that each is on its own side of the cloth.
    fn restart(&mut self, lead: &Lead) {
        match lead {
            Lead::Along(path) => path.at(path.span_s()[0], &mut self.hands),
            Lead::Towards(hands) => {
                if hands.len() == self.hands.len() {
                    self.hands.clone_from(hands);
                }
                let starts = self.rigs.first().map(|rig| rig.drape.start_hands());
                for (hand, start) in self.hands.iter_mut().zip(starts.unwrap_or_default()) {
                    hand.opening_mm = hand.opening_mm.max(start.opening_mm);
                }
            }
        }
        (self.t_s, self.since, self.owed_s) = (0.0, (0.0, 0), 0.0);
        for rig in &mut self.rigs {
            rig.restart(&self.hands);
        }
    }

    /// The longest step of any cloth, s.
    fn step_s(&self) -> f64 {
        let steps = self.rigs.iter().map(|rig| rig.drape.step_s());
        steps.fold(SLACK, f64::max)
    }

    fn step(&mut self, ask: &Ask, samples: &mut Vec<Sample>) -> Result<(), DrapeError> {
        let step_s = self.step_s();
        let (start_s, from) = (self.t_s, self.hands.clone());
        self.owed_s += ask.for_s;
        if let Lead::Along(path) = &ask.lead {
            self.owed_s = self.owed_s.min(length_s(path) - start_s);
        }
        let n_steps: u64 = to_whole((self.owed_s / step_s + SLACK).floor().max(0.0));
        self.owed_s -= n_steps as f64 * step_s;
        for nth in 1..=n_steps {
            self.since.1 += 1;
            let t_s = self.since.0 + Drape::after_s(self.since.1, step_s);
            match &ask.lead {
                // Who does not know the fingers yet leads none.
                Lead::Towards(to) if to.len() != from.len() => {}
                Lead::Towards(to) => {
                    let share = nth as f64 / n_steps as f64;
                    for (hand, (from, to)) in self.hands.iter_mut().zip(from.iter().zip(to)) {
                        *hand = from.towards(*to, share);
                    }
                }
                Lead::Along(path) => path.at(path.span_s()[0] + t_s, &mut self.hands),
            }
            let mut rows = Vec::new();
            for rig in &mut self.rigs {
                rig.step_until(t_s, &self.hands, &mut rows)?;
            }
            self.t_s = t_s;
            samples.push(Sample { t_s, rows });
        }
        Ok(())
    }

    pub(crate) fn frame(&self) -> Frame {
        Frame {
            t_s: self.t_s,
            hands: self.hands.clone(),
            cloths: self.rigs.iter().map(Rig::frame).collect(),
        }
    }
}

impl Rig {
    fn new(base: &Base, choice: &ClothChoice, is_one_sided: bool) -> Result<Self, DrapeError> {
        let scene = match base {
            Base::Shipped => DrapeScene::shipped()?,
            Base::File(path) => DrapeScene::read(path)?,
        };
        let unchanged = match &choice.textile {
            Some(other) => scene.of_other_textile(&other.id, other.library.as_deref())?,
            None => scene,
        };
        let unchanged = if is_one_sided {
            unchanged.on_one_side()
        } else {
            unchanged
        };
        let scene = unchanged.with_figures(&choice.changes)?;
        let drape = Drape::new(&scene, None, None)?;
        let (felt, silent) = match Felt::new(&scene) {
            Ok(felt) => (Some(felt), None),
            Err(why) => (None, Some(why.to_string())),
        };
        let title = choice.textile.as_ref().map(|other| other.name.clone());
        let key = choice.textile.as_ref().map(|other| other.key.clone());
        let facts = ClothFacts {
            title: title.unwrap_or_else(|| scene.name().to_owned()),
            key: key.or_else(|| scene.textile().map(str::to_owned)),
            stepping: stepping(&drape),
            has_touch: drape.has_touch(),
            scene,
            unchanged,
            silent,
        };
        let n_fingers = drape.start_hands().len();
        Ok(Self {
            choice: choice.clone(),
            facts,
            rest: Some(drape.clone()),
            drape,
            felt,
            amplitudes_um: vec![[None; 24]; n_fingers],
        })
    }

    fn refit(&mut self, choice: &ClothChoice) -> Result<(), DrapeError> {
        let scene = self.facts.unchanged.with_figures(&choice.changes)?;
        self.drape.refit(&scene)?;
        self.facts.stepping = stepping(&self.drape);
        self.facts.has_touch = self.drape.has_touch();
        self.facts.scene = scene;
        self.choice = choice.clone();
        self.rest = None;
        Ok(())
    }

    fn restart(&mut self, hands: &[Hand]) {
        let rest = self.rest.take();
        // A cloth that comes to no rest with its new figures goes on from where it is.
        let rest = rest.or_else(|| Drape::new(&self.facts.scene, None, None).ok());
        if let Some(rest) = &rest {
            self.drape = rest.clone();
        }
        self.rest = rest;
        self.felt.iter_mut().for_each(Felt::restart);
        self.amplitudes_um.fill([None; 24]);
        self.drape.place(hands);
    }

    /// Goes on to a time; the row of each finger after the last step.
    fn step_until(
        &mut self,
        t_s: f64,
        hands: &[Hand],
        rows: &mut Vec<[f64; 9]>,
    ) -> Result<(), DrapeError> {
        while self.drape.t_s() < t_s - 0.5 * self.drape.step_s() {
            self.drape.step(hands)?;
            self.tick();
        }
        let [energy_j, _] = self.drape.energy_j();
        rows.extend((0..hands.len().max(1)).map(|nth| self.drape.force_row(nth, energy_j)));
        Ok(())
    }

    /// What contactors are given once a step has come to the next tick of their displays.
    fn tick(&mut self) {
        let (Some(felt), all) = (&mut self.felt, &mut self.amplitudes_um) else {
            return;
        };
        let Ok(()) = felt.take(&mut self.drape, |felt| {
            let given = felt.contacts.iter().zip(felt.frame.amplitudes_um());
            for (amplitude, (contact, given)) in all[felt.finger].iter_mut().zip(given) {
                *amplitude = contact.is_some().then(|| given.map(f64::from));
            }
            Ok::<(), std::convert::Infallible>(())
        });
    }

    fn frame(&self) -> ClothFrame {
        let (pads, places) = (self.drape.pads(), self.drape.places_mm());
        let pads: Vec<_> = pads.collect();
        ClothFrame {
            grid: self.drape.grid(),
            size_mm: self.facts.scene.size_mm(),
            places_mm: places.map(|place| place.map(to_single)).collect(),
            fingers: (0..pads.len()).map(|nth| self.drape.finger(nth)).collect(),
            pads,
            n_overstretched: self.drape.counters().overstretched,
            amplitudes_um: self.amplitudes_um.clone(),
        }
    }
}

fn stepping(drape: &Drape) -> String {
    let (integrator, why) = drape.integrator();
    let step = with_unit(1e3 * drape.step_s(), 3, "ms");
    format!("{} at {step}: {why}", integrator.name())
}

fn length_s(path: &HandPath) -> f64 {
    let [start_s, end_s] = path.span_s();
    end_s - start_s
}
