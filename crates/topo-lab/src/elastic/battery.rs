//! Knotted fibres, as one battery among others.

use std::path::Path;

use super::file;
use super::identity::RESULTS_VERSION;
use super::probe::ROD_PROBE;
use super::scene::ElasticScene;
use crate::LabError;
use crate::battery::{Battery, Scene};
use crate::cost::Probe;
use crate::scene::{Keys, SceneFault};

/// Knotted elastic fibres.
#[derive(Debug, Clone, Copy)]
pub struct Elastic;

impl Battery for Elastic {
    fn name(&self) -> &'static str {
        "elastic"
    }

    fn table(&self) -> &'static str {
        "rod"
    }

    fn what(&self) -> &'static str {
        "a knotted fibre"
    }

    fn schema(&self) -> &'static str {
        "topo-elastic-case/1"
    }

    fn results(&self) -> u32 {
        RESULTS_VERSION
    }

    fn probe(&self) -> &'static Probe {
        &ROD_PROBE
    }

    fn parse(&self, text: &str, path: &Path) -> Result<Box<dyn Scene>, LabError> {
        Ok(Box::new(ElasticScene::parse(text, path)?))
    }

    fn keys(&self) -> Option<&'static Keys> {
        Some(file::keys())
    }

    fn first_scene(&self) -> &'static [(&'static str, &'static str)] {
        &[
            ("rod.knot", "\"3_1\""),
            ("rod.twist", "[0.0, 2.0]"),
            ("rod.contact.stiffness", "20.0"),
            ("rod.friction.ratio", "0.1"),
            ("accuracy.edges", "100"),
        ]
    }

    fn faults(&self, text: &str, path: &Path) -> Vec<SceneFault> {
        ElasticScene::faults(text, path)
    }
}
