//! The analysis of logs: its view, and what is drawn for it.

use eframe::egui::Ui;

use crate::shell::desk::Desk;
use crate::tools::analysis::pictures::Wanted;
use crate::tools::analysis::view::{AnalysisHands, Sight as AnalysisSight};

impl Desk<'_> {
    pub(crate) fn show_analysis(&mut self, ui: &mut Ui) {
        let bench = &mut *self.context.bench;
        let transient = &mut bench.transient;
        let experiment = &transient.experiment;
        let held = experiment.held.as_deref();
        let analysing = &mut transient.analysing;
        if let Some(held) = held {
            analysing.offer(held.log.parent());
        } else {
            analysing.is_uncovered = false;
            analysing.offer(Some(&experiment.form.folder()));
        }
        let mut fields = analysing.fields.clone();
        let mut hands = AnalysisHands {
            fields: &mut fields,
            looks: &mut transient.analysis_looks,
        };
        let view = analysing.view(held.map(|held| held.subject.pseudonym.as_str()));
        let sight =
            crate::tools::analysis::view::show(ui, &view, &mut hands, self.context.commands);
        let wanted = view.found.cloned().zip(sight).map(|(findings, sight)| {
            let AnalysisSight { width_px, paper } = sight;
            Wanted {
                findings,
                section: view.section,
                width_px,
                paper,
            }
        });
        analysing.fields = fields;
        if let Some(wanted) = wanted {
            analysing.draw(ui.ctx(), bench.is_stepped, wanted);
        }
    }
}
