//! The vector field that is integrated.

use pc_expr::Method;
use pc_mech::{Failure, ForcedMotion, MachineCode, MechError, Motion, VectorField};

use crate::machinery::controller::Controller;

/// The vector field of the equations of motion, with or without forces that a function of the program computes.
#[derive(Clone)]
pub(crate) enum MotionField {
    Free(Box<Motion>),
    Forced(Box<ForcedMotion<Controller>>),
}

impl MotionField {
    /// The motion under external forces on these quasi-velocities; the function that computes the
    /// forces is still to be set.
    pub(crate) fn new(motion: Motion, forces: Vec<String>) -> Result<MotionField, MechError> {
        match forces.as_slice() {
            [] => Ok(MotionField::Free(Box::new(motion))),
            _ => Ok(MotionField::Forced(Box::new(motion.forced(forces, Controller::default())?))),
        }
    }

    /// Sets the function that computes the forces and returns the former one; if there are no
    /// external forces, returns the new one as an error.
    pub(crate) fn set_force(&mut self, controller: Controller) -> Result<Controller, Controller> {
        match self {
            MotionField::Free(_) => Err(controller),
            MotionField::Forced(forced) => Ok(std::mem::replace(forced.force_mut(), controller)),
        }
    }

    /// A number that distinguishes the field from fields with other equations or names.
    pub(crate) fn digest(&self) -> u64 {
        self.motion().digest()
    }

    fn motion(&self) -> &Motion {
        match self {
            MotionField::Free(motion) => motion,
            MotionField::Forced(forced) => forced.motion(),
        }
    }

    /// Compiles what a method evaluates, so that clones made afterwards share it.
    pub(crate) fn prepare(&mut self, method: Method) {
        if let MotionField::Free(motion) = self {
            motion.prepare(method);
        }
    }

    /// The machine code of f, if f consists of machine code alone.
    pub(crate) fn machine_code(&mut self) -> Option<MachineCode> {
        match self {
            MotionField::Free(motion) => motion.machine_code(),
            MotionField::Forced(_) => None,
        }
    }

    /// The parameters of the machine code, for the current values.
    pub(crate) fn code_parameters(&mut self) -> Option<&[f64]> {
        match self {
            MotionField::Free(motion) => motion.code_parameters(),
            MotionField::Forced(_) => None,
        }
    }

    /// The pivots of M that depend on parameters alone, for the current values.
    pub(crate) fn fixed_pivots(&mut self) -> Option<&[f64]> {
        match self {
            MotionField::Free(motion) => motion.fixed_pivots(),
            MotionField::Forced(_) => None,
        }
    }

    /// Number of coordinates.
    pub(crate) fn coordinates(&self) -> usize {
        self.motion().coordinates()
    }

    /// Number of quasi-velocities, or momenta.
    pub(crate) fn quasi_velocities(&self) -> usize {
        self.dim() - self.coordinates() - self.motion().states()
    }

    /// Names of the constraints that projection maintains.
    pub(crate) fn constraint_names(&self) -> &[String] {
        self.motion().constraint_names()
    }

    /// Writes the residual of each constraint.
    pub(crate) fn constraint_residuals(&mut self, t: f64, y: &[f64], residuals: &mut [f64]) {
        match self {
            MotionField::Free(motion) => motion.constraint_residuals_to(t, y, residuals),
            MotionField::Forced(forced) => forced.constraint_residuals_to(t, y, residuals),
        }
    }

    /// The parameters, without forces.
    pub(crate) fn parameters(&self) -> &[f64] {
        match self {
            MotionField::Free(motion) => motion.parameters(),
            MotionField::Forced(forced) => forced.parameters(),
        }
    }

    /// Writes the parameters, with the inputs that have tables at their values at t.
    pub(crate) fn parameters_at(&self, t: f64, values: &mut [f64]) -> Result<(), Failure> {
        values.copy_from_slice(self.parameters());
        self.motion().signals().show(t, values).map_err(Failure::fatal)?;
        Ok(())
    }

    /// The parameters, to be changed.
    pub(crate) fn parameters_mut(&mut self) -> &mut [f64] {
        match self {
            MotionField::Free(motion) => motion.parameters_mut(),
            MotionField::Forced(forced) => forced.parameters_mut(),
        }
    }

    /// The parameters, then the forces at (t, y).
    pub(crate) fn inputs(&mut self, t: f64, y: &[f64]) -> Result<&[f64], Failure> {
        match self {
            MotionField::Free(motion) => Ok(motion.parameters()),
            MotionField::Forced(forced) => forced.inputs(t, y),
        }
    }

    /// The derivatives ∂q/∂y of the forces at (t, y), column by column; none without external forces.
    pub(crate) fn force_jacobian(&mut self, t: f64, y: &[f64]) -> Result<Option<&[f64]>, Failure> {
        match self {
            MotionField::Free(_) => Ok(None),
            MotionField::Forced(forced) => forced.force_jacobian(t, y).map(Some),
        }
    }

    /// Writes the observables; those that contain a force that cannot be computed are not finite.
    pub(crate) fn observe(&mut self, t: f64, y: &[f64], values: &mut [f64]) {
        match self {
            MotionField::Free(motion) => motion.observe_to(t, y, values),
            MotionField::Forced(forced) => forced.observe_to(t, y, values),
        }
    }

    /// Writes the observables without calling the function of the forces; those that contain a force are not finite.
    pub(crate) fn observe_unforced(&mut self, t: f64, y: &[f64], values: &mut [f64]) {
        match self {
            MotionField::Free(motion) => motion.observe_to(t, y, values),
            MotionField::Forced(forced) => forced.observe_unforced_to(t, y, values),
        }
    }
}

macro_rules! delegate {
    ($self:expr, $field:pat => $call:expr) => {
        match $self {
            MotionField::Free($field) => $call,
            MotionField::Forced($field) => $call,
        }
    };
}

impl VectorField for MotionField {
    #[inline]
    fn dim(&self) -> usize {
        delegate!(self, field => field.dim())
    }

    #[inline]
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        delegate!(self, field => field.rhs(t, y, ydot))
    }

    #[inline]
    fn checks_rates(&self) -> bool {
        delegate!(self, field => field.checks_rates())
    }

    fn lanes(&mut self) -> Option<pc_expr::LaneField> {
        delegate!(self, field => field.lanes())
    }

    fn has_jacobian(&self) -> bool {
        delegate!(self, field => field.has_jacobian())
    }

    fn jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        delegate!(self, field => field.jacobian(t, y, jacobian))
    }

    fn sparsity(&self) -> Option<&pc_expr::Pattern> {
        delegate!(self, field => field.sparsity())
    }

    fn sparse_jacobian(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        delegate!(self, field => field.sparse_jacobian(t, y, values))
    }

    fn has_jvp(&self) -> bool {
        delegate!(self, field => field.has_jvp())
    }

    fn jvp(&mut self, t: f64, y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), Failure> {
        delegate!(self, field => field.jvp(t, y, v, product))
    }

    fn parameters_len(&self) -> usize {
        delegate!(self, field => field.parameters_len())
    }

    fn has_parameter_jacobian(&self) -> bool {
        delegate!(self, field => field.has_parameter_jacobian())
    }

    fn parameter_jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        delegate!(self, field => field.parameter_jacobian(t, y, jacobian))
    }

    fn parameter_size(&self, j: usize) -> Option<f64> {
        delegate!(self, field => field.parameter_size(j))
    }

    fn has_projection(&self) -> bool {
        delegate!(self, field => field.has_projection())
    }

    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        delegate!(self, field => field.project(t, y))
    }

    fn time_dependence(&self) -> pc_expr::TimeDependence {
        delegate!(self, field => field.time_dependence())
    }

    fn steep_functions(&self) -> Option<pc_expr::SteepFunctions> {
        delegate!(self, field => field.steep_functions())
    }

    fn series(&mut self) -> Result<&pc_expr::TaylorSeries, Failure> {
        delegate!(self, field => field.series())
    }

    fn expand(
        &mut self,
        t: f64,
        y: &[f64],
        sides: &[f64],
        order: usize,
    ) -> Result<&pc_expr::TaylorSeries, Failure> {
        delegate!(self, field => field.expand(t, y, sides, order))
    }

    fn varied_series(&mut self, columns: &[Option<usize>]) -> Result<&pc_expr::TaylorSeries, Failure> {
        delegate!(self, field => field.varied_series(columns))
    }

    fn expand_varied(
        &mut self,
        columns: &[Option<usize>],
        t: f64,
        all: &[f64],
        sides: &[f64],
        order: usize,
    ) -> Result<&pc_expr::TaylorSeries, Failure> {
        delegate!(self, field => field.expand_varied(columns, t, all, sides, order))
    }

    fn restart(&mut self, t: f64, y: &[f64]) {
        delegate!(self, field => field.restart(t, y));
    }

    fn breaks(&self) -> &[f64] {
        delegate!(self, field => field.breaks())
    }

    fn enter(&mut self, t: f64, end: f64) -> bool {
        delegate!(self, field => field.enter(t, end))
    }

    fn switching(&mut self) -> Option<&mut dyn pc_expr::Switching> {
        delegate!(self, field => field.switching())
    }

    fn jumps(&self) -> &[pc_expr::RateJump] {
        delegate!(self, field => field.jumps())
    }

    fn leads(&mut self, from: (f64, &[f64]), to: (f64, &[f64])) -> Result<(), Failure> {
        delegate!(self, field => field.leads(from, to))
    }

    fn component_name(&self, i: usize) -> String {
        delegate!(self, field => field.component_name(i))
    }
}
