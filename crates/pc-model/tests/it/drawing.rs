//! `[[draw]]`, and the shapes drawn automatically.

use pc_mech::Graph;
use pc_model::{Builtin, Document, Model, ModelError, Shape, Source};

fn read(draw: &str) -> Result<Model, ModelError> {
    let text = format!(
        "[parameters]\nl = 2.0\n[coordinates]\n\"φ\" = 0.5\n[lagrangian]\nkinetic = \"l^2*φ'^2/2\"\n\
         potential = \"-9.81*l*cos(φ)\"\n{draw}"
    );
    Ok(Model::new(Document::parse(Source::new("model.toml", text))?))
}

/// The functions of each shape as written.
fn drawn(model: &Model) -> Result<Vec<String>, ModelError> {
    let graph = Graph::new();
    let assembly = model.assemble(&graph)?;
    let shapes = model.drawing(&assembly)?;
    let written = |shape: &Shape<'_>| {
        let functions: Vec<String> = shape.functions().iter().map(ToString::to_string).collect();
        functions.join(", ")
    };
    Ok(shapes.iter().map(written).collect())
}

#[test]
fn shapes_are_functions_of_the_state() {
    let model = read(
        "[[draw]]\nkind = \"line\"\nthrough = [[0, 0], [\"l*sin(φ)\", \"-l*cos(φ)\"]]\n\
         [[draw]]\nkind = \"disc\"\nat = [0, \"φ'\"]\nradius = \"l/2\"\n\
         [[draw]]\nkind = \"text\"\nat = [1, 2, 3]\ntext = \"here\"\n",
    );
    let shapes = drawn(&model.unwrap()).unwrap();
    assert_eq!(shapes, ["0, 0, 0, l*sin(φ), -l*cos(φ), 0", "0, φ', 0, 0, 0, 1, 1/2*l", "1, 2, 3"]);
}

#[test]
fn bodies_on_joints_are_rods_and_masses() {
    let model = Model::new(Builtin::named("four-bar-loop").unwrap().document().unwrap());
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let shapes = model.drawing(&assembly).unwrap();
    let rods = shapes.iter().filter(|shape| matches!(shape, Shape::Line { .. })).count();
    let labels = shapes.iter().filter(|shape| matches!(shape, Shape::Point { label: Some(_), .. })).count();
    assert_eq!((rods, labels), (3, 3), "crank, coupler, rocker");
}

/// Edges 1, 2 and 3 of a mass of 2: I = 2 (2² + 3²)/12 and cyclically.
#[test]
fn a_body_that_turns_is_the_box_of_its_inertia() {
    let body = "[coordinates]\nplate = 0.3\n[bodies.plate]\njoint = { kind = \"revolute\", axis = [0, 0, 1] }\nmass = 2.0\n\
                inertia = [\"13/6\", \"5/3\", \"5/6\"]\n";
    let read = |text: &str| Model::new(Document::parse(Source::new("model.toml", text)).unwrap());
    let shapes = drawn(&read(body)).unwrap();
    let [plate, centre] = &shapes[..] else { panic!("{shapes:?}") };
    let numbers: Vec<f64> = plate.split(", ").skip(3).take(3).map(|edge| edge.parse().unwrap()).collect();
    assert!(numbers.iter().zip([1.0, 2.0, 3.0]).all(|(edge, right)| (edge - right).abs() < 1e-12), "{plate}");
    assert!(plate.contains("cos(plate)") && centre == "0, 0, 0", "{shapes:?}");
    // A point leads to a rod, and a drawing of the text takes the place of the box.
    let with_end = drawn(&read(&format!("{body}[points.end]\nbody = \"plate\"\nat = [1, 0, 0]\n"))).unwrap();
    assert_eq!(with_end[..2], ["0, 0, 0, cos(plate), sin(plate), 0", "0, 0, 0"]);
    let own = drawn(&read(&format!("{body}[[draw]]\nkind = \"point\"\nat = [0, 0]\n"))).unwrap();
    assert_eq!(own, ["0, 0, 0", "0, 0, 0"]);
}

#[test]
fn a_drawing_that_cannot_be_drawn_is_refused_with_its_text() {
    let refused = |draw: &str| match read(draw).and_then(|model| drawn(&model)) {
        Err(error) => error.to_string(),
        Ok(shapes) => panic!("{draw}: {shapes:?}"),
    };
    for (draw, said) in [
        ("[draw]\nkind = \"point\"\nat = [0, 0]\n", "expected [[draw]]"),
        ("[[draw]]\nat = [0, 0]\n", "kind"),
        ("[[draw]]\nkind = \"dot\"\nat = [0, 0]\n", "dot"),
        ("[[draw]]\nkind = \"point\"\n", "at"),
        ("[[draw]]\nkind = \"point\"\nat = [0]\n", "2 or 3 expressions"),
        ("[[draw]]\nkind = \"point\"\nat = [0, 0]\nradius = 1\n", "radius"),
        ("[[draw]]\nkind = \"line\"\nthrough = [[0, 0]]\n", "2 to 64 places"),
        ("[[draw]]\nkind = \"point\"\nat = [\"nowhere\", 0]\n", "nowhere"),
    ] {
        let error = refused(draw);
        assert!(error.contains(said), "{draw}: {error}");
    }
}

#[test]
fn all_models_are_drawn() {
    for builtin in Builtin::all() {
        let model = Model::new(builtin.document().unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        assert!(!model.drawing(&assembly).unwrap().is_empty(), "{}", builtin.name);
    }
}
