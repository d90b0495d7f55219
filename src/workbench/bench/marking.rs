//! Markers of the recording at hand, and parts of it that become recordings.

use std::ops::Range;
use std::time::SystemTime;

use crate::bench::Bench;
use crate::bench::background::{Executor, finished};
use crate::bench::command::RecordingCommand;
use crate::bench::recording::excerpt::cut;
use crate::bench::recording::file::{FeltTick, RecordingFile};
use crate::bench::recording::{About, Marker};
use crate::bench::signals::history::Entry;
use crate::bench::view::Source;
use selvedge_foundation::files::FileError;
use selvedge_foundation::quantity;
use selvedge_render::scene::Pose;

/// Why nothing is marked.
const NO_RECORDING: &str = "Markers stand in recordings: make one, choose one in the list, or \
    keep a part of what was felt last (Shift and drag on the line of time)";

impl Bench {
    /// Puts a marker where the recording is that is made or replayed.
    pub(crate) fn mark_here(&mut self) {
        let play = self.live.play;
        if let Some(running) = &mut self.exploration.recordings.running {
            let name = format!("Marker {}", running.markers.len() + 1);
            let tick = play.n_recorded.saturating_sub(1);
            return running.markers.push(Marker { tick, name });
        }
        let at_hand = self.exploration.at_hand.as_ref();
        let Some(at_hand) = at_hand.filter(|_| play.source == Source::Recording) else {
            return self.notices.give(NO_RECORDING);
        };
        let markers = &at_hand.about().markers;
        if markers.iter().all(|marker| marker.tick != play.tick) {
            let name = format!("Marker {}", markers.len() + 1);
            let tick = play.tick;
            self.mark(Marker { tick, name });
        }
        self.exploration.unnamed = Some(play.tick);
    }

    /// The page of a recording that begins now.
    pub(crate) fn new_page(&self) -> About {
        About {
            name: self.exploration.recordings.next_name(),
            began: quantity::rfc3339(SystemTime::now()),
            scene: self.document.scene().name.clone(),
            scene_file: self.document.path().cloned(),
            tuning: Some(self.document.tuning()),
            stylus: self.device.stylus.clone(),
            ..About::default()
        }
    }

    /// Does something within the recording at hand.
    pub(crate) fn dispatch_within(&mut self, command: RecordingCommand) {
        match command {
            RecordingCommand::Mark(marker) => self.mark(marker),
            RecordingCommand::Unmark(tick) => self.unmark(tick),
            RecordingCommand::Excerpt(ticks) => self.excerpt(ticks),
            RecordingCommand::Keep(columns) => self.keep_felt(columns),
            _ => {}
        }
    }

    fn mark(&mut self, marker: Marker) {
        if let Some(at_hand) = &mut self.exploration.at_hand {
            at_hand.mark(marker);
            self.exploration.recordings.relist();
        }
    }

    fn unmark(&mut self, tick: u64) {
        if let Some(at_hand) = &mut self.exploration.at_hand {
            at_hand.unmark(tick);
            self.exploration.recordings.relist();
        }
    }

    /// Makes ticks of the recording at hand a recording of their own.
    fn excerpt(&mut self, ticks: Range<u64>) {
        let at_hand = self.exploration.at_hand.as_ref();
        let folder = at_hand.and_then(|at_hand| Some((at_hand, at_hand.folder.clone()?)));
        let root = self.exploration.recordings.root.clone();
        let Some(((at_hand, folder), root)) = folder.zip(root) else {
            let words = "Only a recording on disk can be cut: export the path of the part";
            return self.notices.give(words);
        };
        let about = excerpt_page(at_hand.about(), &ticks);
        self.make_recording(about.name.clone(), move || {
            cut(&folder, &root, &about, ticks).map(|_| ())
        });
    }

    /// Makes columns of what was felt last a recording.
    fn keep_felt(&mut self, columns: Range<u64>) {
        let Some(root) = self.exploration.recordings.root.clone() else {
            return self
                .notices
                .give("This system has no folder for recordings");
        };
        let (about, history) = (self.new_page(), &self.past.history);
        let kept = history.of_all_displays(columns);
        let kept: Vec<(Entry, Vec<Pose>, Vec<[f32; 2]>)> =
            kept.map(|(entry, poses, um)| (*entry, poses, um)).collect();
        let sizes = kept
            .first()
            .map(|(_, poses, um)| [poses.len() - 1, um.len()]);
        self.make_recording(about.name.clone(), move || {
            let mut file = RecordingFile::create(&root, about, sizes.unwrap_or_default())?;
            file.append_ticks(kept.iter().map(|(entry, poses, amplitudes_um)| FeltTick {
                tick: entry.tick_sample.tick,
                pose: poses[0],
                others: &poses[1..],
                apply_tick: entry.tick_sample.apply_tick,
                amplitudes_um,
            }))?;
            file.finish().map(|_| ())
        });
    }

    /// Makes a recording of this name on a thread.
    fn make_recording(
        &mut self,
        name: String,
        make: impl FnOnce() -> Result<(), FileError> + Send + 'static,
    ) {
        let task = self.executor.start("selvedge-excerpt", move |_| {
            make().map_err(|error| error.to_string())?;
            Ok(format!("{name} is in the list of recordings"))
        });
        self.exploration.recordings.cutting = Some(task);
        if matches!(self.executor, Executor::InLine) {
            self.poll_excerpt();
        }
    }

    /// Says what became of it.
    pub(crate) fn poll_excerpt(&mut self) {
        let recordings = &mut self.exploration.recordings;
        if let Some(outcome) = finished(&mut recordings.cutting) {
            recordings.relist();
            self.notices.give(outcome.unwrap_or_else(|line| line));
        }
    }
}

/// The page of a part: its markers keep their places.
fn excerpt_page(whole: &About, ticks: &Range<u64>) -> About {
    let within = whole
        .markers
        .iter()
        .filter(|marker| ticks.contains(&marker.tick));
    let markers = within.map(|marker| Marker {
        tick: marker.tick - ticks.start,
        name: marker.name.clone(),
    });
    let [from, to] = [ticks.start, ticks.end].map(|tick| quantity::clock(25 * tick));
    About {
        name: format!("{}, {from} to {to}", whole.name),
        began: quantity::rfc3339(SystemTime::now()),
        ticks: None,
        outline: Vec::new(),
        markers: markers.collect(),
        ..whole.clone()
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::bench::command::{PlayCommand, PlaySource};
    use crate::bench::recording::file::read;
    use crate::bench::recording::tests::two_apart;
    use crate::bench::recording::{Place, Recording, Recordings};
    use crate::shell::headless::Headless;
    use selvedge_scratch::ScratchFolder;

    /// A window that replays a recording of a hundred ticks, marked at its twentieth.
    fn replaying(root: &ScratchFolder) -> Headless {
        let mut desk = Headless::shipped();
        let recordings = &mut desk.workbench.bench.exploration.recordings;
        *recordings = Recordings::in_folder(root.to_path_buf());
        desk.dispatch(PlayCommand::Toggle);
        desk.pass(2);
        desk.dispatch(PlayCommand::ToggleRecording);
        desk.pass_ticks(20);
        desk.dispatch(PlayCommand::Mark);
        desk.pass_ticks(80);
        desk.dispatch(PlayCommand::ToggleRecording);
        desk.pass(3);
        desk.dispatch(PlayCommand::Source(PlaySource::Recording));
        desk.pass(3);
        desk
    }

    fn at_hand(desk: &Headless) -> &Recording {
        desk.workbench.bench.exploration.at_hand.as_ref().unwrap()
    }

    #[test]
    fn markers_are_on_the_page_of_their_recording() {
        let root = ScratchFolder::made("markers");
        let mut desk = replaying(&root);
        let first = at_hand(&desk).about().markers.clone();
        assert_eq!(first.len(), 1, "the one that was put in while it was made");
        desk.dispatch(PlayCommand::Seek(50));
        desk.pass(3);
        desk.dispatch(PlayCommand::Mark);
        let name = "a thread".to_owned();
        desk.dispatch(RecordingCommand::Mark(Marker { tick: 50, name }));
        let folder = at_hand(&desk).folder.clone().unwrap();
        let kept = read(&folder).unwrap();
        let names: Vec<&str> = kept
            .about()
            .markers
            .iter()
            .map(|m| m.name.as_str())
            .collect();
        assert_eq!(names, ["Marker 1", "a thread"]);
        desk.dispatch(RecordingCommand::Unmark(first[0].tick));
        assert_eq!(read(&folder).unwrap().about().markers.len(), 1);
    }

    #[test]
    fn a_part_becomes_a_recording_with_its_markers() {
        let root = ScratchFolder::made("part");
        let mut desk = replaying(&root);
        let marked = at_hand(&desk).about().markers[0].tick;
        desk.dispatch(RecordingCommand::Excerpt(10..60));
        desk.pass(3);
        let entries = desk.workbench.bench.exploration.recordings.entries();
        let part = entries
            .iter()
            .find(|entry| entry.about.name.contains(" to "))
            .unwrap();
        assert_eq!(part.about.ticks, Some([50, 0]));
        assert_eq!(part.about.markers[0].tick, marked - 10);
        assert_eq!(fs::read_dir(&*root).unwrap().count(), 2);
    }

    #[test]
    fn what_was_felt_last_is_kept_as_a_recording_that_nobody_began() {
        let root = ScratchFolder::made("kept");
        let mut desk = Headless::shipped();
        desk.workbench.bench.exploration.recordings = Recordings::in_folder(root.to_path_buf());
        desk.dispatch(PlayCommand::Toggle);
        desk.pass_ticks(80);
        let history = &desk.workbench.bench.past.history;
        let newest = history.newest().unwrap().column;
        let felt: Vec<[f32; 2]> = history.felt_um(newest).unwrap().collect();
        desk.dispatch(RecordingCommand::Keep(newest - 29..newest + 1));
        desk.pass(3);
        let entries = desk.workbench.bench.exploration.recordings.entries();
        let Place::Folder(folder) = &entries[0].place else {
            panic!("it is on disk")
        };
        let kept = read(folder).unwrap();
        assert_eq!(kept.about().ticks, Some([30, 0]));
        assert_eq!(kept.amplitudes_um(29), Some(felt.as_slice()));
    }

    #[test]
    fn what_was_felt_last_is_kept_of_all_displays_whichever_is_shown() {
        for shown in [0, 1] {
            let root = ScratchFolder::made("kept-two");
            let mut desk = two_apart(&root, shown);
            let made = at_hand(&desk).clone();
            let newest = desk.workbench.bench.past.history.newest().unwrap().column;
            desk.dispatch(RecordingCommand::Keep(newest - 29..newest + 1));
            desk.pass(3);
            let entries = desk.workbench.bench.exploration.recordings.entries();
            let kept = entries.iter().find(|entry| entry.about.name != made.name());
            let Place::Folder(folder) = &kept.unwrap().place else {
                panic!("it is on disk")
            };
            let kept = read(folder).unwrap();
            let poses = |of: &Recording| {
                let displays = |(_, first)| {
                    [0, 1].map(|display| {
                        let pose = of.path().pose_of(display, &first);
                        (pose.position, pose.velocity)
                    })
                };
                of.path().ticks().map(displays).collect::<Vec<_>>()
            };
            let (made_at, kept_at) = (poses(&made), poses(&kept));
            let from = made_at.iter().position(|at| *at == kept_at[0]).unwrap();
            let n_common = (made_at.len() - from).min(kept_at.len());
            assert!(n_common > 20, "{n_common}");
            let mut n_apart = 0;
            for (nth, tick) in (from..from + n_common).enumerate() {
                assert_eq!(kept_at[nth], made_at[tick], "tick {tick}");
                let um = made.amplitudes_um(tick as u64).unwrap();
                assert_eq!(kept.amplitudes_um(nth as u64), Some(um), "tick {tick}");
                let sounds =
                    [&um[..24], &um[24..]].map(|display| display.iter().any(|um| *um != [0.0; 2]));
                n_apart += u32::from(sounds[0] != sounds[1]);
            }
            assert!(n_apart > 0, "the second was lifted");
        }
    }

    #[test]
    fn without_a_recording_nothing_is_marked_and_it_is_said() {
        let mut desk = Headless::shipped();
        desk.dispatch(PlayCommand::Mark);
        desk.pass(1);
        assert!(
            desk.workbench
                .notices()
                .iter()
                .any(|words| words == NO_RECORDING)
        );
    }
}
