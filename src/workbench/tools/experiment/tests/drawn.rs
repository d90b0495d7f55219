//! Sessions as they are drawn: pictures tell nothing of what is right.

use std::path::Path;

use eframe::egui::{Color32, Theme};

use super::*;
use crate::kit::view_transform::ViewTransform;

/// A window whose frames are drawn, and what they are drawn with.
struct Drawn {
    size: [usize; 2],
    window: Headless,
    rasteriser: crate::shell::raster::Rasteriser,
}

const SIZE: [usize; 2] = [1400, 900];

impl Drawn {
    /// A trial of a design, for this participant.
    fn trial(folder: &Folder, design: &'static str, pseudonym: &str, theme: Theme) -> Self {
        let chosen = small(folder, design);
        let mut drawn = Self::begun(folder, chosen, pseudonym, (theme, SIZE));
        drawn.go_to_trial();
        drawn
    }

    /// A session of a design that was just begun.
    fn begun(
        folder: &Folder,
        chosen: Chosen,
        pseudonym: &str,
        (theme, size): (Theme, [usize; 2]),
    ) -> Self {
        let window = Headless::new(None, vec2(size[0] as f32, size[1] as f32), 1.0).unwrap();
        window.ctx.set_theme(theme);
        let mut drawn = Self {
            size,
            window,
            rasteriser: crate::shell::raster::Rasteriser::default(),
        };
        drawn.pass(2);
        let form = &mut experiment_mut(&mut drawn.window).form;
        form.choose(chosen);
        form.folder = folder.0.display().to_string();
        form.who.pseudonym = pseudonym.to_owned();
        begin(&mut drawn.window);
        drawn.pass(3);
        let failure = &experiment(&drawn.window).form.failure;
        assert_eq!(*failure, None);
        drawn
    }

    /// Goes on until a trial waits.
    fn go_to_trial(&mut self) {
        for _ in 0..6 {
            pass(&mut self.window);
            self.pass(2);
        }
    }

    fn pass(&mut self, n_frames: u32) {
        for _ in 0..n_frames {
            let mut output = self.window.run();
            self.rasteriser.apply(&mut output.textures_delta);
        }
    }

    fn picture(&mut self) -> crate::shell::raster::Picture {
        let mut output = self.window.run();
        self.rasteriser.apply(&mut output.textures_delta);
        let shapes = output.shapes;
        let primitives = self.window.ctx.tessellate(shapes, output.pixels_per_point);
        self.rasteriser
            .draw(&primitives, self.size, 1.0, Color32::BLACK)
    }

    /// A picture with many colours: letters, cloth and controls stand out from the ground. It is
    /// kept where a folder for pictures was named.
    fn keep_picture(&mut self, name: &str) {
        let picture = self.picture();
        let mut colours: Vec<&[u8]> = picture.rgba.chunks(4).collect();
        colours.sort_unstable();
        colours.dedup();
        assert!(colours.len() > 50, "{name}: {} colours", colours.len());
        if let Ok(out) = std::env::var("SELVEDGE_PICTURES") {
            let path = Path::new(&out).join(format!("{name}.png"));
            let [width, height] = self.size;
            let bytes =
                selvedge_foundation::files::encode_png_rgba(&picture.rgba, width, height, &path);
            fs::write(path, bytes.unwrap()).unwrap();
        }
    }
}

impl Frames for Drawn {
    fn window(&mut self) -> &mut Headless {
        &mut self.window
    }

    fn frames(&mut self, n: u32) {
        self.pass(n);
    }
}

/// Letters may lie elsewhere among the letters' texture, which rounds their edges otherwise.
const ROUNDING: u8 = 8;

/// Where two pictures differ: the bounds of all such pixels, [left, top, right, bottom].
fn differing(
    one: &crate::shell::raster::Picture,
    two: &crate::shell::raster::Picture,
    right: usize,
) -> [usize; 4] {
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
    let target = |drawn: &Drawn| session(&drawn.window).trial().unwrap().task.reference;
    let trial = |name: &str| {
        let folder = Folder::new(&format!("drawn-{name}"));
        let mut drawn = Drawn::trial(&folder, "ranking-virtual-target", name, Theme::Dark);
        let picture = drawn.picture();
        let pane = drawn.window.workbench.bench.pointer.ground.unwrap();
        let size_mm = session(&drawn.window).layout.size_mm;
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
    let low = view.screen(Point::new(10.0, 10.0));
    let high = view.screen(Point::new(330.0, 330.0));
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

/// A design in a file of its own.
fn written(folder: &Folder, text: &str) -> Chosen {
    fs::create_dir_all(&folder.0).unwrap();
    let path = folder.0.join("design.toml");
    fs::write(&path, text).unwrap();
    Chosen::File(path)
}

/// Judgements of four fabrics.
fn judgements(protocol: &str) -> String {
    let stimulus = |(id, material, condition): (&str, &str, &str)| {
        format!(
            "[[stimulus]]\nid = \"{id}\"\ntextile = \"{id}\"\nmaterial = \"{material}\"\n\
             condition = \"{condition}\"\n"
        )
    };
    let stimuli: String = [
        ("silk-crepe", "silk", "measured"),
        ("polyamide-taffeta", "silk", "generated"),
        ("wool-twill", "wool", "measured"),
        ("wool-rib", "wool", "generated"),
    ]
    .map(stimulus)
    .concat();
    format!(
        "study = \"s\"\nexperiment = \"judgement\"\nmedium = \"array\"\nseed = 1\n{stimuli}\
         [judgement]\nreal = \"measured\"\nprotocol = \"{protocol}\"\nrepeats = 1\n\
         confidence_grades = 3\n"
    )
}

/// Three fabrics, and a movement to practise.
const TRIADS: &str = "study = \"s\"\nexperiment = \"triads\"\nmedium = \"array\"\nseed = 1\n\
    textiles = [\"silk-crepe\", \"wool-twill\", \"jute-plain\"]\n\
    [odd_one_out]\nweights = [1.0, 0.5, 0.1]\n\
    [course]\ninstructions = \"Find the odd one.\"\n\
    [[course.familiarisation]]\nmovement = \"circular\"\nfor_s = 30.0\nspeed_mm_per_s = 100.0\n";

/// What a participant has said when a picture is taken.
fn said(design: &str) -> Vec<Mark> {
    match design {
        "rating" => vec![Mark::Rate(1, 30.0), Mark::Rate(0, 80.0)],
        "magnitude" => vec![Mark::Type("12.5".to_owned())],
        "adjustment-two-gains" => vec![Mark::Turn(0, 3)],
        "real-or-generated" => vec![Mark::Place(0), Mark::Confidence(2)],
        _ => vec![Mark::Place(1), Mark::Place(3)],
    }
}

const KINDS: [&str; 8] = [
    "ranking-virtual-target",
    "ranking-real-target",
    "odd-one-out",
    "adjustment-two-gains",
    "gain-matching",
    "rating",
    "magnitude",
    "jnd-40",
];

#[test]
fn every_kind_of_trial_is_drawn_in_both_themes_in_wide_and_narrow_windows() {
    let looks = [(Theme::Dark, SIZE), (Theme::Light, [980, 700])];
    for (design, (theme, size)) in KINDS.into_iter().zip(looks.into_iter().cycle()) {
        let folder = Folder::new(&format!("kind-{design}"));
        let chosen = small(&folder, design);
        let mut drawn = Drawn::begun(&folder, chosen, "p01", (theme, size));
        drawn.go_to_trial();
        explore(&mut drawn.window, 8);
        for one in said(design) {
            mark(&mut drawn.window, one);
        }
        drawn.keep_picture(&format!("{design}-{theme:?}-{}", size[0]));
        assert!(session(&drawn.window).trial().is_some(), "{design}");
    }
}

#[test]
fn judgements_are_drawn_of_one_fabric_and_of_pairs() {
    for (name, size) in [("single", [980, 700]), ("pair", SIZE)] {
        let folder = Folder::new(&format!("judgement-{name}"));
        let chosen = written(&folder, &judgements(name));
        let mut drawn = Drawn::begun(&folder, chosen, "p01", (Theme::Dark, size));
        drawn.go_to_trial();
        for one in said("real-or-generated") {
            mark(&mut drawn.window, one);
        }
        mark(&mut drawn.window, Mark::Place(0));
        drawn.keep_picture(&format!("judgement-{name}"));
        assert!(session(&drawn.window).trial().is_some());
    }
}

#[test]
fn cloth_in_turn_is_drawn_once_below_the_numbers_of_its_intervals() {
    let text = presented::composed("roughness-intervals");
    for (theme, size) in [(Theme::Dark, SIZE), (Theme::Light, [980, 700])] {
        let folder = Folder::new("drawn-in-turn");
        let chosen = written(&folder, &text);
        let mut drawn = Drawn::begun(&folder, chosen, "p01", (theme, size));
        drawn.go_to_trial();
        // Into the second interval.
        let corner = session(&drawn.window).layout.places[0].origin_mm;
        let is_second = |drawn: &Drawn| {
            let intervals = session(&drawn.window).intervals();
            intervals.and_then(|one| one.played) == Some(1)
        };
        for n in 0..200 {
            if is_second(&drawn) {
                break;
            }
            stroke(&mut drawn, corner, n..n + 1);
        }
        assert!(is_second(&drawn));
        let view = experiment(&drawn.window).participant(&EngineView::default(), 0.0);
        let ParticipantView::Trial(trial) = view else {
            panic!("{view:?}")
        };
        let slots: Vec<_> = trial.ground.slots.iter().map(|slot| slot.number).collect();
        assert_eq!(slots, [None], "one cloth, without a number");
        drawn.keep_picture(&format!("in-turn-{theme:?}-{}", size[0]));
    }
}

#[test]
fn every_step_around_the_trials_is_drawn_from_the_form_to_the_end() {
    let folder = Folder::new("steps");
    let chosen = written(&folder, TRIADS);
    let mut drawn = Drawn::begun(&folder, chosen, "p01", (Theme::Dark, SIZE));
    let name = |step: &str| format!("step-{step}");
    drawn.keep_picture(&name("1-instructions"));
    pass(&mut drawn.window);
    drawn.pass(2);
    drawn.keep_picture(&name("2-familiarisation"));
    act(&mut drawn.window, |one, bench| one.pause(true, bench));
    drawn.pass(2);
    drawn.keep_picture(&name("3-pause"));
    act(&mut drawn.window, |one, bench| one.pause(false, bench));
    drawn.pass(2);
    let mut has_rested = false;
    while !matches!(session(&drawn.window).now, Now::Finished) {
        if session(&drawn.window).trial().is_none() {
            if matches!(session(&drawn.window).now, Now::Break { .. }) && !has_rested {
                has_rested = true;
                drawn.keep_picture(&name("4-break"));
            }
            pass(&mut drawn.window);
        } else {
            feel(&mut drawn);
            mark(&mut drawn.window, Mark::Place(1));
            mark(&mut drawn.window, Mark::Confidence(3));
            answer(&mut drawn.window);
        }
        drawn.pass(3);
    }
    drawn.keep_picture(&name("5-end"));
    end(&mut drawn.window);
    drawn.pass(3);
    let form = &mut experiment_mut(&mut drawn.window).form;
    form.choose(Chosen::Shipped("ranking-real-target"));
    drawn.keep_picture(&name("6-form"));
    assert_eq!(experiment(&drawn.window).form.found.len(), 1);
}

#[test]
fn a_blank_screen_shows_nothing_and_feels_all_the_same_and_the_experimenter_types() {
    let folder = Folder::new("drawn-blank");
    let mut drawn = Drawn::trial(&folder, "odd-one-out", "p01", Theme::Dark);
    assert!(drawn.window.workbench.bench.pointer.ground.is_some());
    experiment_mut(&mut drawn.window).is_blank = true;
    drawn.pass(2);
    let ground = drawn.window.workbench.bench.pointer.ground;
    assert!(ground.is_some(), "what lies there is still felt");
    let picture = drawn.picture();
    let colour = |x: usize, y: usize| picture.rgba[4 * (y * SIZE[0] + x)..][..4].to_vec();
    let floor = colour(20, 100);
    let is_blank = (20..1000).step_by(3).all(|x| {
        let mut column = (80..780).step_by(3);
        column.all(|y| colour(x, y) == floor)
    });
    assert!(is_blank, "something is seen");
    drawn.keep_picture("blank");

    feel(&mut drawn);
    let grade = Mark::Confidence(1);
    mark(&mut drawn.window, Mark::Place(1));
    mark(&mut drawn.window, grade);
    answer(&mut drawn.window);
    drawn.pass(4);
    let progress = session(&drawn.window).progress;
    assert_eq!(progress.0, 1, "typed by the experimenter");
    experiment_mut(&mut drawn.window).is_blank = false;
    drawn.pass(2);
    let mut seen = drawn
        .picture()
        .rgba
        .chunks(4)
        .map(<[u8]>::to_vec)
        .collect::<Vec<_>>();
    seen.sort_unstable();
    seen.dedup();
    assert!(seen.len() > 50);
}
