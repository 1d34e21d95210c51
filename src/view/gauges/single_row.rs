//! The columns of a gauge in a single row: a name, a value, a drift and a verdict.
//!
//! In: the width of the row, of the longest name and of the longest verdict. Out: where each column begins. Never here: gauges.

/// The width of a verdict, and the least of one beside a long name.
pub(super) const VERDICT: u16 = 8;
const LEAST_VERDICT: u16 = 5;

/// The width of a drift, and the least and the most of a value: four digits, with an exponent where names leave room.
pub(super) const DRIFT: u16 = 8;
const VALUE: u16 = 8;
const MOST_VALUE: u16 = 11;

/// Where the columns begin. A name says more than a drift, which the page of numbers has too and which gives way to names that are
/// long, as what room the verdicts leave does.
#[derive(Clone, Copy)]
pub(super) struct SingleRow {
    pub(super) value: u16,
    pub(super) value_width: u16,
    pub(super) drift: Option<u16>,
    pub(super) verdict: u16,
    pub(super) residual: bool,
}

impl SingleRow {
    /// The columns of a row of this width, for names and verdicts of these widths.
    pub(super) fn of(width: u16, longest: usize, widest: u16) -> SingleRow {
        let verdict = width.saturating_sub(widest.max(VERDICT));
        let drift = verdict.saturating_sub(DRIFT + 1);
        let value = drift.saturating_sub(VALUE + 1);
        // a value ends at the same column, and begins where the names leave room
        let row = |value: u16, drift, verdict| {
            let spare = value.saturating_sub(u16::try_from(longest + 1).unwrap_or(u16::MAX));
            let more = spare.min(MOST_VALUE - VALUE);
            let (value, value_width) = (value - more, VALUE + more);
            SingleRow { value, value_width, drift, verdict, residual: false }
        };
        if longest < usize::from(value) {
            return row(value, Some(drift), verdict);
        }
        let value = verdict.saturating_sub(VALUE + 1);
        if longest < usize::from(value) {
            return row(value, None, verdict);
        }
        let verdict = width.saturating_sub(widest.max(LEAST_VERDICT));
        row(verdict.saturating_sub(VALUE + 1), None, verdict)
    }

    pub(super) fn verdicts(self, width: u16) -> u16 {
        width.saturating_sub(self.verdict)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A value has up to eleven columns of what names leave, and ends before the next column.
    #[test]
    fn a_value_has_room_for_its_exponent_where_names_leave_it() {
        for (longest, width) in [(3, 11), (12, 11), (17, 9)] {
            let row = SingleRow::of(36, longest, 8);
            assert_eq!(row.value_width, width, "{longest}");
            assert!(usize::from(row.value) > longest, "{longest}: {}", row.value);
            let next = row.drift.unwrap_or(row.verdict);
            assert!(row.value + row.value_width < next, "{longest}: {} before {next}", row.value);
        }
    }
}
