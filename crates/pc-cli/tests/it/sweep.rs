//! `pc sweep`: the same bytes, even after interruptions.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use crate::patience::{ended, started, until};
use crate::random::SplitMix64;
use crate::sweeps;

/// A blade on ice, with a constraint that makes a quasi-velocity vanish.
const SLEIGH: &str = r#"
[parameters]
m = 1.0
J = 1.0
a = 0.5
[coordinates]
x = 0.0
y = 0.0
"φ" = 0.0
[quasi_velocities]
v = { is = "cos(φ)*x' + sin(φ)*y'", start = 0.0 }
"ω" = { is = "φ'", start = 1.0 }
[constraints]
blade = "-sin(φ)*x' + cos(φ)*y'"
[lagrangian]
kinetic = "m/2*(x'^2 + y'^2) + m*a*ω*(cos(φ)*y' - sin(φ)*x') + (J + m*a^2)/2*ω^2"
[simulation]
t_end = 3.0
"#;

/// A pendulum held by a multiplier, whose start depends on its length.
const HELD: &str = r#"
[parameters]
l = 1.0
g = 1.0
[coordinates]
x = "l*sin(1)"
y = "-l*cos(1)"
[constraints]
rod = "x^2 + y^2 - l^2"
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
potential = "g*y"
[integrals]
twice = "x'^2 + y'^2 + 2*g*y"
[simulation]
t_end = 3.0
"#;

/// Two masses on springs; a mass of 0 makes M singular.
const MASSES: &str = r#"
[parameters]
m = 1.0
k = 1.0
[coordinates]
x = 1.0
y = 0.0
[lagrangian]
kinetic = "m*x'^2/2 + y'^2/2"
potential = "k*x^2/2 + (x - y)^2/2"
[simulation]
t_end = 4.0
"#;

fn pc(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
    command.args(arguments).stdin(Stdio::null());
    command
}

fn output(arguments: &[&str]) -> Output {
    pc(arguments).output().expect("pc runs")
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("UTF-8")
}

#[track_caller]
fn ends(arguments: &[&str], code: i32, mentions: &[&str]) {
    let output = output(arguments);
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {text}");
    for mention in mentions {
        assert!(text.contains(mention), "{arguments:?} should mention {mention}: {text}");
    }
}

/// A directory with a model in it.
struct Place(tempfile::TempDir);

impl Place {
    fn new(model: &str) -> Place {
        let directory = tempfile::tempdir().expect("a directory");
        fs::write(directory.path().join("model.toml"), model).expect("written");
        Place(directory)
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn name(&self, name: &str) -> String {
        self.at(name).display().to_string()
    }

    /// `pc sweep` of the model into the file `name`.
    fn sweep(&self, name: &str, options: &[&str]) -> Vec<String> {
        let mut arguments =
            vec!["sweep".to_owned(), self.name("model.toml"), "-o".to_owned(), self.name(name)];
        arguments.extend(options.iter().map(ToString::to_string));
        arguments
    }

    #[track_caller]
    fn swept(&self, name: &str, options: &[&str]) -> Vec<u8> {
        let arguments = self.sweep(name, options);
        ends(&strs(&arguments), 0, &[]);
        assert!(!self.journal(name).exists(), "the journal is gone");
        fs::read(self.at(name)).expect("a table")
    }

    fn journal(&self, name: &str) -> PathBuf {
        self.at(&format!("{name}.partial"))
    }

    /// Whether the sweep of `MANY` was cut short when its journal had grown by `bytes`.
    fn cut(&self, name: &str, bytes: u64) -> bool {
        sweeps::cut(self.0.path(), &strs(&self.sweep(name, &MANY)), &self.journal(name), bytes)
    }
}

fn strs(arguments: &[String]) -> Vec<&str> {
    arguments.iter().map(String::as_str).collect()
}

fn lines(csv: &[u8]) -> Vec<Vec<String>> {
    let text = String::from_utf8(csv.to_vec()).expect("UTF-8");
    text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

#[test]
fn each_member_ends_as_its_own_run_does() {
    for (model, vary, form) in [
        (MASSES, ["m=1:2:3", "k=0.5:4:2"], "poincare"),
        (MASSES, ["m=1:2:3", "k=0.5:4:2"], "canonical"),
        (SLEIGH, ["m=1:2:3", "a=0.1:1:2"], "poincare"),
        (HELD, ["l=1:2:3", "g=0.5:4:2"], "poincare"),
    ] {
        let place = Place::new(model);
        // By the methods that have lanes, members and runs agree to their tolerances.
        let method = ["--method", "adams", "--form", form];
        let vary_both = ["--vary", vary[0], "--vary", vary[1]];
        let table = lines(&place.swept("a.csv", &[&vary_both[..], &method].concat()));
        assert_eq!(table.len(), 7, "a header and 3 × 2 members");
        let names: Vec<String> =
            vary.iter().map(|vary| vary.split('=').next().expect("a name").to_owned()).collect();
        assert_eq!(table[0][..4], ["member", &names[0], &names[1], "status"]);
        for (i, row) in table[1..].iter().enumerate() {
            assert_eq!((row[0].as_str(), row[3].as_str()), (i.to_string().as_str(), "completed"));
            let set = [0, 1].map(|j| format!("{}={}", names[j], row[1 + j]));
            let file = place.name("model.toml");
            let run = [&["run", &file][..], &method, &["--set", &set[0], "--set", &set[1]]].concat();
            let run = output(&run);
            let run = lines(&run.stdout);
            let motion = 4..4 + run[0].len();
            assert_eq!(table[0][motion.clone()], run[0]);
            assert_eq!(Some(&row[motion.clone()]), run.last().map(Vec::as_slice), "{set:?}");
            // The last drift is that of the energy, at the quarters of the motion and at its end.
            let column = run[0].iter().position(|name| name == "energy").expect("an energy");
            let energy = |row: &Vec<String>| row[column].parse::<f64>().expect("a number");
            let quarters = (1..run.len()).step_by((run.len() - 2) / 4);
            let drift = quarters.map(|row| (energy(&run[row]) - energy(&run[1])).abs()).fold(0.0, f64::max);
            let drifts = table[0].iter().position(|name| name == "drift(energy)").expect("a drift");
            assert_eq!(row[drifts].parse(), Ok(drift));
        }
        let varied: Vec<f64> = table[1..].iter().map(|row| row[2].parse().expect("a number")).collect();
        assert_eq!(varied[..2], varied[2..4], "the last changes fastest: {varied:?}");
        assert!(varied[0] < varied[1]);
    }
}

#[test]
fn starts_are_varied_and_all_rows_can_be_written() {
    let place = Place::new(MASSES);
    let table = lines(&place.swept("a.csv", &["--vary", "x'=0:0.5:2", "--rows", "5", "--method", "adams"]));
    assert_eq!(table.len(), 1 + 2 * 5);
    assert_eq!(table[0][..4], ["member", "x'(start)", "status", "t"]);
    fs::write(
        place.at("model.toml"),
        MASSES.replace("[lagrangian]", "[quasi_velocities]\n\"x'\" = 0.5\n[lagrangian]"),
    )
    .expect("written");
    let run = lines(&output(&["run", &place.name("model.toml"), "--rows", "5", "--method", "adams"]).stdout);
    for (row, run) in table[6..].iter().zip(&run[1..]) {
        assert_eq!(&row[3..3 + run.len()], run);
    }
    // A start off the constraint is refused, or projected on request.
    let place = Place::new(HELD);
    let table =
        lines(&place.swept("a.csv", &["--vary", "x=0.6:0.8:2", "--set", "l=1", "--vary", "y=-0.6:-0.6:1"]));
    assert_eq!([&table[1][3], &table[2][3]], ["refused", "completed"]);
    let table = lines(&place.swept("a.csv", &["--vary", "x=0.6:0.8:2", "--project-start"]));
    assert_eq!([&table[1][2], &table[2][2]], ["completed", "completed"]);
}

#[test]
fn the_bytes_do_not_depend_on_the_number_of_threads() {
    let place = Place::new(SLEIGH);
    let options = ["--members", "60", "--random", "ω=normal(1,0.3)", "--random", "a=uniform(0.1,1)"];
    let mut extensions = vec!["csv", "json", "npz"];
    if cfg!(feature = "parquet") {
        extensions.push("parquet");
    }
    for extension in extensions {
        let name = format!("a.{extension}");
        let [one, two] =
            ["1", "2"].map(|threads| place.swept(&name, &[&options[..], &["--threads", threads]].concat()));
        assert!(one == two, "{extension}");
        assert!(one.len() > 60 * 8);
    }
}

/// DOP853 integrates members side by side in vectors: the same bytes for any number of threads, and
/// the numbers of single runs.
#[test]
fn members_side_by_side_are_single_runs() {
    let place = Place::new(MASSES);
    let options = ["--vary", "k=1:2:23", "--method", "dop853"];
    let threads = |name: &str, count| place.swept(name, &[&options[..], &["--threads", count]].concat());
    let one = threads("one.csv", "1");
    assert!(one == threads("two.csv", "2"), "threads do not matter");
    let rows = lines(&one);
    let column = |name: &str| rows[0].iter().position(|column| column == name).expect("a column");
    let (k, x) = (column("k"), column("x"));
    assert_eq!(rows.len(), 24);
    for row in rows.iter().skip(1).step_by(7) {
        let set = format!("k={}", row[k]);
        let (model, table) = (place.name("model.toml"), place.name("run.csv"));
        ends(&["run", &model, "--method", "dop853", "--set", &set, "-o", &table], 0, &[]);
        let run = lines(&fs::read(place.at("run.csv")).expect("a table"));
        let end = &run[run.len() - 1][run[0].iter().position(|column| column == "x").expect("a column")];
        let [a, b] = [&row[x], end].map(|number| number.parse::<f64>().expect("a number"));
        // A hundred times the tolerance of a step.
        assert!((a - b).abs() < 1e-7, "{a} {b}");
    }
    // The summary says what ran.
    let arguments = place.sweep("again.csv", &[&options[..], &["--threads", "1"]].concat());
    let said = output(&strs(&arguments));
    let text = [said.stdout, said.stderr].concat();
    assert!(String::from_utf8_lossy(&text).contains("23 side by side"));
}

#[test]
fn random_members_depend_on_the_seed_and_their_number_alone() {
    let place = Place::new(MASSES);
    let table = |samples: &str, seed: &str| {
        let random =
            ["--random", "m=lognormal(0,0.5)", "--random", "x=normal(2,0.1)", "--random", "y=uniform(-1,3)"];
        lines(&place.swept(
            "a.csv",
            &[&random[..], &["--members", samples, "--seed", seed, "--t-end", "0.1"]].concat(),
        ))
    };
    let (few, many, other) = (table("10", "3"), table("2000", "3"), table("10", "4"));
    assert_eq!(few[..], many[..11]);
    assert!(few[1..].iter().zip(&other[1..]).all(|(a, b)| a[1] != b[1] && a[2] != b[2] && a[3] != b[3]));
    assert_eq!(many[0][..5], ["member", "m", "x(start)", "y(start)", "status"]);
    let column = |j: usize| many[1..].iter().map(move |row| row[j].parse::<f64>().expect("a number"));
    let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / 2000.0;
    // Five standard deviations σ/√2000 of a mean of 2000 numbers; σ of a uniform one is its
    // range/√12.
    let near = |found: f64, expected: f64, deviation: f64| {
        assert!((found - expected).abs() < 5.0 * deviation / 2000.0_f64.sqrt(), "{found} for {expected}");
    };
    near(mean(&mut column(1).map(f64::ln)), 0.0, 0.5);
    near(mean(&mut column(2)), 2.0, 0.1);
    near(mean(&mut column(3)), 1.0, 4.0 / 12.0_f64.sqrt());
    // The variance of (x − 2)² of a normal x is 2σ⁴.
    near(mean(&mut column(2).map(|x| (x - 2.0).powi(2))), 0.01, 0.01 * 2.0_f64.sqrt());
    assert!(column(3).all(|y| (-1.0..=3.0).contains(&y)));
}

#[test]
fn a_member_that_fails_is_reported_and_the_others_finish() {
    let place = Place::new(MASSES);
    let arguments = place.sweep("a.csv", &["--vary", "m=-1:1:3"]);
    // m = −1 makes an energy without lower bound, which is not an error.
    ends(
        &strs(&arguments),
        0,
        &["3, 2 completed, 1 not", "refused  member 1: ", "the mass matrix is singular"],
    );
    let table = lines(&fs::read(place.at("a.csv")).expect("a table"));
    let status: Vec<&str> = table[1..].iter().map(|row| row[2].as_str()).collect();
    assert_eq!(status, ["completed", "refused", "completed"]);
    assert!(table[2][3..table[0].len() - 2].iter().all(|cell| cell == "NaN"));

    let arguments = place.sweep("a.csv", &["--vary", "m=0:0:2"]);
    ends(&strs(&arguments), 5, &["none of the 2 members", "the mass matrix is singular"]);
    assert_eq!(lines(&fs::read(place.at("a.csv")).expect("a table")).len(), 3, "the table is written");

    // ẍ is singular at x = 1, which only one of the members reaches.
    let place = Place::new(
        "[coordinates]\nx = 0.0\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"x + sqrt(1 - x)/1000\"\n\
         [simulation]\nt_end = 3.0\n",
    );
    let table = lines(&place.swept("a.csv", &["--vary", "x'=0:3:2"]));
    let at = |name: &str| table[0].iter().position(|column| column == name).expect("a column");
    assert_eq!([&table[1][at("status")], &table[2][at("status")]], ["completed", "failed"]);
    let x: f64 = table[2][at("x")].parse().expect("a number");
    assert!(x > 0.9 && x < 1.0, "what was reached is in the row: {x}");
    assert!(!table[2][at("message")].is_empty());
}

/// ÿ = −1 from height h: the floor is reached at √(2h), if this is at most 3.
#[test]
fn a_member_that_an_event_ends_names_the_event() {
    let place = Place::new(
        "[parameters]\nh = 1.0\n[coordinates]\ny = \"h\"\n[lagrangian]\nkinetic = \"y'^2/2\"\npotential = \"y\"\n\
         [events.floor]\nwhen = \"y\"\nterminal = true\n[simulation]\nt_end = 3.0\n",
    );
    let arguments = place.sweep("a.csv", &["--vary", "h=2:8:3"]);
    ends(&strs(&arguments), 0, &["  members  3, 2 completed, 1 ended by an event\n"]);
    let table = lines(&fs::read(place.at("a.csv")).expect("a table"));
    let at = |name: &str| table[0].iter().position(|column| column == name).expect("a column");
    let of = |name: &str| table[1..].iter().map(|row| row[at(name)].as_str()).collect::<Vec<_>>();
    assert_eq!(of("status"), ["event", "completed", "completed"]);
    assert_eq!(of("message"), ["ended by the event floor", "", ""]);
    let t: Vec<f64> = of("t").iter().map(|t| t.parse().expect("a number")).collect();
    // rtol 1e-9
    assert!((t[0] - 2.0).abs() < 1e-8 && t[1..] == [3.0, 3.0], "{t:?}");
    let json = String::from_utf8(place.swept("a.json", &["--vary", "h=2:8:3"])).expect("UTF-8");
    assert_eq!(json.matches("\"event\"").count(), 1, "{json}");
    // No member fails, though none is completed.
    let arguments = place.sweep("a.csv", &["--vary", "h=1:2:2"]);
    ends(&strs(&arguments), 0, &["  members  2, 0 completed, 2 ended by an event\n"]);
}

#[test]
fn wrong_usage_suggests_a_correction() {
    let place = Place::new(MASSES);
    for (options, mention) in [
        (&[][..], "--vary"),
        (&["--vary", "m=1:2:3", "--members", "3"], "cannot be used with"),
        (&["--random", "m=normal(0,1)"], "--members"),
        (&["--vary", "m=1:2:3", "--members", "3", "--random", "k=normal(0,1)"], "cannot be used with"),
        (&["--vary", "q=1:2:3"], "its parameters are m, k, its start values x, y, x', y'"),
        (&["--vary", "m=1:2:3", "--vary", "m=1:2:3"], "`m` is given values twice"),
        (&["--vary", "m=1:2:3", "--set", "m=1"], "`m` is given values twice"),
        (&["--vary", "m=1:2"], "NAME=FROM:TO:N"),
        (
            &["--vary", "m=1:2:1"],
            "one value cannot be at both ends; give 2 values, or the same number at both ends",
        ),
        (
            &["--vary", "m=1:2:3", "--set", "k=1", "--set", "k=2"],
            "pc: --set: `k` is given two values; leave one out",
        ),
        (&["--members", "3", "--random", "m=cauchy(0,1)"], "lognormal(m,s)"),
        (&["--members", "0", "--random", "m=normal(0,1)"], "0 is not in"),
        (&["--vary", "m=1:2:3", "--threads", "0"], "--threads"),
        (&["--vary", "m=1:2:10000000000", "--vary", "k=1:2:10000000000"], "more than 2^64 members"),
        (
            &["--vary", "m=1:2:1000000", "--vary", "k=1:2:1000000"],
            "pc: the sweep has 1000000000000 members, more than the limit of 1000000; ask for fewer values, or give \
             --limit-members 1000000000000 if so many are meant\n",
        ),
        (&["--members", "1000001", "--random", "m=normal(1,0.1)"], "give --limit-members 1000001 if"),
        (
            &["--vary", "m=1:2:8", "--shard", "1/4", "--limit-members", "7"],
            "has 8 members, more than the limit of 7",
        ),
        (&["--vary", "m=1:2:3", "--limit-members", "0"], "0 is not in"),
    ] {
        let arguments = place.sweep("a.csv", options);
        ends(&strs(&arguments), 2, &[mention]);
    }
    ends(&strs(&place.sweep("a.txt", &["--vary", "m=1:2:3"])), 2, &[".csv, .json"]);
    ends(&strs(&place.sweep("no/a.csv", &["--vary", "m=1:2:3"])), 2, &["no directory"]);
    ends(&["sweep", "euler-top", "--vary", "I1=1:2:3"], 2, &["--output"]);
    fs::write(place.at("model.toml"), MASSES.replace("k*x^2", "q*x^2")).expect("written");
    ends(&strs(&place.sweep("a.csv", &["--vary", "m=1:2:3"])), 3, &["q"]);
    assert_eq!(fs::read_dir(place.0.path()).expect("a directory").count(), 1, "nothing is left");
}

#[test]
fn a_limit_on_members_that_is_not_passed_changes_nothing() {
    let place = Place::new(MASSES);
    let grid = ["--vary", "m=1:2:3", "--vary", "k=1:2:4"];
    let limited = place.swept("b.csv", &[&grid[..], &["--limit-members", "12"]].concat());
    assert!(place.swept("a.csv", &grid) == limited);
    // A sweep that is meant is begun.
    let mut many = place.sweep("c.csv", &["--vary", "m=1:2:1000001", "--limit-members", "1000001"]);
    many.extend(["--limit-time", "0.5"].map(str::to_owned));
    ends(&strs(&many), 4, &["of 1000001 members: more time would be needed"]);
}

/// So many members that the sweep lasts long enough to be cut short.
const MANY: [&str; 6] = ["--members", "600", "--random", "ω=normal(1,0.3)", "--random", "a=uniform(0.1,1)"];

#[test]
fn a_sweep_cut_short_again_and_again_gives_the_same_bytes() {
    let place = Place::new(SLEIGH);
    let undisturbed = place.swept("whole.csv", &MANY);
    let mut cuts = 0;
    // Random places with a fixed seed, the first of them in the header of the journal.
    let mut random = SplitMix64::new(12_345);
    for k in 0..12 {
        let bytes = if k == 0 { 1 } else { 1 + random.next_bits() % 6000 };
        cuts += u32::from(place.cut("a.csv", bytes));
    }
    assert_eq!(cuts, 12, "the sweep is over too soon for this test");
    let resumed = place.swept("a.csv", &MANY);
    assert!(resumed == undisturbed);
    let table = lines(&resumed);
    assert!(table[1..].iter().enumerate().all(|(i, row)| row[0] == i.to_string()));
    assert_eq!(table.len(), 601);
}

/// The journal of a sweep that was cut short.
fn torn(place: &Place) -> Vec<u8> {
    assert!(place.cut("a.csv", 20_000), "still at work");
    fs::read(place.journal("a.csv")).expect("a journal")
}

#[test]
fn a_damaged_journal_is_repaired() {
    let place = Place::new(SLEIGH);
    let undisturbed = place.swept("whole.csv", &MANY);
    let journal = torn(&place);
    let header = journal.windows(2).position(|pair| pair == b"]]").expect("the end of the header") + 2;
    for k in 0..12 {
        let cut = header + (journal.len() - header) * k / 12;
        let mut damaged = journal[..cut].to_vec();
        if k % 3 == 1 {
            // Cut, and also changed in one bit.
            let place = header + (cut - header) / 2;
            damaged[place] ^= 1 << (k % 8);
        }
        fs::write(place.journal("a.csv"), damaged).expect("written");
        assert!(place.swept("a.csv", &MANY) == undisturbed, "cut at {cut} of {}", journal.len());
    }
    for cut in [0, 5, header - 1] {
        fs::write(place.journal("a.csv"), &journal[..cut]).expect("written");
        assert!(place.swept("a.csv", &MANY) == undisturbed, "cut in the header at {cut}");
    }
}

#[test]
fn the_journal_of_another_sweep_is_refused_with_the_difference() {
    let place = Place::new(SLEIGH);
    let journal = torn(&place);
    let with = |more: &[&str]| place.sweep("a.csv", &[&MANY[..], more].concat());
    for (more, mention) in [
        (&["--rtol", "1e-6"][..], "--rtol 1e-9, where now it is 1e-6"),
        (&["--seed", "1"], "--seed 0, where now it is 1"),
        (&["--t-end", "2"], "--t-end 3, where now it is 2"),
        (&["--set", "m=2"], "the parameter m = 1, where now it is 2"),
        (&["--rows", "2"], "--rows none, where now it is 2"),
        (&["--random", "m=uniform(1,2)"], "--random ω=normal(1,0.3) a=uniform(0.1,1), where now"),
    ] {
        ends(&strs(&with(more)), 2, &[mention, "a.csv.partial", "remove the file to start afresh"]);
    }
    fs::write(place.at("model.toml"), SLEIGH.replace("x = 0.0", "x = 0.1")).expect("written");
    ends(&strs(&with(&[])), 2, &["another text of the model"]);
    for foreign in [&b"precious"[..], &journal[3..], &[0; 4096]] {
        fs::write(place.journal("a.csv"), foreign).expect("written");
        ends(&strs(&with(&[])), 2, &["was not left by a sweep"]);
        assert_eq!(fs::read(place.journal("a.csv")).expect("a file"), foreign, "it is left as it was");
    }
    let held = fs::File::create(place.journal("b.csv")).expect("a file");
    held.try_lock().expect("locked");
    ends(&strs(&place.sweep("b.csv", &MANY)), 2, &["another sweep is writing"]);
}

/// Members for longer than the journal of one thread stays unwritten on a fast machine.
#[cfg(unix)]
const MORE: [&str; 6] = ["--members", "60000", "--random", "ω=normal(1,0.3)", "--random", "a=uniform(0.1,1)"];

/// What comes of a sweep that is interrupted once its journal is long enough, unless it ends before.
#[cfg(unix)]
fn interrupted(place: &Place, signal: &str) -> Output {
    let mut child = started(pc(&strs(&place.sweep("a.csv", &MORE))).stderr(Stdio::piped()));
    let length = || fs::metadata(place.journal("a.csv")).map_or(0, |metadata| metadata.len());
    until("the journal grows", || length() >= 10_000 || child.has_ended());
    child.signal(signal);
    ended(child)
}

/// As [`interrupted`], but before its end: on a busy machine a sweep may be faster than the signal.
#[cfg(unix)]
fn interrupted_midway(place: &Place, signal: &str) -> Output {
    for _ in 0..20 {
        let output = interrupted(place, signal);
        if output.status.code() != Some(0) {
            return output;
        }
        fs::remove_file(place.at("a.csv")).expect("a table");
    }
    panic!("each sweep ends before it is interrupted");
}

#[cfg(unix)]
#[test]
fn ctrl_c_and_a_kill_keep_finished_members() {
    let place = Place::new(SLEIGH);
    let undisturbed = place.swept("whole.csv", &MORE);
    let output = interrupted_midway(&place, "-INT");
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert!(stderr(&output).contains("of 60000 members; the same command continues from there"));
    assert!(!place.at("a.csv").exists());
    assert!(place.swept("a.csv", &MORE) == undisturbed);
    fs::remove_file(place.at("a.csv")).expect("a table");
    let output = interrupted_midway(&place, "-KILL");
    assert_eq!(output.status.code(), None, "{}", stderr(&output));
    assert!(!place.at("a.csv").exists());
    assert!(place.swept("a.csv", &MORE) == undisturbed);
}

#[cfg(feature = "parquet")]
#[test]
fn parquet_and_npz_hold_the_table_of_the_csv() {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use std::io::Read;

    let place = Place::new(MASSES);
    let options = ["--vary", "m=0:1:5"];
    let csv = lines(&place.swept("a.csv", &options));
    place.swept("a.parquet", &options);
    place.swept("a.npz", &options);
    let file = fs::File::open(place.at("a.parquet")).expect("a file");
    let reader = SerializedFileReader::new(file).expect("a parquet file");
    let columns = reader.metadata().file_metadata().schema_descr().columns();
    assert!(columns.iter().map(|column| column.name()).eq(csv[0].iter().map(String::as_str)));
    let number = |text: &str| text.parse::<f64>().expect("a number");
    let same = |a: f64, b: f64| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
    let mut archive =
        zip::ZipArchive::new(fs::File::open(place.at("a.npz")).expect("a file")).expect("an archive");
    let mut rows = 0;
    for (row, line) in reader.get_row_iter(None).expect("rows").zip(&csv[1..]) {
        for ((name, field), text) in row.expect("a row").get_column_iter().zip(line) {
            match field {
                parquet::record::Field::Double(value) => assert!(same(*value, number(text)), "{name}"),
                parquet::record::Field::ULong(value) => assert_eq!(&value.to_string(), text, "{name}"),
                parquet::record::Field::Str(value) if name != "message" => assert_eq!(value, text, "{name}"),
                field => assert_eq!(name, "message", "{field:?}"),
            }
        }
        rows += 1;
    }
    assert_eq!(rows, 5);
    for (j, name) in csv[0].iter().enumerate() {
        let mut bytes = Vec::new();
        archive.by_name(&format!("{name}.npy")).expect(name).read_to_end(&mut bytes).expect("an array");
        let array = npyz::NpyFile::new(&bytes[..]).expect("npy");
        match name.as_str() {
            "member" | "steps" => {
                let column: Vec<u64> = array.into_vec().expect("integers");
                assert!(column.iter().zip(&csv[1..]).all(|(value, line)| value.to_string() == line[j]));
            }
            "status" => {
                let column: Vec<String> = array.into_vec().expect("text");
                assert!(column.iter().zip(&csv[1..]).all(|(value, line)| *value == line[j]));
            }
            "message" => assert_eq!(array.into_vec::<String>().expect("text")[1], ""),
            _ => {
                let column: Vec<f64> = array.into_vec().expect("numbers");
                assert!(column.iter().zip(&csv[1..]).all(|(value, line)| same(*value, number(&line[j]))));
            }
        }
    }
}
