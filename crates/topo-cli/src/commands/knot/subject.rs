//! What is to be tightened, a knot or a link, and what became of it.

use serde_json::Value;
use std::path::Path;
use topo_core::{Interrupt, Polyline};
use topo_knots::{
    Certificate, KnotEntry, KnotError, LinkEntry, SecondOpinion, TightKnot, TightLink,
    TightenSettings, ideal_link_until, ideal_until, second_opinion_of_link_until,
    second_opinion_until, tighten_by_hops_until, tighten_link_by_hops_until,
};

/// A knot or a link to tighten.
pub(super) enum Subject {
    Knot(Box<KnotEntry>),
    Link(Box<LinkEntry>),
}

/// A tight knot or link.
pub(super) enum Tight {
    Knot(Box<TightKnot>),
    Link(Box<TightLink>),
}

/// Numbers that knots and links have alike.
pub(super) struct Facts<'a> {
    pub name: &'a str,
    pub curves: &'a [Polyline],
    pub length_over_radius: f64,
    pub cpu_seconds: f64,
    pub n_factorisations: usize,
    pub writhe: f64,
    pub n_struts: usize,
    pub n_kinks: usize,
    pub residual: f64,
    pub converged: bool,
}

impl From<KnotEntry> for Subject {
    fn from(entry: KnotEntry) -> Self {
        Self::Knot(Box::new(entry))
    }
}

impl From<LinkEntry> for Subject {
    fn from(entry: LinkEntry) -> Self {
        Self::Link(Box::new(entry))
    }
}

impl Subject {
    /// Published length and its source.
    pub(super) fn published(&self) -> (Option<f64>, Option<&str>) {
        match self {
            Self::Knot(entry) => (entry.length_over_radius, entry.source.as_deref()),
            Self::Link(entry) => (entry.length_over_radius, entry.source.as_deref()),
        }
    }

    /// Under which key it is listed, and as which each is.
    pub(super) fn keys(&self) -> [&'static str; 2] {
        match self {
            Self::Knot(_) => ["knots", "knot"],
            Self::Link(_) => ["links", "link"],
        }
    }

    /// The tight shape, and whether the tightening went to its end.
    pub(super) fn tighten(
        &self,
        n_hops: usize,
        settings: &TightenSettings,
        cache: &Path,
        stop: &Interrupt,
    ) -> Result<(Tight, bool), KnotError> {
        match (self, n_hops) {
            (Self::Knot(entry), 0) => ideal_until(entry, settings, Some(cache), stop).map(knot),
            (Self::Knot(entry), n) => tighten_by_hops_until(entry, n, settings, stop).map(knot),
            (Self::Link(entry), 0) => {
                ideal_link_until(entry, settings, Some(cache), stop).map(link)
            }
            (Self::Link(entry), n) => {
                tighten_link_by_hops_until(entry, n, settings, stop).map(link)
            }
        }
        .map(|tight| (tight, true))
        .or_else(|error| match error {
            KnotError::Interrupted { best } => Ok((Tight::Knot(best), false)),
            KnotError::InterruptedLink { best } => Ok((Tight::Link(best), false)),
            error => Err(error),
        })
    }
}

fn knot(tight: TightKnot) -> Tight {
    Tight::Knot(Box::new(tight))
}

fn link(tight: TightLink) -> Tight {
    Tight::Link(Box::new(tight))
}

impl Tight {
    pub(super) fn facts(&self) -> Facts<'_> {
        match self {
            Self::Knot(tight) => Facts {
                name: &tight.name,
                curves: std::slice::from_ref(&tight.curve),
                length_over_radius: tight.length_over_radius,
                cpu_seconds: tight.cpu_seconds,
                n_factorisations: tight.n_factorisations,
                ..Facts::of(&tight.certificate)
            },
            Self::Link(tight) => Facts {
                name: &tight.name,
                curves: &tight.curves,
                length_over_radius: tight.length_over_radius,
                cpu_seconds: tight.cpu_seconds,
                n_factorisations: tight.n_factorisations,
                ..Facts::of(&tight.certificate)
            },
        }
    }

    /// Its certificate for programs.
    pub(super) fn certificate(&self) -> Result<Value, serde_json::Error> {
        match self {
            Self::Knot(tight) => serde_json::to_value(&tight.certificate),
            Self::Link(tight) => serde_json::to_value(&tight.certificate),
        }
    }

    /// The second method's opinion; its curves are left out.
    pub(super) fn second(&self, stop: &Interrupt) -> Result<SecondOpinion<()>, KnotError> {
        match self {
            Self::Knot(tight) => Ok(second_opinion_until(tight, stop)?.without_curves()),
            Self::Link(tight) => Ok(second_opinion_of_link_until(tight, stop)?.without_curves()),
        }
    }
}

impl Facts<'_> {
    fn of<I>(certificate: &Certificate<I>) -> Self {
        Self {
            name: "",
            curves: &[],
            length_over_radius: 0.0,
            cpu_seconds: 0.0,
            n_factorisations: 0,
            writhe: certificate.writhe,
            n_struts: certificate.n_struts,
            n_kinks: certificate.n_kinks,
            residual: certificate.residual,
            converged: certificate.converged,
        }
    }
}
