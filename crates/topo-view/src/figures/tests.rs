//! Every figure drawn from artificial results.

use super::*;
use crate::{gallery, provenance, reproduction, scenes, synthetic};
use topo_lab::Preset;

fn context(results: &Path) -> Context<'_> {
    Context {
        results,
        quality: Preset::Draft,
        detail: 0.15,
        struts: false,
    }
}

#[test]
fn struts_of_tight_knots_are_drawn_on_demand() {
    let dir = tempfile::tempdir().unwrap();
    synthetic::results(dir.path(), 2, &[0.0]);
    let plain = context(dir.path());
    let with_struts = Context {
        struts: true,
        ..plain
    };
    for name in ["knots-table", "links-table"] {
        let figure = *ALL.iter().find(|f| f.name == name).unwrap();
        let [a, b] = [plain, with_struts].map(|c| draw(figure, &c).unwrap().preview);
        assert_ne!(a, b, "{name}");
    }
}

/// The files of a figure: all there, every row with all columns, every sign in the font, the quality said.
fn check_files(results: &Path, name: &str) {
    let file = |extension: &str| results.join(format!("figures/{name}.{extension}"));
    for extension in ["svg", "png", "csv"] {
        assert!(std::fs::metadata(file(extension)).unwrap().len() > 200);
    }
    let csv = std::fs::read_to_string(file("csv")).unwrap();
    let n_columns = csv.lines().next().unwrap().split(',').count();
    assert!(csv.lines().all(|l| l.split(',').count() == n_columns));
    let svg = std::fs::read_to_string(file("svg")).unwrap();
    let missing = missing_glyphs(&svg);
    assert!(missing.is_empty(), "{missing:?}");
    assert!(
        svg.contains("Draft quality"),
        "{name} does not say its quality"
    );
}

#[test]
fn every_figure_is_drawn_with_its_files_and_shown_in_the_gallery() {
    let dir = tempfile::tempdir().unwrap();
    synthetic::results(dir.path(), 14, &[-2.0, -1.0, 0.0, 1.0, 2.0]);
    synthetic::nematic(dir.path());
    let mut done = Vec::new();
    for figure in ALL {
        let d = draw(figure, &context(dir.path())).unwrap();
        assert!(
            !d.finding.is_empty() && d.preview.starts_with(b"\x89PNG"),
            "{}",
            figure.name
        );
        check_files(dir.path(), figure.name);
        done.push(d);
    }
    let mut p =
        provenance::Provenance::collect(Some(Path::new(env!("CARGO_MANIFEST_DIR"))), Preset::Draft);
    p.drew(&done);
    p.warn(&"slow; slow".into());
    p.write(dir.path()).unwrap();
    let claims = reproduction::findings(dir.path()).unwrap();
    scenes::write(dir.path(), Preset::Draft).unwrap();
    let page = gallery::Page {
        done: &done.iter().collect::<Vec<_>>(),
        movies: &[],
        claims: &claims,
        quality: Preset::Draft,
        provenance: &p,
    };
    gallery::write(dir.path(), &page).unwrap();
    let again = kept(ALL[0], dir.path(), done[0].finding.clone()).unwrap();
    assert!(again.preview == done[0].preview);
    let found = provenance::earlier_findings(dir.path());
    assert!(
        ALL.iter()
            .zip(&done)
            .all(|(f, d)| found[f.name] == d.finding)
    );
    let page = std::fs::read_to_string(dir.path().join("index.html")).unwrap();
    for figure in ALL {
        assert!(page.contains(&format!("id=\"{}\"", figure.name)));
    }
    assert!(page.contains("slow (2)") && page.contains("id=\"claims\""));
    assert!(page.contains("scenes/elastic.toml") && page.contains("scenes/nematic.toml"));
    assert!(!page.contains("src=\"http") && !page.contains("href=\"http"));
}

/// Characters of the labels that the shipped faces draw as their box for the unknown.
fn missing_glyphs(svg: &str) -> Vec<char> {
    let spans = svg.split("<tspan").skip(1);
    let shown = spans.filter_map(|s| s.split_once('>')?.1.split_once('<').map(|t| t.0));
    let mut chars: Vec<char> = shown
        .flat_map(str::chars)
        .filter(|c| !c.is_ascii())
        .collect();
    chars.sort_unstable();
    chars.dedup();
    let drawn = |c: char| {
        let svg = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="30" height="30"><text x="5" y="20" font-size="16">{c}</text></svg>"#
        );
        crate::plot::render::pixels(&svg, 1.0).unwrap().take()
    };
    let unknown = drawn('\u{e123}');
    chars.retain(|c| drawn(*c) == unknown);
    chars
}

#[test]
fn an_unknown_character_would_be_noticed() {
    assert_eq!(missing_glyphs("<tspan>θ ℰ −</tspan>"), ['ℰ']);
}

#[test]
fn drawing_twice_gives_the_same_bytes() {
    let draw_one = || {
        let dir = tempfile::tempdir().unwrap();
        synthetic::results(dir.path(), 3, &[-1.0, 0.0, 1.0]);
        draw(ALL[0], &context(dir.path())).unwrap().preview
    };
    assert!(draw_one() == draw_one());
}

#[test]
fn one_state_is_enough() {
    let dir = tempfile::tempdir().unwrap();
    synthetic::results(dir.path(), 2, &[0.0]);
    synthetic::nematic(dir.path());
    for figure in ALL {
        draw(figure, &context(dir.path())).unwrap();
    }
}

#[test]
fn missing_results_and_unknown_names_are_reported() {
    let dir = tempfile::tempdir().unwrap();
    let e = draw(ALL[0], &context(dir.path())).unwrap_err();
    assert!(e.to_string().contains("sweep.csv"));
    let e = chosen(&["elastic-discharging".to_owned()]).unwrap_err();
    assert!(
        e.to_string().contains("elastic-discharge,") && matches!(e, ViewError::Argument { .. })
    );
    let (figures, movies) = chosen(&["knots-table".to_owned()]).unwrap();
    assert_eq!((figures.len(), movies.len()), (1, 0));
    let (figures, movies) = chosen(&["movie-elastic".to_owned()]).unwrap();
    assert_eq!((figures.len(), movies.len()), (0, 1));
}

/// Draws artificial results at full detail into the folder that `TOPO_LOOK` names.
#[test]
#[ignore = "for looking at, not for checking"]
fn look() {
    let Ok(folder) = std::env::var("TOPO_LOOK") else {
        return;
    };
    let twists: Vec<f64> = (0..17).map(|k| -2.0 + 0.25 * k as f64).collect();
    let results = Path::new(&folder);
    if std::env::var_os("TOPO_LOOK_REAL").is_none() {
        synthetic::results(results, 14, &twists);
        synthetic::nematic(results);
    }
    let full = Context {
        detail: 1.0,
        ..context(results)
    };
    let done: Vec<Done> = ALL.iter().map(|f| draw(*f, &full).unwrap()).collect();
    let mut p =
        provenance::Provenance::collect(Some(Path::new(env!("CARGO_MANIFEST_DIR"))), Preset::Draft);
    p.drew(&done);
    p.write(results).unwrap();
    let page = gallery::Page {
        done: &done.iter().collect::<Vec<_>>(),
        movies: &[],
        claims: &reproduction::findings(results).unwrap(),
        quality: Preset::Draft,
        provenance: &p,
    };
    gallery::write(results, &page).unwrap();
}
