//! Folders of textiles that change: what is put in, renamed, taken away, and had back.

use std::path::Path;

use super::super::*;
use selvedge_foundation::progress::Progress;
use selvedge_scratch::ScratchFolder;

fn brownian(name: &str, hurst: f64) -> Vec<BuiltFile> {
    let text = format!(
        "name = \"{name}\"\nconstruction = \"other\"\nfibre = \"\"\n[source]\n\
         kind = \"brownian\"\nhurst = {hurst}\nsmd_um = 3.0\nseed = 7\nstep_mm = 0.05\n"
    );
    let path = Path::new("own.toml");
    build(&Manifest::from_toml(&text, path).unwrap(), path).unwrap()
}

fn name_of(folder: &Path, id: &str) -> String {
    Library::open(folder).unwrap().manifest(id).unwrap().name
}

#[test]
fn an_id_that_is_taken_gets_a_number_unless_it_is_replaced_and_nothing_is_lost() {
    let scratch = ScratchFolder::new("put");
    let folder = LibraryFolder::at(&scratch);
    let first = folder.put("Own", &brownian("One", 0.5), false).unwrap();
    let second = folder.put("own", &brownian("Two", 0.4), false).unwrap();
    assert_eq!((first.id.as_str(), second.id.as_str()), ("own", "own-2"));
    assert_eq!((&first.before, folder.versions("own").len()), (&None, 0));
    let third = folder.put("own", &brownian("Three", 0.3), true).unwrap();
    assert_eq!((third.id.as_str(), &third.before), ("own", &first.after));
    assert_eq!(name_of(&scratch, "own"), "Three");
    let versions = folder.versions("own");
    assert_eq!((versions.len(), versions[0].name.as_str()), (1, "One"));
    folder.restore("own", first.after.as_deref()).unwrap();
    assert_eq!(name_of(&scratch, "own"), "One");
    assert_eq!(folder.versions("own").len(), 2, "the third is one now");
}

#[test]
fn a_textile_that_is_taken_away_comes_back_byte_by_byte() {
    let scratch = ScratchFolder::new("away");
    let folder = LibraryFolder::at(&scratch);
    folder.put("own", &brownian("One", 0.5), false).unwrap();
    let hash = |id: &str| {
        let library = Library::open(&scratch).unwrap();
        library.load(id).unwrap().content_hash().unwrap()
    };
    let before = hash("own");
    let gone = folder.restore("own", None).unwrap();
    assert!(Library::open(&scratch).unwrap().ids().is_empty());
    assert_eq!(folder.removed(), ["own"]);
    let back = folder.restore("own", gone.before.as_deref()).unwrap();
    assert_eq!((back.before, back.after), (gone.after, gone.before));
    assert_eq!((hash("own"), folder.removed()), (before, Vec::new()));
    let refused = folder.restore("own", Some("0123456789abcdef")).unwrap_err();
    assert!(!refused.to_string().contains('\n'), "{refused}");
}

#[test]
fn a_new_name_leaves_the_id_and_the_surface_as_they_are() {
    let scratch = ScratchFolder::new("rename");
    let folder = LibraryFolder::at(&scratch);
    folder.put("own", &brownian("One", 0.5), false).unwrap();
    let change = folder.rename("own", "Öther „one“").unwrap();
    assert_ne!(change.before, change.after);
    assert_eq!(name_of(&scratch, "own"), "Öther „one“");
    assert!(folder.rename("none", "x").is_err());
}

#[test]
fn the_index_of_a_folder_follows_and_its_reference_stays() {
    let scratch = ScratchFolder::new("index");
    let shipped = Library::shipped().unwrap();
    let two = Library::of_folder(Path::new(""), &shipped.ids()[..2]);
    for id in two.ids() {
        write(&shipped.files_of(id).unwrap(), &scratch.join(id)).unwrap();
    }
    let there = Library::open(&scratch).unwrap();
    Progress::unheard(|progress| {
        Index::build(&there, &scratch, there.default_tuning(), 2, progress)
    })
    .unwrap();
    let before = Library::open(&scratch).unwrap().index().unwrap().clone();
    let folder = LibraryFolder::at(&scratch);
    folder.put("own", &brownian("One", 0.5), false).unwrap();
    let own = Library::open(&scratch).unwrap();
    let kept = own.index().unwrap();
    let whole = library::index_of(&own, own.default_tuning(), 2).unwrap();
    assert_eq!(kept.content_hash, whole.content_hash);
    assert_eq!(kept.textiles, whole.textiles);
    assert_eq!(
        kept.compression_reference_db.to_bits(),
        before.compression_reference_db.to_bits()
    );
    folder.restore("own", None).unwrap();
    assert_eq!(Library::open(&scratch).unwrap().index(), Some(&before));
}

#[test]
fn what_is_no_textile_is_refused_before_anything_is_written() {
    let scratch = ScratchFolder::new("nothing");
    let folder = LibraryFolder::at(&scratch);
    let mut files = brownian("One", 0.5);
    files.remove(0);
    for (id, files) in [("x", files), ("– ,", brownian("One", 0.5))] {
        let words = folder.put(id, &files, false).unwrap_err().to_string();
        assert!(!words.is_empty() && !words.contains('\n'), "{words}");
    }
    assert!(!scratch.exists());
}

#[test]
fn a_library_finds_textiles_of_others_by_ids_that_name_them() {
    let scratch = ScratchFolder::new("elsewhere");
    let folder = LibraryFolder::at(&scratch);
    folder.put("own", &brownian("One", 0.5), false).unwrap();
    let shipped = Library::shipped().unwrap();
    let id = id_in(&scratch, "own");
    let textile = shipped.load(&id).unwrap();
    assert_eq!(
        (textile.id(), textile.manifest().name.as_str()),
        (id.as_str(), "One")
    );
    assert!(
        textile.appearance().unwrap().is_some(),
        "its files are found"
    );
    let own = Library::open(&scratch).unwrap();
    assert_eq!(
        own.manifest("sixteen:denim").unwrap(),
        shipped.manifest("denim").unwrap()
    );
    assert!(shipped.manifest("seventy-four:denim-none").is_err());
    assert!(
        shipped
            .appearance(&id_in(&scratch.join("none"), "own"))
            .is_err()
    );
}
