//! `bench trees`: chains of revolute links as trees of bodies, against an articulated-body algorithm by hand.

use std::time::Instant;

use pc_mech::{CompileOptions, Expr, Graph, Joint, MechError, Motion, System, Tree, TreeBody, VectorField};
use pc_tests::classical::SplitMix64;

use crate::error::Error;
use crate::hand::{self, Routine};
use crate::measure::{Variant, interleave};
use crate::mechanisms;
use crate::report::Report;
use crate::robots;

/// Derived and by hand may differ by this, relative to the largest component: rounding grows along a chain with the condition of
/// its mass matrix, about as the square of its length.
const ROUNDING: f64 = 1e-11;

const LENGTHS: [usize; 7] = [5, 10, 20, 50, 100, 200, 1000];

/// The chain that the code by hand is of.
fn chain(graph: &Graph, links: usize) -> Result<System<'_>, MechError> {
    let name = |i: usize| format!("q{i}");
    let body = |i: usize| {
        let axis = if i.is_multiple_of(2) { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
        let at = if i == 0 { [0, 0, 0] } else { [0, 0, -1] };
        let body = TreeBody::new(name(i), Joint::revolute(axis).at(at))
            .mass(1)
            .centre([0.into(), 0.into(), Expr::ratio(-1, 2)])
            .inertia([0.10, 0.12, 0.05]);
        if i == 0 { body } else { body.on(name(i - 1)) }
    };
    let tree = Tree::new(graph, (0..links).map(body))?;
    System::builder(graph)
        .coordinates((0..links).map(name))
        .gravity(|_| [0.into(), 0.into(), (-9.81).into()])
        .tree(tree)
        .build()
}

/// A chain derived and compiled, and the seconds that took.
fn derived(links: usize) -> Result<(Motion, f64), Error> {
    let start = Instant::now();
    let graph = Graph::new();
    let options = CompileOptions::default().jacobian(false);
    let motion = chain(&graph, links)?.poincare()?.compile_for(options)?;
    Ok((motion, start.elapsed().as_secs_f64()))
}

/// Times them.
///
/// # Errors
/// If something cannot be derived, or derived and written equations disagree.
pub(crate) fn run(report: &mut Report) -> Result<(), Error> {
    report.columns(&[
        "links",
        "operations a link",
        "derived, ms",
        "by hand, ns a link",
        "derived, ns a link",
        "/ hand",
    ]);
    let mut measured = Vec::new();
    let mut at_100 = f64::NAN;
    for links in LENGTHS {
        let (mut motion, seconds) = derived(links)?;
        let operations = motion.cost().total() as f64 / links as f64;
        let mut routine = Routine::from(hand::chain(links));
        let mut random = SplitMix64::new(links as u64);
        let state: Vec<f64> = (0..2 * links).map(|_| random.uniform(-1.0, 1.0)).collect();
        let code = motion.machine_code();
        let machine_code = code.ok_or_else(|| Error::Kernel {
            kernel: "jit",
            system: format!("chain of {links} links"),
            cause: "there is no machine code".to_owned(),
        })?;
        let mut compiled = Routine::of_motion(&machine_code, motion.code_parameters().unwrap_or_default());
        let mut variants = vec![
            Variant::new("by hand", Box::new(move |y: &[f64], dy: &mut [f64]| routine.call(y, dy))),
            Variant::new("derived", Box::new(move |y: &[f64], dy: &mut [f64]| compiled.call(y, dy))),
        ];
        compare(links, &state, &mut variants)?;
        let times = interleave(&state, &mut variants);
        let ratio = times[1].ratio_to(&times[0]);
        let each = times[1].median() / links as f64;
        measured.push((links, each));
        if links == 100 {
            at_100 = ratio;
        }
        report.row(&[
            links.to_string(),
            format!("{operations:.1}"),
            format!("{:.1}", seconds * 1e3),
            format!("{:.1}", times[0].median() / links as f64),
            format!("{each:.1}"),
            format!("{ratio:.2}"),
        ]);
        motion.rhs(0.0, &state, &mut vec![0.0; state.len()])?;
    }
    mechanisms::from_text(report, LENGTHS[LENGTHS.len() - 1])?;
    mechanisms::pendulum(report)?;
    mechanisms::loops(report)?;
    robots::run(report)?;
    let of =
        |links: usize| measured.iter().find(|(count, _)| *count == links).map_or(f64::NAN, |(_, each)| *each);
    let exponent = 1.0 + (of(200) / of(20)).ln() / 10f64.ln();
    report.line(format!(
        "\nchain: {:.1} ns a link, ratio to hand {at_100:.2} at N = 100, exponent {exponent:.2}",
        of(100)
    ));
    Ok(())
}

fn compare(links: usize, state: &[f64], variants: &mut [Variant<'_>]) -> Result<(), Error> {
    let reference = variants[0].at(state);
    let found = variants[1].at(state);
    let size = reference.iter().fold(1.0f64, |size, v| size.max(v.abs()));
    for (component, (a, b)) in found.iter().zip(&reference).enumerate() {
        let error = (a - b).abs() / size;
        if error.is_nan() || error > ROUNDING {
            return Err(Error::Disagreement {
                system: format!("chain of {links} links"),
                variant: variants[1].name.clone(),
                reference: variants[0].name.clone(),
                component,
                error,
                state: state.to_vec(),
            });
        }
    }
    Ok(())
}
