//! Compares what the program makes with what is stored in `tests/golden`, group by group.
//!
//! A group is a folder of references that one test makes. What differs, what is missing and what no
//! test makes any more is a failure. For each, old, new and difference are written to
//! `target/golden`, and the message names them. References are made anew by
//! `SELVEDGE_GOLDEN=accept cargo test --test suite golden`.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder as _, Rgb, RgbImage, RgbaImage};

/// Where references are stored.
pub(super) const STORED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden");

/// Channels of stored pictures are multiples of this, of 255: photographs of cloth are noise in
/// their last bits, which would make most of every file.
const STEP: u8 = 8;
/// What a channel may differ by, of 255: half a step for how it is stored, and one for the last bit
/// of a sine or power on another machine, which moves the grey of an edge. Scene, letters and
/// rasteriser are our own and give the same bytes every time on one machine. Nobody sees two
/// hundredths of the way from black to white.
const CHANNEL: u8 = STEP / 2 + 1;
/// Pixels of a picture that may differ by more: where an edge goes through the very middle of a
/// pixel, the last bit decides whether it is in or out. The smallest digit that is printed, changed
/// for another one, changes eight.
const N_PIXELS: usize = 3;

/// A line that begins a part of a text.
pub(super) const PART: &str = "=== ";

/// The references of one group, and what was found to differ.
pub(super) struct Golden {
    group: &'static str,
    made: BTreeSet<String>,
    faults: Vec<String>,
    accepts: bool,
}

impl Golden {
    /// The references in a folder of `tests/golden`.
    pub(super) fn of(group: &'static str) -> Self {
        Self {
            group,
            made: BTreeSet::new(),
            faults: Vec::new(),
            accepts: std::env::var("SELVEDGE_GOLDEN").is_ok_and(|word| word == "accept"),
        }
    }

    /// A picture, whatever its transparency, must look as the one that is stored.
    pub(super) fn picture(&mut self, name: &str, new: &RgbaImage) {
        let file = format!("{name}.png");
        let stored = self.stored(&file);
        self.made.insert(file);
        let new = RgbImage::from_fn(new.width(), new.height(), |x, y| {
            let [r, g, b, _] = new.get_pixel(x, y).0;
            Rgb([r, g, b])
        });
        let old = image::open(&stored)
            .map(image::DynamicImage::into_rgb8)
            .ok();
        let fault = match &old {
            None => Some("there is no reference".to_owned()),
            Some(old) => difference_of(old, &new),
        };
        let Some(fault) = fault else { return };
        if self.accepts {
            write(&stored, &smallest_png(&in_steps(&new)));
            return;
        }
        let shown = self.shown(name);
        write(&shown.with_extension("new.png"), &smallest_png(&new));
        if let Some(old) = old {
            write(&shown.with_extension("old.png"), &smallest_png(&old));
            let marked = smallest_png(&marked(&old, &new));
            write(&shown.with_extension("diff.png"), &marked);
        }
        self.fail(name, &fault, &shown, "png");
    }

    /// A text must be the one that is stored, to the letter.
    pub(super) fn text(&mut self, name: &str, new: &str) {
        self.text_as(name, "txt", new);
    }

    /// The same in a file with another ending, for programs that show such files.
    pub(super) fn text_as(&mut self, name: &str, ending: &str, new: &str) {
        let file = format!("{name}.{ending}");
        let stored = self.stored(&file);
        self.made.insert(file);
        let old = fs::read_to_string(&stored).ok();
        if old.as_deref() == Some(new) {
            return;
        }
        if self.accepts {
            write(&stored, new.as_bytes());
            return;
        }
        let shown = self.shown(name);
        write(
            &shown.with_extension(format!("new.{ending}")),
            new.as_bytes(),
        );
        let fault = match old {
            None => "there is no reference".to_owned(),
            Some(old) => {
                write(
                    &shown.with_extension(format!("old.{ending}")),
                    old.as_bytes(),
                );
                first_lines_that_differ(&old, new)
            }
        };
        self.fail(name, &fault, &shown, ending);
    }

    /// Fails with everything that differed, and with references that nothing was compared with.
    pub(super) fn finish(mut self) {
        let folder = Path::new(STORED).join(self.group);
        let entries = fs::read_dir(&folder).into_iter().flatten();
        for path in entries.map(|entry| entry.unwrap().path()) {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            if self.made.contains(&name) {
                continue;
            }
            if self.accepts {
                fs::remove_file(&path).unwrap();
            } else {
                let words = format!("{}/{name}: no test makes this any more", self.group);
                self.faults.push(words);
            }
        }
        assert!(
            self.faults.is_empty(),
            "{} of {} differ from tests/golden/{}:\n{}\nLook at them; where the new is meant, \
             accept it with SELVEDGE_GOLDEN=accept cargo test --test suite golden",
            self.faults.len(),
            self.made.len(),
            self.group,
            self.faults.join("\n")
        );
    }

    fn stored(&self, file: &str) -> PathBuf {
        Path::new(STORED).join(self.group).join(file)
    }

    /// Where old, new and difference are shown, without an ending.
    fn shown(&self, name: &str) -> PathBuf {
        let target = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("golden");
        // The ending is replaced by what follows.
        target.join(self.group).join(format!("{name}.x"))
    }

    fn fail(&mut self, name: &str, fault: &str, shown: &Path, ending: &str) {
        let shown = shown.with_extension(format!("{{old,new,diff}}.{ending}"));
        let words = format!(
            "{}/{name}: {fault}\n    see {}",
            self.group,
            shown.display()
        );
        self.faults.push(words);
    }
}

/// What a person could see to differ between two pictures.
fn difference_of(old: &RgbImage, new: &RgbImage) -> Option<String> {
    if old.dimensions() != new.dimensions() {
        let ([w, h], [wide, high]) = (old.dimensions().into(), new.dimensions().into());
        return Some(format!("{wide} × {high} px in place of {w} × {h}"));
    }
    let pairs = old.enumerate_pixels().zip(new.pixels());
    let differing = pairs.filter(|((_, _, old), new)| differ(**old, **new));
    let places: Vec<_> = differing.map(|((x, y, _), _)| (x, y)).collect();
    if places.len() <= N_PIXELS {
        return None;
    }
    let range = |values: &mut dyn Iterator<Item = u32>| {
        let (low, high) = values.fold((u32::MAX, 0), |(l, h), v| (l.min(v), h.max(v)));
        format!("{low}…{high}")
    };
    let across = range(&mut places.iter().map(|place| place.0));
    let down = range(&mut places.iter().map(|place| place.1));
    let n = places.len();
    Some(format!(
        "{n} pixels differ, in columns {across} and rows {down}"
    ))
}

/// The same with channels that are multiples of a step, or white.
fn in_steps(picture: &RgbImage) -> RgbImage {
    let mut picture = picture.clone();
    for channel in picture.iter_mut() {
        *channel = match channel.checked_add(STEP / 2) {
            Some(up) => up / STEP * STEP,
            None => u8::MAX,
        };
    }
    picture
}

fn differ(old: Rgb<u8>, new: Rgb<u8>) -> bool {
    let mut channels = old.0.iter().zip(new.0);
    channels.any(|(old, new)| old.abs_diff(new) > CHANNEL)
}

/// The new picture, faint, with what differs in red.
fn marked(old: &RgbImage, new: &RgbImage) -> RgbImage {
    RgbImage::from_fn(new.width(), new.height(), |x, y| {
        let pixel = new.get_pixel(x, y);
        let before = old.get_pixel_checked(x, y);
        if before.is_none_or(|before| differ(*before, *pixel)) {
            return Rgb([255, 0, 0]);
        }
        Rgb(pixel.0.map(|channel| 96 + channel / 4))
    })
}

/// The first line that differs in every part of a text.
fn first_lines_that_differ(old: &str, new: &str) -> String {
    let (olds, news) = (parts_of(old), parts_of(new));
    let mut words = String::new();
    for (head, old) in &olds {
        match news.iter().find(|(other, _)| other == head) {
            None => write!(words, "\n    {head}: gone").unwrap(),
            Some((_, new)) if new != old => {
                let n_same = old
                    .iter()
                    .zip(new)
                    .take_while(|(old, new)| old == new)
                    .count();
                let line = |lines: &[&str]| match lines.get(n_same) {
                    Some(line) => format!("{:?}", shortened(line)),
                    None => "the end".to_owned(),
                };
                let n = n_same + 1;
                let (old, new) = (line(old), line(new));
                write!(words, "\n    {head}, line {n}: {old}\n        is now {new}").unwrap();
            }
            Some(_) => {}
        }
    }
    for (head, _) in &news {
        if olds.iter().all(|(other, _)| other != head) {
            write!(words, "\n    {head}: new").unwrap();
        }
    }
    words
}

/// The lines of every part of a text by its first line.
fn parts_of(text: &str) -> Vec<(&str, Vec<&str>)> {
    let mut parts = vec![("the beginning", Vec::new())];
    for line in text.split('\n') {
        match line.strip_prefix(PART) {
            Some(head) => parts.push((head, Vec::new())),
            None => parts.last_mut().unwrap().1.push(line),
        }
    }
    parts
}

fn shortened(line: &str) -> String {
    line.chars().take(240).collect()
}

/// The smallest file of this picture: plain colours without a filter, or slopes with one.
fn smallest_png(picture: &RgbImage) -> Vec<u8> {
    let encoded = |filter| {
        let mut bytes = Vec::new();
        let encoder = PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, filter);
        let (width, height) = picture.dimensions();
        let kind = ExtendedColorType::Rgb8;
        encoder.write_image(picture, width, height, kind).unwrap();
        bytes
    };
    let filters = [FilterType::NoFilter, FilterType::Adaptive, FilterType::Up];
    filters
        .into_iter()
        .map(encoded)
        .min_by_key(Vec::len)
        .unwrap()
}

fn write(path: &Path, bytes: &[u8]) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, bytes).unwrap();
}

#[test]
fn a_digit_is_seen_to_differ_and_the_last_bit_is_not() {
    let old = RgbImage::from_pixel(20, 20, Rgb([40, 40, 40]));
    let mut new = RgbImage::from_pixel(20, 20, Rgb([43, 40, 37]));
    assert_eq!(difference_of(&old, &new), None);
    assert_eq!(difference_of(&in_steps(&new), &new), None);
    let white = RgbImage::from_pixel(20, 20, Rgb([255, 252, 251]));
    assert_eq!(difference_of(&in_steps(&white), &white), None);
    for row in 3..11 {
        new.put_pixel(5, row, Rgb([60, 60, 60]));
    }
    let words = difference_of(&old, &new).unwrap();
    assert_eq!(words, "8 pixels differ, in columns 5…5 and rows 3…10");
}

#[test]
fn the_first_line_that_differs_is_told_for_every_part() {
    let old = "=== a\n1\n2\n=== b\n3\n=== c\n4";
    let new = "=== a\n1\n5\n=== b\n3\n=== d\n4";
    let words = first_lines_that_differ(old, new);
    assert!(words.contains("a, line 2: \"2\""), "{words}");
    assert!(words.contains("is now \"5\""), "{words}");
    assert!(words.contains("c: gone"), "{words}");
    assert!(words.contains("d: new") && !words.contains("b,"), "{words}");
}
