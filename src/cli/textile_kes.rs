//! `selvedge textile import-kes`: a textile from files of the Kawabata surface tester.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use clap::{Args, ValueEnum};

use super::output::{Cell, InFile, OutFile};
use super::textile_words::{WordsArgs, construction};
use super::usage::one_of;
use super::{CliError, output, terminal};
use selvedge_foundation::quantity::fixed;
use selvedge_textile::{
    ColumnRole, Construction, DecimalSign, KesFile, KesImport, KesOptions, KesPlace, KesReading,
    LengthUnit, MeasuredFigure, ReturnOrder, TextileAxis, Unit,
};

/// Files of the tester, what they do not say, and where the textile goes.
#[derive(Debug, Args)]
pub(super) struct ImportKesArgs {
    /// Exports of the surface tester: text in columns
    #[arg(required = true)]
    files: Vec<InFile>,
    /// The textile's folder
    #[arg(long, value_name = "DIR")]
    out: OutFile,
    /// What people call it
    #[arg(long)]
    name: String,
    /// How it is made
    #[arg(long, value_parser = construction(), default_value = "woven")]
    construction: Construction,
    #[command(flatten)]
    words: WordsArgs,
    /// What a file holds, once a file in their order: warp, weft, warp-forward, warp-return …
    #[arg(long, value_name = "DIRECTION", value_parser = place)]
    direction: Vec<KesPlace>,
    /// The distance between samples, mm
    #[arg(long, value_name = "MM")]
    step_mm: Option<f64>,
    /// The speed of the stroke, mm/s
    #[arg(long, value_name = "V")]
    speed_mm_per_s: Option<f64>,
    /// Samples a second
    #[arg(long, value_name = "HZ")]
    rate_hz: Option<f64>,
    /// The height in µm that 1 V stands for
    #[arg(long, value_name = "UM", allow_negative_numbers = true)]
    um_per_volt: Option<f64>,
    /// The unit of places
    #[arg(long, value_parser = one_of(LENGTHS))]
    x_unit: Option<LengthUnit>,
    /// The unit of heights
    #[arg(long, value_enum)]
    height_unit: Option<ZUnit>,
    /// The decimal sign
    #[arg(long, value_parser = one_of(DECIMALS))]
    decimal: Option<DecimalSign>,
    /// What the columns are: x, t, height, forward, return, warp-forward …, mu, skip
    #[arg(long, value_delimiter = ',', value_parser = role)]
    columns: Option<Vec<ColumnRole>>,
    /// How rows of a return stroke follow one another: as measured, or by place
    #[arg(long, value_parser = one_of(ORDERS))]
    return_order: Option<ReturnOrder>,
    /// The evaluated section, mm on the cloth; warp=FROM,TO or weft=FROM,TO for one axis
    #[arg(long, value_name = "FROM,TO", value_parser = section, allow_hyphen_values = true)]
    section: Vec<Section>,
    /// Also give SMD and MMD without what varies over more than 1 mm
    #[arg(long)]
    official_band: bool,
    /// A trace of friction along the warp
    #[arg(long, value_name = "FILE")]
    friction: Option<InFile>,
}

const LENGTHS: [(&str, LengthUnit); 3] = [
    ("mm", LengthUnit::Millimetre),
    ("cm", LengthUnit::Centimetre),
    ("um", LengthUnit::Micrometre),
];
const DECIMALS: [(&str, DecimalSign); 2] =
    [("point", DecimalSign::Point), ("comma", DecimalSign::Comma)];
const ORDERS: [(&str, ReturnOrder); 2] = [
    ("travel", ReturnOrder::Travel),
    ("mirrored", ReturnOrder::Mirrored),
];

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ZUnit {
    Um,
    Mm,
    #[value(name = "V", alias = "v")]
    Volt,
}

/// A section of one axis, or of both.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Section {
    axis: Option<TextileAxis>,
    mm: [f64; 2],
}

fn place(word: &str) -> Result<KesPlace, String> {
    match ColumnRole::from_word(word) {
        Some(ColumnRole::Height(Some(axis), side)) => Ok(KesPlace { axis, side }),
        _ => Err("say warp, weft, warp-forward, warp-return, weft-forward or weft-return".into()),
    }
}

fn role(word: &str) -> Result<ColumnRole, String> {
    let unknown = "say x, t, height, forward, return, warp-forward …, mu or skip";
    ColumnRole::from_word(word).ok_or_else(|| unknown.to_owned())
}

fn section(text: &str) -> Result<Section, String> {
    let wrong = || "say FROM,TO in mm, warp=FROM,TO or weft=FROM,TO".to_owned();
    let (axis, range) = match text.split_once('=') {
        None => (None, text),
        Some(("warp", range)) => (Some(TextileAxis::Warp), range),
        Some(("weft", range)) => (Some(TextileAxis::Weft), range),
        Some(_) => return Err(wrong()),
    };
    let (from, to) = range.split_once(',').ok_or_else(wrong)?;
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|mm| mm.is_finite());
    match (number(from), number(to)) {
        (Some(from), Some(to)) => Ok(Section {
            axis,
            mm: [from, to],
        }),
        _ => Err(wrong()),
    }
}

impl ImportKesArgs {
    fn options(&self) -> Result<KesOptions, CliError> {
        let (n_said, n_files) = (self.direction.len(), self.files.len());
        if n_said != 0 && n_said != n_files {
            let what = format!("--direction is said {n_said} times for {n_files} files");
            return Err(CliError::Input(format!("{what}; say it once a file")));
        }
        Ok(KesOptions {
            directions: self.direction.iter().copied().map(Some).collect(),
            step_mm: self.step_mm,
            speed_mm_per_s: self.speed_mm_per_s,
            rate_hz: self.rate_hz,
            um_per_volt: self.um_per_volt,
            x_unit: self.x_unit,
            height_unit: self.height_unit.map(|unit| match unit {
                ZUnit::Um => Unit::Length(LengthUnit::Micrometre),
                ZUnit::Mm => Unit::Length(LengthUnit::Millimetre),
                ZUnit::Volt => Unit::Volt,
            }),
            decimal: self.decimal,
            columns: self.columns.clone(),
            return_order: self.return_order,
        })
    }

    fn sections(&self) -> [Option<[f64; 2]>; 2] {
        [TextileAxis::Warp, TextileAxis::Weft].map(|axis| {
            let is_meant = |section: &&Section| section.axis.is_none_or(|said| said == axis);
            self.section
                .iter()
                .rfind(is_meant)
                .map(|section| section.mm)
        })
    }
}

/// Imports.
pub(super) fn run(args: &ImportKesArgs) -> Result<(), CliError> {
    let options = args.options()?;
    let read = |path: &InFile| -> Result<_, CliError> {
        Ok((path.clone(), selvedge_textile::read_measurement(path)?))
    };
    let strokes = args.files.iter().map(read).collect::<Result<Vec<_>, _>>()?;
    let friction = args.friction.as_ref().map(read).transpose()?;
    let given: Vec<KesFile<'_>> = strokes.iter().map(given).collect();
    let friction = friction.as_ref().map(self::given);
    let reading = KesReading::of(&given, friction, &options)?;
    let import = KesImport::new(reading, args.sections(), args.official_band)?;
    for unit in &import.reading().assumed {
        terminal::notice(&format!("assumed: {unit}, no unit is stated"));
    }
    for note in &import.reading().notes {
        terminal::notice(note);
    }
    let words = args.words.words(&args.name, args.construction)?;
    let built = import.files(&words)?;
    selvedge_textile::write(&built, &args.out)?;
    selvedge_textile::write_figure(&import.figure(&args.name), &args.out, "import")?;
    output::print(&report(&import, &args.out)?)
}

fn given((path, bytes): &(InFile, Vec<u8>)) -> KesFile<'_> {
    KesFile { path, bytes }
}

/// What was imported: strokes, sections, figures.
fn report(import: &KesImport, out: &Path) -> Result<String, CliError> {
    let mut text = String::new();
    let failed = |_| CliError::Failed("the report cannot be written; run it again".to_owned());
    for stroke in &import.reading().strokes {
        let marks = stroke
            .marks
            .iter()
            .map(|mark| mark.samples.len())
            .sum::<usize>();
        writeln!(
            text,
            "{:14}{} samples, step {} mm, tilt {} µm/mm taken off, {marks} samples marked",
            stroke.direction.label(),
            stroke.heights_um.len(),
            fixed(stroke.step_mm, 6),
            fixed(stroke.tilt_um_per_mm, 3),
        )
        .map_err(failed)?;
    }
    for (axis, name) in [(TextileAxis::Warp, "warp"), (TextileAxis::Weft, "weft")] {
        let Some(section) = import.section(axis) else {
            continue;
        };
        let how = if section.is_suggested {
            "suggested: most stationary"
        } else {
            "as said"
        };
        let [from, to] = [section.from_mm, section.to_mm].map(|mm| fixed(mm, 2));
        let label = format!("{name} section");
        writeln!(text, "{label:14}{from} to {to} mm ({how})").map_err(failed)?;
    }
    let measured = figures(&import.figures().measured());
    text.extend(measured.into_iter().map(|(_, line)| line));
    writeln!(text, "{}", out.display()).map_err(failed)?;
    Ok(text)
}

/// Measured figures: what each is and its value, and its line.
pub(super) fn figures(measured: &BTreeMap<String, f64>) -> Vec<([Cell; 2], String)> {
    let row = |figure: MeasuredFigure| {
        let value = format!("{} {}", figure.value, figure.unit).replace('-', "−");
        let (name, what) = (figure.name, figure.what);
        let line = format!("{name:14}{value:16}{what}").trim_end().to_owned() + "\n";
        ([Cell::text(name), Cell::text(value.trim_end())], line)
    };
    let all = MeasuredFigure::all_of(measured).into_iter();
    all.map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_textile::StrokeSide;

    #[test]
    fn sections_are_said_for_one_axis_or_both() {
        assert_eq!(section("5,25").unwrap().mm, [5.0, 25.0]);
        assert_eq!(
            section("weft=4.5, 24.5").unwrap().axis,
            Some(TextileAxis::Weft)
        );
        for text in ["5", "bias=5,25", "5;25", "a,b", "nan,25"] {
            assert!(section(text).is_err(), "{text}");
        }
    }

    #[test]
    fn directions_are_said_in_words() {
        let said = place("weft-return").unwrap();
        assert_eq!(
            (said.axis, said.side),
            (TextileAxis::Weft, Some(StrokeSide::Return))
        );
        assert_eq!(place("warp").unwrap().side, None);
        assert_eq!(
            place("warp_reverse").unwrap().side,
            Some(StrokeSide::Return)
        );
        assert!(
            place("up").is_err() && place("forward").is_err(),
            "an axis is needed"
        );
    }
}
