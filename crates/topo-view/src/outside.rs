//! Programs that some tests need and no Rust toolchain brings: Python with its readers, and a browser.

use std::path::PathBuf;
use std::process::Command;

/// A program outside of the workspace. Tests that need one are ignored by name, so that a run without it counts them as skipped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outside {
    /// Python with numpy, VTK and PyVista.
    Python,
    /// A browser that runs without a screen.
    Browser,
}

impl Outside {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Python, Self::Browser];

    /// What the names of the tests that need it begin with.
    pub fn prefix(self) -> &'static str {
        match self {
            Self::Python => "python_",
            Self::Browser => "browser_",
        }
    }

    /// What it is and how to name one.
    pub fn needs(self) -> &'static str {
        match self {
            Self::Python => {
                "needs Python with numpy, vtk and pyvista (python3, or the one that TOPO_PYTHON names)"
            }
            Self::Browser => "needs Chromium (from PATH, or the one that TOPO_BROWSER names)",
        }
    }

    /// The program, if it is there and runs.
    pub fn find(self) -> Option<PathBuf> {
        let (named, usual, arguments): (_, &[&str], &[&str]) = match self {
            Self::Python => (
                "TOPO_PYTHON",
                &["python3"],
                &["-c", "import numpy, vtk, pyvista"],
            ),
            Self::Browser => (
                "TOPO_BROWSER",
                &["chromium", "chromium-browser", "google-chrome"],
                &["--version"],
            ),
        };
        let candidates = match std::env::var_os(named) {
            Some(program) => vec![PathBuf::from(program)],
            None => usual.iter().map(PathBuf::from).collect(),
        };
        candidates.into_iter().find(|program| {
            let tried = Command::new(program).args(arguments).output();
            tried.is_ok_and(|o| o.status.success())
        })
    }
}
