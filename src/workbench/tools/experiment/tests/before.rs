//! What is settled before a session begins: who takes part, where, with what cloth and noise.

use super::*;
use crate::bench::view::BridgeView;
use crate::tools::experiment::presenting::ArrayNow;
use selvedge_device::{DeviceModel, DeviceUid};
use selvedge_experiment::Proof;

#[test]
fn who_takes_part_stands_in_the_table_of_the_study_and_is_not_changed_silently() {
    let folder = Folder::new("particulars");
    let mut window = begun(&folder, "odd-one-out", "p01");
    end(&mut window);
    window.pass(3);
    let form = &mut experiment_mut(&mut window).form;
    form.who.pseudonym = "p02".to_owned();
    form.who.age = "44".to_owned();
    form.who.experience = "practised".to_owned();
    begin(&mut window);
    window.pass(3);
    end(&mut window);
    window.pass(3);
    let table = fs::read_to_string(folder.0.join("participants.csv")).unwrap();
    let rows: Vec<&str> = table.lines().collect();
    assert!(rows[1].starts_with("p01,,,,,,"), "{table}");
    assert!(rows[2].starts_with("p02,44,,,practised,,"), "{table}");
    let form = &mut experiment_mut(&mut window).form;
    assert!(form.who.is_known() && form.refusal().is_none());
    form.session = "2".to_owned();
    form.who.age = "45".to_owned();
    let refusal = form.refusal().unwrap();
    assert!(
        refusal.contains("age_years was 44 then, and is 45 now"),
        "{refusal}"
    );
    begin(&mut window);
    window.pass(3);
    assert!(experiment(&window).session.is_none());
    assert_eq!(
        fs::read_to_string(folder.0.join("participants.csv")).unwrap(),
        table
    );
}

#[test]
fn a_folder_that_was_typed_is_listed_and_a_noise_is_written_into_it() {
    let folder = Folder::new("followed");
    let mut window = begun(&folder, "odd-one-out", "p01");
    end(&mut window);
    window.pass(3);
    let form = &mut experiment_mut(&mut window).form;
    form.folder = folder.0.join("other").display().to_string();
    form.choose(Chosen::Shipped("ranking-virtual-target"));
    window.pass(2);
    let tool = experiment(&window);
    assert!(tool.form.found.is_empty() && tool.form.failure.is_none());
    assert_eq!(tool.noise(), Some(NoiseView::Missing));
    act(&mut window, |one, bench| one.write_noise(bench));
    window.pass(2);
    let at = folder.0.join("other").join("masking-noise.wav");
    let tool = experiment_mut(&mut window);
    assert_eq!(tool.noise(), Some(NoiseView::At(at.display().to_string())));
    assert!(fs::metadata(&at).unwrap().len() > 50_000_000, "ten minutes");
    tool.form.folder = folder.0.display().to_string();
    window.pass(2);
    let form = &experiment(&window).form;
    assert_eq!((form.found.len(), form.has_noise), (1, false));
}

#[test]
fn a_session_with_a_library_of_ones_own_is_resumed_wherever_its_log_lies() {
    let folder = Folder::new("own-library");
    fs::create_dir_all(folder.0.join("cloth")).unwrap();
    let Chosen::File(design) = small(&folder, "odd-one-out") else {
        panic!("a file")
    };
    let text = fs::read_to_string(&design).unwrap();
    let text = text.replace("seed = 2007", "seed = 2007\nlibrary = \"cloth\"");
    fs::write(&design, text).unwrap();
    let library = concat!(env!("CARGO_MANIFEST_DIR"), "/../../textiles");
    copy(std::path::Path::new(library), &folder.0.join("cloth"));
    let mut window = Headless::shipped();
    window.pass(2);
    let form = &mut experiment_mut(&mut window).form;
    form.choose(Chosen::File(design));
    form.folder = folder.0.join("logs").display().to_string();
    form.who.pseudonym = "p01".to_owned();
    begin(&mut window);
    window.pass(3);
    let log = log_of(&window);
    end(&mut window);
    window.pass(3);
    act(&mut window, |one, bench| {
        one.resume_session(log.clone(), bench);
    });
    window.pass(3);
    assert!(experiment(&window).session.is_some());
    end(&mut window);
    window.pass(3);
    fs::rename(folder.0.join("cloth"), folder.0.join("away")).unwrap();
    act(&mut window, |one, bench| one.resume_session(log, bench));
    window.pass(3);
    let tool = experiment(&window);
    let line = tool.form.failure.clone().unwrap();
    assert!(tool.session.is_none());
    assert!(line.contains("the library of its design is gone"), "{line}");
    assert_eq!(line.lines().count(), 1);
}

fn copy(from: &std::path::Path, to: &std::path::Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let at = to.join(entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            copy(&entry.path(), &at);
        } else {
            fs::copy(entry.path(), at).unwrap();
        }
    }
}

#[test]
fn an_emulator_behind_a_port_is_no_array_that_somebody_feels() {
    let mut window = Headless::shipped();
    window.pass(2);
    let bench = &mut window.workbench.bench;
    bench.device.faults = None;
    let mut proof_of = |uid: DeviceUid| {
        bench.live.bridge = Some(BridgeView {
            uid: Some(uid),
            ..BridgeView::default()
        });
        ArrayNow::of(bench).proof
    };
    assert_eq!(proof_of(DeviceUid(*b"a true array")), Proof::Array);
    let caps = DeviceModel::default().caps(1, 1);
    assert_eq!(proof_of(DeviceUid(caps.uid)), Proof::Emulator);
}
