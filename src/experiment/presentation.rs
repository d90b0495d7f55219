//! Proof of presentation: what of a trial reached the finger, and whether its answer may count.
//!
//! A [`Watch`] looks at every tick of a trial on the array. It knows no device and no clock: who
//! presents says of each tick what became of it. Cloth on the table and devices elsewhere are
//! confirmed by the experimenter; simulated observers feel by definition.

use crate::design::Design;
use crate::layout::{Layout, Place, sequence};
use crate::trial::Task;
use selvedge_engine::{Played, SequenceStep, TICKS_PER_S};
use selvedge_foundation::geometry::Point;

mod row;

pub use row::{Presentation, Proof, Validity};

/// Every textile that is compared, and one that hangs, is felt for so long at least, s.
const LEAST_EXPLORED_S: f64 = 1.0;
/// Slower is no exploration, mm/s.
const LEAST_SPEED_MM_PER_S: f64 = 2.0;
/// A cloth that hangs is rubbed where a contactor is given as much, µm: less no finger feels.
const LEAST_RUBBED_UM: f64 = 0.1;
/// Ticks without their frame that may be, of all; one may be always.
const MOST_MISSED_SHARE: f64 = 0.01;
/// Ticks in a row without their frame that may not be.
const MISSED_IN_A_ROW: u32 = 3;
/// Values that limits may have changed, of all; of those of a second at least.
const MOST_LIMITED_SHARE: f64 = 0.01;
/// Why a tick that went to no device does not count, where nothing better is known.
const NOT_ARMED: &str = "the array was not armed";
/// From tick to tick, ns.
const TICK_NS: u64 = 25_000_000;

/// A tick of a presentation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PresentedTick {
    /// Whether its frame went to a device that was armed.
    pub is_sent: bool,
    /// Ticks without their frame that the device has counted so far.
    pub n_missed: u64,
    /// Values that limits of host and device have changed so far.
    pub n_limited: u64,
    /// Values of a frame.
    pub n_values: u64,
    /// Where the display was, mm.
    pub position: Point,
    /// How fast it moved, mm/s.
    pub speed_mm_per_s: f64,
    /// The most that a contactor was given in either band, µm.
    pub strongest_um: f64,
    /// The step of a sequence that was played.
    pub sequence_step: Option<u16>,
}

/// How it stands with a presentation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Standing {
    /// What is missing before an answer may be taken.
    Incomplete(String),
    /// An answer may be taken.
    Valid,
    /// It does not count any more, and why.
    Void(String),
}

/// Looks at every tick of a trial on the array.
#[derive(Debug, Clone, PartialEq)]
pub struct Watch {
    proof: Proof,
    /// What has to be explored, in the order of places.
    places: Vec<Explored>,
    /// What is played, and how long each step was, ticks.
    steps: Vec<(SequenceStep, u32)>,
    may_limit: bool,
    hangs: bool,
    n_ticks: u64,
    n_armed: u64,
    n_values: u64,
    n_values_per_s: u64,
    /// Counters before the first tick, and now.
    missed: Option<Counted>,
    limited: Option<Counted>,
    missed_in_a_row: u32,
    /// The first tick of what is played, from the first of all.
    onset_tick: Option<u64>,
    void: Option<String>,
}

/// A counter of a device that runs on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Counted {
    before: u64,
    now: u64,
}

impl Counted {
    /// How far it went since the last look.
    fn look(this: &mut Option<Self>, now: u64) -> u64 {
        let counted = this.get_or_insert(Self { before: now, now });
        let more = now.saturating_sub(counted.now);
        counted.now = now;
        more
    }

    fn n(this: Option<Self>) -> u64 {
        this.map_or(0, |counted| counted.now.saturating_sub(counted.before))
    }
}

/// A place and how long it was felt.
#[derive(Debug, Clone, PartialEq)]
struct Explored {
    place: Place,
    n_ticks: u32,
    is_needed: bool,
}

impl Watch {
    /// Of a task before its first tick, by a device or an emulator of one.
    pub fn of(design: &Design, task: &Task, proof: Proof) -> Self {
        let places = Layout::of(design, task).places;
        let hangs = Layout::hanging(design, task).is_some();
        let is_needed = places.len() > 1 || hangs;
        let explored = |place: Place| Explored {
            place,
            n_ticks: 0,
            is_needed,
        };
        let steps = sequence(design, task);
        let is_textile = |step: &SequenceStep| matches!(step.played, Played::Textile(_));
        // Vibrations are felt wherever the finger is.
        let is_at_places = steps.is_empty() || steps.iter().any(is_textile);
        Self {
            proof,
            places: if is_at_places {
                places.into_iter().map(explored).collect()
            } else {
                Vec::new()
            },
            steps: steps.into_iter().map(|step| (step, 0)).collect(),
            may_limit: !design.composition.parameters().is_empty(),
            hangs,
            n_ticks: 0,
            n_armed: 0,
            n_values: 0,
            n_values_per_s: 0,
            missed: None,
            limited: None,
            missed_in_a_row: 0,
            onset_tick: None,
            void: None,
        }
    }

    /// Looks at the next tick. `lead` steps of a sequence come before those of the task.
    pub fn tick(&mut self, tick: &PresentedTick, lead: u16) {
        self.n_ticks += 1;
        self.n_armed += u64::from(tick.is_sent);
        self.n_values += tick.n_values;
        self.n_values_per_s = tick.n_values * 40;
        let n_missed = Counted::look(&mut self.missed, tick.n_missed);
        Counted::look(&mut self.limited, tick.n_limited);
        self.missed_in_a_row = match n_missed {
            0 => 0,
            n => self.missed_in_a_row + u32::try_from(n).unwrap_or(u32::MAX),
        };
        let played = self.play(tick, lead);
        self.explore(tick, played);
        if self.missed_in_a_row >= MISSED_IN_A_ROW || !tick.is_sent {
            self.end(NOT_ARMED);
        }
    }

    /// Counts a tick of movement for what is felt: what is uncovered now, or what lies there.
    fn explore(&mut self, tick: &PresentedTick, played: Option<Played>) {
        let hangs = self.hangs;
        let is_moving = if hangs {
            tick.strongest_um >= LEAST_RUBBED_UM
        } else {
            tick.speed_mm_per_s >= LEAST_SPEED_MM_PER_S
        };
        if !is_moving || !tick.is_sent {
            return;
        }
        let [width_mm, height_mm] = Place::SIZE_MM;
        let is_on = |explored: &&mut Explored| {
            let corner = explored.place.origin_mm;
            let (x_mm, y_mm) = (
                tick.position.x_mm - corner.x_mm,
                tick.position.y_mm - corner.y_mm,
            );
            hangs || (0.0..=width_mm).contains(&x_mm) && (0.0..=height_mm).contains(&y_mm)
        };
        let felt = match played {
            Some(Played::Textile(textile)) => self.places.get_mut(textile).filter(is_on),
            None if self.steps.is_empty() => {
                // The last of several that lie upon each other is on top.
                self.places.iter_mut().rev().find(is_on)
            }
            _ => None,
        };
        if let Some(explored) = felt {
            explored.n_ticks += 1;
        }
    }

    /// Counts a tick of a step of the sequence, and says what that plays.
    fn play(&mut self, tick: &PresentedTick, lead: u16) -> Option<Played> {
        let step = tick.sequence_step?.checked_sub(lead)?;
        let (step, n_played) = self.steps.get_mut(usize::from(step))?;
        *n_played += u32::from(tick.is_sent);
        self.onset_tick.get_or_insert(self.n_ticks - 1);
        Some(step.played)
    }

    /// Ends it, after its last tick, for a reason that no tick shows: a stop, a fault, a device
    /// that is gone. An array that gets no frames grows silent by itself: then that is the reason.
    pub fn end(&mut self, why: &str) {
        if self.void.as_ref().is_some_and(|void| void != NOT_ARMED) {
            return;
        }
        self.void = None;
        let n_missed = self.missed_in_a_row;
        self.void = Some(match self.standing() {
            _ if n_missed > 1 => format!("{n_missed} ticks in a row came without their frame"),
            Standing::Void(why) => why,
            Standing::Valid | Standing::Incomplete(_) => why.to_owned(),
        });
    }

    /// How it stands now.
    pub fn standing(&self) -> Standing {
        if let Some(why) = &self.void {
            return Standing::Void(why.clone());
        }
        let n_missed = Counted::n(self.missed);
        if n_missed as f64 > (MOST_MISSED_SHARE * self.n_ticks as f64).max(1.0) {
            return Standing::Void(format!(
                "{n_missed} of {} ticks came without their frame",
                self.n_ticks
            ));
        }
        let most = MOST_LIMITED_SHARE * self.n_values.max(self.n_values_per_s) as f64;
        if !self.may_limit && Counted::n(self.limited) as f64 > most {
            let percent = 100.0 * self.limited_share();
            return Standing::Void(format!("limits changed {percent:.1} % of the values"));
        }
        if let Some(why) = self.passed_unfelt() {
            return Standing::Void(why);
        }
        match self.missing() {
            Some(what) => Standing::Incomplete(what),
            None => Standing::Valid,
        }
    }

    /// An interval that is over and was not explored: it does not come again in this presentation.
    fn passed_unfelt(&self) -> Option<String> {
        let over = self.steps.iter().filter(|(step, n)| *n >= step.n_ticks);
        let mut felt = over.filter_map(|(step, _)| match step.played {
            Played::Textile(textile) => self.places.get(textile),
            Played::Vibration(_) => None,
        });
        let one = felt.find(|one| one.is_unfelt())?;
        let name = match one.place.number {
            Some(number) => format!("interval {number}"),
            None => "what the intervals are compared with".to_owned(),
        };
        Some(format!(
            "{name} was felt in movement for {:.2} s, not {LEAST_EXPLORED_S} s",
            one.felt_s()
        ))
    }

    /// What was not presented yet.
    fn missing(&self) -> Option<String> {
        if self.n_ticks == 0 {
            return Some("nothing was presented yet".to_owned());
        }
        if self
            .steps
            .iter()
            .any(|(step, n_played)| *n_played < step.n_ticks)
        {
            return Some("it is still being played".to_owned());
        }
        let one = self.places.iter().find(|one| one.is_unfelt())?;
        Some(match one.place.number {
            Some(number) => format!("number {number} was not felt for {LEAST_EXPLORED_S} s yet"),
            None if self.places.len() == 1 => {
                format!("the cloth was not rubbed for {LEAST_EXPLORED_S} s yet")
            }
            None => format!("the one in the middle was not felt for {LEAST_EXPLORED_S} s yet"),
        })
    }

    fn limited_share(&self) -> f64 {
        Counted::n(self.limited) as f64 / self.n_values.max(1) as f64
    }

    /// What a row says of it. The presentation began `began_ns` after the session was opened.
    pub fn presentation(&self, began_ns: u64) -> Presentation {
        let void = match self.standing() {
            Standing::Valid => String::new(),
            Standing::Incomplete(why) | Standing::Void(why) => why,
        };
        let onset_ns = self
            .onset_tick
            .map(|tick| began_ns.saturating_add(tick * TICK_NS));
        let n_missed = Counted::n(self.missed);
        Presentation {
            proof: Some(self.proof),
            void,
            armed_share: Some(self.n_armed as f64 / self.n_ticks.max(1) as f64),
            frames_applied: Some(self.n_armed.saturating_sub(n_missed)),
            frames_late: Some(n_missed),
            limited_share: Some(self.limited_share()),
            explored_s: self.places.iter().map(Explored::felt_s).collect(),
            onset_ns,
            path_sha256: String::new(),
        }
    }
}

impl Explored {
    fn felt_s(&self) -> f64 {
        f64::from(self.n_ticks) / TICKS_PER_S
    }

    fn is_unfelt(&self) -> bool {
        self.is_needed && self.felt_s() < LEAST_EXPLORED_S
    }
}

#[cfg(test)]
mod tests;
