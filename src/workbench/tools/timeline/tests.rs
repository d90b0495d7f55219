//! What the bar says and asks for.

use std::path::PathBuf;
use std::sync::LazyLock;

use super::*;
use crate::bench::command::PlaySource;
use crate::bench::command::{Command, PlayCommand};
use crate::bench::recording::Recording;
use crate::bench::recording::strips::Felt;
use crate::bench::signals::history::History;
use crate::tools::timeline::strips_view::{described, share_of, tick_at};
use eframe::egui::{Event, Modifiers, PointerButton, Pos2, RawInput};
use selvedge_foundation::geometry::Point;
use selvedge_render::scene::{ExplorationPath, PathRow};

/// A stroke of ten seconds: ticks 0…400.
fn recorded() -> Recording {
    let row = |t_s: f64, x_mm| PathRow {
        t_s,
        position: Point::new(x_mm, 0.0),
        ..PathRow::default()
    };
    let path = ExplorationPath::new(vec![row(0.0, 0.0), row(10.0, 800.0)]).unwrap();
    Recording::from_path(PathBuf::from("stroke.csv"), path)
}

/// Nothing was felt yet.
static NOTHING: LazyLock<History> = LazyLock::new(History::default);

fn view(take: Option<&Recording>) -> TransportView<'_> {
    TransportView {
        source: PlaySource::Pointer,
        input: None,
        is_playing: true,
        does_loop: false,
        recorded_ticks: None,
        tick: 100,
        speed_mm_per_s: 80.0,
        take,
        live: &NOTHING,
    }
}

/// The bar in a window that is `WIDTH` wide.
struct Window {
    ctx: egui::Context,
    state: Timeline,
}

const WIDTH: f32 = 1200.0;

impl Window {
    fn new() -> Self {
        let ctx = egui::Context::default();
        theme::install(&ctx);
        Self {
            ctx,
            state: Timeline::default(),
        }
    }

    fn frame(&mut self, view: &TransportView<'_>, events: Vec<Event>) -> Commands {
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(WIDTH, 100.0))),
            events,
            focused: true,
            ..RawInput::default()
        };
        let mut commands = Commands::new();
        let output = self.ctx.run_ui(input, |ui| {
            show(ui, view, &mut self.state, &mut commands);
        });
        output.drop_without_applying_deltas();
        commands
    }

    /// Presses the button of the pointer there, or lets it go.
    fn press(&mut self, view: &TransportView<'_>, at: Pos2, is_pressed: bool) -> Commands {
        let button = Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed: is_pressed,
            modifiers: Modifiers::NONE,
        };
        self.frame(view, vec![Event::PointerMoved(at), button])
    }

    fn click(&mut self, view: &TransportView<'_>, at: Pos2) -> Commands {
        self.frame(view, vec![Event::PointerMoved(at)]);
        let mut commands = self.press(view, at, true);
        commands.extend(self.press(view, at, false));
        commands
    }
}

/// Where the record button is; the others follow at every 34 points.
const RECORD: Pos2 = Pos2::new(15.0, 16.0);

fn button_at(index: u8) -> Pos2 {
    RECORD + vec2(34.0 * f32::from(index), 0.0)
}

#[test]
fn every_tick_is_found_where_it_stands() {
    for n_ticks in [2, 3, 494, 576_000] {
        for tick in [0, 1, n_ticks / 2, n_ticks - 1] {
            assert_eq!(tick_at(share_of(tick, n_ticks), n_ticks), tick);
        }
    }
    assert_eq!((share_of(0, 494), share_of(493, 494)), (0.0, 1.0));
    for n_ticks in [0, 1] {
        assert_eq!(tick_at(0.7, n_ticks), 0);
        assert_eq!(share_of(0, n_ticks), 0.0);
    }
}

#[test]
fn the_buttons_ask_for_what_they_show() {
    let mut window = Window::new();
    let take = recorded();
    let replay = TransportView {
        source: PlaySource::Recording,
        ..view(Some(&take))
    };
    let expected = [
        PlayCommand::ToggleRecording,
        PlayCommand::Toggle,
        PlayCommand::Step,
        PlayCommand::Rewind,
        PlayCommand::Loop(true),
    ];
    window.frame(&replay, Vec::new());
    for (index, command) in (0..).zip(expected) {
        let commands = window.click(&replay, button_at(index));
        assert_eq!(commands, [Command::from(command)]);
    }
}

#[test]
fn what_makes_no_sense_now_asks_for_nothing() {
    let mut window = Window::new();
    let live = view(None);
    window.frame(&live, Vec::new());
    let recording = pos2(190.0, 52.0);
    for at in [button_at(2), button_at(3), button_at(4), recording] {
        assert_eq!(window.click(&live, at), [], "{at:?}");
    }
    let take = recorded();
    let with_take = view(Some(&take));
    let commands = window.click(&with_take, recording);
    assert_eq!(
        commands,
        [PlayCommand::Source(PlaySource::Recording).into()]
    );
}

#[test]
fn scrubbing_asks_once_for_each_tick() {
    let mut window = Window::new();
    let take = recorded();
    let replay = TransportView {
        source: PlaySource::Recording,
        ..view(Some(&take))
    };
    window.frame(&replay, Vec::new());
    // Left of everything is the first tick, wherever the plot begins exactly.
    let (inside, far_left) = (pos2(700.0, 34.0), pos2(0.0, 34.0));
    window.frame(&replay, vec![Event::PointerMoved(inside)]);
    let commands = window.press(&replay, inside, true);
    let [Command::Play(PlayCommand::Seek(tick))] = commands[..] else {
        panic!("{commands:?}");
    };
    assert!((150..250).contains(&tick), "{tick}");
    let commands = window.frame(&replay, vec![Event::PointerMoved(far_left)]);
    assert_eq!(commands, [PlayCommand::Seek(0).into()]);
    assert_eq!(window.frame(&replay, Vec::new()), []);
    window.press(&replay, far_left, false);
    assert_eq!(window.frame(&replay, Vec::new()), []);
}

#[test]
fn the_timeline_shows_the_take_only_while_it_moves_the_display() {
    let take = recorded();
    let replay = TransportView {
        source: PlaySource::Recording,
        ..view(Some(&take))
    };
    assert!(replay.shown_take().is_some());
    assert!(view(Some(&take)).shown_take().is_none());
    let recording = TransportView {
        recorded_ticks: Some(3),
        ..replay
    };
    assert!(recording.shown_take().is_none());
    assert_eq!(recording.counted().0, 3);
}

#[test]
fn strips_are_drawn_anew_only_when_they_change() {
    let mut window = Window::new();
    let take = recorded();
    let replay = TransportView {
        source: PlaySource::Recording,
        ..view(Some(&take))
    };
    window.frame(&replay, Vec::new());
    let first = window.state.picture.as_ref().map(Picture::address);
    window.frame(&TransportView { tick: 7, ..replay }, Vec::new());
    assert_eq!(window.state.picture.as_ref().map(Picture::address), first);
    let other = recorded();
    let other = TransportView {
        take: Some(&other),
        ..replay
    };
    window.frame(&other, Vec::new());
    assert_ne!(window.state.picture.as_ref().map(Picture::address), first);
}

#[test]
fn hovering_reads_both_levels_or_says_why_there_are_none() {
    let felt = Felt {
        speed_mm_per_s: 80.0,
        mean_um: Some([0.1, 0.0]),
    };
    let words = described("00:01.000", felt, "of some");
    for part in [
        "80.0 mm/s",
        "40 Hz  −20.0 dB   0.10 µm",
        "320 Hz  silent",
        "of some",
    ] {
        assert!(words.contains(part), "{words}");
    }
    let unknown = Felt {
        mean_um: None,
        ..felt
    };
    let words = described("00:01.000", unknown, "of some");
    assert!(
        words.contains("depends on the scene") && !words.contains("dB"),
        "{words}"
    );
}

#[test]
fn a_still_bar_asks_for_no_frame() {
    let mut window = Window::new();
    let take = recorded();
    for source in [PlaySource::Pointer, PlaySource::Recording] {
        let still = TransportView {
            source,
            ..view(Some(&take))
        };
        // The toolkit itself asks for some frames at first.
        for _ in 0..5 {
            window.frame(&still, Vec::new());
        }
        assert!(!window.ctx.has_requested_repaint(), "{source:?}");
    }
}

#[test]
fn no_width_is_too_small() {
    let mut window = Window::new();
    let take = recorded();
    for width in [0.0, 40.0, 300.0, 430.0] {
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(width, 100.0))),
            ..RawInput::default()
        };
        for source in [PlaySource::Pointer, PlaySource::Recording] {
            let narrow = TransportView {
                source,
                ..view(Some(&take))
            };
            let mut commands = Commands::new();
            let output = window.ctx.run_ui(input.clone(), |ui| {
                show(ui, &narrow, &mut window.state, &mut commands);
            });
            output.drop_without_applying_deltas();
            assert_eq!(commands, []);
        }
    }
}
