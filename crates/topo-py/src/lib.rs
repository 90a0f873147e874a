//! The Python package `topobatteries`: what of the workspace its modules call.
//!
//! Reading order: `attend` (work away from the interpreter: Ctrl-C, progress) → `refusal` (errors) → `values` (dictionaries as settings)
//! → `scenes`, `curves`, `rods`, `colloids`. Classes, units and documentation are in `python/topobatteries`; here are numbers only.

mod attend;
mod colloids;
mod curves;
mod refusal;
mod rods;
mod scenes;
mod values;

use pyo3::prelude::*;

/// Functions and handles for the package `topobatteries`, which documents them.
#[pymodule]
mod _topo {
    #[pymodule_export]
    use crate::colloids::{ChargedColloid, ColloidBattery, SwitchedColloid};
    #[pymodule_export]
    use crate::curves::{check, identify, knot, knots, measure, read_curves, resampled, tight};
    #[pymodule_export]
    use crate::rods::{ChargedRod, CutRod, RodBattery, release_time};
    #[pymodule_export]
    use crate::scenes::{run, scene_text};
    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "a name of Python")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
