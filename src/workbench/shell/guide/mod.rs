//! The guide: the pages of `assets/guide`, to be read in the window and printed by commands.

pub(crate) mod markdown;
mod view;

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
static PAGES: [GuidePage; 8] = pages! {
    "workbench": "The window";
    "textiles": "Textiles, libraries and scenes";
    "pictures": "From a picture to a textile";
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

/// The page of this name.
pub(crate) fn page(name: &str) -> Option<&'static GuidePage> {
    PAGES.iter().find(|page| page.name == name)
}
