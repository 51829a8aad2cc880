//! A scene definition made of bytes. Pointers with counts are true, or NULL, or misaligned, never wild: what they point to is
//! the caller's duty.

use crate::bytes::Bytes;
use nekton_ffi::types::*;

/// A definition and everything that it points to.
pub struct Definition<R> {
    /// To be given to the library.
    pub def: SceneDef<R>,
    _tank: Vec<WallDef<R>>,
    _obstacles: Vec<WallDef<R>>,
    _bodies: Vec<BodyDef<R>>,
    _links: Vec<Vec<LinkDef<R>>>,
    store: Store<R>,
}

/// Arrays that definitions point to.
struct Store<R> {
    points: Vec<Vec<[R; 2]>>,
    harmonics: Vec<Vec<HarmonicDef<R>>>,
    rows: Vec<Vec<[R; 4]>>,
    corners: Vec<Vec<usize>>,
}

/// A true pointer; seldom NULL or misaligned.
fn pointer<T>(bytes: &mut Bytes<'_>, items: &[T]) -> *const T {
    if bytes.chance(2) {
        core::ptr::null()
    } else if bytes.chance(1) {
        items.as_ptr().wrapping_byte_add(1)
    } else {
        items.as_ptr()
    }
}

/// Zero in every field, as C's `{0}`.
pub fn zeroed<T: Copy>() -> T {
    // SAFETY: used for the interface's plain structs of numbers and pointers only.
    unsafe { core::mem::zeroed() }
}

/// Numbers of either precision.
pub trait Number: Copy {
    /// Rounded.
    fn of(x: f64) -> Self;
}
impl Number for f64 {
    fn of(x: f64) -> f64 {
        x
    }
}
impl Number for f32 {
    fn of(x: f64) -> f32 {
        x as f32
    }
}

impl<R: Number> Store<R> {
    fn shape(&mut self, bytes: &mut Bytes<'_>, size: f64) -> ShapeDef<R> {
        let mut real = |ordinary: f64| R::of(bytes.real(ordinary * size));
        let mut shape = ShapeDef {
            a: real(1.0),
            b: real(0.4),
            radius: real(0.8),
            width: real(1.5),
            height: real(0.8),
            ..zeroed::<ShapeDef<R>>()
        };
        shape.amplitude = R::of(bytes.real(0.2));
        shape.corner_radius = R::of(if bytes.below(2) == 0 { 0.0 } else { bytes.real(0.1 * size) });
        shape.lobes = if bytes.chance(3) { bytes.word() as u32 } else { 1 + bytes.below(5) as u32 };
        // Ellipses are the most frequent.
        shape.kind = match bytes.byte() {
            0..=99 => NEKTON_SHAPE_ELLIPSE,
            100..=250 => 1 + bytes.below(5) as i32,
            _ => bytes.kind(7),
        };
        let corners = 3 + bytes.below(8);
        let points = (0..corners).map(|i| {
            let angle = core::f64::consts::TAU * i as f64 / corners as f64;
            [R::of(bytes.real(size * angle.cos())), R::of(bytes.real(0.6 * size * angle.sin()))]
        });
        let points: Vec<_> = points.collect();
        shape.point_count = bytes.below(16).min(points.len());
        if bytes.below(4) != 0 {
            shape.point_count = points.len();
        }
        shape.points = pointer(bytes, &points);
        self.points.push(points);
        shape
    }

    fn signal(&mut self, bytes: &mut Bytes<'_>) -> SignalDef<R> {
        let mut signal = SignalDef { kind: bytes.kind(4), value: R::of(bytes.real(0.3)), ..zeroed::<SignalDef<R>>() };
        let terms: Vec<_> = (0..bytes.below(3))
            .map(|_| HarmonicDef {
                amplitude: R::of(bytes.real(0.3)),
                frequency: R::of(bytes.real(2.0)),
                phase: R::of(bytes.real(1.0)),
                offset: R::of(bytes.real(0.1)),
            })
            .collect();
        let rows = (0..bytes.below(4))
            .map(|i| [bytes.real(0.1 * i as f64), bytes.real(0.2), bytes.real(0.1), bytes.real(0.1)].map(R::of));
        let rows: Vec<_> = rows.collect();
        (signal.harmonics, signal.harmonic_count) = (pointer(bytes, &terms), terms.len());
        (signal.rows, signal.row_count) = (pointer(bytes, &rows), rows.len());
        if bytes.below(3) == 0 {
            let window = [bytes.real(0.05), bytes.real(1.0), bytes.real(0.1)].map(R::of);
            signal.window = WindowDef { from: window[0], to: window[1], ramp: window[2] };
        }
        self.harmonics.push(terms);
        self.rows.push(rows);
        signal
    }

    fn wall(&mut self, bytes: &mut Bytes<'_>, size: f64, place: [f64; 2]) -> WallDef<R> {
        WallDef {
            shape: self.shape(bytes, size),
            struct_size: own_size::<WallDef<R>>(bytes),
            position: place.map(|x| R::of(bytes.real(x))),
            angle: R::of(bytes.real(0.3)),
            nodes: nodes(bytes),
            circulation: R::of(if bytes.below(4) == 0 { bytes.real(0.5) } else { 0.0 }),
            ..zeroed::<WallDef<R>>()
        }
    }

    /// Kind, numbers and count of corners.
    fn corners(&mut self, bytes: &mut Bytes<'_>) -> (i32, *const usize, usize) {
        let mut number = || {
            let most = if bytes.chance(3) { 99 } else { 5 };
            bytes.below(most)
        };
        let numbers: Vec<usize> = (0..number().min(3)).map(|_| number()).collect();
        let all = (bytes.kind(3), pointer(bytes, &numbers), numbers.len());
        self.corners.push(numbers);
        all
    }

    fn link(&mut self, bytes: &mut Bytes<'_>, l: usize) -> LinkDef<R> {
        let side = if l.is_multiple_of(2) { 1.0 } else { -1.0 };
        let mut real = |ordinary: f64| R::of(bytes.real(ordinary));
        let mut link = LinkDef {
            density: real(1.2),
            mass: real(1.0),
            inertia: real(0.3),
            centre_of_mass: [real(0.05), real(0.0)],
            parent_anchor: [real(1.3 * side), real(0.0)],
            self_anchor: [real(-1.3 * side), real(0.0)],
            axis: [real(1.0), real(0.0)],
            angle: real(0.1),
            locked_value: real(0.2),
            stiffness: real(0.5),
            damping: real(0.1),
            rest: real(0.1),
            start: [real(0.1), real(0.0)],
            ..zeroed::<LinkDef<R>>()
        };
        link.parent = if l == 0 { -1 } else { bytes.below(l) as i32 };
        if bytes.chance(3) {
            link.parent = bytes.word() as i32;
        }
        link.circulation = R::of(if bytes.below(4) == 0 { bytes.real(0.5) } else { 0.0 });
        (link.mass_kind, link.joint, link.drive) = (bytes.kind(2), bytes.kind(2), bytes.kind(3));
        link.struct_size = own_size::<LinkDef<R>>(bytes);
        link.nodes = nodes(bytes);
        link.shape = self.shape(bytes, 1.0);
        link.signal = self.signal(bytes);
        (link.corners, link.corner_points, link.corner_count) = self.corners(bytes);
        link
    }
}

/// The size of a definition, or rubbish by which nothing may be read.
pub fn own_size<T>(bytes: &mut Bytes<'_>) -> u32 {
    let own = size_of::<T>() as u32;
    if !bytes.chance(2) {
        return own;
    }
    // A newer caller's size would be believed.
    Some(bytes.word() as u32).filter(|size| *size <= own || *size > 4096).unwrap_or(0)
}

fn nodes(bytes: &mut Bytes<'_>) -> usize {
    if bytes.chance(2) {
        return 0;
    }
    let ordinary = 8 + 2 * bytes.below(4);
    bytes.count(ordinary)
}

impl<R: Number> Definition<R> {
    /// Reads a definition. `version` is the one that the library asks for.
    pub fn new(bytes: &mut Bytes<'_>, version: u32) -> Self {
        let mut store = Store { points: Vec::new(), harmonics: Vec::new(), rows: Vec::new(), corners: Vec::new() };
        let tank: Vec<_> = (0..bytes.below(2)).map(|_| store.wall(bytes, 12.0, [2.0, 0.0])).collect();
        let obstacles = (0..bytes.below(3)).map(|i| store.wall(bytes, 0.7, [3.0 * i as f64, 3.2]));
        let obstacles: Vec<_> = obstacles.collect();
        let mut links: Vec<Vec<_>> = Vec::new();
        let count = 1 + bytes.below(3);
        let mut bodies = Vec::new();
        for b in 0..count {
            let chain = 1 + bytes.below(3);
            links.push((0..chain).map(|l| store.link(bytes, l)).collect());
            let real = |bytes: &mut Bytes<'_>, x: f64| R::of(bytes.real(x));
            bodies.push(BodyDef {
                struct_size: own_size::<BodyDef<R>>(bytes),
                pose: [real(bytes, 4.0 * b as f64), real(bytes, 0.1), real(bytes, 1.5)],
                velocity: [real(bytes, 0.2), real(bytes, -0.1), real(bytes, 0.3)],
                root: if bytes.below(3) == 0 { bytes.kind(3) } else { NEKTON_ROOT_FREE },
                motion: [store.signal(bytes), store.signal(bytes), store.signal(bytes)],
                ..zeroed::<BodyDef<R>>()
            });
        }
        for (body, links) in bodies.iter_mut().zip(&links) {
            body.links = pointer(bytes, links);
            body.link_count = if bytes.chance(3) { bytes.below(links.len() + 1) } else { links.len() };
        }
        let repulsion = if bytes.below(2) == 0 { 0.0 } else { bytes.real(0.01) };
        let def = SceneDef {
            struct_size: own_size::<SceneDef<R>>(bytes),
            abi_version: if bytes.chance(2) { bytes.word() as u32 } else { version },
            fluid_density: R::of(bytes.real(1.0)),
            gravity: R::of(if bytes.below(2) == 0 { 0.0 } else { bytes.real(9.81) }),
            repulsion_epsilon: R::of(repulsion),
            repulsion_alpha: R::of(bytes.real(4.0)),
            circulation: bytes.kind(2),
            force: if bytes.below(4) == 0 { bytes.kind(2) } else { NEKTON_FORCE_EXACT_GRADIENT },
            quadrature: bytes.kind(2),
            tolerance: R::of(if bytes.below(4) > 0 { 0.0 } else { bytes.real(1e-3) }),
            allow_unresolved: bytes.kind(2),
            reserved: 0,
            shortcuts: bytes.kind(2),
            tank: if tank.is_empty() { core::ptr::null() } else { pointer(bytes, &tank) },
            obstacles: pointer(bytes, &obstacles),
            obstacle_count: obstacles.len(),
            bodies: pointer(bytes, &bodies),
            body_count: if bytes.chance(3) { bytes.below(count + 1) } else { count },
        };
        Definition { def, _tank: tank, _obstacles: obstacles, _bodies: bodies, _links: links, store }
    }

    /// Number of arrays behind the definition, to keep them alive.
    pub fn arrays(&self) -> usize {
        self.store.points.len() + self.store.harmonics.len() + self.store.rows.len()
    }
}
