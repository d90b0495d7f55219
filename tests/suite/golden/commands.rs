//! Every command of the guide that needs no device, on small inputs, and the help of every one.

use super::compare::Golden;
use super::samples::{MATRIX_SCALE, export, height_matrix, lit_cloth, profile, readings};
use super::script::Script;
use crate::program::Lab;

/// The commands that a help text lists.
fn commands_in(help: &str) -> Vec<String> {
    let Some((_, list)) = help.split_once("Commands:\n") else {
        return Vec::new();
    };
    let listed = list.lines().take_while(|line| !line.is_empty());
    let is_name = |line: &&str| line.starts_with("  ") && !line.starts_with("   ");
    let name = |line: &str| line.split_whitespace().next().unwrap().to_owned();
    listed.filter(is_name).map(name).collect()
}

/// Tells the help of a command and of all below it.
fn tell_help(script: &mut Script, command: &str) {
    let line = format!("{command} --help");
    script.run(&line);
    let words: Vec<&str> = line.split_whitespace().collect();
    for inner in commands_in(&script.lab.print(&words)) {
        tell_help(script, format!("{command} {inner}").trim());
    }
}

#[test]
fn golden_help() {
    let mut golden = Golden::of("commands/help");
    let mut script = Script::in_lab(Lab::new());
    tell_help(&mut script, "");
    script.run("--version").run("nonsense").run("render");
    script.compare(&mut golden, "help");
    golden.finish();
}

#[test]
fn golden_render() {
    let mut golden = Golden::of("commands/render");
    let mut script = Script::in_lab(Lab::with_scene()).steadied_by(without_times);
    let path = "t_s,x_mm,y_mm,angle_deg\n0,15,40,0\n0.2,35,42,10\n0.4,60,38,350\n";
    script.lab.write("turned.csv", path);
    script
        .run("render a.scene.toml --path a.csv")
        .run("render a.scene.toml --path turned.csv --out t.csv --stats s.json")
        .file("t.csv")
        .file("s.json")
        .run("render a.scene.toml --path a.csv --wav w.wav --hjif h.hjif --frames f.csv")
        .file("w.wav")
        .file("h.hjif")
        .file("f.csv")
        .run("render a.scene.toml --path a.csv --wav i.wav --wav-format archive")
        .file("i.wav")
        .run("render nowhere.toml --path a.csv");
    for method in ["reference", "banded", "table"] {
        let name = format!("{method}.csv");
        let line = format!("render a.scene.toml --path turned.csv --method {method} --out {name}");
        script.run(&line).file(&name);
    }
    script.compare(&mut golden, "render");
    golden.finish();
}

#[test]
fn golden_drape() {
    let mut golden = Golden::of("commands/drape");
    let mut script = Script::in_lab(Lab::new());
    let scene = include_str!("../../../assets/scenes/denim.drape.toml");
    script.lab.write("denim.drape.toml", scene);
    // They close within 40 ms, press, and are drawn down together.
    let hands = "t_s,x_mm,y_mm,z_mm,opening_mm\n0,100,60,0,10\n0.04,100,60,0,-2\n\
                 0.15,100,50,0,-2\n";
    script.lab.write("hands.csv", hands);
    script.lab.write(
        "still.csv",
        "t_s,x_mm,y_mm,z_mm,opening_mm\n0,100,60,0,60\n",
    );
    script
        .lab
        .write("limp.drape.toml", scene.replace("\"top\"", "\"left\""));
    script
        .lab
        .write("wide.drape.toml", scene.replace("200.0]", "-1.0]"));
    script
        .run(
            "drape denim.drape.toml --path hands.csv --out f.csv --mesh m.csv --amplitudes a.csv \
             --stats s.json",
        )
        .file("f.csv")
        .file("m.csv")
        .file("a.csv")
        .file("s.json")
        .run("drape denim.drape.toml --path hands.csv --out l.csv --dt 4 --integrator ie")
        .file("l.csv")
        .run("drape denim.drape.toml --out rest.csv")
        .file("rest.csv")
        .run("drape denim.drape.toml --path hands.csv --integrator xpbd --out x.csv")
        .run("drape test denim")
        .run("drape denim.drape.toml --path hands.csv --integrator explicit --dt 1")
        .run("drape denim.drape.toml --path hands.csv --dt 0")
        .run("drape denim.drape.toml --path still.csv")
        .run("drape denim.drape.toml --path nowhere.csv")
        .run("drape limp.drape.toml")
        .run("drape wide.drape.toml")
        .run("drape denim.drape.toml --integrator rk4")
        .run("drape test nothing")
        .run("drape");
    script.compare(&mut golden, "drape");
    golden.finish();
}

/// Takes away numbers that are measured by a clock.
fn without_times(line: &str) -> String {
    let is_time = ["_ns\"", "_us\"", "_s\":"];
    let is_time = is_time.iter().any(|unit| line.contains(unit));
    match line.split_once(": ") {
        Some((name, value)) if is_time => {
            let comma = if value.ends_with(',') { "," } else { "" };
            format!("{name}: TIME{comma}")
        }
        _ => line.to_owned(),
    }
}

#[test]
fn golden_library() {
    let mut golden = Golden::of("commands/library");
    let mut script = Script::in_lab(Lab::with_scene());
    script
        .run("textile list")
        .run("textile list --library seventy-four")
        .run("textile list --library textiles")
        .run("textile show silk-crepe")
        .run("textile show silk-crepe --recipe")
        .run("textile show fine --library textiles")
        .run("textile spectra fine --library textiles --out s.csv")
        .file("s.csv")
        .run("textile levels")
        .run("textile levels --library textiles --out l.csv")
        .file("l.csv")
        .run("textile select --library seventy-four")
        .run("textile catalogue --library textiles --out sheets")
        .folder("sheets")
        .run("textile show nothing");
    script.compare(&mut golden, "library");
    golden.finish();
}

#[test]
fn golden_made_textiles() {
    let mut golden = Golden::of("commands/make");
    let mut script = Script::in_lab(Lab::new()).steadied_by(without_duration);
    for (name, phase) in [("a.csv", 0.0), ("b.csv", 1.0), ("c.csv", 2.5)] {
        script.lab.write(name, profile(phase));
    }
    for (name, phase) in [("a-probe.csv", 0.0), ("b-probe.csv", 1.0)] {
        let [probe, tracker] = readings(phase);
        script.lab.write(name, probe);
        script.lab.write("tracker.csv", tracker);
    }
    for (id, file) in [("jute-plain", "weave.toml"), ("polyamide-rib", "knit.toml")] {
        let recipe = script.lab.print(&["textile", "show", id, "--recipe"]);
        script.lab.write(file, recipe);
    }
    script
        .run("textile make weave weave.toml --out mine/weave")
        .run("textile make knit knit.toml --out mine/knit")
        .run(
            "textile make brownian --hurst 0.3 --smd-um 6 --seed 4 --step-mm 0.1 \
              --out mine/brownian",
        )
        .run(
            "textile learn-fourier --readings a-probe.csv tracker.csv \
              --readings b-probe.csv tracker.csv --out read.toml",
        )
        .file("read.toml")
        .run("textile learn-fourier a.csv b.csv c.csv --name linen --out linen.toml")
        .file("linen.toml")
        .run("textile make fourier --template linen.toml --seed 4 --out mine/fourier")
        .run(
            "textile make restoration --warp a.csv --weft b.csv --harmonics 12 \
              --composition additive --out mine/restoration",
        )
        .folder("mine")
        .run("textile make library mine --out built")
        .file("built/library.toml")
        .run("textile build --library mine --out all --threads 1")
        .file("all/library.toml");
    script.compare(&mut golden, "make");
    golden.finish();
}

/// Takes away how long it took, on how many threads.
fn without_duration(line: &str) -> String {
    match line.split_once(" textiles in ") {
        Some((before, _)) => format!("{before} textiles in TIME"),
        None => line.to_owned(),
    }
}

#[test]
fn golden_imports() {
    let mut golden = Golden::of("commands/import");
    let mut script = Script::in_lab(Lab::new());
    script.lab.write("map.txt", height_matrix());
    script.lab.write("twill.txt", export());
    script
        .run("textile import map.txt --out mine/map")
        .run(&format!(
            "textile import map.txt --out mine/map {MATRIX_SCALE} --name Ripple"
        ))
        .run(&format!(
            "textile import map.txt --out mine/felt {MATRIX_SCALE} --areal"
        ))
        .run("textile import-kes twill.txt --out mine/twill --name Twill --official-band")
        .folder("mine");
    for ending in ["x3p", "gsf", "npy", "png", "tif"] {
        let name = format!("map.{ending}");
        script.run(&format!(
            "textile convert map.txt --out {name} {MATRIX_SCALE} --fill"
        ));
        script.file(&name);
    }
    script.compare(&mut golden, "import");
    golden.finish();
}

const DISSIMILARITIES: &str = "\
,a,b,c,d,e,f
a,,1,2.1,3.3,4.2,5.4
b,1,,1.1,2.2,3.4,4.6
c,,,0,1.3,2.3,3.5
d,3.3,2.2,1.3,,1.2,2.4
e,4.2,3.4,2.3,1.2,,1.4
f,5.4,4.6,3.5,2.4,1.4,
";

#[test]
fn golden_picture_and_mds() {
    let mut golden = Golden::of("commands/picture-and-mds");
    let mut script = Script::in_lab(Lab::new());
    lit_cloth().save(script.lab.path("scan.png")).unwrap();
    script.lab.write("d.csv", DISSIMILARITIES);
    script
        .run("picture scan.png --out scan --px-per-mm 20 --threads 1")
        .folder("scan")
        .run(
            "picture scan.png --out felt --dpi 600 --light 45,30 --relief-um 180 \
              --textile mine/scan",
        )
        .folder("mine")
        .run("picture scan.png --out part --region 20,10,200,180 --even-light off --lambda 1.5")
        .file("part/periodicity.json")
        .run("mds d.csv --dims 1-2 --starts 5 --json m.json")
        .file("m.json")
        .run("mds d.csv --dims 1-2 --starts 5 --ties secondary --loss sstress --seed 3");
    script.compare(&mut golden, "picture-and-mds");
    golden.finish();
}

const CLOTH: &str = "study = \"cloth\"\nexperiment = \"odd\"\nmedium = \"real-cloth\"\nseed = 3\n\
    title = \"Odd cloth\"\ntextiles = [\"a\", \"b\", \"c\", \"d\", \"e\"]\n[odd_one_out]\n";

#[test]
fn golden_experiment() {
    let mut golden = Golden::of("commands/experiment");
    let mut script = Script::in_lab(Lab::new());
    script.lab.write("cloth.toml", CLOTH);
    let answers = "\n1 easy\n\n2 easy\n\n3 hard\n".repeat(4);
    script.run("experiment designs");
    let list = script.lab.print(&["experiment", "designs"]);
    for name in list
        .lines()
        .filter_map(|line| line.split_whitespace().next())
    {
        script.run(&format!("experiment designs --show {name}"));
    }
    script
        .run_on("experiment run cloth.toml --subject p01", &answers)
        .run("experiment run cloth.toml --subject p01")
        .run_on(
            "experiment run cloth.toml --subject p01 --restart",
            "\n1 easy\nquit\n",
        )
        .run_on(
            "experiment run cloth.toml --subject p01 --resume",
            "note loud\nquit\n",
        )
        .run("experiment run jnd-40 --subject p01")
        .run(
            "experiment simulate odd-one-out --observers 1 --out looks --looks 4 --strategy all \
              --weighting learnt --lapse 0.1 --spread 0.2 --sessions 2",
        )
        .folder("looks")
        .run("experiment noise --out noise.wav --minutes 1 --seed 4")
        .file("noise.wav")
        .run("experiment replicate --studies 20 --out again")
        .file("again/published-numbers.csv");
    script.compare(&mut golden, "experiment");
    golden.finish();
}

/// Studies of errors alone, or whose times stand in columns of their own.
const STUDIES: [&str; 7] = [
    "spectral-model",
    "velocity",
    "brownian",
    "restoration",
    "virtual-probe",
    "savings",
    "stability",
];

#[test]
fn golden_reports() {
    let mut golden = Golden::of("commands/report");
    let mut script = Script::in_lab(Lab::new());
    for study in STUDIES {
        script.run(&format!(
            "report --only {study} --quick --seed 3 --out {study}"
        ));
        let table = script.lab.read(&format!("{study}/{study}.csv"));
        script.note(&format!("{study}.csv"), &untimed(&table));
    }
    script.compare(&mut golden, "report");
    golden.finish();
}

/// A table without the columns that a clock fills.
fn untimed(table: &str) -> String {
    let is_timed = |name: &str| {
        let of_clock = ["cpu_", "wall_", "n_repeats", "n_processes", "pareto"];
        of_clock.iter().any(|start| name.starts_with(start))
    };
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let header = reader.headers().unwrap().clone();
    let kept: Vec<usize> = (0..header.len())
        .filter(|&column| !is_timed(&header[column]))
        .collect();
    let line = |row: &csv::StringRecord| {
        let cells: Vec<&str> = kept.iter().map(|&column| &row[column]).collect();
        format!("{}\n", cells.join(";"))
    };
    let rows = reader.records().map(|row| line(&row.unwrap()));
    std::iter::once(line(&header)).chain(rows).collect()
}

#[test]
fn golden_report_and_bridge() {
    let mut golden = Golden::of("commands/report-and-bridge");
    let mut script = Script::in_lab(Lab::new());
    script
        .run("report --list")
        .run("bridge list --udev-rule")
        .run("bridge kit --out kit")
        .folder("kit")
        .run("bridge kit --out kit")
        .run("bridge test --port nowhere")
        .run("");
    script.compare(&mut golden, "report-and-bridge");
    golden.finish();
}
