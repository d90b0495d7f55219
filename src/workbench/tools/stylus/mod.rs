//! The stylus beside the array: what a force-feedback device would feel where the display is.
//!
//! ```text
//! history, look back ─▶ follow (a run of render::contact) ─▶ rows ─▶ chart ─▶ view, export
//! textile, tip ─▶ ground (in the background) ──┘
//! sliders ─▶ settings: what cannot be held waits until it is confirmed
//! ```
//!
//! Nothing is prepared or computed while the pane is out of sight and it is not felt [`through`]
//! the device.

pub(crate) mod chart;
pub(crate) mod controls;
pub(crate) mod follow;
pub(crate) mod ground;
pub(crate) mod map;
pub(crate) mod settings;
#[cfg(test)]
mod tests;
pub(crate) mod through;
#[cfg(test)]
mod through_tests;
pub(crate) mod view;

use eframe::egui::Ui;

use crate::bench::Bench;
use crate::bench::export::{Exported, NOTHING_FELT, row};
use crate::bench::pane::Pane;
use crate::bench::recording::Recording;
use crate::bench::settings::preferences::Preferences;
use crate::bench::tool::{PaneContext, Tool};
use crate::bench::view::Source;
use crate::kit::pane::framed;
use selvedge_chart::Chart;
use selvedge_foundation::geometry::Point;
use selvedge_render::scene::{LoadedScene, PlacedTextile, Scene};

use crate::tools::stylus::chart::Second;
use crate::tools::stylus::follow::{Follower, Progress, Spot, WINDOW, Way};
use crate::tools::stylus::ground::{Ground, GroundKey, Grounds};
use crate::tools::stylus::settings::{Chosen, StylusSettings};
use crate::tools::stylus::through::ThroughDevice;

/// Why there is nothing to export for a moment.
const PREPARING: &str =
    "There is nothing to export yet: the tip is being rolled over the textile; try again";
/// Height of a chart in a file, pixels.
const CHART_PX: f64 = 240.0;

/// What the rows were made from, apart from the path.
#[derive(Debug)]
struct Circumstances {
    settings: StylusSettings,
    placed: Vec<PlacedTextile>,
    n_clears: u64,
}

/// What the charts were made from: the column at their end, steps made, what is chosen.
type Drawn = (u64, u64, StylusSettings);

/// The stylus.
#[derive(Debug, Default)]
pub(crate) struct Stylus {
    pub(crate) chosen: Chosen,
    pub(crate) through: ThroughDevice,
    /// The stylus that the recording at hand was made with.
    pub(crate) recorded: Option<String>,
    follower: Follower,
    grounds: Grounds,
    made_for: Option<Circumstances>,
    /// Column at the end of what is shown; `None` before anything was felt.
    end: Option<u64>,
    /// The textile under the stylus at the end, if any.
    under: Option<usize>,
    /// Why there is nothing to see of a textile, or what is waited for.
    pub(crate) note: Option<String>,
    charts: Option<(Drawn, Vec<Chart>)>,
    map: Option<(StylusSettings, Chart, f64)>,
}

/// Where a place of the workspace is on the topmost textile there.
fn spot_at(scene: &Scene, position: Point) -> Option<Spot> {
    let textile = scene.textile_at(position)?;
    let from_textile = scene.textiles[textile].workspace_from_textile();
    let place = from_textile.into_point(position);
    Some(Spot {
        textile,
        place_mm: [place.x_mm, place.y_mm],
    })
}

impl Stylus {
    /// The rows of the second that is shown.
    pub(crate) fn second(&self) -> Second<'_> {
        Second {
            rows: self.follower.rows(),
            end: self.end.unwrap_or_default(),
        }
    }

    /// Steps made so far: it stands still while nothing moves or nobody looks.
    #[cfg(test)]
    pub(crate) fn n_steps(&self) -> u64 {
        self.follower.n_steps()
    }

    /// The textile under the stylus, prepared.
    fn ground(&self, loaded: &LoadedScene) -> Option<&Ground> {
        let key = key_of(loaded, self.under?, self.chosen.applied.radius_mm)?;
        self.grounds.get(&key)?.0.as_deref().ok()
    }

    /// Goes on to the tick that every view shows, as far as one frame may.
    pub(crate) fn follow(&mut self, bench: &Bench) -> Progress {
        let history = &bench.past.history;
        let looked_at = bench.past.look_back.as_ref().map(|back| back.column);
        let newest = history.newest().map(|entry| entry.column);
        let loaded = &bench.engine_scene.loaded;
        let scene = loaded.scene();
        let settings = self.chosen.applied;
        let is_as_made = self.made_for.as_ref().is_some_and(|made_for| {
            made_for.settings == settings
                && made_for.n_clears == history.n_clears
                && made_for.placed == scene.textiles
        });
        if !is_as_made {
            self.follower.clear();
            self.made_for = Some(Circumstances {
                settings,
                placed: scene.textiles.clone(),
                n_clears: history.n_clears,
            });
        }
        self.end = looked_at.or(newest);
        let is_replayed = bench.live.play.source == Source::Recording;
        let at_hand = bench.exploration.at_hand.as_ref();
        let recording = at_hand.filter(|_| is_replayed).map(Recording::about);
        self.recorded = recording.and_then(|about| about.stylus.clone());
        self.note = None;
        let Some(end) = self.end else {
            return Progress::Done;
        };
        let spot = |column: u64| {
            let entry = history.at_column(column)?;
            spot_at(scene, entry.tick_sample.pose.position)
        };
        self.under = spot(end).map(|spot| spot.textile);
        let grounds = &mut self.grounds;
        let key = |textile: usize| key_of(loaded, textile, settings.radius_mm);
        // One after the other: each takes a while.
        let mut keys = textiles_of(&spot, end).into_iter().filter_map(key);
        if let Some(wanted) = keys.find(|key| grounds.get(key).is_none()) {
            grounds.follow(bench, &wanted);
        }
        let setup = |textile: usize| match &grounds.get(&key(textile)?)?.0 {
            Ok(ground) => Some(Ok(settings.setup(ground.contact.clone()))),
            Err(why) => Some(Err(why.clone())),
        };
        let way = Way {
            spot: &spot,
            setup: &setup,
        };
        let progress = self.follower.follow(&way, end);
        if progress == Progress::Waits {
            self.note = Some("The tip is being rolled over the textile".to_owned());
        }
        if progress == Progress::More {
            bench.ctx.request_repaint();
        }
        progress
    }

    /// The charts of the second that is shown, made when it changed.
    fn charts(&mut self, bench: &Bench) -> &[Chart] {
        let end = self.end.unwrap_or_default();
        let drawn = (end, self.follower.n_steps(), self.chosen.applied);
        if self.charts.as_ref().is_none_or(|(of, _)| *of != drawn) {
            let entries = bench.past.history.entries().iter();
            let shown = end.saturating_sub(WINDOW)..=end;
            let ticks: Vec<_> = entries
                .filter(|entry| shown.contains(&entry.column))
                .map(|entry| (entry.column, entry.tick_sample.mean_um.map(f64::from)))
                .collect();
            let second = self.second();
            let mut charts = vec![chart::array(second, &ticks)];
            charts.extend(chart::over_time(second));
            charts.extend([chart::over_way(second), chart::spectra(second)]);
            self.charts = Some((drawn, charts));
        }
        self.charts.as_ref().map_or(&[], |(_, charts)| charts)
    }

    /// What can be held with the settings that the rows show, and up to which stiffness, N/m.
    fn map(&mut self) -> (&Chart, f64) {
        let settings = self.chosen.shown();
        let is_made = self.map.as_ref().is_some_and(|(of, ..)| *of == settings);
        if !is_made {
            self.map = None;
        }
        let (_, chart, limit) = self.map.get_or_insert_with(|| {
            let limit = settings.case().stiffness_limits(0.0, 0.0).exact;
            (settings, map::map(&settings), limit)
        });
        (chart, *limit)
    }
}

/// A textile of the scene under a tip.
fn key_of(loaded: &LoadedScene, textile: usize, radius_mm: f64) -> Option<GroundKey> {
    let textile = loaded.textiles().get(textile)?.clone();
    Some(GroundKey { textile, radius_mm })
}

/// The textiles of the second that is shown, the first one that is needed first.
fn textiles_of(spot: &dyn Fn(u64) -> Option<Spot>, end: u64) -> Vec<usize> {
    let mut found = Vec::new();
    for column in end.saturating_sub(WINDOW)..=end {
        let textile = spot(column).map(|spot| spot.textile);
        found.extend(textile.filter(|textile| !found.contains(textile)));
    }
    found
}

impl Tool for Stylus {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Stylus]
    }

    fn begin(&mut self, bench: &mut Bench) {
        let kept = &bench.settings.preferences.hand;
        self.chosen.take_up(kept.stylus, kept.stylus_waiting);
    }

    fn logic(&mut self, bench: &mut Bench) {
        let settings = self.chosen.applied;
        self.through.follow(settings, &mut self.grounds, bench);
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        self.follow(context.bench);
        framed(ui, 10, |ui| view::show(ui, self, context));
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        loop {
            let n_begun = self.grounds.n_begun();
            match self.follow(bench) {
                Progress::Done => break,
                // What is prepared in the background is not waited for.
                Progress::Waits if self.grounds.n_begun() == n_begun => return Err(PREPARING),
                Progress::More | Progress::Waits => {}
            }
        }
        if self.follower.rows().is_empty() {
            return Err(NOTHING_FELT);
        }
        let mut rows: Vec<_> = (self.charts(bench).iter().cloned())
            .map(|chart| row(chart, CHART_PX))
            .collect();
        rows.push(row(self.map().0.clone(), CHART_PX));
        let settings = self.chosen.applied;
        let note = "A simulated stylus led along the display's centre, the second up to the tick \
                    that is shown, at every step of the simulation; places in the textile's frame. \
                    Spectra: peak amplitudes under a Hann window whose gain is compensated.";
        let method = self.follower.chosen.as_deref().unwrap_or_default();
        let brief = settings.words();
        let origin = (bench.rendered_origin()).and("stylus", &brief, &brief).and(
            "stylus_method",
            method,
            method,
        );
        let (title, sheet) = ("Stylus on the path of the display", self.second().columns());
        Ok(Exported::new(title.to_owned(), sheet, rows, note, origin))
    }

    fn leave_scene(&mut self, _bench: &mut Bench) {
        self.grounds = Grounds::default();
        self.made_for = None;
        self.through.is_on = false;
    }

    fn keep_preferences(&self, preferences: &mut Preferences) {
        preferences.hand.stylus = self.chosen.applied;
        let asked = self.chosen.asked.as_ref();
        preferences.hand.stylus_waiting = asked.map(|(settings, _)| *settings);
    }
}
