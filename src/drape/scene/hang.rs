//! How a scene becomes a cloth with its fingers.

use super::DrapeScene;
use crate::DrapeError;
use crate::cloth::{Cloth, Stepping};
use crate::finger::Finger;
use crate::integrator::Integrator;
use crate::mesh::Mesh;
use crate::sheet::Sheet;
use crate::system::System;

/// Widest spacing of a grid that is chosen, m.
const LIVE_SPACING_M: f64 = 8e-3;
/// What XPBD and projective dynamics leave out.
const UNTOUCHED: &str = "fingers touch nothing, and no force is told";

impl DrapeScene {
    pub(super) fn mesh(&self) -> Result<Mesh, DrapeError> {
        let size_m = self.size_mm.map(|mm| 1e-3 * mm);
        let spacing_m = self.fabric.spacing_m(LIVE_SPACING_M);
        let chosen = |side: usize| {
            let cells = (size_m[side] / spacing_m - 1e-9).ceil().clamp(1.0, 399.0);
            selvedge_foundation::numerics::to_index(cells) + 1
        };
        let n = self.grid.unwrap_or_else(|| [0, 1].map(chosen));
        Mesh::new(n, size_m, self.fabric.density_kg_per_m2, &self.pins)
    }

    /// The cloth and its fingers where they start, stepped as asked or as the scene says; with why.
    pub(crate) fn cloth(
        &self,
        integrator: Option<Integrator>,
        step_s: Option<f64>,
    ) -> Result<(Cloth, String), DrapeError> {
        let mesh = self.mesh()?;
        let n_vertices = mesh.n_vertices();
        let sheet = Sheet::new(mesh, &self.fabric, self.losses);
        // Under all its fingers: what is chosen is not to be refused once they touch.
        let contact = self.fingers.len() as f64 * Finger::STIFFNESS_PA_PER_M;
        let limit_s = sheet.limit_s(contact / self.fabric.density_kg_per_m2);
        let asked = integrator.unwrap_or(self.integrator);
        let (chosen, usual_s, why) = asked.chosen(n_vertices, limit_s);
        let step_s = step_s
            .or_else(|| self.step_ms.map(|ms| 1e-3 * ms))
            .unwrap_or(usual_s);
        DrapeError::within(("step", 1e3 * step_s, "ms"), [1e-3, 1e3])?;
        let why = match chosen {
            Integrator::Xpbd => {
                let softer = sheet.softening(step_s);
                format!("yarns act {softer:.3} times softer: {why}; {UNTOUCHED}")
            }
            Integrator::Projective => format!("{why}; {UNTOUCHED}"),
            _ => why,
        };
        let fingers = self.fingers.iter().enumerate().map(|(nth, spec)| {
            let form = (spec.side, spec.rotation_deg);
            let start = spec.target(spec.start_mm, spec.opening_mm);
            Finger::new(n_vertices + nth, form, &self.fabric, start)
        });
        let system = System::new(sheet, fingers.collect());
        Ok((Cloth::new(system, Stepping::new(chosen, step_s)), why))
    }
}
