//! What is drawn over time, as rows of bytes: one column for every tick, in tiles that each hold
//! themselves ever coarser.
//!
//! A byte is the larger the stronger something was, and 0 where nothing is known. Coarser columns
//! hold the largest byte of those they stand for, so that no peak is lost, and any span is read
//! exactly in a few steps however long it is. Four hours of 24 contactors take 44 MB.

use std::array;
use std::collections::VecDeque;
use std::ops::Range;
use std::sync::Arc;

/// Columns of a tile.
pub(crate) const TILE: u64 = 1024;
/// What a tile holds: columns of 1, 4, 16, 64, 256 and 1024.
const N_LEVELS: usize = 6;
/// Most columns: those of the longest recording. A longer path has several ticks in each.
const MOST_COLUMNS: u64 = 4 * 3600 * 40;

/// Columns side by side, and the same ever coarser.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Tile {
    /// Bytes in a column.
    n_rows: usize,
    levels: [Vec<u8>; N_LEVELS],
}

impl Tile {
    /// A tile in which nothing is known.
    pub(crate) fn new(n_rows: usize) -> Self {
        let n_columns = |level: usize| usize::try_from(TILE >> (2 * level)).unwrap_or(0);
        Self {
            n_rows,
            levels: array::from_fn(|level| vec![0; n_columns(level) * n_rows]),
        }
    }

    /// Adds rows to a column of the tile: of each the larger byte stays.
    pub(crate) fn put(&mut self, column: usize, rows: &[u8]) {
        for (level, bytes) in self.levels.iter_mut().enumerate() {
            let first = (column >> (2 * level)) * self.n_rows;
            raise(&mut bytes[first..first + self.n_rows], rows);
        }
    }

    fn rows(&self, level: usize, column: usize) -> &[u8] {
        let first = (column >> (2 * level)) * self.n_rows;
        &self.levels[level][first..first + self.n_rows]
    }
}

fn raise(bytes: &mut [u8], by: &[u8]) {
    for (byte, by) in bytes.iter_mut().zip(by) {
        *byte = (*byte).max(*by);
    }
}

/// Tiles one after the other, as far as they are there.
#[derive(Debug, Clone, Default)]
pub(crate) struct Tiles {
    /// Bytes in a column.
    pub(crate) n_rows: usize,
    ticks_per_column: u64,
    /// The number of the first tile that is held.
    first: u64,
    held: VecDeque<Option<Arc<Tile>>>,
    /// Changes whenever anything in it does.
    pub(crate) version: u64,
}

impl Tiles {
    /// None yet, for an exploration of so many ticks; 0 for one that goes on.
    pub(crate) fn new(n_rows: usize, n_ticks: u64) -> Self {
        let ticks_per_column = n_ticks.div_ceil(MOST_COLUMNS).max(1);
        let n_tiles = n_ticks.div_ceil(ticks_per_column * TILE);
        Self {
            n_rows,
            ticks_per_column,
            held: (0..n_tiles).map(|_| None).collect(),
            ..Self::default()
        }
    }

    /// Ticks that a column stands for: 1 in all but the longest paths.
    pub(crate) fn ticks_per_column(&self) -> u64 {
        self.ticks_per_column.max(1)
    }

    /// Takes in a tile that was made elsewhere.
    pub(crate) fn install(&mut self, nth: u64, tile: Tile) {
        if let Some(slot) = self.slot(nth) {
            *slot = Some(Arc::new(tile));
        }
    }

    /// Adds rows to the column of a tick.
    pub(crate) fn put(&mut self, tick: u64, rows: &[u8]) {
        let (column, n_rows) = (tick / self.ticks_per_column(), self.n_rows);
        let in_tile = usize::try_from(column % TILE).unwrap_or(0);
        if let Some(slot) = self.slot(column / TILE) {
            let tile = slot.get_or_insert_with(|| Arc::new(Tile::new(n_rows)));
            Arc::make_mut(tile).put(in_tile, rows);
        }
    }

    /// Lets go of tiles that end before a tick.
    pub(crate) fn forget_before(&mut self, tick: u64) {
        let keep = tick / self.ticks_per_column() / TILE;
        while self.first < keep && self.held.pop_front().is_some() {
            self.first += 1;
        }
    }

    /// Of each row the largest byte in these ticks.
    pub(crate) fn strongest_into(&self, ticks: Range<u64>, rows: &mut [u8]) {
        rows.fill(0);
        let each = self.ticks_per_column();
        let (mut column, end) = (ticks.start / each, ticks.end.div_ceil(each));
        while column < end {
            let tile = self.tile(column / TILE);
            let Some(tile) = tile else {
                column = (column / TILE + 1) * TILE;
                continue;
            };
            let fits = |level: &usize| {
                let n_columns = 1_u64 << (2 * level);
                column.is_multiple_of(n_columns) && column + n_columns <= end
            };
            let level = (1..N_LEVELS).take_while(fits).last().unwrap_or(0);
            let in_tile = usize::try_from(column % TILE).unwrap_or(0);
            raise(rows, tile.rows(level, in_tile));
            column += 1 << (2 * level);
        }
    }

    fn tile(&self, nth: u64) -> Option<&Tile> {
        let place = usize::try_from(nth.checked_sub(self.first)?).ok()?;
        self.held.get(place)?.as_deref()
    }

    /// Where a tile lies.
    fn slot(&mut self, nth: u64) -> Option<&mut Option<Arc<Tile>>> {
        if self.held.is_empty() {
            self.first = nth;
        }
        while nth < self.first {
            self.held.push_front(None);
            self.first -= 1;
        }
        let place = usize::try_from(nth.checked_sub(self.first)?).ok()?;
        self.version += 1;
        if self.held.len() <= place {
            self.held.resize(place + 1, None);
        }
        self.held.get_mut(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::numerics::Random;

    const N_TICKS: u64 = 5_000;

    fn made() -> (Tiles, Vec<[u8; 3]>) {
        let mut random = Random::new(7);
        let byte = |random: &mut Random| u8::try_from(random.index(200)).unwrap();
        let rows: Vec<[u8; 3]> = (0..N_TICKS)
            .map(|_| [byte(&mut random), byte(&mut random), byte(&mut random)])
            .collect();
        let mut tiles = Tiles::new(3, N_TICKS);
        for (tick, rows) in (0..).zip(&rows) {
            tiles.put(tick, rows);
        }
        (tiles, rows)
    }

    fn largest(rows: &[[u8; 3]]) -> [u8; 3] {
        let larger = |a: [u8; 3], b: &[u8; 3]| array::from_fn(|row| a[row].max(b[row]));
        rows.iter().fold([0; 3], larger)
    }

    #[test]
    fn every_span_is_read_as_its_ticks_one_by_one() {
        let (tiles, rows) = made();
        for start in (0..N_TICKS).step_by(97) {
            for length in [0, 1, 3, 4, 17, 255, 1_024, 1_500, 4_999] {
                let end = (start + length).min(N_TICKS);
                let mut read = [9; 3];
                tiles.strongest_into(start..end, &mut read);
                let ticks = usize::try_from(start).unwrap()..usize::try_from(end).unwrap();
                assert_eq!(read, largest(&rows[ticks]), "{start}..{end}");
            }
        }
    }

    #[test]
    fn what_is_not_there_is_a_gap_and_not_silence() {
        let mut tiles = Tiles::new(2, 9_000);
        let mut tile = Tile::new(2);
        tile.put(3, &[5, 1]);
        tiles.install(4, tile);
        let read = |tiles: &Tiles, ticks| {
            let mut rows = [7; 2];
            tiles.strongest_into(ticks, &mut rows);
            rows
        };
        assert_eq!(read(&tiles, 0..9_000), [5, 1]);
        assert_eq!(read(&tiles, 0..4_000), [0, 0]);
        assert_eq!(read(&tiles, 4_099..4_100), [5, 1]);
        assert_eq!(read(&tiles, 4_100..9_000), [0, 0]);
        let before = tiles.version;
        tiles.forget_before(5_200);
        assert_eq!(read(&tiles, 0..9_000), [0, 0]);
        tiles.put(4_000, &[1, 1]);
        assert_eq!(
            read(&tiles, 0..9_000),
            [1, 1],
            "there is room before it again"
        );
        assert_ne!(tiles.version, before);
    }

    #[test]
    fn a_path_of_days_has_no_more_columns_than_four_hours() {
        let n_ticks = 40_000_000;
        let mut tiles = Tiles::new(1, n_ticks);
        let each = tiles.ticks_per_column();
        assert!(n_ticks / each <= MOST_COLUMNS);
        tiles.put(39_999_999, &[8]);
        let mut rows = [0];
        tiles.strongest_into(n_ticks - 1..n_ticks, &mut rows);
        assert_eq!(rows, [8]);
    }
}
