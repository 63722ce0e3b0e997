//! `pc sweep --of linearize` and `--of check`: rows are those of single commands, and the same bytes whatever happens on the way.

use std::fs;

use crate::sweeps::Place;
use serde_json::Value;

/// λ² = Ω² cos 2θ − g cos θ at an equilibrium; without one for a pull of more than g.
const BEAD: &str = r#"
[parameters]
"Ω" = 0.5
g = 1.0
pull = 0.0
[coordinates]
"θ" = 0.1
[lagrangian]
kinetic = "(θ'^2 + Ω^2*sin(θ)^2)/2"
potential = "-g*cos(θ)"
[forces]
"θ" = "pull"
"#;

/// A table of JSON.
struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<Value>>,
}

impl Table {
    fn of(bytes: &[u8]) -> Table {
        let object: Value = serde_json::from_slice(bytes).expect("JSON");
        let list = |value: &Value| value.as_array().expect("a list").clone();
        Table {
            columns: list(&object["columns"])
                .iter()
                .map(|name| name.as_str().expect("a name").to_owned())
                .collect(),
            rows: list(&object["rows"]).iter().map(list).collect(),
        }
    }

    fn column(&self, name: &str) -> Vec<&Value> {
        let place = self.columns.iter().position(|known| known == name).unwrap_or_else(|| panic!("{name}"));
        self.rows.iter().map(|row| &row[place]).collect()
    }

    fn numbers(&self, name: &str) -> Vec<f64> {
        self.column(name).into_iter().map(|value| value.as_f64().unwrap_or(f64::NAN)).collect()
    }
}

/// The eigenvalues of each speed are those of the root locus, bit by bit; there they are followed as branches.
#[test]
fn the_bicycle_has_the_eigenvalues_of_its_root_locus() {
    let place = Place::new("");
    let speeds = ["--set", "roll=0", "--vary", "v0=1:9:9"];
    let sweep = ["sweep", "whipple-bicycle", "--of", "linearize", "-o", "sweep.json"];
    place.ends(&[&sweep[..], &speeds].concat(), 0, &["Whipple bicycle", "members  9, 9 completed"]);
    let sweep = Table::of(&fs::read(place.at("sweep.json")).expect("a table"));
    let locus =
        place.ends(&[&["linearize", "whipple-bicycle", "--format", "json"][..], &speeds].concat(), 0, &[]);
    let locus: Value = serde_json::from_slice(&locus.stdout).expect("JSON");
    let branches = locus["branches"].as_array().expect("branches");
    assert_eq!((sweep.rows.len(), branches.len()), (9, 5));
    let stability = sweep.column("stability");
    for (i, speed) in sweep.numbers("v0").into_iter().enumerate() {
        assert_eq!(locus["values"][i].as_f64(), Some(speed));
        let part = |branch: &Value, part: &str| branch[part][i].as_f64().expect("a number");
        let mut expected: Vec<[f64; 2]> =
            branches.iter().map(|branch| [part(branch, "real"), part(branch, "imaginary")]).collect();
        let column = |name: String| sweep.numbers(&name)[i];
        let mut found: Vec<[f64; 2]> =
            (1..=5).map(|k| [column(format!("re{k}")), column(format!("im{k}"))]).collect();
        assert!(found.windows(2).all(|pair| pair[0][0] >= pair[1][0]), "in descending order: {found:?}");
        for list in [&mut expected, &mut found] {
            list.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        }
        assert_eq!(found, expected, "at {speed}");
        // Of weave and capsize, self-stability between 4.29 and 6.02 m/s [Meijaard et al. 2007, section 5.2]; any speed is steady.
        let expected = if speed > 4.292 && speed < 6.025 { "undecided" } else { "unstable" };
        assert_eq!(stability[i], expected, "at {speed}");
    }
}

#[test]
fn the_bytes_depend_neither_on_threads_nor_on_shards() {
    let place = Place::new(BEAD);
    let mut extensions = vec!["csv", "json", "npz"];
    if cfg!(feature = "parquet") {
        extensions.push("parquet");
    }
    // Some members of each have no result.
    let linearize = ["--of", "linearize", "--vary", "Ω=0:2:5", "--vary", "pull=0:1.5:4"];
    let check = ["--of", "check", "--vary", "Ω=0:2:3", "--vary", "g=0,1"];
    let random = ["--of", "linearize", "--members", "9", "--random", "pull=uniform(-1,1)", "--seed", "3"];
    let mut sweeps: Vec<(&[&str], String)> =
        extensions.into_iter().map(|extension| (&linearize[..], format!("a.{extension}"))).collect();
    sweeps.extend([(&check[..], "b.csv".to_owned()), (&random[..], "c.csv".to_owned())]);
    for (options, table) in sweeps {
        let whole = format!("whole-{table}");
        let one = place.swept(&whole, &[options, &["--threads", "1"]].concat());
        assert!(one == place.swept(&whole, &[options, &["--threads", "2"]].concat()), "{options:?}");
        let sweep = [&["sweep", "model.toml", "-o", &table][..], options].concat();
        for shard in ["1/3", "2/3", "3/3"] {
            place.ends(&[&sweep[..], &["--shard", shard]].concat(), 0, &["for pc merge"]);
        }
        let shards = [2, 3, 1].map(|i| format!("{table}.shard-{i}-of-3"));
        let mut merge = vec!["merge", "-o", &table];
        merge.extend(shards.iter().map(String::as_str));
        place.ends(&merge, 0, &["  shards   3\n"]);
        assert!(one == fs::read(place.at(&table)).expect("a table"), "{options:?} {table}");
    }
}

#[test]
fn what_was_cut_short_goes_on_and_gives_the_same_bytes() {
    for (options, step) in [
        (["--of", "check", "--vary", "Ω=0:2:60"], 1001),
        (["--of", "linearize", "--vary", "pull=0:1.5:4000"], 20_001),
    ] {
        let place = Place::new(BEAD);
        let undisturbed = place.swept("whole.csv", &options);
        let sweep = [&["sweep", "model.toml", "-o", "a.csv"][..], &options].concat();
        // Never at the same place of a record.
        let cuts = (0..4).filter(|i| place.cut(&sweep, "a.csv.partial", step + 77 * i)).count();
        assert!(cuts >= 1, "{options:?} is over too soon for this test");
        // Unless the last one came to its end before.
        let is_left = place.at("a.csv.partial").exists();
        place.ends(&sweep, 0, if is_left { &["were finished before"] } else { &[] });
        assert!(fs::read(place.at("a.csv")).expect("a table") == undisturbed, "{options:?}");
    }
}

/// sin θ = pull has no solution for a pull of more than 1; the others have λ² = −cos θ = −√(1 − pull²).
#[test]
fn members_without_a_steady_state_say_so() {
    let place = Place::new(BEAD);
    let options = ["--of", "linearize", "--set", "Ω=0", "--vary", "pull=0:1.5:4"];
    let table = Table::of(&place.swept("a.json", &options));
    assert_eq!(
        table.columns,
        ["member", "pull", "status", "re1", "im1", "re2", "im2", "stability", "message"]
    );
    assert_eq!(table.column("status"), ["completed", "completed", "completed", "failed"]);
    assert_eq!(table.column("stability")[..2], ["undecided", "undecided"]);
    // The rounding of numbers of order one.
    assert!((table.numbers("im1")[1] - 0.75f64.powf(0.25)).abs() < 1e-14);
    assert_eq!((table.column("stability")[3], table.column("re1")[3]), (&Value::from(""), &Value::Null));
    let message = table.column("message")[3].as_str().expect("words");
    assert!(message.starts_with("no steady state was found near the start"), "{message}");
    // The picture is the root locus of those that have one.
    let drawn = [&["sweep", "model.toml", "-o", "d.json", "--plot", "d.svg"], &options[..]].concat();
    place.ends(&drawn, 0, &[]);
    let svg = fs::read_to_string(place.at("d.svg")).expect("a picture");
    for said in ["Eigenvalues in the complex plane", "pull from 0 (crosses) to 1 (circles)"] {
        assert!(svg.contains(said), "{said}: {svg}");
    }
    let none = ["sweep", "model.toml", "--of", "linearize", "--vary", "pull=2:3:2", "-o", "b.json"];
    place.ends(&none, 5, &["none of the 2 members was completed; the first: no steady state was found"]);
    // At the start itself nothing has to be steady.
    let at_start = ["--of", "linearize", "--at", "start", "--vary", "pull=0,2"];
    let table = Table::of(&place.swept("c.json", &at_start));
    assert_eq!(table.column("stability"), ["not steady", "not steady"]);
}

#[test]
fn checks_are_those_of_single_models() {
    let place = Place::new("");
    let options = ["--of", "check", "--vary", "a=-0.5,0,0.5", "-o", "a.json"];
    place.ends(&[&["sweep", "chaplygin-sleigh"][..], &options].concat(), 0, &["3, 3 completed"]);
    let table = Table::of(&fs::read(place.at("a.json")).expect("a table"));
    for (i, a) in ["-0.5", "0", "0.5"].into_iter().enumerate() {
        let set = format!("a={a}");
        let single = place.ends(&["check", "chaplygin-sleigh", "--set", &set, "--format", "json"], 0, &[]);
        let single: Value = serde_json::from_slice(&single.stdout).expect("JSON");
        let is = |column: &str, expected: &Value| {
            let found = table.column(column)[i];
            assert_eq!(
                (found.as_f64(), found.as_str()),
                (expected.as_f64(), expected.as_str()),
                "{column} at {a}"
            );
        };
        is("rank", &single["rank"]);
        is("algebra", &single["algebra"]);
        is("mass_rank", &single["mass_matrix_rank"]);
        is("stability", &single["steady_motion"]["verdict"]);
        is("distance", &single["steady_motion"]["distance"]);
        is("deviation", &single["second_derivation"]["error"]);
        is("compared", &single["second_derivation"]["states"]);
        let integrals = single["integrals"].as_array().expect("a list");
        let proved = |integral: &&Value| {
            integral["verdict"].as_str().is_some_and(|verdict| verdict.ends_with("(proved)"))
        };
        is("integrals", &Value::from(integrals.len()));
        is("proved", &Value::from(integrals.iter().filter(proved).count()));
        is("closure", &Value::from("holds identically"));
        is("jacobi", &Value::from("holds identically"));
        is("constraints", &Value::from(1));
        is("nonholonomic", &Value::from(1));
        is("integrability", &Value::from("nonholonomic"));
    }
    // Without an offset of its mass centre the sleigh has more integrals.
    let proved = table.numbers("proved");
    assert!(proved[1] > proved[0], "{proved:?}");
}

#[test]
fn options_that_say_nothing_are_refused() {
    let place = Place::new(BEAD);
    for (of, options, option) in [
        ("linearize", ["--t-end", "2"], "--t-end"),
        ("linearize", ["--rows", "3"], "--rows"),
        ("check", ["--method", "bdf"], "--method"),
        ("check", ["--at", "rest"], "--at"),
        ("run", ["--hold", "θ"], "--hold"),
    ] {
        let sweep = ["sweep", "model.toml", "-o", "a.csv", "--vary", "g=1:2:3", "--of", of];
        let said = format!("{option} has no effect on what `--of {of}` computes; leave it out");
        place.ends(&[&sweep[..], &options].concat(), 2, &[&said]);
    }
    assert_eq!(fs::read_dir(place.at("")).expect("a directory").count(), 1, "nothing is left");
    // What another sweep has left is not gone on with.
    let cut = ["sweep", "model.toml", "-o", "a.csv", "--vary", "g=1:2:300"];
    assert!(place.cut(&[&cut[..], &["--of", "check"]].concat(), "a.csv.partial", 3000));
    place.ends(&[&cut[..], &["--of", "linearize"]].concat(), 2, &["--of check, where now it is linearize"]);
}

#[test]
fn eigenvalues_are_drawn_over_what_is_varied() {
    let place = Place::new(BEAD);
    let options = ["--of", "linearize", "--set", "θ=0", "--vary", "Ω=0:2:9", "--plot", "a.svg"];
    place.swept("a.csv", &options);
    let picture = fs::read_to_string(place.at("a.svg")).expect("a picture");
    assert!(picture.contains("Eigenvalues") && picture.contains("Re λ") && !picture.contains("At the end"));
    let options = ["--of", "check", "--vary", "Ω=0:2:9", "--plot", "b.svg", "--columns", "stability"];
    let sweep = [&["sweep", "model.toml", "-o", "b.csv"][..], &options].concat();
    place.ends(&sweep, 2, &["there is no column `stability`; the columns are rank, mass_rank,"]);
}
