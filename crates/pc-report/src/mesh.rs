//! Surfaces of triangles, from files in STL and OBJ.

use std::collections::{HashMap, HashSet};
use std::io::{self, ErrorKind};
use std::path::Path;

use mesh_loader::Loader;
use pc_model::document::read_file_bounded;

/// The finest grid of corners, in cells along the longest edge of the surface; each coarser one has this part of the cells.
const FINEST: f64 = 1024.0;
const COARSER: f64 = 0.8;

/// A surface of triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The corners.
    pub corners: Vec<[f32; 3]>,
    /// The triangles, each by the indices of its corners.
    pub faces: Vec<[u32; 3]>,
}

impl Mesh {
    /// The surface in a file, its lengths multiplied by a factor for each axis.
    ///
    /// # Errors
    /// Those of the file; [`ErrorKind::InvalidData`] and [`ErrorKind::Unsupported`] for what is in it.
    pub fn read(path: &Path, scale: [f64; 3]) -> io::Result<Mesh> {
        let bytes = read_file_bounded(path)?;
        // Materials, for which there would be other files, are not drawn.
        let scene = Loader::default().load_from_slice_with_reader(&bytes, path, |_| Ok(Vec::new()))?;
        let mut mesh = Mesh::default();
        for part in scene.meshes {
            let first = mesh.corners.len() as u32;
            mesh.faces.extend(part.faces.iter().map(|face| face.map(|corner| first.saturating_add(corner))));
            mesh.corners
                .extend(part.vertices.iter().map(|p| [0, 1, 2].map(|k| (f64::from(p[k]) * scale[k]) as f32)));
        }
        let wrong = |what: &str| Err(io::Error::new(ErrorKind::InvalidData, what));
        if mesh.corners.iter().flatten().any(|x| !x.is_finite()) {
            return wrong("a coordinate is not a finite number");
        }
        if mesh.faces.iter().flatten().any(|&corner| corner as usize >= mesh.corners.len()) {
            return wrong("a triangle has a corner that is not there");
        }
        match mesh.faces.is_empty() {
            true => wrong("it has no triangles"),
            false => Ok(mesh.joined(|p| p.map(f32::to_bits))),
        }
    }

    /// The surface about the middle of the box around it, and the place of that.
    #[must_use]
    pub fn centred(mut self) -> (Mesh, [f64; 3]) {
        let middle = [0, 1, 2].map(|k| {
            let along = || self.corners.iter().map(|p| p[k]);
            let (low, high) =
                (along().fold(f32::INFINITY, f32::min), along().fold(f32::NEG_INFINITY, f32::max));
            f64::midpoint(f64::from(low), f64::from(high))
        });
        for corner in &mut self.corners {
            *corner = [0, 1, 2].map(|k| (f64::from(corner[k]) - middle[k]) as f32);
        }
        (self, middle)
    }

    /// The surface with at most this many triangles: corners that lie in one cell of a grid become one.
    #[must_use]
    pub fn simplified(&self, most: usize) -> Mesh {
        if self.faces.len() <= most {
            return self.clone();
        }
        let reach = self.reach();
        let longest = reach.into_iter().fold(f32::MIN_POSITIVE, f32::max);
        let mut cells = FINEST;
        loop {
            let cell = longest / cells as f32;
            let coarse = self.joined(|p| p.map(|x| (x / cell).floor() as i32));
            if coarse.faces.len() <= most || cells < 1.0 {
                return coarse;
            }
            cells *= COARSER;
        }
    }

    /// The largest distance of a corner from the origin along each axis.
    pub fn reach(&self) -> [f32; 3] {
        [0, 1, 2].map(|k| self.corners.iter().fold(0.0, |reach: f32, p| reach.max(p[k].abs())))
    }

    /// The surface with one corner, the mean, for all that have the same `key`; without triangles that have become lines, or have
    /// become one.
    fn joined<K: std::hash::Hash + Eq>(&self, key: impl Fn([f32; 3]) -> K) -> Mesh {
        let mut known: HashMap<K, u32> = HashMap::new();
        let mut sums: Vec<([f64; 3], f64)> = Vec::new();
        let mut of_corner = Vec::with_capacity(self.corners.len());
        for &corner in &self.corners {
            let place = *known.entry(key(corner)).or_insert_with(|| {
                sums.push(([0.0; 3], 0.0));
                sums.len() as u32 - 1
            });
            let (sum, count) = &mut sums[place as usize];
            (0..3).for_each(|k| sum[k] += f64::from(corner[k]));
            *count += 1.0;
            of_corner.push(place);
        }
        let mut seen = HashSet::new();
        let faces = self.faces.iter().map(|face| face.map(|corner| of_corner[corner as usize]));
        let faces = faces.filter(|&[a, b, c]| a != b && b != c && c != a).filter(|face| {
            let mut corners = *face;
            corners.sort_unstable();
            seen.insert(corners)
        });
        let faces = faces.collect();
        Mesh { corners: sums.iter().map(|(sum, count)| sum.map(|x| (x / count) as f32)).collect(), faces }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tetrahedron in the text form of STL, whose corners stand there three times.
    fn tetrahedron() -> String {
        let corners = ["0 0 0", "1 0 0", "0 1 0", "0 0 1"];
        let facet = |[a, b, c]: [usize; 3]| {
            let vertices = [a, b, c].map(|i| format!("vertex {}\n", corners[i])).concat();
            format!("facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
        };
        let facets = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]].map(facet).concat();
        format!("solid t\n{facets}endsolid t\n")
    }

    fn read(name: &str, text: &str, scale: [f64; 3]) -> io::Result<Mesh> {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join(name);
        std::fs::write(&path, text).unwrap();
        Mesh::read(&path, scale)
    }

    #[test]
    fn both_formats_give_the_same_surface() {
        let stl = read("t.stl", &tetrahedron(), [1.0, 2.0, 0.001]).unwrap();
        let obj = "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
        let obj = read("t.obj", obj, [1.0, 2.0, 0.001]).unwrap();
        assert_eq!((stl.corners.len(), stl.faces.len()), (4, 4));
        assert_eq!(stl.reach(), [1.0, 2.0, 0.001]);
        let (centred, middle) = stl.clone().centred();
        assert_eq!(
            (centred.reach(), middle),
            ([0.5, 1.0, 0.0005], [0.5, 1.0, 0.0005].map(|x: f32| x.into()))
        );
        let places = |mesh: &Mesh| {
            let face = |face: &[u32; 3]| face.map(|corner| mesh.corners[corner as usize].map(f32::to_bits));
            mesh.faces.iter().map(face).collect::<HashSet<_>>()
        };
        assert_eq!(places(&stl), places(&obj));
    }

    #[test]
    fn what_is_no_surface_is_refused() {
        for (name, text) in [
            ("t.stl", "solid nothing\nendsolid nothing\n"),
            ("t.stl", "no solid"),
            ("t.obj", "v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\n"),
            ("t.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9\n"),
            ("t.txt", "nothing"),
        ] {
            let error = read(name, text, [1.0; 3]).unwrap_err();
            assert!(
                matches!(error.kind(), ErrorKind::InvalidData | ErrorKind::Unsupported | ErrorKind::Other),
                "{text}: {error:?}"
            );
        }
        assert_eq!(Mesh::read(Path::new("not/there.stl"), [1.0; 3]).unwrap_err().kind(), ErrorKind::NotFound);
    }

    /// A sphere keeps its size when it has fewer triangles.
    #[test]
    fn large_surfaces_become_coarser() {
        const ROUND: usize = 120;
        let angle = |i: usize, whole: f64| whole * i as f64 / ROUND as f64;
        let corner = |i: usize, j: usize| {
            let ((sin, cos), (s, c)) =
                (angle(i, std::f64::consts::PI).sin_cos(), angle(j, std::f64::consts::TAU).sin_cos());
            [sin * c, sin * s, cos].map(|x| x as f32)
        };
        let corners = (0..=ROUND).flat_map(|i| (0..ROUND).map(move |j| corner(i, j))).collect();
        let at = |i: usize, j: usize| (i * ROUND + j % ROUND) as u32;
        let faces = (0..ROUND).flat_map(|i| (0..ROUND).map(move |j| (i, j))).flat_map(|(i, j)| {
            [[at(i, j), at(i + 1, j), at(i, j + 1)], [at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]]
        });
        let sphere = Mesh { corners, faces: faces.collect() };
        let coarse = sphere.simplified(2000);
        assert!((500..=2000).contains(&coarse.faces.len()), "{}", coarse.faces.len());
        let radius = |p: &[f32; 3]| p.iter().map(|x| x * x).sum::<f32>().sqrt();
        assert!(coarse.corners.iter().all(|p| (0.97..=1.0).contains(&radius(p))));
        assert_eq!(sphere.simplified(sphere.faces.len()), sphere);
    }
}
