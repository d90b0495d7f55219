//! The ids of textiles: names of folders everywhere.

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
