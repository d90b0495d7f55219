//! Proof that the engine's tick allocates nothing: the suite's global allocator aborts inside a
//! guard.

use std::io::Write as _;
use std::net::TcpStream;
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use assert_no_alloc::assert_no_alloc;

use selvedge_device::{ArrayProfile, BridgeState, Target};
use selvedge_engine::{
    Command, Engine, EngineConfig, InputSource, Played, PointerSample, PointerSender,
    PreparedScene, ProgramLink, SequenceStep, SoundSource as _, TICK, loopback, sonification,
};
use selvedge_foundation::geometry::{Displacement, Frame, Point, Rotation};
use selvedge_render::array::{Accuracy, Method};
use selvedge_render::contact::{
    Contact, ContactLaw, DeviceSpec, Friction, Hand, Relief, Stepper, StylusSetup, Tip,
};
use selvedge_render::scene::{ExplorationPath, Geometry, PathRow};
use selvedge_render::stylus::{StylusDrive, StylusState};
use selvedge_render::{ContactorArray, PlacedLevel, PlacedSurface, RenderScene};
use selvedge_textile::surface::{Profile, ProfileSet, Surface};
use selvedge_textile::tactile::{Filters, Tuning};

/// The same one for all who ask: a stylus is felt on the very surface of its scene.
fn surface() -> Arc<Surface> {
    static SURFACE: OnceLock<Arc<Surface>> = OnceLock::new();
    let made = || {
        let heights = (0..4600).map(|i| 3.0 * (f64::from(i) * 0.03).sin());
        let mut profiles = ProfileSet::default();
        profiles[0] = Some(Profile::new(1.0 / 230.0, heights.collect()).unwrap());
        Arc::new(Surface::from_profiles(profiles, 0.0).unwrap())
    };
    Arc::clone(SURFACE.get_or_init(made))
}

fn prepared(offsets: Vec<Displacement>) -> PreparedScene {
    let textile = PlacedSurface {
        workspace_from_textile: Frame {
            origin: Point::default(),
            rotation: Rotation::NONE,
        },
        size_mm: [100.0, 100.0],
        manifest_gain_db: 0.0,
        scene_gain_db: 0.0,
        scene_band_gains_db: [0.0; 2],
        within_mm: None,
        level: PlacedLevel::Known(3.0),
        surface: surface(),
    };
    let scene = RenderScene {
        textiles: vec![textile],
        displays: vec![ContactorArray {
            offsets,
            rotation_deg: 0.0,
        }],
        ..RenderScene::default()
    };
    let how = (Method::Auto, &Accuracy::default());
    let start = Point::new(50.0, 50.0);
    PreparedScene::from_parts(&scene, ArrayProfile::default(), start, how).unwrap()
}

fn engine(start: Instant) -> (Engine, PointerSender) {
    let scene = prepared(Geometry::default().contactors());
    let mut engine = Engine::without_thread(
        EngineConfig {
            scene,
            on_news: None,
        },
        start,
    )
    .unwrap();
    let pointer = engine.take_pointer().unwrap();
    (engine, pointer)
}

fn push(pointer: &mut PointerSender, stamp: Instant, since_s: f64) {
    let position = Point::new(50.0 + 20.0 * (3.0 * since_s).sin(), 40.0);
    pointer.push(PointerSample { stamp, position });
}

#[test]
fn ticks_with_a_mouse_a_recording_and_live_gains_allocate_nothing() {
    let start = Instant::now();
    let (mut engine, mut pointer) = engine(start);
    let _recording = engine.record().unwrap();
    engine.send(Command::SampleTicks(true)).unwrap();
    let (feed, mut sonifier, _) = sonification();
    let feed = Some(Box::new(feed));
    engine.send(Command::SetSound(feed)).unwrap();
    let mut heard = [[0.0; 2]; 1200];
    // Fewer than all blocks of the recording: collecting them is the window's affair.
    for n in 0..390_u32 {
        let gain_db = f64::from(n % 20);
        engine
            .send(Command::SetTuning(Tuning {
                gain_db,
                ..Tuning::default()
            }))
            .unwrap();
        engine.send(Command::TurnBy(0.7)).unwrap();
        let is_felt = (0..24).map(|contactor| contactor != n % 24).collect();
        engine.send(Command::SetContactorMask(is_felt)).unwrap();
        assert_no_alloc(|| {
            for k in 0..25 {
                let stamp = start + TICK * n + Duration::from_millis(1) * k;
                push(&mut pointer, stamp, (stamp - start).as_secs_f64());
            }
            engine.step_uncollected(start + TICK * (n + 1));
            sonifier.fill(&mut heard);
            assert!(engine.next_tick_sample().is_some(), "it moved");
        });
    }
    assert!(
        heard.iter().any(|[left, _]| left.abs() > 1e-3),
        "it is heard"
    );
    let snapshot = engine.snapshot();
    assert_eq!(snapshot.recording.n_ticks, 390);
    assert!(
        snapshot.rendering.counters.directions_evaluated > 1000,
        "{:?}",
        snapshot.rendering.counters
    );
}

#[test]
fn sequences_of_vibrations_and_textiles_allocate_nothing() {
    let start = Instant::now();
    let (mut engine, mut pointer) = engine(start);
    let step = |played, n_ticks| SequenceStep { played, n_ticks };
    let vibration = Played::Vibration([2.0, 0.0]);
    for n in 0..40_u32 {
        if n % 10 == 0 {
            let steps = vec![
                step(vibration, 3),
                SequenceStep::silence(2),
                step(Played::Textile(0), 3),
            ];
            engine.send(Command::PlaySequence(steps)).unwrap();
        }
        assert_no_alloc(|| {
            let stamp = start + TICK * n;
            push(&mut pointer, stamp, (stamp - start).as_secs_f64());
            engine.step_uncollected(start + TICK * (n + 1));
        });
        let is_played = engine.snapshot().sequence_step.is_some();
        assert_eq!(is_played, n % 10 < 8, "tick {n}");
    }
}

#[test]
fn a_stylus_that_is_felt_through_the_device_allocates_nothing() {
    let start = Instant::now();
    let (mut engine, mut pointer) = engine(start);
    let surface = surface();
    let law = ContactLaw {
        damping_n_s_per_m: 5.0,
        ..ContactLaw::default()
    };
    let relief = Relief::of_surface(&surface);
    let contact = Contact::new(&relief, Tip::stylus(0.05), law, Friction::none()).unwrap();
    let setup = StylusSetup {
        contact,
        device: DeviceSpec {
            damping_n_s_per_m: 0.5,
            ..DeviceSpec::default()
        },
        hand: Hand {
            press_n: 0.3,
            leads: None,
        },
        method: Stepper::Auto,
        rate_hz: 1000.0,
        sampling: None,
    };
    let textiles = vec![(surface, Some(setup))];
    let drive = StylusDrive::prepare(textiles, (1000.0, 2000.0), &Filters::default()).unwrap();
    let stylus = Command::SetStylus(Some(Box::new(drive)));
    engine.send(stylus).unwrap();
    let _recording = engine.record().unwrap();
    let mut n_felt = 0;
    for n in 0..200_u32 {
        assert_no_alloc(|| {
            // It moves, is lifted, and comes down elsewhere.
            if n % 50 < 40 {
                for k in 0..25 {
                    let stamp = start + TICK * n + Duration::from_millis(1) * k;
                    push(&mut pointer, stamp, (stamp - start).as_secs_f64());
                }
            } else {
                pointer.lift(0);
            }
            engine.step_uncollected(start + TICK * (n + 1));
        });
        let snapshot = engine.snapshot();
        n_felt += usize::from(snapshot.stylus == Some(StylusState::Led));
    }
    let snapshot = engine.snapshot();
    assert!(
        n_felt > 100,
        "{n_felt} ticks are felt, {:?}",
        snapshot.stylus
    );
    assert!(snapshot.counters.stylus_steps > 100 * 25);
    assert_eq!(snapshot.recording.n_ticks, 200);
}

#[test]
fn a_replay_that_loops_allocates_nothing() {
    let (mut engine, _) = engine(Instant::now());
    let row = |n: u32| PathRow {
        t_s: f64::from(n) * 0.031,
        position: Point::new(20.0 + f64::from(n), 50.0),
        ..PathRow::default()
    };
    let path = ExplorationPath::new((0..50).map(row).collect()).unwrap();
    let other = [Some(30.0), Some(40.0), Some(50.0), Some(0.0)];
    let path = Arc::new(path.with_others(1, vec![other; 50]).unwrap());
    engine
        .send(Command::SetSource(InputSource::Replay(path)))
        .unwrap();
    engine.send(Command::SetLoop(true)).unwrap();
    engine.send(Command::Play).unwrap();
    engine.advance_ticks(1);
    assert_no_alloc(|| {
        engine.advance_ticks(500);
    });
    assert!(engine.snapshot().playback.is_playing);
    for tick in [30, 0, 7, 1_000_000] {
        engine.send(Command::Seek(tick)).unwrap();
        assert_no_alloc(|| {
            engine.advance_ticks(3);
        });
    }
}

#[test]
fn a_program_that_moves_the_display_and_listens_costs_no_allocation() {
    let (mut engine, _) = engine(Instant::now());
    let link = ProgramLink::listen(loopback("127.0.0.1:0").unwrap()).unwrap();
    engine.send(Command::SetSource(link.source())).unwrap();
    let tap = link.tap(24).map(Box::new);
    engine.send(Command::SetTap(tap)).unwrap();
    engine.advance_ticks(1);
    let mut program = TcpStream::connect(link.address()).unwrap();
    let mut n_accepted = 0;
    for n in 0..200 {
        writeln!(program, "{},40", 30 + n % 20).unwrap();
        std::thread::sleep(Duration::from_millis(1));
        assert_no_alloc(|| {
            engine.advance_ticks(1);
        });
        n_accepted = engine.snapshot().pointer.samples.accepted;
    }
    assert!(n_accepted > 10, "{n_accepted}");
}

#[test]
fn a_new_scene_is_taken_over_without_allocating() {
    let start = Instant::now();
    let (mut engine, mut pointer) = engine(start);
    engine.advance(start);
    let _recording = engine.record().unwrap();
    engine.advance(start + TICK);
    let scene = prepared(vec![Displacement::default(); 100]);
    // What comes back is dropped by the owner, whose memory it is: only the take-over is guarded.
    let due = start + TICK * 2;
    engine.send(Command::SetScene(Box::new(scene))).unwrap();
    assert_no_alloc(|| {
        push(&mut pointer, due, 0.1);
        engine.step_uncollected(due);
    });
    assert_eq!(engine.snapshot().displays[0].contactors.len(), 100);
    let edited = prepared(vec![Displacement::default(); 100]);
    let serial = edited.serial();
    let due = start + TICK * 3;
    engine.send(Command::UpdateScene(Box::new(edited))).unwrap();
    assert_no_alloc(|| {
        push(&mut pointer, due, 0.2);
        engine.step_uncollected(due);
    });
    assert_eq!(engine.snapshot().scene_serial, serial);
}

#[test]
fn streaming_to_a_device_allocates_nothing() {
    let (mut engine, mut pointer) = engine(Instant::now());
    engine.send(Command::Connect(Target::Emulator)).unwrap();
    let state = |engine: &mut Engine| engine.snapshot().link.map(|link| link.state);
    let mut is_streaming = false;
    for _ in 0..4000 {
        engine.advance(Instant::now());
        match state(&mut engine) {
            Some(BridgeState::Ready) => engine.send(Command::Arm).unwrap(),
            Some(BridgeState::Streaming) => {
                is_streaming = true;
                break;
            }
            _ => {}
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    assert!(
        is_streaming,
        "the emulator streams: {:?}",
        state(&mut engine)
    );
    let start = Instant::now();
    let frames_before = engine.snapshot().link.unwrap().counters.frames_sent;
    let mut frames = 0;
    while frames < 60 {
        std::thread::sleep(Duration::from_millis(2));
        assert_no_alloc(|| {
            let now = Instant::now();
            push(&mut pointer, now, (now - start).as_secs_f64());
            engine.advance(now);
        });
        frames = engine.snapshot().link.unwrap().counters.frames_sent - frames_before;
        assert!(
            state(&mut engine).is_some_and(BridgeState::is_live),
            "it goes on"
        );
    }
}
