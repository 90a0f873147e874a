//! What a battery is called, where programs list the batteries that they know.

/// A battery whose scenes can be run.
///
/// Programs hold a list of them; nothing else names a battery.
pub trait Battery: Sync {
    /// The table of a scene file that tells its scenes from others, such as `rod`.
    fn table(&self) -> &'static str;

    /// What it is, as messages call it, such as "a knotted fibre".
    fn what(&self) -> &'static str;

    /// What its cases call themselves in `run.json`.
    fn schema(&self) -> &'static str;

    /// Changes whenever the same scene gives other numbers than before.
    fn results(&self) -> u32;
}
