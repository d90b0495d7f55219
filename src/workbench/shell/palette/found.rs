//! What the palette finds, best first: plain data, made anew for what is sought.

use eframe::egui::Context;

use crate::bench::Bench;
use crate::bench::acts;
use crate::bench::command::edit::Edit;
use crate::bench::command::{Command, RecordingCommand, ShowCommand};
use crate::bench::keys::all_written;
use crate::bench::pane::Pane;

/// Something that was found.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Found {
    /// What it is called.
    pub(crate) what: String,
    /// Of which kind it is.
    pub(crate) kind: String,
    /// Its keys, written out; empty if it has none.
    pub(crate) keys: String,
    /// What is done when it is chosen.
    pub(crate) command: Command,
}

/// What matches, best first; everything while nothing is sought.
pub(crate) fn found(sought: &str, bench: &Bench) -> Vec<Found> {
    let sought = sought.to_lowercase();
    let words: Vec<&str> = sought.split_whitespace().collect();
    let all = acts_to_find(&bench.ctx)
        .chain(panes())
        .chain(textiles(bench))
        .chain(recordings(bench));
    let mut matching: Vec<(u8, Found)> = all
        .filter_map(|one| Some((rank(&words, &one)?, one)))
        .collect();
    matching.sort_by_key(|(rank, _)| *rank);
    matching.into_iter().map(|(_, one)| one).collect()
}

/// How well it matches, 0 best: its name begins with what is sought, words of it do, or it holds it
/// somewhere; `None` if a word is not in it.
fn rank(words: &[&str], one: &Found) -> Option<u8> {
    let name = one.what.to_lowercase();
    let whole = format!("{name} {}", one.kind.to_lowercase());
    if !words.iter().all(|word| whole.contains(word)) {
        return None;
    }
    let begins = |word: &&str| {
        name.split([' ', '-', '('])
            .any(|part| part.starts_with(word))
    };
    Some(match words.first() {
        Some(first) if name.starts_with(first) => 0,
        _ if words.iter().all(begins) => 1,
        _ => 2,
    })
}

fn acts_to_find(ctx: &Context) -> impl Iterator<Item = Found> {
    acts::all().iter().map(move |act| Found {
        what: act.what.clone(),
        kind: act.concern.title().to_owned(),
        keys: all_written(ctx, act),
        command: act.command.clone(),
    })
}

fn panes() -> impl Iterator<Item = Found> {
    Pane::ALL.into_iter().map(|pane| Found {
        what: pane.title().to_owned(),
        kind: "pane".to_owned(),
        keys: String::new(),
        command: ShowCommand::Reveal(pane).into(),
    })
}

/// The textiles of all libraries, to be laid into the scene.
fn textiles(bench: &Bench) -> impl Iterator<Item = Found> {
    let shelves = bench.library.view.shelves();
    shelves.flat_map(|shelf| {
        let usable = shelf.items.iter().filter(|item| item.flaw.is_none());
        usable.map(move |item| Found {
            what: item.name.clone(),
            kind: format!("textile, {}", shelf.title),
            keys: String::new(),
            command: Edit::AddCloths(vec![item.id.clone()]).into(),
        })
    })
}

fn recordings(bench: &Bench) -> impl Iterator<Item = Found> {
    let entries = bench.exploration.recordings.entries().iter();
    entries.map(|entry| Found {
        what: entry.about.name.clone(),
        kind: "recording, to replay".to_owned(),
        keys: String::new(),
        command: RecordingCommand::Choose(entry.place.clone()).into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(what: &str, kind: &str) -> Found {
        Found {
            what: what.to_owned(),
            kind: kind.to_owned(),
            keys: String::new(),
            command: Command::Undo,
        }
    }

    #[test]
    fn every_word_must_be_there_and_beginnings_come_first() {
        let wool = one("Wool worsted twill", "textile, Shipped 16");
        assert_eq!(rank(&["wool"], &wool), Some(0));
        assert_eq!(rank(&["twill", "wool"], &wool), Some(1));
        assert_eq!(rank(&["orsted"], &wool), Some(2));
        assert_eq!(rank(&["textile", "wool"], &wool), Some(2));
        assert_eq!(rank(&["wool", "silk"], &wool), None);
        assert_eq!(
            rank(&[], &wool),
            Some(1),
            "everything while nothing is sought"
        );
    }
}
