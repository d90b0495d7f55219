//! Lines that repeat, told once with a count. Pure: time comes in, lines go out.
//!
//! A text is told at once when it is new, then at most once a second, with how often it was said
//! since. Texts that take turns are told apart, 64 of them; what others say, such as a device, has
//! room for 16 new texts a second.

use std::time::{Duration, Instant};

/// How often a text is told at most.
const EVERY: Duration = Duration::from_secs(1);
/// Texts that are remembered.
const MAX_TEXTS: usize = 64;
/// New texts of others that are told within a second.
const MAX_OF_OTHERS: u32 = 16;

/// What was said lately.
#[derive(Debug, Default)]
pub(super) struct Repeats {
    texts: Vec<Text>,
    /// Since when new texts of others are counted, and how many were told.
    others: Option<(Instant, u32)>,
    n_left_out: u64,
}

#[derive(Debug)]
struct Text {
    words: String,
    told: Instant,
    /// How often it was said since.
    n_again: u64,
}

impl Text {
    /// What is to be told of it when it was said since: once, as it was said, so that few lines are
    /// the same however fast they came; more often, with a count.
    fn take(&mut self, now: Instant) -> Option<String> {
        let line = match self.n_again {
            0 => return None,
            1 => self.words.clone(),
            n => format!("{} (again {n} times)", self.words),
        };
        (self.told, self.n_again) = (now, 0);
        Some(line)
    }

    /// Said again: told if it is time.
    fn again(&mut self, now: Instant) -> Option<String> {
        self.n_again += 1;
        self.is_due(now).then(|| self.take(now)).flatten()
    }

    fn is_due(&self, now: Instant) -> bool {
        now.saturating_duration_since(self.told) >= EVERY
    }
}

impl Repeats {
    /// The lines to write when the program says `words`.
    pub(super) fn say(&mut self, now: Instant, words: &str) -> Vec<String> {
        let mut lines = self.overdue(now, words);
        match self.known(words) {
            Some(text) => lines.extend(text.again(now)),
            None => lines.extend(self.learn(now, words)),
        }
        lines
    }

    /// The same for `words` of others, of which there may be any number.
    pub(super) fn hear(&mut self, now: Instant, words: &str) -> Vec<String> {
        let mut lines = self.overdue(now, words);
        if self.known(words).is_some() || self.has_room(now) {
            lines.extend(self.say(now, words));
        } else {
            self.n_left_out += 1;
        }
        lines
    }

    /// What was said and not told, at the end.
    pub(super) fn end(&mut self, now: Instant) -> Vec<String> {
        let texts = std::mem::take(&mut self.texts);
        let untold = texts.into_iter().filter_map(|mut text| text.take(now));
        let untold: Vec<String> = untold.collect();
        untold.into_iter().chain(self.left_out()).collect()
    }

    fn known(&mut self, words: &str) -> Option<&mut Text> {
        self.texts.iter_mut().find(|text| text.words == words)
    }

    /// What is to be told of other texts than `words` by now.
    fn overdue(&mut self, now: Instant, words: &str) -> Vec<String> {
        let others = self.texts.iter_mut();
        let due = others.filter(|text| text.words != words && text.is_due(now));
        let mut lines: Vec<String> = due.filter_map(|text| text.take(now)).collect();
        let is_over = self
            .others
            .is_none_or(|(since, _)| now.saturating_duration_since(since) >= EVERY);
        if is_over {
            lines.extend(self.left_out());
        }
        lines
    }

    /// Tells a new text, in place of the one that was told longest ago if there is no room.
    fn learn(&mut self, now: Instant, words: &str) -> Vec<String> {
        let mut lines = Vec::new();
        if self.texts.len() >= MAX_TEXTS {
            let told = |(_, text): &(usize, &Text)| text.told;
            let oldest = self.texts.iter().enumerate().min_by_key(told);
            let oldest = oldest.map_or(0, |(place, _)| place);
            lines.extend(self.texts.remove(oldest).take(now));
        }
        self.texts.push(Text {
            words: words.to_owned(),
            told: now,
            n_again: 0,
        });
        lines.push(words.to_owned());
        lines
    }

    /// Whether another new text of others may be told now.
    fn has_room(&mut self, now: Instant) -> bool {
        let running = self
            .others
            .filter(|(since, _)| now.saturating_duration_since(*since) < EVERY);
        let (since, n_told) = running.unwrap_or((now, 0));
        let has_room = n_told < MAX_OF_OTHERS;
        if has_room {
            self.others = Some((since, n_told + 1));
        }
        has_room
    }

    fn left_out(&mut self) -> Option<String> {
        match std::mem::take(&mut self.n_left_out) {
            0 => None,
            1 => Some("1 other line of the device is left out".to_owned()),
            n => Some(format!("{n} other lines of the device are left out")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    #[test]
    fn an_equal_line_is_told_once_a_second_with_a_count() {
        let (mut said, start) = (Repeats::default(), Instant::now());
        let mut lines = Vec::new();
        for n in 0..3000 {
            lines.extend(said.say(start + ms(n), "a fault"));
        }
        lines.extend(said.end(start + ms(3000)));
        assert_eq!(
            lines,
            [
                "a fault",
                "a fault (again 1000 times)",
                "a fault (again 1000 times)",
                "a fault (again 999 times)"
            ]
        );
        assert!(said.end(start + ms(3000)).is_empty(), "told");
    }

    #[test]
    fn lines_that_take_turns_are_told_once_a_second_each() {
        let (mut said, start) = (Repeats::default(), Instant::now());
        let mut lines = Vec::new();
        for n in 0..1500 {
            lines.extend(said.say(start + ms(n), if n % 2 == 0 { "a" } else { "b" }));
        }
        lines.extend(said.end(start + ms(1500)));
        let again = |text: &str, n: u32| format!("{text} (again {n} times)");
        let wanted = [
            "a".to_owned(),
            "b".to_owned(),
            again("a", 500),
            again("b", 500),
            again("a", 249),
            again("b", 249),
        ];
        assert_eq!(lines, wanted);
    }

    #[test]
    fn a_line_that_comes_seldom_is_told_each_time_without_a_count() {
        let (mut said, start) = (Repeats::default(), Instant::now());
        for n in 0..5 {
            assert_eq!(
                said.say(start + ms(n * 1000), "type a number"),
                ["type a number"]
            );
        }
        assert!(said.end(start + ms(4000)).is_empty());
    }

    #[test]
    fn a_count_is_told_when_anything_is_said_a_second_later() {
        let (mut said, start) = (Repeats::default(), Instant::now());
        let mut lines = said.say(start, "a");
        lines.extend(said.say(start, "a"));
        lines.extend(said.say(start + ms(1000), "b"));
        assert_eq!(lines, ["a", "a", "b"]);
    }

    #[test]
    fn different_lines_are_all_told_and_few_are_remembered() {
        let (mut said, start) = (Repeats::default(), Instant::now());
        let mut lines = said.say(start, "first");
        lines.extend(said.say(start, "first"));
        for n in 0..1000 {
            lines.extend(said.say(start + ms(1), &format!("file {n} is left out")));
        }
        assert_eq!(said.texts.len(), MAX_TEXTS);
        lines.extend(said.end(start + ms(2)));
        assert_eq!(lines.len(), 1002, "the first twice, a thousand others");
        assert_eq!(lines.iter().filter(|line| *line == "first").count(), 2);
    }

    #[test]
    fn a_talkative_device_has_room_for_16_lines_a_second() {
        let (mut said, start) = (Repeats::default(), Instant::now());
        let mut lines = Vec::new();
        for n in 0..3000 {
            lines.extend(said.hear(start + ms(n), &format!("x = {n}")));
        }
        lines.extend(said.end(start + ms(3000)));
        assert_eq!(lines.len(), 3 * 17, "{lines:?}");
        let left_out = "984 other lines of the device are left out";
        let n_told = lines.iter().filter(|line| *line == left_out).count();
        assert_eq!(n_told, 3, "{lines:?}");
        // The program's own words have room.
        assert_eq!(said.say(start + ms(3000), "stopped"), ["stopped"]);
    }
}
