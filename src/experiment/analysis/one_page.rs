//! All figures of an analysis below each other on one page, with a caption.

use std::path::Path;

use super::model::{Analysis, Drawn};
use super::write::pictures;
use crate::ExperimentError;
use selvedge_chart::{Figure, Row};

/// A page of figures.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OnePage {
    /// The page as SVG.
    pub svg: String,
    /// The same as PNG.
    pub png: Vec<u8>,
    /// What to print below it.
    pub caption: String,
}

impl Analysis {
    /// Every figure on one page, as files whose names begin like `out`; `None` without any figure.
    ///
    /// # Errors
    /// It cannot be drawn.
    pub fn one_page(&self, out: &Path) -> Result<Option<OnePage>, ExperimentError> {
        let all: Vec<&Drawn> = self.sections.iter().flat_map(|s| &s.figures).collect();
        let Some(first) = all.first() else {
            return Ok(None);
        };
        let mut notes: Vec<String> = Vec::new();
        for note in all.iter().flat_map(|drawn| &drawn.figure.notes) {
            if !notes.contains(note) {
                notes.push(note.clone());
            }
        }
        let page = Figure {
            title: self.title.clone(),
            rows: all.iter().flat_map(|drawn| titled_rows(drawn)).collect(),
            notes,
            about: first.figure.about.clone(),
        };
        let (svg, png) = pictures(&page, out)?;
        let caption = self.caption(&all);
        Ok(Some(OnePage { svg, png, caption }))
    }

    /// What is to be known first, then a line for each figure from top to bottom.
    fn caption(&self, figures: &[&Drawn]) -> String {
        let of = |section: &&super::Section| section.key != super::UNREAD;
        let first = self.sections.iter().find(of);
        let told = first.into_iter().flat_map(|section| &section.notes);
        let told = told.map(|note| note.replace("**", ""));
        let lines = (1..).zip(figures);
        let lines = lines.map(|(nth, drawn)| format!("({nth}) {}", drawn.figure.title));
        let parts = std::iter::once(self.title.clone()).chain(told).chain(lines);
        parts.collect::<Vec<_>>().join("\n") + "\n"
    }
}

/// The rows of a figure, the first panel under the figure's title.
fn titled_rows(drawn: &Drawn) -> Vec<Row> {
    let mut rows = drawn.figure.rows.clone();
    if let Some(panel) = rows.first_mut().and_then(|row| row.panels.first_mut()) {
        let title = &drawn.figure.title;
        panel.title = if panel.title.is_empty() {
            title.clone()
        } else {
            format!("{title}: {}", panel.title)
        };
    }
    rows
}
