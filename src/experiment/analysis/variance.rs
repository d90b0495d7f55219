//! Tables of analyses of variance.

use super::model::{Cell, Table, undefined};
use selvedge_statistics::Computed;
use selvedge_statistics::variance::{Effect, Repeated};

const EFFECTS: [(&str, &str); 17] = [
    ("effect", "effect"),
    ("n", "n"),
    ("ss", "SS"),
    ("df", "df"),
    ("ss_error", "SS error"),
    ("df_error", "df error"),
    ("f", "F"),
    ("p", "p"),
    ("partial_eta_squared", "partial η²"),
    ("generalised_eta_squared", "generalised η²"),
    ("mauchly_w", "Mauchly's W"),
    ("mauchly_p", "its p"),
    ("greenhouse_geisser", "ε, Greenhouse–Geisser"),
    ("p_greenhouse_geisser", "p so corrected"),
    ("huynh_feldt", "ε, Huynh–Feldt"),
    ("p_huynh_feldt", "p so corrected"),
    ("remarks", "remarks"),
];

/// Every effect of an analysis, a row each, or one row that says why there is none.
pub(super) fn effects(key: &str, title: &str, found: &Computed<Repeated>) -> Table {
    let mut table = Table::new(key, title, &EFFECTS);
    match found {
        Ok(found) => {
            for effect in &found.effects {
                table.push(row(effect, found.n));
            }
        }
        Err(why) => {
            let mut row = vec![Cell::from("all")];
            row.extend(undefined(why, EFFECTS.len() - 2));
            row.push(format!("refused: {}", why.reason).into());
            table.push(row);
        }
    }
    table
}

fn row(effect: &Effect, n: usize) -> Vec<Cell> {
    let mut row = vec![
        Cell::from(effect.name.as_str()),
        n.into(),
        effect.ss.into(),
        effect.df.into(),
        effect.ss_error.into(),
        effect.df_error.into(),
        Cell::of(&effect.f),
        Cell::of(&effect.p),
        Cell::of(&effect.partial_eta_squared),
        Cell::of(&effect.generalised_eta_squared),
    ];
    if let Some(s) = &effect.sphericity {
        row.extend([
            Cell::of(&s.mauchly_w),
            Cell::of(&s.mauchly_p),
            s.greenhouse_geisser.into(),
            Cell::of(&s.p_greenhouse_geisser),
            Cell::of(&s.huynh_feldt),
            Cell::of(&s.p_huynh_feldt),
        ]);
    } else {
        let why = if effect.df < 2.0 {
            "two levels are always spherical"
        } else {
            "the error term does not vary"
        };
        row.extend((0..6).map(|_| Cell::none(why)));
    }
    let told = match &effect.f {
        Ok(_) => String::new(),
        Err(why) => format!("not computable: {}", why.reason),
    };
    row.push(told.into());
    row
}
