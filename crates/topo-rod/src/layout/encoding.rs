//! How a layout is written: a single component as its three numbers, several as a list behind a count of zero.
//!
//! Checkpoints do not describe themselves, so the files of single rods must keep their bytes: no rod has zero vertices, and a reader
//! looks for the list only there.

use std::fmt;

use serde::de::{Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::ser::SerializeStruct;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Chain, Layout};

const FIELDS: [&str; 4] = ["n_vertices", "closed", "rest_length", "components"];

/// What is written of a component.
type Written = (usize, bool, f64);

impl Serialize for Layout {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let several = self.parts.is_some();
        let mut out = to.serialize_struct("Chain", if several { 4 } else { 3 })?;
        let count = if several { 0 } else { self.whole.n_vertices };
        out.serialize_field(FIELDS[0], &count)?;
        out.serialize_field(FIELDS[1], &self.whole.closed)?;
        out.serialize_field(FIELDS[2], &self.whole.rest_length)?;
        if let Some(parts) = &self.parts {
            let written = parts
                .iter()
                .map(|c| (c.n_vertices, c.closed, c.rest_length));
            out.serialize_field(FIELDS[3], &written.collect::<Vec<Written>>())?;
        }
        out.end()
    }
}

impl<'de> Deserialize<'de> for Layout {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_struct("Chain", &FIELDS, Reader)
    }
}

/// Reads either form, from formats with and without names.
struct Reader;

impl Reader {
    fn layout<E: Error>(
        (n_vertices, closed, rest_length): Written,
        components: Vec<Written>,
    ) -> Result<Layout, E> {
        if n_vertices > 0 {
            return Ok(Layout::of([Chain::new(n_vertices, closed, rest_length)]));
        }
        let is_sound = |&(n, _, rest): &Written| (2..1 << 32).contains(&n) && rest.is_finite();
        if components.len() < 2 || !components.iter().all(is_sound) {
            return Err(E::custom("components that no state can have"));
        }
        let chains = components
            .into_iter()
            .map(|(n, c, rest)| Chain::new(n, c, rest));
        Ok(Layout::of(chains))
    }
}

impl<'de> Visitor<'de> for Reader {
    type Value = Layout;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("how the vertices of a rod are joined")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Layout, A::Error> {
        let missing = |k: usize| A::Error::invalid_length(k, &"three numbers");
        let n_vertices = seq.next_element()?.ok_or_else(|| missing(0))?;
        let closed = seq.next_element()?.ok_or_else(|| missing(1))?;
        let rest_length = seq.next_element()?.ok_or_else(|| missing(2))?;
        let components = if n_vertices == 0 {
            seq.next_element()?.ok_or_else(|| missing(3))?
        } else {
            Vec::new()
        };
        Self::layout((n_vertices, closed, rest_length), components)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Layout, A::Error> {
        let (mut written, mut components) = (<Written>::default(), Vec::new());
        while let Some(key) = map.next_key::<String>()? {
            match FIELDS.iter().position(|field| *field == key) {
                Some(0) => written.0 = map.next_value()?,
                Some(1) => written.1 = map.next_value()?,
                Some(2) => written.2 = map.next_value()?,
                Some(3) => components = map.next_value()?,
                _ => {
                    map.next_value::<IgnoredAny>()?;
                }
            }
        }
        Self::layout(written, components)
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
        let single = Layout::of([Chain::new(300, true, 0.25)]);
        let path = std::path::Path::new("none");
        let bytes = |value: &dyn Fn() -> Vec<u8>| value();
        let as_plain = bytes(&|| topo_core::checkpoint_bytes(path, "x", &(&plain, 7)).unwrap());
        let written = bytes(&|| topo_core::checkpoint_bytes(path, "x", &(&single, 7)).unwrap());
        assert_eq!(as_plain, written);
        let json = serde_json::to_string(&single).unwrap();
        assert_eq!(json, serde_json::to_string(&plain).unwrap());
        assert_eq!(serde_json::from_str::<Layout>(&json).unwrap(), single);
        let several = Layout::of([
            Chain::new(40, true, 0.3),
            Chain::new(21, false, 0.2),
            Chain::new(9, true, 0.1),
        ]);
        for layout in [single, several] {
            let bytes = topo_core::checkpoint_bytes(path, "x", &(&layout, 7)).unwrap();
            let back: (Layout, i32) = topo_core::parse_checkpoint(path, &bytes, "x").unwrap();
            assert_eq!(back, (layout.clone(), 7));
            let json = serde_json::to_string(&layout).unwrap();
            assert_eq!(serde_json::from_str::<Layout>(&json).unwrap(), layout);
        }
        let none = r#"{"n_vertices":0,"closed":true,"rest_length":1.0}"#;
        assert!(serde_json::from_str::<Layout>(none).is_err());
    }
}
