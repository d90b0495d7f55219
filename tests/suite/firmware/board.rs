//! The core on an emulated Cortex-M3 board behind a pseudo-terminal, against the real host.
//!
//! Only the device's counters and clock are judged: a busy machine slows the board's clock, and a
//! host that gets no processor for 100 ms loses its device, as it should. Then it is tried again;
//! one board runs at a time.

use std::io::{BufRead as _, BufReader};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use selvedge_device::{
    ArrayProfile, Bridge, BridgeEvent, BridgeState, Certificate, DeviceState, Extent, Status,
    StopHow, Target, Trial, certify_port,
};

use super::tools;
use crate::program::Lab;

const COMPILER: &str = "arm-none-eabi-gcc";
const EMULATOR: &str = "qemu-system-arm";
const PATIENCE: Duration = Duration::from_secs(30);
/// Tries on a machine that is busy with something else.
const N_TRIES: usize = 25;
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

/// A board that runs until it is dropped.
struct Board {
    _turn: MutexGuard<'static, ()>,
    child: Child,
    port: PathBuf,
}

impl Board {
    /// Builds the firmware and starts it; without the tools says what is skipped.
    fn start(lab: &Lab, skipped: &str) -> Option<Self> {
        if !(tools::has(COMPILER, skipped) && tools::has(EMULATOR, skipped)) {
            return None;
        }
        // A test that failed while it had the turn says so itself.
        let turn = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
        let program = lab.path("hbp.elf");
        build(&program);
        let mut command = Command::new(EMULATOR);
        command.args(["-M", "lm3s6965evb", "-nographic", "-monitor", "none"]);
        command.args(["-serial", "pty", "-kernel"]).arg(&program);
        command.stdin(Stdio::null()).stdout(Stdio::piped());
        let mut child = command.stderr(Stdio::null()).spawn().unwrap();
        let mut line = String::new();
        let mut said = BufReader::new(child.stdout.take().unwrap());
        said.read_line(&mut line).unwrap();
        // "char device redirected to /dev/pts/7 (label serial0)"
        let port = line.split(' ').find(|word| word.starts_with("/dev/"));
        let port = PathBuf::from(port.unwrap_or_else(|| panic!("a terminal: {line}")));
        Some(Self {
            _turn: turn,
            child,
            port,
        })
    }
}

impl Drop for Board {
    fn drop(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
    }
}

fn build(program: &std::path::Path) {
    let folder = tools::kit().join("firmware");
    let board = folder.join("lm3s6965evb");
    let mut args: Vec<String> = [
        "-mcpu=cortex-m3",
        "-mthumb",
        "-Os",
        "-std=c99",
        "-Wall",
        "-Wextra",
        "-Werror",
        "-ffreestanding",
        "-fno-tree-loop-distribute-patterns",
        "-nostdlib",
        "-T",
    ]
    .map(String::from)
    .to_vec();
    args.push(board.join("lm3s6965evb.ld").display().to_string());
    args.extend(["-o".to_owned(), program.display().to_string()]);
    for source in [
        board.join("startup.c"),
        board.join("board.c"),
        folder.join("hbp_core.c"),
    ] {
        args.push(source.display().to_string());
    }
    args.push(String::from("-lgcc"));
    tools::compile(COMPILER, &args);
}

#[test]
fn the_firmware_builds_for_a_board_without_a_word() {
    if tools::has(COMPILER, "the firmware built for a board") {
        let lab = Lab::new();
        build(&lab.path("hbp.elf"));
        let size = std::fs::metadata(lab.path("hbp.elf")).unwrap().len();
        assert!((2000..200_000).contains(&size), "{size} bytes");
    }
}

#[test]
fn an_emulated_board_passes_its_test_and_plays_a_stroke() {
    let lab = Lab::with_scene();
    let Some(board) = Board::start(&lab, "the firmware on an emulated board") else {
        return;
    };
    let mut tries = (1..=N_TRIES).map(|nth| {
        let nonce = 1000 * u32::try_from(nth).unwrap();
        let trial = Trial {
            extent: Extent::Quick,
            nonce,
        };
        certify_port(&board.port, trial, &AtomicBool::new(false), &mut |_| {}).unwrap()
    });
    let certificate = tries.find(Certificate::passed).unwrap();
    assert_eq!(certificate.device_name, "reference firmware");

    let port = board.port.display().to_string();
    let args = ["play", "a.scene.toml", "--path", "a.csv", "--port", &port];
    let played = (0..N_TRIES)
        .map(|_| lab.run(&args))
        .find(|outcome| outcome.code == 0);
    let played = played.expect("a stroke is played to its end in one of many tries");
    assert!(
        !played.out.is_empty() || !played.err.is_empty(),
        "it says what it did"
    );
}

/// A host on the board that streams full amplitude on every channel.
struct Host {
    bridge: Bridge,
    streams: bool,
    statuses: Vec<Status>,
}

impl Host {
    fn open(board: &Board) -> Self {
        let target = Target::Port(board.port.clone());
        Self {
            bridge: Bridge::open(target, ArrayProfile::default(), 24, || {}),
            streams: true,
            statuses: Vec::new(),
        }
    }

    /// Answers ticks until `is_done`; `None` when the link or the device gave up before.
    fn until(&mut self, is_done: impl Fn(&Self) -> bool) -> Option<()> {
        let deadline = Instant::now() + PATIENCE;
        while !is_done(self) {
            if Instant::now() > deadline {
                return None;
            }
            let Some(event) = self.bridge.poll() else {
                std::thread::sleep(Duration::from_micros(300));
                continue;
            };
            match event {
                BridgeEvent::Tick { received, .. } => {
                    self.statuses.extend(self.bridge.status().copied());
                    if self.streams {
                        self.bridge.send(&[[10.0, 20.0]; 24], Some(received));
                    }
                }
                BridgeEvent::Refused(reason) => panic!("{reason}"),
                BridgeEvent::Lost(_) => return None,
                BridgeEvent::Disarmed { .. } if self.streams => return None,
                _ => {}
            }
        }
        Some(())
    }

    /// To full amplitude, beyond the soft start.
    fn stream(&mut self) -> Option<()> {
        self.until(|host| host.bridge.state() == BridgeState::Ready)?;
        assert!(self.bridge.arm(), "a ready device can be armed");
        self.until(|host| host.bridge.counters().frames_sent >= 21)?;
        let full = 24 * (13_107 + 26_214);
        self.until(|host| host.bridge.status().is_some_and(|s| s.amp_sum == full))
    }

    fn is_at_rest(&self) -> bool {
        let rest = DeviceState::Ready.code();
        let rested = |status: &Status| status.state == rest && status.amp_sum == 0;
        self.bridge.status().is_some_and(rested) && !self.bridge.state().is_live()
    }
}

/// Runs `attempt` on a new host until one was not disturbed by a busy machine.
fn undisturbed<T>(board: &Board, attempt: impl Fn(&mut Host) -> Option<T>) -> T {
    let found = (0..N_TRIES).find_map(|_| attempt(&mut Host::open(board)));
    found.expect("every try was disturbed: a very busy machine, or a device that disarms")
}

#[test]
fn an_emulated_board_falls_silent_within_100_ms_of_its_own_clock() {
    let lab = Lab::new();
    let Some(board) = Board::start(&lab, "the silence of an emulated board") else {
        return;
    };
    let statuses = undisturbed(&board, |host| {
        host.stream()?;
        host.streams = false;
        host.statuses.clear();
        host.until(Host::is_at_rest)?;
        Some(host.statuses.clone())
    });
    let full = 24 * (13_107 + 26_214);
    let mut falling = 0;
    for status in &statuses {
        let age_ms = status.age_ms;
        let expected = match age_ms {
            0..=59 => full..=full,
            60..=98 => 1..=full - 1,
            99 => 0..=full / 40,
            _ => 0..=0,
        };
        // An age is told in whole ms, rounded down.
        let is_edge = age_ms == 60;
        assert!(
            expected.contains(&status.amp_sum) || is_edge,
            "{age_ms} ms: {status:?}"
        );
        falling += usize::from(status.amp_sum > 0 && status.amp_sum < full);
        let is_silent = status.state == DeviceState::Ready.code();
        assert!(
            is_silent == (age_ms >= 99) || age_ms == 99,
            "{age_ms} ms: {status:?}"
        );
    }
    assert!(falling > 0, "the ramp is seen: {statuses:?}");
}

#[test]
fn an_emulated_board_obeys_stop_and_takes_a_new_host_afterwards() {
    let lab = Lab::new();
    let Some(board) = Board::start(&lab, "STOP on an emulated board") else {
        return;
    };
    for how in [StopHow::Ramp, StopHow::Now] {
        let underruns = undisturbed(&board, |host| {
            host.stream()?;
            let before = host.bridge.counters().device.underrun;
            host.streams = false;
            host.bridge.stop(how);
            host.until(Host::is_at_rest)?;
            let at_rest = host.bridge.status().copied().unwrap();
            assert_eq!((at_rest.hv_dv, at_rest.faults), (0, 0));
            Some(host.bridge.counters().device.underrun - before)
        });
        assert!(underruns <= 1, "a stopped device misses nothing");
    }
}
