//! Every command that reads a file, and the window, against files that none should take: one line
//! each, and never much memory, however much there is to read.

use std::fs::{self, File};
use std::io::Write as _;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::thread;

use crate::program::{Lab, Outcome, SCENE};
use crate::watched::{is_alone, memory_bytes, watch};
use crate::window::window;
use selvedge_workbench::Workbench;

/// A command, and the file of its that is replaced.
#[rustfmt::skip]
const READERS: [(&str, &str); 42] = [
    ("a.scene.toml", "a.scene.toml"),
    ("render a.scene.toml --path a.csv", "a.scene.toml"),
    ("screenshot a.scene.toml --out new", "a.scene.toml"),
    ("play a.scene.toml --path a.csv --port /dev/ptmx", "a.scene.toml"),
    ("render a.scene.toml --path a.csv", "a.csv"),
    ("probe --surface map --stroke 0,0:1,0 --out new", "map"),
    ("probe --surface flat --path a.csv --out new", "a.csv"),
    ("probe --surface fine --library textiles --drop 1 --out new", "textiles/fine/warp.csv"),
    ("figure a.scene.toml --path a.csv --out new", "a.csv"),
    ("figure a.scene.toml --path a.csv --out new", "a.scene.toml"),
    ("play a.scene.toml --path a.csv --port /dev/ptmx", "a.csv"),
    ("render a.scene.toml --path a.csv", "textiles/fine/textile.toml"),
    ("render a.scene.toml --path a.csv", "textiles/fine/warp.csv"),
    
    ("render b.scene.toml --path a.csv", "others/relief/map"),
    ("textile list --library textiles", "textiles/library.toml"),
    ("textile build --library recipes.toml --out new", "recipes.toml"),
    ("textile make weave recipe.toml --out new", "recipe.toml"),
    ("textile make knit recipe.toml --out new", "recipe.toml"),
    ("textile make brownian recipe.toml --out new", "recipe.toml"),
    ("textile make fourier --template t.toml --out new", "t.toml"),
    ("textile make restoration --warp p.csv --out new", "p.csv"),
    ("textile show fine --library textiles", "textiles/fine/textile.toml"),
    ("textile learn-fourier p.csv --out new", "p.csv"),
    ("textile learn-fourier --readings r.csv p.csv --out new", "p.csv"),
    ("textile import map --out new", "map"),
    ("textile import map --range-um 9 --step-mm 0.1 --height-unit um --out new", "map"),
    ("textile convert map --out new.npy", "map"),
    ("textile import-kes k.txt --name K --out new", "k.txt"),
    ("textile import-kes textiles/fine/warp.csv --name K --friction k.txt --out new", "k.txt"),
    ("textile levels --library textiles", "textiles/fine/warp.csv"),
    ("picture photo --out new", "photo"),
    ("mds d.csv", "d.csv"),
    ("experiment simulate d.toml --observers 1 --out new", "d.toml"),
    ("experiment run d.toml --subject p01", "d.toml"),
    ("experiment analyse logs --out new", "logs/LOG.csv"),
    ("experiment analyse logs --out new", "logs/LOG.json"),
    ("bridge emulate --link new --array x.toml", "x.toml"),
    ("bridge test --port /dev/ptmx --array x.toml", "x.toml"),
    ("play a.scene.toml --path a.csv --port /dev/ptmx --array x.toml", "x.toml"),
    ("bridge identify --port /dev/ptmx --answers y.txt --out new", "y.txt"),
    ("bridge replay s.csv --out new", "s.csv"),
    ("bridge replay s.csv", "s.csv"),
];

/// A file that no reader should take.
struct BadFile {
    kind: &'static str,
    make: fn(&Path),
    /// What comes out of it again and again, where it is a pipe.
    feed: Option<&'static [u8]>,
}

const fn bad(kind: &'static str, make: fn(&Path)) -> BadFile {
    BadFile {
        kind,
        make,
        feed: None,
    }
}

const fn pipe(kind: &'static str, feed: &'static [u8]) -> BadFile {
    BadFile {
        kind,
        make: |path| symlink("/dev/stdin", path).unwrap(),
        feed: Some(feed),
    }
}

#[rustfmt::skip]
const FILES: [BadFile; 10] = [
    bad("zeros without an end", |path| symlink("/dev/zero", path).unwrap()),
    pipe("comments without an end", COMMENT.as_bytes()),
    pipe("a line without an end", b"1,2,"),
    bad("10 GB", |path| File::create(path).and_then(|file| file.set_len(10_000_000_000)).unwrap()),
    bad("50 MB of comments", |path| fs::write(path, COMMENT.repeat(1_000_000)).unwrap()),
    bad("50 MB of short lines", |path| fs::write(path, "1\n".repeat(25_000_000)).unwrap()),
    bad("empty", |path| fs::write(path, "").unwrap()),
    bad("a folder", |path| fs::create_dir(path).unwrap()),
    bad("nonsense", |path| fs::write(path, nonsense()).unwrap()),
    bad("a broken picture", |path| fs::write(path, broken_picture()).unwrap()),
];

/// A line without a word for the program.
const COMMENT: &str = "# nothing to be read here nothing to be read\n";
const MAX_BYTES: u64 = 100_000_000;

fn nonsense() -> Vec<u8> {
    let mut state = 1_u32;
    let mut byte = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state.to_be_bytes()[0]
    };
    (0..100_000).map(|_| byte()).collect()
}

/// A PNG one of whose chunks is not what its checksum says.
fn broken_picture() -> Vec<u8> {
    let picture = image::RgbImage::from_raw(100, 100, nonsense()[..30_000].to_vec()).unwrap();
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture
        .write_to(&mut bytes, image::ImageFormat::Png)
        .unwrap();
    let mut bytes = bytes.into_inner();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0xff;
    bytes
}

/// All that the commands read, as it should be.
fn lab() -> Lab {
    let lab = Lab::with_scene();
    let manifest = lab.read("textiles/fine/textile.toml");
    let (about, _) = manifest.split_once("[source]").unwrap();
    let relief = "[source]\nkind = \"heightmap\"\nfile = \"map\"";
    lab.write("others/relief/textile.toml", format!("{about}{relief}"));
    let scene = SCENE.replace("\"textiles\"", "\"others\"");
    let scene = scene.replace("fine", "relief").replace("flat", "relief");
    lab.write("b.scene.toml", scene);
    lab.write("r.csv", "t_s,height_um\n0,1\n10,2\n");
    let simulated = "experiment simulate ranking-virtual-target --observers 1 --out logs";
    let outcome = lab.run(&simulated.split(' ').collect::<Vec<_>>());
    assert_eq!(outcome.code, 0, "{outcome:?}");
    for entry in fs::read_dir(lab.path("logs")).unwrap() {
        let path = entry.unwrap().path();
        let extension = path.extension().unwrap().to_str().unwrap();
        fs::rename(&path, lab.path(&format!("logs/LOG.{extension}"))).unwrap();
    }
    lab
}

/// Puts a file in the place of another while the command runs, and puts the other back; says what
/// is wrong with how it ended.
fn fault_of(lab: &Lab, args: &str, name: &str, file: &BadFile) -> Option<String> {
    let (place, aside) = (lab.path(name), lab.path("aside"));
    let was_there = fs::rename(&place, &aside).is_ok();
    (file.make)(&place);
    let what = format!("{args}: {name} is {}", file.kind);
    let (outcome, peak_bytes) = run_watched(lab, args, file.feed, &what);
    let leaves = ["new", "new.npy"].map(|name| lab.path(name).exists());
    for path in [&place, &lab.path("new"), &lab.path("new.npy")] {
        if path.is_dir() {
            fs::remove_dir_all(path).unwrap();
        } else if path.is_symlink() || path.exists() {
            fs::remove_file(path).unwrap();
        }
    }
    if was_there {
        fs::rename(&aside, &place).unwrap();
    }
    let fault = match fault_in(&outcome, peak_bytes, name) {
        None if leaves.contains(&true) => "leaves what it did not finish".to_owned(),
        fault => fault?,
    };
    Some(format!(
        "{what}: {fault}: {} {:?}",
        outcome.code, outcome.err
    ))
}

fn fault_in(outcome: &Outcome, peak_bytes: u64, name: &str) -> Option<String> {
    let (folder, _) = name.split_once('/').unwrap_or((name, ""));
    if outcome.code != 2 || !outcome.out.is_empty() {
        return Some("not refused".to_owned());
    }
    if peak_bytes > MAX_BYTES {
        return Some(format!("{} MB of memory", peak_bytes / 1_000_000));
    }
    let Some(line) = outcome.err.strip_suffix('\n') else {
        return Some("no line".to_owned());
    };
    line_fault(line, folder).map(ToOwned::to_owned)
}

/// What is wrong with a line that refuses a file.
fn line_fault(line: &str, name: &str) -> Option<&'static str> {
    let debug = ["Custom {", "Some(", "Error {", "Os {", "Error(", "Kind("];
    let tests = [
        (!line.contains('\n'), "not one line"),
        (line.contains(name), "names no file"),
        (line.contains("; "), "no mend"),
        (line.len() < 400, "too much is said"),
        (
            !debug.iter().any(|print| line.contains(print)),
            "a debug print",
        ),
    ];
    let failed = tests.iter().find(|(holds, _)| !holds);
    failed.map(|(_, fault)| *fault)
}

/// Runs the program to its end and gives the most memory that it held.
fn run_watched(lab: &Lab, args: &str, feed: Option<&[u8]>, what: &str) -> (Outcome, u64) {
    let mut command = lab.command(&args.split(' ').collect::<Vec<_>>());
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    if feed.is_some() {
        command.stdin(Stdio::piped());
    }
    let mut child = command.spawn().unwrap();
    let stdin = child.stdin.take();
    thread::scope(|scope| {
        if let (Some(line), Some(mut stdin)) = (feed, stdin) {
            let much = line.repeat(10_000);
            scope.spawn(move || while stdin.write_all(&much).is_ok() {});
        }
        let peak_bytes = watch(&mut child, 4 * MAX_BYTES, what);
        (Outcome::of(&child.wait_with_output().unwrap()), peak_bytes)
    })
}

#[test]
fn what_no_reader_should_take_ends_in_one_line_and_little_memory() {
    let lab = lab();
    let all = READERS
        .iter()
        .flat_map(|reader| FILES.iter().map(move |file| (reader, file)));
    let faults = all.filter_map(|((args, name), file)| fault_of(&lab, args, name, file));
    let faults: Vec<String> = faults.collect();
    assert!(
        faults.is_empty(),
        "{} faults:\n{}",
        faults.len(),
        faults.join("\n")
    );
}

/// What takes a file, as when it is dropped on the window or chosen.
type Taker = fn(&mut Workbench, PathBuf);

#[test]
fn the_window_takes_none_of_them_either() {
    if !is_alone("bounded::the_window_takes_none_of_them_either") {
        return;
    }
    let lab = Lab::with_scene();
    let mut harness = window(&lab.path("a.scene.toml"));
    // Of what is imported the Import and the Picture pane speak.
    let takers: [(&str, Taker, bool); 4] = [
        ("scene", Workbench::open_scene, true),
        ("recording", Workbench::open_recording, true),
        ("heights", Workbench::import_file, false),
        ("picture", Workbench::open_picture, false),
    ];
    for file in FILES.iter().filter(|file| file.feed.is_none()) {
        for (name, take, is_noticed) in takers {
            let name = format!("{name} that is {}", file.kind);
            (file.make)(&lab.path(&name));
            take(harness.state_mut(), lab.path(&name));
            harness.run_steps(10);
            let notices = harness.state().notices();
            let line = notices.iter().find(|line| line.contains(&name));
            assert!(line.is_some() || !is_noticed, "{name}: {notices:?}");
            assert_eq!(
                line.and_then(|line| line_fault(line, &name)),
                None,
                "{line:?}"
            );
        }
    }
    assert_eq!(harness.state().scene_name(), "Two", "as it was");
    let peak_bytes = memory_bytes(std::process::id(), "VmHWM");
    assert!(peak_bytes < 2 * MAX_BYTES, "{peak_bytes} bytes of memory");
}
