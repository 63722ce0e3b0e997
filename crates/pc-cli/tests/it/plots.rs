//! Pictures of `pc run --plot` and `pc sweep --plot` show the motion.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

use roxmltree::Document;

struct Place(tempfile::TempDir);

impl Place {
    fn new(model: &str) -> Place {
        let directory = tempfile::tempdir().expect("a directory");
        fs::write(directory.path().join("m.toml"), model).expect("written");
        Place(directory)
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn pc(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
        command.args(arguments).current_dir(self.0.path()).output().expect("pc runs")
    }

    /// The picture a.svg after a command that succeeds.
    #[track_caller]
    fn picture(&self, command: &str, arguments: &[&str]) -> String {
        let output = self.pc(&[&[command, "m.toml", "--plot", "a.svg"][..], arguments].concat());
        assert!(output.status.success(), "{}", said(&output));
        fs::read_to_string(self.at("a.svg")).expect("a picture")
    }
}

fn said(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("UTF-8")
}

/// Texts of a picture, in order.
fn texts(svg: &str) -> Vec<String> {
    let xml = Document::parse(svg).expect("XML");
    let texts = xml.descendants().filter(|node| node.has_tag_name("text"));
    texts.map(|node| node.text().unwrap_or_default().to_owned()).collect()
}

/// The points of each line of a colour, without the keys of a legend, which are lines of length 18.
fn lines(svg: &str, colour: &str) -> Vec<Vec<[f64; 2]>> {
    let xml = Document::parse(svg).expect("XML");
    let of = |node: &roxmltree::Node<'_, '_>| node.attribute("stroke") == Some(colour);
    let point = |pair: &str| {
        let (x, y) = pair.split_once(' ').expect("two numbers");
        [x, y].map(|number| number.parse().expect("a number"))
    };
    let path = |d: &str| d.trim_start_matches('M').split(['L', 'M']).map(point).collect::<Vec<[f64; 2]>>();
    let all = xml.descendants().filter(of).filter_map(|node| node.attribute("d")).map(path);
    all.filter(|points| {
        !(points.len() == 2 && points[0][1] == points[1][1] && points[1][0] - points[0][0] == 18.0)
    })
    .collect()
}

const FIRST: &str = "#0072b2";
const EVENT: &str = "#8c94a0";

/// Width and height of points.
fn extent(points: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|k| {
        let values = || points.iter().map(|point| point[k]);
        values().fold(f64::MIN, f64::max) - values().fold(f64::MAX, f64::min)
    })
}

/// x = cos 2πt, while y is slow and small.
const OSCILLATOR: &str = "\
[parameters]
k = 39.47841760435743
[coordinates]
x = 1.0
y = 0.001
[lagrangian]
kinetic = \"(x'^2 + y'^2)/2\"
potential = \"k*x^2/2 + y^2/200\"
[simulation]
t_end = 50.0
samples = 51
";

#[test]
fn nothing_aliases_between_the_rows() {
    let place = Place::new(OSCILLATOR);
    // Each row is at the end of a period, so all have x = 1.
    let plain = place.pc(&["run", "m.toml"]).stdout;
    for method in ["adams", "dop853", "taylor", "bdf"] {
        let svg = place.picture("run", &["--method", method, "--columns", "x"]);
        let curves = lines(&svg, FIRST);
        assert_eq!(curves.len(), 1, "{method}");
        // x takes 10/11 of the 180 points, because of margins.
        let [width, height] = extent(&curves[0]);
        assert!(height > 160.0 && width > 600.0, "{method}: {width} × {height}");
        // cos 2πt vanishes twice in each of 50 periods.
        let middle = curves[0].iter().map(|p| p[1]).fold(f64::MAX, f64::min) + height / 2.0;
        let passes = curves[0].windows(2).filter(|w| (w[0][1] > middle) != (w[1][1] > middle)).count();
        assert_eq!(passes, 100, "{method}");
    }
    let drawn = place.pc(&["run", "m.toml", "--plot", "a.svg"]);
    assert!(drawn.stdout == plain, "the table is the same with a picture");
}

/// v' = u, where u steps from 0 to 1 at t = 1 and back at t = 3.
const STEPS: &str = "\
[inputs]
u = { times = [0, 1, 3, 4], values = [0, 1, 0, 0], interpolation = \"hold\" }
[coordinates]
x = 0.0
[lagrangian]
kinetic = \"x'^2/2\"
[forces]
x = \"u\"
[outputs]
drive = \"u\"
[simulation]
t_end = 4.0
";

#[test]
fn inputs_jump_at_an_instant() {
    let backwards = STEPS.replace("t_end = 4.0", "t_start = 4.0\nt_end = 0.0");
    for (model, way) in [(Place::new(STEPS), "forwards"), (Place::new(&backwards), "backwards")] {
        for method in ["adams", "dop853", "bdf", "auto"] {
            let svg = model.picture("run", &["--method", method, "--columns", "drive"]);
            let points = lines(&svg, FIRST).concat();
            let [width, height] = extent(&points);
            // A rectangle: each line is horizontal or vertical, and the vertical ones are at 1/4
            // and 3/4 of the time.
            let left = points.iter().map(|p| p[0]).fold(f64::MAX, f64::min);
            let mut jumps = Vec::new();
            for pair in points.windows(2) {
                let (across, up) = (pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]);
                // Times are written to a hundredth.
                assert!(across.abs() < 0.015 || up == 0.0, "{method}, {way}: {points:?}");
                if up != 0.0 {
                    assert_eq!(up.abs(), height, "{method}, {way}");
                    jumps.push((pair[0][0] - left) / width);
                }
            }
            jumps.sort_by(f64::total_cmp);
            // A hundredth of a point, for a width above 600.
            let close = |jump: f64, at: f64| (jump - at).abs() < 1e-4;
            assert!(
                jumps.len() == 2 && close(jumps[0], 0.25) && close(jumps[1], 0.75),
                "{method}, {way}: {jumps:?}"
            );
        }
    }
}

#[test]
fn a_small_coordinate_has_its_own_panel() {
    let place = Place::new(OSCILLATOR);
    let all = texts(&place.picture("run", &[]));
    let count = |title: &str| all.iter().filter(|text| *text == title).count();
    assert_eq!((count("Coordinates"), count("Quasi-velocities")), (2, 2), "{all:?}");
    assert_eq!((count("Relative drift of integrals"), count("t")), (1, 1), "{all:?}");
    let chosen = texts(&place.picture("run", &["--columns", "y, drift(energy)"]));
    assert!(chosen.contains(&"y".to_owned()) && !chosen.contains(&"x".to_owned()), "{chosen:?}");
    assert!(chosen.contains(&"Relative drift of integrals".to_owned()));
    let unknown = place.pc(&["run", "m.toml", "--plot", "a.svg", "--columns", "x,q"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(
        said(&unknown).contains("--columns: there is no column `q`; the columns are t, x, y, x', y', energy"),
        "{}",
        said(&unknown)
    );
    for (option, value) in [("--xy", "x"), ("--xy", "x,y,z"), ("--wrap", "x")] {
        let wrong = place.pc(&["run", "m.toml", option, value]);
        assert_eq!(wrong.status.code(), Some(2), "{option} {value}");
    }
}

#[test]
fn paths_and_portraits() {
    // A circle of radius 2 about the origin.
    let place = Place::new(
        "coordinates.x = 2.0\ncoordinates.y = 0.0\nquasi_velocities.\"y'\" = 2.0\n\
         lagrangian.kinetic = \"(x'^2 + y'^2)/2\"\nlagrangian.potential = \"(x^2 + y^2)/2\"\nsimulation.t_end = 7.0\n",
    );
    let svg = place.picture("run", &["--xy", "x,y"]);
    let [width, height] = extent(&lines(&svg, FIRST)[0]);
    assert!((width - height).abs() < 0.01 * width && width > 300.0, "{width} × {height}");
    // A coordinate and its rate are not components of a vector, so each fills its axis.
    let svg = place.picture("run", &["--xy", "x,x'", "--columns", "x"]);
    let curves = lines(&svg, FIRST);
    let [width, height] = extent(&curves[1]);
    assert!(curves.len() == 2 && width > 1.5 * height, "{width} × {height}");
    assert!(texts(&svg).contains(&"x' over x".to_owned()));
}

#[test]
fn angles_are_wrapped_on_request() {
    // φ = 2t turns 3.18 times.
    let place = Place::new(
        "coordinates.\"φ\" = 0.0\nquasi_velocities.\"φ'\" = 2.0\nlagrangian.kinetic = \"φ'^2/2\"\nsimulation.t_end = 10.0\n",
    );
    let svg = place.picture("run", &["--wrap", "φ", "--columns", "φ"]);
    assert_eq!(lines(&svg, FIRST).len(), 4, "broken where it passes π");
    assert!(["−π", "−π/2", "0", "π/2", "π"].iter().all(|label| texts(&svg).contains(&(*label).to_owned())));
    let svg = place.picture("run", &["--columns", "φ"]);
    assert_eq!(lines(&svg, FIRST).len(), 1);
}

#[test]
fn events_are_marked_and_cusps_are_sharp() {
    // A ball falls from 2 with g = 1 and keeps its speed: it is on the floor at 2, 6 and 10, between the rows.
    let place = Place::new(
        "[coordinates]\ny = 2.0\n[lagrangian]\nkinetic = \"y'^2/2\"\npotential = \"y\"\n[events.bounce]\nwhen = \"y\"\n\
         direction = \"falling\"\nreset = { \"y'\" = \"-y'\" }\n[simulation]\nt_end = 11.0\nsamples = 6\n",
    );
    let svg = place.picture("run", &["--columns", "y"]);
    let marks = lines(&svg, EVENT);
    assert_eq!(marks.len(), 3);
    let curve = &lines(&svg, FIRST)[0];
    for mark in marks {
        let [x, lowest] = [mark[0][0], curve.iter().map(|p| p[1]).fold(f64::MIN, f64::max)];
        let near = curve.iter().any(|p| (p[0] - x).abs() < 0.1 && (p[1] - lowest).abs() < 0.1);
        assert!(near, "the curve comes down to the floor at the mark {x}");
    }
}

#[test]
fn a_motion_that_fails_is_drawn_as_far_as_it_was_reached() {
    // ẋ grows without bound before x = 1 is reached, between the first row and the second.
    let place = Place::new(
        "[coordinates]\nx = 0.0\n[quasi_velocities]\n\"x'\" = 3.0\n[lagrangian]\nkinetic = \"x'^2/2\"\n\
         potential = \"x + sqrt(1 - x)/1000\"\n[simulation]\nt_end = 3.0\nsamples = 3\n",
    );
    let output = place.pc(&["run", "m.toml", "--plot", "a.svg"]);
    assert_eq!(output.status.code(), Some(5), "{}", said(&output));
    let svg = fs::read_to_string(place.at("a.svg")).expect("a picture");
    assert!(
        texts(&svg).iter().any(|text| text.starts_with("The motion failed at t = 0.3")),
        "{:?}",
        texts(&svg)
    );
    assert!(extent(&lines(&svg, FIRST)[0])[0] > 600.0, "it is drawn to where it was");
}

/// Every object of the PDF is where its table says, and every stream can be unpacked.
#[test]
fn a_page_for_print_is_whole() {
    use std::io::Read;

    let place = Place::new(OSCILLATOR);
    let output = place.pc(&["run", "m.toml", "--plot", "a.pdf"]);
    assert!(output.status.success(), "{}", said(&output));
    let bytes = fs::read(place.at("a.pdf")).expect("a page");
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let start: usize = text.lines().rev().nth(1).expect("a place").parse().expect("a number");
    let table = String::from_utf8(bytes[start..].to_vec()).expect("ASCII");
    let entries: Vec<&str> = table.lines().skip(3).take_while(|line| line.ends_with(" n ")).collect();
    assert!(entries.len() > 20, "{table}");
    let mut meanings = String::new();
    for (number, entry) in (1..).zip(entries) {
        let place: usize = entry[..10].parse().expect("a number");
        let head = format!("{number} 0 obj\n");
        assert!(bytes[place..].starts_with(head.as_bytes()), "object {number}");
        let end = bytes[place..].windows(6).position(|w| w == b"endobj").expect("an end");
        let object = &bytes[place..place + end];
        if let Some(stream) = object.windows(7).position(|w| w == b"stream\n") {
            let mut unpacked = String::new();
            let mut decoder = flate2::read::ZlibDecoder::new(&object[stream + 7..]);
            decoder.read_to_string(&mut unpacked).expect("text");
            if unpacked.contains("beginbfchar") {
                meanings += &unpacked;
            }
        }
    }
    // The minus sign and the prime of x' can be searched for.
    assert!(meanings.contains("<2212>") && meanings.contains("<0027>"), "{meanings}");
}

#[test]
fn sweeps_are_drawn_by_the_varied_quantities() {
    let place = Place::new(&OSCILLATOR.replace("t_end = 50.0", "t_end = 1.0"));
    let sweep = |options: &[&str]| place.picture("sweep", &[&["-o", "a.csv"], options].concat());
    // x(1) = cos √k at √k = 1, 2, 4, …: the scale of k is logarithmic.
    let svg = sweep(&["--vary", "k=1:256:5:log", "--columns", "x"]);
    let all = texts(&svg);
    assert!(
        ["At the end", "k", "x", "1", "10", "100"].iter().all(|t| all.contains(&(*t).to_owned())),
        "{all:?}"
    );
    assert!(lines(&svg, FIRST)[0].len() >= 4);
    // A colour for each pair, besides those of the scale.
    let svg = sweep(&["--vary", "k=1:2:4", "--vary", "x=1,2,5", "--columns", "x,y"]);
    assert!(texts(&svg).contains(&"x at the end".to_owned()) && texts(&svg).contains(&"x(start)".to_owned()));
    assert_eq!(svg.matches("<rect").count(), 1 + 2 * (4 * 3 + 64));
    let svg = sweep(&["--members", "200", "--random", "k=normal(30,1)", "--columns", "x"]);
    assert!(
        texts(&svg).iter().any(|text| text.contains("median: ") && text.contains("95 %: ")),
        "{:?}",
        texts(&svg)
    );
    assert_eq!(lines(&svg, EVENT).len(), 5, "quantiles");
    let svg = sweep(&["--members", "50", "--random", "k=normal(30,1)", "--columns", "x", "--rows", "20"]);
    for name in ["5 % to 95 %", "25 % to 75 %", "median"] {
        assert!(texts(&svg).contains(&name.to_owned()), "{name}");
    }
    assert_eq!(svg.matches("Z\" fill=").count(), 2, "two bands");
    assert_eq!(lines(&svg, FIRST).len(), 1, "one curve");
    let svg = sweep(&["--vary", "k=1:9:3", "--columns", "x", "--rows", "20"]);
    assert!(texts(&svg).contains(&"k = 5".to_owned()), "{:?}", texts(&svg));
    let refused = |options: &[&str], mention: &str| {
        let output = place.pc(&[&["sweep", "m.toml", "-o", "b.csv", "--plot", "b.svg"], options].concat());
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        assert!(said(&output).contains(mention), "{}", said(&output));
        assert!(!place.at("b.csv").exists(), "nothing is computed");
    };
    refused(&["--vary", "k=1,2", "--vary", "x=1,2", "--vary", "y=1,2"], "3 values are varied");
    refused(&["--vary", "k=1,2", "--columns", "z"], "there is no column `z`");
    refused(&["--vary", "k=1:2:1000", "--vary", "x=1:2:1000"], "1000000 members are more");
}
