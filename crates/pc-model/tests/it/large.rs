//! Many nearly independent coordinates: vanishing terms cost nothing, so that these tests end.

use pc_mech::{Graph, VectorField};
use pc_model::{Document, Model, Source};

/// Oscillators in quasi-velocities ω_i = ẋ_i, in the given potential.
fn chain(n: usize, potential: impl Fn(usize) -> String) -> Model {
    let list = |entry: &dyn Fn(usize) -> String| (0..n).map(entry).collect::<Vec<_>>();
    let text = format!(
        "[coordinates]\n{}\n[quasi_velocities]\n{}\n[kinematics]\n{}\n[lagrangian]\nkinetic = \"{}\"\npotential = \"{}\"\n",
        list(&|i| format!("x{i} = {}", start(i))).join("\n"),
        list(&|i| format!("w{i} = 0.0")).join("\n"),
        list(&|i| format!("x{i} = \"w{i}\"")).join("\n"),
        list(&|i| format!("w{i}^2/2")).join(" + "),
        list(&|i| potential(i)).join(" + "),
    );
    Model::new(Document::parse(Source::new("chain.toml", text)).unwrap_or_else(|error| panic!("{error}")))
}

fn start(i: usize) -> f64 {
    0.1 + (i % 7) as f64 / 8.0
}

/// With 400 of them, computing brackets, ranks, factors and Jacobian for each pair or triple would take
/// minutes.
#[test]
fn four_hundred_oscillators() {
    const N: usize = 400;
    let neighbour = |i: usize| (i + 1) % N;
    let alone = chain(N, |i| format!("x{i}^2/2"));
    let coupled = chain(N, |i| format!("(x{i} - x{})^2/2", neighbour(i)));
    for (model, is_coupled) in [(alone, false), (coupled, true)] {
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(assembly.system.structure().nonzero().count(), 0);
        let equations = assembly.equations().expect("regular");
        let mut motion = equations.compile().expect("defined");
        let y: Vec<f64> = (0..N).map(start).chain(vec![0.0; N]).collect();
        let (mut rates, mut jacobian) = (vec![0.0; 2 * N], vec![0.0; 4 * N * N]);
        motion.rhs(0.0, &y, &mut rates).expect("regular");
        motion.jacobian(0.0, &y, &mut jacobian).expect("regular");
        for i in 0..N {
            let (before, after) = (start((i + N - 1) % N), start(neighbour(i)));
            let force = if is_coupled { before - 2.0 * start(i) + after } else { -start(i) };
            assert!((rates[N + i] - force).abs() < 1e-14, "{i}"); // a few roundings
            assert_eq!(jacobian[i * 2 * N + N + i], if is_coupled { -2.0 } else { -1.0 });
        }
        assert_eq!(jacobian.iter().filter(|&&x| x != 0.0).count(), if is_coupled { 4 * N } else { 2 * N });
    }
}
