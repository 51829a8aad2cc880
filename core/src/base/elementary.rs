//! Elementary functions without branches, calls and tables: a loop over many arguments compiles to vector instructions.
//!
//! They serve where nodes are placed and their preimages found. Within two units in the last place; arguments are finite.
//!
//! Tested by the tests at its end, against libm.

use crate::base::scalar::Real;

/// c₀ + c₁ x + …
#[inline(always)]
fn polynomial<R: Real, const N: usize>(x: R, c: [f64; N]) -> R {
    c.into_iter().rev().fold(R::zero(), |sum, c| sum * x + R::lit(c))
}

#[inline(always)]
fn select<R: Real>(condition: bool, yes: R, no: R) -> R {
    if condition { yes } else { no }
}

/// The nearest integer.
#[inline(always)]
pub(crate) fn nearest<R: Real>(x: R) -> R {
    (x + R::ROUNDER) - R::ROUNDER
}

/// Square root of a number that is 0 or normal.
#[inline(always)]
pub(crate) fn sqrt<R: Real>(x: R) -> R {
    let mut y = x.rough_rsqrt();
    for _ in 0..4 {
        y *= R::lit(1.5) - x * R::HALF * y * y;
    }
    let root = x * y;
    root + (x - root * root) * (y * R::HALF)
}

/// Sine for |x| ≤ π/4, relative to x.
#[inline(always)]
pub(crate) fn small_sine<R: Real>(x: R) -> R {
    let z = x * x;
    let tail = polynomial(
        z,
        [
            -1.666_666_666_666_663_2e-1,
            8.333_333_333_322_49e-3,
            -1.984_126_982_985_795e-4,
            2.755_731_370_707_006_8e-6,
            -2.505_076_025_340_686_3e-8,
            1.589_690_995_211_55e-10,
        ],
    );
    x + x * z * tail
}

/// Sine and cosine for |x| below 10⁵; to `EPSILON`, and sine to that relative to x.
#[inline(always)]
pub(crate) fn sin_cos<R: Real>(x: R) -> (R, R) {
    let n = nearest(x * R::lit(core::f64::consts::FRAC_2_PI));
    let [a, b, c] = R::HALF_PI;
    let r = ((x - n * a) - n * b) - n * c;
    let z = r * r;
    let sine = small_sine(r);
    let tail = polynomial(
        z,
        [
            4.166_666_666_666_66e-2,
            -1.388_888_888_887_411e-3,
            2.480_158_728_947_673e-5,
            -2.755_731_435_139_066_3e-7,
            2.087_572_321_298_175e-9,
            -1.135_964_755_778_819_5e-11,
        ],
    );
    let cosine = R::one() - z * R::HALF + z * z * tail;
    // Quadrant −2 … 2.
    let m = n - R::lit(4.0) * nearest(n * R::lit(0.25));
    let odd = m.abs() > R::HALF && m.abs() < R::lit(1.5);
    let (s, c) = (select(odd, cosine, sine), select(odd, sine, cosine));
    let below = m < -R::HALF || m > R::lit(1.5);
    let left = m > R::HALF || m < R::lit(-1.5);
    (select(below, -s, s), select(left, -c, c))
}

/// Angle of the point (x, y) ≠ 0, in [−π, π].
#[inline(always)]
pub(crate) fn atan2<R: Real>(y: R, x: R) -> R {
    let (ax, ay) = (x.abs(), y.abs());
    let steep = ay > ax;
    let (low, high) = (select(steep, ax, ay), select(steep, ay, ax));
    // tan(π/8)
    let wide = low > high * R::lit(0.414_213_562_373_095_03);
    let q = select(wide, low - high, low) / select(wide, low + high, high);
    let z = q * q;
    let tail = polynomial(
        z,
        [
            -0.333_333_333_333_333_3,
            0.199_999_999_999_998,
            -0.142_857_142_856_593_27,
            0.111_111_111_051_067_04,
            -0.090_909_087_510_765_97,
            0.076_922_963_049_735_5,
            -0.066_664_236_280_552_8,
            0.058_789_145_442_614_44,
            -0.052_303_478_721_123_31,
            0.045_511_081_226_396_58,
            -0.034_558_092_465_728_12,
            0.016_271_944_664_995_414,
        ],
    );
    let mut angle = q + q * z * tail;
    angle += select(wide, R::lit(core::f64::consts::FRAC_PI_4), R::zero());
    angle = select(steep, R::lit(core::f64::consts::FRAC_PI_2) - angle, angle);
    angle = select(x < R::zero(), R::PI - angle, angle);
    select(y < R::zero(), -angle, angle)
}

/// ln(1 + x) for x > −1, to relative accuracy near 0.
#[inline(always)]
pub(crate) fn ln_1p<R: Real>(x: R) -> R {
    let sum = R::one() + x;
    let [m, exponent] = sum.split();
    let plain = exponent == R::zero();
    let f = select(plain, x, m - R::one());
    // What rounding took from 1 + x.
    let lost = select(plain, R::zero(), select(x > R::one(), R::one() - (sum - x), x - (sum - R::one())) / sum);
    let s = f / (R::TWO + f);
    let z = s * s;
    let tail = z * polynomial(
        z,
        [
            6.666_666_666_666_735e-1,
            3.999_999_999_940_942e-1,
            2.857_142_874_366_239e-1,
            2.222_219_843_214_978_4e-1,
            1.818_357_216_161_805e-1,
            1.531_383_769_920_937_3e-1,
            1.479_819_860_511_658_6e-1,
        ],
    );
    let half = f * f * R::HALF;
    let [high, low] = R::LN_2;
    exponent * high - ((half - (s * (half + tail) + (exponent * low + lost))) - f)
}

/// e^x − 1 to relative accuracy near 0, and e^x. An x below the range of exponents counts as its end.
#[inline(always)]
pub(crate) fn exp_m1<R: Real>(x: R) -> (R, R) {
    // 2^n stays normal.
    let x = select(x < R::lit(-80.0), R::lit(-80.0), x);
    let n = nearest(x * R::lit(core::f64::consts::LOG2_E));
    let [high, low] = R::LN_2;
    let r = (x - n * high) - n * low;
    let tail = polynomial(
        r,
        [
            1.0 / 2.0,
            1.0 / 6.0,
            1.0 / 24.0,
            1.0 / 120.0,
            1.0 / 720.0,
            1.0 / 5040.0,
            1.0 / 40320.0,
            1.0 / 362_880.0,
            1.0 / 3_628_800.0,
            1.0 / 39_916_800.0,
            1.0 / 479_001_600.0,
            1.0 / 6_227_020_800.0,
        ],
    );
    let small = r + r * r * tail;
    let scale = n.power_of_two();
    let less = small * scale + (scale - R::one());
    (less, small * scale + scale)
}

/// The square root with real part ≥ 0 of x + i y.
#[inline(always)]
pub(crate) fn csqrt<R: Real>([x, y]: [R; 2]) -> [R; 2] {
    let size = sqrt(x * x + y * y);
    let large = sqrt((size + x.abs()) * R::HALF);
    let small = y * R::HALF / select(large > R::TINY, large, R::one());
    let right = x >= R::zero();
    [select(right, large, small.abs()), select(right, small, select(y < R::zero(), -large, large))]
}

/// Product of two complex numbers.
#[inline(always)]
pub(crate) fn product<R: Real>(a: [R; 2], b: [R; 2]) -> [R; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// Quotient of two complex numbers.
#[inline(always)]
pub(crate) fn quotient<R: Real>(a: [R; 2], b: [R; 2]) -> [R; 2] {
    let inverse = R::one() / (b[0] * b[0] + b[1] * b[1]);
    [(a[0] * b[0] + a[1] * b[1]) * inverse, (a[1] * b[0] - a[0] * b[1]) * inverse]
}

/// ln(1 + x + i y) to relative accuracy near 0.
#[inline(always)]
pub(crate) fn cln_1p<R: Real>([x, y]: [R; 2]) -> [R; 2] {
    [ln_1p(x * (R::TWO + x) + y * y) * R::HALF, atan2(y, R::one() + x)]
}

/// Principal arc tangent of x + i y, to relative accuracy near 0 in the whole.
#[inline(always)]
pub(crate) fn catan<R: Real>([x, y]: [R; 2]) -> [R; 2] {
    let below = R::one() - y;
    let re = atan2(x + x, (R::one() + y) * below - x * x) * R::HALF;
    [re, ln_1p(R::lit(4.0) * y / (x * x + below * below)) * R::lit(0.25)]
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec::Vec;

    /// Numbers of both signs over 16 decades.
    fn many(from: f64, to: f64) -> Vec<f64> {
        let decades = (to / from).log10();
        (0..20_000).map(|i| from * 10f64.powf(decades * f64::from(i) / 2e4)).flat_map(|x| [x, -x]).collect()
    }

    fn close<R: Real>(got: R, exact: f64, scale: f64, name: &str) {
        let error = (got.to_f64() - exact).abs() / (scale * R::EPSILON.to_f64());
        assert!(error <= 2.0, "{name}: {got} instead of {exact}, {error} units");
    }

    fn agree<R: Real>() {
        for x in many(1e-12, 500.0) {
            let (x, y) = (R::lit(x), R::lit(x).to_f64());
            let (s, c) = sin_cos(x);
            close(s, y.sin(), y.abs().min(1.0), "sin");
            close(c, y.cos(), 1.0, "cos");
            close(atan2(x, R::lit(0.7)), y.atan2(R::lit(0.7).to_f64()), y.atan2(0.7).abs(), "atan2");
            close(atan2(x, R::lit(-0.7)), y.atan2(R::lit(-0.7).to_f64()), 3.0, "atan2");
            let (m, e) = exp_m1(select(x > R::lit(60.0), R::lit(60.0), x));
            let y60 = if y > 60.0 { 60.0 } else { y };
            if y60 > -60.0 {
                close(m, y60.exp_m1(), y60.exp_m1().abs(), "exp_m1");
                close(e, y60.exp(), y60.exp(), "exp");
            }
            if y > 0.0 {
                close(sqrt(x), y.sqrt(), y.sqrt(), "sqrt");
            }
            if y > -0.999 {
                close(ln_1p(x), y.ln_1p(), y.ln_1p().abs(), "ln_1p");
            }
        }
        assert_eq!(sqrt(R::zero()), R::zero());
    }

    #[test]
    fn functions_agree_with_the_librarys_within_two_units_in_double_precision() {
        agree::<f64>();
    }

    #[test]
    fn functions_agree_with_the_librarys_within_two_units_in_single_precision() {
        agree::<f32>();
    }

    fn roots_agree<R: Real>() {
        for x in many(1e-12, 500.0).into_iter().filter(|x| *x > 0.0).map(R::lit) {
            let exact = x.to_f64().sqrt();
            let error = (sqrt(x).to_f64() - exact).abs() / (exact * R::EPSILON.to_f64());
            assert!(error <= 1.0, "{x}: {error} units");
        }
    }

    #[test]
    fn square_roots_are_wrong_by_at_most_one_unit() {
        roots_agree::<f64>();
        roots_agree::<f32>();
    }

    #[test]
    fn complex_functions_agree_with_the_complex_modules() {
        use crate::base::complex;
        for (i, r) in many(1e-9, 0.9).into_iter().enumerate() {
            let z = complex::cis(i as f64) * r;
            let near = |got: [f64; 2], exact: complex::Complex<f64>, name: &str| {
                let error = complex::cabs(complex::complex(got[0], got[1]) - exact) / complex::cabs(exact);
                assert!(error < 2e-15, "{name}({z}): {error}");
            };
            near(csqrt([z.re, z.im]), complex::csqrt(z), "sqrt");
            near(cln_1p([z.re, z.im]), complex::cln_1p(z), "ln_1p");
            near(catan([z.re, z.im]), complex::catan(z), "atan");
            near(quotient([1.0, 2.0], [z.re, z.im]), complex::complex(1.0, 2.0) / z, "quotient");
        }
    }
}
