//! A yarn as a recipe states it, and how a length of it varies.

use super::path::{Node, YarnPath};
use super::variation::{Drift, count};
use crate::error::TextileError;
use crate::recipe::{Checker, Group, KeySpec, defaults, keys, parameters_of};
use selvedge_foundation::numerics::Random;

keys! {
    /// A yarn: section, twist, irregularity, loose fibres, colour.
    table pub(crate) Yarn {
        pub(crate) width_um: f64
            => "Width" 10.0 ..= 5000.0 "µm" "Width of the section as it lies in the cloth",
        pub(crate) thickness_um: f64
            => "Thickness" 10.0 ..= 5000.0 "µm" "Thickness of the section as it lies in the cloth",
        #[serde(default)]
        pub(crate) flatness: f64
            => "Flatness" 0.0 ..= 0.9 "" "Share of the width that is flat: 0 elliptic, 0.9 a tape",
        #[serde(default)]
        pub(crate) count_cv: f64
            => "Uneven count" 0.0 ..= 0.6 "" "Variation of the thickness from yarn to yarn",
        #[serde(default)]
        pub(crate) uneven_cv: f64
            => "Unevenness" 0.0 ..= 0.6 "" "Variation of the thickness along a yarn",
        #[serde(default = "default_uneven_mm")]
        pub(crate) uneven_mm: f64
            => "Length of unevenness" 0.5 ..= 50.0 "mm"
            "Correlation length of the variation along a yarn",
        #[serde(default)]
        pub(crate) slubs_per_m: f64
            => "Slubs" 0.0 ..= 200.0 "/m" "Thick places per metre of yarn",
        #[serde(default)]
        pub(crate) slub_gain: f64
            => "Gain of slubs" 0.0 ..= 4.0 ""
            "How much thicker a slub is: 0.5 is half as thick again",
        #[serde(default = "default_slub_mm")]
        pub(crate) slub_mm: f64
            => "Length of slubs" 0.5 ..= 100.0 "mm" "Length of a slub",
        #[serde(default)]
        pub(crate) band_cv: f64
            => "Bands" 0.0 ..= 0.6 ""
            "Barré: standard deviation of the thickness between groups of yarns",
        #[serde(default = "default_band_mm")]
        pub(crate) band_mm: f64
            => "Width of bands" 0.5 ..= 20.0 "mm" "Width of a band",
        #[serde(default)]
        pub(crate) twist_per_m: f64
            => "Twist" 0.0 ..= 5000.0 "/m" "Turns per metre",
        #[serde(default = "default_plies")]
        pub(crate) plies: u8
            => "Plies" 1.0 ..= 8.0 "" "Plies, or filament bundles, that show as ridges",
        #[serde(default)]
        pub(crate) ridge_um: f64
            => "Ridges" 0.0 ..= 500.0 "µm" "Depth of the ridges",
        #[serde(default)]
        pub(crate) hairs_per_mm2: f64
            => "Hairs" 0.0 ..= 100.0 "/mm²" "Loose fibres on the surface",
        #[serde(default = "default_hair_mm")]
        pub(crate) hair_mm: f64
            => "Length of hairs" 0.1 ..= 10.0 "mm" "Length of a loose fibre",
        #[serde(default = "default_hair_um")]
        pub(crate) hair_um: f64
            => "Thickness of hairs" 1.0 ..= 500.0 "µm"
            "Thickness of a loose fibre, or of a tuft that acts as one",
        #[serde(default)]
        pub(crate) hair_lift_um: f64
            => "Lift of hairs" 0.0 ..= 3000.0 "µm"
            "How far a loose fibre stands off the yarn under the probe's load",
        #[serde(default)]
        pub(crate) hair_clump: f64
            => "Clumped hairs" 0.0 ..= 2.0 ""
            "How unevenly the loose fibres are raised: standard deviation of the logarithm",
        pub(crate) colour: String
            => "Colour": "Colour of the fibre, #rrggbb",
        #[serde(default)]
        pub(crate) colour_cv: f64
            => "Uneven colour" 0.0 ..= 0.6 ""
            "How much the lightness varies from yarn to yarn, standard deviation",
    }
}

defaults! {
    default_uneven_mm: f64 = 3.0;
    default_slub_mm: f64 = 8.0;
    default_band_mm: f64 = 4.0;
    default_plies: u8 = 2;
    default_hair_mm: f64 = 1.5;
    default_hair_um: f64 = 18.0;
}

impl Yarn {
    /// Refuses figures that no yarn has.
    pub(crate) fn check(&self, checker: &Checker<'_>, table: &str) -> Result<(), TextileError> {
        KeySpec::check(Self::KEYS, self, (checker, table))?;
        if parse_colour(&self.colour).is_none() {
            let what = format!("colour is \"{}\"", self.colour);
            return Err(checker.wrong(table, "colour", what, "write it as \"#rrggbb\""));
        }
        Ok(())
    }

    /// Its parameters as those of a table.
    pub(crate) fn group(table: &'static str, title: &'static str) -> Group {
        let mut parameters = parameters_of(table, Self::KEYS, &[]);
        // The colour stands last.
        if let Some(colour) = parameters.iter().position(|one| one.place.key == "colour") {
            parameters[colour..].rotate_left(1);
        }
        Group { title, parameters }
    }

    /// The colour of one yarn, red, green and blue 0…1.
    pub(crate) fn colour_of_one(&self, random: &mut Random) -> [f64; 3] {
        let lightness = (1.0 + self.colour_cv * random.normal()).clamp(0.3, 1.7);
        parse_colour(&self.colour)
            .unwrap_or([0.5; 3])
            .map(|c| (c * lightness).min(1.0))
    }

    /// The bands that groups of yarns share, over an axis of the textile.
    pub(crate) fn bands(&self, size_mm: f64, random: &mut Random) -> Drift {
        Drift::new(size_mm, self.band_mm, random)
    }
}

fn parse_colour(text: &str) -> Option<[f64; 3]> {
    let digits = text
        .strip_prefix('#')
        .filter(|d| d.len() == 6 && d.is_ascii())?;
    let part = |k: usize| u8::from_str_radix(&digits[2 * k..2 * k + 2], 16).ok();
    Some([part(0)?, part(1)?, part(2)?].map(|v| f64::from(v) / 255.0))
}

/// One length of yarn that closes on itself: how thick it is and how its ridges lie.
#[derive(Debug)]
pub(crate) struct YarnRun<'a> {
    yarn: &'a Yarn,
    length_mm: f64,
    level: f64,
    uneven: Drift,
    slubs: Vec<(f64, f64)>,
    phase_rad: f64,
    rad_per_mm: f64,
    colour: [f64; 3],
}

impl<'a> YarnRun<'a> {
    /// A run of `length_mm`; `band` is the value of its band (see [`Yarn::bands`]).
    pub(crate) fn new(yarn: &'a Yarn, length_mm: f64, band: f64, random: &mut Random) -> Self {
        let level = yarn.count_cv * random.normal() + yarn.band_cv * band;
        let uneven = Drift::new(length_mm, yarn.uneven_mm, random);
        let expected = yarn.slubs_per_m * length_mm / 1000.0;
        // A whole number with the wanted mean: the chance of one more is the fraction.
        let n_slubs = count((expected - random.uniform()).max(0.0));
        let slub = |random: &mut Random| {
            let place = random.uniform() * length_mm;
            (place, random.uniform_in(0.5, 1.5) * yarn.slub_gain)
        };
        let slubs = (0..n_slubs).map(|_| slub(random)).collect();
        let phase_rad = random.uniform() * std::f64::consts::TAU;
        // A whole number of ridges closes the run.
        let ridges = (f64::from(yarn.plies) * yarn.twist_per_m * length_mm / 1000.0).round();
        let rad_per_mm = ridges * std::f64::consts::TAU / length_mm;
        let colour = yarn.colour_of_one(random);
        Self {
            yarn,
            length_mm,
            level,
            uneven,
            slubs,
            phase_rad,
            rad_per_mm,
            colour,
        }
    }

    /// Thickness over the yarn's mean thickness at a place along the run, mm.
    pub(crate) fn thickness(&self, along_mm: f64) -> f64 {
        let own = 1.0 + self.level + self.yarn.uneven_cv * self.uneven.at(along_mm);
        let slub = |&(place, gain): &(f64, f64)| {
            let apart = (along_mm - place).rem_euclid(self.length_mm);
            let apart = apart.min(self.length_mm - apart) / (0.5 * self.yarn.slub_mm);
            gain * (-2.0 * apart * apart).exp()
        };
        (own + self.slubs.iter().map(slub).sum::<f64>()).clamp(0.3, 5.0)
    }

    /// A node of this run at a place in the textile.
    pub(crate) fn node(&self, place: [f64; 2], z_um: f64, along_mm: f64) -> Node {
        let thick = self.thickness(along_mm);
        Node {
            u_mm: place[0],
            w_mm: place[1],
            z_um,
            half_width_mm: 0.0005 * self.yarn.width_um * (0.5 + 0.5 * thick),
            half_thickness_um: 0.5 * self.yarn.thickness_um * thick,
            twist_rad: self.phase_rad + self.rad_per_mm * along_mm,
        }
    }

    /// The yarn of these nodes.
    pub(crate) fn path(&self, nodes: Vec<Node>) -> YarnPath {
        let yarn = self.yarn;
        let colour = self.colour;
        YarnPath {
            nodes,
            flatness: yarn.flatness,
            ridge_um: yarn.ridge_um,
            colour,
        }
    }
}
