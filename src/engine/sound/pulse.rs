//! The server of sound: `PulseAudio`, or `PipeWire` which speaks the same. The one home of
//! `pulseaudio`.
//!
//! The client hides that a stream was killed or moved, so it is asked once a second whether it is
//! still there. Its thread ends with the socket, which is shut whatever else became of it.

use std::future::Future;
use std::net::Shutdown;
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::pin::pin;
use std::sync::Arc;
use std::task::{Context, Poll, Wake};
use std::thread::{self, Thread};
use std::time::{Duration, Instant};

use pulseaudio::protocol::stream::{BufferAttr, StreamFlags};
use pulseaudio::protocol::{
    ChannelMap, PlaybackLatency, PlaybackStreamParams, ProtocolError, SampleFormat, SampleSpec,
};
use pulseaudio::{AsPlaybackSource as _, Client, ClientError, PlaybackStream};

use super::player::{FADES_OUT, SOUND_RATE_HZ, Shared, SharedPlayer, SoundState, locked};

/// How long an answer may take.
const ANSWER: Duration = Duration::from_secs(1);
/// How often the server is asked how it stands.
const ASK: Duration = Duration::from_secs(1);
/// Bytes of both sides in a millisecond.
const BYTES_PER_MS: u32 = 8 * SOUND_RATE_HZ / 1000;
/// What waits at the server, ms: the least at which nothing is lost on a busy machine.
const TARGET_MS: u32 = 60;
/// Bytes of a cookie.
const N_COOKIE: usize = 256;
/// Left to the server.
const ITS_OWN: u32 = u32::MAX;

/// A stream that plays.
pub(super) struct Stream {
    stream: PlaybackStream,
    // Dropped after the stream.
    _link: Link,
}

/// A client whose thread ends with it.
struct Link {
    client: Client,
    socket: UnixStream,
}

impl Drop for Link {
    fn drop(&mut self) {
        // A socket that is gone already has ended the thread.
        drop(self.socket.shutdown(Shutdown::Both));
    }
}

/// Where the server listens, as the environment says.
///
/// # Errors
/// It says nothing, or names a server on another machine.
pub(super) fn socket_of(variable: impl Fn(&str) -> Option<String>) -> Result<PathBuf, String> {
    let given = |name| variable(name).filter(|value| !value.is_empty());
    if let Some(server) = given("PULSE_SERVER") {
        let mut names = server.split_whitespace().map(|name| {
            // An id of a machine may stand before it, in braces.
            let rest = name.split_once('}').map_or(name, |(_, rest)| rest);
            rest.strip_prefix("unix:").unwrap_or(rest)
        });
        let path = names.find(|name| name.starts_with('/'));
        return path.map(PathBuf::from).ok_or_else(|| {
            format!("PULSE_SERVER is {server:?}, which is no socket of this machine")
        });
    }
    [
        ("PULSE_RUNTIME_PATH", "native"),
        ("XDG_RUNTIME_DIR", "pulse/native"),
    ]
    .into_iter()
    .filter_map(|(name, under)| Some(Path::new(&given(name)?).join(under)))
    .find(|path| path.exists())
    .ok_or_else(|| "no PulseAudio or PipeWire runs here".to_owned())
}

/// Opens a stream that plays at once.
///
/// # Errors
/// No server answers at this socket, or it has nothing to play on.
pub(super) fn open(path: &Path, player: &SharedPlayer) -> Result<Stream, String> {
    let silent = |what: String| format!("{}: {what}", path.display());
    let link = connect(path).map_err(|error| silent(described(&error)))?;
    let player = Arc::clone(player);
    let source = move |bytes: &mut [u8]| {
        locked(&player).fill_bytes(bytes);
        bytes.len()
    };
    let opened = link
        .client
        .create_playback_stream(params(), source.as_playback_source());
    match wait(opened, ANSWER) {
        Some(Ok(stream)) => Ok(Stream {
            stream,
            _link: link,
        }),
        Some(Err(error)) => Err(silent(described(&error))),
        None => Err(silent("the server of sound does not answer".to_owned())),
    }
}

fn connect(path: &Path) -> Result<Link, ClientError> {
    let socket = UnixStream::connect(path)?;
    socket.set_read_timeout(Some(ANSWER))?;
    socket.set_write_timeout(Some(ANSWER))?;
    let ours = socket.try_clone()?;
    let client = Client::new_unix(c"Selvedge", socket, Some(cookie()))?;
    Ok(Link {
        client,
        socket: ours,
    })
}

/// What proves to a server whose user we are; one that wants none throws out whoever sends another
/// length.
fn cookie() -> Vec<u8> {
    let path = pulseaudio::cookie_path_from_env();
    let cookie = path.and_then(|path| std::fs::read(path).ok());
    let cookie = cookie.filter(|cookie| cookie.len() == N_COOKIE);
    cookie.unwrap_or_else(|| vec![0; N_COOKIE])
}

fn params() -> PlaybackStreamParams {
    PlaybackStreamParams {
        sample_spec: SampleSpec {
            format: SampleFormat::Float32Le,
            channels: 2,
            sample_rate: SOUND_RATE_HZ,
        },
        channel_map: ChannelMap::stereo(),
        buffer_attr: BufferAttr {
            max_length: ITS_OWN,
            target_length: TARGET_MS * BYTES_PER_MS,
            pre_buffering: ITS_OWN,
            minimum_request_length: ITS_OWN,
            fragment_size: ITS_OWN,
        },
        flags: StreamFlags {
            adjust_latency: true,
            ..StreamFlags::default()
        },
        ..PlaybackStreamParams::default()
    }
}

impl Stream {
    /// Plays until the output is dropped.
    ///
    /// # Errors
    /// The server does not answer any more, or has let the stream go.
    pub(super) fn play(self, shared: &Shared) -> Result<(), String> {
        while !shared.is_over() {
            match wait(self.stream.timing_info(), ANSWER) {
                Some(Ok(timing)) => shared.set_state(SoundState::Playing {
                    by: "PulseAudio or PipeWire",
                    latency: Some(latency(&timing)),
                }),
                Some(Err(error)) => return Err(described(&error)),
                None => return Err("the server of sound does not answer any more".to_owned()),
            }
            shared.nap(ASK);
        }
        thread::sleep(FADES_OUT);
        Ok(())
    }
}

/// From the making of the next sample to its playing.
fn latency(timing: &PlaybackLatency) -> Duration {
    let waiting = timing.write_offset.saturating_sub(timing.read_offset);
    let waiting_us = u64::try_from(waiting).unwrap_or(0) * 1000 / u64::from(BYTES_PER_MS);
    Duration::from_micros(waiting_us.saturating_add(timing.sink_usec))
}

/// In words; a read that took too long is a server that does not answer.
fn described(error: &ClientError) -> String {
    match error {
        ClientError::Disconnected => "the server of sound has gone".to_owned(),
        ClientError::Io(io) | ClientError::Protocol(ProtocolError::Io(io)) => match io.kind() {
            std::io::ErrorKind::WouldBlock => "the server of sound does not answer".to_owned(),
            _ => io.to_string(),
        },
        error => error.to_string(),
    }
}

/// Waits for an answer, but no longer than this.
pub(super) fn wait<T>(answer: impl Future<Output = T>, limit: Duration) -> Option<T> {
    struct Unpark(Thread);
    impl Wake for Unpark {
        fn wake(self: Arc<Self>) {
            self.0.unpark();
        }
    }
    let waker = Arc::new(Unpark(thread::current())).into();
    let mut context = Context::from_waker(&waker);
    let mut answer = pin!(answer);
    let until = Instant::now() + limit;
    loop {
        if let Poll::Ready(value) = answer.as_mut().poll(&mut context) {
            return Some(value);
        }
        let left = until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return None;
        }
        thread::park_timeout(left);
    }
}
