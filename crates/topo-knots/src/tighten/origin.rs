//! What tightening needs to know of a knot or a link, and what it makes of it.

use serde::Serialize;
use serde::de::DeserializeOwned;
use topo_core::CpuClock;

use super::shape::Shape;
use super::topology::Topology;
use super::{Certificate, TightKnot, TightLink, circle};
use crate::curves::Curves;
use crate::{Invariants, KnotEntry, KnotError, LinkEntry, LinkInvariants};

/// A tight knot or link.
pub(crate) trait Tight: Sized + Serialize + DeserializeOwned {
    /// Name and version of the type in files.
    const SCHEMA: &'static str;

    /// With the certificate of its curves.
    fn of(name: &str, shape: Shape) -> Result<Self, KnotError>;

    fn mirrored(&self) -> Self;

    /// The refusal of a tightening that was cut short.
    fn interrupted(self) -> KnotError;
}

impl Tight for TightKnot {
    const SCHEMA: &'static str = "tight-knot/1";

    fn of(name: &str, shape: Shape) -> Result<Self, KnotError> {
        let curve = shape.curves.into_first();
        let certificate = Certificate::of(&curve, shape.converged)?;
        Ok(Self {
            name: name.to_owned(),
            length_over_radius: curve.length() / certificate.tau(),
            curve,
            certificate,
            cpu_seconds: shape.cpu_seconds,
            n_factorisations: shape.n_factorisations,
        })
    }

    fn mirrored(&self) -> Self {
        self.mirror()
    }

    fn interrupted(self) -> KnotError {
        KnotError::Interrupted {
            best: Box::new(self),
        }
    }
}

impl Tight for TightLink {
    const SCHEMA: &'static str = "tight-link/1";

    fn of(name: &str, shape: Shape) -> Result<Self, KnotError> {
        let invariants = LinkInvariants::of_curves(&shape.curves)?;
        let certificate = Certificate::examine(&shape.curves, shape.converged, invariants);
        Ok(Self {
            name: name.to_owned(),
            length_over_radius: shape.curves.length() / certificate.tau(),
            curves: shape.curves.into_parts(),
            certificate,
            cpu_seconds: shape.cpu_seconds,
            n_factorisations: shape.n_factorisations,
        })
    }

    fn mirrored(&self) -> Self {
        self.mirror()
    }

    fn interrupted(self) -> KnotError {
        KnotError::InterruptedLink {
            best: Box::new(self),
        }
    }
}

/// A knot or a link to tighten.
pub(crate) trait Origin: std::fmt::Debug {
    /// What it becomes.
    type Tight: Tight;

    fn name(&self) -> &str;

    /// Its word; may be empty if a curve to start from is known.
    fn braid(&self) -> &[i32];

    fn other_braids(&self) -> &[Vec<i32>];

    /// Whether a curve to start from was given.
    fn has_start(&self) -> bool;

    fn start(&self) -> Result<Curves, KnotError>;

    /// Refuses curves of another type.
    fn verify(&self, curves: &Curves) -> Result<Topology, KnotError>;

    fn is_mirror_image(&self) -> bool;

    fn mirror(&self) -> Self;

    /// The tight shape, if it is known without a search.
    fn known(&self) -> Result<Option<Shape>, KnotError> {
        Ok(None)
    }
}

impl Origin for KnotEntry {
    type Tight = TightKnot;

    fn name(&self) -> &str {
        &self.name
    }

    fn braid(&self) -> &[i32] {
        &self.braid
    }

    fn other_braids(&self) -> &[Vec<i32>] {
        &self.other_braids
    }

    fn has_start(&self) -> bool {
        self.start.is_some()
    }

    fn start(&self) -> Result<Curves, KnotError> {
        Ok(self.start_curve()?.into())
    }

    fn verify(&self, curves: &Curves) -> Result<Topology, KnotError> {
        let found: Invariants = self.verify(&curves.parts()[0])?;
        Ok(Topology::Knot(found))
    }

    fn is_mirror_image(&self) -> bool {
        self.is_mirror_image()
    }

    fn mirror(&self) -> Self {
        self.mirror()
    }

    fn known(&self) -> Result<Option<Shape>, KnotError> {
        let clock = CpuClock::start();
        self.is_unknot().then(|| circle(clock)).transpose()
    }
}

impl Origin for LinkEntry {
    type Tight = TightLink;

    fn name(&self) -> &str {
        &self.name
    }

    fn braid(&self) -> &[i32] {
        &self.braid
    }

    fn other_braids(&self) -> &[Vec<i32>] {
        &self.other_braids
    }

    fn has_start(&self) -> bool {
        self.start.is_some()
    }

    fn start(&self) -> Result<Curves, KnotError> {
        Ok(self.start_curves()?.into())
    }

    fn verify(&self, curves: &Curves) -> Result<Topology, KnotError> {
        Ok(Topology::Link(self.verify(curves.parts())?))
    }

    fn is_mirror_image(&self) -> bool {
        self.is_mirror_image()
    }

    fn mirror(&self) -> Self {
        self.mirror()
    }
}
