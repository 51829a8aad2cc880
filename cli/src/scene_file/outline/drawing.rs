//! The path of an SVG picture: which element is the outline, and where its groups put it. XML is read by `roxmltree`, path data and
//! transforms by `svgtypes`.

use std::path::Path;

use kurbo::{Affine, PathSeg};
use roxmltree::{Document, Node, ParsingOptions};

use super::cells::short;
use super::line::{turn, twice_area};
use super::path::{self, Line};
use super::points::{CUSP, Outline};
use crate::scene_file::reader::{Outcome, Problem, suggest};

/// Elements of a picture, at most.
const ELEMENTS: u32 = 1_000_000;
/// Elements that draw.
const SHAPES: &[&str] = &[
    "path",
    "rect",
    "circle",
    "ellipse",
    "polygon",
    "polyline",
    "line",
    "use",
    "image",
    "text",
    "foreignObject",
    "svg",
];
/// Elements that draw where they are used, if at all.
const STORES: &[&str] = &["defs", "symbol", "clipPath", "mask", "marker", "pattern"];
/// What moves an element otherwise than by `transform`, or gives it another outline.
const STYLES: &[&str] =
    &["transform", "transform-origin", "transform-box", "translate", "rotate", "scale", "offset-path", "d"];
const TO_PATH: &str = "in Inkscape: Path > Object to Path";

/// Whether a text is XML.
pub fn is_xml(text: &str) -> bool {
    text.trim_start_matches('\u{feff}').trim_start().starts_with('<')
}

/// Points along the path with the name, or the only one, y upwards; and a word on it.
pub fn read(path: &Path, text: &str, id: Option<&str>) -> Outcome<(Outline, String)> {
    let file = |message: String| Problem::file(path, message);
    let text = text.trim_start_matches('\u{feff}').trim_start();
    // Their replacements can be far longer than the file.
    if text.contains("<!ENTITY") {
        return Err(file("declares entities, which are not read".into()).hint("save it as plain SVG"));
    }
    let options = ParsingOptions { allow_dtd: true, nodes_limit: ELEMENTS, ..Default::default() };
    let document = Document::parse_with_options(text, options)
        .map_err(|e| file(format!("is not valid XML: {}", short(&e.to_string()))).hint("save it as plain SVG"))?;
    let root = document.root_element();
    if !is_svg(&root) || root.tag_name().name() != "svg" {
        let message = format!("is XML, but no SVG picture: it begins with <{}>", short(root.tag_name().name()));
        return Err(
            file(message).hint("an outline is an SVG picture, a CSV file with columns x,y, or an aerofoil's .dat file")
        );
    }
    let node = match id {
        Some(id) => named(path, &root, id)?,
        None => only(path, &root)?,
    };
    let at = |message: String| {
        let line = document.text_pos_at(node.range().start).row as usize;
        Problem::line(path, line, format!("{} {message}", called(&node)))
    };
    let Some(data) = node.attribute("d").filter(|d| !d.trim().is_empty()) else {
        return Err(at("has no d, so it draws nothing".into()).hint("d = \"M 0 0 C …\" says how it runs"));
    };
    let moved = place(&document, &node).map_err(|(message, hint)| at(message).hint(hint))?;
    let mut parts = path::parts(data).map_err(|e| at(e).hint("save it as plain SVG"))?;
    let part = match parts.len() {
        1 => parts.remove(0),
        0 => return Err(at("draws nothing: it has no pieces".into()).hint("an outline is closed and has an inside")),
        n => {
            return Err(at(format!("has {n} parts (subpaths), but an outline is one closed line"))
                .hint("in Inkscape: Path > Break Apart, then keep one; a body has no holes"));
        }
    };
    // SVG's y points downwards.
    let pieces: Vec<PathSeg> = part.pieces.iter().map(|p| Affine::FLIP_Y * moved * *p).collect();
    let Line { points, curved, straight, corners } =
        path::along(&pieces, part.closed).map_err(|(message, hint)| at(message).hint(hint))?;
    if twice_area(&points) == 0.0 {
        return Err(at("encloses no area".into()).hint("an outline is closed and has an inside"));
    }
    let count = |n: usize, what: &str| (n > 0).then(|| format!("{n} {what}{}", if n == 1 { "" } else { "s" }));
    let kind = [
        Some(called(&node)),
        count(curved, "curved piece"),
        count(straight, "straight piece"),
        count(corners.len(), "corner"),
        (moved != Affine::IDENTITY).then(|| "transforms applied".to_owned()),
        Some("y turned upwards".to_owned()),
    ];
    let kind: Vec<String> = kind.into_iter().flatten().collect();
    let kind = format!(" ({})", kind.join(", "));
    let corners = corners.into_iter().filter(|k| turn(&points, *k) < CUSP).collect();
    Ok((Outline { corners: Some(corners), ..Outline::of(points) }, kind))
}

/// Whether it is an element of SVG, and not of an editor.
fn is_svg(node: &Node<'_, '_>) -> bool {
    node.is_element() && node.tag_name().namespace().is_none_or(|n| n == "http://www.w3.org/2000/svg")
}

fn called(node: &Node<'_, '_>) -> String {
    let tag = node.tag_name().name();
    match node.attribute("id") {
        Some(id) if tag == "path" => format!("path `{}`", short(id)),
        Some(id) => format!("<{}> `{}`", short(tag), short(id)),
        None if tag == "path" => "the path".to_owned(),
        None => format!("a <{}>", short(tag)),
    }
}

/// The first names of elements.
fn list(nodes: &[Node<'_, '_>]) -> String {
    let mut names: Vec<String> =
        nodes.iter().take(6).map(|n| called(n).replace("the path", "a path without id")).collect();
    if nodes.len() > names.len() {
        names.push(format!("{} more", nodes.len() - names.len()));
    }
    names.join(", ")
}

/// The element with a name.
fn named<'a, 'i>(path: &Path, root: &Node<'a, 'i>, id: &str) -> Outcome<Node<'a, 'i>> {
    let has = |n: &Node<'_, '_>| is_svg(n) && n.attribute("id") == Some(id);
    let found: Vec<Node<'a, 'i>> = root.descendants().filter(has).collect();
    match found.as_slice() {
        [node] if node.tag_name().name() == "path" => Ok(*node),
        [node] => Err(Problem::file(path, format!("has {}, which is no path", called(node))).hint(TO_PATH)),
        [] => {
            let paths = root.descendants().filter(|n| is_svg(n) && n.tag_name().name() == "path");
            let ids: Vec<&str> = paths.filter_map(|n| n.attribute("id")).filter(|i| short(i) == **i).collect();
            let few = if ids.len() <= 20 { suggest(id, &ids) } else { None };
            Err(Problem::file(path, format!("has no path with the id `{}`", short(id))).maybe_hint(few))
        }
        _ => Err(Problem::file(path, format!("has {} elements with the id `{}`", found.len(), short(id)))
            .hint("give the outline one of its own")),
    }
}

/// The path that is the whole picture.
fn only<'a, 'i>(path: &Path, root: &Node<'a, 'i>) -> Outcome<Node<'a, 'i>> {
    let mut drawn = Vec::new();
    // Not through what is only stored.
    let mut open: Vec<Node<'a, 'i>> = vec![*root];
    while let Some(node) = open.pop() {
        let children = node.children().filter(|n| is_svg(n) && !STORES.contains(&n.tag_name().name()));
        open.extend(children.clone());
        drawn.extend(children.filter(|n| SHAPES.contains(&n.tag_name().name())));
    }
    drawn.sort_by_key(|n| n.range().start);
    let paths = drawn.iter().filter(|n| n.tag_name().name() == "path").count();
    match drawn.as_slice() {
        [node] if paths == 1 => Ok(*node),
        [] => Err(Problem::file(path, "has no path").hint("an outline is a <path> that is drawn")),
        _ if paths == 0 => Err(Problem::file(path, format!("has no path, but {}", list(&drawn))).hint(TO_PATH)),
        _ => {
            let message = format!("draws {} things, but an outline is one: {}", drawn.len(), list(&drawn));
            Err(Problem::file(path, message).hint("name one with path = \"id\" beside `curve`, or delete the others"))
        }
    }
}

/// Where an element and all around it are moved to; else what is wrong, and what helps.
fn place(document: &Document<'_>, node: &Node<'_, '_>) -> Result<Affine, (String, String)> {
    const HELPS: &str = "move it in the editor, or write a plain transform = \"…\"";
    let mut all = Affine::IDENTITY;
    for (depth, element) in node.ancestors().filter(Node::is_element).enumerate() {
        let tag = element.tag_name().name();
        let root = element == document.root_element();
        if depth > 0 && !root && !["g", "a", "switch"].contains(&tag) {
            let hint = "an outline is drawn by itself, in groups or not";
            return Err((format!("stands within a <{}>", short(tag)), hint.into()));
        }
        let styles = element.attribute("style").unwrap_or_default().split(';');
        let mut names = styles.filter_map(|s| s.split_once(':')).map(|(name, _)| name.trim().to_lowercase());
        if let Some(name) = names.find(|n| STYLES.contains(&n.as_str())) {
            return Err((
                format!("has `{name}` in the style of {}, which is not read", called(&element)),
                HELPS.into(),
            ));
        }
        if element.has_attribute("transform-origin") {
            return Err((format!("has a `transform-origin` in {}, which is not read", called(&element)), HELPS.into()));
        }
        if let Some(text) = element.attribute("transform") {
            let t: svgtypes::Transform = text.parse().map_err(|e| {
                let message =
                    format!("has a transform that is not understood, `{}` in {}: {e}", short(text), called(&element));
                (message, HELPS.to_owned())
            })?;
            all = Affine::new([t.a, t.b, t.c, t.d, t.e, t.f]) * all;
        }
    }
    // What a sheet applies to is for a browser to say.
    let sheet = |n: &Node<'_, '_>| n.is_element() && n.tag_name().name() == "style";
    let texts = document.descendants().filter(sheet).filter_map(|n| n.text());
    if texts.into_iter().any(|t| t.contains("transform") || t.contains("path(")) {
        return Err(("is in a picture whose style sheet moves things".into(), HELPS.into()));
    }
    if !all.is_finite() {
        return Err(("is moved by transforms that are not finite".into(), HELPS.into()));
    }
    if all.determinant() == 0.0 {
        return Err(("is pressed flat by a transform".into(), HELPS.into()));
    }
    Ok(all)
}
