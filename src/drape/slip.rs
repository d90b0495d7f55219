//! Hysteresis: beside a spring, an element that follows until its friction is reached, then slips.
//!
//! In a step its energy is Huber's, which is convex; what it lost is taken when the step is done.

/// Slip elements of one kind: a value each (strain, angle, curvature), where each is at rest.
#[derive(Debug, Clone, Default)]
pub(crate) struct SlipElements {
    rests: Vec<f64>,
}

/// What an element answers: the energy that it stores, what its slipping adds to that in a step's
/// function, its force and its tangent.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SlipForce {
    pub(crate) stored: f64,
    pub(crate) lost: f64,
    pub(crate) force: f64,
    pub(crate) tangent: f64,
}

/// Stiffness and friction of an element.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SlipLaw {
    pub(crate) stiffness: f64,
    pub(crate) friction: f64,
}

impl SlipLaw {
    /// Reaches its friction after so much of its value.
    pub(crate) fn reached_in(friction: f64, value: f64) -> Self {
        Self {
            stiffness: friction / value,
            friction,
        }
    }

    #[inline]
    fn at(self, off: f64) -> SlipForce {
        let force = self.stiffness * off;
        if force.abs() <= self.friction {
            return SlipForce {
                stored: 0.5 * force * off,
                lost: 0.0,
                force,
                tangent: self.stiffness,
            };
        }
        let reach = self.friction / self.stiffness;
        SlipForce {
            stored: 0.5 * self.friction * reach,
            lost: self.friction * (off.abs() - reach),
            force: self.friction.copysign(off),
            tangent: 0.0,
        }
    }
}

impl SlipElements {
    /// So many, at rest at 0.
    pub(crate) fn new(n: usize) -> Self {
        Self {
            rests: vec![0.0; n],
        }
    }

    /// What the element `index` answers to a value; nothing where there are none.
    #[inline]
    pub(crate) fn at(&self, index: usize, value: f64, law: SlipLaw) -> SlipForce {
        match self.rests.get(index) {
            Some(rest) if law.friction > 0.0 => law.at(value - rest),
            _ => SlipForce::default(),
        }
    }

    /// Lets an element slip to where its friction holds it.
    pub(crate) fn settle(&mut self, index: usize, value: f64, law: SlipLaw) {
        if let Some(rest) = self.rests.get_mut(index)
            && law.friction > 0.0
        {
            let reach = law.friction / law.stiffness;
            *rest = rest.clamp(value - reach, value + reach);
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.rests.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_closed_loop_is_twice_the_friction_wide() {
        let law = SlipLaw::reached_in(2.0, 0.1);
        let mut elements = SlipElements::new(1);
        let mut lost = 0.0;
        let mut at_zero = Vec::new();
        for step in 0..400 {
            let value = (std::f64::consts::TAU * f64::from(step) / 200.0).sin();
            let answer = elements.at(0, value, law);
            lost += answer.lost;
            if value.abs() < 1e-3 && step > 50 {
                at_zero.push(answer.force);
            }
            elements.settle(0, value, law);
        }
        assert_eq!(at_zero, [-2.0, 2.0, -2.0], "there and back");
        // f times the way slipped: two turns of 4 less the reaches where it turns round, the first
        // of which begins at rest.
        assert!((lost - 2.0 * (8.0 - 0.1 - 4.0 * 0.2)).abs() < 0.1, "{lost}");
    }
}
