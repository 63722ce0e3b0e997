//! Models written as robots in URDF and read again.

use pc_model::export::urdf_of_model;
use pc_model::import::{ImportOptions, model_of_robot};
use pc_model::{Document, Model, Source};

use super::motion::{alike, flow, imported, rates, text_of};

fn exported(text: &str) -> Result<(String, Vec<String>), String> {
    let document =
        Document::parse(Source::new("m.toml", text)).unwrap_or_else(|error| panic!("{error}\n{text}"));
    urdf_of_model(&Model::new(document)).map_err(|error| error.to_string())
}

/// A robot that is written and read again has the same accelerations.
#[test]
fn what_is_written_and_read_again_moves_the_same() {
    for (text, joints) in [(imported("crane", false).0, 4), (imported("rover", false).0, 0)] {
        let (urdf, notes) = exported(&text).unwrap();
        assert!(
            notes.iter().all(|note| note.starts_with("prismatic") || note.starts_with("the start")),
            "{notes:?}"
        );
        let again = text_of(&urdf).0;
        let (mut one, mut two) = (flow(&text), flow(&again));
        assert_eq!(one.names, two.names, "{urdf}");
        let mut state = one.start.clone();
        // Coordinates and velocities of joints with one coordinate; those of others start where they are.
        let half = state.len() / 2;
        for place in 0..joints {
            state[place] = 0.3 + 0.2 * place as f64;
            state[half + place] = 0.5 - 0.3 * place as f64;
        }
        alike(&rates(&mut one, &state), &rates(&mut two, &state));
    }
}

const ARM: &str = r#"
[model]
name = "An arm & \"more\""
[parameters]
g = 9.81
m = 1.5
a = 0.3
c = 0.2
[coordinates]
e = 0.4
[gravity]
acceleration = [0, 0, "-g"]
[bodies.upper]
joint = { kind = "revolute", axis = [0, 1, 0], at = [0, 0, "2*a"], turns = [["z", "a"], ["x", 0.5]], coordinates = ["s"] }
mass = "m"
center = [0, 0, "-a/2"]
inertia = ["m*a^2/12", "m*a^2/12", 0.001, 1e-4, 2e-4, 3e-4]
[bodies.fore]
parent = "upper"
joint = { kind = "revolute", axis = [0.6, 0, 0.8], at = [0, 0, "-a"], coordinates = ["e"] }
mass = "m/2"
center = [0, 0.1, "-a/2"]
inertia = [0.01, 0.01, 0.002]
[bodies.slider]
parent = "fore"
joint = { kind = "prismatic", axis = [0, 0, 1], rotation = [0, -1, 0, 1, 0, 0, 0, 0, 1] }
mass = 0.3
[forces]
s = "-c*s'"
"e'" = "-2*c*e' - 0.1*e'"
"#;

#[test]
fn an_arm_is_written() {
    let (urdf, notes) = exported(ARM).unwrap();
    assert_eq!(
        notes,
        ["the start is not a part of URDF", "prismatic joints have the limits 1e9, for URDF requires some"]
    );
    insta::assert_snapshot!("arm", urdf);
    let (mut one, mut two) = (flow(ARM), flow(&text_of(&urdf).0));
    let state = [0.7, -0.4, 0.2, 1.1, -0.8, 0.5];
    let found = rates(&mut one, &state);
    alike(&found, &rates(&mut two, &state));
    // Pinocchio 4.1.0 (`pinocchio.aba`), which reads the URDF, with the torques −d x' of its dampers.
    alike(&found[3..], &[-15.284043205925858, -4.677782822339115, -7.471979216973415]);
}

/// What replaces what in the arm, and the message.
const REFUSED: &[(&str, &str, &str)] = &[
    (
        "s = \"-c*s'\"",
        "s = \"-c*s' + cos(e)\"",
        "m.toml:29:6: [forces] s: the force on `s` is not that of a damper\n    s = \"-c*s' + cos(e)\"\n         ^^^^^^^^^^^^^^\n  help: URDF has dampers of joints only, such as \"-0.1*x'\" on `x`",
    ),
    (
        "[forces]",
        "[lagrangian]\npotential = \"s^2\"\n[forces]",
        "m.toml:29:14: [lagrangian] potential: an energy besides that of bodies and weight has no place in URDF\n    potential = \"s^2\"\n                 ^^^\n  help: URDF has bodies on joints with dampers, friction and limits; leave the rest out",
    ),
    (
        "kind = \"prismatic\", axis = [0, 0, 1]",
        "kind = \"spherical\"",
        "[bodies.slider] joint: the joint of `slider` has no place in URDF",
    ),
    (
        "[forces]",
        "[constraints]\ntie = \"s - e + 0.4\"\n[forces]",
        "m.toml:29:1: [constraints] tie: a constraint has no place in URDF",
    ),
];

#[test]
fn what_has_no_place_is_named() {
    let mut complaints = Vec::new();
    for (part, other, message) in REFUSED {
        let text = ARM.replace(part, other);
        match exported(&text) {
            Ok((urdf, _)) => complaints.push(format!("{message}\nis written:\n{urdf}")),
            Err(error) if !error.contains(message) => {
                complaints.push(format!("{error}\ninstead of\n{message}"));
            }
            Err(_) => {}
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n\n"));
}

/// Limits become stops on request, except of joints that start beyond them; written as URDF they are limits again.
#[test]
fn limits_become_stops_and_limits_again() {
    let link = |name: &str| {
        format!(
            "<link name=\"{name}\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" \
             izz=\"1\"/></inertial></link>\n"
        )
    };
    let joint = |name: &str, parent: &str, child: &str, limits: [f64; 2]| {
        format!(
            "<joint name=\"{name}\" type=\"revolute\"><parent link=\"{parent}\"/><child link=\"{child}\"/><axis xyz=\"0 1 0\"/>\
             <limit lower=\"{:?}\" upper=\"{:?}\" effort=\"1\" velocity=\"1\"/><dynamics damping=\"0.1\" friction=\"0.2\"/></joint>\n",
            limits[0], limits[1]
        )
    };
    let urdf = format!(
        "<robot name=\"r\"><link name=\"base\"/>\n{}{}{}{}</robot>",
        link("a"),
        link("b"),
        joint("s", "base", "a", [-1.5, 0.5]),
        joint("e", "a", "b", [0.2, 2.0])
    );
    let options = ImportOptions { restitution: Some(0.25), ..ImportOptions::default() };
    let (text, notes) = model_of_robot(&Source::new("r.urdf", urdf), options).unwrap();
    assert_eq!(notes, ["the joint `e` starts beyond its limits, which are left out"]);
    assert!(text.contains(", limits = [-1.5, 0.5], restitution = 0.25"), "{text}");
    assert!(text.contains("# limits of the joint e: lower 0.2, upper 2"), "{text}");
    assert_eq!(pc_expr::Events::events(&flow(&text).events).len(), 2);
    let (again, notes) = exported(&text).unwrap();
    assert_eq!(notes, ["how stops push back or rebound is not a part of URDF"]);
    let expected = [
        "<joint name=\"s\" type=\"revolute\">",
        "<limit lower=\"-1.5\" upper=\"0.5\" effort=\"1e9\" velocity=\"1e9\"/>",
        "<dynamics damping=\"0.1\" friction=\"0.2\"/>",
        "<joint name=\"e\" type=\"continuous\">",
    ];
    expected.iter().for_each(|part| assert!(again.contains(part), "{part} in {again}"));
}
