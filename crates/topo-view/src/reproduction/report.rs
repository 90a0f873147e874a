//! The findings as tables and as a section of the gallery.

use super::claim::Verdict;
use super::{Finding, friction};
use crate::data;
use crate::error::ViewError;
use maud::{Markup, html};
use std::fmt::Write as _;
use std::path::Path;
use topo_analysis::write_table;
use topo_lab::Preset;

/// Writes `reproduction.json` and `reproduction.md` into the results folder, and `friction-study.csv` where that study was run.
pub fn write(results: &Path, quality: Preset, findings: &[Finding]) -> Result<(), ViewError> {
    let mut json = serde_json::to_string_pretty(&serde_json::json!({
        "quality": quality,
        "findings": findings,
    }))
    .map_err(|e| ViewError::Drawing {
        reason: format!("reproduction: {e}"),
    })?;
    json.push('\n');
    data::write(&results.join("reproduction.json"), json.as_bytes())?;
    let study = friction::study(results)?;
    if !study.is_empty() {
        write_table(&results.join("friction-study.csv"), &study)?;
    }
    let text = markdown(quality, findings) + &friction::markdown(&study);
    data::write(&results.join("reproduction.md"), text.as_bytes())
}

/// How many of each verdict, in words.
fn summary(findings: &[Finding]) -> String {
    let count = |v: Verdict| findings.iter().filter(|f| f.verdict == v).count();
    let mut text = format!(
        "{} claims looked at: {} confirmed, {} partly, {} not confirmed",
        findings.len(),
        count(Verdict::Confirmed),
        count(Verdict::Partly),
        count(Verdict::NotConfirmed)
    );
    let open = count(Verdict::NotJudged);
    if open > 0 {
        // writing to a string cannot fail
        let _ = write!(text, ", {open} not judged");
    }
    text
}

/// What was found, in both readings where there are two, and what casts doubt on it.
fn said(f: &Finding) -> String {
    let mut text = f.found.clone();
    if let Some(other) = &f.other_reading {
        // writing to a string cannot fail
        let _ = write!(
            text,
            ". {}: {} ({})",
            other.reading,
            other.found,
            other.verdict.words()
        );
    }
    if let Some(doubt) = &f.doubt {
        let _ = write!(text, ". In doubt: {doubt}");
    }
    text
}

fn markdown(quality: Preset, findings: &[Finding]) -> String {
    let mut text = format!(
        "{quality} quality. {}.\n\n| | claim | published in | found here | outcome | decided by | seen in | depends on |\n|---|---|---|---|---|---|---|---|\n",
        summary(findings)
    );
    for f in findings {
        // writing to a string cannot fail
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | **{}** | {} | `{}` | {} |",
            f.number,
            f.claim,
            f.published,
            said(f).replace('|', "\\|"),
            f.verdict.words(),
            f.rule.replace('|', "\\|"),
            f.figure,
            f.depends_on
        );
    }
    text
}

/// The claims for the gallery, readable on a narrow screen.
pub fn section(findings: &[Finding]) -> Markup {
    if findings.is_empty() {
        return html! {};
    }
    html! {
        section id="claims" {
            h2 { "Claim by claim" }
            p {
                (summary(findings)) ". The numbers are read from the tables beside this page ("
                a href="reproduction.md" { "as a table" } ", " a href="reproduction.json" { "as JSON" } ")."
            }
            ol.claims {
                @for f in findings {
                    li value=(f.number) {
                        p {
                            b class=(f.verdict.words().replace(' ', "-")) { (f.verdict.words()) } " " (f.claim) " "
                            span.files { "(" (f.published) ")" }
                        }
                        p { (said(f)) }
                        p.files {
                            "Decided by: " (f.rule) ". Seen in " a href={ "#" (f.figure) } { (f.figure) } ". Depends on: "
                            (f.depends_on) "."
                        }
                    }
                }
            }
        }
    }
}
