//! Terms of a rod: contact, friction, twist, stretch.

use topo_core::{CpuClock, Interrupt, RunHooks};
use topo_rod::contact::ContactPairs;
use topo_rod::energy::{At, Bend, EnergyTerm, Force, Stiffness, Stretch};
use topo_rod::{
    Accuracy, ContactParameters, DischargeSettings, FrictionParameters, Geometry, Guards, Protocol,
    RodBattery, RodParameters, RodState, WorkAccount,
};

use super::term::{Taken, Term};
use crate::stability::rod::trefoil;
use crate::{LabError, Preset};

/// Evaluations that a term which cannot be left out is timed over.
const N_EVALUATIONS: u64 = 20_000;

pub(super) fn terms(preset: Preset) -> Vec<Term> {
    let n_edges = if preset == Preset::Draft { 100 } else { 200 };
    let bare = RodParameters {
        n_edges,
        twist: Some(1.0),
        contact: None,
        friction: None,
        ..RodParameters::default()
    };
    let touching = RodParameters {
        contact: Some(ContactParameters::default()),
        ..bare.clone()
    };
    let rubbing = RodParameters {
        friction: Some(FrictionParameters::default()),
        ..touching.clone()
    };
    let shape = format!("trefoil, N = {n_edges}");
    let untwisted = |parameters: &RodParameters, twist| RodParameters {
        twist,
        ..parameters.clone()
    };
    vec![
        term(
            "contact",
            format!("k_c = 20; {shape}, theta' h = 1, no friction"),
            [bare, touching.clone()],
            |work| (work.contact_bytes, work.n_contact_evaluations),
        ),
        term(
            "friction",
            format!("eta_f/eta = 0.1; {shape}, theta' h = 1, contact"),
            [touching, rubbing.clone()],
            |work| (work.friction_bytes, work.n_friction_evaluations),
        ),
        term(
            "twist",
            format!("theta' h = 0; {shape}, contact, friction"),
            [untwisted(&rubbing, None), untwisted(&rubbing, Some(0.0))],
            |work| (work.twist_bytes, work.n_twist_evaluations),
        ),
        Term {
            system: "rod",
            name: "stretch",
            quantity: format!(
                "gamma = 5; {N_EVALUATIONS} evaluations of force and stiffness beside bending, {shape}"
            ),
            run: Box::new(move |with, _| evaluate(n_edges, with)),
        },
    ]
}

fn term(
    name: &'static str,
    quantity: String,
    scenes: [RodParameters; 2],
    own: fn(&WorkAccount) -> (usize, u64),
) -> Term {
    Term {
        system: "rod",
        name,
        quantity,
        run: Box::new(move |with, interrupt| run(&scenes[usize::from(with)], own, interrupt)),
    }
}

fn refused(source: topo_rod::RodError) -> LabError {
    LabError::Rod {
        case: "cost of a term".to_owned(),
        source,
    }
}

/// Charges, cuts and discharges a rod.
fn run(
    parameters: &RodParameters,
    own: fn(&WorkAccount) -> (usize, u64),
    interrupt: &Interrupt,
) -> Result<Taken, LabError> {
    let clock = CpuClock::start();
    let curve = trefoil();
    let accuracy = Accuracy::default();
    let run = || {
        let guards = Guards::default();
        let battery = RodBattery::new(parameters, &accuracy, guards, &curve)?;
        let protocol = Protocol {
            discharge: DischargeSettings {
                until_released: 0.99,
                ..DischargeSettings::default()
            },
            ..Protocol::default()
        };
        let (charged, run) = battery.run(&protocol, &mut RunHooks::new(interrupt))?;
        let charge = charged.record().report.clone();
        Ok(std::iter::once(charge).chain(run.map(|r| r.record.report)))
    };
    let reports = run().map_err(refused)?;
    let mut taken = Taken {
        cpu_seconds: clock.seconds(),
        ..Taken::default()
    };
    for report in reports {
        let work = report.own.work;
        let (bytes, calls) = own(&work);
        taken.calls += report.counters.n_trials;
        taken.term_calls += calls;
        taken.term_bytes = taken.term_bytes.max(bytes as u64);
        taken.peak_bytes = taken.peak_bytes.max(report.n_bytes());
    }
    Ok(taken)
}

/// Evaluates bending without or with stretch: a rod always has both, since its edges have no other hold on their length.
fn evaluate(n_edges: usize, with: bool) -> Result<Taken, LabError> {
    let curve = trefoil();
    let curve = curve.resampled(n_edges).map_err(|e| refused(e.into()))?;
    let state = RodState::new(&curve, curve.length(), 0.0).map_err(refused)?;
    let mut geometry = Geometry::default();
    geometry.update(&state);
    let pairs = ContactPairs::new(0.0, 0.5);
    let at = At {
        state: &state,
        geometry: &geometry,
        pairs: &pairs,
    };
    let mut terms: Vec<Box<dyn EnergyTerm>> = vec![Box::new(Bend)];
    if with {
        terms.push(Box::new(Stretch { ratio: 5.0 }));
    }
    let (mut force, mut stiffness) = (Force::default(), Stiffness::default());
    let clock = CpuClock::start();
    let mut energy = 0.0;
    for _ in 0..N_EVALUATIONS {
        force.reset(&state);
        stiffness.reset(state.n_vertices(), 0);
        for term in &terms {
            energy += term.add_force(at, &mut force);
            term.add_stiffness(at, &mut stiffness);
        }
    }
    std::hint::black_box((energy, &force, &stiffness));
    Ok(Taken {
        cpu_seconds: clock.seconds(),
        calls: N_EVALUATIONS,
        term_calls: if with { N_EVALUATIONS } else { 0 },
        ..Taken::default()
    })
}
