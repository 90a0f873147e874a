//! What the published work claims, and what the tables of a results folder say to each claim.

mod elastic;
mod nematic;

use crate::data::{self, Cut, NematicSweep, Sweep, read_csv};
use crate::error::XtaskError;
use crate::figures::Quality;
use crate::plot::text::escape;
use serde::Serialize;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// How far a claim is borne out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// As claimed.
    Confirmed,
    /// In part, or only under some readings.
    Partly,
    /// Not as claimed.
    NotConfirmed,
}

impl Verdict {
    fn words(self) -> &'static str {
        match self {
            Self::Confirmed => "confirmed",
            Self::Partly => "partly",
            Self::NotConfirmed => "not confirmed",
        }
    }

    /// Confirmed when it holds, else not.
    fn when(holds: bool) -> Self {
        if holds {
            Self::Confirmed
        } else {
            Self::NotConfirmed
        }
    }

    /// Confirmed when all hold, in part when one does.
    fn both(a: bool, b: bool) -> Self {
        match (a, b) {
            (true, true) => Self::Confirmed,
            (false, false) => Self::NotConfirmed,
            _ => Self::Partly,
        }
    }
}

/// What the tables say.
type Said = Option<(String, Verdict)>;

/// One claim.
struct Claim {
    /// In our words.
    text: &'static str,
    /// Where it is made.
    published: &'static str,
    /// Our figure that shows it.
    figure: &'static str,
    /// What the outcome depends on.
    depends: &'static str,
    /// What the tables say; `None` where they lack what is needed.
    look: fn(&Tables) -> Said,
}

/// What is looked at.
struct Tables {
    results: PathBuf,
    elastic: Option<Sweep>,
    /// Untwisted cases under other choices of friction: the name of the choice and its rows.
    variants: Vec<(&'static str, Vec<Cut>)>,
    nematic: Option<NematicSweep>,
}

/// A claim with what was found.
#[derive(Debug, Serialize)]
pub struct Finding {
    claim: &'static str,
    published: &'static str,
    figure: &'static str,
    found: String,
    verdict: Verdict,
    depends_on: &'static str,
}

/// All claims that the tables of a results folder can say something to.
pub fn findings(results: &Path) -> Result<Vec<Finding>, XtaskError> {
    let there = |r: Result<_, XtaskError>| match r {
        Err(XtaskError::Missing { .. }) => Ok(None),
        other => other.map(Some),
    };
    let mut variants = Vec::new();
    for (name, folder) in [
        (
            "friction range of the contact diameter",
            "elastic-contact-range",
        ),
        ("reading “tight”", "elastic-tight"),
    ] {
        if let Ok(rows) = read_csv::<Cut>(&results.join(folder).join("sweep.csv")) {
            variants.push((name, rows));
        }
    }
    let tables = Tables {
        results: results.to_owned(),
        elastic: there(Sweep::read(results))?,
        variants,
        nematic: match NematicSweep::read(results) {
            Err(XtaskError::Missing { .. }) => None,
            other => Some(other?),
        },
    };
    let said = |c: &Claim| {
        let (found, verdict) = (c.look)(&tables)?;
        Some(Finding {
            claim: c.text,
            published: c.published,
            figure: c.figure,
            found,
            verdict,
            depends_on: c.depends,
        })
    };
    let all = elastic::CLAIMS.iter().chain(&nematic::CLAIMS);
    Ok(all.filter_map(said).collect())
}

/// Writes `reproduction.json` and `reproduction.md` into the results folder.
pub fn write(results: &Path, quality: Quality, findings: &[Finding]) -> Result<(), XtaskError> {
    let mut json = serde_json::to_string_pretty(&serde_json::json!({
        "quality": quality,
        "findings": findings,
    }))
    .map_err(|e| XtaskError::Drawing {
        reason: format!("reproduction: {e}"),
    })?;
    json.push('\n');
    data::write(&results.join("reproduction.json"), json.as_bytes())?;
    data::write(
        &results.join("reproduction.md"),
        markdown(quality, findings).as_bytes(),
    )
}

/// How many of each verdict, in words.
fn summary(findings: &[Finding]) -> String {
    let count = |v: Verdict| findings.iter().filter(|f| f.verdict == v).count();
    format!(
        "{} claims looked at: {} confirmed, {} partly, {} not confirmed",
        findings.len(),
        count(Verdict::Confirmed),
        count(Verdict::Partly),
        count(Verdict::NotConfirmed)
    )
}

fn markdown(quality: Quality, findings: &[Finding]) -> String {
    let mut text = format!(
        "{quality} quality. {}.\n\n| | claim | published in | found here | outcome | seen in | depends on |\n|---|---|---|---|---|---|---|\n",
        summary(findings)
    );
    for (k, f) in findings.iter().enumerate() {
        // writing to a string cannot fail
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | **{}** | `{}` | {} |",
            k + 1,
            f.claim,
            f.published,
            f.found.replace('|', "\\|"),
            f.verdict.words(),
            f.figure,
            f.depends_on
        );
    }
    text
}

/// The claims for the gallery, readable on a narrow screen.
pub fn section(findings: &[Finding]) -> String {
    if findings.is_empty() {
        return String::new();
    }
    let mut html = format!(
        "<section id=\"claims\"><h2>Claim by claim</h2><p>{}. The numbers are read from the tables beside this page \
         (<a href=\"reproduction.md\">as a table</a>, <a href=\"reproduction.json\">as JSON</a>).</p><ol class=\"claims\">",
        summary(findings)
    );
    for f in findings {
        let _ = write!(
            html,
            "<li><p><b class=\"{class}\">{verdict}</b> {claim} <span class=\"files\">({published})</span></p>\
             <p>{found}</p><p class=\"files\">Seen in <a href=\"#{figure}\">{figure}</a>. Depends on: {depends}.</p></li>",
            class = f.verdict.words().replace(' ', "-"),
            verdict = f.verdict.words(),
            claim = escape(f.claim),
            published = escape(f.published),
            found = escape(&f.found),
            figure = f.figure,
            depends = escape(f.depends_on),
        );
    }
    html.push_str("</ol></section>\n");
    html
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic;

    #[test]
    fn every_claim_is_looked_at_and_written() {
        let dir = tempfile::tempdir().unwrap();
        assert!(findings(dir.path()).unwrap().is_empty());
        synthetic::results(dir.path(), 14, &[-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0]);
        let elastic = findings(dir.path()).unwrap();
        assert!(elastic.len() >= elastic::CLAIMS.len() - 1, "{elastic:?}");
        synthetic::nematic(dir.path());
        let all = findings(dir.path()).unwrap();
        assert!(all.len() >= 20, "{}", all.len());
        assert!(
            all.iter()
                .all(|f| !f.found.contains("NaN") && !f.found.contains("inf"))
        );
        write(dir.path(), Quality::Draft, &all).unwrap();
        let text = std::fs::read_to_string(dir.path().join("reproduction.md")).unwrap();
        let rows: Vec<&str> = text.lines().filter(|l| l.starts_with('|')).collect();
        assert_eq!(rows.len(), all.len() + 2);
        assert!(
            rows.iter()
                .all(|r| r.replace("\\|", "").matches('|').count() == 8)
        );
        let html = section(&all);
        assert_eq!(html.matches("<li>").count(), all.len());
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
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/reproduction.md");
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
}
