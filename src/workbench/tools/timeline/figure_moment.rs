//! What stands out in an exploration: the tick at which most was felt, and one contactor.

use crate::bench::error::AppError;
use crate::bench::recording::Recording;
use selvedge_chart::{At, Extent, Ink, Rule};
use selvedge_render::scene::{ExplorationPath, Pose, Scene, TICKS_PER_S};

/// What stands out: the tick at which most was felt, and one contactor.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Moment {
    pub(crate) tick: u64,
    /// Where the first display was.
    pub(crate) first: Pose,
    /// A display, and one of its contactors.
    pub(crate) contactor: [usize; 2],
    /// What that is called.
    pub(crate) name: String,
}

impl Moment {
    pub(crate) fn of(
        recording: &Recording,
        scene: &Scene,
        contactor: Option<usize>,
    ) -> Result<Self, AppError> {
        let n = recording.n_contactors();
        if let Some(contactor) = contactor.filter(|contactor| *contactor >= n) {
            let most = n.max(1) - 1;
            let what = format!("there is no contactor {contactor}; give 0 to {most}");
            return Err(AppError::Exploration(what));
        }
        let mut of_contactors = vec![0.0; n];
        let mut strongest = (0.0, 0, Pose::default());
        for (tick, first) in recording.path().ticks() {
            let amplitudes_um = recording.amplitudes_um(tick).unwrap_or_default();
            let sums = amplitudes_um
                .iter()
                .map(|[low, high]| f64::from(low + high));
            let sum: f64 = sums.clone().sum();
            of_contactors
                .iter_mut()
                .zip(sums)
                .for_each(|(all, um)| *all += um);
            if sum > strongest.0 || tick == 0 {
                strongest = (sum, tick, first);
            }
        }
        let most = (0..n)
            .rev()
            .max_by(|a, b| of_contactors[*a].total_cmp(&of_contactors[*b]));
        let contactor = contactor.or(most).unwrap_or(0);
        let displays = 0..scene.displays.len();
        let mut displays = displays.map(|display| (display, scene.contactors_of(display)));
        let on = displays.find(|(_, contactors)| contactors.contains(&contactor));
        let contactor = on.map_or([0; 2], |(display, of)| [display, contactor - of.start]);
        let [display, nth] = contactor;
        let name = if scene.displays.len() > 1 {
            format!("contactor {nth} of display {}", display + 1)
        } else {
            format!("contactor {nth}")
        };
        let (_, tick, first) = strongest;
        Ok(Self {
            tick,
            first,
            contactor,
            name,
        })
    }

    /// Where its display is when the first is here.
    pub(crate) fn pose(&self, path: &ExplorationPath, first: &Pose) -> Pose {
        path.pose_of(self.contactor[0], first)
    }

    pub(crate) fn t_s(&self) -> f64 {
        self.tick as f64 / TICKS_PER_S
    }

    /// Where it stands in the strips.
    pub(crate) fn rule(&self) -> Rule {
        Rule {
            at: At::X(self.t_s()),
            ink: Ink::Grey,
            extent: Extent::Dashed,
            ..Rule::default()
        }
    }
}
