//! The plots of signals in a window without a screen: what they compute when, and that nothing
//! odd harms them.

use std::f64::consts::TAU;

use eframe::egui::{self, Pos2, RawInput, Rect, Ui, Vec2, vec2};

use crate::bench::amplitude::AmplitudeScale;
use crate::bench::signals::history::History;
use crate::kit::theme;
use crate::kit::theme::colour_map::ColourMap;
use crate::tools::spectra::contact::{self, ContactSpectrogram, ContactSpectrumView};
use crate::tools::spectra::drive::{self, DriveSpectrogram, DriveSpectrumView};
use crate::tools::spectra::spatial::{self, SpatialSource, SpatialSpectra};
use crate::tools::spectra::wave::{self, DriveWaveView, WaveScale};
use selvedge_engine::TickSample;
use selvedge_foundation::geometry::{Point, Velocity};
use selvedge_render::RenderScene;
use selvedge_render::array::ContactInspector;
use selvedge_render::scene::{LoadedScene, Pose};

/// Everything that the plots need, as the window will keep it.
struct Bench {
    ctx: egui::Context,
    scene: RenderScene,
    inspector: ContactInspector,
    history: History,
    contactor: usize,
    contact: ContactSpectrogram,
    drive: DriveSpectrogram,
    spatial: SpatialSpectra,
    wave: WaveScale,
}

impl Bench {
    fn of(scene: RenderScene) -> Self {
        let ctx = egui::Context::default();
        theme::install(&ctx);
        ctx.set_theme(egui::Theme::Dark);
        Self {
            ctx,
            inspector: ContactInspector::new(&scene),
            scene,
            history: History::default(),
            contactor: 9,
            contact: ContactSpectrogram::default(),
            drive: DriveSpectrogram::default(),
            spatial: SpatialSpectra::default(),
            wave: WaveScale::default(),
        }
    }

    fn shipped() -> Self {
        Self::of(RenderScene::of(&LoadedScene::shipped().unwrap()))
    }

    /// Explores along an eight over all four textiles, faster and slower.
    fn explore(&mut self, ticks: std::ops::Range<u64>) {
        for tick in ticks {
            let pose = pose_at(tick);
            #[expect(
                clippy::cast_possible_truncation,
                reason = "as glimpses hold amplitudes"
            )]
            let rounded = |um: f64| um as f32;
            let trace = self.inspector.trace(0, self.contactor, &pose).unwrap();
            self.history.take(TickSample {
                tick,
                pose,
                watched: u32::try_from(self.contactor).unwrap(),
                watched_um: trace.amplitudes_um.map(rounded),
                ..TickSample::default()
            });
        }
    }

    fn pose(&self) -> Pose {
        let newest = self.history.newest();
        newest.map_or_else(Pose::default, |entry| entry.glimpse.pose)
    }

    fn all(&mut self, ui: &mut Ui) {
        let height = ui.available_height() / 4.0;
        let pane = |ui: &mut Ui, content: &mut dyn FnMut(&mut Ui)| {
            let size = vec2(ui.available_width(), height);
            let layout = egui::Layout::top_down(egui::Align::Min);
            ui.allocate_ui_with_layout(size, layout, content);
        };
        ui.spacing_mut().item_spacing = Vec2::ZERO;
        pane(ui, &mut |ui| self.show_contact(ui, ColourMap::Viridis));
        pane(ui, &mut |ui| self.show_drive(ui));
        pane(ui, &mut |ui| self.show_wave(ui));
        pane(ui, &mut |ui| self.show_spatial(ui));
    }

    fn show_contact(&mut self, ui: &mut Ui, map: ColourMap) {
        let view = ContactSpectrumView {
            history: &self.history,
            contactor: self.contactor,
            filters: &self.scene.filters,
            map,
            scene_serial: 1,
        };
        contact::show(ui, &mut self.contact, &mut self.inspector, &view);
    }

    fn show_drive(&mut self, ui: &mut Ui) {
        let view = DriveSpectrumView {
            history: &self.history,
            scale: AmplitudeScale::default(),
            map: ColourMap::Viridis,
        };
        drive::show(ui, &mut self.drive, &view);
    }

    fn show_wave(&mut self, ui: &mut Ui) {
        let tick = self.history.newest().map_or(1, |entry| entry.glimpse.tick);
        let watched = u32::try_from(self.contactor).unwrap();
        let drive = |tick| crate::bench::signals::drive::drive_um(&self.history, watched, tick);
        let view = DriveWaveView {
            before_um: drive(tick.saturating_sub(1)),
            now_um: drive(tick),
            limit_um: [20.0, 50.0],
        };
        wave::show(ui, &mut self.wave, &view);
    }

    fn show_spatial(&mut self, ui: &mut Ui) {
        let source = SpatialSource {
            scene: &self.scene,
            scene_serial: 1,
            contactor: self.contactor,
            pose: self.pose(),
        };
        spatial::show(ui, &mut self.spatial, &mut self.inspector, &source);
    }

    /// One frame of a window of this size, with the pointer in its middle.
    fn frame(&mut self, size: Vec2, mut content: impl FnMut(&mut Self, &mut Ui)) {
        let ctx = self.ctx.clone();
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

    /// Columns, texture writes and views so far.
    fn work(&self) -> [u64; 5] {
        [
            self.contact.n_columns_computed(),
            self.contact.n_uploads(),
            self.drive.n_columns_computed(),
            self.drive.n_uploads(),
            self.spatial.n_views_computed(),
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
    let mut bench = Bench::shipped();
    bench.explore(0..100);
    bench.frame(SIZE, Bench::all);
    let work = bench.work();
    assert_eq!(work, [100, 1, 100, 1, 1]);
    for _ in 0..5 {
        bench.frame(SIZE, Bench::all);
    }
    assert_eq!(bench.work(), work, "nothing moved");
    bench.explore(100..102);
    bench.frame(SIZE, Bench::all);
    assert_eq!(bench.work(), [102, 2, 102, 2, 2]);
}

#[test]
fn what_nobody_sees_is_not_computed() {
    let mut bench = Bench::shipped();
    bench.explore(0..400);
    bench.frame(SIZE, Bench::show_wave);
    bench.frame(vec2(30.0, 20.0), Bench::all);
    assert_eq!(bench.work(), [0; 5]);
}

#[test]
fn other_colours_and_another_contactor_begin_anew() {
    let mut bench = Bench::shipped();
    bench.explore(0..50);
    bench.frame(SIZE, |bench, ui| bench.show_contact(ui, ColourMap::Viridis));
    bench.frame(SIZE, |bench, ui| bench.show_contact(ui, ColourMap::Grey));
    assert_eq!(bench.contact.n_columns_computed(), 100);
    bench.contactor = 3;
    bench.explore(50..51);
    bench.frame(SIZE, |bench, ui| bench.show_contact(ui, ColourMap::Grey));
    assert_eq!(bench.contact.n_columns_computed(), 151);
    bench.frame(SIZE, Bench::show_drive);
    bench.history.clear();
    bench.frame(SIZE, Bench::all);
    assert_eq!(
        bench.contact.n_columns_computed(),
        151,
        "nothing is left to compute"
    );
}

#[test]
fn nothing_odd_harms_the_plots() {
    let odd = Pose {
        position: Point::new(f64::NAN, 1.0),
        velocity: Velocity::new(f64::INFINITY, f64::NAN),
        ..Pose::default()
    };
    for mut bench in [Bench::shipped(), Bench::of(RenderScene::default())] {
        for contactor in [9, 24, 4_000_000] {
            bench.contactor = contactor;
            for size in [vec2(0.0, 0.0), vec2(1.0, 900.0), vec2(900.0, 1.0), SIZE] {
                bench.frame(size, Bench::all);
            }
            bench.history.take(TickSample {
                tick: contactor as u64,
                pose: odd,
                watched_um: [f32::NAN, f32::INFINITY],
                ..TickSample::default()
            });
            bench.frame(SIZE, Bench::all);
        }
    }
}
