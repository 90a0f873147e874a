//! What pictures and exports must know of it.

use topo_core::Vector3;
use topo_view::export::{Archive, Array, Files, Finished, Wanted, line};
use topo_view::guide::{Curve, Guide, Quantity, Setting, column, result};
use topo_view::{Shown, ViewError};

use crate::battery::Unwinding;
use crate::rows::Vertex;

const SETTINGS: [Setting; 3] = [
    Setting::number("length", "*L*/*h*", "Length *L*/*h*"),
    Setting::number("turn", "Φ", "Turn Φ"),
    Setting::number("edges", "*N*", "Edges *N*"),
];

const RESULTS: [Quantity; 2] = [
    Quantity {
        label: "Discharge time *t* *C*/ζ*h*^{2}",
        columns: &[
            result("t50", "*t*_{50}", "Discharge time *t*_{50} *C*/ζ*h*^{2}"),
            column("t90", "*t*_{90}"),
            result("t99", "*t*_{99}", "Discharge time *t*_{99} *C*/ζ*h*^{2}"),
        ],
        log: true,
    },
    Quantity {
        label: "Energy *Eh*/*C*",
        columns: &[result("energy", "*E*", "Stored energy *Eh*/*C*")],
        log: false,
    },
];

const PARTS: [Quantity; 1] = [Quantity {
    label: "Energy *Eh*/*C*",
    columns: &[column("energy", "*E*"), column("dissipated", "drag")],
    log: false,
}];

impl Shown for Unwinding {
    fn guide(&self) -> Guide {
        Guide {
            settings: &SETTINGS,
            results: &RESULTS,
            curve: Curve {
                file: "series.csv",
                time: "time",
                time_label: "Time *t* *C*/ζ*h*^{2}",
                energy: "energy",
                full: "energy",
                empty: None,
                of: None,
            },
            parts: &PARTS,
        }
    }

    fn export(
        &self,
        case: &Finished<'_>,
        wanted: &Wanted,
        files: &mut Files<'_>,
    ) -> Result<(), ViewError> {
        let wrong = |reason: String| ViewError::Case {
            path: case.folder.to_owned(),
            reason,
        };
        if !wanted.vtk && !wanted.npz {
            let reason = "a straight fibre has no director: ask for vtk or npz";
            return Err(wrong(reason.to_owned()));
        }
        let rows = csv::Reader::from_path(case.folder.join("angles.csv"))
            .and_then(|reader| {
                reader
                    .into_deserialize()
                    .collect::<Result<Vec<Vertex>, _>>()
            })
            .map_err(|e| wrong(e.to_string()))?;
        let angles = |of: fn(&Vertex) -> f64| rows.iter().map(of).collect::<Vec<f64>>();
        let shapes = [
            ("charged", angles(|v| v.charged)),
            ("end", angles(|v| v.end)),
        ];
        if wanted.vtk {
            let points: Vec<_> = rows.iter().map(|v| Vector3::new(v.s, 0.0, 0.0)).collect();
            for (name, angles) in &shapes {
                let angle = Array::scalars("angle", angles.iter().copied());
                let path = files.place(&format!("{name}.vtp"));
                line(&path, &case.about(), &points, false, &[angle])?;
            }
        }
        if wanted.npz {
            let mut archive = Archive::new(&case.about())?;
            archive.add("s", &[rows.len()], angles(|v| v.s))?;
            for (name, angles) in shapes {
                archive.add(&format!("angle_{name}"), &[rows.len()], angles)?;
            }
            archive.write(&files.place("fibre.npz"))?;
        }
        Ok(())
    }
}
