//! The layers of core.

/// A layer of core: a folder of core/src or a file in it.
pub struct Layer {
    pub name: &'static str,
    /// A layer uses itself and layers of lower level; those of one level do not use each other.
    pub level: usize,
    pub holds: &'static str,
}

const fn layer(name: &'static str, level: usize, holds: &'static str) -> Layer {
    Layer { name, level, holds }
}

/// The layers of core from the ground up: the one list of them. docs/architecture.md and CONTRIBUTING.md show it.
pub const LAYERS: [Layer; 11] = [
    layer("base", 0, "numbers, errors, memory, the processor's vectors"),
    layer("linear", 1, "dense linear systems"),
    layer("scene", 1, "what the caller describes"),
    layer("integrate", 1, "differential equations, any"),
    layer("geometry", 2, "outlines, their nodes, and where they are"),
    layer("model", 3, "what set-up makes: immutable, in any position"),
    layer("fluid", 4, "the boundary integral equation and its quadrature"),
    layer("dynamics", 5, "from positions and velocities to accelerations"),
    layer("simulation", 6, "steps in time, and what can be asked between them"),
    layer("setup", 7, "from a scene to a model: checks, sizes, records"),
    layer("lib.rs", 8, "the public names"),
];

/// The layer of a file of core.
pub fn layer_of(file: &str) -> Option<usize> {
    let first = file.split('/').next().unwrap_or(file);
    LAYERS.iter().position(|layer| layer.name == first || format!("{}.rs", layer.name) == first)
}
