//! The parameters of every kind of recipe, in the groups in which they are shown.

use super::{Number, Parameter, ParameterKind, Place};
use crate::cloth::YARN_NUMBERS;
use crate::{brownian, fourier, knit, restoration, weave};

/// Parameters that belong together.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Their title.
    pub title: &'static str,
    /// The parameters, in order.
    pub parameters: Vec<Parameter>,
}

/// Whether a cloth is felt along four strokes or over its area.
const REPRESENTATIONS: &[&str] = &["economical", "areal"];
const SIDES: &[&str] = &["face", "back"];
const STRUCTURES: &[&str] = &[
    "jersey",
    "reverse-jersey",
    "rib-1-1",
    "rib-2-2",
    "interlock",
    "pique",
    "terry",
    "fleece",
    "plush",
];
const GENERATORS: &[&str] = &["exact", "periodic"];
const TIPS: &[&str] = &["point", "wire"];
const COMPOSITIONS: &[&str] = &["independent", "product"];
const READINGS: &[&str] = &["corrected", "literal"];
const RULES: &[&str] = &["additive", "product", "max", "gated"];

/// The parameters of a kind of recipe; none of what is no recipe.
pub fn groups(kind: &str) -> Vec<Group> {
    match kind {
        "weave" => weave_groups(),
        "knit" => knit_groups(),
        "fourier" => fourier_groups(),
        "brownian" => brownian_groups(),
        "restoration" => restoration_groups(),
        _ => Vec::new(),
    }
}

fn weave_groups() -> Vec<Group> {
    let interlacing = of(
        "interlacing",
        ("Interlacing", "Which yarn lies on top at every crossing"),
        ParameterKind::Interlacing,
    );
    let mut numbers = of_numbers("source", weave::NUMBERS);
    let noise = numbers.split_off(numbers.len() - 1);
    let mut cloth = vec![interlacing];
    cloth.extend(numbers);
    vec![
        Group {
            title: "Cloth",
            parameters: cloth,
        },
        yarn("source.warp", "Warp yarn"),
        yarn("source.weft", "Weft yarn"),
        touched(noise),
    ]
}

fn knit_groups() -> Vec<Group> {
    let structure = of(
        "structure",
        ("Structure", "Which stitch stands where"),
        ParameterKind::Choice(STRUCTURES),
    );
    let mut numbers = of_numbers("source", knit::NUMBERS);
    let noise = numbers.split_off(numbers.len() - 1);
    let mut cloth = vec![structure];
    cloth.extend(numbers);
    vec![
        Group {
            title: "Cloth",
            parameters: cloth,
        },
        yarn("source.yarn", "Yarn"),
        touched(noise),
    ]
}

fn yarn(table: &'static str, title: &'static str) -> Group {
    let mut parameters = of_numbers(table, YARN_NUMBERS);
    for parameter in &mut parameters {
        if let ("plies", ParameterKind::Number { is_whole, .. }) =
            (parameter.place.key, &mut parameter.kind)
        {
            *is_whole = true;
        }
    }
    parameters.push(Parameter {
        place: Place {
            table,
            key: "colour",
        },
        name: "Colour",
        what: "Colour of the fibre, #rrggbb",
        kind: ParameterKind::Colour,
    });
    Group { title, parameters }
}

/// What decides how a cloth is felt.
fn touched(noise: Vec<Parameter>) -> Group {
    let mut parameters = vec![
        of(
            "side",
            ("Side", "Which side of the cloth is touched"),
            ParameterKind::Choice(SIDES),
        ),
        of(
            "representation",
            (
                "Felt",
                "Economical: along four strokes; areal: at every point of its relief",
            ),
            ParameterKind::Choice(REPRESENTATIONS),
        ),
        seed(),
    ];
    parameters.extend(noise);
    Group {
        title: "Touch",
        parameters,
    }
}

fn fourier_groups() -> Vec<Group> {
    let composition = of(
        "composition",
        ("Composition", "How two profiles become a surface"),
        ParameterKind::Choice(COMPOSITIONS),
    );
    let reading = of(
        "reading",
        (
            "Reading",
            "The printed sum as corrected, or to the letter (with product)",
        ),
        ParameterKind::Choice(READINGS),
    );
    let mut surface = vec![composition, reading];
    surface.extend(of_numbers("source", fourier::NUMBERS));
    surface.push(seed());
    vec![
        Group {
            title: "Surface",
            parameters: surface,
        },
        template("source.template", "Along the warp", false),
        template("source.weft_template", "Along the weft", true),
    ]
}

fn template(table: &'static str, title: &'static str, is_optional: bool) -> Group {
    let key = table.rsplit('.').next().unwrap_or(table);
    let mut parameters = vec![Parameter {
        place: Place {
            table: "source",
            key,
        },
        name: "Template",
        what: "Mean and spread of the coefficients of each harmonic",
        kind: ParameterKind::Template { is_optional },
    }];
    parameters.extend(of_numbers(table, fourier::TEMPLATE_NUMBERS));
    let lists = [
        ("mean_cos_um", "Cosines, mean", "Mean of the cosines"),
        ("sd_cos_um", "Cosines, sd", "Spread of the cosines"),
        ("mean_sin_um", "Sines, mean", "Mean of the sines"),
        ("sd_sin_um", "Sines, sd", "Spread of the sines"),
    ];
    parameters.extend(lists.map(|(key, name, what)| Parameter {
        place: Place { table, key },
        name,
        what,
        kind: ParameterKind::Numbers("µm"),
    }));
    Group { title, parameters }
}

fn brownian_groups() -> Vec<Group> {
    let generator = of(
        "generator",
        (
            "Generator",
            "Exact: no approximation and no repeat; periodic: repeats, takes cut-offs",
        ),
        ParameterKind::Choice(GENERATORS),
    );
    let tip = of(
        "tip",
        (
            "Tip",
            "A point, or the 5 mm wide wire of the virtual tester",
        ),
        ParameterKind::Choice(TIPS),
    );
    let cut_off = |key, name, what| {
        let kind = ParameterKind::Optional {
            least: 0.01,
            most: 50.0,
            unit: "mm",
            instead_of: "",
        };
        of(key, (name, what), kind)
    };
    let mut surface = vec![generator];
    surface.extend(of_numbers("source", brownian::NUMBERS));
    for (key, other) in [("smd_um", "rise_um"), ("rise_um", "smd_um")] {
        let found = surface
            .iter_mut()
            .find(|parameter| parameter.place.key == key);
        if let Some(parameter) = found {
            parameter.kind = optional(parameter.kind, other);
        }
    }
    surface.extend([
        cut_off(
            "shortest_mm",
            "Shortest wave",
            "No waves shorter than this; periodic alone",
        ),
        cut_off(
            "longest_mm",
            "Longest wave",
            "Waves longer than this are no stronger than this one; periodic alone",
        ),
        tip,
        seed(),
    ]);
    vec![Group {
        title: "Surface",
        parameters: surface,
    }]
}

fn restoration_groups() -> Vec<Group> {
    let rule = of(
        "composition",
        (
            "Composition",
            "How a warp and a weft profile become a surface",
        ),
        ParameterKind::Choice(RULES),
    );
    let residual = of(
        "residual",
        (
            "Residual",
            "Whether noise with the spectrum of the residual is added",
        ),
        ParameterKind::Flag,
    );
    let mut surface = vec![rule, residual];
    surface.extend(of_numbers("source", restoration::NUMBERS));
    surface.push(seed());
    vec![
        Group {
            title: "Surface",
            parameters: surface,
        },
        reduced("source.warp", "Warp profile"),
        reduced("source.weft", "Weft profile"),
    ]
}

fn reduced(table: &'static str, title: &'static str) -> Group {
    let mut parameters = of_numbers(table, restoration::REDUCED_NUMBERS);
    for parameter in &mut parameters {
        if parameter.place.key == "period_mm" {
            parameter.kind = optional(parameter.kind, "");
        }
    }
    let lists = [
        (
            "harmonics",
            "Harmonics",
            "Which harmonics of the period are kept",
            ParameterKind::Counts,
        ),
        (
            "amplitude_um",
            "Amplitudes",
            "Amplitudes of the harmonics",
            ParameterKind::Numbers("µm"),
        ),
        (
            "phase_deg",
            "Phases",
            "Phases of the harmonics",
            ParameterKind::Numbers("°"),
        ),
        (
            "residual_um",
            "Residual",
            "The residual in bands of a third of an octave, rms",
            ParameterKind::Numbers("µm"),
        ),
    ];
    parameters.extend(lists.map(|(key, name, what, kind)| Parameter {
        place: Place { table, key },
        name,
        what,
        kind,
    }));
    Group { title, parameters }
}

fn seed() -> Parameter {
    of(
        "seed",
        (
            "Seed",
            "Chooses the irregularities: another seed, another piece",
        ),
        ParameterKind::Seed,
    )
}

/// A parameter of the source itself.
fn of(
    key: &'static str,
    (name, what): (&'static str, &'static str),
    kind: ParameterKind,
) -> Parameter {
    let table = "source";
    Parameter {
        place: Place { table, key },
        name,
        what,
        kind,
    }
}

fn of_numbers<R>(table: &'static str, numbers: &[Number<R>]) -> Vec<Parameter> {
    let parameter = |number: &Number<R>| Parameter {
        place: Place {
            table,
            key: number.key,
        },
        name: number.name,
        what: number.what,
        kind: ParameterKind::Number {
            least: number.least,
            most: number.most,
            unit: number.unit,
            is_whole: false,
        },
    };
    numbers.iter().map(parameter).collect()
}

/// The same number where it may be left out.
fn optional(kind: ParameterKind, instead_of: &'static str) -> ParameterKind {
    match kind {
        ParameterKind::Number {
            least, most, unit, ..
        } => ParameterKind::Optional {
            least,
            most,
            unit,
            instead_of,
        },
        other => other,
    }
}
