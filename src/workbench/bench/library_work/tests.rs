//! Libraries in the window: what is kept, asked, changed and taken back.

use eframe::egui::vec2;

use super::*;
use crate::bench::command::{Command, FileCommand, Purpose};
use crate::bench::keep::NewTextile;
use crate::shell::headless::Headless;
use selvedge_scratch::ScratchFolder;
use selvedge_textile::{Manifest, build};

/// A window whose own library lies in a folder of this test's.
fn window(folder: &ScratchFolder) -> Headless {
    let mut window = Headless::shipped();
    window.workbench.bench.library.acts.own_folder = Some(folder.to_path_buf());
    window.workbench.bench.open_own_library();
    window.pass(2);
    window
}

fn new_textile(name: &str, seed: u32) -> Arc<Vec<NewTextile>> {
    let text = format!(
        "name = \"{name}\"\nconstruction = \"other\"\nfibre = \"\"\n[source]\n\
         kind = \"brownian\"\nhurst = 0.5\nsmd_um = 3.0\nseed = {seed}\nstep_mm = 0.05\n"
    );
    let path = Path::new("own.toml");
    Arc::new(vec![NewTextile {
        id: selvedge_textile::id_of(name),
        name: name.to_owned(),
        files: build(&Manifest::from_toml(&text, path).unwrap(), path).unwrap(),
    }])
}

fn do_now(window: &mut Headless, command: impl Into<Command>) {
    window.dispatch(command);
    window.pass(2);
}

/// Names of the user's own textiles.
fn own(window: &Headless) -> Vec<String> {
    let items = window.workbench.bench.library.view.all_items();
    let own = items.filter(|item| &*item.home == OWN);
    own.map(|item| item.name.clone()).collect()
}

fn key(window: &Headless, name: &str) -> String {
    let mut items = window.workbench.bench.library.view.all_items();
    items.find(|item| item.name == name).unwrap().id.clone()
}

fn notices(window: &Headless) -> Vec<String> {
    let shown = window.workbench.bench.notices.shown();
    shown.iter().map(|notice| notice.text.clone()).collect()
}

fn undo_here(window: &mut Headless, command: Command) {
    window.workbench.bench.pointer.pane_in_use = Some(Pane::Library);
    do_now(window, command);
}

#[test]
fn what_was_kept_is_felt_in_a_free_place_and_is_there_in_any_scene_and_after_a_restart() {
    let folder = ScratchFolder::new("feel");
    let mut first = window(&folder);
    do_now(&mut first, Keep::of(new_textile("Mine", 1), true));
    let bench = &first.workbench.bench;
    let scene = bench.document.scene();
    assert_eq!(scene.library, None, "the scene keeps its library");
    let placed = scene.textiles.last().unwrap();
    assert_eq!(bench.engine_scene.loaded.textiles()[4].id(), placed.id);
    let within = |at: f64, side: f64, size: f64| at >= 0.0 && at + side <= size;
    let ([width, height], [w, h]) = (scene.size_mm, placed.size_mm);
    assert!(within(placed.origin_mm.x_mm, w, width) && within(placed.origin_mm.y_mm, h, height));
    assert_eq!(own(&first), ["Mine"]);
    let said = notices(&first);
    assert!(
        said.iter().any(|line| line.starts_with("Kept mine in ")),
        "{said:?}"
    );
    // Nobody is asked about the scene.
    let path = folder.join("a.scene.toml");
    let bench = &mut first.workbench.bench;
    let contents = bench.engine_scene.loaded.contents();
    bench.document.save_as(&path, contents).unwrap();
    do_now(&mut first, FileCommand::New);
    assert_eq!(own(&first), ["Mine"]);
    let second = window(&folder);
    assert_eq!(own(&second), ["Mine"]);
    let again = Headless::new(Some(&path), vec2(1400.0, 900.0), 1.0).unwrap();
    assert_eq!(
        again.workbench.bench.engine_scene.loaded.textiles().len(),
        5
    );
}

#[test]
fn a_new_textile_is_felt_beside_two_others_and_kept_only_when_it_is_wanted() {
    let folder = ScratchFolder::new("listen");
    let mut window = window(&folder);
    let before = window.workbench.bench.document.scene().clone();
    let heard = |window: &Headless| -> Vec<String> {
        let placed = &window.workbench.bench.engine_scene.loaded.scene().textiles;
        placed.iter().map(|one| one.id.clone()).collect()
    };
    let own_scene = heard(&window);
    let textiles = new_textile("Mine", 1);
    let listen = LibraryCommand::Listen(Arc::clone(&textiles), Pane::Lab);
    do_now(&mut window, listen.clone());
    assert_eq!(heard(&window), vec!["mine"; 4]);
    let listening = window.workbench.bench.library.acts.listening.as_ref();
    let listening = listening.unwrap();
    let [low, high] = listening.new.as_ref().unwrap().1;
    assert!(low > 0.0 && high > 0.0, "its levels: {low} and {high} µm");
    let references = listening.references.clone().map(Option::unwrap);
    assert_ne!(references[0], references[1]);
    do_now(&mut window, LibraryCommand::Feel(2));
    assert_eq!(heard(&window), vec![references[1].clone(); 4]);
    let other = LibraryCommand::CompareWith(0, "denim".to_owned());
    do_now(&mut window, other);
    assert_eq!(heard(&window), vec!["denim"; 4]);
    do_now(&mut window, LibraryCommand::Feel(0));
    assert_eq!(heard(&window), vec!["mine"; 4], "and back");
    assert_eq!(*window.workbench.bench.document.scene(), before);
    do_now(&mut window, Command::Dismiss);
    assert_eq!(heard(&window), own_scene, "Esc keeps nothing");
    assert!(own(&window).is_empty());
    do_now(&mut window, listen);
    do_now(&mut window, Keep::of(textiles, false));
    assert_eq!(heard(&window), own_scene);
    assert_eq!(own(&window), ["Mine"]);
}

#[test]
fn a_new_textile_stands_for_its_namesake_only_while_it_is_felt() {
    let folder = ScratchFolder::new("namesake");
    let mut window = window(&folder);
    let first = |window: &Headless| {
        let textile = &window.workbench.bench.engine_scene.loaded.textiles()[0];
        (textile.id().to_owned(), textile.content_hash().unwrap())
    };
    let placed = first(&window);
    let path = folder.join("a.scene.toml");
    let save = FileCommand::Use(Purpose::SaveScene, path.clone());
    do_now(&mut window, save.clone());
    let saved = std::fs::read_to_string(&path).unwrap();
    assert!(saved.contains(&placed.1), "{saved}");
    let listen = LibraryCommand::Listen(new_textile(&placed.0, 1), Pane::Lab);
    do_now(&mut window, listen);
    let new = first(&window);
    assert!(new.0 == placed.0 && new.1 != placed.1, "{new:?} {placed:?}");
    do_now(&mut window, save);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), saved);
    let namesake = LibraryCommand::CompareWith(0, placed.0.clone());
    do_now(&mut window, namesake);
    assert_eq!(first(&window), placed, "the library's own");
    do_now(&mut window, LibraryCommand::Feel(0));
    assert_eq!(first(&window), new);
    do_now(&mut window, Command::Dismiss);
    assert_eq!(first(&window), placed);
}

#[test]
fn an_equal_name_asks_and_both_can_be_kept_or_the_old_one_replaced_and_had_back() {
    let folder = ScratchFolder::new("taken");
    let mut window = window(&folder);
    do_now(&mut window, Keep::of(new_textile("Mine", 1), false));
    let again = Keep::of(new_textile("Mine", 2), false);
    let answered = |answer| Keep {
        when_taken: Some(answer),
        ..again.clone()
    };
    do_now(&mut window, again.clone());
    let taken = window.workbench.bench.library.acts.taken.clone().unwrap();
    assert_eq!(taken.there, [["Mine".to_owned(), "mine".to_owned()]]);
    assert_eq!(own(&window), ["Mine"]);
    do_now(&mut window, LibraryCommand::ForgetKeep);
    assert!(window.workbench.bench.library.acts.taken.is_none());
    do_now(&mut window, answered(WhenTaken::KeepBoth));
    assert_eq!(own(&window), ["Mine", "Mine 2"]);
    let said = notices(&window);
    assert!(
        said.iter().any(|line| line.starts_with("Kept mine-2 in ")),
        "{said:?}"
    );
    do_now(&mut window, answered(WhenTaken::Replace));
    assert_eq!(own(&window), ["Mine", "Mine 2"]);
    let shelf = window.workbench.bench.keeping_shelf().unwrap();
    let of_library = shelf.folder().unwrap();
    let versions = of_library.versions("mine");
    assert_eq!(versions.len(), 1);
    let hash = |window: &Headless| {
        let shelf = window.workbench.bench.keeping_shelf().unwrap();
        shelf.library.load("mine").unwrap().content_hash().unwrap()
    };
    let replaced = hash(&window);
    let version = versions[0].version.clone();
    do_now(
        &mut window,
        LibraryCommand::Restore(of_library, "mine".to_owned(), version),
    );
    assert_ne!(hash(&window), replaced);
}

#[test]
fn rename_duplicate_and_delete_are_taken_back_and_brought_again() {
    let folder = ScratchFolder::new("acts");
    let mut window = window(&folder);
    do_now(&mut window, Keep::of(new_textile("Mine", 1), false));
    let mine = key(&window, "Mine");
    do_now(
        &mut window,
        LibraryCommand::Rename(mine.clone(), "Yours".to_owned()),
    );
    do_now(&mut window, LibraryCommand::Duplicate(mine.clone()));
    assert_eq!(own(&window), ["Yours", "Yours, copy"]);
    do_now(&mut window, LibraryCommand::Remove(mine));
    assert_eq!(own(&window), ["Yours, copy"]);
    let names = window.workbench.bench.library.acts.steps().names;
    let expected = [
        "kept Mine",
        "renamed Yours",
        "duplicated Yours, copy",
        "deleted Yours",
    ];
    assert_eq!(names, expected);
    undo_here(&mut window, Command::Undo);
    assert_eq!(own(&window), ["Yours", "Yours, copy"]);
    undo_here(&mut window, Command::StepTo(1));
    assert_eq!(own(&window), ["Mine"]);
    undo_here(&mut window, Command::StepTo(4));
    assert_eq!(own(&window), ["Yours, copy"]);
    // An edit of the scene is what undo acts on afterwards.
    let begun_db = window.workbench.bench.document.tuning().gain_db;
    do_now(&mut window, Edit::MasterGain(-3.0));
    undo_here(&mut window, Command::Undo);
    let gain_db = window.workbench.bench.document.tuning().gain_db;
    assert_eq!(gain_db, begun_db);
    assert_eq!(own(&window), ["Yours, copy"]);
}

#[test]
fn a_textile_of_the_program_is_copied_into_the_own_library_and_never_changed() {
    let folder = ScratchFolder::new("program");
    let mut window = window(&folder);
    do_now(&mut window, LibraryCommand::Remove("denim".to_owned()));
    let said = notices(&window);
    assert!(said[0].contains("part of the program"), "{said:?}");
    do_now(&mut window, LibraryCommand::Duplicate("denim".to_owned()));
    assert_eq!(own(&window).len(), 1);
    assert!(own(&window)[0].ends_with(", copy"), "{:?}", own(&window));
}

#[test]
fn what_lies_in_the_scene_is_not_deleted_and_what_replaces_it_is_felt() {
    let folder = ScratchFolder::new("placed");
    let mut window = window(&folder);
    do_now(&mut window, Keep::of(new_textile("Mine", 1), true));
    let mine = key(&window, "Mine");
    let felt = |window: &Headless| {
        let textiles = window.workbench.bench.engine_scene.loaded.textiles();
        textiles[4].content_hash().unwrap()
    };
    let before = felt(&window);
    do_now(&mut window, LibraryCommand::Remove(mine));
    assert_eq!(own(&window), ["Mine"]);
    window.workbench.bench.step_library_to(0);
    assert_eq!(own(&window), ["Mine"], "nor taken back");
    let keep = Keep {
        when_taken: Some(WhenTaken::Replace),
        ..Keep::of(new_textile("Mine", 2), false)
    };
    do_now(&mut window, keep);
    assert_ne!(felt(&window), before);
}

#[test]
fn without_a_folder_nothing_is_kept_and_a_sentence_says_so() {
    let mut window = Headless::shipped();
    window.pass(1);
    do_now(&mut window, Keep::of(new_textile("Mine", 1), true));
    let said = notices(&window);
    assert!(said[0].contains("no folder"), "{said:?}");
    assert_eq!(window.workbench.bench.document.scene().textiles.len(), 4);
}

#[test]
fn a_folder_that_was_added_is_listed_until_it_is_forgotten() {
    let folder = ScratchFolder::new("added");
    let files = new_textile("Theirs", 3)[0].files.clone();
    selvedge_textile::write(&files, &folder.join("study").join("theirs")).unwrap();
    let mut window = Headless::shipped();
    window.pass(1);
    let study = folder.join("study");
    do_now(&mut window, LibraryCommand::AddFolder(study.clone()));
    let theirs = key(&window, "Theirs");
    do_now(&mut window, Edit::AddCloths(vec![theirs]));
    assert_eq!(
        window.workbench.bench.engine_scene.loaded.textiles().len(),
        5
    );
    do_now(&mut window, LibraryCommand::AddFolder(folder.join("none")));
    assert!(notices(&window)[0].contains("is no folder"));
    do_now(&mut window, LibraryCommand::ForgetFolder(study));
    let items = window.workbench.bench.library.view.all_items();
    assert_eq!(items.filter(|item| item.name == "Theirs").count(), 0);
}
