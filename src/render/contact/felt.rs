//! What a textile is to a tip: its relief, its friction, and how soft it is.

use super::friction::Friction;
use super::law::{Compression, ContactLaw};
use super::patch::Contact;
use super::relief::Relief;
use super::tip::Tip;
use crate::RenderError;
use selvedge_textile::{Textile, TextileError};

/// A surface, and what is known of how it rubs and yields.
#[derive(Debug, Clone)]
pub struct FeltSurface {
    /// Its heights: those over an area where the textile has them, else its profiles'.
    pub relief: Relief,
    /// How it rubs; not at all where no friction was measured.
    pub friction: Friction,
    /// How it yields, where its compression was measured.
    pub cloth: Option<Compression>,
}

impl FeltSurface {
    /// A surface that neither rubs nor yields.
    pub fn rigid(relief: Relief) -> Self {
        Self {
            relief,
            friction: Friction::none(),
            cloth: None,
        }
    }

    /// A textile as a tip presses it. Heights over an area may take a second.
    ///
    /// # Errors
    /// Those of the textile's files.
    pub fn of_textile(textile: &Textile, tip: &Tip) -> Result<Self, TextileError> {
        let relief = match textile.height_map()? {
            Some(map) => Relief::of_map(&map),
            None => Relief::of_surface(textile.surface()),
        };
        Self::on_relief(textile, tip, relief)
    }

    /// The same on its relief as it is known already.
    ///
    /// # Errors
    /// Those of the textile's files.
    pub fn on_relief(textile: &Textile, tip: &Tip, relief: Relief) -> Result<Self, TextileError> {
        let measured = &textile.manifest().measured;
        let figure = |key: &str| measured.get(key).copied();
        let area_mm2 = std::f64::consts::PI * tip.radius_mm * tip.radius_mm;
        let n_contacts = tip.contacts_mm.len() as f64;
        let friction = textile.friction()?;
        Ok(Self {
            relief,
            friction: friction.map_or_else(Friction::none, |trace| Friction {
                trace: Some(trace),
                ..Friction::coulomb(1.0)
            }),
            cloth: Compression::of_figures(figure, n_contacts * area_mm2),
        })
    }

    /// A tip on it, by the usual law.
    ///
    /// # Errors
    /// What [`Contact::new`] refuses.
    pub fn contact(&self, tip: Tip) -> Result<Contact, RenderError> {
        let law = ContactLaw {
            cloth: self.cloth,
            ..ContactLaw::default()
        };
        Contact::new(&self.relief, tip, law, self.friction.clone())
    }
}
