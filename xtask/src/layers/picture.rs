//! The picture of the layers: a box for each, and at its right a line that goes up to those that use it.

use super::imports::Sources;
use super::list::{LAYERS, layer_of};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

const WIDTH: usize = 900;
const MARGIN: usize = 24;
const BOX_RIGHT: usize = 560;
/// Distance of the lines, and of the first one from the boxes.
const LANE: usize = 30;
const TOP: usize = 84;
/// A line of text: height, and letters that fit.
const LINE: usize = 16;
const LETTERS: usize = 88;
const GAP: usize = 14;
/// Between layers of one level.
const NARROW: usize = 4;

/// One colour for each layer: of its box's edge and of its line.
const COLOURS: [&str; 10] =
    ["#4a5568", "#2b6cb0", "#2c7a7b", "#6b46c1", "#b7791f", "#9b2c2c", "#276749", "#97266d", "#1a5f7a", "#7b341e"];

/// Names of the files of a layer, those of a folder inside it in parentheses, broken into lines.
fn names(sources: &Sources, layer: usize) -> Vec<String> {
    let mut words: BTreeMap<String, BTreeSet<&str>> = BTreeMap::new();
    for file in sources.files.iter().filter(|file| layer_of(file) == Some(layer)) {
        let inside = file.split_once('/').map_or(file.as_str(), |(_, inside)| inside);
        if let Some((folder, rest)) = inside.split_once('/') {
            words.entry(folder.into()).or_default().insert(rest);
        } else if inside != "mod.rs" {
            words.entry(inside.trim_end_matches(".rs").into()).or_default();
        }
    }
    words.remove(LAYERS[layer].name);
    // What stands before a word on its line, and the word.
    let mut parts: Vec<(&str, String)> = Vec::new();
    for (name, inside) in words {
        let mut files: Vec<&str> = inside.iter().map(|file| file.trim_end_matches(".rs")).collect();
        files.retain(|file| *file != "mod");
        match files.as_mut_slice() {
            [] => parts.push((" \u{b7} ", name)),
            [first, rest @ ..] => {
                parts.push((" \u{b7} ", format!("{name}/ ({first}")));
                parts.extend(rest.iter().map(|file| (" ", file.to_string())));
                if let Some((_, last)) = parts.last_mut() {
                    last.push(')');
                }
            }
        }
    }
    let mut lines: Vec<String> = Vec::new();
    for (space, word) in parts {
        match lines.last_mut() {
            Some(line) if line.chars().count() + space.len() + word.chars().count() <= LETTERS => {
                *line += &(space.to_string() + &word)
            }
            _ => lines.push(word),
        }
    }
    lines
}

/// For each pair of layers, the pairs of files of which one uses the other.
fn counts(sources: &Sources) -> BTreeMap<(usize, usize), usize> {
    let pairs: BTreeSet<(usize, usize)> = sources.imports.iter().map(|import| (import.from, import.to)).collect();
    let mut counts = BTreeMap::new();
    for (from, to) in pairs {
        if let (Some(from), Some(to)) = (layer_of(&sources.files[from]), layer_of(&sources.files[to])) {
            *counts.entry((from, to)).or_default() += usize::from(from != to);
        }
    }
    counts
}

/// The picture as SVG.
pub fn draw(sources: &Sources) -> String {
    let counts = counts(sources);
    // From the top down: where each box begins and ends.
    let mut place = [(0, 0); LAYERS.len()];
    let mut y = TOP;
    for (i, layer) in LAYERS.iter().enumerate().rev() {
        let lines = if i + 1 == LAYERS.len() { 0 } else { names(sources, i).len() };
        let height = 32 + LINE * lines + if lines > 0 { 4 } else { 0 };
        place[i] = (y, y + height);
        let together = i > 0 && LAYERS[i - 1].level == layer.level;
        y += height + if together { NARROW } else { GAP };
    }
    let height = y - GAP + MARGIN;
    let lane = |to: usize| BOX_RIGHT + 36 + LANE * to;
    let line = |i: usize| place[i].0 + 18;

    let mut svg = String::new();
    let _ = write!(
        svg,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height}\" viewBox=\"0 0 {WIDTH} {height}\" \
         font-family=\"system-ui, 'Segoe UI', 'DejaVu Sans', sans-serif\" font-size=\"12\" fill=\"#2d3748\">\n\
         <title>Layers of core</title>\n\
         <!-- Made by cargo xtask layers (picture) from the imports of core/src. -->\n\
         <rect x=\"0.5\" y=\"0.5\" width=\"{}\" height=\"{}\" rx=\"8\" fill=\"#fbfaf7\" stroke=\"#d5d0c4\"/>\n\
         <text x=\"{MARGIN}\" y=\"36\" font-size=\"18\" font-weight=\"bold\">Layers of core</text>\n\
         <text x=\"{MARGIN}\" y=\"58\">A layer uses itself and those below it, never one above.</text>\n\
         <text x=\"{}\" y=\"36\" font-size=\"12\" font-weight=\"bold\">Who uses whom</text>\n\
         <text x=\"{}\" y=\"54\" font-size=\"11\">A line leads from users down to their layer;</text>\n\
         <text x=\"{}\" y=\"69\" font-size=\"11\">a number: so many pairs of user and used files.</text>\n",
        WIDTH - 1,
        height - 1,
        BOX_RIGHT + 20,
        BOX_RIGHT + 20,
        BOX_RIGHT + 20,
    );
    // Rows of users, under everything else.
    for i in 0..LAYERS.len() {
        let users = (0..i).filter(|&to| counts.get(&(i, to)).is_some_and(|&n| n > 0));
        if let Some(far) = users.max() {
            let _ = writeln!(
                svg,
                "<path d=\"M{BOX_RIGHT} {y}H{}\" stroke=\"#d5d0c4\" stroke-width=\"1.5\"/>",
                lane(far),
                y = line(i)
            );
        }
    }
    for to in 0..COLOURS.len() {
        let users: Vec<usize> =
            (0..LAYERS.len()).filter(|&from| counts.get(&(from, to)).is_some_and(|&n| n > 0)).collect();
        let (Some(&top), colour) = (users.last(), COLOURS[to]) else { continue };
        let (x, y) = (lane(to), line(to) + 9);
        // The end of the line points into its layer.
        let _ = writeln!(
            svg,
            "<path d=\"M{x} {}V{}Q{x} {y} {} {y}H{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>\n\
             <path d=\"M{} {y}l9 -4.5v9z\" fill=\"{colour}\"/>",
            line(top),
            y - 8,
            x - 8,
            BOX_RIGHT + 8,
            BOX_RIGHT + 1,
        );
    }
    // Above all lines.
    for (&(from, to), &count) in counts.iter().filter(|&(_, &count)| count > 0) {
        let (x, y) = (lane(to), line(from));
        let colour = COLOURS.get(to).unwrap_or(&"#2d3748");
        let _ = writeln!(
            svg,
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"10.5\" fill=\"#fbfaf7\" stroke=\"{colour}\" stroke-width=\"2\"/>\n\
             <text x=\"{x}\" y=\"{}\" font-size=\"11\" text-anchor=\"middle\">{count}</text>",
            y + 4
        );
    }
    for (i, layer) in LAYERS.iter().enumerate().rev() {
        let (top, bottom) = place[i];
        let colour = COLOURS.get(i).unwrap_or(&"#2d3748");
        let _ = writeln!(
            svg,
            "<rect x=\"{MARGIN}\" y=\"{top}\" width=\"{}\" height=\"{}\" rx=\"4\" fill=\"#ffffff\" stroke=\"#d5d0c4\"/>\n\
             <rect x=\"{MARGIN}\" y=\"{top}\" width=\"5\" height=\"{}\" fill=\"{colour}\"/>\n\
             <text x=\"{}\" y=\"{}\" font-size=\"14\" font-weight=\"bold\">{}</text>\n\
             <text x=\"{}\" y=\"{}\">{}</text>",
            BOX_RIGHT - MARGIN,
            bottom - top,
            bottom - top,
            MARGIN + 16,
            top + 21,
            layer.name,
            MARGIN + 112,
            top + 21,
            layer.holds
        );
        if i + 1 < LAYERS.len() {
            for (k, text) in names(sources, i).iter().enumerate() {
                let _ = writeln!(
                    svg,
                    "<text x=\"{}\" y=\"{}\" font-size=\"11\" fill=\"#5a6577\">{text}</text>",
                    MARGIN + 16,
                    top + 40 + LINE * k
                );
            }
        }
    }
    svg + "</svg>\n"
}
