//! `[units]`: names of units beside those of quantities.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::{Value, json};

const SPRING: &str = r#"
[parameters]
k = 4.0
[coordinates]
x = 1.0
[lagrangian]
kinetic = "x'^2/2"
potential = "k*x^2/2"
[outputs]
pull = "-k*x"
[simulation]
t_end = 1.0
[units]
t = "s"
x = "mm"
k = "N/mm & more"
pull = "N"
"#;

fn pc(arguments: &[&str], directory: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).current_dir(directory).output().expect("pc runs")
}

fn place(text: &str) -> tempfile::TempDir {
    let directory = tempfile::tempdir().expect("a directory");
    fs::write(directory.path().join("m.toml"), text).expect("written");
    directory
}

#[test]
fn units_stand_beside_names() {
    let place = place(SPRING);
    let done = |arguments: &[&str]| {
        let output = pc(arguments, place.path());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    };
    let read = |name: &str| fs::read_to_string(place.path().join(name)).expect("a file");
    done(&["run", "m.toml", "-o", "a.json", "--plot", "a.svg"]);
    let table: Value = serde_json::from_str(&read("a.json")).expect("JSON");
    assert_eq!(table["units"], json!({ "t": "s", "x": "mm", "pull": "N" }));
    let picture = read("a.svg");
    assert!(
        [">t [s]<", ">x [mm]<", ">pull [N]<", ">x&#39;<"].iter().all(|name| picture.contains(name)),
        "{picture}"
    );
    done(&["run", "m.toml", "-o", "a.csv"]);
    assert!(read("a.csv").starts_with("t,x,x',energy,pull\n"));
    done(&["report", "m.toml", "-o", "a.html"]);
    let page = read("a.html");
    assert!(["x [mm]", "4 N/mm &amp; more"].iter().all(|name| page.contains(name)));
}

#[test]
fn only_quantities_have_units() {
    let refused = |units: &str, words: &[&str]| {
        let text = SPRING.split_once("[units]").expect("a section").0.to_owned() + "[units]\n" + units;
        let output = pc(&["check", "m.toml"], place(&text).path());
        let said = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!(output.status.code(), Some(3), "{said}");
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
    };
    refused("pul = \"N\"", &["`pul` is not a quantity", "did you mean `pull`?", "m.toml:14:1"]);
    refused("x = \"\"", &["the name of a unit", "m.toml:14:5"]);
    refused("x = 1", &["m.toml:14:5"]);
}
