//! Least squares on the full reflectance: the heights that make `Σ (E/a − R)² + λ Σ (∇²z)²` least,
//! by Gauss–Newton from the linear inversion on.
//!
//! Slopes are central differences, so that no direction is preferred. Every step is solved by
//! conjugate gradients, preconditioned by the transform of the mean problem; it is halved until it
//! lowers the sum. Coarse tiles come first, and λ begins high and falls to what was asked for:
//! broad forms are found first, which keeps steep weaves out of wrong valleys and is cheap. The
//! albedo is fitted between steps. A tile is done when a step hardly lowers the sum any more.
//!
//! Pictures of one surface under several lights are summed over, and each point has an albedo of
//! its own: the one that fits it best, drawn towards that of all by [`EVEN`].

use super::coarse::{resampled, sizes};
use super::error::ShadingError;
use super::reflectance::{
    Lambert, across, across_row, along, along_row, laplacian, laplacian_row, residual, residual_of,
};
use super::shape::{EVEN, Found, ShadingOptions};
use super::tangent::{Normal, Tangent, add, dot, down, mean_problem, product, squares};
use super::{View, linear};
use selvedge_foundation::numerics::{Complex, Grid, PlaneTransform};
use selvedge_foundation::progress::Progress;

/// Weight of squared curvature unless stated, and at first.
const SMOOTHNESS: f64 = 1e-3;
const FIRST_SMOOTHNESS: f64 = 0.3;
/// The same where a coarser tile was solved before.
const NEXT_SMOOTHNESS: f64 = 0.1;
/// Iterations over which the weight falls, first and where a coarser tile was solved before.
const FALLING: [usize; 2] = [11, 3];
/// A step that lowers the sum by less than this share is the last one.
const MIN_GAIN: f64 = 0.03;
/// Weight of squared heights: keeps what the light does not show near 0.
const TIKHONOV: f64 = 1e-7;
/// Damping of a step, at first, and its limits.
const DAMPING: [f64; 3] = [1e-7, 1e-3, 1e3];
/// Rounds of conjugate gradients, and the share of the first residual (squared) that ends them.
const N_INNER: usize = 20;
const INNER_END: f64 = 0.01;
/// A step is halved so often at most.
const N_HALVINGS: usize = 10;

/// A picture of the surface.
struct Seen {
    /// Brightness, over each point's share of the albedo.
    target: Grid<f64>,
    matt: Lambert,
}

/// One surface that is being fitted.
struct Fit {
    seen: Vec<Seen>,
    /// Brightness itself, where there are several pictures and so shares of the albedo.
    brightness: Vec<Grid<f64>>,
    transform: PlaneTransform,
    albedo: f64,
    smoothness: f64,
    damping: f64,
    z: Grid<f64>,
    /// Rounds of conjugate gradients so far.
    n_rounds: usize,
}

/// How the weight of curvature falls over the iterations on one tile.
struct Falling {
    first: f64,
    last: f64,
    n: usize,
}

impl Falling {
    /// `share`: a pixel of the whole tile in pixels of this one. Curvature in pixels grows as
    /// they do, so that its weight is less on coarse tiles.
    fn of(options: &ShadingOptions, share: f64, is_first: bool) -> Self {
        let last = options.regulariser.unwrap_or(SMOOTHNESS);
        let [n_first, n_next] = FALLING;
        let (first, n) = if is_first {
            (FIRST_SMOOTHNESS, n_first)
        } else {
            (NEXT_SMOOTHNESS, n_next)
        };
        Self {
            first: first.max(last) * share * share,
            last: last * share * share,
            n: n.min(options.n_iterations() - 1),
        }
    }

    fn at(&self, done: usize) -> f64 {
        if done >= self.n {
            return self.last;
        }
        let share = done as f64 / self.n as f64;
        self.first * (self.last / self.first).powf(share)
    }
}

pub(super) fn solve(
    views: &[View<'_>],
    options: &ShadingOptions,
    progress: &mut Progress<'_>,
) -> Result<Found, ShadingError> {
    let &(brightness, light) = views.first().ok_or(ShadingError::Empty)?;
    let sizes = sizes(brightness.width(), brightness.height());
    let n_points = |[width, height]: [usize; 2]| (width * height) as f64;
    let whole: f64 = sizes.iter().copied().map(n_points).sum();
    let albedo = options.albedo_for(brightness, light);
    let flat = Grid::filled(brightness.width(), brightness.height(), 0.0);
    let first = residual_of(views, albedo, &flat);
    let mut found = Found {
        height_px: flat,
        albedo,
        residuals: Vec::new(),
        n_rounds: 0,
    };
    let (mut is_first, mut done, mut damping) = (true, 0.0, DAMPING[1]);
    for size in sizes {
        let coarse: Vec<Grid<f64>> = views.iter().map(|(e, _)| resampled(e, size)).collect();
        let z = if is_first {
            let lights = views.iter().map(|view| view.1);
            let coarse: Vec<View<'_>> = coarse.iter().zip(lights).collect();
            linear::heights(&coarse, options)
        } else {
            finer(&found.height_px, size)
        };
        let brightnesses = if views.len() > 1 {
            coarse.clone()
        } else {
            Vec::new()
        };
        let mut fit = Fit {
            brightness: brightnesses,
            seen: coarse.into_iter().zip(views).map(Seen::of).collect(),
            transform: PlaneTransform::new(size[0], size[1]),
            albedo: found.albedo,
            smoothness: 0.0,
            damping,
            z,
            n_rounds: 0,
        };
        let share = size[0] as f64 / brightness.width() as f64;
        let falling = Falling::of(options, share, is_first);
        let part = [done / whole, n_points(size) / whole];
        let residuals = fit.run(&falling, options, part, progress)?;
        is_first = false;
        done += n_points(size);
        damping = fit.damping;
        // In rounds on the whole tile.
        let rounds = (fit.n_rounds * size[0] * size[1]).div_ceil(brightness.values().len());
        found = Found {
            height_px: fit.z,
            albedo: fit.albedo,
            residuals,
            n_rounds: found.n_rounds + rounds,
        };
    }
    found.residuals.insert(0, first);
    Ok(found)
}

/// Heights of a coarse tile as those of a finer one, whose pixels are smaller.
fn finer(coarse: &Grid<f64>, size: [usize; 2]) -> Grid<f64> {
    let factor = size[0] as f64 / coarse.width() as f64;
    resampled(coarse, size).map(|z| z * factor)
}

impl Seen {
    fn of((target, (_, light)): (Grid<f64>, &View<'_>)) -> Self {
        Self {
            target,
            matt: Lambert::under(*light),
        }
    }
}

impl Fit {
    /// Steps until they hardly help; hands back the residual after each. `part`: where in the
    /// whole work it begins and what share it is.
    fn run(
        &mut self,
        falling: &Falling,
        options: &ShadingOptions,
        part: [f64; 2],
        progress: &mut Progress<'_>,
    ) -> Result<Vec<f64>, ShadingError> {
        let n = options.n_iterations();
        let mut residuals = Vec::new();
        for done in 0..n {
            let share = part[0] + part[1] * done as f64 / n as f64;
            progress.step(share, "fitting heights")?;
            self.smoothness = falling.at(done);
            if options.albedo.is_none() {
                self.fit_albedo();
            }
            let before = self.cost(&self.z);
            let after = self.step(before, progress, share)?;
            residuals.push(self.residual());
            let is_settled = after >= before * (1.0 - MIN_GAIN);
            if done > falling.n && is_settled {
                break;
            }
        }
        Ok(residuals)
    }

    /// The mean of |E/a − R|.
    fn residual(&self) -> f64 {
        let (p, q) = (along(&self.z), across(&self.z));
        let of = |seen: &Seen| residual(&seen.target, self.albedo, [&p, &q], seen.matt);
        self.seen.iter().map(of).sum::<f64>() / self.seen.len() as f64
    }

    /// The albedo that fits the surface as it is best; as before if all of it is dark. With several
    /// pictures, that of each point then.
    fn fit_albedo(&mut self) {
        let (p, q) = (along(&self.z), across(&self.z));
        let slopes = || p.values().iter().zip(q.values());
        let mut sums = (0.0, 0.0);
        for seen in &self.seen {
            let pairs = seen.target.values().iter().zip(slopes());
            sums = pairs.fold(sums, |(er, rr), (e, (p, q))| {
                let bright = seen.matt.of(*p, *q).max(0.0);
                (er + e * bright, rr + bright * bright)
            });
        }
        if sums.0 > 0.0 && sums.1 > 0.0 {
            self.albedo = sums.0 / sums.1;
        }
        if self.brightness.is_empty() {
            return;
        }
        for (i, (p, q)) in slopes().enumerate() {
            let pairs = self.seen.iter().zip(&self.brightness);
            let (er, rr) = pairs.fold((EVEN, EVEN), |(er, rr), (seen, brightness)| {
                let bright = seen.matt.of(*p, *q).max(0.0);
                let e = brightness.values()[i] / self.albedo;
                (er + e * bright, rr + bright * bright)
            });
            for (seen, brightness) in self.seen.iter_mut().zip(&self.brightness) {
                seen.target.values_mut()[i] = brightness.values()[i] * rr / er;
            }
        }
    }

    /// What is made least.
    fn cost(&self, z: &Grid<f64>) -> f64 {
        let [mut p, mut q, mut bent, mut off] = [(); 4].map(|()| vec![0.0; z.width()]);
        let (mut misfit, mut curved) = (0.0, 0.0);
        for row in 0..z.height() {
            along_row(z, row, &mut p);
            across_row(z, row, &mut q);
            laplacian_row(z, row, &mut bent);
            for seen in &self.seen {
                let slopes = p.iter().zip(&q);
                let pairs = seen.target.row(row).iter().zip(slopes);
                for (off, (e, (p, q))) in off.iter_mut().zip(pairs) {
                    *off = e / self.albedo - seen.matt.of(*p, *q).max(0.0);
                }
                misfit += product(&off, &off);
            }
            curved += product(&bent, &bent);
        }
        misfit + self.smoothness * curved + TIKHONOV * squares(z)
    }

    /// One Gauss–Newton step, halved until it lowers the cost, which is handed back; none if
    /// nothing does.
    fn step(
        &mut self,
        before: f64,
        progress: &mut Progress<'_>,
        share: f64,
    ) -> Result<f64, ShadingError> {
        let about = |seen: &Seen| Tangent::of(&seen.target, self.albedo, (&self.z, seen.matt));
        let tangents: Vec<Tangent> = self.seen.iter().map(about).collect();
        let mut down = down(&tangents, [self.z.width(), self.z.height()]);
        let bent = laplacian(&laplacian(&self.z));
        add(&mut down, -self.smoothness, &bent);
        add(&mut down, -TIKHONOV, &self.z);
        let way = self.solved(&tangents, down, progress, share)?;
        let mut length = 1.0;
        for _ in 0..N_HALVINGS {
            let mut z = self.z.clone();
            add(&mut z, length, &way);
            let after = self.cost(&z);
            if after < before {
                self.z = z;
                if length >= 1.0 {
                    self.damping = (self.damping / 3.0).max(DAMPING[0]);
                }
                return Ok(after);
            }
            length *= 0.5;
        }
        self.damping = (10.0 * self.damping).min(DAMPING[2]);
        Ok(before)
    }

    /// `(JᵀJ + λ∇⁴ + μ) x = right` by conjugate gradients.
    fn solved(
        &mut self,
        tangents: &[Tangent],
        mut right: Grid<f64>,
        progress: &mut Progress<'_>,
        share: f64,
    ) -> Result<Grid<f64>, ShadingError> {
        let shift = TIKHONOV + self.damping;
        let inverse = mean_problem(tangents, self.smoothness, shift);
        let mut normal = Normal::of(tangents, [self.smoothness, shift], &right);
        let (width, height) = (right.width(), right.height());
        let [mut x, mut y] = [(); 2].map(|()| Grid::filled(width, height, 0.0));
        let mut waves = inverse.map(|_| Complex::default());
        self.divided(&right, &inverse, (&mut waves, &mut y));
        let mut way = y.clone();
        let first = dot(&right, &y);
        let mut now = first;
        for _ in 0..N_INNER {
            if now <= INNER_END * first || now <= f64::MIN_POSITIVE {
                break;
            }
            progress.step(share, "fitting heights")?;
            self.n_rounds += 1;
            let image = normal.times(&way);
            let length = now / dot(&way, image);
            if !length.is_finite() {
                break;
            }
            add(&mut x, length, &way);
            add(&mut right, -length, image);
            self.divided(&right, &inverse, (&mut waves, &mut y));
            let next = dot(&right, &y);
            let keep = next / now;
            for (w, y) in way.values_mut().iter_mut().zip(y.values()) {
                *w = y + keep * *w;
            }
            now = next;
        }
        Ok(x)
    }

    /// Divided by the transform of the mean problem, of which the inverse is given.
    fn divided(
        &self,
        right: &Grid<f64>,
        inverse: &Grid<f64>,
        (waves, into): (&mut Grid<Complex>, &mut Grid<f64>),
    ) {
        self.transform.forward_into(right, waves);
        for (f, weight) in waves.values_mut().iter_mut().zip(inverse.values()) {
            *f *= *weight;
        }
        self.transform.inverse_into(waves, into);
    }
}
