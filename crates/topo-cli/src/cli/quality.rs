//! The option `--quality`: which presets a command knows, and what each means there.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use topo_lab::Preset;

/// Presets that a command knows, each with what it means there.
pub type PresetNotes = &'static [(Preset, &'static str)];

/// Figures and what is measured for them.
pub const OF_FIGURES: PresetNotes = &[
    (
        Preset::Draft,
        "14 knots at 17 twists, one cut each: minutes",
    ),
    (Preset::Standard, "The same with every near-tied cut"),
    (
        Preset::Paper,
        "Twice the resolution, all readings of the zero-twist row",
    ),
];

/// Maps of the extremes, trade-offs and costs of terms.
pub const OF_STUDIES: PresetNotes = &[
    (Preset::Draft, "Few or small runs: minutes"),
    (Preset::Standard, "Every run to its end, finer references"),
];

/// Tight shapes.
pub const OF_SHAPES: PresetNotes = &[
    (
        Preset::Draft,
        "4 vertices per unit of ropelength: within half a percent",
    ),
    (
        Preset::Standard,
        "8 vertices per unit: within a tenth of a percent",
    ),
    (
        Preset::Paper,
        "16 vertices per unit and a longer search: within two hundredths of a percent",
    ),
];

/// Reads one of the presets `known`.
pub fn quality(known: PresetNotes) -> impl TypedValueParser<Value = Preset> {
    let value = |(preset, help): &(Preset, &'static str)| {
        let value = PossibleValue::new(preset.name()).help(*help);
        match preset {
            Preset::Paper => value.alias("fine"),
            _ => value,
        }
    };
    let values: Vec<PossibleValue> = known.iter().map(value).collect();
    PossibleValuesParser::new(values).map(move |name| {
        let named = known.iter().find(|(preset, _)| preset.name() == name);
        named.map_or(Preset::Paper, |(preset, _)| *preset)
    })
}
