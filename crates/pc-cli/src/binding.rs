//! What is said of constraints beside the equations.

use pc_mech::{Constraint, Expr, Style, System};
use pc_model::{Assembly, Form};
use pc_nonholo::Kind;
use serde_json::{Value, json};

use crate::derive::Derived;
use crate::text::say;

/// What vanishes, a line a constraint.
pub fn constraints(derived: &Derived<'_>) -> Vec<String> {
    let lines = derived.constraints.iter().map(|(constraint, kind)| {
        let (left, kind) = (derived.vanishing(constraint).display(Style::Book), kind_in_words(*kind));
        format!("{}: {left} = 0   ({kind})", constraint.name())
    });
    lines.collect()
}

/// What a constraint does.
pub fn kind_in_words(kind: Kind) -> &'static str {
    match kind {
        Kind::Position => "holonomic",
        Kind::Integrable => "holonomic in disguise: integrable",
        Kind::Nonholonomic { .. } => "nonholonomic",
    }
}

/// The constraints for programs.
pub fn constraint_objects(derived: &Derived<'_>) -> Value {
    let object = |(constraint, kind): &(Constraint<'_>, Kind)| {
        json!({
            "name": constraint.name(),
            "expression": derived.vanishing(constraint).to_string(),
            "kind": kind_in_words(*kind),
        })
    };
    derived.constraints.iter().map(object).collect()
}

/// The constraints that were dropped, each with the reason.
pub fn dropped(assembly: &Assembly<'_>) -> Vec<(String, String)> {
    let reason = |names: &[String]| match names {
        [] => "says nothing".to_owned(),
        names => format!("follows from {}", names.join(", ")),
    };
    let redundant = assembly.bound.redundant().iter();
    redundant.map(|redundant| (redundant.constraint.clone(), reason(&redundant.follows_from))).collect()
}

/// Says which constraints were dropped, on standard error.
pub fn say_dropped(assembly: &Assembly<'_>) {
    for (name, reason) in dropped(assembly) {
        say(format_args!("note: the constraint {name} {reason}; it is dropped\n"));
    }
}

/// What is to be known of equations in the `free` velocities chosen from those that constraints bind; nothing where
/// there is no choice.
pub fn choice(assembly: &Assembly<'_>, free: &System<'_>) -> Option<String> {
    let Form::Held(_) = assembly.bound.form() else { return None };
    let free = free.quasi_velocities();
    let all = assembly.system.quasi_velocities().iter();
    let others: Vec<String> = all.filter(|eta| !free.contains(eta)).map(Expr::to_string).collect();
    let free: Vec<String> = free.iter().map(Expr::to_string).collect();
    let follow = if others.len() == 1 { "follows" } else { "follow" };
    Some(format!(
        "The equations are in {}; {} {follow} from the constraints.\n\
         This choice is the best at the start. Where it fails the equations are singular,\n\
         and nothing takes errors of the integration back to the constraints.",
        free.join(", "),
        others.join(", ")
    ))
}

/// Says it, on standard error.
pub fn say_choice(choice: &str) {
    say(format_args!("note: {}\n", choice.replace('\n', "\n      ")));
}
