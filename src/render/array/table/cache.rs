//! Tables kept from one preparation to the next, so that a scene that is edited is ready at once.
//!
//! Moving, turning or tuning a textile changes nothing that its tables are made from. A table is
//! found again by all that it depends on: the very spectra (the cache holds on to them, so no
//! others can ever take their place in memory), the unit of its powers, the filters and the nodes.
//! What is found is what would be computed, bit for bit.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::build::{NodeGains, tables_of};
use super::grid::{Density, Grid};
use super::segments::Segments;
use super::stored::{Table, units_um2};
use super::touched::MAX_TABLE_BYTES;
use crate::plan::ScenePlan;
#[cfg(test)]
use crate::{
    RenderScene,
    array::{Accuracy, Method, auto},
};
use selvedge_textile::surface::LocalSpectra;
use selvedge_textile::tactile::Filters;

/// Filters and budgets whose nodes are kept.
const MAX_GRIDS: usize = 8;

/// Filters as a key: the bits of their width, or none for those of the receptors.
type FiltersKey = Option<u64>;
/// All that a table depends on besides its spectra: unit, filters, nodes an octave.
type TableKey = (u64, FiltersKey, u32);

/// Tables of scenes prepared before. A clone shares them, so that it may be filled by another
/// thread.
#[derive(Debug, Clone)]
pub struct TableCache {
    /// By place in memory.
    spectra: BTreeMap<usize, OfSpectra>,
    /// Newest last.
    grids: Vec<((FiltersKey, u64), Grid)>,
    /// For the tables of areal spectra; newest last.
    gains: Vec<((FiltersKey, u32), Arc<NodeGains>)>,
    preparation: u64,
    max_bytes: usize,
}

/// What is known of one set of spectra.
#[derive(Debug, Clone)]
struct OfSpectra {
    /// Held, so that nothing else is ever found at its place.
    spectra: Arc<LocalSpectra>,
    /// The largest power of any of its points, µm².
    largest_um2: f64,
    tables: Vec<(TableKey, Kept)>,
    /// The last preparation that used it.
    last_use: u64,
}

/// A table, and the last preparation that used it.
#[derive(Debug, Clone)]
struct Kept {
    table: Arc<Table>,
    last_use: u64,
}

impl Default for TableCache {
    /// An empty one that keeps as much as one scene may take.
    fn default() -> Self {
        Self::with_limit(MAX_TABLE_BYTES)
    }
}

impl TableCache {
    /// An empty cache. Once it holds more than so many bytes, it forgets what the newest scene does
    /// not use.
    pub(crate) fn with_limit(max_bytes: usize) -> Self {
        Self {
            spectra: BTreeMap::new(),
            grids: Vec::new(),
            gains: Vec::new(),
            preparation: 0,
            max_bytes,
        }
    }

    /// Bytes of tables and of spectra that are held.
    pub fn n_bytes(&self) -> usize {
        self.spectra.values().map(OfSpectra::n_bytes).sum()
    }

    /// Whether preparing this scene would compute no table: it is a matter of microseconds then.
    #[cfg(test)]
    pub(crate) fn has_all(&self, scene: &RenderScene, method: Method, accuracy: &Accuracy) -> bool {
        if !method.may_tabulate() {
            return true;
        }
        let Some(grid) = self.known_grid(&scene.filters, accuracy.budget_db) else {
            return false;
        };
        let plan = ScenePlan::of(scene);
        if auto::resolve(scene, &plan, (method, accuracy), Some(grid)) != Method::Table {
            return true;
        }
        let own: Option<Vec<f64>> = plan.pool.iter().map(|s| self.known_largest(s)).collect();
        let Some(own) = own else {
            return false;
        };
        let units = units_um2(&plan, &own);
        let has = |(spectra, unit_um2): (&Arc<LocalSpectra>, &f64)| {
            let key = table_key(*unit_um2, &scene.filters, grid);
            if spectra.is_areal() {
                self.known_gains(&scene.filters, grid).is_some()
            } else {
                self.known_table(spectra, key).is_some()
            }
        };
        plan.pool.iter().zip(&units).all(has)
    }

    /// The nodes of tables for these filters within this budget.
    pub(crate) fn grid(&mut self, filters: &Filters, budget_db: f64) -> Grid {
        if let Some(grid) = self.known_grid(filters, budget_db) {
            return grid.clone();
        }
        let density = Density::within(filters, budget_db);
        let alike = |(_, grid): &&(_, Grid)| grid.density.per_octave == density.per_octave;
        let segments = match self.grids.iter().find(alike) {
            Some((_, grid)) => Arc::clone(&grid.segments),
            None => Arc::new(Segments::new(density.per_octave)),
        };
        let grid = Grid { density, segments };
        if self.grids.len() == MAX_GRIDS {
            self.grids.remove(0);
        }
        self.grids
            .push((grid_key(filters, budget_db), grid.clone()));
        grid
    }

    /// The gains that nodes of areal tables are made with.
    pub(super) fn node_gains(&mut self, filters: &Filters, grid: &Grid) -> Arc<NodeGains> {
        if let Some(known) = self.known_gains(filters, grid) {
            return Arc::clone(known);
        }
        let gains = Arc::new(NodeGains::new(grid.segments.nodes(), filters));
        if self.gains.len() == MAX_GRIDS {
            self.gains.remove(0);
        }
        let key = (filters_key(filters), grid.density.per_octave);
        self.gains.push((key, Arc::clone(&gains)));
        gains
    }

    fn known_gains(&self, filters: &Filters, grid: &Grid) -> Option<&Arc<NodeGains>> {
        let key = (filters_key(filters), grid.density.per_octave);
        let found = self.gains.iter().find(|(known, _)| *known == key);
        found.map(|(_, gains)| gains)
    }

    /// The tables of all spectra of a plan and the units that their powers are stored in, µm²;
    /// those that are missing are computed; those of areal spectra are empty. Forgets what it has
    /// no room for.
    pub(super) fn tables(
        &mut self,
        plan: &ScenePlan,
        filters: &Filters,
        grid: &Grid,
    ) -> (Vec<Arc<Table>>, Vec<f64>) {
        self.preparation += 1;
        let own: Vec<f64> = plan.pool.iter().map(|s| self.largest_um2(s)).collect();
        let units = units_um2(plan, &own);
        let key_of = |unit_um2: f64| table_key(unit_um2, filters, grid);
        let missing: Vec<(&Arc<LocalSpectra>, f64)> = plan
            .pool
            .iter()
            .zip(units.iter().copied())
            .filter(|(spectra, _)| !spectra.is_areal())
            .filter(|(spectra, unit_um2)| self.known_table(spectra, key_of(*unit_um2)).is_none())
            .collect();
        let made: Vec<(&LocalSpectra, f64)> = missing.iter().map(|(s, u)| (&***s, *u)).collect();
        let made = tables_of(grid.segments.nodes(), &made, filters);
        for ((spectra, unit_um2), powers) in missing.into_iter().zip(made) {
            let n_points = spectra.n_points();
            let table = Arc::new(Table { n_points, powers });
            self.keep(spectra, key_of(unit_um2), table);
        }
        let found = plan.pool.iter().zip(&units);
        let none = Arc::new(Table {
            n_points: 0,
            powers: Vec::new(),
        });
        let tables = found.filter_map(|(s, unit_um2)| {
            if s.is_areal() {
                return Some(Arc::clone(&none));
            }
            self.used_table(s, key_of(*unit_um2))
        });
        let tables = tables.collect();
        self.forget();
        (tables, units)
    }

    fn known_grid(&self, filters: &Filters, budget_db: f64) -> Option<&Grid> {
        let key = grid_key(filters, budget_db);
        let found = self.grids.iter().find(|(known, _)| *known == key);
        found.map(|(_, grid)| grid)
    }

    #[cfg(test)]
    fn known_largest(&self, spectra: &Arc<LocalSpectra>) -> Option<f64> {
        let known = self.spectra.get(&place_of(spectra));
        known.map(|known| known.largest_um2)
    }

    fn known_table(&self, spectra: &Arc<LocalSpectra>, key: TableKey) -> Option<&Kept> {
        let tables = &self.spectra.get(&place_of(spectra))?.tables;
        let found = tables.iter().find(|(known, _)| *known == key);
        found.map(|(_, kept)| kept)
    }

    /// The largest power of any point, µm²; the spectra are held from now on.
    fn largest_um2(&mut self, spectra: &Arc<LocalSpectra>) -> f64 {
        let known = self.spectra.entry(place_of(spectra));
        let known = known.or_insert_with(|| OfSpectra {
            spectra: Arc::clone(spectra),
            largest_um2: largest_um2(spectra),
            tables: Vec::new(),
            last_use: 0,
        });
        known.last_use = self.preparation;
        known.largest_um2
    }

    fn keep(&mut self, spectra: &Arc<LocalSpectra>, key: TableKey, table: Arc<Table>) {
        if let Some(known) = self.spectra.get_mut(&place_of(spectra)) {
            let last_use = self.preparation;
            known.tables.push((key, Kept { table, last_use }));
        }
    }

    fn used_table(&mut self, spectra: &Arc<LocalSpectra>, key: TableKey) -> Option<Arc<Table>> {
        let tables = &mut self.spectra.get_mut(&place_of(spectra))?.tables;
        let (_, kept) = tables.iter_mut().find(|(known, _)| *known == key)?;
        kept.last_use = self.preparation;
        Some(Arc::clone(&kept.table))
    }

    /// Drops what the last preparation did not use, if there is too much.
    fn forget(&mut self) {
        if self.n_bytes() <= self.max_bytes {
            return;
        }
        let newest = self.preparation;
        self.spectra.retain(|_, known| known.last_use == newest);
        for known in self.spectra.values_mut() {
            known.tables.retain(|(_, kept)| kept.last_use == newest);
        }
    }
}

impl OfSpectra {
    fn n_bytes(&self) -> usize {
        let n_tabulated: usize = self
            .tables
            .iter()
            .map(|(_, kept)| kept.table.n_bytes())
            .sum();
        n_tabulated + self.spectra.n_bytes()
    }
}

fn place_of(spectra: &Arc<LocalSpectra>) -> usize {
    Arc::as_ptr(spectra).addr()
}

fn filters_key(filters: &Filters) -> FiltersKey {
    match filters {
        Filters::LogGaussian { octaves } => Some(octaves.to_bits()),
        Filters::Receptor => None,
    }
}

fn grid_key(filters: &Filters, budget_db: f64) -> (FiltersKey, u64) {
    (filters_key(filters), budget_db.to_bits())
}

fn table_key(unit_um2: f64, filters: &Filters, grid: &Grid) -> TableKey {
    (
        unit_um2.to_bits(),
        filters_key(filters),
        grid.density.per_octave,
    )
}

/// The largest power of any point, µm².
fn largest_um2(spectra: &LocalSpectra) -> f64 {
    (0..spectra.n_points())
        .map(|point| spectra.powers_um2(point).iter().sum())
        .fold(0.0, f64::max)
}
