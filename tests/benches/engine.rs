//! How punctual the engine is with a device: in process and over a pseudo-terminal.
//!
//! A pointer moves at 125 Hz for a minute (`--quick`: 5 s) while an emulated device paces. Prints
//! how late frames were written after they were due (a while after the STATUS that asked for them,
//! so that they come just in time), how old the pointer's sample
//! was by then, and what was missed.

#![expect(clippy::print_stdout, reason = "a bench prints its figures")]
#![expect(
    clippy::unwrap_used,
    reason = "a bench that cannot run says so by panicking"
)]

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use selvedge_device::{ArrayProfile, BridgeState, Spread, Target};
use selvedge_engine::{
    Command, Engine, EngineConfig, PointerSample, PointerSender, PreparedScene, Snapshot,
};
use selvedge_foundation::geometry::Point;
use selvedge_foundation::quantity::time_span;
use selvedge_render::array::{Accuracy, Method};
use selvedge_render::scene::LoadedScene;

/// Between two samples of the pointer.
const MOUSE: Duration = Duration::from_millis(8);
/// Longest wait for a device.
const PATIENCE: Duration = Duration::from_secs(10);

fn main() {
    let is_quick = std::env::args().any(|argument| argument == "--quick");
    let duration = Duration::from_secs(if is_quick { 5 } else { 60 });
    println!(
        "device-paced for {} s each, pointer at 125 Hz",
        duration.as_secs()
    );
    run("emulator in process", Target::Emulator, duration);
    #[cfg(unix)]
    over_a_terminal(duration);
}

#[cfg(unix)]
fn over_a_terminal(duration: Duration) {
    use selvedge_device::{DeviceModel, Faults, PtyEmulator};

    let link = std::env::temp_dir().join(format!("selvedge-bench-{}", std::process::id()));
    let model = DeviceModel::for_array(&ArrayProfile::default());
    let emulator = PtyEmulator::new(model, &Faults::default(), &link, None).unwrap();
    let is_over = AtomicBool::new(false);
    thread::scope(|scope| {
        let builder = thread::Builder::new().name("bench-emulator".to_owned());
        builder
            .spawn_scoped(scope, || emulator.run(&is_over, |_, _| {}).unwrap())
            .unwrap();
        run(
            "emulator behind a pty",
            Target::Port(link.clone()),
            duration,
        );
        is_over.store(true, Ordering::SeqCst);
    });
}

fn run(what: &str, target: Target, duration: Duration) {
    let mut engine = Engine::start(EngineConfig {
        scene: scene(),
        on_news: None,
    })
    .unwrap();
    engine.send(Command::Connect(target)).unwrap();
    reach(&mut engine, BridgeState::Ready);
    engine.send(Command::Arm).unwrap();
    reach(&mut engine, BridgeState::Streaming);
    let is_over = Arc::new(AtomicBool::new(false));
    let mouse = move_pointer(engine.take_pointer().unwrap(), Arc::clone(&is_over));
    thread::sleep(duration);
    report(what, engine.snapshot());
    is_over.store(true, Ordering::SeqCst);
    mouse.join().unwrap();
    engine.send(Command::Disarm).unwrap();
}

fn reach(engine: &mut Engine, state: BridgeState) {
    let deadline = Instant::now() + PATIENCE;
    while engine.snapshot().link.map(|link| link.state) != Some(state) {
        assert!(Instant::now() < deadline, "the device never became {state}");
        thread::sleep(Duration::from_millis(5));
    }
}

/// Moves the pointer in circles.
fn move_pointer(mut pointer: PointerSender, is_over: Arc<AtomicBool>) -> thread::JoinHandle<()> {
    let draw = move || {
        let start = Instant::now();
        let mut due = start;
        while !is_over.load(Ordering::SeqCst) {
            due += MOUSE;
            thread::sleep(due.saturating_duration_since(Instant::now()));
            let stamp = Instant::now();
            let (sin, cos) = (3.0 * (stamp - start).as_secs_f64()).sin_cos();
            let position = Point::new(50.0 + 30.0 * cos, 50.0 + 30.0 * sin);
            pointer.push(PointerSample { stamp, position });
        }
    };
    thread::Builder::new()
        .name("bench-pointer".to_owned())
        .spawn(draw)
        .unwrap()
}

fn report(what: &str, snapshot: &Snapshot) {
    let (clock, link) = (&snapshot.clock, snapshot.link.unwrap());
    println!("{what}");
    print_spread("answer due to FRAME written", link.timings.due_to_write);
    print_spread(
        "pointer stamp to FRAME written",
        link.timings.stamp_to_write,
    );
    print_spread("tick due to frame handed over", clock.lateness);
    println!(
        "  {:<34} {} ns",
        "cost of a tick (recent median)", clock.cost_ns
    );
    let felt = snapshot
        .pointer
        .felt_age
        .map_or(0.0, |age| age.as_secs_f64());
    println!(
        "  {:<34} {} at depth {}",
        "age of a felt amplitude",
        time_span(felt),
        link.depth
    );
    println!(
        "  {:<34} {} before the tick; clock {:+.1} ppm",
        "frames are due",
        time_span(link.lead.as_secs_f64()),
        link.clock.rate_ppm
    );
    println!(
        "  ticks {}, late {}, missed {}, own-clock takeovers {}",
        snapshot.tick, clock.late, clock.missed, clock.fallbacks
    );
    let device = link.counters.device;
    println!(
        "  frames {}, superseded {}; device: underruns {}, late {}, bad {}",
        link.counters.frames_sent,
        link.counters.frames_superseded,
        device.underrun,
        device.late,
        device.bad
    );
}

fn print_spread(what: &str, spread: Spread) {
    let [median, p99, max] =
        [spread.median, spread.p99, spread.max].map(|span| time_span(span.as_secs_f64()));
    println!(
        "  {what:<34} p50 {median:>10}  p99 {p99:>10}  max {max:>10}  n {}",
        spread.n
    );
}

/// The scene that the program ships.
fn scene() -> PreparedScene {
    let loaded = LoadedScene::shipped().unwrap();
    PreparedScene::prepare(&loaded, Method::Auto, &Accuracy::default()).unwrap()
}
