//! Where hands go: the file `FINGERS.csv`, and where they are at a time.

use std::path::Path;

use super::{DrapeError, DrapeScene};
use selvedge_foundation::files::{self, FileError, Table, TableWriter};

/// Columns of a finger; those of the second end with `_1`.
const COLUMNS: [&str; 4] = ["x_mm", "y_mm", "z_mm", "opening_mm"];

/// What a column of the so manieth finger is called.
fn column(name: &str, nth: usize) -> String {
    match nth {
        0 => name.to_owned(),
        nth => format!("{name}_{nth}"),
    }
}

/// What the hand does with a finger: the centre of a grasp, and how far it is open, mm.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Hand {
    /// The centre, mm: x right, y up, z out of the plane of the cloth at rest.
    pub centre_mm: [f64; 3],
    /// Between the pads, mm; below 0 they press.
    pub opening_mm: f64,
}

impl Hand {
    /// So far on the way to another.
    #[must_use]
    pub fn towards(self, to: Self, share: f64) -> Self {
        let mix = |a: f64, b: f64| a + (b - a) * share;
        Self {
            centre_mm: [0, 1, 2].map(|axis| mix(self.centre_mm[axis], to.centre_mm[axis])),
            opening_mm: mix(self.opening_mm, to.opening_mm),
        }
    }
}

/// Where hands go over time.
#[derive(Debug, Clone)]
pub struct HandPath {
    times_s: Vec<f64>,
    /// Of each finger.
    hands: Vec<Vec<Hand>>,
}

impl HandPath {
    /// Reads `t_s` and per finger of the scene `x_mm,y_mm,z_mm,opening_mm`; those of the second are
    /// called `x_mm_1` and so on, and may be left out where it is mirrored.
    ///
    /// # Errors
    /// One line: what is wrong, where, and how to mend it.
    pub fn read(path: &Path, scene: &DrapeScene) -> Result<Self, DrapeError> {
        let text = files::read_text(path)?;
        let second = COLUMNS.map(|name| column(name, 1));
        let own = |nth: usize, of: usize| column(COLUMNS[of], nth);
        let mut required = vec!["t_s"];
        let mut optional = Vec::new();
        for (nth, finger) in scene.fingers().iter().enumerate() {
            let names = if nth == 0 {
                COLUMNS
            } else {
                second.each_ref().map(String::as_str)
            };
            if finger.is_mirrored {
                optional.extend(names);
            } else {
                required.extend(names);
            }
        }
        let table = Table::read(&text, path, &required, &optional)?;
        let times_s = table.required_numbers("t_s")?;
        if let Some(row) = (1..times_s.len()).find(|row| times_s[*row] <= times_s[row - 1]) {
            let what = format!("t_s is {} after {}", times_s[row], times_s[row - 1]);
            let mend = "let times rise from row to row";
            return Err(FileError::content(path, table.line_of(row), what, mend).into());
        }
        if times_s.len() < 2 {
            let mend = "give two rows or more";
            return Err(FileError::content(path, 1, "this path has no length", mend).into());
        }
        let mut hands: Vec<Vec<Hand>> = Vec::new();
        for (nth, finger) in scene.fingers().iter().enumerate() {
            if finger.is_mirrored && table.numbers(&own(nth, 0))?.is_none() {
                let first = hands.first().cloned().unwrap_or_default();
                hands.push(first);
                continue;
            }
            let columns = [0, 1, 2, 3].map(|of| table.required_numbers(&own(nth, of)));
            let [x, y, z, opening] = columns;
            let (x, y, z, opening) = (x?, y?, z?, opening?);
            let hand = |row: usize| Hand {
                centre_mm: [x[row], y[row], z[row]],
                opening_mm: opening[row],
            };
            hands.push((0..times_s.len()).map(hand).collect());
        }
        Ok(Self { times_s, hands })
    }

    /// One that begins with hands at a time; it has a length once it is led on.
    pub fn starting(t_s: f64, hands: &[Hand]) -> Self {
        Self {
            times_s: vec![t_s],
            hands: hands.iter().map(|hand| vec![*hand]).collect(),
        }
    }

    /// Leads it on to hands at a later time; at no later one it stays as it is.
    pub fn push(&mut self, t_s: f64, hands: &[Hand]) {
        if self.times_s.last().is_some_and(|last| t_s > *last) {
            self.times_s.push(t_s);
            for (rows, hand) in self.hands.iter_mut().zip(hands) {
                rows.push(*hand);
            }
        }
    }

    /// The file that [`Self::read`] reads.
    ///
    /// # Errors
    /// None that a text in memory could have.
    pub fn to_csv(&self) -> Result<Vec<u8>, DrapeError> {
        let names = (0..self.hands.len()).flat_map(|nth| COLUMNS.map(|of| column(of, nth)));
        let header: Vec<String> = std::iter::once("t_s".to_owned()).chain(names).collect();
        let header: Vec<&str> = header.iter().map(String::as_str).collect();
        let mut table = TableWriter::new(Vec::new(), Path::new("FINGERS.csv"), &header)?;
        for (row, t_s) in self.times_s.iter().enumerate() {
            table.number(t_s);
            for hand in self.hands.iter().map(|rows| rows[row]) {
                let numbers = hand.centre_mm.into_iter().chain([hand.opening_mm]);
                numbers.for_each(|mm| {
                    table.number(mm);
                });
            }
            table.end_row()?;
        }
        Ok(table.finish()?)
    }

    /// Its first and last time, s.
    pub fn span_s(&self) -> [f64; 2] {
        [0, self.times_s.len() - 1].map(|row| self.times_s[row])
    }

    /// What each finger's hand does at a time, into `hands`; the ends hold beyond.
    pub fn at(&self, t_s: f64, hands: &mut [Hand]) {
        let after = self.times_s.partition_point(|time| *time <= t_s);
        let last = self.times_s.len() - 1;
        let (a, b) = (after.saturating_sub(1), after.min(last));
        let length_s = self.times_s[b] - self.times_s[a];
        let share = if length_s > 0.0 {
            ((t_s - self.times_s[a]) / length_s).clamp(0.0, 1.0)
        } else {
            0.0
        };
        for (hand, rows) in hands.iter_mut().zip(&self.hands) {
            *hand = rows[a].towards(rows[b], share);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_scratch::ScratchFolder;

    #[test]
    fn hands_are_where_the_rows_say_and_between() {
        let folder = ScratchFolder::made("hands");
        let (scene, path) = (folder.join("a.drape.toml"), folder.join("fingers.csv"));
        let text = "name = \"a\"\ntextile = \"denim\"\n\
            [[finger]]\nstart_mm = [0, 0, 0]\nopening_mm = 60\n\
            [[finger]]\nmapping = \"mirrored\"\nstart_mm = [0, 0, 0]\nopening_mm = 60\n";
        std::fs::write(&scene, text).unwrap();
        let scene = DrapeScene::read(&scene).unwrap();
        let rows = "t_s,x_mm,y_mm,z_mm,opening_mm\n0,10,20,0,40\n2,30,20,4,0\n";
        std::fs::write(&path, rows).unwrap();
        let hands = HandPath::read(&path, &scene).unwrap();
        let mut now = [Hand::default(); 2];
        hands.at(0.5, &mut now);
        let expected = Hand {
            centre_mm: [15.0, 20.0, 1.0],
            opening_mm: 30.0,
        };
        assert_eq!(now, [expected; 2]);
        hands.at(9.0, &mut now);
        assert_eq!(now[1].centre_mm, [30.0, 20.0, 4.0]);
        let mut led = HandPath::starting(0.0, &[expected; 2]);
        led.push(0.5, &now);
        led.push(0.5, &[expected; 2]);
        std::fs::write(&path, led.to_csv().unwrap()).unwrap();
        let read = HandPath::read(&path, &scene).unwrap();
        assert_eq!(read.span_s(), [0.0, 0.5]);
        assert_eq!((read.times_s, read.hands), (led.times_s, led.hands));
        for (rows, expected) in [
            ("t_s,x_mm,y_mm,z_mm\n", "no column opening_mm"),
            (
                "t_s,x_mm,y_mm,z_mm,opening_mm\n0,0,0,0,0\n0,0,0,0,0\n",
                ":3: t_s is 0 after 0",
            ),
            ("t_s,x_mm,y_mm,z_mm,opening_mm\n0,0,0,0,0\n", "no length"),
            (
                "t_s,x_mm,y_mm,z_mm,opening_mm\n0,0,0,nan,0\n1,0,0,0,0\n",
                ":2: z_mm is \"nan\"",
            ),
        ] {
            std::fs::write(&path, rows).unwrap();
            let error = HandPath::read(&path, &scene).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
}
