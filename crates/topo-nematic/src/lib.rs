//! Charged nematic colloids: the nematic battery. An empty room until its physics lands.
