//! Manifests: what is read back, and what is refused with line and mend.

use std::path::Path;

use proptest::prelude::*;

use super::*;

const PROFILES: &str = "name = \"A\"\nconstruction = \"other\"\nfibre = \"paper\"\n\
    [source]\nkind = \"profiles\"\nwarp_forward = \"w.csv\"\n";

const WEAVE: &str = "name = \"A\"\nconstruction = \"woven\"\nfibre = \"silk\"\n\
    [source]\nkind = \"weave\"\nseed = 1\ninterlacing = \"plain\"\nwarp_per_cm = 20.0\n\
    weft_per_cm = 20.0\n[source.warp]\nwidth_um = 300.0\nthickness_um = 200.0\n\
    colour = \"#ffffff\"\n[source.weft]\nwidth_um = 300.0\nthickness_um = 200.0\n\
    colour = \"#ffffff\"\n";

const KNOWN: &str = "[uncertainty]\nfriction_level = 0.1\nlevels = [[40.0, 0.0, -2.0, 3.0], \
    [40.0, 90.0, -4.0, 1.0], [320.0, 0.0, -1.0, 1.0]]\n";

fn read_text(text: &str) -> Result<Manifest, String> {
    Manifest::from_toml(text, Path::new("t.toml")).map_err(|error| error.to_string())
}

fn refused(text: &str, expected: &str) {
    let error = read_text(text).unwrap_err();
    assert!(error.starts_with(expected), "{error}");
    assert!(error.contains("; "), "a mend is missing: {error}");
    assert!(!error.contains('\n'), "more than one line: {error}");
}

#[test]
fn what_is_written_reads_back() {
    let known = format!("{PROFILES}{KNOWN}");
    for text in [PROFILES, WEAVE, &known] {
        let manifest = read_text(text).unwrap();
        let written = manifest.to_toml(Path::new("t.toml")).unwrap();
        assert_eq!(read_text(&written).unwrap(), manifest);
    }
}

#[test]
fn unknown_and_missing_keys_name_their_line() {
    refused(
        &format!("colour = 1\n{PROFILES}"),
        "t.toml:1: unknown field `colour`",
    );
    refused(
        &format!("{PROFILES}weft = 2\n"),
        "t.toml:7: unknown field `weft`",
    );
    refused(
        &WEAVE.replace("plies", "x").replace("seed = 1\n", ""),
        "t.toml:4: missing field",
    );
    refused(
        &WEAVE.replace("seed", "sed"),
        "t.toml:6: unknown field `sed`",
    );
    refused(
        &PROFILES.replace("\"profiles\"", "\"felt\""),
        "t.toml:5: unknown kind of source",
    );
    refused("name = \"A\"\n", "t.toml:1: no kind of source");
    refused(
        &PROFILES.replace("other", "glued"),
        "t.toml:2: unknown variant `glued`",
    );
    refused("name = \n", "t.toml:1: ");
}

#[test]
fn values_that_make_no_sense_name_their_line() {
    for (from, to, expected) in [
        (
            "warp_per_cm = 20.0",
            "warp_per_cm = nan",
            "t.toml:8: warp_per_cm is NaN",
        ),
        (
            "weft_per_cm = 20.0",
            "weft_per_cm = -3.0",
            "t.toml:9: weft_per_cm is -3",
        ),
        (
            "\"plain\"",
            "\"tartan\"",
            "t.toml:7: unknown interlacing \"tartan\"",
        ),
        (
            "\"plain\"",
            "[\"X.\", \"XX\"]",
            "t.toml:7: a yarn of the interlacing never changes",
        ),
        (
            "colour = \"#ffffff\"\n[",
            "colour = \"red\"\n[",
            "t.toml:13: colour is \"red\"",
        ),
        ("seed = 1", "seed = -1", "t.toml:6: "),
        (
            "seed = 1",
            "seed = 1\nwarp_forward = \"../w.csv\"",
            "t.toml:7: warp_forward is",
        ),
        ("name", "gain_db = inf\nname", "t.toml:1: gain_db is inf"),
        (
            "name",
            "noise_floor_um2_mm = -1.0\nname",
            "t.toml:1: noise_floor_um2_mm is -1",
        ),
        ("\"A\"", "\" \"", "t.toml:1: the name is empty"),
    ] {
        assert!(WEAVE.contains(from), "{from}");
        refused(&WEAVE.replacen(from, to, 1), expected);
    }
    refused(
        &PROFILES.replace("warp_forward", "weft_forward"),
        "t.toml:5: no warp profile",
    );
    refused(
        &format!("{PROFILES}[appearance]\nimage = \"a.png\"\npx_per_mm = 0\n"),
        "t.toml:9: ",
    );
    refused(
        &format!("{PROFILES}[measured]\nsmd_um = nan\n"),
        "t.toml:8: smd_um is NaN",
    );
}

#[test]
fn a_band_goes_over_from_direction_to_direction_and_what_is_none_is_refused() {
    use crate::tactile::Band;

    let known = read_text(&format!("{PROFILES}{KNOWN}"))
        .unwrap()
        .uncertainty
        .unwrap();
    for (deg, band) in [
        (0.0, [-2.0, 3.0]),
        (45.0, [-3.0, 2.0]),
        (90.0, [-4.0, 1.0]),
        (135.0, [-3.0, 2.0]),
        (-90.0, [-4.0, 1.0]),
        (180.0, [-2.0, 3.0]),
    ] {
        let found = known.level_db(Band::Low, deg);
        assert!(
            (0..2).all(|end| (found[end] - band[end]).abs() < 1e-9),
            "{deg}°: {found:?}"
        );
    }
    assert_eq!(
        known.level_db(Band::High, 90.0),
        [-1.0, 1.0],
        "one direction is all"
    );
    assert_eq!(Uncertainty::default().level_db(Band::Low, 10.0), [0.0; 2]);
    assert_eq!(known.too_wide(), None);
    for wrong in [
        "[50.0, 0.0, -2.0, 3.0]",
        "[40.0, 180.0, -2.0, 3.0]",
        "[40.0, 0.0, 3.0, -2.0]",
    ] {
        let text = format!(
            "{PROFILES}{}",
            KNOWN.replace("[40.0, 0.0, -2.0, 3.0]", wrong)
        );
        refused(&text, "t.toml:9: [");
    }
}

#[test]
fn the_recipe_hash_ignores_the_files_and_nothing_else() {
    let path = Path::new("t.toml");
    let hash = |text: &str| read_text(text).unwrap().source.recipe_hash(path).unwrap();
    let with_files = WEAVE.replace("seed = 1\n", "seed = 1\nwarp_forward = \"w.csv\"\n");
    assert_eq!(hash(WEAVE), hash(&with_files));
    assert_ne!(hash(WEAVE), hash(&WEAVE.replace("seed = 1", "seed = 2")));
}

proptest! {
    #[test]
    fn no_text_makes_the_reader_panic(text in any::<String>()) {
        drop(read_text(&text));
    }

    #[test]
    fn no_damage_makes_the_reader_panic(
        at in 0..WEAVE.len(),
        end in 0..WEAVE.len(),
        put in "[-0-9.a-z\"\n= \\[\\]]{0,12}",
    ) {
        let mut text = WEAVE.to_owned();
        text.replace_range(at.min(end)..at.max(end), &put);
        if let Ok(manifest) = read_text(&text) {
            let written = manifest.to_toml(Path::new("t.toml")).unwrap();
            prop_assert_eq!(read_text(&written).unwrap(), manifest);
        }
    }
}
