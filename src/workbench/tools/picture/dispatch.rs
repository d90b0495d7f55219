//! A picture that becomes a textile. Neither saved nor undone.

use std::sync::Arc;

use crate::bench::Bench;
use crate::bench::command::ShowCommand;
use crate::bench::keep::Keep;
use crate::bench::pane::Pane;
use crate::tools::picture::{PictureCommand, Picturing};

impl Bench {
    pub(crate) fn dispatch_picture(&mut self, command: PictureCommand) {
        let picturing = &mut self.transient.picturing;
        match command {
            PictureCommand::Open(path) => {
                picturing.open(path);
                if !self.shows(Pane::Picture) {
                    self.commands.push(ShowCommand::Pane(Pane::Picture).into());
                }
            }
            PictureCommand::Draft(draft) => picturing.take_draft(*draft),
            PictureCommand::Cancel => picturing.cancel(),
            PictureCommand::Clear => {
                picturing.cancel();
                *picturing = Picturing::default();
            }
            PictureCommand::Keep { is_felt } => {
                let Some(made) = picturing.take_textile() else {
                    return;
                };
                let textile = Arc::clone(&made.textile);
                let keep = if is_felt {
                    Keep::Feel(textile)
                } else {
                    Keep::Save(textile)
                };
                self.commands.push(keep.into());
            }
        }
    }
}
