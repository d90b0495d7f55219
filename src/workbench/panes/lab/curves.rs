//! Amplitudes over speed along one stroke: amber at 40 Hz, cyan at 320 Hz; what is compared is
//! thin and grey, a family is drawn from faint (its first) to full (its last).

use eframe::egui::{
    self, Align2, Color32, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, WidgetInfo,
    pos2, vec2,
};

use super::{LabView, title};
use crate::lab::{Felt, Page, Preview, SPEEDS_MM_PER_S, speeds_mm_per_s};
use crate::panes::response_ends_db;
use crate::theme::{self, Palette};
use crate::widgets::{Axis, Side, Tick, paint_ticks, paint_unit};
use selvedge_foundation::quantity;
use selvedge_render::array::PointSpread;
use selvedge_textile::surface::Direction;
use selvedge_textile::tactile::Band;

/// Speeds that are named, mm/s.
const NAMED_MM_PER_S: [f64; 4] = [1.0, 10.0, 100.0, 1000.0];
/// How opaque the range over all points is drawn.
const RANGE: f32 = 0.14;
/// How opaque the first of a family is drawn.
const FAINTEST: f32 = 0.3;

/// Shows the plot.
pub(super) fn show(ui: &Ui, rect: Rect, view: &LabView<'_>, preview: &Preview) {
    let direction = view.lab.look.direction;
    let family = view.lab.family.as_ref();
    let family = family.filter(|_| view.lab.page == Page::Family);
    let words = match family {
        Some(family) => format!(
            "amplitudes, {}: {} from {} (faint) to {}",
            direction.label(),
            family.parameter[0],
            ends_of(family)[0],
            ends_of(family)[1]
        ),
        None => format!("amplitudes over speed, {}", direction.label()),
    };
    let below = title(ui, rect, &words);
    let id = ui.scope_id().with("lab curves");
    let response = ui.interact(below, id, Sense::hover());
    let name = format!("Amplitudes over speed, {}", direction.label());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Canvas, true, &name));
    let plot = Plot::new(below, response_ends_db(view.scale));
    if plot.area.width() < 40.0 || plot.area.height() < 24.0 {
        return;
    }
    let painter = ui.painter();
    let palette = Palette::in_ui(ui);
    plot.paint_axes(painter);
    if let Some(compared) = &view.lab.compared {
        for band in Band::ALL {
            let grey = Stroke::new(1.0, palette.line);
            plot.paint_line(painter, &compared.felt, (direction, band), grey);
        }
    }
    if let Some(family) = family {
        let last = family.members.len().saturating_sub(1).max(1) as f32;
        for (nth, member) in family.members.iter().enumerate() {
            let strength = FAINTEST + (1.0 - FAINTEST) * nth as f32 / last;
            for band in Band::ALL {
                let ink = palette.band(band).gamma_multiply(strength);
                let line = Stroke::new(1.5, ink);
                plot.paint_line(painter, &member.felt, (direction, band), line);
            }
        }
    } else {
        for band in Band::ALL {
            let ink = palette.band(band);
            plot.paint_range(painter, &preview.felt, (direction, band), ink);
            let line = Stroke::new(1.75, ink);
            plot.paint_line(painter, &preview.felt, (direction, band), line);
        }
    }
    plot.paint_legend(painter);
    tell(response, &plot, view, preview);
}

fn ends_of(family: &crate::lab::Family) -> [String; 2] {
    let ends = [family.members.first(), family.members.last()];
    let unit = family.parameter[1];
    ends.map(|end| {
        end.map_or_else(String::new, |member| {
            let tick = Tick::number(member.value);
            format!("{} {unit}", tick.label).trim_end().to_owned()
        })
    })
}

fn tell(response: Response, plot: &Plot, view: &LabView<'_>, preview: &Preview) {
    let Some(at) = response.hover_pos().filter(|at| plot.area.contains(*at)) else {
        return;
    };
    let direction = view.lab.look.direction;
    let distance = |speed: f64| (plot.speeds.x(plot.area.x_range(), speed) - at.x).abs();
    let all = speeds_mm_per_s().enumerate();
    let nearest = all.min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
    let Some((nth, speed_mm_per_s)) = nearest else {
        return;
    };
    let words_of = |felt: &Felt| {
        let spread = felt.over_speed[direction.index()].get(nth).copied();
        let spread = spread.unwrap_or_default();
        let band_words = Band::ALL.map(|band| {
            let um = spread.rms_um[band.index()];
            let db = quantity::fixed(quantity::level_db(um), 1);
            format!("A{} {db} dB", quantity::fixed(band.carrier_hz(), 0))
        });
        band_words.join("   ")
    };
    let compared = view
        .lab
        .compared
        .as_ref()
        .map_or_else(String::new, |compared| {
            format!("\n{}: {}", compared.name, words_of(&compared.felt))
        });
    let decimals = usize::from(speed_mm_per_s < 9.95);
    response.on_hover_text_at_pointer(format!(
        "{}\n{}{compared}\nRoot mean square over all points, re 1 µm peak, before gains; the \
         shade is from the least to the largest",
        quantity::with_unit(speed_mm_per_s, decimals, "mm/s"),
        words_of(&preview.felt)
    ));
}

struct Plot {
    area: Rect,
    speeds: Axis,
    levels_db: Axis,
}

impl Plot {
    fn new(rect: Rect, [least_db, most_db]: [f64; 2]) -> Self {
        Self {
            area: Rect::from_min_max(
                pos2(rect.left() + 34.0, rect.top() + 6.0),
                pos2(rect.right() - 8.0, rect.bottom() - 16.0),
            ),
            speeds: Axis::log(SPEEDS_MM_PER_S[0], SPEEDS_MM_PER_S[1]),
            levels_db: Axis::linear(least_db, most_db),
        }
    }

    fn paint_axes(&self, painter: &Painter) {
        let levels = self.levels_db.ticks(self.area.height(), 22.0);
        paint_ticks(painter, self.area, (&self.levels_db, Side::Left), &levels);
        let speeds = NAMED_MM_PER_S.map(Tick::number);
        paint_ticks(painter, self.area, (&self.speeds, Side::Bottom), &speeds);
        let corner = self.area.right_bottom() + vec2(-4.0, -1.0);
        paint_unit(painter, corner, Align2::RIGHT_BOTTOM, "mm/s");
        let corner = self.area.left_top() + vec2(4.0, 1.0);
        paint_unit(painter, corner, Align2::LEFT_TOP, "dB re 1 µm");
    }

    fn paint_legend(&self, painter: &Painter) {
        let palette = Palette::of(painter.ctx().theme());
        let mut right = self.area.right() - 4.0;
        for band in [Band::High, Band::Low] {
            let words = format!("{} Hz", quantity::fixed(band.carrier_hz(), 0));
            let at = pos2(right, self.area.top() + 1.0);
            let ink = palette.band(band);
            let text = painter.text(at, Align2::RIGHT_TOP, words, theme::small(), ink);
            right = text.left() - 8.0;
        }
    }

    fn at(&self, speed_mm_per_s: f64, um: f64) -> Pos2 {
        let y = self
            .levels_db
            .y(self.area.y_range(), quantity::level_db(um));
        let y = y.clamp(self.area.top() - 2.0, self.area.bottom() + 2.0);
        pos2(self.speeds.x(self.area.x_range(), speed_mm_per_s), y)
    }

    fn points(
        &self,
        felt: &Felt,
        direction: Direction,
        um: impl Fn(&PointSpread) -> f64,
    ) -> Vec<Pos2> {
        let curve = speeds_mm_per_s().zip(&felt.over_speed[direction.index()]);
        curve
            .map(|(speed, spread)| self.at(speed, um(spread)))
            .collect()
    }

    fn paint_line(
        &self,
        painter: &Painter,
        felt: &Felt,
        (direction, band): (Direction, Band),
        stroke: Stroke,
    ) {
        let b = band.index();
        let points = self.points(felt, direction, |spread| spread.rms_um[b]);
        painter
            .with_clip_rect(self.area)
            .add(Shape::line(points, stroke));
    }

    fn paint_range(
        &self,
        painter: &Painter,
        felt: &Felt,
        (direction, band): (Direction, Band),
        ink: Color32,
    ) {
        let b = band.index();
        let lower = self.points(felt, direction, |spread| spread.min_um[b]);
        let upper = self.points(felt, direction, |spread| spread.max_um[b]);
        crate::panes::response_range(
            &painter.with_clip_rect(self.area),
            (&lower, &upper),
            ink.gamma_multiply(RANGE),
        );
    }
}
