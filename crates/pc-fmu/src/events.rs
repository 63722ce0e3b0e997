//! The events of a model on the state of its equations.

use pc_expr::{Direction, Expr};
use pc_model::{Assembly, FreeForm};

use crate::error::FmuError;

/// An event, in functions of the state of the equations.
pub(crate) struct FmuEvent<'g> {
    pub(crate) name: String,
    pub(crate) when: Expr<'g>,
    pub(crate) direction: Direction,
    pub(crate) is_terminal: bool,
    pub(crate) is_reset: bool,
    /// The state after it.
    pub(crate) after: Vec<Expr<'g>>,
}

/// The events, `known` being all quasi-velocities of the model and `forces` those of contacts, in terms of the state of the
/// form.
///
/// # Errors
/// [`FmuError`] for resets that have no formula.
pub(crate) fn events<'g>(
    assembly: &Assembly<'g>,
    form: &FreeForm<'g>,
    known: &[(Expr<'g>, Expr<'g>)],
    forces: &[(Expr<'g>, Expr<'g>)],
) -> Result<Vec<FmuEvent<'g>>, FmuError> {
    let (whole, graph) = (&assembly.system, assembly.system.graph());
    let coordinates = whole.frame().coordinates();
    if !assembly.events.is_empty() && form.system.frame().coordinates() != coordinates {
        return Err(FmuError::EventsNeedCoordinates);
    }
    if whole.is_held_at_rest() || assembly.rolls_by_friction() {
        return Err(FmuError::HeldAtRest);
    }
    let all = whole.state();
    let first_state = all.len() - whole.states().len();
    let in_form = |list: &[Expr<'g>]| graph.substitute(list, known);
    let mut events = Vec::new();
    for event in &assembly.events {
        if assembly.has_multipliers() && event.resets.iter().any(|&(place, _)| place < first_state) {
            return Err(FmuError::ResetUnderConstraints { event: event.name.clone() });
        }
        // (x, η, z) of the model after it, in terms of the state before it.
        let mut after = in_form(&all);
        for &(place, value) in &event.resets {
            after[place] = in_form(&[value])[0];
        }
        let becomes: Vec<_> = all.iter().copied().zip(after).collect();
        let state: Vec<Expr<'g>> = form
            .system
            .state()
            .iter()
            .map(|symbol| {
                let place = form.system.quasi_velocities().iter().position(|eta| eta == symbol);
                place.map_or(*symbol, |place| form.definitions[place])
            })
            .collect();
        events.push(FmuEvent {
            name: event.name.clone(),
            when: graph.substitute(&in_form(&[event.when]), forces)[0],
            direction: event.direction,
            is_terminal: event.terminal,
            is_reset: !event.resets.is_empty(),
            after: graph.substitute(&state, &becomes),
        });
    }
    Ok(events)
}
