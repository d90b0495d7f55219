//! What is hung, and what is told of it: plain data that goes between the window and the thread
//! that steps.

use std::path::PathBuf;
use std::sync::Arc;

use selvedge_drape::{DrapeScene, FingerRow, Hand, HandPath, Pad};

/// Where a scene comes from.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) enum Base {
    /// The program.
    #[default]
    Shipped,
    /// A file.
    File(PathBuf),
}

impl Base {
    /// What its file is called.
    pub(crate) fn name(&self) -> String {
        let name = match self {
            Self::Shipped => Some("denim.drape.toml".as_ref()),
            Self::File(path) => path.file_name(),
        };
        name.unwrap_or_default().to_string_lossy().into_owned()
    }
}

/// A textile of a library in place of the scene's own.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OtherTextile {
    /// What scenes call it.
    pub(crate) key: String,
    /// What people call it.
    pub(crate) name: String,
    /// What its library calls it.
    pub(crate) id: String,
    /// Where that is; `None` is the program's.
    pub(crate) library: Option<PathBuf>,
}

/// A cloth that hangs: the scene's or another textile, with figures that were changed.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct ClothChoice {
    pub(crate) textile: Option<OtherTextile>,
    pub(crate) changes: Vec<(&'static str, f64)>,
}

/// Where the second finger is, and what leads it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Second {
    /// On the other side, doing what the first does.
    #[default]
    Mirrored,
    /// Beside the first, on its side.
    Beside,
    /// On the other side, along the recorded path.
    Recorded,
    /// On the other side, where the scene's second display is: a finger of its own.
    Device,
}

/// What was chosen: every change is a step that can be taken back.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Chosen {
    pub(crate) base: Base,
    /// Side by side; there is always one.
    pub(crate) cloths: Vec<ClothChoice>,
    pub(crate) second: Second,
}

impl Default for Chosen {
    fn default() -> Self {
        Self {
            base: Base::default(),
            cloths: vec![ClothChoice::default()],
            second: Second::default(),
        }
    }
}

impl Chosen {
    /// What was changed to get here.
    pub(crate) fn step_from(&self, before: &Self) -> &'static str {
        let textiles = |chosen: &Self| -> Vec<_> {
            let cloths = chosen.cloths.iter();
            cloths.map(|cloth| cloth.textile.clone()).collect()
        };
        match () {
            () if self.base != before.base => "scene",
            () if self.cloths.len() != before.cloths.len() => "cloths side by side",
            () if textiles(self) != textiles(before) => "textile",
            () if self.second != before.second => "second finger",
            () => "figures of the cloth",
        }
    }
}

/// What leads the fingers.
#[derive(Debug, Clone)]
pub(crate) enum Lead {
    /// Towards where hands are now.
    Towards(Vec<Hand>),
    /// Along a path, from its start.
    Along(Arc<HandPath>),
}

/// What the window asks for.
#[derive(Debug, Clone)]
pub(crate) struct Ask {
    pub(crate) wanted: Arc<Chosen>,
    pub(crate) lead: Lead,
    /// How much time is to pass in the scene, s.
    pub(crate) for_s: f64,
    /// How often all was hung anew: another number begins at rest.
    pub(crate) n_restarts: u64,
}

/// What is known of a cloth as long as the same one hangs.
#[derive(Debug, Clone)]
pub(crate) struct ClothFacts {
    /// As it hangs, and as it was before figures were changed.
    pub(crate) scene: DrapeScene,
    pub(crate) unchanged: DrapeScene,
    pub(crate) title: String,
    /// What scenes call its textile.
    pub(crate) key: Option<String>,
    /// How it is stepped: method, step, why.
    pub(crate) stepping: String,
    /// Whether fingers touch it: else no force is told.
    pub(crate) has_touch: bool,
    /// Why its contactors are silent, if it has no surface.
    pub(crate) silent: Option<String>,
}

/// What is known as long as the same cloths hang.
#[derive(Debug, Default)]
pub(crate) struct Facts {
    pub(crate) cloths: Vec<ClothFacts>,
    /// Where hands start.
    pub(crate) hands: Vec<Hand>,
    /// Why what is wanted does not hang, in a line.
    pub(crate) refused: Option<String>,
}

/// A cloth at an instant.
#[derive(Debug, Clone)]
pub(crate) struct ClothFrame {
    /// Vertices along warp and weft.
    pub(crate) grid: [usize; 2],
    pub(crate) size_mm: [f64; 2],
    /// Row by row along the warp, mm.
    pub(crate) places_mm: Vec<[f32; 3]>,
    pub(crate) pads: Vec<Pad>,
    pub(crate) fingers: Vec<FingerRow>,
    /// Steps in which a yarn was stretched beyond what was measured.
    pub(crate) n_overstretched: u64,
    /// What each contactor of each finger is given, µm; `None` where it touches nothing.
    pub(crate) amplitudes_um: Vec<[Option<[f64; 2]>; 24]>,
}

/// An instant.
#[derive(Debug, Clone)]
pub(crate) struct Frame {
    pub(crate) t_s: f64,
    pub(crate) hands: Vec<Hand>,
    pub(crate) cloths: Vec<ClothFrame>,
}

/// A step: what the command writes of it, cloth by cloth and finger by finger.
#[derive(Debug, Clone)]
pub(crate) struct Sample {
    pub(crate) t_s: f64,
    pub(crate) rows: Vec<[f64; 9]>,
}

impl ClothFrame {
    /// Mean amplitudes of a finger in both bands, µm; what touches nothing counts as silent.
    pub(crate) fn mean_um(&self, finger: usize) -> [f64; 2] {
        let contactors = self.amplitudes_um.get(finger).into_iter().flatten();
        let sum = contactors
            .flatten()
            .fold([0.0; 2], |sum, felt| [sum[0] + felt[0], sum[1] + felt[1]]);
        sum.map(|sum| sum / 24.0)
    }

    /// Strain at each vertex: that of the cloth beside it which is stretched or pressed most.
    pub(crate) fn strains(&self) -> Vec<f32> {
        let [n_warp, n_weft] = self.grid;
        let rest_mm = [0, 1].map(|axis| {
            let cells = (self.grid[axis] - 1).max(1) as f64;
            selvedge_foundation::numerics::to_single(self.size_mm[axis] / cells)
        });
        let mut strains = vec![0.0_f32; self.places_mm.len()];
        let mut edge = |a: usize, b: usize, rest_mm: f32| {
            let [p, q] = [a, b].map(|vertex| self.places_mm[vertex]);
            let off = [0, 1, 2].map(|axis| q[axis] - p[axis]);
            let length_mm = off.iter().map(|x| x * x).sum::<f32>().sqrt();
            let strain = length_mm / rest_mm - 1.0;
            for vertex in [a, b] {
                if strain.abs() > strains[vertex].abs() {
                    strains[vertex] = strain;
                }
            }
        };
        for row in 0..n_weft {
            for column in 0..n_warp {
                let vertex = row * n_warp + column;
                if column + 1 < n_warp {
                    edge(vertex, vertex + 1, rest_mm[0]);
                }
                if row + 1 < n_weft {
                    edge(vertex, vertex + n_warp, rest_mm[1]);
                }
            }
        }
        strains
    }
}
