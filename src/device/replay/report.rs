//! What a replay found of one link, in lines for people.

use std::collections::BTreeMap;
use std::fmt;

use super::judge::Disagreement;

/// One link of a log, replayed.
#[derive(Clone, Debug, Default)]
pub struct ReplayedLink {
    /// What its first line says: number, target, program.
    pub(super) heading: String,
    /// When it began, by the host's calendar.
    pub(super) utc: String,
    /// Hashes of what was played on what.
    pub(super) about: Vec<String>,
    /// Why it could not be replayed, or no longer.
    pub(super) broken: Option<String>,
    /// Whether frames are told by their hashes only.
    pub(super) is_hashed: bool,
    pub(super) counts: Counts,
    pub(super) disagreements: BTreeMap<&'static str, u64>,
    /// The first disagreement and its tick.
    pub(super) first: Option<(u32, Disagreement)>,
}

/// What was counted on the way.
#[derive(Clone, Debug, Default)]
pub(super) struct Counts {
    /// FRAMEs that were written, STATUS that arrived, and those of them that were judged.
    pub(super) frames: u64,
    pub(super) statuses: u64,
    pub(super) judged: u64,
    /// STATUS of a tick that another had told of.
    pub(super) repeated: u64,
    /// Packets of the host that did not arrive, and of which that cannot be told.
    pub(super) lost: u64,
    pub(super) doubtful: u64,
    /// Packets that the log itself has lost, and texts that were no packet.
    pub(super) unrecorded: u64,
    pub(super) bad: u64,
    /// By which the device counted more bad and repeated packets than the host wrote.
    pub(super) on_the_way: [u64; 2],
    /// The largest peak, µm, its channel and its tick.
    pub(super) largest: Option<(f64, usize, u32)>,
}

impl ReplayedLink {
    /// Whether the device's numbers are the emulator's, as far as the log can tell.
    pub fn agrees(&self) -> bool {
        self.first.is_none() && self.broken.is_none()
    }

    pub(super) fn disagree(&mut self, tick: u32, found: Disagreement) {
        *self.disagreements.entry(found.what).or_default() += 1;
        self.first.get_or_insert((tick, found));
    }

    fn verdict(&self) -> String {
        let judged = self.counts.judged;
        if let Some((tick, first)) = &self.first {
            let (what, device, emulator) = (first.what, &first.device, &first.emulator);
            let kinds = self.disagreements.iter();
            let kinds: Vec<_> = kinds.map(|(what, n)| format!("{what} {n}")).collect();
            let kinds = kinds.join(", ");
            return format!(
                "disagrees, first at tick {tick}: {what} {device}, the emulator's {emulator}; \
                 in all: {kinds}"
            );
        }
        if judged == 0 {
            return String::from(
                "nothing to judge: no STATUS of a session that begins in this log",
            );
        }
        let of_codes = if self.is_hashed {
            ""
        } else {
            ", amp_sum, clipped"
        };
        format!("agrees in {judged} STATUS: state, age, queue, underrun, late{of_codes}")
    }

    /// What the log does not tell.
    fn unknowns(&self) -> Vec<String> {
        let counts = &self.counts;
        let [bad, dup] = counts.on_the_way;
        let mut unknowns = Vec::new();
        if self.is_hashed {
            unknowns.push(String::from(
                "frames are hashes here: what the finger got, amp_sum and clipped are not known",
            ));
        }
        let numbers = [
            (
                counts.lost,
                "packets of the host did not arrive, or have no answer",
            ),
            (
                counts.doubtful,
                "packets may have arrived or not; the ticks after them are not judged",
            ),
            (counts.unrecorded, "packets are not in the log"),
            (counts.bad, "texts from the device were no packet"),
            (bad, "bad packets were counted by the device"),
            (dup, "repeated packets were counted by the device"),
            (counts.repeated, "STATUS told of a tick that was over"),
        ];
        let some = numbers.iter().filter(|(n, _)| *n > 0);
        unknowns.extend(some.map(|(n, what)| format!("{n} {what}")));
        unknowns
    }
}

impl fmt::Display for ReplayedLink {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = &self.counts;
        writeln!(f, "link {}, {}", self.heading, self.utc)?;
        for about in &self.about {
            writeln!(f, "  {about}")?;
        }
        let (frames, statuses) = (counts.frames, counts.statuses);
        writeln!(f, "  {frames} FRAME, {statuses} STATUS")?;
        if let Some((peak_um, channel, tick)) = counts.largest {
            let what = "largest displacement by the model";
            writeln!(
                f,
                "  {what}: {peak_um:.2} µm, channel {channel}, tick {tick}"
            )?;
        }
        for unknown in self.unknowns() {
            writeln!(f, "  {unknown}")?;
        }
        if let Some(broken) = &self.broken {
            writeln!(f, "  not replayed further: {broken}")?;
        }
        if counts.judged > 0 {
            let how = "placed by the age in STATUS within 1 ms, PING exactly, others in their tick";
            writeln!(
                f,
                "  {how}; nothing is judged within 2 ms of an edge of a ramp"
            )?;
        }
        writeln!(f, "  {}", self.verdict())
    }
}
