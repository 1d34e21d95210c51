//! Shards put together: the bytes of the sweep without shards.
//!
//! In: the files of all shards. Out: one file. Never here: rows computed.

use std::io;
use std::path::{Path, PathBuf};

use super::identity::{Identity, Shard};
use crate::cli::error::CommandError;
use crate::cli::output::{Output, OutputForm};
use crate::file;
use crate::printable;

struct ReadShard {
    path: PathBuf,
    identity: Identity,
    shard: Shard,
    /// The lines before the rows, without that of the identity.
    head: Vec<String>,
    rows: Vec<String>,
}

pub(super) fn execute(paths: &[PathBuf], output: Option<&Path>) -> Result<(), CommandError> {
    let mut parts = paths.iter().map(|path| read(path)).collect::<Result<Vec<ReadShard>, _>>()?;
    parts.sort_by_key(|part| part.shard.index);
    let Some(first) = parts.first() else { return Ok(()) };
    let wrong = |message: String| Err(CommandError::WrongUse(message));
    let of = first.shard.of;
    for part in &parts[1..] {
        let same = part.identity.digest == first.identity.digest
            && part.identity.rows == first.identity.rows
            && part.shard.of == of
            && part.head == first.head;
        if !same {
            let [one, other] = [&first.path, &part.path].map(|path| printable::path(path));
            return wrong(format!("{one} and {other} are not shards of one sweep"));
        }
    }
    if let Some(two) = parts.windows(2).find(|two| two[0].shard == two[1].shard) {
        let [one, other] = [&two[0].path, &two[1].path].map(|path| printable::path(path));
        return wrong(format!("{one} and {other} are the same shard"));
    }
    if let Some(missing) = (1..=of).find(|&i| !parts.iter().any(|p| p.shard.index == i)) {
        return wrong(format!("shard {missing} of {of} is missing"));
    }
    let rows = first.identity.rows;
    for part in &parts {
        let (found, expected) = (part.rows.len(), part.shard.count(rows));
        if found != expected {
            let path = printable::path(&part.path);
            return wrong(format!("{path} has {found} of {expected} rows"));
        }
    }
    let whole = Identity { shard: None, ..first.identity.clone() };
    let (lead, names) = first.head.split_at(first.head.len() - 1);
    let mut text = lead.iter().flat_map(|line| [line.as_str(), "\n"]).collect::<String>();
    text += &format!("{}\n{}\n", whole.line(), names[0]);
    for row in 0..rows {
        text += &parts[row % of].rows[row / of];
        text.push('\n');
    }
    Output::open(output, OutputForm::Text)?.write_text(&text)
}

fn read(path: &Path) -> Result<ReadShard, CommandError> {
    let failed = |error: io::Error| CommandError::reading(path, &error);
    let (bytes, _) = file::read(path, u64::MAX).map_err(failed)?;
    let text = String::from_utf8(bytes)
        .map_err(|_| failed(io::Error::new(io::ErrorKind::InvalidData, "it is not UTF-8")))?;
    let no_shard = || {
        let path = printable::path(path);
        CommandError::WrongUse(format!("{path} is not a complete shard of a sweep"))
    };
    let (mut head, mut identity) = (Vec::new(), None);
    let mut lines = text.lines();
    for line in lines.by_ref() {
        match Identity::read(line) {
            Some(found) => identity = Some(found),
            None => head.push(line.to_owned()),
        }
        if !line.starts_with('#') {
            break;
        }
    }
    let identity = identity.ok_or_else(no_shard)?;
    let shard = identity.shard.ok_or_else(no_shard)?;
    if head.last().is_none_or(|names| names.starts_with('#')) {
        return Err(no_shard());
    }
    let rows = lines.filter(|line| !line.starts_with('#')).map(str::to_owned).collect();
    Ok(ReadShard { path: path.to_owned(), identity, shard, head, rows })
}
