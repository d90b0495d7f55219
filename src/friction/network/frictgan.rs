//! `FrictGAN` (Cai et al. 2021), built anew from the paper and its authors' description, at a
//! quarter and less of its size.
//!
//! What differs from the authors' code:
//! - pictures have 512 × 512 pixels of 1/12.8 mm where theirs have 1024 × 1024 of 1/11.81 mm, and
//!   picture and trace stay registered, where theirs slide apart by a factor of two;
//! - the encoder has seven layers of 4 to 64 channels where theirs has eight of 32 to 512; the
//!   decoder 64 to 4 where theirs has 512 to 32, the layer after the noise 64 where theirs has 512;
//! - the decoder widens by a frame after its stages of 32, 64 and 128 bins, theirs after those of
//!   16, 32 and 64, and its kernels are 4 × 4 and 4 × 3 where theirs are 4 × 4 and 3 × 3;
//! - answers start from the mean magnitude of each bin (theirs has to find that the mean is 108),
//!   with no rectifier at the end while it learns: what is below 0 is cut off when it is asked;
//! - the critic has 16 to 128 channels where theirs has 64 to 512, and halves frames once where
//!   theirs halves them twice (bins three times both), with smaller kernels;
//! - the critic's five steps are on one batch, whose pictures are encoded once;
//! - the rate of learning is ten times theirs and falls to a hundredth by half a cosine, over the
//!   four rounds that ten minutes have room for, where theirs stays the same for 200;
//! - when it is asked, batch statistics are those of training, nothing is dropped and the noise is
//!   0, where theirs goes on as in training;
//! - Griffin and Lim begin with a constant's phases and no absolute value is taken at the end.

use burn::module::Module;
use burn::nn::conv::{Conv2d, Conv2dConfig, ConvTranspose2d, ConvTranspose2dConfig};
use burn::nn::{BatchNorm, BatchNormConfig, Linear, LinearConfig, PaddingConfig2d};
use burn::tensor::activation::relu;
use burn::tensor::ops::PadMode;
use burn::tensor::{Device, Tensor};

use selvedge_foundation::numerics::Grid;

use crate::signal::N_BINS;

/// Pixels of a picture's side.
pub(super) const SIDE: usize = 512;
/// Numbers of noise.
pub(super) const N_NOISE: usize = 50;
/// Strides of the encoder: 512 → 256 → 128 → 64 → 32 → 8 → 2 → 1.
const STRIDES: [usize; 7] = [2, 2, 2, 2, 4, 4, 2];
/// Channels of the encoder.
const CHANNELS: [usize; 7] = [4, 8, 16, 32, 64, 64, 64];
/// Heights (bins) of the decoder's stages, from 1, and their channels.
const STAGES: [(usize, usize); 8] = [
    (2, 64),
    (4, 64),
    (8, 64),
    (16, 32),
    (32, 16),
    (64, 8),
    (128, 4),
    (256, 4),
];
/// Stages whose outputs are dropped by half.
const N_DROPPED: usize = 3;

/// The generator.
#[derive(Module, Debug)]
pub(super) struct Generator {
    encoder: Vec<Conv2d>,
    encoder_norms: Vec<BatchNorm>,
    dense: Linear,
    mixed: Linear,
    decoder: Vec<ConvTranspose2d>,
    decoder_norms: Vec<BatchNorm>,
    widened: Vec<Conv2d>,
    last: Conv2d,
}

/// What the encoder makes of pictures.
pub(super) struct Seen {
    /// Of every layer, for the decoder's stages that see them.
    maps: Vec<Tensor<4>>,
    latent: Tensor<2>,
}

/// Frames after each stage, so that the last has as many as are asked for: doubled as long as that
/// is not too many, then one more each time.
fn frames(n_frames: usize) -> [usize; STAGES.len()] {
    let mut now = 1;
    let n_doubled = n_frames.ilog2() as usize;
    std::array::from_fn(|stage| {
        if stage < n_doubled {
            now *= 2;
        } else {
            now = (now + usize::from(stage > n_doubled)).min(n_frames);
        }
        now
    })
}

impl Generator {
    pub(super) fn new(n_frames: usize, device: &Device) -> Self {
        let one = PaddingConfig2d::Explicit(1, 1, 1, 1);
        let encoder = CHANNELS.iter().enumerate().map(|(n, &to)| {
            let from = n.checked_sub(1).map_or(1, |n| CHANNELS[n]);
            let config = Conv2dConfig::new([from, to], [3, 3]).with_bias(false);
            config
                .with_stride([STRIDES[n]; 2])
                .with_padding(one.clone())
                .init(device)
        });
        let wide = frames(n_frames);
        let (mut decoder, mut widened) = (Vec::new(), Vec::new());
        let mut before = (64, 1);
        for (stage, &(_, to)) in STAGES.iter().enumerate() {
            let is_doubled = wide[stage] == 2 * before.1;
            let stride = [2, if is_doubled { 2 } else { 1 }];
            let (kernel, padding) = if is_doubled {
                ([4, 4], [1, 1])
            } else {
                ([4, 3], [1, 1])
            };
            let from = before.0 + Self::n_skipped(stage);
            let config = ConvTranspose2dConfig::new([from, to], kernel).with_stride(stride);
            decoder.push(config.with_padding(padding).init(device));
            if !is_doubled && wide[stage] > before.1 {
                widened.push(Conv2dConfig::new([to, to], [7, 7]).init(device));
            }
            before = (to, wide[stage]);
        }
        let norm = |n: usize| BatchNormConfig::new(n).init(device);
        Self {
            encoder: encoder.collect(),
            encoder_norms: CHANNELS[1..].iter().map(|&n| norm(n)).collect(),
            dense: LinearConfig::new(64, 128).init(device),
            mixed: LinearConfig::new(128 + N_NOISE, 64).init(device),
            decoder,
            decoder_norms: STAGES.iter().map(|&(_, n)| norm(n)).collect(),
            widened,
            last: Conv2dConfig::new([4, 1], [8, 7]).init(device),
        }
    }

    /// Channels of the encoder's map that a stage sees besides the stage before: those whose
    /// height is the stage's own input.
    fn n_skipped(stage: usize) -> usize {
        Self::skipped(stage).map_or(0, |layer| CHANNELS[layer])
    }

    /// The layer of the encoder whose map is as high as the input of a stage.
    fn skipped(stage: usize) -> Option<usize> {
        let height = STAGES[stage.checked_sub(1)?].0;
        let mut side = SIDE;
        STRIDES.iter().position(|stride| {
            side /= stride;
            side == height
        })
    }

    /// What is seen in pictures (example × 1 × side × side, −1 to 1): the same whatever the noise.
    pub(super) fn encode(&self, pictures: Tensor<4>) -> Seen {
        let n = pictures.dims()[0];
        let mut maps = Vec::with_capacity(self.encoder.len());
        let mut x = pictures;
        for (layer, conv) in self.encoder.iter().enumerate() {
            x = conv.forward(x);
            if let Some(norm) = layer.checked_sub(1).map(|layer| &self.encoder_norms[layer]) {
                x = norm.forward(x);
            }
            x = relu(x);
            maps.push(x.clone());
        }
        let latent = self.dense.forward(x.reshape([n, 64]));
        Seen { maps, latent }
    }

    /// Magnitudes of example × 1 × bin × frame above the mean, from what is seen and noise; `masks`
    /// says what is dropped while learning.
    pub(super) fn decode(
        &self,
        seen: &Seen,
        noise: Tensor<2>,
        masks: Option<&[Tensor<4>; N_DROPPED]>,
    ) -> Tensor<4> {
        let n = noise.dims()[0];
        let mixed = Tensor::cat(vec![seen.latent.clone(), noise], 1);
        let mixed = self.mixed.forward(mixed);
        let mut x: Tensor<4> = mixed.reshape([n, 64, 1, 1]);
        let mut widened = self.widened.iter();
        for (stage, conv) in self.decoder.iter().enumerate() {
            let before = x.dims()[3];
            if let Some(layer) = Self::skipped(stage) {
                x = Tensor::cat(vec![x, middle(seen.maps[layer].clone(), before)], 1);
            }
            x = conv.forward(x);
            x = self.decoder_norms[stage].forward(x);
            if let Some(mask) = masks.and_then(|masks| masks.get(stage)) {
                x = x * mask.clone();
            }
            x = relu(x);
            let is_wider = self.wide(stage, before);
            if let Some(conv) = is_wider.then(|| widened.next()).flatten() {
                // One frame more: rows 3 + 3, columns 3 + 4.
                x = relu(conv.forward(reflected(x, [3, 3, 3, 4])));
            }
        }
        // One bin more: rows 4 + 4 under a kernel of 8.
        self.last.forward(reflected(x, [4, 4, 3, 3]))
    }

    /// Whether a stage adds a frame by its own convolution.
    fn wide(&self, stage: usize, before: usize) -> bool {
        let n_adding = self.widened.len();
        let n_doubled = self
            .decoder
            .iter()
            .filter(|conv| conv.stride[1] == 2)
            .count();
        stage > n_doubled && stage <= n_doubled + n_adding && before > 1
    }

    /// Brings what was learnt of batches into the running means, which take it up lazily.
    pub(super) fn settle(&self) {
        for norm in self.encoder_norms.iter().chain(&self.decoder_norms) {
            norm.running_mean.value_sync();
            norm.running_var.value_sync();
        }
    }

    /// Shapes of what is dropped, for a batch.
    pub(super) fn masks_of(n: usize, n_frames: usize) -> [[usize; 4]; N_DROPPED] {
        let wide = frames(n_frames);
        std::array::from_fn(|stage| [n, STAGES[stage].1, STAGES[stage].0, wide[stage]])
    }
}

/// The columns in the middle of a map.
fn middle(map: Tensor<4>, n_columns: usize) -> Tensor<4> {
    let width = map.dims()[3];
    map.narrow(3, (width - n_columns.min(width)) / 2, n_columns.min(width))
}

/// A map mirrored outwards: rows above and below, columns left and right. Where it is too small to
/// be mirrored, its edge goes on.
fn reflected(map: Tensor<4>, [above, below, left, right]: [usize; 4]) -> Tensor<4> {
    let [_, _, height, width] = map.dims();
    let is_small = height <= above.max(below) || width <= left.max(right);
    let mode = if is_small {
        PadMode::Edge
    } else {
        PadMode::Reflect
    };
    map.pad([(above, below), (left, right)], mode)
}

/// The middle of a picture as the critic sees it: bins × frames of pixels, whatever they show.
pub(super) fn critic_crop(picture: &Grid<f32>, n_frames: usize) -> Vec<f32> {
    let [left, top] = [(SIDE - n_frames) / 2, (SIDE - N_BINS) / 2];
    (top..top + N_BINS)
        .flat_map(|row| picture.row(row)[left..left + n_frames].to_vec())
        .collect()
}
