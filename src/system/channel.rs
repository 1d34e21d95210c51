//! The channels of a system: every observable quantity of a state, in one fixed order.

/// One observable quantity of a state.
#[derive(Clone, PartialEq, Debug)]
pub struct Channel {
    /// What the channel measures.
    pub kind: ChannelKind,
    /// The column name: `theta`, `theta'`, `p_theta`, `energy`, an observable's name, or the
    /// expression as written.
    pub name: String,
    /// The display name: `θ`, `θ̇`, `p_θ`, `E`.
    pub shown: String,
    /// The unit, empty if it is not known.
    pub unit: String,
    /// Whether the channel is a periodic coordinate, or an angle written as `atan2(y, x)`. Its period is given by
    /// [`System::period`].
    ///
    /// [`System::period`]: super::System::period
    pub periodic: bool,
    /// Whether it measures a place as the coordinates do: see [`Equations::is_place`].
    ///
    /// [`Equations::is_place`]: crate::mechanics::Equations::is_place
    pub is_place: bool,
}

/// The quantity that a channel measures.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum ChannelKind {
    /// The coordinate of this index.
    Position(usize),
    /// A coordinate's velocity.
    Velocity(usize),
    /// A coordinate's momentum.
    Momentum(usize),
    /// The multiplier λ of the constraint of this index.
    Multiplier(usize),
    /// Jacobi's h for a Lagrangian system, or H.
    Energy,
    /// The Casimir of this index.
    Casimir(usize),
    /// The declared observable of this index.
    Observable(usize),
    /// The extra channel of this index, as given to [`System::compile`](super::System::compile).
    Extra(usize),
    /// The energy less the work done on the system, which is constant by the law of energy change.
    /// The channel exists only where the energy itself is not conserved.
    EnergyBalance,
    /// An entry of the attitude matrix, in row-major order.
    Attitude(usize),
    /// The conserved quantity of this index in `Equations::conserved`.
    Conserved(usize),
    /// Any other expression: of an expectation, a view or a shape.
    /// [`System::channel_of`](super::System::channel_of) finds it.
    Expression,
}
