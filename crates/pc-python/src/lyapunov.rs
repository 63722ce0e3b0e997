//! Lyapunov exponents of a motion.

use pc_model::deep;
use pc_run::Plan;
use pc_solve::{LyapunovOptions, lyapunov_exponents};
use pyo3::prelude::*;

use crate::model::renewed;
use crate::plan::{Wished, options};
use crate::system::SystemCore;
use crate::task::attended;

#[pymethods]
impl SystemCore {
    /// The largest exponents, and their means after each interval, one after the other.
    #[pyo3(name = "_exponents")]
    fn exponents(
        &self,
        py: Python<'_>,
        count: usize,
        interval: f64,
        intervals: (u32, u32),
        wished: Wished,
    ) -> PyResult<(Vec<f64>, Vec<f64>)> {
        let (mut model, derived) = self.now();
        let cancel = renewed(&mut model);
        let t_start = self.inventory.t_start;
        let (intervals, transient) = intervals;
        let end = t_start + interval * f64::from(intervals.saturating_add(transient));
        let plan = wished.plan(&model, self.variables, &cancel)?;
        let mut flow = derived.flow.clone();
        let options = options(&Plan { t_end: end, ..plan }, &mut flow);
        let work = move || {
            deep(|| {
                let wanted = LyapunovOptions::new(count, interval, intervals).transient(transient);
                let found = lyapunov_exponents(&mut flow.motion, t_start, &flow.start, &options, &wanted)?;
                Ok((found.exponents, found.history))
            })
        };
        attended(py, &cancel, |_| Ok(()), work)
    }
}
