//! Ways to spoil pictures of cloth, in steps.

use super::spoilt::Spoilt;
use crate::Effort;
use selvedge_chart::Scale;

/// A way to spoil pictures, in steps.
pub(super) struct Sweep {
    pub(super) name: &'static str,
    pub(super) label: &'static str,
    pub(super) scale: Scale,
    pub(super) values: Vec<f64>,
    pub(super) spoil: fn(&mut Spoilt, f64),
}

pub(super) fn sweeps(effort: Effort) -> Vec<Sweep> {
    let mut all = of_cloth(effort);
    all.extend(of_camera(effort));
    all
}

/// Values in quick and in full mode.
type Values<'a> = [&'a [f64]; 2];

impl Sweep {
    pub(super) fn new(
        [name, label]: [&'static str; 2],
        [quick, full]: Values<'_>,
        effort: Effort,
        spoil: fn(&mut Spoilt, f64),
    ) -> Self {
        Self {
            name,
            label,
            scale: Scale::Linear,
            values: effort.pick(quick, full).to_vec(),
            spoil,
        }
    }
}

/// What may be wrong with the cloth under the camera.
fn of_cloth(effort: Effort) -> Vec<Sweep> {
    vec![
        Sweep::new(
            ["turn", "turn of the threads, degrees"],
            [
                &[20.0],
                &[0.0, 2.0, 5.0, 10.0, 20.0, 30.0, 45.0, 60.0, 75.0, 88.0],
            ],
            effort,
            |spoilt, x| spoilt.turn_deg = Some(x),
        ),
        Sweep::new(
            ["bend", "amplitude of the waves that the cloth lies in, px"],
            [&[4.0], &[0.0, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0]],
            effort,
            |spoilt, x| spoilt.bend_px = x,
        ),
        Sweep::new(
            ["repeats", "side of the picture, in mean periods"],
            [&[3.0], &[1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0]],
            effort,
            |spoilt, x| spoilt.n_repeats = Some(x),
        ),
    ]
}

/// What may be wrong with camera, light and file.
fn of_camera(effort: Effort) -> Vec<Sweep> {
    vec![
        Sweep::new(
            ["noise", "signal over noise, dB"],
            [
                &[-12.0, 6.0],
                &[-18.0, -15.0, -12.0, -9.0, -6.0, -3.0, 0.0, 6.0, 12.0, 24.0],
            ],
            effort,
            |spoilt, x| spoilt.snr_db = x,
        ),
        Sweep::new(
            ["blur", "blur, px (standard deviation)"],
            [&[3.0], &[0.0, 0.7, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0]],
            effort,
            |spoilt, x| spoilt.blur_px = x,
        ),
        Sweep {
            scale: Scale::Log,
            ..Sweep::new(
                ["light", "brightest over darkest light"],
                [&[8.0], &[1.0, 1.5, 2.0, 4.0, 8.0, 16.0, 32.0]],
                effort,
                |spoilt, x| spoilt.light_ratio = x,
            )
        },
        Sweep {
            scale: Scale::Log,
            ..Sweep::new(
                ["compression", "quality of the JPEG"],
                [&[20.0], &[2.0, 5.0, 10.0, 20.0, 35.0, 50.0, 75.0, 95.0]],
                effort,
                |spoilt, x| spoilt.quality = Some(x),
            )
        },
    ]
}
