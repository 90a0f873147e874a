//! Claims about knotted fibres.

mod charging;
mod discharge;
mod end;
mod energies;
mod phases;
mod rows;
mod slow;
#[cfg(test)]
mod tests;
mod times;

use super::claim::{Claim, Other};
use discharge::{fast_at_high_twist, knots_washed_out, slow_at_low_twist};
use rows::flags;
pub(crate) use slow::{SLOW, words};
use slow::{robust, slow_pair};
use times::{Site, tied};

const BRANCH: &str = "the branch that a start shape settles in (θ′h near ±1)";
const CUT: &str = "what “maximum stress” means, which of several near-tied sites is cut, the range of friction, how L/h is read";
/// The other experiment: all near-tied sites are cut, one rod each.
const TIES: &str = "By the mean over near-tied cuts";

pub const CLAIMS: [Claim; 15] = [
    Claim {
        text: "Fourteen knots at seventeen twists can be charged and hold their energy as long as they are closed.",
        published: "Fig. 1",
        figure: "elastic-configurations",
        depends: "nothing seen",
        rule: "all 238 states are charged to the end of the run, keep their knot type and, to 1e-10 turns, their linking number; in part if nine in ten of the states run do",
        look: charging::charged,
        other: None,
        doubt: flags,
    },
    Claim {
        text: "The trefoil, being chiral, buckles differently under right- and left-handed twist.",
        published: "Fig. 2a",
        figure: "elastic-charging",
        depends: BRANCH,
        rule: "at the largest twist the energies of the two hands differ by more than 0.5 %",
        look: charging::trefoil,
        other: None,
        doubt: flags,
    },
    Claim {
        text: "The figure-eight knot, being its own mirror image, does not care for the hand of the twist.",
        published: "Fig. 2a",
        figure: "elastic-charging",
        depends: BRANCH,
        rule: "from one image of the start shape alone the energies of the two hands differ by at most 0.5 % at every twist; in part if at the largest; not judged where the energy of the other image is not in the table",
        look: charging::figure_eight,
        other: None,
        doubt: flags,
    },
    Claim {
        text: "Chiral knots in general buckle by the hand of the twist, and amphichiral ones do not.",
        published: "text to Fig. 2",
        figure: "elastic-charging",
        depends: "amphichiral knots being started from the better of two mirror images",
        rule: "by the median over twists, every chiral knot sees the hand more than three times as much as the amphichiral ones from one image alone; in part if the median of the chiral knots does; not judged where the energy of the other image is not in the table",
        look: charging::chirality_by_median,
        other: Some(Other {
            reading: "By the largest over twists",
            look: charging::chirality_by_largest,
        }),
        doubt: flags,
    },
    Claim {
        text: "The energy density along a trefoil differs between θ′h = +2 and −2.",
        published: "Fig. 2b",
        figure: "elastic-charging",
        depends: "nothing seen",
        rule: "largest over mean density differs by more than 5 % between the hands",
        look: charging::profiles,
        other: None,
        doubt: flags,
    },
    Claim {
        text: "Buckling turns twist into writhe: less twist is left than was supplied.",
        published: "text to Fig. 2",
        figure: "elastic-charging",
        depends: "how L/h is read (sets the twist supplied)",
        rule: "the paper says “typically”: more than half of the states of either hand hold less twist than was supplied; in part if of one hand",
        look: charging::twist_left,
        other: None,
        doubt: flags,
    },
    Claim {
        text: "At low twist the stored energy depends on the knot, at high twist it does not.",
        published: "Fig. 3b",
        figure: "elastic-discharge",
        depends: "how L/h is read (sets the energy of an untwisted knot)",
        rule: "largest over smallest energy, less one, falls to below a third; in part if it falls",
        look: energies::energies,
        other: None,
        doubt: flags,
    },
    Claim {
        text: "Twist takes over from bending at θ′h of about 1.",
        published: "Fig. 3b–e",
        figure: "elastic-discharge",
        depends: "how L/h is read",
        rule: "the median lies between 0.75 and 1.25; in part if twist takes over at another value",
        look: energies::takeover,
        other: None,
        doubt: flags,
    },
    Claim {
        text: "Energy is released in phases, as intermediate knots form and untie (7₄ over others to the unknot).",
        published: "Fig. 3c",
        figure: "elastic-discharge",
        depends: "the cut site",
        rule: "7₄ passes through another knot, and so do more than half of the knots that have a simpler one a crossing change away (all but 3₁ and 4₁); in part if one of the two",
        look: phases::one_cut,
        other: Some(Other {
            reading: "Over all near-tied cuts",
            look: phases::near_ties,
        }),
        doubt: flags,
    },
    Claim {
        text: "Without twist 3₁ and 7₄ untie more slowly than others.",
        published: "Fig. 3c",
        figure: "elastic-discharge",
        depends: CUT,
        rule: "one cut at the point of maximum stress, as published: t99 of both is more than 1.5 times the median of the knots whether that is the largest energy density, curvature, tension or von Mises stress; in part if by some of these only, if that of one is, or if t90 of both is",
        look: |t| slow_pair(t, Site::Largest),
        other: Some(Other {
            reading: TIES,
            look: |t| tied(t, slow_pair),
        }),
        doubt: slow::flags_of_criteria,
    },
    Claim {
        text: "Some knots are superslow for a reason of topology.",
        published: "Fig. 3d, e",
        figure: "elastic-discharge",
        depends: "what “maximum stress” means, which of several near-tied sites is cut, the range of friction, how L/h is read (“hard” stretches rods of seven crossings, and that energy goes at once; “own-length” has longer rods for longer knots, which take longer in T₀ to straighten)",
        rule: "one cut, at the largest energy density: t99 of some untwisted knot is more than 1.5 times the median of the knots by default, under every other choice of friction and reading, and cut at the largest curvature, tension or von Mises stress; in part if by default only",
        look: |t| robust(t, Site::Largest),
        other: Some(Other {
            reading: TIES,
            look: |t| tied(t, robust),
        }),
        doubt: slow::flags_of_choices,
    },
    Claim {
        text: "Superslow states lie at low twist.",
        published: "Fig. 3d",
        figure: "elastic-discharge",
        depends: "the cut site",
        rule: "one cut, at the largest energy density: nine in ten of the states slower than twice the median have |θ′h| ≤ 1; in part if two in three have",
        look: |t| slow_at_low_twist(t, Site::Largest),
        other: Some(Other {
            reading: TIES,
            look: |t| tied(t, slow_at_low_twist),
        }),
        doubt: flags,
    },
    Claim {
        text: "High twist makes every knot discharge fast.",
        published: "Fig. 3d, e",
        figure: "elastic-discharge",
        depends: "the cut site",
        rule: "one cut, at the largest energy density: every state of |θ′h| ≥ 1.5 is faster than the untwisted median; in part if nine in ten are",
        look: |t| fast_at_high_twist(t, Site::Largest),
        other: Some(Other {
            reading: TIES,
            look: |t| tied(t, fast_at_high_twist),
        }),
        doubt: flags,
    },
    Claim {
        text: "At high twist the knot no longer matters for the discharge time.",
        published: "Fig. 3e",
        figure: "elastic-discharge",
        depends: "which share is timed: the last of the energy goes by straightening, and 7₁ stays slow to 99 %",
        rule: "one cut, at the largest energy density: for either hand the standard deviation of t90 over the knots falls to below a third of that without twist, and to below half of it relative to the mean; in part if for one hand",
        look: |t| knots_washed_out(t, "t90", |r| r.t90),
        other: Some(Other {
            reading: "By t99",
            look: |t| knots_washed_out(t, "t99", |r| r.t99),
        }),
        doubt: flags,
    },
    Claim {
        text: "The last of the energy goes at a rate set by the relaxed length, the same for all.",
        published: "text to Fig. 3c",
        figure: "elastic-discharge",
        depends: "how long the discharge is followed, how L/h is read",
        rule: "followed to 99.999 %, nine in ten discharges end within 10 % of 1/T_b; in part if half do",
        look: end::to_the_last_mode,
        other: Some(Other {
            reading: "Followed to 99.9 %",
            look: end::of_the_sweep,
        }),
        doubt: end::flags_of_last,
    },
];
