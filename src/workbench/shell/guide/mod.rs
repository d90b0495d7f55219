//! The guide: the pages of `assets/guide`, to be read in the window and printed by commands.

pub(crate) mod markdown;
mod view;

use std::sync::LazyLock;

use crate::bench::pane::Pane;
use crate::shell::guide::markdown::{Block, Span, anchor, blocks};

pub(crate) use view::{Reading, show};

/// A page of the guide.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct GuidePage {
    /// What its file is called, without the ending.
    pub name: &'static str,
    /// What it is about, in a few words.
    pub about: &'static str,
    /// Its text, in Markdown.
    pub text: &'static str,
}

macro_rules! pages {
    ($($name:literal: $about:literal;)*) => {
        [$(GuidePage {
            name: $name,
            about: $about,
            text: include_str!(concat!("../../../../assets/guide/", $name, ".md")),
        },)*]
    };
}

/// All pages, in the order in which they are offered.
static PAGES: [GuidePage; 11] = pages! {
    "workbench": "The window";
    "panes": "What each pane shows";
    "textiles": "Textiles, libraries and scenes";
    "pictures": "From a picture to a textile";
    "friction": "Friction from a picture";
    "drape": "The hanging cloth";
    "bridge": "Devices";
    "experiments": "Experiments on people";
    "stage": "Before the public";
    "commands": "The command line";
    "report": "Studies: error against run time, stability";
};

/// All pages of the guide.
pub fn guide_pages() -> &'static [GuidePage] {
    &PAGES
}

/// The page on which panes are explained.
const PANES: &str = "panes";

/// Where the guide explains a pane.
pub(crate) fn page_of(pane: Pane) -> String {
    format!("{PANES}#{}", anchor(pane.title()))
}

/// What a pane shows, in the words with which the guide begins to explain it.
pub(crate) fn about(pane: Pane) -> &'static str {
    static ABOUT: LazyLock<[String; Pane::ALL.len()]> = LazyLock::new(|| {
        let blocks = page(PANES).map_or_else(Vec::new, |page| blocks(page.text));
        Pane::ALL.map(|pane| {
            let heading = Block::Heading(2, pane.title().to_owned());
            let place = blocks.iter().position(|block| *block == heading);
            match place.and_then(|place| blocks.get(place + 1)) {
                Some(Block::Paragraph(spans)) => spans.iter().map(Span::text).collect(),
                _ => String::new(),
            }
        })
    });
    &ABOUT[pane.index()]
}

/// The page of this name.
pub(crate) fn page(name: &str) -> Option<&'static GuidePage> {
    PAGES.iter().find(|page| page.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pane_is_explained_in_a_sentence_or_two() {
        for pane in Pane::ALL {
            let about = about(pane);
            assert!(
                about.ends_with('.') && about.len() < 240,
                "{}: {about}",
                pane.title()
            );
        }
    }
}
