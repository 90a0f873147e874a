//! What is written of claims, and that the documentation holds all of them.

use super::*;
use crate::synthetic;
use std::path::Path;
use topo_lab::Preset;

#[test]
fn every_claim_is_looked_at_and_written() {
    let dir = tempfile::tempdir().unwrap();
    assert!(findings(dir.path()).unwrap().is_empty());
    synthetic::results(dir.path(), 14, &[-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0]);
    let elastic = findings(dir.path()).unwrap();
    assert_eq!(elastic.len(), elastic::CLAIMS.len());
    synthetic::nematic(dir.path());
    let all = findings(dir.path()).unwrap();
    assert!(all.len() >= 20, "{}", all.len());
    assert!(
        all.iter()
            .all(|f| !f.found.contains("NaN") && !f.found.contains("inf"))
    );
    write(dir.path(), Preset::Draft, &all).unwrap();
    let text = std::fs::read_to_string(dir.path().join("reproduction.md")).unwrap();
    let rows: Vec<&str> = text.lines().filter(|l| l.starts_with('|')).collect();
    assert_eq!(rows.len(), all.len() + 2);
    assert!(
        rows.iter()
            .all(|r| r.replace("\\|", "").matches('|').count() == 9)
    );
    let html = section(&all).into_string();
    assert_eq!(html.matches("<li value").count(), all.len());
    for f in &all {
        let names = crate::figures::ALL.iter().map(|f| f.name);
        let known: Vec<&str> = names
            .chain(crate::movies::ALL.iter().map(|m| m.name))
            .collect();
        assert!(known.contains(&f.figure), "{}", f.figure);
    }
}

#[test]
fn the_page_of_the_documentation_holds_every_claim() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/reproduction.md");
    let text = std::fs::read_to_string(page).unwrap();
    for claim in elastic::CLAIMS.iter().chain(&nematic::CLAIMS) {
        assert!(text.contains(claim.text), "the page lacks: {}", claim.text);
    }
    for verdict in ["**confirmed**", "**partly**"] {
        assert!(text.contains(verdict));
    }
}

#[test]
fn verdicts_follow_the_tables() {
    let dir = tempfile::tempdir().unwrap();
    synthetic::nematic(dir.path());
    let all = findings(dir.path()).unwrap();
    let of = |words: &str| {
        let f = all.iter().find(|f| f.claim.contains(words));
        f.unwrap_or_else(|| panic!("{words}")).verdict
    };
    // made up: monotonic energy, buckling at 6, times that grow behind it
    assert_eq!(of("free energy grows"), Verdict::Confirmed);
    assert_eq!(of("buckles at a critical"), Verdict::Partly);
    assert_eq!(of("half of the energy"), Verdict::Confirmed);
}
