//! `pc import`: robots move like the same models written by hand, and errors are shown with
//! their place.

mod exported;
mod meshes;
mod mjcf;
mod motion;
mod quirks;
mod sdf;

use std::process::Command;

use pc_mech::VectorField;
use pc_model::Source;
use pc_model::import::model_of_urdf;

use motion::{alike, flow, imported, rates, text_of};

type Matrix = [[String; 3]; 3];

fn matrix(rows: [[&str; 3]; 3]) -> Matrix {
    rows.map(|row| row.map(|entry| format!("({entry})")))
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let entry = |i: usize, j: usize| {
        (0..3).map(|l| format!("{}*{}", a[i][l], b[l][j])).collect::<Vec<_>>().join(" + ")
    };
    std::array::from_fn(|i| std::array::from_fn(|j| format!("({})", entry(i, j))))
}

fn place(origin: &[String; 3], r: &Matrix, arm: [&str; 3]) -> [String; 3] {
    std::array::from_fn(|i| {
        let parts: Vec<String> = (0..3).map(|j| format!("{}*({})", r[i][j], arm[j])).collect();
        format!("{} + {}", origin[i], parts.join(" + "))
    })
}

fn body(name: &str, mass: f64, position: &[String; 3], inertia: &str, r: &Matrix) -> String {
    let list =
        |texts: &[String]| texts.iter().map(|text| format!("\"{text}\"")).collect::<Vec<_>>().join(", ");
    format!(
        "[bodies.{name}]\nmass = {mass:?}\nposition = [{}]\ninertia = {inertia}\nrotation = [{}]\n",
        list(position),
        list(&r.concat())
    )
}

/// The arm by positions: inertias along their principal axes, the elbow by Rodrigues' formula,
/// rotations by roll, pitch and yaw.
fn arm_by_hand() -> String {
    let a = matrix([["cos(a)", "-sin(a)", "0"], ["sin(a)", "cos(a)", "0"], ["0", "0", "1"]]);
    let yaw = matrix([["cos(0.2)", "sin(0.2)", "0"], ["-sin(0.2)", "cos(0.2)", "0"], ["0", "0", "1"]]);
    let pitch = matrix([["cos(0.1)", "0", "sin(0.1)"], ["0", "1", "0"], ["-sin(0.1)", "0", "cos(0.1)"]]);
    let roll = matrix([["1", "0", "0"], ["0", "0", "-1"], ["0", "1", "0"]]);
    let elbow = matrix([
        ["cos(e)", "-0.8*sin(e)", "0.6*sin(e)"],
        ["0.8*sin(e)", "cos(e) + 0.36*(1 - cos(e))", "0.48*(1 - cos(e))"],
        ["-0.6*sin(e)", "0.48*(1 - cos(e))", "cos(e) + 0.64*(1 - cos(e))"],
    ]);
    let forearm = product(&a, &product(&yaw, &product(&pitch, &product(&roll, &elbow))));
    let skew = matrix([["cos(0.3)", "-sin(0.3)", "0"], ["sin(0.3)", "cos(0.3)", "0"], ["0", "0", "1"]]);
    let shoulder = ["0".to_owned(), "0".to_owned(), "0.5".to_owned()];
    let at_elbow = place(&shoulder, &a, ["0.5", "0", "0"]);
    let finger = "[1e-4, 1e-4, 1e-4]";
    let bodies = [
        body(
            "upper",
            2.0,
            &place(&shoulder, &a, ["0.25", "0", "0.01"]),
            "[0.01, 0.05, 0.06, 0.002, 0.001, 0]",
            &product(&a, &skew),
        ),
        body("forearm", 1.0, &place(&at_elbow, &forearm, ["0.2", "0", "0"]), "[0.002, 0.02, 0.02]", &forearm),
        body("left", 0.1, &place(&at_elbow, &forearm, ["0.45", "0.02 + l", "0"]), finger, &forearm),
        body("right", 0.1, &place(&at_elbow, &forearm, ["0.45", "-0.02 - r", "0"]), finger, &forearm),
    ];
    format!(
        "[coordinates]\na = 0\ne = 0\nl = 0\nr = 0.01\n[gravity]\nacceleration = [0, 0, -9.81]\n\
         [constraints]\nfollows = \"r - l - 0.01\"\n[forces]\na = \"-0.7*a' - 0.1*sign(a')\"\n{}",
        bodies.concat()
    )
}

#[test]
fn an_arm_moves_as_by_hand() {
    let (text, left_out) = imported("arm", false);
    assert_eq!(
        left_out,
        [
            "one <transmission> is left out",
            "2 <gazebo> are left out",
            "no body has the principal moments of inertia 0.0099002, 0.05 and 0.0600998 of the link `upper arm`: one is \
             negative, or larger than the sum of the others"
        ]
    );
    for remark in [
        "# mesh: package://arm/meshes/upper.stl\n",
        "# limits of the joint elbow: lower -2, upper 2, effort 30, velocity 3\n",
        "# the link upper arm\n",
    ] {
        assert_eq!(text.matches(remark).count(), 1, "{text}");
    }
    let (mut urdf, mut hand) = (flow(&text), flow(&arm_by_hand()));
    assert_eq!(urdf.names[..3], ["shoulder_pan", "elbow", "left_finger"]);
    // By hand the right finger, which follows the left, has a coordinate and a constraint.
    let of_robot = |all: &[f64]| [&all[..3], &all[4..7]].concat();
    assert_eq!(urdf.start, of_robot(&hand.start));
    for state in [
        [0.0, 0.0, 0.0, 0.01, 0.0, 0.0, 0.0, 0.0],
        [0.7, -1.1, 0.02, 0.03, 0.5, -1.3, 0.2, 0.2],
        [-2.0, 2.5, 0.03, 0.04, 1.5, 2.3, -0.1, -0.1],
    ] {
        alike(&rates(&mut urdf, &of_robot(&state)), &of_robot(&rates(&mut hand, &state)));
    }
}

#[test]
fn a_rover_moves_as_by_hand() {
    let hand = "[gravity]\nacceleration = [0, 0, -9.81]\n\
        [bodies.hull]\njoint = { kind = \"free\" }\nmass = 20\ncenter = [0, 0, 0.1]\ninertia = [1, 2, 2.5]\n\
        [bodies.axle]\nparent = \"hull\"\njoint = { kind = \"revolute\", axis = [0, 1, 0], at = [0.5, 0.3, 0] }\nmass = 1\n\
        inertia = [0.01, 0.02, 0.01]\n\
        [bodies.probe]\nparent = \"hull\"\njoint = { kind = \"free\", at = [0, 0, 1] }\nmass = 0.5\ninertia = [0.01, 0.01, 0.01]\n\
        [bodies.plate]\nparent = \"hull\"\nmass = 0.5\ninertia = [0.01, 0.01, 0.02]\n\
        joint = { kind = \"planar\", axis = [0, 0, 1], at = [0, 0, 0.4], rotation = [0, -1, 0, 1, 0, 0, 0, 0, 1] }\n";
    let (mut urdf, mut hand) = (flow(&imported("rover", true).0), flow(hand));
    assert_eq!(urdf.start, hand.start);
    let mut state = urdf.start.clone();
    for (i, component) in state.iter_mut().enumerate() {
        // The components of quaternions, 3 to 6 and 11 to 14, stay unchanged.
        if !(3..7).contains(&i) && !(11..15).contains(&i) {
            *component += (i as f64 + 1.0).sin();
        }
    }
    alike(&rates(&mut urdf, &state), &rates(&mut hand, &state));
    // A fixed hull has no coordinates.
    assert_eq!(flow(&imported("rover", false).0).start.len(), urdf.start.len() - 13);
}

#[test]
fn the_program_writes_what_the_library_makes() {
    let directory = tempfile::tempdir().unwrap();
    let output = directory.path().join("arm.toml");
    let path = format!("{}/../../tests/robots/arm.urdf", env!("CARGO_MANIFEST_DIR"));
    let run =
        Command::new(env!("CARGO_BIN_EXE_pc")).args(["import", &path, "-o"]).arg(&output).output().unwrap();
    assert!(run.status.success());
    assert!(String::from_utf8(run.stderr).unwrap().starts_with("note: one <transmission> is left out\n"));
    let printed = Command::new(env!("CARGO_BIN_EXE_pc")).args(["import", &path]).output().unwrap();
    assert_eq!(std::fs::read(&output).unwrap(), printed.stdout);
    assert_eq!(String::from_utf8(printed.stdout).unwrap(), imported("arm", false).0);
    std::fs::write(&output, "<robot>").unwrap();
    let refused = Command::new(env!("CARGO_BIN_EXE_pc")).arg("import").arg(&output).output().unwrap();
    assert_eq!(refused.status.code(), Some(3));
}

#[test]
fn the_program_fixes_links_without_mass_on_request() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("r.urdf");
    std::fs::write(&file, quirks::ENDS).unwrap();
    let program = |options: &[&str]| {
        let run = Command::new(env!("CARGO_BIN_EXE_pc")).arg("import").arg(&file).args(options).output();
        let run = run.unwrap();
        (run.status.code(), String::from_utf8(run.stderr).unwrap())
    };
    let (code, complaint) = program(&[]);
    assert_eq!(code, Some(3));
    assert!(complaint.contains("or fix all such joints by `--fix-massless`"), "{complaint}");
    let (code, said) = program(&["--fix-massless"]);
    assert_eq!((code, said.lines().count()), (Some(0), 2), "{said}");
}

const LINK: &str = "<link name=\"a\"><inertial><mass value=\"1\"/>\n<inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial></link>\n";

/// A text that occurs in the robot, and the message.
const REFUSED: &[(&str, &str)] = &[
    (
        "<robot><link name='a'></robot>",
        "r.urdf:1:23: not valid XML: expected 'link' tag, not 'robot' at 1:23\n    <robot><link name='a'></robot>\n                          ^\n  help: the formats that can be imported are XML",
    ),
    (
        "<svg/>",
        "r.urdf:1:1: <svg>: the root is <svg>\n    <svg/>\n    ^^^^\n  help: the root of URDF is <robot>, that of MJCF <mujoco>, that of SDF <sdf>",
    ),
    (
        "<robot/>",
        "r.urdf:1:1: <robot>: there is no <link>\n    <robot/>\n    ^^^^^^\n  help: a robot has links and joints between them",
    ),
    (
        "<robot>\nLINK<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>\n</robot>",
        "r.urdf:4:1: <joint j>: its child, the link `b`, is not there\n    <joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>\n    ^^^^^^\n  help: declare the link, or correct its name",
    ),
    (
        "<robot>\nLINK<joint name=\"j\" type=\"screw\"><parent link=\"a\"/><child link=\"b\"/></joint>\n</robot>",
        "r.urdf:4:23: <joint j>: there is no joint of type `screw`\n    <joint name=\"j\" type=\"screw\"><parent link=\"a\"/><child link=\"b\"/></joint>\n                          ^^^^^\n  help: the types are fixed, revolute, continuous, prismatic, floating, planar, spherical, universal",
    ),
    (
        "<robot>\nLINK<joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"a\"/><axis xyz=\"0 0 0\"/></joint>\n</robot>",
        "r.urdf:4:79: <joint j>: the axis has length 0\n    …pe=\"revolute\"><parent link=\"a\"/><child link=\"a\"/><axis xyz=\"0 0 0\"/></joint>\n                                                                 ^^^^^\n  help: give it a direction, such as `0 0 1`",
    ),
    (
        "<robot>\nLINK<link name=\"b\"/>\n</robot>",
        "r.urdf:4:1: <link b>: `a` and `b` hang on nothing: there are two roots\n    <link name=\"b\"/>\n    ^^^^^\n  help: join them by a joint",
    ),
    (
        "<robot>\nLINK<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"a\"/></joint>\n</robot>",
        "r.urdf:2:1: <link a>: every link hangs on another: there is no root\n    <link name=\"a\"><inertial><mass value=\"1\"/>\n    ^^^^^\n  help: one link is the child of no joint",
    ),
    (
        "<robot>\nLINK<link name=\"b\"/>\n<joint name=\"j\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/></joint>\n</robot>",
        "r.urdf:4:1: <link b>: the link `b` can move, and neither it nor what hangs on it has mass\n    <link name=\"b\"/>\n    ^^^^^\n  help: give it an <inertial>, make its joint `fixed`, or fix all such joints by `--fix-massless`",
    ),
    (
        "<robot>\nLINK<joint name=\"j\" type=\"fixed\"><origin xyz=\"0 1\"/><parent link=\"a\"/><child link=\"b\"/></joint>\n</robot>",
        "r.urdf:4:43: <origin>: `0 1` is not three numbers\n    <joint name=\"j\" type=\"fixed\"><origin xyz=\"0 1\"/><parent link=\"a\"/><child link=\"b\"/></joint>\n                                              ^^^\n  help: write three numbers with spaces between them, such as `0 0 1`",
    ),
    (
        "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n<xacro:macro name=\"m\"/>\n</robot>",
        "r.urdf:2:1: <macro m>: it is a macro of xacro\n    <xacro:macro name=\"m\"/>\n    ^^^^^^^^^^^^\n  help: expand the macros first: `xacro robot.xacro > robot.urdf`",
    ),
    (
        "<robot>\nLINK\n<xacro:include filename=\"a.xacro\"/></robot>",
        "r.urdf:5:2: it is a macro of xacro\n    <xacro:include filename=\"a.xacro\"/></robot>\n     ^^^^^^^^^^^^^\n  help: expand the macros first: `xacro robot.xacro > robot.urdf`",
    ),
    (
        "<robot>\nLINK<link name=\"b\"><inertial><mass value=\"${2*m}\"/></inertial></link></robot>",
        "r.urdf:4:39: <mass>: `${2*m}` is an expression of xacro\n    <link name=\"b\"><inertial><mass value=\"${2*m}\"/></inertial></link></robot>\n                                          ^^^^^^\n  help: expand the macros first: `xacro robot.xacro > robot.urdf`",
    ),
    (
        "<robot>\nLINK<gazebo><plugin>\n  <file>$(find arm)/a.yaml</file></plugin></gazebo></robot>",
        "r.urdf:5:9: <file>: `$(find arm)` is an expression of xacro\n      <file>$(find arm)/a.yaml</file></plugin></gazebo></robot>\n            ^^^^^^^^^^^\n  help: expand the macros first: `xacro robot.xacro > robot.urdf`",
    ),
    (
        "<robot>\nLINK<link name=\"b\"/>\n<joint name=\"j\" type=\"fixed\"><origin quat_xyzw=\"0 0 0 2\"/><parent link=\"a\"/><child link=\"b\"/></joint>\n</robot>",
        "r.urdf:5:49: <joint j>: the length of the quaternion is 2\n    <joint name=\"j\" type=\"fixed\"><origin quat_xyzw=\"0 0 0 2\"/><parent link=\"a\"/><child link=\"b\"/></joint>\n                                                    ^^^^^^^\n  help: it is 1: x, y, z are the axis times sin(φ/2), w is cos(φ/2)",
    ),
    (
        "<robot>\nLINK<link name=\"b\"/>\n<joint name=\"j\" type=\"universal\"><parent link=\"a\"/><child link=\"b\"/></joint>\n</robot>",
        "r.urdf:5:1: <joint j>: it has no <axis2>\n    <joint name=\"j\" type=\"universal\"><parent link=\"a\"/><child link=\"b\"/></joint>\n    ^^^^^^\n  help: write <axis2 xyz=\"0 1 0\"/>: the body turns about <axis>, then about <axis2>",
    ),
    (
        "<robot>\nLINK<link name=\"b\"/>\n<joint name=\"j\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/></joint>\n<link name=\"c\"/>\n<joint name=\"k\" type=\"revolute\"><parent link=\"a\"/><child link=\"c\"/><mimic joint=\"j\"/></joint>\n</robot>",
        "r.urdf:4:1: <link b>: the link `b` can move, and neither it nor what hangs on it has mass\n    <link name=\"b\"/>\n    ^^^^^\n  help: `k` mimics its joint: let that move by itself, and mimic it",
    ),
];

#[test]
fn what_is_wrong_is_shown_where_it_stands() {
    let mut complaints = Vec::new();
    for (text, message) in REFUSED {
        let source = Source::new("r.urdf", text.replace("LINK", LINK));
        match model_of_urdf(&source, false) {
            Ok((text, _)) => complaints.push(format!("{message}\nis accepted:\n{text}")),
            Err(error) if error.to_string().trim_end() != *message => {
                complaints.push(format!("{error}\ninstead of\n{message}"));
            }
            Err(_) => {}
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n\n"));
}

/// A link of mass 2 on a joint, on a base that stands.
fn on_joint(joint: &str) -> String {
    format!(
        r#"<robot name="r"><link name="base"/>
        <link name="l"><inertial><mass value="2"/><inertia ixx="0.5" ixy="0" ixz="0" iyy="0.5" iyz="0" izz="0.5"/></inertial></link>
        {joint}</robot>"#
    )
}

/// m v̇ = −d v + m g and I ω̇ = −d ω, each velocity of a joint with several of them: a planar joint normal to y falls along −z = −`x`
/// of its plane, a free body along −z.
#[test]
fn each_velocity_of_a_joint_is_damped() {
    let joint = |kind: &str| {
        on_joint(&format!(
            r#"<joint name="j" type="{kind}"><parent link="base"/><child link="l"/><axis xyz="0 1 0"/>
            <dynamics damping="3"/></joint>"#
        ))
    };
    let mut planar = flow(&text_of(&joint("planar")).0);
    alike(
        &rates(&mut planar, &[0.0, 0.0, 0.0, 0.1, 0.2, 0.3])[3..],
        &[-9.81 - 1.5 * 0.1, -1.5 * 0.2, -6.0 * 0.3],
    );
    let mut free = flow(&text_of(&joint("floating")).0);
    let start = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.1, 0.2, 0.0, 0.0];
    alike(
        &rates(&mut free, &start)[7..],
        // v̇ = g − ω × v − d v/m in body axes
        &[0.0, 0.2 * 0.1, -9.81 - 1.5 * 0.1, -6.0 * 0.2, 0.0, 0.0],
    );
}

/// A joint may be called what would be the name of another's damping, or of a coordinate of a body.
#[test]
fn names_made_of_others_are_not_taken() {
    let urdf = r#"<robot name="r"><link name="base"/>
        <link name="l"><inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
        <link name="k"><inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
        <link name="h"><inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
        <joint name="a" type="planar"><parent link="base"/><child link="l"/><axis xyz="0 1 0"/><dynamics damping="3"/></joint>
        <joint name="l_x" type="revolute"><parent link="l"/><child link="k"/><dynamics damping="0.5"/></joint>
        <joint name="l_x_damping" type="revolute"><parent link="k"/><child link="h"/></joint></robot>"#;
    let (text, left_out) = text_of(urdf);
    assert!(left_out.is_empty(), "{left_out:?}");
    assert_eq!(
        flow(&text).motion.names()[..5],
        ["l__z", "l__x", "l__φ", "l_x", "l_x_damping"].map(str::to_owned)
    );
    assert!(text.contains("damping = \"l_x_damping_\""), "{text}");
}

/// A joint that does not move follows nothing.
#[test]
fn a_fixed_joint_does_not_mimic() {
    let (text, left_out) = text_of(
        r#"<robot name="r"><link name="base"/>
        <link name="l"><inertial><mass value="1"/><origin xyz="0.1 0 0"/>
        <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link><link name="k"/>
        <joint name="a" type="revolute"><parent link="base"/><child link="l"/><axis xyz="0 1 0"/></joint>
        <joint name="b" type="fixed"><parent link="l"/><child link="k"/><axis xyz="0 1 0"/><mimic joint="a"/></joint></robot>"#,
    );
    assert_eq!(left_out, ["the joint `b` is fixed: that it mimics `a` is left out"]);
    // (I + m r²) ä = m g r cos a
    alike(&rates(&mut flow(&text), &[0.3, 0.0]), &[0.0, 9.81 * 0.1 * 0.3_f64.cos() / 0.11]);
}

/// A finger without mass that follows an arm: a pendulum of length 0.3 with the moments m r² + I, by the energy.
#[test]
fn a_link_without_mass_may_follow_another() {
    let urdf = r#"<robot name="r"><link name="base"/><link name="arm"><inertial><mass value="2"/><origin xyz="0.3 0 0"/>
<inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link><link name="tip"/>
<joint name="a" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/></joint>
<joint name="b" type="revolute"><parent link="arm"/><child link="tip"/><axis xyz="0 1 0"/><mimic joint="a" multiplier="2"/></joint></robot>"#;
    let (text, left_out) = model_of_urdf(&Source::new("r.urdf", urdf), false).unwrap();
    assert!(left_out.is_empty(), "{left_out:?}");
    let mut flow = flow(&text);
    assert_eq!(flow.names[..2], ["a", "a'"]);
    let (a, rate) = (0.4, 1.5);
    let mut rates = [f64::NAN; 2];
    flow.motion.rhs(0.0, &[a, rate], &mut rates).unwrap();
    let expected = 2.0 * 9.81 * 0.3 * f64::cos(a) / (2.0 * 0.09 + 0.1);
    assert!((rates[1] - expected).abs() < 1e-12 * expected, "{rates:?}");
}
