//! The stage brought to a state of its own accord, for pictures without a display.

use crate::bench::stage::StagePicture;
use crate::tools::stage::Stage;
use crate::tools::stage::act::{Act, Hand};
use crate::tools::stage::game::Game;
use crate::tools::stage::voltage::{DeviceState, HOLD_S};

/// How long the stage was visited before it is pictured, s.
const VISITED_S: f64 = 21.0;

impl Stage {
    /// Does what a visitor or the operator would have done.
    pub(super) fn act_out(&mut self, picture: StagePicture) {
        match picture {
            StagePicture::Watching => {}
            StagePicture::Pin => self.lock.ask(self.machine.now_s()),
            StagePicture::Operator => {
                let now_s = self.machine.now_s();
                self.lock.ask(now_s);
                self.lock.digit(now_s, '0');
                self.lock.enter(now_s, |_| true);
            }
            _ => self.visit(picture),
        }
    }

    fn visit(&mut self, picture: StagePicture) {
        self.machine.act(Act::Tour(0), "keys");
        if picture == StagePicture::Touching {
            return self.machine.act(Act::Tour(2), "keys");
        }
        self.machine.voltage.permit(true);
        for cloth in [0, 1, 2] {
            self.machine.act(Act::Tour(cloth), "keys");
            let now_s = self.machine.now_s() + VISITED_S / 3.0 - 1.5;
            for now_s in [now_s, now_s + 1.5] {
                self.machine
                    .step(now_s, Hand::default(), DeviceState::Ready);
            }
        }
        match picture {
            StagePicture::Offered => self.machine.act(Act::Tour(2), "keys"),
            StagePicture::Armed => {
                self.machine.act(Act::Tour(2), "keys");
                self.machine.act(Act::HoldFeel(true), "keys");
                self.ahead_s += HOLD_S;
            }
            _ => self.guess(picture),
        }
    }

    fn guess(&mut self, picture: StagePicture) {
        self.machine.act(Act::Guess, "keys");
        let wait = |stage: &mut Self, seconds: f64| {
            let now_s = stage.machine.now_s() + seconds;
            stage
                .machine
                .step(now_s, Hand::default(), DeviceState::Ready);
        };
        match picture {
            StagePicture::Told => {
                self.machine.act(Act::Choose(1), "keys");
                wait(self, 1.0);
            }
            StagePicture::StillHere => wait(self, 38.0),
            StagePicture::Ended => {
                for _ in 0..3 {
                    self.machine.act(Act::Choose(2), "keys");
                    wait(self, 3.0);
                }
                self.machine.act(Act::Face(2), "keys");
                self.machine.act(Act::Word(1), "keys");
            }
            _ => {
                if let Some(truth) = self.machine.game().and_then(Game::truth) {
                    self.machine.act(Act::Tour(truth), "keys");
                }
            }
        }
    }
}
