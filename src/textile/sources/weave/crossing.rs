//! Where the yarns of a weave cross, and the paths between the crossings.

use super::Weave;
use super::interlacing::Repeat;
use crate::yarns::{Drift, Field, Yarn, YarnPath, YarnRun, count};
use selvedge_foundation::numerics::{Grid, Random};

/// The patch is at least this large, mm: the stroke of 20 mm and what the probe touches around it.
const MIN_SIZE_MM: f64 = 22.0;
/// Straight pieces between two crossings.
const PIECES: u8 = 6;

/// What happens where an end crosses a pick.
#[derive(Debug, Clone, Copy, Default)]
struct Crossing {
    u_mm: f64,
    w_mm: f64,
    warp_z_um: f64,
    weft_z_um: f64,
}

/// One set of parallel yarns.
struct Sheet<'a> {
    runs: Vec<YarnRun<'a>>,
    places_mm: Vec<f64>,
    bow: [Drift; 2],
    bow_mm: f64,
    length_mm: f64,
}

/// Size of the patch (u, w) in mm, the ends, the picks.
pub(super) fn paths(
    weave: &Weave,
    repeat: &Repeat,
    random: &Random,
) -> ([f64; 2], Vec<YarnPath>, Vec<YarnPath>) {
    let whole = |per_cm: f64, repeat: usize| {
        let repeats = (MIN_SIZE_MM * per_cm / 10.0 / repeat as f64).ceil();
        count(repeats) * repeat
    };
    let n_ends = whole(weave.warp_per_cm, repeat.n_ends());
    let n_picks = whole(weave.weft_per_cm, repeat.n_picks());
    let pitch = [10.0 / weave.weft_per_cm, 10.0 / weave.warp_per_cm];
    let size = [n_picks as f64 * pitch[0], n_ends as f64 * pitch[1]];
    let ends = Sheet::new(
        weave,
        &weave.warp,
        (n_ends, pitch[1]),
        size[0],
        &random.branch("warp"),
    );
    let picks = Sheet::new(
        weave,
        &weave.weft,
        (n_picks, pitch[0]),
        size[1],
        &random.branch("weft"),
    );
    let crossings = crossings(weave, repeat, [&ends, &picks], size, random);
    let at = |end: usize, pick: usize| crossings.row(pick)[end];
    let warp = (0..n_ends).map(|end| {
        let line: Vec<_> = (0..=n_picks)
            .map(|pick| {
                let mut c = at(end, pick % n_picks);
                c.u_mm += if pick == n_picks { size[0] } else { 0.0 };
                ([c.u_mm, c.w_mm], c.warp_z_um)
            })
            .collect();
        path(&ends.runs[end], &line, 0)
    });
    let weft = (0..n_picks).map(|pick| {
        let line: Vec<_> = (0..=n_ends)
            .map(|end| {
                let mut c = at(end % n_ends, pick);
                c.w_mm += if end == n_ends { size[1] } else { 0.0 };
                ([c.u_mm, c.w_mm], c.weft_z_um)
            })
            .collect();
        path(&picks.runs[pick], &line, 1)
    });
    (size, warp.collect(), weft.collect())
}

impl<'a> Sheet<'a> {
    /// `n` yarns at a pitch in mm, each of `length_mm`.
    fn new(
        weave: &Weave,
        yarn: &'a Yarn,
        (n, pitch_mm): (usize, f64),
        length_mm: f64,
        random: &Random,
    ) -> Self {
        let width_mm = n as f64 * pitch_mm;
        let bands = yarn.bands(width_mm, &mut random.branch("bands"));
        let mut place = random.branch("places");
        let places_mm: Vec<f64> = (0..n)
            .map(|i| (i as f64 + 0.5 + weave.pitch_cv * place.normal()) * pitch_mm)
            .collect();
        let mut run = random.branch("yarns");
        let runs = places_mm
            .iter()
            .map(|&place| YarnRun::new(yarn, length_mm, bands.at(place), &mut run))
            .collect();
        let mut bow = random.branch("bow");
        let bow = [0, 1].map(|_| Drift::new(width_mm, weave.drift_mm, &mut bow));
        Self {
            runs,
            places_mm,
            bow,
            bow_mm: 0.001 * weave.bow_um,
            length_mm,
        }
    }

    /// Where yarn `i` runs at a place along it, mm: its own place and its bow.
    fn place_mm(&self, i: usize, along_mm: f64) -> f64 {
        let place = self.places_mm[i];
        let turn = std::f64::consts::TAU * along_mm / self.length_mm;
        place
            + self.bow_mm
                * (self.bow[0].at(place) * turn.sin() + self.bow[1].at(place) * turn.cos())
    }
}

fn crossings(
    weave: &Weave,
    repeat: &Repeat,
    [ends, picks]: [&Sheet<'_>; 2],
    size: [f64; 2],
    random: &Random,
) -> Grid<Crossing> {
    let tension = Field::new(size, weave.drift_mm, &mut random.branch("tension"));
    let pucker = Field::new(size, weave.pucker_mm, &mut random.branch("pucker"));
    let mut grid = Grid::filled(ends.runs.len(), picks.runs.len(), Crossing::default());
    for pick in 0..picks.runs.len() {
        for end in 0..ends.runs.len() {
            let u_mm = picks.place_mm(pick, ends.places_mm[end]);
            let w_mm = ends.place_mm(end, picks.places_mm[pick]);
            let thick = [
                weave.warp.thickness_um * ends.runs[end].thickness(u_mm),
                weave.weft.thickness_um * picks.runs[pick].thickness(w_mm),
            ];
            let apart = 0.5 * weave.compaction * (thick[0] + thick[1]);
            let share = weave.crimp_share + weave.tension_drift * tension.at(u_mm, w_mm);
            let share = share.clamp(0.0, 1.0);
            let is_warp_on_top = repeat.is_warp_on_top(end, pick);
            let side = if is_warp_on_top { 1.0 } else { -1.0 };
            let lift = weave.float_lift_um * float_height(repeat, end, pick);
            let plane = weave.pucker_um * pucker.at(u_mm, w_mm);
            let (warp_lift, weft_lift) = if is_warp_on_top {
                (lift, 0.0)
            } else {
                (0.0, lift)
            };
            grid.row_mut(pick)[end] = Crossing {
                u_mm,
                w_mm,
                warp_z_um: plane + side * share * apart + warp_lift,
                weft_z_um: plane - side * (1.0 - share) * apart + weft_lift,
            };
        }
    }
    grid
}

/// How far the float on top of a crossing bulges there, in lifts per crossing passed: a half sine
/// over the float, highest in its middle, 0 for a float of one.
fn float_height(repeat: &Repeat, end: usize, pick: usize) -> f64 {
    let is_warp = repeat.is_warp_on_top(end, pick);
    let n = if is_warp {
        repeat.n_picks()
    } else {
        repeat.n_ends()
    };
    let same = |steps: usize, forward: bool| {
        let step = if forward { steps } else { n * steps - steps };
        let (e, p) = if is_warp {
            (end, pick + step)
        } else {
            (end + step, pick)
        };
        repeat.is_warp_on_top(e, p) == is_warp
    };
    let reach = |forward: bool| (1..n).take_while(|&k| same(k, forward)).count();
    let (before, after) = (reach(false), reach(true));
    let length = (before + after + 1) as f64;
    (length - 1.0) * (std::f64::consts::PI * (before as f64 + 0.5) / length).sin()
}

/// The yarn through its crossings (place, height): cosine blends of height between them.
/// `axis` is the coordinate that runs along the yarn.
fn path(run: &YarnRun<'_>, line: &[([f64; 2], f64)], axis: usize) -> YarnPath {
    let mut nodes = Vec::with_capacity(line.len() * usize::from(PIECES));
    for pair in line.windows(2) {
        let ((from, low), (to, high)) = (pair[0], pair[1]);
        for k in 0..PIECES {
            let share = f64::from(k) / f64::from(PIECES);
            let rise = 0.5 - 0.5 * (std::f64::consts::PI * share).cos();
            let place = [0, 1].map(|c| from[c] + (to[c] - from[c]) * share);
            nodes.push(run.node(place, low + (high - low) * rise, place[axis]));
        }
    }
    if let Some(&(place, z_um)) = line.last() {
        nodes.push(run.node(place, z_um, place[axis]));
    }
    run.path(nodes)
}
