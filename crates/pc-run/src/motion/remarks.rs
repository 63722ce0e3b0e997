//! Remarks on the equations, for the user.

use std::sync::{Mutex, PoisonError};

use pc_mech::{Constraint, Expr};
use pc_model::{Assembly, ConstraintFormulation, Variables};
use pc_report::{NEGATIVE_ENERGY, changing_masses, dropped};

use pc_print::{energy_remark, short, wrapped};

use crate::error::RunError;
use crate::observer::Observer;

/// Takes remarks down.
#[derive(Default)]
struct Notes(Mutex<Vec<String>>);

impl Observer for Notes {
    fn remark(&self, remark: &str) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(remark.to_owned());
    }
}

/// Everything that is known about the equations before they are integrated.
pub(crate) fn of(assembly: &Assembly<'_>) -> Result<Vec<String>, RunError> {
    let notes = Notes::default();
    say(assembly, &notes)?;
    Ok(notes.0.into_inner().unwrap_or_else(PoisonError::into_inner))
}

/// Tells the observer everything that is known about the equations before they are integrated.
///
/// # Errors
/// [`RunError`] if they cannot be derived.
pub fn say(assembly: &Assembly<'_>, observer: &dyn Observer) -> Result<(), RunError> {
    say_moved(assembly, observer);
    say_negative_energy(assembly, observer);
    say_changing_masses(assembly, observer);
    if assembly.constraints.held().is_none() && assembly.has_multipliers() {
        let (_, free) = assembly.equations_of(Variables::QuasiVelocities)?;
        if let Some(remark) = choice(assembly, &free.independent) {
            observer.remark(&remark);
        }
        energy_remark(assembly).into_iter().for_each(|remark| observer.remark(remark));
    }
    say_undetermined(assembly, observer);
    Ok(())
}

/// Says which constraints were dropped.
pub fn say_dropped(assembly: &Assembly<'_>, observer: &dyn Observer) {
    for (name, reason) in dropped(assembly) {
        observer.remark(&format!("the constraint {name} {reason}; it is dropped"));
    }
}

/// A remark on equations in the `free` velocities, which were chosen as independent, or on equations in all
/// velocities, which have nonlinear constraints as integrals; none if neither is the case.
pub fn choice(assembly: &Assembly<'_>, free: &[Expr<'_>]) -> Option<String> {
    let ConstraintFormulation::Multipliers(_) = assembly.constraints.formulation() else { return None };
    if let Some(held) = assembly.constraints.nonlinear() {
        let names: Vec<&str> = held.constraints().iter().map(Constraint::name).collect();
        let are = if names.len() == 1 { "is an integral" } else { "are integrals" };
        return Some(format!(
            "The equations are in all velocities, with the reactions put in; {} {are} of them,\n\
             and nothing takes errors of the integration back to the constraints.",
            names.join(", ")
        ));
    }
    let all = assembly.system.quasi_velocities().iter();
    let others: Vec<String> = all.filter(|eta| !free.contains(eta)).map(Expr::to_string).collect();
    let free: Vec<String> = free.iter().map(Expr::to_string).collect();
    let follow = if others.len() == 1 { "follows" } else { "follow" };
    let declared = &assembly.system.quasi_velocities()[..assembly.declared];
    let choice = match declared.iter().all(|eta| free.contains(&eta.to_string())) {
        _ if !assembly.constraints.asked_for().is_empty() => "These are the requested ones.",
        true => "These are the quasi-velocities of the model.",
        false => "This choice is regular at the start, and makes them short.",
    };
    Some(format!(
        "The equations are in {}; {} {follow} from the constraints.\n\
         {choice} Where this choice fails the equations are singular,\n\
         and nothing takes errors of the integration back to the constraints.",
        free.join(", "),
        others.join(", ")
    ))
}

/// Says how the start was moved onto the constraints.
pub fn say_moved(assembly: &Assembly<'_>, observer: &dyn Observer) {
    if let Some(written) = &assembly.written_start {
        let names = assembly.system.state();
        let moved = names
            .iter()
            .zip(written.iter().zip(&assembly.start))
            .filter(|(_, (before, after))| before != after);
        let moves = moved.map(|(name, (before, after))| {
            format!("{name} = {} → {}", short(*before, 10), short(*after, 10))
        });
        match wrapped(moves, 80).as_slice() {
            [] => observer.remark("the start satisfies the constraints; it was not moved"),
            lines => {
                let lines = lines.join("\n");
                observer.remark(&format!("the start was moved onto the constraints:\n{lines}"));
            }
        }
    }
}

/// Says which masses change with time, and how the mass that they lose moves.
pub fn say_changing_masses(assembly: &Assembly<'_>, observer: &dyn Observer) {
    if let Some(remark) = changing_masses(assembly) {
        observer.remark(&remark);
    }
}

/// Says if the kinetic energy is negative.
pub fn say_negative_energy(assembly: &Assembly<'_>, observer: &dyn Observer) {
    if assembly.has_negative_energy() {
        observer.remark(NEGATIVE_ENERGY);
    }
}

/// Says which reaction forces on bodies are missing from the outputs.
pub fn say_undetermined(assembly: &Assembly<'_>, observer: &dyn Observer) {
    let left_out = assembly.constraints.undetermined();
    if !left_out.is_empty() {
        let are = if left_out.len() == 1 { "is" } else { "are" };
        observer.remark(&format!(
            "{} of the reactions {are} left out: the choice of coordinates ties velocities of bodies together, and \
             virtual work does not tell forces between them",
            left_out.join(", ")
        ));
    }
}
