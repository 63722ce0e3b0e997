//! The meshes with which links are drawn, where their files are there.

use std::path::{Path, PathBuf};

use crate::import::pose::Pose;

/// The directories between which paths lead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Directories<'a> {
    /// Where the file of the robot is.
    pub robot: &'a Path,
    /// Where the text of the model is to be.
    pub model: &'a Path,
}

/// A mesh that is seen.
#[derive(Clone, Debug)]
pub(crate) struct Visual {
    /// The file as the robot names it.
    pub(crate) file: String,
    /// The pose of the file's axes in the link.
    pub(crate) origin: Pose,
    pub(crate) scale: [f64; 3],
}

/// The formats of meshes that drawings can contain.
const FORMATS: [&str; 2] = ["stl", "obj"];

impl<'a> Directories<'a> {
    /// Those of two files.
    pub fn of_files(robot: &'a Path, model: &'a Path) -> Directories<'a> {
        // The parent of a name alone is empty, which is no path of a directory.
        let directory = |file: &'a Path| match file.parent() {
            Some(parent) if parent != Path::new("") => parent,
            _ => Path::new("."),
        };
        Directories { robot: directory(robot), model: directory(model) }
    }

    /// The path of a mesh as the model names it; `None` where the file is not there, or cannot be drawn.
    pub(crate) fn path(&self, named: &str) -> Option<String> {
        let file = self.file(named)?;
        let format = file.extension()?.to_str()?.to_lowercase();
        if !FORMATS.contains(&format.as_str()) {
            return None;
        }
        // Without a common beginning, the whole path.
        let [file, model] = [file, self.model.to_owned()].map(|path| std::path::absolute(path).ok());
        let (file, model) = (file?, model?);
        let path = pathdiff::diff_paths(&file, model).unwrap_or(file);
        Some(path.to_str()?.replace('\\', "/"))
    }

    /// The file on this machine. `package://NAME/PATH` is in a directory of this name, in which the robot is, or which is beside
    /// one of the directories in which the robot is, as in ROS.
    fn file(&self, named: &str) -> Option<PathBuf> {
        let Some(of_package) = named.strip_prefix("package://").or(named.strip_prefix("model://")) else {
            let file = self.robot.join(named.strip_prefix("file://").unwrap_or(named));
            return file.is_file().then_some(file);
        };
        let robot = std::path::absolute(self.robot).ok()?;
        robot.ancestors().map(|directory| directory.join(of_package)).find(|file| file.is_file())
    }
}
