//! The notices of an experiment to its user.
//!
//! In: sentences. Out: the newest of them. Never here: what they say.

/// The greatest number of stored notices.
const MOST: usize = 16;

/// The newest notices, and what is reported only once.
#[derive(Clone, Debug, Default)]
pub(super) struct Notices {
    /// The sentences, the newest last.
    pub(super) sentences: Vec<String>,
    reported: Vec<String>,
}

impl Notices {
    pub(super) fn push(&mut self, sentence: String) {
        if self.sentences.len() == MOST {
            self.sentences.remove(0);
        }
        self.sentences.push(sentence);
    }

    /// Adds a sentence about an occurrence of this name, unless there was one before.
    pub(super) fn push_once(&mut self, name: String, sentence: String) {
        if !self.reported.contains(&name) {
            self.reported.push(name);
            self.push(sentence);
        }
    }

    /// Removes the last sentence if it begins with these words, since a newer one replaces it.
    pub(super) fn withdraw(&mut self, lead: &str) {
        self.sentences.pop_if(|last| last.starts_with(lead));
    }
}
