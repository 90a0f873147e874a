//! `topo scene new`: a scene to begin with.

use topo_lab::folder_of;
use topo_view::data;

use crate::batteries::Batteries;
use crate::cli::NewArgs;
use crate::error::CliError;
use crate::output;

/// Writes the scene.
pub fn run(args: &NewArgs, batteries: &Batteries<'_>) -> Result<(), CliError> {
    let described = batteries.iter().filter_map(|b| Some((b, b.keys()?)));
    let described: Vec<_> = described.collect();
    let found = described.iter().find(|(b, _)| b.name() == args.battery);
    let Some((battery, keys)) = found else {
        let names: Vec<&str> = described.iter().map(|(b, _)| b.name()).collect();
        return Err(CliError::Argument {
            key: "--battery",
            value: args.battery.clone(),
            remedy: format!("write one of {}", names.join(", ")),
        });
    };
    // a name that no results can go to is better refused now
    folder_of(&args.file)?;
    let file = args.file.display();
    let text = format!(
        "# A scene of {}: `topo run {file}` runs it. Lines behind # say what is there without them.\n{}",
        battery.what(),
        keys.new_scene(battery.first_scene()),
    );
    if args.file.exists() && !args.force {
        return Err(CliError::Argument {
            key: "FILE",
            value: file.to_string(),
            remedy: "it is there already: name another, or add --force to write over it".to_owned(),
        });
    }
    data::write(&args.file, text.as_bytes())?;
    output::data("scene", file.to_string());
    say!("written to {file}; `topo run {file}` runs it");
    Ok(())
}
