//! The textiles as a tip meets them: prepared in the background, kept while the tip is the same.

use std::sync::Arc;

use crate::bench::Bench;
use crate::bench::latest::{Computed, Latest};
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_render::contact::{Contact, FeltSurface, Tip};
use selvedge_textile::Textile;

/// So many prepared textiles are kept at least.
const MOST: usize = 8;

/// A textile and a radius of the tip, mm.
#[derive(Debug, Clone)]
pub(crate) struct GroundKey {
    pub(crate) textile: Arc<Textile>,
    pub(crate) radius_mm: f64,
}

impl PartialEq for GroundKey {
    fn eq(&self, other: &Self) -> bool {
        let is_same_tip = self.radius_mm.to_bits() == other.radius_mm.to_bits();
        Arc::ptr_eq(&self.textile, &other.textile) && is_same_tip
    }
}

/// A tip on a textile, and the textile's own heights.
#[derive(Debug)]
pub(crate) struct Ground {
    pub(crate) felt: FeltSurface,
    pub(crate) contact: Contact,
}

/// What came of preparing it, or why not.
#[derive(Debug)]
pub(crate) struct Prepared(pub(crate) Result<Arc<Ground>, String>);

impl Computed<GroundKey> for Prepared {
    const THREAD: &str = "selvedge-stylus";

    fn compute(
        key: &GroundKey,
        prior: Option<(&GroundKey, &Self)>,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let tip = Tip::stylus(key.radius_mm);
        progress.step(0.0, "reading the relief")?;
        let same = prior.filter(|(before, _)| Arc::ptr_eq(&before.textile, &key.textile));
        let relief = same.and_then(|(_, prior)| Some(prior.0.as_ref().ok()?.felt.relief.clone()));
        let felt = match relief {
            Some(relief) => FeltSurface::on_relief(&key.textile, &tip, relief),
            None => FeltSurface::of_textile(&key.textile, &tip),
        };
        progress.step(0.5, "rolling the tip over it")?;
        let ground = felt.map_err(|error| error.to_string()).and_then(|felt| {
            let contact = felt.contact(tip).map_err(|error| error.to_string())?;
            Ok(Arc::new(Ground { felt, contact }))
        });
        Ok(Self(ground))
    }

    fn broken(_: &GroundKey, why: &str) -> Self {
        Self(Err(why.to_owned()))
    }

    fn serves(under_way: &GroundKey, now: &GroundKey) -> bool {
        under_way.radius_mm.to_bits() == now.radius_mm.to_bits()
    }
}

/// Those that are prepared, and the one that is being.
#[derive(Debug, Default)]
pub(crate) struct Grounds {
    kept: Vec<(GroundKey, Arc<Prepared>)>,
    /// How many are wanted at once.
    n_wanted: usize,
    preparing: Latest<GroundKey, Prepared>,
}

impl Grounds {
    /// Preparations begun so far.
    pub(crate) fn n_begun(&self) -> u64 {
        self.preparing.n_begun()
    }

    /// Keeps so many at once, if that is more than usual.
    pub(crate) fn make_room_for(&mut self, n_wanted: usize) {
        self.n_wanted = n_wanted;
    }

    /// One that is prepared.
    pub(crate) fn get(&self, key: &GroundKey) -> Option<&Prepared> {
        let kept = self.kept.iter().find(|(kept, _)| kept == key);
        kept.map(|(_, prepared)| &**prepared)
    }

    /// Has one prepared, after what is under way.
    pub(crate) fn follow(&mut self, bench: &Bench, key: &GroundKey) {
        self.preparing.poll();
        self.keep();
        if self.get(key).is_none() {
            self.preparing.follow(&bench.ctx, &bench.executor, key);
            self.keep();
        }
    }

    /// Keeps what was prepared last.
    fn keep(&mut self) {
        let found = self.preparing.key().zip(self.preparing.value());
        let Some((key, prepared)) = found.filter(|(key, _)| self.get(key).is_none()) else {
            return;
        };
        self.kept.push((key.clone(), Arc::clone(prepared)));
        let n_old = self.kept.len().saturating_sub(self.n_wanted.max(MOST));
        self.kept.drain(..n_old);
    }
}
