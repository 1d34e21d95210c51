//! Which sweep a file belongs to: a digest of everything that its rows depend on.
//!
//! In: a table. Out: one `#` line, the same for all shards but for their number. Never here: rows.

use super::table::SweepTable;
use crate::num::digest;

/// One part of a sweep: every Nth row, from the Ith on, counted from 1.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Shard {
    pub(super) index: usize,
    pub(super) of: usize,
}

impl Shard {
    /// The row of the table at a place of the shard, both from 0.
    pub(super) fn row(self, place: usize) -> usize {
        self.index - 1 + place * self.of
    }

    pub(super) fn count(self, rows: usize) -> usize {
        if self.index > rows { 0 } else { (rows - self.index) / self.of + 1 }
    }
}

/// The identity of a sweep, or of a shard of one.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Identity {
    /// The version of the program and a digest.
    pub(super) digest: String,
    /// The rows of the whole sweep.
    pub(super) rows: usize,
    pub(super) shard: Option<Shard>,
}

/// What begins the line.
const LEAD: &str = "# sweep: ";

impl Identity {
    pub(super) fn of(table: &SweepTable, shard: Option<Shard>) -> Identity {
        let digest = format!("{:016x}", digest(&table.everything()));
        Identity { digest, rows: table.count(), shard }
    }

    pub(super) fn line(&self) -> String {
        let Identity { digest, rows, shard } = self;
        let shard = shard.map_or(String::new(), |s| format!(" shard={}/{}", s.index, s.of));
        format!("{LEAD}digest={digest} rows={rows}{shard}")
    }

    pub(super) fn read(line: &str) -> Option<Identity> {
        let mut fields = line.strip_prefix(LEAD)?.split(' ');
        let digest = fields.next()?.strip_prefix("digest=")?.to_owned();
        let rows = fields.next()?.strip_prefix("rows=")?.parse().ok()?;
        let shard = match fields.next() {
            Some(field) => Some(field.strip_prefix("shard=")?.parse().ok()?),
            None => None,
        };
        Some(Identity { digest, rows, shard })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_have_each_row_once() {
        for rows in [0, 1, 7, 12] {
            for of in 1..6 {
                let shards = (1..=of).map(|index| Shard { index, of });
                let mut all: Vec<usize> =
                    shards.flat_map(|s| (0..s.count(rows)).map(move |p| s.row(p))).collect();
                all.sort_unstable();
                assert_eq!(all, (0..rows).collect::<Vec<_>>(), "{rows} in {of}");
            }
        }
    }

    #[test]
    fn a_line_reads_back() {
        for shard in [None, Some(Shard { index: 3, of: 8 })] {
            let identity = Identity { digest: "0123456789abcdef".to_owned(), rows: 9, shard };
            assert_eq!(Identity::read(&identity.line()), Some(identity));
        }
        assert_eq!(Identity::read("# sweep: digest=1 rows=x"), None);
        assert_eq!(Identity::read("x,y"), None);
    }
}
