//! VTK poly data, two files per frame, and ParaView indices over time.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::ExportError;
use super::grains::FrameWriter;
use super::whole_file::WholeFile;
use crate::frames::{Body, Frame, Grain};

/// `grains-000000.vtp` … with `grains.pvd`, and the same of `bodies`, in SI units. Grains are points with
/// `radius`, `velocity`, `speed`, `force`, `id`; bodies are surfaces, whose points have a `velocity` and the
/// number of their `body`.
///
/// Source: The VTK User's Guide, XML file formats; the numbers stand behind the text, as they are.
pub(super) struct Vtp {
    out: PathBuf,
    grains: Series,
    bodies: Series,
    files: Vec<PathBuf>,
}

/// Files that belong together.
struct Series {
    name: &'static str,
    /// Times (s) and names.
    frames: Vec<(f64, String)>,
}

/// An array of a file: its element with what names it, and its numbers in little endian.
struct Array {
    attributes: &'static str,
    bytes: Vec<u8>,
}

/// What is in a file.
struct Piece {
    n_points: usize,
    point_data: Vec<Array>,
    points: [Array; 1],
    /// `Verts` or `Polys`.
    kind: &'static str,
    n_cells: usize,
    /// Connectivity and offsets.
    cells: [Array; 2],
}

impl Array {
    fn new<const N: usize, I: IntoIterator<Item = [u8; N]>>(
        attributes: &'static str,
        numbers: I,
    ) -> Self {
        Self { attributes, bytes: numbers.into_iter().flatten().collect() }
    }

    fn points(coordinates: impl IntoIterator<Item = [f32; 3]>) -> Self {
        Self::vectors(r#"type="Float32" Name="Points" NumberOfComponents="3""#, coordinates)
    }

    fn velocities(velocities: impl IntoIterator<Item = [f32; 3]>) -> Self {
        Self::vectors(r#"type="Float32" Name="velocity" NumberOfComponents="3""#, velocities)
    }

    fn vectors(attributes: &'static str, vectors: impl IntoIterator<Item = [f32; 3]>) -> Self {
        Self::new(attributes, vectors.into_iter().flat_map(|vector| vector.map(f32::to_le_bytes)))
    }

    /// Connectivity of cells of `corners` points each, and where they end.
    fn cells(connectivity: impl ExactSizeIterator<Item = i64>, corners: usize) -> [Self; 2] {
        let ends = (corners..=connectivity.len()).step_by(corners);
        let offsets: Vec<[u8; 8]> = ends.map(|end| (end as i64).to_le_bytes()).collect();
        [
            Self::new(r#"type="Int64" Name="connectivity""#, connectivity.map(i64::to_le_bytes)),
            Self::new(r#"type="Int64" Name="offsets""#, offsets),
        ]
    }
}

impl Piece {
    fn of_grains(grains: &[Grain]) -> Self {
        let floats = |attributes, of: fn(&Grain) -> f32| {
            Array::new(attributes, grains.iter().map(move |grain| of(grain).to_le_bytes()))
        };
        Self {
            n_points: grains.len(),
            point_data: vec![
                floats(r#"type="Float32" Name="radius""#, |grain| grain.radius),
                Array::velocities(grains.iter().map(|grain| grain.velocity)),
                floats(r#"type="Float32" Name="speed""#, |grain| grain.speed),
                floats(r#"type="Float32" Name="force""#, |grain| grain.force),
                Array::new(r#"type="UInt32" Name="id""#, grains.iter().map(|g| g.id.to_le_bytes())),
            ],
            points: [Array::points(grains.iter().map(|grain| grain.position))],
            // Every point is a vertex of its own.
            kind: "Verts",
            n_cells: grains.len(),
            cells: Array::cells((0..grains.len()).map(|i| i as i64), 1),
        }
    }

    fn of_bodies(bodies: &[Body]) -> Self {
        let single = |vector: &[f64; 3]| vector.map(|x| x as f32);
        let (mut points, mut velocities) = (Vec::new(), Vec::new());
        let (mut of_body, mut corners) = (Vec::new(), Vec::new());
        for (number, Body { surface, velocities: of_corners, .. }) in (0_u32..).zip(bodies) {
            let first = points.len() as i64;
            points.extend(surface.corners.iter().map(single));
            velocities.extend(of_corners.iter().map(single));
            of_body.resize(points.len(), number.to_le_bytes());
            let indices = surface.triangles.iter().flatten();
            corners.extend(indices.map(|&corner| first + i64::from(corner)));
        }
        Self {
            n_points: points.len(),
            point_data: vec![
                Array::velocities(velocities),
                Array::new(r#"type="UInt32" Name="body""#, of_body),
            ],
            points: [Array::points(points)],
            kind: "Polys",
            n_cells: corners.len() / 3,
            cells: Array::cells(corners.into_iter(), 3),
        }
    }

    fn write(&self, file: &mut impl Write) -> io::Result<()> {
        let count = |kind| if kind == self.kind { self.n_cells } else { 0 };
        writeln!(
            file,
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" \
             byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n<Piece \
             NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" \
             NumberOfPolys=\"{}\">",
            self.n_points,
            count("Verts"),
            count("Polys")
        )?;
        let mut offset = 0;
        for (element, arrays) in [
            ("PointData", &self.point_data[..]),
            ("Points", &self.points),
            (self.kind, &self.cells),
        ] {
            writeln!(file, "<{element}>")?;
            for Array { attributes, bytes } in arrays {
                writeln!(
                    file,
                    "<DataArray {attributes} format=\"appended\" offset=\"{offset}\"/>"
                )?;
                offset += size_of::<u64>() + bytes.len();
            }
            writeln!(file, "</{element}>")?;
        }
        write!(file, "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_")?;
        for Array { bytes, .. } in self.point_data.iter().chain(&self.points).chain(&self.cells) {
            file.write_all(&(bytes.len() as u64).to_le_bytes())?;
            file.write_all(bytes)?;
        }
        writeln!(file, "\n</AppendedData>\n</VTKFile>")
    }
}

impl Series {
    fn new(name: &'static str) -> Self {
        Self { name, frames: Vec::new() }
    }

    /// One more file, at the place and time of `frame`.
    fn add(&mut self, out: &Path, frame: &Frame, piece: &Piece) -> Result<PathBuf, ExportError> {
        let name = format!("{}-{:06}.vtp", self.name, frame.number);
        let mut file = WholeFile::create(out.join(&name))?;
        piece.write(&mut file).map_err(|error| file.failed(error))?;
        self.frames.push((frame.time, name));
        file.finish()
    }

    /// The index over time.
    fn finish(&self, out: &Path) -> Result<PathBuf, ExportError> {
        let mut file = WholeFile::create(out.join(format!("{}.pvd", self.name)))?;
        let line = |(time, name): &(f64, String)| {
            format!("<DataSet timestep=\"{time:?}\" part=\"0\" file=\"{name}\"/>\n")
        };
        let lines: String = self.frames.iter().map(line).collect();
        let text = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n\
             {lines}</Collection>\n</VTKFile>\n"
        );
        file.write_all(text.as_bytes()).map_err(|error| file.failed(error))?;
        file.finish()
    }
}

impl Vtp {
    pub(super) fn new(out: &Path) -> Self {
        let [grains, bodies] = ["grains", "bodies"].map(Series::new);
        Self { out: out.to_owned(), grains, bodies, files: Vec::new() }
    }
}

impl FrameWriter for Vtp {
    fn frame(&mut self, frame: &Frame) -> Result<(), ExportError> {
        let (grains, bodies) = (Piece::of_grains(&frame.grains), Piece::of_bodies(&frame.bodies));
        self.files.push(self.grains.add(&self.out, frame, &grains)?);
        self.files.push(self.bodies.add(&self.out, frame, &bodies)?);
        Ok(())
    }

    fn finish(mut self) -> Result<Vec<PathBuf>, ExportError> {
        for series in [&self.bodies, &self.grains] {
            self.files.push(series.finish(&self.out)?);
        }
        Ok(self.files)
    }
}
