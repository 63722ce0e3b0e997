//! Values of event functions along a step.

/// Times with a relative difference less than this count as equal: events between them are
/// simultaneous.
pub(super) const SAME: f64 = 64.0 * f64::EPSILON;

/// The values of all functions at one time.
#[derive(Debug, Clone)]
pub(crate) struct Sample {
    pub(crate) t: f64,
    pub(crate) values: Vec<f64>,
}

/// Access to the functions: `evaluate` writes their values at a time.
pub(crate) struct Look<'a, F> {
    pub(crate) evaluate: F,
    /// The number of functions.
    pub(crate) functions: usize,
    /// Whether each function is known to have at most one root between successive sample times.
    pub(crate) separated: bool,
    pub(crate) room: &'a mut Room,
}

/// Room for samples along a step, so that steps without events do not allocate.
#[derive(Debug, Clone)]
pub(crate) struct Room {
    values: Vec<Vec<f64>>,
    pub(crate) samples: Vec<Sample>,
    /// Where the search along a step begins.
    pub(crate) start: f64,
    /// The largest magnitude of each function in the samples of a step.
    pub(crate) largest: Vec<f64>,
}

/// The number of samples allocated at the beginning.
const ROOM: usize = 64;

impl Room {
    /// Room for the values of `functions` functions.
    pub(crate) fn new(functions: usize) -> Room {
        let samples = if functions == 0 { 0 } else { ROOM };
        let values = (0..samples).map(|_| Vec::with_capacity(functions)).collect();
        let largest = Vec::with_capacity(functions);
        Room { values, samples: Vec::with_capacity(samples), start: f64::NAN, largest }
    }

    /// Notes the first sample of a step.
    pub(crate) fn begin(&mut self, sample: &Sample) {
        self.start = sample.t;
        self.largest.clear();
        self.largest.extend(sample.values.iter().map(|value| value.abs()));
    }

    /// Notes the magnitudes of further samples of the step.
    pub(crate) fn measure(&mut self, samples: &[Sample]) {
        for sample in samples {
            let largest = self.largest.iter_mut().zip(&sample.values);
            largest.for_each(|(largest, value)| *largest = largest.max(value.abs()));
        }
    }

    /// Recycles a sample.
    pub(crate) fn take_back(&mut self, sample: Sample) {
        self.values.push(sample.values);
    }

    fn copy(&mut self, sample: &Sample) -> Sample {
        let mut values = self.values.pop().unwrap_or_default();
        values.clone_from(&sample.values);
        Sample { t: sample.t, values }
    }
}

impl<F> Look<'_, F> {
    pub(crate) fn copy(&mut self, sample: &Sample) -> Sample {
        self.room.copy(sample)
    }

    pub(crate) fn at<E>(&mut self, t: f64) -> Result<Sample, E>
    where
        F: FnMut(f64, &mut [f64]) -> Result<(), E>,
    {
        let mut values = self.room.values.pop().unwrap_or_default();
        values.clear();
        values.resize(self.functions, f64::NAN);
        (self.evaluate)(t, &mut values)?;
        Ok(Sample { t, values })
    }
}
