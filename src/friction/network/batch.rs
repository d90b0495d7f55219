//! Examples as tensors, and weights drawn from a seed.

use burn::module::{Module, ModuleMapper, Param};
use burn::tensor::{Device, Tensor, TensorData};

use selvedge_foundation::numerics::{Random, to_single};

/// Draws every weight from a generator of its own: matrices and kernels from a normal distribution
/// (Glorot & Bengio 2010), vectors become 0. The library's own draws hang on a generator that all
/// threads share.
struct Drawn(Random);

impl ModuleMapper for Drawn {
    fn map_float<const D: usize>(&mut self, param: Param<Tensor<D>>) -> Param<Tensor<D>> {
        param.map(|tensor| {
            let shape = tensor.dims();
            let n = shape.iter().product();
            if D == 1 {
                return tensor;
            }
            let kernel: usize = shape[2..].iter().product();
            let sd = (2.0 / ((shape[0] + shape[1]) * kernel) as f64).sqrt();
            let values: Vec<f32> = (0..n).map(|_| to_single(sd * self.0.normal())).collect();
            Tensor::from_data(TensorData::new(values, shape), &tensor.device()).require_grad()
        })
    }
}

/// A module with weights drawn from a seed.
pub fn drawn<M: Module>(module: M, seed: u64) -> M {
    module.map(&mut Drawn(Random::new(seed).branch("weights")))
}

/// A tensor of these values.
pub fn tensor<const D: usize>(values: Vec<f32>, shape: [usize; D], device: &Device) -> Tensor<D> {
    Tensor::from_data(TensorData::new(values, shape), device)
}
