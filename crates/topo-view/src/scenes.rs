//! The scenes behind the figures, written beside them so that a reader can run them again.

use crate::data;
use crate::error::ViewError;
use crate::program::program;
use std::path::Path;
use topo_lab::NematicScene;
use topo_lab::Preset;

/// Writes `scenes/elastic.toml` and `scenes/nematic.toml` into the results folder.
pub fn write(results: &Path, quality: Preset) -> Result<(), ViewError> {
    for (name, text) in [("elastic", elastic(quality)), ("nematic", nematic(quality))] {
        let path = results.join(format!("scenes/{name}.toml"));
        data::write(&path, text.as_bytes())?;
    }
    Ok(())
}

fn elastic(quality: Preset) -> String {
    let (name, program) = (quality.name(), program());
    format!(
        "# The sweep of the elastic figures. Run it: {program} run scenes/elastic.toml --out again\n\
         [rod]\nknot = \"all\"\nslenderness = 50\ntwist = {{ from = -2.0, to = 2.0, n = 17 }}\n\
         [rod.contact]\n[rod.friction]\n[accuracy]\npreset = \"{name}\"\n"
    )
}

fn nematic(quality: Preset) -> String {
    let program = program();
    let scene = NematicScene::published(quality);
    let flowing = scene.flowing.map_or(String::new(), |q| {
        let numbers: Vec<String> = q.iter().map(u32::to_string).collect();
        format!("q = [{}]\n", numbers.join(", "))
    });
    format!(
        "# The sweep of the nematic figures. Run it: {program} run scenes/nematic.toml --out again\n\
         [nematic]\nradius = {}\nspacing = {}\nq = {{ from = 1, to = {}, n = {} }}\n\
         [flow]\n{flowing}",
        scene.nematic.radius,
        scene.nematic.spacing,
        scene.charges.len(),
        scene.charges.len()
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use topo_lab::{ElasticScene, Scene};

    #[test]
    fn the_scenes_are_those_of_the_figures() {
        for quality in [Preset::Draft, Preset::Standard, Preset::Paper] {
            let path = Path::new("elastic.toml");
            let scene = Scene::parse(&elastic(quality), path).unwrap();
            let mut published = ElasticScene::published(quality);
            // each case has a twist of its own
            published.rod.twist = None;
            assert_eq!(scene, Scene::Elastic(Box::new(published)));
            let path = Path::new("nematic.toml");
            let scene = Scene::parse(&nematic(quality), path).unwrap();
            let published = NematicScene::published(quality);
            assert_eq!(scene, Scene::Nematic(Box::new(published)));
        }
    }
}
