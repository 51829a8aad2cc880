//! Shapes as written in a scene file.

use nekton::scene::{Corners, Shape};

use super::outline::naca::{Naca, POINTS, Tail};
use super::outline::{Outline, noise, smooth, turn};
use super::reader::{Item, Outcome, Section};

/// A turn in degrees of a point of a smooth curve that is named.
const SHARP: f64 = 60.0;
/// Two points so many times closer than those beside them are named.
const TWINS: f64 = 50.0;
/// Points whose distances have fewer steps of the last digit than this one are too far from their origin.
const DIGITS: f64 = 1e3;

/// A shape with its own points.
#[derive(Clone, Debug, PartialEq)]
pub enum ShapeDef {
    /// `ellipse = [a, b]`
    Ellipse(f64, f64),
    /// `star = { radius, amplitude, lobes }`
    Star(f64, f64, usize),
    /// `rectangle = [width, height], radius = r`
    Rectangle(f64, f64, Option<f64>),
    /// `polygon = [[x, y], …], radius = r`
    Polygon(Vec<[f64; 2]>, Option<f64>),
    /// `curve = [[x, y], …]` or a file, or `naca = "2412"`
    Curve(Outline, CornersDef),
}

/// Which points of a curve are corners, as written.
#[derive(Clone, Debug, PartialEq)]
pub enum CornersDef {
    /// `corners = "auto"`, as without it: as found, or none.
    Word(Corners<'static>),
    /// `corners = [i, …]`
    At(Vec<usize>),
}

impl CornersDef {
    fn read(item: &Item<'_>, points: usize) -> Outcome<Self> {
        if item.is_text() {
            let none = item.word(&["auto", "none"])? == "none";
            return Ok(CornersDef::Word(if none { Corners::None } else { Corners::Auto }));
        }
        let one = |k: &Item<'_>| match k.count()? {
            n if n < points => Ok(n),
            n => {
                Err(k.problem(format!("is the number of a corner, but there are {points} points, counted from 0: {n}")))
            }
        };
        let mut all = item.list()?.iter().map(one).collect::<Outcome<Vec<_>>>()?;
        all.sort_unstable();
        match all.windows(2).find(|w| w[0] == w[1]) {
            Some(twice) => {
                Err(item.problem(format!("names the corner {} twice", twice[0])).hint("name every corner once"))
            }
            None => Ok(CornersDef::At(all)),
        }
    }
}

impl ShapeDef {
    /// Reads `shape = { … }`.
    pub fn read(item: &Item<'_>) -> Outcome<Self> {
        const KINDS: &[&str] = &["ellipse", "star", "rectangle", "polygon", "curve", "naca"];
        const KEYS: &[&str] = &[
            "ellipse",
            "star",
            "rectangle",
            "polygon",
            "curve",
            "naca",
            "radius",
            "chord",
            "points",
            "tail",
            "corners",
            "path",
            "smooth",
        ];
        let section = item.section("`shape`", KEYS)?;
        let (kind, value) = section.one_of(KINDS)?;
        let cornered = matches!(kind, "rectangle" | "polygon");
        let radius = match section.get("radius") {
            Some(r) if !cornered => return Err(r.problem("is for rectangles and polygons only")),
            Some(r) => Some(r.positive()?),
            None => None,
        };
        let stranger = ["chord", "points", "tail"].iter().find_map(|k| section.get(k)).filter(|_| kind != "naca");
        if let Some(other) = stranger {
            return Err(other.problem("is for `naca` only"));
        }
        let drawn = section.get("path");
        if let Some(p) = drawn.as_ref().filter(|_| kind != "curve" || !value.is_text()) {
            return Err(p.problem("is for `curve` with an SVG picture only"));
        }
        let corners = match section.get("corners") {
            Some(c) if !matches!(kind, "curve" | "naca") => return Err(c.problem("is for `curve` and `naca` only")),
            other => other,
        };
        let within = match section.get("smooth") {
            Some(s) if kind != "curve" => return Err(s.problem("is for `curve` only, whose points may scatter")),
            other => other,
        };
        let curve = |outline: Outline| {
            let corners = corners.as_ref().map(|c| CornersDef::read(c, outline.points.len())).transpose()?;
            // A picture knows its corners.
            let known = || outline.corners.clone().map_or(CornersDef::Word(Corners::Auto), CornersDef::At);
            let corners = corners.unwrap_or_else(known);
            let curve = ShapeDef::Curve(outline, corners);
            // A formula's points do not scatter.
            Ok(if kind == "curve" { curve.fitted(within.as_ref())? } else { curve })
        };
        let measures = || {
            let pair = value.pair()?;
            match pair.iter().find(|x| **x <= 0.0) {
                Some(x) => Err(value.problem(format!("needs two lengths greater than 0, but one is {x}"))),
                None => Ok(pair),
            }
        };
        Ok(match kind {
            "ellipse" => measures().map(|[a, b]| ShapeDef::Ellipse(a, b))?,
            "rectangle" => measures().map(|[w, h]| ShapeDef::Rectangle(w, h, radius))?,
            "star" => {
                let star = value.section("`star`", &["radius", "amplitude", "lobes"])?;
                let amplitude = star.need("amplitude")?;
                let size = amplitude.number()?;
                if size.abs() >= 1.0 {
                    return Err(amplitude.problem(format!("must lie between -1 and 1, but is {size}")));
                }
                let lobes = star.need("lobes")?;
                if lobes.count()? == 0 {
                    return Err(lobes.problem("must be at least 1, but is 0"));
                }
                ShapeDef::Star(star.need("radius")?.positive()?, size, lobes.count()?)
            }
            "naca" => curve(naca(&section, &value)?)?,
            "curve" if value.is_text() => curve(Outline::open(&value, drawn.as_ref())?)?,
            _ => {
                let points = value.points()?;
                if points.len() < 3 {
                    return Err(value.problem(format!("needs at least 3 points, but has {}", points.len())));
                }
                match kind {
                    "curve" => curve(Outline::of(points))?,
                    _ => ShapeDef::Polygon(points, radius),
                }
            }
        })
    }

    /// A curve whose scatter is known, and which is smoothed if that is asked for.
    fn fitted(self, within: Option<&Item<'_>>) -> Outcome<Self> {
        let mut corners = Vec::new();
        self.core().each_corner(|k| corners.push(k));
        let ShapeDef::Curve(mut outline, def) = self else { return Ok(self) };
        outline.noise = noise(&outline.points, &corners);
        let Some(item) = within else { return Ok(ShapeDef::Curve(outline, def)) };
        let distance = item.positive()?;
        if matches!(def, CornersDef::Word(Corners::Auto)) {
            // A turn that scatter makes is no corner.
            let sigma = outline.noise.map_or(0.0, |n| n.sigma);
            corners.retain(|k| smooth::stands_out(&outline.points, *k, sigma));
        }
        let smoothed = outline.smoothed(&corners, distance).map_err(|(why, hint)| item.problem(why).hint(hint))?;
        let def = if corners.is_empty() { CornersDef::Word(Corners::None) } else { CornersDef::At(corners) };
        Ok(ShapeDef::Curve(smoothed, def))
    }

    /// What would help against scatter that matters.
    pub fn scatter(&self) -> Option<String> {
        let ShapeDef::Curve(outline, _) = self else { return None };
        // Below the digits of the points their differences tell nothing.
        let size = outline.points.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
        let noise = outline.noise.filter(|n| n.matters && n.sigma > 1e-12 * size)?;
        let distance = noise.distance(outline.points.len());
        Some(format!(
            "its points scatter by about {:.0e} m across it: `smooth = {distance:.1e}` beside `curve` fits one within that distance of them",
            noise.sigma
        ))
    }

    /// The core's description of it.
    pub fn core(&self) -> Shape<'_, f64> {
        match self {
            ShapeDef::Ellipse(a, b) => Shape::Ellipse { a: *a, b: *b },
            ShapeDef::Star(radius, amplitude, lobes) => {
                Shape::Star { radius: *radius, amplitude: *amplitude, lobes: *lobes }
            }
            ShapeDef::Rectangle(width, height, radius) => {
                Shape::Rectangle { width: *width, height: *height, radius: *radius }
            }
            ShapeDef::Polygon(vertices, radius) => Shape::Polygon { vertices, radius: *radius },
            ShapeDef::Curve(outline, corners) => Shape::Curve {
                points: &outline.points,
                corners: match corners {
                    CornersDef::Word(word) => *word,
                    CornersDef::At(at) => Corners::At(at),
                },
            },
        }
    }

    /// The points of a curve at which it turns by more than smooth ones should, and is no corner; with the largest turn, in degrees.
    pub fn sharp(&self) -> Option<(Vec<usize>, f64)> {
        let ShapeDef::Curve(outline, _) = self else { return None };
        let (points, n) = (&outline.points, outline.points.len());
        let mut corners = vec![false; n];
        self.core().each_corner(|k| corners[k] = true);
        let turns = (0..n).filter(|k| !corners[*k]).map(|k| (k, turn(points, k)));
        let sharp: Vec<_> = turns.filter(|(_, turn)| *turn >= SHARP).collect();
        let most = sharp.iter().fold(0.0, |most: f64, (_, turn)| most.max(*turn));
        (!sharp.is_empty()).then(|| (sharp.into_iter().map(|(k, _)| k).collect(), most))
    }

    /// The first two neighbours among the points of a curve that are closer by far than to the points beside them.
    pub fn twins(&self) -> Option<(usize, usize)> {
        let ShapeDef::Curve(outline, _) = self else { return None };
        let (points, n) = (&outline.points, outline.points.len());
        let side = |k: usize| {
            let ([x, y], [u, v]) = (points[k % n], points[(k + 1) % n]);
            (u - x).hypot(v - y)
        };
        let twins = |k: &usize| side(*k) > 0.0 && TWINS * side(*k) < side(k + n - 1).min(side(k + 1));
        (0..n).find(twins).map(|k| (k, (k + 1) % n))
    }

    /// What to say of points so far from the origin of their drawing that their last digits are as large as a part of their distances.
    pub fn far(&self) -> Option<String> {
        let points = match self {
            ShapeDef::Curve(outline, _) => &outline.points,
            ShapeDef::Polygon(vertices, _) => vertices,
            _ => return None,
        };
        let first = points.first()?;
        let size = points.iter().fold(0.0, |s: f64, p| s.max((p[0] - first[0]).hypot(p[1] - first[1])));
        let digit = f64::EPSILON * first[0].abs().max(first[1].abs());
        let coarse = digit * DIGITS * points.len() as f64 > size;
        coarse.then(|| {
            format!(
                "they lie so far from the origin of their drawing that their coordinates are multiples of {digit:.0e}: draw it nearer to its \
                 origin"
            )
        })
    }

    /// What smoothing may have changed the added mass by.
    pub fn smoothing(&self) -> Option<f64> {
        let ShapeDef::Curve(outline, _) = self else { return None };
        outline.smoothing
    }

    /// What the user is told of points that the scene file does not show, and of points that scatter.
    pub fn told(&self) -> Option<String> {
        let ShapeDef::Curve(outline, _) = self else { return None };
        let all: Vec<String> = outline.told.clone().into_iter().chain(self.scatter()).collect();
        (!all.is_empty()).then(|| all.join("; "))
    }
}

/// Reads `naca = "2412", chord = 1.0`.
fn naca(section: &Section<'_>, value: &Item<'_>) -> Outcome<Outline> {
    if value.is_number() {
        return Err(value.problem("must be a string, but is a number").hint("write naca = \"2412\""));
    }
    let chord = section.need("chord")?.positive()?;
    let sharp = section.or("tail", "blunt", |t| t.word(&["blunt", "sharp"]))? == "sharp";
    let tail = if sharp { Tail::Sharp } else { Tail::Blunt };
    let naca = Naca::new(value.text()?, tail).map_err(|e| value.problem(e))?;
    let count = section.or("points", POINTS, Item::count)?;
    let points = naca.outline(chord, count);
    let points = points.map_err(|e| section.get("points").map_or_else(|| value.problem(&e), |p| p.problem(&e)))?;
    Ok(Outline::new(points, &format!("naca {}, {} tail", value.text()?.trim(), if sharp { "sharp" } else { "blunt" })))
}

/// Reads `nodes = n`: even and at least 8, or `"auto"`, as without it: 0, as the core has it.
pub fn nodes(item: Option<Item<'_>>) -> Outcome<usize> {
    let Some(item) = item else { return Ok(0) };
    if item.is_text() {
        return item.word(&["auto"]).map(|_| 0);
    }
    let n = item.count()?;
    if n >= 8 && n.is_multiple_of(2) {
        return Ok(n);
    }
    let near = (n + n % 2).max(8);
    Err(item.problem(format!("must be even and at least 8, but is {n}")).hint(format!("try {near}")))
}
