//! The plot of the library and its numbers, one row a textile: what the pane shows and exports.

use crate::bench::export::Exported;
use crate::bench::export::origin::Origin;
use crate::bench::view::LibraryEntry;
use crate::tools::collection::measure::Measure;
use crate::tools::collection::state::{CollectionView, Entry};
use selvedge_chart::{Axis, Chart, Columns, Ink, Series, Style, Tone, Weight, Words};
use selvedge_foundation::quantity;
use selvedge_textile::tactile::Band;

/// Up to this many textiles are all named where none is selected; else those that are.
const MOST_NAMED: usize = 20;
/// Height of the plot, px.
const HEIGHT_PX: f64 = 560.0;

/// The textiles that are shown.
pub(crate) fn exported(view: &CollectionView<'_>, origin: Origin) -> Exported {
    let [x, y] = &view.choice.axes;
    let speed_mm_per_s = view.choice.speed_mm_per_s;
    let speed = quantity::with_unit(speed_mm_per_s, 0, "mm/s");
    let how = if view.choice.is_tuned {
        "after gains and compression; grey lines lead from where a textile is without them"
    } else {
        "through the filters alone, without gains or compression"
    };
    let is_without = |one: &&Entry<'_>| point(one, view, view.choice.is_tuned).is_none();
    let n_without = view.entries.iter().filter(is_without).count();
    let missing = match n_without {
        0 => String::new(),
        n => format!(" {n} textiles have no place here: not measured, or silent."),
    };
    let note = format!(
        "Means over all points and the four directions at {speed} along one axis, {how}.{missing}"
    );
    let origin = origin
        .and("speed_mm_per_s", &speed_mm_per_s.to_string(), &speed)
        .and("x", &x.label(view.items), "")
        .and("y", &y.label(view.items), "");
    let title = format!("The library: {} over {}", y.name(), x.name());
    let chart = Chart {
        columns: columns(view),
        ..chart(view, 0.0)
    };
    Exported::of_chart(&title, chart, HEIGHT_PX, &note, origin)
}

/// Where a textile stands, if it has both figures.
pub(crate) fn point(
    entry: &Entry<'_>,
    view: &CollectionView<'_>,
    is_tuned: bool,
) -> Option<[f64; 2]> {
    let [x, y] = &view.choice.axes;
    Some([entry.value(x, is_tuned)?, entry.value(y, is_tuned)?])
}

/// Every textile as a dot, with a line from where it is without the tuning; without the columns.
/// `faintness` is that of lines of what is neither selected nor pointed at.
pub(crate) fn chart(view: &CollectionView<'_>, faintness: f32) -> Chart {
    let is_tuned = view.choice.is_tuned;
    let at = |entry: &Entry<'_>| point(entry, view, is_tuned);
    let dots = |name: &str, ink, takes: &dyn Fn(&Entry<'_>) -> bool| Series {
        name: name.to_owned(),
        points: view
            .entries
            .iter()
            .filter(|one| takes(one))
            .filter_map(at)
            .collect(),
        ink,
        ..Series::default()
    };
    let mut series = Vec::new();
    if is_tuned {
        series.extend(view.entries.iter().filter_map(|one| {
            let points = vec![point(one, view, false)?, at(one)?];
            let is_moved = points[0].map(f64::to_bits) != points[1].map(f64::to_bits);
            let is_lit = one.is_selected || one.is_marked;
            is_moved.then(|| Series {
                points,
                faintness: if is_lit { 0.0 } else { faintness },
                style: Style::Line,
                ink: Ink::Grey,
                weight: Weight::Thin,
                ..Series::default()
            })
        }));
    }
    series.push(dots("library", Ink::Grey, &|one| !one.is_selected));
    series.push(dots("selected", Ink::Black, &|one| one.is_selected));
    let are_few = view.entries.len() <= MOST_NAMED && view.selected().next().is_none();
    let named = view.entries.iter().filter(|one| are_few || one.is_selected);
    let words = named.filter_map(|one| {
        Some(Words {
            at: at(one)?,
            text: one.item.name.clone(),
            tone: Tone::Aside,
        })
    });
    let [x, y] = view
        .choice
        .axes
        .each_ref()
        .map(|measure| axis_of(measure, view));
    Chart {
        x,
        y,
        series,
        words: words.collect(),
        ..Chart::default()
    }
}

fn axis_of(measure: &Measure, view: &CollectionView<'_>) -> Axis {
    let label = measure.label(view.items);
    if measure.is_log() {
        Axis::log(label)
    } else {
        Axis::linear(label)
    }
}

fn columns(view: &CollectionView<'_>) -> Columns {
    let entries = &view.entries;
    let words = |of: &dyn Fn(&LibraryEntry) -> &str| -> Vec<String> {
        entries.iter().map(|one| of(one.item).to_owned()).collect()
    };
    let number = |measure: &Measure, is_tuned: bool| -> Vec<f64> {
        let value = |one: &Entry<'_>| one.value(measure, is_tuned).unwrap_or(f64::NAN);
        entries.iter().map(value).collect()
    };
    let mean_um = |band: Band, is_tuned: bool| -> Vec<f64> {
        let um = |one: &Entry<'_>| {
            one.mean_um(is_tuned)
                .map_or(f64::NAN, |um| um[band.index()])
        };
        entries.iter().map(um).collect()
    };
    let gain_db = |b: usize| -> Vec<f64> { entries.iter().map(|one| one.gains_db[b]).collect() };
    let yes = |of: fn(&Entry<'_>) -> bool| -> Vec<u64> {
        entries.iter().map(|one| u64::from(of(one))).collect()
    };
    let [low, high] = Band::ALL;
    let measured = Measure::Figure("SMD".to_owned());
    let is_tuned = view.choice.is_tuned;
    Columns::default()
        .with("textile", words(&|item| &item.id))
        .with("name", words(&|item| &item.name))
        .with("construction", words(&|item| item.construction))
        .with(
            "structure",
            words(&|item| item.structure.unwrap_or_default()),
        )
        .with("raw_a40_um", mean_um(low, false))
        .with("raw_a320_um", mean_um(high, false))
        .with("raw_level_db", number(&Measure::Level, false))
        .with("gain_40_db", gain_db(0))
        .with("gain_320_db", gain_db(1))
        .with("tuned_a40_um", mean_um(low, true))
        .with("tuned_a320_um", mean_um(high, true))
        .with("tuned_level_db", number(&Measure::Level, true))
        .with(
            "variation_40_percent",
            number(&Measure::Variation(low), false),
        )
        .with(
            "variation_320_percent",
            number(&Measure::Variation(high), false),
        )
        .with("anisotropy_40_db", number(&Measure::Anisotropy(low), false))
        .with(
            "anisotropy_320_db",
            number(&Measure::Anisotropy(high), false),
        )
        .with("heights_smd_um", number(&Measure::Roughness, false))
        .with("measured_smd_um", number(&measured, false))
        .with("x", number(&view.choice.axes[0], is_tuned))
        .with("y", number(&view.choice.axes[1], is_tuned))
        .with("is_selected", yes(|one| one.is_selected))
        .with("is_in_scene", yes(|one| one.placed.is_some()))
}
