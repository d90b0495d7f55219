//! The plots of signals in a window without a screen: what they compute when, and that nothing
//! odd harms them.

use std::f64::consts::TAU;

use eframe::egui::{self, Pos2, RawInput, Rect, Ui, Vec2, vec2};

use crate::bench::command::Commands;
use crate::bench::pane::Pane;
use crate::bench::tool::{PaneContext, Tools};
use crate::bench::{Bench, Drive};
use crate::kit::spectrum_scale::Handle;
use crate::kit::theme::colour_map::ColourMap;
use crate::tools::spectra::contact::ContactSpectrum;
use crate::tools::spectra::drive::DriveSpectrum;
use crate::tools::spectra::spatial::SpatialSpectra;
use crate::tools::spectra::wave::DriveWave;
use selvedge_engine::TickSample;
use selvedge_foundation::geometry::{Point, Velocity};
use selvedge_foundation::numerics::to_single;
use selvedge_render::RenderScene;
use selvedge_render::array::ContactInspector;
use selvedge_render::scene::Pose;

/// The four plots around a bench.
struct Plots {
    bench: Bench,
    tools: Tools,
}

impl Plots {
    fn shipped() -> Self {
        let ctx = egui::Context::default();
        let bench = Bench::new(&ctx, None, Drive::Stepped).unwrap();
        ctx.set_theme(egui::Theme::Dark);
        Self {
            bench,
            tools: Tools::new(vec![
                Box::new(ContactSpectrum::default()),
                Box::new(DriveSpectrum::default()),
                Box::new(DriveWave::default()),
                Box::new(SpatialSpectra::default()),
            ]),
        }
    }

    /// The same on a scene without textiles and displays.
    fn empty() -> Self {
        let mut plots = Self::shipped();
        let inspection = &mut plots.bench.inspection;
        inspection.scene = RenderScene::default();
        inspection.inspector = ContactInspector::new(&inspection.scene);
        plots
    }

    /// Explores along an eight over all four textiles, faster and slower.
    fn explore(&mut self, ticks: std::ops::Range<u64>) {
        let contactor = self.bench.selection.contactor.unwrap();
        for tick in ticks {
            let pose = pose_at(tick);
            let inspector = &mut self.bench.inspection.inspector;
            let trace = inspector.trace(0, contactor, &pose).unwrap();
            self.take(TickSample {
                tick,
                pose,
                watched: u32::try_from(contactor).unwrap(),
                watched_um: trace.amplitudes_um.map(to_single),
                ..TickSample::default()
            });
        }
    }

    fn take(&mut self, sample: TickSample) {
        let live = &mut self.bench.live;
        (live.tick, live.pose) = (sample.tick, sample.pose);
        self.bench.past.history.take(sample);
    }

    fn all(&mut self, ui: &mut Ui) {
        let height = ui.available_height() / 4.0;
        ui.spacing_mut().item_spacing = Vec2::ZERO;
        for pane in [
            Pane::ContactSpectrum,
            Pane::DriveSpectrum,
            Pane::DriveWave,
            Pane::SpatialSpectra,
        ] {
            let size = vec2(ui.available_width(), height);
            let layout = egui::Layout::top_down(egui::Align::Min);
            ui.allocate_ui_with_layout(size, layout, |ui| self.show(ui, pane));
        }
    }

    fn show(&mut self, ui: &mut Ui, pane: Pane) {
        let scene = self.bench.plain_scene_view();
        let mut context = PaneContext {
            bench: &mut self.bench,
            scene: &scene,
            commands: &mut Commands::new(),
            ground: &mut None,
            guest: &mut None,
        };
        let tool = self.tools.showing(pane).unwrap();
        tool.ui(pane, ui, &mut context);
    }

    fn show_contact(&mut self, ui: &mut Ui, map: ColourMap) {
        self.bench.settings.preferences.colour_map = map;
        self.show(ui, Pane::ContactSpectrum);
    }

    /// One frame of a window of this size, with the pointer in its middle.
    fn frame(&mut self, size: Vec2, mut content: impl FnMut(&mut Self, &mut Ui)) {
        let ctx = self.bench.ctx.clone();
        let at = Pos2::ZERO + 0.5 * size;
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, size)),
            events: vec![egui::Event::PointerMoved(at)],
            ..RawInput::default()
        };
        let mut output = ctx.run_ui(input, |ui| content(self, ui));
        let shapes = std::mem::take(&mut output.shapes);
        assert!(
            !ctx.tessellate(shapes, 1.0).is_empty() || size.min_elem() < 50.0,
            "drawn"
        );
        output.drop_without_applying_deltas();
    }

    fn contact(&self) -> &ContactSpectrum {
        self.tools.get().unwrap()
    }

    /// Columns, texture writes and views so far.
    fn work(&self) -> [u64; 5] {
        let drive: &DriveSpectrum = self.tools.get().unwrap();
        let spatial: &SpatialSpectra = self.tools.get().unwrap();
        [
            self.contact().n_columns_computed(),
            self.contact().n_uploads(),
            drive.n_columns_computed(),
            drive.n_uploads(),
            spatial.n_views_computed(),
        ]
    }
}

fn pose_at(tick: u64) -> Pose {
    let place = |tick: f64| {
        let phase = TAU * (tick / 400.0 + 0.02 * (TAU * tick / 97.0).sin());
        let point = [
            130.0 + 75.0 * phase.sin(),
            130.0 + 60.0 * (2.0 * phase).sin(),
        ];
        Point::from(point)
    };
    let (before, now) = (place(tick as f64 - 1.0), place(tick as f64));
    Pose {
        position: now,
        velocity: Pose::moving_mm_per_s(before, now),
        ..Pose::default()
    }
}

const SIZE: Vec2 = Vec2::new(400.0, 840.0);

#[test]
fn what_does_not_change_is_computed_and_sent_once() {
    let mut plots = Plots::shipped();
    plots.explore(0..100);
    plots.frame(SIZE, Plots::all);
    let work = plots.work();
    assert_eq!(work, [100, 1, 100, 1, 1]);
    for _ in 0..5 {
        plots.frame(SIZE, Plots::all);
    }
    assert_eq!(plots.work(), work, "nothing moved");
    plots.explore(100..102);
    plots.frame(SIZE, Plots::all);
    assert_eq!(plots.work(), [102, 2, 102, 2, 2]);
}

#[test]
fn what_nobody_sees_is_not_computed() {
    let mut plots = Plots::shipped();
    plots.explore(0..400);
    plots.frame(SIZE, |plots, ui| plots.show(ui, Pane::DriveWave));
    plots.frame(vec2(30.0, 20.0), Plots::all);
    assert_eq!(plots.work(), [0; 5]);
}

#[test]
fn other_colours_are_sent_anew_and_another_contactor_is_computed_anew() {
    let mut plots = Plots::shipped();
    plots.explore(0..50);
    plots.frame(SIZE, |plots, ui| plots.show_contact(ui, ColourMap::Viridis));
    plots.frame(SIZE, |plots, ui| plots.show_contact(ui, ColourMap::Grey));
    let floor = plots
        .bench
        .selection
        .spectrum
        .levels
        .moved(Handle::Floor, 10.0);
    plots.bench.selection.spectrum.levels = floor;
    plots.frame(SIZE, |plots, ui| plots.show_contact(ui, ColourMap::Grey));
    assert_eq!(plots.work()[..2], [50, 3], "only colours changed");
    plots.bench.selection.contactor = Some(3);
    plots.explore(50..51);
    plots.frame(SIZE, |plots, ui| plots.show_contact(ui, ColourMap::Grey));
    assert_eq!(plots.contact().n_columns_computed(), 101);
    plots.frame(SIZE, |plots, ui| plots.show(ui, Pane::DriveSpectrum));
    plots.bench.past.history.clear();
    plots.frame(SIZE, Plots::all);
    assert_eq!(
        plots.contact().n_columns_computed(),
        101,
        "nothing is left to compute"
    );
}

#[test]
fn where_nothing_is_felt_is_a_gap_in_what_is_exported_too() {
    let mut plots = Plots::shipped();
    plots.explore(0..30);
    for tick in 30..60 {
        let outside = Pose {
            position: Point::new(-40.0, -40.0),
            velocity: Velocity::new(50.0, 0.0),
            ..Pose::default()
        };
        plots.take(TickSample {
            tick,
            pose: outside,
            watched: 9,
            ..TickSample::default()
        });
    }
    for (pane, value) in [
        (Pane::ContactSpectrum, "level_db"),
        (Pane::DriveSpectrum, "amplitude_um"),
    ] {
        let Plots { bench, tools } = &mut plots;
        let exported = tools.showing(pane).unwrap().export(pane, bench).unwrap();
        let cells = exported.sheet.points("tick", value);
        let last = cells.iter().map(|[tick, _]| *tick).fold(0.0, f64::max);
        assert!(!cells.is_empty() && last < 34.0, "{pane:?}: tick {last}");
        assert!(
            cells.iter().all(|[_, value]| !value.is_infinite()),
            "{pane:?}"
        );
    }
}

#[test]
fn nothing_odd_harms_the_plots() {
    let odd = Pose {
        position: Point::new(f64::NAN, 1.0),
        velocity: Velocity::new(f64::INFINITY, f64::NAN),
        ..Pose::default()
    };
    for plots in [Plots::shipped, Plots::empty] {
        let mut plots = plots();
        for contactor in [9, 24, 4_000_000] {
            plots.bench.selection.contactor = Some(contactor);
            for size in [vec2(0.0, 0.0), vec2(1.0, 900.0), vec2(900.0, 1.0), SIZE] {
                plots.frame(size, Plots::all);
            }
            plots.take(TickSample {
                tick: contactor as u64,
                pose: odd,
                watched_um: [f32::NAN, f32::INFINITY],
                ..TickSample::default()
            });
            plots.frame(SIZE, Plots::all);
        }
    }
}
