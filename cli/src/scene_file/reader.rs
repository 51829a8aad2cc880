//! Reading TOML with lines kept, so that every complaint is one line `path:line: message (hint)`.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::file;

/// Something wrong with a file: one line for the user.
#[derive(Debug)]
pub struct Problem {
    path: PathBuf,
    line: Option<usize>,
    message: String,
    hint: Option<String>,
}

impl Problem {
    /// A complaint about a file as a whole.
    pub fn file(path: &Path, message: impl Into<String>) -> Self {
        Problem { path: path.to_owned(), line: None, message: message.into(), hint: None }
    }
    /// A complaint about one line of a file.
    pub fn line(path: &Path, line: usize, message: impl Into<String>) -> Self {
        Problem { path: path.to_owned(), line: Some(line), message: message.into(), hint: None }
    }
    /// The same with a suggestion.
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }
    /// The same with a suggestion, if there is one.
    pub fn maybe_hint(mut self, hint: Option<String>) -> Self {
        self.hint = hint;
        self
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.path.display())?;
        if let Some(line) = self.line {
            write!(f, "{line}:")?;
        }
        write!(f, " {}", self.message)?;
        if let Some(hint) = &self.hint {
            write!(f, " ({hint})")?;
        }
        Ok(())
    }
}

/// Shorthand.
pub type Outcome<T> = Result<T, Problem>;

/// "did you mean …?" for a misspelt word, or the list of what is allowed if nothing comes near.
pub fn suggest(word: &str, allowed: &[&str]) -> Option<String> {
    let near = allowed
        .iter()
        .map(|a| (strsim::damerau_levenshtein(&word.to_lowercase(), &a.to_lowercase()), *a))
        .filter(|(d, a)| *d < a.len().max(word.len()))
        .filter(|(d, a)| *d <= 1 + a.len().max(word.len()) / 4 || (word.len() > 2 && a.starts_with(word)))
        .min_by_key(|(d, _)| *d);
    match near {
        Some((_, a)) => Some(format!("did you mean `{a}`?")),
        None if allowed.is_empty() => None,
        None => Some(format!("allowed: {}", allowed.join(", "))),
    }
}

/// A text with its path, from which lines are counted.
#[derive(Clone, Debug)]
pub struct Source {
    /// As the user gave it.
    pub path: PathBuf,
    text: String,
    /// Where its lines end.
    ends: Vec<usize>,
}

impl Source {
    /// Reads a file.
    pub fn open(path: &Path) -> Outcome<Self> {
        // A scene may come through a pipe, but not without end.
        let open = std::fs::File::open(path).map_err(|e| e.to_string());
        let bytes = open.and_then(|f| file::bounded(f, file::SCENE));
        let bytes = bytes.map_err(|e| Problem::file(path, format!("cannot be read: {e}")))?;
        let text = String::from_utf8(bytes).map_err(|e| {
            let good = e.utf8_error().valid_up_to();
            let line = 1 + e.as_bytes().iter().take(good).filter(|b| **b == b'\n').count();
            Problem::line(path, line, "this is not UTF-8 text")
        })?;
        let ends = text.bytes().enumerate().filter(|(_, b)| *b == b'\n').map(|(i, _)| i).collect();
        Ok(Source { path: path.to_owned(), text, ends })
    }
    /// Nothing yet.
    pub fn empty() -> Self {
        Source { path: PathBuf::new(), text: String::new(), ends: Vec::new() }
    }
    /// The text.
    pub fn text(&self) -> &str {
        &self.text
    }
    /// Line of a byte range's start, counted from 1.
    pub fn line_of(&self, span: Range<usize>) -> usize {
        1 + self.ends.partition_point(|end| *end < span.start)
    }
    /// A complaint about a line.
    pub fn problem(&self, line: usize, message: impl Into<String>) -> Problem {
        Problem::line(&self.path, line, message)
    }
    /// A path in the file is relative to the file.
    pub fn relative(&self, name: &str) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(name)
    }
    /// Parses the text.
    pub fn parse(&self) -> Outcome<Spanned<DeTable<'_>>> {
        DeTable::parse(&self.text).map_err(|e| {
            let line = e.span().map_or(1, |s| self.line_of(s));
            let message = e.message().trim().replace('\n', "; ");
            self.problem(line, format!("not valid TOML: {message}"))
        })
    }
}

/// A value with what is needed to complain about it.
#[derive(Clone, Copy)]
pub struct Item<'t> {
    /// The file.
    pub source: &'t Source,
    /// Line on which it stands.
    pub line: usize,
    /// Its key, for messages.
    pub key: &'t str,
    value: &'t DeValue<'t>,
}

fn article(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a string",
        DeValue::Integer(_) => "a whole number",
        DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}

impl<'t> Item<'t> {
    /// A complaint about this value.
    pub fn problem(&self, message: impl fmt::Display) -> Problem {
        self.source.problem(self.line, format!("`{}` {message}", self.key))
    }
    fn wrong(&self, wanted: &str) -> Problem {
        self.problem(format!("must be {wanted}, but is {}", article(self.value)))
    }
    /// A finite number.
    pub fn number(&self) -> Outcome<f64> {
        let (text, x) = match self.value {
            DeValue::Float(f) => (f.as_str(), f.as_str().parse().ok()),
            DeValue::Integer(i) if i.radix() == 10 => (i.as_str(), i.as_str().parse().ok()),
            DeValue::Integer(i) => (i.as_str(), u64::from_str_radix(i.as_str(), i.radix()).ok().map(|n| n as f64)),
            _ => return Err(self.wrong("a number")),
        };
        match x {
            Some(x) if f64::is_finite(x) => Ok(x),
            _ => Err(self.problem(format!("must be finite, but is {text}"))),
        }
    }
    /// A finite number > 0.
    pub fn positive(&self) -> Outcome<f64> {
        let x = self.number()?;
        if x > 0.0 { Ok(x) } else { Err(self.problem(format!("must be greater than 0, but is {x}"))) }
    }
    /// A finite number ≥ 0.
    pub fn not_negative(&self) -> Outcome<f64> {
        let x = self.number()?;
        if x >= 0.0 { Ok(x) } else { Err(self.problem(format!("must not be negative, but is {x}"))) }
    }
    /// A whole number ≥ 0.
    pub fn count(&self) -> Outcome<usize> {
        match self.value {
            DeValue::Integer(i) => usize::from_str_radix(i.as_str(), i.radix())
                .map_err(|_| self.problem(format!("must be a whole number that is not negative, but is {i}"))),
            _ => Err(self.wrong("a whole number")),
        }
    }
    /// Text.
    pub fn text(&self) -> Outcome<&'t str> {
        self.value.as_str().ok_or_else(|| self.wrong("a string"))
    }
    /// True or false.
    pub fn flag(&self) -> Outcome<bool> {
        self.value.as_bool().ok_or_else(|| self.wrong("true or false"))
    }
    /// Refuses a name that a spreadsheet would take for a formula at the head of a column, or a reader of tables for a comment.
    pub fn no_formula(&self) -> Outcome<()> {
        let text = self.text()?;
        match text.trim_start().chars().next() {
            Some(c) if "=+-@#".contains(c) => {
                let hint =
                    format!("spreadsheets take what begins with {c} for a formula or a comment; begin with a letter");
                Err(self.problem(format!("cannot be `{}`", text.escape_debug())).hint(hint))
            }
            _ => Ok(()),
        }
    }
    /// One of several words.
    pub fn word(&self, allowed: &[&'static str]) -> Outcome<&'static str> {
        let text = self.text()?;
        allowed
            .iter()
            .find(|a| **a == text)
            .copied()
            .ok_or_else(|| self.problem(format!("cannot be `{text}`")).maybe_hint(suggest(text, allowed)))
    }
    /// Elements of a list.
    pub fn list(&self) -> Outcome<Vec<Item<'t>>> {
        let array = self.value.as_array().ok_or_else(|| {
            let brackets = self.value.is_table().then(|| format!("write [[{}]] with two brackets", self.key));
            self.wrong("a list").maybe_hint(brackets)
        })?;
        Ok(array
            .iter()
            .map(|v| Item {
                source: self.source,
                line: self.source.line_of(v.span()),
                key: self.key,
                value: v.get_ref(),
            })
            .collect())
    }
    /// Two finite numbers.
    pub fn pair(&self) -> Outcome<[f64; 2]> {
        match self.list()?.as_slice() {
            [x, y] => Ok([x.number()?, y.number()?]),
            other => Err(self.problem(format!("must have 2 numbers, but has {}", other.len()))),
        }
    }
    /// A list of points.
    pub fn points(&self) -> Outcome<Vec<[f64; 2]>> {
        self.list()?.iter().map(Item::pair).collect()
    }
    /// Whether it is text.
    pub fn is_text(&self) -> bool {
        self.value.is_str()
    }
    /// Whether it is a number.
    pub fn is_number(&self) -> bool {
        matches!(self.value, DeValue::Float(_) | DeValue::Integer(_))
    }
    /// A table that may have these keys and no others.
    pub fn section(&self, title: &str, allowed: &'static [&'static str]) -> Outcome<Section<'t>> {
        let table = self.value.as_table().ok_or_else(|| self.wrong("a table"))?;
        Section::new(self.source, self.line, title, table, allowed)
    }
}

/// A table whose keys are all known.
#[derive(Clone)]
pub struct Section<'t> {
    source: &'t Source,
    /// Line of its head.
    pub line: usize,
    /// What it is, for messages: "[fluid]", "body `fish`".
    pub title: String,
    table: &'t DeTable<'t>,
}

impl<'t> Section<'t> {
    /// Checks the keys.
    pub fn new(
        source: &'t Source,
        line: usize,
        title: &str,
        table: &'t DeTable<'t>,
        allowed: &'static [&'static str],
    ) -> Outcome<Self> {
        let stranger = table.keys().filter(|k| !allowed.contains(&&**k.get_ref())).min_by_key(|k| k.span().start);
        if let Some(key) = stranger {
            let line = source.line_of(key.span());
            return Err(source
                .problem(line, format!("unknown key `{}` in {title}", key.get_ref()))
                .maybe_hint(suggest(key.get_ref(), allowed)));
        }
        Ok(Section { source, line, title: title.to_owned(), table })
    }
    /// The value of a key, if it is there.
    pub fn get(&self, key: &str) -> Option<Item<'t>> {
        let (key, value) = self.table.iter().find(|(k, _)| &**k.get_ref() == key)?;
        Some(Item {
            source: self.source,
            line: self.source.line_of(key.span()),
            key: key.get_ref(),
            value: value.get_ref(),
        })
    }
    /// The value of a key that must be there.
    pub fn need(&self, key: &str) -> Outcome<Item<'t>> {
        self.get(key).ok_or_else(|| self.problem(format!("{} needs `{key}`", self.title)))
    }
    /// The value of a key by a reader, or a default.
    pub fn or<T>(&self, key: &str, default: T, read: impl FnOnce(&Item<'t>) -> Outcome<T>) -> Outcome<T> {
        self.get(key).map_or(Ok(default), |i| read(&i))
    }
    /// The one key of several that is there.
    pub fn one_of(&self, keys: &[&'static str]) -> Outcome<(&'static str, Item<'t>)> {
        let mut found = keys.iter().filter_map(|k| Some((*k, self.get(k)?)));
        let first =
            found.next().ok_or_else(|| self.problem(format!("{} needs one of: {}", self.title, keys.join(", "))))?;
        match found.next() {
            None => Ok(first),
            Some((key, item)) => Err(self
                .source
                .problem(item.line, format!("{} cannot have both `{}` and `{key}`", self.title, first.0))),
        }
    }
    /// A complaint about the table.
    pub fn problem(&self, message: impl Into<String>) -> Problem {
        self.source.problem(self.line, message)
    }
    /// A complaint about a line.
    pub fn at(&self, line: usize, message: impl Into<String>) -> Problem {
        self.source.problem(line, message)
    }
    /// Where everything in this table stands, except below the keys in `except`.
    pub fn lines(&self, except: &[&str]) -> Lines {
        let mut lines = Lines { own: self.line, keys: Vec::new() };
        collect(self.source, self.table, except, &mut lines.keys);
        lines
    }
}

fn collect(source: &Source, table: &DeTable<'_>, except: &[&str], keys: &mut Vec<(String, usize)>) {
    for (key, value) in table.iter().filter(|(k, _)| !except.contains(&&**k.get_ref())) {
        keys.push((key.get_ref().to_string(), source.line_of(key.span())));
        if let DeValue::Table(inner) = value.get_ref() {
            collect(source, inner, &[], keys);
        }
    }
}

/// Lines of a table's keys, nested ones included.
#[derive(Clone, Debug, Default)]
pub struct Lines {
    /// Line of the table's head.
    pub own: usize,
    keys: Vec<(String, usize)>,
}

impl Lines {
    /// Line of the first of these keys that is there.
    pub fn find(&self, names: &[&str]) -> Option<usize> {
        names.iter().find_map(|n| self.keys.iter().find(|(k, _)| k == n)).map(|(_, l)| *l)
    }
}
