//! Examples at the end of the help of commands: lines that a user can type.

use clap::Command;

/// Commands, and lines of the shell that show what they are for. A test parses every line.
const EXAMPLES: &[(&str, &[&str])] = &[
    (
        "",
        &[
            "selvedge",
            "selvedge my.scene.toml",
            "selvedge render my.scene.toml --path finger.csv --out amplitudes.csv",
            "selvedge help scenes",
        ],
    ),
    (
        "render",
        &[
            "selvedge render my.scene.toml --path finger.csv --out amplitudes.csv",
            "selvedge render my.scene.toml --path finger.csv --wav drive.wav --stats cost.json",
            "selvedge render my.scene.toml --path - < finger.csv | head",
        ],
    ),
    (
        "probe",
        &["selvedge probe --surface denim --path finger.csv --out force.csv"],
    ),
    (
        "drape",
        &["selvedge drape denim.drape.toml --path fingers.csv --out force.csv --stats cost.json"],
    ),
    ("drape test", &["selvedge drape test denim"]),
    (
        "figure",
        &["selvedge figure my.scene.toml --path finger.csv --out figure"],
    ),
    (
        "play",
        &[
            "selvedge play my.scene.toml --path finger.csv --port /dev/ttyACM0 --log sent.csv",
            "selvedge play my.scene.toml --path finger.csv --audio USB --channels 1-24",
        ],
    ),
    (
        "textile",
        &[
            "selvedge textile list",
            "selvedge textile show silk-crepe",
            "selvedge textile levels --out levels.csv",
        ],
    ),
    (
        "textile list",
        &[
            "selvedge textile list",
            "selvedge textile list --library seventy-four --json",
        ],
    ),
    (
        "textile show",
        &[
            "selvedge textile show silk-crepe",
            "selvedge textile show denim --recipe > mine.toml",
        ],
    ),
    (
        "textile spectra",
        &["selvedge textile spectra denim --out spectra.csv"],
    ),
    (
        "textile levels",
        &["selvedge textile levels --library my/textiles --out levels.csv"],
    ),
    (
        "textile select",
        &["selvedge textile select --library seventy-four"],
    ),
    (
        "textile build",
        &["selvedge textile build --library seventy-four --out built"],
    ),
    (
        "textile make",
        &["selvedge textile make weave mine.toml --out my/cloth"],
    ),
    (
        "textile make weave",
        &[
            "selvedge textile make weave mine.toml --out my/cloth",
            "selvedge textile make weave - --out my/denim < denim.toml",
        ],
    ),
    (
        "textile make knit",
        &["selvedge textile make knit jersey.toml --out my/jersey"],
    ),
    (
        "textile make fourier",
        &["selvedge textile make fourier drawn.toml --out my/drawn"],
    ),
    (
        "textile make brownian",
        &["selvedge textile make brownian rough.toml --out my/rough"],
    ),
    (
        "textile make restoration",
        &["selvedge textile make restoration --warp warp.csv --weft weft.csv --out my/restored"],
    ),
    (
        "textile make library",
        &["selvedge textile make library recipes --out my/textiles"],
    ),
    (
        "textile learn-fourier",
        &["selvedge textile learn-fourier a.csv b.csv c.csv --out template.toml"],
    ),
    (
        "textile import",
        &[
            "selvedge textile import scan.x3p --out my/cloth",
            "selvedge textile import scan.npy --step-mm 0.01 --height-unit um --out my/cloth",
        ],
    ),
    ("textile rebuild", &["selvedge textile rebuild my/cloth"]),
    (
        "textile convert",
        &["selvedge textile convert scan.sur --out scan.x3p"],
    ),
    (
        "textile import-kes",
        &["selvedge textile import-kes warp.txt weft.txt --name cloth --out my/cloth"],
    ),
    (
        "textile catalogue",
        &["selvedge textile catalogue --out catalogue"],
    ),
    (
        "picture",
        &[
            "selvedge picture cloth.jpg --out cloth --px-per-mm 24",
            "selvedge picture cloth.jpg --turned cloth-90.jpg --turned cloth-45.jpg --out cloth \
             --dpi 600 --smd-um 4 --textile my/cloth",
        ],
    ),
    (
        "mds",
        &["selvedge mds dissimilarities.csv --dims 1-5 --json maps.json"],
    ),
    (
        "experiment",
        &[
            "selvedge experiment designs",
            "selvedge experiment simulate study.toml --observers 20 --out simulated",
        ],
    ),
    (
        "experiment run",
        &["selvedge experiment run ranking-virtual-target --subject p07"],
    ),
    (
        "experiment analyse",
        &["selvedge experiment analyse logs --out analysis"],
    ),
    (
        "experiment verify",
        &["selvedge experiment verify logs --json"],
    ),
    (
        "experiment plan",
        &["selvedge experiment plan study.toml --subjects 20 --out plan.toml"],
    ),
    (
        "experiment preview",
        &["selvedge experiment preview ranking-virtual-target --subjects 12"],
    ),
    (
        "experiment designs",
        &[
            "selvedge experiment designs --json",
            "selvedge experiment designs --show ranking-virtual-target > study.toml",
        ],
    ),
    (
        "experiment noise",
        &["selvedge experiment noise --minutes 5 --out noise.wav"],
    ),
    (
        "experiment simulate",
        &["selvedge experiment simulate study.toml --observers 20 --out simulated"],
    ),
    (
        "experiment replicate",
        &["selvedge experiment replicate --studies 20 --out replication"],
    ),
    (
        "bridge",
        &[
            "selvedge bridge list",
            "selvedge bridge emulate --link /tmp/array",
            "selvedge bridge test --port /tmp/array",
        ],
    ),
    (
        "bridge list",
        &[
            "selvedge bridge list --json",
            "selvedge bridge list --udev-rule",
        ],
    ),
    ("bridge test", &["selvedge bridge test --port /dev/ttyACM0"]),
    (
        "bridge certify",
        &["selvedge bridge certify --port /dev/ttyACM0 --out certificates"],
    ),
    (
        "bridge replay",
        &["selvedge bridge replay session.csv --out felt.csv"],
    ),
    ("bridge kit", &["selvedge bridge kit --out kit"]),
    (
        "bridge identify",
        &["selvedge bridge identify --port /dev/ttyACM0 --out mine.toml"],
    ),
    (
        "bridge emulate",
        &["selvedge bridge emulate --link /tmp/array --log device.csv"],
    ),
    ("input", &["selvedge input list"]),
    ("input list", &["selvedge input list --json"]),
    ("stage", &["selvedge stage export --out totals"]),
    (
        "stage export",
        &["selvedge stage export --log visits --out totals"],
    ),
    ("doctor", &["selvedge doctor"]),
    (
        "report",
        &[
            "selvedge report --list",
            "selvedge report --out report --quick --only rendering",
        ],
    ),
    (
        "screenshot",
        &["selvedge screenshot my.scene.toml --out bench.png --width 1920 --height 1080"],
    ),
    (
        "help",
        &["selvedge help scenes", "selvedge help bridge test"],
    ),
    (
        "completions",
        &["selvedge completions bash > ~/.local/share/bash-completion/completions/selvedge"],
    ),
    ("man", &["selvedge man ~/.local/share/man/man1"]),
];

/// The same of commands that are part of the program only where it has networks.
#[cfg(feature = "friction")]
const OF_FRICTION: &[(&str, &[&str])] = &[
    (
        "friction",
        &["selvedge friction generate cloth.png --px-per-mm 12.8 --out friction.csv"],
    ),
    (
        "friction generate",
        &["selvedge friction generate cloth.png --px-per-mm 12.8 --out friction.csv"],
    ),
    (
        "friction train",
        &["selvedge friction train --split A --out runs"],
    ),
    (
        "friction evaluate",
        &["selvedge friction evaluate --out runs"],
    ),
];
#[cfg(not(feature = "friction"))]
const OF_FRICTION: &[(&str, &[&str])] = &[];

/// The commands with their examples.
pub(super) fn added(command: Command) -> Command {
    let all = EXAMPLES.iter().chain(OF_FRICTION);
    all.fold(command, |command, (name, lines)| {
        let names: Vec<&str> = name.split_whitespace().collect();
        added_to(command, &names, lines)
    })
}

fn added_to(command: Command, names: &[&str], lines: &[&str]) -> Command {
    match names {
        [] => command.after_help(format!("Examples:\n  {}", lines.join("\n  "))),
        [first, rest @ ..] => command.mut_subcommand(first, |inner| added_to(inner, rest, lines)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_example_is_a_command_line_that_parses() {
        for (name, lines) in EXAMPLES.iter().chain(OF_FRICTION) {
            for line in *lines {
                let typed = line
                    .split([' '])
                    .take_while(|word| !["<", ">", "|"].contains(word));
                let parsed = crate::command().try_get_matches_from(typed);
                assert!(
                    parsed.is_ok(),
                    "{line}: {:?}",
                    parsed.err().map(|e| e.to_string())
                );
                let is_of = line.starts_with(format!("selvedge {name}").trim_end());
                assert!(is_of, "{line} under {name}");
            }
        }
    }

    #[test]
    fn every_command_has_an_example_however_deep_it_lies() {
        fn look(command: &Command, name: &str, n_seen: &mut usize) {
            for inner in command.get_subcommands() {
                let name = format!("{name} {}", inner.get_name());
                let text = inner.get_after_help().map(ToString::to_string);
                let has_one = text.is_some_and(|text| text.contains(&format!("selvedge{name}")));
                assert!(has_one, "{name}");
                *n_seen += 1;
                look(inner, &name, n_seen);
            }
        }
        let mut n_seen = 0;
        look(&crate::command(), "", &mut n_seen);
        assert!(n_seen > 50, "{n_seen} commands");
    }
}
