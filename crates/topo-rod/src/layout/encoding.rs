//! How it is written how vertices are joined: a single component that is straight at rest as its three numbers, others as a list, and
//! what their material is like, behind a count of zero.
//!
//! Checkpoints do not describe themselves, so the files of single rods must keep their bytes: no rod has zero vertices, and a reader
//! looks for more only there.

use std::fmt;

use serde::de::{Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::ser::SerializeStruct;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Chain, Layout};
use crate::state::{Joined, Material};

const FIELDS: [&str; 5] = [
    "n_vertices",
    "closed",
    "rest_length",
    "components",
    "material",
];

/// What is written of a component.
type Written = (usize, bool, f64);

impl Serialize for Joined {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let chains = self.layout.components();
        let more = chains.len() > 1 || self.material.is_some();
        let mut out = to.serialize_struct("Chain", if more { 5 } else { 3 })?;
        let count = if more { 0 } else { self.layout.n_vertices() };
        out.serialize_field(FIELDS[0], &count)?;
        out.serialize_field(FIELDS[1], &self.layout.is_closed())?;
        out.serialize_field(FIELDS[2], &self.layout.rest_length())?;
        if more {
            let written = chains
                .iter()
                .map(|c| (c.n_vertices, c.closed, c.rest_length));
            out.serialize_field(FIELDS[3], &written.collect::<Vec<Written>>())?;
            out.serialize_field(FIELDS[4], &self.material)?;
        }
        out.end()
    }
}

impl<'de> Deserialize<'de> for Joined {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_struct("Chain", &FIELDS, Reader)
    }
}

/// Reads either form, from formats with and without names.
struct Reader;

impl Reader {
    fn joined<E: Error>(
        (n_vertices, closed, rest_length): Written,
        (components, material): (Vec<Written>, Option<Box<Material>>),
    ) -> Result<Joined, E> {
        if n_vertices > 0 {
            return Ok(Layout::of([Chain::new(n_vertices, closed, rest_length)]).into());
        }
        let is_sound = |&(n, _, rest): &Written| (2..1 << 32).contains(&n) && rest.is_finite();
        if components.is_empty() || !components.iter().all(is_sound) {
            return Err(E::custom("components that no state can have"));
        }
        let chains = components
            .into_iter()
            .map(|(n, c, rest)| Chain::new(n, c, rest));
        let layout = Layout::of(chains);
        Ok(Joined { layout, material })
    }
}

impl<'de> Visitor<'de> for Reader {
    type Value = Joined;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("how the vertices of a rod are joined")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Joined, A::Error> {
        let missing = |k: usize| A::Error::invalid_length(k, &"three numbers");
        let n_vertices = seq.next_element()?.ok_or_else(|| missing(0))?;
        let closed = seq.next_element()?.ok_or_else(|| missing(1))?;
        let rest_length = seq.next_element()?.ok_or_else(|| missing(2))?;
        let more = if n_vertices == 0 {
            let components = seq.next_element()?.ok_or_else(|| missing(3))?;
            (components, seq.next_element()?.ok_or_else(|| missing(4))?)
        } else {
            (Vec::new(), None)
        };
        Self::joined((n_vertices, closed, rest_length), more)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Joined, A::Error> {
        let (mut written, mut components, mut material) = (<Written>::default(), Vec::new(), None);
        while let Some(key) = map.next_key::<String>()? {
            match FIELDS.iter().position(|field| *field == key) {
                Some(0) => written.0 = map.next_value()?,
                Some(1) => written.1 = map.next_value()?,
                Some(2) => written.2 = map.next_value()?,
                Some(3) => components = map.next_value()?,
                Some(4) => material = map.next_value()?,
                _ => {
                    map.next_value::<IgnoredAny>()?;
                }
            }
        }
        Self::joined(written, (components, material))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A single component is written as the three numbers it always was, and several come back as they were.
    #[test]
    fn a_single_component_keeps_its_bytes() {
        #[derive(Serialize)]
        struct Plain {
            n_vertices: usize,
            closed: bool,
            rest_length: f64,
        }
        let plain = Plain {
            n_vertices: 300,
            closed: true,
            rest_length: 0.25,
        };
        let single = Joined::from(Layout::of([Chain::new(300, true, 0.25)]));
        let path = std::path::Path::new("none");
        let bytes = |value: &dyn Fn() -> Vec<u8>| value();
        let as_plain = bytes(&|| topo_core::checkpoint_bytes(path, "x", &(&plain, 7)).unwrap());
        let written = bytes(&|| topo_core::checkpoint_bytes(path, "x", &(&single, 7)).unwrap());
        assert_eq!(as_plain, written);
        let json = serde_json::to_string(&single).unwrap();
        assert_eq!(json, serde_json::to_string(&plain).unwrap());
        assert_eq!(serde_json::from_str::<Joined>(&json).unwrap(), single);
        let several = Layout::of([
            Chain::new(40, true, 0.3),
            Chain::new(21, false, 0.2),
            Chain::new(9, true, 0.1),
        ]);
        let curved = Joined {
            material: Some(Box::default()),
            ..single.clone()
        };
        for layout in [single, several.into(), curved] {
            let bytes = topo_core::checkpoint_bytes(path, "x", &(&layout, 7)).unwrap();
            let back: (Joined, i32) = topo_core::parse_checkpoint(path, &bytes, "x").unwrap();
            assert_eq!(back, (layout.clone(), 7));
            let json = serde_json::to_string(&layout).unwrap();
            assert_eq!(serde_json::from_str::<Joined>(&json).unwrap(), layout);
        }
        let none = r#"{"n_vertices":0,"closed":true,"rest_length":1.0}"#;
        assert!(serde_json::from_str::<Joined>(none).is_err());
    }
}
