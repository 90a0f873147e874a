//! What the parameters of a rod name.

use crate::contact::ContactPairs;
use crate::energy::{ContactEnergy, Twist};
use crate::friction::Friction;
use crate::{RodParameters, Tube};

/// What the parameters name, and how far strands act on each other.
#[derive(Clone, Copy)]
pub(super) struct Named {
    pub(super) twist: Option<Twist>,
    pub(super) contact: Option<ContactEnergy>,
    pub(super) friction: Option<Friction>,
    pub(super) reach: f64,
}

impl Named {
    pub(super) fn of(parameters: &RodParameters, tube: &Tube) -> Self {
        let twist = Twist::of(parameters);
        let contact = ContactEnergy::of(parameters, tube);
        let friction = parameters
            .friction
            .filter(|f| f.ratio > 0.0)
            .map(|f| Friction {
                ratio: f.ratio,
                range: tube.friction_range,
            });
        let mut reach = contact.map_or(0.0, |contact| contact.diameter);
        if let Some(friction) = friction {
            reach = reach.max(friction.range);
        }
        Self {
            twist,
            contact,
            friction,
            reach,
        }
    }

    pub(super) fn pairs(&self, skin: f64, is_closed: bool) -> ContactPairs {
        let mut pairs = ContactPairs::new(self.reach, skin);
        if self.contact.is_some() {
            pairs = pairs.with_core();
        }
        pairs.set_cyclic(is_closed);
        pairs
    }
}
