//! The page, by itself and in a browser.

use crate::figures::{self, Context};
use crate::outside::Outside;
use crate::{gallery, provenance, reproduction, synthetic};
use std::path::{Path, PathBuf};
use std::process::Command;
use topo_lab::Preset;

/// Moves sliders, chooses another state and reads pixels back; what it finds becomes the title of the page.
const PROBE: &str = r#"<script>
window.problems = [];
window.addEventListener('error', (e) => window.problems.push(e.message));
window.addEventListener('load', () => {
  const report = {};
  const inked = (c) => {
    const flat = document.createElement('canvas');
    flat.width = c.width; flat.height = c.height;
    const g = flat.getContext('2d');
    g.drawImage(c, 0, 0);
    const p = g.getImageData(0, 0, c.width, c.height).data;
    let n = 0, sum = 0;
    for (let i = 0; i < p.length; i += 4) if (p[i + 3] > 128) { n++; sum += p[i] * (i % 977); }
    return [n, sum];
  };
  for (const name of ['elastic', 'nematic']) {
    const box = document.getElementById('viewer-' + name), canvas = box.querySelector('canvas');
    const slider = box.querySelector('input[type=range]'), out = box.querySelector('output');
    const before = [inked(canvas), out.textContent];
    slider.value = slider.max;
    slider.dispatchEvent(new Event('input'));
    const after = [inked(canvas), out.textContent];
    const state = box.dataset.state;
    if (name === 'elastic') {
      const b = box.querySelector('button[aria-pressed=true]');
      b.dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowRight', bubbles: true }));
    } else {
      const s = box.querySelector('select');
      s.value = 0; s.dispatchEvent(new Event('change'));
    }
    report[name] = { ready: box.dataset.ready, pixels: before[0][0], moved: before[0][1] !== after[0][1] && before[1] !== after[1], chosen: state !== box.dataset.state, wide: document.documentElement.scrollWidth <= window.innerWidth };
  }
  report.problems = window.problems;
  document.title = 'REPORT' + JSON.stringify(report);
});
</script>"#;

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
    let text = std::fs::read_to_string(folder.join("index.html")).unwrap();
    let probed = folder.join("probed.html");
    std::fs::write(&probed, text.replace("</head>", &format!("{PROBE}</head>"))).unwrap();
    probed
}

#[test]
fn the_page_loads_nothing_from_the_network() {
    let dir = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(page(dir.path())).unwrap();
    assert!(text.contains("viewer-elastic") && text.contains("viewer-nematic"));
    assert!(!text.contains("src=\"http") && !text.contains("href=\"http"));
}

#[test]
#[ignore = "needs Chromium: `cargo xtask test` runs it where there is one"]
fn browser_the_viewer_turns_slides_and_chooses() {
    let needs = Outside::Browser.needs();
    let browser = Outside::Browser.find().expect(needs);
    let dir = tempfile::tempdir().unwrap();
    let page = page(dir.path());
    for size in ["1200,900", "500,900"] {
        let output = Command::new(&browser)
            .args(["--headless", "--no-sandbox", "--disable-dev-shm-usage"])
            .args(["--use-gl=angle", "--use-angle=swiftshader"])
            .args(["--enable-unsafe-swiftshader", "--virtual-time-budget=8000"])
            .arg(format!("--window-size={size}"))
            .arg(format!(
                "--user-data-dir={}",
                dir.path().join("profile").display()
            ))
            .arg("--dump-dom")
            .arg(format!("file://{}", page.display()))
            .output()
            .unwrap();
        let dom = String::from_utf8_lossy(&output.stdout).into_owned();
        let report = dom
            .split_once("<title>REPORT")
            .and_then(|t| t.1.split_once("</title>"))
            .unwrap_or_else(|| panic!("{}", String::from_utf8_lossy(&output.stderr)))
            .0
            .replace("&quot;", "\"");
        let report: serde_json::Value = serde_json::from_str(&report).unwrap();
        assert_eq!(report["problems"], serde_json::json!([]), "{report}");
        for battery in ["elastic", "nematic"] {
            let t = &report[battery];
            assert!(
                t["ready"] == "yes"
                    && t["moved"] == true
                    && t["chosen"] == true
                    && t["wide"] == true,
                "{size}: {report}"
            );
            assert!(t["pixels"].as_u64().unwrap() > 5000, "{report}");
        }
    }
}

#[test]
fn a_page_without_results_has_no_viewer() {
    let dir = tempfile::tempdir().unwrap();
    assert_eq!(super::sections(dir.path()).unwrap(), "");
}
