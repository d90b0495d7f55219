//! Positions as lines of text from any stream, read on a thread of its own.
//!
//! A line is `x_mm,y_mm`, stamped when it arrives, or `t_s,x_mm,y_mm` or `t_s,x_mm,y_mm,angle_deg`
//! by the stream's own clock, whose first time is taken to be its arrival; the word `lift` says
//! that the finger left the surface. A header and lines that begin with `#` are passed over;
//! anything else is counted as bad. When the ring is full the reader waits, so that a pipe pushes
//! back on whoever writes it; a file of lines with times is thereby played at its own speed.

use std::io::{self, BufRead, Read as _};
use std::thread;
use std::time::{Duration, Instant};

use super::feed::{FeedInput, FeedItem, FeedSender, feed};
use super::pointer::SourceKind;
use crate::{EngineError, PointerSample};
use selvedge_foundation::geometry::Point;

/// A longer line is bad, whatever it holds, in bytes.
const LONGEST_LINE: u64 = 256;
/// How far a stream may run ahead of its own times.
const LEAD: Duration = Duration::from_millis(100);
/// A time farther ahead than this is not waited for: the stream's clock has jumped.
const LONGEST_LEAD: Duration = Duration::from_secs(1);
const NAP: Duration = Duration::from_millis(5);
const HEADERS: [&str; 3] = ["x_mm,y_mm", "t_s,x_mm,y_mm", "t_s,x_mm,y_mm,angle_deg"];

/// Starts to read a stream. The thread ends with it, or at the next line after the input is
/// dropped.
pub(crate) fn start_lines(lines: Box<dyn BufRead + Send>) -> Result<FeedInput, EngineError> {
    let (mut sender, input) = feed(SourceKind::Lines);
    let mut lines = Lines::new(lines);
    thread::Builder::new()
        .name("selvedge-lines".to_owned())
        .spawn(move || {
            while let Some(said) = lines.next() {
                match said {
                    Said::Aside => {}
                    Said::Bad => sender.count_bad_line(),
                    Said::Item(item) => push_patiently(&mut sender, item),
                }
                if sender.is_abandoned() {
                    break;
                }
            }
            sender.end();
        })
        .map_err(EngineError::Thread)?;
    Ok(input)
}

fn push_patiently(sender: &mut FeedSender, mut item: FeedItem) {
    while let Err(rejected) = sender.offer(item) {
        if sender.is_abandoned() {
            return;
        }
        item = rejected;
        thread::sleep(NAP);
    }
}

/// What a line says.
#[derive(Debug, PartialEq)]
pub(crate) enum Said {
    Item(FeedItem),
    Aside,
    Bad,
}

/// A stream of lines with its clock.
pub(crate) struct Lines<R> {
    stream: R,
    text: Vec<u8>,
    /// The stream's first time, s, and when it arrived.
    origin: Option<(f64, Instant)>,
}

/// What a line holds.
#[derive(Debug, PartialEq)]
enum Line {
    Sample {
        t_s: Option<f64>,
        position: Point,
        angle_deg: Option<f64>,
    },
    Lift,
    Aside,
    Bad,
}

impl<R: BufRead> Lines<R> {
    pub(crate) fn new(lines: R) -> Self {
        Self {
            stream: lines,
            text: Vec::new(),
            origin: None,
        }
    }

    /// What the next line says, with its time on the engine's clock, waited for if that is a
    /// little ahead; `None` at the end.
    pub(crate) fn next(&mut self) -> Option<Said> {
        if !self.read_line().unwrap_or(false) {
            return None;
        }
        Some(match parse(&self.text) {
            Line::Aside => Said::Aside,
            Line::Bad => Said::Bad,
            Line::Lift => Said::Item(FeedItem::Lift),
            Line::Sample {
                t_s,
                position,
                angle_deg,
            } => {
                let stamp = t_s.map_or_else(Instant::now, |t_s| self.stamp_of(t_s));
                Said::Item(FeedItem::Sample(
                    PointerSample { stamp, position },
                    angle_deg,
                ))
            }
        })
    }

    /// Reads one line, or the first bytes of one that is too long; false at the end.
    fn read_line(&mut self) -> io::Result<bool> {
        self.text.clear();
        let n_read = (&mut self.stream)
            .take(LONGEST_LINE)
            .read_until(b'\n', &mut self.text)?;
        if n_read as u64 == LONGEST_LINE && !self.text.ends_with(b"\n") {
            self.skip_line()?;
        }
        Ok(n_read > 0)
    }

    fn skip_line(&mut self) -> io::Result<()> {
        loop {
            let buffer = self.stream.fill_buf()?;
            let end = buffer.iter().position(|&byte| byte == b'\n');
            let n_skipped = end.map_or(buffer.len(), |end| end + 1);
            self.stream.consume(n_skipped);
            if end.is_some() || n_skipped == 0 {
                return Ok(());
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
    if text.is_empty() || text.starts_with('#') || HEADERS.contains(&text) {
        return Line::Aside;
    }
    if text == "lift" {
        return Line::Lift;
    }
    let mut numbers = [0.0; 4];
    let mut n_numbers = 0;
    for cell in text.split(',') {
        let (Some(slot), Ok(number)) = (numbers.get_mut(n_numbers), cell.trim().parse()) else {
            return Line::Bad;
        };
        *slot = number;
        n_numbers += 1;
    }
    let [a, b, c, d] = numbers;
    let (t_s, position, angle_deg) = match n_numbers {
        2 => (None, Point::new(a, b), None),
        3 if a.is_finite() => (Some(a), Point::new(b, c), None),
        4 if a.is_finite() => (Some(a), Point::new(b, c), Some(d)),
        _ => return Line::Bad,
    };
    Line::Sample {
        t_s,
        position,
        angle_deg,
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::super::{PointerInput as _, Reading};
    use super::*;

    /// Every sample of a text, and its bad lines.
    fn read(text: impl Into<Vec<u8>>) -> (Vec<PointerSample>, u64) {
        let mut input = start_lines(Box::new(Cursor::new(text.into()))).unwrap();
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
    fn a_fourth_number_is_the_angle_and_a_word_the_lift() {
        let text = "t_s,x_mm,y_mm,angle_deg\n0,1,2,30\nlift\n";
        let mut lines = Lines::new(Cursor::new(text));
        assert_eq!(lines.next(), Some(Said::Aside));
        let sample = lines.next();
        let Some(Said::Item(FeedItem::Sample(sample, angle_deg))) = sample else {
            panic!("{sample:?}");
        };
        assert_eq!(
            (sample.position, angle_deg),
            (Point::new(1.0, 2.0), Some(30.0))
        );
        assert_eq!(lines.next(), Some(Said::Item(FeedItem::Lift)));
        assert_eq!(lines.next(), None);
    }

    #[test]
    fn bad_lines_are_counted_and_the_stream_goes_on() {
        let mut text = b"one,two\n1\n1,2,3,4,5\nnan,1,2\n1,2;\n\xff\xfe\n".to_vec();
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
