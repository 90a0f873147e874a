//! Writes the seeds of the fuzz targets that are not text: checkpoints of the present schemas.

use std::path::Path;
use topo_tests::parsers::{checkpoint_payloads, nematic_payloads, rod_payloads};

fn main() -> std::io::Result<()> {
    let seeds = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/seeds");
    for (target, payloads) in [
        ("checkpoint", checkpoint_payloads()),
        ("nematic_checkpoint", nematic_payloads()),
        ("rod_checkpoint", rod_payloads()),
    ] {
        let folder = seeds.join(target);
        std::fs::create_dir_all(&folder)?;
        for (name, bytes) in payloads {
            std::fs::write(folder.join(name), &bytes)?;
            println!("{target}/{name}: {} bytes", bytes.len());
        }
    }
    Ok(())
}
