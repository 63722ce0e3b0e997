//! What is common to all commands that write a table: `-o`, `--format`, `--columns` and `--outputs`.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;

/// A pendulum in Cartesian coordinates: λ_rod is the tension over the length, known in closed form.
const PENDULUM: &str = "[parameters]\nk = 1.0\n[coordinates]\nx = 0.6\ny = -0.8\n[constraints]\nrod = \"x^2 + y^2 - 1\"\n[lagrangian]\n\
                        kinetic = \"(x'^2 + y'^2)/2\"\npotential = \"k*y\"\n[outputs]\nsum = \"x + y\"\n[simulation]\nt_end = 2.0\nsamples = 5\n";

/// A directory with the pendulum.
struct Place(tempfile::TempDir);

impl Place {
    fn new(model: &str) -> Place {
        let directory = tempfile::tempdir().expect("a directory");
        fs::write(directory.path().join("m.toml"), model).expect("written");
        Place(directory)
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn pc(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
        command.args(arguments).current_dir(self.path()).stdin(Stdio::null()).output().expect("pc")
    }

    #[track_caller]
    fn answer(&self, arguments: &[&str]) -> Vec<u8> {
        let output = self.pc(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", said(&output));
        output.stdout
    }

    #[track_caller]
    fn file(&self, name: &str, arguments: &[&str]) -> Vec<u8> {
        self.answer(&[arguments, &["-o", name]].concat());
        fs::read(self.path().join(name)).expect("the file")
    }

    /// The names and numbers of a table in JSON; what is no number is NaN.
    #[track_caller]
    fn table(&self, arguments: &[&str]) -> (Vec<String>, Vec<Vec<f64>>) {
        let bytes = self.file("table.json", arguments);
        let table: Value = serde_json::from_slice(&bytes).expect("JSON");
        let names = serde_json::from_value(table["columns"].clone()).expect("names");
        let row = |row: &Value| {
            row.as_array().expect("a row").iter().map(|cell| cell.as_f64().unwrap_or(f64::NAN)).collect()
        };
        (names, table["rows"].as_array().expect("rows").iter().map(row).collect())
    }
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn column(table: &(Vec<String>, Vec<Vec<f64>>), name: &str) -> Vec<f64> {
    let place =
        table.0.iter().position(|known| known == name).unwrap_or_else(|| panic!("{name}: {:?}", table.0));
    table.1.iter().map(|row| row[place]).collect()
}

/// The commands, the first of whose formats is the usual one on standard output; then those that write to files alone.
const PRINTED: [(&[&str], &[&str]); 5] = [
    (&["run", "m.toml"], &["csv", "json", "npz", "parquet"]),
    (&["compare", "m.toml", "--form", "poincare,canonical"], &["text", "json", "csv", "npz", "parquet"]),
    (&["linearize", "m.toml", "--at", "start"], &["text", "json", "csv", "npz", "mat"]),
    (&["linearize", "m.toml", "--at", "start", "--vary", "k=1:2:3"], &["text", "json", "csv", "npz", "mat"]),
    (&["equilibria", "m.toml", "--starts", "40"], &["text", "json", "csv"]),
];

fn ending(format: &str) -> &str {
    if format == "text" { "txt" } else { format }
}

/// A motion says how long it took.
fn without_time(format: &str, bytes: &[u8]) -> Value {
    if format != "json" {
        return Value::from(String::from_utf8_lossy(bytes).into_owned());
    }
    let mut all: Value = serde_json::from_slice(bytes).expect("JSON");
    if let Some(summary) = all.get_mut("summary").and_then(Value::as_object_mut) {
        summary.retain(|_, value| !value.is_number());
    }
    all
}

/// `--format` says the same of standard output and of a file, of whatever name; without it the ending does.
#[test]
fn a_format_is_the_same_everywhere() {
    let place = Place::new(PENDULUM);
    for (command, formats) in PRINTED {
        for format in
            formats.iter().copied().filter(|format| cfg!(feature = "parquet") || *format != "parquet")
        {
            let same = |bytes: Vec<u8>| without_time(format, &bytes);
            let printed = same(place.answer(&[command, &["--format", format]].concat()));
            let named = same(place.file(&format!("a.{}", ending(format)), command));
            let asked = same(place.file("b.csv", &[command, &["--format", format]].concat()));
            assert!(printed == named, "{command:?} {format}: as the ending says");
            assert!(printed == asked, "{command:?} {format}: whatever the ending");
        }
        let usual = without_time(formats[0], &place.answer(command));
        assert!(
            usual == without_time(formats[0], &place.answer(&[command, &["--format", formats[0]]].concat()))
        );
    }
    let sweep = ["sweep", "m.toml", "--vary", "k=1:2:3"];
    for format in ["csv", "json", "npz"] {
        let named = place.file(&format!("a.{format}"), &sweep);
        assert!(named == place.file("b.dat", &[&sweep[..], &["--format", format]].concat()), "{format}");
    }
}

#[test]
fn a_format_that_there_is_not_is_refused() {
    let place = Place::new(PENDULUM);
    let refuses = |arguments: &[&str], message: &str| {
        let output = place.pc(arguments);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments:?}");
        assert!(said(&output).contains(message), "{arguments:?}: {}", said(&output));
    };
    refuses(&["run", "m.toml", "--format", "mat"], "pc: --format mat: this is written as csv, json, npz");
    refuses(
        &["equilibria", "m.toml", "--format", "npz"],
        "pc: --format npz: this is written as text, json or csv\n",
    );
    refuses(
        &["compare", "m.toml", "--form", "canonical", "-o", "a.mat"],
        "the name must end in .txt, .json, .csv, .npz",
    );
    refuses(
        &["sweep", "m.toml", "--vary", "k=1,2", "-o", "-"],
        "pc: this is written only to a file; name it by -o FILE\n",
    );
    refuses(&["sweep", "m.toml", "--vary", "k=1,2"], "required");
}

/// The wanted columns in their order, behind those that tell rows apart.
#[test]
fn columns_are_those_that_are_wanted() {
    let place = Place::new(PENDULUM);
    let names = |arguments: &[&str]| place.table(arguments).0;
    assert_eq!(names(&["run", "m.toml", "--columns", "energy, x"]), ["t", "energy", "x"]);
    assert_eq!(names(&["run", "m.toml", "--columns", "y,t,y"]), ["t", "y"]);
    assert_eq!(names(&["run", "m.toml", "--estimate", "--columns", "error(x)"]), ["t", "error(x)"]);
    let by_k = ["--sensitivities", "k", "--columns", "∂x/∂k"];
    assert_eq!(names(&[&["run", "m.toml"], &by_k[..]].concat()), ["t", "∂x/∂k"]);
    let sweep = ["sweep", "m.toml", "--vary", "k=1:2:3", "--columns", "y,status,x"];
    assert_eq!(names(&sweep), ["member", "k", "t", "y", "status", "x"]);
    let whole = place.table(&["run", "m.toml"]);
    let part = place.table(&["run", "m.toml", "--columns", "y,x"]);
    assert_eq!((column(&whole, "x"), column(&whole, "y")), (column(&part, "x"), column(&part, "y")));
    let text = String::from_utf8(place.answer(&["run", "m.toml", "--columns", "x"])).expect("UTF-8");
    assert!(text.starts_with("t,x\n0.0000000000000000e0,5.9999999999999998e-1\n"), "{text}");
    // A picture has the same ones; a drift is drawn alone.
    let drawn = ["run", "m.toml", "--plot", "a.svg", "--columns", "y,drift(energy)"];
    assert_eq!(names(&drawn), ["t", "y"]);
    for (command, known) in
        [(&["run", "m.toml"][..], "t, x, y"), (&["sweep", "m.toml", "--vary", "k=1,2"], "member, k, status")]
    {
        let output = place.pc(&[command, &["--columns", "energi", "-o", "no.csv"]].concat());
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        let message = format!(
            "pc: --columns: there is no column `energi`; did you mean `energy`? the columns are {known}"
        );
        assert!(said(&output).contains(&message), "{}", said(&output));
        assert!(!place.path().join("no.csv").exists());
    }
    // What is compared stands in the order in which it is wanted.
    let compared =
        ["compare", "m.toml", "--form", "poincare,canonical", "--columns", "y, x", "--format", "csv"];
    let text = String::from_utf8(place.answer(&compared)).expect("UTF-8");
    let first: Vec<&str> = text.lines().map(|line| line.split(',').next().expect("a cell")).collect();
    assert_eq!(first, ["name", "y", "x"]);
}

/// Rows that are written while the motion is integrated.
#[test]
fn a_stream_has_the_columns_that_are_wanted() {
    let place = Place::new(PENDULUM);
    let many = ["run", "m.toml", "--rows", "300001", "--limit-memory", "20M", "--no-verify"];
    let text = |more: &[&str]| {
        String::from_utf8(place.file("many.csv", &[&many[..], more].concat())).expect("UTF-8")
    };
    let (whole, part) = (text(&[]), text(&["--columns", "energy,x"]));
    assert!(part.starts_with("t,energy,x\n") && part.lines().count() == 300_002);
    let last = |text: &str| -> Vec<String> {
        text.lines().last().expect("a row").split(',').map(str::to_owned).collect()
    };
    let (names, values) = (whole.lines().next().expect("names").split(','), last(&whole));
    let of =
        |name: &str| names.clone().position(|known| known == name).map(|j| values[j].clone()).expect(name);
    assert_eq!(last(&part), [of("t"), of("energy"), of("x")]);
}

#[test]
fn shards_are_merged_with_the_columns_that_are_wanted() {
    let place = Place::new(PENDULUM);
    let sweep = ["sweep", "m.toml", "--vary", "k=1:2:4"];
    for shard in ["1/2", "2/2"] {
        place.answer(&[&sweep[..], &["-o", "s.csv", "--shard", shard]].concat());
    }
    let merge = ["merge", "s.csv.shard-1-of-2", "s.csv.shard-2-of-2", "--columns", "energy,x"];
    assert_eq!(
        place.file("merged.txt", &[&merge[..], &["--format", "csv"]].concat()),
        place.file("whole.csv", &[&sweep[..], &["--columns", "energy,x"]].concat())
    );
}

/// −v² = x ẍ + y ÿ = 2 λ − k y: what `pc run` gives is right, and the other commands give the same.
#[test]
fn reactions_are_those_of_a_motion() {
    let place = Place::new(PENDULUM);
    let run = place.table(&["run", "m.toml", "--outputs", "reactions"]);
    let tension = column(&run, "λ_rod");
    let (x, y, energy) = (column(&run, "x"), column(&run, "y"), column(&run, "energy"));
    for i in 0..tension.len() {
        let speed = 2.0 * (energy[i] - y[i]);
        assert!((2.0 * tension[i] - (y[i] - speed)).abs() < 1e-7, "{i}: {} {} {}", tension[i], x[i], y[i]);
    }
    let sweep = ["sweep", "m.toml", "--vary", "k=1,2", "--rows", "5", "--outputs", "reactions"];
    let swept = column(&place.table(&sweep), "λ_rod");
    assert_eq!(swept[..5], tension);
    let last = place.table(&["sweep", "m.toml", "--vary", "k=1,2", "--outputs", "reactions"]);
    assert_eq!(column(&last, "λ_rod")[0], tension[4]);
    let compare =
        ["compare", "m.toml", "--form", "poincare,canonical", "--outputs", "reactions", "--format", "json"];
    let found: Value = serde_json::from_slice(&place.answer(&compare)).expect("JSON");
    let columns = found["columns"].as_array().expect("a list");
    let of_rod = columns.iter().find(|column| column["name"] == "λ_rod").expect("λ_rod");
    assert_eq!(of_rod["verdict"], "same", "{of_rod}");
    // At rest below, 2 λ = −k; to first order it does not change.
    let rest = ["--set", "x=0", "--set", "y=-1", "--outputs", "reactions", "--format", "json"];
    let linear: Value =
        serde_json::from_slice(&place.answer(&[&["linearize", "m.toml"], &rest[..]].concat())).expect("JSON");
    let outputs: Vec<String> = serde_json::from_value(linear["outputs"].clone()).expect("names");
    let h = outputs.iter().position(|name| name == "λ_rod").unwrap_or_else(|| panic!("{linear:#}"));
    assert!((linear["output_values"][h].as_f64().expect("a number") + 0.5).abs() < 1e-9, "{linear:#}");
    // Where there are no constraints, this is said.
    let free = Place::new(
        "[coordinates]\nx = 1\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2\"\n[simulation]\nt_end = 1\n",
    );
    for command in [
        &["run", "m.toml", "-o", "a.csv"][..],
        &["sweep", "m.toml", "--vary", "x=1,2", "-o", "a.csv"],
        &["linearize", "m.toml"],
        &["equilibria", "m.toml"],
    ] {
        let output = free.pc(&[command, &["--outputs", "reactions"]].concat());
        assert!(output.status.success(), "{}", said(&output));
        assert!(
            said(&output).contains("note: there are no constraints, and so no reactions\n"),
            "{command:?}"
        );
    }
}
