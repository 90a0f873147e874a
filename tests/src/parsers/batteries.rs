//! Checkpoints of the batteries, gone on from.

use std::path::Path;
use std::sync::OnceLock;

use topo_core::{Interrupt, Progress, checkpoint_bytes};
use topo_nematic::{
    ChargeSettings, DischargeSettings, FlowParameters, NematicAccuracy, NematicBattery,
    NematicError, NematicParameters, RunHooks, SwitchSettings, SwitchTarget, SwitchedNematic,
};
use topo_rod::{Accuracy, CutRod, CutSite, Guards, RodBattery, RodError, RodParameters};

use super::{DIGEST, HEAD, Raw};

/// Checkpoints of nematics: the bytes after the first as what a sound file of the case holds, which then goes on.
///
/// The first byte chooses charge (even) or discharge (odd, from 128 on with flow).
pub fn nematic_checkpoint(data: &[u8]) {
    let Some((kind, payload)) = data.split_first() else {
        return;
    };
    let run = match (kind % 2, *kind >= 128) {
        (0, _) => small_run(0),
        (_, false) => small_run(1),
        (_, true) => small_run(2),
    };
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("checkpoint");
    run.sample.write(&path, payload);
    match run.go_on(&path) {
        Ok(())
        | Err(NematicError::File(_) | NematicError::Diverged { .. } | NematicError::Flow(_)) => {}
        Err(other) => panic!("{other}"),
    }
}

/// A battery of few cells with a checkpoint of it.
struct SmallRun {
    battery: NematicBattery,
    charge: ChargeSettings,
    discharge: Option<(SwitchedNematic, DischargeSettings)>,
    sample: Sample,
}

impl SmallRun {
    /// Goes on from the checkpoint in a file, for a few steps.
    fn go_on(&self, path: &Path) -> Result<(), NematicError> {
        let interrupt = Interrupt::default();
        let mut hooks = RunHooks::new(&interrupt).with_checkpoint(path, 1e9);
        match &self.discharge {
            None => drop(self.battery.charge(&self.charge, &mut hooks)?),
            Some((released, settings)) => drop(released.discharge(settings, &mut hooks)?),
        }
        Ok(())
    }
}

/// What a sound checkpoint of a nematic holds after its case, with the byte that chooses it: inputs of [`nematic_checkpoint`].
pub fn nematic_payloads() -> Vec<(&'static str, Vec<u8>)> {
    [("charge", 0u8), ("discharge", 1), ("flow", 129)]
        .into_iter()
        .enumerate()
        .map(|(k, (name, byte))| (name, [&[byte], &small_run(k).sample.payload[..]].concat()))
        .collect()
}

fn small_run(which: usize) -> &'static SmallRun {
    static RUNS: [OnceLock<SmallRun>; 3] = [const { OnceLock::new() }; 3];
    RUNS[which].get_or_init(|| {
        let parameters = NematicParameters {
            radius: 3.0,
            spacing: 1.5,
            // A particle is held by the flow's forces; without flow it only makes the input longer.
            particle: which == 2,
            cells: Some(if which == 2 { [6, 6, 8] } else { [4, 4, 4] }),
            ..NematicParameters::default()
        };
        let accuracy = NematicAccuracy {
            max_steps: 4,
            ..NematicAccuracy::default()
        };
        let battery = NematicBattery::new(&parameters, &accuracy).expect("a battery");
        let charge = ChargeSettings {
            max_steps: 3,
            ..ChargeSettings::default()
        };
        let discharge = (which > 0).then(|| {
            let mut none = RunHooks::new(&Interrupt::default());
            let charged = battery.charge(&charge, &mut none).expect("a charge");
            let to = if which == 2 {
                SwitchTarget::default()
            } else {
                SwitchTarget::Keep
            };
            let released = charged.switch(&SwitchSettings { to, ramp: None });
            let settings = DischargeSettings {
                flow: (which == 2).then(FlowParameters::default),
                ..DischargeSettings::default()
            };
            (released.expect("released"), settings)
        });
        let mut run = SmallRun {
            battery,
            charge,
            discharge,
            sample: Sample::default(),
        };
        run.sample = Sample::of(|path| run.stopped(path));
        run
    })
}

impl SmallRun {
    /// Leaves a checkpoint.
    fn stopped(&self, path: &Path) {
        let interrupt = Interrupt::default();
        interrupt.request();
        let mut hooks = RunHooks::new(&interrupt).with_checkpoint(path, 0.0);
        match &self.discharge {
            None => drop(
                self.battery
                    .charge(&self.charge, &mut hooks)
                    .expect("a charge"),
            ),
            Some((released, settings)) => {
                drop(
                    released
                        .discharge(settings, &mut hooks)
                        .expect("a discharge"),
                );
            }
        }
    }
}

/// A rod of few edges, its cut state and what a checkpoint of either phase holds.
struct SmallRod {
    charge: topo_rod::ChargeSettings,
    battery: RodBattery,
    discharge: topo_rod::DischargeSettings,
    cut: CutRod,
    samples: [Sample; 2],
}

/// Checkpoints of rods: the bytes after the first as what a sound file of the case holds, which then goes on.
///
/// The first byte chooses charge (even) or discharge (odd).
pub fn rod_checkpoint(data: &[u8]) {
    let Some((kind, payload)) = data.split_first() else {
        return;
    };
    let (rod, phase) = (small_rod(), usize::from(kind % 2));
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("checkpoint");
    rod.samples[phase].write(&path, payload);
    match rod.run(phase, &path, &Interrupt::default()) {
        Ok(()) | Err(RodError::File(_)) => {}
        Err(other) => panic!("{other}"),
    }
}

/// What a sound checkpoint of a rod holds after its case, with the byte that chooses it: inputs of [`rod_checkpoint`].
pub fn rod_payloads() -> Vec<(&'static str, Vec<u8>)> {
    [("charge", 0u8), ("discharge", 1)]
        .into_iter()
        .zip(&small_rod().samples)
        .map(|((name, byte), sample)| (name, [&[byte], &sample.payload[..]].concat()))
        .collect()
}

fn small_rod() -> &'static SmallRod {
    static ROD: OnceLock<SmallRod> = OnceLock::new();
    ROD.get_or_init(|| {
        let parameters = RodParameters {
            n_edges: 12,
            twist: Some(1.0),
            ..RodParameters::default()
        };
        let accuracy = Accuracy {
            max_steps: 12,
            ..Accuracy::default()
        };
        let guards = Guards::default();
        let curve = crate::curves::trefoil(60, 2.0, 1.0);
        let battery = RodBattery::new(&parameters, &accuracy, guards, &curve).expect("a battery");
        let charge = topo_rod::ChargeSettings::default();
        let none = &mut topo_core::RunHooks::default();
        let charged = battery.charge(&charge, none).expect("a charge");
        let mut rod = SmallRod {
            charge,
            battery,
            discharge: topo_rod::DischargeSettings::default(),
            cut: charged.cut(CutSite::At(0.25)).expect("a cut"),
            samples: Default::default(),
        };
        for phase in 0..2 {
            rod.samples[phase] = Sample::of(|path| rod.stopped(phase, path));
        }
        rod
    })
}

impl SmallRod {
    /// Goes on from a checkpoint, for a few steps.
    fn run(&self, phase: usize, path: &Path, interrupt: &Interrupt) -> Result<(), RodError> {
        let mut stop_soon = |p: &Progress| {
            if p.step == 5 {
                interrupt.request();
            }
        };
        let mut hooks = topo_core::RunHooks::new(interrupt)
            .with_progress(&mut stop_soon)
            .with_checkpoint(path, 1e9);
        match phase {
            0 => drop(self.battery.charge(&self.charge, &mut hooks)?),
            _ => drop(self.cut.discharge(&self.discharge, &mut hooks)?),
        }
        Ok(())
    }

    /// Leaves a checkpoint after some steps.
    fn stopped(&self, phase: usize, path: &Path) {
        self.run(phase, path, &Interrupt::default())
            .expect("a phase");
    }
}

/// What a checkpoint holds, taken apart.
#[derive(Default)]
struct Sample {
    schema: String,
    case: String,
    /// After the case.
    payload: Vec<u8>,
}

impl Sample {
    /// What a run leaves that is stopped by `run`.
    fn of(run: impl FnOnce(&Path)) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("checkpoint");
        run(&path);
        let bytes = std::fs::read(&path).expect("a checkpoint");
        let n_schema = usize::from(bytes[HEAD - 2]);
        let head = HEAD + n_schema + 8;
        let payload = &bytes[head..bytes.len() - DIGEST];
        let (n, at) = length(payload);
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("a name");
        Self {
            schema: text(&bytes[HEAD..HEAD + n_schema]),
            case: text(&payload[at..at + n]),
            payload: payload[at + n..].to_vec(),
        }
    }

    /// Writes a sound file of the case that holds `payload`.
    fn write(&self, path: &Path, payload: &[u8]) {
        let content = (&self.case, Raw(payload));
        let file = checkpoint_bytes(path, &self.schema, &content).expect("encoded");
        std::fs::write(path, file).expect("written");
    }
}

/// A length of seven bits a byte, and where what it counts begins.
fn length(bytes: &[u8]) -> (usize, usize) {
    let mut n = 0;
    for (k, byte) in bytes.iter().enumerate() {
        n |= usize::from(byte & 127) << (7 * k);
        if byte & 128 == 0 {
            return (n, k + 1);
        }
    }
    (n, bytes.len())
}
