//! XML: the leaves of a document, one after the other. No entities but the five of XML and
//! characters by number; no document types.

use std::path::Path;

use quick_xml::Reader;
use quick_xml::events::Event;

use super::{FileError, line_at};

/// Deepest nesting that is read.
const MAX_DEEP: usize = 64;

/// Calls `visit` with the path (`Record1/Axes/CX`, without name-space prefixes) and the text of
/// every element as it ends; texts are trimmed. `path` only names the document in errors.
///
/// # Errors
/// What is no well-formed XML, with its line; whatever `visit` refuses.
pub fn visit_elements(
    xml: &[u8],
    path: &Path,
    mut visit: impl FnMut(&str, &str) -> Result<(), FileError>,
) -> Result<(), FileError> {
    let xml = xml.strip_prefix(b"\xef\xbb\xbf").unwrap_or(xml);
    let mut reader = Reader::from_reader(xml);
    let (mut names, mut text) = (String::new(), String::new());
    let mut lengths: Vec<usize> = Vec::new();
    loop {
        let offset = usize::try_from(reader.buffer_position()).unwrap_or(usize::MAX);
        let wrong = |what: String| {
            let line = line_at(xml, offset);
            FileError::content(path, line, what, "get an intact copy of the file")
        };
        let event = reader.read_event();
        match event.map_err(|error| wrong(error.to_string()))? {
            Event::Start(tag) => {
                if lengths.len() == MAX_DEEP {
                    return Err(wrong(format!("more than {MAX_DEEP} elements deep")));
                }
                lengths.push(names.len());
                enter(&mut names, tag.local_name().as_ref());
                text.clear();
            }
            Event::Empty(tag) => {
                let length = names.len();
                enter(&mut names, tag.local_name().as_ref());
                visit(&names, "")?;
                names.truncate(length);
            }
            Event::End(_) => {
                visit(&names, text.trim())?;
                names.truncate(lengths.pop().unwrap_or(0));
                text.clear();
            }
            Event::Text(part) => text.push_str(&String::from_utf8_lossy(&part)),
            Event::CData(part) => text.push_str(&String::from_utf8_lossy(&part)),
            Event::GeneralRef(name) => {
                let by_number = name.resolve_char_ref();
                let by_number = by_number.map_err(|error| wrong(error.to_string()))?;
                text.extend(by_number.or_else(|| named(&name)));
            }
            Event::Eof if lengths.is_empty() => return Ok(()),
            Event::Eof => return Err(wrong(format!("the text ends within {names}"))),
            Event::Comment(_) | Event::Decl(_) | Event::PI(_) | Event::DocType(_) => {}
        }
    }
}

fn enter(names: &mut String, name: &[u8]) {
    if !names.is_empty() {
        names.push('/');
    }
    names.push_str(&String::from_utf8_lossy(name));
}

fn named(name: &[u8]) -> Option<char> {
    match name {
        b"lt" => Some('<'),
        b"gt" => Some('>'),
        b"amp" => Some('&'),
        b"apos" => Some('\''),
        b"quot" => Some('"'),
        _ => None,
    }
}

/// A text as XML spells it.
pub fn xml_text(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    text.replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_come_with_their_path_and_text() {
        let xml = "\u{feff}<?xml version=\"1.0\"?><!-- a --><p:a xmlns:p=\"u\"><b> 1 &amp; \
                   &#181;m </b><c/><b><d>2</d></b></p:a>";
        let mut seen = Vec::new();
        let mut visit = |path: &str, text: &str| {
            seen.push(format!("{path}={text}"));
            Ok(())
        };
        visit_elements(xml.as_bytes(), Path::new("a.xml"), &mut visit).unwrap();
        assert_eq!(seen, ["a/b=1 & µm", "a/c=", "a/b/d=2", "a/b=", "a="]);
        assert_eq!(xml_text("a<b & c>"), "a&lt;b &amp; c&gt;");
    }

    #[test]
    fn what_is_no_xml_is_refused_with_its_line() {
        let deep = "<a>".repeat(1000);
        for xml in ["<a>\n<b>\n</a>", "<a>", deep.as_str()] {
            let read = visit_elements(xml.as_bytes(), Path::new("a.xml"), |_, _| Ok(()));
            let error = read.unwrap_err().to_string();
            assert!(
                error.starts_with("a.xml:") && error.contains("; "),
                "{error}"
            );
        }
    }
}
