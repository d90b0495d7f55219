//! The lab without a window: from a beginning to the files of a textile.

use std::path::Path;

use eframe::egui;

use super::*;
use crate::bench::background::Executor;
use crate::bench::command::lab::Beginning;
use crate::bench::history::Moment;
use crate::bench::latest::Standing;
use crate::tools::lab::family::{Family, Member, Plan};
use crate::tools::lab::state::Begun;
use crate::tools::lab::work::{begin, built};
use selvedge_foundation::progress::Progress;
use selvedge_scratch::ScratchFolder;
use selvedge_textile::surface::Direction;
use selvedge_textile::tactile::Filters;
use selvedge_textile::{Library, Manifest, Place};

const HURST: Place = Place {
    table: "source",
    key: "hurst",
};

fn begun(from: &Beginning) -> Begun {
    let library = Library::shipped().unwrap();
    Progress::unheard(|progress| begin(from, &library, &Filters::default(), progress)).unwrap()
}

/// A Brownian surface of few points: made in no time.
fn small() -> Lab {
    let mut lab = Lab::default();
    lab.begin(begun(&Beginning::Example("brownian")));
    let at = |key| Place {
        table: "source",
        key,
    };
    lab.set(at("step_mm"), Some(0.1.into()), Moment::default());
    lab
}

#[test]
fn a_copy_names_its_parent_and_is_kept_with_the_bytes_of_its_recipe() {
    let mut lab = Lab::default();
    lab.begin(begun(&Beginning::Copy("polyamide-taffeta".to_owned())));
    let library = Library::shipped().unwrap();
    assert_eq!(lab.recipe().unwrap().fields.id, "polyamide-taffeta-changed");
    let recipes = vec![lab.to_keep().unwrap()];
    let [one, again] =
        [(); 2].map(|()| Progress::unheard(|progress| built(&recipes, progress)).unwrap());
    assert_eq!(one, again, "no clock, no chance");
    let manifest = &one[0]
        .files
        .iter()
        .find(|file| file.name == "textile.toml")
        .unwrap()
        .bytes;
    let text = String::from_utf8(manifest.clone()).unwrap();
    let manifest = Manifest::from_toml(&text, Path::new("textile.toml")).unwrap();
    let provenance = manifest.provenance.as_ref().unwrap();
    let parent = library.load("polyamide-taffeta").unwrap();
    assert_eq!(provenance.parents[0].id, "polyamide-taffeta");
    assert_eq!(provenance.parents[0].hash, parent.content_hash().unwrap());
    // The recipe was not changed: what the textile is felt as is its parent's.
    let of = |manifest: &Manifest| manifest.source.recipe_hash(Path::new("a")).unwrap();
    assert_eq!(of(&manifest), of(parent.manifest()));
}

#[test]
fn a_recipe_that_another_took_the_place_of_comes_back_with_all_its_steps() {
    let mut lab = small();
    lab.set(HURST, Some(0.3.into()), Moment::default());
    let mut fields = lab.recipe().unwrap().fields.clone();
    fields.id = "mine".to_owned();
    lab.call(fields, Moment::default());
    let mine = lab.recipe().unwrap().clone();
    lab.begin(begun(&Beginning::Copy("polyamide-taffeta".to_owned())));
    assert!(lab.recipe().unwrap().parent.is_some());
    let steps = lab.steps.as_ref().unwrap().list();
    assert_eq!((steps.n_done, steps.redo()), (4, None));
    assert_eq!(steps.undo(), Some("began Polyamide taffeta, changed"));
    lab.go_to(3);
    assert_eq!(lab.recipe().unwrap(), &mine);
    lab.go_to(2);
    assert_ne!(lab.recipe().unwrap(), &mine, "its own steps too");
    lab.go_to(4);
    let parent = lab.recipe().unwrap().parent.as_ref();
    assert_eq!(parent.unwrap().id, "polyamide-taffeta");
    assert_eq!(lab.steps.as_ref().unwrap().list(), steps);
}

#[test]
fn what_has_no_recipe_is_refused_in_a_line_and_can_be_restored() {
    let folder = ScratchFolder::new("lab");
    let textile = folder.join("measured");
    std::fs::create_dir_all(&textile).unwrap();
    let row = |i: u32| {
        let x_mm = f64::from(i) / 100.0;
        format!("{x_mm},{}\n", 5.0 * (x_mm * 6.0).sin())
    };
    let rows: String = (0..2000).map(row).collect();
    std::fs::write(textile.join("w.csv"), format!("x_mm,height_um\n{rows}")).unwrap();
    let text = "name = \"M\"\nconstruction = \"woven\"\nfibre = \"wool\"\n[source]\n\
                kind = \"profiles\"\nwarp_forward = \"w.csv\"\n";
    std::fs::write(textile.join("textile.toml"), text).unwrap();
    let library = Library::open(&folder).unwrap();
    let begin = |from: Beginning| {
        Progress::unheard(|progress| begin(&from, &library, &Filters::default(), progress))
    };
    let refusal = begin(Beginning::Copy("measured".to_owned())).unwrap_err();
    assert!(refusal.contains("is not a recipe"), "{refusal}");
    let begun = begin(Beginning::Restore("measured".to_owned())).unwrap();
    assert_eq!(begun.draft.kind(), "restoration");
    let (parent, compared) = begun.parent.unwrap();
    assert_eq!(
        (parent.id.as_str(), compared.name.as_str()),
        ("measured", "M")
    );
}

#[test]
fn a_family_differs_in_one_parameter_and_is_named_one_after_the_other() {
    let mut lab = small();
    let plan = Plan {
        place: HURST,
        ends: [0.2, 0.8],
        n: 3,
    };
    let draft = lab.steps.as_ref().unwrap().recipe.draft.clone();
    let filters = Filters::default();
    let family =
        Progress::unheard(|progress| Family::of(&draft, &plan, &filters, progress)).unwrap();
    let labels: Vec<&str> = family
        .members
        .iter()
        .map(|member| member.label.as_str())
        .collect();
    let wanted = [
        "Hurst exponent 0.2",
        "Hurst exponent 0.5",
        "Hurst exponent 0.8",
    ];
    assert_eq!(labels, wanted);
    // Of equally rough surfaces the jagged one is stronger at 320 Hz.
    let high = |member: &Member| member.felt.levels.mean_um[1];
    assert!(high(&family.members[0]) > 2.0 * high(&family.members[2]));
    lab.family = Some(family);
    let kept = lab.family_to_keep().unwrap();
    let ids: Vec<&str> = kept.iter().map(|(id, _)| id.as_str()).collect();
    assert_eq!(
        ids,
        [
            "brownian-surface-1",
            "brownian-surface-2",
            "brownian-surface-3"
        ]
    );
    assert_eq!(kept[2].1.name, "Brownian surface, Hurst exponent 0.8");
    let beyond = Plan {
        ends: [0.2, 8.0],
        ..plan
    };
    let words =
        Progress::unheard(|progress| Family::of(&draft, &beyond, &filters, progress)).unwrap_err();
    assert_eq!(words, "hurst is 4.1; give a number from 0.01 to 0.99");
}

#[test]
fn a_preview_is_due_until_it_is_shown_and_not_while_it_is_stopped() {
    let ctx = egui::Context::default();
    let mut lab = small();
    lab.follow_recipe(&ctx, &Executor::Threads(ctx.clone()));
    lab.stop();
    assert_eq!(lab.standing(), Standing::Stopped);
    lab.follow_recipe(&ctx, &Executor::InLine);
    assert_eq!(lab.previews.n_begun(), 1);
    lab.previews.go_on();
    while lab.standing() != Standing::Fresh {
        lab.follow_recipe(&ctx, &Executor::InLine);
        std::thread::yield_now();
    }
    let preview = lab.preview().unwrap();
    let [asked, found, _] = preview.hurst.unwrap();
    assert!(asked == 0.5 && (found - asked).abs() < 0.3, "{found}");
    assert_eq!(
        preview.felt.over_speed[Direction::WeftReverse.index()].len(),
        49
    );
    lab.set(HURST, Some(0.6.into()), Moment::default());
    assert!(matches!(lab.standing(), Standing::Working(_)));
    assert!(lab.preview().is_some(), "the last one stays");
}
