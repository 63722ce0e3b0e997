//! Random trees of bodies on joints, with loops, against bodies whose places are written out.
//!
//! ```text
//! seed, number ─ generator ─► Tree ─ text ─► bodies on joints, and bodies by `position` and `rotation`
//! ```
//! The second text knows nothing of joints: places and rotations are expressions, composed here from the world outwards, loops
//! are constraints between them. So recursions over trees, elimination by joints and what is read of `joint` and `loops` are
//! compared with dense equations, and with their second derivation. That of what is written out takes long.

mod generator;
mod pose;
mod text;

use super::comparison::{self, Finding};
use super::emission;
use super::examination::{Examined, Thoroughness, bounded};
use super::execution::{Forms, Refusal, execute};

/// Examines tree number `index` of a seed.
pub(super) fn examine(seed: u64, index: u64, thoroughness: Thoroughness) -> Examined {
    let tree = generator::tree(seed, index);
    let (on_joints, written_out) = (text::on_joints(&tree), text::written_out(&tree));
    let texts = (on_joints.clone(), written_out.clone());
    let (has_forces, has_loops) = (tree.has_forces(), !tree.loops.is_empty());
    // Emitted source is compared at states beside that of the start. Off |q| = 1 forms of the equations differ.
    let thoroughness =
        Thoroughness { emitted: thoroughness.emitted && !tree.has_quaternions(), ..thoroughness };
    let limit = thoroughness.limit;
    let work = move || examine_texts(&texts.0, &texts.1, [has_forces, has_loops], thoroughness);
    Examined { text: on_joints, twin: Some(written_out), ..bounded(limit, work) }
}

fn examine_texts(
    on_joints: &str,
    written_out: &str,
    [has_forces, has_loops]: [bool; 2],
    thoroughness: Thoroughness,
) -> Examined {
    let mut examined = Examined::default();
    let execution = match execute(
        "model.toml",
        on_joints,
        Forms { all: true, emitted: thoroughness.emitted, second: true, ..Forms::ONE },
    ) {
        Ok(execution) => execution,
        Err(refusal) => {
            examined.refusals.push(refusal);
            return examined;
        }
    };
    examined.ran = true;
    examined.refusals = comparison::refusals(&execution);
    examined.findings = comparison::of_forms(&execution);
    if let Some(Ok(emission)) = &execution.emitted {
        examined.findings.extend(emission::compare(emission));
    }
    if let Some(commands) = thoroughness.commands {
        // Loops may come to where they lock; bodies on joints alone are never refused.
        let must_run = !has_loops;
        examined.add(commands.clone().follow(on_joints, &["--t-end", "10"], must_run));
        examined.add(commands.examine(on_joints, &execution));
    }
    match execute("written-out.toml", written_out, Forms::ONE) {
        Ok(twin) => {
            let name_in_twin = |name: &str| match name {
                // Of a constant force the energy knows where its body is placed by expressions.
                "energy" => (!has_forces).then(|| name.to_owned()),
                // Multipliers of constraints that are written otherwise, and of other bodies.
                reaction if ["λ_", "F_", "N_"].iter().any(|of| reaction.starts_with(of)) => None,
                name => Some(text::in_written_out(name, written_out)),
            };
            let kind = "motion of bodies written out differs";
            examined.findings.extend(comparison::compare(
                kind,
                &execution.motion,
                &twin.motion,
                name_in_twin,
                None,
            ));
        }
        // Loops between bodies that joints hold already: of their constraints some follow from others at the start alone.
        Err(refusal) if has_loops && refusal.message.contains("restricts no velocity") => {
            examined.refusals.push(Refusal { stage: "bodies written out", ..refusal });
        }
        Err(refusal) => examined
            .findings
            .push(Finding { kind: "bodies written out are refused", detail: refusal.message }),
    }
    examined
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::generator::{Closing, Tree};
    use super::*;

    const SHORT: Thoroughness =
        Thoroughness { emitted: false, commands: None, units: None, limit: Duration::from_secs(3600) };

    /// The first small tree of a seed that has what is wanted.
    fn tree(has: impl Fn(&Tree) -> bool) -> Tree {
        let mut trees = (0..5000).map(|index| generator::tree(4, index));
        trees.find(|tree| tree.bodies.len() < 4 && has(tree)).expect("a tree")
    }

    /// What is found where the text without joints is that of another tree.
    fn found(tree: &Tree, other: &Tree) -> Vec<&'static str> {
        let has = [tree.has_forces(), !tree.loops.is_empty()];
        let examined = examine_texts(&text::on_joints(tree), &text::written_out(other), has, SHORT);
        assert!(examined.ran, "{:?}", examined.refusals);
        examined.findings.iter().map(|finding| finding.kind).collect()
    }

    #[test]
    fn an_anchor_that_moves_otherwise_is_found() {
        let driven = tree(|tree| tree.drive.is_some());
        assert_eq!(found(&driven, &driven), [""; 0]);
        let mut other = driven.clone();
        other.drive.iter_mut().for_each(|drive| drive.amplitude *= 1.1);
        assert_eq!(found(&driven, &other), ["motion of bodies written out differs"]);
    }

    #[test]
    fn another_axis_of_a_loop_is_found() {
        let is_revolute = |closed: &generator::Loop| matches!(closed.closing, Closing::Revolute(_));
        let closed = tree(|tree| tree.loops.len() == 1 && is_revolute(&tree.loops[0]));
        assert_eq!(found(&closed, &closed), [""; 0]);
        let mut other = closed.clone();
        if let Closing::Revolute([axis, _]) = &mut other.loops[0].closing {
            axis[0] += 0.5;
        }
        assert_eq!(found(&closed, &other), ["bodies written out are refused"]);
    }
}
