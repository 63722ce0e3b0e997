//! Rates and their derivatives by recursion over the joints, against those of the whole mass matrix.

use super::*;

#[test]
fn joint_after_joint_is_the_whole_tree_at_once() {
    trees(12, 3, derivatives_agree);
}

#[test]
fn joint_after_joint_is_the_whole_geared_tree_at_once() {
    geared(12, 4, derivatives_agree);
    geared(12, 5, derivatives_agree);
}

/// A direction along which quaternions keep their norm: off the spheres the two derivations are different
/// functions.
fn along_spheres(bodies: &[Hung], y: &[f64], numbers: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut direction: Vec<f64> = numbers.take(y.len()).collect();
    let mut first = 0;
    for body in bodies {
        let quaternion = match body.kind {
            7 => first..first + 4,
            8 => first + 3..first + 7,
            _ => 0..0,
        };
        first += body.sizes().0;
        let q = &y[quaternion.clone()];
        let across: f64 = q.iter().zip(&direction[quaternion.clone()]).map(|(q, v)| q * v).sum();
        direction[quaternion.clone()].iter_mut().zip(q).for_each(|(v, q)| *v -= across * q);
    }
    direction
}

/// Rates, Jacobian and its products by the recursion and by the whole mass matrix.
fn derivatives_agree(bodies: &[Hung], numbers: &[f64]) {
    let graph = Graph::new();
    let system = hung(&graph, bodies, true);
    let equations = system.poincare().unwrap();
    let y = state(bodies, numbers);
    let direction = along_spheres(bodies, &y, numbers.iter().rev().copied());
    let derivatives = |elimination: TreeElimination| {
        let options = CompileOptions::default().jvp(true).elimination(elimination);
        let mut motion = equations.compile_for(options).unwrap();
        let n = y.len();
        let (mut jacobian, mut product) = (vec![0.0; n * n], vec![0.0; n]);
        motion.jacobian(0.0, &y, &mut jacobian).unwrap();
        motion.jvp(0.0, &y, &direction, &mut product).unwrap();
        let by_columns = (0..n).map(|i| (0..n).map(|j| jacobian[j * n + i] * direction[j]).sum()).collect();
        (motion.rates(0.0, &y).unwrap(), product, by_columns)
    };
    let (by_joints, whole) = (derivatives(TreeElimination::ByJoints), derivatives(TreeElimination::Whole));
    assert!(difference(&by_joints.0, &whole.0) < ROUNDING);
    let products: [Vec<f64>; 4] = [by_joints.1, by_joints.2, whole.1, whole.2];
    assert!(products.iter().all(|product| difference(product, &products[0]) < ROUNDING));
}

/// Along an axis with three components the constants of the equations are rounded; with eleven unknowns an
/// intermediate result may have the value of a shorter one that contains accelerations.
#[test]
fn the_jacobian_of_a_chain_with_oblique_axes_is_that_of_its_rates() {
    for axis in [[0.1, 0.9, 0.4], [-0.35, 0.8, 0.5]] {
        let joints = [(7, [0.0; 3]), (4, [-0.6, 0.3, 0.1]), (8, [0.5, -0.7, -0.2])];
        let bodies: Vec<Hung> = joints
            .iter()
            .enumerate()
            .map(|(i, &(kind, place))| Hung {
                kind,
                axes: [axis; 2],
                parent: i.checked_sub(1),
                place,
                tilt: [0.0; 3],
                mass: 0.8 + i as f64,
                centre: [0.13, -0.21, 0.34 - 0.2 * i as f64],
                spread: [[0.5, 0.1, 0.2], [-0.3, 0.4, 0.1], [0.1, 0.2, 0.6]],
                follows: None,
                drive: None,
            })
            .collect();
        let graph = Graph::new();
        let system = hung(&graph, &bodies, true);
        let equations = system.poincare().unwrap();
        let y = state(&bodies, &(0..24).map(|i| (0.9 * f64::from(i) + 0.4).sin()).collect::<Vec<_>>());
        let n = y.len();
        for elimination in [TreeElimination::ByJoints, TreeElimination::Whole, TreeElimination::Shorter] {
            let options = CompileOptions::default().elimination(elimination);
            let mut motion = equations.compile_for(options).unwrap();
            let mut jacobian = vec![0.0; n * n];
            motion.jacobian(0.0, &y, &mut jacobian).unwrap();
            let mut quotients = Vec::with_capacity(n * n);
            for j in 0..n {
                let h = 1e-4;
                let mut beside = |steps: f64| {
                    let mut y = y.clone();
                    y[j] += steps * h;
                    motion.rates(0.0, &y).unwrap()
                };
                let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(&mut beside);
                // Of fourth order in h.
                quotients.extend((0..n).map(|i| (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * h)));
            }
            let worst = difference(&jacobian, &quotients);
            assert!(worst < 1e-9, "{elimination:?} along {axis:?}: {worst}");
        }
    }
}
