//! As much of Markdown as the guide is written in: headings, paragraphs, lists, tables and blocks
//! of code; within lines bold and slanted words, code and links.

use std::iter::Peekable;

/// What stands before lines that are shown as they are.
const INDENT: &str = "    ";

/// A part of a page.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Block {
    /// A heading of this depth, from 1.
    Heading(usize, String),
    /// Lines that flow.
    Paragraph(Vec<Span>),
    /// A point of a list, with what stands before it.
    Point(String, Vec<Span>),
    /// Lines as they are.
    Code(String),
    /// Rows of cells; the first is the head.
    Table(Vec<Vec<Vec<Span>>>),
}

/// Letters that look alike.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Span {
    Plain(String),
    Bold(String),
    Slanted(String),
    Code(String),
    /// A link: its words, and where it leads.
    Link(String, String),
}

impl Span {
    /// Its letters.
    pub(crate) fn text(&self) -> &str {
        match self {
            Self::Plain(text)
            | Self::Bold(text)
            | Self::Slanted(text)
            | Self::Code(text)
            | Self::Link(text, _) => text,
        }
    }
}

/// The lines of a page that were not read yet.
type Lines<'a> = Peekable<std::str::Lines<'a>>;

/// The parts of a page.
pub(crate) fn blocks(text: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        let line = line.trim_end();
        if line.is_empty() || line.starts_with("![") {
            continue;
        }
        blocks.push(if let Some(first) = line.strip_prefix(INDENT) {
            indented(first, &mut lines)
        } else if line.starts_with("```") {
            let code = lines.by_ref().take_while(|line| !line.starts_with("```"));
            Block::Code(code.collect::<Vec<_>>().join("\n"))
        } else if line.starts_with('#') {
            let depth = line.bytes().take_while(|byte| *byte == b'#').count();
            let title = spans(line[depth..].trim());
            Block::Heading(depth, title.iter().map(Span::text).collect())
        } else if line.starts_with('|') {
            table(line, &mut lines)
        } else {
            flowing(line, &mut lines)
        });
    }
    blocks
}

fn indented(first: &str, lines: &mut Lines<'_>) -> Block {
    let mut code = vec![first];
    while let Some(next) = lines.next_if(|next| next.starts_with(INDENT)) {
        code.push(&next[INDENT.len()..]);
    }
    Block::Code(code.join("\n"))
}

fn table(head: &str, lines: &mut Lines<'_>) -> Block {
    let mut rows = vec![cells(head)];
    while let Some(row) = lines.next_if(|line| line.starts_with('|')) {
        let is_rule = row.chars().all(|c| "|-: ".contains(c));
        if !is_rule {
            rows.push(cells(row));
        }
    }
    Block::Table(rows)
}

/// A paragraph or a point of a list.
fn flowing(line: &str, lines: &mut Lines<'_>) -> Block {
    let (bullet, rest) = bullet(line).map_or((None, line), |(bullet, rest)| (Some(bullet), rest));
    let mut words = rest.trim().to_owned();
    while let Some(next) = lines.next_if(|next| flows_on(next)) {
        words.push(' ');
        words.push_str(next.trim());
    }
    let spans = spans(&words);
    match bullet {
        Some(bullet) => Block::Point(bullet, spans),
        None => Block::Paragraph(spans),
    }
}

/// Whether a line belongs to the paragraph or point before it.
fn flows_on(line: &str) -> bool {
    let is_other = ["#", "|", "```", "!["];
    let starts_other = is_other.iter().any(|start| line.starts_with(start));
    !(line.trim().is_empty() || starts_other || bullet(line).is_some())
}

/// What stands before a point of a list, and the rest of the line.
fn bullet(line: &str) -> Option<(String, &str)> {
    let trimmed = line.trim_start();
    if let Some(rest) = trimmed.strip_prefix("- ") {
        return Some(("•".to_owned(), rest));
    }
    let (number, rest) = trimmed.split_once(". ")?;
    let is_number = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
    is_number.then(|| (format!("{number}."), rest))
}

fn cells(row: &str) -> Vec<Vec<Span>> {
    let row = row.trim().trim_start_matches('|').trim_end_matches('|');
    // A bar within code is none between cells.
    let row = row.replace("\\|", "\u{0}");
    let cells = row.split('|');
    cells
        .map(|cell| spans(&cell.trim().replace('\u{0}', "|")))
        .collect()
}

/// Lines as letters that look alike.
pub(crate) fn spans(text: &str) -> Vec<Span> {
    let mut found = Vec::new();
    let mut plain = String::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let Some((span, after)) = marked(rest) else {
            plain.push(first);
            rest = &rest[first.len_utf8()..];
            continue;
        };
        if !plain.is_empty() {
            found.push(Span::Plain(std::mem::take(&mut plain)));
        }
        found.push(span);
        rest = after;
    }
    if !plain.is_empty() {
        found.push(Span::Plain(plain));
    }
    found
}

/// What is marked at the very beginning, and what follows it.
fn marked(text: &str) -> Option<(Span, &str)> {
    let within = |mark: &str| {
        let (inside, after) = text.strip_prefix(mark)?.split_once(mark)?;
        let is_marked = !inside.is_empty() && !inside.starts_with(' ') && !inside.ends_with(' ');
        is_marked.then(|| (inside.to_owned(), after))
    };
    if let Some((code, after)) = within("`") {
        return Some((Span::Code(code), after));
    }
    if let Some((bold, after)) = within("**") {
        return Some((Span::Bold(bold.replace(['*', '`'], "")), after));
    }
    if let Some((slanted, after)) = within("*") {
        return Some((Span::Slanted(slanted), after));
    }
    let (words, rest) = text.strip_prefix('[')?.split_once("](")?;
    let (target, after) = rest.split_once(')')?;
    let words = words.replace('`', "");
    let is_link = !words.contains('[') && !target.contains(' ');
    is_link.then(|| (Span::Link(words, target.to_owned()), after))
}

/// What a link to a heading calls it.
pub(crate) fn anchor(title: &str) -> String {
    let kept = |c: char| match c {
        ' ' => Some('-'),
        '-' | '_' => Some(c),
        c if c.is_alphanumeric() => c.to_lowercase().next(),
        _ => None,
    };
    title.chars().filter_map(kept).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shell::guide::{guide_pages, page};

    #[test]
    fn what_is_marked_is_told_from_what_is_not() {
        let found = spans("a **b** `c|d` *e f* [g](h.md#i) 2 * 3 * 4");
        let expected = [
            Span::Plain("a ".to_owned()),
            Span::Bold("b".to_owned()),
            Span::Plain(" ".to_owned()),
            Span::Code("c|d".to_owned()),
            Span::Plain(" ".to_owned()),
            Span::Slanted("e f".to_owned()),
            Span::Plain(" ".to_owned()),
            Span::Link("g".to_owned(), "h.md#i".to_owned()),
            Span::Plain(" 2 * 3 * 4".to_owned()),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn lists_tables_and_code_are_parts_of_their_own() {
        let lists = "# T\none\ntwo\n- a\n  b\n1. c\n\n";
        let table = "| h | i |\n|---|---|\n| j | k |\n";
        let code = "```\nx  y\n```\n\n    z\n      z\n";
        let found = blocks(&[lists, table, code].concat());
        assert_eq!(found[0], Block::Heading(1, "T".to_owned()));
        assert_eq!(found[1], Block::Paragraph(spans("one two")));
        assert_eq!(found[2], Block::Point("•".to_owned(), spans("a b")));
        assert_eq!(found[3], Block::Point("1.".to_owned(), spans("c")));
        assert!(matches!(&found[4], Block::Table(rows) if rows.len() == 2));
        assert_eq!(found[5], Block::Code("x  y".to_owned()));
        assert_eq!(found[6], Block::Code("z\n  z".to_owned()));
    }

    #[test]
    fn every_link_of_the_guide_leads_to_a_page_and_a_heading() {
        for from in guide_pages() {
            let links = blocks(from.text).into_iter().flat_map(|block| match block {
                Block::Paragraph(spans) | Block::Point(_, spans) => spans,
                Block::Table(rows) => rows.into_iter().flatten().flatten().collect(),
                Block::Heading(..) | Block::Code(_) => Vec::new(),
            });
            let targets = links.filter_map(|span| match span {
                Span::Link(_, target) => Some(target),
                _ => None,
            });
            let in_guide = |target: &String| !target.contains("://") && !target.starts_with("..");
            for target in targets.filter(in_guide) {
                let (name, heading) = target.split_once('#').unwrap_or((&target, ""));
                let name = name.strip_suffix(".md").unwrap_or(name);
                let to = if name.is_empty() {
                    Some(from)
                } else {
                    page(name)
                };
                let to = to.unwrap_or_else(|| panic!("{}: no page {target}", from.name));
                let leads_to = |block: Block| match block {
                    Block::Heading(_, title) => anchor(&title) == heading,
                    _ => false,
                };
                let is_there = heading.is_empty() || blocks(to.text).into_iter().any(leads_to);
                assert!(is_there, "{}: no heading {target}", from.name);
            }
        }
    }
}
