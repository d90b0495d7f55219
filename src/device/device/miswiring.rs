//! How the contactors of an emulated device are connected, where not each to its own channel.

/// How contactors are connected. The default: each to its own channel.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Miswiring {
    /// Channels that move nothing.
    pub dead: Vec<u16>,
    /// Pairs of channels that move each other's contactor.
    pub swapped: Vec<[u16; 2]>,
}

impl Miswiring {
    /// The largest channel that is named.
    pub fn largest(&self) -> Option<usize> {
        let named = self.dead.iter().chain(self.swapped.iter().flatten());
        named.copied().map(usize::from).max()
    }

    /// Turns the codes of channels into those of the contactors that move.
    pub(super) fn connect(&self, codes: &mut [[u16; 2]]) {
        for &channel in &self.dead {
            if let Some(code) = codes.get_mut(usize::from(channel)) {
                *code = [0; 2];
            }
        }
        for &pair in &self.swapped {
            let [a, b] = pair.map(usize::from);
            if a.max(b) < codes.len() {
                codes.swap(a, b);
            }
        }
    }
}
