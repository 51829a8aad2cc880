//! Tables as they are measured, and their places in pages.

type Result<T> = std::result::Result<T, String>;

/// A table without quotes.
pub struct Csv {
    names: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

impl Csv {
    /// From text with a line of names.
    pub fn parse(text: &str) -> Csv {
        let cells = |line: &str| line.split(',').map(str::to_owned).collect();
        let mut lines = text.lines();
        Csv { names: lines.next().map(cells).unwrap_or_default(), rows: lines.map(cells).collect() }
    }

    /// A cell; the error names what is not there.
    pub fn cell(&self, row: usize, name: &str) -> Result<&str> {
        let column = self.names.iter().position(|n| n == name).ok_or_else(|| format!("no column {name}"))?;
        self.rows.get(row).and_then(|r| r.get(column)).map(String::as_str).ok_or_else(|| format!("no row {row}"))
    }

    /// A number in a cell.
    pub fn number(&self, row: usize, name: &str) -> Result<f64> {
        let text = self.cell(row, name)?;
        text.parse().map_err(|_| format!("row {}: {name} is {text}", row + 1))
    }

    /// What a row is about.
    pub fn first(&self, row: usize) -> Result<&str> {
        self.rows.get(row).and_then(|r| r.first()).map(String::as_str).ok_or_else(|| format!("no row {row}"))
    }

    /// All cells of a column.
    pub fn column<'s>(&'s self, name: &'s str) -> impl Iterator<Item = &'s str> {
        (0..self.rows.len()).filter_map(move |r| self.cell(r, name).ok())
    }
}

/// Puts a table between a page's markers.
pub fn between(page: &str, marker: &str, table: &str) -> Result<String> {
    let (begin, end) = (format!("<!-- begin {marker} -->"), format!("<!-- end {marker} -->"));
    let cut = page.split_once(&begin).and_then(|(head, rest)| Some((head, rest.split_once(&end)?.1)));
    let (head, tail) = cut.ok_or_else(|| format!("no {begin} … {end}"))?;
    Ok(format!("{head}{begin}\n{table}{end}{tail}"))
}
