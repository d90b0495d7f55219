//! Friction of a cloth from its picture, felt on an electrovibration screen.
//!
//! ```text
//! picture, scale ─▶ source (a thread) ─▶ Trace: f(s) ──────────────┬─▶ chart ─▶ view, export
//! history, look back ─▶ stroke: V = b f(s) Y(t) ─▶ VoltageSink ────┘
//! ```
//!
//! Networks are read when the first picture is asked for, and nothing is predicted while the pane
//! is out of sight. The only sink is the simulated screen: no voltage leaves the program.

pub(crate) mod chart;
pub(crate) mod controls;
pub(crate) mod source;
pub(crate) mod stroke;
#[cfg(test)]
mod tests;
pub(crate) mod view;

use std::path::PathBuf;
use std::sync::Arc;

use eframe::egui::{ColorImage, Ui};

use crate::bench::Bench;
use crate::bench::command::{Command, FileCommand, Purpose, ShowCommand};
use crate::bench::export::{Exported, Origin, row};
use crate::bench::history::{History, Moment, StepList};
use crate::bench::latest::{Latest, Standing};
use crate::bench::pane::Pane;
use crate::bench::settings::preferences::Preferences;
use crate::bench::tool::{PaneContext, Tool};
use crate::kit::pane::framed;
use crate::kit::texture::{Same, Texture};
use crate::kit::theme::colour_map::ColourMap;
use crate::tools::friction::source::{Asked, Found, Source, Trace};
use crate::tools::friction::stroke::Instant;
use selvedge_chart::{Chart, Row};
use selvedge_render::electrovibration::{Driven, Electrovibration};

/// Scales that a picture may have, px/mm.
const PX_PER_MM: [f64; 2] = [0.1, 200.0];
/// Height of a row of charts in a file, pixels.
const CHART_PX: f64 = 220.0;
/// What there is to do before anything is shown.
const EMPTY: &str = "Open a picture of cloth, type its scale, or choose a textile of the scene";

/// What was chosen and typed: every change is a step that can be taken back.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Chosen {
    pub(crate) source: Option<Source>,
    /// Pixels to a millimetre, as typed.
    pub(crate) scale: String,
    pub(crate) drive: Electrovibration,
}

impl Chosen {
    /// The picture with its scale; `None` until both are known.
    fn asked(&self) -> Option<Asked> {
        let typed: f64 = self.scale.trim().replace(',', ".").parse().ok()?;
        let is_scale = (PX_PER_MM[0]..=PX_PER_MM[1]).contains(&typed);
        Some(Asked {
            source: self.source.clone()?,
            px_per_mm: is_scale.then_some(typed)?,
        })
    }

    /// What was changed to get here.
    fn step_from(&self, before: &Self) -> &'static str {
        let (now, then) = (self.drive, before.drive);
        let is_other_b = now.amplification_v.to_bits() != then.amplification_v.to_bits();
        let is_other_hz = now.carrier_hz.to_bits() != then.carrier_hz.to_bits();
        match (is_other_b, is_other_hz) {
            _ if self.source != before.source => "picture",
            _ if self.scale != before.scale => "scale",
            (true, true) => "preset",
            (true, false) => "amplification",
            (false, true) => "carrier frequency",
            (false, false) => "carrier",
        }
    }
}

/// What a table holds that is exported.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum TableOf {
    /// The coefficient of friction along the strip.
    #[default]
    Strip,
    /// A stroke along all of it, with voltages.
    Stroke,
}

/// Where the finger is now: the place, mm, friction there, the voltage.
type Now = (f64, f64, Driven);
/// What was shown was made of: the trace, the drive, the column at its end, how often the history
/// was cleared.
type Made = (Same<Trace>, Electrovibration, Option<u64>, u64);

/// What is shown of a trace and of the last second.
struct Shown {
    of: Made,
    now: Option<Now>,
    stroke: Vec<Instant>,
    /// Friction along the strip, then pairs of what is felt with its spectrum.
    charts: Vec<Chart>,
}

/// The tool.
#[derive(Default)]
pub(crate) struct Friction {
    pub(crate) chosen: Chosen,
    pub(crate) table: TableOf,
    history: History<Chosen, &'static str>,
    work: Latest<Asked, Found>,
    shown: Option<Shown>,
    strip: Texture<Same<ColorImage>>,
    spectrogram: Texture<(Same<Trace>, ColourMap)>,
}

impl Friction {
    /// How what was predicted stands to what is chosen.
    pub(crate) fn standing(&self) -> Standing {
        let asked = self.chosen.asked();
        asked.map_or(Standing::Empty, |asked| self.work.standing(&asked))
    }

    /// Friction along the strip of the picture that is chosen; why there is none.
    pub(crate) fn trace(&self) -> Option<Result<&Arc<Trace>, &str>> {
        let found = (self.work.value()).filter(|_| self.standing() == Standing::Fresh)?;
        Some(found.trace.as_ref().map_err(String::as_str))
    }

    /// Predicts what is due: to be called while the pane is in sight.
    fn follow(&mut self, bench: &Bench) {
        if let Some(asked) = self.chosen.asked() {
            self.work.follow(&bench.ctx, &bench.executor, &asked);
        }
    }

    /// Changes what is chosen, as a step.
    pub(crate) fn change(&mut self, moment: Moment, change: impl FnOnce(&mut Self)) {
        let before = self.chosen.clone();
        change(self);
        if self.chosen != before {
            let step = self.chosen.step_from(&before);
            self.history.begin(&before, step, step, moment);
        }
    }

    /// Makes what is shown, if it is another than before.
    fn shown(&mut self, bench: &Bench) -> Option<&Shown> {
        let trace = Arc::clone(self.trace()?.ok()?);
        let history = &bench.past.history;
        let looked_at = bench.past.look_back.as_ref().map(|back| back.column);
        let end = looked_at.or_else(|| history.newest().map(|entry| entry.column));
        let drive = self.chosen.drive;
        let of: Made = (Same(Arc::clone(&trace)), drive, end, history.n_clears);
        if self.shown.as_ref().is_none_or(|shown| shown.of != of) {
            let ticks = end.map(|end| (history.entries(), end));
            let stroke =
                ticks.map_or_else(Vec::new, |ticks| stroke::of_history(&trace, &drive, ticks));
            let now = end.and_then(|end| history.at_column(end)).map(|entry| {
                let place_mm = trace.place_mm(entry.tick_sample.pose.position.x_mm);
                let mu = trace.mu(place_mm);
                (place_mm, mu, drive.driven(mu, 0.0))
            });
            let mut charts = vec![chart::friction(&trace, now.map(|(place_mm, ..)| place_mm))];
            if !stroke.is_empty() {
                charts.extend(chart::FELT.iter().flat_map(|felt| felt.charts(&stroke)));
            }
            self.shown = Some(Shown {
                of,
                now,
                stroke,
                charts,
            });
        }
        self.shown.as_ref()
    }

    /// Where the picture comes from.
    fn origin(&self) -> Origin {
        let program = selvedge_foundation::PROGRAM;
        let name = self.chosen.source.as_ref().map(Source::name);
        let (name, drive) = (name.unwrap_or_default(), self.chosen.drive);
        let scale = &self.chosen.scale;
        let [b, hz] = [drive.amplification_v, drive.carrier_hz];
        let words = format!("b {b} V, {} carrier of {hz} Hz", drive.carrier.word());
        Origin::default()
            .and("program", program, program)
            .and("file", &name, &name)
            .and("px_per_mm", scale, &format!("{scale} px/mm"))
            .and("electrovibration", &words, &words)
    }
}

impl Tool for Friction {
    fn panes(&self) -> &'static [Pane] {
        &[Pane::Friction]
    }

    fn begin(&mut self, bench: &mut Bench) {
        let kept = bench.settings.preferences.hand.electrovibration;
        self.chosen.drive = kept.within_limits();
    }

    fn logic(&mut self, _bench: &mut Bench) {
        self.work.poll();
    }

    fn ui(&mut self, _pane: Pane, ui: &mut Ui, context: &mut PaneContext<'_>) {
        self.follow(context.bench);
        let moment = context.bench.pointer.moment;
        framed(ui, 10, |ui| {
            self.change(moment, |friction| view::show(ui, friction, context));
        });
    }

    fn command(&mut self, command: &Command, bench: &mut Bench) {
        let source = match command {
            Command::File(FileCommand::Use(Purpose::OpenPicture(Pane::Friction), path)) => {
                Source::File(path.clone().into())
            }
            Command::Friction(picture) => Source::AtHand(picture.clone()),
            _ => return,
        };
        self.change(bench.pointer.moment, |friction| {
            // The next file may well be of the same scale.
            if let Source::AtHand(picture) = &source {
                friction.chosen.scale = picture.px_per_mm.to_string();
            }
            friction.chosen.source = Some(source);
        });
        let reveal = ShowCommand::Reveal(Pane::Friction);
        bench.commands.push(reveal.into());
    }

    fn steps(&self, _bench: &Bench) -> Option<StepList> {
        Some(self.history.steps(&self.chosen))
    }

    fn step_to(&mut self, n_done: usize, _bench: &mut Bench) {
        self.history.step_to(n_done, &mut self.chosen);
    }

    fn export(&mut self, _pane: Pane, bench: &mut Bench) -> Result<Exported, &'static str> {
        self.follow(bench);
        let (origin, drive, table) = (self.origin(), self.chosen.drive, self.table);
        let trace = self.trace().and_then(Result::ok).map(Arc::clone);
        let shown = self.shown(bench);
        let (Some(trace), Some(shown)) = (trace, shown) else {
            return Err("There is nothing to export yet: open a picture in the Friction pane");
        };
        let map = bench.settings.preferences.colour_map;
        let (cells, colours) = chart::spectrogram_cells(&trace, map);
        let spectrogram = Chart {
            raster: Some(cells),
            ..chart::spectrogram_frame(&trace)
        };
        let of = |panels: Vec<Chart>| Row {
            panels,
            height_px: CHART_PX,
            bar: None,
        };
        let mut rows = vec![
            row(shown.charts[0].clone(), CHART_PX),
            Row {
                bar: Some(colours),
                ..row(spectrogram, CHART_PX)
            },
        ];
        let sheet = match table {
            TableOf::Strip => {
                rows.extend(shown.charts[1..].chunks(2).map(|pair| of(pair.to_vec())));
                shown.charts[0].columns.clone()
            }
            TableOf::Stroke => {
                let stroke = stroke::along(&trace, &drive);
                let pairs = chart::FELT.iter().map(|felt| felt.charts(&stroke));
                rows.extend(pairs.map(|pair| of(pair.into())));
                stroke::columns(&stroke)
            }
        };
        let note = "Friction along the middle of a picture by networks that learnt on procedural \
                    cloth, grey: its level in 95 % of cloths like those. The screen is simulated. \
                    Spectra: peak amplitudes under a Hann window whose gain is compensated.";
        let title = "Friction from a picture".to_owned();
        Ok(Exported::new(title, sheet, rows, note, origin))
    }

    fn known_path(&self, purpose: Purpose) -> Option<PathBuf> {
        match &self.chosen.source {
            Some(Source::File(file)) if purpose == Purpose::OpenPicture(Pane::Friction) => {
                Some(file.path().to_owned())
            }
            _ => None,
        }
    }

    fn keep_preferences(&self, preferences: &mut Preferences) {
        preferences.hand.electrovibration = self.chosen.drive;
    }
}
