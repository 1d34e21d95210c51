//! The three principles of stationary action in words.
//!
//! Out: names and letters. Never here: the actions themselves.

/// What is stationary on a motion, and among what.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::instrument) enum Principle {
    /// ∫ L dt among the paths of the same time.
    Hamilton,
    /// ∫ Σ p dq among the ways of the same energy.
    Maupertuis,
    /// ∫ (Σ p q̇ − H) dt among the curves in phase space.
    PhaseSpace,
}

impl Principle {
    pub(super) fn action(self) -> &'static str {
        match self {
            Principle::Hamilton => "action",
            Principle::Maupertuis => "abbreviated action",
            Principle::PhaseSpace => "action in phase space",
        }
    }

    pub(super) fn about(self) -> &'static str {
        match self {
            Principle::Hamilton => {
                "Hamilton's principle: the action of paths beside the motion, with its ends"
            }
            Principle::Maupertuis => {
                "the principle of Maupertuis: ∫ p dq of the ways beside the motion, with its ends and energy"
            }
            Principle::PhaseSpace => {
                "the principle in phase space: q and p are varied independently, the ends of p are free"
            }
        }
    }

    pub(super) fn letter(self) -> &'static str {
        match self {
            Principle::Hamilton => "S",
            Principle::Maupertuis => "W",
            Principle::PhaseSpace => "A",
        }
    }

    /// What the letter stands for.
    pub(super) fn integral(self) -> &'static str {
        match self {
            Principle::Hamilton => "∫ L dt",
            Principle::Maupertuis => "∫ Σ p dq",
            Principle::PhaseSpace => "∫ (Σ p q′ − H) dt",
        }
    }
}
