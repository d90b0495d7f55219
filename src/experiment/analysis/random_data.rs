//! The stress of maps of random ranks, which the stress of a map has to lie below.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_statistics::mds::{Dissimilarities, Map, Mds, Null, NullKind};

/// What was found of random ranks before; clones share it. It depends on the number of objects,
/// the pairs that are missing, dimensions and loss, never on the answers: ranks at random have no
/// ties.
#[derive(Debug, Clone, Default)]
pub struct RandomData(Arc<Mutex<BTreeMap<Asked, Null>>>);

#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Asked {
    n_objects: usize,
    pairs: Vec<[usize; 2]>,
    loss: &'static str,
    dims: usize,
    n_sets: usize,
    starts: [usize; 3],
    seed: u64,
}

impl RandomData {
    /// How many sizes are known.
    #[cfg(test)]
    pub(super) fn n_kept(&self) -> usize {
        self.0.lock().map_or(0, |all| all.len())
    }

    /// Losses of so many sets of random ranks, for each map.
    ///
    /// # Errors
    /// It was cancelled.
    pub(super) fn of(
        &self,
        maps: &[Map],
        (mds, data): (&Mds, &Dissimilarities),
        n_sets: usize,
        progress: &mut Progress<'_>,
    ) -> Result<Vec<Null>, Cancelled> {
        if n_sets == 0 {
            return Ok(Vec::new());
        }
        let mds = mds.for_chance();
        let mut all = Vec::with_capacity(maps.len());
        for map in maps {
            let asked = Asked {
                n_objects: data.n_objects(),
                pairs: data.pairs().iter().map(|pair| pair.objects).collect(),
                loss: mds.loss.name(),
                dims: map.dims,
                n_sets,
                starts: [mds.n_starts, mds.n_starts_on_a_line, mds.n_exchanged],
                seed: mds.seed,
            };
            let known = self.0.lock().ok().and_then(|all| all.get(&asked).cloned());
            if let Some(null) = known {
                all.push(null);
                continue;
            }
            let sets = (map.dims, n_sets);
            let null = Null::of(&mds, data, NullKind::RandomRanks, sets, progress)?;
            if let Ok(mut all) = self.0.lock() {
                all.insert(asked, null.clone());
            }
            all.push(null);
        }
        Ok(all)
    }
}
