//! What a file asked for and is left out, gathered into one sentence per kind.

/// Counts occurrences, so that a scene with a thousand lines of one kind yields one note.
#[derive(Default)]
pub(super) struct Notes(Vec<(&'static str, String, usize)>);

impl Notes {
    /// Notes that `what` holds for `object`.
    pub fn add(&mut self, what: &'static str, object: &str) {
        match self.0.iter_mut().find(|(known, _, _)| *known == what) {
            Some((_, _, count)) => *count += 1,
            None => self.0.push((what, object.to_owned(), 1)),
        }
    }

    pub fn append(&mut self, mut other: Self) {
        self.0.append(&mut other.0);
    }

    /// One sentence per kind, in the order in which the kinds first occurred.
    pub fn into_sentences(self) -> Vec<String> {
        let sentence = |(what, first, count)| match count {
            1 => format!("{first}: {what}."),
            _ => format!("{first} and {} more: {what}.", count - 1),
        };
        self.0.into_iter().map(sentence).collect()
    }
}
