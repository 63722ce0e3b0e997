//! The page on the text format: its models run, its errors are those that are given, and it names all there is.

use std::path::Path;

use pc_algebra::CATALOGUE;
use pc_expr::parse::FUNCTIONS;
use pc_mech::Graph;
use pc_model::{Document, ErrorKind, Flow, Model, ModelError, Source, Variables};
use pc_solve::{Options, Solve};
use pc_tests::verified::derived_twice;
use pc_verify::verify;

const PAGE: &str = include_str!("../../../docs/model-format.md");

/// A fenced block: the words after its fence, its text, and the line of the page at which this begins.
struct Block {
    words: &'static str,
    text: String,
    line: usize,
}

fn blocks() -> Vec<Block> {
    let (mut blocks, mut open): (Vec<Block>, Option<Block>) = (Vec::new(), None);
    for (i, line) in PAGE.lines().enumerate() {
        match (line.strip_prefix("```"), &mut open) {
            (Some(_), Some(_)) => blocks.extend(open.take()),
            (Some(words), None) => open = Some(Block { words, text: String::new(), line: i + 2 }),
            (None, Some(block)) => block.text += &format!("{line}\n"),
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "a block of the page is not closed");
    blocks
}

/// The models of the page that run, beside the tables that it shows.
fn models(directory: &Path) -> Vec<(usize, Document)> {
    let (tables, blocks): (Vec<Block>, _) = blocks().into_iter().partition(|b| b.words.starts_with("csv "));
    for table in &tables {
        std::fs::write(directory.join(&table.words["csv ".len()..]), &table.text).unwrap();
    }
    let path = directory.join("model.toml").display().to_string();
    let document = |block: Block| {
        let document = Document::parse(Source::new(path.as_str(), block.text));
        (block.line, document.unwrap_or_else(|error| panic!("line {} of the page: {error}", block.line)))
    };
    blocks.into_iter().filter(|block| block.words == "toml").map(document).collect()
}

#[test]
fn the_models_of_the_page_run() {
    let directory = tempfile::tempdir().unwrap();
    let models = models(directory.path());
    assert!(models.len() > 15, "{} models", models.len());
    for (line, document) in models {
        let model = derived_twice(document);
        let graph = Graph::new();
        let assembly =
            model.assemble(&graph).unwrap_or_else(|error| panic!("line {line} of the page: {error}"));
        if model.document().undetermined_functions().next().is_some() {
            continue;
        }
        let t_end = model.document().simulation.t_end.as_ref().unwrap().value;
        let mut flow = Flow::new(&model, &assembly, Variables::QuasiVelocities).unwrap();
        let start = flow.start.clone();
        let solved = Solve::new(&mut flow.motion, assembly.t_start, &start)
            .method(&Options::default())
            .events(&mut flow.events)
            .run(&[assembly.t_start, t_end]);
        let solved = solved.unwrap_or_else(|failure| panic!("line {line} of the page: {}", failure.error));
        let (_, end) = solved.trajectory.iter().last().unwrap();
        assert!(end.iter().all(|y| y.is_finite()) && end != start, "line {line} of the page: {end:?}");
    }
}

/// Not only without disagreement, as in every test, but with states at which there was something to compare.
#[test]
fn the_models_of_the_page_are_compared_with_their_second_derivation() {
    let directory = tempfile::tempdir().unwrap();
    for (line, document) in models(directory.path()) {
        let model = Model::new(document);
        let options = pc_verify::Options { states: 3, seed: 5, ..pc_verify::Options::default() };
        let agreement = model.derived(|assembly| verify(&model, assembly, &options));
        let agreement = agreement.unwrap_or_else(|error| panic!("line {line} of the page: {error}"));
        assert_eq!(agreement.states, 3, "line {line} of the page: {agreement}");
    }
}

fn refusal(text: &str) -> Option<ModelError> {
    let document = Document::parse(Source::new("model.toml", text));
    document.and_then(|document| Model::new(document).assemble(&Graph::new()).map(|_| ())).err()
}

#[test]
fn the_errors_of_the_page_are_those_given() {
    let blocks = blocks();
    let mut count = 0;
    for (wrong, message) in blocks.iter().zip(&blocks[1..]).filter(|(block, _)| block.words == "toml refused")
    {
        count += 1;
        let error = refusal(&wrong.text).unwrap_or_else(|| panic!("line {}: it is accepted", wrong.line));
        assert_eq!(error.to_string().trim_end(), message.text.trim_end(), "line {} of the page", wrong.line);
    }
    assert_eq!(count, blocks.iter().filter(|block| block.words.contains("refused")).count());
    assert!(count > 2);
}

/// What the reader of the format says is allowed where `wrong` stands.
fn allowed(text: &str) -> Vec<&'static str> {
    match refusal(text).map(|error| error.kind().clone()) {
        Some(ErrorKind::UnknownKey { allowed, .. }) => allowed.to_vec(),
        other => panic!("{text}: {other:?}"),
    }
}

#[test]
fn the_page_names_every_section_key_function_and_algebra() {
    let mut missing = Vec::new();
    let mut look_for = |text: String| {
        if !PAGE.contains(&text) {
            missing.push(text);
        }
    };
    let help = refusal("[nonsense]\n").unwrap().kind().help();
    let (_, sections) = help.split_once("the sections are ").unwrap();
    for section in sections.split(", ") {
        if section == "draw" {
            look_for("### `[[draw]]`\n".to_owned());
            continue;
        }
        let suffix = if matches!(section, "bodies" | "events" | "points" | "loops" | "contacts") {
            ".NAME"
        } else {
            ""
        };
        look_for(format!("### `[{section}{suffix}]`\n"));
    }
    let sections =
        ["model", "algebra", "lagrangian", "gravity", "simulation", "bodies.a", "events.a", "points.a"];
    for place in sections.into_iter().chain(["loops.a", "contacts.a", "drawing", "hamilton_jacobi"]) {
        allowed(&format!("[{place}]\nwrong = 1\n")).iter().for_each(|key| look_for(format!("`{key}`")));
    }
    for (place, joint) in [("center = [0, 0, 0]\nwrong", "1"), ("joint", "{ wrong = 1 }")] {
        let text = format!("[bodies.a]\n{place} = {joint}\n");
        allowed(&text).iter().for_each(|key| look_for(format!("`{key}`")));
    }
    for kind in
        ["fixed", "revolute", "prismatic", "screw", "cylindrical", "universal", "planar", "spherical", "free"]
    {
        look_for(format!("`\"{kind}\"`"));
    }
    for kind in ["point", "line", "disc", "ring", "sphere", "box", "spring", "trace", "text"] {
        look_for(format!("`\"{kind}\"`"));
        let text = format!("[[draw]]\nkind = \"{kind}\"\nwrong = 1\n");
        allowed(&text).iter().for_each(|key| look_for(format!("`{key}`")));
    }
    for place in ["inputs", "quasi_velocities", "states", "constraints"] {
        for key in allowed(&format!("[{place}]\na = {{ wrong = 1 }}\n")) {
            look_for(key.to_owned());
        }
    }
    FUNCTIONS.iter().for_each(|function| look_for(format!("`{}`", function.usage)));
    CATALOGUE.iter().for_each(|entry| look_for(format!("`{}`", entry.name)));
    assert!(missing.is_empty(), "the page does not name {missing:?}");
}
