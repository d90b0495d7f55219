//! Many-channel WAV as a stream: one channel per contactor, written as it is made, sizes filled in
//! at the end.
//!
//! The header is our own 68 bytes of `WAVE_FORMAT_EXTENSIBLE` with `dwChannelMask = 0`: 24
//! contactors are no loudspeakers, and a mask that names positions makes some systems drop the
//! channels beyond the eighteenth. What a sample means in µm stands as text in a LIST/INFO chunk
//! behind the data. It knows nothing of carriers or amplitudes.
//!
//! ```text
//! "RIFF" size "WAVE" | "fmt " 40 format | "data" size samples … |
//! "LIST" size "INFO" "ICMT" size text
//! ```

use std::io::{Seek, SeekFrom, Write};

use super::BridgeError;

const HEADER_LEN: u64 = 68;
const RIFF_SIZE_AT: u64 = 4;
const DATA_SIZE_AT: u64 = 64;
const EXTENSIBLE: u16 = 0xfffe;
/// The part that both sub-format identifiers share; the first four bytes tell PCM (1) from IEEE
/// float (3).
const SUBFORMAT_TAIL: [u8; 12] = [
    0x00, 0x00, 0x10, 0x00, 0x80, 0x00, 0x00, 0xaa, 0x00, 0x38, 0x9b, 0x71,
];

/// How samples are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SampleFormat {
    /// 32-bit float; 1.0 is full scale, larger values are kept.
    F32,
    /// 16-bit integer; 32767 is full scale, larger values are cut.
    I16,
}

impl SampleFormat {
    fn bytes(self) -> u16 {
        match self {
            Self::F32 => 4,
            Self::I16 => 2,
        }
    }

    fn tag(self) -> u32 {
        match self {
            Self::F32 => 3,
            Self::I16 => 1,
        }
    }
}

/// Shape and scale of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WavSpec {
    /// One channel per contactor, in contactor order.
    pub n_channels: u16,
    /// Frames per second.
    pub sample_rate_hz: u32,
    /// Storage of a sample.
    pub format: SampleFormat,
    /// Displacement in µm that full scale stands for (F40 of the array profile).
    pub full_scale_um: f64,
    /// The part of a longer recording that this file is, from 1, and its first frame.
    pub part: Option<(u32, u64)>,
}

impl WavSpec {
    fn frame_bytes(&self) -> u32 {
        u32::from(self.n_channels) * u32::from(self.format.bytes())
    }

    /// The text that says what a sample means.
    fn comment(&self) -> String {
        let full = match self.format {
            SampleFormat::F32 => "1.0",
            SampleFormat::I16 => "32767",
        };
        let part = self.part.map_or_else(String::new, |(number, first)| {
            format!("; part {number}, from frame {first}")
        });
        format!(
            "sample {full} = {} um displacement; one channel per contactor, row by row{part}",
            self.full_scale_um
        )
    }

    fn header(&self) -> [u8; 68] {
        let bits = 8 * self.format.bytes();
        let fields: [&[u8]; 18] = [
            b"RIFF",
            &[0; 4],
            b"WAVE",
            b"fmt ",
            &40_u32.to_le_bytes(),
            &EXTENSIBLE.to_le_bytes(),
            &self.n_channels.to_le_bytes(),
            &self.sample_rate_hz.to_le_bytes(),
            &self
                .sample_rate_hz
                .wrapping_mul(self.frame_bytes())
                .to_le_bytes(),
            &u16::try_from(self.frame_bytes())
                .unwrap_or(u16::MAX)
                .to_le_bytes(),
            &bits.to_le_bytes(),
            &22_u16.to_le_bytes(),
            &bits.to_le_bytes(),
            // No loudspeaker positions.
            &[0; 4],
            &self.format.tag().to_le_bytes(),
            &SUBFORMAT_TAIL,
            b"data",
            &[0; 4],
        ];
        let mut header = [0; 68];
        for (slot, byte) in header.iter_mut().zip(fields.into_iter().flatten()) {
            *slot = *byte;
        }
        header
    }

    /// The LIST/INFO chunk, padded to even length.
    fn info(&self) -> Vec<u8> {
        let mut text = self.comment().into_bytes();
        text.push(0);
        if text.len() % 2 == 1 {
            text.push(0);
        }
        let text_len = u32::try_from(text.len()).unwrap_or(u32::MAX);
        let mut chunk = Vec::with_capacity(20 + text.len());
        chunk.extend(b"LIST");
        chunk.extend((text_len + 12).to_le_bytes());
        chunk.extend(b"INFOICMT");
        chunk.extend(text_len.to_le_bytes());
        chunk.extend(text);
        chunk
    }
}

/// A WAV file being written. Until [`finish`](Self::finish) its sizes are 0.
#[derive(Debug)]
pub(crate) struct WavWriter<W: Write + Seek> {
    out: W,
    spec: WavSpec,
    data_bytes: u64,
    max_data_bytes: u64,
    buffer: Vec<u8>,
}

impl<W: Write + Seek> WavWriter<W> {
    /// Writes the header to `out`, which must be at its start.
    pub(crate) fn new(mut out: W, spec: WavSpec) -> Result<Self, BridgeError> {
        // The block size field has 16 bits.
        if spec.n_channels == 0 || spec.sample_rate_hz == 0 || spec.frame_bytes() > 0xffff {
            let WavSpec {
                n_channels,
                sample_rate_hz,
                ..
            } = spec;
            return Err(BridgeError::WavSpec {
                n_channels,
                sample_rate_hz,
            });
        }
        out.write_all(&spec.header()).map_err(BridgeError::Wav)?;
        let around = HEADER_LEN - 8 + spec.info().len() as u64;
        let max_data_bytes = u64::from(u32::MAX) - around;
        Ok(Self {
            out,
            spec,
            data_bytes: 0,
            max_data_bytes,
            buffer: Vec::new(),
        })
    }

    /// The same for a file of at most so many bytes.
    pub(crate) fn with_limit(out: W, spec: WavSpec, max_bytes: u32) -> Result<Self, BridgeError> {
        let mut writer = Self::new(out, spec)?;
        let around = HEADER_LEN + spec.info().len() as u64;
        let most = u64::from(max_bytes).saturating_sub(around);
        writer.max_data_bytes = writer.max_data_bytes.min(most);
        Ok(writer)
    }

    /// Frames that still fit.
    pub(crate) fn n_free_frames(&self) -> u64 {
        (self.max_data_bytes - self.data_bytes) / u64::from(self.spec.frame_bytes())
    }

    /// Frames written.
    pub(crate) fn n_frames(&self) -> u64 {
        self.data_bytes / u64::from(self.spec.frame_bytes())
    }

    /// Appends whole frames of interleaved samples, 1.0 = full scale. NaN becomes 0.
    ///
    /// Refuses what would make the file 4 GiB or larger; what was written before stays a valid
    /// file.
    pub(crate) fn write(&mut self, interleaved: &[f32]) -> Result<(), BridgeError> {
        let n_channels = self.spec.n_channels;
        if !interleaved.len().is_multiple_of(usize::from(n_channels)) {
            return Err(BridgeError::WavFrame {
                n_samples: interleaved.len(),
                n_channels,
            });
        }
        let bytes = interleaved.len() as u64 * u64::from(self.spec.format.bytes());
        if self.data_bytes + bytes > self.max_data_bytes {
            return Err(BridgeError::WavFull);
        }
        self.buffer.clear();
        for &sample in interleaved {
            let sample = if sample.is_nan() { 0.0 } else { sample };
            match self.spec.format {
                SampleFormat::F32 => self.buffer.extend(sample.to_le_bytes()),
                SampleFormat::I16 => self.buffer.extend(quantised(sample).to_le_bytes()),
            }
        }
        self.out.write_all(&self.buffer).map_err(BridgeError::Wav)?;
        self.data_bytes += bytes;
        Ok(())
    }

    /// Writes the scale, fills in the sizes, and gives the output back, flushed.
    pub(crate) fn finish(mut self) -> Result<W, BridgeError> {
        self.close().map_err(BridgeError::Wav)?;
        Ok(self.out)
    }

    fn close(&mut self) -> std::io::Result<()> {
        let info = self.spec.info();
        self.out.write_all(&info)?;
        let riff_bytes = HEADER_LEN - 8 + self.data_bytes + info.len() as u64;
        for (at, size) in [(RIFF_SIZE_AT, riff_bytes), (DATA_SIZE_AT, self.data_bytes)] {
            let size = u32::try_from(size).unwrap_or(u32::MAX);
            self.out.seek(SeekFrom::Start(at))?;
            self.out.write_all(&size.to_le_bytes())?;
        }
        self.out.seek(SeekFrom::End(0))?;
        self.out.flush()
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "clamped to ±1 before it is scaled"
)]
fn quantised(sample: f32) -> i16 {
    (sample.clamp(-1.0, 1.0) * 32767.0).round() as i16
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    const SPEC: WavSpec = WavSpec {
        n_channels: 24,
        sample_rate_hz: 48_000,
        format: SampleFormat::F32,
        full_scale_um: 50.0,
        part: None,
    };

    fn file(spec: WavSpec, samples: &[f32]) -> Vec<u8> {
        let mut writer = WavWriter::new(Cursor::new(Vec::new()), spec).unwrap();
        for block in samples.chunks(2 * usize::from(spec.n_channels)) {
            writer.write(block).unwrap();
        }
        writer.finish().unwrap().into_inner()
    }

    fn u32_at(bytes: &[u8], at: usize) -> u32 {
        u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
    }

    #[test]
    fn the_header_is_extensible_without_loudspeakers() {
        let bytes = file(SPEC, &[0.5; 24 * 3]);
        assert_eq!(&bytes[..4], b"RIFF");
        assert_eq!(u32_at(&bytes, 4) as usize, bytes.len() - 8);
        assert_eq!(&bytes[8..16], b"WAVEfmt ");
        assert_eq!(u32_at(&bytes, 16), 40);
        assert_eq!(bytes[20..24], [0xfe, 0xff, 24, 0]);
        assert_eq!(u32_at(&bytes, 24), 48_000);
        assert_eq!(u32_at(&bytes, 28), 48_000 * 96);
        assert_eq!(bytes[32..40], [96, 0, 32, 0, 22, 0, 32, 0]);
        assert_eq!(u32_at(&bytes, 40), 0, "channel mask");
        assert_eq!(u32_at(&bytes, 44), 3, "IEEE float");
        assert_eq!(&bytes[60..64], b"data");
        assert_eq!(u32_at(&bytes, 64), 24 * 3 * 4);
        let info = String::from_utf8_lossy(&bytes[68 + 288..]);
        assert!(info.starts_with("LIST"), "{info}");
        assert!(
            info.contains("INFOICMT") && info.contains("sample 1.0 = 50 um"),
            "{info}"
        );
        assert_eq!(bytes.len() % 2, 0);
    }

    #[test]
    fn an_independent_reader_finds_every_channel() {
        let samples: Vec<f32> = (0..24_u8 * 5).map(|i| f32::from(i) / 120.0).collect();
        let bytes = file(SPEC, &samples);
        let reader = hound::WavReader::new(Cursor::new(bytes)).unwrap();
        assert_eq!(
            (reader.spec().channels, reader.spec().sample_rate),
            (24, 48_000)
        );
        let read: Vec<f32> = reader.into_samples().map(Result::unwrap).collect();
        assert_eq!(read, samples);

        let spec = WavSpec {
            format: SampleFormat::I16,
            n_channels: 3,
            ..SPEC
        };
        let bytes = file(spec, &[1.0, -1.0, 7.0, f32::NAN, 0.5, -0.25]);
        let reader = hound::WavReader::new(Cursor::new(bytes)).unwrap();
        assert_eq!(reader.spec().bits_per_sample, 16);
        let read: Vec<i16> = reader.into_samples().map(Result::unwrap).collect();
        assert_eq!(read, [32767, -32767, 32767, 0, 16384, -8192]);
    }

    #[test]
    fn shapes_that_make_no_file_are_refused() {
        for spec in [
            WavSpec {
                n_channels: 0,
                ..SPEC
            },
            WavSpec {
                sample_rate_hz: 0,
                ..SPEC
            },
            WavSpec {
                n_channels: 20_000,
                ..SPEC
            },
        ] {
            assert!(WavWriter::new(Cursor::new(Vec::new()), spec).is_err());
        }
        let mut writer = WavWriter::new(Cursor::new(Vec::new()), SPEC).unwrap();
        let message = writer.write(&[0.0; 25]).unwrap_err().to_string();
        assert!(message.contains("25 samples"), "{message}");
    }

    #[test]
    fn four_gib_are_refused_before_they_are_written() {
        let mut writer = WavWriter::new(Cursor::new(Vec::new()), SPEC).unwrap();
        writer.data_bytes = writer.max_data_bytes - 96;
        writer.write(&[0.0; 24]).unwrap();
        let message = writer.write(&[0.0; 24]).unwrap_err().to_string();
        assert!(message.contains("4 GiB"), "{message}");
        let riff = 60 + writer.data_bytes + writer.spec.info().len() as u64;
        assert_eq!(riff, u64::from(u32::MAX));
    }

    #[test]
    fn an_empty_file_is_valid() {
        let bytes = file(SPEC, &[]);
        assert_eq!(hound::WavReader::new(Cursor::new(bytes)).unwrap().len(), 0);
    }
}
