//! The stage brought to a state of its own accord, for pictures without a display.

use crate::bench::Bench;
use crate::bench::stage::StagePicture;
use crate::bench::view::{BridgePhase, BridgeView};
use crate::tools::stage::Stage;
use crate::tools::stage::act::{Act, Hand};
use crate::tools::stage::game::Game;
use crate::tools::stage::voltage::DeviceState;

/// How long the stage was visited before it is pictured, s.
const VISITED_S: f64 = 21.0;

impl Stage {
    /// Does what a visitor or the operator would have done.
    pub(super) fn act_out(&mut self, picture: StagePicture, bench: &mut Bench) {
        match picture {
            StagePicture::Watching => {}
            StagePicture::Pin => self.lock.ask(self.machine.now_s()),
            StagePicture::Operator => {
                let now_s = self.machine.now_s();
                self.lock.ask(now_s);
                self.lock.digit(now_s, '0');
                self.lock.enter(now_s, |_| true);
            }
            _ => self.visit(picture, bench),
        }
    }

    fn visit(&mut self, picture: StagePicture, bench: &mut Bench) {
        let phase = match picture {
            StagePicture::Armed => BridgePhase::Armed,
            _ => BridgePhase::Ready,
        };
        bench.device.pictured = Some(BridgeView {
            phase,
            ..BridgeView::default()
        });
        self.machine.act(Act::Tour(0), "keys");
        if picture == StagePicture::Touching {
            return self.machine.act(Act::Tour(2), "keys");
        }
        self.machine.voltage.permit(true);
        if picture == StagePicture::Armed {
            // As if the second of holding were over: a picture has no device to arm.
            self.machine.act(Act::HoldFeel(true), "keys");
            let now_s = self.machine.now_s() + 1.0;
            self.machine
                .step(now_s, Hand::default(), DeviceState::Ready);
        }
        for cloth in [0, 1, 2] {
            self.machine.act(Act::Tour(cloth), "keys");
            let now_s = self.machine.now_s() + VISITED_S / 3.0 - 1.5;
            self.machine.step(now_s, Hand::default(), state_of(picture));
            self.machine
                .step(now_s + 1.5, Hand::default(), state_of(picture));
        }
        match picture {
            StagePicture::Offered | StagePicture::Armed => self.machine.act(Act::Tour(2), "keys"),
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

fn state_of(picture: StagePicture) -> DeviceState {
    match picture {
        StagePicture::Armed => DeviceState::Armed,
        _ => DeviceState::Ready,
    }
}
