//! What the pane commands when it is clicked, dragged, scrolled and typed at.

use eframe::egui::{
    Context, DragAndDrop, Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton,
    Pos2, RawInput, TouchPhase, pos2,
};

use super::*;
use crate::bench::command::edit::Edit;
use crate::bench::command::{Command, PlayCommand, ShowCommand};
use crate::bench::library_view::LibraryItem;
use crate::bench::selection::Selection;
use crate::bench::trail::Trail;
use crate::bench::view::{Cloth, Dot, EngineView, SceneView};
use crate::kit::theme;
use crate::kit::theme::colour_map::ColourMap;
use selvedge_foundation::geometry::{Frame, Point, Rotation};
use selvedge_textile::tactile::{Filters, Tuning};

/// The pane in a window of its own, with two textiles.
struct Window {
    ctx: Context,
    scene: SceneView,
    live: EngineView,
    view: WorkspaceView,
    selection: Selection,
    frame: u32,
    modifiers: Modifiers,
}

impl Window {
    fn new(tool: Tool) -> Self {
        let cloths = vec![
            cloth([20.0, 20.0], [100.0, 100.0]),
            cloth([140.0, 60.0], [100.0, 100.0]),
        ];
        let scene = SceneView {
            name: String::new(),
            path: None,
            is_edited: false,
            size_mm: [260.0; 2],
            cloths,
            tuning: Tuning::default(),
            default_tuning: Tuning::default(),
            reference_db: None,
            filters: Filters::default(),
            grid: Some((6, 4)),
            library: Vec::new(),
            library_is_stale: false,
            marks: crate::bench::view::Marks::default(),
            picked: std::sync::Arc::default(),
        };
        let ctx = Context::default();
        theme::install(&ctx);
        let mut window = Self {
            ctx,
            scene,
            live: EngineView::default(),
            view: WorkspaceView {
                tool,
                ..WorkspaceView::default()
            },
            selection: Selection::default(),
            frame: 0,
            modifiers: Modifiers::NONE,
        };
        window.run(Vec::new());
        window
    }

    /// One frame with these events: what was wished for, and what came of it.
    fn run(&mut self, mut events: Vec<Event>) -> (Commands, PointerGround) {
        self.frame += 1;
        events.insert(0, Event::ModifiersChanged(self.modifiers));
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(634.0, 620.0))),
            time: Some(f64::from(self.frame) / 40.0),
            predicted_dt: 0.025,
            focused: true,
            events,
            ..RawInput::default()
        };
        let mut commands = Commands::new();
        let mut shown = None;
        let (maps, lattice) = (Maps::default(), Lattice::default());
        let layers = layers(&maps, &lattice);
        let (trail, next) = (Trail::default(), Cell::new(self.view));
        let mut output = self.ctx.run_ui(input, |ui| {
            commands.clear();
            next.set(self.view);
            let sight = Sight {
                scene: &self.scene,
                live: &self.live,
                trail: &trail,
                selection: &self.selection,
                layers,
                next: &next,
            };
            shown = Some(show(ui, sight, &mut commands));
        });
        self.view = next.get();
        output.textures_delta.clear();
        let is_hover = |c: &Command| matches!(c, Command::Show(ShowCommand::Hover(_)));
        commands.retain(|command| !is_hover(command));
        (commands, shown.unwrap())
    }

    fn at(&mut self, x_mm: f64, y_mm: f64) -> Pos2 {
        let (_, shown) = self.run(Vec::new());
        shown.view.screen(Point::new(x_mm, y_mm))
    }

    fn press(&self, pos: Pos2, pressed: bool) -> Event {
        Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: self.modifiers,
        }
    }

    /// Drags from one place to another, mm; what was wished for while the button was down, and
    /// after it was let go.
    fn drag(&mut self, from: [f64; 2], to: [f64; 2]) -> (Commands, Commands) {
        let [from, to] = [self.at(from[0], from[1]), self.at(to[0], to[1])];
        self.run(vec![Event::PointerMoved(from)]);
        let mut during = self.run(vec![self.press(from, true)]).0;
        for share in [0.3, 0.7, 1.0] {
            let at = from.lerp(to, share);
            during.extend(self.run(vec![Event::PointerMoved(at)]).0);
        }
        during.extend(self.run(Vec::new()).0);
        let mut after = self.run(vec![self.press(to, false)]).0;
        after.extend(self.run(vec![Event::PointerMoved(to + vec2(40.0, 9.0))]).0);
        (during, after)
    }

    fn click(&mut self, at: Pos2) -> Commands {
        self.run(vec![Event::PointerMoved(at)]);
        let mut commands = self.run(vec![self.press(at, true)]).0;
        commands.extend(self.run(vec![self.press(at, false)]).0);
        commands
    }

    fn scroll(&mut self, at: Pos2) -> Commands {
        self.run(vec![Event::PointerMoved(at)]);
        let wheel = Event::MouseWheel {
            unit: MouseWheelUnit::Line,
            delta: vec2(0.0, 1.0),
            phase: TouchPhase::Move,
            source: MouseWheelSource::Wheel,
            modifiers: self.modifiers,
        };
        self.run(vec![wheel]).0
    }
}

fn layers<'a>(maps: &'a Maps, lattice: &'a Lattice) -> Layers<'a> {
    Layers {
        readings: &[],
        maps,
        lattice,
        colours: ColourMap::Viridis,
    }
}

fn cloth(origin: [f64; 2], size_mm: [f64; 2]) -> Cloth {
    Cloth {
        id: "felt".to_owned(),
        label: "1".to_owned(),
        name: "Felt".to_owned(),
        workspace_from_textile: Frame {
            origin: origin.into(),
            rotation: Rotation::NONE,
        },
        size_mm,
        ..Cloth::default()
    }
}

fn edits(commands: &[Command]) -> Vec<Edit> {
    let edit = |command: &Command| match command {
        Command::Edit(edit) => Some(edit.clone()),
        _ => None,
    };
    commands.iter().filter_map(edit).collect()
}

#[test]
fn dragging_a_textile_chooses_and_moves_it_only_while_the_button_is_down() {
    let mut window = Window::new(Tool::Arrange);
    let (during, after) = window.drag([70.0, 70.0], [75.3, 108.9]);
    assert_eq!(
        during.first(),
        Some(&ShowCommand::SelectCloth(Some(0)).into())
    );
    let moves = edits(&during);
    let Some(Edit::MoveCloth(0, origin)) = moves.last() else {
        panic!("{during:?}");
    };
    // 5.3 mm to the right are whole mm; 38.9 mm up, its lower edge meets the other textile's.
    assert_eq!(*origin, Point::new(25.0, 60.0));
    assert_eq!(edits(&after), [], "let go");
}

#[test]
fn with_alt_held_nothing_snaps() {
    let mut window = Window::new(Tool::Arrange);
    window.modifiers = Modifiers::ALT;
    let (during, _) = window.drag([70.0, 70.0], [75.3, 75.4]);
    let Some(Edit::MoveCloth(0, origin)) = edits(&during).last().cloned() else {
        panic!("{during:?}");
    };
    let wanted = Point::new(25.3, 25.4);
    assert!((origin - wanted).length_mm() < 0.01, "{origin:?}");
}

#[test]
fn handles_resize_and_turn_the_chosen_textile() {
    let mut window = Window::new(Tool::Arrange);
    window.selection.cloth = Some(0);
    let (during, _) = window.drag([120.0, 120.0], [113.2, 91.1]);
    let Some(Edit::ResizeCloth(0, size_mm)) = edits(&during).last().cloned() else {
        panic!("{during:?}");
    };
    assert_eq!(size_mm, [93.0, 71.0]);
    let (_, shown) = window.run(Vec::new());
    let handle_mm = 120.0 + 22.0 / shown.view.points_per_mm;
    let (during, _) = window.drag([70.0, handle_mm], [130.0, 68.0]);
    let turned = edits(&during).last().cloned();
    assert_eq!(turned, Some(Edit::TurnCloth(0, -90.0)), "{during:?}");
}

#[test]
fn dragging_empty_ground_goes_about_and_holds_what_is_under_the_pointer() {
    let mut window = Window::new(Tool::Arrange);
    window.selection.cloth = Some(0);
    let (during, after) = window.drag([30.0, 200.0], [50.0, 190.0]);
    assert_eq!(during.first(), Some(&ShowCommand::SelectCloth(None).into()));
    assert_ne!(window.view.camera, Camera::Fit, "gone about");
    assert_eq!((edits(&during), edits(&after)), (Vec::new(), Vec::new()));
}

#[test]
fn the_pointer_feels_while_it_explores_and_not_while_it_arranges() {
    let mut window = Window::new(Tool::Feel);
    let on_cloth = window.at(70.0, 70.0);
    assert!(window.run(vec![Event::PointerMoved(on_cloth)]).1.feels);
    let (during, _) = window.drag([70.0, 70.0], [100.0, 90.0]);
    assert_eq!(during, [], "a drag feels and does nothing else");
    let mut window = Window::new(Tool::Arrange);
    assert!(!window.run(vec![Event::PointerMoved(on_cloth)]).1.feels);
}

#[test]
fn the_wheel_zooms_about_the_pointer_and_with_alt_turns_the_display() {
    let mut window = Window::new(Tool::Feel);
    let at = window.at(70.0, 70.0);
    let before = window.run(Vec::new()).1.view;
    assert_eq!(window.scroll(at), []);
    let after = window.run(Vec::new()).1.view;
    assert!(after.points_per_mm > before.points_per_mm, "{after:?}");
    let place = after.workspace(at);
    assert!(
        (place - Point::new(70.0, 70.0)).length_mm() < 0.01,
        "{place:?}"
    );
    let mut window = Window::new(Tool::Feel);
    window.modifiers = Modifiers::ALT;
    assert_eq!(window.scroll(at), [PlayCommand::Turn(5.0).into()]);
}

#[test]
fn two_clicks_on_empty_ground_show_all_of_it() {
    let closer = Camera::At {
        centre: Point::new(130.0, 130.0),
        points_per_mm: 2.2,
    };
    for ([x_mm, y_mm], is_fit) in [([70.0, 70.0], false), ([60.0, 200.0], true)] {
        let mut window = Window::new(Tool::Feel);
        window.view.camera = closer;
        let at = window.at(x_mm, y_mm);
        window.click(at);
        window.click(at);
        let wanted = if is_fit { Camera::Fit } else { closer };
        assert_eq!(window.view.camera, wanted);
    }
}

#[test]
fn arrow_keys_move_the_chosen_textile() {
    let mut window = Window::new(Tool::Arrange);
    let key = |key, modifiers| Event::Key {
        key,
        physical_key: None,
        pressed: true,
        repeat: false,
        modifiers,
    };
    let right = vec![key(Key::ArrowRight, Modifiers::NONE)];
    assert_eq!(window.run(right.clone()).0, [], "none is chosen");
    window.selection.cloth = Some(0);
    let moved = |x, y| vec![Command::Edit(Edit::MoveCloth(0, Point::new(x, y)))];
    assert_eq!(window.run(right).0, moved(21.0, 20.0));
    window.modifiers = Modifiers::SHIFT;
    let down = vec![key(Key::ArrowDown, Modifiers::SHIFT)];
    assert_eq!(window.run(down).0, moved(20.0, 19.9));
}

#[test]
fn clicking_a_contactor_looks_closer_at_it() {
    let mut window = Window::new(Tool::Arrange);
    window.live.centre = Some(Point::new(70.0, 70.0));
    window.live.dots = vec![
        Dot::default(),
        Dot {
            position: Point::new(70.0, 70.0),
            cloth: Some(0),
            ..Dot::default()
        },
    ];
    let at = window.at(70.0, 70.0);
    assert_eq!(window.click(at), [ShowCommand::SelectContactor(1).into()]);
}

#[test]
fn a_textile_of_the_library_is_placed_where_it_is_let_go() {
    let mut window = Window::new(Tool::Feel);
    let at = window.at(69.6, 200.3);
    window.run(vec![Event::PointerMoved(at)]);
    window.run(vec![window.press(at, true)]);
    let item = LibraryItem {
        id: "silk".to_owned(),
    };
    DragAndDrop::set_payload(&window.ctx, item);
    let (commands, shown) = window.run(vec![Event::PointerMoved(at + vec2(1.0, 0.0))]);
    assert_eq!(commands, []);
    assert!(!shown.feels, "the pointer carries");
    let commands = window.run(vec![window.press(at, false)]).0;
    let add = Edit::AddCloth("silk".to_owned(), Point::new(70.0, 200.0));
    assert_eq!(commands, [add.into()]);
}

#[test]
fn what_is_measured_between_the_crosses_calibrates_the_screen() {
    let mut window = Window::new(Tool::Feel);
    window.view.is_calibrating = true;
    let typed = |text: &str| Event::Text(text.to_owned());
    let enter = Event::Key {
        key: Key::Enter,
        physical_key: None,
        pressed: true,
        repeat: false,
        modifiers: Modifiers::NONE,
    };
    window.run(Vec::new());
    window.run(Vec::new());
    assert_eq!(window.run(vec![typed("-"), enter.clone()]).0, []);
    window.view.is_calibrating = false;
    window.run(Vec::new());
    window.view.is_calibrating = true;
    window.run(Vec::new());
    let (_, shown) = window.run(Vec::new());
    assert!(!shown.feels, "the pointer measures");
    assert_eq!(window.run(vec![typed("100"), enter]).0, []);
    let pixels_per_mm = window.view.true_pixels_per_mm.unwrap();
    let pixels = 0.6 * (f64::from(shown.rect.width()) - 28.0);
    assert!(
        (pixels_per_mm - pixels / 100.0).abs() < 0.02,
        "{pixels_per_mm}"
    );
}

#[test]
fn nothing_to_show_is_shown_without_harm() {
    let mut window = Window::new(Tool::Arrange);
    window.scene.cloths.clear();
    window.scene.size_mm = [f64::NAN, 0.0];
    window.selection.cloth = Some(7);
    window.selection.contactor = Some(99);
    let at = pos2(300.0, 300.0);
    window.click(at);
    let (during, _) = window.drag([0.1, 0.1], [0.3, 0.4]);
    assert_eq!(edits(&during), []);
    let tiny = RawInput {
        screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(9.0, 5.0))),
        ..RawInput::default()
    };
    let (maps, lattice) = (Maps::default(), Lattice::default());
    let (trail, next) = (Trail::default(), Cell::new(window.view));
    let sight = Sight {
        scene: &window.scene,
        live: &window.live,
        trail: &trail,
        selection: &window.selection,
        layers: layers(&maps, &lattice),
        next: &next,
    };
    let mut output = window.ctx.run_ui(tiny, |ui| {
        show(ui, sight, &mut Commands::new());
    });
    output.textures_delta.clear();
}
