//! What is said of a textile that is imported: what it is made of, whose it is, what was measured.

use std::collections::BTreeMap;

use clap::{Args, ValueEnum};

use super::CliError;
use selvedge_textile::{Construction, Description};

/// How a textile is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Made {
    Woven,
    Knitted,
    Nonwoven,
    Other,
}

impl Made {
    /// The same in a manifest.
    pub(super) fn construction(self) -> Construction {
        match self {
            Self::Woven => Construction::Woven,
            Self::Knitted => Construction::Knitted,
            Self::Nonwoven => Construction::Nonwoven,
            Self::Other => Construction::Other,
        }
    }
}

/// What people say of a textile.
#[derive(Debug, Args)]
pub(super) struct WordsArgs {
    /// What it is made of
    #[arg(long, default_value = "")]
    fibre: String,
    /// The licence of its files
    #[arg(long, default_value = "")]
    licence: String,
    /// One line of description
    #[arg(long, default_value = "")]
    notes: String,
    /// A figure that was measured, in place of what is found, such as miu=0.21
    #[arg(long, value_name = "KEY=VALUE", value_parser = figure)]
    figure: Vec<(String, f64)>,
}

fn figure(text: &str) -> Result<(String, f64), String> {
    let wrong = || "say KEY=VALUE, such as miu=0.21".to_owned();
    let (key, value) = text.split_once('=').ok_or_else(wrong)?;
    let value: f64 = value.trim().parse().ok().ok_or_else(wrong)?;
    Ok((key.trim().to_owned(), value))
}

impl WordsArgs {
    /// The words with a name and how it is made.
    pub(super) fn words(&self, name: &str, made: Made) -> Result<Description, CliError> {
        let mut figures = BTreeMap::new();
        for (key, value) in &self.figure {
            if figures.insert(key.clone(), *value).is_some() {
                let what = format!("--figure {key} is said twice");
                return Err(CliError::Input(format!("{what}; say it once")));
            }
        }
        Ok(Description {
            name: name.to_owned(),
            construction: made.construction(),
            fibre: self.fibre.clone(),
            licence: self.licence.clone(),
            notes: self.notes.clone(),
            figures,
        })
    }
}
