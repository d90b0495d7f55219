//! What is chosen in all views, and how amplitudes are drawn in all of them. Never undoable.

use crate::bench::command::ShowCommand;
use crate::bench::gain_set::GainSet;
use crate::bench::mute_solo::MuteSolo;
use crate::bench::part::DotStyle;
use crate::bench::probe::Probe;
use crate::bench::view::Hovered;
use crate::kit::amplitude::AmplitudeScale;
use crate::kit::spectrum_scale::SpectrumScale;

/// What all views share.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Selection {
    /// The chosen textile: its place in the scene's list.
    pub cloth: Option<usize>,
    /// The display that the panes look at: its place in the scene's list.
    pub(crate) display: usize,
    /// The contactor of it that is looked at closer.
    pub contactor: Option<usize>,
    /// The scale on which amplitudes are drawn.
    pub scale: AmplitudeScale,
    /// The scale on which spectrograms are drawn.
    pub(crate) spectrum: SpectrumScale,
    /// What the dots show by what.
    pub(crate) dot_style: DotStyle,
    /// Whether what is below the threshold of detection is greyed.
    pub(crate) greys_below: bool,
    /// The velocity at which textiles are asked what they would give.
    pub probe: Probe,
    /// What the pointer rests on.
    pub(crate) hovered: Hovered,
    /// Gains that are felt in place of the scene's as long as they are held.
    pub(crate) held_gains: Option<GainSet>,
    /// What is muted and what is felt alone.
    pub(crate) mute_solo: MuteSolo,
}

impl Selection {
    /// Takes in what the user wants to see; what does not concern it changes nothing.
    pub(crate) fn take(&mut self, command: &ShowCommand) {
        match *command {
            ShowCommand::SelectContactor(index) => self.contactor = Some(index),
            ShowCommand::SelectCloth(index) => self.cloth = index,
            ShowCommand::DotStyle(style) => self.dot_style = style,
            ShowCommand::ToggleThreshold => self.greys_below = !self.greys_below,
            ShowCommand::Probe(probe) => self.probe = probe,
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choosing_is_taken_in() {
        let mut selection = Selection::default();
        for command in [
            ShowCommand::SelectCloth(Some(2)),
            ShowCommand::SelectContactor(7),
            ShowCommand::DotStyle(DotStyle::Size),
            ShowCommand::Help,
        ] {
            selection.take(&command);
        }
        assert_eq!((selection.cloth, selection.contactor), (Some(2), Some(7)));
        assert_eq!(selection.dot_style, DotStyle::Size);
    }
}
