//! The core on an emulated Cortex-M3 board behind a pseudo-terminal, against the real host.
//!
//! Only the device's counters and clock are judged: a busy machine slows the board's clock, and a
//! host that gets no processor for 100 ms loses its device, as it should. Then it is tried again;
//! one board runs at a time.

use std::fs::File;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::AtomicBool;
use std::sync::mpsc::{Receiver, sync_channel};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use selvedge_device::{
    ArrayProfile, Bridge, BridgeEvent, BridgeState, Certificate, Clear, Decoder, DeviceMessage,
    DeviceState, DirectLine, Extent, Hello, Message as _, Status, StopHow, Target, Trial,
};

use super::tools;
use crate::program::Lab;

const COMPILER: &str = "arm-none-eabi-gcc";
const EMULATOR: &str = "qemu-system-arm";
/// Fault bit 4: restarted by the watchdog, a hard fault or a brown-out.
const RESTARTED: u16 = 1 << 4;
/// A busy machine can keep an emulated board waiting for longer than a watchdog may.
const WITHOUT_WATCHDOG: &str = "-DHBP_NO_WATCHDOG";
const PATIENCE: Duration = Duration::from_secs(30);
/// Tries on a machine that is busy with something else.
const N_TRIES: usize = 25;
/// The same for certificates, which try again by themselves.
const N_CERTIFICATES: u32 = 6;
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
        Self::start_built(lab, skipped, &[WITHOUT_WATCHDOG])
    }

    /// The same with more arguments for the compiler.
    fn start_built(lab: &Lab, skipped: &str, more: &[&str]) -> Option<Self> {
        if !(tools::has(COMPILER, skipped) && tools::has(EMULATOR, skipped)) {
            return None;
        }
        // A test that failed while it had the turn says so itself.
        let turn = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
        let program = lab.path("hbp.elf");
        build(&program, more);
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

fn build(program: &Path, more: &[&str]) {
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
    args.extend(more.iter().map(|arg| String::from(*arg)));
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
        for more in [&[] as &[&str], &[WITHOUT_WATCHDOG]] {
            build(&lab.path("hbp.elf"), more);
            let size = std::fs::metadata(lab.path("hbp.elf")).unwrap().len();
            assert!((2000..200_000).contains(&size), "{size} bytes");
        }
    }
}

#[test]
fn an_emulated_board_passes_the_quick_certificate_and_plays_a_stroke() {
    let lab = Lab::with_scene();
    let Some(board) = Board::start(&lab, "the firmware on an emulated board") else {
        return;
    };
    let certificates = (0..N_CERTIFICATES).map(|number| {
        let trial = Trial {
            extent: Extent::Quick,
            nonce: 1 + 100_000 * number,
        };
        let target = Target::Port(board.port.clone());
        let mut line = DirectLine::open(target, &ArrayProfile::default(), None).unwrap();
        let certificate = Certificate::of(&mut line, trial, &AtomicBool::new(false), &mut |_| {});
        line.close();
        certificate
    });
    let mut said = String::new();
    let passed = certificates.into_iter().find(|certificate| {
        said = certificate.to_markdown();
        certificate.passed()
    });
    let certificate = passed.unwrap_or_else(|| panic!("the last of {N_CERTIFICATES}:\n{said}"));
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
                    self.statuses
                        .extend(self.bridge.session().status().copied());
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
        self.until(|host| {
            host.bridge
                .session()
                .status()
                .is_some_and(|s| s.amp_sum == full)
        })
    }

    fn is_at_rest(&self) -> bool {
        let rest = DeviceState::Ready.code();
        let rested = |status: &Status| status.state == rest && status.amp_sum == 0;
        self.bridge.session().status().is_some_and(rested) && !self.bridge.state().is_live()
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
            let at_rest = host.bridge.session().status().copied().unwrap();
            assert_eq!((at_rest.hv_dv, at_rest.faults), (0, 0));
            Some(host.bridge.counters().device.underrun - before)
        });
        assert!(underruns <= 1, "a stopped device misses nothing");
    }
}

/// The board's terminal without the host: what it says comes over a channel.
struct Terminal {
    port: File,
    said: Receiver<Vec<u8>>,
    decoder: Decoder,
}

impl Terminal {
    fn open(board: &Board) -> Self {
        let mut options = File::options();
        let port = options.read(true).write(true).open(&board.port).unwrap();
        let mut reader = port.try_clone().unwrap();
        let (sender, said) = sync_channel(1000);
        let name = std::thread::Builder::new().name(String::from("terminal"));
        name.spawn(move || {
            let mut bytes = [0; 1000];
            while let Ok(n @ 1..) = reader.read(&mut bytes) {
                if sender.send(bytes[..n].to_vec()).is_err() {
                    return;
                }
            }
        })
        .unwrap();
        Self {
            port,
            said,
            decoder: Decoder::new(1024),
        }
    }

    /// Says HELLO until a STATUS is as `wanted`. The emulator is deaf for a second after an
    /// opening.
    fn status(&mut self, session: u32, wanted: impl Fn(&Status) -> bool) {
        let deadline = Instant::now() + PATIENCE;
        let hello = Hello::new(session).packet(1).unwrap();
        while Instant::now() < deadline {
            self.port.write_all(hello.as_bytes()).unwrap();
            let until = Instant::now() + Duration::from_millis(300);
            while let Ok(bytes) = self.said.recv_timeout(until - Instant::now()) {
                if self.statuses(&bytes).iter().any(&wanted) {
                    return;
                }
            }
        }
        panic!("no such STATUS in {PATIENCE:?}");
    }

    fn statuses(&mut self, bytes: &[u8]) -> Vec<Status> {
        let mut found = Vec::new();
        for byte in bytes {
            let packet = self.decoder.push(*byte);
            let message = packet.and_then(|packet| DeviceMessage::decode(&packet, 24).ok());
            if let Some(DeviceMessage::Status(status)) = message {
                found.push(status);
            }
        }
        found
    }
}

#[test]
fn an_emulated_board_that_ran_into_a_hard_fault_starts_anew_and_says_so() {
    let lab = Lab::new();
    let trap = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/suite/firmware/trap.c");
    let trap = trap.display().to_string();
    let include = format!("-I{}", tools::kit().join("firmware").display());
    let more = [WITHOUT_WATCHDOG, "-Wl,--wrap=hbp_receive", &include, &trap];
    let Some(board) = Board::start_built(&lab, "a hard fault on an emulated board", &more) else {
        return;
    };
    let mut terminal = Terminal::open(&board);
    let is_well = |status: &Status| status.state == DeviceState::Ready.code() && status.faults == 0;
    terminal.status(1, is_well);
    terminal.port.write_all(&[0xf0, 0xf1, 0xf2, 0xf3]).unwrap();
    terminal.status(2, |status| {
        status.state == DeviceState::Fault.code() && status.faults == RESTARTED
    });
    // It is over, so that CLEAR will do.
    let clear = Clear { bits: u16::MAX }.packet(2).unwrap();
    terminal.port.write_all(clear.as_bytes()).unwrap();
    terminal.status(3, is_well);
}

/// The emulator does not mind; on the real board a register without its clock is a bus fault.
#[test]
fn a_port_of_the_board_has_its_clock_before_it_is_written() {
    let path = tools::kit().join("firmware/lm3s6965evb/board.c");
    let source = std::fs::read_to_string(path).unwrap();
    let body = |name: &str| {
        let from = source.find(&format!("{name}(void)\n{{")).unwrap();
        let length = source[from..].find("\n}\n").unwrap();
        &source[from..from + length]
    };
    let starts = [
        (
            "static void start_high_voltage_pin",
            "SYSTEM_RCGC2",
            "GPIO_F(",
        ),
        ("static void start_uart", "SYSTEM_RCGC2", "GPIO_A("),
        ("static void start_uart", "SYSTEM_RCGC1", "UART("),
        ("static void start_watchdog", "SYSTEM_RCGC0", "WATCHDOG("),
    ];
    for (start, clock, port) in starts {
        let body = body(start);
        let clocked = body.find(&format!("SYSTEM({clock}) |=")).unwrap();
        // Reading a clock register back gives the clock the cycles that it needs.
        let waited = body.find("(void)SYSTEM(").unwrap();
        let written = body.find(port).unwrap();
        assert!(clocked < waited && waited < written, "{start}: {port}");
    }
    // The core switches the high voltage off as soon as it begins, so its pin is ready by then.
    let main = body("int main");
    let at = |call: &str| main.find(call).unwrap();
    assert!(at("start_high_voltage_pin()") < at("hbp_init("));
    assert!(at("hbp_init(") < at("start_systick()"), "no sample before");
}
