//! One program that is connected: a thread that tells it, and one that hears it.

use std::io::{self, BufReader, Write as _};
use std::net::{Shutdown, TcpStream};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;
use std::time::Duration;

use super::super::input::{FeedItem, Lines, Said};
use super::Shared;

/// Lines on their way to a program: two and a half seconds.
const MAX_LINES: usize = 100;
/// How long one line may take; a program that stands still longer is let go.
const PATIENCE: Duration = Duration::from_secs(2);
/// What a second program that says positions is told.
const TAKEN: &str = "# another program moves the display; this one only listens\n";

/// A program that is connected. Dropping it ends the connection.
#[derive(Debug)]
pub(super) struct Client {
    id: u64,
    stream: TcpStream,
    lines: SyncSender<Arc<str>>,
}

impl Client {
    /// Starts to tell and to hear a program.
    pub(super) fn start(id: u64, stream: TcpStream, shared: &Arc<Shared>) -> io::Result<Self> {
        stream.set_nodelay(true)?;
        stream.set_write_timeout(Some(PATIENCE))?;
        let (lines, queue) = sync_channel(MAX_LINES);
        let named = |what: &str| thread::Builder::new().name(format!("selvedge-{what}-{id}"));
        let writing = stream.try_clone()?;
        named("to").spawn(move || write(writing, &queue))?;
        let (reading, shared) = (stream.try_clone()?, Arc::clone(shared));
        named("from").spawn(move || hear(id, &reading, &shared))?;
        Ok(Self { id, stream, lines })
    }

    /// Hands a line over; false if the program is too slow or gone.
    pub(super) fn send(&self, line: &Arc<str>) -> bool {
        self.lines.try_send(Arc::clone(line)).is_ok()
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        // It may be gone already.
        drop(self.stream.shutdown(Shutdown::Both));
    }
}

fn write(mut stream: TcpStream, queue: &Receiver<Arc<str>>) {
    while let Ok(line) = queue.recv() {
        if stream.write_all(line.as_bytes()).is_err() {
            // What hears it then ends, and takes it from the list.
            drop(stream.shutdown(Shutdown::Both));
            return;
        }
    }
}

/// Hears a program until it goes.
fn hear(id: u64, stream: &TcpStream, shared: &Arc<Shared>) {
    let mut lines = Lines::new(BufReader::new(stream));
    let mut was_told = false;
    while let Some(said) = lines.next() {
        let mut state = shared.state();
        match said {
            Said::Aside => {}
            Said::Bad => {
                if let Some(feed) = &state.feed {
                    feed.count_bad_line();
                }
            }
            Said::Item(_) if state.writer.is_some_and(|writer| writer != id) => {
                if !std::mem::replace(&mut was_told, true) {
                    let me = state.clients.iter().find(|client| client.id == id);
                    me.map(|client| client.send(&Arc::from(TAKEN)));
                }
            }
            Said::Item(item) => {
                state.writer = Some(id);
                if let Some(feed) = &mut state.feed {
                    feed.push(item);
                }
            }
        }
    }
    let mut state = shared.state();
    state.clients.retain(|client| client.id != id);
    if state.writer == Some(id) {
        state.writer = None;
        // A program that goes lets go of the finger.
        if let Some(feed) = &mut state.feed {
            feed.push(FeedItem::Lift);
        }
    }
}
