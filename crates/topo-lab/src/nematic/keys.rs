//! The keys of a colloid that may have several values, in the order in which cases run through them.

use topo_nematic::anchoring::{Plate, PlateDirector};
use topo_nematic::{Anchoring, ExternalField, Sides};

use super::case::NematicCase;
use crate::scene::{Access, AxisValue, SweptKey};

type Key = SweptKey<NematicCase>;

const fn number(
    key: &'static str,
    read: fn(&NematicCase) -> Option<f64>,
    write: fn(&mut NematicCase, f64),
) -> Key {
    let access = Access::Number(read, write);
    SweptKey { key, access }
}

const fn choice(
    key: &'static str,
    read: fn(&NematicCase) -> Option<AxisValue>,
    write: fn(&mut NematicCase, &AxisValue),
) -> Key {
    let access = Access::Choice(read, write);
    SweptKey { key, access }
}

fn strength(anchoring: Anchoring) -> Option<f64> {
    match anchoring {
        Anchoring::Weak(strength) => Some(strength),
        _ => None,
    }
}

fn angle(director: PlateDirector) -> Option<f64> {
    match director {
        PlateDirector::Planar(angle) => Some(angle),
        _ => None,
    }
}

fn anchoring(value: &AxisValue, to: &mut Anchoring) {
    if let AxisValue::Anchoring(anchoring) = value {
        *to = *anchoring;
    }
}

fn director(value: &AxisValue, to: &mut PlateDirector) {
    if let AxisValue::Director(director) = value {
        *to = *director;
    }
}

fn walls(case: &NematicCase) -> Option<Plate> {
    match case.nematic.sides {
        Sides::Walled(plate) => Some(plate),
        _ => None,
    }
}

fn change_walls(case: &mut NematicCase, change: impl FnOnce(&mut Plate)) {
    if let Sides::Walled(plate) = &mut case.nematic.sides {
        change(plate);
    }
}

fn field(case: &mut NematicCase) -> Option<&mut ExternalField> {
    case.nematic.field.as_mut()
}

/// The key of the resolution.
pub(super) const SPACING: &str = "nematic.spacing";

/// Windings run slowest, then these; of cases with and without flow, those with it come second.
pub(crate) const COLLOID_KEYS: [Key; 24] = [
    number(
        "nematic.radius",
        |c| Some(c.nematic.radius),
        |c, x| c.nematic.radius = x,
    ),
    number(
        SPACING,
        |c| Some(c.nematic.spacing),
        |c, x| c.nematic.spacing = x,
    ),
    choice(
        "nematic.pattern",
        |c| Some(AxisValue::Pattern(c.nematic.pattern.clone())),
        |c, s| {
            if let AxisValue::Pattern(pattern) = s {
                c.nematic.pattern = pattern.clone();
            }
        },
    ),
    choice(
        "nematic.anchoring",
        |c| Some(AxisValue::Anchoring(c.nematic.anchoring)),
        |c, s| anchoring(s, &mut c.nematic.anchoring),
    ),
    number(
        "nematic.anchoring.weak",
        |c| strength(c.nematic.anchoring),
        |c, x| c.nematic.anchoring = Anchoring::Weak(x),
    ),
    choice(
        "nematic.boundary",
        |c| Some(AxisValue::Boundary(c.nematic.boundary)),
        |c, s| {
            if let AxisValue::Boundary(boundary) = s {
                c.nematic.boundary = *boundary;
            }
        },
    ),
    choice(
        "nematic.plates.anchoring",
        |c| Some(AxisValue::Anchoring(c.nematic.plates.anchoring)),
        |c, s| anchoring(s, &mut c.nematic.plates.anchoring),
    ),
    number(
        "nematic.plates.anchoring.weak",
        |c| strength(c.nematic.plates.anchoring),
        |c, x| c.nematic.plates.anchoring = Anchoring::Weak(x),
    ),
    choice(
        "nematic.plates.director",
        |c| Some(AxisValue::Director(c.nematic.plates.director)),
        |c, s| director(s, &mut c.nematic.plates.director),
    ),
    number(
        "nematic.plates.director.planar",
        |c| angle(c.nematic.plates.director),
        |c, x| c.nematic.plates.director = PlateDirector::Planar(x),
    ),
    choice(
        "nematic.sides.walled.anchoring",
        |c| walls(c).map(|plate| AxisValue::Anchoring(plate.anchoring)),
        |c, s| change_walls(c, |plate| anchoring(s, &mut plate.anchoring)),
    ),
    number(
        "nematic.sides.walled.anchoring.weak",
        |c| walls(c).and_then(|plate| strength(plate.anchoring)),
        |c, x| change_walls(c, |plate| plate.anchoring = Anchoring::Weak(x)),
    ),
    choice(
        "nematic.sides.walled.director",
        |c| walls(c).map(|plate| AxisValue::Director(plate.director)),
        |c, s| change_walls(c, |plate| director(s, &mut plate.director)),
    ),
    number(
        "nematic.sides.walled.director.planar",
        |c| walls(c).and_then(|plate| angle(plate.director)),
        |c, x| change_walls(c, |plate| plate.director = PlateDirector::Planar(x)),
    ),
    number(
        "material.a",
        |c| Some(c.nematic.material.a),
        |c, x| c.nematic.material.a = x,
    ),
    number(
        "material.b",
        |c| Some(c.nematic.material.b),
        |c, x| c.nematic.material.b = x,
    ),
    number(
        "material.c",
        |c| Some(c.nematic.material.c),
        |c, x| c.nematic.material.c = x,
    ),
    number(
        "material.elastic_constant",
        |c| Some(c.nematic.material.elastic_constant),
        |c, x| c.nematic.material.elastic_constant = x,
    ),
    number(
        "material.second_elastic_constant",
        |c| c.nematic.material.second_elastic_constant,
        |c, x| c.nematic.material.second_elastic_constant = Some(x),
    ),
    number(
        "material.rotational_mobility",
        |c| Some(c.nematic.material.rotational_mobility),
        |c, x| c.nematic.material.rotational_mobility = x,
    ),
    number(
        "material.flow_alignment",
        |c| Some(c.nematic.material.flow_alignment),
        |c, x| c.nematic.material.flow_alignment = x,
    ),
    number(
        "material.viscosity",
        |c| Some(c.nematic.material.viscosity),
        |c, x| c.nematic.material.viscosity = x,
    ),
    number(
        "material.surface_order",
        |c| c.nematic.material.surface_order,
        |c, x| c.nematic.material.surface_order = Some(x),
    ),
    number(
        "nematic.field.anisotropy",
        |c| c.nematic.field.map(|field| field.anisotropy),
        |c, x| {
            if let Some(field) = field(c) {
                field.anisotropy = x;
            }
        },
    ),
];

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::NematicScene;

    use super::*;

    /// A scene with all keys that fit together.
    const FULL: &str = "[nematic]\nradius = 15\npattern = { planar = { axis = [0, 0, 1] } }\nanchoring = { weak = 1.0 }\nplates = { anchoring = { weak = 2.0 }, director = { planar = 0.1 } }\nsides = { walled = { anchoring = { weak = 2.0 }, director = { planar = 0.1 } } }\nfield = { vector = [0, 0, 0.1], anisotropy = 1 }\n[material]\nsecond_elastic_constant = 0.1\nsurface_order = 0.5\n[switch]\nramp = 1.0\n[flow]\nsolver = \"sparse\"\n[accuracy]\nmemory_limit = 8000000000\n";

    /// Numbers of a scene that have one value only, and why.
    const ONE_VALUE: [(&str, &str); 9] = [
        ("nematic.cell", "three edges"),
        (
            "nematic.pattern.planar.axis",
            "a vector: patterns may be several",
        ),
        (
            "nematic.field.vector",
            "a vector: the anisotropy may be several",
        ),
        ("charge.", "method"),
        ("switch.", "method"),
        ("discharge.", "method"),
        ("flow.", "method"),
        ("accuracy.", "method"),
        (
            "nematic.q",
            "has values of its own, which run slower than these",
        ),
    ];

    #[test]
    fn every_number_of_a_colloid_may_have_several_values() {
        let scene = NematicScene::parse(FULL, Path::new("full.toml")).unwrap();
        let file: toml::Table = toml::from_str(&scene.text()).unwrap();
        let written = crate::scene::numbers_written(&file);
        assert!(written.len() > 25, "{written:?}");
        for key in &written {
            let swept = COLLOID_KEYS.iter().any(|k| k.key == key.as_str());
            let excepted = ONE_VALUE.iter().any(|(e, _)| key.starts_with(e));
            assert!(swept || excepted, "{key} can have one value only");
        }
        let case = scene.cases().remove(0);
        for key in &COLLOID_KEYS {
            assert!(key.read(&case).is_some(), "{}", key.key);
            let choice = matches!(key.access, Access::Choice(..));
            assert!(
                choice || written.iter().any(|w| w == key.key),
                "{}",
                key.key
            );
        }
    }
}
