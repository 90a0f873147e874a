//! The page, by itself and in a browser.

use crate::browser::{Browser, SEND, address};
use crate::figures::{self, Context};
use crate::{gallery, provenance, reproduction, synthetic};
use std::path::{Path, PathBuf};
use topo_lab::Preset;

/// What the probes of the page share: waiting until a viewer shows a state, and the ink of its picture.
const COMMON: &str = r#"
window.problems = [];
addEventListener('error', (e) => window.problems.push(e.message || 'not loaded: ' + (e.target.src || e.target)), true);
const pause = (ms) => new Promise((go) => setTimeout(go, ms));
const shown = async (name) => {
  const box = document.getElementById('viewer-' + name);
  for (let k = 0; k < 100 && !(box.dataset.ready && box.dataset.state); k++) await pause(50);
  return box;
};
// pixels with ink, a sum that tells pictures apart, and how many of the pixels at the rim have ink
const ink = (c) => {
  const flat = document.createElement('canvas');
  flat.width = c.width; flat.height = c.height;
  const g = flat.getContext('2d');
  g.drawImage(c, 0, 0);
  const p = g.getImageData(0, 0, c.width, c.height).data;
  let n = 0, sum = 0, rim = 0;
  for (let i = 0; i < p.length; i += 4) if (p[i + 3] > 128) {
    const x = i / 4 % c.width, y = Math.floor(i / 4 / c.width);
    n++; sum += p[i] * (i % 977);
    if (x === 0 || y === 0 || x === c.width - 1 || y === c.height - 1) rim++;
  }
  return { n: n / (c.width * c.height), sum, rim };
};
"#;

/// Scrolls to both viewers, moves sliders, chooses other states, plays, and turns the wheel.
const HANDS: &str = r#"
const report = {};
for (const name of ['elastic', 'nematic']) {
  document.getElementById('viewer-' + name).scrollIntoView();
  const box = await shown(name), canvas = box.querySelector('canvas'), stage = box.querySelector('.stage');
  const slider = box.querySelector('input[type=range]'), out = box.querySelector('output');
  const frames = [];
  for (let k = 0; k <= +slider.max; k++) {
    slider.value = k;
    slider.dispatchEvent(new Event('input'));
    frames.push({ ...ink(canvas), time: out.textContent });
  }
  const wheel = () => {
    const e = new WheelEvent('wheel', { deltaY: 100, bubbles: true, cancelable: true });
    canvas.dispatchEvent(e);
    return e.defaultPrevented;
  };
  const outside = wheel();
  stage.focus();
  const inside = wheel();
  stage.blur();
  const play = box.querySelector('button.play');
  play.click();
  const begun = +slider.value;
  await pause(1200);
  const played = +slider.value - begun;
  play.click();
  const rested = +slider.value;
  await pause(1000);
  const paused = +slider.value === rested;
  const state = box.dataset.state;
  if (name === 'elastic') {
    const b = box.querySelector('button[aria-pressed=true][data-i]');
    b.dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowRight', bubbles: true }));
  } else {
    const s = box.querySelector('select');
    s.value = 0; s.dispatchEvent(new Event('change'));
  }
  for (let k = 0; k < 100 && box.dataset.state === state; k++) await pause(50);
  report[name] = {
    ready: box.dataset.ready, frames, outside, inside, played, paused, chosen: state !== box.dataset.state,
    address: location.hash, link: box.querySelector('a.state').getAttribute('href'),
    bars: [...box.querySelectorAll('.bar')].map((b) => b.innerText), ruler: box.querySelector('.ruler').textContent,
  };
}
report.wide = document.documentElement.scrollWidth - window.innerWidth;
report.problems = window.problems;
"#;

/// Says which state an address shows.
const ADDRESSED: &str = r#"
const box = await shown('elastic'), at = box.getBoundingClientRect();
const report = {
  state: box.dataset.state, frame: box.querySelector('input[type=range]').value, said: box.querySelector('.said').textContent,
  seen: at.top < innerHeight && at.bottom > 0, problems: window.problems,
};
"#;

/// The page with a script that runs once it is loaded.
fn probed(page: &Path, probe: &str) -> PathBuf {
    let text = std::fs::read_to_string(page).unwrap();
    let script = format!(
        "<script>{COMMON}addEventListener('load', async () => {{ {probe} {SEND} }});</script></head>"
    );
    let file = page.with_file_name("probed.html");
    std::fs::write(&file, text.replace("</head>", &script)).unwrap();
    file
}

fn page(folder: &Path) -> PathBuf {
    synthetic::results(folder, 3, &[-1.0, 0.0, 1.0]);
    synthetic::nematic(folder);
    let context = Context {
        results: folder,
        quality: Preset::Draft,
        detail: 0.15,
        struts: false,
    };
    let done = figures::draw(figures::ALL[0], &context).unwrap();
    let p =
        provenance::Provenance::collect(Some(Path::new(env!("CARGO_MANIFEST_DIR"))), Preset::Draft);
    let claims = reproduction::findings(folder).unwrap();
    let shown = gallery::Page {
        done: &[&done],
        movies: &[],
        claims: &claims,
        quality: Preset::Draft,
        provenance: &p,
    };
    gallery::write(folder, &shown).unwrap();
    folder.join("index.html")
}

#[test]
fn the_page_is_small_and_loads_nothing_from_the_network() {
    let dir = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(page(dir.path())).unwrap();
    assert!(text.contains("viewer-elastic") && text.contains("viewer-nematic"));
    assert!(!text.contains("src=\"http") && !text.contains("href=\"http"));
    // shapes and three.js lie beside it
    assert!(!text.contains("\"xyz\"") && !text.contains("WebGLShader"));
    for file in ["three", "elastic/3_1", "elastic/5_1", "nematic/q04"] {
        let path = dir.path().join(format!("viewer/{file}.js"));
        assert!(
            std::fs::metadata(&path).is_ok_and(|m| m.len() > 10_000),
            "{file}"
        );
    }
}

#[test]
#[ignore = "needs Chromium: `cargo xtask test` runs it where there is one"]
fn browser_the_viewer_turns_slides_plays_and_chooses() {
    let dir = tempfile::tempdir().unwrap();
    let page = probed(&page(dir.path()), HANDS);
    let browser = Browser::start();
    for size in [[1280, 800], [390, 844]] {
        let report = browser.report(&address(&page), size);
        assert_eq!(report["problems"], serde_json::json!([]), "{report}");
        assert!(report["wide"].as_i64().unwrap() <= 0, "{size:?}: {report}");
        for (battery, least, link) in [("elastic", 0.01, "#3_1,+1"), ("nematic", 0.05, "#q=1")] {
            let t = &report[battery];
            let is = |key: &str, value: bool| t[key] == value;
            assert!(
                t["ready"] == "yes" && is("chosen", true) && is("paused", true),
                "{size:?}: {t}"
            );
            assert!(t["played"].as_i64().unwrap() >= 1, "{size:?}: {t}");
            // the wheel belongs to the page until the stage has the focus
            assert!(is("outside", false) && is("inside", true), "{size:?}: {t}");
            assert!(t["link"] == link && t["address"] == link, "{t}");
            let bars = t["bars"].to_string();
            assert!(
                bars.contains(if battery == "elastic" {
                    "Energy density"
                } else {
                    "twisted"
                }),
                "{bars}"
            );
            assert_ne!(t["ruler"], "", "{t}");
            let frames = t["frames"].as_array().unwrap();
            // the artificial colloid does not change after its ring is gone
            let n_moving = if battery == "elastic" { 11 } else { 3 };
            for pair in frames[..n_moving].windows(2) {
                assert!(
                    pair[0]["sum"] != pair[1]["sum"] && pair[0]["time"] != pair[1]["time"],
                    "{t}"
                );
            }
            for (k, f) in frames.iter().enumerate() {
                // everything is in the picture, and large enough to be seen
                assert!(
                    f["n"].as_f64().unwrap() > least,
                    "{size:?} {battery} {k}: {f}"
                );
                assert!(
                    battery == "nematic" || f["rim"] == 0,
                    "{size:?} {battery} {k}: {f}"
                );
            }
        }
    }
}

#[test]
#[ignore = "needs Chromium: `cargo xtask test` runs it where there is one"]
fn browser_an_address_names_a_state() {
    let dir = tempfile::tempdir().unwrap();
    let page = probed(&page(dir.path()), ADDRESSED);
    let browser = Browser::start();
    let report = |hash: &str| browser.report(&format!("{}#{hash}", address(&page)), [390, 844]);
    let found = report("4_1,-1,3");
    assert!(
        found["state"] == "1,0" && found["frame"] == "3" && found["seen"] == true,
        "{found}"
    );
    assert!(
        found["said"].as_str().unwrap().starts_with("4₁, θ′h = −1"),
        "{found}"
    );
    assert_eq!(found["problems"], serde_json::json!([]), "{found}");
    // no such state: the first one
    assert_eq!(report("9_9,+7")["state"], "0,1");
    std::fs::remove_file(dir.path().join("viewer/elastic/4_1.js")).unwrap();
    let found = report("4_1,+1");
    let said = found["said"].as_str().unwrap();
    assert!(
        said.contains("viewer/elastic/4_1.js is not beside this page"),
        "{found}"
    );
}

#[test]
fn a_page_without_results_has_no_viewer() {
    let dir = tempfile::tempdir().unwrap();
    assert_eq!(super::sections(dir.path()).unwrap(), "");
}
