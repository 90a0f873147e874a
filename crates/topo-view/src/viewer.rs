//! The interactive part of the gallery: charged states and their discharge in three dimensions, in one page without a network.

mod bytes;
mod elastic;
mod nematic;
#[cfg(test)]
mod tests;

use crate::error::ViewError;
use crate::plot::color::Scale;
use serde_json::json;
use std::path::Path;

const THREE: &str = include_str!("../assets/three/three.min.js");
const SCRIPT: &str = include_str!("../assets/viewer/viewer.js");

/// Style sheet of the viewer, for the head of the page.
pub const STYLE: &str = include_str!("../assets/viewer/viewer.css");

const ELASTIC: &str = r#"<section id="view-elastic"><h2>Every charged knot, in the hand</h2>
<div class="viewer" id="viewer-elastic">
<div class="stage" tabindex="0" role="img" aria-label="Charged knot in three dimensions; arrow keys turn it"><div class="told"></div></div>
<div class="controls"><button type="button" class="play">Play</button><label>Discharge <input type="range" min="0" max="1" step="1" value="0" aria-label="Time of the discharge"></label><output></output></div>
<div class="scroll"><table class="states" aria-label="Knots by twist, coloured by stored energy"></table></div>
</div>
<p>Choose knot (row) and twist density θ′h (column); drag or use the arrow keys to turn, the slider to follow the discharge. States are coloured by stored energy, fibres by energy density, from dark (low) to bright (high).</p></section>
"#;

const NEMATIC: &str = r#"<section id="view-nematic"><h2>The colloid and its defect ring, in the hand</h2>
<div class="viewer" id="viewer-nematic">
<div class="stage" tabindex="0" role="img" aria-label="Colloid with defect ring in three dimensions; arrow keys turn it"><div class="told"></div></div>
<div class="controls"><label>Charge <select aria-label="Topological charge"></select></label><button type="button" class="play">Play</button><label>Discharge <input type="range" min="0" max="1" step="1" value="0" aria-label="Time of the discharge"></label><output></output></div>
</div>
<p>Green rods: the director in the plane through the centre. The ring is coloured by its cross-section, from +½ (dark) over twisted to −½ (bright); the particle by the x component of its anchoring while that is on.</p></section>
"#;

/// Sections with the viewers and their script, of what the results folder holds; empty if it holds neither.
pub fn sections(results: &Path) -> Result<String, ViewError> {
    let elastic = elastic::data(results)?;
    let nematic = nematic::data(results)?;
    if elastic.is_none() && nematic.is_none() {
        return Ok(String::new());
    }
    let scale = Scale::viridis(0.0, 255.0);
    let viridis: Vec<[u8; 3]> = (0..256).map(|i| scale.rgb(f64::from(i))).collect();
    let mut html = String::new();
    if elastic.is_some() {
        html.push_str(ELASTIC);
    }
    if nematic.is_some() {
        html.push_str(NEMATIC);
    }
    let data = json!({ "viridis": viridis, "elastic": elastic, "nematic": nematic });
    // `</` would end the script that holds the data
    let data = data.to_string().replace("</", "<\\/");
    html.push_str(&format!(
        "<script type=\"application/json\" id=\"viewer-data\">{data}</script>\n<script>{THREE}</script>\n<script>{SCRIPT}</script>\n"
    ));
    Ok(html)
}
