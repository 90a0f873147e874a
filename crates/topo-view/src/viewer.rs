//! The interactive part of the gallery: charged states and their discharge in three dimensions, without a network or a server.
//!
//! The page itself holds only what is small. Three.js and the shapes lie beside it in the folder `viewer`, as scripts that are loaded
//! when they are needed: a page that was opened from disk may load scripts, but not read files.

mod bytes;
mod elastic;
mod nematic;
#[cfg(test)]
mod tests;

use crate::data::write;
use crate::error::ViewError;
use crate::plot::color::Scale;
use serde_json::{Value, json};
use std::path::Path;

const THREE: &str = include_str!("../assets/three/three.min.js");

/// The page's script: one function made of these files.
const SCRIPT: [&str; 4] = [
    include_str!("../assets/viewer/stage.js"),
    include_str!("../assets/viewer/elastic.js"),
    include_str!("../assets/viewer/nematic.js"),
    include_str!("../assets/viewer/start.js"),
];

/// Style sheet of the viewer, for the head of the page.
pub const STYLE: &str = include_str!("../assets/viewer/viewer.css");

const ELASTIC: &str = r##"<section id="view-elastic"><h2>Every charged knot in three dimensions</h2>
<div class="viewer" id="viewer-elastic">
<div class="stage" tabindex="0" role="img" aria-label="Charged knot in three dimensions; arrow keys turn it"><div class="said"></div><div class="ruler"></div></div>
<div class="controls"><button type="button" class="play">Play</button><label>Discharge <input type="range" min="0" max="1" step="1" value="0" aria-label="Time of the discharge"></label><output></output><a class="state" href="#view-elastic">Link to this state</a></div>
<div class="bars"><div class="bar"></div><div class="bar states"></div></div>
<div class="scroll"><table class="states" aria-label="Knots by twist, coloured by stored energy"></table></div>
</div>
<p>Choose knot (row) and twist density θ′h (column); drag or use the arrow keys to turn, the slider to follow the discharge. After a click into the picture the wheel zooms. Colours are square-root scales; that of the fibre ends at the largest energy density of each state. h: radius of the fibre, L: its length, E<sub>b</sub>: bending modulus, η: viscosity; E₀ = E<sub>b</sub> h² L, T₀ = 2 L η/(h E<sub>b</sub>); t₉₉: time in which 99 % of E is released.</p></section>
"##;

const NEMATIC: &str = r##"<section id="view-nematic"><h2>The colloid and its defect ring in three dimensions</h2>
<div class="viewer" id="viewer-nematic">
<div class="stage" tabindex="0" role="img" aria-label="Colloid with defect ring in three dimensions; arrow keys turn it"><div class="said"></div><div class="ruler"></div></div>
<div class="controls"><label>Charge <select aria-label="Topological charge"></select></label><button type="button" class="play">Play</button><label>Discharge <input type="range" min="0" max="1" step="1" value="0" aria-label="Time of the discharge"></label><output></output><a class="state" href="#view-nematic">Link to this state</a></div>
<div class="bars"><div class="bar"></div><div class="bar"></div></div>
</div>
<p>Green rods: the director in the plane through the centre. The particle is coloured while its anchoring is on. F: free energy, L: elastic constant, Γ: rotational mobility, R: radius of the particle, ξ<sub>N</sub>: nematic correlation length.</p></section>
"##;

/// What one of the viewers needs.
struct Data {
    /// In the page.
    index: Value,
    /// In files of their own, by name.
    files: Vec<(String, Value)>,
}

/// Writes the folder `viewer` and returns the sections of the page, of what the results folder holds; empty if it holds neither.
pub fn sections(results: &Path) -> Result<String, ViewError> {
    let elastic = elastic::data(results)?;
    let nematic = nematic::data(results)?;
    if elastic.is_none() && nematic.is_none() {
        return Ok(String::new());
    }
    let folder = results.join("viewer");
    write(&folder.join("three.js"), THREE.as_bytes())?;
    let mut html = String::new();
    for (data, section) in [(&elastic, ELASTIC), (&nematic, NEMATIC)] {
        let Some(data) = data else { continue };
        html.push_str(section);
        for (name, value) in &data.files {
            let text = format!("topoView({}, {value});\n", json!(name));
            write(&folder.join(format!("{name}.js")), text.as_bytes())?;
        }
    }
    let scale = Scale::viridis(0.0, 255.0);
    let viridis: Vec<[u8; 3]> = (0..256).map(|i| scale.rgb(f64::from(i))).collect();
    let [elastic, nematic] = [elastic, nematic].map(|data| data.map(|d| d.index));
    let index = json!({ "viridis": viridis, "elastic": elastic, "nematic": nematic });
    // `</` would end the script that holds it
    let index = index.to_string().replace("</", "<\\/");
    let script = SCRIPT.join("\n");
    html.push_str(&format!(
        "<script type=\"application/json\" id=\"viewer-index\">{index}</script>\n<script>(function () {{\n'use strict';\n{script}}})();</script>\n"
    ));
    Ok(html)
}
