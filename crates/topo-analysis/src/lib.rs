//! From scenes to discharge times, knot timelines, ensembles and resonances.
