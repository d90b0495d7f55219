//! Another cloth in the same scene, and other laws for a cloth that hangs: it keeps its shape.

use std::path::Path;

use super::fabric::Fabric;
use super::kes::{self, Figures};
use super::run::Drape;
use super::{DrapeError, DrapeScene};

/// The key of friction between finger and cloth, which no tester measures.
const FRICTION: &str = "friction";
/// Widths of the loop of shear, 2HG and 2HG5, and the energy of compression.
const NARROW: &str = "2hg_gf_per_cm";
const WIDE: &str = "2hg5_gf_per_cm";
const WC: &str = "wc_gf_cm_per_cm2";

impl DrapeScene {
    /// A figure by its key in `[measured]`, the mean of warp and weft, or `friction`.
    pub fn figure(&self, key: &str) -> Option<f64> {
        match key {
            FRICTION => Some(self.fabric.friction),
            "t0_mm" => Some(1e3 * self.fabric.compression.thickness_m),
            "lc" => Some(self.fabric.compression.linearity()),
            WC => Some(self.fabric.compression.work_j_per_m2() / kes::N_PER_M),
            WIDE => of_key(&self.figures, key).or_else(|| of_key(&self.figures, NARROW)),
            "rt_percent" => of_key(&self.figures, key).or(Some(100.0)),
            _ => of_key(&self.figures, key),
        }
    }

    /// Whether a figure changes anything: losses do where the scene has hysteresis; LT goes before
    /// WT, from which it follows where it is not known.
    pub fn uses(&self, key: &str) -> bool {
        let (symbol, _) = kes::parts(key);
        let has_lt = || of_key(&self.figures, "lt").is_some();
        match symbol {
            "2hg" | "2hg5" | "2hb" | "rt" => self.losses.has_hysteresis,
            "lt" => has_lt(),
            "wt" => !has_lt(),
            _ => true,
        }
    }

    /// The same with other figures. Those of warp and weft keep their ratio, and 2HG5 that to 2HG
    /// unless it is given, too.
    ///
    /// # Errors
    /// A figure is out of its range.
    pub fn with_figures(&self, changes: &[(&str, f64)]) -> Result<Self, DrapeError> {
        let (mut figures, mut friction) = (self.figures.clone(), self.fabric.friction);
        // 2HG first: it takes 2HG5 along, which may be changed after that.
        let (first, others): (Vec<_>, Vec<_>) = changes.iter().partition(|(key, _)| *key == NARROW);
        for (key, value) in first.into_iter().chain(others) {
            match key {
                FRICTION => friction = value,
                NARROW => {
                    let before = of_key(&figures, key);
                    set(&mut figures, WIDE, value, before);
                    set(&mut figures, key, value, before);
                }
                _ => {
                    let before = of_key(&figures, key);
                    set(&mut figures, key, value, before);
                }
            }
        }
        DrapeError::within((FRICTION, friction, ""), [0.0, 10.0])?;
        let mut scene = self.with_laws(figures, friction)?;
        let is_of_tension = |key: &str| matches!(kes::parts(key).0, "emt" | "lt" | "wt");
        if !changes.iter().any(|(key, _)| is_of_tension(key)) {
            scene.fabric.tension = self.fabric.tension;
        }
        let changed = changes
            .iter()
            .map(|(key, value)| ((*key).to_owned(), *value));
        scene.plausible = scene.plausible.without(&changed.collect());
        Ok(scene)
    }

    fn with_laws(&self, figures: Figures, friction: f64) -> Result<Self, DrapeError> {
        let (fabric, notes) = Fabric::of_figures(&figures)?;
        let mut scene = self.clone();
        scene.fabric = Fabric { friction, ..fabric };
        (scene.figures, scene.notes) = (figures, notes);
        Ok(scene)
    }

    /// The same with a textile of a library, the program's if none is named, in place of its own.
    ///
    /// # Errors
    /// A textile that is unknown, or whose figures are.
    pub fn of_other_textile(&self, id: &str, library: Option<&Path>) -> Result<Self, DrapeError> {
        let (figures, plausible) = kes::of_textile(id, library)?;
        let mut scene = self.with_laws(figures, self.fabric.friction)?;
        scene.plausible = plausible;
        (scene.textile, scene.back) = (Some(id.to_owned()), None);
        scene.library_folder = library.map(Path::to_owned);
        Ok(scene)
    }

    /// The same with all fingers on the side of the first: they stretch it between them.
    #[must_use]
    pub fn on_one_side(&self) -> Self {
        let mut scene = self.clone();
        let side = scene.fingers.first().map_or(1.0, |first| first.side);
        scene
            .fingers
            .iter_mut()
            .for_each(|finger| finger.side = side);
        scene
    }
}

impl Drape {
    /// Gives the cloth the laws of another scene of its size: places and speeds, fingers and what
    /// they hold stay, and so does the clock.
    ///
    /// # Errors
    /// The scene has other fingers, or a step that cannot be; nothing has changed then.
    pub fn refit(&mut self, scene: &DrapeScene) -> Result<(), DrapeError> {
        let mut on_grid = scene.clone();
        on_grid.grid = Some(self.grid());
        let (mut cloth, why) = on_grid.cloth(None, None)?;
        let old = &self.cloth;
        if cloth.x.len() != old.x.len() {
            let mend = "hang it anew";
            return Err(DrapeError::input("the scene has other fingers", mend));
        }
        cloth.x.copy_from_slice(&old.x);
        cloth.v.copy_from_slice(&old.v);
        (cloth.counters, cloth.work_j) = (old.counters, old.work_j);
        let fingers = cloth.system.fingers.iter_mut().zip(&old.system.fingers);
        for (finger, old) in fingers {
            finger.take_up(old);
        }
        cloth.restart();
        self.take(cloth, why);
        Ok(())
    }
}

fn of_key(figures: &Figures, key: &str) -> Option<f64> {
    let (symbol, suffix) = kes::parts(key);
    kes::mean(figures, symbol, suffix)
}

/// Brings a figure from its mean before to another, or scales one by that of another key.
fn set(figures: &mut Figures, key: &str, value: f64, before: Option<f64>) {
    let (symbol, suffix) = kes::parts(key);
    let sides = ["", "_warp", "_weft"].map(|side| format!("{symbol}{side}{suffix}"));
    let is_known = sides.iter().any(|key| figures.contains_key(key));
    if let Some(before) = before.filter(|before| is_known && *before > 0.0) {
        for key in &sides {
            if let Some(figure) = figures.get_mut(key) {
                *figure *= value / before;
            }
        }
    } else {
        for key in &sides[1..] {
            figures.remove(key);
        }
        figures.insert(key.to_owned(), value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Hand;

    fn shipped() -> DrapeScene {
        let path =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/scenes/denim.drape.toml");
        DrapeScene::read(&path).unwrap()
    }

    #[test]
    fn figures_that_are_changed_keep_their_ratio_and_are_refused_out_of_range() {
        let scene = shipped();
        let key = "b_gf_cm2_per_cm";
        let before = scene.figure(key).unwrap();
        let changes = [(key, 2.0 * before), (FRICTION, 0.7), ("2hg_gf_per_cm", 1.0)];
        let other = scene.with_figures(&changes).unwrap();
        assert!((other.figure(key).unwrap() - 2.0 * before).abs() < 1e-12);
        assert_eq!(other.figure(FRICTION), Some(0.7));
        let [old, new] = [&scene, &other].map(|scene| scene.fabric().bending_n_m);
        assert!((new[0] / new[1] - old[0] / old[1]).abs() < 1e-9);
        let [old, new] = [&scene, &other].map(|scene| scene.fabric().shear_loop_n_per_m);
        assert!(
            (new[1] / new[0] - old[1] / old[0]).abs() < 1e-9,
            "{old:?} {new:?}"
        );
        let refused = scene.with_figures(&[("emt_percent", 0.0)]).unwrap_err();
        assert!(refused.to_string().contains("EMT"), "{refused}");
        assert!(scene.with_figures(&[(FRICTION, f64::NAN)]).is_err());
        let silk = scene.of_other_textile("silk-crepe", None).unwrap();
        assert_eq!(silk.size_mm(), scene.size_mm());
        assert!(silk.fabric().density_kg_per_m2 < 0.1);
    }

    #[test]
    fn losses_and_compression_are_changed_by_their_own_figures() {
        let scene = shipped();
        for changes in [[(WIDE, 9.0), (NARROW, 3.0)], [(NARROW, 3.0), (WIDE, 9.0)]] {
            let other = scene.with_figures(&changes).unwrap();
            let found = [NARROW, WIDE].map(|key| other.figure(key).unwrap());
            let off = [0, 1].map(|nth| (found[nth] - [3.0, 9.0][nth]).abs());
            assert!(off[0].max(off[1]) < 1e-12, "{changes:?}: {found:?}");
        }
        let loose = scene.with_figures(&[("rt_percent", 20.0)]).unwrap();
        let [old, new] = [&scene, &loose].map(|scene| scene.fabric().tension_friction_n_per_m[0]);
        let left = scene.figure("rt_percent").unwrap();
        assert!(
            (new / old - 80.0 / (100.0 - left)).abs() < 1e-9,
            "{old} {new}"
        );
        let before = scene.figure(WC).unwrap();
        let soft = scene.with_figures(&[(WC, 2.0 * before)]).unwrap();
        let [old, new] = [&scene, &soft].map(|scene| scene.fabric().compression.yield_m);
        assert!((new / old - 2.0).abs() < 1e-9, "{old} {new}");
        assert!((soft.figure(WC).unwrap() / before - 2.0).abs() < 1e-9);
        // What does nothing is known to: losses without hysteresis, WT beside LT.
        let plain = DrapeScene::of_textile("denim").unwrap();
        let idle = [
            NARROW,
            WIDE,
            "2hb_gf_cm_per_cm",
            "rt_percent",
            "wt_gf_cm_per_cm2",
        ];
        assert!(idle.iter().all(|key| !plain.uses(key)));
        assert!(["lt", "lc", WC, NARROW].iter().all(|key| scene.uses(key)));
        let n_plausible = |scene: &DrapeScene| scene.plausible_figures().len();
        assert_eq!(n_plausible(&scene), n_plausible(&loose) + 1);
    }

    #[test]
    fn a_cloth_keeps_its_place_and_its_grip_when_its_laws_change() {
        let scene = shipped();
        let mut drape = Drape::new(&scene, None, None).unwrap();
        let mut hands: Vec<Hand> = drape.start_hands();
        for step in 0..300 {
            for hand in &mut hands {
                hand.opening_mm = (20.0 - 0.2 * f64::from(step)).max(-2.0);
            }
            if step == 0 {
                drape.place(&hands);
            }
            drape.step(&hands).unwrap();
        }
        let held = drape.finger(0);
        assert!(held.n_contacts > 8, "{held:?}");
        let before: Vec<[f64; 3]> = drape.places_mm().collect();
        let stiff = scene.with_figures(&[("b_gf_cm2_per_cm", 2.0)]).unwrap();
        let then_s = drape.t_s();
        let mut slow = stiff.clone();
        slow.step_ms = Some(4.0);
        let mut slower = drape.clone();
        slower.refit(&slow).unwrap();
        assert_eq!(slower.t_s(), then_s, "the clock goes on");
        slower.step(&hands).unwrap();
        assert!((slower.t_s() - then_s - 4e-3).abs() < 1e-12);
        drape.refit(&stiff).unwrap();
        assert!(
            drape.places_mm().eq(before.iter().copied()),
            "at once it is where it was"
        );
        drape.step(&hands).unwrap();
        let now = drape.finger(0);
        assert!(now.n_contacts > 8, "still held: {held:?} {now:?}");
        let farthest = drape.places_mm().zip(&before).map(|(now, before)| {
            [0, 1, 2]
                .map(|axis| (now[axis] - before[axis]).abs())
                .into_iter()
                .fold(0.0, f64::max)
        });
        assert!(farthest.fold(0.0, f64::max) < 1.0, "nothing jumps");
        let mut without = scene.clone();
        without.fingers.clear();
        let refused = drape.refit(&without).unwrap_err().to_string();
        assert!(refused.contains("other fingers"), "{refused}");
        assert!(drape.finger(0).n_contacts > 8, "nothing has changed");
    }

    #[test]
    fn contactors_lie_on_their_pad() {
        let drape = Drape::new(&shipped(), None, None).unwrap();
        let pads: Vec<_> = drape.pads().collect();
        assert_eq!((pads.len(), pads[0].side, pads[1].side), (2, 1.0, -1.0));
        for pad in pads {
            let [x, y, z] = pad.tip_mm;
            for place in pad.contactors_mm() {
                let on = pad.at_mm([place[0] - x, place[1] - y]);
                assert!((on[2] - place[2]).abs() < 1e-9);
            }
            assert!((z - 30.0 * pad.side).abs() < 1e-9);
        }
    }
}
