//! A nematic experiment and the cases it stands for.

use std::path::{Path, PathBuf};

use serde::Serialize;
use topo_nematic::{
    ChargeSettings, DischargeSettings, FlowParameters, NematicAccuracy, NematicParameters,
    SurfacePattern, SwitchSettings,
};

use super::case::NematicCase;
use super::keys::COLLOID_KEYS;
use crate::goal::Goal;
use crate::preset::Preset;
use crate::scene::{Axis, product};

/// The q that the draft preset shows with flow.
const DRAFT_FLOW: u32 = 4;

/// A nematic experiment: which colloid, how charged, how switched, with flow or without.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NematicScene {
    /// Folder of its tables below the output folder.
    pub folder: String,
    /// Windings q of the particle's anchoring; empty: the scene's own pattern.
    pub charges: Vec<u32>,
    /// Windings that are discharged with flow besides without; `None`: all with flow only, if there is flow.
    pub flowing: Option<Vec<u32>>,
    /// Cell, particle, material; its pattern is replaced by each q.
    pub nematic: NematicParameters,
    /// Minimisation of the free energy.
    pub charge: ChargeSettings,
    /// What the anchoring is switched to.
    pub switch: SwitchSettings,
    /// The relaxation after it.
    pub discharge: DischargeSettings,
    /// Flow; `None`: no velocity is modelled.
    pub flow: Option<FlowParameters>,
    /// Tolerance, storage and limits.
    pub accuracy: NematicAccuracy,
    /// Keys with several values: the cases are their product, the last axis running fastest.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub axes: Vec<Axis>,
    /// Spacing that a goal asks for: the grid of each case is fitted to it.
    #[serde(skip)]
    pub(super) fitted: Option<f64>,
    /// What was asked for instead of settings.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub goal: Option<Goal>,
}

impl NematicScene {
    /// The published sweep: q = 1 to 10 at radius 20 without flow but for one q (draft), q = 1 to 12 at 25 without and with flow
    /// (standard) and at the published 52.5 with flow (paper).
    ///
    /// The draft's particle is the smallest whose buckled rings (from q = 7 on) have eight nodes a wavelength at this spacing.
    pub fn published(preset: Preset) -> Self {
        let (radius, most, flowing) = match preset {
            Preset::Draft => (20.0, 10, Some(vec![DRAFT_FLOW])),
            Preset::Standard => (25.0, 12, Some((1..=12).collect())),
            Preset::Paper | Preset::Reference => (52.5, 12, None),
        };
        Self {
            folder: "nematic".to_owned(),
            charges: (1..=most).collect(),
            flowing,
            nematic: NematicParameters {
                radius,
                spacing: 1.5,
                ..NematicParameters::default()
            },
            charge: ChargeSettings::default(),
            switch: SwitchSettings::default(),
            discharge: DischargeSettings::default(),
            flow: Some(FlowParameters::default()),
            accuracy: NematicAccuracy::default(),
            axes: Vec::new(),
            fitted: None,
            goal: None,
        }
    }

    /// The cases of the scene: windings in the order given, the values of the [axes](Self::axes) inside; of two cases that differ in
    /// flow alone, the one with it comes second.
    pub fn cases(&self) -> Vec<NematicCase> {
        let mut cases = Vec::new();
        let mut add = |pattern: SurfacePattern| {
            let base = NematicCase {
                q: 0,
                nematic: NematicParameters {
                    pattern,
                    ..self.nematic.clone()
                },
                flow: None,
            };
            for mut case in product(&COLLOID_KEYS, &self.axes, base) {
                if let Some(spacing) = self.fitted {
                    fit(&mut case.nematic, spacing);
                }
                case.q = winding(&case.nematic);
                let chosen = self.flowing.as_ref();
                let is_still = self.flow.is_none() || chosen.is_some();
                let flows = chosen.is_none_or(|chosen| chosen.contains(&case.q));
                let flow = self.flow.filter(|_| flows);
                if is_still {
                    cases.push(case.clone());
                }
                if flow.is_some() {
                    cases.push(NematicCase { flow, ..case });
                }
            }
        };
        if self.charges.is_empty() {
            add(self.nematic.pattern.clone());
        }
        for &q in &self.charges {
            add(SurfacePattern::Winding(q as i32));
        }
        cases
    }

    /// Where files with the scene's tables lie below an output folder.
    pub fn results(&self, out: &Path) -> PathBuf {
        out.join(&self.folder)
    }
}

/// Turns of the anchoring: none without a particle, or with a pattern that has none.
fn winding(nematic: &NematicParameters) -> u32 {
    match nematic.pattern {
        SurfacePattern::Winding(q) if nematic.particle => q.unsigned_abs(),
        _ => 0,
    }
}

/// Most that a fitted grid is finer than asked for.
const FINER: f64 = 0.12;
/// Sides that miss the cell by less than this share are met.
const MET: f64 = 2e-3;

/// Gives `nematic` a grid of at most this spacing, such that its plates are as far apart as it says and its sides nearly.
///
/// A cell is rounded to whole spacings otherwise, and late times go with the square of the distance between the plates: two
/// grids would differ by the rounding, not by their error.
pub(crate) fn fit(nematic: &mut NematicParameters, spacing: f64) {
    if let Some(cells) = nematic.cells.take() {
        nematic.cell = cells.map(|n| n as f64 * nematic.spacing / nematic.radius);
    }
    let half = nematic.cell.map(|edge| 0.5 * edge * nematic.radius);
    let least = (half[2] / spacing - 1e-9).ceil().max(1.0);
    let most = (least * (1.0 + FINER)).floor() as usize;
    let missed = |n: usize| {
        let h = half[2] / n as f64;
        let of = |x: f64| ((x / h).round() * h / x - 1.0).abs();
        of(half[0]).max(of(half[1]))
    };
    let all = || least as usize..=most;
    let best = all().map(missed).fold(f64::INFINITY, f64::min);
    let n = all().find(|&n| missed(n) <= best.max(MET)).unwrap_or(most);
    nematic.spacing = half[2] / n as f64;
}

#[cfg(test)]
mod tests {
    use topo_nematic::NematicBattery;

    use super::*;

    #[test]
    fn published_presets_resolve_their_patterns() {
        for preset in [Preset::Draft, Preset::Standard, Preset::Paper] {
            let scene = NematicScene::published(preset);
            for case in scene.cases() {
                let battery = NematicBattery::new(&case.nematic, &scene.accuracy).unwrap();
                assert!(battery.warnings().is_empty(), "{:?}", battery.warnings());
            }
        }
    }

    #[test]
    fn grids_of_goals_keep_the_plates_apart() {
        for radius in [10.0, 15.0, 17.0] {
            for spacing in [2.0, 1.5, 1.2, 1.0] {
                let mut nematic = NematicParameters {
                    radius,
                    ..NematicParameters::default()
                };
                let cell = nematic.cell.map(|edge| edge * radius);
                fit(&mut nematic, spacing);
                let h = nematic.spacing;
                assert!(
                    h <= spacing * (1.0 + 1e-9) && h > 0.85 * spacing,
                    "{h} for {spacing}"
                );
                let battery = NematicBattery::new(&nematic, &NematicAccuracy::default()).unwrap();
                let edges = battery.grid().extent();
                assert!(
                    (edges[2] / cell[2] - 1.0).abs() < 1e-12,
                    "{edges:?}, not {cell:?}"
                );
                let missed = (edges[0] / cell[0] - 1.0).abs();
                assert!(
                    missed < 0.025,
                    "sides miss by {missed} at R = {radius}, h = {spacing}"
                );
            }
        }
        // a cell given in numbers of cells keeps its size
        let mut nematic = NematicParameters {
            radius: 10.0,
            spacing: 1.5,
            cells: Some([40, 40, 30]),
            ..NematicParameters::default()
        };
        fit(&mut nematic, 1.0);
        assert_eq!((nematic.spacing, nematic.cells), (22.5 / 24.0, None));
        assert_eq!(nematic.cell, [6.0, 6.0, 4.5]);
    }
}
