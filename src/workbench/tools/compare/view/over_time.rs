//! When A and B differ: the difference of the mean levels along the path.

use eframe::egui::{
    self, Align2, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2,
};

use crate::bench::command::{Commands, PlayCommand};
use crate::bench::tool::PaneContext;
use crate::bench::view::Source;
use crate::kit::theme;
use crate::kit::theme::Palette;
use crate::kit::widgets::axis::{Axis, Side, Tick, paint_ticks, paint_unit};
use crate::tools::compare::choice::Route;
use crate::tools::compare::comparison::Compare;
use crate::tools::compare::words::{band_name, decimals_of, scale_db, signed_db, unit_of};
use selvedge_foundation::quantity::{clock, fixed};
use selvedge_render::scene::TICKS_PER_S;
use selvedge_render::{LevelDifference, Spread};
use selvedge_textile::tactile::{Band, just_noticeable_db};

/// Space for numbers and titles around the plot, points.
const LEFT: f32 = 34.0;
const TOP: f32 = 20.0;
const BOTTOM: f32 = 16.0;
/// A tick of the path, ms.
const TICK_MS: u64 = 25;

/// Shows the curve in `rect`.
pub(crate) fn show(
    ui: &Ui,
    rect: Rect,
    compare: &mut Compare,
    route: &Route,
    context: &mut PaneContext<'_>,
) {
    let area = Rect::from_min_max(rect.min + vec2(LEFT, TOP), rect.max - vec2(6.0, BOTTOM));
    if area.width() < 40.0 || area.height() < 24.0 {
        return;
    }
    let is_at_hand = compare.route() == Some(route);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "points of a screen"
    )]
    let n_columns = area.width() as usize;
    let columns = compare.columns(n_columns).to_vec();
    let Some(found) = compare.found() else {
        return;
    };
    let plot = Plot::new(area, found, &columns);
    let id = ui.scope_id().with("difference over time");
    let response = ui.interact(area, id, Sense::click());
    response.widget_info(|| {
        let words = format!(
            "Level difference over time, B less A, {} ticks",
            found.n_ticks
        );
        WidgetInfo::labeled(egui::Role::Canvas, true, words)
    });
    plot.paint(&ui.painter_at(rect), &columns);
    let is_recorded = is_at_hand && matches!(route, Route::Take(_));
    let play = context.bench.live.play;
    if is_recorded && play.source == Source::Recording {
        let x = ui.painter().round_to_pixel_center(plot.x_of(play.tick));
        let stroke = Stroke::new(1.0, Palette::in_ui(ui).selection);
        ui.painter().vline(x, area.y_range(), stroke);
    }
    answer(&response, &plot, &columns, is_recorded, context.commands);
}

struct Plot {
    area: Rect,
    time_s: Axis,
    height_db: Axis,
    n_ticks: u64,
    /// Just noticeable differences of both bands, dB.
    noticed_db: [Option<f64>; 2],
}

impl Plot {
    fn new(area: Rect, found: &LevelDifference, columns: &[[Spread; 2]]) -> Self {
        let ends = columns
            .iter()
            .flatten()
            .filter_map(|spread| spread.range_db);
        let most_db = scale_db(ends.flatten());
        let last = found.n_ticks.saturating_sub(1).max(1);
        Self {
            area,
            time_s: Axis::linear(0.0, last as f64 / TICKS_PER_S),
            height_db: Axis::linear(-most_db, most_db),
            n_ticks: found.n_ticks,
            noticed_db: found
                .sensation_db
                .map(|above_db| above_db.map(just_noticeable_db)),
        }
    }

    fn x_of(&self, tick: u64) -> f32 {
        self.time_s
            .x(self.area.x_range(), tick as f64 / TICKS_PER_S)
    }

    fn tick_at(&self, x: f32) -> u64 {
        let time_s = self.time_s.value_at_x(self.area.x_range(), x);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "not below 0, and bounded next"
        )]
        let tick = (time_s * TICKS_PER_S).round().max(0.0) as u64;
        tick.min(self.n_ticks.saturating_sub(1))
    }

    fn y_of(&self, difference_db: f64) -> f32 {
        self.height_db.y(self.area.y_range(), difference_db)
    }

    fn paint(&self, painter: &Painter, columns: &[[Spread; 2]]) {
        self.paint_noticed(painter);
        self.paint_axes(painter);
        let within = painter.with_clip_rect(self.area.expand(1.0));
        for band in Band::ALL {
            self.paint_line(&within, band, columns);
        }
        self.paint_title(painter);
    }

    /// Within the shaded bands no difference is noticed, by the model.
    fn paint_noticed(&self, painter: &Painter) {
        let palette = Palette::of(painter.ctx().theme());
        for band in Band::ALL {
            let Some(noticed_db) = self.noticed_db[band.index()] else {
                continue;
            };
            let ys = [noticed_db, -noticed_db].map(|db| self.y_of(db));
            let shaded = Rect::from_x_y_ranges(self.area.x_range(), ys[0]..=ys[1]);
            let shaded = shaded.intersect(self.area);
            let ink = palette.band(band);
            painter.rect_filled(shaded, 0, ink.gamma_multiply(0.09));
            for y in ys.into_iter().filter(|y| self.area.y_range().contains(*y)) {
                let stroke = Stroke::new(1.0, ink.gamma_multiply(0.35));
                painter.hline(
                    self.area.x_range(),
                    painter.round_to_pixel_center(y),
                    stroke,
                );
            }
        }
    }

    fn paint_axes(&self, painter: &Painter) {
        let most_db = self.height_db.most();
        let (unit, factor) = unit_of(most_db);
        let heights = [-most_db, 0.0, most_db].map(|db| Tick {
            value: db,
            ..Tick::number(db * factor)
        });
        paint_ticks(painter, self.area, (&self.height_db, Side::Left), &heights);
        let mut times = self.time_s.ticks(self.area.width(), 48.0);
        // The last number would not fit beside its unit.
        if let Some(last) = times.last_mut() {
            last.label += " s";
        }
        paint_ticks(painter, self.area, (&self.time_s, Side::Bottom), &times);
        let palette = Palette::of(painter.ctx().theme());
        let zero = painter.round_to_pixel_center(self.y_of(0.0));
        painter.hline(self.area.x_range(), zero, Stroke::new(1.0, palette.line));
        let at = pos2(self.area.left() - 5.0, self.area.top() - 6.0);
        paint_unit(painter, at, Align2::RIGHT_BOTTOM, unit);
    }

    fn paint_title(&self, painter: &Painter) {
        let palette = Palette::of(painter.ctx().theme());
        let noticed = self.noticed_db.iter().flatten();
        let least = noticed.copied().min_by(f64::total_cmp);
        let words = match least {
            Some(db) => format!("B − A  JND ±{} (model)", fixed(db, 1)),
            None => "B − A".to_owned(),
        };
        let at = pos2(self.area.right(), self.area.top() - 10.0);
        let font = theme::small();
        painter.text(at, Align2::RIGHT_CENTER, words, font, palette.dim);
    }

    fn x_of_column(&self, column: usize, n_columns: usize) -> f32 {
        let last = n_columns.saturating_sub(1).max(1) as f32;
        self.area.left() + column as f32 / last * self.area.width()
    }

    /// From the least to the most in every column; gaps where not both sound, with a stroke at the
    /// upper edge for B only and at the lower for A only.
    fn paint_line(&self, painter: &Painter, band: Band, columns: &[[Spread; 2]]) {
        let ink = Palette::of(painter.ctx().theme()).band(band);
        // Where both lines coincide, both are seen.
        let width = [2.5, 1.25][band.index()];
        let mut run: Vec<Pos2> = Vec::new();
        let flush = |run: &mut Vec<Pos2>| {
            if let [alone] = run[..] {
                painter.circle_filled(alone, 0.6 * width, ink);
            }
            painter.add(Shape::line(std::mem::take(run), Stroke::new(width, ink)));
        };
        for (column, spreads) in columns.iter().enumerate() {
            let spread = &spreads[band.index()];
            let x = self.x_of_column(column, columns.len());
            match spread.range_db {
                Some([least, most]) => {
                    run.push(pos2(x, self.y_of(least)));
                    if most > least {
                        run.push(pos2(x, self.y_of(most)));
                    }
                }
                None => flush(&mut run),
            }
            let edges = [self.area.bottom() - 4.0, self.area.top()];
            for (top, _) in edges.into_iter().zip(spread.is_only).filter(|(_, is)| *is) {
                painter.vline(x, top..=top + 4.0, Stroke::new(1.0, ink));
            }
        }
        flush(&mut run);
    }
}

fn answer(
    response: &Response,
    plot: &Plot,
    columns: &[[Spread; 2]],
    is_recorded: bool,
    commands: &mut Commands,
) {
    let Some(pointer) = response.hover_pos() else {
        return;
    };
    let tick = plot.tick_at(pointer.x);
    if response.clicked() && is_recorded {
        commands.push(PlayCommand::ReplayAt(tick).into());
    }
    let share = (pointer.x - plot.area.left()) / plot.area.width();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "not below 0, and a column that is not there is none"
    )]
    let column = (share * columns.len().saturating_sub(1) as f32)
        .round()
        .max(0.0) as usize;
    let Some(spreads) = columns.get(column) else {
        return;
    };
    let words = words(plot, tick, spreads, is_recorded);
    response.clone().on_hover_ui_at_pointer(|ui| {
        ui.label(words);
    });
}

fn words(plot: &Plot, tick: u64, spreads: &[Spread; 2], is_recorded: bool) -> String {
    let line = |band: Band| {
        let spread = &spreads[band.index()];
        let difference = match (spread.range_db, spread.is_only) {
            (Some([least, most]), _) if most > least => {
                let [least, most] = [least, most].map(|db| signed_db(db, decimals_of(db)));
                format!("{least} … {most}")
            }
            (Some([db, _]), _) => signed_db(db, decimals_of(db)),
            (None, [true, false]) => "A only".to_owned(),
            (None, [false, true]) => "B only".to_owned(),
            (None, [true, true]) => "A only or B only".to_owned(),
            (None, [false, false]) => "silent in both".to_owned(),
        };
        let noticed = plot.noticed_db[band.index()].map_or_else(String::new, |noticed_db| {
            format!(", just noticeable ±{} dB", fixed(noticed_db, 1))
        });
        format!("{}  {difference}{noticed}", band_name(band))
    };
    let [low, high] = Band::ALL.map(line);
    let end = if is_recorded {
        "Click shows this tick of the recording"
    } else {
        "This path is generated: record one to go to its ticks"
    };
    format!(
        "{}   tick {tick}\n{low}\n{high}\nB less A, of the mean over all contactors. Shaded: too \
         little to be noticed at the mean level of A, a model (“Compare” in the guide)\n{end}",
        clock(tick * TICK_MS),
    )
}
