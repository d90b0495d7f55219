//! Frames as a table: the drive codes of every contactor at every tick, with the rule that makes
//! amplitudes of them at its head.
//!
//! ```text
//! # array = exeter-24, 6 rows, 4 columns
//! # amplitude = code / 65535 * full scale
//! tick,t_s,code40_0,code320_0,code40_1,…
//! ```
//!
//! With frames that went to a device, `apply_tick` stands behind `t_s`: the device's tick that was
//! asked for, empty where nothing was sent. Codes are those of full soft-start gain, limits held.

use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::Path;

use super::SinkError;
use super::codes::{ArrayProfile, Coder};
use selvedge_foundation::files::{Staged, TableWriter};

/// Ticks a second.
const TICKS_PER_S: f64 = 40.0;

/// A table of frames being written.
#[derive(Debug)]
pub struct FrameTable {
    staged: Staged,
    table: TableWriter<BufWriter<File>>,
    coder: Coder,
    codes: Vec<[u16; 2]>,
    with_apply_tick: bool,
}

impl FrameTable {
    /// A table at `path` of what the array of `profile` is told, `n_contactors` of them;
    /// `with_apply_tick` where frames went to a device.
    pub fn create(
        path: &Path,
        (profile, n_contactors): (&ArrayProfile, usize),
        with_apply_tick: bool,
    ) -> Result<Self, SinkError> {
        let staged = Staged::new(path);
        let mut out = staged.create().map_err(SinkError::place(path))?;
        out.write_all(head(profile).as_bytes())
            .map_err(SinkError::write(path))?;
        let mut header = vec!["tick".to_owned(), "t_s".to_owned()];
        if with_apply_tick {
            header.push("apply_tick".to_owned());
        }
        header.extend(
            (0..n_contactors).flat_map(|n| [format!("code40_{n}"), format!("code320_{n}")]),
        );
        let header: Vec<&str> = header.iter().map(String::as_str).collect();
        Ok(Self {
            table: TableWriter::new(out, path, &header)?,
            staged,
            coder: Coder::new(profile, n_contactors),
            codes: vec![[0; 2]; n_contactors],
            with_apply_tick,
        })
    }

    /// Writes the row of a tick: amplitudes [A40, A320] in µm after gains, before limits.
    pub fn take(
        &mut self,
        tick: u64,
        apply_tick: Option<u32>,
        amplitudes_um: &[[f32; 2]],
    ) -> Result<(), SinkError> {
        self.coder.encode_into(amplitudes_um, 1.0, &mut self.codes);
        let row = &mut self.table;
        row.number(tick).number(tick as f64 / TICKS_PER_S);
        if self.with_apply_tick {
            row.optional(apply_tick);
        }
        for [low, high] in &self.codes {
            row.number(low).number(high);
        }
        Ok(row.end_row()?)
    }

    /// The table is whole: puts it in its place.
    pub fn finish(self) -> Result<(), SinkError> {
        let out = self.table.finish()?;
        Ok(self.staged.finish(out)?)
    }
}

/// What codes mean, as lines that readers of tables pass over.
fn head(profile: &ArrayProfile) -> String {
    let ArrayProfile {
        name,
        rows,
        cols,
        pitch_um,
        ..
    } = profile;
    let [full_40, full_320] = profile.full_scale_um;
    let [limit_40, limit_320] = profile.limit_um;
    let program = selvedge_foundation::PROGRAM;
    format!(
        "# program = {program}\n\
         # array = {name}, {rows} rows, {cols} columns, pitch {pitch_um} um\n\
         # contactors = row by row from the fingertip end, left first, from 0\n\
         # amplitude = code / 65535 * full scale, peak displacement in um\n\
         # full_scale_um = {full_40} at 40 Hz, {full_320} at 320 Hz\n\
         # limit_um = {limit_40} at 40 Hz, {limit_320} at 320 Hz\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_foundation::files::Table;
    use selvedge_scratch::ScratchFolder;

    #[test]
    fn rows_hold_the_codes_of_every_contactor_and_the_head_their_scale() {
        let folder = ScratchFolder::made("frames");
        let path = folder.join("a.csv");
        let profile = ArrayProfile::default();
        let mut frames = FrameTable::create(&path, (&profile, 2), true).unwrap();
        frames
            .take(0, None, &[[50.0, 0.0], [f32::NAN, 25.0]])
            .unwrap();
        frames
            .take(1, Some(77), &[[60.0, 60.0], [0.0, 0.0]])
            .unwrap();
        frames.finish().unwrap();
        let text = folder.read("a.csv");
        assert!(text.contains("# full_scale_um = 50 at 40 Hz"), "{text}");
        let columns = ["tick", "t_s", "apply_tick"];
        let codes = ["code40_0", "code320_0", "code40_1", "code320_1"];
        let table = Table::read(&text, &path, &[&columns[..], &codes].concat(), &[]).unwrap();
        assert_eq!(table.text("apply_tick").unwrap(), ["", "77"]);
        assert_eq!(table.text("t_s").unwrap(), ["0", "0.025"]);
        assert_eq!(table.text("code40_0").unwrap(), ["65535", "32768"]);
        assert_eq!(table.text("code320_0").unwrap(), ["0", "32767"]);
        assert_eq!(table.text("code320_1").unwrap(), ["32768", "0"]);
    }
}
