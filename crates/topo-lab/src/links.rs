//! Tight shapes of links, and their table.

use std::path::Path;

use rayon::prelude::*;
use topo_analysis::{LinkRow, write_table};
use topo_core::Interrupt;
use topo_knots::{
    KnotError, LinkEntry, LinkTable, TightLink, TightenSettings, ideal_link_until, is_link_kept,
    write_curves,
};

use crate::LabError;
use crate::cost::{Estimate, Speed, estimate, threads};
use crate::elastic::ROD_PROBE;
use crate::folder::make_folder;
use crate::knots::{cost, knots_folder};
use crate::progress::Event;

/// Tight shapes of the links, in parallel and in order; those found below `out` are read instead of computed.
///
/// Stops early, with what is there, when interrupted.
///
/// # Errors
/// A link that is unknown or cannot be tightened.
pub fn tight_links(
    names: &[String],
    settings: &TightenSettings,
    out: &Path,
    interrupt: &Interrupt,
    progress: &(dyn Fn(Event<'_>) + Sync),
) -> Result<Vec<TightLink>, LabError> {
    let cache = knots_folder(out).join("cache");
    let one = |name: &String| {
        if interrupt.is_requested() {
            return Ok(None);
        }
        let entry = LinkTable::builtin().get(name)?;
        let tight = match ideal_link_until(&entry, settings, Some(&cache), interrupt) {
            Err(KnotError::InterruptedLink { .. }) => return Ok(None),
            made => made?,
        };
        progress(Event::Knot {
            name,
            length_over_radius: tight.length_over_radius,
        });
        Ok(Some(tight))
    };
    let made = names.par_iter().with_max_len(1).map(one);
    let made = made.collect::<Result<Vec<_>, LabError>>()?;
    Ok(made.into_iter().flatten().collect())
}

impl Estimate {
    /// What [`tight_links`] is expected to take for those of the links that are not kept below `out`.
    ///
    /// # Errors
    /// An unknown link.
    pub fn of_links(
        names: &[String],
        settings: &TightenSettings,
        out: &Path,
        jobs: usize,
    ) -> Result<Self, LabError> {
        let cache = knots_folder(out).join("cache");
        let mut costs = Vec::new();
        for name in names {
            let entry = LinkTable::builtin().get(name)?;
            if !is_link_kept(&entry, settings, &cache) {
                costs.push(cost(entry.crossing_number, settings));
            }
        }
        let speed = Speed::of(&ROD_PROBE, &[]);
        Ok(estimate(&costs, speed, threads(jobs), true))
    }
}

/// Writes `knots/links.csv` and the curves of each link, `knots/<link>.vect`, at thickness 1.
///
/// # Errors
/// A file that cannot be written.
pub fn write_links(links: &[TightLink], out: &Path) -> Result<Vec<LinkRow>, LabError> {
    let folder = knots_folder(out);
    make_folder(&folder)?;
    let mut rows = Vec::new();
    for tight in links {
        let entry: &LinkEntry = &*LinkTable::builtin().get(&tight.name)?;
        rows.push(row(entry, tight));
        write_curves(&folder.join(format!("{}.vect", tight.name)), &tight.curves)?;
    }
    write_table(&folder.join("links.csv"), &rows)?;
    Ok(rows)
}

fn row(entry: &LinkEntry, tight: &TightLink) -> LinkRow {
    let (certificate, length) = (&tight.certificate, tight.length_over_radius);
    let reference = entry.length_over_radius;
    let linking = certificate.invariants.linking.iter().map(i32::to_string);
    LinkRow {
        link: tight.name.clone(),
        length_over_radius: length,
        reference,
        source: entry.source.clone().unwrap_or_default(),
        residual: certificate.residual,
        excess_percent: reference.map(|r| 100.0 * (length / r - 1.0)),
        components: tight.curves.len(),
        vertices: tight.curves.iter().map(|c| c.n_vertices()).sum(),
        linking_numbers: linking.collect::<Vec<_>>().join(" "),
        writhe: certificate.writhe,
        struts: certificate.n_struts,
        kinks: certificate.n_kinks,
        converged: certificate.converged,
        cpu_seconds: tight.cpu_seconds,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use topo_analysis::read_table;
    use topo_knots::{CurveFile, FrameChoice};

    #[test]
    fn links_have_their_table_and_curves() {
        let folder = tempfile::tempdir().unwrap();
        let settings = TightenSettings {
            n_variants: 0,
            n_kicks: 0,
            n_kicks_a_start: 0,
            ..TightenSettings::draft()
        };
        let names = ["L2a1", "mL4a1"].map(str::to_owned);
        let make = || tight_links(&names, &settings, folder.path(), &Interrupt::new(), &|_| {});
        let links = make().unwrap();
        let rows = write_links(&links, folder.path()).unwrap();
        let path = folder.path().join("knots/links.csv");
        assert_eq!(read_table::<LinkRow>(&path).unwrap(), rows);
        let head = std::fs::read_to_string(&path).unwrap();
        assert!(
            head.starts_with("link,length_over_radius,reference,source,residual,"),
            "{head}"
        );
        assert!((rows[0].length_over_radius / 25.132741 - 1.0).abs() < 3e-3);
        assert_eq!(
            (rows[0].source.as_str(), rows[1].reference),
            ("cantarella2002", None)
        );
        // those of the curves as they run: a link of the table is one up to the directions of its components
        let ring = |k: usize| (links[1].curves[k].vertices(), true);
        let linking = topo_core::linking(ring(0), ring(1)).round();
        assert_eq!(linking.abs(), 2.0);
        assert_eq!(rows[1].linking_numbers, linking.to_string());
        let curves = folder.path().join("knots/mL4a1.vect");
        let read = CurveFile::read(&curves, None, FrameChoice::Only).unwrap();
        assert_eq!(read.components[1].vertices, links[1].curves[1].vertices());
        // Kept, and read again.
        assert_eq!(make().unwrap(), links);
        let stop = Interrupt::new();
        stop.request();
        let none = tight_links(
            &["L5a1".to_owned()],
            &settings,
            folder.path(),
            &stop,
            &|_| {},
        );
        assert!(none.unwrap().is_empty());
        let unknown = tight_links(
            &["L99a1".to_owned()],
            &settings,
            folder.path(),
            &Interrupt::new(),
            &|_| {},
        );
        assert!(unknown.unwrap_err().to_string().contains("L99a1"));
    }
}
