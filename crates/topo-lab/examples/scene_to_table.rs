//! Runs a scene and prints its table: a small built-in one, or the file named as the first argument.
//!
//! ```text
//! cargo run --release -p topo-lab --example scene_to_table -- [SCENE.toml] [OUT]
//! ```

use std::path::{Path, PathBuf};

use topo_knots::KnotTable;
use topo_lab::{ElasticScene, Event, SweepSettings, run_sweep};

const SCENE: &str = r#"
[rod]
knot = "3_1"
twist = [0.0, 1.0]
[rod.contact]
[rod.friction]
[accuracy]
edges = 80
tolerance = 4e-3
"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let scene = match arguments.next() {
        Some(path) => ElasticScene::read(Path::new(&path))?,
        None => ElasticScene::parse(SCENE, Path::new("built-in scene"))?,
    };
    let folder = tempfile::tempdir()?;
    let out = arguments
        .next()
        .map_or(folder.path().to_owned(), PathBuf::from);
    let settings = SweepSettings::new(&out);
    let report = run_sweep(&scene, &KnotTable::builtin(), &settings, &|event| {
        if let Event::Case {
            name,
            n_done,
            warnings,
            ..
        } = event
        {
            eprintln!("{n_done}: {name} {warnings}");
        }
    })?;
    println!("knot  theta'h   E/E0     Wr      t50     t99   untied  CPU s");
    let cell = |t: Option<f64>| t.map_or("      -".to_owned(), |t| format!("{t:7.3}"));
    for r in &report.rows {
        println!(
            "{:5} {:+6.2} {:8.4} {:+7.3} {} {} {} {:6.2}",
            r.knot,
            r.twist,
            r.energy,
            r.writhe,
            cell(r.t50),
            cell(r.t99),
            cell(r.t_untie),
            r.cpu_seconds
        );
    }
    Ok(())
}
