//! Columns of a table under constraints.

use super::{SLEIGH, SLIP, SPHERE, agree, pc, run, stderr, stdout};

#[test]
fn all_declared_quasi_velocities_are_columns() {
    let slip = run(SLIP, &[]);
    assert_eq!(slip.0, ["t", "x", "y", "phi", "v", "u", "omega", "energy"]);
    assert!(slip.1.iter().all(|row| row[5] == 0.0), "u stays zero");
    let sleigh = run(SLEIGH, &[]);
    assert_eq!(sleigh.0, ["t", "x", "y", "phi", "v", "omega", "energy"]);
    agree(&sleigh, &slip, 1e-7);
    let sphere = run(SPHERE, &[]);
    assert_eq!(sphere.0, ["t", "x", "y", "z", "x'", "y'", "z'", "area", "energy"]);
    for row in &sphere.1 {
        assert!((row[1].hypot(row[2]).hypot(row[3]) - 1.0).abs() < 1e-14, "projected to rounding");
        assert!((row[1] * row[4] + row[2] * row[5] + row[3] * row[6]).abs() < 1e-14);
    }
}

/// The state has only momenta of the free velocities, but all quasi-velocities are columns.
#[test]
fn the_canonical_form_has_the_same_columns() {
    for model in [SLEIGH, SLIP, SPHERE] {
        let (usual, canonical) = (run(model, &[]), run(model, &["--form", "canonical"]));
        assert_eq!(usual.0, canonical.0);
        agree(&usual, &canonical, 1e-6);
    }
    // All momenta are components of the state, so no velocities are chosen and the constraints are
    // kept.
    let text = stderr(&pc(SPHERE, &["run", "-", "--form", "canonical"]));
    assert!(!text.contains("note:"), "{text}");
    assert!(text.contains("\n  held     length  to "), "{text}");
}

/// On a moving belt, ẏ = V + x, the energy in all velocities grows by the work of the belt; every
/// form gives the same column, ½ (1 + (V + x)²) with x = t.
#[test]
fn the_energy_is_that_of_all_velocities_in_every_form() {
    let belt = "[coordinates]\nx = 0.0\ny = 0.0\n[quasi_velocities]\n\"x'\" = 1.0\n\"y'\" = 2.0\n[constraints]\n\
                belt = \"y' - 2 - x\"\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n[simulation]\nt_end = 1.0\nsamples = 3\n";
    for form in ["poincare", "canonical"] {
        let (names, rows) = run(belt, &["--form", form]);
        assert_eq!(names, ["t", "x", "y", "x'", "y'", "energy"]);
        for row in rows {
            let expected = (1.0 + (2.0 + row[0]).powi(2)) / 2.0;
            assert!((row[5] - expected).abs() < 1e-8, "{form}: {row:?}"); // the tolerance of the run is 1e-9
        }
    }
    let derived = stdout(&pc(SLEIGH, &["derive", "-", "--form", "canonical"]));
    assert!(derived.contains("only along the constraints, which are not integrable"), "{derived}");
}

/// The reaction of the blade along the motion is λ = v ω (m − m² a²/(m a² + J)).
#[test]
fn reactions_are_columns_on_request() {
    let (names, rows) = run(SLEIGH, &["--outputs", "reactions"]);
    assert_eq!(names, ["t", "x", "y", "phi", "v", "omega", "energy", "λ_blade"]);
    let share = 1.0 - 0.09 / (0.09 + 0.5);
    for row in rows {
        assert!((row[7] - row[4] * row[5] * share).abs() < 1e-14, "{row:?}");
    }
}

#[test]
fn forces_on_bodies_are_columns_beside_the_reactions() {
    let pendulum = "[coordinates]\nx = 0.6\nz = -0.8\n[bodies.bob]\nmass = 2\nposition = [\"x\", 0, \"z\"]\n\
                    force = [0, 0, -19.6]\n[constraints]\nlength = \"x^2 + z^2 - 1\"\n[simulation]\nt_end = 1.0\nsamples = 5\n";
    let (names, rows) = run(pendulum, &["--outputs", "reactions"]);
    let columns = ["λ_length", "F_length_bob_x", "F_length_bob_y", "F_length_bob_z"];
    assert_eq!(names[names.len() - 4..], columns);
    for row in &rows {
        // The rod pulls along itself with m g cos θ + m l θ̇².
        let tension = -19.6 * row[2] + 2.0 * (row[3].powi(2) + row[4].powi(2));
        assert!(
            (row[7] + tension * row[1]).abs() < 1e-12 && (row[9] + tension * row[2]).abs() < 1e-12,
            "{row:?}"
        );
    }
    agree(&run(pendulum, &["--outputs", "reactions", "--form", "canonical"]), &(names, rows), 1e-6);
    let tied = pendulum
        .replace("[constraints]", "[bodies.end]\nmass = 1\nposition = [\"2*x\", 0, 0]\n[constraints]");
    let text = stderr(&pc(&tied, &["run", "-", "--outputs", "reactions"]));
    let note = "note: the force on `bob`, the force on `end` of the reactions are left out: the choice of coordinates ties \
                velocities of bodies together, and virtual work does not tell forces between them\n";
    assert!(text.starts_with(note), "{text}");
}
