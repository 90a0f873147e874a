//! A artificial nematic sweep.

use crate::data::write;
use serde::Serialize;
use std::f64::consts::TAU;
use std::path::Path;
use topo_analysis::Flow;
use topo_analysis::{LinePoint, NematicRow, NematicSample, SlicePoint};

const RADIUS: f64 = 15.0;
const CRITICAL: u32 = 6;

/// Writes sweep and cases of q = 1..9 without flow and q = 4 with it.
pub fn nematic(folder: &Path) {
    let folder = folder.join("nematic");
    let mut rows = Vec::new();
    for q in 1..=9 {
        rows.push(row(q, Flow::Off));
        if q == 4 {
            rows.push(row(q, Flow::On));
        }
    }
    for row in &rows {
        let case = folder.join(&row.case);
        table(&case.join("ring.csv"), &lines(row));
        table(&case.join("slices.csv"), &slices(row));
        table(&case.join("series.csv"), &series(row));
    }
    table(&folder.join("sweep.csv"), &rows);
}

fn table<T: Serialize>(path: &Path, rows: &[T]) {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).unwrap();
    }
    write(path, &writer.into_inner().unwrap()).unwrap();
}

fn row(q: u32, flow: Flow) -> NematicRow {
    let order = 0.1 * f64::from(q.saturating_sub(CRITICAL - 1)).sqrt();
    let late = if q < CRITICAL {
        0.5 / f64::from(q)
    } else {
        2.0
    };
    let time = |t: f64| Some(t * RADIUS * RADIUS);
    NematicRow {
        case: format!("q{q:02}_flow-{flow}"),
        radius: RADIUS,
        spacing: 1.5,
        q,
        boundary: "cut-link".into(),
        precision: "f64".into(),
        flow,
        f_charged: 300.0 + 60.0 * f64::from(q),
        f_after_switch: 280.0 + 60.0 * f64::from(q),
        order_parameter: order,
        ring_mode: Some(q),
        t50: time(0.03 / f64::from(q)),
        t99: time(0.4 * late),
        t999: time(late),
        ..Default::default()
    }
}

fn ring(row: &NematicRow, time: Option<f64>, radius: f64) -> Vec<LinePoint> {
    (0..90)
        .map(|i| {
            let a = f64::from(i) / 90.0 * TAU;
            LinePoint {
                time,
                line: 0,
                closed: true,
                x: radius * a.cos(),
                y: radius * a.sin(),
                z: 6.0 * row.order_parameter * (f64::from(row.q) * a).cos(),
                angle: Some(90.0 - 90.0 * (f64::from(row.q.max(2) - 1) * a).cos()),
            }
        })
        .collect()
}

fn lines(row: &NematicRow) -> Vec<LinePoint> {
    let mut all = ring(row, None, 1.15 * RADIUS);
    all.extend(ring(row, Some(1.0), 1.05 * RADIUS));
    all
}

fn slices(row: &NematicRow) -> Vec<SlicePoint> {
    let times = [None, Some(1.0), Some(8.0), Some(30.0), Some(120.0)];
    let mut points = Vec::new();
    for time in times {
        for k in -21..21 {
            for i in -28..28 {
                let (x, z) = (1.5 * (f64::from(i) + 0.5), 1.5 * (f64::from(k) + 0.5));
                let r = x.hypot(z);
                let tilt = (RADIUS / r.max(1.0)).powi(3) * x.signum();
                let flowing = row.flow.is_on() && time.is_some();
                points.push(SlicePoint {
                    time,
                    x,
                    z,
                    order: 0.53,
                    nx: tilt.sin(),
                    ny: 0.0,
                    nz: tilt.cos(),
                    ux: flowing.then_some(-z / r / r),
                    uz: flowing.then_some(x / r / r),
                    vorticity: flowing.then_some((x / 8.0).sin() * (-r / 20.0).exp()),
                });
            }
        }
    }
    points
}

fn series(row: &NematicRow) -> Vec<NematicSample> {
    (0..60)
        .map(|i| {
            let time = RADIUS * RADIUS * 1e-4 * 1.2_f64.powi(i);
            NematicSample {
                time,
                energy: row.f_after_switch * (-time * f64::from(row.q) / 20.0).exp(),
                order_x: row.order_parameter,
                flow_correlation: (row.flow.is_on()).then(|| (time / 9.0).cos()),
                ..Default::default()
            }
        })
        .collect()
}
