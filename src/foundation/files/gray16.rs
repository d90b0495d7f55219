//! Grey pictures of 8 or 16 bits, PNG and TIFF, with the texts that they carry.
//!
//! Sizes are checked before anything is decoded.

use std::io::Cursor;
use std::path::Path;

use tiff::decoder::{Decoder as TiffDecoder, DecodingResult, Limits};
use tiff::encoder::{TiffEncoder, colortype};
use tiff::tags::Tag;

use super::{FileError, Number};

/// A grey picture, row by row from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct GrayImage {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Grey values, 0 to [`GrayImage::white`].
    pub values: Vec<u16>,
    /// The value of white: 255 or 65535.
    pub white: u16,
    /// Texts by key.
    pub texts: Vec<(String, String)>,
}

impl GrayImage {
    /// A picture of 16 bits of shares of white, 0 to 1, row by row from the top.
    pub fn of_shares([width, height]: [usize; 2], shares: impl Iterator<Item = f64>) -> Self {
        Self {
            width,
            height,
            values: Self::values_of(shares),
            white: u16::MAX,
            texts: Vec::new(),
        }
    }

    /// The text of a key.
    pub fn text(&self, key: &str) -> Option<&str> {
        let found = self.texts.iter().find(|(name, _)| name == key);
        found.map(|(_, text)| text.as_str())
    }
}

const GREY_MEND: &str = "save it as a grey picture of 8 or 16 bits";
/// Deflate packs at most about 1032 bytes into one.
const MAX_PACKED: usize = 1100;
/// What a decoder may hold of even the smallest picture, bytes.
const MIN_BUFFER: usize = 1 << 16;

/// Refuses a size beyond `most` pixels, or one that `n_bytes` of a file cannot hold.
fn check_size(
    path: &Path,
    [width, height]: [u32; 2],
    most: usize,
    n_bytes: usize,
) -> Result<[usize; 2], FileError> {
    let size = [width, height].map(|n| usize::try_from(n).unwrap_or(usize::MAX));
    let n = size[0].saturating_mul(size[1]);
    if n > most || n == 0 {
        let what = format!("{width} × {height} pixels where 1 to {most} are read");
        return Err(FileError::whole(
            path,
            what,
            "cut out or scale down what you need",
        ));
    }
    if n > n_bytes.saturating_mul(MAX_PACKED) {
        let what = format!("{width} × {height} pixels cannot be in {n_bytes} bytes");
        return Err(FileError::whole(path, what, "get an intact copy"));
    }
    Ok(size)
}

impl GrayImage {
    /// Decodes a grey PNG of at most `most` pixels. `path` only names it in errors.
    ///
    /// # Errors
    /// What is no grey PNG, is damaged, or is larger.
    pub fn from_png(bytes: &[u8], path: &Path, most: usize) -> Result<Self, FileError> {
        // The decoder's own words are for its authors.
        let damaged = |_error: png::DecodingError| {
            let what = "this picture is damaged or cut short";
            FileError::whole(path, what, "give an intact PNG picture")
        };
        let mut decoder = png::Decoder::new(Cursor::new(bytes));
        decoder.set_transformations(png::Transformations::IDENTITY);
        let info = decoder.read_header_info().map_err(damaged)?;
        let [width, height] = check_size(path, [info.width, info.height], most, bytes.len())?;
        let depth = info.bit_depth;
        if info.color_type != png::ColorType::Grayscale {
            return Err(FileError::whole(path, "the picture is coloured", GREY_MEND));
        }
        let white = match depth {
            png::BitDepth::Eight => 255,
            png::BitDepth::Sixteen => u16::MAX,
            _ => {
                return Err(FileError::whole(
                    path,
                    "fewer than 8 bits a pixel",
                    GREY_MEND,
                ));
            }
        };
        let mut reader = decoder.read_info().map_err(damaged)?;
        let mut data = vec![0; width * height * if white == 255 { 1 } else { 2 }];
        reader.next_frame(&mut data).map_err(damaged)?;
        // Texts may stand after the pixels.
        reader.finish().map_err(damaged)?;
        let values = if white == 255 {
            data.into_iter().map(u16::from).collect()
        } else {
            let pairs = data.as_chunks().0.iter();
            pairs.map(|&pair| u16::from_be_bytes(pair)).collect()
        };
        Ok(Self {
            width,
            height,
            values,
            white,
            texts: png_texts(reader.info()),
        })
    }
}

fn png_texts(info: &png::Info<'_>) -> Vec<(String, String)> {
    let plain = info.uncompressed_latin1_text.iter();
    let plain = plain.map(|chunk| (chunk.keyword.clone(), chunk.text.clone()));
    let wide = info.utf8_text.iter();
    let wide = wide.filter_map(|chunk| Some((chunk.keyword.clone(), chunk.get_text().ok()?)));
    plain.chain(wide).collect()
}

impl GrayImage {
    /// Encodes a picture as PNG of 16 bits with its texts.
    ///
    /// # Errors
    /// A size or a text that PNG cannot hold.
    pub fn to_png(&self, path: &Path) -> Result<Vec<u8>, FileError> {
        let failed = |error: png::EncodingError| cannot(path, error.to_string(), "PNG");
        let [width, height] = sizes(self, path, "PNG")?;
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(png::BitDepth::Sixteen);
        for (key, text) in &self.texts {
            let added = encoder.add_itxt_chunk(key.clone(), text.clone());
            added.map_err(failed)?;
        }
        let mut writer = encoder.write_header().map_err(failed)?;
        let data: Vec<u8> = self.values.iter().flat_map(|v| v.to_be_bytes()).collect();
        writer.write_image_data(&data).map_err(failed)?;
        writer.finish().map_err(failed)?;
        Ok(bytes)
    }

    /// Decodes a grey TIFF of at most `most` pixels; the lines `key value` of its description are
    /// its texts. `path` only names it in errors.
    ///
    /// # Errors
    /// What is no grey TIFF, is damaged, packed in a way that is not read, or is larger.
    pub fn from_tiff(bytes: &[u8], path: &Path, most: usize) -> Result<Self, FileError> {
        let damaged = |error: tiff::TiffError| {
            let what = match error {
                tiff::TiffError::UnsupportedError(_) => {
                    "this picture is packed in a way not read here"
                }
                _ => "this picture is damaged or cut short",
            };
            let mend = "give an intact TIFF picture, not packed or packed by deflate";
            FileError::whole(path, what, mend)
        };
        let mut limits = Limits::default();
        limits.decoding_buffer_size = most.saturating_mul(2).max(MIN_BUFFER);
        limits.intermediate_buffer_size = limits.decoding_buffer_size;
        let decoder = TiffDecoder::new(Cursor::new(bytes)).map_err(damaged)?;
        let mut decoder = decoder.with_limits(limits);
        let (width, height) = decoder.dimensions().map_err(damaged)?;
        let [width, height] = check_size(path, [width, height], most, bytes.len())?;
        let description = decoder.find_tag(Tag::ImageDescription).map_err(damaged)?;
        let description = description.and_then(|value| value.into_string().ok());
        match decoder.colortype().map_err(damaged)? {
            tiff::ColorType::Gray(8 | 16) => {}
            _ => return Err(FileError::whole(path, "the picture is not grey", GREY_MEND)),
        }
        let (values, white) = match decoder.read_image().map_err(damaged)? {
            DecodingResult::U8(data) => (data.into_iter().map(u16::from).collect(), 255),
            DecodingResult::U16(data) => (data, u16::MAX),
            _ => return Err(FileError::whole(path, "numbers with a sign", GREY_MEND)),
        };
        if values.len() != width * height {
            let what = format!("{} values for {width} × {height} pixels", values.len());
            return Err(FileError::whole(path, what, "give an intact TIFF picture"));
        }
        let lines = description.as_deref().unwrap_or_default().lines();
        let pair = |line: &str| {
            let (key, text) = line.split_once(' ')?;
            Some((key.to_owned(), text.trim().to_owned()))
        };
        Ok(Self {
            width,
            height,
            values,
            white,
            texts: lines.filter_map(pair).collect(),
        })
    }

    /// Encodes a picture as TIFF of 16 bits, not packed, its texts as lines of its description.
    ///
    /// # Errors
    /// A size that TIFF cannot hold.
    pub fn to_tiff(&self, path: &Path) -> Result<Vec<u8>, FileError> {
        let failed = |error: tiff::TiffError| cannot(path, error.to_string(), "TIFF");
        let [width, height] = sizes(self, path, "TIFF")?;
        let mut bytes = Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut bytes).map_err(failed)?;
        let mut image = encoder
            .new_image::<colortype::Gray16>(width, height)
            .map_err(failed)?;
        let lines: Vec<String> = self
            .texts
            .iter()
            .map(|(key, text)| format!("{key} {}", text.replace('\n', " ")))
            .collect();
        let description = lines.join("\n");
        let written = image
            .encoder()
            .write_tag(Tag::ImageDescription, description.as_str());
        written.map_err(failed)?;
        image.write_data(&self.values).map_err(failed)?;
        Ok(bytes.into_inner())
    }
}

fn sizes(picture: &GrayImage, path: &Path, format: &str) -> Result<[u32; 2], FileError> {
    let is_whole = picture.values.len() == picture.width * picture.height;
    let size = |n: usize| u32::try_from(n).ok();
    match (size(picture.width), size(picture.height), is_whole) {
        (Some(width), Some(height), true) => Ok([width, height]),
        _ => Err(cannot(path, "its size is wrong".to_owned(), format)),
    }
}

fn cannot(path: &Path, what: String, format: &str) -> FileError {
    FileError::whole(path, what, format!("this cannot be saved as {format}"))
}

impl GrayImage {
    /// Grey values from shares of white, 0 to 1.
    fn values_of(shares: impl Iterator<Item = f64>) -> Vec<u16> {
        let bytes = Number::U16.encode(shares.map(|share| share * f64::from(u16::MAX)));
        let pairs = bytes.as_chunks().0.iter();
        pairs.map(|&pair| u16::from_le_bytes(pair)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture() -> GrayImage {
        GrayImage {
            width: 3,
            height: 2,
            values: vec![0, 1, 256, 65535, 40000, 77],
            white: u16::MAX,
            texts: vec![
                ("Gwy::XReal".to_owned(), "0.01".to_owned()),
                ("Gwy::ZUnit".to_owned(), "m".to_owned()),
            ],
        }
    }

    #[test]
    fn pictures_come_back_with_their_texts() {
        let path = Path::new("a");
        let png = picture().to_png(path).unwrap();
        assert_eq!(GrayImage::from_png(&png, path, 6).unwrap(), picture());
        let tiff = picture().to_tiff(path).unwrap();
        assert_eq!(GrayImage::from_tiff(&tiff, path, 6).unwrap(), picture());
        assert_eq!(picture().text("Gwy::ZUnit"), Some("m"));
        assert_eq!(
            GrayImage::values_of([0.0, 0.5, 1.0].into_iter()),
            [0, 32768, 65535]
        );
    }

    #[test]
    fn large_damaged_and_coloured_pictures_are_refused() {
        let path = Path::new("a");
        let png = picture().to_png(path).unwrap();
        let tiff = picture().to_tiff(path).unwrap();
        let error = GrayImage::from_png(&png, path, 5).unwrap_err().to_string();
        assert!(error.contains("3 × 2 pixels where 1 to 5"), "{error}");
        assert!(GrayImage::from_tiff(&tiff, path, 5).is_err());
        assert!(GrayImage::from_png(&png[..png.len() - 30], path, 6).is_err());
        assert!(GrayImage::from_tiff(&tiff[..20], path, 6).is_err());
        let colours = super::super::Rgb8Image {
            width: 1,
            height: 1,
            pixels: vec![[1, 2, 3]],
        };
        let coloured = colours.to_png(path).unwrap();
        let error = GrayImage::from_png(&coloured, path, 6)
            .unwrap_err()
            .to_string();
        assert!(error.contains("coloured"), "{error}");
    }
}
