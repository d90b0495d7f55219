//! Pictures of the common formats (PNG, JPEG, TIFF, BMP), 8 or 16 bits, grey or coloured; PNG out.
//!
//! What a file is, its content says. Its size is checked before anything of that size is held.

use std::io::Cursor;
use std::path::Path;

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{
    DynamicImage, ExtendedColorType, ImageDecoder as _, ImageEncoder as _, ImageError, ImageFormat,
    ImageReader, Limits,
};

use super::FileError;

/// Largest picture that is decoded, pixels.
const MAX_PIXELS: u64 = 64_000_000;

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

/// What a decoder may hold beside the pixels, bytes.
const ROOM: u64 = 1 << 26;
/// Bytes of a pixel in the largest format that is decoded (four floats).
const MAX_BYTES: u64 = 16;
const FORMATS: [ImageFormat; 4] = [
    ImageFormat::Png,
    ImageFormat::Jpeg,
    ImageFormat::Tiff,
    ImageFormat::Bmp,
];

/// How the names of pictures end that are decoded, in lower case.
pub const PICTURE_ENDINGS: [&str; 6] = ["png", "jpg", "jpeg", "tif", "tiff", "bmp"];

/// Whether a file begins as a picture that is decoded.
pub fn is_picture(head: &[u8]) -> bool {
    image::guess_format(head).is_ok_and(|format| FORMATS.contains(&format))
}

impl Rgb16Image {
    /// Decodes a picture of at most 64 million pixels to red, green and blue of 16 bits. `path`
    /// only names it in errors.
    ///
    /// # Errors
    /// What is no such picture, is damaged, or is larger.
    pub fn decode(bytes: &[u8], path: &Path) -> Result<Self, FileError> {
        let mend = "give an intact PNG, JPEG, TIFF or BMP picture";
        let picture = decode(bytes, path, &FORMATS, mend)?;
        let n_bits = match picture {
            DynamicImage::ImageLuma8(_)
            | DynamicImage::ImageLumaA8(_)
            | DynamicImage::ImageRgb8(_)
            | DynamicImage::ImageRgba8(_) => 8,
            _ => 16,
        };
        Ok(Self {
            width: picture.width() as usize,
            height: picture.height() as usize,
            pixels: pixels(picture),
            n_bits,
        })
    }
}

impl Rgb8Image {
    /// Decodes a PNG of any colour type to 8-bit RGB. `path` only names it in errors.
    ///
    /// # Errors
    /// What is no PNG, is damaged, or has more than 64 million pixels.
    pub fn from_png(bytes: &[u8], path: &Path) -> Result<Self, FileError> {
        let formats = [ImageFormat::Png];
        let picture = decode(bytes, path, &formats, "give an intact PNG picture")?.into_rgb8();
        Ok(Self {
            width: picture.width() as usize,
            height: picture.height() as usize,
            pixels: picture.pixels().map(|pixel| pixel.0).collect(),
        })
    }
}

fn decode(
    bytes: &[u8],
    path: &Path,
    formats: &[ImageFormat],
    mend: &str,
) -> Result<DynamicImage, FileError> {
    let wrong = |error: ImageError| FileError::whole(path, damage(&error), mend);
    let format = image::guess_format(bytes).ok();
    let Some(format) = format.filter(|format| formats.contains(format)) else {
        let what = "this is no picture of a known format";
        return Err(FileError::whole(path, what, mend));
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
    DynamicImage::from_decoder(decoder).map_err(wrong)
}

/// What is wrong with a picture. The decoders' own words are for their authors.
fn damage(error: &ImageError) -> &'static str {
    match error {
        ImageError::Unsupported(_) => "this picture is packed in a way that is not read",
        ImageError::Limits(_) => "this picture takes more memory than a picture may",
        _ => "this picture is damaged or cut short",
    }
}

impl Rgb8Image {
    /// Encodes a picture as PNG.
    pub fn to_png(&self, path: &Path) -> Result<Vec<u8>, FileError> {
        encode_rgb(self, Packing::default(), path)
    }

    /// Encodes a picture of few colours as PNG, slowly and small: the best compression, no filter.
    pub fn to_small_png(&self, path: &Path) -> Result<Vec<u8>, FileError> {
        encode_rgb(self, (CompressionType::Best, FilterType::NoFilter), path)
    }
}

/// Encodes rows of 8-bit red, green, blue and alpha (not premultiplied) as PNG.
pub fn encode_png_rgba(
    rgba: &[u8],
    width: usize,
    height: usize,
    path: &Path,
) -> Result<Vec<u8>, FileError> {
    let colour = ExtendedColorType::Rgba8;
    encode(rgba, ([width, height], colour), Packing::default(), path)
}

type Packing = (CompressionType, FilterType);

fn encode_rgb(picture: &Rgb8Image, packing: Packing, path: &Path) -> Result<Vec<u8>, FileError> {
    let layout = ([picture.width, picture.height], ExtendedColorType::Rgb8);
    encode(picture.pixels.as_flattened(), layout, packing, path)
}

fn encode(
    bytes: &[u8],
    ([width, height], colour): ([usize; 2], ExtendedColorType),
    (compression, filter): Packing,
    path: &Path,
) -> Result<Vec<u8>, FileError> {
    let failed = |what: String| FileError::content(path, 1, what, "this cannot be saved as PNG");
    let size = |n: usize| u32::try_from(n).map_err(|error| failed(error.to_string()));
    let (columns, rows) = (size(width)?, size(height)?);
    let expected = width * height * usize::from(colour.bits_per_pixel() / 8);
    if bytes.len() != expected {
        let n_bytes = bytes.len();
        return Err(failed(format!(
            "{n_bytes} bytes for {width} × {height} pixels"
        )));
    }
    let mut png = Vec::new();
    PngEncoder::new_with_quality(&mut png, compression, filter)
        .write_image(bytes, columns, rows, colour)
        .map_err(|error| failed(error.to_string()))?;
    Ok(png)
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
    use crate::files::GrayImage;

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
        let png = picture.to_png(Path::new("a.png")).unwrap();
        assert_eq!(
            Rgb8Image::from_png(&png, Path::new("a.png")).unwrap(),
            picture
        );
    }

    #[test]
    fn nonsense_and_truncated_pictures_are_refused_by_name() {
        let picture = Rgb8Image {
            width: 40,
            height: 40,
            pixels: vec![[7, 90, 200]; 1600],
        };
        let png = picture.to_png(Path::new("a.png")).unwrap();
        for bytes in [b"not a picture".as_slice(), &png[..png.len() / 2], b""] {
            let error = Rgb8Image::from_png(bytes, Path::new("b.png"))
                .unwrap_err()
                .to_string();
            assert!(error.starts_with("b.png: this "), "{error}");
        }
    }

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
        for bytes in [grey.to_png(at()).unwrap(), grey.to_tiff(at()).unwrap()] {
            let read = Rgb16Image::decode(&bytes, at()).unwrap();
            assert_eq!(read.pixels, [[0; 3], [12_345; 3], [65_535; 3]]);
            assert_eq!(read.n_bits, 16);
        }
        let colours = Rgb8Image {
            width: 1,
            height: 2,
            pixels: vec![[0, 128, 255], [1, 2, 3]],
        };
        let read = Rgb16Image::decode(&colours.to_png(at()).unwrap(), at()).unwrap();
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
        let error = Rgb16Image::decode(&bitmap(20_000, 20_000), at())
            .unwrap_err()
            .to_string();
        let expected =
            "a.png: 20000 × 20000 pixels where 1 to 64 million are read; scale it down or cut it";
        assert_eq!(error, expected);
        let read = Rgb16Image::decode(&bitmap(1, 1), at()).unwrap();
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
        let png = picture.to_png(at()).unwrap();
        for bytes in [
            &png[..png.len() / 2],
            b"GIF89a....",
            b"no picture",
            b"",
            &png[..20],
        ] {
            let error = Rgb16Image::decode(bytes, at()).unwrap_err().to_string();
            assert!(
                error.starts_with("a.png: this ") && error.ends_with("BMP picture"),
                "{error}"
            );
        }
    }

    #[test]
    fn a_broken_chunk_is_told_in_words_and_not_in_the_decoders_types() {
        let picture = Rgb8Image {
            width: 9,
            height: 7,
            pixels: vec![[7, 90, 200]; 63],
        };
        let png = picture.to_png(at()).unwrap();
        for at_byte in 8..png.len() {
            let mut broken = png.clone();
            broken[at_byte] ^= 0x20;
            for error in [
                Rgb8Image::from_png(&broken, at()).err(),
                Rgb16Image::decode(&broken, at()).err(),
                GrayImage::from_png(&broken, at(), 63).err(),
            ] {
                let error = error.map_or_else(String::new, |error| error.to_string());
                let foreign = ["{", "(", "ChunkType", "Crc", "IHDR", "Some"];
                let is_plain = !foreign.iter().any(|word| error.contains(word));
                assert!(is_plain, "byte {at_byte}: {error}");
            }
        }
    }

    proptest::proptest! {
        #[test]
        fn no_damage_makes_the_decoder_panic(at in 0..200_usize, byte in proptest::num::u8::ANY) {
            let picture = Rgb8Image { width: 9, height: 7, pixels: vec![[7, 90, 200]; 63] };
            let mut png = picture.to_png(Path::new("a.png")).unwrap();
            let at = at % png.len();
            png[at] = byte;
            if let Ok(decoded) = Rgb8Image::from_png(&png, Path::new("a.png")) {
                proptest::prop_assert_eq!(decoded.pixels.len(), decoded.width * decoded.height);
            }
        }
    }
}
