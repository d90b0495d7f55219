//! What the finger gets of what is shown: decided once for every contactor and band, and asked by
//! every view, so that heatmaps, dots, waveform and spectra never tell different stories.
//!
//! Views draw the amplitude that was rendered, fainter the less of it is played, and say why.

use eframe::egui::{Align2, CornerRadius, Painter, Rect, vec2};

use crate::bench::mute_solo::MuteSolo;
use crate::bench::part::Part;
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::limit_mark::limits_band;
use selvedge_engine::{ContactorView, Snapshot};
use selvedge_textile::tactile::Band;

/// What becomes of an amplitude that is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum OnFinger {
    /// The finger gets it as it is shown.
    #[default]
    Felt,
    /// The finger gets less: an output limit bites.
    Limited,
    /// The screen alone shows it: no device is armed.
    ShownOnly,
    /// The display stands still in the middle of a stroke or a replay: nothing is played.
    Held,
    /// A tick of the past, which is looked back at: the finger gets what is felt now.
    Past,
    /// Everything was switched off: nothing is played.
    AllOff,
    /// It was muted, or another part is felt alone.
    Muted,
}

impl OnFinger {
    /// Of a display as a whole, before it is asked which contactor and band. A device drives the
    /// first display of a scene.
    pub(crate) fn of_display(snapshot: &Snapshot, display: usize) -> Self {
        let is_driven = |link: &selvedge_engine::LinkView| link.state.takes_frames();
        if snapshot.is_stopped {
            Self::AllOff
        } else if snapshot.is_silent {
            Self::Held
        } else {
            let is_armed = snapshot.link.as_ref().is_some_and(is_driven);
            Self::sent(is_armed && display == 0)
        }
    }

    /// Of a tick that went to an armed device, or did not.
    pub(crate) fn sent(is_sent: bool) -> Self {
        if is_sent { Self::Felt } else { Self::ShownOnly }
    }

    /// Of one band of one contactor on a display that is `self` as a whole; contactors of the first
    /// display alone, which have a number here, can be left out.
    pub(crate) fn of_band(
        self,
        (index, contactor): (Option<usize>, &ContactorView),
        band: Band,
        mute_solo: &MuteSolo,
    ) -> Self {
        let parts = index.map(Part::Contactor).into_iter();
        let cloth = contactor.textile.map(|cloth| Part::Cloth(cloth.into()));
        if parts
            .chain([Part::Band(band)])
            .chain(cloth)
            .any(|part| !mute_solo.is_felt(part))
        {
            Self::Muted
        } else if self == Self::Felt && limits_band(contactor.limiter, band.index()) {
            Self::Limited
        } else {
            self
        }
    }

    /// Whether the device would play silence in its place, armed or not.
    pub(crate) fn is_silence(self) -> bool {
        matches!(self, Self::Held | Self::AllOff | Self::Muted)
    }

    /// How much of its ink it is drawn with, 0…1.
    pub(crate) fn presence(self) -> f32 {
        match self {
            Self::Felt | Self::Limited => 1.0,
            Self::ShownOnly => 0.85,
            Self::Held | Self::Past => 0.6,
            Self::AllOff => 0.5,
            Self::Muted => 0.4,
        }
    }

    /// A word for where there is little room; `None` where it is played.
    pub(crate) fn label(self) -> Option<&'static str> {
        match self {
            Self::Felt | Self::Limited => None,
            Self::ShownOnly => Some("screen only"),
            Self::Held => Some("held"),
            Self::Past => Some("past"),
            Self::AllOff => Some("all off"),
            Self::Muted => Some("muted"),
        }
    }

    /// A sentence for tips; `None` where it is played.
    pub(crate) fn sentence(self) -> Option<&'static str> {
        match self {
            Self::Felt | Self::Limited => None,
            Self::ShownOnly => Some("On the screen only: no device is armed"),
            Self::Held => Some("Held: shown as it was; the finger gets nothing"),
            Self::Past => Some("Looking back: shown as it was; the finger gets what is felt now"),
            Self::AllOff => Some("All off: the finger gets nothing"),
            Self::Muted => Some("Muted: the finger gets nothing"),
        }
    }
}

/// Whether a contactor is left out, both bands of it.
pub(crate) fn is_muted(bands: [OnFinger; 2]) -> bool {
    bands == [OnFinger::Muted; 2]
}

/// The sentences about both bands of a contactor: one where they fare alike.
pub(crate) fn sentences(bands: [OnFinger; 2]) -> Vec<String> {
    said_once(bands.map(OnFinger::sentence), ": ")
}

/// The same, each on a line of its own behind other words.
pub(crate) fn sentence_lines(bands: [OnFinger; 2]) -> String {
    let mut lines = String::new();
    for sentence in sentences(bands) {
        lines.push('\n');
        lines.push_str(&sentence);
    }
    lines
}

/// What is said of both bands: once where it is the same, else behind the name of its band.
fn said_once(bands: [Option<&str>; 2], between: &str) -> Vec<String> {
    if bands[0] == bands[1] {
        return bands[0].map(str::to_owned).into_iter().collect();
    }
    let of = |(band, words): (Band, Option<&str>)| {
        Some(format!("{} Hz{between}{}", band.carrier_hz(), words?))
    };
    Band::ALL.into_iter().zip(bands).filter_map(of).collect()
}

/// Writes the labels of both bands of what a picture shows into its upper left corner, on a ground
/// of their own; nothing where all of it is played.
pub(crate) fn paint_label(painter: &Painter, picture: Rect, bands: [OnFinger; 2]) {
    let labels = said_once(bands.map(OnFinger::label), " ").join(", ");
    if labels.is_empty() {
        return;
    }
    let palette = Palette::of(painter.ctx().theme());
    let text = painter.layout_no_wrap(labels, theme::small(), palette.text);
    let tag = Rect::from_min_size(picture.min, text.size() + vec2(10.0, 4.0));
    if tag.width() > picture.width() || tag.height() > picture.height() {
        return;
    }
    let below = CornerRadius {
        se: 4,
        ..CornerRadius::ZERO
    };
    painter.rect_filled(tag, below, palette.tag);
    let at = Align2::CENTER_CENTER.align_size_within_rect(text.size(), tag);
    painter.galley(at.min, text, palette.text);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::{Bench, Drive};
    use eframe::egui;
    use selvedge_device::LimiterState;

    fn snapshot() -> Snapshot {
        let ctx = egui::Context::default();
        let mut bench = Bench::new(&ctx, None, Drive::Stepped).unwrap();
        bench.engine.snapshot().clone()
    }

    #[test]
    fn a_display_that_is_held_or_off_is_not_on_the_finger() {
        let mut snapshot = snapshot();
        assert_eq!(OnFinger::of_display(&snapshot, 0), OnFinger::ShownOnly);
        snapshot.is_silent = true;
        assert_eq!(OnFinger::of_display(&snapshot, 0), OnFinger::Held);
        snapshot.is_stopped = true;
        assert_eq!(OnFinger::of_display(&snapshot, 0), OnFinger::AllOff);
    }

    #[test]
    fn of_all_reasons_the_nearest_to_the_contactor_is_named() {
        let contactor = ContactorView {
            textile: Some(1),
            amplitude_um: [80.0, 1.0],
            limiter: LimiterState {
                limited: [true, false],
                ..LimiterState::default()
            },
            ..ContactorView::default()
        };
        let of = |display: OnFinger, mute_solo: &MuteSolo| {
            Band::ALL.map(|band| display.of_band((Some(3), &contactor), band, mute_solo))
        };
        let mut mute_solo = MuteSolo::default();
        assert_eq!(
            of(OnFinger::Felt, &mute_solo),
            [OnFinger::Limited, OnFinger::Felt]
        );
        assert_eq!(of(OnFinger::Held, &mute_solo), [OnFinger::Held; 2]);
        mute_solo.toggle_mute(Part::Band(Band::Low));
        assert_eq!(
            of(OnFinger::Felt, &mute_solo),
            [OnFinger::Muted, OnFinger::Felt]
        );
        assert_eq!(sentences(of(OnFinger::Felt, &mute_solo)).len(), 1);
        for part in [Part::Contactor(3), Part::Cloth(1)] {
            let mut mute_solo = MuteSolo::default();
            mute_solo.toggle_mute(part);
            let muted = of(OnFinger::AllOff, &mute_solo);
            assert_eq!(muted, [OnFinger::Muted; 2], "{part:?}");
            assert_eq!(sentences(muted), ["Muted: the finger gets nothing"]);
        }
    }

    #[test]
    fn the_less_of_it_is_played_the_fainter_it_is_and_the_reason_is_said() {
        let all = [
            OnFinger::Felt,
            OnFinger::ShownOnly,
            OnFinger::Held,
            OnFinger::AllOff,
            OnFinger::Muted,
        ];
        assert!(
            all.windows(2)
                .all(|pair| pair[0].presence() > pair[1].presence())
        );
        for on in all {
            assert_eq!(on.label().is_none(), on == OnFinger::Felt, "{on:?}");
            assert_eq!(on.sentence().is_none(), on == OnFinger::Felt, "{on:?}");
        }
    }
}
