//! Lines of numbers as programs and spreadsheets write them: separators, decimal commas, comments, heads.

use std::path::Path;

use super::super::reader::{Outcome, Problem};

/// What stands between two numbers of a line. Those with decimal commas come first where a comma could be both.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Separator {
    Semicolon,
    Tab,
    Comma,
    Blanks,
    /// Blanks, and numbers with decimal commas.
    BlanksAndCommas,
}

use Separator::{Blanks, BlanksAndCommas, Comma, Semicolon, Tab};

/// A line of numbers.
pub struct Row {
    pub line: usize,
    pub cells: Vec<f64>,
    /// Whether a line of blanks stands before it.
    pub apart: bool,
}

/// The lines of a file.
pub struct Sheet {
    /// Lines of text before the first numbers, whole and as cells.
    pub head: Vec<(String, Vec<String>)>,
    pub rows: Vec<Row>,
    pub decimal_commas: bool,
}

/// The text of a file: UTF-8, or UTF-16 with its mark as spreadsheets write it. Letters of other encodings do not matter.
pub fn text(path: &Path, bytes: &[u8]) -> Outcome<String> {
    let wide = |order: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes.chunks_exact(2).skip(1).map(|b| order([b[0], b[1]])).collect();
        String::from_utf16_lossy(&units)
    };
    let text = match bytes {
        [0xff, 0xfe, ..] => wide(u16::from_le_bytes),
        [0xfe, 0xff, ..] => wide(u16::from_be_bytes),
        _ => String::from_utf8_lossy(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)).into_owned(),
    };
    let file = |message: &str, hint: &str| Err(Problem::file(path, message).hint(hint));
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    let mut first = text.trim_start().lines().map(str::trim);
    if bytes.starts_with(b"AutoCAD Binary DXF")
        || ending == "dxf"
        || (first.next() == Some("0") && first.next() == Some("SECTION"))
    {
        return file(
            "is a DXF drawing, which is not read",
            "save the outline as one path of an SVG picture, or its vertices as lines x,y of a CSV file",
        );
    }
    if bytes.starts_with(b"\x1f\x8b") {
        return file("is compressed", "save it as plain SVG or CSV");
    }
    if bytes.starts_with(b"PK\x03\x04") {
        return file("is a spreadsheet or an archive, not text", "save the sheet as CSV");
    }
    if text.contains('\0') {
        return file(
            "is not text",
            "an outline is a CSV file with columns x,y, an aerofoil's .dat file, or an SVG picture",
        );
    }
    Ok(text)
}

/// Lines with their numbers, whatever ends them.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut rest = Some(text);
    std::iter::from_fn(move || {
        let all = rest?;
        let end = all.find(['\n', '\r']);
        rest = end.map(|k| all[k..].strip_prefix("\r\n").unwrap_or(&all[k + 1..]));
        Some(end.map_or(all, |k| &all[..k]).trim())
    })
    .enumerate()
    .map(|(k, line)| (k + 1, line))
}

fn is_comment(line: &str) -> bool {
    line.starts_with(['#', '%']) || line.starts_with("//")
}

/// A line without the comment at its end, which a blank sets off.
fn without_comment(line: &str) -> Option<&str> {
    let starts = line.char_indices().filter(|(k, _)| line[..*k].ends_with(char::is_whitespace));
    starts.map(|(k, _)| k).find(|k| is_comment(&line[*k..])).map(|k| &line[..k])
}

/// The cells of a line, without quotes and without the empty ones at its end.
fn cells(line: &str, separator: Separator) -> Vec<&str> {
    let mut quoted = false;
    let between = |c: char| {
        quoted ^= c == '"';
        !quoted
            && match separator {
                Semicolon => c == ';',
                Tab => c == '\t',
                Comma => c == ',',
                Blanks | BlanksAndCommas => c.is_whitespace(),
            }
    };
    let bare = |c: &str| c.trim().len();
    let mut cells: Vec<&str> = line.split(between).collect();
    if matches!(separator, Blanks | BlanksAndCommas) {
        cells.retain(|c| bare(c) > 0);
    }
    while cells.last().is_some_and(|c| bare(c) == 0) {
        cells.pop();
    }
    cells.iter().map(|c| c.trim().trim_matches(['"', '\'']).trim()).collect()
}

/// A number, finite or not; Fortran's exponents and a printed minus are understood.
fn number(cell: &str, separator: Separator) -> Option<f64> {
    let mut text = cell.replace('\u{2212}', "-");
    if text.contains(',') {
        // With a point beside it, or a second one, it parts thousands.
        let parts = text.contains('.') || text.matches(',').count() > 1;
        if parts || matches!(separator, Comma | Blanks) {
            return None;
        }
        text = text.replace(',', ".");
    }
    text.parse().ok().or_else(|| {
        let plain = |c: char| c.is_ascii_digit() || "+-.dD".contains(c);
        text.chars().all(plain).then(|| text.replace(['d', 'D'], "e").parse().ok())?
    })
}

fn numbers(line: &str, separator: Separator) -> Option<Vec<f64>> {
    let cells = cells(line, separator);
    if cells.is_empty() { None } else { cells.iter().map(|c| number(c, separator)).collect() }
}

/// The numbers of a line, comment or not at its end.
fn row(line: &str, separator: Separator) -> Option<(&str, Vec<f64>)> {
    let shorter = || without_comment(line).and_then(|l| Some((l, numbers(l, separator)?)));
    numbers(line, separator).map(|n| (line, n)).or_else(shorter)
}

/// Whether a line before the first numbers looks like numbers with a mistake rather than like a name or a head.
fn spoilt(cells: &[&str], separator: Separator) -> bool {
    let nearly = |c: &&str| {
        let letters = c.chars().filter(|l| l.is_alphabetic()).count();
        letters < 2 && c.chars().all(|l| l.is_alphanumeric() || "+-.,".contains(l))
    };
    let pointed = |c: &&str| c.contains(['.', ',']) && c.contains(|d: char| d.is_ascii_digit());
    let is_number = |c: &&str| number(c, separator).is_some();
    let first = cells.first().is_some_and(is_number);
    let near = cells.iter().all(nearly) && (first || cells.iter().any(pointed));
    // A name may well begin with a number or be a letter and one, but hardly with a comma between.
    let begun = cells.first().is_some_and(|c| c.starts_with(|d: char| d.is_ascii_digit() || "+-.".contains(d)));
    let parted = begun || (cells.iter().all(nearly) && cells.iter().any(is_number));
    cells.len() > 1 && (near || (parted && !matches!(separator, Blanks | BlanksAndCommas)))
}

/// Reads the lines of a file. O(bytes).
pub fn sheet(path: &Path, text: &str) -> Outcome<Sheet> {
    // The separator is the one that makes the most lines lines of numbers.
    let score = |s: Separator| {
        let told = lines(text).filter(|(_, l)| !is_comment(l));
        told.filter(|(_, l)| row(l, s).is_some_and(|(_, n)| n.len() > 1)).count()
    };
    let mut best = (0, Semicolon);
    for separator in [Semicolon, Tab, Comma, Blanks, BlanksAndCommas] {
        let found = score(separator);
        if found > best.0 {
            best = (found, separator);
        }
    }
    let (found, separator) = best;
    if found == 0 {
        let first = lines(text).find(|(_, l)| !l.is_empty() && !is_comment(l));
        let hint = "each point is a line of two numbers, such as 0.5,0.1";
        return Err(match first {
            Some((line, text)) => {
                Problem::line(path, line, format!("no line of the file has two numbers; here is `{}`", short(text)))
            }
            None => Problem::file(path, "is empty"),
        }
        .hint(hint));
    }
    let mut sheet = Sheet { head: Vec::new(), rows: Vec::new(), decimal_commas: false };
    let (mut apart, mut points) = (false, false);
    for (line, text) in lines(text) {
        if is_comment(text) {
            continue;
        }
        let parts = cells(text, separator);
        if parts.iter().all(|c| c.is_empty()) {
            apart = true;
            continue;
        }
        let Some((told, numbers)) = row(text, separator) else {
            if sheet.rows.iter().any(|r| r.cells.len() > 1) || spoilt(&parts, separator) {
                return Err(not_numbers(path, line, text, &parts, separator));
            }
            sheet.head.push((text.to_owned(), parts.into_iter().map(str::to_owned).collect()));
            continue;
        };
        let parts = cells(told, separator);
        if let Some((cell, _)) = parts.iter().zip(&numbers).find(|(_, x)| !x.is_finite()) {
            return Err(Problem::line(path, line, format!("`{cell}` is not a finite number")));
        }
        sheet.decimal_commas |= parts.iter().any(|c| c.contains(','));
        points |= parts.iter().any(|c| c.contains('.'));
        if sheet.decimal_commas && points {
            let message = format!("`{}`: decimal points and decimal commas in one file", short(text));
            return Err(Problem::line(path, line, message).hint("write all numbers in one of the two ways"));
        }
        sheet.rows.push(Row { line, cells: numbers, apart });
        apart = false;
    }
    Ok(sheet)
}

fn not_numbers(path: &Path, line: usize, text: &str, parts: &[&str], separator: Separator) -> Problem {
    let bad = parts.iter().find(|c| number(c, separator).is_none()).copied().unwrap_or(text);
    let hint = if bad.is_empty() {
        "a number is missing"
    } else if bad.contains(',') && bad.contains(|c: char| c.is_ascii_digit()) {
        "decimal commas go with semicolons, tabs or blanks between the numbers; thousands are not parted"
    } else if parts.iter().any(|c| number(c, separator).is_some()) {
        "each point is two numbers; a name before the points begins with a word"
    } else {
        "text may stand before the points only; for another outline make another file, for a comment begin the line with #"
    };
    Problem::line(path, line, format!("`{}` in `{}` is not a number", short(bad), short(text))).hint(hint)
}

/// A text that fits on a line.
pub fn short(text: &str) -> String {
    let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    if text.chars().count() > 40 { text.chars().take(39).chain(['…']).collect() } else { text }
}
