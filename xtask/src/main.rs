//! The commands of the topo workspace.
fn main() {}
