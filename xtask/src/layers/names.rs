//! Names of functions and tests in docs/architecture.md and in the headers of core, looked for in the tree: a map that names what is
//! no longer there is worse than none.

/// The text of a file of the checkout, if there is one.
type Read<'a> = &'a dyn Fn(&str) -> Option<String>;

/// What is between backquotes.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

/// Whether a text defines a function; `test`: one that the tests run.
fn defines(text: &str, name: &str, test: bool) -> bool {
    let word = |c: char| c.is_alphanumeric() || c == '_';
    text.match_indices(&format!("fn {name}")).any(|(at, found)| {
        let (before, after) = (&text[..at], &text[at + found.len()..]);
        // Attributes stand between the end of what is before and the function.
        let attributes = before.rsplit(['}', ';']).next().unwrap_or("");
        !after.starts_with(word) && !before.ends_with(word) && (!test || attributes.contains("#[test]"))
    })
}

/// Where a name of the map may point: into core, into the tests, or anywhere from the root on.
fn found(path: &str, read: Read<'_>) -> Option<String> {
    let inside = |folder: &str| path.starts_with("tests/").then(|| format!("{folder}/{path}"));
    let places = [Some(format!("core/src/{path}")), inside("tests"), inside("core"), Some(path.to_owned())];
    places.into_iter().flatten().find_map(|path| read(&path))
}

/// What is wrong with `FILE.rs:function`, or `FILE.rs`.
fn fault(name: &str, test: bool, read: Read<'_>) -> Option<String> {
    let (path, function) = name.split_once(':').map_or((name, None), |(path, function)| (path, Some(function)));
    let Some(text) = found(path, read) else { return Some(format!("there is no file {path}")) };
    let function = function?;
    if defines(&text, function, test) {
        return None;
    }
    Some(format!("{path} has no {} {function}", if test { "test" } else { "function" }))
}

/// Whether something quoted is the name of a file, or of a function in one.
fn is_name(quoted: &&str) -> bool {
    let path = quoted.split(':').next().unwrap_or("");
    path.ends_with(".rs") && path.contains('/') && !quoted.contains([' ', '*'])
}

/// Names of docs/architecture.md that are not there, and rows of its table of formulas without code or test.
pub fn of_map(page: &str, read: Read<'_>) -> Vec<String> {
    let mut faults = Vec::new();
    let (mut formulas, mut rows) = (false, 0);
    for line in page.lines() {
        formulas = line.starts_with("| formula |") || formulas && line.starts_with('|');
        let cells: Vec<&str> = line.trim_matches('|').split('|').collect();
        let row = formulas && !line.starts_with("|---") && !line.starts_with("| formula |");
        rows += usize::from(row);
        if row && (cells.len() != 3 || !quoted(cells[2]).any(|name| is_name(&name))) {
            faults.push(format!("names no test: {line}"));
        }
        for (k, cell) in cells.iter().enumerate() {
            faults.extend(quoted(cell).filter(is_name).filter_map(|name| fault(name, row && k == 2, read)));
        }
    }
    if rows == 0 {
        faults.push("has no table that begins with | formula |".to_owned());
    }
    faults
}

/// Names after "Tested by" in the header of a file of core that are not there: `tests/NAME` is a file of tests/tests or core/tests.
pub fn of_header(text: &str, read: Read<'_>) -> Vec<String> {
    let header: Vec<&str> = text.lines().map_while(|line| line.strip_prefix("//!")).collect();
    let header = header.join("\n");
    let Some((_, tested)) = header.split_once("Tested by") else { return Vec::new() };
    let names = quoted(tested).filter(|name| name.starts_with("tests/") || is_name(name));
    names
        .filter_map(|name| match name.contains(".rs") {
            true => fault(name, name.contains(':'), read),
            false => fault(&format!("{name}.rs"), false, read),
        })
        .collect()
}
