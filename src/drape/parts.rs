//! The parts of a step, one by one, so that a study can tell what each costs.

use super::cloth::Cloth;
use super::mesh::Vector;
use super::run::Drape;
use super::system::System;

/// Of what an implicit step is made, where a cloth is now. Nothing moves.
#[derive(Debug)]
pub struct StepParts {
    cloth: Cloth,
    p: Vec<Vector>,
    out: Vec<Vector>,
}

impl Drape {
    /// The parts of its next step.
    pub fn parts(&self) -> StepParts {
        let mut cloth = self.cloth.clone();
        cloth.prepare(2);
        let (p, out) = (cloth.v.clone(), cloth.x.clone());
        let mut parts = StepParts { cloth, p, out };
        parts.gradient();
        parts.lines();
        parts
    }

    /// Lets a step take so many Newton steps at most: 1 is what is left where time is short.
    pub fn bound_newton(&mut self, max_steps: u32) {
        self.cloth.stepping.max_steps = max_steps;
    }
}

impl StepParts {
    /// Energy and forces of the cloth, with tangents.
    pub fn gradient(&mut self) {
        let Self { cloth, out, .. } = self;
        cloth.system.evaluate_cloth(&cloth.x, out);
    }

    /// The product of its tangent with a motion.
    pub fn product(&mut self) {
        self.cloth.system.product(&self.p, &mut self.out);
    }

    /// The lines of yarn, factored.
    pub fn lines(&mut self) {
        let Cloth {
            system, newton, x, ..
        } = &mut self.cloth;
        system.precondition(x, &mut newton.lines);
    }

    /// The same, solved.
    pub fn line(&mut self) {
        self.cloth.newton.lines.apply(&self.p, &mut self.out);
    }

    /// What fingers touch, and their forces: so many points press.
    pub fn contact(&mut self) -> usize {
        let Self { cloth, out, .. } = self;
        let System { sheet, fingers, .. } = &mut cloth.system;
        for finger in &mut *fingers {
            finger.look(&sheet.mesh, &cloth.x);
            finger.evaluate(&cloth.x, out);
        }
        let points = fingers.iter().flat_map(|finger| &finger.points);
        points.filter(|point| point.pressure_pa > 0.0).count()
    }
}
