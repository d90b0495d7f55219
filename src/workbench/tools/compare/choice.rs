//! What is compared: the choices of the user, and the two scenes and methods that come of them.

use std::sync::Arc;

use crate::bench::Bench;
use crate::bench::gain_set::GainSet;
use crate::bench::play::resting_stroke;
use crate::bench::recording::Recording;
use selvedge_foundation::numerics::to_index;
use selvedge_render::array::Method;
use selvedge_render::scene::{
    ExplorationPath, PathCursor, Pose, Scene, SlotLetter, Stroke, TICKS_PER_S,
};
use selvedge_textile::tactile::Tuning;

/// Places of a path at which is looked to find the textile under it.
const N_LOOKS: u64 = 128;
/// A stroke is compared for ten minutes at most.
const MOST_STROKE_TICKS: f64 = 24_000.0;

/// What differs between A and B.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum What {
    /// Gains, compression, filters.
    #[default]
    Tunings,
    /// One textile in the place of another.
    Textiles,
    /// How amplitudes are computed.
    Methods,
    /// Two recordings as they were felt or shown, tick for tick.
    Recordings,
}

/// A tuning to compare.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TuningChoice {
    /// The one in force.
    Live,
    /// What is kept in a slot.
    Slot(SlotLetter),
    /// The one that the library comes with.
    Library,
}

/// What the user chose.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Choice {
    /// What differs.
    pub what: What,
    /// The tunings of A and B.
    pub tunings: [TuningChoice; 2],
    /// The place in the scene's list whose textile is exchanged; `None`: where the path mostly is.
    pub place: Option<usize>,
    /// The textiles that lie there in A and B; `None`: the one of the scene.
    pub textiles: [Option<String>; 2],
    /// The methods of A and B.
    pub methods: [Method; 2],
}

impl Default for Choice {
    fn default() -> Self {
        Self {
            what: What::default(),
            tunings: [TuningChoice::Library, TuningChoice::Live],
            place: None,
            textiles: [None, None],
            methods: [Method::Reference, Method::Table],
        }
    }
}

/// The path that both follow.
#[derive(Debug, Clone)]
pub(crate) enum Route {
    /// A recorded exploration.
    Recording(Arc<ExplorationPath>),
    /// A generated stroke through the scene, this many ticks long.
    Stroke(Stroke, u64),
    /// Each its own: nothing is rendered, two recordings are compared as they were.
    Recorded(Arc<[Recording; 2]>),
}

impl PartialEq for Route {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Recording(one), Self::Recording(other)) => Arc::ptr_eq(one, other),
            (Self::Stroke(one, n), Self::Stroke(other, m)) => one == other && n == m,
            (Self::Recorded(two), Self::Recorded(others)) => Arc::ptr_eq(two, others),
            _ => false,
        }
    }
}

impl Route {
    /// The recording at hand; without one, once along the stroke that the display explores with.
    pub(crate) fn at_hand(bench: &Bench) -> Self {
        if let Some(take) = &bench.exploration.at_hand {
            return Self::Recording(Arc::clone(take.path()));
        }
        let stroke = resting_stroke(bench.document.scene());
        let n_ticks = (stroke.period_s() * TICKS_PER_S)
            .ceil()
            .clamp(1.0, MOST_STROKE_TICKS);
        Self::Stroke(stroke, to_index(n_ticks) as u64)
    }

    /// Its ticks.
    pub(crate) fn n_ticks(&self) -> u64 {
        match self {
            Self::Recording(path) => path.n_ticks(),
            Self::Stroke(_, n_ticks) => *n_ticks,
            Self::Recorded(two) => {
                let [a, b] = two.each_ref().map(|one| one.path().n_ticks());
                a.min(b)
            }
        }
    }

    /// Every tick with its pose.
    pub(crate) fn ticks(&self) -> Box<dyn Iterator<Item = (u64, Pose)> + '_> {
        match self {
            Self::Recording(path) => Box::new(path.ticks()),
            Self::Recorded(two) => Box::new(two[0].path().ticks()),
            Self::Stroke(stroke, n_ticks) => {
                Box::new((0..*n_ticks).map(|tick| (tick, pose_of(stroke, tick))))
            }
        }
    }

    /// The path that tells where displays beside the first are.
    pub(crate) fn path(&self) -> Option<&ExplorationPath> {
        match self {
            Self::Recording(path) => Some(path),
            Self::Stroke(..) | Self::Recorded(_) => None,
        }
    }

    fn pose_at(&self, tick: u64, display: usize) -> Option<Pose> {
        match self {
            Self::Recording(path) => {
                let (_, first) = PathCursor::at(path, tick).step(path)?;
                Some(path.pose_of(display, &first))
            }
            Self::Stroke(stroke, _) => Some(pose_of(stroke, tick)),
            Self::Recorded(_) => None,
        }
    }

    /// The place in the scene's list of the textile that a display is on mostly; of equals the one
    /// on top. `None` when it is on none.
    pub(crate) fn mostly_on(&self, scene: &Scene, display: usize) -> Option<usize> {
        let n_ticks = self.n_ticks();
        let n_looks = n_ticks.min(N_LOOKS);
        let mut n_on = vec![0_u64; scene.textiles.len()];
        for look in 0..n_looks {
            let pose = self.pose_at(look * n_ticks / n_looks, display);
            let on = pose.and_then(|pose| scene.textile_at(pose.position));
            if let Some(n) = on.and_then(|index| n_on.get_mut(index)) {
                *n += 1;
            }
        }
        let most = (0..n_on.len()).max_by_key(|&index| n_on[index])?;
        (n_on[most] > 0).then_some(most)
    }
}

fn pose_of(stroke: &Stroke, tick: u64) -> Pose {
    stroke.pose_at(tick as f64 / TICKS_PER_S)
}

/// One of the two.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Side {
    /// The scene, with its tuning.
    pub scene: Scene,
    /// The method.
    pub method: Method,
    /// The recording that is set against the other as it was.
    pub recording: Option<String>,
}

/// Everything that a comparison depends on.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Inputs {
    /// A and B.
    pub sides: [Side; 2],
    /// The path that both follow.
    pub route: Route,
    /// The display whose contactors are compared.
    pub(crate) display: usize,
}

impl Inputs {
    /// What comes of a choice for a display of a scene whose tuning is `live`, its library's
    /// `library`.
    ///
    /// # Errors
    /// A sentence that says what is missing and what to do.
    pub(crate) fn of(
        choice: &Choice,
        scene: &Scene,
        [live, library]: [Tuning; 2],
        (route, display): (Route, usize),
    ) -> Result<Self, &'static str> {
        if scene.textiles.is_empty() {
            return Err("Place a textile first: there is nothing to feel in this scene");
        }
        let place = choice.place_in(scene, (&route, display));
        let mut sides = [0, 1].map(|_| Side {
            scene: Scene {
                tuning: Some(live),
                ..scene.clone()
            },
            method: Method::Auto,
            recording: None,
        });
        for (index, side) in sides.iter_mut().enumerate() {
            match choice.what {
                What::Tunings => match choice.tunings[index] {
                    TuningChoice::Live => {}
                    TuningChoice::Library => side.scene.tuning = Some(library),
                    TuningChoice::Slot(letter) => {
                        let gains = GainSet::of_slot(scene, letter);
                        let empty = "That slot is empty: keep a tuning in it in the Tuning pane";
                        gains.ok_or(empty)?.put_into(&mut side.scene);
                    }
                },
                What::Textiles => {
                    let id = choice.textiles[index].as_ref();
                    let cloth = side.scene.textiles.get_mut(place);
                    if let (Some(id), Some(cloth)) = (id, cloth) {
                        cloth.id.clone_from(id);
                    }
                }
                What::Methods => side.method = choice.methods[index],
                What::Recordings => match &route {
                    Route::Recorded(two) if !two[index].has_display(scene, display) => {
                        return Err(
                            "A recording has no levels of this display: press D for the next",
                        );
                    }
                    Route::Recorded(two) => side.recording = Some(two[index].name().to_owned()),
                    _ => {
                        return Err(
                            "Choose a recording in the Recordings pane, then “Compare with…”",
                        );
                    }
                },
            }
        }
        Ok(Self {
            sides,
            route,
            display,
        })
    }
}

impl Choice {
    /// The place whose textile is exchanged.
    pub(crate) fn place_in(&self, scene: &Scene, (route, display): (&Route, usize)) -> usize {
        let chosen = self.place.filter(|place| *place < scene.textiles.len());
        chosen
            .or_else(|| route.mostly_on(scene, display))
            .unwrap_or(0)
    }
}
