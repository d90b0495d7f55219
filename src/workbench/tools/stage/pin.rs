//! The lock before the operator's page: a PIN, and a delay that doubles with every wrong one. Pure.

/// The delay after the first wrong PIN, and the longest, s.
const FIRST_S: f64 = 1.0;
const LONGEST_S: f64 = 3600.0;
/// Digits that can be typed.
const MAX_DIGITS: usize = 16;
/// The page goes by itself once nothing was pressed for so long, s.
const LEFT_S: f64 = 60.0;

/// How far the operator is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum Access {
    /// The public sees the stage.
    #[default]
    Closed,
    /// The PIN is asked for.
    Asked,
    /// The page is open.
    Open,
}

/// The lock.
#[derive(Debug, Clone, Default)]
pub(crate) struct Lock {
    access: Access,
    digits: String,
    n_wrong: u32,
    locked_until_s: f64,
    used_s: f64,
}

impl Lock {
    /// Asks for the PIN.
    pub(crate) fn ask(&mut self, now_s: f64) {
        self.used_s = now_s;
        if self.access == Access::Closed {
            self.access = Access::Asked;
            self.digits.clear();
        }
    }

    /// Shows the stage again.
    pub(crate) fn close(&mut self) {
        self.access = Access::Closed;
        self.digits.clear();
    }

    /// How far the operator is.
    pub(crate) fn access(&self) -> Access {
        self.access
    }

    /// Digits that were typed.
    pub(crate) fn n_digits(&self) -> usize {
        self.digits.len()
    }

    /// How long nothing is taken, s.
    pub(crate) fn locked_s(&self, now_s: f64) -> f64 {
        (self.locked_until_s - now_s).max(0.0)
    }

    /// Something of the page was used.
    pub(crate) fn is_used(&mut self, now_s: f64) {
        self.used_s = now_s;
    }

    /// Goes by itself when nobody uses it.
    pub(crate) fn step(&mut self, now_s: f64) {
        if now_s - self.used_s > LEFT_S {
            self.close();
        }
    }

    /// Takes a digit.
    pub(crate) fn digit(&mut self, now_s: f64, digit: char) {
        self.used_s = now_s;
        if self.locked_s(now_s) <= 0.0 && self.digits.len() < MAX_DIGITS {
            self.digits.push(digit);
        }
    }

    /// Takes the last digit back.
    pub(crate) fn back(&mut self) {
        self.digits.pop();
    }

    /// All digits are typed; `is_pin` says whether they are the PIN.
    pub(crate) fn enter(&mut self, now_s: f64, is_pin: impl Fn(&str) -> bool) {
        self.used_s = now_s;
        if self.digits.is_empty() || self.locked_s(now_s) > 0.0 {
            return;
        }
        let digits = std::mem::take(&mut self.digits);
        if is_pin(&digits) {
            self.access = Access::Open;
            self.n_wrong = 0;
            return;
        }
        let doubled = 2_f64.powi(i32::try_from(self.n_wrong.min(20)).unwrap_or(20));
        self.n_wrong += 1;
        self.locked_until_s = now_s + (FIRST_S * doubled).min(LONGEST_S);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn try_pin(lock: &mut Lock, now_s: f64, digits: &str) -> Access {
        lock.ask(now_s);
        for digit in digits.chars() {
            lock.digit(now_s, digit);
        }
        lock.enter(now_s, |typed| typed == "271828");
        lock.access()
    }

    #[test]
    fn every_wrong_pin_doubles_the_delay_and_nothing_is_taken_meanwhile() {
        let mut lock = Lock::default();
        let mut now_s = 0.0;
        for expected_s in [1.0, 2.0, 4.0, 8.0] {
            assert_eq!(try_pin(&mut lock, now_s, "271829"), Access::Asked);
            assert!((lock.locked_s(now_s) - expected_s).abs() < 1e-9);
            assert_eq!(
                try_pin(&mut lock, now_s + 0.5 * expected_s, "271828"),
                Access::Asked
            );
            now_s += expected_s;
        }
        assert_eq!(try_pin(&mut lock, now_s, "271828"), Access::Open);
        lock.close();
        assert_eq!(try_pin(&mut lock, now_s, "1"), Access::Asked);
        assert!(lock.locked_s(now_s) <= 1.0, "the right PIN begins anew");
        for _ in 0..40 {
            now_s += 3600.0;
            try_pin(&mut lock, now_s, "1");
        }
        assert!(lock.locked_s(now_s) <= 3600.0);
    }

    #[test]
    fn a_page_that_nobody_uses_goes_by_itself() {
        let mut lock = Lock::default();
        assert_eq!(try_pin(&mut lock, 0.0, "271828"), Access::Open);
        lock.step(59.0);
        lock.is_used(59.0);
        lock.step(100.0);
        assert_eq!(lock.access(), Access::Open);
        lock.step(120.0);
        assert_eq!(lock.access(), Access::Closed);
    }
}
