//! Knotted fibres.

mod shapes;

use super::Shown;
use crate::error::ViewError;
use crate::export::fibre;
use crate::export::files::{Files, Wanted, refusal};
use crate::export::finished::Finished;
use crate::guide::{Curve, Guide, Quantity, Setting, column, name, result};
use crate::plot::text::knot_name;
use crate::sweeps::OwnPicture;
use topo_lab::Elastic;

const SETTINGS: [Setting; 14] = [
    Setting::name("knot", "Knot", knot_name),
    Setting::number("twist", "θ′*h*", "Twist density θ′*h*"),
    Setting::name("reading", "Reading of *L*/*h*", name),
    Setting::number("slenderness", "*L*/*h*", "Slenderness *L*/*h*"),
    Setting::number("twist_ratio", "α", "Twist over bending stiffness α"),
    Setting::number("stretch_ratio", "γ", "Stretch stiffness γ"),
    Setting::number("contact_stiffness", "*k*_{c}", "Contact stiffness *k*_{c}"),
    Setting::number("friction_ratio", "η_{f}/η", "Friction η_{f}/η"),
    Setting::name("friction_range", "Friction range", |range| {
        format!("friction range {range}")
    }),
    Setting::number("imperfection", "imperfection/*h*", "Imperfection / *h*"),
    Setting::number("seed", "seed", "Seed"),
    Setting::number("edges", "*N*", "Edges *N*"),
    Setting::number("tolerance", "tolerance/*h*", "Tolerance / *h*"),
    Setting::number("cut", "*s*/*L*", "Place of the cut *s*/*L*").following(),
];

const RESULTS: [Quantity; 3] = [
    Quantity {
        label: "Discharge time *t* / *T*_{0}",
        columns: &[
            result("t50", "*t*_{50}", "Discharge time *t*_{50} / *T*_{0}"),
            result("t90", "*t*_{90}", "Discharge time *t*_{90} / *T*_{0}"),
            result("t95", "*t*_{95}", "Discharge time *t*_{95} / *T*_{0}"),
            result("t99", "*t*_{99}", "Discharge time *t*_{99} / *T*_{0}"),
        ],
        log: true,
    },
    Quantity {
        label: "Energy *E* / *E*_{0}",
        columns: &[
            result("energy", "*E*", "Stored energy *E* / *E*_{0}"),
            column("bend", "bending"),
            column("twist_energy", "twist"),
            column("stretch", "stretch"),
        ],
        log: false,
    },
    Quantity {
        label: "Turns",
        columns: &[
            result("writhe", "Wr", "Writhe Wr / turns"),
            column("total_twist", "Tw"),
        ],
        log: false,
    },
];

const PARTS: [Quantity; 3] = [
    Quantity {
        label: "Energy *E* / *E*_{0}",
        columns: &[
            column("energy", "*E*"),
            column("bend", "bending"),
            column("twist_energy", "twist"),
            column("stretch", "stretch"),
        ],
        log: false,
    },
    Quantity {
        label: "Dissipated / *E*_{0}",
        columns: &[
            column("dissipated_viscosity", "viscosity"),
            column("dissipated_twist", "twist"),
            column("dissipated_friction", "friction"),
        ],
        log: false,
    },
    Quantity {
        label: "Turns",
        columns: &[column("writhe", "Wr"), column("total_twist", "Tw")],
        log: false,
    },
];

impl Shown for Elastic {
    fn guide(&self) -> Guide {
        Guide {
            settings: &SETTINGS,
            results: &RESULTS,
            curve: Curve {
                file: "series.csv",
                time: "time",
                time_label: "Time *t* / *T*_{0}",
                energy: "energy",
                full: "energy",
                empty: None,
                of: Some("cut"),
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
        if wanted.nemaktis.is_some() && !wanted.vtk && !wanted.npz {
            return Err(refusal(
                case.folder,
                "a fibre has no director field for nemaktis: ask for vtk or npz",
            ));
        }
        fibre::write(
            case.folder,
            &case.part("tube")?,
            case.about(),
            wanted,
            files,
        )
    }

    fn pictures(&self) -> &'static [OwnPicture] {
        &[shapes::PICTURE]
    }
}

#[cfg(test)]
mod tests;
