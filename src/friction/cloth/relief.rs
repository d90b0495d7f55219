//! The heights of a cloth.

use std::f64::consts::{FRAC_PI_2, PI};

use super::noise::{bell, smooth};
use super::{Area, Family, Recipe};
use selvedge_foundation::numerics::Grid;

/// Seeds of what is drawn by place.
struct Seeds {
    warp: u64,
    weft: u64,
    hairs: u64,
}

/// A yarn that runs beside others: which one lies at a place, and how far from its middle, as a
/// share of the pitch.
#[derive(Debug, Clone, Copy)]
struct Beside {
    index: i64,
    off: f64,
}

impl Recipe {
    /// Heights, µm, about a mean that is nearly 0.
    pub(crate) fn relief_um(&self, area: Area) -> Grid<f32> {
        let seeds = Seeds {
            warp: self.seed_for("warp"),
            weft: self.seed_for("weft"),
            hairs: self.seed_for("hairs"),
        };
        let (sin, cos) = self.turn.sin_cos();
        area.filled(|x, y| self.height_um(&seeds, cos * x + sin * y, cos * y - sin * x))
    }

    fn height_um(&self, seeds: &Seeds, x: f64, y: f64) -> f64 {
        let base = match self.family {
            Family::Plain | Family::Twill | Family::Satin | Family::Basket => {
                self.woven_um(seeds, x, y)
            }
            Family::Rib | Family::Jersey => self.knitted_um(seeds, x, y),
            Family::Pile => self.tufted_um(seeds, x, y),
            Family::Nonwoven => self.felted_um(seeds, x, y),
        };
        let hairs =
            smooth(seeds.hairs, x / 0.12, y / 0.25) + smooth(!seeds.hairs, x / 0.3, y / 0.1);
        base + 12.0 * self.fuzz * hairs
    }

    /// The yarn at a place across yarns that lie `pitch` apart, each shifted by chance.
    fn beside(&self, seed: u64, place: f64) -> Beside {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "the nearest yarn is a whole number"
        )]
        let nearest = place.round() as i64;
        let off = |index: i64| place - index as f64 - self.jitter * bell(seed, index, 0);
        let candidates = [nearest - 1, nearest, nearest + 1].map(|index| Beside {
            index,
            off: off(index),
        });
        let closer = |a: Beside, b: Beside| if b.off.abs() < a.off.abs() { b } else { a };
        candidates.into_iter().fold(candidates[1], closer)
    }

    /// Whether the end lies over the pick at their crossing.
    fn is_warp_up(&self, end: i64, pick: i64) -> bool {
        let repeat = self.repeat.cast_signed() as i64;
        match self.family {
            Family::Twill => (end - pick).rem_euclid(repeat) != 0,
            // Crossings step by 2 in five, by 3 in eight.
            Family::Satin => (end - (repeat + 1) / 3 * pick).rem_euclid(repeat) != 0,
            Family::Basket => (end.div_euclid(2) + pick.div_euclid(2)).rem_euclid(2) == 0,
            _ => (end + pick).rem_euclid(2) == 0,
        }
    }

    /// How high a yarn runs at a place along it, −1 to 1: a cosine between crossings.
    fn rise(place: f64, is_up: impl Fn(i64) -> bool) -> f64 {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "the crossing before is whole"
        )]
        let before = place.floor() as i64;
        let [a, b] = [before, before + 1].map(|crossing| if is_up(crossing) { 1.0 } else { -1.0 });
        let share = 0.5 - 0.5 * (PI * (place - before as f64)).cos();
        a + (b - a) * share
    }

    /// A yarn's surface above its path: a circle's arc flattened by its width.
    fn arc(&self, off: f64) -> f64 {
        let share = 2.0 * off / self.cover;
        (1.0 - share * share).max(0.0).sqrt() - 0.5
    }

    fn woven_um(&self, seeds: &Seeds, x: f64, y: f64) -> f64 {
        let place = [x / self.pitch_mm[0], y / self.pitch_mm[1]];
        let (end, pick) = (
            self.beside(seeds.warp, place[0]),
            self.beside(seeds.weft, place[1]),
        );
        let thick = |seed: u64, index: i64, along: f64| {
            1.0 + self.slub * smooth(seed ^ 0x51, index as f64, 0.15 * along)
        };
        let depth_um = 1.2 * self.crimp_um;
        let warp = self.crimp_um * Self::rise(place[1], |pick| self.is_warp_up(end.index, pick))
            + depth_um * self.arc(end.off) * thick(seeds.warp, end.index, place[1]);
        let weft = self.crimp_um * Self::rise(place[0], |end| !self.is_warp_up(end, pick.index))
            + depth_um * self.arc(pick.off) * thick(seeds.weft, pick.index, place[0]);
        // The lower of two yarns is never deeper than the cloth is thick.
        warp.max(weft).max(-2.0 * self.crimp_um)
    }

    fn knitted_um(&self, seeds: &Seeds, x: f64, y: f64) -> f64 {
        let place = [x / self.pitch_mm[0], y / self.pitch_mm[1]];
        let wale = self.beside(seeds.warp, place[0]);
        // Both legs of a loop lean outwards from foot to head, once a course.
        let course = place[1] - place[1].floor();
        let lean = 0.12 + 0.16 * (FRAC_PI_2 * course).sin();
        let leg = (wale.off.abs() - lean) / 0.2;
        let thick = 1.0 + self.slub * smooth(seeds.weft, wale.index as f64, 0.5 * place[1]);
        let loops = (1.0 - leg * leg).max(0.0).sqrt() * thick + 0.25 * (PI * course).sin();
        let stands = match self.family {
            Family::Rib if wale.index.rem_euclid(4) >= 2 => -1.4,
            _ => 0.0,
        };
        self.crimp_um * (loops + stands)
    }

    fn tufted_um(&self, seeds: &Seeds, x: f64, y: f64) -> f64 {
        let row = self.beside(seeds.weft, y / self.pitch_mm[1]);
        let tufts = smooth(
            seeds.warp,
            x / (0.5 * self.pitch_mm[0]),
            y / (0.4 * self.pitch_mm[1]),
        );
        self.crimp_um * (0.5 * self.arc(row.off) + 0.8 * tufts)
    }

    fn felted_um(&self, seeds: &Seeds, x: f64, y: f64) -> f64 {
        let at = |seed: u64, size: f64| smooth(seed, x / size, y / size);
        let [coarse, fine] = [self.pitch_mm[0], 0.3 * self.pitch_mm[0]];
        // Fibres: ridges where a surface goes through 0.
        let ridge = 1.0 - (2.0 * at(seeds.weft, fine).abs()).min(1.0);
        self.crimp_um * (0.6 * at(seeds.warp, coarse) + 0.4 * at(!seeds.warp, fine) + 0.6 * ridge)
    }
}
