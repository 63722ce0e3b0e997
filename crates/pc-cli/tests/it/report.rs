//! `pc report` and `pc animate`: pages are written whole and are the same each time; drawings agree
//! with the run.

use std::path::Path;
use std::process::{Command, Output};

use roxmltree::{Document, ParsingOptions};
use serde_json::Value;

fn pc(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).output().expect("pc runs")
}

fn text(output: Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

fn parsed(page: &str) -> Document<'_> {
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    Document::parse_with_options(page, options).expect("a page is XML")
}

#[test]
fn a_page_of_the_program_is_the_same_in_a_file_and_on_standard_output() {
    let directory = tempfile::tempdir().expect("a directory");
    let file = directory.path().join("disk.html");
    let path = file.to_str().expect("UTF-8");
    assert!(text(pc(&["report", "tilted-disk", "-o", path])).is_empty());
    let page = std::fs::read_to_string(&file).expect("written");
    assert_eq!(page, text(pc(&["report", "tilted-disk"])), "the same bytes");
    assert!(page.len() < 1_500_000);
    let xml = parsed(&page);
    let titles: Vec<&str> =
        xml.descendants().filter(|node| node.has_tag_name("h2")).filter_map(|node| node.text()).collect();
    assert_eq!(
        titles,
        [
            "Motion",
            "Equations of motion",
            "Verdicts",
            "Frame and Lagrangian",
            "Theory of the motions",
            "Text of the model"
        ]
    );
    for wanted in
        ["Reactions", "Canonical equations", "Chaplygin&#39;s equations", "λ_rolling", "sin(θ) dx dy"]
    {
        assert!(page.contains(wanted), "{wanted}");
    }
    let is_code = |node: roxmltree::Node<'_, '_>| node.has_tag_name("script") || node.has_tag_name("style");
    let read = |node: &roxmltree::Node<'_, '_>| node.is_text() && !node.ancestors().any(is_code);
    let mut words = xml.descendants().filter(read).filter_map(|node| node.text());
    assert!(!words.any(|words| words.contains(" ms")), "no time of day, no timing");
}

#[test]
fn missing_parts_of_a_page_are_reported() {
    let directory = tempfile::tempdir().expect("a directory");
    let model = directory.path().join("model.toml");
    let write = |end: &str| {
        let text = format!(
            "coordinates.x = 1.0\nlagrangian.kinetic = \"x'^2/2\"\nlagrangian.potential = \"x^2/2\"\n{end}"
        );
        std::fs::write(&model, text).expect("written");
    };
    let path = model.to_str().expect("UTF-8");
    write("");
    assert!(text(pc(&["report", path])).contains("the text says no end of time"));
    assert!(!text(pc(&["report", path, "--no-run"])).contains("id=\"motion\""));
    assert!(text(pc(&["report", path, "--t-end", "3"])).contains("Relative drift of integrals"));
    let nothing = pc(&["animate", path, "--t-end", "3"]);
    assert_eq!(nothing.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&nothing.stderr).contains("can be drawn"));
    let wrong = pc(&["report", path, "-o", Path::new("x.pdf").to_str().expect("UTF-8")]);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&wrong.stderr).contains(".html"));
}

/// The model with most bodies and curves.
#[test]
fn the_page_of_a_platform_on_six_legs_is_not_too_long() {
    let page = text(pc(&["report", "stewart-platform", "--t-end", "0.05"]));
    assert!(page.len() < 1_500_000, "{} bytes", page.len());
    parsed(&page);
}

/// What takes long is left to other commands, which the page names, unless everything is asked for.
#[test]
fn a_page_is_brief_unless_it_is_full() {
    let page = |model: &str, options: &[&str]| text(pc(&[&["report", model, "--no-run"], options].concat()));
    let briefly = "looked for briefly; pc theory looks further";
    let (brief, full) = (page("chaplygin-sleigh", &[]), page("chaplygin-sleigh", &["--full"]));
    assert!(brief.contains(briefly) && brief.contains("at 32 states"), "{brief}");
    assert!(!full.contains(briefly) && full.contains("at 100 states"), "{full}");
    let long = page("puma-560", &[]);
    for left in ["left to pc theory", "pc derive --form canonical", "pc check finds them"] {
        assert!(long.contains(left), "{left}");
    }
}

/// Numbers in base 64, as the script of the page reads them.
fn numbers(text: &str) -> Vec<f32> {
    let digit = |c: u8| match c {
        b'A'..=b'Z' => u32::from(c - b'A'),
        b'a'..=b'z' => u32::from(c - b'a') + 26,
        b'0'..=b'9' => u32::from(c - b'0') + 52,
        b'+' => 62,
        b'/' => 63,
        _ => 0,
    };
    let mut bytes = Vec::new();
    for group in text.as_bytes().chunks(4) {
        let bits = group.iter().fold(0, |bits, &c| bits << 6 | digit(c));
        let padding = group.iter().filter(|&&c| c == b'=').count();
        bytes.extend_from_slice(&bits.to_be_bytes()[1..4 - padding]);
    }
    bytes.chunks_exact(4).map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]])).collect()
}

/// The end of the first link of the double pendulum, in the frames of the player and in columns of
/// the run.
#[test]
fn frames_are_the_numbers_of_the_run() {
    let model = "double-pendulum-cartesian";
    let page = text(pc(&["animate", model, "--rows", "101"]));
    let xml = parsed(&page);
    let data = xml.descendants().find(|node| node.attribute("id") == Some("player-data")).expect("data");
    let data: Value = serde_json::from_str(data.text().expect("text")).expect("JSON");
    let shapes = data["shapes"].as_array().expect("shapes");
    assert_eq!(
        shapes.iter().map(|shape| shape[0].as_str().expect("kind")).collect::<Vec<_>>(),
        ["line", "point", "point", "trace"]
    );
    let width: usize = shapes.iter().map(|shape| shape[1].as_u64().expect("a count") as usize).sum();
    let frames = numbers(data["frames"].as_str().expect("text"));
    let times = numbers(data["times"].as_str().expect("text"));
    assert_eq!((frames.len(), times.len()), (101 * width, 101));
    let table = text(pc(&["run", model, "--rows", "101"]));
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    let column = |name: &str| rows[0].iter().position(|known| *known == name).expect("a column");
    for row in [0, 50, 100] {
        let value = |name: &str| rows[row + 1][column(name)].parse::<f64>().expect("a number") as f32;
        // Equal but for rounding to single precision.
        assert_eq!(times[row], value("t"));
        assert_eq!(
            frames[row * width + 3..row * width + 5],
            [value("x1"), value("y1")],
            "line, second corner"
        );
        assert_eq!(frames[row * width + 12..row * width + 14], [value("x2"), value("y2")], "second point");
    }
}

/// The centres of the dots of a picture, in order: each is the largest of the circles of which it is made, and wider than a rod.
fn dots(svg: &str) -> Vec<[f64; 2]> {
    let xml = parsed(svg);
    let filled = xml.descendants().filter(|node| {
        node.has_tag_name("path") && node.attribute("fill").is_some_and(|fill| fill != "none")
    });
    let circle = |node: roxmltree::Node<'_, '_>| {
        let path = node.attribute("d").expect("a path").trim_start_matches('M').trim_end_matches('Z');
        let corners: Vec<[f64; 2]> = path
            .split('L')
            .map(|corner| {
                let (x, y) = corner.split_once(' ').expect("two numbers");
                [x, y].map(|number| number.parse().expect("a number"))
            })
            .collect();
        let mean = |k: usize| corners.iter().map(|corner| corner[k]).sum::<f64>() / corners.len() as f64;
        let middle = [mean(0), mean(1)];
        let radius = (corners[0][0] - middle[0]).hypot(corners[0][1] - middle[1]);
        (corners.len() > 4 && radius > 5.4).then_some(middle)
    };
    filled.filter_map(circle).collect()
}

/// Lengths in a frame are those of the run times one common factor.
#[test]
fn a_frame_is_the_motion_on_paper() {
    let directory = tempfile::tempdir().expect("a directory");
    let model = "double-pendulum-cartesian";
    let table = text(pc(&["run", model, "--rows", "101"]));
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    let column = |name: &str| rows[0].iter().position(|known| *known == name).expect("a column");
    let mut factors: Vec<f64> = Vec::new();
    let mut before: Option<([f64; 2], [f64; 2])> = None;
    for row in [10, 70] {
        let value = |name: &str| rows[row + 1][column(name)].parse::<f64>().expect("a number");
        let file = directory.path().join(format!("{row}.svg"));
        let path = file.to_str().expect("UTF-8");
        let at = value("t").to_string();
        assert!(text(pc(&["animate", model, "--rows", "101", "--time", &at, "-o", path])).is_empty());
        let [first, second] = dots(&std::fs::read_to_string(&file).expect("written"))[..] else {
            panic!("two points are drawn");
        };
        let run = [[value("x1"), value("y1")], [value("x2"), value("y2")]];
        let way = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]).hypot(b[1] - a[1]);
        factors.push(way(first, second) / way(run[0], run[1]));
        if let Some((paper, motion)) = before {
            factors.push(way(paper, first) / way(motion, run[0]));
        }
        before = Some((first, run[0]));
    }
    // Positions up to a few hundred points are written to hundredths.
    assert!(factors.iter().all(|factor| (factor / factors[0] - 1.0).abs() < 1e-3), "{factors:?}");
}

#[test]
fn films_and_frames_are_written() {
    let directory = tempfile::tempdir().expect("a directory");
    let place = |name: &str| directory.path().join(name).to_str().expect("UTF-8").to_owned();
    let film = place("swing.gif");
    let animate = ["animate", "double-pendulum-cartesian", "--t-end", "0.4"];
    assert!(text(pc(&[&animate[..], &["-o", &film]].concat())).is_empty());
    let mut decoder = gif::Decoder::new(std::fs::File::open(&film).expect("written")).expect("a GIF");
    let mut frames = 0;
    while let Some(frame) = decoder.read_next_frame().expect("a frame") {
        assert_eq!((frame.width, frame.height, frame.delay), (480, 360, 4));
        frames += 1;
    }
    assert_eq!(frames, 11, "25 a second, and the start");
    for (name, start) in [("swing.png", &b"\x89PNG"[..]), ("swing.pdf", b"%PDF"), ("swing.svg", b"<svg")] {
        assert!(text(pc(&[&animate[..], &["-o", &place(name)]].concat())).is_empty());
        assert!(std::fs::read(place(name)).expect("written").starts_with(start), "{name}");
    }
    let wrong = pc(&[&animate[..], &["--time", "0.1", "-o", &film]].concat());
    assert_eq!(wrong.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&wrong.stderr).contains("--time chooses a frame"));
}

/// Reactions are not drawn, so there is no remark on them.
#[test]
fn an_animation_has_remarks_only_on_what_it_shows() {
    let bicycle = pc(&["animate", "whipple-bicycle", "--t-end", "0.05"]);
    assert!(bicycle.status.success());
    assert_eq!(String::from_utf8_lossy(&bicycle.stderr), "");
}
