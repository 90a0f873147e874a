//! Dictionaries of Python as tables of TOML, and as settings.

use std::path::Path;

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::{Table, Value};
use topo_lab::{Document, Keys, LabError};

use crate::refusal::Refusal;

/// A dictionary as a table; a key whose value is `None` is left out. `place` is what stands before the keys in messages.
pub fn table(dict: &Bound<'_, PyDict>, place: &str) -> PyResult<Table> {
    let mut table = Table::new();
    for (key, value) in dict {
        let name = key.extract::<String>().map_err(|_| {
            PyTypeError::new_err(format!("{place}{key}: keys are names, give a string"))
        })?;
        if let Some(value) = value_of(&value, &format!("{place}{name}"))? {
            table.insert(name, value);
        }
    }
    Ok(table)
}

fn value_of(value: &Bound<'_, PyAny>, key: &str) -> PyResult<Option<Value>> {
    if value.is_none() {
        return Ok(None);
    }
    // arrays and scalars of numpy
    if value.hasattr("tolist")? {
        return value_of(&value.call_method0("tolist")?, key);
    }
    let all = |items: Bound<'_, PyAny>| -> PyResult<Value> {
        let values: PyResult<Vec<_>> = items.try_iter()?.map(|v| value_of(&v?, key)).collect();
        Ok(Value::Array(values?.into_iter().flatten().collect()))
    };
    Ok(Some(if value.is_instance_of::<PyBool>() {
        Value::Boolean(value.extract()?)
    } else if value.is_instance_of::<PyInt>() {
        Value::Integer(value.extract()?)
    } else if value.is_instance_of::<PyFloat>() {
        Value::Float(value.extract()?)
    } else if value.is_instance_of::<PyString>() {
        Value::String(value.extract()?)
    } else if let Ok(dict) = value.cast::<PyDict>() {
        Value::Table(table(dict, &format!("{key}."))?)
    } else if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        all(value.clone())?
    } else {
        let kind = value.get_type().name()?;
        return Err(PyTypeError::new_err(format!(
            "{key} is of type {kind}: give a number, a name, a list or a dictionary"
        )));
    }))
}

/// Arguments of Python that have another name than the field they set.
const ARGUMENTS: [(&str, &str); 2] = [("n_edges", "edges"), ("seeds", "tilts")];

/// `defaults` with what `given` says instead; a key whose value is `None` is taken out.
pub fn settings<T: Clone + Serialize + DeserializeOwned + JsonSchema>(
    defaults: &T,
    given: &Bound<'_, PyDict>,
) -> PyResult<T> {
    if given.is_empty() {
        return Ok(defaults.clone());
    }
    let mut all = Table::try_from(defaults).map_err(|e| PyTypeError::new_err(e.to_string()))?;
    for (key, value) in given {
        if value.is_none() {
            all.remove(&key.extract::<String>()?);
        }
    }
    all.extend(table(given, "")?);
    let text = all.to_string();
    let document = Document::new(&text, Path::new("")).map_err(refused)?;
    Keys::of::<T>().check(&document).map_err(refused)?;
    Ok(document.read(&text).map_err(refused)?)
}

/// The message of a scene, without a place in a file.
fn refused(error: LabError) -> Refusal {
    let LabError::Scene(fault) = error else {
        return error.into();
    };
    let argument = ARGUMENTS.iter().find(|(field, _)| *field == fault.key);
    let key = argument.map_or(&*fault.key, |(_, argument)| argument);
    Refusal::value(key, fault.found, &fault.expected)
}
