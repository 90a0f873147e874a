//! The keys of a rod that may have several values, in the order in which cases run through them.

use topo_rod::{ContactParameters, EndLoad, FrictionParameters, FrictionRange};

use super::case::ElasticCase;
use super::defaults::poisson_ratio_of;
use crate::scene::{Access, AxisValue, SweptKey};

fn contact(case: &mut ElasticCase) -> &mut ContactParameters {
    case.rod.contact.get_or_insert_default()
}

fn friction(case: &mut ElasticCase) -> &mut FrictionParameters {
    case.rod.friction.get_or_insert_default()
}

fn load(case: &mut ElasticCase) -> &mut EndLoad {
    case.load.get_or_insert_default()
}

/// Knots run slowest, then twists, then these; the last one runs fastest.
pub(crate) const ROD_KEYS: [SweptKey<ElasticCase>; 14] = [
    SweptKey {
        key: "rod.slenderness",
        access: Access::Number(|c| Some(c.rod.slenderness), |c, x| c.rod.slenderness = x),
    },
    SweptKey {
        key: "rod.reading",
        access: Access::Choice(
            |c| Some(AxisValue::Reading(c.rod.reading)),
            |c, s| {
                if let AxisValue::Reading(reading) = s {
                    c.rod.reading = *reading;
                }
            },
        ),
    },
    SweptKey {
        key: "rod.poisson_ratio",
        access: Access::Number(
            |c| Some(poisson_ratio_of(c.rod.twist_ratio)),
            |c, x| c.rod.twist_ratio = 1.0 / (1.0 + x),
        ),
    },
    SweptKey {
        key: "rod.stretch_ratio",
        access: Access::Number(
            |c| Some(c.rod.stretch_ratio),
            |c, x| c.rod.stretch_ratio = x,
        ),
    },
    SweptKey {
        key: "rod.contact.stiffness",
        access: Access::Number(
            |c| c.rod.contact.map(|contact| contact.stiffness),
            |c, x| contact(c).stiffness = x,
        ),
    },
    SweptKey {
        key: "rod.friction.ratio",
        access: Access::Number(
            |c| c.rod.friction.map(|friction| friction.ratio),
            |c, x| friction(c).ratio = x,
        ),
    },
    SweptKey {
        key: "rod.friction.range",
        access: Access::Choice(
            |c| {
                let friction = c.rod.friction;
                friction.map(|friction| AxisValue::FrictionRange(friction.range))
            },
            |c, s| {
                if let AxisValue::FrictionRange(range) = s {
                    friction(c).range = *range;
                }
            },
        ),
    },
    SweptKey {
        key: "rod.friction.range.times-contact",
        access: Access::Number(
            |c| match c.rod.friction.map(|friction| friction.range) {
                Some(FrictionRange::TimesContact(factor)) => Some(factor),
                _ => None,
            },
            |c, x| friction(c).range = FrictionRange::TimesContact(x),
        ),
    },
    SweptKey {
        key: "rod.imperfection",
        access: Access::Number(|c| Some(c.imperfection), |c, x| c.imperfection = x),
    },
    SweptKey {
        key: "rod.seed",
        access: Access::Whole(|c| Some(c.seed), |c, n| c.seed = n),
    },
    SweptKey {
        key: "discharge.load.spring",
        access: Access::Number(|c| c.load.map(|l| l.spring), |c, x| load(c).spring = x),
    },
    SweptKey {
        key: "discharge.load.rest_length",
        access: Access::Number(
            |c| c.load.map(|l| l.rest_length),
            |c, x| load(c).rest_length = x,
        ),
    },
    SweptKey {
        key: DASHPOT,
        access: Access::Number(|c| c.load.map(|l| l.dashpot), |c, x| load(c).dashpot = x),
    },
    SweptKey {
        key: EDGES,
        access: Access::Whole(
            |c| Some(c.rod.n_edges as u64),
            |c, n| c.rod.n_edges = usize::try_from(n).unwrap_or(usize::MAX),
        ),
    },
];

/// The key of the resolution.
pub(super) const EDGES: &str = "accuracy.edges";
/// The key of the resistance of the load.
pub(super) const DASHPOT: &str = "discharge.load.dashpot";

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::ElasticScene;

    use super::*;

    /// A scene with all keys.
    const FULL: &str = "knots = \"own\"\n[rod]\nknot = \"3_1\"\ntwist = 1.0\n[rod.contact]\n[rod.friction]\nrange = { times-contact = 1.1 }\n[discharge.load]\ndashpot = 0.5\n[accuracy]\nintegrator = \"ros2w\"\n";

    /// Numbers of a scene that have one value only, and why.
    const ONE_VALUE: [(&str, &str); 9] = [
        (
            "rod.twist",
            "has values of its own, which run slower than these",
        ),
        ("charge.duration", "method"),
        ("discharge.cuts", "all cuts of a case belong to it"),
        ("discharge.until_released", "method"),
        ("discharge.longest", "method"),
        ("discharge.closures", "method"),
        ("discharge.ends.motions", "vectors and numbers of two ends"),
        ("accuracy.", "method, but for the edges"),
        ("knots", "a name"),
    ];

    #[test]
    fn every_number_of_a_rod_may_have_several_values() {
        let scene = ElasticScene::parse(FULL, Path::new("full.toml")).unwrap();
        let file: toml::Table = toml::from_str(&scene.text()).unwrap();
        let written = crate::scene::numbers_written(&file);
        assert!(written.len() > 12, "{written:?}");
        for key in &written {
            let swept = ROD_KEYS.iter().any(|k| k.key == key.as_str());
            let excepted = ONE_VALUE.iter().any(|(e, _)| key.starts_with(e));
            assert!(swept || excepted, "{key} can have one value only");
        }
        // and each key of the list is there, with a value to read
        let case = scene.case("3_1", None);
        for key in &ROD_KEYS {
            let is_read = key.read(&case).is_some();
            assert!(is_read, "{}", key.key);
            let choice = matches!(key.access, Access::Choice(..));
            assert!(
                choice || written.iter().any(|w| w == key.key),
                "{}",
                key.key
            );
        }
    }
}
