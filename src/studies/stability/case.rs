//! An extreme case: what goes in, what should come back, and what came back.

/// What came back: as promised, or otherwise.
pub(super) type Verdict = Result<String, String>;

/// An extreme case.
pub(super) struct Case {
    /// What it belongs to: `speed`, `files`.
    pub(super) area: &'static str,
    /// What goes in.
    pub(super) tried: String,
    /// What should come back.
    pub(super) should: &'static str,
    /// Tries it.
    pub(super) run: Box<dyn FnOnce() -> Verdict + Send>,
}

impl Case {
    /// A case of an area: what goes in, what should come back, and the trial.
    pub(super) fn new(
        area: &'static str,
        tried: impl Into<String>,
        should: &'static str,
        run: impl FnOnce() -> Verdict + Send + 'static,
    ) -> Self {
        Self {
            area,
            tried: tried.into(),
            should,
            run: Box::new(run),
        }
    }
}

/// Cases of an area: what goes in, what should come back, and the trial.
macro_rules! cases {
    ($area:literal; $($tried:expr => $should:expr, $run:expr;)+) => {
        vec![$(Case::new($area, $tried, $should, $run)),+]
    };
}
pub(super) use cases;

/// As promised or otherwise, with what came back.
pub(super) fn verdict(is_as_promised: bool, came_back: String) -> Verdict {
    if is_as_promised {
        Ok(came_back)
    } else {
        Err(came_back)
    }
}

/// What should be refused: as promised if it was, with all of these parts in the reason.
pub(super) fn refused<T>(result: Result<T, impl std::fmt::Display>, parts: &[&str]) -> Verdict {
    match result {
        Ok(_) => Err("it was taken".to_owned()),
        Err(error) => {
            let line = error.to_string();
            let has_all = parts.iter().all(|part| line.contains(part)) && !line.contains('\n');
            verdict(has_all, format!("refused: {line}"))
        }
    }
}

/// An error in words, for trials that need something to work before they can begin.
pub(super) fn failed(error: impl std::fmt::Display) -> String {
    format!("the trial itself failed: {error}")
}
