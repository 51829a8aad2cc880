//! Bodies, links and joints as written in a scene file.

use nekton::scene::{Drive, Joint, JointKind, Link, Mass, Root};

use super::reader::{Item, Lines, Outcome, Section, suggest};
use super::shape::{ShapeDef, nodes};
use super::signal::{Purpose, SignalDef};

/// A body: links in the user's order.
#[derive(Clone, Debug)]
pub struct BodyDef {
    /// Name, given or `body1`, `body2`, …
    pub name: String,
    /// Pose of the root link.
    pub pose: [f64; 3],
    /// Velocity of the root link.
    pub velocity: [f64; 3],
    /// Prescribed motion of the root link.
    pub root: Option<[SignalDef; 3]>,
    /// Links as listed.
    pub links: Vec<LinkDef>,
    /// The links as the core wants them, every parent before its children: indices into `links`.
    pub order: Vec<usize>,
    /// Where everything stands.
    pub lines: Lines,
}

/// A link.
#[derive(Clone, Debug)]
pub struct LinkDef {
    /// Name, given or `link1`, `link2`, …
    pub name: String,
    /// Its outline.
    pub shape: ShapeDef,
    mass: Mass<f64>,
    pub(super) nodes: usize,
    circulation: f64,
    /// How it hangs on its parent.
    pub joint: Option<JointDef>,
    /// Where everything stands.
    pub lines: Lines,
}

/// A joint to a parent, which is an index into the body's `links`.
#[derive(Clone, Debug)]
pub struct JointDef {
    /// Parent as listed by the user.
    pub parent: usize,
    kind: JointKind<f64>,
    parent_anchor: [f64; 2],
    self_anchor: [f64; 2],
    drive: DriveDef,
}

#[derive(Clone, Debug)]
enum DriveDef {
    Locked(f64),
    Motion(SignalDef),
    Torque { torque: SignalDef, stiffness: f64, damping: f64, rest: f64, start: [f64; 2] },
}

const BODY: &[&str] = &["name", "position", "angle", "velocity", "angular_velocity", "root", "link"];
const LINK: &[&str] = &[
    "name",
    "shape",
    "density",
    "mass",
    "inertia",
    "centre_of_mass",
    "nodes",
    "circulation",
    "parent",
    "hinge",
    "slider",
    "motion",
];

/// A name that can stand in a column's head.
fn name(section: &Section<'_>, kind: &str, number: usize) -> Outcome<(String, usize)> {
    let Some(item) = section.get("name") else { return Ok((format!("{kind}{number}"), section.line)) };
    let text = item.text()?;
    if text.trim().is_empty() || text.chars().any(|c| c.is_control() || ".,\"".contains(c)) {
        return Err(item.problem(format!("cannot be `{}`", text.escape_debug())).hint("no dot, comma or quote"));
    }
    item.no_formula()?;
    Ok((text.to_owned(), item.line))
}

fn unique<'a>(
    section: &Section<'_>,
    line: usize,
    name: &str,
    mut earlier: impl Iterator<Item = (&'a str, usize)>,
    what: &str,
) -> Outcome<()> {
    match earlier.find(|(n, _)| *n == name) {
        None => Ok(()),
        Some((_, first)) => Err(section
            .at(line, format!("two {what} are called `{name}`"))
            .hint(format!("the other is on line {first}; names must differ"))),
    }
}

impl BodyDef {
    /// Reads one `[[body]]`.
    pub fn read(item: &Item<'_>, number: usize, earlier: &[BodyDef]) -> Outcome<Self> {
        let section = item.section(&format!("[[body]] {number}"), BODY)?;
        let (name, line) = name(&section, "body", number)?;
        unique(&section, line, &name, earlier.iter().map(|b| (b.name.as_str(), b.name_line())), "bodies")?;
        let position = section.or("position", [0.0; 2], Item::pair)?;
        let velocity = section.or("velocity", [0.0; 2], Item::pair)?;
        let root = section.get("root").map(|r| read_root(&r)).transpose()?;
        if let (Some(_), Some(v)) = (&root, section.get("velocity").or_else(|| section.get("angular_velocity"))) {
            return Err(v.problem("cannot be given where `root` prescribes the motion"));
        }
        let mut links: Vec<LinkDef> = Vec::new();
        let items = section.need("link").map_err(|p| p.hint("a body has one or more [[body.link]]"))?.list()?;
        let sections = items
            .iter()
            .enumerate()
            .map(|(k, i)| i.section(&format!("link {} of body `{name}`", k + 1), LINK))
            .collect::<Outcome<Vec<_>>>()?;
        if sections.is_empty() {
            return Err(section.problem(format!("body `{name}` has no link")));
        }
        let mut names = Vec::new();
        for (k, link) in sections.iter().enumerate() {
            let (text, line) = self::name(link, "link", k + 1)?;
            let before = names.iter().map(|(n, l): &(String, usize)| (n.as_str(), *l));
            unique(link, line, &text, before, &format!("links of body `{name}`"))?;
            names.push((text, line));
        }
        for (k, link) in sections.iter().enumerate() {
            links.push(LinkDef::read(link, k, &names)?);
        }
        let order = order(&name, &section, &sections, &links)?;
        Ok(BodyDef {
            name,
            pose: [position[0], position[1], section.or("angle", 0.0, Item::number)?],
            velocity: [velocity[0], velocity[1], section.or("angular_velocity", 0.0, Item::number)?],
            root,
            links,
            order,
            lines: section.lines(&["link"]),
        })
    }

    /// Every function of time: of the root, then of the joints as listed.
    pub fn signals(&self) -> impl Iterator<Item = &SignalDef> {
        let joints = self.links.iter().filter_map(|l| match &l.joint.as_ref()?.drive {
            DriveDef::Motion(signal) | DriveDef::Torque { torque: signal, .. } => Some(signal),
            DriveDef::Locked(_) => None,
        });
        self.root.iter().flatten().chain(joints)
    }

    /// The same, to be changed.
    pub fn signals_mut(&mut self) -> impl Iterator<Item = &mut SignalDef> {
        let joints = self.links.iter_mut().filter_map(|l| match &mut l.joint.as_mut()?.drive {
            DriveDef::Motion(signal) | DriveDef::Torque { torque: signal, .. } => Some(signal),
            DriveDef::Locked(_) => None,
        });
        self.root.iter_mut().flatten().chain(joints)
    }

    fn name_line(&self) -> usize {
        self.lines.find(&["name"]).unwrap_or(self.lines.own)
    }

    /// The core's index of a link within the body.
    pub fn core_index(&self, link: usize) -> usize {
        self.order.iter().position(|u| *u == link).unwrap_or(0)
    }

    /// The core's links.
    pub fn core_links(&self) -> Vec<Link<'_, f64>> {
        self.order.iter().filter_map(|u| self.links.get(*u)).map(|l| l.core(self)).collect()
    }

    /// The core's description of the root's motion.
    pub fn core_root(&self) -> Root<'_, f64> {
        self.root.as_ref().map_or(Root::Free, |signals| Root::Prescribed(signals.each_ref().map(SignalDef::core)))
    }
}

fn read_root(item: &Item<'_>) -> Outcome<[SignalDef; 3]> {
    let section = item.section("`root`", &["x", "y", "theta"])?;
    let get = |key| section.or(key, SignalDef::Constant(0.0), |i| SignalDef::read(i, Purpose::Motion));
    Ok([get("x")?, get("y")?, get("theta")?])
}

/// Parents before children, otherwise as listed; refuses a second root and rings.
fn order(name: &str, body: &Section<'_>, sections: &[Section<'_>], links: &[LinkDef]) -> Outcome<Vec<usize>> {
    let roots: Vec<usize> = (0..links.len()).filter(|k| links[*k].joint.is_none()).collect();
    let mut order = roots.clone();
    match roots.as_slice() {
        [_] => {}
        [first, second, ..] => {
            let (a, b) = (&links[*first].name, &links[*second].name);
            return Err(sections[*second]
                .problem(format!("link `{b}` of body `{name}` has no parent, and neither has link `{a}`"))
                .hint(format!(
                    "only one link of a body hangs on nothing; did you mean `parent = \"{a}\"` with a hinge?"
                )));
        }
        [] => {
            let ring = ring(links, 0);
            return Err(body
                .problem(format!("the parents of body `{name}` lead round: {ring}"))
                .hint("one link of the body must have no parent"));
        }
    }
    let mut next = 0;
    while let Some(parent) = order.get(next).copied() {
        order.extend((0..links.len()).filter(|k| links[*k].joint.as_ref().is_some_and(|j| j.parent == parent)));
        next += 1;
    }
    if let Some(lost) = (0..links.len()).find(|k| !order.contains(k)) {
        return Err(sections[lost]
            .problem(format!("the parents of body `{name}` lead round: {}", ring(links, lost)))
            .hint("hinges must form a tree that starts at one link without parent"));
    }
    Ok(order)
}

/// The ring of parents reached from a link, as text.
fn ring(links: &[LinkDef], start: usize) -> String {
    let parent = |k: usize| links[k].joint.as_ref().map_or(k, |j| j.parent);
    // After as many steps as there are links one is on the ring for certain.
    let on = (0..links.len()).fold(start, |k, _| parent(k));
    let mut text = links[on].name.clone();
    let mut k = parent(on);
    while k != on {
        text = format!("{text} -> {}", links[k].name);
        k = parent(k);
    }
    format!("{text} -> {}", links[on].name)
}

impl LinkDef {
    fn read(section: &Section<'_>, index: usize, names: &[(String, usize)]) -> Outcome<Self> {
        let name = names[index].0.clone();
        let shape = ShapeDef::read(&section.need("shape")?)?;
        Ok(LinkDef {
            nodes: nodes(section.get("nodes"))?,
            mass: mass(section)?,
            circulation: section.or("circulation", 0.0, Item::number)?,
            joint: JointDef::read(section, index, names)?,
            lines: section.lines(&[]),
            shape,
            name,
        })
    }

    fn core(&self, body: &BodyDef) -> Link<'_, f64> {
        Link {
            shape: self.shape.core(),
            mass: self.mass,
            nodes: self.nodes,
            circulation: self.circulation,
            joint: self.joint.as_ref().map(|j| Joint {
                parent: body.core_index(j.parent),
                kind: j.kind,
                parent_anchor: j.parent_anchor,
                self_anchor: j.self_anchor,
                drive: j.drive.core(),
            }),
        }
    }
}

fn mass(section: &Section<'_>) -> Outcome<Mass<f64>> {
    if let Some(density) = section.get("density") {
        if let Some(other) = ["mass", "inertia", "centre_of_mass"].iter().find_map(|k| section.get(k)) {
            return Err(other.problem("cannot be given together with `density`"));
        }
        return density.not_negative().map(Mass::Density);
    }
    if ["mass", "inertia", "centre_of_mass"].iter().all(|k| section.get(k).is_none()) {
        return section.need("density").map_err(|p| p.hint("or `mass` and `inertia`")).map(|_| Mass::Density(0.0));
    }
    Ok(Mass::Given {
        mass: section.need("mass")?.not_negative()?,
        inertia: section.need("inertia")?.not_negative()?,
        centre_of_mass: section.or("centre_of_mass", [0.0; 2], Item::pair)?,
    })
}

impl JointDef {
    /// Whether it slides.
    pub fn is_slider(&self) -> bool {
        matches!(self.kind, JointKind::Slider { .. })
    }

    fn read(section: &Section<'_>, index: usize, names: &[(String, usize)]) -> Outcome<Option<Self>> {
        let Some(parent) = section.get("parent") else {
            return match ["hinge", "slider", "motion"].iter().find_map(|k| section.get(k)) {
                Some(item) => Err(item
                    .problem(format!("of link `{}` needs `parent`", names[index].0))
                    .hint("name the link on which it hangs")),
                None => Ok(None),
            };
        };
        let text = parent.text()?;
        let Some(parent_index) = names.iter().position(|(n, _)| n == text) else {
            let others: Vec<&str> =
                names.iter().enumerate().filter(|(k, _)| *k != index).map(|(_, (n, _))| n.as_str()).collect();
            let message = format!("`{text}` of link `{}` is not a link of this body", names[index].0);
            return Err(parent.problem(message).maybe_hint(suggest(text, &others)));
        };
        let (kind, value) = section.one_of(&["hinge", "slider"])?;
        let (joint, kind) = if kind == "hinge" {
            (value.section("a hinge", &["parent", "self"])?, JointKind::Hinge)
        } else {
            let slider = value.section("a slider", &["parent", "self", "axis", "angle"])?;
            let axis = slider.need("axis")?;
            let direction = axis.pair()?;
            if direction == [0.0; 2] {
                return Err(axis.problem("must have a direction, but is [0, 0]"));
            }
            let angle = slider.or("angle", 0.0, Item::number)?;
            (slider, JointKind::Slider { axis: direction, angle })
        };
        let motion = section.need("motion").map_err(|p| {
            p.hint("{ harmonic = … }, { table = … }, { channel = … } or { torque = … }; a stiff joint is { locked = 0.0 }, a free one { torque = 0.0 }")
        })?;
        Ok(Some(JointDef {
            parent: parent_index,
            kind,
            parent_anchor: joint.or("parent", [0.0; 2], Item::pair)?,
            self_anchor: joint.or("self", [0.0; 2], Item::pair)?,
            drive: DriveDef::read(&motion)?,
        }))
    }
}

impl DriveDef {
    fn read(item: &Item<'_>) -> Outcome<Self> {
        const KEYS: &[&str] = &[
            "harmonic",
            "window",
            "table",
            "slopes",
            "channel",
            "value",
            "locked",
            "torque",
            "stiffness",
            "damping",
            "rest",
            "start",
        ];
        let section = item.section("`motion`", KEYS)?;
        let (kind, value) = section.one_of(&["harmonic", "table", "channel", "torque", "locked"])?;
        let strangers: &[&str] = match kind {
            "torque" => &["window", "slopes", "value"],
            "locked" => &["window", "slopes", "value", "stiffness", "damping", "rest", "start"],
            _ => &["stiffness", "damping", "rest", "start"],
        };
        if let Some(other) = strangers.iter().find_map(|k| section.get(k)) {
            let hint = match other.key {
                "window" => "goes inside: torque = { harmonic = …, window = … }",
                "slopes" => "goes inside: torque = { table = …, slopes = … }",
                "value" => "goes inside: torque = { channel = …, value = … }",
                _ => "they go with `torque`",
            };
            return Err(other.problem(format!("does not go with `{kind}`")).hint(hint));
        }
        Ok(match kind {
            "locked" => DriveDef::Locked(value.number()?),
            "torque" => DriveDef::Torque {
                torque: SignalDef::read(&value, Purpose::Torque)?,
                stiffness: section.or("stiffness", 0.0, Item::not_negative)?,
                damping: section.or("damping", 0.0, Item::not_negative)?,
                rest: section.or("rest", 0.0, Item::number)?,
                start: section.or("start", [0.0; 2], Item::pair)?,
            },
            _ => DriveDef::Motion(SignalDef::from_section(&section, Purpose::Motion)?),
        })
    }

    fn core(&self) -> Drive<'_, f64> {
        match self {
            DriveDef::Locked(value) => Drive::Locked(*value),
            DriveDef::Motion(signal) => Drive::Motion(signal.core()),
            DriveDef::Torque { torque, stiffness, damping, rest, start } => Drive::Torque {
                torque: torque.core(),
                stiffness: *stiffness,
                damping: *damping,
                rest: *rest,
                start: *start,
            },
        }
    }
}
