//! The ids of textiles: names of folders everywhere, and of textiles in other libraries.

use std::path::Path;

use super::recipe_file::is_of_the_program;

/// What the library of the sixteen is called in the id of a textile.
pub(crate) const SIXTEEN: &str = "sixteen";

/// Letters that an id may have at most.
const MAX_LETTERS: usize = 64;

/// The id of one of several textiles of an import: `id-2`, or as it is if it is alone.
pub fn nth_id(id: &str, nth: usize, n: usize) -> String {
    if n > 1 {
        format!("{id}-{}", nth + 1)
    } else {
        id.to_owned()
    }
}

/// The library and the id there, of an id that names a textile of another library.
///
/// `seventy-four:serge`, `./own/textiles:serge`: only libraries of the program and paths are
/// libraries here; a colon in any other id means nothing.
pub fn elsewhere(id: &str) -> Option<(&Path, &str)> {
    let (library, id) = id.rsplit_once(':')?;
    let is_named = library == SIXTEEN || is_of_the_program(Path::new(library));
    (is_named || library.contains(['/', '\\'])).then_some((Path::new(library), id))
}

/// The id of a textile of another library, which stands under `id` there.
pub fn id_in(library: &Path, id: &str) -> String {
    format!("{}:{id}", library.display())
}

/// Letters of western European languages and what stands for them in an id.
const PLAIN: [(&str, &str); 12] = [
    ("àáâãäå", "a"),
    ("èéêë", "e"),
    ("ìíîï", "i"),
    ("òóôõöø", "o"),
    ("ùúûü", "u"),
    ("ýÿ", "y"),
    ("ç", "c"),
    ("ñ", "n"),
    ("ß", "ss"),
    ("æ", "ae"),
    ("œ", "oe"),
    ("ð", "d"),
];

/// The id that a name makes: lower-case letters without accents and digits, joined by hyphens.
/// Empty when nothing of the name is left.
pub fn id_of(name: &str) -> String {
    let mut plain = name.to_lowercase();
    for (letters, letter) in PLAIN {
        plain = plain.replace(|found| letters.contains(found), letter);
    }
    let words = plain.split(|letter: char| !letter.is_ascii_alphanumeric());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    let id: String = words.join("-").chars().take(MAX_LETTERS).collect();
    id.trim_end_matches('-').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_id_names_another_library_only_by_a_path_or_a_name_of_the_program() {
        let serge = |library: &'static str| Some((Path::new(library), "serge"));
        for (id, expected) in [
            ("seventy-four:serge", serge("seventy-four")),
            ("sixteen:serge", serge("sixteen")),
            ("/home/a:b/textiles:serge", serge("/home/a:b/textiles")),
            ("./textiles:serge", serge("./textiles")),
            ("serge", None),
            ("wool: 2", None),
        ] {
            assert_eq!(elsewhere(id), expected, "{id}");
        }
        let id = id_in(Path::new("/a"), "serge");
        assert_eq!(elsewhere(&id), serge("/a"));
    }

    #[test]
    fn ids_are_words_with_hyphens() {
        for (name, id) in [
            ("Wool twill (2/2), É.", "wool-twill-2-2-e"),
            ("Silk crêpe 2", "silk-crepe-2"),
            ("Öl & Straße", "ol-strasse"),
            ("../etc", "etc"),
            (" ../.. ", ""),
            ("…", ""),
        ] {
            assert_eq!(id_of(name), id, "{name}");
        }
        assert_eq!(id_of(&"x".repeat(99)).len(), MAX_LETTERS);
    }

    #[test]
    fn several_are_numbered() {
        assert_eq!(
            (nth_id("twill", 0, 1), nth_id("twill", 2, 3)),
            ("twill".into(), "twill-3".into())
        );
    }
}
