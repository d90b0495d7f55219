//! A waveform of any length: one WAV file, or several numbered ones that follow each other without
//! a gap, because the format's sizes end at 4 GiB.
//!
//! Parts stand beside their places until the last is whole: then `W.wav` is there, or `W-001.wav`,
//! `W-002.wav` and so on, and whatever failed before leaves none of them. Each part says in its
//! text which one it is and with which frame of the whole it begins.

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use super::wav::{WavSpec, WavWriter};
use super::{BridgeError, SinkError};
use selvedge_foundation::files::Staged;

/// A waveform on its way to one file or several.
#[derive(Debug)]
pub struct WavParts {
    path: PathBuf,
    spec: WavSpec,
    max_bytes: u32,
    done: Vec<(Staged, BufWriter<File>)>,
    current: (Staged, WavWriter<BufWriter<File>>),
    n_frames: u64,
}

impl WavParts {
    /// A waveform at `path`, in parts of less than 4 GiB.
    pub fn create(path: &Path, spec: WavSpec) -> Result<Self, SinkError> {
        Self::with_limit(path, spec, u32::MAX)
    }

    /// The same in parts of at most so many bytes, one frame at least.
    pub fn with_limit(path: &Path, spec: WavSpec, max_bytes: u32) -> Result<Self, SinkError> {
        let current = begin(path, WavSpec { part: None, ..spec }, max_bytes)?;
        Ok(Self {
            path: path.to_owned(),
            spec,
            max_bytes,
            done: Vec::new(),
            current,
            n_frames: 0,
        })
    }

    /// Appends whole frames of interleaved samples, 1.0 = full scale, in new parts as needed.
    pub fn write(&mut self, mut interleaved: &[f32]) -> Result<(), SinkError> {
        let n_channels = usize::from(self.spec.n_channels);
        while !interleaved.is_empty() {
            let n_free = self.current.1.n_free_frames();
            if n_free == 0 {
                self.next_part()?;
                continue;
            }
            let n_wanted = interleaved.len() / n_channels;
            let n_now = usize::try_from(n_free).map_or(n_wanted, |free| free.min(n_wanted));
            // What is no whole frame is refused below.
            let n_samples = if n_now == n_wanted {
                interleaved.len()
            } else {
                n_now * n_channels
            };
            let (now, later) = interleaved.split_at(n_samples);
            self.current.1.write(now)?;
            self.n_frames += n_now as u64;
            interleaved = later;
        }
        Ok(())
    }

    fn next_part(&mut self) -> Result<(), SinkError> {
        if self.current.1.n_frames() == 0 {
            return Err(BridgeError::WavFull.into());
        }
        let number = u32::try_from(self.done.len()).unwrap_or(u32::MAX) + 2;
        let spec = WavSpec {
            part: Some((number, self.n_frames)),
            ..self.spec
        };
        let next = begin(&numbered(&self.path, number), spec, self.max_bytes)?;
        let (staged, writer) = std::mem::replace(&mut self.current, next);
        self.done.push((staged, writer.finish()?));
        Ok(())
    }

    /// All parts are whole: puts them in their places, and says where they are.
    pub fn finish(self) -> Result<Vec<PathBuf>, SinkError> {
        let (last, writer) = self.current;
        let out = writer.finish()?;
        if self.done.is_empty() {
            last.finish(out)?;
            return Ok(vec![self.path]);
        }
        let mut paths = Vec::new();
        for (index, (staged, out)) in self.done.into_iter().chain([(last, out)]).enumerate() {
            let number = u32::try_from(index).unwrap_or(u32::MAX).saturating_add(1);
            let path = numbered(&self.path, number);
            staged.finish_as(out, &path)?;
            paths.push(path);
        }
        Ok(paths)
    }
}

/// `W.wav` as part 2: `W-002.wav`.
fn numbered(path: &Path, number: u32) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(format!("-{number:03}"));
    let named = path.with_file_name(name);
    match path.extension() {
        Some(ending) => named.with_added_extension(ending),
        None => named,
    }
}

fn begin(
    path: &Path,
    spec: WavSpec,
    max_bytes: u32,
) -> Result<(Staged, WavWriter<BufWriter<File>>), SinkError> {
    let staged = Staged::new(path);
    let out = staged.create().map_err(SinkError::place(path))?;
    Ok((staged, WavWriter::with_limit(out, spec, max_bytes)?))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::super::wav::SampleFormat;
    use super::*;
    use selvedge_scratch::ScratchFolder;

    const SPEC: WavSpec = WavSpec {
        n_channels: 2,
        sample_rate_hz: 8000,
        format: SampleFormat::I16,
        full_scale_um: 50.0,
        part: None,
    };

    fn samples(path: &Path) -> Vec<i16> {
        let reader = hound::WavReader::open(path).unwrap();
        reader.into_samples().map(Result::unwrap).collect()
    }

    #[test]
    fn a_waveform_beyond_the_limit_goes_on_in_numbered_files() {
        let folder = ScratchFolder::made("parts");
        let path = folder.join("a.wav");
        // Room for a hundred frames or so around header and text.
        let mut parts = WavParts::with_limit(&path, SPEC, 600).unwrap();
        let all: Vec<f32> = (0..500_u16).map(|n| f32::from(n) / 32767.0).collect();
        for block in all.chunks(26) {
            parts.write(block).unwrap();
        }
        let paths = parts.finish().unwrap();
        assert!(paths.len() > 1, "{paths:?}");
        assert_eq!(paths[0], folder.join("a-001.wav"));
        let read: Vec<i16> = paths.iter().flat_map(|path| samples(path)).collect();
        assert_eq!(read, (0..500_i16).collect::<Vec<i16>>(), "no gap");
        for path in &paths {
            assert!(fs::metadata(path).unwrap().len() <= 600, "{path:?}");
        }
        let n_first = samples(&paths[0]).len() / 2;
        let text = String::from_utf8_lossy(&fs::read(&paths[1]).unwrap()).into_owned();
        assert!(
            text.contains(&format!("part 2, from frame {n_first}")),
            "{text}"
        );
        assert_eq!(fs::read_dir(&folder).unwrap().count(), paths.len());
    }

    #[test]
    fn a_waveform_that_fits_keeps_its_name() {
        let folder = ScratchFolder::made("whole");
        let path = folder.join("a.wav");
        let mut parts = WavParts::create(&path, SPEC).unwrap();
        parts.write(&[0.5; 8]).unwrap();
        assert_eq!(parts.finish().unwrap(), std::slice::from_ref(&path));
        assert_eq!(samples(&path).len(), 8);
    }

    #[test]
    fn what_is_not_finished_leaves_nothing() {
        let folder = ScratchFolder::made("half");
        let mut parts = WavParts::with_limit(&folder.join("a.wav"), SPEC, 600).unwrap();
        parts.write(&[0.5; 800]).unwrap();
        assert!(parts.write(&[0.5; 3]).is_err(), "no whole frames");
        drop(parts);
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
        let nowhere = WavParts::create(&folder.join("none/a.wav"), SPEC).unwrap_err();
        assert!(nowhere.to_string().contains("none/a.wav"), "{nowhere}");
    }
}
