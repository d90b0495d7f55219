//! Fits whose values follow by hand, or from elsewhere.

use super::super::*;
use super::assert_close;
use crate::{Computed, Freedom, normal_density, normal_lower, normal_quantile};

fn pair(wins: u64, losses: u64) -> Preferences {
    Preferences::of_wins(&[vec![0, wins], vec![losses, 0]]).unwrap()
}

#[test]
fn two_items_lie_the_logit_of_the_share_apart() -> Computed<()> {
    let found = BradleyTerry::fit(&pair(14, 6), Prior::None)?;
    let difference = found.scale.difference(0, 1)?;
    let error = (1.0_f64 / 14.0 + 1.0 / 6.0).sqrt();
    assert_close(
        &[difference.value, difference.se],
        &[(14.0_f64 / 6.0).ln(), error],
        1e-13,
    );
    assert_close(&[found.scale.centred()[0].se], &[0.5 * error], 1e-13);
    assert!(found.deviance.residual.abs() < 1e-12, "saturated");
    assert_eq!((found.deviance.df, found.deviance.null_df), (0, 1));
    assert!(found.deviance.goodness_of_fit().is_err(), "nothing left");
    Ok(())
}

#[test]
fn two_items_lie_the_z_of_the_share_apart_by_both_routes() -> Computed<()> {
    let z = normal_quantile(0.7)?;
    let found = Thurstone::fit(&pair(14, 6))?;
    let difference = found.scale.difference(0, 1)?;
    let error = (0.7_f64 * 0.3 / 20.0).sqrt() / normal_density(z);
    assert_close(&[difference.value, difference.se], &[z, error], 1e-12);
    let rows = Mosteller::of(&pair(14, 6))?;
    assert_close(&rows.values, &[0.5 * z, -0.5 * z], 1e-14);
    assert!(rows.n_clipped == 0 && rows.fit.is_err(), "{rows:?}");
    let always = Mosteller::of(&pair(20, 0))?;
    assert_eq!(always.n_clipped, 1);
    let clipped = 0.5 * normal_quantile(1.0 - 1.0 / 40.0)?;
    assert_close(&always.values, &[clipped, -clipped], 1e-14);
    Ok(())
}

#[test]
fn journals_have_the_abilities_of_the_generalised_linear_model() -> Computed<()> {
    // Citations between four journals of statistics (Stigler 1994; Agresti 2002, p. 448), fitted by
    // iteration of the likelihood equations in another language: Biometrika, Communications, JASA,
    // JRSS-B.
    let cited = Preferences::of_wins(&[
        vec![0, 730, 498, 221],
        vec![33, 0, 68, 17],
        vec![320, 813, 0, 142],
        vec![284, 276, 325, 0],
    ])?;
    let found = BradleyTerry::fit(&cited, Prior::None)?;
    let from_first = |item| found.scale.difference(item, 0);
    let relative = (1..4)
        .map(from_first)
        .collect::<Computed<Vec<Estimate>>>()?;
    let values: Vec<f64> = relative.iter().map(|e| e.value).collect();
    let errors: Vec<f64> = relative.iter().map(|e| e.se).collect();
    assert_close(
        &values,
        &[-2.949_072_496_844, -0.479_569_769_752, 0.268_954_055_819],
        1e-11,
    );
    assert_close(
        &errors,
        &[0.102_545_335_511, 0.060_588_729_248, 0.070_829_965_111],
        1e-11,
    );
    let deviance = found.deviance;
    assert_close(
        &[deviance.residual, deviance.null, found.log_likelihood],
        &[4.293_383_969_89, 1_925.232_850_208_5, -1_622.889_808_827_6],
        1e-9,
    );
    assert_eq!((deviance.df, deviance.null_df), (3, 6));
    assert_eq!(deviance.goodness_of_fit()?.df, Freedom::One(3.0));
    Ok(())
}

#[test]
fn a_circle_of_equal_wins_is_level_and_as_sure_as_a_triangle_of_springs() -> Computed<()> {
    // All abilities 0: each pair has information n/4, and three in a triangle 3n/4 about the mean.
    let circle = [vec![0, 7, 3], vec![3, 0, 7], vec![7, 3, 0]];
    let preferences = Preferences::of_wins(&circle)?;
    let found = BradleyTerry::fit(&preferences, Prior::None)?;
    assert_close(&found.scale.values, &[0.0; 3], 1e-14);
    let variance = found.scale.covariance[0][0];
    assert!((variance - (2.0 / 3.0) / (0.75 * 10.0)).abs() < 1e-14);
    // Every pair is 7 : 3 and the model has 5 : 5.
    let fit = found.deviance.goodness_of_fit()?;
    let by_hand = 3.0 * 2.0 * (7.0 * 1.4_f64.ln() + 3.0 * 0.6_f64.ln());
    assert!((fit.statistic.value - by_hand).abs() < 1e-12);
    let rows = Mosteller::of(&preferences)?;
    assert_close(&rows.values, &[0.0; 3], 1e-14);
    let angle = 0.7_f64.sqrt().asin() - std::f64::consts::FRAC_PI_4;
    let arcsine = rows.fit?;
    assert!((arcsine.statistic.value - 120.0 * angle * angle).abs() < 1e-12);
    assert_eq!(arcsine.df, Freedom::One(1.0));
    Ok(())
}

#[test]
fn three_items_ranked_in_every_order_have_the_worths_of_their_first_places() -> Computed<()> {
    // Firsts 3 : 2 : 1, and seconds as Luce's rule would have them of the rest: 3/6 · 2/3 of 60
    // rankings are 1, 2, 3 and so on. The worths are then exactly 3 : 2 : 1.
    let mut rankings: Vec<[usize; 3]> = Vec::new();
    let worths = [3, 2, 1];
    for (a, b, c) in [
        (0, 1, 2),
        (0, 2, 1),
        (1, 0, 2),
        (1, 2, 0),
        (2, 0, 1),
        (2, 1, 0),
    ] {
        let n = 60 * worths[a] * worths[b] / (6 * (worths[b] + worths[c]));
        rankings.extend(std::iter::repeat_n([a, b, c], n));
    }
    assert_eq!(rankings.len(), 60);
    let found = PlackettLuce::fit(3, &rankings, Prior::None)?;
    assert_close(&found.worths(), &[0.5, 1.0 / 3.0, 1.0 / 6.0], 1e-12);
    let null = 60.0 * (1.0_f64 / 6.0).ln();
    assert!((found.null_log_likelihood - null).abs() < 1e-10);
    Ok(())
}

#[test]
fn shares_that_follow_the_normal_scale_are_fitted_by_it() -> Computed<()> {
    let truth = [0.7, 0.1, -0.8];
    let n = 1_000_000_000.0;
    let mut rows = vec![vec![0; 3]; 3];
    for (i, j) in [(0, 1), (0, 2), (1, 2), (1, 0), (2, 0), (2, 1)] {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a share of a thousand million"
        )]
        let wins = (n * normal_lower(truth[i] - truth[j])).round() as u64;
        rows[i][j] = wins;
    }
    let shares = Preferences::of_wins(&rows)?;
    assert_close(&Thurstone::fit(&shares)?.scale.values, &truth, 1e-7);
    assert_close(&Mosteller::of(&shares)?.values, &truth, 1e-7);
    assert!(Thurstone::fit(&shares)?.deviance.residual < 1e-6);
    Ok(())
}

#[test]
fn a_prior_is_one_choice_of_each_item_among_all() -> Computed<()> {
    let found = BradleyTerry::fit(&pair(5, 0), Prior::Gamma(0.5))?;
    let apart = found.scale.difference(0, 1)?;
    assert_close(&[apart.value], &[(5.5_f64 / 0.5).ln()], 1e-12);
    assert!(found.deviance.goodness_of_fit().is_err(), "no χ²");
    // For rankings: the same fit as with those choices added as rankings of one first.
    let mut ranked = vec![vec![0, 1, 2]; 4];
    let with_prior = PlackettLuce::fit(3, &ranked, Prior::Gamma(1.0))?;
    assert!(with_prior.against_chance().is_err(), "no χ²");
    let worths = with_prior.worths();
    // Slopes: choices won less choices expected, the prior's three among all included.
    let expected = [
        5.0 - 7.0 * worths[0],
        5.0 - 7.0 * worths[1] - 4.0 * worths[1] / (worths[1] + worths[2]),
        1.0 - 7.0 * worths[2] - 4.0 * worths[2] / (worths[1] + worths[2]),
    ];
    assert_close(&expected, &[0.0; 3], 1e-10);
    ranked.extend([vec![2, 1, 0], vec![1, 0, 2], vec![0, 2, 1]]);
    let weak = PlackettLuce::fit(3, &ranked, Prior::Gamma(1e-9))?;
    let none = PlackettLuce::fit(3, &ranked, Prior::None)?;
    assert_close(&weak.scale.values, &none.scale.values, 1e-8);
    Ok(())
}

#[test]
fn a_chain_of_hardly_any_defeats_is_as_long_as_its_links() -> Computed<()> {
    let n = 16;
    let mut rows = vec![vec![0; n]; n];
    for i in 1..n {
        rows[i - 1][i] = 1_000_000;
        rows[i][i - 1] = 1;
    }
    let chain = Preferences::of_wins(&rows)?;
    let (logit, probit) = (
        BradleyTerry::fit(&chain, Prior::None)?,
        Thurstone::fit(&chain)?,
    );
    let z = normal_quantile(1e6 / (1e6 + 1.0))?;
    for i in 1..n {
        let link = |scale: &Scale| scale.difference(i - 1, i);
        assert!((link(&logit.scale)?.value - 1e6_f64.ln()).abs() < 1e-8);
        assert!((link(&logit.scale)?.se - (1.0 + 1e-6_f64).sqrt()).abs() < 1e-8);
        assert!((link(&probit.scale)?.value - z).abs() < 1e-8);
    }
    Ok(())
}
