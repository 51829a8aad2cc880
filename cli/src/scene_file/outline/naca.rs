//! NACA's sections of four and five digits in closed form.

use std::f64::consts::PI;

/// Points if the scene does not say.
pub const POINTS: usize = 161;
/// Points, least and most.
const LEAST: usize = 21;
const MOST: usize = 10_001;

/// What the tail is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tail {
    /// With the original coefficient .1015 it has a thickness of .0021/.2 of the section's.
    Blunt,
    /// With .1036 both surfaces meet.
    Sharp,
}

/// A mean line.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Camber {
    None,
    /// Greatest camber and its place.
    Four(f64, f64),
    /// Factor k₁ and place r.
    Five(f64, f64),
}

/// A section of chord 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Naca {
    thickness: f64,
    camber: Camber,
    tail: Tail,
}

/// Place of the greatest camber in twentieths of the chord, r and k₁ for a lift coefficient of 0.3 (Abbott and von Doenhoff).
const FIVE: [(u32, f64, f64); 5] =
    [(1, 0.0580, 361.4), (2, 0.1260, 51.64), (3, 0.2025, 15.957), (4, 0.2900, 6.643), (5, 0.3910, 3.230)];

impl Naca {
    /// The section of a designation; the error says what is wrong with it.
    pub fn new(designation: &str, tail: Tail) -> Result<Self, String> {
        let text = designation.trim();
        let text = text.get(..4).filter(|t| t.eq_ignore_ascii_case("naca")).map_or(text, |_| text[4..].trim_start());
        let known =
            "known are those of four digits, such as 2412, and of five, 210 to 250 for the mean line, such as 23012";
        let digits: Option<Vec<u32>> = text.chars().map(|c| c.to_digit(10)).collect();
        let wrong = |why: &str| Err(format!("cannot be `{}`: {why}", designation.escape_debug()));
        let percent = |a: u32, b: u32| f64::from(10 * a + b) / 100.0;
        let (thickness, camber) = match digits.as_deref() {
            Some(&[0, 0, a, b]) => (percent(a, b), Camber::None),
            Some(&[0, ..] | &[_, 0, _, _]) if text.len() == 4 => {
                return wrong("camber and its place, the first two digits, are both 0 or neither");
            }
            Some(&[m, p, a, b]) => (percent(a, b), Camber::Four(f64::from(m) / 100.0, f64::from(p) / 10.0)),
            Some(&[_, _, 1, _, _]) => return wrong("mean lines with reflex are not known here"),
            Some(&[lift, place, 0, a, b]) if lift > 0 => match FIVE.iter().find(|(p, ..)| *p == place) {
                Some((_, r, k)) => (percent(a, b), Camber::Five(k * f64::from(lift) / 2.0, *r)),
                None => return wrong(known),
            },
            _ => return wrong(known),
        };
        if thickness == 0.0 {
            return wrong("the last two digits are the thickness in percent, which is 0");
        }
        Ok(Naca { thickness, camber, tail })
    }

    /// Half the thickness.
    fn half(&self, x: f64) -> f64 {
        let last = if self.tail == Tail::Sharp { 0.1036 } else { 0.1015 };
        5.0 * self.thickness * (0.2969 * x.sqrt() + x * (-0.1260 + x * (-0.3516 + x * (0.2843 - x * last))))
    }

    /// The mean line and its slope.
    fn mean(&self, x: f64) -> [f64; 2] {
        match self.camber {
            Camber::None => [0.0; 2],
            Camber::Four(m, p) if x < p => [m / (p * p) * x * (2.0 * p - x), 2.0 * m / (p * p) * (p - x)],
            Camber::Four(m, p) => {
                let f = m / ((1.0 - p) * (1.0 - p));
                [f * (1.0 - x) * (1.0 + x - 2.0 * p), 2.0 * f * (p - x)]
            }
            Camber::Five(k, r) if x < r => [
                k / 6.0 * x * (x * (x - 3.0 * r) + r * r * (3.0 - r)),
                k / 6.0 * (3.0 * x * (x - 2.0 * r) + r * r * (3.0 - r)),
            ],
            Camber::Five(k, r) => [k / 6.0 * r * r * r * (1.0 - x), -k / 6.0 * r * r * r],
        }
    }

    /// A point above (1) or below (−1) the mean line.
    fn point(&self, x: f64, side: f64) -> [f64; 2] {
        if x == 1.0 && self.tail == Tail::Sharp {
            return [1.0, 0.0];
        }
        let ([mean, slope], half) = (self.mean(x), side * self.half(x));
        let long = slope.hypot(1.0);
        [x - half * slope / long, mean + half / long]
    }

    /// Points from the tail over the upper side to the nose at the origin and back, counter-clockwise, crowding at both ends as
    /// cosines do. `count` is odd and counts the tail twice, so that a sharp tail, which is one point, gives one less.
    pub fn outline(&self, chord: f64, count: usize) -> Result<Vec<[f64; 2]>, String> {
        if !(LEAST..=MOST).contains(&count) || count.is_multiple_of(2) {
            return Err(format!("must be odd, from {LEAST} to {MOST}, both ends at the tail counted, but is {count}"));
        }
        let half = count / 2;
        let place = |i: usize| match i {
            i if i == half => 0.0,
            i => (0.5 * PI * i as f64 / half as f64).cos().powi(2),
        };
        let upper = (0..=half).map(|i| self.point(place(i), 1.0));
        let least = usize::from(self.tail == Tail::Sharp);
        let lower = (least..half).rev().map(|i| self.point(place(i), -1.0));
        Ok(upper.chain(lower).map(|[x, y]| [chord * x, chord * y]).collect())
    }
}
