//! Charged colloids in a nematic.

mod pictures;

use super::Shown;
use crate::error::ViewError;
use crate::export::colloid;
use crate::export::files::{Files, Wanted};
use crate::export::finished::Finished;
use crate::guide::{Curve, Guide, Quantity, Setting, column, name, result};
use crate::sweeps::OwnPicture;
use topo_lab::Colloid;

const SETTINGS: [Setting; 20] = [
    Setting::number("q", "*q*", "Topological charge *q*"),
    Setting::name("flow", "Flow", |flow| match flow {
        "on" => "with flow".to_owned(),
        "off" => "without flow".to_owned(),
        other => other.to_owned(),
    }),
    Setting::name("pattern", "Pattern", name),
    Setting::name("anchoring", "Anchoring", |strength| {
        format!("anchoring {strength}")
    }),
    Setting::number("radius", "*R*", "Radius *R* / ξ_{N}"),
    Setting::number("a", "*A*", "*A* / *L*ξ_{N}^{−2}"),
    Setting::number("b", "*B*", "*B* / *L*ξ_{N}^{−2}"),
    Setting::number("c", "*C*", "*C* / *L*ξ_{N}^{−2}"),
    Setting::number("elastic_constant", "*L*", "Elastic constant *L*"),
    Setting::number(
        "second_elastic_constant",
        "*L*_{2}",
        "Second elastic constant *L*_{2} / *L*",
    ),
    Setting::number("rotational_mobility", "Γ", "Rotational mobility Γ"),
    Setting::number("flow_alignment", "χ", "Flow alignment χ"),
    Setting::number("viscosity", "ηΓ", "Viscosity η Γ"),
    Setting::number("surface_order", "*S*_{surface}", "Order at surfaces *S*"),
    Setting::number(
        "field_anisotropy",
        "field anisotropy",
        "Anisotropy of the field",
    ),
    Setting::name("boundary", "Boundary", name),
    Setting::name("precision", "Precision", name),
    Setting::number("spacing", "*h*", "Spacing *h* / ξ_{N}"),
    Setting::number("tolerance", "tolerance", "Tolerance"),
    Setting::number("cell_z", "*L*_{z}", "Distance of the plates / ξ_{N}").following(),
];

const RESULTS: [Quantity; 4] = [
    Quantity {
        label: "Discharge time *t* / τ_{N}",
        columns: &[
            result("t50", "*t*_{50}", "Discharge time *t*_{50} / τ_{N}"),
            result("t90", "*t*_{90}", "Discharge time *t*_{90} / τ_{N}"),
            result("t99", "*t*_{99}", "Discharge time *t*_{99} / τ_{N}"),
            result("t999", "*t*_{99.9}", "Discharge time *t*_{99.9} / τ_{N}"),
        ],
        log: true,
    },
    Quantity {
        label: "Free energy *F* / *L*ξ_{N}",
        columns: &[
            result("f_charged", "charged", "Charged: *F* / *L*ξ_{N}"),
            column("f_after_switch", "switched"),
            column("f_final", "final"),
        ],
        log: false,
    },
    Quantity {
        label: "Order parameter",
        columns: &[result("order_parameter", "", "Order parameter")],
        log: false,
    },
    Quantity {
        label: "Ring radius / ξ_{N}",
        columns: &[result("ring_radius", "", "Ring radius / ξ_{N}")],
        log: false,
    },
];

const PARTS: [Quantity; 4] = [
    Quantity {
        label: "Energy / *L*ξ_{N}",
        columns: &[
            column("energy", "*F*"),
            column("dissipated_rotation", "rotation"),
            column("dissipated_flow", "flow"),
        ],
        log: false,
    },
    Quantity {
        label: "Mean tilt",
        columns: &[column("tilt", "")],
        log: false,
    },
    Quantity {
        label: "Ring radius / ξ_{N}",
        columns: &[column("ring_radius", "")],
        log: false,
    },
    Quantity {
        label: "Largest speed / ξ_{N}τ_{N}^{−1}",
        columns: &[column("max_speed", "")],
        log: false,
    },
];

impl Shown for Colloid {
    fn guide(&self) -> Guide {
        Guide {
            settings: &SETTINGS,
            results: &RESULTS,
            curve: Curve {
                file: "series.csv",
                time: "time",
                time_label: "Time *t* / τ_{N}",
                energy: "energy",
                full: "f_after_switch",
                empty: Some("f_final"),
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
        let parameters = case.part("case.nematic")?;
        colloid::write(case.folder, &parameters, case.about(), wanted, files)
    }

    fn pictures(&self) -> &'static [OwnPicture] {
        &[pictures::RINGS, pictures::SLICES]
    }
}
