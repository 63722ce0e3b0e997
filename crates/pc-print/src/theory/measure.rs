//! The invariant measure of the motion, and Chaplygin's reducing multiplier.

use pc_analysis::{MeasureSearch, ReducingMultiplier};
use pc_mech::Expr;
use pc_model::{Assembly, ModelError};
use pc_nonholo::Voronets;

use crate::theory::basis::Basis;
use crate::theory::description::{Entry, Section, Side, Verdict};

/// The section on the density N of the invariant measure N dx dy.
pub(crate) fn section<'g>(ground: &Basis<'_, 'g>) -> Result<Section<'g>, ModelError> {
    let section = |entries| {
        Ok(Section { key: "invariant_measure", title: "Invariant measure", names: Vec::new(), entries })
    };
    if ground.assembly.constraints.nonlinear().is_some() {
        return section(vec![open("not looked for: a constraint is not affine in the velocities")]);
    }
    let positions = ground.assembly.constraints.positions(&ground.assembly.system);
    let found = MeasureSearch::of(&ground.free, positions.as_deref(), &ground.near.centre);
    let measure = match ground.placed(found)? {
        MeasureSearch::None => return section(vec![open("none found")]),
        MeasureSearch::External => return section(vec![open("not looked for: forces are computed outside")]),
        MeasureSearch::TooLong => return section(vec![open("not looked for: the equations are too long")]),
        MeasureSearch::Found(measure) => measure,
    };
    let density = |side: Side<'g>, density: Option<Expr<'g>>| {
        density.map(|density| Entry::formula(side, Side::of(density)).with(Verdict::Proved))
    };
    let in_velocities = Side::symbol("Nη", "N_{\\eta}", "<msub><mi>N</mi><mi>η</mi></msub>");
    let densities =
        [density(Side::letter("N"), measure.density), density(in_velocities, measure.in_velocities)];
    let mut entries: Vec<Entry<'g>> = densities.into_iter().flatten().collect();
    let whose = if measure.liouville { ", Liouville's" } else { "" };
    entries.push(Entry::words(format!("the motion keeps N dx dy and Nη dx dη{whose}")));
    if measure.density.is_none() {
        entries.push(Entry::words("its density is too long to print").with(Verdict::Proved));
    }
    let singular: Vec<String> = measure.singular.iter().map(|p| format!("{p} = 0")).collect();
    let resets = ground.assembly.events.iter().any(pc_model::Event::changes_state);
    let words = [
        (!singular.is_empty()).then(|| format!("singular where {}", singular.join(" or "))),
        measure.jumps.then(|| "where nothing jumps".to_owned()),
        resets.then(|| "between events".to_owned()),
    ];
    entries.extend(words.into_iter().flatten().map(Entry::words));
    section(entries)
}

fn open<'g>(words: &str) -> Entry<'g> {
    Entry::words(words).with(Verdict::Open)
}

/// The section on N in dτ = N dt, and on the Lagrangian in the new time τ.
pub(crate) fn multiplier<'g>(ground: &Basis<'_, 'g>) -> Section<'g> {
    let section = |entries| Section {
        key: "reducing_multiplier",
        title: "Chaplygin's multiplier",
        names: Vec::new(),
        entries,
    };
    if ground.is_holonomic() || ground.assembly.constraints.nonlinear().is_some() {
        return section(Vec::new());
    }
    let Some(voronets) = voronets(ground.assembly) else {
        return section(vec![open("not looked for: the constraints are not solved for velocities")]);
    };
    if !voronets.is_chaplygin() {
        return section(vec![Entry::words("the equations are not of Chaplygin's form")]);
    }
    let Ok(Some(reduced)) = ReducingMultiplier::of(&voronets) else {
        return section(vec![open("none found")]);
    };
    let multiplier = Entry::formula(Side::letter("N"), Side::of(reduced.multiplier));
    let lagrangian = Entry::formula(
        Side::symbol("L*", "L^{*}", "<msup><mi>L</mi><mo>*</mo></msup>"),
        Side::of(reduced.system.lagrangian()),
    );
    section(vec![
        multiplier.with(Verdict::Proved),
        lagrangian,
        Entry::words("dτ = N dt: in the time τ the independent coordinates move as L* says, x' = dx/dτ"),
    ])
}

/// Chaplygin's reducing multiplier of a model; none if it is not found, if there are no equations of
/// Voronets' form, or if they have no closed form.
pub fn reducing_multiplier<'g>(assembly: &Assembly<'g>) -> Option<ReducingMultiplier<'g>> {
    ReducingMultiplier::of(&voronets(assembly)?).ok()?
}

/// The equations of independent velocities, if the constraints can be solved for the others.
fn voronets<'g>(assembly: &Assembly<'g>) -> Option<Voronets<'g>> {
    let held = assembly.constraints.multipliers()?.in_velocities().ok()?;
    let mut transform = assembly.system.velocity_transform().ok()?;
    let start = transform.to_velocities(assembly.t_start, &assembly.start);
    let lagrange = held.equations().system();
    let mut at: Vec<(Expr<'g>, f64)> = lagrange.state().into_iter().zip(start).collect();
    at.push((lagrange.frame().time(), assembly.t_start));
    Voronets::shortest(&held, &at).ok()
}
