//! What is learnt how.

use selvedge_foundation::named;

use super::critic::AdversarialLoss;
use super::registered::Size;

named! {
    /// Which network learns.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Method {
        /// Registered strips, level, trend and spectra apart.
        Ours = "ours",
        /// The same with a critic.
        OursAdversarial = "ours-adversarial",
        /// `FrictGAN` (Cai et al. 2021) built anew, at reduced size.
        FrictGan = "frictgan",
    }
    /// Its name on the command line and in tables.
    pub fn word;
}

/// What is learnt how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lesson {
    /// Which network.
    pub method: Method,
    /// What generator and critic are told by each other, where there are both.
    pub loss: AdversarialLoss,
    /// How large ours is.
    pub(crate) size: Size,
    /// Times that every example is seen.
    pub n_rounds: usize,
    /// What everything that is drawn hangs on.
    pub seed: u64,
}

impl Lesson {
    /// As shipped and compared.
    pub fn usual(method: Method, seed: u64) -> Self {
        Self {
            method,
            loss: AdversarialLoss::Entropy,
            size: Size::default(),
            n_rounds: match method {
                Method::Ours => 8,
                Method::OursAdversarial => 6,
                Method::FrictGan => 4,
            },
            seed,
        }
    }

    /// Ours with so many channels.
    #[must_use]
    pub fn with_width(mut self, width: usize) -> Self {
        self.size.width = width;
        self
    }
}
