//! The finger on a contactor: a spring and a damper side by side, and whether it can lift off.
//!
//! Kelvin–Voigt as fitted to pins of 0.6 mm on finger pads. The range, 200–1000 N/m and 0.05–0.5
//! N s/m, is an assumption that a measurement must replace.

use std::fmt;
use std::str::FromStr;

use super::within;
use crate::BridgeError;

/// A load on every contactor.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Skin {
    /// Stiffness ks, N/m.
    pub stiffness_n_per_m: f64,
    /// Damping cs, N s/m.
    pub damping_n_s_per_m: f64,
    /// How far the skin is pressed in at rest, µm; `None` glues it to the pin.
    ///
    /// With it the force is `max(0, ks (x + preload) + cs x')`: skin pushes and never pulls.
    pub preload_um: Option<f64>,
}

impl Skin {
    /// No finger.
    pub const FREE: Self = Self::bonded(0.0, 0.0);
    /// A finger that rests lightly.
    pub const LIGHT: Self = Self::bonded(200.0, 0.05);
    /// A finger that presses.
    pub const FIRM: Self = Self::bonded(1000.0, 0.5);
    /// The loads that have a name, the lightest first.
    pub const NAMED: [(&'static str, Self); 3] = [
        ("free", Self::FREE),
        ("light", Self::LIGHT),
        ("firm", Self::FIRM),
    ];

    /// A load that never lifts off.
    pub const fn bonded(stiffness_n_per_m: f64, damping_n_s_per_m: f64) -> Self {
        Self {
            stiffness_n_per_m,
            damping_n_s_per_m,
            preload_um: None,
        }
    }

    /// Refuses what is not finite, below 0, or above 10⁹ N/m, 10⁴ N s/m, 10⁴ µm.
    pub fn check(&self) -> Result<(), BridgeError> {
        let preload_um = self.preload_um.unwrap_or(0.0);
        let ranges = [
            ("stiffness", self.stiffness_n_per_m, [0.0, 1e9], " N/m"),
            ("damping", self.damping_n_s_per_m, [0.0, 1e4], " N s/m"),
            ("preload", preload_um, [0.0, 1e4], " µm"),
        ];
        within("skin", &ranges)
    }

    /// The name of a load that has one.
    pub fn name(&self) -> Option<&'static str> {
        let named = Self::NAMED.iter().find(|(_, skin)| skin == self);
        named.map(|(name, _)| *name)
    }
}

/// `light (200 N/m, 0.05 N s/m)`, for people.
impl fmt::Display for Skin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == Self::FREE {
            return f.write_str("free");
        }
        let (ks, cs) = (self.stiffness_n_per_m, self.damping_n_s_per_m);
        match self.name() {
            Some(name) => write!(f, "{name} ({ks} N/m, {cs} N s/m)")?,
            None => write!(f, "{ks} N/m, {cs} N s/m")?,
        }
        match self.preload_um {
            Some(preload_um) => write!(f, ", pressed in {preload_um} µm"),
            None => Ok(()),
        }
    }
}

/// `free`, `light`, `firm`, or `KS,CS` or `KS,CS,PRELOAD` in N/m, N s/m and µm.
impl FromStr for Skin {
    type Err = BridgeError;

    fn from_str(text: &str) -> Result<Self, BridgeError> {
        let wanted = text.trim();
        let named = |(name, _): &&(&str, Self)| name.eq_ignore_ascii_case(wanted);
        if let Some((_, skin)) = Self::NAMED.iter().find(named) {
            return Ok(*skin);
        }
        let numbers: Result<Vec<f64>, _> = wanted.split(',').map(|n| n.trim().parse()).collect();
        let skin = match numbers.as_deref() {
            Ok(&[ks, cs]) => Self::bonded(ks, cs),
            Ok(&[ks, cs, preload_um]) => Self {
                preload_um: Some(preload_um),
                ..Self::bonded(ks, cs)
            },
            _ => {
                return Err(BridgeError::Model(format!(
                    "a skin \"{wanted}\"; give free, light, firm, or KS,CS in N/m and N s/m"
                )));
            }
        };
        skin.check()?;
        Ok(skin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loads_are_read_by_name_and_by_number() {
        assert_eq!("Free".parse::<Skin>().unwrap(), Skin::FREE);
        assert_eq!(
            "500, 0.2".parse::<Skin>().unwrap(),
            Skin::bonded(500.0, 0.2)
        );
        let pressed: Skin = "500,0.2,30".parse().unwrap();
        assert_eq!(pressed.preload_um, Some(30.0));
        assert_eq!(pressed.to_string(), "500 N/m, 0.2 N s/m, pressed in 30 µm");
        assert_eq!(Skin::LIGHT.to_string(), "light (200 N/m, 0.05 N s/m)");
    }

    #[test]
    fn loads_that_make_no_sense_are_refused_with_the_mend() {
        for bad in ["", "soft", "1", "1,2,3,4", "nan,0", "-1,0", "1e10,0"] {
            let error = bad.parse::<Skin>().unwrap_err().to_string();
            assert!(error.contains("give"), "{bad}: {error}");
        }
    }
}
