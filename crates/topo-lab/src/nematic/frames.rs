//! Ring and central plane of one discharge at many times, for moving pictures.

use topo_core::Interrupt;
use topo_nematic::flow::FlowCoupling;
use topo_nematic::record::NematicSample;
use topo_nematic::{
    DischargeSettings, NematicBattery, NematicState, Protocol, RunHooks, SurfacePattern, Threads,
};

use super::scene::NematicScene;
use super::snapshot::Snapshots;
use crate::LabError;
use topo_analysis::{LinePoint, SlicePoint};

/// The colloid at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct NematicFrame {
    /// Time since the switch, in τ_N; `None`: charged.
    pub time: Option<f64>,
    /// Free energy, in L ξ_N.
    pub energy: f64,
    /// Points of the ring; none once it is gone.
    pub ring: Vec<LinePoint>,
    /// The vertical plane through the particle's centre.
    pub plane: Vec<SlicePoint>,
}

/// Charges the colloid of a scene with winding `q`, switches it, and looks at it `per_decade` times a decade of time.
///
/// Stops early, with what is there, when interrupted.
///
/// # Errors
/// As [`run_nematic_sweep`](crate::run_nematic_sweep).
pub fn nematic_frames(
    scene: &NematicScene,
    q: u32,
    per_decade: f64,
    interrupt: &Interrupt,
) -> Result<Vec<NematicFrame>, LabError> {
    let refuse = |source| LabError::Nematic {
        case: format!("q = {q}"),
        source,
    };
    let mut nematic = scene.nematic.clone();
    nematic.pattern = SurfacePattern::Winding(q as i32);
    let mut accuracy = scene.accuracy;
    accuracy.threads = Threads::All;
    let battery = NematicBattery::new(&nematic, &accuracy).map_err(refuse)?;
    let protocol = Protocol {
        charge: scene.charge.clone(),
        switch: scene.switch.clone(),
        discharge: DischargeSettings {
            flow: scene.flow,
            outputs_per_decade: per_decade,
            ..scene.discharge.clone()
        },
    };
    let mut frames = Vec::new();
    let mut see = |s: &NematicSample, state: &NematicState, flow: Option<&FlowCoupling>| {
        frames.push(frame(Some(s.time), s.energy.total(), state, flow));
    };
    let mut hooks = RunHooks::new(interrupt).with_samples(&mut see);
    let (charged, _) = battery.run(&protocol, &mut hooks).map_err(refuse)?;
    let energy = charged.energy().total();
    frames.insert(0, frame(None, energy, charged.state(), None));
    Ok(frames)
}

fn frame(
    time: Option<f64>,
    energy: f64,
    state: &NematicState,
    flow: Option<&FlowCoupling>,
) -> NematicFrame {
    let mut kept = Snapshots::default();
    kept.keep(time, state, flow);
    NematicFrame {
        time,
        energy,
        ring: kept.ring,
        plane: kept.slices,
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    #[test]
    fn frames_follow_a_discharge_from_its_charged_state() {
        let text = "[nematic]\nradius = 5\nspacing = 1.0\nq = 1\n[charge]\ntolerance = 1e-4\n[discharge]\nuntil_released = 0.9\n[accuracy]\ntolerance = 1e-3\n";
        let scene = NematicScene::parse(text, Path::new("scene.toml")).unwrap();
        let frames = nematic_frames(&scene, 2, 20.0, &Interrupt::new()).unwrap();
        assert!(frames.len() > 12, "{}", frames.len());
        assert!(frames[0].time.is_none());
        assert!(!frames[0].ring.is_empty());
        let times: Vec<f64> = frames.iter().filter_map(|f| f.time).collect();
        assert!(times.windows(2).all(|w| w[0] < w[1]));
        assert!(frames.windows(2).all(|w| w[1].energy < 1.001 * w[0].energy));
        assert!(
            frames
                .iter()
                .all(|f| f.plane.len() == frames[0].plane.len())
        );
        let stop = Interrupt::new();
        stop.request();
        assert_eq!(nematic_frames(&scene, 1, 20.0, &stop).unwrap().len(), 1);
    }
}
