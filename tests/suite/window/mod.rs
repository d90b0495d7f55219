//! The real window under test: no display, no graphics card, simulated time, our own rasteriser.

mod accuracy;
mod analysis;
mod armed;
mod around;
mod basics;
mod collection;
mod compare;
mod contactors;
mod export;
mod import;
mod lab;
mod overlays;
mod picture;
#[cfg(unix)]
mod ports;
#[cfg(target_os = "linux")]
mod random_input;
mod timeline;
mod views;
mod workbench;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;

use eframe::egui::accesskit::Role;
use eframe::egui::{
    Color32, Context, Event, FullOutput, Key, Modifiers, Pos2, TexturesDelta, ViewportId, vec2,
};
use egui_kittest::kittest::Queryable as _;
use egui_kittest::{Harness, TestRenderer};
use selvedge_workbench::{Drive, Rasteriser, Workbench};

use crate::program::Lab;

/// The rasteriser of the window's own screenshots as the renderer of the tests.
pub(crate) struct Soft(pub(crate) Rasteriser);

impl TestRenderer for Soft {
    fn handle_delta(&mut self, delta: &mut TexturesDelta) {
        self.0.apply(delta);
    }

    fn render(&mut self, ctx: &Context, output: &FullOutput) -> Result<image::RgbaImage, String> {
        let primitives = ctx.tessellate(output.shapes.clone(), output.pixels_per_point);
        let size = ctx.content_rect().size() * output.pixels_per_point;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a window's size"
        )]
        let [width, height] = [size.x, size.y].map(|pixels| pixels.round() as u32);
        let picture = self.0.draw(
            &primitives,
            [width as usize, height as usize],
            output.pixels_per_point,
            Color32::BLACK,
        );
        image::RgbaImage::from_raw(width, height, picture.rgba).ok_or_else(|| "size".to_owned())
    }
}

/// A folder with a scene whose one textile fills the workspace.
struct Folder(Lab);

impl Folder {
    fn new(name: &str) -> Self {
        Self::with_size(name, [200.0, 200.0])
    }

    /// The same with a textile of this size.
    fn with_size(name: &str, [width_mm, height_mm]: [f64; 2]) -> Self {
        let folder = Lab::named(name);
        folder.write("library/ripple/warp_forward.csv", ripple());
        folder.write("library/ripple/textile.toml", MANIFEST);
        let size = format!("origin_mm = [0.0, 0.0]\nsize_mm = [{width_mm:?}, {height_mm:?}]");
        let scene = SCENE.replace("origin_mm = [0.0, 0.0]\nsize_mm = [200.0, 200.0]", &size);
        folder.write("test.scene.toml", scene);
        Self(folder)
    }

    /// The place of a file.
    fn path(&self, name: &str) -> PathBuf {
        self.0.path(name)
    }

    fn scene(&self) -> PathBuf {
        self.path("test.scene.toml")
    }
}

const MANIFEST: &str = r#"name = "Ripple"
construction = "other"
fibre = "none"
licence = "CC0-1.0"
notes = "A sine and its octave."
[source]
kind = "profiles"
warp_forward = "warp_forward.csv"
"#;

const SCENE: &str = r#"name = "Test"
library = "library"
size_mm = [200.0, 200.0]
[[textile]]
id = "ripple"
origin_mm = [0.0, 0.0]
size_mm = [200.0, 200.0]
label = "1"
[[display]]
geometry = "exeter-24"
"#;

/// 20 mm of a sine of 0.5 mm and one of 2 mm, so that both bands are felt.
fn ripple() -> String {
    let mut text = String::from("x_mm,height_um\n");
    for i in 0..4_600 {
        let x_mm = f64::from(i) / 230.0;
        let height = 5.0 * (x_mm * 4.0 * std::f64::consts::PI).sin()
            + 5.0 * (x_mm * std::f64::consts::PI).sin();
        writeln!(text, "{x_mm},{height}").unwrap();
    }
    text
}

/// The window on a scene.
pub(crate) fn window(scene: &Path) -> Harness<'static, Workbench> {
    let scene = scene.to_owned();
    Harness::builder()
        .with_size(vec2(1400.0, 900.0))
        .with_step_dt(1.0 / 40.0)
        .with_max_steps(200)
        .renderer(Soft(Rasteriser::default()))
        .build_eframe(move |cc| Workbench::new(&cc.egui_ctx, Some(&scene), Drive::Stepped).unwrap())
}

/// A place over the textile.
fn on_cloth(harness: &Harness<'_, Workbench>) -> Pos2 {
    let workspace = harness.get_by_label("Workspace with 1 textiles").rect();
    workspace.min + vec2(0.35 * workspace.width(), 0.5 * workspace.height())
}

/// Moves the pointer to the right over the cloth, about 70 mm/s.
fn stroke(harness: &mut Harness<'_, Workbench>, n_ticks: u16) {
    let start = on_cloth(harness);
    for tick in 0..n_ticks {
        harness.hover_at(start + vec2(5.0 * f32::from(tick), 0.0));
        harness.step();
    }
}

fn loudest_um(harness: &Harness<'_, Workbench>) -> f64 {
    harness
        .state()
        .amplitudes_um()
        .into_iter()
        .flatten()
        .fold(0.0, f64::max)
}

/// Brings a pane to the front by its tab, or finds it by its name where it has none.
fn click_tab(harness: &mut Harness<'_, Workbench>, title: &str) {
    let Some(tab) = harness.query_by_label(title) else {
        press(harness, Modifiers::COMMAND, Key::K);
        let sought = Event::Text(format!("{title} pane"));
        harness.event(sought);
        harness.run_steps(2);
        return press(harness, Modifiers::NONE, Key::Enter);
    };
    tab.click();
    harness.run_steps(2);
}

fn press(harness: &mut Harness<'_, Workbench>, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.run_steps(3);
}

/// Steps in real time until `is_done`, since the emulated device lives in it.
fn wait(harness: &mut Harness<'_, Workbench>, is_done: fn(&Workbench) -> bool) {
    for _ in 0..600 {
        harness.step();
        if is_done(harness.state()) {
            return;
        }
        thread::sleep(Duration::from_millis(5));
    }
    panic!(
        "it never happened; notices: {:?}",
        harness.state().notices()
    );
}

fn repaint_delay(harness: &Harness<'_, Workbench>) -> Duration {
    harness.output().viewport_output[&ViewportId::ROOT].repaint_delay
}

/// Types over what the field with the focus holds.
fn type_over(harness: &mut Harness<'_, Workbench>, text: &str) {
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.step();
    harness.event(Event::Text(text.to_owned()));
    harness.step();
}

/// Types into a field over what it holds.
fn type_into(harness: &mut Harness<'_, Workbench>, label: &str, text: &str) {
    harness
        .get_by_role_and_label(Role::TextInput, label)
        .focus();
    type_over(harness, text);
    harness.run_steps(3);
}

/// Answers the field that asks for a path.
/// Presses “Keep…” as it is called here, feels what is asked about, and answers.
fn keep(harness: &mut Harness<'_, Workbench>, ask: &str, answer: &str) {
    for name in [ask, answer] {
        harness
            .get_by_role_and_label(Role::Button, name)
            .click_accesskit();
        harness.run_steps(6);
    }
}

fn type_path(harness: &mut Harness<'_, Workbench>, path: &str) {
    type_over(harness, path);
    press(harness, Modifiers::NONE, Key::Enter);
}

/// Types the path of a port and connects to it.
fn connect_to(harness: &mut Harness<'_, Workbench>, path: &str) {
    harness.get_by_label("Port").click();
    harness.run();
    harness.get_by_label("Port").type_text(path);
    harness.run();
    harness
        .get_by_role_and_label(Role::Button, "Connect")
        .click();
}
