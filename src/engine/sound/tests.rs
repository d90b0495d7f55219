//! Outputs against servers that are not there, do not answer, and a real one.

use std::fs;
use std::os::unix::net::UnixListener;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::sync_channel;

use super::*;
use pulse::socket_of;
use pulseaudio::{Client, protocol};
use selvedge_foundation::numerics::{Complex, RealTransform};
use selvedge_scratch::ScratchFolder;
use std::time::Instant;

/// 320 Hz at half of full scale, on both sides.
#[derive(Default)]
struct Tone(u32);

impl SoundSource for Tone {
    fn fill(&mut self, frames: &mut [[f32; 2]]) {
        for frame in frames {
            let turn = f64::from(self.0) * 320.0 / f64::from(SOUND_RATE_HZ);
            #[expect(clippy::cast_possible_truncation, reason = "sound has fewer digits")]
            let x = (0.5 * (std::f64::consts::TAU * turn).sin()) as f32;
            *frame = [x; 2];
            self.0 = (self.0 + 1) % 150;
        }
    }
}

/// An output at this socket, without `aplay`.
fn opened(socket: PathBuf) -> SoundOutput {
    let ways: Ways = Box::new(move |player, shared| pulse::open(&socket, player)?.play(shared));
    SoundOutput::open_by(Box::<Tone>::default(), ways).unwrap()
}

/// The state once it is none of those before; whoever waits too long fails.
fn awaited(output: &SoundOutput, is_it: impl Fn(&SoundState) -> bool) -> SoundState {
    let since = Instant::now();
    while since.elapsed() < Duration::from_secs(30) {
        let state = output.state();
        if is_it(&state) {
            return state;
        }
        thread::sleep(Duration::from_millis(5));
    }
    panic!("{:?}", output.state());
}

fn absent(output: &SoundOutput) -> String {
    match awaited(output, |state| *state != SoundState::Opening) {
        SoundState::Absent(why) => why,
        state => panic!("{state:?}"),
    }
}

fn n_threads() -> usize {
    let names = fs::read_dir("/proc/self/task").unwrap().flatten();
    let name = |entry: fs::DirEntry| fs::read_to_string(entry.path().join("comm"));
    let names = names.filter_map(|entry| name(entry).ok());
    names
        .filter(|name| name.starts_with("selvedge-sound"))
        .count()
}

#[test]
fn the_socket_is_where_the_environment_says() {
    let folder = ScratchFolder::made("sockets");
    let at = |variables: &[(&str, &str)]| {
        let find = |name: &str| {
            let of = variables.iter().find(|(known, _)| *known == name);
            of.map(|(_, value)| (*value).to_owned())
        };
        socket_of(find)
    };
    for server in ["unix:/a/native", "/a/native", "{1f2e}unix:/a/native tcp:b"] {
        let found = at(&[("PULSE_SERVER", server), ("XDG_RUNTIME_DIR", "/b")]);
        assert_eq!(found, Ok(PathBuf::from("/a/native")), "{server}");
    }
    let far = at(&[("PULSE_SERVER", "tcp:elsewhere:4713")]).unwrap_err();
    assert!(far.contains("tcp:elsewhere"), "{far}");
    let root = folder.join("run");
    fs::create_dir_all(root.join("pulse")).unwrap();
    let root = root.to_str().unwrap();
    let nothing = at(&[
        ("PULSE_RUNTIME_PATH", "/nowhere"),
        ("XDG_RUNTIME_DIR", root),
    ]);
    assert_eq!(nothing.unwrap_err(), "no PulseAudio or PipeWire runs here");
    fs::write(Path::new(root).join("pulse/native"), "").unwrap();
    let found = at(&[
        ("PULSE_RUNTIME_PATH", "/nowhere"),
        ("XDG_RUNTIME_DIR", root),
    ]);
    assert_eq!(found, Ok(Path::new(root).join("pulse/native")));
    assert!(at(&[("PULSE_SERVER", "")]).is_err());
}

#[test]
fn no_server_and_no_listener_are_one_line_each() {
    let folder = ScratchFolder::made("nobody");
    let why = absent(&opened(folder.join("native")));
    assert!(why.contains("native: "), "{why}");
    drop(UnixListener::bind(folder.join("left")).unwrap());
    let why = absent(&opened(folder.join("left")));
    assert!(why.contains("refused") && why.lines().count() == 1, "{why}");
}

#[test]
fn a_server_that_never_answers_is_given_up_and_nobody_waits_for_it() {
    let folder = ScratchFolder::made("mute");
    let path = folder.join("native");
    let listener = UnixListener::bind(&path).unwrap();
    let output = opened(path);
    assert_eq!(output.state(), SoundState::Opening);
    let why = absent(&output);
    assert!(why.contains("does not answer"), "{why}");
    drop(output);
    drop(listener);
}

#[test]
fn a_player_fades_keeps_its_level_and_lets_nothing_through_that_is_no_number() {
    struct Wild;
    impl SoundSource for Wild {
        fn fill(&mut self, frames: &mut [[f32; 2]]) {
            for (n, frame) in frames.iter_mut().enumerate() {
                *frame = [[f32::NAN, 9.0], [f32::INFINITY, -9.0]][n % 2];
            }
        }
    }
    let output = opened(PathBuf::from("/nowhere"));
    output.set_level(0.5);
    let mut player = Player {
        source: Box::new(Wild),
        shared: Arc::clone(&output.shared),
        gain: 0.0,
    };
    let mut bytes = vec![9; 8 * 4800 + 3];
    player.fill_bytes(&mut bytes);
    assert_eq!(bytes[8 * 4800..], [0; 3], "no whole frame");
    let float = |part: &[u8]| f32::from_le_bytes(part.try_into().unwrap());
    let samples: Vec<f32> = bytes.chunks_exact(4).map(float).collect();
    assert!(samples.iter().all(|x| x.abs() <= 1.0));
    assert!(samples[1].abs() < 0.01, "it begins softly");
    output.set_level(f32::NAN);
    player.fill_bytes(&mut bytes);
    let mut last = bytes[8 * 4700..8 * 4800].chunks_exact(4).map(float);
    assert!(last.all(|x| x == 0.0), "no level is silence");
    assert_eq!(player.gain.to_bits(), 0);
}

/// A server of one's own with a sink that nobody hears.
struct Server {
    child: Child,
    folder: ScratchFolder,
}

impl Server {
    /// `None` where none is installed.
    fn started(name: &str) -> Option<Self> {
        let folder = ScratchFolder::made(name);
        let socket = folder.join("native");
        let script = format!(
            "load-module module-null-sink sink_name=null rate={SOUND_RATE_HZ}\n\
             load-module module-native-protocol-unix auth-anonymous=1 socket={}\n",
            socket.display()
        );
        fs::write(folder.join("null.pa"), script).unwrap();
        let Ok(child) = Self::spawned(&folder) else {
            eprintln!("skipped: pulseaudio is not installed");
            return None;
        };
        let server = Self { child, folder };
        let since = Instant::now();
        while !socket.exists() {
            assert!(since.elapsed() < Duration::from_secs(30), "no socket");
            thread::sleep(Duration::from_millis(10));
        }
        Some(server)
    }

    fn spawned(folder: &ScratchFolder) -> std::io::Result<Child> {
        Command::new("pulseaudio")
            .args(["-n", "--daemonize=no", "--use-pid-file=no"])
            .args(["--exit-idle-time=-1", "-F"])
            .arg(folder.join("null.pa"))
            .env("XDG_RUNTIME_DIR", folder.join(""))
            .env("HOME", folder.join(""))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
    }

    /// Killed, as a crash would.
    fn end(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
    }

    fn socket(&self) -> PathBuf {
        self.folder.join("native")
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.end();
    }
}

/// What plays on the sink for so long, left.
fn recorded(server: &Server, output: &SoundOutput, seconds: usize) -> Vec<f32> {
    let socket = std::os::unix::net::UnixStream::connect(server.socket()).unwrap();
    let client = Client::new_unix(c"test", socket, Some([0; 256])).unwrap();
    let (sender, blocks) = sync_channel::<Vec<u8>>(100_000);
    let params = protocol::RecordStreamParams {
        sample_spec: protocol::SampleSpec {
            format: protocol::SampleFormat::Float32Le,
            channels: 2,
            sample_rate: SOUND_RATE_HZ,
        },
        channel_map: protocol::ChannelMap::stereo(),
        source_name: Some(c"null.monitor".to_owned()),
        buffer_attr: protocol::stream::BufferAttr {
            max_length: u32::MAX,
            fragment_size: 8 * 240,
            ..protocol::stream::BufferAttr::default()
        },
        flags: protocol::stream::StreamFlags {
            adjust_latency: true,
            ..protocol::stream::StreamFlags::default()
        },
        ..protocol::RecordStreamParams::default()
    };
    let sink = move |data: &[u8]| drop(sender.try_send(data.to_vec()));
    let recorder = pulse::wait(
        client.create_record_stream(params, sink),
        Duration::from_secs(5),
    );
    let recorder = recorder.unwrap().unwrap();
    // A sink that slept has rendered ahead: it is awake after a while.
    thread::sleep(Duration::from_secs(3));
    blocks.try_iter().for_each(drop);
    output.set_level(1.0);
    let mut left = Vec::new();
    while left.len() < seconds * SOUND_RATE_HZ as usize {
        let bytes = blocks.recv_timeout(Duration::from_secs(20)).unwrap();
        let float = |frame: &[u8]| f32::from_le_bytes(frame[..4].try_into().unwrap());
        left.extend(bytes.chunks_exact(8).map(float));
    }
    drop(recorder);
    left
}

#[test]
fn a_real_server_plays_320_hz_and_one_that_is_killed_is_missed_and_found_again() {
    let Some(mut server) = Server::started("pulse") else {
        return;
    };
    let output = opened(server.socket());
    let state = awaited(&output, |state| *state != SoundState::Opening);
    assert!(matches!(state, SoundState::Playing { .. }), "{state:?}");
    let left = recorded(&server, &output, 4);
    // A busy machine drops some: what is whole is 320 Hz and nothing else.
    let is_silent = |part: &[f32]| part.iter().all(|x| x.abs() < 1e-6);
    let past_fade = left[2 * SOUND_RATE_HZ as usize..].chunks_exact(4800);
    let whole = past_fade.filter(|part| !part.windows(4).any(is_silent));
    let mut n_whole = 0;
    for part in whole {
        let part: Vec<f64> = part.iter().copied().map(f64::from).collect();
        let spectrum = RealTransform::new(part.len()).forward(&part);
        let power: f64 = spectrum.iter().map(Complex::norm_sqr).sum();
        let amplitude = 2.0 * spectrum[32].norm() / part.len() as f64;
        assert!((amplitude - 0.5).abs() < 1e-3, "{amplitude}");
        assert!(power - spectrum[32].norm_sqr() < 1e-8 * power);
        n_whole += 1;
    }
    assert!(n_whole >= 5, "{n_whole}");
    server.end();
    awaited(&output, |state| matches!(state, SoundState::Absent(_)));
    drop(fs::remove_file(server.socket()));
    server.child = Server::spawned(&server.folder).unwrap();
    awaited(&output, |state| matches!(state, SoundState::Playing { .. }));
}

#[test]
fn outputs_that_are_dropped_leave_no_thread_behind() {
    let folder = ScratchFolder::made("gone");
    let server = Server::started("cycles");
    for n in 0..20 {
        let socket = match &server {
            Some(server) if n % 2 == 0 => server.socket(),
            _ => folder.join("native"),
        };
        let output = opened(socket);
        awaited(&output, |state| *state != SoundState::Opening);
    }
    let since = Instant::now();
    // Those of tests beside this one come and go.
    while n_threads() > 3 {
        assert!(since.elapsed() < Duration::from_secs(30), "{}", n_threads());
        thread::sleep(Duration::from_millis(20));
    }
}
