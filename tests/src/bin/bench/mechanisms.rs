//! Of `bench trees`: what is no chain of links on alternating axes.

use std::fs;
use std::time::Instant;

use pc_mech::{
    CompileOptions, Expr, Graph, Joint, MechError, Motion, System, Tree, TreeBody, TreeElimination,
    VectorField,
};
use pc_model::{Builtin, Document, Flow, Model, Source, Variables};

use crate::error::Error;
use crate::hand::{self, Routine};
use crate::measure::{Variant, interleave};
use crate::report::Report;

/// Links of the pendulum in a plane.
const LINKS: usize = 32;

/// Derived and by hand may differ by this, relative to the largest component.
const ROUNDING: f64 = 1e-10;

const SQUEEZER: &str = include_str!("../../../mechanisms/squeezer-loop.toml");

/// Unit masses on unit links, gravity 10: a tree whose angles are those between links.
fn planar(graph: &Graph) -> Result<System<'_>, MechError> {
    let name = |i: usize| format!("q{i}");
    let body = |i: usize| {
        let at = if i == 0 { [0, 0, 0] } else { [0, 0, -1] };
        let body = TreeBody::new(name(i), Joint::revolute([0.0, 1.0, 0.0]).at(at)).mass(1).centre([0, 0, -1]);
        if i == 0 { body } else { body.on(name(i - 1)) }
    };
    let tree = Tree::new(graph, (0..LINKS).map(body))?;
    System::builder(graph)
        .coordinates((0..LINKS).map(name))
        .gravity(|_| [Expr::ZERO, Expr::ZERO, (-10).into()])
        .tree(tree)
        .build()
}

/// The pendulum in a plane as a tree, against its tensions eliminated by hand.
///
/// # Errors
/// If they disagree, or something cannot be derived.
pub(crate) fn pendulum(report: &mut Report) -> Result<(), Error> {
    let graph = Graph::new();
    let options = CompileOptions::default().jacobian(false);
    let mut motion = planar(&graph)?.poincare()?.compile_for(options)?;
    let operations = motion.cost().total() as f64 / LINKS as f64;
    let code = motion.machine_code().ok_or_else(|| Error::Kernel {
        kernel: "jit",
        system: format!("pendulum of {LINKS} links"),
        cause: "there is no machine code".to_owned(),
    })?;
    let mut derived = Routine::of_motion(&code, motion.code_parameters().unwrap_or_default());
    let mut by_hand = Routine::from(hand::pendulum_by_tensions(LINKS));
    // Angles from the vertical and between links, and their rates.
    let angles: Vec<f64> = (0..2 * LINKS).map(|i| (0.7 * i as f64).sin()).collect();
    let between = |all: &[f64]| -> Vec<f64> {
        (0..all.len()).map(|i| if i % LINKS == 0 { all[i] } else { all[i] - all[i - 1] }).collect()
    };
    let (mut expected, mut found) = (vec![0.0; 2 * LINKS], vec![0.0; 2 * LINKS]);
    by_hand.call(&angles, &mut expected);
    derived.call(&between(&angles), &mut found);
    let expected = between(&expected);
    let size = expected.iter().fold(1.0f64, |size, v| size.max(v.abs()));
    for (component, (a, b)) in found.iter().zip(&expected).enumerate() {
        let error = (a - b).abs() / size;
        if error.is_nan() || error > ROUNDING {
            return Err(Error::Disagreement {
                system: format!("pendulum of {LINKS} links"),
                variant: "derived".to_owned(),
                reference: "by hand".to_owned(),
                component,
                error,
                state: angles,
            });
        }
    }
    let mut variants = vec![
        Variant::new("by hand", Box::new(move |y: &[f64], dy: &mut [f64]| by_hand.call(y, dy))),
        Variant::new("derived", Box::new(move |y: &[f64], dy: &mut [f64]| derived.call(y, dy))),
    ];
    let times = interleave(&angles, &mut variants);
    report.line(format!(
        "\nplanar pendulum of {LINKS} links as a tree: {operations:.1} operations a link, {:.0} ns, by hand {:.0} ns, ratio {:.2}",
        times[1].median(),
        times[0].median(),
        times[1].ratio_to(&times[0])
    ));
    Ok(())
}

/// Mechanisms with loops, joint after joint and with the mass matrix bordered by the conditions.
///
/// # Errors
/// If one cannot be derived.
pub(crate) fn loops(report: &mut Report) -> Result<(), Error> {
    let builtin = |name: &'static str| {
        Builtin::named(name).ok_or(Error::NoModel { name })?.document().map_err(Error::from)
    };
    let mechanisms = [
        ("four-bar", builtin("four-bar-loop")?),
        ("slider-crank", builtin("slider-crank-loop")?),
        ("squeezer", Document::parse(Source::new("squeezer-loop.toml", SQUEEZER))?),
        ("Stewart's platform", builtin("stewart-platform")?),
    ];
    report.line("");
    report.columns(&[
        "loops",
        "whole matrix, ns",
        "by joints, ns",
        "/ whole",
        "chosen, ns",
        "J, µs",
        "f a column",
    ]);
    for (name, document) in mechanisms {
        let model = Model::new(document);
        let graph = model.graph();
        let assembly = model.assemble(&graph)?;
        let Some(held) = assembly.constraints.held() else { continue };
        let compiled = |elimination| -> Result<Motion, Error> {
            let options = CompileOptions::default().jacobian(false).elimination(elimination);
            Ok(held.compile_for(options)?)
        };
        let mut variants = Vec::new();
        for (name, elimination) in [
            ("whole", TreeElimination::Whole),
            ("by joints", TreeElimination::ByJoints),
            ("chosen", TreeElimination::Shorter),
        ] {
            let mut motion = compiled(elimination)?;
            motion.rhs(assembly.t_start, &assembly.start, &mut vec![0.0; assembly.start.len()])?;
            let call = move |y: &[f64], dy: &mut [f64]| {
                if motion.rhs(0.0, y, dy).is_err() {
                    dy.fill(0.0); // the state wanders off a little
                }
            };
            variants.push(Variant::new(name, Box::new(call)));
        }
        let mut with_jacobian = held.compile()?;
        let n = assembly.start.len();
        let mut entries = vec![0.0; n * n];
        with_jacobian.jacobian(assembly.t_start, &assembly.start, &mut entries)?;
        let jacobian = move |y: &[f64], dy: &mut [f64]| {
            if with_jacobian.jacobian(0.0, y, &mut entries).is_err() {
                entries.fill(0.0);
            }
            dy.copy_from_slice(&entries[entries.len() - dy.len()..]);
        };
        variants.push(Variant::new("J", Box::new(jacobian)));
        let times = interleave(&assembly.start, &mut variants);
        report.row(&[
            name.to_owned(),
            format!("{:.0}", times[0].median()),
            format!("{:.0}", times[1].median()),
            format!("{:.2}", times[1].ratio_to(&times[0])),
            format!("{:.0}", times[2].median()),
            format!("{:.1}", times[3].median() / 1e3),
            format!("{:.2}", times[3].ratio_to(&times[2]) / n as f64),
        ]);
    }
    Ok(())
}

/// The text of a chain of so many links.
fn text(links: usize) -> String {
    let mut text = "[gravity]\nacceleration = [0, 0, -9.81]\n".to_owned();
    for i in 0..links {
        let (axis, at) =
            (if i % 2 == 0 { "[1, 0, 0]" } else { "[0, 1, 0]" }, if i == 0 { "0" } else { "-1" });
        let parent = if i == 0 { String::new() } else { format!("parent = \"q{}\"\n", i - 1) };
        text += &format!(
            "[bodies.q{i}]\n{parent}joint = {{ kind = \"revolute\", axis = {axis}, at = [0, 0, {at}] }}\nmass = 1\n\
             center = [0, 0, -0.5]\ninertia = [0.10, 0.12, 0.05]\n"
        );
    }
    text
}

/// From the text of a long chain to what is integrated, and the most memory that this process has held.
///
/// # Errors
/// If the model is refused.
pub(crate) fn from_text(report: &mut Report, links: usize) -> Result<(), Error> {
    let text = text(links);
    let start = Instant::now();
    let model = Model::new(Document::parse(Source::new("chain.toml", &text))?);
    let graph = model.graph();
    let assembly = model.assemble(&graph)?;
    let mut flow = Flow::new(&model, &assembly, Variables::QuasiVelocities)?;
    let begin = flow.start.clone();
    flow.motion.rhs(0.0, &begin, &mut vec![0.0; begin.len()])?;
    let seconds = start.elapsed().as_secs_f64();
    let peak =
        peak_memory().map_or_else(|| "not known here".to_owned(), |bytes| format!("{:.0} MB", bytes / 1e6));
    report.line(format!(
        "\ntext of {links} links to their motion: {:.0} ms, peak memory {peak}",
        seconds * 1e3
    ));
    Ok(())
}

/// The most bytes that this process has held, where the system says so.
fn peak_memory() -> Option<f64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok().map(|kilobytes| 1024.0 * kilobytes)
}
