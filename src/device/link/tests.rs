//! The writer's order of precedence, without threads.

use std::io;

use super::shared::{CONTROLS, PASSING};
use super::*;
use crate::message::{Arm, Ping, frame};

/// A port that notes what is written, or fails as told.
#[derive(Default)]
struct Notes {
    written: Vec<Vec<u8>>,
    fail: Option<io::ErrorKind>,
}

impl Port for Notes {
    fn name(&self) -> &'static str {
        "notes"
    }

    fn read(&mut self, _buffer: &mut [u8], _patience: Duration) -> io::Result<usize> {
        Ok(0)
    }

    fn write(&mut self, packet: &[u8], _patience: Duration) -> io::Result<()> {
        if let Some(kind) = self.fail {
            return Err(kind.into());
        }
        self.written.push(packet.to_vec());
        Ok(())
    }
}

struct Desk {
    link: Link,
    writer: Writer,
    port: Notes,
}

fn desk() -> Desk {
    let shared = Arc::new(Shared::new(Sequence::default(), Arc::new(|| {})));
    let (_, incoming) = RingBuffer::new(INCOMING);
    let (failed, failures) = RingBuffer::new(FRAMES);
    let (controls, controls_out) = RingBuffer::new(CONTROLS);
    let (frames, frames_out) = RingBuffer::new(FRAMES);
    let outgoing = Outgoing::new(controls_out, frames_out);
    let [(sent, sent_end), (_, received_end)] = [tap(PASSING), tap(PASSING)];
    let writer = Writer::new(Arc::clone(&shared), outgoing, failed, sent);
    Desk {
        link: Link {
            shared,
            incoming,
            failures,
            controls,
            frames,
            taps: Some([sent_end, received_end]),
            stepped: None,
        },
        writer,
        port: Notes::default(),
    }
}

fn queued(tick: u32) -> QueuedFrame {
    let packet = frame::packet(1, tick, &[[1, 2]; 24]).unwrap();
    let now = Instant::now();
    QueuedFrame {
        packet,
        due: Some(now),
        stamp: Some(now),
    }
}

impl Desk {
    fn write_all(&mut self) {
        while self.writer.step(&mut self.port, None).is_some() {}
    }
}

#[test]
fn only_the_newest_frame_is_written() {
    let mut desk = desk();
    for tick in 0..6 {
        desk.link.send_frame(&queued(tick));
    }
    desk.write_all();
    assert_eq!(desk.port.written, [queued(3).packet.as_bytes()]);
    let counters = desk.link.counters();
    assert_eq!((counters.frames_sent, counters.frames_superseded), (1, 5));
    assert_eq!(desk.link.timings().stamp_to_write.n, 1);
}

#[test]
fn control_packets_precede_frames() {
    let mut desk = desk();
    let ping = Ping { token: 1 }.packet(0).unwrap();
    desk.link.send_frame(&queued(1));
    desk.link.send_control(&ping);
    desk.write_all();
    assert_eq!(
        desk.port.written,
        [ping.as_bytes(), queued(1).packet.as_bytes()]
    );
}

#[test]
fn a_stop_overtakes_and_discards_everything_queued() {
    let mut desk = desk();
    let stop = Stop {
        reason: 0,
        how: StopHow::Now,
    }
    .packet(9)
    .unwrap();
    desk.link.send_control(&Arm::new(5).packet(0).unwrap());
    desk.link.send_frame(&queued(1));
    desk.link.send_frame(&queued(2));
    desk.link.send_stop(&stop);
    desk.write_all();
    assert_eq!(desk.port.written, [stop.as_bytes()]);
    assert_eq!(desk.link.counters().frames_superseded, 2);
}

#[test]
fn a_stop_handle_tells_the_owner_and_sees_the_writing() {
    let mut desk = desk();
    let handle = desk.link.stop_handle();
    assert!(handle.wait_written(Duration::ZERO), "nothing asked yet");
    handle.stop(StopHow::Now);
    handle.stop(StopHow::Ramp);
    assert!(!handle.wait_written(Duration::ZERO));
    assert_eq!(
        desk.link.take_stop_by_handle(),
        Some(StopHow::Now),
        "the harder one holds"
    );
    assert_eq!(desk.link.take_stop_by_handle(), None);
    desk.write_all();
    assert!(handle.wait_written(Duration::ZERO));
    assert_eq!(desk.port.written.len(), 1);
}

#[test]
fn a_second_time_out_in_a_row_is_the_end_and_a_stop_is_tried_twice() {
    let mut desk = desk();
    desk.port.fail = Some(io::ErrorKind::TimedOut);
    desk.link.send_frame(&queued(1));
    assert!(desk.writer.step(&mut desk.port, None).is_some());
    assert!(desk.link.next().is_none(), "one time-out is forgiven");
    desk.port.fail = None;
    desk.link.send_frame(&queued(2));
    desk.write_all();
    desk.port.fail = Some(io::ErrorKind::TimedOut);
    desk.link.send_stop(
        &Stop {
            reason: 0,
            how: StopHow::Now,
        }
        .packet(9)
        .unwrap(),
    );
    desk.writer.step(&mut desk.port, None);
    assert!(desk.link.next().is_none());
    desk.writer.step(&mut desk.port, None);
    let Some(Incoming::Gone(reason)) = desk.link.next() else {
        panic!("gone")
    };
    assert!(reason.contains("stopped taking data"), "{reason}");
    assert_eq!(desk.link.counters().write_timeouts, 3);
}

#[test]
fn a_vanished_port_is_the_end_at_once() {
    let mut desk = desk();
    desk.port.fail = Some(io::ErrorKind::BrokenPipe);
    desk.link.send_frame(&queued(1));
    desk.writer.step(&mut desk.port, None);
    assert!(matches!(desk.link.next(), Some(Incoming::Gone(_))));
}

#[test]
fn rings_that_are_full_drop_and_count() {
    let mut desk = desk();
    for tick in 0..100 {
        desk.link
            .send_control(&Ping { token: tick }.packet(0).unwrap());
    }
    desk.write_all();
    assert_eq!(desk.port.written.len(), CONTROLS);
}
