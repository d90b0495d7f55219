//! Numbers that come tick by tick and are wanted row by row: blocks of ticks, turned round in
//! memory, beside the file that they are for.
//!
//! One block is held; full ones go to a file that is made when the first is full and removed in
//! any case. Every number is written once and read once.

use std::fs::File;
use std::io::{BufWriter, Read as _, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};

use super::SinkError;
use selvedge_foundation::files::Staged;

/// Ticks in a block: 26 s.
const BLOCK_TICKS: usize = 1024;
const NUMBER_BYTES: usize = 4;
/// A row's numbers of a block.
const ROW_BYTES: usize = BLOCK_TICKS * NUMBER_BYTES;

/// Ticks of `n_rows` numbers.
#[derive(Debug)]
pub(super) struct Spool {
    n_rows: usize,
    /// The block that is filled, tick by tick.
    ticks: Vec<f32>,
    place: PathBuf,
    file: Option<(Staged, BufWriter<File>)>,
    n_blocks: u64,
    bytes: Vec<u8>,
}

impl Spool {
    /// A spool beside `path`, in the folder for temporary files where that is no ordinary file.
    pub(super) fn beside(path: &Path, n_rows: usize) -> Self {
        let is_special = path.metadata().is_ok_and(|meta| !meta.is_file());
        let place = if is_special {
            std::env::temp_dir().join("selvedge-ticks")
        } else {
            path.with_added_extension("ticks")
        };
        Self {
            n_rows,
            ticks: Vec::with_capacity(BLOCK_TICKS * n_rows),
            place,
            file: None,
            n_blocks: 0,
            bytes: Vec::new(),
        }
    }

    /// Adds the next number of this tick.
    pub(super) fn push(&mut self, number: f32) {
        self.ticks.push(number);
    }

    /// The tick is whole.
    pub(super) fn end_tick(&mut self) -> Result<(), SinkError> {
        if self.ticks.len() >= BLOCK_TICKS * self.n_rows {
            self.put_away()?;
        }
        Ok(())
    }

    /// Gives `take` a row's numbers of all ticks, and returns the last; 0 without any.
    pub(super) fn visit(
        &mut self,
        row: usize,
        take: &mut dyn FnMut(f32) -> Result<(), SinkError>,
    ) -> Result<f32, SinkError> {
        let mut last = 0.0;
        for block in 0..self.n_blocks {
            self.fetch(block, row)?;
            for bytes in self.bytes.chunks_exact(NUMBER_BYTES) {
                last = bytes.try_into().map_or(0.0, f32::from_le_bytes);
                take(last)?;
            }
        }
        for &number in self.ticks.iter().skip(row).step_by(self.n_rows) {
            last = number;
            take(last)?;
        }
        Ok(last)
    }

    /// Turns the block round and writes it.
    fn put_away(&mut self) -> Result<(), SinkError> {
        self.bytes.resize(self.n_rows * ROW_BYTES, 0);
        for (row, bytes) in self.bytes.chunks_exact_mut(ROW_BYTES).enumerate() {
            let numbers = self.ticks.iter().skip(row).step_by(self.n_rows);
            for (place, number) in bytes.chunks_exact_mut(NUMBER_BYTES).zip(numbers) {
                place.copy_from_slice(&number.to_le_bytes());
            }
        }
        self.ticks.clear();
        if self.file.is_none() {
            let staged = Staged::new(&self.place);
            let out = staged.create().map_err(SinkError::place(&self.place))?;
            self.file = Some((staged, out));
        }
        if let Some((_, out)) = &mut self.file {
            let written = out.write_all(&self.bytes).and_then(|()| out.flush());
            written.map_err(SinkError::write(&self.place))?;
        }
        self.n_blocks += 1;
        Ok(())
    }

    /// Reads a row's numbers of a block.
    fn fetch(&mut self, block: u64, row: usize) -> Result<(), SinkError> {
        let at = block * (self.n_rows * ROW_BYTES) as u64 + (row * ROW_BYTES) as u64;
        self.bytes.resize(ROW_BYTES, 0);
        let Some((_, out)) = &mut self.file else {
            return Ok(());
        };
        let mut file = out.get_ref();
        let read = file.seek(SeekFrom::Start(at));
        read.and_then(|_| file.read_exact(&mut self.bytes))
            .map_err(SinkError::write(&self.place))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_scratch::ScratchFolder;

    #[test]
    fn rows_come_back_whole_over_many_blocks_and_nothing_is_left() {
        let folder = ScratchFolder::made("spool");
        let path = folder.join("a.x");
        let mut spool = Spool::beside(&path, 3);
        let n_ticks = 2 * BLOCK_TICKS + 7;
        for tick in 0..n_ticks {
            for row in 0..3 {
                spool.push((10 * tick + row) as f32);
            }
            spool.end_tick().unwrap();
        }
        let kept = spool.ticks.len();
        assert_eq!((kept, spool.n_blocks), (21, 2), "memory holds one block");
        for row in 0..3 {
            let mut numbers = Vec::new();
            let last = spool.visit(row, &mut |number| {
                numbers.push(number);
                Ok(())
            });
            let expected: Vec<f32> = (0..n_ticks).map(|tick| (10 * tick + row) as f32).collect();
            assert_eq!(numbers, expected);
            assert_eq!(last.unwrap(), expected[n_ticks - 1]);
        }
        let n_files = || folder.read_dir().unwrap().count();
        assert_eq!(n_files(), 1);
        drop(spool);
        assert_eq!(n_files(), 0);
    }
}
