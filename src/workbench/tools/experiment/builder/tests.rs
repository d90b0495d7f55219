//! The builder in a window.

use eframe::egui::DragAndDrop;

use super::view::block_of;
use super::*;
use crate::bench::command::ShowCommand;
use crate::bench::history::Moment;
use crate::bench::library_view::LibraryItem;
use crate::bench::pane::Pane;
use crate::shell::headless::Headless;
use crate::tools::experiment::builder::block_list::BLOCKS;
use crate::tools::experiment::builder::fields::Editing;
use crate::tools::experiment::builder::study_text::Target;
use selvedge_foundation::files::KeyValue;

fn window() -> Headless {
    let mut window = Headless::shipped();
    window.pass(2);
    window.dispatch(ShowCommand::Reveal(Pane::Builder));
    window.pass(3);
    window
}

fn experiment(window: &mut Headless) -> &mut Experiment {
    window.workbench.tools.get_mut().unwrap()
}

fn choose(window: &mut Headless, name: &'static str) {
    experiment(window).form.choose(Chosen::Shipped(name));
    window.pass(3);
}

#[test]
fn every_shipped_design_is_shown_with_its_blocks_its_sample_and_its_numbers() {
    let mut window = window();
    for name in Design::shipped_names() {
        choose(&mut window, name);
        for block in BLOCKS {
            experiment(&mut window).builder.open = Some(block.title);
            window.pass(1);
        }
        let form = &experiment(&mut window).form;
        let looked = form.looked.value().unwrap();
        assert!(
            looked.preview.is_ok() && looked.missing.is_empty(),
            "{name}: {looked:?}"
        );
        assert!(looked.trial.is_some(), "{name}");
        assert!(!form.study.is_changed(), "{name}: looking changes nothing");
    }
}

#[test]
fn a_textile_that_is_let_go_over_the_list_is_a_stimulus_and_a_step() {
    let mut window = window();
    choose(&mut window, "rating");
    let tool = experiment(&mut window);
    let mut editing = Editing {
        keys: tool.form.study.keys().unwrap().clone(),
        stimuli: Vec::new(),
        change: None,
    };
    let before = stimuli::ids(&editing.keys);
    let bench = &window.workbench.bench;
    let refused = stimuli::take(&mut editing, &before[0], bench).unwrap_err();
    assert!(refused.contains("there already"), "{refused}");
    let refused = stimuli::take(&mut editing, "seventy-four:serge", bench).unwrap_err();
    assert!(
        refused.contains("seventy-four") && refused.contains("sixteen"),
        "{refused}"
    );
    editing.keys.set(("", 0, "textiles"), None);
    assert!(stimuli::ids(&editing.keys).is_empty());
    stimuli::take(&mut editing, "seventy-four:serge", bench).unwrap();
    let of_keys = |key| editing.keys.value(("", 0, key));
    assert_eq!(of_keys("library"), Some(KeyValue::from("seventy-four")));
    assert_eq!(stimuli::ids(&editing.keys), ["serge"]);
    DragAndDrop::set_payload(
        &window.ctx,
        LibraryItem {
            id: "denim".to_owned(),
        },
    );
    window.pass(1);
}

#[test]
fn what_is_wrong_stands_at_its_block_and_undo_mends_it() {
    let mut window = window();
    let study = &mut experiment(&mut window).form.study;
    let wrong = study.text().replace("kind = \"rank\"", "kind = \"rang\"");
    study.write(wrong, (Target::Text, "text"), Moment::default());
    window.pass(2);
    let tool = experiment(&mut window);
    let fault = tool.form.study.design().unwrap_err();
    assert_eq!(block_of(&fault.table), Some("Response"));
    assert!(tool.form.refusal().unwrap().contains("rang"));
    assert!(
        window
            .workbench
            .unsaved()
            .iter()
            .any(|part| part.unsaved.name.contains("design"))
    );
    window.dispatch(crate::bench::command::Command::StepTo(0));
    window.pass(1);
    assert!(experiment(&mut window).form.study.design().is_ok());
}

#[test]
fn a_simulated_study_says_its_answer_and_whose_design_it_was_of() {
    let mut window = window();
    choose(&mut window, "odd-one-out");
    let workbench = &mut window.workbench;
    let tool: &mut Experiment = workbench.tools.get_mut().unwrap();
    tool.begin_simulation(&workbench.bench);
    window.pass(2);
    let (text, outcome) = experiment(&mut window).builder.simulated.clone().unwrap();
    let lines = outcome.unwrap();
    assert!(
        lines[0].contains("observers") && lines.len() > 3,
        "{lines:?}"
    );
    assert!(
        lines
            .iter()
            .any(|line| line.contains("simulated observers")),
        "{lines:?}"
    );
    assert_eq!(text, experiment(&mut window).form.study.text());
}
