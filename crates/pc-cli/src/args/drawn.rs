//! Arguments for pictures of a motion.

use clap::Args;
use pc_report::picture::Wanted;

/// Which parts of a motion are drawn, and how.
#[derive(Clone, Debug, Default, Args)]
pub struct DrawnArguments {
    /// With --plot: draw column Y against column X, as a path or a phase portrait; components of a vector, such as x and y, are
    /// drawn to the same scale (repeatable)
    #[arg(long, value_name = "X,Y", value_parser = pair, requires = "plot")]
    pub xy: Vec<(String, String)>,
    /// With --plot: wrap these angles, separated by commas, to the range from −π to π
    #[arg(long, value_name = "NAMES", value_delimiter = ',', requires = "plot")]
    pub wrap: Vec<String>,
}

impl DrawnArguments {
    /// What is drawn, with these columns over time, in the form that `pc_report` takes.
    pub fn wanted(&self, columns: Vec<String>) -> Wanted {
        let wrapped = self.wrap.iter().map(|name| name.trim().to_owned()).collect();
        Wanted { columns, pairs: self.xy.clone(), wrapped }
    }
}

fn pair(text: &str) -> Result<(String, String), String> {
    match text.split_once(',').map(|(x, y)| (x.trim(), y.trim())) {
        Some((x, y)) if !x.is_empty() && !y.is_empty() && !y.contains(',') => {
            Ok((x.to_owned(), y.to_owned()))
        }
        _ => Err("write X,Y, two columns, as in `--xy x,y`".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_split_at_the_comma() {
        assert_eq!(pair("x, y"), Ok(("x".to_owned(), "y".to_owned())));
        for wrong in ["x", "x,", ",y", "x,y,z", ""] {
            assert!(pair(wrong).is_err(), "{wrong}");
        }
    }
}
