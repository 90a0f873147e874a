//! How tables are written and read, and the row of the table of knots.

use std::path::Path;

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use topo_core::write_atomic_bytes;

use crate::AnalysisError;
use crate::further::expanded;

/// One knot: lengths in units of the tube radius.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct KnotRow {
    /// Name.
    pub knot: String,
    /// Vertices of the tight polygon.
    pub vertices: usize,
    /// Its ropelength, in tube radii.
    pub length_over_radius: f64,
    /// Published ropelength, in tube radii, if any.
    pub reference: Option<f64>,
    /// Excess over the published one, in per cent.
    pub excess_percent: Option<f64>,
    /// Writhe: no unit.
    pub writhe: f64,
    /// Average crossing number.
    pub average_crossing_number: f64,
    /// Pairs of edges in contact.
    pub struts: usize,
    /// Vertices as sharp as the tube allows.
    pub kinks: usize,
    /// Coefficients of the Alexander polynomial.
    pub alexander: String,
    /// Determinant.
    pub determinant: u64,
    /// Signature.
    pub signature: i32,
    /// Processor time that the tightening took, in seconds.
    pub cpu_seconds: f64,
}

/// One link: lengths in units of the tube radius.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct LinkRow {
    /// Name.
    pub link: String,
    /// Length of all components over the radius of the tube around them.
    pub length_over_radius: f64,
    /// Published one, exact where it is proved or calculated, if any.
    pub reference: Option<f64>,
    /// Key of its publication.
    pub source: String,
    /// Part of the tension that contacts cannot balance.
    pub residual: f64,
    /// Excess over the published one, in per cent.
    pub excess_percent: Option<f64>,
    /// Number of components.
    pub components: usize,
    /// Vertices of the tight polygons.
    pub vertices: usize,
    /// Linking numbers of the pairs of components: 1 and 2, 1 and 3, 2 and 3, and so on.
    pub linking_numbers: String,
    /// Sum of the writhes of the components: no unit.
    pub writhe: f64,
    /// Pairs of edges in contact.
    pub struts: usize,
    /// Vertices as sharp as the tube allows.
    pub kinks: usize,
    /// Whether the length came to rest at the finest level.
    pub converged: bool,
    /// Processor time that the tightening took, in seconds.
    pub cpu_seconds: f64,
}

/// Writes rows as CSV with a header, atomically. A field `further` of type [`Further`](crate::Further) becomes columns of their own.
///
/// # Errors
/// A file that cannot be written, with its path and the remedy.
pub fn write_table<T: Serialize>(path: &Path, rows: &[T]) -> Result<(), AnalysisError> {
    Ok(write_atomic_bytes(path, &table_bytes(path, rows)?)?)
}

/// The bytes that [`write_table`] writes; `path` names them in messages.
///
/// # Errors
/// A row that cannot be written as a table row.
pub fn table_bytes<T: Serialize>(path: &Path, rows: &[T]) -> Result<Vec<u8>, AnalysisError> {
    let wrong = |source| AnalysisError::Table {
        path: path.to_owned(),
        source,
    };
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).map_err(wrong)?;
    }
    let table = writer
        .into_inner()
        .map_err(|e| wrong(e.into_error().into()))?;
    expanded(table).map_err(wrong)
}

/// Names of the columns of a row.
///
/// # Errors
/// A row that cannot be written as a table row.
pub fn columns<T: Serialize>(row: &T) -> Result<Vec<String>, AnalysisError> {
    let table = table_bytes(Path::new("a row"), std::slice::from_ref(row))?;
    let header = table.split(|byte| *byte == b'\n').next().unwrap_or(&[]);
    let header = String::from_utf8_lossy(header);
    Ok(header.split(',').map(str::to_owned).collect())
}

/// Reads rows of a CSV with a header; columns that the row type does not have are ignored.
///
/// # Errors
/// A file that cannot be read or a row that does not fit, with path and line.
pub fn read_table<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>, AnalysisError> {
    let wrong = |source| AnalysisError::Table {
        path: path.to_owned(),
        source,
    };
    let bytes = std::fs::read(path).map_err(|e| wrong(e.into()))?;
    parse_table(path, &bytes)
}

/// Reads rows from the bytes of a CSV with a header; `path` names it in messages.
///
/// # Errors
/// As [`read_table`], except those of the file system.
pub fn parse_table<T: DeserializeOwned>(
    path: &Path,
    bytes: &[u8],
) -> Result<Vec<T>, AnalysisError> {
    let rows = csv::Reader::from_reader(bytes).into_deserialize();
    rows.collect::<Result<_, _>>()
        .map_err(|source| AnalysisError::Table {
            path: path.to_owned(),
            source,
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Further, SweepRow};

    #[test]
    fn tables_come_back_as_written_and_carry_the_agreed_header() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sweep.csv");
        let rows = vec![
            SweepRow {
                knot: "3_1".into(),
                t99: Some(19.5),
                warnings: "a;b".into(),
                ..Default::default()
            },
            SweepRow::default(),
        ];
        write_table(&path, &rows).unwrap();
        assert_eq!(read_table::<SweepRow>(&path).unwrap(), rows);
        let text = std::fs::read_to_string(&path).unwrap();
        assert_eq!(
            text.lines().next().unwrap(),
            "case,knot,name,components,linking,twist,cut,cut_by,reading,edges,slenderness,length,twist_ratio,stretch_ratio,contact_stiffness,friction_ratio,friction_range,load_spring,load_rest_length,load_dashpot,imperfection,seed,tolerance,energy,bend,twist_energy,stretch,energy_other_image,writhe,total_twist,t50,t90,t95,t99,t50_after_cut,t90_after_cut,t95_after_cut,t99_after_cut,t_untie,energy_in,work,heat,residual,peak_power,efficiency,energy_per_mass,link_drift,min_distance_over_contact,steps,rejected,cpu_seconds,warnings"
        );
        let path = folder.path().join("table.csv");
        write_table(&path, &[KnotRow::default()]).unwrap();
        assert_eq!(
            std::fs::read_to_string(&path)
                .unwrap()
                .lines()
                .next()
                .unwrap(),
            "knot,vertices,length_over_radius,reference,excess_percent,writhe,average_crossing_number,struts,kinks,alexander,determinant,signature,cpu_seconds"
        );
        assert!(read_table::<SweepRow>(&path).is_err());
    }

    /// Each name is a column after the standard energies; where the table already has such a column, `_energy` is appended.
    #[test]
    fn further_energies_are_columns_of_their_name() {
        let row = |case: &str, further: &[(&str, f64)]| SweepRow {
            case: case.into(),
            further: further.iter().copied().collect(),
            ..Default::default()
        };
        let rows = [
            row("a", &[("trap", 1.0 / 3.0), ("writhe", 2.0)]),
            row("b,c", &[("wall", 1e-9), ("trap", 0.25)]),
        ];
        let bytes = table_bytes(Path::new("sweep.csv"), &rows).unwrap();
        let plain = table_bytes(Path::new("sweep.csv"), &[SweepRow::default()]).unwrap();
        let lines = |bytes: &[u8]| -> Vec<String> {
            let text = String::from_utf8(bytes.to_vec()).unwrap();
            text.lines().map(str::to_owned).collect()
        };
        let (found, plain) = (lines(&bytes), lines(&plain));
        let more = ",stretch,trap,writhe_energy,wall,energy_other_image,";
        assert_eq!(
            found[0],
            plain[0].replace(",stretch,energy_other_image,", more)
        );
        let mut reader = csv::Reader::from_reader(bytes.as_slice());
        let cells: Vec<_> = reader.records().map(Result::unwrap).collect();
        let place = plain[0].split(',').position(|c| c == "stretch").unwrap();
        let of = |k: usize| -> Vec<&str> { cells[k].iter().skip(place + 1).take(3).collect() };
        assert_eq!(of(0), ["0.3333333333333333", "2.0", ""]);
        assert_eq!(of(1), ["0.25", "", "1e-9"]);
        assert_eq!(&cells[1][0], "b,c");
        // left out where a table is read
        let read: Vec<SweepRow> = parse_table(Path::new("sweep.csv"), &bytes).unwrap();
        assert_eq!(read[1].further, Further::default());
    }
}
