//! Pictures of the common formats (PNG, JPEG, TIFF, BMP), 8 or 16 bits, grey or coloured.
//!
//! What a file is, its content says. Its size is checked before anything of that size is held.

use std::io::Cursor;
use std::path::Path;

use image::{DynamicImage, ImageDecoder as _, ImageFormat, ImageReader, Limits};

use super::FileError;
use super::picture::MAX_PIXELS;

/// A picture of red, green and blue in 16 bits each, row by row from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rgb16Image {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green and blue of every pixel, 0 to 65535; 8 bits were multiplied by 257. What was
    /// transparent stands on white.
    pub pixels: Vec<[u16; 3]>,
    /// Bits of a channel in the file: 8, or 16 and more.
    pub(crate) n_bits: u8,
}

const MEND: &str = "give an intact PNG, JPEG, TIFF or BMP picture";
/// What a decoder may hold beside the pixels, bytes.
const ROOM: u64 = 1 << 26;
/// Bytes of a pixel in the largest format that is decoded (four floats).
const MAX_BYTES: u64 = 16;

/// Decodes a picture of at most 64 million pixels. `path` only names it in errors.
///
/// # Errors
/// What is no such picture, is damaged, or is larger.
pub fn decode_picture(bytes: &[u8], path: &Path) -> Result<Rgb16Image, FileError> {
    let wrong = |error: image::ImageError| {
        let what = error.to_string().replace('\n', " ");
        FileError::whole(path, format!("this cannot be read: {what}"), MEND)
    };
    let format = image::guess_format(bytes).ok();
    let format = format.filter(|format| {
        use ImageFormat::{Bmp, Jpeg, Png, Tiff};
        matches!(format, Bmp | Jpeg | Png | Tiff)
    });
    let Some(format) = format else {
        let what = "this is no picture of a known format";
        return Err(FileError::whole(path, what, MEND));
    };
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = Limits::default();
    limits.max_alloc = Some(MAX_PIXELS * MAX_BYTES + ROOM);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(wrong)?;
    let (width, height) = decoder.dimensions();
    let n_pixels = u64::from(width) * u64::from(height);
    if n_pixels > MAX_PIXELS || n_pixels == 0 {
        let what = format!("{width} × {height} pixels where 1 to 64 million are read");
        return Err(FileError::whole(path, what, "scale it down or cut it"));
    }
    let picture = DynamicImage::from_decoder(decoder).map_err(wrong)?;
    let n_bits = match picture {
        DynamicImage::ImageLuma8(_)
        | DynamicImage::ImageLumaA8(_)
        | DynamicImage::ImageRgb8(_)
        | DynamicImage::ImageRgba8(_) => 8,
        _ => 16,
    };
    Ok(Rgb16Image {
        width: width as usize,
        height: height as usize,
        pixels: pixels(picture),
        n_bits,
    })
}

fn pixels(picture: DynamicImage) -> Vec<[u16; 3]> {
    let wide = |value: u8| u16::from(value) * 257;
    match picture {
        DynamicImage::ImageLuma8(grey) => {
            grey.into_raw().into_iter().map(|v| [wide(v); 3]).collect()
        }
        DynamicImage::ImageLuma16(grey) => grey.into_raw().into_iter().map(|v| [v; 3]).collect(),
        DynamicImage::ImageRgb8(colours) => colours.pixels().map(|p| p.0.map(wide)).collect(),
        DynamicImage::ImageRgb16(colours) => colours.pixels().map(|p| p.0).collect(),
        other => other
            .into_rgba16()
            .pixels()
            .map(|p| on_white(p.0))
            .collect(),
    }
}

/// A colour of some opacity on white.
fn on_white([red, green, blue, alpha]: [u16; 4]) -> [u16; 3] {
    let (alpha, white) = (u32::from(alpha), u32::from(u16::MAX));
    [red, green, blue].map(|value| {
        let mixed = (u32::from(value) * alpha + white * (white - alpha) + white / 2) / white;
        u16::try_from(mixed).unwrap_or(u16::MAX)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::{GrayImage, Rgb8Image, encode_gray_png, encode_gray_tiff, encode_png};

    fn at() -> &'static Path {
        Path::new("a.png")
    }

    #[test]
    fn sixteen_bits_are_kept_and_eight_are_spread() {
        let grey = GrayImage {
            width: 3,
            height: 1,
            values: vec![0, 12_345, 65_535],
            white: u16::MAX,
            texts: Vec::new(),
        };
        for bytes in [
            encode_gray_png(&grey, at()).unwrap(),
            encode_gray_tiff(&grey, at()).unwrap(),
        ] {
            let read = decode_picture(&bytes, at()).unwrap();
            assert_eq!(read.pixels, [[0; 3], [12_345; 3], [65_535; 3]]);
            assert_eq!(read.n_bits, 16);
        }
        let colours = Rgb8Image {
            width: 1,
            height: 2,
            pixels: vec![[0, 128, 255], [1, 2, 3]],
        };
        let read = decode_picture(&encode_png(&colours, at()).unwrap(), at()).unwrap();
        assert_eq!(read.pixels, [[0, 32_896, 65_535], [257, 514, 771]]);
        assert_eq!((read.width, read.height, read.n_bits), (1, 2, 8));
    }

    #[test]
    fn what_is_transparent_stands_on_white() {
        assert_eq!(on_white([0, 65_535, 100, 0]), [65_535; 3]);
        assert_eq!(on_white([0, 65_535, 100, 65_535]), [0, 65_535, 100]);
    }

    /// A bitmap file that says it is `width` × `height` and holds one pixel.
    fn bitmap(width: u32, height: u32) -> Vec<u8> {
        let mut bytes = b"BM".to_vec();
        for number in [
            58_u32,
            0,
            54,
            40,
            width,
            height,
            0x0018_0001,
            0,
            4,
            0,
            0,
            0,
            0,
            0,
        ] {
            bytes.extend(number.to_le_bytes());
        }
        bytes
    }

    #[test]
    fn a_size_beyond_the_limit_is_refused_before_it_is_decoded() {
        let error = decode_picture(&bitmap(20_000, 20_000), at())
            .unwrap_err()
            .to_string();
        let expected =
            "a.png: 20000 × 20000 pixels where 1 to 64 million are read; scale it down or cut it";
        assert_eq!(error, expected);
        let read = decode_picture(&bitmap(1, 1), at()).unwrap();
        assert_eq!(read.pixels.len(), 1);
    }

    #[test]
    fn truncated_pictures_and_other_files_are_refused_with_their_name() {
        let picture = Rgb8Image {
            width: 60,
            height: 60,
            pixels: (0..3600_u16)
                .map(|i| [i.to_le_bytes()[0], 7, i.to_le_bytes()[1]])
                .collect(),
        };
        let png = encode_png(&picture, at()).unwrap();
        for bytes in [
            &png[..png.len() / 2],
            b"GIF89a....",
            b"no picture",
            b"",
            &png[..20],
        ] {
            let error = decode_picture(bytes, at()).unwrap_err().to_string();
            assert!(
                error.starts_with("a.png: this ") && error.ends_with(MEND),
                "{error}"
            );
        }
    }
}
