//! Colours over a frame: as rectangles where there are few, else as a picture within the SVG.
//!
//! A few cells stay rectangles, which no viewer blurs; many would make a file of megabytes, so that
//! they are embedded as PNG, one pixel a cell, to be enlarged without smoothing.

use super::pixels::png;
use super::{FigureError, Raster};

/// Up to this many cells are drawn as rectangles.
const MOST_RECTANGLES: usize = 600;

/// A raster on the page: upper left corner, width and height, px.
#[derive(Debug, Clone)]
pub(super) struct Placed<'a> {
    pub(super) raster: &'a Raster,
    pub(super) corner_px: [f64; 2],
    pub(super) size_px: [f64; 2],
}

impl Placed<'_> {
    /// Whether it is a picture within the SVG, not rectangles.
    pub(super) fn is_picture(&self) -> bool {
        self.raster.cells.len() > MOST_RECTANGLES
    }

    /// Cells of one colour that follow one another in a row, as rectangles.
    pub(super) fn rectangles(&self) -> String {
        let Raster { n_columns, cells } = self.raster;
        let n_rows = self.raster.n_rows().max(1) as f64;
        let [cell_px, row_px] = [
            self.size_px[0] / (*n_columns).max(1) as f64,
            self.size_px[1] / n_rows,
        ];
        // Edges on whole pixels: smoothed ones would leave seams between neighbours.
        let mut out = String::from("<g shape-rendering=\"crispEdges\">\n");
        for (row, cells) in cells.chunks_exact((*n_columns).max(1)).enumerate() {
            let mut column = 0;
            for run in cells.chunk_by(|one, other| one == other) {
                if let Some(colour) = run.first().copied().flatten() {
                    let x = self.corner_px[0] + column as f64 * cell_px;
                    let y = self.corner_px[1] + row as f64 * row_px;
                    let width = run.len() as f64 * cell_px;
                    let fill = hex(colour);
                    let rect = format!(
                        "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{width:.2}\" \
                         height=\"{row_px:.2}\" fill=\"{fill}\"/>\n"
                    );
                    out.push_str(&rect);
                }
                column += run.len();
            }
        }
        out + "</g>\n"
    }

    /// An image with its pixels within.
    pub(super) fn image(&self) -> Result<String, FigureError> {
        let ([x, y], [width, height]) = (self.corner_px, self.size_px);
        let data = base64(&png(self.raster)?);
        Ok(format!(
            "<image x=\"{x:.2}\" y=\"{y:.2}\" width=\"{width:.2}\" height=\"{height:.2}\" \
             preserveAspectRatio=\"none\" image-rendering=\"optimizeSpeed\" \
             style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{data}\"/>\n"
        ))
    }
}

/// A colour as SVG spells it.
pub(super) fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Bytes as base64 with padding (RFC 4648, section 4).
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let at = |i: usize| u32::from(three.get(i).copied().unwrap_or(0));
        let bits = at(0) << 16 | at(1) << 8 | at(2);
        for i in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * i) & 63) as usize];
            let is_padding = i > three.len();
            out.push(if is_padding { '=' } else { char::from(digit) });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_its_standard() {
        // RFC 4648, section 10.
        for (bytes, digits) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(bytes.as_bytes()), digits);
        }
    }

    #[test]
    fn equal_neighbours_are_one_rectangle_and_nothing_is_none() {
        let (red, blue) = (Some([255, 0, 0]), Some([0, 0, 255]));
        let raster = Raster {
            n_columns: 3,
            cells: vec![red, red, blue, None, blue, blue],
        };
        let placed = Placed {
            raster: &raster,
            corner_px: [10.0, 20.0],
            size_px: [30.0, 8.0],
        };
        let svg = placed.rectangles();
        assert_eq!(svg.matches("<rect").count(), 3, "{svg}");
        assert!(
            svg.contains(
                "x=\"20.00\" y=\"24.00\" width=\"20.00\" height=\"4.00\" fill=\"#0000ff\""
            ),
            "{svg}"
        );
    }
}
