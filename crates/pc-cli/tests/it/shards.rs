//! `pc sweep --shard` and `pc merge`: the same bytes as one process, whatever happens to the
//! processes of the shards.

use std::fs;

use crate::sweeps::Place;

/// A blade on ice, pushed off its mass centre.
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

const RANDOM: [&str; 6] = ["--members", "500", "--random", "ω=normal(1,0.3)", "--random", "a=uniform(0.1,1)"];
/// Members with m = 0 are refused: the mass matrix is singular.
const GRID: [&str; 4] = ["--vary", "m=0,1,2", "--vary", "a=0.1:1:7"];

/// The sweep into `table`, or a shard of it.
fn sweep<'a>(table: &'a str, members: &[&'a str], shard: &'a str) -> Vec<&'a str> {
    let whole = [&["sweep", "model.toml", "-o", table][..], members].concat();
    if shard.is_empty() { whole } else { [&whole[..], &["--shard", shard]].concat() }
}

#[track_caller]
fn merged(place: &Place, table: &str, shards: &[&str]) -> Vec<u8> {
    place.ends(&[&["merge", "-o", table][..], shards].concat(), 0, &[]);
    fs::read(place.at(table)).expect("a table")
}

#[test]
fn shards_give_the_bytes_of_one_process() {
    let place = Place::new(SLEIGH);
    let mut extensions = vec!["csv", "json", "npz"];
    if cfg!(feature = "parquet") {
        extensions.push("parquet");
    }
    for extension in extensions {
        let (whole, table) = (format!("whole.{extension}"), format!("a.{extension}"));
        let undisturbed = place.swept(&whole, &GRID);
        for shard in ["1/3", "2/3", "3/3"] {
            place.ends(&sweep(&table, &GRID, shard), 0, &["  shard    ", shard, "for pc merge"]);
        }
        assert!(!place.at(&table).exists(), "there is no table of a part");
        let shards = [3, 1, 2].map(|i| format!("{table}.shard-{i}-of-3"));
        let shards: Vec<&str> = shards.iter().map(String::as_str).collect();
        assert!(merged(&place, &table, &shards) == undisturbed, "{extension}");
        assert!(shards.iter().all(|shard| place.at(shard).exists()), "they stay where they are");
    }
    // With all rows, and more shards than members.
    let members = ["--vary", "a=0.1:1:2", "--rows", "3"];
    let undisturbed = place.swept("rows.csv", &members);
    for shard in ["1/3", "2/3", "3/3"] {
        place.ends(&sweep("b.csv", &members, shard), 0, &[]);
    }
    let shards = ["b.csv.shard-1-of-3", "b.csv.shard-2-of-3", "b.csv.shard-3-of-3"];
    assert!(merged(&place, "b.csv", &shards) == undisturbed);
    place.ends(
        &["merge", "a.csv.shard-1-of-3", "a.csv.shard-2-of-3", "a.csv.shard-3-of-3", "-o", "c.csv"],
        0,
        &["  shards   3\n", "  members  21, 14 completed, 7 not\n", "refused  member 0: "],
    );
}

#[test]
fn shards_that_do_not_belong_together_are_named() {
    let place = Place::new(SLEIGH);
    for shard in ["1/3", "2/3"] {
        place.ends(&sweep("a.csv", &GRID, shard), 0, &[]);
    }
    let (one, two) = ("a.csv.shard-1-of-3", "a.csv.shard-2-of-3");
    let refuses = |shards: &[&str], mentions: &[&str]| {
        place.ends(&[&["merge", "-o", "a.csv"][..], shards].concat(), 2, mentions);
        assert!(!place.at("a.csv").exists(), "nothing is written");
    };
    refuses(&[one, two], &["of 3 shards one is missing: 3"]);
    refuses(&[two], &["of 3 shards some are missing: 1, 3"]);
    refuses(&[one, two, one], &["the shard 1/3 is there twice", one]);
    refuses(&[one, "model.toml"], &["model.toml was not left by `pc sweep --shard`"]);
    place.ends(&["merge", "-o", "a.csv", "nothing"], 6, &["cannot use nothing"]);
    // Shards of other sweeps: another tolerance, another text, another number of shards, a whole
    // sweep.
    let other = [&GRID[..], &["--rtol", "1e-6"]].concat();
    place.ends(&sweep("b.csv", &other, "3/3"), 0, &[]);
    refuses(
        &[one, two, "b.csv.shard-3-of-3"],
        &["b.csv.shard-3-of-3", "not of the same sweep", "--rtol 1e-6"],
    );
    place.ends(&sweep("c.csv", &GRID, "3/4"), 0, &[]);
    refuses(
        &[one, two, "c.csv.shard-3-of-4"],
        &["not of the same sweep", "--shard 3/4, where there it is 1/3"],
    );
    // An incomplete shard, which continues.
    let whole = "a.csv.shard-3-of-3";
    place.ends(&sweep("a.csv", &GRID, "3/3"), 0, &[]);
    let bytes = fs::read(place.at(whole)).expect("a shard");
    fs::write(place.at(whole), &bytes[..bytes.len() - 5]).expect("written");
    refuses(&[one, two, whole], &[whole, "the shard 3/3, has 6 of its 7 members", "repeat its command"]);
    place.ends(&sweep("a.csv", &GRID, "3/3"), 0, &["6 were finished before"]);
    assert!(fs::read(place.at(whole)).expect("a shard") == bytes, "the same shard");
    // A shard that is being written.
    let held = fs::File::open(place.at(two)).expect("a file");
    held.try_lock().expect("locked");
    refuses(&[one, two, whole], &["another sweep is writing", two]);
    held.unlock().expect("unlocked");
    assert!(merged(&place, "a.csv", &[one, two, whole]) == place.swept("whole.csv", &GRID));
    for shard in ["0/3", "4/3", "1", "x/y"] {
        place.ends(&sweep("a.csv", &GRID, shard), 2, &["write I/N"]);
    }
}

#[test]
fn shards_cut_short_continue_where_they_were() {
    let place = Place::new(SLEIGH);
    let undisturbed = place.swept("whole.csv", &RANDOM);
    let mut cuts = 0;
    for shard in ["1/2", "2/2"] {
        let journal = format!("a.csv.shard-{}-of-2", &shard[..1]);
        let arguments = sweep("a.csv", &RANDOM, shard);
        // Each time later than before, and at another place of a record.
        for bytes in (0..10).map(|i| 700 + 977 * i) {
            if !place.cut(&arguments, &journal, bytes) {
                break;
            }
            cuts += 1;
        }
        place.ends(&arguments, 0, &[]);
    }
    assert!(cuts >= 6, "{cuts} cuts");
    let shards = ["a.csv.shard-1-of-2", "a.csv.shard-2-of-2"];
    assert!(merged(&place, "a.csv", &shards) == undisturbed);
}
