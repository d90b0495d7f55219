//! Words, buttons and bars of a stage, to be read and hit from a metre away. What was drawn where
//! is written down, so that tests can count words and measure targets.

use eframe::egui::{
    Align2, Color32, FontId, Painter, Pos2, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui,
    WidgetInfo, vec2,
};

use crate::kit::theme::Palette;
use crate::tools::stage::layout::Layout;

/// What was drawn in a frame, points.
#[derive(Debug, Default)]
pub(crate) struct Drawn {
    /// Lines of words.
    pub(crate) lines: Vec<(String, Rect)>,
    /// What can be pressed.
    pub(crate) targets: Vec<Rect>,
    /// Where a press switches everything off.
    pub(crate) stop: Option<Rect>,
}

impl Drawn {
    /// Lets screen readers read the words that stand by themselves.
    pub(crate) fn read_out(&self, ui: &Ui) {
        let is_alone = |place: &Rect| !self.targets.iter().any(|target| target.intersects(*place));
        let alone = self.lines.iter().filter(|(_, place)| is_alone(place));
        for (nth, (words, place)) in alone.enumerate() {
            let id = ui.scope_id().with(("words", nth));
            let response = ui.interact(*place, id, Sense::hover());
            response.widget_info(|| WidgetInfo::labeled(Role::Label, true, words));
        }
    }
}

/// How a button looks.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Look {
    /// Whether it is chosen.
    pub(crate) is_on: bool,
    /// How much of it is filled while it is held, 0…1.
    pub(crate) held: f32,
    /// Whether it switches off.
    pub(crate) is_danger: bool,
    /// Whether it can do nothing here.
    pub(crate) is_faint: bool,
}

/// What is drawn where letters have no sign for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sign {
    Tick,
    Cross,
    /// An arrow that goes round.
    Anew,
    /// A loudspeaker with so many waves, crossed out with none.
    Sound(u8),
}

impl Sign {
    fn of(words: &str) -> Option<Self> {
        Some(match words {
            "✔" => Self::Tick,
            "✖" => Self::Cross,
            "⟲" => Self::Anew,
            "🔇" => Self::Sound(0),
            "🔈" => Self::Sound(1),
            "🔉" => Self::Sound(2),
            "🔊" => Self::Sound(3),
            _ => return None,
        })
    }
}

/// What a stage is drawn with.
pub(crate) struct Brush<'a> {
    pub(crate) painter: Painter,
    pub(crate) palette: &'static Palette,
    pub(crate) layout: Layout,
    pub(crate) drawn: &'a mut Drawn,
}

impl Brush<'_> {
    /// One line within a place, smaller if it would not fit.
    pub(crate) fn line(
        &mut self,
        within: Rect,
        align: Align2,
        (points, ink): (f32, Color32),
        words: &str,
    ) {
        if let Some(sign) = Sign::of(words) {
            return self.sign(within, sign, Stroke::new(0.09 * points, ink));
        }
        let lay = |points: f32| {
            let font = FontId::proportional(points);
            self.painter.layout_no_wrap(words.to_owned(), font, ink)
        };
        let mut galley = lay(points);
        let fits = (within.width() / galley.size().x).min(within.height() / galley.size().y);
        if fits < 1.0 {
            galley = lay((0.98 * fits * points).floor().max(6.0));
        }
        let place = align.align_size_within_rect(galley.size(), within);
        self.drawn.lines.push((words.to_owned(), place));
        self.painter.galley(place.min, galley, ink);
    }

    /// A button with a word or a sign; read out as `label`.
    pub(crate) fn button(
        &mut self,
        ui: &Ui,
        rect: Rect,
        (words, label): (&str, &str),
        look: Look,
    ) -> Response {
        let response = self.target(ui, rect, label, look.is_on);
        let palette = self.palette;
        let round = 0.12 * rect.height().min(rect.width());
        let (fill, ink) = if look.is_on {
            (palette.selection, palette.floor)
        } else if look.is_faint {
            (palette.raised, palette.line)
        } else {
            (palette.raised, palette.text)
        };
        let edge = if look.is_danger {
            Stroke::new(6.0 * self.layout.unit, palette.danger)
        } else {
            Stroke::new(2.0 * self.layout.unit, palette.line)
        };
        self.painter
            .rect(rect, round, fill, edge, StrokeKind::Inside);
        if look.held > 0.0 {
            let filled = rect.with_max_x(rect.left() + look.held * rect.width());
            self.painter.rect_filled(filled, round, palette.hovered);
        }
        let within = rect.shrink(0.1 * rect.height());
        let points = self.layout.words.min(0.6 * rect.height());
        self.line(within, Align2::CENTER_CENTER, (points, ink), words);
        self.ring(rect, &response);
        response
    }

    /// Something that can be pressed, without a look of its own.
    pub(crate) fn target(&mut self, ui: &Ui, rect: Rect, label: &str, is_on: bool) -> Response {
        self.drawn.targets.push(rect);
        let response = ui.interact(rect, ui.scope_id().with(label), Sense::click());
        let is_enabled = ui.is_enabled();
        response.widget_info(|| WidgetInfo::selected(Role::Button, is_enabled, is_on, label));
        response
    }

    /// A ring around what the keys go to.
    pub(crate) fn ring(&self, rect: Rect, response: &Response) {
        if response.has_focus() {
            let stroke = Stroke::new(4.0 * self.layout.unit, self.palette.selection);
            let around = rect.expand(4.0 * self.layout.unit);
            self.painter
                .rect_stroke(around, 0, stroke, StrokeKind::Middle);
        }
    }

    /// A sign, where the letters of the window have none.
    fn sign(&self, within: Rect, sign: Sign, stroke: Stroke) {
        let centre = within.center();
        let size = 0.5 * within.width().min(within.height());
        let at = |[x, y]: [f32; 2]| centre + size * vec2(x, y);
        let line = |points: &[[f32; 2]]| {
            let points = points.iter().copied().map(at).collect();
            self.painter.line(points, stroke);
        };
        match sign {
            Sign::Tick => line(&[[-0.6, 0.0], [-0.15, 0.5], [0.65, -0.5]]),
            Sign::Cross => {
                line(&[[-0.5, -0.5], [0.5, 0.5]]);
                line(&[[-0.5, 0.5], [0.5, -0.5]]);
            }
            Sign::Anew => {
                self.arc(centre, 0.6 * size, -0.8, stroke);
                line(&[[-0.3, -0.85], [0.0, -0.6], [-0.3, -0.3]]);
            }
            Sign::Sound(n_waves) => {
                let horn = [
                    [-0.8, -0.2],
                    [-0.5, -0.2],
                    [-0.15, -0.55],
                    [-0.15, 0.55],
                    [-0.5, 0.2],
                    [-0.8, 0.2],
                    [-0.8, -0.2],
                ];
                line(&horn);
                for wave in 0..n_waves {
                    let reach = 0.25 + 0.22 * f32::from(wave);
                    line(&[
                        [reach - 0.1, -reach],
                        [reach + 0.1, 0.0],
                        [reach - 0.1, reach],
                    ]);
                }
                if n_waves == 0 {
                    line(&[[0.2, -0.3], [0.75, 0.3]]);
                    line(&[[0.2, 0.3], [0.75, -0.3]]);
                }
            }
        }
    }

    /// A share of a circle, from the top on.
    pub(crate) fn arc(&self, centre: Pos2, radius: f32, share: f32, stroke: Stroke) {
        let n = 48_u8;
        let points = (0..=n).map(|step| {
            let angle = share * f32::from(step) / f32::from(n) * std::f32::consts::TAU;
            centre + radius * vec2(angle.sin(), -angle.cos())
        });
        self.painter.line(points.collect(), stroke);
    }

    /// A bar of one band with its words above it.
    pub(crate) fn bar(&mut self, place: Rect, words: &str, ink: Color32, share: f32) {
        let name = place.with_max_y(place.center().y);
        let label = (self.layout.label, self.palette.text);
        self.line(name, Align2::LEFT_BOTTOM, label, words);
        let rail = place.with_min_y(place.center().y + 4.0 * self.layout.unit);
        self.painter.rect_filled(rail, 4, self.palette.raised);
        let filled = rail.with_max_x(rail.left() + share.clamp(0.0, 1.0) * rail.width());
        self.painter.rect_filled(filled, 4, ink);
    }

    /// A face that is sad (−1), so-so or glad (1).
    pub(crate) fn face(&self, rect: Rect, mood: f32, is_on: bool) {
        let (fill, ink) = if is_on {
            (self.palette.selection, self.palette.floor)
        } else {
            (self.palette.raised, self.palette.text)
        };
        let (centre, radius) = (rect.center(), 0.42 * rect.height().min(rect.width()));
        let stroke = Stroke::new(0.08 * radius, ink);
        self.painter.circle(centre, radius, fill, stroke);
        for side in [-1.0, 1.0] {
            let eye = centre + radius * vec2(0.35 * side, -0.25);
            self.painter.circle_filled(eye, 0.09 * radius, ink);
        }
        let mouth = (-4..=4_i8).map(|step| {
            let x = f32::from(step) / 4.0;
            centre + radius * vec2(0.5 * x, 0.4 - 0.22 * mood * x * x)
        });
        self.painter.line(mouth.collect(), stroke);
    }
}
