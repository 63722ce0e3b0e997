//! The output of `pc derive` and `pc check`.

use std::process::Command;

use serde_json::Value;

fn pc(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).output().expect("pc starts");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

fn json(arguments: &[&str]) -> Value {
    serde_json::from_str(&pc(&[arguments, &["--format", "json"]].concat())).expect("JSON")
}

#[test]
fn derived_equations_as_an_object() {
    let object = json(&["derive", "heavy-top-euler", "--set", "r1=0.5"]);
    assert_eq!(object["coordinates"], serde_json::json!(["ψ", "θ", "φ"]));
    assert_eq!(object["quasi_velocities"], serde_json::json!(["ω1", "ω2", "ω3"]));
    assert_eq!(object["parameters"]["r1"], 0.5);
    assert_eq!(object["kinematics"]["b"].as_array().map(Vec::len), Some(3));
    assert_eq!(object["kinematics"]["b_0"], serde_json::json!(["0", "0", "0"]));
    let so3 = serde_json::json!([
        { "r": "ω1", "s": "ω2", "m": "ω3", "value": "1" },
        { "r": "ω1", "s": "ω3", "m": "ω2", "value": "-1" },
        { "r": "ω2", "s": "ω3", "m": "ω1", "value": "1" },
    ]);
    assert_eq!(object["structure_coefficients"], so3);
    assert_eq!(object["mass_matrix"][0], serde_json::json!(["I1", "0", "0"]));
    assert_eq!(object["equations"].as_array().map(Vec::len), Some(3));
    assert!(object["energy"].as_str().expect("text").contains("I1"));
    for kind in ["free", "bound"] {
        let operations = object["operations"][kind].as_object().expect("an object");
        let sum: u64 =
            operations.iter().filter(|(name, _)| *name != "total").filter_map(|(_, n)| n.as_u64()).sum();
        assert_eq!(operations["total"].as_u64(), Some(sum), "{kind}");
        assert_eq!(operations["sin"], 2, "sin θ and sin φ, once each");
    }
    let total = |kind: &str| object["operations"][kind]["total"].as_u64();
    assert!(total("bound") < total("free"));
}

#[test]
fn time_is_called_0_in_an_object_and_t_in_print() {
    let object = json(&["derive", "damped-oscillator-scaled-frame"]);
    let first = &object["structure_coefficients"][0];
    assert_eq!(first["r"], "0");
    let name = first["s"].as_str().expect("text");
    assert!(pc(&["derive", "damped-oscillator-scaled-frame"]).contains(&format!("[t, {name}] = ")));
}

#[test]
fn derived_equations_in_print() {
    let text = pc(&["derive", "heavy-top-lagrange"]);
    for line in ["γ1' = γ2 ω3 - γ3 ω2", "[ω1, ω2] = ω3", "diag(I1, I2, I3)", "I3 ω3' = ", "½ I1 ω1²"]
    {
        assert!(text.contains(line), "{line} not in {text}");
    }
}

#[test]
fn integrals_are_proved_or_not() {
    let verdict = |model: &str, settings: &[&str], name: &str| {
        let report = json(&[&["check", model], settings].concat());
        let integrals = report["integrals"].as_array().expect("a list").clone();
        let integral = integrals.into_iter().find(|integral| integral["name"] == name).expect("the integral");
        integral["verdict"].as_str().expect("text").to_owned()
    };
    assert_eq!(verdict("heavy-top-lagrange", &[], "area"), "conserved (proved)");
    assert_eq!(verdict("heavy-top-lagrange", &[], "energy"), "conserved (proved)");
    assert_eq!(verdict("heavy-top-lagrange", &[], "spin"), "conserved for these parameters (proved)");
    assert!(
        verdict("heavy-top-lagrange", &["--set", "I1=2"], "spin")
            .starts_with("not conserved: changes at the rate ")
    );
    assert!(verdict("damped-oscillator", &[], "energy").contains("changes at the rate 0.75"));
}

#[test]
fn momenta_of_cyclic_displacements_are_found() {
    let model = "[parameters]\nA = 1\nC = 2\nmgl = 3\n[coordinates]\ng1 = 0\ng2 = 0\ng3 = 1\n[quasi_velocities]\nw1 = 1\n\
                 w2 = 0\nw3 = 1\n[kinematics]\ng1 = \"g2*w3 - g3*w2\"\ng2 = \"g3*w1 - g1*w3\"\ng3 = \"g1*w2 - g2*w1\"\n\
                 [algebra]\nname = \"so3\"\n[lagrangian]\nkinetic = \"(A*(w1^2 + w2^2) + C*w3^2)/2\"\n\
                 potential = \"mgl*g3\"\n";
    let path = std::env::temp_dir().join(format!("pc-cyclic-{}.toml", std::process::id()));
    std::fs::write(&path, model).expect("a file");
    let report = json(&["check", path.to_str().expect("UTF-8")]);
    std::fs::remove_file(&path).expect("the file");
    let integrals = report["integrals"].as_array().expect("a list").clone();
    let found = integrals.into_iter().find(|found| found["name"] == "momentum of w3").expect("the momentum");
    assert_eq!(found["expression"], "C*w3");
    assert_eq!(found["how"], "cyclic displacement");
    assert!(found["verdict"].as_str().expect("text").contains("(proved)"));
}

#[test]
fn a_check_as_an_object() {
    let report = json(&["check", "heavy-top-lagrange"]);
    assert_eq!(report["rank"], 2);
    assert_eq!(report["closure_residual"], 0.0);
    assert_eq!(report["jacobi_residual"], 0.0);
    assert_eq!(report["start_residual"], 0.0);
    assert_eq!(report["constraints"], serde_json::json!([]));
    assert_eq!(report["integrals"][0]["how"], "declared; a Casimir");
    let text = pc(&["check", "heavy-top-lagrange"]);
    assert!(text.contains("2 of 3") && text.contains("so3") && text.contains("rank 3 of 3"), "{text}");
}

#[test]
fn canonical_equations_in_print() {
    let text = pc(&["derive", "heavy-top-euler", "--form", "canonical"]);
    for line in [
        "Heavy top in Euler's angles: canonical equations",
        "θ' = p_ω1 cos(φ)/I1 - p_ω2 sin(φ)/I2",
        "p_ω1 = I1 ω1",
        "p_ω1²/(2 I1) + p_ω2²/(2 I2) + p_ω3²/(2 I3) + mg (r1 sin(φ) sin(θ) + r2 cos(φ) sin(θ) + r3 γ3)",
        "γ3 = cos(θ)",
        "p_ω1' = r3 mg cos(φ) sin(θ) - r2 mg γ3 + p_ω2 p_ω3 (1/I3 - 1/I2)",
    ] {
        assert!(text.contains(line), "{line} not in {text}");
    }
    let page = pc(&["derive", "heavy-top-euler", "--form", "canonical", "--format", "latex"]);
    assert!(page.contains(r"\dot{p}_{\omega_{1}} &= "), "{page}");
    let object = json(&["derive", "heavy-top-euler", "--form", "canonical"]);
    assert_eq!(object["momenta"], serde_json::json!(["p_ω1", "p_ω2", "p_ω3"]));
    assert_eq!(object["closed"], true);
    assert_eq!(object["quasi_velocities_of_momenta"][2], "p_ω3/I3");
    assert_eq!(object["operations"]["free"]["sin"], 2);
}

#[test]
fn canonical_equations_that_are_not_closed_in_print() {
    let text = pc(&["derive", "relativistic-particle", "--form", "canonical"]);
    for line in [
        "Momenta\n  p_η1 = η1/sqrt(1 - (η1² + η2²)/c²)\n",
        "Hamiltonian\n  c² sqrt(1 - (η1² + η2²)/c²) - κ/ρ + η1 p_η1 + η2 p_η2\n",
        "p_η1' = η2 p_η2/ρ - κ/ρ²",
        "p_η2' = -η1 p_η2/ρ",
        "Operations of one right-hand side, quasi-velocities known",
    ] {
        assert!(text.contains(line), "{line} not in {text}");
    }
    let page = pc(&["derive", "relativistic-particle", "--form", "canonical", "--format", "latex"]);
    for line in [r"\paragraph{Momenta.}", r"p_{\eta_{1}} &= \frac{", r"\dot{p}_{\eta_{2}} &= "] {
        assert!(page.contains(line), "{line} not in {page}");
    }
    let object = json(&["derive", "relativistic-particle", "--form", "canonical"]);
    assert_eq!(object["closed"], false);
    assert_eq!(object["quasi_velocities_of_momenta"], Value::Null);
    assert_eq!(object["momenta_of_velocities"][0], "η1/sqrt(1 - (η1^2 + η2^2)/c^2)");
    assert_eq!(object["velocities"], serde_json::json!(["η1", "η2/ρ"]));
    assert_eq!(object["operations"]["free"]["sqrt"], Value::Null);
}

#[test]
fn lagranges_equations_in_print() {
    let text = pc(&["derive", "heavy-top-euler", "--form", "lagrange"]);
    for line in
        ["Lagrange's equations", "all operators commute", "M(φ', ψ') = I3 γ3", "I3 ψ'' γ3 + I3 φ'' = "]
    {
        assert!(text.contains(line), "{line} not in {text}");
    }
    let output = Command::new(env!("CARGO_BIN_EXE_pc"))
        .args(["derive", "heavy-top-quaternion", "--form", "lagrange"])
        .output()
        .expect("pc starts");
    assert_eq!(output.status.code(), Some(4));
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    let expected =
        "Lagrange's equations need independent coordinates; here 4 coordinates move with 3 quasi-velocities";
    assert!(message.contains(expected), "{message}");
}
