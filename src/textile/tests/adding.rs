//! New textiles in libraries.

use std::fs;

use super::super::*;
use crate::surface::Direction;
use selvedge_foundation::files::sha256_hex;
use selvedge_foundation::progress::unheard;
use selvedge_scratch::ScratchFolder;

fn brownian(hurst: f64) -> Vec<BuiltFile> {
    let text = format!(
        "name = \"Own\"\nconstruction = \"other\"\nfibre = \"\"\n\
         [source]\nkind = \"brownian\"\nhurst = {hurst}\nsmd_um = 3.0\nseed = 7\n"
    );
    let path = std::path::Path::new("own.toml");
    build(&Manifest::from_toml(&text, path).unwrap(), path).unwrap()
}

fn keep(library: &Library, name: &str, to: &std::path::Path) -> (Library, Vec<String>) {
    let new = [(name.to_owned(), brownian(0.5))];
    unheard(|progress| library.add(&new, to, 2, progress)).unwrap()
}

#[test]
fn a_library_of_the_program_is_copied_and_gains_a_textile_while_its_reference_stays() {
    let to = ScratchFolder::new("copy");
    let shipped = Library::shipped().unwrap();
    let (own, ids) = keep(&shipped, "My own", &to);
    assert_eq!(ids, ["my-own"]);
    assert_eq!(own.ids().len(), 17);
    assert_eq!(own.ids()[..16], *shipped.ids());
    let [before, after] = [&shipped, &own].map(|library| library.index().unwrap().clone());
    assert_eq!(
        after.compression_reference_db.to_bits(),
        before.compression_reference_db.to_bits()
    );
    assert_eq!(after.textiles[..16], before.textiles);
    for id in shipped.ids() {
        let [here, there] = [&shipped, &own].map(|library| library.load(id).unwrap());
        for direction in Direction::ALL {
            let [here, there] = [&here, &there].map(|textile| textile.surface().spectra(direction));
            assert_eq!(here.powers_um2(3), there.powers_um2(3), "{id}");
        }
        assert_eq!(here.manifest(), there.manifest(), "{id}");
    }
}

#[test]
fn the_index_that_keeping_writes_is_the_one_that_building_would_write() {
    let to = ScratchFolder::new("index");
    let (own, _) = keep(&Library::shipped().unwrap(), "x", &to);
    let whole = library::index_of(&own, own.default_tuning(), 2).unwrap();
    let kept = own.index().unwrap();
    assert_eq!(kept.content_hash, whole.content_hash);
    assert_eq!(kept.textiles, whole.textiles);
}

#[test]
fn an_id_that_is_taken_gets_a_number_and_nothing_is_written_over() {
    let to = ScratchFolder::new("twice");
    let shipped = Library::shipped().unwrap();
    let taken = shipped.ids()[2].clone();
    let (own, first) = keep(&shipped, &taken, &to);
    let file = to.join(&taken).join("textile.toml");
    let before = sha256_hex([fs::read(&file).unwrap().as_slice()]);
    let (own, second) = keep(&own, &taken, &to);
    assert_eq!(first, [format!("{taken}-2")]);
    assert_eq!(second, [format!("{taken}-3")]);
    assert_eq!(own.ids().len(), 18);
    assert_eq!(before, sha256_hex([fs::read(&file).unwrap().as_slice()]));
}

#[test]
fn a_folder_without_an_index_stays_without_one() {
    let to = ScratchFolder::new("plain");
    fs::create_dir_all(&to).unwrap();
    write(&brownian(0.2), &to.join("first")).unwrap();
    let (own, _) = keep(&Library::open(&to).unwrap(), "second", &to);
    assert_eq!(own.ids(), ["first", "second"]);
    assert!(own.index().is_none());
}

#[test]
fn what_is_no_textile_is_refused_before_anything_is_written() {
    let to = ScratchFolder::new("nothing");
    let mut files = brownian(0.5);
    files.remove(0);
    let shipped = Library::shipped().unwrap();
    let broken = [("x".to_owned(), files)];
    let unnamed = [("– ,".to_owned(), brownian(0.5))];
    for new in [&broken, &unnamed] {
        let refused = unheard(|progress| shipped.add(new, &to, 1, progress));
        let words = refused.unwrap_err().to_string();
        assert!(!words.is_empty() && !words.contains('\n'), "{words}");
    }
    assert!(!to.exists());
}
