//! Texts in a figure: escaped for XML, shortened, wrapped.

/// A text as XML may hold it. Control characters have no place in XML and become spaces.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

/// A text of at most `longest` characters, with `…` where it was cut.
pub(super) fn shortened(text: &str, longest: usize) -> String {
    if text.chars().count() <= longest {
        return text.to_owned();
    }
    let kept: String = text.chars().take(longest.saturating_sub(1)).collect();
    format!("{}…", kept.trim_end())
}

/// A text in lines of at most `longest` characters, broken between words.
pub(super) fn wrapped(text: &str, longest: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let word = shortened(word, longest);
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= longest => {
                line.push(' ');
                line.push_str(&word);
            }
            _ => lines.push(word),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_in_a_text_is_taken_for_markup() {
        assert_eq!(
            escaped("a<b> & \"c\" 'd'\u{0}\u{1b}e"),
            "a&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;  e"
        );
    }

    #[test]
    fn long_texts_are_cut_or_broken_between_words() {
        assert_eq!(shortened("plain weave", 6), "plain…");
        assert_eq!(shortened("plain", 5), "plain");
        assert_eq!(wrapped("one two  three", 7), ["one two", "three"]);
        assert!(wrapped(" ", 7).is_empty(), "nothing has no lines");
    }
}
