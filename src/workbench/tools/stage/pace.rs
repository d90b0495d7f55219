//! How often the stage is drawn: less often where the machine cannot keep up, so that touch, sound
//! and array go first. Pure: told what time it is.

/// Frames a second while somebody touches, and while nobody is there; then ever fewer of them.
const TOUCHING_FPS: f64 = 20.0;
const WATCHING_FPS: f64 = 10.0;
/// Shares of those frames that are drawn, step by step.
const STEPS: [f64; 4] = [1.0, 0.75, 0.5, 0.3];
/// Intervals between frames that are looked at.
const N_INTERVALS: usize = 30;
/// A median that is longer than planned by this is too slow: 60 ms for 20 frames a second.
const SLOW: f64 = 1.2;
/// One step up is tried after so long without being slow, s; twice as long after one that failed.
const TRY_S: f64 = 20.0;
const LONGEST_TRY_S: f64 = 600.0;
/// A longer interval is a pause of the program, not a slow frame, s.
const PAUSE_S: f64 = 1.0;

/// The pace at which frames are drawn.
#[derive(Debug)]
pub(crate) struct Pace {
    step: usize,
    /// Intervals since the plan changed, and the last frame, s.
    intervals_s: Vec<f64>,
    last_s: Option<f64>,
    planned_s: f64,
    /// The median that was found last, s.
    median_s: Option<f64>,
    /// Since when nothing was slow, and how long that must be before more is tried, s.
    calm_since_s: f64,
    try_s: f64,
    /// Whether the last change was a step up.
    is_tried: bool,
}

impl Default for Pace {
    fn default() -> Self {
        Self {
            step: 0,
            intervals_s: Vec::with_capacity(N_INTERVALS),
            last_s: None,
            planned_s: 0.0,
            median_s: None,
            calm_since_s: 0.0,
            try_s: TRY_S,
            is_tried: false,
        }
    }
}

impl Pace {
    /// A frame is drawn; how long until the next is planned, s. `is_quiet`: nobody is there.
    pub(crate) fn frame(&mut self, now_s: f64, is_quiet: bool) -> f64 {
        let interval_s = self.last_s.replace(now_s).map(|last_s| now_s - last_s);
        if let Some(interval_s) = interval_s.filter(|interval_s| *interval_s < PAUSE_S) {
            self.intervals_s.push(interval_s);
        }
        if self.intervals_s.len() >= N_INTERVALS {
            self.judge(now_s);
        }
        let fps = if is_quiet { WATCHING_FPS } else { TOUCHING_FPS };
        let planned_s = 1.0 / (fps * STEPS[self.step]);
        if planned_s.total_cmp(&self.planned_s).is_ne() {
            // Frames of before had another plan.
            self.intervals_s.clear();
            self.planned_s = planned_s;
        }
        planned_s
    }

    /// What the operator ought to know.
    pub(crate) fn describe(&self) -> String {
        let planned = 1.0 / self.planned_s.max(1e-3);
        let reached = self.median_s.map_or(planned, |median_s| 1.0 / median_s);
        let share = 100.0 * STEPS[self.step];
        let why = if self.step == 0 {
            ""
        } else {
            ": drawing is slow on this machine"
        };
        format!("Frames: {reached:.0} a second, {share:.0} % of the plan{why}")
    }

    fn judge(&mut self, now_s: f64) {
        let middle = self.intervals_s.len() / 2;
        let (_, median_s, _) = self
            .intervals_s
            .select_nth_unstable_by(middle, f64::total_cmp);
        let median_s = *median_s;
        self.intervals_s.clear();
        self.median_s = Some(median_s);
        if median_s > SLOW * self.planned_s {
            if self.is_tried {
                self.try_s = (2.0 * self.try_s).min(LONGEST_TRY_S);
            }
            self.step = (self.step + 1).min(STEPS.len() - 1);
            (self.is_tried, self.calm_since_s) = (false, now_s);
        } else if self.step > 0 && now_s - self.calm_since_s >= self.try_s {
            self.step -= 1;
            (self.is_tried, self.calm_since_s) = (true, now_s);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Frames of a machine that needs so long for each, until `until_s`; the plans it was given.
    fn draw(pace: &mut Pace, now_s: &mut f64, needs_s: f64, until_s: f64) -> Vec<f64> {
        let mut plans = Vec::new();
        while *now_s < until_s {
            let planned_s = pace.frame(*now_s, false);
            plans.push(planned_s);
            *now_s += planned_s.max(needs_s);
        }
        plans
    }

    #[test]
    fn a_machine_that_keeps_up_is_never_slowed_down() {
        let (mut pace, mut now_s) = (Pace::default(), 0.0);
        let plans = draw(&mut pace, &mut now_s, 0.059, 60.0);
        assert!(plans.iter().all(|planned_s| *planned_s == 0.05));
        assert_eq!(pace.describe(), "Frames: 17 a second, 100 % of the plan");
        for _ in 0..100 {
            now_s += 0.1;
            assert_eq!(pace.frame(now_s, true), 0.1, "nobody is there");
        }
    }

    #[test]
    fn a_median_over_60_ms_steps_down_and_a_machine_that_is_free_again_up() {
        let (mut pace, mut now_s) = (Pace::default(), 0.0);
        let plans = draw(&mut pace, &mut now_s, 0.061, 20.0);
        let first = plans.iter().position(|planned_s| *planned_s > 0.05);
        assert_eq!(first, Some(N_INTERVALS), "by {N_INTERVALS} intervals");
        assert!(
            (plans[plans.len() - 1] - 1.0 / 15.0).abs() < 1e-12,
            "one step"
        );
        assert!(
            pace.describe()
                .ends_with("75 % of the plan: drawing is slow on this machine")
        );
        draw(&mut pace, &mut now_s, 0.3, 60.0);
        assert_eq!(pace.step, STEPS.len() - 1, "never fewer than that");
        draw(&mut pace, &mut now_s, 0.01, 200.0);
        assert_eq!(pace.step, 0);
    }

    #[test]
    fn what_failed_is_tried_ever_more_seldom() {
        let (mut pace, mut now_s) = (Pace::default(), 0.0);
        let plans = draw(&mut pace, &mut now_s, 0.065, 3600.0);
        let ups = plans.windows(2).filter(|pair| pair[1] < pair[0]).count();
        assert!((3..12).contains(&ups), "{ups} in an hour");
    }

    #[test]
    fn a_single_slow_frame_and_a_pause_change_nothing() {
        let (mut pace, mut now_s) = (Pace::default(), 0.0);
        for nth in 0..600 {
            let interval_s = match nth % 30 {
                3..=15 => 0.2,
                20 => 30.0,
                _ => 0.04,
            };
            now_s += interval_s;
            assert_eq!(pace.frame(now_s, false), 0.05, "frame {nth}");
        }
    }
}
