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
        "bridge",
        &[
            "selvedge bridge list",
            "selvedge bridge emulate --link /tmp/array",
            "selvedge bridge test --port /tmp/array",
        ],
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

/// The commands with their examples.
pub(super) fn added(command: Command) -> Command {
    let with = |command: Command, (name, lines): &(&str, &[&str])| {
        let text = format!("Examples:\n  {}", lines.join("\n  "));
        if name.is_empty() {
            command.after_help(text)
        } else {
            command.mut_subcommand(name, |inner| inner.after_help(text))
        }
    };
    EXAMPLES.iter().fold(command, with)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_example_is_a_command_line_that_parses() {
        for (name, lines) in EXAMPLES {
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
                let words: Vec<&str> = line.split(' ').collect();
                let is_of = name.is_empty() || words.get(1) == Some(name);
                assert!(is_of, "{line} under {name}");
            }
        }
    }

    #[test]
    fn every_command_has_an_example() {
        let without = ["friction", "input", "stage"];
        for command in crate::command().get_subcommands() {
            let has_one = EXAMPLES.iter().any(|(name, _)| *name == command.get_name());
            let name = command.get_name();
            assert!(has_one != without.contains(&name), "{name}");
        }
    }
}
