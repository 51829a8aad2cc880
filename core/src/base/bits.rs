//! Bits of floating-point numbers: roundings, exponents, first guesses. Tested by [`super::elementary`].

/// What a floating-point number's bits tell.
pub trait Bits: Sized {
    /// Added and subtracted, it rounds to the nearest integer.
    #[doc(hidden)]
    const ROUNDER: Self;
    /// π/2 in three parts, of which the first two have bits to spare for a factor.
    #[doc(hidden)]
    const HALF_PI: [Self; 3];
    /// ln 2 in two parts.
    #[doc(hidden)]
    const LN_2: [Self; 2];
    /// m and e with x = m 2^e, √½ ≤ m < √2, of a positive normal number.
    #[doc(hidden)]
    fn split(self) -> [Self; 2];
    /// 2^n of an integer in the range of exponents.
    #[doc(hidden)]
    fn power_of_two(self) -> Self;
    /// 1/√x to 4 %, of a positive number.
    #[doc(hidden)]
    fn rough_rsqrt(self) -> Self;
    /// Its bits, the lowest ones of the word.
    #[doc(hidden)]
    fn to_word(self) -> u64;
    /// The number of these bits; higher ones are lost.
    #[doc(hidden)]
    fn from_word(word: u64) -> Self;
}

macro_rules! bits {
    ($t:ident, $u:ident, $mantissa:literal, $bias:literal, $half:literal, $magic:literal, $pi:expr, $ln:expr) => {
        impl Bits for $t {
            const ROUNDER: Self = 1.5 * (1u64 << $mantissa) as $t;
            const HALF_PI: [Self; 3] = $pi;
            const LN_2: [Self; 2] = $ln;
            #[inline(always)]
            fn split(self) -> [Self; 2] {
                const TWO_TO: $t = (1u64 << $mantissa) as $t;
                let bits = self.to_bits();
                // Biased exponent of x/√½.
                let exponent = bits.wrapping_sub($half).wrapping_add($bias << $mantissa) >> $mantissa;
                let m = bits.wrapping_sub(exponent.wrapping_sub($bias) << $mantissa);
                [$t::from_bits(m), ($t::from_bits(exponent | TWO_TO.to_bits()) - TWO_TO) - $bias as $t]
            }
            #[inline(always)]
            fn power_of_two(self) -> Self {
                $t::from_bits((self + ((1u64 << $mantissa) + $bias) as $t).to_bits() << $mantissa)
            }
            #[inline(always)]
            fn rough_rsqrt(self) -> Self {
                $t::from_bits(($magic as $u).wrapping_sub(self.to_bits() >> 1))
            }
            #[inline]
            fn to_word(self) -> u64 {
                u64::from(self.to_bits())
            }
            #[inline]
            fn from_word(word: u64) -> Self {
                $t::from_bits(word as $u)
            }
        }
    };
}
bits!(
    f64,
    u64,
    52,
    1023,
    0x3fe6_a09e_667f_3bcd,
    0x5fe6_eb50_c7b5_37a9u64,
    [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21],
    [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10]
);
bits!(
    f32,
    u32,
    23,
    127,
    0x3f35_04f3,
    0x5f37_59dfu32,
    [1.570_312_5, 4.837_513e-4, 7.549_79e-8],
    [0.693_359_4, -2.121_944_4e-4]
);
