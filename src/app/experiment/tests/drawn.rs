//! Sessions as they are drawn: pictures tell nothing of what is right.

use std::path::Path;

use eframe::egui::{Color32, Theme};

use super::*;
use crate::app::workspace::ViewTransform;

/// A window whose frames are drawn, and what they are drawn with.
struct Drawn {
    window: Headless,
    rasteriser: crate::app::Rasteriser,
}

const SIZE: [usize; 2] = [1400, 900];

impl Drawn {
    /// A trial of a design, for this participant.
    fn trial(folder: &Folder, design: &'static str, pseudonym: &str, theme: Theme) -> Self {
        let window = Headless::new(None, vec2(1400.0, 900.0), 1.0).unwrap();
        window.ctx.set_theme(theme);
        let mut drawn = Self {
            window,
            rasteriser: crate::app::Rasteriser::default(),
        };
        drawn.pass(2);
        let form = &mut drawn.window.bench.transient.experiment.form;
        form.choose(small(folder, design));
        form.folder = folder.0.display().to_string();
        form.who.pseudonym = pseudonym.to_owned();
        drawn.window.dispatch(ExperimentCommand::Begin);
        drawn.pass(3);
        for _ in 0..6 {
            drawn.window.dispatch(ExperimentCommand::Pass);
            drawn.pass(2);
        }
        drawn
    }

    fn pass(&mut self, n_frames: u32) {
        for _ in 0..n_frames {
            let mut output = self.window.run();
            self.rasteriser.apply(&mut output.textures_delta);
        }
    }

    fn picture(&mut self) -> crate::app::Picture {
        let mut output = self.window.run();
        self.rasteriser.apply(&mut output.textures_delta);
        let shapes = output.shapes;
        let primitives = self.window.ctx.tessellate(shapes, output.pixels_per_point);
        let picture = self.rasteriser.draw(&primitives, SIZE, 1.0, Color32::BLACK);
        if let Ok(out) = std::env::var("SELVEDGE_PICTURES") {
            let task = held(&self.window)
                .trial()
                .map(|trial| format!("{:?}", trial.task));
            let word = task
                .as_deref()
                .and_then(|task| task.split(' ').next())
                .unwrap_or("x");
            let path = Path::new(&out).join(format!("{word}-{:?}.png", self.window.ctx.theme()));
            let bytes = crate::files::encode_png_rgba(&picture.rgba, SIZE[0], SIZE[1], &path);
            fs::write(path, bytes.unwrap()).unwrap();
        }
        picture
    }
}

/// Letters may lie elsewhere among the letters' texture, which rounds their edges otherwise.
const ROUNDING: u8 = 8;

/// Where two pictures differ: the bounds of all such pixels, [left, top, right, bottom].
fn differing(one: &crate::app::Picture, two: &crate::app::Picture, right: usize) -> [usize; 4] {
    let mut bounds = [usize::MAX, usize::MAX, 0, 0];
    for (n, (a, b)) in one.rgba.chunks(4).zip(two.rgba.chunks(4)).enumerate() {
        let (x, y) = (n % SIZE[0], n / SIZE[0]);
        let is_other = (a.iter().zip(b)).any(|(a, b)| a.abs_diff(*b) > ROUNDING);
        if is_other && x < right {
            bounds = [
                bounds[0].min(x),
                bounds[1].min(y),
                bounds[2].max(x),
                bounds[3].max(y),
            ];
        }
    }
    bounds
}

#[test]
fn pictures_of_two_trials_with_other_targets_differ_in_the_targets_picture_alone() {
    let target = |drawn: &Drawn| match held(&drawn.window).trial().map(|trial| &trial.task) {
        Some(Task::Rank { target, .. }) => *target,
        _ => panic!("a ranking"),
    };
    let trial = |name: &str| {
        let folder = Folder::new(&format!("drawn-{name}"));
        let mut drawn = Drawn::trial(&folder, "ranking-virtual-target", name, Theme::Dark);
        let picture = drawn.picture();
        let pane = drawn.window.bench.transient.ground.unwrap();
        let size_mm = held(&drawn.window).layout.size_mm;
        (
            target(&drawn),
            picture,
            ViewTransform::fitted(pane, size_mm),
        )
    };
    let (one, first, view) = trial("p01");
    let (two, second, _) = (["p02", "p03", "p04", "p05"].into_iter().map(trial))
        .find(|(two, ..)| *two != one)
        .unwrap();
    assert_ne!(one, two);
    // The experimenter's view, on the right, names the participant.
    let right = SIZE[0] - 340;
    let bounds = differing(&first, &second, right);
    let low = view.screen(crate::geometry::Point::new(10.0, 10.0));
    let high = view.screen(crate::geometry::Point::new(330.0, 330.0));
    let near = |at: usize, edge: f32| (at as f32 - edge).abs() < 3.0;
    assert!(
        near(bounds[0], low.x) && near(bounds[2], high.x),
        "{bounds:?} {low} {high}"
    );
    assert!(
        near(bounds[1], high.y) && near(bounds[3], low.y),
        "{bounds:?} {low} {high}"
    );
}

#[test]
fn every_kind_of_trial_is_drawn_in_both_themes() {
    let kinds = [
        ("odd-one-out", Theme::Light),
        ("ranking-real-target", Theme::Light),
        ("adjustment-two-gains", Theme::Dark),
        ("rating", Theme::Dark),
        ("magnitude", Theme::Light),
    ];
    for (design, theme) in kinds {
        let folder = Folder::new(&format!("kind-{design}"));
        let mut drawn = Drawn::trial(&folder, design, "p01", theme);
        explore(&mut drawn.window, 8);
        mark(&mut drawn.window, Mark::Place(2));
        mark(&mut drawn.window, Mark::Rate(1, 30.0));
        let picture = drawn.picture();
        // Letters, cloth and controls stand out from the ground.
        let mut colours: Vec<&[u8]> = picture.rgba.chunks(4).collect();
        colours.sort_unstable();
        colours.dedup();
        assert!(colours.len() > 50, "{design}: {} colours", colours.len());
        assert!(held(&drawn.window).trial().is_some(), "{design}");
    }
}
