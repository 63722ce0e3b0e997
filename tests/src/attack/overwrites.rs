//! Results under the names of what is read, in every disguise: what is read stays.

use std::fs;
use std::io;
use std::os::unix::fs::symlink;

use crate::attack::victim::{Finding, Victim};
use crate::fuzz::random::Random;

const PLAIN: &str = "[parameters]\np = 1\n[coordinates]\na = 1.0\n[gravity]\nacceleration = [0, 0, -9.81]\n\
                     [bodies.a]\njoint = { kind = \"revolute\", axis = [0, 1, 0] }\nmass = \"p\"\n\
                     center = [0, 0, -1]\n[simulation]\nt_end = 0.1\nsamples = 3\n";
const TABLE: &str = "t,u\n0,1\n1,3\n";
/// What `with` replaces by the name of a file.
const FILE: &str = "IN";
/// What `with` replaces by the name of what is written.
const RESULT: &str = "OUT";

/// What a command reads, or holds already.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Read {
    /// A model, or the table of one.
    Model,
    /// The model on standard input.
    Stream,
    Robot,
    Shard,
    Checkpoint,
    /// A file that is there already, and is not to be replaced.
    Kept,
    /// Another result of the same command.
    Result,
}

/// A command that writes OUT and reads IN, whose names end alike; what is written is OUT with the second ending.
#[derive(Clone, Copy, Debug)]
struct Writing(Read, &'static [&'static str], &'static [&'static str], &'static str);

const WRITINGS: &[Writing] = &[
    Writing(Read::Model, &["run", "IN", "-o", "OUT"], &[".csv", ".json", ".npz", ".parquet"], ""),
    Writing(Read::Model, &["run", "IN", "--plot", "OUT"], &[".svg", ".png", ".pdf"], ""),
    Writing(Read::Model, &["run", "IN", "--checkpoint", "OUT"], &["", ".toml"], ""),
    Writing(Read::Model, &["linearize", "IN", "-o", "OUT"], &[".json", ".csv", ".npz", ".mat"], ""),
    Writing(Read::Model, &["linearize", "IN", "--vary", "p=1:2:2", "--plot", "OUT"], &[".svg", ".png"], ""),
    Writing(Read::Model, &["equilibria", "IN", "-o", "OUT"], &[".json", ".csv"], ""),
    Writing(Read::Model, &["report", "IN", "-o", "OUT"], &[".html", ".htm"], ""),
    Writing(Read::Model, &["animate", "IN", "-o", "OUT"], &[".html", ".gif", ".svg", ".png", ".pdf"], ""),
    Writing(Read::Model, &["sweep", "IN", "--vary", "p=1:2:2", "-o", "OUT"], &[".csv", ".parquet"], ""),
    Writing(Read::Model, &["sweep", "IN", "--vary", "p=1:2:2", "-o", "OUT"], &[".csv"], ".partial"),
    Writing(
        Read::Model,
        &["sweep", "IN", "--vary", "p=1:2:2", "--shard", "1/2", "-o", "OUT"],
        &[".csv"],
        ".shard-1-of-2",
    ),
    Writing(
        Read::Model,
        &["sweep", "IN", "--vary", "p=1:2:2", "-o", "other.csv", "--plot", "OUT"],
        &[".svg"],
        "",
    ),
    Writing(Read::Model, &["emit", "IN", "--fmu", "2", "--sources-only", "-o", "OUT"], &[".fmu"], ""),
    Writing(Read::Model, &["emit", "IN", "--fmu", "3", "--sources-only", "-o", "OUT"], &[".fmu"], ""),
    Writing(Read::Model, &["emit", "IN", "--lang", "c", "-o", "OUT"], &[".c", ".h"], "/"),
    Writing(Read::Model, &["emit", "IN", "--lang", "rust", "-o", "OUT"], &[".rs"], "/"),
    Writing(Read::Model, &["export", "IN", "-o", "OUT"], &["", ".urdf"], ""),
    Writing(Read::Model, &["check", "IN", "-o", "OUT"], &["", ".txt"], ""),
    Writing(Read::Model, &["derive", "IN", "-o", "OUT"], &["", ".tex"], ""),
    Writing(Read::Model, &["theory", "IN", "-o", "OUT"], &["", ".txt"], ""),
    Writing(Read::Stream, &["run", "-", "-o", "OUT"], &[".csv", ".npz"], ""),
    Writing(Read::Stream, &["report", "-", "-o", "OUT"], &[".html"], ""),
    Writing(Read::Stream, &["emit", "-", "--fmu", "2", "--sources-only", "-o", "OUT"], &[".fmu"], ""),
    Writing(Read::Stream, &["export", "-", "-o", "OUT"], &[".urdf"], ""),
    Writing(Read::Robot, &["import", "IN", "-o", "OUT"], &["", ".urdf", ".toml"], ""),
    Writing(Read::Shard, &["merge", "IN", "-o", "OUT"], &[".csv", ".json"], ""),
    Writing(Read::Shard, &["merge", "IN", "-o", "other.csv", "--plot", "OUT"], &[".svg"], ""),
    Writing(Read::Checkpoint, &["run", "plain.toml", "--resume", "IN", "-o", "OUT"], &[".csv"], ""),
    Writing(Read::Checkpoint, &["run", "plain.toml", "--resume", "IN", "--plot", "OUT"], &[".svg"], ""),
    Writing(Read::Kept, &["new", "joints", "-o", "OUT"], &["", ".toml"], ""),
    Writing(Read::Result, &["run", "plain.toml", "-o", "IN", "--checkpoint", "OUT"], &[".csv"], ""),
    Writing(Read::Result, &["run", "plain.toml", "--plot", "IN", "--checkpoint", "OUT"], &[".svg"], ""),
];

/// Directories in which the file has its own name again, and how it comes to be there.
const DISGUISES: &[&str] =
    &["", "./", "/", "linked/", "chain/", "twin/", "there/", "there/../", "case", "there/twin/./"];

/// A writing, the ending of the names, a disguise, and whether it is the file read that is disguised; and whether that is
/// the table of the model.
#[derive(Clone, Copy, Debug)]
pub struct Attempt {
    writing: Writing,
    ending: &'static str,
    disguise: &'static str,
    is_read_disguised: bool,
    is_table: bool,
}

/// All of them, in an order by chance.
pub fn attempts(random: &mut Random) -> Vec<Attempt> {
    let mut all = Vec::new();
    for &writing in WRITINGS {
        for &ending in writing.2 {
            for &disguise in DISGUISES {
                for (is_read_disguised, is_table) in [(false, false), (true, false), (false, true)] {
                    if !is_table || writing.0 == Read::Model {
                        all.push(Attempt { writing, ending, disguise, is_read_disguised, is_table });
                    }
                }
            }
        }
    }
    random.shuffle(&mut all);
    all
}

/// Has results written under the names of what is read.
///
/// # Errors
/// If files cannot be made.
pub fn overwrites(victim: &Victim, attempts: &[Attempt]) -> io::Result<Vec<Finding>> {
    fs::write(victim.file("plain.toml"), PLAIN)?;
    for made in [
        &["sweep", "plain.toml", "--vary", "p=1:2:2", "-o", "made.csv", "--shard", "1/1"][..],
        &["export", "plain.toml", "-o", "made.urdf"],
        &["run", "plain.toml", "-o", "made.csv", "--checkpoint", "made.point"],
    ] {
        match victim.run(made)? {
            Ok(ended) if ended.code == Some(0) => {}
            Ok(ended) => return Ok(vec![ended.finding("not done")]),
            Err(finding) => return Ok(vec![finding]),
        }
    }
    let mut findings = Vec::new();
    for (number, attempt) in attempts.iter().enumerate() {
        let room = victim.room(&format!("room{number}"))?;
        findings.extend(attempt.made(victim, &room)?);
        fs::remove_dir_all(room.file(""))?;
    }
    Ok(findings)
}

impl Attempt {
    /// The finding, if there is one.
    fn made(&self, victim: &Victim, room: &Victim) -> io::Result<Option<Finding>> {
        let Writing(read, command, _, second) = self.writing;
        let name = match second {
            "/" => format!("m{}", self.ending),
            _ => format!("m{}{second}", self.ending),
        };
        let bytes = self.bytes(victim)?;
        fs::write(room.file("plain.toml"), PLAIN)?;
        fs::write(room.file(&name), &bytes)?;
        let Some(other) = self.disguised(room, &name)? else { return Ok(None) };
        let (input, output) =
            if self.is_read_disguised { (other, name.clone()) } else { (name.clone(), other) };
        let input = if self.is_table { reader(room, &name)? } else { with_slash(input) };
        let output = match second {
            "/" => with_slash(output).trim_end_matches(&name).to_owned(),
            _ => output.trim_end_matches(second).to_owned(),
        };
        let word = |word: &'static str| match word {
            FILE => input.clone(),
            RESULT => output.clone(),
            _ => word.to_owned(),
        };
        let words: Vec<String> = command.iter().copied().map(word).collect();
        let arguments: Vec<&str> = words.iter().map(String::as_str).collect();
        let ended =
            if read == Read::Stream { room.run_on(&name, &arguments)? } else { room.run(&arguments)? };
        Ok(match ended {
            Err(finding) => Some(finding),
            Ok(ended) if fs::read(room.file(&name))? != bytes => {
                Some(ended.finding(format!("{name} is not as it was")))
            }
            Ok(ended) if !self.may_end(ended.code) => {
                Some(ended.finding(format!("exit code {:?}, not 2", ended.code)))
            }
            Ok(_) => None,
        })
    }

    /// It is refused; or it is another file that was written, if anything was: not all commands have a result for the model of
    /// a table. What is there already cannot be written.
    fn may_end(&self, code: Option<i32>) -> bool {
        match code {
            Some(2) => true,
            Some(0) => self.disguise == "case",
            Some(3..=5) => self.disguise == "case" && self.is_table,
            Some(6) => self.writing.0 == Read::Kept,
            _ => false,
        }
    }

    /// What is in the file that is to stay.
    fn bytes(&self, victim: &Victim) -> io::Result<Vec<u8>> {
        match self.writing.0 {
            _ if self.is_table => Ok(TABLE.as_bytes().to_vec()),
            Read::Model | Read::Stream => Ok(PLAIN.as_bytes().to_vec()),
            Read::Robot => fs::read(victim.file("made.urdf")),
            Read::Shard => fs::read(victim.file("made.csv.shard-1-of-1")),
            Read::Checkpoint => fs::read(victim.file("made.point")),
            Read::Kept | Read::Result => Ok(b"before".to_vec()),
        }
    }

    /// Another path of the file; none where there is no such path.
    fn disguised(&self, room: &Victim, name: &str) -> io::Result<Option<String>> {
        for directory in ["linked", "chain", "twin"] {
            fs::create_dir(room.file(directory))?;
        }
        symlink(format!("../{name}"), room.file("linked").join(name))?;
        symlink(format!("../linked/{name}"), room.file("chain").join(name))?;
        fs::hard_link(room.file(name), room.file("twin").join(name))?;
        symlink(".", room.file("there"))?;
        Ok(match self.disguise {
            "/" => Some(fs::canonicalize(room.file(name))?.display().to_string()),
            "there/../" => {
                let own = fs::canonicalize(room.file(""))?;
                own.file_name().map(|own| format!("there/../{}/{name}", own.to_string_lossy()))
            }
            // Another file, unless the system takes them for the same; two results are two files then.
            "case" if self.is_read_disguised || self.writing.0 == Read::Result => None,
            "case" => Some(name.to_uppercase()),
            directory => Some(format!("{directory}{name}")),
        })
    }
}

/// A model with the table of this name.
fn reader(room: &Victim, table: &str) -> io::Result<String> {
    let text =
        format!("{PLAIN}[inputs]\nu = {{ file = \"{table}\", column = \"u\" }}\n[forces]\na = \"u\"\n");
    // Source is called like its model.
    fs::write(room.file("m.model"), &text)?;
    Ok("./m.model".to_owned())
}

/// A path that is not taken for the name of a model.
fn with_slash(path: String) -> String {
    if path.contains('/') { path } else { format!("./{path}") }
}
