//! What a tick leaves in the tiles: speed, levels and limits of all contactors, or the spectrum
//! that arrives at one.

use std::ops::Range;

use crate::bench::on_finger::OnFinger;
use crate::bench::recording::Recording;
use crate::bench::signals::contact::ContactColumns;
use crate::bench::signals::rows::{N_ROWS, Rows};
use crate::tools::timeline::code::{
    GAP, SILENT, amplitude_code, finger_code, level_code, mirrored, speed_code,
};
use selvedge_device::Coder;
use selvedge_engine::ApplyTicks;
use selvedge_render::array::{ArrayRenderer, ContactInspector};
use selvedge_render::scene::{ExplorationPath, Pose};
use selvedge_textile::tactile::vibrating_mean_um;

/// Rows before those of the contactors: from the highest to the lowest (mirrored) of speed and of
/// the mean levels of both bands; contactors that a limit bites; ticks that are missing; what the
/// finger got.
pub(crate) const N_LINES: usize = 9;
/// The row of how many contactors a limit bites, after 1.
pub(crate) const LIMITED: usize = 6;
/// The row that tells that ticks are missing before this one.
pub(crate) const MISSING: usize = 7;
/// The row of what the finger got.
pub(crate) const ON_FINGER: usize = 8;

/// Makes the column of a tick.
pub(crate) trait TickColumns: Send {
    /// Bytes in a column.
    fn n_rows(&self) -> usize;

    /// Writes the column of a tick of a path at which the first display is at `first`.
    fn write(&mut self, path: &ExplorationPath, at: (u64, &Pose), rows: &mut [u8]);
}

/// Bytes in a column of what is felt with so many contactors.
pub(crate) fn n_felt_rows(n_contactors: usize) -> usize {
    N_LINES + 2 * n_contactors
}

/// Which contactors limits bite.
#[derive(Debug)]
pub(crate) struct Limits {
    coder: Coder,
    codes: Vec<[u16; 2]>,
}

impl Limits {
    /// Those of a coder for so many contactors.
    pub(crate) fn of(coder: Coder, n_contactors: usize) -> Self {
        Self {
            coder,
            codes: vec![[0; 2]; n_contactors],
        }
    }

    fn n_bitten(&mut self, amplitudes_um: &[[f32; 2]]) -> usize {
        self.coder.encode_into(amplitudes_um, 1.0, &mut self.codes);
        let limited = self.coder.limited().iter();
        limited.filter(|limiter| limiter.any()).count()
    }
}

/// Writes the column of a tick that was felt: lines, then A40 of all contactors, then A320.
/// Without amplitudes their rows are gaps.
pub(crate) fn write_felt(
    (speed_mm_per_s, on_finger): (f64, OnFinger),
    amplitudes_um: &[[f32; 2]],
    limits: &mut Limits,
    rows: &mut [u8],
) {
    rows.fill(0);
    let (lines, contactors) = rows.split_at_mut(N_LINES);
    lines[ON_FINGER] = finger_code(on_finger);
    let speed = speed_code(speed_mm_per_s);
    [lines[0], lines[1]] = [speed, mirrored(speed)];
    if amplitudes_um.is_empty() {
        return;
    }
    let exact = amplitudes_um.iter().map(|um| um.map(f64::from));
    let (_, mean_um) = vibrating_mean_um(exact);
    for band in 0..2 {
        let code = level_code(selvedge_foundation::quantity::level_db(mean_um[band]));
        // The lower end is that of the ticks that sound.
        let low = if code == SILENT { GAP } else { mirrored(code) };
        [lines[2 + 2 * band], lines[3 + 2 * band]] = [code, low];
    }
    let n_bitten = limits.n_bitten(amplitudes_um);
    lines[LIMITED] = u8::try_from(1 + n_bitten).unwrap_or(u8::MAX);
    let (low, high) = contactors.split_at_mut(contactors.len() / 2);
    for (um, (low, high)) in amplitudes_um.iter().zip(low.iter_mut().zip(high)) {
        [*low, *high] = um.map(amplitude_code);
    }
}

/// How strong each tick is: as a scene renders it now, or as it was recorded.
pub(crate) enum Amplitudes {
    /// Rendered.
    Rendered(Box<Rendered>),
    /// As they were: of these contactors among those of all displays.
    Recorded(Recording, Range<usize>),
}

/// A scene that renders one pose after the other.
pub(crate) struct Rendered {
    /// The renderer.
    pub(crate) renderer: ArrayRenderer,
    /// Which contactors are felt; those beyond its end are.
    pub(crate) mask: Vec<bool>,
    /// One for each display.
    pub(crate) poses: Vec<Pose>,
}

impl Rendered {
    fn tick(&mut self, display: usize) -> &[[f32; 2]] {
        self.renderer.tick(&self.poses);
        self.renderer.mask_display(0, &self.mask);
        let shown = self.renderer.frames().get(display);
        shown.map_or(&[], |frame| frame.amplitudes_um())
    }
}

/// Columns of what is felt.
pub(crate) struct FeltColumns {
    /// The display that is shown.
    pub(crate) display: usize,
    pub(crate) amplitudes: Amplitudes,
    pub(crate) n_contactors: usize,
    pub(crate) limits: Limits,
    /// The device's tick of every one that was sent.
    pub(crate) apply_ticks: ApplyTicks,
    /// Ticks before which others are missing, rising.
    pub(crate) missing: Vec<u64>,
}

impl TickColumns for FeltColumns {
    fn n_rows(&self) -> usize {
        n_felt_rows(self.n_contactors)
    }

    fn write(&mut self, path: &ExplorationPath, (tick, first): (u64, &Pose), rows: &mut [u8]) {
        let amplitudes_um = match &mut self.amplitudes {
            Amplitudes::Rendered(rendered) => {
                path.poses_into(first, &mut rendered.poses);
                rendered.tick(self.display)
            }
            Amplitudes::Recorded(recording, shown) => {
                let all_um = recording.amplitudes_um(tick).unwrap_or_default();
                all_um.get(shown.clone()).unwrap_or_default()
            }
        };
        let amplitudes_um = &amplitudes_um[..amplitudes_um.len().min(self.n_contactors)];
        let velocity = path.pose_of(self.display, first).velocity;
        let speed = velocity.speed_mm_per_s();
        let nth = usize::try_from(tick).unwrap_or(usize::MAX);
        // A device plays the first display.
        let is_sent = self.display == 0 && self.apply_ticks.get(nth).is_some_and(Option::is_some);
        let on_finger = OnFinger::sent(is_sent);
        write_felt((speed, on_finger), amplitudes_um, &mut self.limits, rows);
        rows[MISSING] = 1 + u8::from(self.missing.binary_search(&tick).is_ok());
    }
}

/// Columns of the vibration that arrives at a contactor.
pub(crate) struct SpectrumColumns {
    pub(crate) inspector: ContactInspector,
    /// The display that is shown, and its contactor.
    pub(crate) contactor: [usize; 2],
    pub(crate) columns: ContactColumns,
}

impl TickColumns for SpectrumColumns {
    fn n_rows(&self) -> usize {
        N_ROWS
    }

    fn write(&mut self, path: &ExplorationPath, (_, first): (u64, &Pose), rows: &mut [u8]) {
        let mut levels_db: Rows = [0.0; N_ROWS];
        let pose = path.pose_of(self.contactor[0], first);
        let at = (&mut self.inspector, self.contactor);
        self.columns.levels_db(at.0, at.1, &pose, &mut levels_db);
        write_levels(&levels_db, rows);
    }
}

/// Writes levels, dB re 1 µm.
pub(crate) fn write_levels(levels_db: &Rows, rows: &mut [u8]) {
    for (row, level_db) in rows.iter_mut().zip(levels_db) {
        *row = level_code(f64::from(*level_db));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tools::timeline::code::finger_of;
    use selvedge_device::ArrayProfile;

    fn column(amplitudes_um: &[[f32; 2]]) -> Vec<u8> {
        let n = amplitudes_um.len();
        let mut limits = Limits::of(Coder::new(&ArrayProfile::default(), n), n);
        let mut rows = vec![9; n_felt_rows(2)];
        write_felt(
            (120.0, OnFinger::Felt),
            amplitudes_um,
            &mut limits,
            &mut rows,
        );
        rows
    }

    #[test]
    fn a_column_holds_both_bands_of_every_contactor_and_what_limits_bite() {
        let rows = column(&[[2.0, 0.0], [900.0, 4.0]]);
        let bands = [[2.0, 900.0], [0.0, 4.0]].map(|band| band.map(amplitude_code));
        assert_eq!(rows[N_LINES..], bands.concat());
        assert_eq!(rows[LIMITED], 2, "one of them");
        assert_eq!(finger_of(rows[ON_FINGER]), Some(OnFinger::Felt));
        assert_eq!(rows[5], mirrored(amplitude_code(2.0)), "the mean of 320 Hz");
    }

    #[test]
    fn the_lower_end_of_a_line_is_of_ticks_that_sound() {
        let rows = column(&[[0.0; 2]; 2]);
        assert_eq!(rows[2..6], [SILENT, GAP, SILENT, GAP]);
        let unknown = column(&[]);
        assert_eq!(unknown[2..ON_FINGER], [GAP; ON_FINGER - 2]);
        assert_eq!(unknown[N_LINES..], [GAP; 4]);
    }
}
