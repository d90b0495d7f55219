//! Tables of analyses of variance.

use super::model::{Cell, Table, cells, or_undefined};
use selvedge_statistics::variance::{Comparison, Crossed, Effect, Repeated};
use selvedge_statistics::{Computed, Named};

const EFFECTS: &str = "effect; n; ss: SS; df; ss_error: SS error; df_error: df error; f: F; p; \
    partial_eta_squared: partial η²; partial_eta_squared_low: 95 % CI (noncentral F) from; \
    partial_eta_squared_high: to; generalised_eta_squared: generalised η²; mauchly_w: Mauchly's \
    W; mauchly_p: its p; greenhouse_geisser: ε, Greenhouse–Geisser; p_greenhouse_geisser: p so \
    corrected; huynh_feldt: ε, Huynh–Feldt; p_huynh_feldt: p so corrected; remarks";

/// The cells of every subject, where nobody lacks one.
pub(super) fn complete_rows(crossed: &Computed<Crossed>) -> Computed<Vec<Vec<f64>>> {
    let table = crossed.as_ref().map_err(Clone::clone)?;
    let rows = table.complete()?;
    Ok(rows
        .chunks(table.n_cells().max(1))
        .map(<[f64]>::to_vec)
        .collect())
}

/// Every effect of an analysis, a row each, or one row that says why there is none.
pub(super) fn effects(key: &str, title: &str, found: &Computed<Repeated>) -> Table {
    let mut table = Table::new(key, title, EFFECTS);
    match found {
        Ok(found) => {
            for effect in &found.effects {
                table.push(row(effect, found.n));
            }
        }
        Err(why) => {
            let blank = vec![Cell::none(&why.reason); table.columns.len() - 2];
            table.push(cells!["all", blank, format!("refused: {}", why.reason)]);
        }
    }
    table
}

fn row(effect: &Effect, n: usize) -> Vec<Cell> {
    let sphericity = if let Some(s) = &effect.sphericity {
        cells![
            &s.mauchly_w,
            &s.mauchly_p,
            s.greenhouse_geisser,
            &s.p_greenhouse_geisser,
            &s.huynh_feldt,
            &s.p_huynh_feldt,
        ]
    } else if effect.df < 2.0 {
        vec![Cell::none("two levels are always spherical"); 6]
    } else {
        vec![Cell::none("the error term does not vary"); 6]
    };
    let remark = match &effect.f {
        Ok(_) => String::new(),
        Err(why) => format!("not computable: {}", why.reason),
    };
    let sums = [effect.ss, effect.df, effect.ss_error, effect.df_error];
    let tested = [&effect.f, &effect.p, &effect.partial_eta_squared];
    cells![
        &effect.name,
        n,
        sums,
        tested,
        effect.partial_eta_squared_interval(),
        &effect.generalised_eta_squared,
        sphericity,
        remark
    ]
}

/// Every two stimuli that anybody answered to, subject by subject, their p values adjusted for each
/// other by Holm.
pub(super) fn every_two(key: &str, crossed: &Computed<Crossed>) -> Table {
    let columns = "first; second; n; difference: mean difference; ci_low: 95 % CI from; ci_high: \
        to; p: p (paired t); p_holm: p by Holm; d_z; d_z_low: 95 % CI (noncentral t) from; \
        d_z_high: to";
    let title = "Every two stimuli, subject by subject";
    let mut table = Table::new(key, title, columns);
    let names = crossed.as_ref().map_or(&[][..], Crossed::levels);
    let column = |rows: &Vec<Vec<f64>>, at: usize| rows.iter().map(|row| row[at]).collect();
    let found = complete_rows(crossed).and_then(|rows| {
        let all: Vec<Vec<f64>> = (0..names.len()).map(|at| column(&rows, at)).collect();
        Comparison::every_pair(&all)
    });
    match found {
        Ok(all) => all.iter().for_each(|one| table.push(pair(one, names))),
        Err(why) => {
            let blank = vec![Cell::none(&why.reason); table.columns.len() - 2];
            table.push(cells!["all", "all", blank]);
        }
    }
    table
}

fn pair(one: &Comparison, names: &[String]) -> Vec<Cell> {
    let [first, second] = one.conditions.map(|at| &names[at]);
    let found = one.outcome.as_ref().map(|outcome| {
        let value = |named: &Computed<Named>| named.clone().map(|named| named.value);
        cells![
            outcome.n.iter().sum::<usize>(),
            value(&outcome.estimate),
            &outcome.interval,
            outcome.p,
            &one.p_holm,
            value(&outcome.effect),
            outcome.effect_interval().map(|(interval, _)| interval),
        ]
    });
    cells![first, second, or_undefined(found, 9)]
}
