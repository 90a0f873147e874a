//! Colloids in a nematic, as one battery among others.

use std::path::Path;

use super::file;
use super::identity::RESULTS_VERSION;
use super::probe::COLLOID_PROBE;
use super::scene::NematicScene;
use crate::LabError;
use crate::battery::{Battery, Scene};
use crate::cost::Probe;
use crate::scene::{Keys, SceneFault};

/// Charged colloids in a nematic.
#[derive(Debug, Clone, Copy)]
pub struct Colloid;

impl Battery for Colloid {
    fn name(&self) -> &'static str {
        "nematic"
    }

    fn table(&self) -> &'static str {
        "nematic"
    }

    fn what(&self) -> &'static str {
        "a colloid"
    }

    fn schema(&self) -> &'static str {
        "topo-nematic-case/1"
    }

    fn results(&self) -> u32 {
        RESULTS_VERSION
    }

    fn probe(&self) -> &'static Probe {
        &COLLOID_PROBE
    }

    fn parse(&self, text: &str, path: &Path) -> Result<Box<dyn Scene>, LabError> {
        Ok(Box::new(NematicScene::parse(text, path)?))
    }

    fn keys(&self) -> Option<&'static Keys> {
        Some(file::keys())
    }

    fn first_scene(&self) -> &'static [(&'static str, &'static str)] {
        &[("nematic.q", "[2, 5]"), ("nematic.radius", "15.0")]
    }

    fn faults(&self, text: &str, path: &Path) -> Vec<SceneFault> {
        NematicScene::faults(text, path)
    }
}
