//! The log of `selvedge play`: what every frame that was sent asks the device for.

use std::path::Path;

use super::CliError;
use super::output::TableOut;
use selvedge_device::{ArrayProfile, Coder, LinkScale, SentFrame};
use selvedge_render::scene::Pose;

/// One row a frame.
pub(super) struct PlayLog {
    out: TableOut,
    coder: Coder,
    codes: Vec<[u16; 2]>,
}

impl PlayLog {
    /// A log of frames for `n_contactors` contactors:
    /// `seq,apply_tick,gain,t_s,x_mm,y_mm,a40_um_0,a320_um_0,…,code40_0,code320_0,…`: amplitudes by
    /// contactor, codes by channel.
    pub(super) fn create(
        path: &Path,
        profile: &ArrayProfile,
        n_contactors: usize,
    ) -> Result<Self, CliError> {
        let fixed = ["seq", "apply_tick", "gain", "t_s", "x_mm", "y_mm"].map(str::to_owned);
        let pairs = |low: &str, high: &str| -> Vec<String> {
            (0..n_contactors)
                .flat_map(|i| [format!("{low}_{i}"), format!("{high}_{i}")])
                .collect()
        };
        let amplitudes = pairs("a40_um", "a320_um");
        let codes = pairs("code40", "code320");
        let header: Vec<&str> = fixed
            .iter()
            .chain(&amplitudes)
            .chain(&codes)
            .map(String::as_str)
            .collect();
        Ok(Self {
            out: TableOut::new(Some(path), &header)?,
            coder: Coder::new(profile, n_contactors),
            codes: vec![[0; 2]; n_contactors],
        })
    }

    /// What the device makes of codes.
    pub(super) fn set_link(&mut self, scale: Option<LinkScale>) {
        self.coder.set_link(scale);
    }

    /// Writes the row of a frame: amplitudes in µm after gains, before limits and soft start.
    pub(super) fn frame(
        &mut self,
        sent: &SentFrame,
        pose: &Pose,
        amplitudes_um: &[[f32; 2]],
    ) -> Result<(), CliError> {
        self.coder
            .encode_into(amplitudes_um, sent.gain, &mut self.codes);
        let row = self.out.rows();
        row.number(sent.seq)
            .number(sent.apply_tick)
            .number(sent.gain);
        row.number(pose.t_s)
            .number(pose.position.x_mm)
            .number(pose.position.y_mm);
        for [low, high] in amplitudes_um {
            row.number(low).number(high);
        }
        for [low, high] in &self.codes {
            row.number(low).number(high);
        }
        Ok(row.end_row()?)
    }

    /// The log is whole.
    pub(super) fn finish(self) -> Result<(), CliError> {
        self.out.finish()
    }
}
