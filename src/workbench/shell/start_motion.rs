//! Motion at the start: the display moves over the scene by itself until the pointer comes to feel,
//! or the user wants something else of it.

use eframe::egui::Context;

use crate::bench::command::{Command, PlayCommand, PlaySource};
use crate::kit::view_transform::{Pointed, PointerGround};
use crate::shell::state::StartMotion;
use crate::shell::window::Workbench;

/// A pointer that moved less than this lay there when the window came up, points.
const AT_REST: f32 = 4.0;

impl Workbench {
    /// Lets the display move until the pointer feels.
    pub(crate) fn begin_motion(&mut self) {
        self.dispatch(PlayCommand::Source(PlaySource::Stroke).into());
        self.shell.start_motion = Some(StartMotion::default());
    }

    /// Gives way to a pointer that moves over the workspace.
    pub(crate) fn follow_start_motion(&mut self, ctx: &Context, ground: Option<PointerGround>) {
        let Some(motion) = &mut self.shell.start_motion else {
            return;
        };
        let Some(at) = ctx.input(|input| input.pointer.hover_pos()) else {
            return;
        };
        let has_moved = motion.seen.get_or_insert(at).distance(at) > AT_REST;
        let feels_at = |ground: PointerGround| {
            ground.feels && ground.window == Pointed::Workbench && ground.rect.contains(at)
        };
        if has_moved && ground.is_some_and(feels_at) && !self.shell.is_covered() {
            self.shell.start_motion = None;
            let feel = PlayCommand::Source(PlaySource::Pointer);
            self.bench.commands.push(feel.into());
        }
    }

    /// Motion is the user's own from now on, if a command says what moves the display.
    pub(crate) fn leave_start_motion(&mut self, command: &Command) {
        if matches!(command, Command::Play(_)) || self.bench.has_session() {
            self.shell.start_motion = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Event, Pos2, pos2, vec2};

    use super::*;
    use crate::bench::view::Source;
    use crate::shell::headless::Headless;

    fn point(window: &mut Headless, at: Pos2) {
        window.events.push(Event::PointerMoved(at));
        window.pass(2);
    }

    fn source(window: &Headless) -> Source {
        window.workbench.bench.live.play.source
    }

    #[test]
    fn the_display_moves_at_the_start_until_the_pointer_moves_over_the_workspace() {
        let mut window = Headless::shipped();
        window.workbench.begin_motion();
        window.pass_ticks(20);
        assert_eq!(source(&window), Source::Stroke);
        assert!(window.workbench.bench.live.play.is_playing);
        let ground = window.workbench.bench.pointer.ground.unwrap();
        point(&mut window, ground.center());
        assert_eq!(source(&window), Source::Stroke, "it lay there already");
        point(&mut window, pos2(20.0, 20.0));
        assert_eq!(source(&window), Source::Stroke, "not over the workspace");
        point(&mut window, ground.center() + vec2(9.0, 0.0));
        assert_eq!(source(&window), Source::Pointer, "the pointer feels");
        window.dispatch(PlayCommand::Toggle);
        window.pass(2);
        point(&mut window, ground.center());
        assert_eq!(
            source(&window),
            Source::Stroke,
            "motion that was asked for stays"
        );
    }
}
