//! How pictures of the cloths are taken: a balanced part of all ways.

use crate::Effort;
use selvedge_foundation::numerics::Random;
use selvedge_textile::Lamp;
use selvedge_textile::picture::shading::Light;

/// Where the light comes from: along neither yarn.
pub(super) const LIGHT: Light = Light {
    slant_deg: 45.0,
    tilt_deg: 30.0,
};
/// How far a lamp is off that is told wrong, degrees.
const OFF_DEG: f64 = 15.0;
/// Bits, noise (share of white) and the largest local stretch of the cloth: of the eight ways the
/// four in which any two of these meet at every level once.
const CAMERAS: [(i32, f64, f64); 4] = [
    (16, 0.01, 0.0),
    (16, 0.03, 0.08),
    (8, 0.01, 0.08),
    (8, 0.03, 0.0),
];
/// The two of them that take a cloth under every lamp, cloth by cloth in turn, so that each takes
/// half of the cloths and meets each other one.
const PAIRS: [[usize; 2]; 6] = [[0, 1], [2, 3], [0, 2], [1, 3], [0, 3], [1, 2]];

/// How a picture is taken, and what is known of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Taking {
    /// Pixels a side at most.
    pub(super) side_px: usize,
    /// Noise of the camera, share of white.
    pub(super) noise: f64,
    /// Bits a pixel.
    pub(super) bits: i32,
    /// The largest local stretch of the cloth, which lies in waves.
    pub(super) stretch: f64,
    /// The lamp as it is told.
    pub(super) lamp: Lamp,
}

impl Taking {
    /// Under a lamp that is told right, of flat cloth, with little noise.
    pub(super) const PLAIN: Self = Self {
        side_px: 300,
        noise: 0.01,
        bits: 16,
        stretch: 0.0,
        lamp: told(0.0),
    };

    /// What it is by each that pictures differ in, in words.
    pub(super) fn words(&self) -> [String; 4] {
        let light = match self.lamp {
            Lamp::Unknown | Lamp::Turned { .. } => "light unknown".to_owned(),
            Lamp::Known { light, .. } if light == LIGHT => "light known".to_owned(),
            Lamp::Known { .. } => format!("light {OFF_DEG}° off"),
        };
        let bend = if self.stretch > 0.0 { "bent" } else { "flat" };
        let noise = format!("noise {} %", 100.0 * self.noise);
        [light, format!("{} bits", self.bits), noise, bend.to_owned()]
    }

    /// What the camera makes of a brightness.
    pub(super) fn seen(&self, brightness: f64, random: &mut Random) -> f64 {
        let steps = 2.0_f64.powi(self.bits) - 1.0;
        let noisy = (brightness + self.noise * random.normal()).clamp(0.0, 1.0);
        (noisy * steps).round() / steps
    }
}

/// A lamp told wrong by so many degrees.
const fn told(off_deg: f64) -> Lamp {
    Lamp::Known {
        light: Light {
            tilt_deg: LIGHT.tilt_deg + off_deg,
            ..LIGHT
        },
        within_deg: Lamp::WITHIN_DEG,
    }
}

/// How the cloth of this number is taken, the plainest first.
pub(super) fn takings(number: usize, effort: Effort) -> Vec<Taking> {
    let plain = Taking {
        side_px: effort.pick(160, Taking::PLAIN.side_px),
        ..Taking::PLAIN
    };
    if effort == Effort::Quick {
        let lamp = Lamp::Unknown;
        return vec![plain, Taking { lamp, ..plain }];
    }
    let mut all = vec![plain];
    for lamp in [told(0.0), told(OFF_DEG), Lamp::Unknown] {
        for (bits, noise, stretch) in PAIRS[number % PAIRS.len()].map(|one| CAMERAS[one]) {
            let taking = Taking {
                noise,
                bits,
                stretch,
                lamp,
                ..plain
            };
            if taking != plain {
                all.push(taking);
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_takes_as_many_pictures_and_any_two_meet() {
        let all: Vec<Taking> = (0..12)
            .flat_map(|number| takings(number, Effort::Full).split_off(1))
            .collect();
        let n = |has: &dyn Fn(&Taking) -> bool| all.iter().filter(|taking| has(taking)).count();
        // The plainest one of half of the cloths stands first and is left out here.
        assert_eq!(all.len(), 12 * 6 - 6);
        for bits in [8, 16] {
            for stretch in [0.0, 0.08] {
                let of = n(&|one| (one.bits, one.stretch) == (bits, stretch));
                let plain = if (bits, stretch) == (16, 0.0) { 6 } else { 0 };
                assert_eq!(of + plain, 18, "{bits} bits, stretch {stretch}");
            }
        }
        assert_eq!(n(&|one| one.lamp == Lamp::Unknown), 24);
        assert_eq!(n(&|one| one.lamp == told(OFF_DEG)), 24);
    }
}
