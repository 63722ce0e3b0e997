//! Robots in SDF: frames, joints that close loops, links that nothing holds, and what is refused.

use pc_model::Source;
use pc_model::import::{ImportOptions, model_of_robot};

use super::motion::{alike, flow, rates};

fn model_of(text: &str) -> (String, Vec<String>) {
    let source = Source::new("robot.sdf", text);
    model_of_robot(&source, ImportOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// The accelerations of Pinocchio 4.1.0 (`pinocchio.aba`) for the same robot in URDF.
#[test]
fn a_crane_moves_as_in_pinocchio() {
    let path = format!("{}/../../tests/robots/crane.sdf", env!("CARGO_MANIFEST_DIR"));
    let (text, notes) = model_of(&std::fs::read_to_string(path).unwrap());
    assert_eq!(notes, ["one <plugin> is left out"]);
    insta::assert_snapshot!("crane", text);
    let mut flow = flow(&text);
    assert_eq!(flow.names[..4], ["slew", "luff", "run", "swing"]);
    for (state, accelerations) in [
        (
            [0.3, -0.6, 0.2, 0.9, 0.5, -0.4, 0.7, 1.1],
            [-4.86584593825671, 7.651112810138749, 3.729434608793924, 10.653160254226455],
        ),
        (
            [-2.0, 0.8, -0.1, -1.7, -1.3, 2.1, -0.5, 0.4],
            [-4.543983170480644, 6.118488137707767, -5.386759541794178, -10.08897339173296],
        ),
    ] {
        alike(&rates(&mut flow, &state)[4..], &accelerations);
    }
}

const MASS: &str = "<inertial><pose>0 0 0.15 0 0 0</pose><mass>0.5</mass><inertia><ixx>0.004</ixx><iyy>0.004</iyy>\
                    <izz>0.001</izz></inertia></inertial>";

/// The four bars of four-bars.xml without a motor: twice the joint of the coupler has the child `coupler`.
#[test]
fn a_second_parent_closes_a_loop() {
    let path = format!("{}/../../tests/robots/four-bars.xml", env!("CARGO_MANIFEST_DIR"));
    let source = Source::new("four-bars.xml", std::fs::read_to_string(path).unwrap());
    let (by_mujoco, _) = model_of_robot(&source, ImportOptions::default()).unwrap();
    let sdf = format!(
        r#"<sdf version="1.7"><world name="w"><gravity>0 0 -9.81</gravity><model name="bars">
        <link name="crank">{MASS}</link>
        <link name="coupler"><pose>0 0 0.3 0 0 0</pose><inertial><pose>0.4 0 0.1 0 0 0</pose><mass>1.2</mass>
        <inertia><ixx>0.01</ixx><iyy>0.05</iyy><izz>0.05</izz></inertia></inertial></link>
        <link name="rocker"><pose>0.8 0 0.5 0 0 0</pose><inertial><pose>0 0 -0.25 0 0 0</pose><mass>0.8</mass>
        <inertia><ixx>0.02</ixx><iyy>0.02</iyy><izz>0.003</izz></inertia></inertial></link>
        <joint name="crank_joint" type="revolute"><parent>world</parent><child>crank</child><axis><xyz>0 1 0</xyz></axis></joint>
        <joint name="coupler_joint" type="revolute"><parent>crank</parent><child>coupler</child><axis><xyz>0 1 0</xyz></axis></joint>
        <joint name="rocker_joint" type="revolute"><pose>0 0 -0.5 0 0 0</pose><parent>world</parent><child>rocker</child>
        <axis><xyz>0 1 0</xyz><dynamics><damping>0.2</damping></dynamics></axis></joint>
        <joint name="pin" type="revolute"><pose relative_to="rocker">0 0 0 0 0 0</pose><parent>rocker</parent><child>coupler</child>
        <axis><xyz>0 1 0</xyz></axis></joint>
        </model></world></sdf>"#
    );
    let (text, notes) = model_of(&sdf);
    assert!(notes.is_empty(), "{notes:?}");
    insta::assert_snapshot!("four_bars", text);
    let (mut one, mut two) = (flow(&by_mujoco), flow(&text));
    alike(&rates(&mut one, &[0.0; 6]), &rates(&mut two, &[0.0; 6]));
}

/// A universal joint with a spring, a screw, and a ball: as the joints of a text written by hand.
#[test]
fn joints_of_several_kinds_move_as_by_hand() {
    let sdf = format!(
        r#"<sdf version="1.10"><model name="m"><link name="post"/><joint name="f" type="fixed"><parent>world</parent><child>post</child></joint>
        <link name="a">{MASS}</link><link name="b">{MASS}</link><link name="c">{MASS}</link>
        <joint name="u" type="universal"><parent>post</parent><child>a</child><axis><xyz>1 0 0</xyz><dynamics><damping>0.1</damping>
        <spring_stiffness>3</spring_stiffness><spring_reference>0.4</spring_reference></dynamics></axis>
        <axis2><xyz>0 1 0</xyz></axis2></joint>
        <joint name="s" type="screw"><pose>0 0 0.1 0 0 0</pose><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis>
        <screw_thread_pitch>0.05</screw_thread_pitch></joint>
        <joint name="k" type="ball"><parent>b</parent><child>c</child></joint></model></sdf>"#
    );
    let (text, notes) = model_of(&sdf);
    assert_eq!(notes, ["the link `post` has the mass 1 and the moments 1, the defaults of SDF"]);
    let hand = r#"
[gravity]
acceleration = [0, 0, -9.81]
[bodies.a]
joint = { kind = "universal", axes = [[1, 0, 0], [0, 1, 0]] }
mass = 0.5
center = [0, 0, 0.15]
inertia = [0.004, 0.004, 0.001]
[bodies.b]
parent = "a"
joint = { kind = "screw", axis = [0, 0, 1], pitch = "0.05/(2*pi)", at = [0, 0, 0.1] }
mass = 0.5
center = [0, 0, 0.05]
inertia = [0.004, 0.004, 0.001]
[bodies.c]
parent = "b"
joint = { kind = "spherical", at = [0, 0, -0.1] }
mass = 0.5
center = [0, 0, 0.15]
inertia = [0.004, 0.004, 0.001]
[lagrangian]
potential = "3*(a_1 - 0.4)^2/2"
[forces]
a_1 = "-0.1*a_1'"
"#;
    let (mut one, mut two) = (flow(&text), flow(hand));
    assert_eq!(one.names[..7], ["u_1", "u_2", "s", "c_q0", "c_q1", "c_q2", "c_q3"]);
    let state = [0.3, -0.4, 1.1, 0.5, 0.5, -0.5, 0.5, 0.7, -0.2, 0.9, 1.2, -0.8, 0.4];
    alike(&rates(&mut one, &state), &rates(&mut two, &state));
}

/// Links without a joint fly, models that are static stand.
#[test]
fn links_that_nothing_holds_are_free() {
    let (text, _) = model_of(&format!(
        r#"<sdf version="1.6"><world name="w"><model name="one"><pose>1 2 3 0 0 1</pose><link name="l">{MASS}</link></model>
        <model name="ground"><static>true</static><link name="l">{MASS}</link></model></world></sdf>"#
    ));
    insta::assert_snapshot!("free_links", text);
    let mut flow = flow(&text);
    assert_eq!(flow.names.len(), 13);
    let start = flow.start.clone();
    // The default of SDF is 9.8; the mass centre falls along the fixed axis z.
    alike(&rates(&mut flow, &start)[7..], &[0.0, 0.0, -9.8, 0.0, 0.0, 0.0]);
}

/// A model, and the message.
const REFUSED: &[(&str, &str)] = &[
    (
        "<sdf version=\"1.4\"><model name=\"m\"/></sdf>",
        "r.sdf:1:15: <sdf>: the version 1.4 of SDF is not known here\n    <sdf version=\"1.4\"><model name=\"m\"/></sdf>\n                  ^^^\n  help: the versions are 1.5 and later",
    ),
    (
        "<sdf version=\"1.9\"><include><uri>model://a</uri></include></sdf>",
        "r.sdf:1:20: <include>: the contents of another file belong here\n    <sdf version=\"1.9\"><include><uri>model://a</uri></include></sdf>\n                       ^^^^^^^^\n  help: write the file with what it includes first: `gz sdf -p robot.sdf`",
    ),
    (
        "<sdf version=\"1.9\"><model name=\"m\"><link name=\"a\"><pose relative_to=\"b\"/></link></model></sdf>",
        "r.sdf:1:36: <link a>: there is no frame `b` in this model\n    <sdf version=\"1.9\"><model name=\"m\"><link name=\"a\"><pose relative_to=\"b\"/></link></model></sdf>\n                                       ^^^^^\n  help: name a link, a joint or a frame of the model, or `__model__`",
    ),
    (
        "<sdf version=\"1.9\"><model name=\"m\"><link name=\"a\"/><link name=\"b\"/>\n<joint name=\"j\" type=\"gearbox\"><parent>a</parent><child>b</child></joint></model></sdf>",
        "r.sdf:2:23: <joint j>: a joint of type `gearbox` has no place here\n    <joint name=\"j\" type=\"gearbox\"><parent>a</parent><child>b</child></joint></model></sdf>\n                          ^^^^^^^\n  help: the types are revolute, continuous, prismatic, screw, ball, universal, revolute2, fixed",
    ),
    (
        "<sdf version=\"1.9\"><model name=\"m\"><link name=\"a\"/>\n<frame name=\"f\"><pose relative_to=\"g\"/></frame><frame name=\"g\"><pose relative_to=\"f\"/></frame>\n<joint name=\"j\" type=\"ball\"><pose relative_to=\"f\"/><parent>world</parent><child>a</child></joint></model></sdf>",
        "r.sdf:2:48: <frame g>: the pose of `f` is given in terms of itself\n    <frame name=\"f\"><pose relative_to=\"g\"/></frame><frame name=\"g\"><pose relative_to=\"f\"/></frame>\n                                                   ^^^^^^\n  help: give one of the poses in `__model__`",
    ),
    (
        "<sdf version=\"1.9\"><model name=\"m\"><link name=\"a\"/><link name=\"b\"/>\n<joint name=\"i\" type=\"prismatic\"><parent>world</parent><child>b</child><axis/></joint>\n<joint name=\"j\" type=\"prismatic\"><parent>a</parent><child>b</child><axis/></joint></model></sdf>",
        "r.sdf:3:1: <joint j>: it closes a loop, for `b` hangs on another joint already\n    <joint name=\"j\" type=\"prismatic\"><parent>a</parent><child>b</child><axis/></joint></model></sdf>\n    ^^^^^^\n  help: revolute, ball and fixed joints can close loops",
    ),
];

#[test]
fn what_is_wrong_is_shown_where_it_stands() {
    let mut complaints = Vec::new();
    for (text, message) in REFUSED {
        match model_of_robot(&Source::new("r.sdf", *text), ImportOptions::default()) {
            Ok((text, _)) => complaints.push(format!("{message}\nis accepted:\n{text}")),
            Err(error) if error.to_string().trim_end() != *message => {
                complaints.push(format!("{error}\ninstead of\n{message}"));
            }
            Err(_) => {}
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n\n"));
}
