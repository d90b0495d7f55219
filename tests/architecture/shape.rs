//! The shape of the house: the floors of the window, and how much one type may hold.

use super::{report, sources};

/// The floors of the window: who may use whom.
#[test]
fn the_floors_of_the_window_stay_apart() {
    let mut faults = Vec::new();
    let uses = |line: &str, path: &str| line.contains(path);
    for source in sources(&["src/workbench"]) {
        let path = source.path.trim_start_matches("src/workbench/");
        let is_test = path.contains("/tests/") || path.ends_with("tests.rs");
        let mut parts = path.split('/');
        let floor = parts.next().unwrap_or_default();
        let tool = parts.next().unwrap_or_default().trim_end_matches(".rs");
        let above: &[&str] = match floor {
            "kit" => &["crate::bench", "crate::tools", "crate::shell"],
            "bench" => &["crate::tools", "crate::shell"],
            "tools" => &["crate::shell", "crate::tools"],
            _ => &[],
        };
        let own = format!("crate::tools::{tool}");
        // Tests may drive the whole window.
        let code = source.code().take_while(|(_, line)| *line != "mod tests {");
        for (number, line) in code.filter(|_| !is_test) {
            let is_own = floor == "tools" && uses(line, &own);
            for upper in above.iter().filter(|upper| uses(line, upper) && !is_own) {
                faults.push(format!("{}:{number}: uses {upper}", source.path));
            }
        }
    }
    report(
        "a floor of the window uses one above it, or a tool another tool",
        &faults,
    );
}

/// Fields of a struct that is neither a message on the wire nor a row of a file.
const MAX_FIELDS: usize = 20;

/// Messages on the wire and rows of files: they have as many fields as the other side.
const ROWS: &[&str] = &["Caps"];

#[test]
fn no_type_has_more_fields_than_a_head_holds() {
    let mut faults = Vec::new();
    for source in sources(&["src"]) {
        let mut open: Option<(String, usize)> = None;
        for (number, line) in source.code() {
            let words: Vec<&str> = line.split_whitespace().collect();
            let name = words.iter().position(|word| *word == "struct");
            if let (Some(at), true) = (name, line.ends_with('{') && !line.starts_with(' ')) {
                let name = words.get(at + 1).copied().unwrap_or_default();
                let name = name.split(['<', '{']).next().unwrap_or_default();
                open = Some((name.to_owned(), 0));
            } else if line == "}" {
                if let Some((name, n)) = open.take().filter(|(_, n)| *n > MAX_FIELDS)
                    && !ROWS.contains(&name.as_str())
                {
                    let place = format!("{}:{number}", source.path);
                    faults.push(format!(
                        "{place}: {name} has {n} fields, divide it by subject"
                    ));
                }
            } else if let Some((_, n)) = &mut open {
                let field = line
                    .strip_prefix("    ")
                    .filter(|rest| !rest.starts_with(' '));
                *n += usize::from(field.is_some_and(|rest| rest.contains(": ")));
            }
        }
    }
    report("a type of too many fields", &faults);
}
