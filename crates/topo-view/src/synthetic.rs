//! Artificial results in the layout of real ones, for the tests of drawing only.

mod nematic;

pub use nematic::nematic;

use crate::data::{Cut, KNOTS, KnotRow, write};
use nalgebra::Vector3;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;
use topo_analysis::{LinkRow, table_bytes};
use topo_core::Polyline;
use topo_knots::write_curves;

const N: usize = 120;
const LENGTH: f64 = 50.0;

/// Writes sweep, cases and knots into a results folder, for the first `n_knots` knots at
/// `twists`.
pub fn results(folder: &Path, n_knots: usize, twists: &[f64]) {
    let mut sweep = csv::Writer::from_writer(Vec::new());
    let mut table = csv::Writer::from_writer(Vec::new());
    for (k, knot) in KNOTS.iter().take(n_knots).enumerate() {
        let curve = scaled(&closed(k, 0.0), LENGTH);
        let mut xyz = "x,y,z\n".to_owned();
        for p in scaled(&closed(k, 0.0), 32.0 + 2.4 * k as f64) {
            writeln!(xyz, "{},{},{}", p.x, p.y, p.z).unwrap();
        }
        write(&folder.join(format!("knots/{knot}.csv")), xyz.as_bytes()).unwrap();
        table.serialize(knot_row(knot, k)).unwrap();
        for &twist in twists {
            let n_cuts = if k % 4 == 3 && twist.abs() < 0.6 {
                3
            } else {
                1
            };
            for c in 0..n_cuts {
                let cut = cut(knot, k, twist, c);
                if c == 0 {
                    case(folder, k, &cut, &scaled(&closed(k, twist), LENGTH));
                }
                sweep.serialize(cut).unwrap();
            }
        }
        assert_eq!(curve.len(), N);
    }
    links(folder);
    let sweep = sweep.into_inner().unwrap();
    write(&folder.join("elastic/sweep.csv"), &sweep).unwrap();
    let rows = csv::Reader::from_reader(sweep.as_slice()).into_deserialize();
    let rows: Vec<Cut> = rows.collect::<Result<_, _>>().unwrap();
    let breaking = table_bytes(Path::new("sweep.csv"), &by_criterion(&rows)).unwrap();
    write(&folder.join("elastic-breaking/sweep.csv"), &breaking).unwrap();
    let work = table_bytes(Path::new("sweep.csv"), &on_loads(&rows)).unwrap();
    write(&folder.join("elastic-work/sweep.csv"), &work).unwrap();
    // another choice of friction, as if it changed nothing
    write(&folder.join("elastic-contact-range/sweep.csv"), &sweep).unwrap();
    write(
        &folder.join("knots/table.csv"),
        &table.into_inner().unwrap(),
    )
    .unwrap();
}

/// Untwisted knots cut by each criterion: where a knot has near ties two by two agree, and a third cut is a tie; else all agree.
fn by_criterion(rows: &[Cut]) -> Vec<Cut> {
    let untwisted = rows.iter().filter(|r| r.twist == 0.0).cloned();
    let named = untwisted.map(|mut row| {
        let n_cuts = rows.iter().filter(|r| r.case == row.case).count();
        let by = match (n_cuts > 1, row.cut < 0.2, row.cut < 0.5) {
            (false, ..) => "energy;curvature;tension;von-mises",
            (true, true, _) => "energy;von-mises",
            (true, false, true) => "curvature;tension",
            _ => "energy",
        };
        row.cut_by = by.to_owned();
        row
    });
    named.collect()
}

/// Every state against three dashpots: efficiency grows with the resistance, power is largest at the middle one.
fn on_loads(rows: &[Cut]) -> Vec<Cut> {
    let firsts = rows
        .iter()
        .enumerate()
        .filter(|(i, row)| *i == 0 || rows[i - 1].case != row.case);
    let loaded = |row: &Cut, c: f64| {
        let matched = 4.0 * (c / 0.1) / (1.0 + c / 0.1).powi(2);
        let efficiency = 0.6 * c / (0.1 + c) / (1.0 + 0.3 * row.twist.abs());
        Cut {
            load_dashpot: Some(c),
            work: Some(efficiency * row.energy),
            energy_in: Some(row.energy),
            efficiency: Some(efficiency),
            peak_power: Some(matched * row.energy * (1.0 + row.twist.abs())),
            ..row.clone()
        }
    };
    firsts
        .flat_map(|(_, row)| [0.01, 0.1, 1.0].map(|c| loaded(row, c)))
        .collect()
}

fn closed(k: usize, twist: f64) -> Vec<Vector3<f64>> {
    let p = [3.0, 4.0, 5.0, 5.0, 6.0, 6.0, 6.0][k.min(6)] + if k > 6 { 1.0 } else { 0.0 };
    (0..N)
        .map(|i| {
            let a = i as f64 / N as f64 * TAU;
            if k == 1 {
                let r = 2.0 + (2.0 * a).cos();
                return Vector3::new(
                    r * (3.0 * a).cos(),
                    r * (3.0 * a).sin(),
                    1.4 * (4.0 * a).sin(),
                );
            }
            let p = if (p as usize).is_multiple_of(2) {
                p + 1.0
            } else {
                p
            };
            let buckle = 0.12 * twist * (a * (2.0 + k as f64 % 3.0)).sin();
            let r = 2.3 + (p * a).cos() + buckle;
            let y = r * (2.0 * a).sin() * (1.0 - 0.08 * twist);
            Vector3::new(r * (2.0 * a).cos(), y, 1.1 * (p * a).sin() + 1.5 * buckle)
        })
        .collect()
}

fn scaled(points: &[Vector3<f64>], length: f64) -> Vec<Vector3<f64>> {
    let n = points.len();
    let old: f64 = (0..n)
        .map(|i| (points[(i + 1) % n] - points[i]).norm())
        .sum();
    points.iter().map(|p| p * (length / old)).collect()
}

fn cut(knot: &str, k: usize, twist: f64, c: usize) -> Cut {
    let bend = 0.03 + 0.008 * k as f64 + 0.02 * twist * twist * (1.0 + 0.1 * twist);
    let twist_energy = 0.24 * twist * twist;
    let slow = [
        1.0, 0.4, 0.5, 0.6, 0.5, 0.55, 0.5, 0.7, 0.6, 0.5, 0.9, 0.5, 0.6, 0.5,
    ][k];
    let t99 =
        19.0 * slow / (1.0 + 1.6 * twist * twist) * (1.0 + 0.5 * c as f64) + 1.9 + 0.1 * twist;
    Cut {
        case: format!("{knot}_twist{twist:+.2}_shrunk_n{N}"),
        knot: knot.to_owned(),
        components: 1,
        twist,
        cut: 0.1 + 0.3 * c as f64,
        reading: "shrunk".to_owned(),
        edges: N,
        energy: bend + twist_energy,
        bend,
        twist_energy,
        stretch: 0.001,
        writhe: 3.4 + 0.8 * twist,
        total_twist: 8.0 * twist,
        t50: Some(t99 / 12.0),
        t90: Some(t99 / 3.0),
        t95: Some(t99 / 2.0),
        t99: Some(t99),
        t50_after_cut: Some(t99 / 12.0),
        t90_after_cut: Some(t99 / 3.0),
        t95_after_cut: Some(t99 / 2.0),
        t99_after_cut: Some(t99),
        t_untie: Some(t99 / 4.0),
        link_drift: Some(1e-12),
        min_distance_over_contact: Some(0.97),
        steps: 800,
        rejected: 12,
        cpu_seconds: 0.5,
        ..Cut::default()
    }
}

fn case(folder: &Path, k: usize, cut: &Cut, curve: &[Vector3<f64>]) {
    let folder = folder.join("elastic").join(&cut.case);
    let density = |i: usize| {
        let a = i as f64 / N as f64 * TAU;
        0.3 * cut.twist * cut.twist
            + 0.05
            + 0.16 * (1.0 + ((k % 5 + 2) as f64 * a).cos()) * (1.0 + 0.3 * cut.twist)
    };
    let mut charged = "s,x,y,z,twist,energy_density\n".to_owned();
    for (i, p) in curve.iter().enumerate() {
        let s = i as f64 * LENGTH / N as f64;
        let (x, y, z, twist, w) = (p.x, p.y, p.z, cut.twist, density(i));
        writeln!(charged, "{s},{x},{y},{z},{twist},{w}").unwrap();
    }
    write(&folder.join("charged.csv"), charged.as_bytes()).unwrap();
    write(&folder.join("series.csv"), series(k, cut).as_bytes()).unwrap();
    let shots = snapshots(cut, curve, density);
    write(&folder.join("snapshots.csv"), shots.as_bytes()).unwrap();
    write(&folder.join("run.json"), b"{\"warnings\":[]}").unwrap();
}

/// An energy that falls in two exponentials, and a knot that opens on the way.
fn series(k: usize, cut: &Cut) -> String {
    let mut series = "cut,time,energy,bend,twist_energy,stretch,contact_energy,dissipated_viscosity,dissipated_twist,dissipated_friction,work,writhe,total_twist,n_contacts,min_distance,end_to_end,knot,knot_probability\n".to_owned();
    let t99 = cut.t99.unwrap();
    let path = ["7_4", "5_2", "3_1", "0_1"];
    for step in 0..150 {
        let t = if step == 0 {
            0.0
        } else {
            1e-3 * 10.0_f64.powf(step as f64 / 149.0 * 4.6)
        };
        let e = cut.energy * (0.5 * (-t / t99 * 14.0).exp() + 0.5 * (-t / t99 * 4.0).exp());
        let stage = [0.03, 0.09, 0.26].iter().filter(|f| t > *f * t99).count();
        let knot = if k != 10 {
            if stage < 2 { cut.knot.as_str() } else { "0_1" }
        } else {
            path[stage]
        };
        let knot = if step % 3 == 0 { knot } else { "" };
        writeln!(
            series,
            "{},{t},{e},{e},0,0,0,0,0,0,0,1,1,3,1.9,4,{knot},0.9",
            cut.cut
        )
        .unwrap();
    }
    series
}

/// A rod that straightens.
fn snapshots(cut: &Cut, curve: &[Vector3<f64>], density: impl Fn(usize) -> f64) -> String {
    let t99 = cut.t99.unwrap();
    let mut shots = "cut,time,s,x,y,z,energy_density\n".to_owned();
    for shot in 0..10 {
        let f = shot as f64 / 9.0;
        let t = t99 * f.powi(3) * 1.2;
        for (i, p) in curve.iter().enumerate() {
            let s = i as f64 * LENGTH / N as f64;
            let line = Vector3::new(s - LENGTH / 2.0, 1.5 * (0.1 * s).sin(), 0.0);
            let q = p * (1.0 - f) + line * f;
            writeln!(
                shots,
                "{},{t},{s},{},{},{},{}",
                cut.cut,
                q.x,
                q.y,
                q.z,
                density(i) * (1.0 - f)
            )
            .unwrap();
        }
    }
    shots
}

/// Two tight rings, each through the other, and three that are apart.
fn links(folder: &Path) {
    let ring = |x: f64, upright: bool| {
        let point = |i: usize| {
            let (s, c) = (i as f64 / N as f64 * TAU).sin_cos();
            match upright {
                true => Vector3::new(x + 2.0 * c, 0.0, 2.0 * s),
                false => Vector3::new(x + 2.0 * c, 2.0 * s, 0.0),
            }
        };
        Polyline::new((0..N).map(point).collect(), true).unwrap()
    };
    let hopf = vec![ring(0.0, false), ring(2.0, true)];
    let apart = (0..3).map(|k| ring(6.0 * k as f64, false)).collect();
    let links: [(&str, Vec<Polyline>); 2] = [("L2a1", hopf), ("L6a4", apart)];
    let mut table = csv::Writer::from_writer(Vec::new());
    for (link, curves) in links {
        let path = folder.join(format!("knots/{link}.vect"));
        write_curves(&path, &curves).unwrap();
        let reference = (link == "L2a1").then_some(25.1327);
        let row = LinkRow {
            link: link.to_owned(),
            length_over_radius: 12.57 * curves.len() as f64,
            reference,
            excess_percent: reference.map(|_| 0.03),
            residual: 0.01 * curves.len() as f64,
            components: curves.len(),
            vertices: N * curves.len(),
            linking_numbers: if curves.len() == 2 { "1" } else { "0 -1 0" }.to_owned(),
            struts: 240,
            converged: curves.len() == 2,
            ..LinkRow::default()
        };
        table.serialize(row).unwrap();
    }
    let table = table.into_inner().unwrap();
    write(&folder.join("knots/links.csv"), &table).unwrap();
}

fn knot_row(knot: &str, k: usize) -> KnotRow {
    let reference = 32.74 + 2.4 * k as f64;
    let excess = 0.12 + 0.05 * (k % 5) as f64;
    KnotRow {
        knot: knot.to_owned(),
        vertices: 320 + 8 * k,
        length_over_radius: reference * (1.0 + excess / 100.0),
        reference: Some(reference),
        excess_percent: Some(excess),
        writhe: 3.4 - 0.9 * k as f64,
        average_crossing_number: 4.3 + 0.7 * k as f64,
        struts: 150 + 10 * k,
        kinks: k,
        alexander: "1 -1 1".to_owned(),
        determinant: 3 + 2 * k as u64,
        signature: -2 + (k % 4) as i32,
        cpu_seconds: 1.0,
    }
}
