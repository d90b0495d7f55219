//! Ways to spoil pictures of cloth, in steps.

use super::spoilt::Spoilt;
use selvedge_chart::Scale;

/// A way to spoil pictures, in steps.
pub(super) struct Sweep {
    pub(super) name: &'static str,
    pub(super) label: &'static str,
    pub(super) scale: Scale,
    /// Values in quick and in full mode.
    pub(super) values: [&'static [f64]; 2],
    pub(super) spoil: fn(&mut Spoilt, f64),
}

/// What may be wrong with the cloth under the camera, then with camera, light and file.
pub(super) const SWEEPS: [Sweep; 7] = [
    Sweep {
        name: "turn",
        label: "turn of the threads, degrees",
        scale: Scale::Linear,
        values: [
            &[20.0],
            &[0.0, 2.0, 5.0, 10.0, 20.0, 30.0, 45.0, 60.0, 75.0, 88.0],
        ],
        spoil: |spoilt, x| spoilt.turn_deg = Some(x),
    },
    Sweep {
        name: "bend",
        label: "amplitude of the waves that the cloth lies in, px",
        scale: Scale::Linear,
        values: [&[4.0], &[0.0, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0]],
        spoil: |spoilt, x| spoilt.bend_px = x,
    },
    Sweep {
        name: "repeats",
        label: "side of the picture, in mean periods",
        scale: Scale::Linear,
        values: [&[3.0], &[1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0]],
        spoil: |spoilt, x| spoilt.n_repeats = Some(x),
    },
    Sweep {
        name: "noise",
        label: "signal over noise, dB",
        scale: Scale::Linear,
        values: [
            &[-12.0, 6.0],
            &[-18.0, -15.0, -12.0, -9.0, -6.0, -3.0, 0.0, 6.0, 12.0, 24.0],
        ],
        spoil: |spoilt, x| spoilt.snr_db = x,
    },
    Sweep {
        name: "blur",
        label: "blur, px (standard deviation)",
        scale: Scale::Linear,
        values: [&[3.0], &[0.0, 0.7, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0]],
        spoil: |spoilt, x| spoilt.blur_px = x,
    },
    Sweep {
        name: "light",
        label: "brightest over darkest light",
        scale: Scale::Log,
        values: [&[8.0], &[1.0, 1.5, 2.0, 4.0, 8.0, 16.0, 32.0]],
        spoil: |spoilt, x| spoilt.light_ratio = x,
    },
    Sweep {
        name: "compression",
        label: "quality of the JPEG",
        scale: Scale::Log,
        values: [&[20.0], &[2.0, 5.0, 10.0, 20.0, 35.0, 50.0, 75.0, 95.0]],
        spoil: |spoilt, x| spoilt.quality = Some(x),
    },
];
