//! Weights of a module as plain numbers: drawn from a seed, put into a file, taken from one.

use burn::module::{Module, ModuleMapper, ModuleVisitor, Param};
use burn::tensor::{Device, Tensor, TensorData};

use selvedge_foundation::numerics::{Random, to_single};

use crate::FrictionError;

/// How a file of weights begins.
const MAGIC: [u8; 8] = *b"SLVFRIC1";

/// What a network is, apart from its layers: how its input is scaled, and its weights, in the
/// order of its fields.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Weights {
    /// How input and output are scaled.
    pub scales: Vec<f32>,
    /// The weights.
    pub values: Vec<f32>,
}

impl Weights {
    /// As a file: a mark, both counts, all numbers, little-endian.
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX).to_le_bytes();
        let mut bytes = MAGIC.to_vec();
        bytes.extend(count(self.scales.len()));
        bytes.extend(count(self.values.len()));
        bytes.extend(
            self.scales
                .iter()
                .chain(&self.values)
                .flat_map(|x| x.to_le_bytes()),
        );
        bytes
    }

    /// From a file.
    ///
    /// # Errors
    /// Another kind of file, one that is cut short, numbers that are not finite.
    pub(crate) fn from_bytes(bytes: &[u8]) -> Result<Self, FrictionError> {
        let wrong = |what: &str| FrictionError::Weights {
            what: what.to_owned(),
        };
        let (head, numbers) = bytes
            .split_at_checked(16)
            .ok_or_else(|| wrong("it is too short"))?;
        if head[..8] != MAGIC {
            return Err(wrong("it does not begin as one"));
        }
        let count = |at: usize| {
            let bytes = [head[at], head[at + 1], head[at + 2], head[at + 3]];
            u32::from_le_bytes(bytes) as usize
        };
        let (n_scales, n_values) = (count(8), count(12));
        let (numbers, rest) = numbers.as_chunks::<4>();
        if !rest.is_empty() || numbers.len() != n_scales.saturating_add(n_values) {
            return Err(wrong("it is cut short"));
        }
        let mut scales: Vec<f32> = numbers.iter().map(|b| f32::from_le_bytes(*b)).collect();
        if !scales.iter().all(|x| x.is_finite()) {
            return Err(wrong("it holds numbers that are none"));
        }
        let values = scales.split_off(n_scales);
        Ok(Self { scales, values })
    }
}

/// Draws matrices and kernels from a normal distribution (Glorot & Bengio 2010). Vectors that the
/// library drew, biases, become 0; those that are the same throughout, of normalisations (never of
/// one channel), stay.
///
/// The library's own draws hang on a generator that all threads share.
struct Drawn(Random);

impl ModuleMapper for Drawn {
    fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
        param.map(|old| {
            let shape = old.dims();
            if D == 1 {
                let drawn = values(old.clone());
                let is_same =
                    drawn.len() > 1 && drawn.iter().all(|x| x.total_cmp(&drawn[0]).is_eq());
                return if is_same {
                    old
                } else {
                    put(vec![0.0; drawn.len()], &old)
                };
            }
            let kernel: usize = shape[2..].iter().product();
            let sd = (2.0 / ((shape[0] + shape[1]) * kernel) as f64).sqrt();
            let n = shape.iter().product();
            put(
                (0..n).map(|_| to_single(sd * self.0.normal())).collect(),
                &old,
            )
        })
    }
}

/// Reads weights in order.
#[derive(Default)]
struct Read(Vec<f32>);

impl ModuleVisitor for Read {
    fn visit_float<const D: usize>(&mut self, param: &Param<Tensor<D>>) {
        self.0.extend(values(param.val()));
    }
}

/// Writes weights in order.
struct Written<'a>(std::slice::Iter<'a, f32>);

impl ModuleMapper for Written<'_> {
    fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
        param.map(|old| {
            let n = old.dims().iter().product();
            let mut values: Vec<f32> = self.0.by_ref().take(n).copied().collect();
            values.resize(n, 0.0);
            put(values, &old)
        })
    }
}

/// Values in place of others, learnt if those are.
fn put<const D: usize>(values: Vec<f32>, old: &Tensor<D>) -> Tensor<D> {
    tensor(values, old.dims(), &old.device()).set_require_grad(old.is_require_grad())
}

/// A module with biases of 0 and weights drawn from a seed.
pub(super) fn drawn<M: Module>(module: M, seed: u64) -> M {
    module.map(&mut Drawn(Random::new(seed).branch("weights")))
}

/// The weights of a module.
pub(super) fn read<M: Module>(module: &M) -> Vec<f32> {
    let mut read = Read::default();
    module.visit(&mut read);
    read.0
}

/// A module with these weights; what is missing becomes 0.
pub(super) fn filled<M: Module>(module: M, values: &[f32]) -> M {
    module.map(&mut Written(values.iter()))
}

/// A tensor of these values.
pub(super) fn tensor<const D: usize>(
    values: Vec<f32>,
    shape: [usize; D],
    device: &Device,
) -> Tensor<D> {
    Tensor::from_data(TensorData::new(values, shape), device)
}

/// The values of a tensor, row by row; none if they are not of single precision.
pub(super) fn values<const D: usize>(tensor: Tensor<D>) -> Vec<f32> {
    tensor.into_data().try_into_vec().unwrap_or_default()
}
