//! VTK poly data, one file per frame, and a ParaView index over time.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::ExportError;
use super::grains::{Frame, FrameWriter, Grain};
use super::whole_file::WholeFile;

/// `grains-000000.vtp` … and `grains.pvd`, in SI units. Points have `radius`, `speed`, `force`, `id`.
///
/// Source: The VTK User's Guide, XML file formats; the numbers stand behind the text, as they are.
pub(super) struct Vtp {
    out: PathBuf,
    /// Times (s) and names of the frames.
    frames: Vec<(f64, String)>,
    files: Vec<PathBuf>,
}

/// An array of a file: its element with what names it, and its numbers in little endian.
struct Array {
    attributes: &'static str,
    bytes: Vec<u8>,
}

impl Array {
    fn new<const N: usize, I: IntoIterator<Item = [u8; N]>>(
        attributes: &'static str,
        numbers: I,
    ) -> Self {
        Self { attributes, bytes: numbers.into_iter().flatten().collect() }
    }
}

impl Vtp {
    pub(super) fn new(out: &Path) -> Self {
        Self { out: out.to_owned(), frames: Vec::new(), files: Vec::new() }
    }
}

fn write(file: &mut impl Write, grains: &[Grain]) -> io::Result<()> {
    let n = grains.len();
    let floats = |attributes, of: fn(&Grain) -> f32| {
        Array::new(attributes, grains.iter().map(move |grain| of(grain).to_le_bytes()))
    };
    let point_data = [
        floats(r#"type="Float32" Name="radius""#, |grain| grain.radius),
        floats(r#"type="Float32" Name="speed""#, |grain| grain.speed),
        floats(r#"type="Float32" Name="force""#, |grain| grain.force),
        Array::new(r#"type="UInt32" Name="id""#, grains.iter().map(|g| g.id.to_le_bytes())),
    ];
    let coordinates = grains.iter().flat_map(|grain| grain.position.map(f32::to_le_bytes));
    let points =
        [Array::new(r#"type="Float32" Name="Points" NumberOfComponents="3""#, coordinates)];
    // Every point is a vertex of its own.
    let verts = [
        Array::new(r#"type="Int64" Name="connectivity""#, (0..n as i64).map(i64::to_le_bytes)),
        Array::new(r#"type="Int64" Name="offsets""#, (1..=n as i64).map(i64::to_le_bytes)),
    ];
    writeln!(
        file,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" \
         byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n<Piece \
         NumberOfPoints=\"{n}\" NumberOfVerts=\"{n}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" \
         NumberOfPolys=\"0\">"
    )?;
    let mut offset = 0;
    for (element, arrays) in
        [("PointData", &point_data[..]), ("Points", &points), ("Verts", &verts)]
    {
        writeln!(file, "<{element}>")?;
        for Array { attributes, bytes } in arrays {
            writeln!(file, "<DataArray {attributes} format=\"appended\" offset=\"{offset}\"/>")?;
            offset += size_of::<u64>() + bytes.len();
        }
        writeln!(file, "</{element}>")?;
    }
    write!(file, "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_")?;
    for Array { bytes, .. } in point_data.iter().chain(&points).chain(&verts) {
        file.write_all(&(bytes.len() as u64).to_le_bytes())?;
        file.write_all(bytes)?;
    }
    writeln!(file, "\n</AppendedData>\n</VTKFile>")
}

impl FrameWriter for Vtp {
    fn frame(&mut self, frame: &Frame) -> Result<(), ExportError> {
        let name = format!("grains-{:06}.vtp", frame.number);
        let mut file = WholeFile::create(self.out.join(&name))?;
        write(&mut file, &frame.grains).map_err(|error| file.failed(error))?;
        self.files.push(file.finish()?);
        self.frames.push((frame.time, name));
        Ok(())
    }

    fn finish(mut self) -> Result<Vec<PathBuf>, ExportError> {
        let mut file = WholeFile::create(self.out.join("grains.pvd"))?;
        let lines: Vec<String> = self
            .frames
            .iter()
            .map(|(time, name)| {
                format!("<DataSet timestep=\"{time:?}\" part=\"0\" file=\"{name}\"/>\n")
            })
            .collect();
        let text = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n{}\
             </Collection>\n</VTKFile>\n",
            lines.concat()
        );
        file.write_all(text.as_bytes()).map_err(|error| file.failed(error))?;
        self.files.push(file.finish()?);
        Ok(self.files)
    }
}
