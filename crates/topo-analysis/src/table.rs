//! Rows of the tables that figures draw, and how they are written and read.

use std::path::Path;

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use topo_core::write_atomic_bytes;

use crate::AnalysisError;

/// One discharge: energies in E_0 = E_b h² L, times in T_0 = 2 L η/(h E_b), L the row's own length.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SweepRow {
    /// Folder of the case beside the table.
    pub case: String,
    /// Knot type.
    pub knot: String,
    /// θ'h tied in before the ends were fused.
    pub twist: f64,
    /// Place of the cut, s/L.
    pub cut: f64,
    /// Reading of the slenderness.
    pub reading: String,
    /// Edges of the rod.
    pub edges: usize,
    /// L/h.
    #[serde(default)]
    pub slenderness: f64,
    /// Ratio α of twist to bending stiffness.
    #[serde(default)]
    pub twist_ratio: f64,
    /// Stretch stiffness γ = E/E_b.
    #[serde(default)]
    pub stretch_ratio: f64,
    /// Stiffness k_c of the contact; empty without contact.
    #[serde(default)]
    pub contact_stiffness: Option<f64>,
    /// η_f/η; empty without friction.
    #[serde(default)]
    pub friction_ratio: Option<f64>,
    /// Where friction reaches: as the reading says, contact, or a multiple of the contact diameter; empty without friction.
    #[serde(default)]
    pub friction_range: Option<String>,
    /// Random perturbation of the start curve, in h.
    #[serde(default)]
    pub imperfection: f64,
    /// Its seed, and that of the closures.
    #[serde(default)]
    pub seed: u64,
    /// Local error aimed at, in h.
    #[serde(default)]
    pub tolerance: f64,
    /// Elastic energy after charging.
    pub energy: f64,
    /// Its bending part.
    pub bend: f64,
    /// Its twist part.
    pub twist_energy: f64,
    /// Its stretch part.
    pub stretch: f64,
    /// Elastic energy that the image of an amphichiral knot which was not kept has after charging; empty where only one was
    /// charged, and in tables written before there was this column.
    #[serde(default)]
    pub energy_other_image: Option<f64>,
    /// Writhe after charging.
    pub writhe: f64,
    /// Total twist after charging, in turns.
    pub total_twist: f64,
    /// Time at which half of the elastic energy before the cut was released; 0 if the cut itself did.
    pub t50: Option<f64>,
    /// Same for 90 %.
    pub t90: Option<f64>,
    /// Same for 95 %.
    pub t95: Option<f64>,
    /// Same for 99 %.
    pub t99: Option<f64>,
    /// Time at which half of the elastic energy that the cut left was released.
    pub t50_after_cut: Option<f64>,
    /// Same for 90 %.
    pub t90_after_cut: Option<f64>,
    /// Same for 95 %.
    pub t95_after_cut: Option<f64>,
    /// Same for 99 %.
    pub t99_after_cut: Option<f64>,
    /// Time of the last change of the knot type to the unknot; empty if not seen.
    pub t_untie: Option<f64>,
    /// Largest |Δ(Tw + Wr)| while closed, in turns.
    pub link_drift: Option<f64>,
    /// Least distance of vertices of different strands over the contact diameter, charge and discharge.
    pub min_distance_over_contact: Option<f64>,
    /// Accepted steps of charge and discharge.
    pub steps: u64,
    /// Refused steps of charge and discharge.
    pub rejected: u64,
    /// Processor seconds of this discharge and its share of the charge.
    pub cpu_seconds: f64,
    /// Warnings, separated by `;`.
    pub warnings: String,
}

impl SweepRow {
    /// Whether two rows are of one charged state, whatever their resolution.
    pub fn is_same_state(&self, other: &Self) -> bool {
        let settings = |r: &Self| {
            (
                r.knot.clone(),
                r.reading.clone(),
                [
                    r.twist,
                    r.slenderness,
                    r.twist_ratio,
                    r.stretch_ratio,
                    r.imperfection,
                ],
                [r.contact_stiffness, r.friction_ratio],
                r.friction_range.clone(),
                r.seed,
            )
        };
        settings(self) == settings(other)
    }

    /// t50, t90, t95 and t99.
    pub fn times(&self) -> [Option<f64>; 4] {
        [self.t50, self.t90, self.t95, self.t99]
    }
}

/// One knot: lengths in units of the tube radius.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct KnotRow {
    /// Name.
    pub knot: String,
    /// Vertices of the tight polygon.
    pub vertices: usize,
    /// Its ropelength.
    pub length_over_radius: f64,
    /// Published ropelength, if any.
    pub reference: Option<f64>,
    /// Excess over the published one, in per cent.
    pub excess_percent: Option<f64>,
    /// Writhe.
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
    /// Processor seconds that the tightening took.
    pub cpu_seconds: f64,
}

/// Adds a warning to a cell of warnings.
pub(crate) fn push_warning(warnings: &mut String, text: &str) {
    if !warnings.is_empty() {
        warnings.push(';');
    }
    // `;` separates warnings
    warnings.push_str(&text.replace(';', ","));
}

/// Writes rows as CSV with a header, atomically.
///
/// # Errors
/// A file that cannot be written, with its path and the remedy.
pub fn write_table<T: Serialize>(path: &Path, rows: &[T]) -> Result<(), AnalysisError> {
    Ok(write_atomic_bytes(path, &table_bytes(path, rows)?)?)
}

/// The bytes that [`write_table`] writes; `path` names them in messages.
///
/// # Errors
/// A row that cannot stand in a table.
pub fn table_bytes<T: Serialize>(path: &Path, rows: &[T]) -> Result<Vec<u8>, AnalysisError> {
    let wrong = |source| AnalysisError::Table {
        path: path.to_owned(),
        source,
    };
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).map_err(wrong)?;
    }
    writer
        .into_inner()
        .map_err(|e| wrong(e.into_error().into()))
}

/// Reads rows of a CSV with a header.
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
/// As [`read_table`], but for those of the file system.
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
            "case,knot,twist,cut,reading,edges,slenderness,twist_ratio,stretch_ratio,contact_stiffness,friction_ratio,friction_range,imperfection,seed,tolerance,energy,bend,twist_energy,stretch,energy_other_image,writhe,total_twist,t50,t90,t95,t99,t50_after_cut,t90_after_cut,t95_after_cut,t99_after_cut,t_untie,link_drift,min_distance_over_contact,steps,rejected,cpu_seconds,warnings"
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
}
