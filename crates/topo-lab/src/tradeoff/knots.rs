//! Settings of the knot generator: vertices a unit of length, length of the search, method.

use topo_core::CpuClock;
use topo_knots::{KnotEntry, KnotTable, TightenSettings, second_opinion, tighten_entry};

use super::trial::{Outcome, REFERENCE, Trial};
use crate::LabError;
use crate::preset::Preset;

const QUANTITY: &str = "ropelength";

/// Vertices a unit at which the second method is tried.
const SECOND: [f64; 2] = [2.0, 4.0];

/// All runs: the reference is the published ropelength, which costs nothing here.
pub(super) fn trials(preset: Preset) -> Result<Vec<Trial>, LabError> {
    let table = KnotTable::builtin();
    let names: Vec<String> = match preset {
        Preset::Draft => ["3_1", "4_1", "5_2", "6_2", "7_4", "7_7"]
            .map(String::from)
            .to_vec(),
        _ => table.primes_up_to(7).map(|k| k.name.clone()).collect(),
    };
    let levels: &[f64] = match preset {
        Preset::Draft => &[2.0, 4.0, 8.0],
        _ => &[2.0, 4.0, 8.0, 16.0],
    };
    let mut trials = Vec::new();
    for name in names {
        let entry = table.get(&name)?.into_owned();
        trials.push(published(&entry));
        for &per_unit in levels {
            let value = format!("{per_unit} a unit");
            trials.push(tightened(&entry, "vertices", value, at(per_unit)));
        }
        for (search, settings) in searches() {
            let value = format!("{search}, 4 a unit");
            trials.push(tightened(&entry, "search", value, settings));
        }
        trials.extend(SECOND.map(|per_unit| second(&entry, per_unit)));
    }
    Ok(trials)
}

/// Searches shorter and longer than that of the levels, at 4 vertices a unit.
fn searches() -> [(&'static str, TightenSettings); 2] {
    [
        (
            "no kicks",
            TightenSettings {
                n_kicks: 0,
                n_kicks_a_start: 0,
                n_variants: 0,
                ..at(4.0)
            },
        ),
        (
            "three times the kicks",
            TightenSettings {
                n_kicks: 12,
                n_variants: 3,
                ..at(4.0)
            },
        ),
    ]
}

/// The published ropelength.
fn published(entry: &KnotEntry) -> Trial {
    let published = entry.length_over_radius;
    Trial {
        case: entry.name.clone(),
        setting: REFERENCE,
        value: "published".to_owned(),
        run: Box::new(move |_, _| {
            Ok(Some(Outcome {
                quantities: vec![(QUANTITY, published)],
                cpu_seconds: 0.0,
                peak_bytes: 0,
            }))
        }),
    }
}

fn tightened(
    entry: &KnotEntry,
    setting: &'static str,
    value: String,
    settings: TightenSettings,
) -> Trial {
    let entry = entry.clone();
    Trial {
        case: entry.name.clone(),
        setting,
        value,
        run: Box::new(move |meter, interrupt| {
            let (found, cpu_seconds, peak_bytes) =
                meter.measure(|| tighten_entry(&entry, &settings));
            let found = found.and_then(Result::ok).map(|t| t.length_over_radius);
            Ok((!interrupt.is_requested()).then_some(Outcome {
                quantities: vec![(QUANTITY, found)],
                cpu_seconds,
                peak_bytes,
            }))
        }),
    }
}

/// The second method, from a shape of the first, whose time does not count.
fn second(entry: &KnotEntry, per_unit: f64) -> Trial {
    let entry = entry.clone();
    Trial {
        case: entry.name.clone(),
        setting: "method",
        value: format!("augmented Lagrangian, {per_unit} a unit"),
        run: Box::new(move |meter, interrupt| {
            let start = tighten_entry(&entry, &at(per_unit));
            let clock = CpuClock::start();
            let (found, _, peak_bytes) =
                meter.measure(|| start.ok().and_then(|s| second_opinion(&s).ok()));
            let found = found.flatten().map(|s| s.length_over_radius);
            Ok((!interrupt.is_requested()).then_some(Outcome {
                quantities: vec![(QUANTITY, found)],
                cpu_seconds: clock.seconds(),
                peak_bytes,
            }))
        }),
    }
}

fn at(per_unit: f64) -> TightenSettings {
    TightenSettings {
        per_unit,
        ..if per_unit > 8.0 {
            TightenSettings::fine()
        } else if per_unit > 4.0 {
            TightenSettings::standard()
        } else {
            TightenSettings::draft()
        }
    }
}
