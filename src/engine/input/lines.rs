//! Positions as lines of text from any stream, read on a thread of its own.
//!
//! A line is `x_mm,y_mm`, stamped when it arrives, or `t_s,x_mm,y_mm` by the stream's own clock,
//! whose first time is taken to be its arrival. A header and lines that begin with `#` are passed
//! over; anything else is counted as bad. When the ring is full the reader waits, so that a pipe
//! pushes back on whoever writes it; a file of lines with times is thereby played at its own speed.

use std::io::{self, BufRead, Read as _};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use rtrb::{Consumer, Producer, RingBuffer};

use super::{InputLosses, PointerInput, Reading};
use crate::engine::{EngineError, PointerSample, SourceKind};
use crate::geometry::Point;

const CAPACITY: usize = 1024;
/// A longer line is bad, whatever it holds, in bytes.
const LONGEST_LINE: u64 = 256;
/// How far a stream may run ahead of its own times.
const LEAD: Duration = Duration::from_millis(100);
/// A time farther ahead than this is not waited for: the stream's clock has jumped.
const LONGEST_LEAD: Duration = Duration::from_secs(1);
const NAP: Duration = Duration::from_millis(5);

/// Samples from a stream of lines.
#[derive(Debug)]
pub(in crate::engine) struct LineInput {
    ring: Consumer<PointerSample>,
    shared: Arc<Shared>,
}

#[derive(Debug, Default)]
struct Shared {
    bad_lines: AtomicU64,
    has_ended: AtomicBool,
}

impl LineInput {
    /// Starts to read. The thread ends with the stream, or at the next line after this is dropped.
    pub(in crate::engine) fn start(lines: Box<dyn BufRead + Send>) -> Result<Self, EngineError> {
        let (sender, ring) = RingBuffer::new(CAPACITY);
        let shared = Arc::new(Shared::default());
        let reader = Reader {
            lines,
            sender,
            shared: Arc::clone(&shared),
            origin: None,
        };
        thread::Builder::new()
            .name("selvedge-lines".to_owned())
            .spawn(move || reader.run())
            .map_err(EngineError::Thread)?;
        Ok(Self { ring, shared })
    }
}

impl PointerInput for LineInput {
    fn kind(&self) -> SourceKind {
        SourceKind::Lines
    }

    fn poll(&mut self, _now: Instant, take: &mut dyn FnMut(PointerSample)) -> Reading {
        // Read before the ring is emptied: what the reader pushed before it ended is then in it.
        let has_ended = self.shared.has_ended.load(Ordering::Acquire);
        for n_taken in 0..CAPACITY {
            let Ok(sample) = self.ring.pop() else {
                return if has_ended && n_taken == 0 {
                    Reading::Ended
                } else {
                    Reading::Samples
                };
            };
            take(sample);
        }
        Reading::Samples
    }

    fn losses(&self) -> InputLosses {
        let bad_lines = self.shared.bad_lines.load(Ordering::Relaxed);
        InputLosses {
            bad_lines,
            ..InputLosses::default()
        }
    }
}

struct Reader {
    lines: Box<dyn BufRead + Send>,
    sender: Producer<PointerSample>,
    shared: Arc<Shared>,
    /// The stream's first time, s, and when it arrived.
    origin: Option<(f64, Instant)>,
}

/// What a line holds.
#[derive(Debug, PartialEq)]
enum Line {
    Sample { t_s: Option<f64>, position: Point },
    Aside,
    Bad,
}

impl Reader {
    fn run(mut self) {
        let mut text = Vec::new();
        while !self.sender.is_abandoned() {
            match self.read_line(&mut text) {
                Ok(true) => self.take(&text),
                Ok(false) | Err(_) => break,
            }
        }
        self.shared.has_ended.store(true, Ordering::Release);
    }

    /// Reads one line, or the first bytes of one that is too long; false at the end.
    fn read_line(&mut self, text: &mut Vec<u8>) -> io::Result<bool> {
        text.clear();
        let n_read = (&mut self.lines)
            .take(LONGEST_LINE)
            .read_until(b'\n', text)?;
        if n_read as u64 == LONGEST_LINE && !text.ends_with(b"\n") {
            self.skip_line()?;
        }
        Ok(n_read > 0)
    }

    fn skip_line(&mut self) -> io::Result<()> {
        loop {
            let buffer = self.lines.fill_buf()?;
            let end = buffer.iter().position(|&byte| byte == b'\n');
            let n_skipped = end.map_or(buffer.len(), |end| end + 1);
            self.lines.consume(n_skipped);
            if end.is_some() || n_skipped == 0 {
                return Ok(());
            }
        }
    }

    fn take(&mut self, text: &[u8]) {
        match parse(text) {
            Line::Aside => {}
            Line::Bad => {
                self.shared.bad_lines.fetch_add(1, Ordering::Relaxed);
            }
            Line::Sample { t_s, position } => {
                let stamp = t_s.map_or_else(Instant::now, |t_s| self.stamp_of(t_s));
                self.push(PointerSample { stamp, position });
            }
        }
    }

    /// The stream's time on the engine's clock, waited for if it is a little ahead.
    fn stamp_of(&mut self, t_s: f64) -> Instant {
        let now = Instant::now();
        let (first_s, arrival) = *self.origin.get_or_insert((t_s, now));
        let since_s = t_s - first_s;
        let since = Duration::try_from_secs_f64(since_s.abs()).unwrap_or_default();
        let moved = if since_s < 0.0 {
            arrival.checked_sub(since)
        } else {
            arrival.checked_add(since)
        };
        let stamp = moved.unwrap_or(now);
        let ahead = stamp.saturating_duration_since(now);
        if ahead > LEAD && ahead <= LONGEST_LEAD {
            thread::sleep(ahead.saturating_sub(LEAD));
        }
        stamp
    }

    fn push(&mut self, mut sample: PointerSample) {
        while let Err(rtrb::PushError::Full(rejected)) = self.sender.push(sample) {
            if self.sender.is_abandoned() {
                return;
            }
            sample = rejected;
            thread::sleep(NAP);
        }
    }
}

/// Numbers that are not finite are samples here: the engine drops and counts them as such.
fn parse(text: &[u8]) -> Line {
    let is_too_long = text.len() as u64 >= LONGEST_LINE && !text.ends_with(b"\n");
    let Ok(text) = std::str::from_utf8(text) else {
        return Line::Bad;
    };
    let text = text.trim_start_matches('\u{feff}').trim();
    if is_too_long {
        return Line::Bad;
    }
    if text.is_empty() || text.starts_with('#') || matches!(text, "x_mm,y_mm" | "t_s,x_mm,y_mm") {
        return Line::Aside;
    }
    let mut numbers = [0.0; 3];
    let mut n_numbers = 0;
    for cell in text.split(',') {
        let (Some(slot), Ok(number)) = (numbers.get_mut(n_numbers), cell.trim().parse()) else {
            return Line::Bad;
        };
        *slot = number;
        n_numbers += 1;
    }
    let [a, b, c] = numbers;
    match n_numbers {
        2 => Line::Sample {
            t_s: None,
            position: Point::new(a, b),
        },
        3 if a.is_finite() => Line::Sample {
            t_s: Some(a),
            position: Point::new(b, c),
        },
        _ => Line::Bad,
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    /// Every sample of a text, and its bad lines.
    fn read(text: impl Into<Vec<u8>>) -> (Vec<PointerSample>, u64) {
        let mut input = LineInput::start(Box::new(Cursor::new(text.into()))).unwrap();
        let mut samples = Vec::new();
        while input.poll(Instant::now(), &mut |s| samples.push(s)) != Reading::Ended {
            thread::sleep(Duration::from_millis(1));
        }
        (samples, input.losses().bad_lines)
    }

    #[test]
    fn lines_with_times_keep_their_distances() {
        let (samples, n_bad) = read("t_s,x_mm,y_mm\n7,1,2\n7.008, 3 ,4\n# aside\n\n6.5,5,6\n");
        assert_eq!((samples.len(), n_bad), (3, 0));
        assert_eq!(
            samples[1].stamp - samples[0].stamp,
            Duration::from_millis(8)
        );
        assert!(
            samples[2].stamp < samples[0].stamp,
            "a time that goes back is judged later"
        );
        assert_eq!(samples[1].position, Point::new(3.0, 4.0));
    }

    #[test]
    fn lines_without_times_are_stamped_as_they_arrive() {
        let (samples, n_bad) = read("1,2\nNaN,3\r\n4,5");
        assert_eq!((samples.len(), n_bad), (3, 0));
        assert!(samples[0].stamp <= samples[2].stamp);
        assert!(
            samples[1].position.x_mm.is_nan(),
            "dropped later, where it is counted"
        );
    }

    #[test]
    fn bad_lines_are_counted_and_the_stream_goes_on() {
        let mut text = b"one,two\n1\n1,2,3,4\nnan,1,2\n1,2;\n\xff\xfe\n".to_vec();
        text.extend(std::iter::repeat_n(b'9', 100_000));
        text.extend(b"\n8,9\n");
        let (samples, n_bad) = read(text);
        assert_eq!((samples.len(), n_bad), (1, 7));
        assert_eq!(samples[0].position, Point::new(8.0, 9.0));
    }

    #[test]
    fn more_lines_than_the_ring_holds_wait_for_room() {
        let lines: Vec<String> = (0..3000).map(|n| format!("{n},0\n")).collect();
        let (samples, _) = read(lines.concat());
        assert_eq!(samples.len(), 3000);
        assert!(
            samples
                .iter()
                .enumerate()
                .all(|(n, s)| s.position.x_mm == n as f64)
        );
    }

    proptest::proptest! {
        #[test]
        fn no_line_makes_the_parser_fail(text in proptest::collection::vec(0_u8.., 0..80)) {
            parse(&text);
        }
    }
}
