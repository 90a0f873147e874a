//! Errors on their way to Python: which class, which file, key and value, and what would be right.

use pyo3::exceptions::{PyFileNotFoundError, PyOSError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use topo_core::{CurveError, InvalidValue};
use topo_knots::KnotError;
use topo_lab::LabError;
use topo_nematic::NematicError;
use topo_rod::RodError;

/// Classes of `topobatteries.errors`, and those of Python for files.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum Class {
    #[default]
    Topo,
    Scene,
    Knot,
    NoFile,
    File,
}

/// What was refused and why, away from the interpreter; small, as it is the error of most functions here.
#[derive(Debug, Clone, Default)]
pub struct Refusal {
    class: Class,
    message: String,
    file: Option<Box<str>>,
    line: Option<usize>,
    key: Option<Box<str>>,
    value: Option<Box<str>>,
    remedy: Option<Box<str>>,
}

impl Refusal {
    /// A value of an argument that cannot be.
    pub fn value(key: &str, value: impl ToString, remedy: &str) -> Self {
        let value = value.to_string();
        Self {
            message: format!("{key} = {value}: {remedy}"),
            key: Some(key.into()),
            value: Some(value.into()),
            remedy: Some(remedy.into()),
            ..Self::default()
        }
    }

    fn says(class: Class, error: &dyn std::error::Error) -> Self {
        let message = error.to_string();
        Self {
            class,
            message,
            ..Self::default()
        }
    }
}

impl From<InvalidValue> for Refusal {
    fn from(error: InvalidValue) -> Self {
        let message = error.to_string();
        let remedy = format!("expected {}", error.expected);
        Self {
            message,
            ..Self::value(&error.name, error.value, &remedy)
        }
    }
}

impl From<CurveError> for Refusal {
    fn from(error: CurveError) -> Self {
        match error {
            CurveError::Value(value) => value.into(),
            other => Self::says(Class::Topo, &other),
        }
    }
}

impl From<RodError> for Refusal {
    fn from(error: RodError) -> Self {
        match error {
            RodError::Value(value) => value.into(),
            other => Self::says(Class::Topo, &other),
        }
    }
}

impl From<NematicError> for Refusal {
    fn from(error: NematicError) -> Self {
        match error {
            NematicError::Value(value) => value.into(),
            other => Self::says(Class::Topo, &other),
        }
    }
}

impl From<KnotError> for Refusal {
    fn from(error: KnotError) -> Self {
        let class = match &error {
            KnotError::Io { source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
                Class::NoFile
            }
            KnotError::Io { .. } => Class::File,
            _ => Class::Knot,
        };
        let name = match &error {
            KnotError::UnknownKnot { name, .. } => Some(name.clone().into()),
            _ => None,
        };
        Self {
            value: name,
            ..Self::says(class, &error)
        }
    }
}

impl From<LabError> for Refusal {
    fn from(error: LabError) -> Self {
        let whole = error.to_string();
        let scene = Self {
            class: Class::Scene,
            message: whole.clone(),
            ..Self::default()
        };
        match error {
            LabError::Scene(fault) => Self {
                file: Some(fault.file.into()),
                line: fault.line,
                key: Some(fault.key)
                    .filter(|key| !key.is_empty())
                    .map(Into::into),
                value: Some(fault.found.into()),
                remedy: Some(fault.expected.into()),
                ..scene
            },
            LabError::SceneName { path, reason } => Self {
                file: Some(path.display().to_string().into()),
                remedy: Some(reason.into()),
                ..scene
            },
            LabError::Option {
                option,
                value,
                remedy,
            } => Self {
                class: Class::Scene,
                ..Self::value(option.trim_start_matches('-'), value, &remedy)
            },
            LabError::Goal { goal, reason } => Self {
                value: Some(goal.into()),
                remedy: Some(reason.into()),
                ..scene
            },
            LabError::Unreadable { source, .. }
                if source.kind() == std::io::ErrorKind::NotFound =>
            {
                Self {
                    class: Class::NoFile,
                    ..scene
                }
            }
            LabError::Unreadable { .. } | LabError::File(_) | LabError::Output { .. } => Self {
                class: Class::File,
                ..scene
            },
            LabError::OtherScene { .. } => scene,
            LabError::Knot(source) => source.into(),
            _ => Self {
                class: Class::Topo,
                ..scene
            },
        }
    }
}

impl From<Refusal> for PyErr {
    fn from(refusal: Refusal) -> Self {
        match refusal.class {
            Class::NoFile => PyFileNotFoundError::new_err(refusal.message),
            Class::File => PyOSError::new_err(refusal.message),
            _ => Python::attach(|py| refusal.raised(py).unwrap_or_else(|error| error)),
        }
    }
}

impl Refusal {
    fn raised(self, py: Python<'_>) -> PyResult<PyErr> {
        let class = match self.class {
            Class::Scene => "SceneError",
            Class::Knot => "KnotError",
            _ => "TopoError",
        };
        let fields = PyDict::new(py);
        fields.set_item("file", self.file.as_deref())?;
        fields.set_item("line", self.line)?;
        fields.set_item("key", self.key.as_deref())?;
        fields.set_item("value", self.value.as_deref())?;
        fields.set_item("remedy", self.remedy.as_deref())?;
        let class = py.import("topobatteries.errors")?.getattr(class)?;
        let error = class.call((self.message,), Some(&fields))?;
        Ok(PyErr::from_value(error))
    }
}
