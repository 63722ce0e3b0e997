//! Where an installation goes, in the words of `cargo cinstall`.

use std::path::{Component, Path, PathBuf};

use crate::error::Error;

/// The directories of an installation, all of them absolute.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Places {
    pub(super) prefix: PathBuf,
    /// Of the libraries, and of what finds them.
    pub(super) libdir: PathBuf,
    /// Of the headers.
    pub(super) includedir: PathBuf,
    /// In which all of it is put together, to be moved to the root by who packs it.
    destdir: Option<PathBuf>,
}

impl Places {
    /// The usual ones below a prefix.
    ///
    /// # Errors
    /// [`Error::File`] if it has no absolute path.
    pub(crate) fn below(prefix: &Path) -> Result<Places, Error> {
        let prefix = absolute(prefix)?;
        let (libdir, includedir) = (prefix.join("lib"), prefix.join("include"));
        Ok(Places { prefix, libdir, includedir, destdir: None })
    }

    /// Those of `--prefix DIR [--libdir DIR] [--includedir DIR] [--destdir DIR]`, where a relative directory of libraries
    /// or headers is one below the prefix.
    ///
    /// # Errors
    /// [`Error::Usage`] for other words, and as [`below`](Places::below).
    pub(crate) fn of(command: &str, words: &[String]) -> Result<Places, Error> {
        let usage = |message: String| Err(Error::Usage { message });
        let mut given: [Option<&str>; 4] = [None; 4];
        let mut words = words.iter();
        while let Some(word) = words.next() {
            let (name, value) = word.split_once('=').map_or((word.as_str(), None), |(n, v)| (n, Some(v)));
            let Some(i) = OPTIONS.iter().position(|&option| option == name) else {
                return usage(format!("`{command}` does not take `{word}`"));
            };
            let Some(value) = value.or_else(|| words.next().map(String::as_str)) else {
                return usage(format!("`{command}` needs `{name} DIR`"));
            };
            if given[i].replace(value).is_some() {
                return usage(format!("`{command}` takes `{name}` once"));
            }
        }
        let [Some(prefix), libdir, includedir, destdir] = given else {
            return usage(format!("`{command}` needs `--prefix DIR`"));
        };
        let mut places = Places::below(Path::new(prefix))?;
        for (place, given) in [(&mut places.libdir, libdir), (&mut places.includedir, includedir)] {
            if let Some(directory) = given {
                *place = places.prefix.join(directory);
            }
        }
        places.destdir = destdir.map(|directory| absolute(Path::new(directory))).transpose()?;
        Ok(places)
    }

    /// Where a file that will stand at `path` is put.
    pub(super) fn staged(&self, path: &Path) -> PathBuf {
        match &self.destdir {
            Some(destdir) => destdir.join(path.strip_prefix("/").unwrap_or(path)),
            None => path.to_owned(),
        }
    }

    /// The part of a directory below the prefix; none if it is elsewhere.
    pub(super) fn inside<'a>(&self, directory: &'a Path) -> Option<&'a Path> {
        let rest = directory.strip_prefix(&self.prefix).ok()?;
        rest.components().all(|component| matches!(component, Component::Normal(_))).then_some(rest)
    }

    /// The way from one directory to another that stays below the prefix; none if one of them does not.
    pub(super) fn way(&self, from: &Path, to: &Path) -> Option<PathBuf> {
        let (from, to) = (self.inside(from)?, self.inside(to)?);
        let up = from.components().map(|_| Component::ParentDir);
        Some(up.chain(to.components()).collect())
    }
}

const OPTIONS: [&str; 4] = ["--prefix", "--libdir", "--includedir", "--destdir"];

fn absolute(path: &Path) -> Result<PathBuf, Error> {
    std::path::absolute(path).map_err(|source| Error::File { path: path.display().to_string(), source })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(line: &str) -> Result<Places, String> {
        let words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
        Places::of("install", &words).map_err(|error| error.to_string())
    }

    #[test]
    fn directories_are_those_given_or_below_the_prefix() {
        let usual = of("--prefix /opt/pc").unwrap();
        assert_eq!(usual, Places::below(Path::new("/opt/pc")).unwrap());
        assert_eq!(usual, of("--includedir include --libdir=/opt/pc/lib --prefix=/opt/pc").unwrap());
        assert_eq!(usual.staged(&usual.libdir), Path::new("/opt/pc/lib"));
        let packed = of("--prefix /usr --libdir lib/x --destdir /stage").unwrap();
        assert_eq!(packed.libdir, Path::new("/usr/lib/x"));
        assert_eq!(packed.staged(&packed.libdir), Path::new("/stage/usr/lib/x"));
        assert_eq!(packed.staged(&packed.includedir), Path::new("/stage/usr/include"));
        assert!(of("--prefix here").unwrap().libdir.is_absolute());
    }

    #[test]
    fn the_word_at_fault_is_named() {
        assert_eq!(of("--libdir x"), Err("`install` needs `--prefix DIR`".to_owned()));
        assert_eq!(of("--prefix"), Err("`install` needs `--prefix DIR`".to_owned()));
        assert_eq!(of("--prefix a --destdir"), Err("`install` needs `--destdir DIR`".to_owned()));
        assert_eq!(of("--prefix a --prefix b"), Err("`install` takes `--prefix` once".to_owned()));
        assert_eq!(of("--prefix a --bindir b"), Err("`install` does not take `--bindir`".to_owned()));
    }

    #[test]
    fn relative_paths_stay_below_the_prefix() {
        let places = of("--prefix /usr --libdir lib/x86_64-linux-gnu --includedir /opt/include").unwrap();
        let way = |from: &Path, to: &Path| places.way(from, to);
        assert_eq!(way(&places.libdir, &places.prefix), Some("../..".into()));
        assert_eq!(way(&places.libdir, Path::new("/usr/include")), Some("../../include".into()));
        assert_eq!(way(&places.libdir, &places.includedir), None);
        assert_eq!(way(Path::new("/usr/../lib"), &places.prefix), None);
    }
}
