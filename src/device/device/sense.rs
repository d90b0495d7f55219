//! What a device measures of itself.

/// What a device's sensors show, as STATUS tells it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sense {
    /// Temperature in 0.01 °C.
    pub temp_cdeg: i16,
    /// Supply current in mA.
    pub i_ma: u16,
    /// High voltage in thousandths of what was asked for.
    pub(crate) hv_per_mille: u16,
}

impl Default for Sense {
    /// 25 °C, no current, full voltage.
    fn default() -> Self {
        Self {
            temp_cdeg: 2500,
            i_ma: 0,
            hv_per_mille: 1000,
        }
    }
}

/// What amplifiers and contactors take, to be measured: a current in proportion to each code.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// Root mean square of a contactor's current for each code, `[40 Hz, 320 Hz]`, mA.
    pub(crate) ma_per_code: [f64; 2],
}

impl Load {
    /// The current of channels with these codes: their root mean squares over a tick added, mA.
    pub fn ma(&self, codes: impl Iterator<Item = [u16; 2]>) -> f64 {
        let of_channel = |code: [u16; 2]| {
            let [low, high] = [0, 1].map(|band| self.ma_per_code[band] * f64::from(code[band]));
            low.hypot(high)
        };
        codes.map(of_channel).sum()
    }
}
