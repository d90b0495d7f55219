//! The real window on the shipped scene, one pane of it alone: no display, and simulated time.
//!
//! What is shown depends on the tick at which it is looked at. So that a picture does not change
//! with what was clicked for the one before it, every picture is taken at a tick of its own.

use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, Rect, Theme, Vec2, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use image::RgbaImage;
use selvedge_workbench::{Drive, Rasteriser, Workbench};

use crate::golden::compare::Golden;
use crate::window::Soft;

/// Heights of the line on top, of a row of tabs and of the timeline, points.
const HEADER: f32 = 44.0;
const TABS: f32 = 24.0;
const TIMELINE: f32 = 144.0;
/// Height of the line at the foot, points.
const STATUS: f32 = 24.0;
/// Frames in a second.
const RATE_HZ: f32 = 40.0;

/// A window, and what is in front in it.
pub(super) struct Stage {
    pub(super) harness: Harness<'static, Workbench>,
    has_timeline: bool,
    /// What is another one every time, such as the path of a test's folder, points.
    hidden: Vec<Rect>,
    /// Frames before the first that counts.
    start: u32,
}

impl Stage {
    /// A window of this size in pixels on a scene, the shipped one if none is named.
    pub(super) fn new(scene: Option<&Path>, size_px: [u16; 2], pixels_per_point: f32) -> Self {
        let scene = scene.map(Path::to_owned);
        let size = Vec2::from(size_px.map(f32::from)) / pixels_per_point;
        let harness = Harness::builder()
            .with_size(size)
            .with_pixels_per_point(pixels_per_point)
            .with_step_dt(1.0 / RATE_HZ)
            .with_max_steps(200)
            .renderer(Soft(Rasteriser::default()))
            .build_eframe(move |cc| {
                Workbench::new(&cc.egui_ctx, scene.as_deref(), Drive::Stepped).unwrap()
            });
        let mut stage = Self {
            harness,
            has_timeline: true,
            hidden: Vec::new(),
            start: 0,
        };
        stage.theme(Theme::Dark);
        stage
    }

    /// A window so small that every pane stands alone, behind one row of tabs.
    pub(super) fn alone(scene: Option<&Path>) -> Self {
        let mut stage = Self::new(scene, [720, 560], 1.0);
        stage.press(Modifiers::COMMAND, Key::Num2);
        stage
    }

    /// Brings a pane of this size in points to the front.
    pub(super) fn front(&mut self, title: &str, [width, height]: [u16; 2]) {
        let above = if self.has_timeline { TIMELINE } else { 0.0 };
        let size = vec2(
            width.into(),
            f32::from(height) + HEADER + TABS + STATUS + above,
        );
        self.hidden.clear();
        self.harness.set_size(size);
        self.harness.run_steps(2);
        self.harness.get_by_label(title).click_accesskit();
        self.harness.run_steps(2);
    }

    /// While a session is held, what is felt is not to be seen: there is no timeline.
    pub(super) fn without_timeline(&mut self) {
        self.has_timeline = false;
    }

    pub(super) fn press(&mut self, modifiers: Modifiers, key: Key) {
        self.harness.key_press_modifiers(modifiers, key);
        self.harness.run_steps(3);
    }

    /// Clicks what has this name and role, wherever it is scrolled to.
    pub(super) fn click(&mut self, role: Role, name: &str) {
        let found = self.harness.get_by_role_and_label(role, name);
        found.click_accesskit();
        self.harness.run_steps(4);
    }

    /// Clicks what has this name.
    pub(super) fn click_named(&mut self, name: &str) {
        self.harness.get_by_label(name).click_accesskit();
        self.harness.run_steps(4);
    }

    /// Chooses from a list by the pointer, so that the list is folded again.
    pub(super) fn choose(&mut self, list: &str, entry: &str) {
        self.harness.get_by_label(list).click();
        self.harness.run_steps(3);
        self.harness.get_by_label(entry).click();
        self.harness.run_steps(4);
        self.harness.remove_cursor();
        self.harness.run_steps(2);
    }

    /// Clicks what has a name that holds these words.
    pub(super) fn click_about(&mut self, words: &str) {
        self.harness.get_by_label_contains(words).click_accesskit();
        self.harness.run_steps(4);
    }

    /// Covers a field in the pictures of this pane.
    pub(super) fn hide_field(&mut self, name: &str) {
        let field = self.harness.get_by_role_and_label(Role::TextInput, name);
        let place = field.rect();
        self.hide(place);
    }

    /// Covers everything below a label in the pictures of this pane.
    pub(super) fn hide_below(&mut self, label: &str) {
        let top = self.harness.get_by_label(label).rect().bottom();
        let whole = self.harness.ctx.content_rect();
        self.hide(whole.with_min_y(top));
    }

    /// Types into a field over what it holds.
    pub(super) fn type_into(&mut self, label: &str, text: &str) {
        let field = self.harness.get_by_role_and_label(Role::TextInput, label);
        field.focus();
        self.harness.run_steps(2);
        self.type_over(text);
    }

    /// Types over what the field with the focus holds.
    pub(super) fn type_over(&mut self, text: &str) {
        self.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        self.harness.step();
        self.harness.event(Event::Text(text.to_owned()));
        self.harness.run_steps(3);
    }

    /// Answers the field that asks for a path.
    pub(super) fn type_path(&mut self, path: &Path) {
        self.harness.run_steps(2);
        self.type_over(&path.display().to_string());
        self.press(Modifiers::NONE, Key::Enter);
    }

    pub(super) fn theme(&mut self, theme: Theme) {
        self.harness.ctx.set_theme(theme);
        self.harness.run_steps(2);
    }

    /// Steps in real time until other threads have done their work; then ticks are counted anew.
    pub(super) fn wait(&mut self, is_done: fn(&Workbench) -> bool) {
        let patience = Instant::now() + Duration::from_mins(2);
        while !is_done(self.harness.state()) {
            assert!(Instant::now() < patience, "it never happened");
            self.harness.step();
            thread::sleep(Duration::from_millis(5));
        }
        self.restart();
    }

    /// Steps in real time until something is so in two frames on end, the latter of which shows it.
    pub(super) fn wait_to_see(&mut self, is_so: fn(&Workbench) -> bool) {
        let patience = Instant::now() + Duration::from_mins(2);
        let mut was_so = false;
        loop {
            self.harness.step();
            let is_so = is_so(self.harness.state());
            if is_so && was_so {
                return;
            }
            was_so = is_so;
            assert!(Instant::now() < patience, "it is never seen");
            thread::sleep(Duration::from_millis(2));
        }
    }

    /// Counts ticks from now on: other threads took as long as they did.
    fn restart(&mut self) {
        self.start += self.tick();
    }

    /// Covers a place of the window in the pictures of this pane.
    fn hide(&mut self, place: Rect) {
        self.hidden.push(place);
    }

    /// Frames until now, 25 ms apart.
    fn tick(&self) -> u32 {
        let now_s = self.harness.ctx.input(|input| input.time);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a whole number of frames"
        )]
        let tick = (now_s * f64::from(RATE_HZ)).round() as u32;
        tick - self.start
    }

    /// Lets time pass until a tick.
    pub(super) fn until(&mut self, tick: u32) {
        let now = self.tick();
        assert!(
            now <= tick,
            "it is tick {now} already, not yet {tick} was meant"
        );
        while self.tick() < tick {
            self.harness.step();
        }
    }

    /// The whole window.
    pub(super) fn window(&mut self) -> RgbaImage {
        self.harness.render().unwrap()
    }

    /// A part of the window, points.
    pub(super) fn part(&mut self, place: Rect) -> RgbaImage {
        let mut window = self.window();
        let scale = self.harness.ctx.pixels_per_point();
        for hidden in &self.hidden {
            cover(&mut window, *hidden * scale);
        }
        let [left, top, right, bottom] = corners(place * scale);
        image::imageops::crop_imm(&window, left, top, right - left, bottom - top).to_image()
    }

    /// The pane in front, without what is around it.
    fn pane(&mut self) -> RgbaImage {
        let size = self.harness.ctx.content_rect().size();
        let below = if self.has_timeline { TIMELINE } else { 0.0 };
        let pane = Rect::from_min_max(
            pos2(0.0, HEADER + TABS),
            pos2(size.x, size.y - STATUS - below),
        );
        self.part(pane)
    }

    /// Compares the pane in front as it is at a tick.
    pub(super) fn compare_dark(&mut self, golden: &mut Golden, name: &str, tick: u32) {
        self.until(tick);
        let dark = self.pane();
        golden.picture(&format!("{name}-dark"), &dark);
    }

    /// Compares the pane in front in both themes, the dark one at a tick.
    pub(super) fn compare(&mut self, golden: &mut Golden, name: &str, tick: u32) {
        self.compare_dark(golden, name, tick);
        self.theme(Theme::Light);
        let light = self.pane();
        golden.picture(&format!("{name}-light"), &light);
        self.theme(Theme::Dark);
    }
}

/// Paints over a place, in pixels.
fn cover(picture: &mut RgbaImage, rect: Rect) {
    let [left, top, right, bottom] = corners(rect);
    for y in top..bottom.min(picture.height()) {
        for x in left..right.min(picture.width()) {
            picture.put_pixel(x, y, image::Rgba([128, 0, 128, 255]));
        }
    }
}

/// Left, top, right and bottom of a place in whole pixels.
fn corners(rect: Rect) -> [u32; 4] {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "pixels of a window"
    )]
    let whole = |at: f32| at.max(0.0).round() as u32;
    [rect.left(), rect.top(), rect.right(), rect.bottom()].map(whole)
}
