//! The files of one crate and which of them use which, read from their text.
//!
//! A name is followed through re-exports to the file that defines it, so a `mod.rs` that only
//! passes on what its children define uses nobody. Tests are left out. Text only: no macros are
//! expanded, and names that a glob brings in are not seen.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// A module's path within its crate: empty for the root.
pub(crate) type ModulePath = Vec<String>;

/// An import: the path that it names, and what it is called here.
#[derive(Debug, Clone)]
struct Import {
    path: Vec<String>,
    name: String,
}

#[derive(Debug, Default)]
struct Module {
    file: PathBuf,
    code: String,
    children: BTreeSet<String>,
    items: BTreeSet<String>,
    imports: Vec<Import>,
    /// Imports that are passed on by `pub use`.
    passed_on: Vec<Import>,
}

/// The modules of a crate.
#[derive(Debug, Default)]
pub(crate) struct Modules(BTreeMap<ModulePath, Module>);

/// From a file to the files that it uses, each with the path by which it does.
pub(crate) type Uses = BTreeMap<ModulePath, BTreeMap<ModulePath, String>>;

impl Modules {
    /// The modules below the `lib.rs` of a crate's folder.
    pub(crate) fn of_crate(folder: &Path) -> Self {
        let mut modules = Self::default();
        modules.read(&[], &folder.join("lib.rs"));
        modules
    }

    /// The file of a module.
    pub(crate) fn file(&self, path: &[String]) -> &Path {
        &self.0[path].file
    }

    fn read(&mut self, path: &[String], file: &Path) {
        let text = fs::read_to_string(file).expect("sources are text");
        let code = without_tests(&without_comments(&text));
        let mut module = Module {
            file: file.to_owned(),
            ..Module::default()
        };
        let is_root = ["lib.rs", "mod.rs"].iter().any(|name| file.ends_with(name));
        let folder = if is_root {
            file.parent().expect("a file lies in a folder").to_owned()
        } else {
            file.with_extension("")
        };
        for line in code.lines().map(without_visibility) {
            if let Some(name) = line.strip_prefix("mod ").and_then(|l| l.strip_suffix(';')) {
                module.children.insert(name.to_owned());
            }
            module.items.extend(defined(line));
        }
        for (is_passed_on, list) in uses(&code) {
            let imports = imports_of(&list);
            if is_passed_on {
                module.passed_on.extend(imports.iter().cloned());
            }
            module.imports.extend(imports);
        }
        module.code = code;
        let children = module.children.clone();
        self.0.insert(path.to_vec(), module);
        for child in children {
            let places = [format!("{child}.rs"), format!("{child}/mod.rs")];
            let found = places
                .iter()
                .map(|place| folder.join(place))
                .find(|p| p.exists());
            if let Some(file) = found {
                let mut below = path.to_vec();
                below.push(child);
                self.read(&below, &file);
            }
        }
    }

    /// Which file uses which.
    pub(crate) fn uses(&self) -> Uses {
        let mut found = Uses::new();
        for (path, module) in &self.0 {
            for used in module.paths() {
                if let Some(place) = self.place_of(path, &used, 0)
                    && place != *path
                {
                    let by = found.entry(path.clone()).or_default();
                    by.entry(place).or_insert_with(|| used.join("::"));
                }
            }
        }
        found
    }

    /// The module that defines what a path names, seen from a module; `None` for another crate's.
    fn place_of(&self, from: &[String], path: &[String], depth: usize) -> Option<ModulePath> {
        let module = self.0.get(from)?;
        let first = path.first()?.as_str();
        let mut at = from.to_vec();
        let mut rest = path;
        match first {
            "crate" => (at, rest) = (Vec::new(), &path[1..]),
            "self" => rest = &path[1..],
            "super" => {
                while rest.first().is_some_and(|name| name == "super") {
                    at.pop()?;
                    rest = &rest[1..];
                }
            }
            name if module.children.contains(name) => {}
            _ => return None,
        }
        while let Some(name) = rest.first() {
            let mut below = at.clone();
            below.push(name.clone());
            if self.0.contains_key(&below) {
                at = below;
                rest = &rest[1..];
                continue;
            }
            let here = self.0.get(&at)?;
            if here.items.contains(name) {
                return Some(at);
            }
            let import = here.imports.iter().find(|import| import.name == *name);
            return match import {
                // Names that import each other end somewhere.
                Some(import) if depth < 16 => self.place_of(&at, &import.path, depth + 1),
                _ => Some(at),
            };
        }
        Some(at)
    }
}

impl Module {
    /// Every path of the file that may name something of this crate.
    fn paths(&self) -> Vec<Vec<String>> {
        let is_passed_on = |one: &Import| self.passed_on.iter().any(|two| two.path == one.path);
        let mut found: Vec<Vec<String>> = Vec::new();
        let body = without_uses(&self.code);
        let words: BTreeSet<&str> = body.split(|c: char| !is_name(c)).collect();
        for import in &self.imports {
            // What is passed on is used here only where it is named.
            if !is_passed_on(import) || words.contains(import.name.as_str()) {
                found.push(import.path.clone());
            }
        }
        for path in paths_in(&body) {
            let first = path[0].as_str();
            let import = self.imports.iter().find(|import| import.name == first);
            if ["crate", "super", "self"].contains(&first) || self.children.contains(first) {
                found.push(path);
            } else if let Some(import) = import {
                found.push(import.path.iter().chain(&path[1..]).cloned().collect());
            }
        }
        found
    }
}

fn is_name(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// Paths of two names and more: `a::b::C`.
fn paths_in(code: &str) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    let words = code.split(|c: char| !is_name(c) && c != ':');
    for word in words.filter(|word| word.contains("::") && !word.starts_with("::")) {
        let names = word.split("::").filter(|name| !name.is_empty());
        let names: Vec<String> = names
            .map(|name| name.trim_matches(':').to_owned())
            .collect();
        if names.len() > 1 {
            found.push(names);
        }
    }
    found
}

fn without_comments(text: &str) -> String {
    let code = |line: &str| {
        line.split("//")
            .next()
            .unwrap_or_default()
            .trim_end()
            .to_owned()
    };
    text.lines().map(code).collect::<Vec<_>>().join("\n")
}

/// The code without modules and imports for tests.
fn without_tests(code: &str) -> String {
    let mut kept = Vec::new();
    let mut lines = code.lines().peekable();
    while let Some(line) = lines.next() {
        let is_gate = line.trim_start().starts_with("#[cfg(") && line.contains("test");
        if !is_gate {
            kept.push(line);
            continue;
        }
        let mut depth = 0_i32;
        for line in lines.by_ref() {
            if line.trim_start().starts_with("#[") && depth == 0 {
                continue;
            }
            depth += i32::try_from(line.matches('{').count()).expect("few braces");
            depth -= i32::try_from(line.matches('}').count()).expect("few braces");
            if depth == 0 {
                break;
            }
        }
    }
    kept.join("\n")
}

fn without_visibility(line: &str) -> &str {
    let Some(rest) = line.strip_prefix("pub") else {
        return line;
    };
    let rest = rest.strip_prefix('(').map_or(rest, |inner| {
        inner.split_once(')').map_or(inner, |(_, after)| after)
    });
    rest.trim_start()
}

/// The name of what a line at the left margin defines.
fn defined(line: &str) -> Option<String> {
    let mut words = line.split([' ', '!']).peekable();
    let qualifiers = ["const", "async", "unsafe"];
    while words.peek().is_some_and(|word| qualifiers.contains(word)) {
        let is_constant = words.next() == Some("const") && words.peek() != Some(&"fn");
        if is_constant {
            return words.next().map(leading_name);
        }
    }
    let kinds = [
        "fn",
        "struct",
        "enum",
        "trait",
        "type",
        "static",
        "union",
        "macro_rules",
    ];
    let is_kind = words.next().is_some_and(|word| kinds.contains(&word));
    let name = words.find(|word| !word.is_empty())?;
    is_kind.then(|| leading_name(name))
}

fn leading_name(word: &str) -> String {
    word.chars().take_while(|&c| is_name(c)).collect()
}

/// The imports of a file: whether they are passed on, and what stands after `use`.
fn uses(code: &str) -> Vec<(bool, String)> {
    let mut found = Vec::new();
    let mut open: Option<(bool, String)> = None;
    for line in code.lines() {
        if open.is_none() {
            let is_passed_on = line.starts_with("pub");
            let list = without_visibility(line.trim_start()).strip_prefix("use ");
            open = list.map(|list| (is_passed_on, list.to_owned()));
        } else if let Some((_, list)) = &mut open {
            list.push_str(line.trim());
        }
        if open.as_ref().is_some_and(|(_, list)| list.ends_with(';')) {
            let (is_passed_on, list) = open.take().expect("it was just there");
            found.push((is_passed_on, list.trim_end_matches(';').to_owned()));
        }
    }
    found
}

fn without_uses(code: &str) -> String {
    let mut kept = Vec::new();
    let mut is_in_use = false;
    for line in code.lines() {
        is_in_use |= without_visibility(line.trim_start()).starts_with("use ");
        if !is_in_use {
            kept.push(line);
        }
        is_in_use &= !line.trim_end().ends_with(';');
    }
    kept.join("\n")
}

/// Every name of a tree of imports: `a::{b, c::{self, D as E}}`.
fn imports_of(tree: &str) -> Vec<Import> {
    let mut found = Vec::new();
    gather(&[], tree, &mut found);
    found
}

fn gather(before: &[String], tree: &str, found: &mut Vec<Import>) {
    for part in split_at_commas(tree) {
        let part = part.trim();
        if let Some((head, inner)) = part.split_once('{') {
            let names = head.split("::").filter(|name| !name.trim().is_empty());
            let names = names.map(|name| name.trim().to_owned());
            let head: Vec<String> = before.iter().cloned().chain(names).collect();
            gather(&head, inner.trim_end().trim_end_matches('}'), found);
            continue;
        }
        let (path, name) = part
            .split_once(" as ")
            .map_or((part, None), |(p, n)| (p, Some(n)));
        let names = path.split("::").map(|name| name.trim().to_owned());
        let mut path: Vec<String> = before.iter().cloned().chain(names).collect();
        if path
            .last()
            .is_some_and(|last| last == "self" || last == "*")
        {
            path.pop();
        }
        if let Some(last) = path.last().filter(|last| !last.is_empty()).cloned() {
            let name = name.map_or(last, |name| name.trim().to_owned());
            found.push(Import { path, name });
        }
    }
}

fn split_at_commas(tree: &str) -> Vec<&str> {
    let (mut depth, mut start) = (0, 0);
    let mut parts = Vec::new();
    for (at, c) in tree.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&tree[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&tree[start..]);
    parts
}

/// The circles among files: sets of files each of which uses every other, by whatever way round.
pub(crate) fn circles(uses: &Uses) -> Vec<BTreeSet<ModulePath>> {
    let reach = |from: &ModulePath| {
        let mut reached = BTreeSet::new();
        let mut waiting = vec![from.clone()];
        while let Some(path) = waiting.pop() {
            for used in uses.get(&path).into_iter().flat_map(BTreeMap::keys) {
                if reached.insert(used.clone()) {
                    waiting.push(used.clone());
                }
            }
        }
        reached
    };
    let reached: BTreeMap<&ModulePath, BTreeSet<ModulePath>> =
        uses.keys().map(|path| (path, reach(path))).collect();
    let mut found: Vec<BTreeSet<ModulePath>> = Vec::new();
    for (&path, from_here) in &reached {
        let is_back = |other: &&ModulePath| reached.get(*other).is_some_and(|r| r.contains(path));
        let mut circle: BTreeSet<ModulePath> = from_here.iter().filter(is_back).cloned().collect();
        circle.insert(path.clone());
        if circle.len() > 1 && !found.contains(&circle) {
            found.push(circle);
        }
    }
    found
}
