//! Other programs join by a connection on this machine: positions in, amplitudes out, as lines.
//!
//! Whoever connects hears a line a tick. The first who says a position is the one that moves the
//! display, until it goes away; others are told so and go on listening. Nobody is waited for: a
//! program that reads too slowly is let go, and what comes faster than it can be used is dropped
//! and counted. Only addresses of this machine are listened to: nothing here asks who is there.
//!
//! ```text
//! engine ─ Tap (ring) ─▶ teller ─ bounded queue a program ─▶ socket        a line a tick
//! socket ─▶ a thread a program ─ feed (ring) ─▶ engine                     a line a position
//! ```

mod client;
#[cfg(test)]
mod tests;

use std::io;
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use super::input::{FeedSender, InputError, feed};
use super::tap::{FeltTick, Tap, TapReader, tap};
use super::{EngineError, InputSource, SourceKind};
use client::Client;
use selvedge_foundation::files::push_number;

/// Programs that may be connected at once.
const MAX_CLIENTS: usize = 16;
/// How long the teller sleeps when nothing wakes it.
const NAP: Duration = Duration::from_millis(100);
/// How long a goodbye may take.
const GOODBYE: Duration = Duration::from_millis(200);

/// How it stands with other programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ProgramCounts {
    /// Programs that are connected.
    pub connected: usize,
    /// Whether one of them moves the display.
    pub has_writer: bool,
    /// Programs that read too slowly and were let go.
    pub let_go: u64,
    /// Ticks that nobody could be told of in time.
    pub(crate) lost_ticks: u64,
}

/// Listens for programs until it is dropped.
#[derive(Debug)]
pub struct ProgramLink {
    address: SocketAddr,
    shared: Arc<Shared>,
    teller: Option<JoinHandle<()>>,
    listener: Option<JoinHandle<()>>,
}

/// What the threads share.
#[derive(Debug, Default)]
struct Shared {
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    is_over: bool,
    clients: Vec<Client>,
    next_id: u64,
    /// Where positions go; `None` until somebody wants them.
    feed: Option<FeedSender>,
    /// The program that moves the display.
    writer: Option<u64>,
    /// What the teller reads next.
    tap: Option<TapReader>,
    header: String,
    n_contactors: usize,
    let_go: u64,
    lost_ticks: u64,
}

impl Shared {
    /// Nothing that holds the lock can be left half done by a panic.
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// An address of this machine: `127.0.0.1:7240`, `[::1]:7240` or `localhost:7240`; port 0 takes any
/// that is free.
///
/// # Errors
/// It is no address, or one that other machines reach.
pub fn loopback(text: &str) -> Result<SocketAddr, InputError> {
    let named = text.strip_prefix("localhost:");
    let numbered = named.map(|port| format!("127.0.0.1:{port}"));
    let address: SocketAddr = numbered
        .as_deref()
        .unwrap_or(text)
        .parse()
        .map_err(|_not_one| InputError::Address(text.to_owned()))?;
    if address.ip().is_loopback() {
        Ok(address)
    } else {
        Err(InputError::NotLoopback(address))
    }
}

impl ProgramLink {
    /// Begins to listen at an address of this machine.
    ///
    /// # Errors
    /// The address is another machine's to reach, or taken; the system gives no thread.
    pub fn listen(address: SocketAddr) -> Result<Self, EngineError> {
        if !address.ip().is_loopback() {
            return Err(InputError::NotLoopback(address).into());
        }
        let refused = |source: io::Error| InputError::Listen { address, source };
        let listener = TcpListener::bind(address).map_err(refused)?;
        let address = listener.local_addr().map_err(refused)?;
        let shared = Arc::new(Shared::default());
        let accepting = Arc::clone(&shared);
        let named = |name: &str| thread::Builder::new().name(name.to_owned());
        let listener = named("selvedge-listen")
            .spawn(move || accept(&listener, &accepting))
            .map_err(EngineError::Thread)?;
        let telling = Arc::clone(&shared);
        let teller = named("selvedge-tell")
            .spawn(move || send_ticks(&telling))
            .map_err(EngineError::Thread)?;
        Ok(Self {
            address,
            shared,
            teller: Some(teller),
            listener: Some(listener),
        })
    }

    /// Where programs connect.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// The positions of whoever moves the display; an earlier source gets none any more.
    pub fn source(&self) -> InputSource {
        let (sender, input) = feed(SourceKind::Program);
        self.shared.state().feed = Some(sender);
        InputSource::Live(Box::new(input))
    }

    /// A tap for an engine that feels with `n_contactors` contactors; an earlier one is deaf.
    pub fn tap(&self, n_contactors: usize) -> Option<Tap> {
        let (tap, reader) = tap(self.teller.as_ref()?.thread().clone());
        let mut state = self.shared.state();
        state.tap = Some(reader);
        state.header = header(n_contactors);
        state.n_contactors = n_contactors;
        Some(tap)
    }

    /// How it stands.
    pub fn counts(&self) -> ProgramCounts {
        let state = self.shared.state();
        ProgramCounts {
            connected: state.clients.len(),
            has_writer: state.writer.is_some(),
            let_go: state.let_go,
            lost_ticks: state.lost_ticks + state.tap.as_ref().map_or(0, TapReader::n_lost),
        }
    }
}

impl Drop for ProgramLink {
    /// Lets everybody go and ends the threads.
    fn drop(&mut self) {
        let mut state = self.shared.state();
        state.is_over = true;
        let clients = std::mem::take(&mut state.clients);
        drop(state);
        drop(clients);
        if let Some(teller) = self.teller.take() {
            teller.thread().unpark();
            drop(teller.join());
        }
        // The listener sits in `accept` until somebody comes.
        if TcpStream::connect_timeout(&self.address, GOODBYE).is_ok()
            && let Some(listener) = self.listener.take()
        {
            drop(listener.join());
        }
    }
}

/// Takes programs in until the link is over.
fn accept(listener: &TcpListener, shared: &Arc<Shared>) {
    for stream in listener.incoming() {
        let mut state = shared.state();
        if state.is_over {
            return;
        }
        let Ok(stream) = stream else { continue };
        if state.clients.len() >= MAX_CLIENTS {
            continue;
        }
        let id = state.next_id;
        state.next_id += 1;
        if let Ok(client) = Client::start(id, stream, shared) {
            client.send(&Arc::from(state.header.as_str()));
            state.clients.push(client);
        }
    }
}

/// Tells every program every tick until the link is over.
fn send_ticks(shared: &Arc<Shared>) {
    let mut felt = FeltTick::default();
    let mut text = String::new();
    loop {
        let mut state = shared.state();
        if state.is_over {
            return;
        }
        let is_there = state.tap.as_mut().is_some_and(|tap| tap.next(&mut felt));
        if is_there {
            state.send_header(felt.amplitudes_um.len() / 2);
            write_line(&felt, &mut text);
            state.send(&Arc::from(text.as_str()));
            continue;
        }
        state.forget_abandoned();
        drop(state);
        thread::park_timeout(NAP);
    }
}

impl State {
    /// Tells everybody of another array.
    fn send_header(&mut self, n_contactors: usize) {
        if n_contactors != self.n_contactors {
            self.n_contactors = n_contactors;
            self.header = header(n_contactors);
            let line = Arc::from(self.header.as_str());
            self.send(&line);
        }
    }

    /// Tells everybody; whoever has not read the last hundred lines is let go.
    fn send(&mut self, line: &Arc<str>) {
        let before = self.clients.len();
        self.clients.retain(|client| client.send(line));
        self.let_go += (before - self.clients.len()) as u64;
    }

    /// A tap whose engine is gone, with what it lost.
    fn forget_abandoned(&mut self) {
        if let Some(tap) = self.tap.take_if(|tap| tap.is_abandoned()) {
            self.lost_ticks += tap.n_lost();
        }
    }
}

/// What a program is told first.
fn header(n_contactors: usize) -> String {
    let mut header = String::from("tick,t_s,x_mm,y_mm,angle_deg");
    for contactor in 0..n_contactors {
        header.push_str(",a40_um_");
        push_number(&mut header, contactor);
        header.push_str(",a320_um_");
        push_number(&mut header, contactor);
    }
    header.push('\n');
    header
}

fn write_line(felt: &FeltTick, text: &mut String) {
    text.clear();
    push_number(text, felt.tick);
    for number in [felt.t_s()].iter().chain(&felt.place) {
        text.push(',');
        push_number(text, number);
    }
    for amplitude_um in &felt.amplitudes_um {
        text.push(',');
        push_number(text, single(*amplitude_um));
    }
    text.push('\n');
}

/// An amplitude with the digits that it has.
#[expect(clippy::cast_possible_truncation, reason = "it was widened from f32")]
fn single(amplitude_um: f64) -> f32 {
    amplitude_um as f32
}
