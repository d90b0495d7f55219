//! Trials that count: what was not felt is not answered, what stops counting is presented again.

use super::*;
use crate::bench::command::array::ArrayCommand;
use crate::bench::view::BridgePhase;
use selvedge_device::FaultWords;
use selvedge_engine::SequenceStep;
use selvedge_experiment::analysis::{Analysis, Cell, Options};
use selvedge_experiment::{Proof, Record, Validity};
use selvedge_foundation::progress::Progress;
use selvedge_textile::tactile::Band;

/// Runs frames until something is so.
fn wait(window: &mut Headless, what: &str, is_so: impl Fn(&Headless) -> bool) {
    for _ in 0..200 {
        window.pass(1);
        if is_so(window) {
            return;
        }
    }
    panic!("{what} did not come");
}

/// Connects the emulator and arms it, until it is at full strength.
pub(super) fn arm(window: &mut Headless) {
    if window.workbench.bench.live.bridge.is_none() {
        window.dispatch(DeviceCommand::ConnectEmulator);
    }
    wait(window, "a device", |window| {
        let bridge = window.workbench.bench.live.bridge.as_ref();
        bridge.is_some_and(|bridge| bridge.phase == BridgePhase::Ready)
    });
    window.dispatch(DeviceCommand::Arm);
    wait(window, "full strength", |window| {
        ArrayNow::of(&window.workbench.bench).why_not.is_none()
    });
}

/// A window with a session on the emulator that counts, before its first trial, without practice.
pub(super) fn begun_on_array(folder: &Folder, design: &str) -> Headless {
    let text = Design::shipped_text(design).map_or_else(|| composed(design), str::to_owned);
    let is_practice =
        |line: &&str| line.starts_with("practice_trials") || line.starts_with("least_practised");
    let text: Vec<&str> = text.lines().filter(|line| !is_practice(line)).collect();
    let path = folder.0.join(format!("{design}.toml"));
    fs::create_dir_all(&folder.0).unwrap();
    fs::write(&path, with_four(&text.join("\n"))).unwrap();
    let mut window = Headless::shipped();
    window.pass(2);
    let form = &mut experiment_mut(&mut window).form;
    form.choose(Chosen::File(path));
    form.folder = folder.0.join("logs").display().to_string();
    form.who.pseudonym = "p01".to_owned();
    act(&mut window, Experiment::begin_session);
    window.pass(3);
    for _ in 0..4 {
        pass(&mut window);
        window.pass(2);
    }
    window
}

/// A design of those that the analysis is tried with.
pub(super) fn composed(name: &str) -> String {
    let designs = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../experiment/analysis/tests/designs"
    );
    fs::read_to_string(format!("{designs}/{name}.toml")).unwrap()
}

#[test]
fn an_answer_waits_until_everything_was_felt() {
    let folder = Folder::new("unfelt");
    let mut window = begun(&folder, "odd-one-out", "p01");
    to_trial(&mut window);
    let say = |window: &mut Headless| {
        mark(window, Mark::Place(1));
        mark(window, Mark::Confidence(1));
        answer(window);
        window.pass(4);
    };
    say(&mut window);
    assert_eq!(session(&window).progress.0, 0);
    window.pass(25);
    assert!(session(&window).missing().unwrap().contains("number 1"));
    feel(&mut window);
    say(&mut window);
    assert_eq!(session(&window).progress.0, 1);
    let found = Found::in_folder(&folder.0).unwrap().0;
    let presentation = &found[0].records[0].presentation;
    assert_eq!(
        (presentation.validity(), presentation.proof),
        (Validity::Valid, Some(Proof::Screen))
    );
    let felt_s = &presentation.explored_s;
    assert!(
        felt_s.len() == 3 && felt_s.iter().all(|s| *s >= 1.0),
        "{felt_s:?}"
    );
    assert_eq!(found[0].breaks, []);
}

/// From the start of the emulator until it is armed and a presentation has begun, ticks at most.
const ARMING_TICKS: u64 = 52;
/// Ticks after which a fault has struck: three frames in a row are missing, or a hundredth of all
/// values is limited.
const STRUCK_TICKS: u64 = 6;
/// Ticks that every place is felt, a second and some more.
const PLACE_TICKS: u64 = 44;

/// What goes wrong in a presentation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Fault {
    /// The frames of four ticks in a row are late.
    Late,
    /// The array is disarmed.
    Disarmed,
    /// Whoever holds the session lowers the array's limits to nothing.
    Limited,
    /// Its cable is pulled.
    Unplugged,
}

impl Fault {
    const ALL: [Self; 4] = [Self::Late, Self::Disarmed, Self::Limited, Self::Unplugged];

    /// An emulator that is armed; what befalls it by itself does so that many ticks after its
    /// start.
    fn prepare(self, window: &mut Headless, at: u64) {
        let at_ms = 25 * at;
        let [stall, unplug] = [format!("{at_ms}ms+90ms"), format!("{at_ms}ms")];
        let befalls: &[(&'static str, &str)] = match self {
            Self::Late => &[("stall-reading-at", &stall)],
            Self::Unplugged => &[("unplug-at", &unplug)],
            Self::Disarmed | Self::Limited => &[],
        };
        window.dispatch(DeviceCommand::StartFaults(FaultWords::of(befalls)));
        window.pass(1);
        arm(window);
    }

    fn happen(self, window: &mut Headless) {
        match self {
            Self::Late | Self::Unplugged => {}
            Self::Disarmed => window.dispatch(DeviceCommand::Disarm),
            Self::Limited => limit(window, 0.0),
        }
    }

    /// What a row says of it.
    fn words(self) -> &'static str {
        match self {
            Self::Late => "without their frame",
            Self::Disarmed | Self::Unplugged => "not armed",
            Self::Limited => "limits changed",
        }
    }
}

/// Lets the array play so much at most, µm.
fn limit(window: &mut Headless, limit_um: f64) {
    for band in [Band::Low, Band::High] {
        window.dispatch(DeviceCommand::Array(ArrayCommand::Limit(band, limit_um)));
    }
    window.pass(2);
}

/// Every kind of trial that a participant's screen knows, and a whole answer to it.
fn every_kind() -> Vec<(&'static str, Vec<Mark>)> {
    let place = Mark::Place;
    vec![
        ("ranking-virtual-target", (0..4).map(place).collect()),
        ("odd-one-out", vec![place(1), Mark::Confidence(1)]),
        ("abx", vec![place(1), Mark::Confidence(2)]),
        ("best-worst", vec![place(0), place(3)]),
        ("ranked-threes", (0..3).map(place).collect()),
        ("same-different", vec![place(0), Mark::Confidence(4)]),
        ("gain-yes-no", vec![place(0)]),
        ("compression-staircase", vec![place(1)]),
        ("rotation-staircase", vec![place(1)]),
        ("duration-constant", vec![place(1)]),
        ("equality-constant", vec![place(0)]),
        ("masked-threshold", vec![place(2)]),
        ("roughness-intervals", vec![place(0)]),
        ("free-sorting", (0..4).map(Mark::NextPile).collect()),
        ("dissimilarity", vec![Mark::Rate(0, 30.0)]),
        (
            "rating",
            (0..4).map(|scale| Mark::Rate(scale, 30.0)).collect(),
        ),
        ("magnitude", vec![Mark::Type("12".to_owned())]),
        ("gain-matching", vec![Mark::Turn(0, 1)]),
    ]
}

/// Whether a presentation is under way.
fn is_presented(window: &Headless) -> bool {
    let session = session(window);
    session.trial().is_some() && !session.is_waiting() && session.is_open()
}

/// Ends a pause and lets the next presentation begin.
pub(super) fn present(window: &mut Headless) {
    if session(window).pause == Pause::On {
        act(window, |one, bench| one.pause(false, bench));
    }
    experiment_mut(window).session.as_mut().unwrap().lay();
    wait(window, "a presentation", is_presented);
}

/// Moves on for a tick, from place to place: the finger was moved for `nth` ticks before.
fn stroke_all(window: &mut Headless, nth: u64) {
    let places = session(window).layout.places.clone();
    let n_places = places.len().max(1) as u64;
    let place = places.get((nth / PLACE_TICKS % n_places) as usize);
    let corner = place.map_or_else(Point::default, |place| place.origin_mm);
    stroke(window, corner, nth..nth + 1);
}

/// Ticks from the start of the emulator after which everything of the trial that waits was felt.
fn felt_by(window: &Headless) -> u64 {
    let session = session(window);
    let lengths = session.sequence().into_iter().map(|step| step.n_ticks);
    let played: u32 = lengths.filter(|n| *n != SequenceStep::UNTIL_NEXT).sum();
    ARMING_TICKS + u64::from(played) + PLACE_TICKS * (session.layout.places.len() as u64 + 1)
}

/// The engine's tick.
fn tick(window: &Headless) -> u64 {
    window.workbench.bench.live.tick
}

/// The strongest of what the array is told now, µm.
pub(super) fn strongest_um(window: &Headless) -> f64 {
    let all = window.workbench.amplitudes_um();
    all.iter().flatten().copied().fold(0.0, f64::max)
}

/// Gives a whole answer and hands it in.
fn say(window: &mut Headless, marks: &[Mark]) {
    let session = experiment_mut(window).session.as_mut();
    session.unwrap().forget_draft();
    for one in marks {
        mark(window, one.clone());
    }
    answer(window);
    window.pass(1);
}

/// Goes on as if nothing had happened: feels everything and answers all the while, until a row is
/// written.
fn go_on(window: &mut Headless, marks: &[Mark]) {
    let (attempt, n_answered) = (session(window).attempt(), session(window).progress.0);
    for nth in 0..300 {
        let now = session(window);
        if now.attempt() > attempt || now.progress.0 > n_answered {
            break;
        }
        say(window, marks);
        stroke_all(window, nth);
    }
}

/// The rows of the only session, which are as they were written.
pub(super) fn rows(folder: &Folder) -> Vec<Record> {
    let [found] = &Found::in_folder(&folder.0.join("logs")).unwrap().0[..] else {
        panic!("one session")
    };
    assert_eq!(found.breaks, []);
    found.records.clone()
}

/// Whether it strikes while something is played: limits change nothing of what is over.
fn strikes_early(fault: Fault, window: &Headless) -> bool {
    fault == Fault::Limited && !session(window).sequence().is_empty()
}

/// Lets a fault happen once everything was felt and an answer would be taken: the row says so
/// whatever is answered then.
fn void_by(fault: Fault, window: &mut Headless, (marks, at, folder): (&[Mark], u64, &Folder)) {
    let start = tick(window);
    let what = format!("{fault:?} in {}", folder.0.display());
    fault.prepare(window, at);
    present(window);
    let attempt = session(window).attempt();
    let is_early = strikes_early(fault, window);
    let is_due = |window: &Headless| match fault {
        _ if is_early => strongest_um(window) > 0.1,
        // What is limited has to be there.
        Fault::Limited => tick(window) >= start + at && strongest_um(window) > 0.1,
        _ => tick(window) >= start + at,
    };
    let mut nth = 0;
    while !is_due(window) {
        assert!(is_presented(window), "{what} is not yet");
        assert!(tick(window) < start + 2 * at, "{what}: nothing is felt");
        stroke_all(window, nth);
        nth += 1;
    }
    if !is_early {
        assert_eq!(session(window).missing(), None, "{what}: not all was felt");
    }
    fault.happen(window);
    for after in 0..STRUCK_TICKS {
        stroke_all(window, nth + after);
    }
    go_on(window, marks);
    let is_stopped = session(window).pause == Pause::On;
    let rows = rows(folder);
    assert_eq!(session(window).progress.0, 0, "{what} was answered");
    assert_eq!(rows.len(), attempt as usize, "{what} left a row");
    let void = &rows.last().unwrap().presentation.void;
    assert!(void.contains(fault.words()), "{what}: {void}");
    let trouble = session(window).presented.trouble.clone().unwrap();
    assert!(trouble.contains("does not count"), "{trouble}");
    assert_eq!(is_stopped, rows.len() == 3, "three times stop");
    assert_eq!(trouble.contains("3 times"), is_stopped, "{trouble}");
    limit(window, 50.0);
}

/// Feels all that lies there and answers: that counts.
fn answer_validly(window: &mut Headless, marks: &[Mark]) {
    window.dispatch(DeviceCommand::ConnectEmulator);
    window.pass(1);
    arm(window);
    present(window);
    feel(window);
    say(window, marks);
    window.pass(4);
    let one = session(window);
    assert_eq!(one.progress.0, 1, "{:?}: {:?}", one.missing(), one.draft);
}

/// The row of an answer that is handed in so many ticks after a fault by itself was to strike.
fn answered_after(
    (fault, after): (Fault, u64),
    window: &mut Headless,
    (marks, at, folder): (&[Mark], u64, &Folder),
) -> Record {
    let start = tick(window);
    fault.prepare(window, at);
    present(window);
    act(window, |one, bench| one.pause(true, bench));
    let n_before = rows(folder).len();
    for nth in 0.. {
        if tick(window) >= start + at + after {
            break;
        }
        assert_eq!(
            rows(folder).len(),
            n_before,
            "{fault:?} {after}: void before it is answered"
        );
        stroke_all(window, nth);
    }
    assert_eq!(session(window).missing(), None, "{fault:?} {after}");
    say(window, marks);
    wait(window, "a row", |_| rows(folder).len() > n_before);
    rows(folder)[n_before].clone()
}

#[test]
fn what_counts_is_every_tick_to_the_answer() {
    let marks: Vec<Mark> = (0..4).map(|scale| Mark::Rate(scale, 30.0)).collect();
    let folder = Folder::new("late");
    let mut window = begun_on_array(&folder, "rating");
    let at = felt_by(&window);
    // A frame is sent a tick before it is felt: that of the tick in which the stall begins is
    // there. One that is missing may be, more may not, and none after the answer counts.
    for (after, n_late) in [0, 0, 1, 2, 3].into_iter().enumerate() {
        let case = (Fault::Late, after as u64);
        let row = answered_after(case, &mut window, (&marks, at, &folder));
        let presentation = &row.presentation;
        assert_eq!(presentation.frames_late, Some(n_late), "{after}");
        assert_eq!(
            row.answer().is_some(),
            n_late <= 1,
            "{after}: {presentation:?}"
        );
    }
    let folder = Folder::new("unplugged");
    let mut window = begun_on_array(&folder, "rating");
    let case = (Fault::Unplugged, 0);
    let row = answered_after(case, &mut window, (&marks, at, &folder));
    assert_eq!(row.answer(), None, "{:?}", row.presentation);
    assert!(
        row.presentation.void.contains("not armed"),
        "{:?}",
        row.presentation
    );
}

/// What the table of sessions says of the only one: trials that count, and those that are void.
fn counted(folder: &Folder) -> [Cell; 2] {
    let logs = folder.0.join("logs");
    let find = |own: &mut Progress<'_>| Analysis::of_folder(&logs, &Options::default(), own);
    let analysis = Progress::unheard(find).unwrap();
    let mut tables = analysis.sections.iter().flat_map(|section| &section.tables);
    let held = tables.find(|table| table.key == "held").unwrap();
    ["trials", "void"].map(|name| {
        let column = held.columns.iter().position(|one| one.name == name);
        held.rows[0][column.unwrap()].clone()
    })
}

#[test]
fn no_fault_of_the_array_lets_an_answer_to_any_kind_of_trial_count_though_all_was_felt() {
    for (design, marks) in every_kind() {
        let folder = Folder::new(design);
        let mut window = begun_on_array(&folder, design);
        let at = felt_by(&window);
        for fault in Fault::ALL {
            let draft = &session(&window).draft;
            if fault == Fault::Limited && matches!(draft, Draft::Adjust { .. }) {
                // What is adjusted may meet its limits.
                continue;
            }
            void_by(fault, &mut window, (&marks, at, &folder));
        }
        answer_validly(&mut window, &marks);
        let rows = rows(&folder);
        let (last, voided) = rows.split_last().unwrap();
        for (nth, row) in (1..).zip(voided) {
            assert_eq!((&row.trial, row.attempt), (&last.trial, nth), "{design}");
            let presentation = &row.presentation;
            let validity = presentation.validity();
            assert_eq!((row.answer(), validity), (None, Validity::Void), "{design}");
            assert_eq!(presentation.proof, Some(Proof::Emulator));
        }
        assert!(last.answer().is_some(), "{design}");
        assert_eq!(last.presentation.validity(), Validity::Valid, "{design}");
        let n_void = voided.len() as f64;
        assert_eq!(
            counted(&folder),
            [1.0, n_void].map(Cell::Number),
            "{design}"
        );
    }
}

#[test]
fn a_trial_waits_for_an_armed_array_and_nothing_is_answered_before_it_begins() {
    let folder = Folder::new("unarmed");
    let mut window = begun_on_array(&folder, "odd-one-out");
    let waiting = session(&window);
    assert!(waiting.trial().is_some() && waiting.is_waiting());
    let seen = experiment(&window).participant(&EngineView::default(), 0.0);
    assert!(
        matches!(seen, ParticipantView::Words { left_s: None, .. }),
        "{seen:?}"
    );
    mark(&mut window, Mark::Place(1));
    assert!(matches!(
        session(&window).draft,
        Draft::Choose { position: None, .. }
    ));
}

#[test]
fn a_beginning_is_taken_back_without_a_trace_but_a_line() {
    let folder = Folder::new("undone");
    let mut window = begun_on_array(&folder, "odd-one-out");
    let log = log_of(&window);
    assert!(log.exists());
    act(&mut window, Experiment::undo_beginning);
    window.pass(3);
    assert!(experiment(&window).session.is_none());
    assert!(!log.exists() && !log.with_extension("json").exists());
    let undone = folder.0.join("logs/undone-sessions.csv");
    let undone = fs::read_to_string(undone).unwrap();
    assert!(
        undone.lines().nth(1).unwrap().ends_with(",p01,1"),
        "{undone}"
    );
}

#[test]
fn the_keys_that_a_trial_names_answer_it_in_the_main_window() {
    let is_chosen = |draft: &Draft, at: usize, said: Option<u8>| match draft {
        Draft::Choose { position, sure, .. } => *position == Some(at) && sure.grade == said,
        _ => false,
    };
    let is_odd = |draft: &Draft| is_chosen(draft, 1, Some(3));
    let is_real = |draft: &Draft| is_chosen(draft, 0, None);
    press_in_trial("odd-one-out", &[Key::Num2, Key::H], is_odd);
    press_in_trial("real-or-generated", &[Key::R], is_real);
}

fn press_in_trial(design: &'static str, keys: &[Key], is_expected: impl Fn(&Draft) -> bool) {
    let folder = Folder::new("keys");
    let mut window = begun(&folder, design, "p01");
    to_trial(&mut window);
    window.pass(3);
    for key in keys {
        window.press(Modifiers::NONE, *key);
    }
    let draft = &session(&window).draft;
    assert!(is_expected(draft), "{design}: {draft:?}");
}
