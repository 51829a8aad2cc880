//! Bytes read as numbers, most of them ordinary, so that many scenes are valid.

/// A reader of bytes; zeros after the last.
pub struct Bytes<'a> {
    rest: &'a [u8],
}

impl<'a> Bytes<'a> {
    /// From the first byte on.
    pub fn new(bytes: &'a [u8]) -> Self {
        Bytes { rest: bytes }
    }

    /// Whether there is no more.
    pub fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    /// The next byte.
    pub fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.rest.split_first() else { return 0 };
        self.rest = rest;
        *first
    }

    /// The next eight bytes.
    pub fn word(&mut self) -> u64 {
        (0..8).fold(0, |word, _| word << 8 | u64::from(self.byte()))
    }

    /// True once in about 256 / `often` times.
    pub fn chance(&mut self, often: u8) -> bool {
        // A byte of zero, as after the end, is the ordinary case.
        self.byte() > 255 - often
    }

    /// 0 … n − 1.
    pub fn below(&mut self, n: usize) -> usize {
        usize::from(self.byte()) % n
    }

    /// A kind 0 … n − 1, or seldom any number.
    pub fn kind(&mut self, n: usize) -> i32 {
        if self.chance(3) { self.word() as i32 } else { self.below(n) as i32 }
    }

    /// A number near the ordinary one; seldom a special or any one.
    pub fn real(&mut self, ordinary: f64) -> f64 {
        const SPECIAL: [f64; 16] = [
            0.0,
            -0.0,
            1.0,
            -1.0,
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::MAX,
            f64::MIN_POSITIVE,
            1e-300,
            1e300,
            1e-30,
            1e30,
            3.4e38,
            1e-12,
            1e5,
        ];
        match self.byte() {
            0..=150 => ordinary,
            byte @ 151..=249 => ordinary * (0.5 + f64::from(byte - 150) / 66.0),
            250..=253 => SPECIAL[self.below(SPECIAL.len())],
            _ => f64::from_bits(self.word()),
        }
    }

    /// The same for a count.
    pub fn count(&mut self, ordinary: usize) -> usize {
        if self.chance(3) { self.word() as usize } else { ordinary }
    }
}

/// Pseudo-random bytes, the same for the same seed on every machine.
pub struct Random(u64);

impl Random {
    /// Of a seed.
    pub fn new(seed: u64) -> Self {
        Random(seed)
    }

    /// The next number (splitmix64).
    pub fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A script for [`crate::run`]. In some, ordinary numbers are the more frequent.
    pub fn script(&mut self) -> Vec<u8> {
        let length = 64 + self.word() as usize % 1024;
        let calm = self.word() % 4;
        (0..length)
            .map(|_| {
                let word = self.word();
                let byte = word as u8;
                // Bytes above 249 are the strange ones.
                if calm > 0 && byte > 249 && word >> 32 & 63 != 0 { byte - 100 } else { byte }
            })
            .collect()
    }
}
