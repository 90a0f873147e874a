//! Extremes of the knot generator.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use topo_core::Vector3;
use topo_core::{Interrupt, Polyline};
use topo_knots::{
    Invariants, KnotError, KnotTable, TightenSettings, closed_braid, identify, n_components,
    tighten,
};

use super::cell::{Cell, Verdict};
use super::rod::trefoil_at;
use crate::preset::Preset;

type V = Vector3<f64>;

/// Letters beyond which a word is tightened for a few steps only: whether it is still the same knot is what counts.
const LONG: usize = 20;
const LONG_STEPS: usize = 6;

/// Settings of a quick tightening.
fn quick(preset: Preset) -> TightenSettings {
    let draft = TightenSettings {
        n_variants: 0,
        n_kicks_a_start: 0,
        n_kicks: 0,
        ..TightenSettings::draft()
    };
    match preset {
        Preset::Draft => TightenSettings {
            per_unit: 2.0,
            search_vertices: 100,
            max_steps: 40,
            ..draft
        },
        _ => TightenSettings::draft(),
    }
}

/// Tightens the closure of a braid; its type must be kept, and its length be one a knot can have.
fn tightened(word: &[i32], settings: &TightenSettings) -> Verdict {
    let run = || -> Result<Verdict, KnotError> {
        let start = closed_braid(word)?;
        let kind = Invariants::of(start.vertices())?;
        let tight = tighten("braid", &[start], settings)?;
        let mut found = u32::from(Invariants::of(tight.curve.vertices())? != kind);
        let finite = tight.curve.vertices().iter().all(|v| v.sum().is_finite());
        // No closed curve is shorter than the circle.
        let is_possible = tight.length_over_radius >= std::f64::consts::TAU - 1e-9;
        found += u32::from(!finite) + u32::from(!is_possible);
        Ok(if tight.certificate.converged {
            Verdict::converged(found)
        } else {
            Verdict::stopped("not converged, the best curve is kept", found)
        })
    };
    run().unwrap_or_else(|e| Verdict::stopped(e, 0))
}

/// A random word on `strands` strands that uses every generator and closes to a knot, if one is found.
fn word(strands: i32, letters: usize, seed: u64) -> Option<Vec<i32>> {
    let mut rng = Pcg64::seed_from_u64(seed);
    for _ in 0..10_000 {
        let mut letter = || {
            let sign = if rng.random_bool(0.5) { 1 } else { -1 };
            sign * rng.random_range(1..strands)
        };
        let word: Vec<i32> = (0..letters).map(|_| letter()).collect();
        let has_all = (1..strands).all(|g| word.iter().any(|w| w.abs() == g));
        if has_all && n_components(&word).is_ok_and(|n| n == 1) {
            return Some(word);
        }
    }
    None
}

/// Names a curve: a wrong name is a violation, an error a reason to stop.
fn named(curve: Result<Polyline, String>, expected: &str) -> Verdict {
    let curve = match curve {
        Ok(curve) => curve,
        Err(refused) => return Verdict::stopped(format!("refused: {refused}"), 0),
    };
    match identify(curve.vertices(), &KnotTable::builtin()) {
        Ok(kind) if kind.types().iter().any(|n| n.to_string() == expected) => Verdict::converged(0),
        Ok(kind) if kind.types().is_empty() => {
            Verdict::stopped(format!("unknown type: {}", kind.label()), 0)
        }
        Ok(kind) => Verdict::stopped(format!("named {}", kind.label()), 1),
        Err(e) => Verdict::stopped(e, 0),
    }
}

/// All runs.
pub(super) fn cells(preset: Preset) -> Vec<Cell> {
    let mut cells = Vec::new();
    for strands in [2, 3, 4, 5, 6] {
        // Words of twelve letters are diagrams of knots of up to twelve crossings.
        for least in [7, 9, 11, 13, 15, 60] {
            let mut settings = quick(preset);
            if least > LONG {
                settings.max_steps = LONG_STEPS;
            }
            // Only an even number of letters on an odd number of strands closes to a knot, and the converse.
            let letters = least + (least + strands as usize + 1) % 2;
            cells.push(Cell {
                axes: ["least letters of the braid", "strands"],
                at: [least.to_string(), strands.to_string()],
                is_inner: false,
                run: Box::new(move |_: &Interrupt| match word(strands, letters, 7) {
                    Some(word) => tightened(&word, &settings),
                    None => Verdict::stopped("no knot has such a braid: only links do", 0),
                }),
            });
        }
    }
    // A trefoil, disturbed ever more in ever more ways.
    for (disturbance, disturb) in DISTURBANCES {
        for size in [0.0, 1e-15, 1e-9, 1e-3, 0.05, 0.3, 1e3] {
            cells.push(Cell {
                axes: ["size of the disturbance", "disturbance of a trefoil"],
                at: [size.to_string(), disturbance.to_owned()],
                is_inner: disturbance == "noise" && size <= 0.05,
                run: Box::new(move |_: &Interrupt| named(disturb(size), "3_1")),
            });
        }
    }
    cells
}

type Disturb = fn(f64) -> Result<Polyline, String>;

/// Ways to spoil a trefoil that keep its type at small sizes.
const DISTURBANCES: [(&str, Disturb); 6] = [
    ("noise", |size| {
        let mut rng = Pcg64::seed_from_u64(3);
        let mut noise = || 2.0 * rng.random::<f64>() - 1.0;
        curve(trefoil().map(|x| x + V::new(noise(), noise(), noise()) * size))
    }),
    ("vertices moved together", |size| {
        let mut x = trefoil();
        for k in (0..x.len()).step_by(2) {
            x[k + 1] = x[k] + (x[k + 1] - x[k]) * size;
        }
        curve(x)
    }),
    ("flattened by", |size| {
        curve(trefoil().map(|x| V::new(x.x, x.y, x.z / (1.0 + 1e6 * size))))
    }),
    ("grown by 10^(300 size)", |size| {
        curve(trefoil().map(|x| x * 10f64.powf(300.0 * size.min(1.0))))
    }),
    ("moved far away", |size| {
        curve(trefoil().map(|x| x + V::new(1.0, 1.0, 1.0) * (1e12 * size)))
    }),
    ("spike", |size| {
        let mut x = trefoil();
        let out = x[0] * (1.0 + size);
        x[0] = out;
        curve(x)
    }),
];

const N: usize = 120;

fn trefoil() -> [V; N] {
    std::array::from_fn(|k| trefoil_at(std::f64::consts::TAU * k as f64 / N as f64).into())
}

fn curve(x: [V; N]) -> Result<Polyline, String> {
    Polyline::new(x.to_vec(), true).map_err(|e| e.to_string())
}
