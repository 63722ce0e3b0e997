//! The surfaces of triangles in a drawing.

use std::path::{Path, PathBuf};

use pc_mech::{Expr, Graph};
use pc_model::{Model, ModelError, Shape};

use crate::mesh::Mesh;

/// The largest number of triangles in all surfaces together, on a page and in a still.
const MOST_FACES: [usize; 2] = [12_000, 3_000];

/// The surfaces of files, each once.
#[derive(Default)]
pub(crate) struct Surfaces {
    files: Vec<(PathBuf, [f64; 3])>,
    /// Each about its middle, the place of which is among the middles.
    meshes: Vec<Mesh>,
    middles: Vec<[f64; 3]>,
}

impl Surfaces {
    /// Those of a drawing.
    ///
    /// # Errors
    /// [`ModelError`] at the entry of the text whose file is not there, or has none.
    pub(crate) fn of(model: &Model, drawing: &[Shape<'_>]) -> Result<Surfaces, ModelError> {
        let mut surfaces = Surfaces::default();
        for shape in drawing {
            let Shape::Mesh { file, scale, .. } = shape else { continue };
            if surfaces.index(file, *scale).is_none() {
                let mesh =
                    Mesh::read(file, *scale).map_err(|error| model.not_drawn(file, error.to_string()))?;
                let (mesh, middle) = mesh.centred();
                surfaces.files.push((file.clone(), *scale));
                surfaces.meshes.push(mesh);
                surfaces.middles.push(middle);
            }
        }
        Ok(surfaces)
    }

    /// A shape that is at its middle: x + R c.
    pub(crate) fn centred<'g>(&self, graph: &'g Graph, shape: Shape<'g>) -> Shape<'g> {
        let Shape::Mesh { file, scale, at, rotation } = shape else { return shape };
        let middle = self.index(&file, scale).map_or([0.0; 3], |index| self.middles[index]).map(Expr::from);
        let at = [0, 1, 2].map(|i| at[i] + graph.dot((0..3).map(|j| rotation[(i, j)]), middle));
        Shape::Mesh { file, scale, at, rotation }
    }

    pub(crate) fn index(&self, file: &Path, scale: [f64; 3]) -> Option<usize> {
        self.files.iter().position(|(known, of)| known == file && *of == scale)
    }

    /// The surfaces with as many triangles as there is room for, each with its part of them.
    pub(crate) fn simplified(&self) -> Vec<[Mesh; 2]> {
        let all: usize = self.meshes.iter().map(|mesh| mesh.faces.len()).sum();
        let part = |mesh: &Mesh, most: usize| match all <= most {
            true => mesh.clone(),
            false => mesh.simplified((most as f64 * mesh.faces.len() as f64 / all as f64).ceil() as usize),
        };
        self.meshes.iter().map(|mesh| MOST_FACES.map(|most| part(mesh, most))).collect()
    }
}
