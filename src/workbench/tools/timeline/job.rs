//! Tiles of a whole recording, made in the background: those in sight first, then outward.
//!
//! What a tile holds depends on path and scene alone, not on the order in which they are made.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use crate::bench::background::{Executor, Task, finished};
use crate::bench::recording::tiles::{TILE, Tile, Tiles};
use crate::tools::timeline::columns::TickColumns;
use selvedge_foundation::progress::Progress;
use selvedge_render::scene::{ExplorationPath, PathCursor};

/// What makes columns, made itself where they are.
pub(crate) type MakeColumns = Box<dyn FnOnce() -> Result<Box<dyn TickColumns>, String> + Send>;

/// Tiles on their way.
pub(crate) struct Job {
    task: Option<Task<()>>,
    made: Arc<Mutex<Vec<(u64, Tile)>>>,
    /// The tile in the middle of what is in sight.
    focus: Arc<AtomicU64>,
}

impl Job {
    /// Begins to make every tile of a path, beginning around the tile `focus`.
    pub(crate) fn start(
        executor: &Executor,
        (path, ticks_per_column): (Arc<ExplorationPath>, u64),
        focus: u64,
        make: MakeColumns,
    ) -> Self {
        let made = Arc::new(Mutex::new(Vec::new()));
        let focus = Arc::new(AtomicU64::new(focus));
        let (to, around) = (Arc::clone(&made), Arc::clone(&focus));
        let task = executor.start("selvedge-timeline", move |progress| {
            let mut columns = make()?;
            let mut work = Work {
                path: &path,
                ticks_per_tile: ticks_per_column * TILE,
                columns: &mut *columns,
            };
            let put = |nth, tile| {
                let mut made = to.lock().unwrap_or_else(PoisonError::into_inner);
                made.push((nth, tile));
            };
            work.all(&around, put, progress)
        });
        Self {
            task: Some(task),
            made,
            focus,
        }
    }

    /// What is in sight is around this tile now.
    pub(crate) fn look_at(&self, tile: u64) {
        self.focus.store(tile, Ordering::Relaxed);
    }

    /// Takes the tiles that are made. Whether the job goes on, or why it failed.
    pub(crate) fn take_into(&mut self, tiles: &mut Tiles) -> Result<bool, String> {
        let outcome = finished(&mut self.task);
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        for (nth, tile) in made.drain(..) {
            tiles.install(nth, tile);
        }
        match outcome {
            Some(Err(why)) => Err(why),
            _ => Ok(self.task.is_some()),
        }
    }

    /// How far it is, 0…1.
    pub(crate) fn share(&self) -> f32 {
        self.task.as_ref().map_or(1.0, Task::share)
    }
}

impl Drop for Job {
    fn drop(&mut self) {
        if let Some(task) = &self.task {
            task.stop();
        }
    }
}

/// The work of a job.
struct Work<'a> {
    path: &'a ExplorationPath,
    ticks_per_tile: u64,
    columns: &'a mut dyn TickColumns,
}

impl Work<'_> {
    fn all(
        &mut self,
        focus: &AtomicU64,
        mut put: impl FnMut(u64, Tile),
        progress: &mut Progress<'_>,
    ) -> Result<(), String> {
        let n_tiles = self.path.n_ticks().div_ceil(self.ticks_per_tile);
        let mut left: Vec<u64> = (0..n_tiles).collect();
        while let Some(place) = nearest(&left, focus.load(Ordering::Relaxed)) {
            let nth = left.remove(place);
            put(nth, self.tile(nth));
            let share = 1.0 - left.len() as f64 / n_tiles as f64;
            let went_on = progress.step(share, "rendering");
            went_on.map_err(|_stopped| "stopped".to_owned())?;
        }
        Ok(())
    }

    fn tile(&mut self, nth: u64) -> Tile {
        let mut rows = vec![0; self.columns.n_rows()];
        let mut tile = Tile::new(rows.len());
        let first = nth * self.ticks_per_tile;
        let mut cursor = PathCursor::at(self.path, first);
        for within in 0..self.ticks_per_tile {
            let Some((tick, pose)) = cursor.step(self.path) else {
                break;
            };
            self.columns.write(self.path, (tick, &pose), &mut rows);
            let column = within * TILE / self.ticks_per_tile;
            tile.put(usize::try_from(column).unwrap_or(0), &rows);
        }
        tile
    }
}

/// Where the tile nearest to `focus` stands among those that are left, which rise; of two the one
/// before it.
fn nearest(left: &[u64], focus: u64) -> Option<usize> {
    let above = left.partition_point(|nth| *nth <= focus);
    let below = above.checked_sub(1);
    match (below, left.get(above)) {
        (Some(below), Some(above_nth)) if above_nth - focus < focus - left[below] => Some(above),
        (Some(below), _) => Some(below),
        (None, above_nth) => above_nth.map(|_| above),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::progress::Progress;
    use selvedge_render::scene::{PathRow, Pose};

    /// Writes the number of the tick.
    struct Counted;

    impl TickColumns for Counted {
        fn n_rows(&self) -> usize {
            1
        }

        fn write(&mut self, _: &ExplorationPath, (tick, _): (u64, &Pose), rows: &mut [u8]) {
            rows[0] = u8::try_from(tick % 255 + 1).unwrap();
        }
    }

    fn path(n_ticks: u64) -> ExplorationPath {
        let row = |t_s| PathRow {
            t_s,
            ..PathRow::default()
        };
        ExplorationPath::new(vec![row(0.0), row((n_ticks - 1) as f64 / 40.0)]).unwrap()
    }

    fn order(n_ticks: u64, focus: u64) -> (Vec<u64>, Tiles) {
        let path = path(n_ticks);
        let mut tiles = Tiles::new(1, n_ticks);
        let mut work = Work {
            path: &path,
            ticks_per_tile: TILE,
            columns: &mut Counted,
        };
        let (focus, mut order) = (AtomicU64::new(focus), Vec::new());
        let put = |nth, tile| {
            order.push(nth);
            tiles.install(nth, tile);
        };
        Progress::unheard(|progress| work.all(&focus, put, progress)).unwrap();
        (order, tiles)
    }

    #[test]
    fn what_is_in_sight_is_made_first_and_then_outward() {
        assert_eq!(order(7 * TILE, 4).0, [4, 3, 5, 2, 6, 1, 0]);
        assert_eq!(order(3 * TILE + 1, 99).0, [3, 2, 1, 0]);
    }

    #[test]
    fn every_tick_is_made_and_the_order_changes_nothing() {
        let n_ticks = 2 * TILE + 77;
        let tiles = order(n_ticks, 0).1;
        let other = order(n_ticks, 2).1;
        for tick in 0..n_ticks + 3 {
            let mut rows = [[0_u8; 1]; 2];
            tiles.strongest_into(tick..tick + 1, &mut rows[0]);
            other.strongest_into(tick..tick + 1, &mut rows[1]);
            let expected = if tick < n_ticks { tick % 255 + 1 } else { 0 };
            assert_eq!(rows.map(|[byte]| u64::from(byte)), [expected; 2], "{tick}");
        }
    }

    #[test]
    fn the_nearest_is_found_among_those_that_are_left() {
        assert_eq!(nearest(&[], 3), None);
        assert_eq!(nearest(&[1, 5, 9], 4), Some(1));
        assert_eq!(nearest(&[1, 5, 9], 3), Some(0), "of two the one before");
        assert_eq!(nearest(&[5, 9], 0), Some(0));
        assert_eq!(nearest(&[1, 5], 8), Some(1));
    }
}
