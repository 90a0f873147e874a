//! Claims about charged colloids.

mod charging;
mod discharging;
mod runs;
#[cfg(test)]
mod tests;

use super::claim::Claim;

const SIZE: &str = "the size of the particle and the thickness of the cell";
const SCHEME: &str = "the scheme at the particle’s surface, the thickness of the cell";

/// Runs with warnings are left out of all of them, and what was left out is said.
pub const CLAIMS: [Claim; 13] = [
    Claim {
        text: "Below a critical charge the defect ring is flat and lies on the equator.",
        published: "Fig. 4a, b",
        figure: "nematic-charging",
        depends: SIZE,
        rule: "every ring of a state without tilt (order parameter below 0.01) stays within 0.01 R of the equator; in part if some do; judged where q was run on both sides of the buckling",
        look: charging::flat,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "The cross-section of the ring changes along it between +1/2, twisted and −1/2.",
        published: "Fig. 4a",
        figure: "nematic-charging",
        depends: "how well the grid resolves the core of the ring",
        rule: "each of the three is the nearest profile (0, 90 or 180 degrees) somewhere on every ring of q > 1; in part if on some rings",
        look: charging::profiles,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "The ring buckles at a critical charge, published as 7.",
        published: "Fig. 4b",
        figure: "nematic-charging",
        depends: "the size of the particle, the thickness of the cell, and, for the published size, the scheme at the particle’s surface: at R = 52.5 ξ_N rings buckle from q = 7 on where nodes in the particle are masked, as in most earlier work, and from q = 8 on where links are cut at its surface",
        rule: "R = 52.5 ξ_N, q = 6 is flat and q = 7 buckled; in part if rings buckle at another charge or size; judged where q was run on both sides of the buckling",
        look: charging::critical,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "A buckled ring has q maxima and minima.",
        published: "Fig. 4b",
        figure: "nematic-charging",
        depends: "nothing seen",
        rule: "the strongest mode of the ring’s height is q on all states with a tilt; in part if on more than half",
        look: charging::undulations,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "The undulations grow with q.",
        published: "text to Fig. 4",
        figure: "nematic-charging",
        depends: SIZE,
        rule: "over three states with a tilt or more, the ring’s height grows in every step; in part if only from the first to the last",
        look: charging::amplitudes,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "The mean horizontal director is zero below the buckling and positive above.",
        published: "Fig. 4c, d",
        figure: "nematic-charging",
        depends: "the seed that breaks the symmetry",
        rule: "states are sorted by the height of their rings (flat: below 0.01 R): the largest order parameter of flat ones is below a tenth of the smallest of others; in part if it is merely smaller",
        look: charging::order,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "The free energy grows with q all the way.",
        published: "Fig. 4e",
        figure: "nematic-charging",
        depends: "nothing seen",
        rule: "F grows from each q to the next; confirmed only where q was run on both sides of the buckling",
        look: charging::energy,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "After the switch the ring shrinks and vanishes on the particle.",
        published: "Fig. 5a",
        figure: "movie-nematic",
        depends: "whether buckled rings are counted",
        rule: "in every discharge the ring, when last seen, is smaller than at first and within 0.1 R of the particle’s radius, and none is left at the end; in part if in some",
        look: discharging::vanishing,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "The discharge drives a flow that changes direction.",
        published: "Fig. 5a",
        figure: "nematic-discharge",
        depends: "nothing seen",
        rule: "in every discharge with flow the correlation of the velocity, in three dimensions, with the first one recorded is negative at some time; in part if in some",
        look: discharging::reversal,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "The energy falls by orders of magnitude within the relaxation time R²/ΓL.",
        published: "Fig. 5b",
        figure: "nematic-discharge",
        depends: "the thickness of the cell, for buckled states",
        rule: "t99.9 is at most R²/ΓL for all unbuckled states; in part if for some; buckled ones, which are slow by another claim, are listed beside",
        look: discharging::decades,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "The rate at which half of the energy goes grows with q.",
        published: "Fig. 5c",
        figure: "nematic-discharge",
        depends: SCHEME,
        rule: "R²/(ΓL t50) grows from each q to the next; in part if only from the first to the last; confirmed only where q was run on both sides of the buckling",
        look: discharging::half,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "The late rates (99 % and 99.9 %) are largest close to the critical charge.",
        published: "Fig. 5d",
        figure: "nematic-discharge",
        depends: SCHEME,
        rule: "both rates peak within 1 of the first buckled charge; in part if one does; judged where q was run on both sides of the buckling and of the peaks",
        look: discharging::resonance,
        other: None,
        doubt: |_| None,
    },
    Claim {
        text: "Far above it the discharge is slow again, held up by the long mode of the horizontal director.",
        published: "Fig. 5d",
        figure: "nematic-discharge",
        depends: "the thickness of the cell (sets the slowest mode)",
        rule: "the 99.9 % rate at the last q, two or more above the first buckled one, is less than half its peak, and buckled discharges end within 15 % of the rate of that mode; in part if one of the two",
        look: discharging::slow_mode,
        other: None,
        doubt: |_| None,
    },
];
