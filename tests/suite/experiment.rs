//! `selvedge experiment`, run as a person at a desk runs it, and interrupted as people are.

use std::fs;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use selvedge_experiment::design::{Design, Subject};
use selvedge_experiment::session::{Circumstances, Session, path_file};
use selvedge_experiment::{Answer, Apparatus, Grade, Presentation, Proof, Step, Timing};
use selvedge_render::scene::ExplorationPath;

use crate::program::{Lab, Outcome, PATH, Rows};

const CLOTH: &str = "study = \"cloth\"\nexperiment = \"odd\"\nmedium = \"real-cloth\"\nseed = 3\n\
    title = \"Odd cloth\"\ntextiles = [\"a\", \"b\", \"c\", \"d\", \"e\"]\n[odd_one_out]\n";
const RUN: [&str; 5] = ["experiment", "run", "cloth.toml", "--subject", "p01"];
const LOG: &str = "cloth/cloth_odd_p01_1.csv";
/// Five cloths make ten pairs.
const N_TRIALS: usize = 10;

fn lab() -> Lab {
    let lab = Lab::new();
    lab.write("cloth.toml", CLOTH);
    lab
}

/// The lines that answer some trials.
fn answers(trials: std::ops::Range<usize>) -> String {
    let lines = |trial: usize| {
        let grade = Grade::ALL[trial % 3].name();
        format!("\n{} {grade}\n", trial % 3 + 1)
    };
    trials.map(lines).collect::<Vec<_>>().concat()
}

/// A session that waits for lines.
struct PaneHost {
    child: Child,
    typed: ChildStdin,
    said: BufReader<ChildStdout>,
}

impl PaneHost {
    fn of(mut command: Command) -> Self {
        let command = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        Self {
            typed: child.stdin.take().unwrap(),
            said: BufReader::new(child.stdout.take().unwrap()),
            child,
        }
    }

    fn sit(lab: &Lab, more: &[&str]) -> Self {
        Self::of(lab.command(&[&RUN[..], more].concat()))
    }

    fn types(&mut self, lines: &str) {
        self.typed.write_all(lines.as_bytes()).unwrap();
    }

    /// Reads until a line holds this.
    fn hears(&mut self, text: &str) -> String {
        loop {
            let mut line = String::new();
            let n = self.said.read_line(&mut line).unwrap();
            assert!(n > 0, "{text:?} was never said");
            if line.contains(text) {
                return line;
            }
        }
    }

    /// Nothing more is typed: how it ended.
    fn ends(self) -> Outcome {
        drop(self.typed);
        drop(self.said);
        Outcome::of(&self.child.wait_with_output().unwrap())
    }
}

/// The cells of a log without times.
fn timeless(log: &Path) -> Vec<(String, Vec<String>)> {
    let rows = Rows::trials(log);
    let header = rows.header();
    let columns = header.split(',');
    let is_time = |name: &&str| name.starts_with("t_") || ["rt_ms", "before_sha256"].contains(name);
    let cells = |name: &str| rows.text(name).into_iter().map(str::to_owned).collect();
    columns
        .filter(|name| !is_time(name))
        .map(|name| (name.to_owned(), cells(name)))
        .collect()
}

#[test]
fn killed_in_the_middle_and_resumed_a_session_has_the_rows_of_one_that_was_not() {
    let whole = lab();
    let outcome = whole.run_on(&RUN, &answers(0..N_TRIALS));
    assert_eq!((outcome.code, outcome.err.as_str()), (0, ""), "{outcome:?}");
    assert!(outcome.out.contains("10 rows in"), "{outcome:?}");

    let lab = lab();
    let mut desk = PaneHost::sit(&lab, &[]);
    desk.types(&answers(0..4));
    desk.hears("trial 5, block 1: 4 of 10 done");
    desk.types("\n");
    desk.hears("type the odd position");
    desk.child.kill().unwrap();
    desk.child.wait().unwrap();
    let before = fs::read(lab.path(LOG)).unwrap();
    fs::write(lab.path(LOG), [&before[..], b"1,cloth,od"].concat()).unwrap();

    let described = lab.refuse(&RUN);
    assert!(
        described.contains("session 1 of p01 has 4 of 10 trials done"),
        "{described}"
    );
    assert!(
        described.contains("the last 0 min ago; give --resume"),
        "{described}"
    );
    let outcome = lab.run_on(&[&RUN[..], &["--resume"]].concat(), &answers(4..N_TRIALS));
    assert_eq!(outcome.code, 0, "{outcome:?}");
    assert!(outcome.err.contains("4 of 10 trials done"), "{outcome:?}");
    assert!(outcome.err.contains("p01_1.csv.torn-1"), "{outcome:?}");
    assert!(fs::read(lab.path(LOG)).unwrap().starts_with(&before));
    assert_eq!(timeless(&lab.path(LOG)), timeless(&whole.path(LOG)));
    let described = lab.refuse(&[&RUN[..], &["--session", "1"]].concat());
    assert!(described.contains("it is finished"), "{described}");
}

#[test]
fn a_session_that_ran_out_of_lines_fails_and_one_that_was_quit_does_not() {
    let lab = lab();
    let outcome = lab.run_on(&RUN, &answers(0..2));
    assert_eq!(outcome.code, 1, "{outcome:?}");
    assert!(
        outcome.one_line().contains("2 of 10 trials are in"),
        "{outcome:?}"
    );
    let more = [&RUN[..], &["--resume", "--note", "late"]].concat();
    let outcome = lab.run_on(&more, "\n1 easy\nquit\n");
    assert_eq!(outcome.code, 0, "{outcome:?}");
    let log = Rows::trials(&lab.path(LOG));
    assert_eq!(log.text("note"), ["", "", "late"]);
    assert_eq!(log.text("device"), ["cloth on the table"; 3]);
}

#[test]
fn two_programs_cannot_hold_one_session() {
    let lab = lab();
    let mut desk = PaneHost::sit(&lab, &[]);
    desk.types(&answers(0..1));
    desk.hears("trial 2");
    let outcome = lab.run(&[&RUN[..], &["--resume"]].concat());
    assert_eq!(outcome.code, 1, "{outcome:?}");
    assert!(
        outcome.one_line().contains("another session"),
        "{outcome:?}"
    );
    desk.types(&answers(1..N_TRIALS));
    desk.hears("finished");
    assert_eq!(desk.ends().code, 0);
    assert_eq!(Rows::trials(&lab.path(LOG)).len(), N_TRIALS);
}

#[test]
fn restarting_begins_the_next_session_and_leaves_the_first() {
    let lab = lab();
    lab.run_on(&RUN, &answers(0..3));
    let before = fs::read(lab.path(LOG)).unwrap();
    let outcome = lab.run_on(&[&RUN[..], &["--restart"]].concat(), &answers(0..1));
    assert!(outcome.out.contains("session 2: 0 of 10"), "{outcome:?}");
    assert_eq!(fs::read(lab.path(LOG)).unwrap(), before);
    let outcome = lab.run_on(&[&RUN[..], &["--resume"]].concat(), "quit\n");
    assert!(
        outcome.err.contains("session 2 of p01 has 1 of 10"),
        "{outcome:?}"
    );
    let first = [&RUN[..], &["--resume", "--session", "1"]].concat();
    let outcome = lab.run_on(&first, "quit\n");
    assert!(
        outcome.err.contains("session 1 of p01 has 3 of 10"),
        "{outcome:?}"
    );
}

#[test]
fn participants_are_listed_once_and_sessions_go_by_their_number() {
    let lab = lab();
    let described = ["--age", "31", "--sex", "female", "--room", "B-214"];
    lab.run_on(&[&RUN[..], &described].concat(), "quit\n");
    let second = ["experiment", "run", "cloth.toml", "--subject", "p02"];
    lab.run_on(&second, "quit\n");
    lab.run_on(&[&RUN[..], &["--resume"]].concat(), "quit\n");
    let table = Rows::read(&lab.path("cloth/participants.csv"));
    assert_eq!(table.text("pseudonym"), ["p01", "p02"]);
    assert_eq!(table.text("age_years"), ["31", ""]);
    for (subject, nth) in [("p01", 0), ("p02", 1)] {
        let sidecar = lab.read(&format!("cloth/cloth_odd_{subject}_1.json"));
        assert!(
            sidecar.contains(&format!("\"nth_subject\": {nth}")),
            "{sidecar}"
        );
    }
    let older = [&RUN[..], &["--restart", "--age", "32"]].concat();
    let described = lab.refuse(&older);
    assert!(
        described.contains("age_years was 31 then, and is 32 now"),
        "{described}"
    );
    assert!(!lab.path("cloth/cloth_odd_p01_2.csv").exists());
}

#[test]
fn what_cannot_be_held_is_told_in_one_line() {
    let lab = lab();
    let run = |design: &str, subject: &str, more: &[&str]| {
        let args = ["experiment", "run", design, "--subject", subject];
        lab.refuse(&[&args[..], more].concat())
    };
    let described = run("threshold-40", "p01", &[]);
    assert!(described.contains("--presented-elsewhere"), "{described}");
    let described = run("no-such", "p01", &[]);
    assert!(described.contains("there is no design"), "{described}");
    let described = run("cloth.toml", "Ada Lovelace", &[]);
    assert!(described.contains("no real name"), "{described}");
    let described = run("cloth.toml", "p01", &["--resume"]);
    assert!(described.contains("no session 1 of p01"), "{described}");
    let described = run("cloth.toml", "p01", &["--folder", "cloth.toml"]);
    assert!(described.contains("--folder"), "{described}");
    lab.write("bad.toml", CLOTH.replace("real-cloth", "stylus"));
    let described = run("bad.toml", "p01", &[]);
    assert!(described.contains("bad.toml:3"), "{described}");
    assert!(!lab.path("cloth").exists(), "nothing was begun");
}

#[test]
fn a_design_that_was_changed_in_between_is_refused() {
    let lab = lab();
    lab.run_on(&RUN, &answers(0..3));
    let before = fs::read(lab.path(LOG)).unwrap();
    lab.write("cloth.toml", CLOTH.replace("seed = 3", "seed = 4"));
    let described = lab.refuse(&[&RUN[..], &["--resume"]].concat());
    assert!(
        described.contains("cloth.toml was changed since session 1"),
        "{described}"
    );
    assert_eq!(fs::read(lab.path(LOG)).unwrap(), before);
}

#[test]
fn something_else_may_present_what_an_array_would() {
    let lab = Lab::new();
    let args = [
        "experiment",
        "run",
        "odd-one-out",
        "--subject",
        "p01",
        "--folder",
        "here",
        "--presented-elsewhere=rig 2",
    ];
    let outcome = lab.run_on(&args, "\n\n2 hard\nquit\n");
    assert_eq!(outcome.code, 0, "{outcome:?}");
    let log = Rows::trials(&lab.path("here/similar-fabrics_odd-one-out_p01_1.csv"));
    assert_eq!(log.text("device"), ["rig 2"]);
    assert_eq!(log.text("practice"), ["1"]);
}

#[test]
fn a_log_says_how_far_levels_of_its_textiles_may_be_off() {
    let lab = Lab::with_scene();
    let manifest = lab.read("textiles/fine/textile.toml");
    let known = "[uncertainty]\nlevels = [[40.0, 0.0, -6.0, 2.0], [320.0, 0.0, -1.0, 4.0]]\n";
    lab.write("textiles/fine/textile.toml", format!("{manifest}{known}"));
    let design = CLOTH
        .replace("real-cloth", "array")
        .replace("\"a\", \"b\", \"c\", \"d\", \"e\"", "\"fine\", \"flat\"")
        .replace("[odd_one_out]", "library = \"textiles\"\n[odd_one_out]");
    lab.write("cloth.toml", design);
    let outcome = lab.run_on(
        &[&RUN[..], &["--presented-elsewhere=rig 2"]].concat(),
        "quit\n",
    );
    assert_eq!(outcome.code, 0, "{outcome:?}");
    let sidecar = lab.read(&LOG.replace(".csv", ".json"));
    let sidecar: serde_json::Value = serde_json::from_str(&sidecar).unwrap();
    let known = sidecar["uncertain"].as_object().unwrap();
    assert_eq!(known.len(), 1, "{known:?}: the other is measured");
    let words = known["fine"].as_str().unwrap();
    assert!(
        words.contains("A40 −6.0 to +2.0 dB along the warp"),
        "{words}"
    );
}

#[test]
fn the_designs_of_the_program_are_listed_and_shown_as_files() {
    let lab = Lab::new();
    let list = lab.print(&["experiment", "designs"]);
    assert_eq!(list.lines().count(), Design::shipped_names().count());
    let shown = lab.print(&["experiment", "designs", "--show", "rating"]);
    assert_eq!(Some(shown.as_str()), Design::shipped_text("rating"));
    let described = lab.refuse(&["experiment", "designs", "--show", "ratings"]);
    assert!(described.contains("rating"), "{described}");
}

#[test]
fn a_masking_noise_is_a_sound_file_of_the_length_that_was_asked_for() {
    let lab = Lab::new();
    let noise = ["experiment", "noise", "--out", "noise.wav", "--minutes"];
    lab.print(&[&noise[..], &["1", "--seed", "4", "--colour", "white"]].concat());
    let bytes = fs::read(lab.path("noise.wav")).unwrap();
    assert_eq!(bytes.len(), 44 + 2 * 48_000 * 60);
    assert!(bytes.starts_with(b"RIFF") && &bytes[8..12] == b"WAVE");
    let described = lab.refuse(&[&noise[..], &["1", "--fade-s", "-2"]].concat());
    assert!(described.contains("fade"), "{described}");
    let described = lab.refuse(&[&noise[..], &["0"]].concat());
    assert!(described.contains("minutes"), "{described}");
    assert_eq!(
        fs::read(lab.path("noise.wav")).unwrap(),
        bytes,
        "nothing was written"
    );
}

/// A session that may write no file longer than a few thousand bytes, as on a disk that is full.
#[cfg(target_os = "linux")]
fn on_a_small_disk(lab: &Lab) -> PaneHost {
    let limited = "trap '' XFSZ; ulimit -S -f 40; exec \"$0\" \"$@\"";
    let program = lab.command(&[]).get_program().to_owned();
    let mut command = Command::new("sh");
    command
        .args(["-c", limited])
        .arg(program)
        .args(RUN)
        .current_dir(lab.path(""));
    let mut desk = PaneHost::of(command);
    desk.types(&answers(0..2));
    desk.hears("trial 3");
    desk.types(&format!("note {}\n\n3 hard\n", "x".repeat(50_000)));
    let described = desk.hears("cannot write");
    assert!(
        described.contains("Enter writes the same answer again"),
        "{described}"
    );
    desk
}

#[cfg(target_os = "linux")]
#[test]
fn on_a_full_disk_nothing_is_lost_and_the_session_goes_on_elsewhen() {
    let lab = lab();
    let mut desk = on_a_small_disk(&lab);
    assert_eq!(
        Rows::trials(&lab.path(LOG)).len(),
        2,
        "no piece of a row stays"
    );
    desk.types("\n");
    desk.hears("cannot write");
    desk.types("quit\n");
    let described = desk.hears("your note was not kept");
    assert!(described.contains("xxx"), "the note is told back");
    assert_eq!(desk.ends().code, 0);
    let outcome = lab.run_on(&[&RUN[..], &["--resume"]].concat(), &answers(2..N_TRIALS));
    assert_eq!(outcome.code, 0, "{outcome:?}");
    let whole = self::lab();
    whole.run_on(&RUN, &answers(0..N_TRIALS));
    assert_eq!(timeless(&lab.path(LOG)), timeless(&whole.path(LOG)));
}

#[cfg(target_os = "linux")]
#[test]
fn once_the_disk_has_room_the_same_answer_is_written() {
    if Command::new("prlimit").arg("--version").output().is_err() {
        eprintln!("skipped: there is no prlimit");
        return;
    }
    let lab = lab();
    let mut desk = on_a_small_disk(&lab);
    let pid = desk.child.id().to_string();
    let room = Command::new("prlimit")
        .args(["--pid", &pid, "--fsize=unlimited:"])
        .status();
    assert!(room.unwrap().success());
    desk.types("\n");
    desk.hears("trial 4");
    desk.types("quit\n");
    assert_eq!(desk.ends().code, 0);
    let log = Rows::trials(&lab.path(LOG));
    assert_eq!(log.text("response"), ["1", "2", "3"]);
    assert_eq!(log.text("grade"), ["easy", "normal", "hard"]);
    assert_eq!(log.text("note")[2].len(), 50_000);
}

#[test]
fn how_a_trial_was_explored_is_replayed_by_render() {
    let lab = Lab::with_scene();
    let design = Design::from_toml(CLOTH, Path::new("cloth.toml")).unwrap();
    let subject = Subject {
        pseudonym: "p01".to_owned(),
        nth: 0,
        session: 1,
    };
    let mut session = Session::create(&lab.path("held"), design, subject, "none").unwrap();
    let explored = ExplorationPath::from_csv(PATH, Path::new("a.csv")).unwrap();
    let circumstances = Circumstances {
        timing: Timing::between([std::time::UNIX_EPOCH; 2], [0, 500_000_000]),
        apparatus: Apparatus::default(),
        presentation: Presentation::confirmed(Proof::RealCloth),
        note: "",
        path: Some(&explored),
        samples: &[],
    };
    let Step::Trial(trial) = session.step() else {
        panic!("a trial waits");
    };
    let file = path_file(session.log(), trial, 1);
    let answer = Answer::chosen(0, Some(1));
    session.answer(&answer, &circumstances).unwrap();
    let file = file.to_str().unwrap();
    let replayed = lab.print(&["render", "a.scene.toml", "--path", file]);
    let direct = lab.print(&["render", "a.scene.toml", "--path", "a.csv"]);
    assert_eq!(replayed, direct);
    assert!(
        Rows::parse(&replayed)
            .numbers("a40_um")
            .iter()
            .any(|a| *a > 0.0)
    );
}
