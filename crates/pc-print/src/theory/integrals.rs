//! The integrals of the motion, and the fields of displacements to which they belong.

use pc_analysis::{
    AnsatzSearch, ConservationVerdict, Integral, Integrals, LevelEquation, NoetherField, Origin,
    PolynomialAnsatz,
};
use pc_mech::{Constraint, Equations, Expr, Identity, Multipliers, Neighbourhood, Number, Style, System};
use pc_model::{Assembly, ConstraintFormulation, Model, ModelError};

use crate::equations::derived::energy_remark;
use crate::language::mathml;
use crate::theory::basis::Basis;
use crate::theory::description::{Entry, Section, Side, Verdict};
use crate::theory::options::TheoryOptions;
use crate::words::lines::combination;
use crate::words::words::short;

/// The integrals of a model's motion, known or found by an ansatz, with names meant for readers.
pub fn integrals_of<'g>(
    assembly: &Assembly<'g>,
    equations: &Equations<'g>,
    near: &Neighbourhood<'g>,
    by_ansatz: bool,
) -> Integrals<'g> {
    let mut integrals = match by_ansatz {
        true => Integrals::find(equations, near),
        false => Integrals::known(equations, near),
    };
    name_momenta(&mut integrals, equations.system());
    if assembly.keeps_energy() && energy_remark(assembly).is_none() {
        integrals.keep_energy(equations);
    }
    if energy_remark(assembly).is_some()
        && let Some(energy) = energy_of_all(assembly, equations)
    {
        integrals.add_energy_of_all(equations, near, energy);
    }
    drop_constraints(&mut integrals, assembly, equations);
    say_what_jumps(&mut integrals, assembly);
    integrals.judge_on_levels(equations, near, &constraints_of(assembly, equations));
    integrals
}

/// Drops functions of the constraints, which the ansatz finds again.
fn drop_constraints<'g>(integrals: &mut Integrals<'g>, assembly: &Assembly<'g>, equations: &Equations<'g>) {
    let constraints = constraints_of(assembly, equations);
    if !constraints.is_empty() {
        integrals.drop_functions_of(equations.system(), &constraints);
    }
}

/// The constraints on positions and on velocities in terms of the velocities in the equations, as far as these do not
/// satisfy them identically.
fn constraints_of<'g>(assembly: &Assembly<'g>, equations: &Equations<'g>) -> Vec<Expr<'g>> {
    let constraints = assembly.constraints.multipliers().map(Multipliers::constraints).unwrap_or_default();
    let (graph, system) = (assembly.system.graph(), &assembly.system);
    let positions = constraints.iter().filter(|g| g.is_holonomic(system)).map(Constraint::expression);
    let velocities = constraints.iter().map(|g| g.velocity(system));
    let all: Vec<Expr<'g>> = positions.chain(velocities).collect();
    let (given, free) = (system.quasi_velocities(), equations.system().quasi_velocities());
    let Ok(values) = assembly.quasi_velocities_of(free) else { return Vec::new() };
    let known: Vec<(Expr<'g>, Expr<'g>)> = given.iter().copied().zip(values).collect();
    let mut all = graph.substitute(&all, &known);
    all.retain(|constraint| constraint.constant().is_none());
    all
}

/// Names momenta after their displacements.
fn name_momenta(integrals: &mut Integrals<'_>, system: &System<'_>) {
    let name = |coefficients: &[Number]| {
        let names = system.quasi_velocities().iter().map(ToString::to_string);
        format!("momentum of {}", combination(coefficients.iter().map(ToString::to_string).zip(names)))
    };
    integrals.rename(|integral| match &integral.origin {
        Origin::CyclicDisplacement { coefficients } => Some(name(coefficients)),
        _ => None,
    });
}

/// Marks functions that are conserved between events, but may be changed by resets.
fn say_what_jumps<'g>(integrals: &mut Integrals<'g>, assembly: &Assembly<'g>) {
    let projected = matches!(assembly.constraints.formulation(), ConstraintFormulation::Multipliers(_));
    // An impact gives all velocities values of which nothing is known here.
    let (state, graph) = (assembly.system.state(), assembly.system.graph());
    let n = assembly.system.frame().coordinates().len();
    let moving = n..state.len() - assembly.system.states().len();
    let unknown = |place: usize| (place, graph.symbol(&format!("{} after the impact", state[place])));
    let any: Vec<_> = moving.map(unknown).collect();
    let reset = |event: &'_ pc_model::Event<'g>| match event.impact {
        Some(_) => any.clone(),
        None => event.resets.clone(),
    };
    let resets: Vec<_> = assembly.events.iter().map(reset).collect();
    integrals.jump(&assembly.system, resets.iter().map(Vec::as_slice), projected);
}

/// The energy formed with all velocities, which a run observes, in terms of the independent velocities of the
/// equations.
fn energy_of_all<'g>(assembly: &Assembly<'g>, equations: &Equations<'g>) -> Option<Expr<'g>> {
    let (all, free) = (assembly.system.quasi_velocities(), equations.system().quasi_velocities());
    let values = assembly.quasi_velocities_of(free).ok()?;
    let known: Vec<(Expr<'g>, Expr<'g>)> = all.iter().copied().zip(values).collect();
    let graph = assembly.system.graph();
    Some(graph.substitute(&[assembly.system.energy()], &known)[0])
}

/// The largest number of functions with unknown coefficients in a brief search, which takes a few tenths of a second.
const MOST_BRIEFLY: usize = 150;

/// The integrals that the theory lists, with those found by the ansatz at the end, and the extent of the
/// search.
pub(crate) fn found<'g>(
    ground: &Basis<'_, 'g>,
    model: &Model,
    options: &TheoryOptions,
) -> Result<(Integrals<'g>, AnsatzSearch), ModelError> {
    let assembly = ground.assembly;
    let texts = options.functions.iter();
    let functions: Result<Vec<Expr<'g>>, ModelError> =
        texts.map(|text| model.function(assembly, text)).collect();
    let mut integrals = integrals_of(assembly, &ground.equations, &ground.near, false);
    let usual = PolynomialAnsatz::of_degree(options.degree);
    let most = options.extent.either(usual.most, MOST_BRIEFLY);
    let ansatz = PolynomialAnsatz { functions: functions?, most, ..usual };
    let made = ground.placed(integrals.add_polynomials(&ground.equations, &ground.near, &ansatz))?;
    drop_constraints(&mut integrals, assembly, &ground.equations);
    say_what_jumps(&mut integrals, assembly);
    Ok((integrals, made))
}

/// The section on the integrals, each with its verdict.
pub(crate) fn section<'g>(
    ground: &Basis<'_, 'g>,
    (integrals, made): &(Integrals<'g>, AnsatzSearch),
    options: &TheoryOptions,
) -> Section<'g> {
    let entry = |integral: &Integral<'g>| {
        let (verdict, words) = verdict(integral);
        let of_rate = match integral.verdict {
            ConservationVerdict::Rate { rate, .. } => {
                let rate = ground.free.graph().shorten(&[rate], ground.free.quasi_velocities())[0];
                Some((Side::rate_of(&integral.name), Side::of(rate)))
            }
            _ => None,
        };
        let constant = Side::symbol("const", "\\text{const}", "<mtext>const</mtext>");
        let formulas = [(Side::of(integral.value), constant)].into_iter().chain(of_rate).collect();
        let dependent = integral.dependent.then(|| "a function of those above".to_owned());
        let words = words.into_iter().chain(where_conserved(integral)).chain(dependent).collect();
        Entry { formulas, words, ..Entry::default() }.named(integral.name.clone()).with(verdict)
    };
    let mut entries: Vec<Entry<'g>> = integrals.list().iter().map(entry).collect();
    entries.push(Entry::words(tried(*made, options)));
    Section { key: "integrals", title: "Integrals", names: Vec::new(), entries }
}

/// The verdict on an integral: if its rate is not proved to vanish, numerical values at the start may refute
/// it.
fn verdict(integral: &Integral<'_>) -> (Verdict, Option<String>) {
    let between = integral.jumps.then(|| "between events".to_owned());
    match integral.verdict {
        ConservationVerdict::Conserved => (Verdict::Proved, between),
        ConservationVerdict::ConservedHere => (Verdict::ProvedHere, between),
        ConservationVerdict::BetweenJumps => (Verdict::Proved, Some("where it does not jump".to_owned())),
        ConservationVerdict::OnLevel { always: true } => (Verdict::Proved, between),
        ConservationVerdict::OnLevel { always: false } => (Verdict::ProvedHere, between),
        ConservationVerdict::NoFunction => {
            (Verdict::Open, Some("it is not a function of time and state alone".to_owned()))
        }
        ConservationVerdict::Rate { at_start, part_left, near, .. } => {
            let verdict = part_left.map_or(Verdict::Open, |left| Verdict::of(Identity::of(left)));
            let at_start = at_start.map(|rate| format!("its rate at the start is {}", short(rate, 4)));
            match (verdict, near) {
                (Verdict::Disproved { .. }, _) => (verdict, at_start),
                (_, Some(left)) => (Verdict::of(Identity::of(left)), at_start),
                // A vanishing number at one state is not a proof.
                (_, None) => (Verdict::Open, at_start),
            }
        }
    }
}

/// The level on which a function is conserved, in words.
fn where_conserved(integral: &Integral<'_>) -> Option<String> {
    level_in_words(integral).map(|level| match integral.verdict {
        ConservationVerdict::OnLevel { .. } => format!("where {level}, as at the start"),
        _ => format!("conserved where {level} (proved)"),
    })
}

/// The equations of the level on which a function is conserved, in words; `None` if there are none.
pub fn level_in_words(integral: &Integral<'_>) -> Option<String> {
    let equation = |equation: &LevelEquation<'_>| format!("{} = {}", equation.name, equation.value);
    let equations: Vec<String> = integral.level.iter().map(equation).collect();
    (!equations.is_empty()).then(|| equations.join(" and "))
}

/// The extent of the search by the ansatz, in words.
fn tried(made: AnsatzSearch, options: &TheoryOptions) -> String {
    let degree = options.degree;
    let times = match options.functions.as_slice() {
        [] => String::new(),
        functions => format!(", times 1, {}", functions.join(", ")),
    };
    match made {
        AnsatzSearch::Made { coefficients, functions } => format!(
            "looked for among {functions} functions: degree up to {degree} in the velocities, up to {coefficients} in the \
             coordinates (or in their sines and cosines){times}"
        ),
        AnsatzSearch::TooMany { functions } => format!(
            "no more are looked for: there are {functions} functions of degree up to {degree} in the velocities{times}"
        ),
        AnsatzSearch::TooLong => "no more are looked for: the equations are too long".to_owned(),
    }
}

/// The section on the displacements X = a_s X_s of those integrals that are linear in the momenta.
pub(crate) fn displacements<'g>(ground: &Basis<'_, 'g>, integrals: &Integrals<'g>) -> Section<'g> {
    let section = |entries| Section {
        key: "cyclic_displacements",
        title: "Cyclic displacements",
        names: Vec::new(),
        entries,
    };
    let Ok(canonical) = &ground.canonical else { return section(Vec::new()) };
    if ground.constrained.is_some() {
        return section(Vec::new()); // under constraints, symmetries of L alone give no integrals
    }
    let entry = |integral: &Integral<'_>| {
        let field = NoetherField::of(canonical, integral.value)?;
        let right = Side::written(|style| written(&ground.free, &field, style));
        let gauge = (!field.gauge.is_zero()).then(|| {
            let f = field.gauge.display(Style::Book);
            format!("L changes along it by a total derivative: to its momentum is added {f}")
        });
        let commutes = if field.commutes {
            "commutes with all operators: cyclic in Chetaev's sense"
        } else {
            "is not found to commute with all operators"
        };
        let mut entry = Entry::formula(Side::letter("X"), right).named(integral.name.clone());
        entry.words = [commutes.to_owned()].into_iter().chain(gauge).collect();
        Some(entry.with(if integral.verdict == ConservationVerdict::Conserved {
            Verdict::Proved
        } else {
            Verdict::ProvedHere
        }))
    };
    section(integrals.conserved().filter_map(entry).collect())
}

/// The text of a_s X_s, in which the operators of velocities are written ∂/∂x.
fn written(system: &System<'_>, field: &NoetherField<'_>, style: Style) -> String {
    let (frame, eta) = (system.frame(), system.quasi_velocities());
    let is_lagrange = frame.velocities(eta) == eta;
    let operator = |s: usize| {
        let name = if is_lagrange { frame.coordinates()[s] } else { eta[s] }.display(style);
        match (is_lagrange, style) {
            (true, Style::Latex) => format!("\\frac{{\\partial}}{{\\partial {name}}}"),
            (true, Style::Book | Style::Text) => format!("∂/∂{name}"),
            (false, Style::Latex) => format!("X_{{{name}}}"),
            (false, Style::Book | Style::Text) => format!("X_{name}"),
            (true, Style::MathMl) => mathml::partial(&name),
            (false, Style::MathMl) => mathml::operator(&name),
        }
    };
    if style == Style::MathMl {
        let terms = (0..).zip(&field.coefficients).filter(|(_, a)| !a.is_zero());
        let terms = terms.map(|(s, a)| (a.display(Style::Book), a.display(style), operator(s)));
        return mathml::combination(terms).into_iter().map(|(term, _)| term).collect();
    }
    let terms = field.coefficients.iter().enumerate();
    combination(terms.map(|(s, a)| (a.display(style), operator(s))))
}
