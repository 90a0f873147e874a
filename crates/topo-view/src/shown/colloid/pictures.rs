//! The defect rings of charged colloids, and director and flow in the plane through one of them over its discharge.

use crate::data::{DefectLine, Slice, rings, slices};
use crate::error::ViewError;
use crate::figures::Drawn;
use crate::figures::nematic::{colloid_at, particle_bar, profile_bar, slice};
use crate::figures::series::Table;
use crate::plot::canvas::Canvas;
use crate::plot::solids::Solids;
use crate::plot::style::Style;
use crate::sweeps::groups::evenly;
use crate::sweeps::{Cases, OwnPicture, Row};

pub(super) const RINGS: OwnPicture = OwnPicture {
    name: "rings",
    title: "Charged colloids with their defect rings",
    draw: draw_rings,
};

pub(super) const SLICES: OwnPicture = OwnPicture {
    name: "slices",
    title: "Director and flow in the plane through the particle",
    draw: draw_slices,
};

/// Most colloids of a picture.
const MOST: usize = 8;
const CELL: [f64; 2] = [160.0, 120.0];

/// A charged colloid and its rings; none without a radius.
fn charged_colloid(
    cases: &Cases,
    row: &Row,
) -> Result<Option<(Solids<'static>, Vec<DefectLine>)>, ViewError> {
    let Some(radius) = row.number("radius") else {
        return Ok(None);
    };
    let lines = rings(&cases.case_folder(row))?;
    let charged: Vec<&DefectLine> = lines.iter().filter(|l| l.time.is_none()).collect();
    // early tables have no pattern: theirs has the winding q
    let has_winding = matches!(row.text("pattern"), "" | "charge");
    let q = row.number("q").filter(|_| has_winding).map(|q| q as u32);
    let solids = colloid_at(radius, q, &charged, None, [-90.0, 22.0]);
    Ok(Some((solids, lines)))
}

fn draw_rings(cases: &Cases) -> Result<Option<Drawn>, ViewError> {
    let all: Vec<&Row> = cases
        .first_rows()
        .into_iter()
        .filter(|r| r.text("pattern") != "none")
        .filter(|r| cases.case_folder(r).join("ring.csv").exists())
        .collect();
    if all.is_empty() {
        return Ok(None);
    }
    let mut shown = Vec::new();
    let mut unit = f64::MAX;
    for k in evenly(all.len(), MOST) {
        if let Some((solids, lines)) = charged_colloid(cases, all[k])? {
            let [x0, y0, x1, y1] = solids.extent();
            unit = unit.min(CELL[0] / (x1 - x0)).min(CELL[1] / (y1 - y0));
            shown.push((all[k], solids, lines));
        }
    }
    let across = shown.len().min(4);
    let n_lines = shown.len().div_ceil(4);
    let (pitch, tall) = ([176.0, 148.0], 148.0 * n_lines as f64);
    let mut notes = vec![
        "Ring: local cross-section, grey where it is not determined. Particle: x component of the surface director.".to_owned(),
    ];
    if shown.len() < all.len() {
        let text = format!(
            "{} of {} cases are shown, picked evenly.",
            shown.len(),
            all.len()
        );
        notes.push(text);
    }
    let width = (pitch[0] * across as f64 + 16.0).max(360.0);
    let mut canvas = Canvas::new(width, tall + 52.0, 3.0);
    let mut table = Table::new("case,line,x,y,z,angle");
    for (k, (row, solids, lines)) in shown.iter().enumerate() {
        let at = [
            16.0 + pitch[0] * (k % 4) as f64,
            8.0 + pitch[1] * (k / 4) as f64,
        ];
        canvas.solids(at, CELL, [0.0, 0.0], 0.98 * unit, solids)?;
        let middle = Style::default().middle().size(9.0);
        let below = at[1] + CELL[1] + 10.0;
        canvas.text(at[0] + 0.5 * CELL[0], below, &cases.label(row), middle);
        let charged = lines.iter().filter(|l| l.time.is_none()).enumerate();
        for (n, line) in charged {
            for (p, angle) in line.points.iter().zip(&line.angles) {
                let numbers = [p.x, p.y, p.z, angle.unwrap_or(f64::NAN)];
                table.row(&[row.case(), &n.to_string()], &numbers);
            }
        }
    }
    profile_bar(&mut canvas, [16.0, tall + 8.0], [150.0, 7.0], 8.5);
    particle_bar(&mut canvas, [192.0, tall + 8.0], [150.0, 7.0], 8.5);
    canvas.footnote(&notes);
    Ok(Some(Drawn {
        picture: canvas.finish()?,
        csv: table.finish(),
        finding: notes.join(" "),
    }))
}

fn draw_slices(cases: &Cases) -> Result<Option<Drawn>, ViewError> {
    let rows = cases.first_rows();
    let has_slices = |r: &&&Row| cases.case_folder(r).join("slices.csv").exists();
    let with_flow = rows
        .iter()
        .filter(has_slices)
        .find(|r| r.text("flow") == "on");
    let Some(row) = with_flow.or_else(|| rows.iter().find(has_slices)) else {
        return Ok(None);
    };
    let folder = cases.case_folder(row);
    let all = slices(&folder)?;
    let after: Vec<&Slice> = all.iter().filter(|s| s.time.is_some()).collect();
    let (Some(radius), Some(first)) = (row.number("radius"), after.first()) else {
        return Ok(None);
    };
    let [half_x, half_z] = first.half_size();
    let unit = (160.0 / (2.0 * half_x)).min(150.0 / (2.0 * half_z));
    let mut canvas = Canvas::new(696.0, 2.0 * half_z * unit + 54.0 + slice::KEY_HEIGHT, 3.0);
    slice::moments(&mut canvas, &after, &rings(&folder)?, radius)?;
    let label = cases.label(row);
    canvas.text(12.0, 12.0, &label, Style::default().bold().size(9.5));
    let note = "Director (green), velocity (arrows), vorticity (colour), defect line (red); each picture has its own scales.";
    canvas.footnote(&[note.to_owned()]);
    let mut table = Table::new("case,time,x,z,order,nx,ny,nz,ux,uz,vorticity");
    for slice in after {
        for p in &slice.points {
            let flow = [p.ux, p.uz, p.vorticity].map(|v| v.unwrap_or(f64::NAN));
            let time = p.time.unwrap_or(f64::NAN);
            let place = [time, p.x, p.z, p.order, p.nx, p.ny, p.nz];
            table.row(&[row.case()], &[&place[..], &flow].concat());
        }
    }
    Ok(Some(Drawn {
        picture: canvas.finish()?,
        csv: table.finish(),
        finding: format!("{label}: {note}"),
    }))
}
