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
use super::execution::{Forms, execute};

/// Examines tree number `index` of a seed.
pub(super) fn examine(seed: u64, index: u64, thoroughness: Thoroughness) -> Examined {
    let tree = generator::tree(seed, index);
    let (on_joints, written_out) = (text::on_joints(&tree), text::written_out(&tree));
    let texts = (on_joints.clone(), written_out.clone());
    let has_forces = tree.has_forces();
    // Emitted source is compared at states beside that of the start. Off |q| = 1 forms of the equations differ.
    let thoroughness =
        Thoroughness { emitted: thoroughness.emitted && !tree.has_quaternions(), ..thoroughness };
    let work = move || examine_texts(&texts.0, &texts.1, has_forces, thoroughness);
    Examined { text: on_joints, twin: Some(written_out), ..bounded(thoroughness.limit, work) }
}

fn examine_texts(
    on_joints: &str,
    written_out: &str,
    has_forces: bool,
    thoroughness: Thoroughness,
) -> Examined {
    let mut examined = Examined::default();
    let execution = match execute(
        "model.toml",
        on_joints,
        Forms { all: true, emitted: thoroughness.emitted, second: true },
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
    match execute("written-out.toml", written_out, Forms { all: false, emitted: false, second: false }) {
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
        Err(refusal) => examined
            .findings
            .push(Finding { kind: "bodies written out are refused", detail: refusal.message }),
    }
    examined
}
