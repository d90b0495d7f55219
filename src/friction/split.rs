//! Which windows of which cloths are learnt from, and which are held back.

use selvedge_foundation::named;
use selvedge_foundation::numerics::Random;

use crate::cloth::{Area, FINGER_ROWS, Family};
use crate::example::{SHORT_WINDOW, SQUARE, TRACE, WINDOW, Window};
use crate::signal::HOP;

/// Seed of the first cloth that is held back.
const HELD_BACK: u64 = 10_000;

named! {
    /// What is held back.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Split {
        /// Cloths of known families that were never seen: the main result.
        Cloths = "A", "unseen cloths of known families",
        /// A family that was never seen: twills.
        Family = "B", "an unseen family (twill)",
        /// Known cloths at a place 50 mm from any that was seen.
        Places = "C", "unseen places of known cloths, 40 mm each",
        /// The protocol of the paper: windows of one photograph and one trace a cloth, so that a
        /// test window shares nearly all pixels and samples with one that was learnt.
        Leaky = "D", "leaky, for comparison only: windows 2 pixels apart",
    }
    /// Its letter.
    pub fn letter;
    /// What it holds back.
    pub fn describe;
}

impl Split {
    /// Cloths of each family that are learnt from.
    pub const N_CLOTHS: usize = 150;

    /// Windows to learn from, and those that are held back. `scale` cloths of each family are
    /// learnt from ([`Self::N_CLOTHS`] is what results are told of), a quarter of that held back,
    /// at most 20; those do not depend on how many are learnt from.
    pub(crate) fn windows(self, scale: usize) -> [Vec<Window>; 2] {
        let n_held_back = (scale / 4).clamp(1, 20);
        match self {
            Self::Cloths => [
                apart(&Family::ALL, 0, scale, 2),
                apart(&Family::ALL, HELD_BACK, n_held_back, 1),
            ],
            Self::Family => {
                let known: Vec<_> = Family::ALL
                    .into_iter()
                    .filter(|&family| family != Family::Twill)
                    .collect();
                [
                    apart(&known, 0, scale, 2),
                    apart(&[Family::Twill], HELD_BACK, 4 * n_held_back, 1),
                ]
            }
            Self::Places => [&[0, HOP] as &[usize], &[WINDOW]].map(|starts| {
                cloths(&Family::ALL, 0, scale)
                    .flat_map(|cloth| {
                        starts
                            .iter()
                            .map(move |&from| at(cloth, [from, SHORT_WINDOW]))
                    })
                    .collect()
            }),
            Self::Leaky => leaky(scale),
        }
    }
}

/// Cloths of each family from a seed on.
fn cloths(families: &[Family], from: u64, n: usize) -> impl Iterator<Item = (Family, u64)> {
    families
        .iter()
        .flat_map(move |&family| (from..from + n as u64).map(move |seed| (family, seed)))
}

/// One window of a cloth, taken in a way of its own.
fn at((family, seed): (Family, u64), columns: [usize; 2]) -> Window {
    let take = Random::new(seed)
        .branch(&format!("{} {}", family.word(), columns[0]))
        .seed();
    Window {
        family,
        seed,
        area: Area {
            columns,
            rows: [(SQUARE - FINGER_ROWS) / 2, FINGER_ROWS],
        },
        take,
        is_cut: false,
    }
}

/// So many windows of each cloth, far from each other.
fn apart(families: &[Family], from: u64, n_cloths: usize, n_windows: usize) -> Vec<Window> {
    cloths(families, from, n_cloths)
        .flat_map(|cloth| (0..n_windows).map(move |n| at(cloth, [n * 2 * WINDOW, WINDOW])))
        .collect()
}

/// Windows two pixels apart of one photograph and one trace a cloth, eight of nine learnt from.
fn leaky(scale: usize) -> [Vec<Window>; 2] {
    let starts = (0..=TRACE - WINDOW).step_by(2).take(2 * scale);
    let cut = |cloth, from| Window {
        is_cut: true,
        take: at(cloth, [0, TRACE]).take,
        ..at(cloth, [from, WINDOW])
    };
    let mut windows: Vec<Window> = cloths(&Family::ALL, 0, 1)
        .flat_map(|cloth| starts.clone().map(move |from| cut(cloth, from)))
        .collect();
    Random::new(669).shuffle(&mut windows);
    let held_back = windows.split_off(windows.len() - windows.len() / 9);
    [windows, held_back]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether both see the same place of the same cloth.
    fn overlap(one: &Window, other: &Window) -> bool {
        let [a, b] = [one, other].map(|window| window.area.columns);
        let is_same = (one.family, one.seed) == (other.family, other.seed);
        is_same && a[0] < b[0] + b[1] && b[0] < a[0] + a[1]
    }

    #[test]
    fn nothing_that_is_held_back_was_seen() {
        for split in [Split::Cloths, Split::Family, Split::Places] {
            let [learnt, held_back] = split.windows(8);
            assert!(!held_back.is_empty());
            for test in &held_back {
                let leak = learnt.iter().find(|window| overlap(window, test));
                assert_eq!(leak, None, "{split:?}: {test:?}");
                if split == Split::Places {
                    let same = |w: &&Window| (w.family, w.seed) == (test.family, test.seed);
                    let end = learnt
                        .iter()
                        .filter(same)
                        .map(|w| w.area.columns[0] + SHORT_WINDOW);
                    let gap = test.area.columns[0] - end.max().unwrap();
                    assert!(gap >= 640, "{gap} samples");
                }
                if split == Split::Family {
                    assert!(learnt.iter().all(|window| window.family != test.family));
                }
            }
        }
        let [learnt, held_back] = Split::Leaky.windows(8);
        let leaks = held_back
            .iter()
            .filter(|test| learnt.iter().any(|w| overlap(w, test)));
        assert_eq!(leaks.count(), held_back.len(), "the leaky split leaks");
    }
}
