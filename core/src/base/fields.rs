//! Fields of records, walked one by one in a fixed order: the same walk counts, writes and reads them. Every record is taken
//! apart without `..`, so that a new field cannot be forgotten.
//!
//! Tested by `tests/saving`, `simulation/saved.rs`.

use crate::base::scalar::Real;

/// Counts that are read are below this: adding steps to them does not overflow.
const MOST: u64 = 1 << 62;

/// What is done with fields that are walked. Each is a word of 64 bits; what is read may be anything, and what no record could
/// hold is refused: the record is then of no use.
pub(crate) trait Fields<R: Real> {
    /// A word.
    fn word(&mut self, name: &'static str, x: &mut u64);

    /// The value of this field is impossible.
    fn refuse(&mut self, name: &'static str);

    /// Refuses what is not as it must be.
    fn require(&mut self, name: &'static str, holds: bool) {
        if !holds {
            self.refuse(name);
        }
    }

    /// Any number, bit for bit.
    fn real(&mut self, name: &'static str, x: &mut R) {
        let mut word = x.to_word();
        self.word(name, &mut word);
        *x = R::from_word(word);
        self.require(name, x.to_word() == word);
    }

    /// A finite number.
    fn finite(&mut self, name: &'static str, x: &mut R) {
        self.real(name, x);
        self.require(name, x.is_finite());
    }

    /// A number ≥ 0, maybe infinite.
    fn at_least_zero(&mut self, name: &'static str, x: &mut R) {
        self.real(name, x);
        self.require(name, *x >= R::zero());
    }

    /// A count of what goes on.
    fn total(&mut self, name: &'static str, x: &mut u64) {
        self.word(name, x);
        self.require(name, *x <= MOST);
    }

    /// A count of at most `most`.
    fn count(&mut self, name: &'static str, x: &mut usize, most: usize) {
        let mut word = *x as u64;
        self.word(name, &mut word);
        self.require(name, word <= most as u64);
        *x = most.min(word.min(u64::from(u32::MAX)) as usize);
    }

    /// Yes or no.
    fn flag(&mut self, name: &'static str, x: &mut bool) {
        let mut word = u64::from(*x);
        self.word(name, &mut word);
        self.require(name, word <= 1);
        *x = word == 1;
    }
}
