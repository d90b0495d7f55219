//! Runs the built program in a folder of its own, with small textiles to run it on.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};

/// A folder that is removed at the end of a test.
pub(crate) struct Lab {
    folder: PathBuf,
}

/// What a run of the program left behind.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub(crate) code: i32,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Lab {
    /// An empty folder.
    pub(crate) fn new() -> Self {
        Self::named("lab")
    }

    /// The same with a name that tells whose it is.
    pub(crate) fn named(name: &str) -> Self {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let name = format!("selvedge-{name}-{}-{number}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        fs::create_dir_all(&folder).unwrap();
        Self { folder }
    }

    /// A folder with a library of two textiles, a scene that places both and a path over them.
    pub(crate) fn with_scene() -> Self {
        let lab = Self::new();
        lab.add_textile("fine", |x_mm| {
            4.0 * (std::f64::consts::TAU * 3.2 * x_mm).sin()
        });
        lab.add_textile("flat", |_| 1.0);
        lab.write("a.scene.toml", SCENE);
        lab.write("a.csv", PATH);
        lab
    }

    /// Writes a file and gives its place.
    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, content).unwrap();
        path
    }

    /// Adds a textile that is measured along the warp only, 20 mm of it.
    pub(crate) fn add_textile(&self, id: &str, height_um: impl Fn(f64) -> f64) {
        let row = |sample: u16| {
            let x_mm = f64::from(sample) / 230.0;
            format!("{x_mm},{}\n", height_um(x_mm))
        };
        let rows: String = (0..4600).map(row).collect();
        let profile = format!("x_mm,height_um\n{rows}");
        self.write(&format!("textiles/{id}/warp.csv"), profile);
        self.write(&format!("textiles/{id}/textile.toml"), MANIFEST);
    }

    /// The place of a file.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// The text of a file.
    pub(crate) fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    /// The program, to be run here without a display.
    pub(crate) fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_selvedge"));
        command
            .args(args)
            .current_dir(&self.folder)
            .env("XDG_CACHE_HOME", self.folder.join("cache"))
            .env("XDG_DATA_HOME", self.folder.join("data"))
            .stdin(Stdio::null());
        for variable in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
            command.env_remove(variable);
        }
        command
    }

    /// Runs the program to its end on what it is fed, all of which it takes.
    pub(crate) fn run_on(&self, args: &[&str], fed: &str) -> Outcome {
        let mut command = self.command(args);
        command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let mut stdin = child.stdin.take().unwrap();
        stdin.write_all(fed.as_bytes()).unwrap();
        drop(stdin);
        Outcome::of(&child.wait_with_output().unwrap())
    }

    /// Runs the program to its end.
    pub(crate) fn run(&self, args: &[&str]) -> Outcome {
        Outcome::of(&self.command(args).output().unwrap())
    }

    /// Runs the program, which must succeed without a word on stderr, and gives what it prints.
    pub(crate) fn print(&self, args: &[&str]) -> String {
        let outcome = self.run(args);
        assert_eq!(
            (outcome.code, outcome.err.as_str()),
            (0, ""),
            "{args:?}: {outcome:?}"
        );
        outcome.out
    }

    /// Runs the program, which must refuse with exit code 2 and one line on stderr; gives the line.
    pub(crate) fn refuse(&self, args: &[&str]) -> String {
        let outcome = self.run(args);
        assert_eq!(outcome.code, 2, "{args:?}: {outcome:?}");
        assert_eq!(outcome.out, "", "{args:?}: nothing but the error is said");
        outcome.one_line()
    }
}

impl Outcome {
    pub(crate) fn of(output: &Output) -> Self {
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
        let code = output.status.code().unwrap_or(-1);
        // On a machine that is busy any work may take the second from which on it shows progress,
        // and frames may come late, which is told and no failure.
        let is_of_load = |line: &&str| line.contains(" %, ") || line.contains("frames came late");
        let err = text(&output.stderr);
        let err: String = err
            .split_inclusive('\n')
            .filter(|line| !is_of_load(line))
            .collect();
        Self {
            code,
            out: text(&output.stdout),
            err,
        }
    }

    /// The one line on stderr, without the program's name.
    pub(crate) fn one_line(&self) -> String {
        let line = self.err.strip_suffix('\n').unwrap_or(&self.err);
        assert!(!line.contains('\n'), "one line: {:?}", self.err);
        line.strip_prefix("selvedge: ")
            .unwrap_or_else(|| panic!("{line:?}"))
            .to_owned()
    }
}

impl Drop for Lab {
    fn drop(&mut self) {
        drop(fs::remove_dir_all(&self.folder));
    }
}

/// The rows of a CSV as text cells, and the column of each name.
pub(crate) struct Rows {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Rows {
    pub(crate) fn parse(text: &str) -> Self {
        let cells = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
        let mut lines = text.lines();
        let header = cells(lines.next().unwrap());
        Self {
            header,
            rows: lines.map(cells).collect(),
        }
    }

    pub(crate) fn read(path: &Path) -> Self {
        Self::parse(&fs::read_to_string(path).unwrap())
    }

    /// The trials of a log of an experiment, without what opens and closes it.
    pub(crate) fn trials(log: &Path) -> Self {
        let mut all = Self::read(log);
        let kind = all.header.iter().position(|name| name == "kind").unwrap();
        all.rows.retain(|row| row[kind] == "trial");
        all
    }

    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }

    pub(crate) fn header(&self) -> String {
        self.header.join(",")
    }

    /// The cells of a column.
    pub(crate) fn text(&self, column: &str) -> Vec<&str> {
        let index = self.header.iter().position(|name| name == column);
        let index = index.unwrap_or_else(|| panic!("no column {column} in {:?}", self.header));
        self.rows.iter().map(|row| row[index].as_str()).collect()
    }

    /// The numbers of a column.
    pub(crate) fn numbers(&self, column: &str) -> Vec<f64> {
        self.text(column)
            .iter()
            .map(|cell| cell.parse().unwrap())
            .collect()
    }
}

const MANIFEST: &str = r#"name = "Sample"
construction = "other"
fibre = "none"
gain_db = 0.0
[source]
kind = "profiles"
warp_forward = "warp.csv"
"#;

/// Two textiles of 60 × 60 mm side by side, the left one with a profile.
pub(crate) const SCENE: &str = r#"name = "Two"
library = "textiles"
size_mm = [140.0, 80.0]

[[textile]]
id = "fine"
origin_mm = [10.0, 10.0]
size_mm = [60.0, 60.0]
rotation_deg = 0.0
gain_db = 0.0
label = "1"

[[textile]]
id = "flat"
origin_mm = [70.0, 10.0]
size_mm = [60.0, 60.0]

[[display]]
geometry = "exeter-24"

[filters]
kind = "log-gaussian"
octaves = 2.0

[tuning]
gain_db = 0.0
compression = 0.0
"#;

/// A stroke of 0.5 s at 100 mm/s to the right over the left textile.
pub(crate) const PATH: &str = "t_s,x_mm,y_mm\n0,15,40\n0.5,65,40\n";
