//! A model of bodies on joints written again without joints: each body by its position and rotation matrix, which are made in
//! `[definitions]` from what a joint is, and kinematics of quaternions written out. Both move alike.

use std::fmt::Write;

use pc_model::document::{Document, Expression, JointKind, JointRotation, TreeBody};
use pc_model::{Builtin, Model};

use super::run::{difference, document, flow, rates};

type Vector = [String; 3];
type Matrix = [Vector; 3];

fn sum(terms: impl IntoIterator<Item = String>) -> String {
    let terms: Vec<String> = terms.into_iter().filter(|term| term != "0").collect();
    if terms.is_empty() { "0".into() } else { terms.join(" + ") }
}

fn times(a: &str, b: &str) -> String {
    match (a, b) {
        ("0", _) | (_, "0") => "0".into(),
        ("1", x) | (x, "1") => format!("({x})"),
        (a, b) => format!("({a})*({b})"),
    }
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| sum((0..3).map(|l| times(&a[i][l], &b[l][j])))))
}

fn apply(a: &Matrix, v: &Vector) -> Vector {
    std::array::from_fn(|i| sum((0..3).map(|j| times(&a[i][j], &v[j]))))
}

fn unit() -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { "1".into() } else { "0".into() }))
}

/// The turn about a coordinate axis.
fn about(axis: usize, angle: &str) -> Matrix {
    let mut turn = unit();
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    (turn[next][next], turn[last][last]) = (format!("cos({angle})"), format!("cos({angle})"));
    (turn[next][last], turn[last][next]) = (format!("-sin({angle})"), format!("sin({angle})"));
    turn
}

/// The rotation by a unit quaternion, entry by entry.
fn by_quaternion(q: &[String]) -> Matrix {
    let [a, b, c, d] = [&q[0], &q[1], &q[2], &q[3]];
    [
        [
            format!("1 - 2*({c}^2 + {d}^2)"),
            format!("2*({b}*{c} - {a}*{d})"),
            format!("2*({b}*{d} + {a}*{c})"),
        ],
        [
            format!("2*({b}*{c} + {a}*{d})"),
            format!("1 - 2*({b}^2 + {d}^2)"),
            format!("2*({c}*{d} - {a}*{b})"),
        ],
        [
            format!("2*({b}*{d} - {a}*{c})"),
            format!("2*({c}*{d} + {a}*{b})"),
            format!("1 - 2*({b}^2 + {c}^2)"),
        ],
    ]
}

fn texts(list: Option<&[Expression; 3]>) -> Vector {
    list.map_or(["0".into(), "0".into(), "0".into()], |list| list.each_ref().map(|part| part.text.clone()))
}

/// The number of the coordinate axis that a joint has.
fn axis(body: &TreeBody, number: usize) -> usize {
    let axis = body.joint.axes[number];
    let place = axis.iter().position(|&part| part == 1.0).unwrap();
    assert_eq!(axis.iter().map(|part| part.abs()).sum::<f64>(), 1.0, "{}", body.name.text);
    place
}

struct Hand<'a> {
    document: &'a Document,
    definitions: String,
    kinematics: String,
}

impl Hand<'_> {
    fn define(&mut self, name: String, value: &str) -> String {
        writeln!(self.definitions, "{name} = \"{value}\"").unwrap();
        name
    }

    /// Slide and turn of a joint, in its axes.
    fn motion(&self, body: &TreeBody) -> (Vector, Matrix) {
        let x: Vec<String> = body.joint.coordinates.iter().map(|name| name.text.clone()).collect();
        let still = || ["0".into(), "0".into(), "0".into()];
        let along = |axis: usize, by: &str| -> Vector {
            std::array::from_fn(|i| if i == axis { by.to_owned() } else { "0".into() })
        };
        match body.joint.kind {
            JointKind::Fixed => (still(), unit()),
            JointKind::Revolute => (still(), about(axis(body, 0), &x[0])),
            JointKind::Prismatic => (along(axis(body, 0), &x[0]), unit()),
            JointKind::Universal => {
                (still(), product(&about(axis(body, 0), &x[0]), &about(axis(body, 1), &x[1])))
            }
            JointKind::Spherical => (still(), by_quaternion(&x)),
            JointKind::Free => ([x[0].clone(), x[1].clone(), x[2].clone()], by_quaternion(&x[3..])),
            kind => panic!("{kind:?}: the models of the library have none"),
        }
    }

    /// The definitions of rotation and place of a body, after those of the one it hangs on.
    fn place(&mut self, number: usize) {
        let body = &self.document.tree[number];
        let mut rotation = unit();
        match &body.joint.rotation {
            None => {}
            Some(JointRotation::Turns(turns)) => {
                for (axis, angle) in turns {
                    rotation = product(&rotation, &about(*axis, &angle.text));
                }
            }
            Some(JointRotation::Matrix(entries)) => {
                rotation = std::array::from_fn(|i| std::array::from_fn(|j| entries[3 * i + j].text.clone()));
            }
        }
        let (slide, turn) = self.motion(body);
        let parent = body.parent().map(|name| self.number(name));
        let (above, origin) = match parent {
            None => (unit(), ["0".into(), "0".into(), "0".into()]),
            Some(parent) => (self.rotation(parent), self.origin(parent)),
        };
        let own = product(&above, &product(&rotation, &turn));
        let arm = apply(&rotation, &slide);
        let at = texts(body.joint.at.as_ref());
        let arm = apply(&above, &std::array::from_fn(|i| sum([at[i].clone(), arm[i].clone()])));
        for i in 0..3 {
            for j in 0..3 {
                self.define(format!("R{number}_{i}{j}"), &own[i][j]);
            }
        }
        for i in 0..3 {
            self.define(format!("r{number}_{i}"), &sum([origin[i].clone(), arm[i].clone()]));
        }
    }

    fn number(&self, body: &str) -> usize {
        self.document.tree.iter().position(|known| known.name.text == body).unwrap()
    }

    fn rotation(&self, number: usize) -> Matrix {
        std::array::from_fn(|i| std::array::from_fn(|j| format!("R{number}_{i}{j}")))
    }

    fn origin(&self, number: usize) -> Vector {
        std::array::from_fn(|i| format!("r{number}_{i}"))
    }

    /// ẋ of the coordinates of a joint.
    fn rates(&mut self, body: &TreeBody) {
        let x: Vec<&str> = body.joint.coordinates.iter().map(|name| name.text.as_str()).collect();
        let eta: Vec<String> = body.joint.quasi_velocities.iter().map(|name| own_name(&name.text)).collect();
        let Some(first) = body.joint.kind.quaternion() else {
            for (x, eta) in x.iter().zip(&eta) {
                writeln!(self.kinematics, "{x} = \"{eta}\"").unwrap();
            }
            return;
        };
        let q: Vec<String> = x[first..].iter().map(|x| (*x).to_owned()).collect();
        if first > 0 {
            let v = [eta[0].clone(), eta[1].clone(), eta[2].clone()];
            for (x, rate) in x.iter().zip(apply(&by_quaternion(&q), &v)) {
                writeln!(self.kinematics, "{x} = \"{rate}\"").unwrap();
            }
        }
        let [a, b, c, d] = [&q[0], &q[1], &q[2], &q[3]];
        let [p, r, s] = [&eta[first], &eta[first + 1], &eta[first + 2]];
        writeln!(self.kinematics, "{a} = \"-({b}*{p} + {c}*{r} + {d}*{s})/2\"").unwrap();
        writeln!(self.kinematics, "{b} = \"({a}*{p} + {c}*{s} - {d}*{r})/2\"").unwrap();
        writeln!(self.kinematics, "{c} = \"({a}*{r} + {d}*{p} - {b}*{s})/2\"").unwrap();
        writeln!(self.kinematics, "{d} = \"({a}*{s} + {b}*{r} - {c}*{p})/2\"").unwrap();
    }
}

/// `u_x` for a quasi-velocity that is called `x'`.
fn own_name(eta: &str) -> String {
    eta.strip_suffix('\'').map_or_else(|| eta.to_owned(), |x| format!("u_{x}"))
}

/// The text of the same model without joints; without points and what is made of them, too.
fn without_joints(document: &Document) -> String {
    let mut hand = Hand { document, definitions: String::new(), kinematics: String::new() };
    let quoted = |list: &[Expression]| {
        let texts: Vec<String> = list.iter().map(|part| format!("\"{}\"", part.text)).collect();
        format!("[{}]", texts.join(", "))
    };
    let of_points =
        |text: &str| document.points.iter().any(|point| text.contains(&format!("{}_", point.name.text)));
    for definition in document.definitions.iter().filter(|definition| !of_points(&definition.expression.text))
    {
        hand.define(format!("\"{}\"", definition.name.text), &definition.expression.text);
    }
    let mut text = "[parameters]\n".to_owned();
    for parameter in &document.parameters {
        writeln!(text, "\"{}\" = \"{}\"", parameter.name.text, parameter.expression.text).unwrap();
    }
    writeln!(text, "[coordinates]").unwrap();
    for x in &document.coordinates {
        writeln!(text, "{} = \"{}\"", x.name.text, x.expression.text).unwrap();
    }
    writeln!(text, "[quasi_velocities]").unwrap();
    for eta in &document.quasi_velocities {
        let start = eta.start.as_ref().map_or("0", |start| start.text.as_str());
        writeln!(text, "\"{}\" = \"{start}\"", own_name(&eta.name.text)).unwrap();
    }
    for velocity in &document.start_velocities {
        writeln!(text, "\"{}'\" = \"{}\"", velocity.name.text, velocity.expression.text).unwrap();
    }
    let mut bodies = String::new();
    for (number, body) in document.tree.iter().enumerate() {
        hand.place(number);
        hand.rates(body);
        let (rotation, origin) = (hand.rotation(number), hand.origin(number));
        let arm = apply(&rotation, &texts(body.center.as_ref()));
        let center: Vec<String> =
            (0..3).map(|i| format!("\"{}\"", sum([origin[i].clone(), arm[i].clone()]))).collect();
        let mass = body.mass.as_ref().map_or("0", |mass| mass.text.as_str());
        writeln!(
            bodies,
            "[bodies.{}]\nmass = \"{mass}\"\nposition = [{}]",
            body.name.text,
            center.join(", ")
        )
        .unwrap();
        if let Some(inertia) = &body.inertia {
            let inertia = match inertia {
                pc_model::document::Inertia::Principal(list) => quoted(&list[..]),
                pc_model::document::Inertia::Full(list) => quoted(&list[..]),
            };
            let entries: Vec<String> =
                rotation.iter().flatten().map(|entry| format!("\"{entry}\"")).collect();
            writeln!(bodies, "inertia = {inertia}\nrotation = [{}]", entries.join(", ")).unwrap();
        }
    }
    writeln!(text, "[definitions]\n{}", hand.definitions).unwrap();
    if !document.quasi_velocities.is_empty() {
        writeln!(text, "[kinematics]\n{}", hand.kinematics).unwrap();
    }
    text += &bodies;
    if let Some(gravity) = &document.gravity {
        writeln!(text, "[gravity]\nacceleration = {}", quoted(&gravity.acceleration)).unwrap();
    }
    if let Some(own) = &document.lagrangian {
        writeln!(text, "[lagrangian]").unwrap();
        for (key, part) in [("kinetic", &own.kinetic), ("potential", &own.potential)] {
            if let Some(part) = part {
                writeln!(text, "{key} = \"{}\"", part.text).unwrap();
            }
        }
    }
    writeln!(text, "[forces]").unwrap();
    for force in &document.forces {
        writeln!(text, "{} = \"{}\"", force.name.text, force.expression.text).unwrap();
    }
    text
}

/// At the start and at states around it, quaternions staying what they are.
#[track_caller]
fn moves_as_by_hand(document: Document) {
    let hand = Model::new(self::document(&without_joints(&document)));
    let quaternions: Vec<String> = document
        .tree
        .iter()
        .filter_map(|body| Some(body.joint.coordinates[body.joint.kind.quaternion()?..].to_vec()))
        .flatten()
        .map(|name| name.text)
        .collect();
    let names: Vec<String> = document.coordinates.iter().map(|x| x.name.text.clone()).collect();
    let model = Model::new(document);
    let (mut tree, mut hand) = (flow(&model), flow(&hand));
    assert_eq!(tree.start, hand.start, "{}", model.title());
    for number in 0..4 {
        let mut state = tree.start.clone();
        for (i, component) in state.iter_mut().enumerate() {
            let is_held = names.get(i).is_some_and(|name| quaternions.contains(name));
            if !is_held {
                *component += f64::from(number) * (0.4 * (i as f64 + 1.0)).sin();
            }
        }
        let t = 0.3 * f64::from(number);
        let (one, two) = (rates(&mut tree, t, &state), rates(&mut hand, t, &state));
        // Thousands of operations, led through mass matrices with condition numbers of some hundreds.
        let apart = difference(&one, &two);
        assert!(apart < 1e-10, "{}, state {number}: {apart}\n{one:?}\n{two:?}", model.title());
    }
}

#[test]
fn an_arm_moves_as_its_links_placed_by_hand() {
    moves_as_by_hand(Builtin::named("puma-560").unwrap().document().unwrap());
}

#[test]
fn a_chain_moves_as_its_rods_placed_by_hand() {
    let document = Builtin::named("spatial-chain").unwrap().document().unwrap();
    // Half of the rods: by hand, the expressions of eight fill a gigabyte.
    let text = document.source.text();
    let (head, rest) = text.split_once("[bodies.rod5]").unwrap();
    let tail = rest.split_once("[simulation]").unwrap().1;
    let head = head.replace("rod5_1 = -0.5\n", "rod4_1 = -0.5\n");
    moves_as_by_hand(self::document(&format!("{head}[simulation]{tail}")));
}

#[test]
fn a_satellite_moves_as_its_parts_placed_by_hand() {
    moves_as_by_hand(Builtin::named("satellite").unwrap().document().unwrap());
}

/// Two of the four legs, one on each side.
#[test]
fn a_walker_moves_as_its_parts_placed_by_hand() {
    let document = Builtin::named("quadruped").unwrap().document().unwrap();
    let mut text = document.source.text().to_owned();
    text = text.replace(" + spring_hind_left + spring_hind_right", "");
    for line in ["[events.ground]", "[outputs]"] {
        let start = text.find(line).unwrap();
        let end = text[start + 1..].find("\n[").map_or(text.len(), |end| start + 2 + end);
        text.replace_range(start..end, "");
    }
    let sections: Vec<&str> = text.split("\n[").collect();
    let kept: Vec<String> = sections
        .into_iter()
        .filter(|section| !section.starts_with("bodies.hind") && !section.starts_with("points"))
        .map(|section| {
            let is_left_out =
                |line: &str| ["hind", "spring_hind", "lowest_foot"].iter().any(|name| line.starts_with(name));
            let lines = section.lines().filter(|line| !is_left_out(line.trim_start_matches('"')));
            lines.collect::<Vec<_>>().join("\n")
        })
        .collect();
    moves_as_by_hand(self::document(&kept.join("\n[")));
}
