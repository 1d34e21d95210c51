//! The channels of a system: everything that can be seen of a state, in one fixed order.

/// One number that can be seen of a state.
#[derive(Clone, PartialEq, Debug)]
pub struct Channel {
    /// What it is.
    pub kind: ChannelKind,
    /// As a column is called: `theta`, `theta'`, `p_theta`, `energy`, an observable's name, or
    /// the expression as written.
    pub name: String,
    /// As shown: `θ`, `θ̇`, `p_θ`, `E`.
    pub shown: String,
    /// Its unit, empty where none is known.
    pub unit: String,
    /// Whether it is a coordinate that repeats: its period is [`System::period`]'s.
    ///
    /// [`System::period`]: super::System::period
    pub periodic: bool,
}

/// What a channel is.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum ChannelKind {
    /// The coordinate of this index.
    Position(usize),
    /// A coordinate's velocity.
    Velocity(usize),
    /// A coordinate's momentum.
    Momentum(usize),
    /// λ of the constraint of this index.
    Multiplier(usize),
    /// Jacobi's h, or H.
    Energy,
    /// The Casimir of this index.
    Casimir(usize),
    /// The declared observable of this index.
    Observable(usize),
    /// The extra channel of this index, as given to [`System::compile`](super::System::compile).
    Extra(usize),
    /// The energy less the work done on it: constant by the law of the energy's change. There is
    /// one only where the energy itself is not conserved.
    Ledger,
    /// An entry of the attitude's matrix, by rows.
    Attitude(usize),
    /// The conserved quantity of this index in `Equations::conserved`.
    Conserved(usize),
    /// Any other expression: of an expectation, a view, a shape. Found by
    /// [`System::channel_of`](super::System::channel_of).
    Expression,
}
