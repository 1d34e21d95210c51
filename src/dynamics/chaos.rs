//! Whether neighbouring motions separate exponentially, and whether that is chaos, by what was measured along one motion.
//!
//! In: the growth of tangent vectors, MEGNO, how the motion was carried. Out: a verdict with its reason. Never here: steps.

use super::lyapunov_course::CarriedMotion;
use crate::num::{math, short};

/// A verdict needs this many steps of a series, or ten times as many of fixed size.
const STEPS: u64 = 120;

/// MEGNO up to which a motion is regular, and from which it is chaotic.
const REGULAR: f64 = 2.8;
const CHAOTIC: f64 = 5.0;

/// MEGNO below which neighbours approach each other, if the largest exponent says so too: of regular motion it goes to 2, or to 0
/// where neighbours stay where they are.
const APPROACHING: f64 = -1.0;

/// Beyond the first, MEGNO of regular motion has not grown by the second since half of the time; of chaotic motion it doubles.
const SETTLED: f64 = 2.2;
const RISING: f64 = 1.5;

/// A chaotic motion has grown by this many powers of e.
const GROWTH: f64 = 8.0;

/// The distance from the start grows by this part of the power of e by which neighbours part where these part as the motion escapes.
const ESCAPE: f64 = 0.5;

/// A motion that is to close does so before neighbours have separated by this power of e: rounding has led it away from where it was later.
const LOST: f64 = 20.0;

/// Whether neighbouring motions separate exponentially, and whether that is chaos.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Chaos {
    /// They do not.
    Regular,
    /// They do, and the motion is bounded and keeps returning without ever closing.
    Chaotic,
    /// They do, and the motion is none that could be chaotic: it is at rest, periodic, escapes, or follows linear equations.
    Unstable,
    /// It cannot be decided.
    Undecided,
}

impl Chaos {
    /// As it is written in tables and JSON.
    pub fn word(self) -> &'static str {
        match self {
            Chaos::Regular => "regular",
            Chaos::Chaotic => "chaotic",
            Chaos::Unstable => "unstable",
            Chaos::Undecided => "undecided",
        }
    }
}

/// What was measured along a motion of which neighbours can part.
pub(super) struct Evidence<'a> {
    pub(super) motion: &'a CarriedMotion,
    /// The time followed.
    pub(super) lasted: f64,
    /// The logarithm of the growth of the first vector.
    pub(super) grown: f64,
    /// MEGNO, averaged over the time.
    pub(super) megno: f64,
    /// By how many times it has grown since half of the time.
    pub(super) megno_growth: f64,
    /// The largest exponent and its uncertainty.
    pub(super) largest: f64,
    pub(super) uncertainty: f64,
}

impl Evidence<'_> {
    /// Why the motion is too short for a verdict, if it is.
    pub(super) fn too_short(&self) -> Option<String> {
        let least = if self.motion.fixed { 10 * STEPS } else { STEPS };
        (self.motion.steps < least).then(|| {
            format!("the motion is too short: {} steps, and {least} are needed", self.motion.steps)
        })
    }

    /// The verdict and its reason.
    pub(super) fn verdict(&self) -> (Chaos, String) {
        let Evidence { grown, megno, .. } = *self;
        let (time, off) = (short(self.lasted), self.uncertainty);
        if has_separated(grown) && megno >= CHAOTIC && self.largest > 2.0 * off {
            let reason = format!(
                "neighbouring motions separate by e^{grown:.1} in a time of {time}, and MEGNO is {megno:.1}, \
                 where regular motion has 2"
            );
            return (Chaos::Chaotic, reason);
        }
        if megno < APPROACHING {
            return self.approaching();
        }
        let rises = megno > SETTLED && self.megno_growth > RISING;
        if !rises && megno <= REGULAR && grown < GROWTH + math::ln(self.motion.steps as f64) {
            let reason = format!(
                "neighbouring motions separate no faster than in proportion to time: MEGNO is \
                 {megno:.2}, and chaotic motion exceeds {CHAOTIC}"
            );
            return (Chaos::Regular, reason);
        }
        let between = megno > REGULAR && megno < CHAOTIC;
        let reason = if rises && megno <= REGULAR {
            format!(
                "MEGNO is {megno:.2} (regular up to {REGULAR}, chaotic from {CHAOTIC}), but rises in proportion to time, and λ is \
                 known to ± {off:.1e}: a longer time may tell"
            )
        } else if between {
            format!(
                "neighbouring motions separate by e^{grown:.1} in a time of {time} and MEGNO is {megno:.1}, between regular (up to \
                 {REGULAR}) and chaotic (from {CHAOTIC}): a longer time may tell"
            )
        } else {
            format!(
                "MEGNO is {megno:.1} (regular up to {REGULAR}, chaotic from {CHAOTIC}), but neighbouring motions separate by \
                 e^{grown:.1} in a time of {time}, and λ is known to ± {off:.1e}: a longer time may tell"
            )
        };
        (Chaos::Undecided, reason)
    }

    /// The verdict where MEGNO is far below that of motions whose neighbours neither part nor approach.
    fn approaching(&self) -> (Chaos, String) {
        let Evidence { grown, megno, largest, .. } = *self;
        let (time, off) = (short(self.lasted), self.uncertainty);
        if grown < 0.0 && largest < -2.0 * off {
            let reason = format!(
                "neighbouring motions approach each other, by e^{grown:.1} in a time of {time}: MEGNO is {megno:.1}"
            );
            return (Chaos::Regular, reason);
        }
        let reason = format!(
            "MEGNO is {megno:.1}, where regular motion has 2, but λ = {} ± {off:.1e} does not say that neighbouring motions \
             approach each other: a longer time may tell",
            short(largest)
        );
        (Chaos::Undecided, reason)
    }
}

/// Whether vectors that have grown by this power of e show that neighbours part exponentially.
pub(super) fn has_separated(grown: f64) -> bool {
    grown >= GROWTH
}

/// Whether a motion goes away from its start as its neighbours part: by these powers of e in the second half of the time.
pub(super) fn is_escape(widening: f64, separation: f64) -> bool {
    separation > 1.0 && widening >= ESCAPE * separation
}

/// The time until which a motion from `begin` with this largest exponent would close if it does.
pub(super) fn last_closing(begin: f64, exponent: f64) -> f64 {
    begin + LOST / exponent
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::Settings;

    /// The verdict on a motion of 1000 steps of a series, with a growth, MEGNO and its growth, λ = 1 known to this.
    fn verdict(grown: f64, [megno, megno_growth]: [f64; 2], uncertainty: f64) -> Chaos {
        let motion = &CarriedMotion { settings: Settings::default(), fixed: false, steps: 1000 };
        let (lasted, largest) = (100.0, 1.0);
        let evidence =
            Evidence { motion, lasted, grown, megno, megno_growth, largest, uncertainty };
        evidence.verdict().0
    }

    #[test]
    fn chaos_needs_growth_by_e_to_the_8_and_megno_of_5_and_a_known_exponent() {
        assert_eq!(verdict(8.0, [5.0, 2.0], 0.49), Chaos::Chaotic);
        assert_eq!(verdict(7.99, [5.0, 2.0], 0.49), Chaos::Undecided);
        assert_eq!(verdict(8.0, [4.99, 2.0], 0.49), Chaos::Undecided);
        assert_eq!(verdict(8.0, [5.0, 2.0], 0.51), Chaos::Undecided);
    }

    #[test]
    fn a_motion_is_regular_up_to_megno_of_2_8_and_growth_by_e_to_the_8_times_the_steps() {
        assert_eq!(verdict(5.0, [2.8, 1.0], 0.1), Chaos::Regular);
        assert_eq!(verdict(5.0, [2.81, 1.0], 0.1), Chaos::Undecided);
        let most = 8.0 + math::ln(1000.0);
        assert_eq!(verdict(most - 0.01, [2.0, 1.0], 0.1), Chaos::Regular);
        assert_eq!(verdict(most + 0.01, [2.0, 1.0], 0.1), Chaos::Undecided);
    }

    #[test]
    fn megno_beyond_2_2_that_has_grown_by_a_half_is_not_that_of_regular_motion() {
        for (megno, growth, wanted) in [
            (2.19, 1.51, Chaos::Regular),
            (2.21, 1.49, Chaos::Regular),
            (2.21, 1.51, Chaos::Undecided),
        ] {
            assert_eq!(verdict(5.0, [megno, growth], 0.1), wanted, "{megno} grown by {growth}");
        }
    }

    /// Chaos is not decided by MEGNO below −1 alone, which is that of motions that approach each other.
    #[test]
    fn a_negative_megno_is_that_of_motions_that_approach() {
        let of = |megno: f64, grown: f64, largest: f64| {
            let motion =
                &CarriedMotion { settings: Settings::default(), fixed: false, steps: 1000 };
            let (lasted, megno_growth, uncertainty) = (100.0, 2.0, 0.1);
            Evidence { motion, lasted, grown, megno, megno_growth, largest, uncertainty }.verdict()
        };
        assert_eq!(of(-0.99, 0.1, 0.0).0, Chaos::Regular);
        assert_eq!(of(-1.01, 0.1, 0.0).0, Chaos::Undecided);
        for (grown, largest, wanted) in [
            (-88.0, -0.21, Chaos::Regular),
            (-88.0, -0.19, Chaos::Undecided),
            (0.1, -0.21, Chaos::Undecided),
            (3.0, 0.0, Chaos::Undecided),
        ] {
            let (verdict, reason) = of(-88.0, grown, largest);
            assert_eq!(verdict, wanted, "{reason}");
            assert_eq!(reason.contains("approach each other, by"), wanted == Chaos::Regular);
        }
    }

    #[test]
    fn a_verdict_needs_120_steps_of_a_series_or_1200_of_fixed_size() {
        for (fixed, steps, is_too_short) in
            [(false, 119, true), (false, 120, false), (true, 1199, true), (true, 1200, false)]
        {
            let motion = &CarriedMotion { settings: Settings::default(), fixed, steps };
            let evidence = Evidence {
                motion,
                lasted: 1.0,
                grown: 0.0,
                megno: 2.0,
                megno_growth: 1.0,
                largest: 0.0,
                uncertainty: 0.0,
            };
            assert_eq!(evidence.too_short().is_some(), is_too_short, "{steps}, fixed: {fixed}");
        }
    }

    #[test]
    fn a_motion_that_goes_away_half_as_fast_as_neighbours_part_escapes() {
        assert!(is_escape(5.0, 10.0));
        assert!(!is_escape(4.99, 10.0));
        // neighbours have hardly separated
        assert!(is_escape(1.0, 1.01) && !is_escape(1.0, 1.0));
    }

    #[test]
    fn a_motion_closes_before_neighbours_have_separated_by_e_to_the_20() {
        assert_eq!(last_closing(3.0, 0.5), 43.0);
        assert!(has_separated(8.0) && !has_separated(7.99));
    }
}
