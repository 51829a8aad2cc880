//! Checks of a scene's definition, before anything is made of it.

use crate::convert;
use crate::diag::{Fault, Outcome};
use crate::shared::NEKTON_ABI_VERSION;
use crate::sized::{self, Defs};
use crate::types::{BodyDef, LinkDef, SceneDef, WallDef};
use nekton::scene::{Body, Description, Drive, Link, Root, Scene, Shape, Signal, Wall};
use nekton::{Place, Real, Status};

/// A checked definition: the core reads it item by item.
pub(crate) struct Checked<'a, R> {
    settings: Scene<'a, R>,
    tank: Defs<'a, WallDef<R>>,
    obstacles: Defs<'a, WallDef<R>>,
    bodies: Defs<'a, BodyDef<R>>,
}

impl<R: Real> Checked<'_, R> {
    /// Checks a definition. Geometry is left to the core.
    pub(crate) unsafe fn new(def: *const SceneDef<R>) -> Outcome<Self> {
        convert::check_pointer("def", def)?;
        // SAFETY: not NULL, aligned; both numbers come first, so that nothing is read that another version does not have.
        let (size, version) = unsafe { ((*def).struct_size, (*def).abi_version) };
        if size != 0 && version != NEKTON_ABI_VERSION {
            return Err(Fault::of(Status::AbiVersion, "abi_version", f64::from(version)));
        }
        // SAFETY (all): the caller's promise.
        let def = unsafe { sized::one("def", def) }?;
        let settings = convert::settings(&def)?;
        for (what, x) in [
            ("fluid_density", def.fluid_density),
            ("gravity", def.gravity),
            ("repulsion_epsilon", def.repulsion_epsilon),
            ("repulsion_alpha", def.repulsion_alpha),
            ("tolerance", def.tolerance),
        ] {
            finite(what, x)?;
        }
        let walls = usize::from(!def.tank.is_null());
        let tank = unsafe { Defs::new("tank", def.tank, walls) }?;
        let obstacles = unsafe { Defs::new("obstacles", def.obstacles, def.obstacle_count) }?;
        let bodies = unsafe { Defs::new("bodies", def.bodies, def.body_count) }?;
        let of = |walls: &Defs<'_, WallDef<R>>, i: usize| unsafe { convert::wall(&walls.get(i)?) };
        for (defs, place) in [(&tank, (|_| Place::Tank) as fn(usize) -> Place), (&obstacles, Place::Obstacle)] {
            for i in 0..defs.count() {
                check_wall(of(defs, i)).map_err(|f| f.at(place(i)))?;
            }
        }
        for b in 0..bodies.count() {
            let links = bodies.get(b).and_then(|def| unsafe {
                check_body(convert::body(&def))?;
                Defs::new("links", def.links, def.link_count)
            });
            let links = links.map_err(|f| f.at(Place::Body(b)))?;
            for l in 0..links.count() {
                let link = links.get(l).and_then(|def| unsafe { convert::link(&def) });
                check_link(link).map_err(|f| f.at(Place::Link(b, l)))?;
            }
        }
        Ok(Checked { settings, tank, obstacles, bodies })
    }
}

impl<'a, R: Real> Checked<'a, R> {
    fn links(&self, b: usize) -> Option<Defs<'a, LinkDef<R>>> {
        let body = self.bodies.get(b).ok()?;
        // SAFETY: checked when this was made.
        unsafe { Defs::new("links", body.links, body.link_count) }.ok()
    }
}

fn finite<R: Real>(what: &'static str, x: R) -> Outcome {
    if x.is_finite() { Ok(()) } else { Err(Fault::of(Status::NotFinite, what, x.to_f64())) }
}

/// Refuses numbers that are not finite, naming the first by its number in the array.
fn all_finite<R: Real, const N: usize>(what: &'static str, items: impl Iterator<Item = [R; N]>) -> Outcome {
    for (i, item) in items.enumerate() {
        for x in item {
            finite(what, x).map_err(|f| Fault { item: i32::try_from(i).unwrap_or(i32::MAX), ..f })?;
        }
    }
    Ok(())
}

fn check_shape<R: Real>(shape: Shape<'_, R>) -> Outcome {
    match shape {
        Shape::Ellipse { a, b } => finite("a", a).and(finite("b", b)),
        Shape::Star { radius, amplitude, .. } => finite("radius", radius).and(finite("amplitude", amplitude)),
        Shape::Rectangle { width, height, radius } => {
            finite("width", width)?;
            finite("height", height)?;
            finite("corner_radius", radius.unwrap_or(R::zero()))
        }
        Shape::Polygon { vertices, radius } => {
            finite("corner_radius", radius.unwrap_or(R::zero()))?;
            all_finite("points", vertices.iter().copied())
        }
        Shape::Curve { points, .. } => all_finite("points", points.iter().copied()),
    }
}

fn check_signal<R: Real>(signal: Signal<'_, R>) -> Outcome {
    match signal {
        Signal::Constant(value) => finite("signal.value", value),
        Signal::Harmonic { terms, window } => {
            if let Some(w) = window {
                finite("window.from", w.from)?;
                finite("window.to", w.to)?;
                finite("window.ramp", w.ramp)?;
            }
            all_finite("harmonics", terms.iter().map(|h| [h.amplitude, h.frequency, h.phase, h.offset]))
        }
        Signal::Table(rows) => all_finite("rows", rows.iter().copied()),
        Signal::Channel => Ok(()),
    }
}

fn check_wall<R: Real>(wall: Outcome<Wall<'_, R>>) -> Outcome {
    let wall = wall?;
    check_shape(wall.shape)?;
    for x in wall.position {
        finite("position", x)?;
    }
    finite("angle", wall.angle)?;
    finite("circulation", wall.circulation)
}

fn check_body<R: Real>(body: Outcome<Body<'_, R>>) -> Outcome {
    let body = body?;
    for (what, values) in [("pose", body.pose), ("velocity", body.velocity)] {
        for x in values {
            finite(what, x)?;
        }
    }
    match body.root {
        Root::Free => Ok(()),
        Root::Prescribed(signals) => signals.into_iter().try_for_each(check_signal),
    }
}

/// What the core checks itself before it writes anything (masses, joints) is not checked twice.
fn check_link<R: Real>(link: Outcome<Link<'_, R>>) -> Outcome {
    let link = link?;
    check_shape(link.shape)?;
    finite("circulation", link.circulation)?;
    match link.joint.map(|j| j.drive) {
        Some(Drive::Motion(signal) | Drive::Torque { torque: signal, .. }) => check_signal(signal),
        _ => Ok(()),
    }
}

impl<R: Real> Description<R> for Checked<'_, R> {
    fn settings(&self) -> Scene<'_, R> {
        self.settings
    }
    fn tank(&self) -> Option<Wall<'_, R>> {
        // SAFETY (all): checked when this was made.
        self.tank.get(0).and_then(|w| unsafe { convert::wall(&w) }).ok()
    }
    fn obstacle_count(&self) -> usize {
        self.obstacles.count()
    }
    fn obstacle(&self, i: usize) -> Option<Wall<'_, R>> {
        self.obstacles.get(i).and_then(|w| unsafe { convert::wall(&w) }).ok()
    }
    fn body_count(&self) -> usize {
        self.bodies.count()
    }
    fn body(&self, b: usize) -> Option<Body<'_, R>> {
        self.bodies.get(b).and_then(|d| unsafe { convert::body(&d) }).ok()
    }
    fn link_count(&self, b: usize) -> usize {
        self.links(b).map_or(0, |links| links.count())
    }
    fn link(&self, b: usize, l: usize) -> Option<Link<'_, R>> {
        self.links(b)?.get(l).and_then(|d| unsafe { convert::link(&d) }).ok()
    }
}
