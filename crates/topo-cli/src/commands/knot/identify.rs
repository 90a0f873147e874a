//! `topo knot identify`: the type of a curve in a file.

mod report;
#[cfg(test)]
mod tests;

use crate::cli::IdentifyArgs;
use crate::error::CliError;
use crate::output;
use crate::progress::waiting;
use report::{Component, Finding, Frame, LinkFinding, Report};
use std::fmt::Write as _;
use std::process::ExitCode;
use topo_knots::{
    CurveComponent, CurveFile, CurveFrame, FrameChoice, Handedness, KnotError, KnotTable,
    LinkTable, LinkType, V, identify, identify_link, identify_open,
};

/// Exit code where several types fit, or one that is not proved.
const NOT_CERTAIN: u8 = 3;

/// Names what the file holds. With `--json` the keys of the report also stand beside those of every command.
pub(super) fn run(args: &IdentifyArgs, table: &KnotTable) -> Result<ExitCode, CliError> {
    let (report, text) = waiting("naming the curve", || look(args, table))?;
    report
        .warnings
        .iter()
        .for_each(|w| output::warning(w.as_str()));
    let finding = serde_json::to_value(&report).map_err(|e| CliError::Step(e.to_string()))?;
    output::beside(&finding);
    output::data("finding", finding);
    super::print(&text);
    Ok(exit_code(&report))
}

/// 0 if the file, or each of its components, has a name that is proved.
fn exit_code(report: &Report) -> ExitCode {
    if report.finding.certain {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(NOT_CERTAIN)
    }
}

/// What is found, component by component, and the same as text.
fn look(args: &IdentifyArgs, table: &KnotTable) -> Result<(Report, String), CliError> {
    let choice = args.frame.unwrap_or(FrameChoice::Last);
    let file = CurveFile::read(&args.file, args.format, choice)?;
    let several = file.components.len() > 1;
    let mut text = String::new();
    let mut warnings = file.notes;
    if let Some(frame) = &file.frame {
        warnings.insert(0, frame_note(frame, args.frame.is_none()));
    }
    let link = match several {
        true => look_at_link(args, &file.components)?,
        false => None,
    };
    match &link {
        // Writing to a string cannot fail.
        Some(found) => drop(writeln!(text, "{}", link_text(found))),
        None if several => {
            let note = format!(
                "{} components, some of them open: how they are linked is not found, each is named by itself",
                file.components.len()
            );
            let _ = writeln!(text, "{note}");
            warnings.push(note);
        }
        None => {}
    }
    let mut components = Vec::new();
    for (k, component) in file.components.iter().enumerate() {
        let place = if several {
            format!("component {}: ", k + 1)
        } else {
            String::new()
        };
        let (closed, note) = is_closed(args, component);
        warnings.extend(note.map(|note| format!("{place}{note}")));
        let named = name(component, closed, args.closures, table);
        let (finding, sentence) =
            named.map_err(|e| CliError::Input(format!("{}: {place}{e}", args.file.display())))?;
        let _ = write!(text, "{place}{sentence}");
        components.push(Component {
            closed,
            vertices: component.vertices.len(),
            finding,
        });
    }
    for warning in warnings
        .iter()
        .filter(|w| !text.contains(w.as_str()))
        .cloned()
        .collect::<Vec<_>>()
    {
        let _ = writeln!(text, "  note: {warning}");
    }
    let finding = match &components[..] {
        [only] => only.finding.clone(),
        several => Finding::link(several, link.as_ref()),
    };
    let report = Report {
        file: args.file.display().to_string(),
        frame: file.frame.as_ref().map(Frame::from),
        finding,
        link: link.as_ref().map(LinkFinding::from),
        components,
        warnings,
    };
    Ok((report, text))
}

/// The link of several components, if all of them are closed.
fn look_at_link(
    args: &IdentifyArgs,
    components: &[CurveComponent],
) -> Result<Option<LinkType>, CliError> {
    if !components
        .iter()
        .all(|component| is_closed(args, component).0)
    {
        return Ok(None);
    }
    let parts: Vec<&[V]> = components.iter().map(|c| c.vertices.as_slice()).collect();
    let found = identify_link(&parts, LinkTable::builtin());
    let named = |e: KnotError| CliError::Input(format!("{}: {e}", args.file.display()));
    found.map(Some).map_err(named)
}

fn link_text(found: &LinkType) -> String {
    let linking: Vec<String> = found
        .invariants
        .linking
        .iter()
        .map(i32::to_string)
        .collect();
    let jones = found.invariants.oriented_jones();
    format!(
        "{}\n  {} crossings in the simplest diagram found; linking numbers {}, Jones polynomial {}",
        found.describe(),
        found.n_crossings(),
        linking.join(" "),
        jones.map_or_else(|| "not computed".to_owned(), |jones| jones.text())
    )
}

fn frame_note(frame: &CurveFrame, by_default: bool) -> String {
    let label = frame
        .label
        .as_ref()
        .map_or_else(String::new, |label| format!(" ({label})"));
    let choice = if by_default {
        "; this is the last one, --frame N names another"
    } else {
        ""
    };
    format!(
        "frame {} of {}{label}{choice}",
        frame.number, frame.n_frames
    )
}

/// Whether a component is taken for closed, and what to say of that.
fn is_closed(args: &IdentifyArgs, component: &CurveComponent) -> (bool, Option<String>) {
    let gap = component.gap_over_longest_edge();
    if args.closed {
        return (true, None);
    }
    if args.open {
        let drops_edge = component.closed == Some(true) && !component.repeats_first;
        let note = "the file says that the curve is closed; --open leaves its closing edge out";
        return (false, drops_edge.then(|| note.to_owned()));
    }
    let closed = component.is_closed();
    let note = (component.closed.is_none() && !closed).then(|| {
        format!("taken for open: the ends are {gap:.3} times the longest edge apart; --closed joins them")
    });
    (closed, note)
}

/// The finding for a component, and the same in words.
fn name(
    component: &CurveComponent,
    closed: bool,
    n_closures: usize,
    table: &KnotTable,
) -> Result<(Finding, String), KnotError> {
    if !closed {
        let found = identify_open(&component.open_vertices(), n_closures, 0, table)?;
        let finding = Finding::open(&found);
        let text = open_text(&finding, found.n_closures);
        return Ok((finding, text));
    }
    let kind = identify(&component.vertices, table)?;
    let finding = Finding::closed(&kind);
    let compared = if kind.is_certain() {
        let hand = if kind.handedness == Handedness::Undecided {
            ", its hand is unknown"
        } else {
            ""
        };
        format!("every knot of so few was compared{hand}")
    } else {
        format!("only to {} every knot is compared", kind.certain_to())
    };
    let text = format!(
        "{}\n  {} crossings in the simplest diagram found; {compared}\n{}",
        kind.describe(),
        kind.n_crossings,
        invariants_text(&finding)
    );
    Ok((finding, text))
}

fn invariants_text(finding: &Finding) -> String {
    format!(
        "  Alexander polynomial {}, determinant {}, signature {}, Jones polynomial {}\n",
        finding.alexander.as_deref().unwrap_or("not computed"),
        finding.determinant.unwrap_or_default(),
        finding.signature.unwrap_or_default(),
        finding.jones.as_deref().unwrap_or("not computed"),
    )
}

fn open_text(finding: &Finding, n_closures: usize) -> String {
    let mut text = String::new();
    for (k, closure) in finding.closures.iter().enumerate() {
        let share = 100.0 * closure.share;
        let _ = match (k, finding.certain) {
            (0, true) => writeln!(
                text,
                "{} in 100 % of {n_closures} closures (open curve, certain of each)",
                closure.name
            ),
            (0, false) => writeln!(
                text,
                "{} in {share:.1} % of {n_closures} closures (open curve)",
                closure.name
            ),
            _ => writeln!(text, "  {} in {share:.1} %", closure.name),
        };
    }
    text
}
