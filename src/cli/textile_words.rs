//! What is said of a textile that is imported: what it is made of, whose it is, what was measured.

use std::collections::BTreeMap;

use clap::Args;
use clap::builder::TypedValueParser;

use super::CliError;
use super::usage::one_of;
use selvedge_textile::{Construction, Description};

/// Reads how a textile is made.
pub(super) fn construction() -> impl TypedValueParser<Value = Construction> {
    let all = [
        Construction::Woven,
        Construction::Knitted,
        Construction::Nonwoven,
        Construction::Other,
    ];
    one_of(all.map(|one| (one.word(), one)))
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
    pub(super) fn words(
        &self,
        name: &str,
        construction: Construction,
    ) -> Result<Description, CliError> {
        let mut figures = BTreeMap::new();
        for (key, value) in &self.figure {
            if figures.insert(key.clone(), *value).is_some() {
                let what = format!("--figure {key} is said twice");
                return Err(CliError::Input(format!("{what}; say it once")));
            }
        }
        Ok(Description {
            name: name.to_owned(),
            construction,
            fibre: self.fibre.clone(),
            licence: self.licence.clone(),
            notes: self.notes.clone(),
            figures,
        })
    }
}
