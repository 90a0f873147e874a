//! Scene files: what is the same for every battery.

mod axis;
mod beside;
mod document;
mod fault;
mod folder;
mod forms;
mod keys;
mod numbers;
mod rows;
mod syntax;
mod words;

pub(crate) use axis::{Access, SweptKey, axes, check_count, product, put_axes, remove};
pub use axis::{Axis, AxisValue};
pub(crate) use beside::BesideQ;
pub use document::Document;
pub(crate) use document::read_text;
pub(crate) use fault::LEFT_OUT;
pub use fault::SceneFault;
pub use folder::folder_of;
pub(crate) use forms::nearest;
pub use keys::Keys;
pub(crate) use keys::numbers as numbers_node;
pub use numbers::{Numbers, numbers};
pub(crate) use numbers::{repeated, repeated_number};
pub use rows::KeyRow;
pub(crate) use words::listed;

/// The dotted keys of all numbers and lists of numbers in a file.
#[cfg(test)]
pub(crate) fn numbers_written(file: &toml::Table) -> Vec<String> {
    fn is_numeric(value: &toml::Value) -> bool {
        match value {
            toml::Value::Integer(_) | toml::Value::Float(_) => true,
            toml::Value::Array(list) => list.iter().any(is_numeric),
            toml::Value::Table(table) => table.values().any(is_numeric),
            _ => false,
        }
    }
    let mut keys = Vec::new();
    for (name, value) in file {
        match value {
            toml::Value::Table(table) => {
                let inner = numbers_written(table);
                keys.extend(inner.iter().map(|key| format!("{name}.{key}")));
            }
            value if is_numeric(value) => keys.push(name.clone()),
            _ => {}
        }
    }
    keys
}
