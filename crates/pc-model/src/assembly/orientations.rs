//! Checks on bodies whose orientation is a matrix in redundant coordinates: the matrix must be a rotation at
//! the start, and along every motion from there.
//!
//! If there are as many coordinates as quasi-velocities, RᵀR has to be a multiple of 1 everywhere, which
//! `pc_mech` checks. Redundant coordinates, such as nine direction cosines, may give a rotation only on the
//! surface that contains the motion, a surface that is known from the start and from the operators X_s along
//! it.

use pc_algebra::Frame;
use pc_mech::Expr;

use crate::assembly::assembler::Assembler;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::diagnostics::source::Place;
use crate::document::Orientation;
use crate::names::stage::Stage;

/// The greatest relative deviation of RᵀR from a multiple of 1: far above the rounding error of numbers
/// written with all their digits, and too small to affect ω.
const OFF: f64 = 1e-10;

impl<'g> Assembler<'g, '_> {
    /// Checks that the matrices of bodies are rotations at the start, given by `values`, and remain rotations
    /// along the operators of the frame.
    pub(super) fn check_orientations(
        &mut self,
        frame: &Frame<'g>,
        values: &[(Expr<'g>, f64)],
    ) -> Result<(), ModelError> {
        let document = self.model.document();
        // Under constraints, some operators are not directions of motion.
        if frame.coordinates().len() <= frame.operators() || !document.constraints.is_empty() {
            return Ok(());
        }
        for body in &document.bodies {
            let Some(Orientation::Rotation(entries)) = &body.orientation else { continue };
            let rotation = self.resolved(entries, Stage::Position)?;
            let Ok(at_start) = self.graph.evaluate::<f64>(&products(&rotation), values) else { continue };
            let size = at_start[..3].iter().sum::<f64>() / 3.0;
            let body = body.name.text.clone();
            let fault = match (defect(&at_start), self.defect_along(frame, &rotation, values, size)) {
                (defect, _) if defect > OFF * size => MeaningError::NotARotationAtTheStart { body, defect },
                (_, Some(defect)) => MeaningError::NotARotationAlong { body, defect },
                (_, None) => continue,
            };
            let (first, last) = (entries[0].whole(), entries[8].whole());
            let place = Place { span: first.span.start..last.span.end, ..first };
            return Err(document.error(&place, fault));
        }
        Ok(())
    }

    /// The largest deviation of the derivatives of RᵀR along the operators of the frame, X_0 included, from
    /// multiples of 1, if it exceeds rounding error for an RᵀR of this size. Missing values are reported
    /// elsewhere.
    fn defect_along(
        &self,
        frame: &Frame<'g>,
        rotation: &[Expr<'g>; 9],
        values: &[(Expr<'g>, f64)],
        size: f64,
    ) -> Option<f64> {
        let x = frame.coordinates();
        let along = |s: Option<usize>| {
            let components: Vec<Expr<'g>> =
                (0..x.len()).map(|i| s.map_or(frame.b0()[i], |s| frame.b()[(i, s)])).collect();
            let mut direction: Vec<_> = x.iter().copied().zip(components.iter().copied()).collect();
            direction.extend(s.is_none().then(|| self.graph.in_time(frame.time())).into_iter().flatten());
            let rates = self.graph.directional(&products(rotation), &direction);
            let rates: Vec<f64> = self.graph.evaluate(&rates, values).ok()?;
            let components: Vec<f64> = self.graph.evaluate(&components, values).ok()?;
            let speed = components.iter().fold(1.0f64, |largest, component| largest.max(component.abs()));
            Some(defect(&rates)).filter(|defect| *defect > OFF * size * speed)
        };
        let defects = [None].into_iter().chain((0..frame.operators()).map(Some)).filter_map(along);
        defects.max_by(f64::total_cmp)
    }
}

/// The deviation of a symmetric matrix, given by its diagonal and then its other entries, from a multiple of
/// 1.
fn defect(matrix: &[f64]) -> f64 {
    let (diagonal, beside) = matrix.split_at(3);
    let mean = diagonal.iter().sum::<f64>() / 3.0;
    let misses = diagonal.iter().map(|entry| entry - mean).chain(beside.iter().copied());
    misses.fold(0.0, |largest, miss| largest.max(miss.abs()))
}

/// RᵀR: 11, 22, 33, 12, 13, 23.
fn products<'g>(rotation: &[Expr<'g>; 9]) -> Vec<Expr<'g>> {
    let product = |(i, j): (usize, usize)| {
        (0..3)
            .map(|row| rotation[3 * row + i] * rotation[3 * row + j])
            .fold(Expr::ZERO, |sum, term| sum + term)
    };
    [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(product).to_vec()
}
