//! Values of the functions of events along a step.

/// All functions at a time.
#[derive(Debug, Clone)]
pub(crate) struct Sample {
    pub(crate) t: f64,
    pub(crate) values: Vec<f64>,
}

/// What looks at the functions: `evaluate` writes their values at a time.
pub(crate) struct Look<'a, F> {
    pub(crate) evaluate: F,
    /// How many functions there are.
    pub(crate) functions: usize,
    /// Whether it is known that no function has more than one root between two of the times that it is looked at.
    pub(crate) separated: bool,
    pub(crate) room: &'a mut Room,
}

/// Room for what is seen along a step: steps in which nothing occurs allocate nothing.
#[derive(Debug, Clone)]
pub(crate) struct Room {
    values: Vec<Vec<f64>>,
    pub(crate) samples: Vec<Sample>,
}

/// Samples for which there is room from the beginning.
const ROOM: usize = 64;

impl Room {
    /// Room for values of that many functions.
    pub(crate) fn new(functions: usize) -> Room {
        let samples = if functions == 0 { 0 } else { ROOM };
        let values = (0..samples).map(|_| Vec::with_capacity(functions)).collect();
        Room { values, samples: Vec::with_capacity(samples) }
    }

    /// Takes back what is no longer needed.
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
