//! Zlib streams in and out, with a limit on what may come out.

use std::io::{Read as _, Write as _};
use std::path::Path;

use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;

use super::FileError;

/// Inflates a zlib stream to exactly `n_bytes`. `path` only names the file in errors.
///
/// # Errors
/// A damaged stream, or one of another length.
pub fn inflate(bytes: &[u8], n_bytes: usize, path: &Path) -> Result<Vec<u8>, FileError> {
    let limit = u64::try_from(n_bytes).unwrap_or(u64::MAX);
    let mut out = Vec::new();
    let read = ZlibDecoder::new(bytes)
        .take(limit.saturating_add(1))
        .read_to_end(&mut out);
    let wrong = |what: String| FileError::whole(path, what, "get an intact copy");
    read.map_err(|error| wrong(format!("the packed points are damaged: {error}")))?;
    if out.len() == n_bytes {
        return Ok(out);
    }
    Err(wrong(format!(
        "packed points do not come to the {n_bytes} bytes that the header promises"
    )))
}

/// Deflates bytes into a zlib stream.
pub fn deflate(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    // A vector takes everything.
    let written = encoder.write_all(bytes).and_then(|()| encoder.finish());
    written.unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_come_back_and_lengths_are_kept() {
        let path = Path::new("a.sur");
        let zeros = vec![0; 100_000];
        let packed = deflate(&zeros);
        assert!(packed.len() < 500);
        assert_eq!(inflate(&packed, zeros.len(), path).unwrap(), zeros);
        for n_bytes in [10, 99_999, 100_001] {
            assert!(inflate(&packed, n_bytes, path).is_err());
        }
        assert!(inflate(&packed[..20], zeros.len(), path).is_err());
    }
}
