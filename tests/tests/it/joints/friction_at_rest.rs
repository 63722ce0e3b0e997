//! Joints that dry friction holds at rest.

use std::fmt::Write;
use std::ops::ControlFlow;

use pc_solve::{Method, Options, Solve};

use super::run::{flow, model};

/// Four fingers of four joints, each with more friction than the weight of the finger has torque about its root.
fn hand() -> String {
    let mut text = String::from("[gravity]\nacceleration = [0, 0, -9.81]\n");
    for i in 0..16 {
        let (parent, at) = match i % 4 {
            0 => (String::new(), format!("[0, {:?}, 0]", 0.05 * f64::from(i / 4))),
            _ => (format!("parent = \"f{}\"\n", i - 1), "[0.1, 0, 0]".to_owned()),
        };
        writeln!(
            text,
            "[bodies.f{i}]\n{parent}joint = {{ kind = \"revolute\", axis = [0, 1, 0], at = {at}, damping = 0.01, friction = 1.0 }}\n\
             mass = 0.1\ncenter = [0.05, 0, 0]\ninertia = [1e-4, 1e-4, 1e-4]"
        )
        .unwrap();
    }
    text
}

/// After two steps, none is shorter than a thousandth of a second.
#[test]
fn a_hand_at_rest_takes_long_steps() {
    let mut flow = flow(&model(&hand()));
    let start = flow.start.clone();
    let mut ends = vec![0.0];
    let observed = |t: f64, _: &[f64]| {
        ends.push(t);
        ControlFlow::Continue(())
    };
    let options = Options::new(Method::Auto);
    let solve = Solve::new(&mut flow.motion, 0.0, &start).method(&options);
    solve.run_observed(&[1000.0], observed).map_err(|failure| failure.error).unwrap();
    let steps: Vec<f64> = ends.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert_eq!(ends.last(), Some(&1000.0));
    // Nothing that moves tells how long a first step may be: it is short, and the next ones grow sixfold.
    let shortest = steps[2..].iter().copied().fold(f64::INFINITY, f64::min);
    println!("{} steps, the first {:?}, the shortest after them {shortest}", steps.len(), &steps[..2]);
    assert!(shortest > 1e-3, "a step of {shortest} s");
}
