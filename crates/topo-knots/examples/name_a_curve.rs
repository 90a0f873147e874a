//! Names a closed braid, and the types of the same curve after a cut, from its coordinates alone.

use topo_knots::{KnotError, KnotTable, closed_braid, identify, identify_open, thickness};

fn main() -> Result<(), KnotError> {
    let table = KnotTable::builtin();
    let curve = closed_braid(&[1, 1, 2, -1, 2, 2, 3, -2, 3])?;
    let kind = identify(curve.vertices(), &table)?;
    println!(
        "closed: {} with signature {}",
        kind.label(),
        kind.invariants.signature
    );
    println!(
        "a tube of radius {:.2} fits around it",
        thickness(&curve).tau
    );
    let entry = table.get(&kind.label())?;
    if let Some(ropelength) = entry.length_over_radius {
        println!("tight, it is {ropelength} radii long");
    }
    let cut = &curve.vertices()[..curve.n_vertices() - 60];
    for (label, share) in identify_open(cut, 64, 0, &table)?.distribution {
        println!("cut: {label} in {:.0} % of the closures", 100.0 * share);
    }
    Ok(())
}
