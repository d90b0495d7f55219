//! The parameters of a recipe, group by group.

use eframe::egui::{CollapsingHeader, Ui};

use crate::kit::widgets::text::quiet;
use crate::tools::lab::state::Lab;
use crate::tools::lab::steps::Steps;
use crate::tools::lab::view::parts::complaint;
use crate::tools::lab::view::rows;
use selvedge_foundation::files::KeyValue;
use selvedge_foundation::quantity;
use selvedge_textile::{Draft, Group, Parameter, ParameterKind, Place, groups};

/// Centimetres in a micrometre.
const UM_IN_CM: f64 = 1e-4;

/// A parameter that was changed, or left out.
type Change = (Place, Option<KeyValue>);

/// Shows every parameter; what is wrong stands below its own. Says what was changed.
pub(crate) fn show(ui: &mut Ui, lab: &Lab) -> Vec<Change> {
    let mut changes = Vec::new();
    let Some(steps) = &lab.steps else {
        return changes;
    };
    let draft = &steps.recipe.draft;
    let fault = steps.fault();
    if let Some(fault) = fault.filter(|fault| fault.place.is_none()) {
        complaint(ui, &fault.message);
    }
    for group in groups(draft.kind()) {
        let is_faulty =
            |parameter: &Parameter| fault.is_some_and(|fault| fault.place == Some(parameter.place));
        let has_fault = group.parameters.iter().any(is_faulty);
        let mark = if has_fault { " ·  wrong value" } else { "" };
        let title = quiet(format!("{}{mark}", group.title));
        let header = CollapsingHeader::new(title)
            .id_salt((draft.kind().to_owned(), group.title))
            .default_open(is_short(&group));
        let header = if has_fault {
            header.open(Some(true))
        } else {
            header
        };
        header.show_unindented(ui, |ui| {
            for parameter in &group.parameters {
                changes.extend(show_parameter(ui, steps, parameter));
                if let Some(fault) = fault.filter(|fault| fault.place == Some(parameter.place)) {
                    complaint(ui, &fault.message);
                }
                if let Some(words) = crowding(draft, parameter.place) {
                    complaint(ui, &words);
                }
            }
        });
    }
    changes
}

/// What is said of a count at which yarns have no room beside each other: it can be made and felt,
/// and no loom weaves it.
fn crowding(draft: &Draft, place: Place) -> Option<String> {
    let (what, table) = match place.key {
        "warp_per_cm" => ("ends", "source.warp"),
        "weft_per_cm" => ("picks", "source.weft"),
        _ => return None,
    };
    let key = "width_um";
    let (count, width_um) = (draft.number(place)?, draft.number(Place { table, key })?);
    let cover = count * width_um * UM_IN_CM;
    (cover > 1.0).then(|| {
        let [count, width, percent] = [(count, "/cm"), (width_um, "µm"), (100.0 * cover, "%")]
            .map(|(value, unit)| quantity::with_unit(value, 0, unit));
        format!(
            "{count} of {what} {width} wide cover {percent}: more yarn than there is room for; \
             take fewer {what} or a narrower yarn"
        )
    })
}

/// Whether a group stands open at first.
fn is_short(group: &Group) -> bool {
    let is_list = |parameter: &Parameter| {
        matches!(
            parameter.kind,
            ParameterKind::Numbers(_) | ParameterKind::Counts | ParameterKind::Colour
        )
    };
    !group.parameters.iter().any(is_list)
}

fn show_parameter(ui: &mut Ui, steps: &Steps, parameter: &Parameter) -> Option<Change> {
    let draft = &steps.recipe.draft;
    let is_of_table = matches!(parameter.kind, ParameterKind::Template { .. })
        || draft.has_table(parameter.place.table);
    if !is_of_table {
        if let Some(words) = rows::missing(parameter) {
            ui.label(quiet(words));
        }
        return None;
    }
    let changed = match parameter.kind {
        ParameterKind::Number {
            min,
            max,
            unit,
            is_whole,
        } => {
            let range = rows::Range {
                ends: [min, max],
                unit,
                is_whole,
            };
            rows::number(ui, steps, parameter, range).map(Some)
        }
        ParameterKind::Optional {
            min,
            max,
            unit,
            instead_of,
        } => {
            let range = rows::Range {
                ends: [min, max],
                unit,
                is_whole: false,
            };
            rows::optional(ui, steps, parameter, (range, instead_of))
        }
        ParameterKind::Choice(words) => rows::choice(ui, draft, parameter, words).map(Some),
        ParameterKind::Flag => rows::flag(ui, draft, parameter).map(Some),
        ParameterKind::Seed => rows::seed(ui, draft, parameter).map(Some),
        ParameterKind::Numbers(unit) => rows::list(ui, draft, parameter, (unit, false)).map(Some),
        ParameterKind::Counts => rows::list(ui, draft, parameter, ("", true)).map(Some),
        ParameterKind::Colour => rows::colour(ui, draft, parameter).map(Some),
        ParameterKind::Interlacing => {
            crate::tools::lab::view::weave::show(ui, draft, parameter).map(Some)
        }
        ParameterKind::Template { is_optional } => {
            rows::template(ui, draft, parameter, is_optional)
        }
    };
    changed.map(|value| (parameter.place, value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_textile::Manifest;

    #[test]
    fn more_yarn_than_there_is_room_for_is_said_and_less_is_not() {
        let mut draft = Draft::of(&Manifest::example("weave").unwrap()).unwrap();
        let at = |table, key| Place { table, key };
        let ends = at("source", "warp_per_cm");
        draft.set(ends, Some(57.0.into()));
        draft.set(at("source.warp", "width_um"), Some(310.0.into()));
        let words = crowding(&draft, ends).unwrap();
        assert!(
            words.contains("177 %") && words.contains("57 /cm"),
            "{words}"
        );
        draft.set(ends, Some(30.0.into()));
        assert_eq!(crowding(&draft, ends), None);
        assert_eq!(crowding(&draft, at("source", "bow_um")), None);
    }
}
