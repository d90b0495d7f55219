//! Pictures: 8-bit PNG in and out.
//!
//! Sizes are checked before anything is decoded.

use std::io::Cursor;
use std::path::Path;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageDecoder as _, ImageEncoder as _};

use super::FileError;

/// Largest picture that is decoded, pixels.
pub(super) const MAX_PIXELS: u64 = 64_000_000;

/// A picture of 8-bit red, green and blue, row by row from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rgb8Image {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green, blue of every pixel.
    pub pixels: Vec<[u8; 3]>,
}

/// Decodes a PNG of any colour type to 8-bit RGB. `path` only names it in errors.
pub fn decode_png(bytes: &[u8], path: &Path) -> Result<Rgb8Image, FileError> {
    let wrong = |what: String| FileError::content(path, 1, what, "give an intact PNG picture");
    let decoder = image::codecs::png::PngDecoder::new(Cursor::new(bytes))
        .map_err(|error| wrong(error.to_string()))?;
    let (width, height) = decoder.dimensions();
    if u64::from(width) * u64::from(height) > MAX_PIXELS {
        return Err(wrong(format!(
            "{width} × {height} pixels are more than 64 million"
        )));
    }
    let picture = image::DynamicImage::from_decoder(decoder)
        .map_err(|error| wrong(error.to_string()))?
        .into_rgb8();
    let pixels = picture.pixels().map(|pixel| pixel.0).collect();
    Ok(Rgb8Image {
        width: width as usize,
        height: height as usize,
        pixels,
    })
}

/// Encodes a picture as PNG.
pub fn encode_png(picture: &Rgb8Image, path: &Path) -> Result<Vec<u8>, FileError> {
    let bytes: Vec<u8> = picture.pixels.iter().flatten().copied().collect();
    encode(
        &bytes,
        picture.width,
        picture.height,
        ExtendedColorType::Rgb8,
        path,
    )
}

/// Encodes a picture of few colours as PNG, slowly and small: the best compression, no filter.
pub fn encode_png_small(picture: &Rgb8Image, path: &Path) -> Result<Vec<u8>, FileError> {
    let bytes: Vec<u8> = picture.pixels.iter().flatten().copied().collect();
    let mut png = Vec::new();
    let (compression, filter) = (CompressionType::Best, FilterType::NoFilter);
    let encoder = PngEncoder::new_with_quality(&mut png, compression, filter);
    let size = [picture.width, picture.height];
    write_image(encoder, &bytes, size, ExtendedColorType::Rgb8, path)?;
    Ok(png)
}

/// Encodes rows of 8-bit red, green, blue and alpha (not premultiplied) as PNG.
pub fn encode_png_rgba(
    rgba: &[u8],
    width: usize,
    height: usize,
    path: &Path,
) -> Result<Vec<u8>, FileError> {
    encode(rgba, width, height, ExtendedColorType::Rgba8, path)
}

fn encode(
    bytes: &[u8],
    width: usize,
    height: usize,
    colour: ExtendedColorType,
    path: &Path,
) -> Result<Vec<u8>, FileError> {
    let mut png = Vec::new();
    write_image(
        PngEncoder::new(&mut png),
        bytes,
        [width, height],
        colour,
        path,
    )?;
    Ok(png)
}

fn write_image(
    encoder: PngEncoder<&mut Vec<u8>>,
    bytes: &[u8],
    [width, height]: [usize; 2],
    colour: ExtendedColorType,
    path: &Path,
) -> Result<(), FileError> {
    let failed = |what: String| FileError::content(path, 1, what, "this cannot be saved as PNG");
    let size = |n: usize| u32::try_from(n).map_err(|error| failed(error.to_string()));
    let (columns, rows) = (size(width)?, size(height)?);
    let expected = width * height * usize::from(colour.bits_per_pixel() / 8);
    if bytes.len() != expected {
        return Err(failed(format!(
            "{} bytes for {width} × {height} pixels",
            bytes.len()
        )));
    }
    encoder
        .write_image(bytes, columns, rows, colour)
        .map_err(|error| failed(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_survive_encoding_and_decoding() {
        let pixels = vec![
            [1, 2, 3],
            [4, 5, 6],
            [7, 8, 9],
            [250, 0, 255],
            [0, 0, 0],
            [9, 9, 9],
        ];
        let picture = Rgb8Image {
            width: 3,
            height: 2,
            pixels,
        };
        let png = encode_png(&picture, Path::new("a.png")).unwrap();
        assert_eq!(decode_png(&png, Path::new("a.png")).unwrap(), picture);
    }

    #[test]
    fn nonsense_and_truncated_pictures_are_refused_by_name() {
        let picture = Rgb8Image {
            width: 40,
            height: 40,
            pixels: vec![[7, 90, 200]; 1600],
        };
        let png = encode_png(&picture, Path::new("a.png")).unwrap();
        for bytes in [b"not a picture".as_slice(), &png[..png.len() / 2], b""] {
            let error = decode_png(bytes, Path::new("b.png"))
                .unwrap_err()
                .to_string();
            assert!(error.starts_with("b.png:1: "), "{error}");
        }
    }

    proptest::proptest! {
        #[test]
        fn no_damage_makes_the_decoder_panic(at in 0..200_usize, byte in proptest::num::u8::ANY) {
            let picture = Rgb8Image { width: 9, height: 7, pixels: vec![[7, 90, 200]; 63] };
            let mut png = encode_png(&picture, Path::new("a.png")).unwrap();
            let at = at % png.len();
            png[at] = byte;
            if let Ok(decoded) = decode_png(&png, Path::new("a.png")) {
                proptest::prop_assert_eq!(decoded.pixels.len(), decoded.width * decoded.height);
            }
        }
    }
}
