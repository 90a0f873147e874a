//! The page with movies: what is loaded at once, and what when it is asked for.

use super::*;
use crate::browser::{Browser, SEND, address};
use crate::synthetic;

/// A folder with the 238 states of the published sweep and a movie, and its page.
fn whole(folder: &Path) -> String {
    let twists: Vec<f64> = (-8..=8).map(|k| 0.25 * f64::from(k)).collect();
    synthetic::results(folder, 14, &twists);
    synthetic::nematic(folder);
    let movie = movies::ALL[0];
    let size = movies::SIZE;
    let frames = [0, 120, 255].map(|grey| vec![grey; (3 * size.width * size.height) as usize]);
    let bytes = movies::encode(size, 10, &frames).unwrap();
    data::write(&folder.join(format!("figures/{}.png", movie.name)), &bytes).unwrap();
    let provenance = Provenance::collect(None, Preset::Draft);
    let shown = Page {
        done: &[],
        movies: &[(movie, "A finding.".to_owned())],
        claims: &[],
        quality: Preset::Draft,
        provenance: &provenance,
    };
    write(folder, &shown).unwrap();
    std::fs::read_to_string(folder.join("index.html")).unwrap()
}

#[test]
fn what_comes_before_the_first_picture_is_small() {
    let dir = tempfile::tempdir().unwrap();
    let page = whole(dir.path());
    assert_eq!(page.matches("\"shade\"").count(), 238);
    // nothing beside the page is waited for: no script, no style sheet, and pictures as they are reached
    assert!(!page.contains("<script src") && !page.contains("<link") && !page.contains("@import"));
    assert_eq!(
        page.matches("<img").count(),
        page.matches("loading=\"lazy\"").count()
    );
    // besides fonts: the scripts, and three numbers for each state
    let n_fonts = font::style().len();
    assert!(n_fonts < 420_000, "{n_fonts} bytes");
    let n_others = page.len() - n_fonts;
    assert!(n_others < 60_000, "{n_others} bytes");
}

#[test]
#[ignore = "needs Chromium: `cargo xtask test` runs it where there is one"]
fn browser_a_movie_plays_when_asked_and_stops() {
    let dir = tempfile::tempdir().unwrap();
    let page = whole(dir.path());
    let probe = format!(
        "<script>addEventListener('load', async () => {{
        const box = document.querySelector('.movie'), image = box.querySelector('img'), button = box.querySelector('button');
        const report = {{ steps: [] }};
        const look = async () => {{
            if (!image.complete || !image.naturalWidth) await new Promise(done => image.addEventListener('load', done, {{ once: true }}));
            report.steps.push([image.src.split('/figures/')[1], button.textContent, image.naturalWidth]);
        }};
        box.scrollIntoView();
        await look();
        button.click(); await look();
        button.click(); await look();
        image.click(); await look();
        {SEND}
        }});</script></head>"
    );
    let file = dir.path().join("probed.html");
    std::fs::write(&file, page.replace("</head>", &probe)).unwrap();
    let report = Browser::start().report(&address(&file), [800, 600]);
    let still = serde_json::json!(["preview/movie-elastic.png", "Play", movies::SIZE.width]);
    let plays = serde_json::json!(["movie-elastic.png", "Stop", movies::SIZE.width]);
    let steps = serde_json::json!([still, plays, still, plays]);
    assert_eq!(report["steps"], steps, "{report}");
}
