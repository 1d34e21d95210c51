//! The periodic points of the return maps of a file's surfaces of section: where periodic orbits cross each of them.
//!
//! In: the crossings of orbits. Out: [`PeriodicPoints`], which every section of the lab marks while the picture of the orbit or
//! of its family is there. Never here: how orbits are closed and followed, what is drawn.

/// An orbit, and the members of its family if that was followed.
#[derive(Clone, Debug)]
pub struct PeriodicOrbits {
    /// The orbit that was closed near the motion.
    pub(super) orbit: PeriodicPoints,
    /// The members of its family, in their order.
    pub(super) family: Vec<PeriodicPoints>,
}

/// Where a periodic orbit crosses the surfaces of section of a file.
#[derive(Clone, Debug)]
pub struct PeriodicPoints {
    pub(super) parameters: Vec<f64>,
    pub(super) energy: f64,
    /// Whether it is stable; `None` where that is not known.
    pub(super) stable: Option<bool>,
    /// For each surface the crossings of a period: the time, then all channels.
    pub(super) surfaces: Vec<Vec<Vec<f64>>>,
}

impl PeriodicPoints {
    /// Its crossings of a surface, in two channels.
    pub(super) fn on(
        &self,
        section: usize,
        channels: [usize; 2],
    ) -> impl ExactSizeIterator<Item = [f64; 2]> + '_ {
        let rows = self.surfaces.get(section).map_or(&[][..], Vec::as_slice);
        rows.iter().map(move |row| {
            channels.map(|channel| row.get(1 + channel).copied().unwrap_or(f64::NAN))
        })
    }
}
