//! VTK XML files with raw appended data.
//!
//! The format (VTK File Formats, XML, appended raw encoding): the XML names each array with its offset into
//! one block that starts after an underscore; there each array is its length in bytes as u64 and then its
//! values, all little endian. Values are streamed: no second copy of the particles is held.

use std::io::{self, Write};

/// Writes the array's values.
type Values<'a> = Box<dyn Fn(&mut dyn Write) -> io::Result<()> + 'a>;

/// One array of the file.
pub(super) struct Array<'a> {
    name: &'static str,
    /// `Float64`, `UInt8`, ...
    kind: &'static str,
    components: usize,
    bytes: u64,
    /// Empty of a pure number.
    unit: &'static str,
    values: Values<'a>,
}

impl<'a> Array<'a> {
    /// The same with its unit (`m/s`), which viewers show.
    pub fn in_unit(self, unit: &'static str) -> Array<'a> {
        Array { unit, ..self }
    }

    /// `components` values of `N` bytes each for every item, through `encode`.
    pub fn new<T, const N: usize, const C: usize>(
        name: &'static str,
        kind: &'static str,
        items: impl ExactSizeIterator<Item = T> + Clone + 'a,
        encode: impl Fn(T) -> [[u8; N]; C] + 'a,
    ) -> Array<'a> {
        Array {
            name,
            kind,
            components: C,
            unit: "",
            bytes: (items.len() * N * C) as u64,
            values: Box::new(move |out| {
                for item in items.clone() {
                    out.write_all(encode(item).as_flattened())?;
                }
                Ok(())
            }),
        }
    }
}

/// A named group of arrays: `Points`, `PointData`, `Cells`, ... with its attributes.
pub(super) struct Section<'a> {
    pub element: &'static str,
    pub attributes: &'static str,
    pub arrays: Vec<Array<'a>>,
}

/// One piece of a data set.
pub(super) struct DataSet<'a> {
    /// `UnstructuredGrid` or `PolyData`.
    pub kind: &'static str,
    /// The counts on the piece: `NumberOfPoints="3" ...`.
    pub counts: String,
    /// s, shown by viewers as the data's time.
    pub time: Option<f64>,
    /// Lists of names as field data: what the indices in an array stand for.
    pub names: Vec<(&'static str, &'a [String])>,
    pub sections: Vec<Section<'a>>,
}

impl DataSet<'_> {
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let kind = self.kind;
        writeln!(out, r#"<?xml version="1.0"?>"#)?;
        writeln!(out, r#"<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt64">"#)?;
        writeln!(out, "<{kind}>")?;
        if self.time.is_some() || self.names.iter().any(|(_, names)| !names.is_empty()) {
            write!(out, "<FieldData>")?;
            if let Some(time) = self.time {
                write!(
                    out,
                    r#"<DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">{time}</DataArray>"#
                )?;
            }
            for (array, names) in self.names.iter().filter(|(_, names)| !names.is_empty()) {
                // Characters by their numbers, each name with a zero at its end.
                write!(out, r#"<Array type="String" Name="{array}" NumberOfTuples="{}" format="ascii">"#, names.len())?;
                for name in *names {
                    name.bytes().try_for_each(|byte| write!(out, "{byte} "))?;
                    write!(out, "0 ")?;
                }
                write!(out, "</Array>")?;
            }
            writeln!(out, "</FieldData>")?;
        }
        writeln!(out, "<Piece {}>", self.counts)?;
        let mut offset = 0;
        for section in &self.sections {
            let element = section.element;
            writeln!(out, "<{element}{}>", section.attributes)?;
            for array in &section.arrays {
                writeln!(
                    out,
                    r#"<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{offset}">{}</DataArray>"#,
                    array.kind,
                    array.name,
                    array.components,
                    unit_label(array.unit)
                )?;
                offset += size_of::<u64>() as u64 + array.bytes;
            }
            writeln!(out, "</{element}>")?;
        }
        write!(out, "</Piece>\n</{kind}>\n<AppendedData encoding=\"raw\">\n_")?;
        for array in self.sections.iter().flat_map(|section| &section.arrays) {
            out.write_all(&array.bytes.to_le_bytes())?;
            (array.values)(out)?;
        }
        write!(out, "\n</AppendedData>\n</VTKFile>\n")
    }
}

/// As VTK's own writers leave it.
fn unit_label(unit: &str) -> String {
    if unit.is_empty() {
        return String::new();
    }
    format!(r#"<InformationKey name="UNITS_LABEL" location="vtkDataArray">{unit}</InformationKey>"#)
}
