//! Two ends of a byte link inside this process, with room for 64 kB each way.

use std::collections::VecDeque;
use std::io;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::Port;

const ROOM: usize = 65_536;

#[derive(Debug, Default)]
struct Pipe {
    state: Mutex<PipeState>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct PipeState {
    bytes: VecDeque<u8>,
    closed: bool,
}

impl Pipe {
    fn lock(&self) -> MutexGuard<'_, PipeState> {
        // A panic elsewhere leaves the queue as it was: bytes have no invariants to break.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits until `ready` or the end of `patience`.
    fn wait(
        &self,
        patience: Duration,
        ready: impl Fn(&PipeState) -> bool,
    ) -> MutexGuard<'_, PipeState> {
        let deadline = Instant::now() + patience;
        let mut state = self.lock();
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            if ready(&state) || state.closed || left.is_zero() {
                return state;
            }
            let waited = self.changed.wait_timeout(state, left);
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    fn close(&self) {
        self.lock().closed = true;
        self.changed.notify_all();
    }
}

/// Closes both directions when the last copy of an end is gone.
#[derive(Debug)]
struct End {
    incoming: Arc<Pipe>,
    outgoing: Arc<Pipe>,
}

impl Drop for End {
    fn drop(&mut self) {
        self.incoming.close();
        self.outgoing.close();
    }
}

/// One end; copies share it, so that one thread can read while another writes.
#[derive(Clone, Debug)]
pub struct PairPort {
    end: Arc<End>,
    name: &'static str,
}

impl PairPort {
    /// Two connected ends.
    pub fn pair(name: &'static str) -> (Self, Self) {
        let (there, back) = (Arc::new(Pipe::default()), Arc::new(Pipe::default()));
        let host = End {
            incoming: Arc::clone(&back),
            outgoing: Arc::clone(&there),
        };
        let device = End {
            incoming: there,
            outgoing: back,
        };
        (
            Self {
                end: Arc::new(host),
                name,
            },
            Self {
                end: Arc::new(device),
                name,
            },
        )
    }
}

impl Port for PairPort {
    fn name(&self) -> &str {
        self.name
    }

    fn read(&mut self, buffer: &mut [u8], patience: Duration) -> io::Result<usize> {
        let mut state = self
            .end
            .incoming
            .wait(patience, |state| !state.bytes.is_empty());
        if state.bytes.is_empty() && state.closed {
            return Err(io::ErrorKind::BrokenPipe.into());
        }
        let count = state.bytes.len().min(buffer.len());
        for (slot, byte) in buffer.iter_mut().zip(state.bytes.drain(..count)) {
            *slot = byte;
        }
        self.end.incoming.changed.notify_all();
        Ok(count)
    }

    fn write(&mut self, packet: &[u8], patience: Duration) -> io::Result<()> {
        let fits = |state: &PipeState| state.bytes.len() + packet.len() <= ROOM;
        let mut state = self.end.outgoing.wait(patience, fits);
        if state.closed {
            return Err(io::ErrorKind::BrokenPipe.into());
        }
        if !fits(&state) {
            return Err(io::ErrorKind::TimedOut.into());
        }
        state.bytes.extend(packet);
        self.end.outgoing.changed.notify_all();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_cross_in_order_both_ways() {
        let (mut host, mut device) = PairPort::pair("test");
        host.write(&[1, 2, 3], Duration::ZERO).unwrap();
        device.write(&[9], Duration::ZERO).unwrap();
        let mut buffer = [0; 2];
        assert_eq!(device.read(&mut buffer, Duration::ZERO).unwrap(), 2);
        assert_eq!(buffer, [1, 2]);
        assert_eq!(device.read(&mut buffer, Duration::ZERO).unwrap(), 1);
        assert_eq!(device.read(&mut buffer, Duration::ZERO).unwrap(), 0);
        assert_eq!(host.read(&mut buffer, Duration::ZERO).unwrap(), 1);
    }

    #[test]
    fn a_full_link_times_out_and_keeps_its_bound() {
        let (mut host, device) = PairPort::pair("test");
        let mut taken = 0;
        let error = loop {
            match host.write(&[7; 1000], Duration::ZERO) {
                Ok(()) => taken += 1000,
                Err(error) => break error,
            }
        };
        assert_eq!(error.kind(), io::ErrorKind::TimedOut);
        assert!(taken <= ROOM);
        drop(device);
        let error = host.write(&[7], Duration::ZERO).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::BrokenPipe);
    }

    #[test]
    fn what_was_written_before_the_end_is_still_read() {
        let (mut host, device) = PairPort::pair("test");
        let mut copy = device.clone();
        drop(device);
        copy.write(&[5], Duration::ZERO).unwrap();
        drop(copy);
        let mut buffer = [0; 4];
        assert_eq!(host.read(&mut buffer, Duration::ZERO).unwrap(), 1);
        assert!(host.read(&mut buffer, Duration::ZERO).is_err());
    }
}
