//! Notices: one sentence each that says what is wrong and how to mend it, until put away or until
//! what it speaks of is over.

/// Most notices that are kept; older ones go.
const MAX_NOTICES: usize = 20;
/// How long a notice stays that asks for nothing, s.
const READING_S: f64 = 20.0;

/// When a notice is over without being put away.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Until {
    /// Never.
    PutAway,
    /// Once there was time to read it: it asks for nothing.
    Read,
    /// Once a device is armed.
    Armed,
    /// Once a device is ready.
    Ready,
    /// Once no recording is made.
    Recorded,
    /// Once no session of an experiment is held.
    SessionOver,
    /// Once a tablet or program was chosen.
    InputChosen,
    /// Once frames come in time again.
    InTime,
    /// Once sound plays, or is off.
    Heard,
}

/// A sentence for the user.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Notice {
    /// Its number, by which it is put away.
    pub number: u64,
    /// What is wrong and how to mend it.
    pub text: String,
    /// How often it was given.
    pub(crate) n_times: u32,
    until: Until,
    /// When it was followed first since it was given last, by the toolkit's clock, s.
    since_s: Option<f64>,
}

/// The notices that nobody has put away yet, old to new.
#[derive(Debug, Clone, Default)]
pub(crate) struct Notices {
    shown: Vec<Notice>,
    n_given: u64,
}

impl Notices {
    /// Gives a notice that stays until it is put away. The same sentence twice is one, counted.
    pub(crate) fn give(&mut self, text: impl Into<String>) {
        self.give_until(Until::PutAway, text);
    }

    /// Gives a notice that goes by itself.
    pub(crate) fn give_until(&mut self, until: Until, text: impl Into<String>) {
        let text = text.into();
        let last = self.shown.iter().position(|notice| notice.text == text);
        let n_before = last.map_or(0, |place| self.shown.remove(place).n_times);
        self.n_given += 1;
        self.shown.push(Notice {
            number: self.n_given,
            text,
            n_times: n_before + 1,
            until,
            since_s: None,
        });
        if self.shown.len() > MAX_NOTICES {
            self.shown.remove(0);
        }
    }

    /// Puts one away.
    pub(crate) fn dismiss(&mut self, number: u64) {
        self.shown.retain(|notice| notice.number != number);
    }

    /// Puts all away.
    pub(crate) fn dismiss_all(&mut self) {
        self.shown.clear();
    }

    /// Puts away those that begin with a name.
    pub(crate) fn forget_about(&mut self, name: &str) {
        self.shown.retain(|notice| !notice.text.starts_with(name));
    }

    /// Lets those go whose time is over, by the toolkit's clock, and those of which `is_over` says
    /// so. Says after how many seconds the next is read, if one waits for that.
    pub(crate) fn follow(&mut self, now_s: f64, is_over: impl Fn(Until) -> bool) -> Option<f64> {
        let mut next_s: Option<f64> = None;
        self.shown.retain_mut(|notice| {
            let left_s = *notice.since_s.get_or_insert(now_s) + READING_S - now_s;
            if notice.until != Until::Read {
                return !is_over(notice.until);
            }
            next_s = Some(next_s.map_or(left_s, |next_s| next_s.min(left_s)));
            left_s > 0.0
        });
        next_s.filter(|left_s| *left_s > 0.0)
    }

    /// Whether this is said already.
    pub(crate) fn says(&self, text: &str) -> bool {
        self.shown.iter().any(|notice| notice.text == text)
    }

    /// Those that are shown, old to new.
    pub(crate) fn shown(&self) -> &[Notice] {
        &self.shown
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_sentence_is_one_that_is_counted_and_newest_again() {
        let mut notices = Notices::default();
        for text in ["a", "b", "a", "c"] {
            notices.give(text);
        }
        let shown = notices.shown().iter();
        let shown: Vec<(&str, u32)> = shown.map(|n| (n.text.as_str(), n.n_times)).collect();
        assert_eq!(shown, [("b", 1), ("a", 2), ("c", 1)]);
        notices.forget_about("c");
        assert!(!notices.says("c") && notices.says("a"));
        notices.dismiss(notices.shown()[0].number);
        assert_eq!(notices.shown().len(), 1);
        for i in 0..2 * MAX_NOTICES {
            notices.give(i.to_string());
        }
        assert_eq!(notices.shown().len(), MAX_NOTICES, "the oldest went");
        notices.dismiss_all();
        assert!(notices.shown().is_empty());
    }

    #[test]
    fn notices_go_when_their_reason_is_over_or_they_were_read() {
        let mut notices = Notices::default();
        notices.give_until(Until::Armed, "arm first");
        notices.give_until(Until::Read, "written");
        notices.give("stays");
        assert_eq!(notices.follow(3.0, |_| false), Some(READING_S));
        assert_eq!(notices.shown().len(), 3);
        notices.follow(4.0, |until| until == Until::Armed);
        assert!(!notices.says("arm first"));
        notices.give_until(Until::Read, "written");
        assert_eq!(
            notices.follow(20.0, |_| false),
            Some(READING_S),
            "read anew"
        );
        assert_eq!(notices.follow(40.0, |_| false), None);
        assert_eq!(notices.shown().len(), 1, "only what stays");
    }
}
