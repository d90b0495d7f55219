//! `selvedge friction train`: networks that learn on procedural cloth.

use clap::Args;

use super::super::output::OutFile;
use super::data::DataArgs;
use super::{folder, run_timed};
use crate::CliError;
use crate::terminal::{self, with_meter};
use crate::usage::one_of;
use selvedge_foundation::numerics::n_threads;
use selvedge_friction::{
    AdversarialLoss, Contestant, FrictionError, Lesson, Method, Run, Split, Taken,
};

/// What is trained, and where it is kept.
#[derive(Debug, Args)]
pub(crate) struct TrainArgs {
    /// Folder of runs
    #[arg(long, value_name = "DIR")]
    out: OutFile,
    /// The network: ours, ours-adversarial or frictgan
    #[arg(long, default_value = "ours",
        value_parser = one_of(Method::ALL.map(|method| (method.word(), method))))]
    method: Method,
    /// What is held back: A (cloths), B (a family), C (places) or D (leaky, for comparison only)
    #[arg(long, default_value = "A",
        value_parser = one_of(Split::ALL.map(|split| (split.letter(), split))))]
    split: Split,
    /// What everything that is drawn begins with: a run a seed
    #[arg(long, value_name = "S", num_args = 1.., default_values_t = [1])]
    seeds: Vec<u64>,
    /// What generator and critic are told by each other, where there are both
    #[arg(long, default_value = "bce",
        value_parser = one_of(AdversarialLoss::ALL.map(|loss| (loss.word(), loss))))]
    loss: AdversarialLoss,
    /// Times that every example is seen (as many as results are told of)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    rounds: Option<u32>,
    /// Cloths of each family that are learnt from
    #[arg(long, value_name = "N", default_value_t = Split::N_CLOTHS as u32,
        value_parser = clap::value_parser!(u32).range(1..=5000))]
    cloths: u32,
    /// Channels of ours
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=64))]
    width: Option<u8>,
    #[command(flatten)]
    data: DataArgs,
}

pub(super) fn run(args: &TrainArgs) -> Result<(), CliError> {
    folder(&args.out)?;
    let lesson = |seed: u64| {
        let mut lesson = Lesson::usual(args.method, seed);
        lesson.loss = args.loss;
        lesson.n_rounds = args.rounds.map_or(lesson.n_rounds, |n| n as usize);
        args.width
            .map_or(lesson, |width| lesson.with_width(width.into()))
    };
    let (fabrics, name) = (args.data.fabrics()?, args.data.name());
    let run = |seed: u64| Run {
        contestant: Contestant::Network(lesson(seed)),
        split: args.split,
        n_cloths: args.cloths as usize,
        fabrics: name.as_deref(),
        folder: &args.out,
    };
    let mut wanted = Vec::new();
    for &seed in &args.seeds {
        let run = run(seed);
        if run.finished()?.is_some() {
            terminal::notice(&format!("{} is finished", run.name()));
        } else {
            wanted.push(run);
        }
    }
    if wanted.is_empty() {
        return Ok(());
    }
    with_meter("train", |progress| -> Result<(), FrictionError> {
        progress
            .step(0.0, "making pictures of cloth")
            .map_err(|_stopped| FrictionError::Cancelled)?;
        let taken = match &fabrics {
            Some(fabrics) => Taken::of_fabrics(fabrics)?,
            None => Taken::of(args.split, args.cloths as usize, n_threads()),
        };
        for run in wanted {
            run_timed(&run, &taken, progress)?;
        }
        Ok(())
    })??;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;
    use selvedge_foundation::files::GrayImage;
    use selvedge_scratch::ScratchFolder;

    #[derive(Debug, Parser)]
    struct Asked {
        #[command(flatten)]
        train: TrainArgs,
    }

    #[test]
    fn networks_learn_from_a_folder_of_fabrics_and_one_of_five_is_held_back() {
        let folder = ScratchFolder::made("mine");
        for nth in 0..5_u32 {
            let values = (0..600 * 110_u32).map(|i| f64::from(i * (nth + 1) % 97) / 97.0);
            let picture = GrayImage::of_shares([600, 110], values);
            let name = format!("cloth{nth}.png");
            folder.write(&name, picture.to_png(name.as_ref()).unwrap());
            let mu = |at: u32| format!("{}\n", 0.3 + 0.01 * f64::from(at % (3 + nth)));
            let trace: String = (0..700).map(mu).collect();
            folder.write(&format!("cloth{nth}.csv"), trace);
        }
        let out = ScratchFolder::new("runs");
        let [data, to] = [&folder, &out].map(|folder| folder.to_string_lossy());
        let args = ["train", "--out", &to, "--data", &data, "--px-per-mm", "10"];
        let short = ["--rounds", "1", "--width", "2", "--seeds", "3"];
        let asked = Asked::parse_from(args.iter().chain(&short));
        run(&asked.train).unwrap();
        let name = "ours-mine-3-width-2-rounds-1";
        let scores = out.read(&format!("{name}.scores.csv"));
        let of: Vec<_> = scores.lines().skip(1).collect();
        assert_eq!(of.len(), 1, "{scores}");
        assert!(of[0].starts_with("cloth4,0,0,"), "{scores}");
        let kept = out.read("runs.csv");
        assert!(
            kept.lines()
                .nth(1)
                .unwrap()
                .starts_with(&format!("{name},ours,mine,3,2,1,"))
        );
        let cpu_s = kept.trim().rsplit(',').nth(1).unwrap();
        assert!(cpu_s.parse::<f64>().unwrap() > 0.0, "{kept}");
    }
}
