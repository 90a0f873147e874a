//! The Python package: its wheel, its tests, and the site that documents it.

use super::cargo::step;
use super::test::Counts;
use crate::workspace::{at, workspace};
use std::path::{Path, PathBuf};
use std::process::Command;
use topo_cli::CliError;

/// Its crate.
const CRATE: &str = "crates/topo-py";
/// What the tests need besides numpy; notebooks and pictures are tested where their packages are there.
const NEEDED: &str = "import maturin, pytest, numpy";
/// What is said where it is missing.
const NEEDS: &str = "needs Python with maturin, pytest and numpy (the one that TOPO_PYTHON names)";

/// The Python that `TOPO_PYTHON` names, if it has these modules.
fn find(imports: &str) -> Option<PathBuf> {
    let python = PathBuf::from(std::env::var_os("TOPO_PYTHON")?);
    let tried = Command::new(&python).args(["-c", imports]).output();
    tried.is_ok_and(|o| o.status.success()).then_some(python)
}

/// What became of the tests of the package.
pub enum Tested {
    /// They ran; whether all went well.
    Ran(Counts, bool),
    /// How many could not, and why.
    Skipped(usize, String),
}

/// Builds the wheel, installs it below `target`, and runs its tests there; `program` is what they compare its results with.
pub fn test(target: &Path, program: &Path, long: bool) -> Result<Tested, CliError> {
    let Some(python) = find(NEEDED) else {
        let n = n_tests(&workspace().join(CRATE).join("tests"))?;
        return Ok(Tested::Skipped(
            n,
            format!("SKIPPED: {n} tests of the Python package: {NEEDS}"),
        ));
    };
    let root = target.join("python-package");
    if root.exists() {
        std::fs::remove_dir_all(&root).map_err(at(&root))?;
    }
    let (wheels, site) = (root.join("wheels"), root.join("site"));
    let mut counts = Counts::default();
    let module = |name: &str| {
        let mut command = Command::new(&python);
        command.args(["-m", name]).current_dir(workspace());
        command
    };
    let mut build = module("maturin");
    build.args([
        "build",
        "--release",
        "--quiet",
        "--locked",
        "--compatibility",
        "linux",
    ]);
    build.args(["--manifest-path", &format!("{CRATE}/Cargo.toml"), "--out"]);
    build.arg(&wheels).arg("--interpreter").arg(&python);
    if !step("wheel of the Python package", build, |_| {})? {
        return Ok(Tested::Ran(counts, false));
    }
    let mut install = module("pip");
    install.args([
        "install",
        "--quiet",
        "--no-deps",
        "--no-index",
        "--disable-pip-version-check",
    ]);
    install.arg("--target").arg(&site).args(wheel(&wheels)?);
    if !step("its installation", install, |_| {})? {
        return Ok(Tested::Ran(counts, false));
    }
    let mut tests = module("pytest");
    tests.args([
        "--color=no",
        "-p",
        "no:cacheprovider",
        &format!("{CRATE}/tests"),
    ]);
    tests.env("PYTHONPATH", &site).env("TOPO_PROGRAM", program);
    tests.env("PYTHONDONTWRITEBYTECODE", "1");
    if long {
        tests.env("TOPO_LONG", "1");
    }
    let ok = step("tests of the Python package", tests, |line| {
        counts.add_pytest(line)
    })?;
    Ok(Tested::Ran(counts, ok))
}

/// Builds the site of the documentation into `target/site`, from what is there.
pub fn docs(target: &Path) -> Result<(), CliError> {
    let Some(python) = find("import mkdocs, material, mkdocstrings_handlers.python, latex2mathml")
    else {
        return Err(CliError::Input(
            "the site needs Python with mkdocs-material, mkdocstrings-python and latex2mathml (the one that TOPO_PYTHON names): install these there"
                .to_owned(),
        ));
    };
    let mut build = Command::new(python);
    build.args(["-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir"]);
    build.arg(target.join("site")).current_dir(workspace());
    match step("site", build, |_| {})? {
        true => {
            topo_cli::say!("written to {}", target.join("site/index.html").display());
            Ok(())
        }
        false => Err(CliError::Step("the site cannot be built".to_owned())),
    }
}

/// The wheel in a folder.
fn wheel(folder: &Path) -> Result<Option<PathBuf>, CliError> {
    let mut entries = std::fs::read_dir(folder).map_err(at(folder))?.flatten();
    let is_wheel = |path: &PathBuf| path.extension().is_some_and(|e| e == "whl");
    Ok(entries.find_map(|e| Some(e.path()).filter(is_wheel)))
}

/// Test functions in the files of a folder.
fn n_tests(folder: &Path) -> Result<usize, CliError> {
    let mut n = 0;
    for entry in std::fs::read_dir(folder).map_err(at(folder))?.flatten() {
        if entry.path().extension().is_some_and(|e| e == "py") {
            let text = std::fs::read_to_string(entry.path()).map_err(at(&entry.path()))?;
            n += text.lines().filter(|l| l.starts_with("def test_")).count();
        }
    }
    Ok(n)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tests_of_the_python_package_are_counted_in_its_files() {
        let dir = tempfile::tempdir().unwrap();
        let text = "import x\ndef test_a():\n    pass\ndef helper():\n    pass\ndef test_b(tmp_path):\n    pass\n";
        std::fs::write(dir.path().join("test_x.py"), text).unwrap();
        std::fs::write(dir.path().join("notes.txt"), text).unwrap();
        assert_eq!(n_tests(dir.path()).unwrap(), 2);
        assert!(n_tests(&workspace().join(CRATE).join("tests")).unwrap() > 10);
    }
}
