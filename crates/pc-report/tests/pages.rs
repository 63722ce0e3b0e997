//! Pages of models: well-formed, self-contained, the same each time; names and texts of a model cannot become
//! markup.

#![expect(clippy::unwrap_used, reason = "tests")]

use std::sync::atomic::{AtomicUsize, Ordering};

use pc_model::{Builtin, Document, Model, Source};
use pc_report::{ColumnKind, Columns, Recording, ReportError, Samples, report};
use roxmltree::{Document as Xml, Node, ParsingOptions};

/// The page as XML.
fn parsed(page: &str) -> Xml<'_> {
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    match Xml::parse_with_options(page, options) {
        Ok(xml) => xml,
        Err(error) => {
            let line = page.lines().nth(error.pos().row as usize - 1).unwrap_or_default();
            panic!("{error}: {}", line.chars().take(400).collect::<String>())
        }
    }
}

fn model(text: &str) -> Model {
    Model::new(Document::parse(Source::new("model.toml", text)).unwrap())
}

fn paged(model: &Model, record: Option<&Recording>) -> Result<String, ReportError> {
    model.derived(|assembly| report(model, assembly, record))
}

fn builtin(name: &str) -> Model {
    Model::new(Builtin::named(name).unwrap().document().unwrap())
}

/// A motion of three rows.
fn record() -> Recording {
    let column = |name: &str, values: [f64; 3]| (name.to_owned(), values.to_vec());
    Recording {
        rows: Samples {
            times: vec![0.0, 0.5, 1.0],
            columns: vec![
                Columns {
                    kind: ColumnKind::Coordinates,
                    list: vec![column("x", [1.0, 0.0, -1.0]), column("φ", [0.0, 100.0, 200.0])],
                },
                Columns { kind: ColumnKind::QuasiVelocities, list: vec![column("x'", [0.0, -3.0, 0.0])] },
                Columns {
                    kind: ColumnKind::Conserved,
                    list: vec![column("energy", [2.0, 2.0 + 2e-12, 2.0])],
                },
            ],
        },
        fine: None,
        summary: vec![("method".to_owned(), vec!["Adams <b>".to_owned()])],
        keeps_energy: true,
        events: vec![0.25],
        ..Recording::default()
    }
}

const OSCILLATOR: &str = "\
[model]
name = \"Oscillator\"
description = \"A mass on a spring.\"
[parameters]
m = 2.0
k = 8.0
[coordinates]
x = 1.0
[lagrangian]
kinetic = \"m*x'^2/2\"
potential = \"k*x^2/2\"
";

#[test]
fn an_oscillator_from_its_text_to_its_curves() {
    let page = paged(&model(OSCILLATOR), Some(&record())).unwrap();
    let between = |page: &str, start: &str, end: &str| {
        let first = page.find(start).unwrap() + start.len();
        let length = page[first..].find(end).unwrap();
        format!("{}{}", &page[..first], &page[first + length..])
    };
    let page = between(&page, "<style>", "</style>");
    let page = between(&page, "<script>", "</script>");
    insta::assert_snapshot!(page);
}

/// The page without the viewer, which is the same on all pages: within it are names of namespaces.
fn without_viewer(page: &str) -> String {
    match page.split_once("<script>/*<![CDATA[*/") {
        Some((before, rest)) => before.to_owned() + rest.split_once("/*]]>*/</script>").unwrap().1,
        None => page.to_owned(),
    }
}

/// Checks that every page satisfies; `name` is the model.
fn check(name: &str, page: &str) {
    assert!(page.len() < 1_500_000, "{name}: {} bytes", page.len());
    assert!(!without_viewer(page).contains("http"), "{name}: nothing from elsewhere");
    let xml = parsed(page);
    let with = |tag: &'static str| xml.descendants().filter(move |node| node.has_tag_name(tag));
    let ids: Vec<&str> = xml.descendants().filter_map(|node| node.attribute("id")).collect();
    let mut unique = ids.clone();
    unique.sort_unstable();
    unique.dedup();
    assert_eq!(unique.len(), ids.len(), "{name}: ids are there once");
    for link in with("a").filter_map(|node| node.attribute("href")) {
        assert!(ids.contains(&link.strip_prefix('#').unwrap()), "{name}: {link} leads somewhere");
    }
    assert!(with("math").count() > 3, "{name}: there are formulas");
    for math in with("math") {
        let scrolls = math.ancestors().any(|around| around.attribute("class") == Some("formula"));
        assert!(scrolls && math.has_children(), "{name}: a formula scrolls in its own box");
        for element in math.descendants().filter(Node::is_element) {
            let count = element.children().filter(Node::is_element).count();
            let wanted = match element.tag_name().name() {
                "msub" | "msup" | "mfrac" | "mover" => 2,
                "msubsup" => 3,
                "mi" | "mn" | "mo" | "mtext" | "mspace" => 0,
                _ => continue,
            };
            assert_eq!(count, wanted, "{name}: {:?}", &page[element.range()]);
        }
    }
    for svg in with("svg") {
        let says = |tag: &str| svg.children().any(|node| node.has_tag_name(tag) && node.text().is_some());
        assert!(says("title") && says("desc"), "{name}: a picture says what it shows");
    }
    let mut level = 1;
    for heading in
        xml.descendants().filter(|node| matches!(node.tag_name().name(), "h1" | "h2" | "h3" | "h4"))
    {
        let next = heading.tag_name().name()[1..].parse::<u32>().unwrap();
        assert!(next <= level + 1, "{name}: headings step down one by one");
        level = next;
    }
    let sources =
        with("details").filter(|node| node.descendants().any(|n| n.text() == Some("LaTeX"))).count();
    // Of long equations a brief page leaves out the theory, and says so.
    let least = if page.contains("their theory is left to pc theory") { 2 } else { 3 };
    assert!(sources >= least, "{name}: {sources} sources of formulas");
    // Only the player and the plots need scripts. The player is hidden until its script runs, and plots are pictures.
    let players = page.matches("id=\"player\" hidden=\"hidden\"").count();
    let plots = page.matches("id=\"plots-data\"").count();
    assert_eq!(with("script").count(), 2 * (players + plots), "{name}");
}

#[test]
fn pages_of_models_are_whole_small_and_the_same_each_time() {
    for name in
        ["tilted-disk", "heavy-top-euler", "chaplygin-sleigh", "double-pendulum-cartesian", "turning-hoop"]
    {
        let page = paged(&builtin(name), Some(&record())).unwrap();
        check(name, &page);
        assert_eq!(page, paged(&builtin(name), Some(&record())).unwrap(), "{name}");
    }
}

/// Includes the long pages, of trees and loops.
#[test]
fn pages_of_all_models() {
    let (models, next): (Vec<_>, _) = (Builtin::all().collect(), AtomicUsize::new(0));
    let work = || {
        while let Some(builtin) = models.get(next.fetch_add(1, Ordering::Relaxed)) {
            let model = Model::new(builtin.document().unwrap());
            check(builtin.name, &paged(&model, None).unwrap());
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        work();
    });
}

#[test]
fn hostile_text_stays_text() {
    let hostile = "</title></code></math><script>alert(1)</script><!-- & ' ]]>";
    let text = format!(
        "[model]\nname = \"{hostile}\"\ndescription = \"{hostile}\"\nreference = \"{hostile}\"\n\
         # {hostile}\n[coordinates]\nx = 1.0\ny = 0.0\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n\
         [constraints]\n\"{hostile}\" = \"x' - y*y'\"\n"
    );
    let text = if Document::parse(Source::new("a", &text)).is_ok() {
        text
    } else {
        // Names of constraints must be names.
        text.replace(&format!("\"{hostile}\" = \"x'"), "roll = \"x'")
    };
    let mut motion = record();
    motion.rows.columns[0].list[0].0 = hostile.to_owned();
    motion.summary.push((hostile.to_owned(), vec![hostile.to_owned()]));
    motion.remark = Some(hostile.to_owned());
    let page = paged(&model(&text), Some(&motion)).unwrap();
    check("hostile", &page);
    let xml = parsed(&page);
    let heading = xml.descendants().find(|node| node.has_tag_name("h1")).unwrap();
    assert_eq!(heading.text(), Some(hostile));
    let escaped =
        ["&lt;script&gt;alert(1)", "\\u003cscript\\u003ealert(1)"].map(|text| page.matches(text).count());
    assert_eq!(page.matches("alert(1)").count(), escaped.iter().sum::<usize>());
}

/// What the script of the plots finds on the page.
#[test]
fn plots_have_the_numbers_of_the_motion() {
    let page = paged(&model(OSCILLATOR), Some(&record())).unwrap();
    let xml = parsed(&page);
    let by_id = |id: &str| xml.descendants().find(|node| node.attribute("id") == Some(id));
    let data: serde_json::Value = serde_json::from_str(by_id("plots-data").unwrap().text().unwrap()).unwrap();
    // 0, 0.5 and 1 in single precision.
    assert_eq!(data["times"], serde_json::json!([[0.0, "AAAAAAAAAD8AAIA/"]]));
    let charts = data["charts"].as_array().unwrap();
    let names: Vec<&str> = charts.iter().filter_map(|chart| chart["curves"][0][0].as_str()).collect();
    assert_eq!(names, ["φ", "x", "x'", "energy"]);
    for chart in charts {
        let figure = by_id(chart["id"].as_str().unwrap()).unwrap();
        assert!(figure.has_tag_name("figure") && figure.descendants().any(|node| node.has_tag_name("svg")));
    }
    assert_eq!(charts[0]["events"], serde_json::json!([0.25]));
    assert_eq!(charts[3]["decades"], true);
    // The path of x' over x: its axes are wider than the values.
    let path = &data["paths"][0];
    assert_eq!((&path["x"], &path["y"]), (&"x".into(), &"x'".into()));
    assert!(path["across"][0].as_f64() < Some(-1.0) && path["up"][1].as_f64() >= Some(0.0));
}

#[test]
fn the_eigenvalues_of_a_steady_motion_are_drawn() {
    let page = paged(&model(OSCILLATOR), None).unwrap();
    // ±2i about x = 0
    assert!(page.contains("0 of 2 have positive real parts: 0 + 2i, 0 − 2i"), "{page}");
}
