//! A digest of 64 bits of a sequence of words: of a scene's numbers, and of what was saved.
//!
//! Tested by the tests at its end, `setup/fingerprint.rs`, `tests/saving`.

use crate::base::scalar::Real;

/// The digest of the words so far. Each word changes it by a function that is one-to-one for a given word and for a given
/// digest: sequences of one length that differ in one word never have the same. Others have by chance, one in 2⁶⁴.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Digest(u64);

impl Digest {
    pub(crate) fn new() -> Self {
        Digest(0)
    }

    /// Adds a word.
    pub(crate) fn word(&mut self, word: u64) {
        // The last step of MurmurHash3, whose every output bit depends on every input bit; the constant keeps 0 from staying 0.
        let mut x = (self.0 ^ word).wrapping_add(0x9e37_79b9_7f4a_7c15);
        x = (x ^ (x >> 33)).wrapping_mul(0xff51_afd7_ed55_8ccd);
        x = (x ^ (x >> 33)).wrapping_mul(0xc4ce_b9fe_1a85_ec53);
        self.0 = x ^ (x >> 33);
    }

    /// Adds a number, as the bits of the same number in double precision: 0 and −0 differ.
    pub(crate) fn real<R: Real>(&mut self, x: R) {
        self.word(x.to_f64().to_bits());
    }

    /// Adds a count, an index or the number of a case.
    pub(crate) fn count(&mut self, n: usize) {
        self.word(n as u64);
    }

    /// Adds a text, its end included.
    pub(crate) fn text(&mut self, text: &str) {
        self.count(text.len());
        text.bytes().for_each(|byte| self.word(u64::from(byte)));
    }

    /// The digest; more words may follow.
    pub(crate) fn value(&self) -> u64 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(words: &[u64]) -> u64 {
        let mut digest = Digest::new();
        words.iter().for_each(|w| digest.word(*w));
        digest.value()
    }

    #[test]
    fn every_bit_of_every_word_changes_about_half_the_bits() {
        let words = [0, 1, 0x8000_0000_0000_0000, 0.1_f64.to_bits()];
        for i in 0..words.len() {
            for bit in 0..64 {
                let mut other = words;
                other[i] ^= 1 << bit;
                let changed = (of(&words) ^ of(&other)).count_ones();
                assert!((12..=52).contains(&changed), "word {i} bit {bit}: {changed}");
            }
        }
    }

    #[test]
    fn order_and_length_count() {
        assert_ne!(of(&[1, 2]), of(&[2, 1]));
        assert_ne!(of(&[0]), of(&[0, 0]));
        assert_ne!(of(&[]), of(&[0]));
    }

    #[test]
    fn it_is_the_same_on_every_machine_and_in_every_version() {
        assert_eq!(of(&[1, 2, 3]), GOLDEN);
    }

    /// Computed by another program: what is saved outlives a build.
    const GOLDEN: u64 = 0x2656_bf6c_8d05_872d;
}
