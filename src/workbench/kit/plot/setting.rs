//! How a chart stands in its pane.

use eframe::egui::Margin;

/// What dragging over a chart does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Drag {
    /// It moves the view; a double click shows everything again.
    Pans,
    /// It chooses a value for the pane, and so do the arrows.
    Chooses,
    /// Whatever the pane makes of it, which moves and zooms by the axes that it gives the chart.
    ByPane,
}

/// How a chart stands in its pane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Setting<'a> {
    /// What assistive tools call it; one name a window.
    pub name: &'a str,
    /// Room for labels around the frame.
    pub margin: Margin,
    /// Whether the wheel alone zooms: not where the pane scrolls.
    pub wheel: bool,
    /// What dragging with the primary button does.
    pub drag: Drag,
    /// Charts with the same horizontal axis: they are zoomed together and share a cursor.
    pub link: Option<&'static str>,
    /// Whether hovering names what every series says there: not where the pane has own words.
    pub hover: bool,
    /// What hovering says of the whole chart, below that.
    pub note: &'a str,
    /// Whether the names of series stand above the frame.
    pub has_legend: bool,
}

impl Default for Setting<'_> {
    fn default() -> Self {
        Self {
            name: "Chart",
            margin: Margin {
                left: 34,
                right: 8,
                top: 18,
                bottom: 18,
            },
            wheel: true,
            drag: Drag::Pans,
            link: None,
            hover: true,
            note: "",
            has_legend: true,
        }
    }
}
