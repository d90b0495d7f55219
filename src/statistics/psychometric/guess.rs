//! How the lower end of a psychometric function is known.

/// How the lower end of the function is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Guess {
    /// This share: 1/m of m alternatives, 0 of a yes that is never guessed.
    Share(f64),
    /// As large as the lapse rate: two-sided answers, wrong as often at either end.
    EqualToLapse,
}

impl Guess {
    /// The rate beside a lapse rate.
    pub fn rate(self, lapse: f64) -> f64 {
        match self {
            Self::Share(share) => share,
            Self::EqualToLapse => lapse,
        }
    }
}
