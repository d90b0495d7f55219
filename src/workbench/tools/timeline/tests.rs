//! What the bar says and asks for.

use std::path::PathBuf;
use std::sync::LazyLock;

use super::*;
use crate::bench::command::PlaySource;
use crate::bench::command::{Command, Edit, PlayCommand, ShowCommand};
use crate::bench::recording::Recording;
use crate::bench::recording::tests::two_apart;
use crate::bench::signals::history::History;
use crate::kit::amplitude::AmplitudeScale;
use crate::kit::spectrum_scale::SpectrumScale;
use crate::kit::theme;
use crate::kit::theme::colour_map::ColourMap;
use crate::shell::headless::Headless;
use crate::tools::timeline::code::amplitude_code;
use crate::tools::timeline::columns::N_LINES;
use crate::tools::timeline::layer::RecordedTiles;
use crate::tools::timeline::scope::extent;
use eframe::egui::{
    self, Event, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, Pos2, RawInput,
    TouchPhase,
};
use selvedge_foundation::geometry::Point;
use selvedge_render::array::single;
use selvedge_render::scene::{ExplorationPath, PathRow};
use selvedge_scratch::ScratchFolder;

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
        loop_within: None,
        past_column: None,
    }
}

fn style() -> LaneStyle {
    LaneStyle {
        map: ColourMap::default(),
        scale: AmplitudeScale::default(),
        spectrum: SpectrumScale::default(),
    }
}

/// A place in the lanes.
const INSIDE: Pos2 = Pos2::new(700.0, 60.0);

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
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(WIDTH, 400.0))),
            events,
            focused: true,
            ..RawInput::default()
        };
        let mut commands = Commands::new();
        let output = self.ctx.run_ui(input, |ui| {
            let drawn = (&mut style(), &mut 132.0);
            show(ui, view, drawn, &mut self.state, &mut commands);
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

    /// Turns the wheel: up is positive.
    fn scroll(&mut self, view: &TransportView<'_>, at: Pos2, points: f32) {
        let wheel = Event::MouseWheel {
            unit: MouseWheelUnit::Point,
            delta: vec2(0.0, points),
            source: MouseWheelSource::Unknown,
            phase: TouchPhase::Move,
            modifiers: Modifiers::NONE,
        };
        self.frame(view, vec![Event::PointerMoved(at), wheel]);
        for _ in 0..5 {
            self.frame(view, Vec::new());
        }
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
    let (inside, far_left) = (pos2(700.0, 6.0), pos2(0.0, 6.0));
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
fn lanes_are_drawn_anew_only_when_they_change() {
    let mut window = Window::new();
    let take = recorded();
    let replay = TransportView {
        source: PlaySource::Recording,
        ..view(Some(&take))
    };
    window.state.sight.turn_to(1);
    let desk = Headless::shipped();
    let tiles = &mut window.state.recorded;
    assert_eq!(
        tiles.follow(&desk.workbench.bench, &take, (9, false), 0),
        None
    );
    window.frame(&replay, Vec::new());
    let first = window.state.pictures.n_uploads();
    window.frame(&TransportView { tick: 7, ..replay }, Vec::new());
    assert_eq!(window.state.pictures.n_uploads(), first);
    window.scroll(&replay, INSIDE, 120.0);
    assert!(window.state.pictures.n_uploads() > first);
}

#[test]
fn the_wheel_zooms_a_drag_pans_and_two_clicks_show_all() {
    let mut window = Window::new();
    let take = recorded();
    let replay = TransportView {
        source: PlaySource::Recording,
        ..view(Some(&take))
    };
    window.state.sight.turn_to(1);
    window.frame(&replay, Vec::new());
    let all = extent(&replay);
    for _ in 0..8 {
        window.scroll(&replay, INSIDE, 120.0);
    }
    let near = window.state.sight.span(all);
    assert!(near.length() < 0.5 * all.length(), "{near:?}");
    let left = INSIDE - vec2(90.0, 0.0);
    window.press(&replay, INSIDE, true);
    let commands = window.frame(&replay, vec![Event::PointerMoved(left)]);
    assert_eq!(commands, [], "a drag moves what is in sight alone");
    window.press(&replay, left, false);
    let moved = window.state.sight.span(all);
    assert!((moved.length() - near.length()).abs() < 1e-6 && moved.start > near.start + 1.0);
    window.click(&replay, INSIDE);
    window.click(&replay, INSIDE);
    assert_eq!(window.state.sight.span(all), all);
}

#[test]
fn a_gain_that_changes_renders_a_recording_anew_as_it_is_replayed() {
    let mut desk = Headless::shipped();
    desk.dispatch(PlayCommand::Toggle);
    desk.pass_ticks(10);
    desk.dispatch(PlayCommand::ToggleRecording);
    desk.pass_ticks(1_100);
    desk.dispatch(PlayCommand::ToggleRecording);
    desk.pass(3);
    desk.dispatch(PlayCommand::Source(PlaySource::Recording));
    desk.pass(2);
    let mut tiles = RecordedTiles::default();
    for gain_db in [0.0, -12.0] {
        desk.dispatch(Edit::MasterGain(gain_db));
        desk.pass(2);
        let take = desk.workbench.bench.exploration.at_hand.clone().unwrap();
        let failure = tiles.follow(&desk.workbench.bench, &take, (9, false), 1_050);
        assert_eq!((failure, tiles.share()), (None, None), "done in line");
        for tick in [0, 500, 1_023, 1_024, 1_090] {
            desk.dispatch(PlayCommand::Seek(tick));
            desk.pass(3);
            let live = &desk.workbench.bench.live;
            assert_eq!(live.play.tick, tick);
            let mut rows = vec![0; tiles.felt().n_rows];
            tiles.felt().strongest_into(tick..tick + 1, &mut rows);
            for (contactor, dot) in live.dots.iter().enumerate() {
                let codes = [0, 1].map(|band| rows[N_LINES + band * 24 + contactor]);
                let expected = dot.amplitude_um.map(|um| amplitude_code(single(um)));
                assert_eq!(codes, expected, "tick {tick}, contactor {contactor}");
            }
        }
    }
}

#[test]
fn lanes_and_their_export_are_of_the_display_that_is_shown() {
    let folder = ScratchFolder::made("lanes-two");
    let mut desk = two_apart(&folder, 0);
    let take = desk.workbench.bench.exploration.at_hand.clone().unwrap();
    let all = Span::of(&(0..take.path().n_ticks()));
    let sheets = [0, 1].map(|display| {
        desk.dispatch(ShowCommand::SelectDisplay(display));
        desk.pass(1);
        let bench = &desk.workbench.bench;
        let scene = bench.document.scene();
        for is_as_recorded in [true, false] {
            let mut tiles = RecordedTiles::default();
            let failure = tiles.follow(bench, &take, (9, is_as_recorded), 0);
            assert_eq!((failure, tiles.share()), (None, None), "done in line");
            for tick in all.ticks() {
                let mut rows = vec![0; tiles.felt().n_rows];
                tiles.felt().strongest_into(tick..tick + 1, &mut rows);
                let felt_um = take.display_um(tick, (scene, display)).unwrap();
                for (contactor, um) in felt_um.iter().enumerate() {
                    let codes = [0, 1].map(|band| rows[N_LINES + band * 24 + contactor]);
                    assert_eq!(
                        codes,
                        um.map(amplitude_code),
                        "display {display}, tick {tick}"
                    );
                }
            }
        }
        let replay = TransportView {
            source: PlaySource::Recording,
            ..view(Some(&take))
        };
        let origin = bench.rendered_origin();
        let exported = export::timeline(&replay, all, ((scene, display), origin)).unwrap();
        format!("{:?}", exported.sheet)
    });
    assert!(
        sheets[0].contains("80.0") && sheets[1].contains("120.0"),
        "{sheets:?}"
    );
}

#[test]
fn while_the_ruler_is_dragged_the_tick_that_is_shown_is_heard_and_no_longer() {
    let mut desk = Headless::shipped();
    desk.dispatch(PlayCommand::Toggle);
    desk.pass_ticks(10);
    desk.dispatch(PlayCommand::ToggleRecording);
    desk.pass_ticks(400);
    desk.dispatch(PlayCommand::ToggleRecording);
    desk.pass(3);
    let pointer = |at, pressed| Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    for source in [PlaySource::Stroke, PlaySource::Recording] {
        desk.dispatch(PlayCommand::Source(source));
        desk.pass(2);
        let [from, to] = [1000.0, 1100.0].map(|x| pos2(x, 744.0));
        desk.events = vec![Event::PointerMoved(from)];
        desk.pass(1);
        desk.events = vec![pointer(from, true)];
        desk.pass(2);
        desk.events = vec![Event::PointerMoved(to)];
        desk.pass(3);
        let bench = &mut desk.workbench.bench;
        let sought = match &bench.past.look_back {
            Some(back) => back.column,
            None => bench.live.play.tick,
        };
        assert!((100..400).contains(&sought), "{source:?} {sought}");
        // Left and right share the power of every contactor.
        let shown = bench.live.dots.iter().map(|dot| dot.amplitude_um);
        let power = shown.fold([0.0; 2], |sum, um| {
            [0, 1].map(|band| sum[band] + um[band].powi(2))
        });
        let [left, right] = bench.scrubbed_levels().unwrap();
        for band in 0..2 {
            let heard = f64::from(left[band].powi(2) + right[band].powi(2));
            let wanted = power[band] / 12.0;
            assert!(
                wanted > 1.0 && (heard / wanted - 1.0).abs() < 1e-4,
                "{source:?}"
            );
        }
        desk.events = vec![pointer(to, false)];
        desk.pass(2);
        assert_eq!(desk.workbench.bench.scrubbed_levels(), None);
    }
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
                let drawn = (&mut style(), &mut 132.0);
                show(ui, &narrow, drawn, &mut window.state, &mut commands);
            });
            output.drop_without_applying_deltas();
            assert_eq!(commands, []);
        }
    }
}
