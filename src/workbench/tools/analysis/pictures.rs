//! Figures of a section as pixels, drawn on a thread for the width and the theme at hand.

use std::sync::Arc;

use eframe::egui::ColorImage;

use crate::bench::latest::Computed;
use crate::tools::analysis::findings::Findings;
use selvedge_chart::Paper;
use selvedge_foundation::progress::{Cancelled, Progress};

/// Which figures are drawn, and how.
#[derive(Debug, Clone)]
pub(crate) struct Wanted {
    /// What they show.
    pub findings: Arc<Findings>,
    /// Of which section.
    pub section: usize,
    /// How wide, px of the screen.
    pub width_px: u32,
    /// What is behind them.
    pub paper: Paper,
}

impl Wanted {
    /// Whether these are the same figures, of whatever width.
    pub(crate) fn shows_the_same(&self, other: &Self) -> bool {
        let is_same = Arc::ptr_eq(&self.findings, &other.findings);
        is_same && self.section == other.section && self.paper == other.paper
    }
}

impl PartialEq for Wanted {
    fn eq(&self, other: &Self) -> bool {
        self.shows_the_same(other) && self.width_px == other.width_px
    }
}

/// Figures as they were drawn, in the order of the section, or why one was not.
#[derive(Debug)]
pub(crate) struct Pictures {
    /// Their pixels.
    pub images: Vec<Result<Arc<ColorImage>, String>>,
}

impl Computed<Wanted> for Pictures {
    const THREAD: &str = "selvedge-figures";

    fn compute(
        wanted: &Wanted,
        _: Option<(&Wanted, &Self)>,
        progress: &mut Progress<'_>,
    ) -> Result<Self, Cancelled> {
        let section = wanted.findings.analysis.sections.get(wanted.section);
        let figures = section.map_or(&[][..], |section| &section.figures);
        let mut images = Vec::new();
        for (nth, drawn) in figures.iter().enumerate() {
            progress.step(nth as f64 / figures.len() as f64, &drawn.key)?;
            let pixels = drawn.figure.to_pixels_on(wanted.paper, wanted.width_px);
            let image = pixels.map(|pixels| {
                let size = [pixels.width, pixels.height];
                Arc::new(ColorImage::from_rgba_unmultiplied(size, &pixels.rgba))
            });
            images.push(image.map_err(|error| error.to_string()));
        }
        Ok(Self { images })
    }

    fn broken(wanted: &Wanted, why: &str) -> Self {
        let section = wanted.findings.analysis.sections.get(wanted.section);
        let n = section.map_or(0, |section| section.figures.len());
        let images = (0..n).map(|_| Err(why.to_owned())).collect();
        Self { images }
    }

    fn serves(under_way: &Wanted, now: &Wanted) -> bool {
        under_way.shows_the_same(now)
    }
}
