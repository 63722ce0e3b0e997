//! The sides of its surfaces on which a field of several pieces is held, and the changes of side so far.

use pc_expr::{Failure, RootSeparation, Sliding, VectorField};

/// The sides of the surfaces of a field: 1, −1, or 0 where the motion slides.
#[derive(Debug, Clone, Default)]
pub(crate) struct HeldSides {
    pub(crate) sides: Vec<f64>,
    /// Whether these sides are known to be those on which the motion is at the front.
    pub(crate) are_known: bool,
    /// Whether the functions depend on time alone.
    of_time: bool,
    /// Room for a state.
    pub(crate) place: Vec<f64>,
    /// What separates the roots of the functions.
    pub(crate) separation: Option<RootSeparation>,
    /// The parts of the motion so far in which it slid along surfaces.
    pub(crate) slides: Vec<Slide>,
    /// All changes of side, if they are to be recorded.
    pub(crate) passages: Option<Vec<Passage>>,
}

impl HeldSides {
    /// The sides of a field at a start, where the sides are not yet known.
    pub(crate) fn of(field: &mut impl VectorField) -> HeldSides {
        let dim = field.dim();
        match field.switching() {
            Some(switching) => {
                switching.hold(None);
                let sides = vec![1.0; switching.surfaces().len()];
                let of_time = switching.program().is_some_and(|(program, _)| !program.reads_state());
                HeldSides { sides, of_time, place: vec![0.0; dim], ..HeldSides::default() }
            }
            None => HeldSides::default(),
        }
    }

    /// Whether the functions can be evaluated along a step without knowing the states.
    pub(crate) fn need_no_states(&self) -> bool {
        self.of_time && !self.sides.contains(&0.0)
    }

    /// The number of surfaces.
    pub(crate) fn len(&self) -> usize {
        self.sides.len()
    }
}

/// A part of a motion that slides along a surface on which its field jumps.
#[derive(Debug, Clone, PartialEq)]
pub struct Slide {
    /// The function that vanishes on the surface.
    pub surface: String,
    /// When this part begins.
    pub from: f64,
    /// When this part ends; none while it lasts.
    pub until: Option<f64>,
}

/// The sides of all surfaces from this time on.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Passage {
    /// The surfaces reached; none at a start.
    pub(crate) surfaces: Vec<usize>,
    pub(crate) time: f64,
    pub(crate) state: Vec<f64>,
    /// The sides before this time, if surfaces were reached, and the sides after it.
    pub(crate) before: Vec<f64>,
    pub(crate) after: Vec<f64>,
}

/// Writes the functions whose zeros an integration looks for: those of the surfaces, and for the
/// surfaces along which the motion slides the margin of σ, such as 1 − σ².
pub(crate) fn write_functions(
    field: &mut impl VectorField,
    held: &HeldSides,
    t: f64,
    y: &[f64],
    values: &mut [f64],
) -> Result<(), Failure> {
    let Some(switching) = field.switching().filter(|_| held.are_known) else {
        values.fill(1.0);
        return Ok(());
    };
    switching.functions(t, y, values);
    for (value, side) in values.iter_mut().zip(&held.sides) {
        if value.is_nan() {
            *value = *side; // it has no value, and none is needed there
        }
    }
    if held.sides.contains(&0.0) {
        let Sliding { surfaces, weights, .. } = Sliding::of(switching, &held.sides, t, y)?;
        for (surface, weight) in surfaces.into_iter().zip(weights) {
            values[surface] = switching.range(surface, t, y).margin(weight);
        }
    }
    Ok(())
}
