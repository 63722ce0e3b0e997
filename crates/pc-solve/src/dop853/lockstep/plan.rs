//! The settings that all members share.

use pc_expr::{Deadline, Method};

use crate::settings::options::Options;
use crate::settings::tolerance::Tolerance;

/// Lanes do not support a start time that is farther from 0 than this many times the span of the
/// motion.
const FARTHEST: f64 = 1e4;

/// Times, tolerances and limits, as far as lanes support them.
#[derive(Debug, Clone)]
pub(crate) struct Plan {
    pub(crate) start: f64,
    pub(crate) times: Vec<f64>,
    /// 1 or −1.
    pub(crate) direction: f64,
    pub(crate) relative: f64,
    pub(crate) absolute: Tolerance,
    pub(crate) longest: Option<f64>,
    /// The length of the first step, if given.
    pub(crate) first: Option<f64>,
    pub(crate) max_steps: u64,
    /// Whether members that turn out to be stiff leave their lanes.
    pub(crate) watches_stiffness: bool,
    pub(crate) deadline: Option<Deadline>,
}

impl Plan {
    /// The plan; none if the input is invalid, which each member then reports by itself, or if
    /// lanes do not support it because of the method, inequalities, a minimum step or a stop time before the last
    /// output.
    pub(crate) fn new(start: f64, times: &[f64], options: &Options) -> Option<Plan> {
        let more = !matches!(options.method, Method::Auto | Method::Dop853)
            || !options.inequalities.is_empty()
            || options.min_step.is_some();
        let &end = times.last()?;
        let finite = start.is_finite() && times.iter().all(|t| t.is_finite());
        if more || !finite || end == start {
            return None;
        }
        let direction = 1.0_f64.copysign(end - start);
        // The last step ends at the last output.
        if options.stop_time.is_some_and(|stop| (stop - end) * direction < 0.0) {
            return None;
        }
        let ahead = (times[0] - start) * direction >= 0.0;
        let monotonic = times.windows(2).all(|pair| (pair[1] - pair[0]) * direction > 0.0);
        // The times of lanes are not counted from the start: they would lose digits.
        let is_near = start.abs() <= FARTHEST * (end - start).abs();
        (ahead && monotonic && is_near)
            .then(|| Plan {
                start,
                times: times.to_vec(),
                direction,
                relative: options.resolved_tolerance(),
                absolute: options.absolute_tolerance.clone(),
                longest: options.max_step,
                first: options.initial_step,
                max_steps: options.max_steps,
                watches_stiffness: options.method == Method::Auto,
                deadline: options.deadline.clone(),
            })
            // Other options are validated for the length of a state.
            .filter(|_| match &options.absolute_tolerance {
                Tolerance::Scalar(_) => options.validate(1).is_ok(),
                Tolerance::Vector(tolerances) => options.validate(tolerances.len()).is_ok(),
            })
    }

    /// Whether both plans have the same tapes.
    pub(super) fn is_like(&self, other: &Plan) -> bool {
        let limits = |plan: &Plan| (plan.start, plan.end(), plan.direction, plan.relative, plan.max_steps);
        let lengths = |plan: &Plan| (plan.longest, plan.first, plan.has_inside(), plan.watches_stiffness);
        limits(self) == limits(other) && lengths(self) == lengths(other) && self.absolute == other.absolute
    }

    /// Whether there are output times other than the start and the end, so that states inside a
    /// step are needed.
    pub(super) fn has_inside(&self) -> bool {
        self.times.iter().any(|&t| t != self.start && t != self.end())
    }

    /// The absolute tolerance of each component; none if the number of tolerances differs from the
    /// number of components.
    pub(super) fn absolute(&self, dim: usize) -> Option<Vec<f64>> {
        match &self.absolute {
            Tolerance::Scalar(tolerance) => Some(vec![*tolerance; dim]),
            Tolerance::Vector(tolerances) => (tolerances.len() == dim).then(|| tolerances.clone()),
        }
    }

    pub(super) fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or(self.start)
    }
}
