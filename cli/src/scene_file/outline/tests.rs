use std::path::Path;

use super::naca::{Naca, Tail};
use super::points::description;
use super::read;

type Points = Vec<[f64; 2]>;

fn reads(text: impl AsRef<[u8]>) -> Result<(Points, String), String> {
    super::cells::text(Path::new("o.csv"), text.as_ref())
        .and_then(|t| read(Path::new("o.csv"), &t))
        .map_err(|p| p.to_string())
}

const SQUARE: [[f64; 2]; 4] = [[0.0, 0.5], [1.0, 0.25], [1.5, 1.0], [-0.5, 0.75]];

#[test]
fn outlines_are_read_however_they_are_written() {
    let wide = |order: fn(u16) -> [u8; 2]| -> Vec<u8> {
        "\u{feff}x\ty\r\n0,0\t0,5\r\n1,0\t0,25\r\n1,5\t1,0\r\n-0,5\t0,75\r\n".encode_utf16().flat_map(order).collect()
    };
    let (little, big) = (wide(u16::to_le_bytes), wide(u16::to_be_bytes));
    for (text, kind) in [
        (&b"x,y\n0,0.5\n1,0.25\n1.5,1\n-0.5,0.75\n"[..], ""),
        (b"X,Y\n0,0.5\n1,0.25\n1.5,1\n-0.5,0.75", ""),
        (b"0,0.5\n1,0.25\n1.5,1\n-0.5,0.75\n", ""),
        (b"\xef\xbb\xbfx,y\r\n0,0.5\r\n1,0.25\r\n1.5,1\r\n-0.5,0.75\r\n", ""),
        (b"x,y\r0,0.5\r1,0.25\r1.5,1\r-0.5,0.75\r", ""),
        (b"\n\nx , y\n\n0 , 0.5\n1 ,\t0.25\n 1.5,1 \n\n-0.5,.75\n  \t \n\n", ""),
        (b"x,y,\n0,0.5,\n1,0.25,\n1.5,1,\n-0.5,0.75,\n,,\n", ""),
        (b"\"x\",\"y\"\n\"0\",\"0.5\"\n\"1\",\"0.25\"\n'1.5','1'\n\"-0.5\",\"0.75\"\n", ""),
        (b"# by hand\nx,y\n// one\n0,0.5 # here\n1,0.25 // there\n% two\n1.5,1\t% and\n-0.5,0.75", ""),
        (b"x [m]; y [m]\n0,0;0,5\n1,0;0,25\n1,5;1\n-0,5;0,75\n;\n", " (decimal commas)"),
        (b"\"x [m]\";\"y [m]\"\n\"0,0\";\"0,5\"\n\"1,0\";\"0,25\"\n1,5;1\n-0,5;0,75\n", " (decimal commas)"),
        (b"x;y\n0;0.5\n1;0.25\n1.5;1\n-0.5;0.75\n", ""),
        (b"x\ty\n0,0\t0,5\n1\t0,25\n1,5\t1\n-0,5\t0,75\n", " (decimal commas)"),
        (b"0.0\t0.5\n1\t0.25\n1.5\t1\n-0.5\t0.75\n", ""),
        (b"0,0 0,5\n1 0,25\n1,5 1\n-0,5 0,75\n", " (decimal commas)"),
        (b"  0.0   0.5\n  1.  .25\n 1.5D0 1.0d+00\n -5.0E-1\t 7.5e-1\n", ""),
        (b"0 0.5\n1 0.25\n1.5 1\n\xe2\x88\x920.5 0.75\n", ""),
        (b"4\n0 0.5\n1 0.25\n1.5 1\n-0.5 0.75\n", " (with their number)"),
        (b"NACA 0012\n0 0.5\n1 0.25\n1.5 1\n-0.5 0.75\n", " (`NACA 0012`)"),
        (b"G\xf6ttingen 11.7%\n0 0.5\n1 0.25\n1.5 1\n-0.5 0.75\n", " (`G\u{fffd}ttingen 11.7%`)"),
        (b"E63 (4.25%)\n0 0.5\n1 0.25\n1.5 1\n-0.5 0.75\n", " (`E63 (4.25%)`)"),
        (b"8 percent, E 387 of 2\n0 0.5\n1 0.25\n1.5 1\n-0.5 0.75\n", " (`8 percent, E 387 of 2`)"),
        (b"Clark Y\nx/c  y/c\n0 0.5\n1 0.25\n1.5 1\n-0.5 0.75\n", " (`Clark Y`)"),
        (b"x,z\n0,0.5\n1,0.25\n1.5,1\n-0.5,0.75\n", " (`x,z`)"),
        (b"y,x\n0.5,0\n0.25,1\n1,1.5\n0.75,-0.5\n", " (x and y from columns 2 and 1)"),
        (b"y [m]  x [m]\n0.5 0\n0.25 1\n1 1.5\n0.75 -0.5\n", " (x and y from columns 2 and 1)"),
        (b"n,X (mm),cp,Y (mm)\n1,0,9,0.5\n2,1,9,0.25\n3,1.5,9,1\n4,-0.5,9,0.75\n", " (x and y from columns 2 and 4)"),
        (&little, " (decimal commas)"),
        (&big, " (decimal commas)"),
    ] {
        let shown = String::from_utf8_lossy(text);
        assert_eq!(reads(text), Ok((SQUARE.to_vec(), kind.to_owned())), "{shown}");
    }
}

#[test]
fn what_is_no_outline_is_refused_with_file_line_and_text() {
    for (text, told) in [
        ("", "o.csv: is empty (each point is"),
        ("# nothing\n\n", "o.csv: is empty"),
        ("x,y\n", "o.csv:1: no line of the file has two numbers; here is `x,y`"),
        ("\n1\n2\n3\n", "o.csv:2: no line of the file has two numbers; here is `1`"),
        ("x,y\n0,0\n1,O\n1,1\n", "o.csv:3: `O` in `1,O` is not a number (each point is two numbers"),
        ("0,O\n1,0\n1,1\n0,1\n", "o.csv:1: `O` in `0,O` is not a number"),
        ("O,1\n1,0\n1,1\n0,1\n", "o.csv:1: `O` in `O,1` is not a number"),
        ("1 000,5;0\n0;0\n1;1\n2;1\n", "o.csv:1: `1 000,5` in `1 000,5;0` is not a number"),
        ("0.5 mm,0\n1,0\n1,1\n0,1\n", "o.csv:1: `0.5 mm` in `0.5 mm,0` is not a number"),
        ("1,oops\n1,0\n1,1\n0,1\n", "o.csv:1: `oops` in `1,oops` is not a number"),
        ("l.0 0.0\n1 1\n0 1\n0 0\n", "o.csv:1: `l.0` in `l.0 0.0` is not a number"),
        ("x,y\nnan,0\n1,0\n1,1\n", "o.csv:2: `nan` is not a finite number"),
        ("x,y\n0,0\n1e999,0\n1,1\n", "o.csv:3: `1e999` is not a finite number"),
        ("x,y\n0,0\n1,0,5\n1,1\n", "o.csv:3: 3 numbers where other lines have 2"),
        ("x,y\n0,0\n1\n1,1\n", "o.csv:3: 1 numbers where other lines have 2"),
        ("name\n0 1 2 3\n0 0\n1 0\n1 1\n", "o.csv:2: 4 numbers where other lines have 2"),
        ("x,y\n0,0\n,1\n1,1\n", "o.csv:3: `` in `,1` is not a number (a number is missing)"),
        ("0,0,0\n1,0,0\n1,1,0\n", "o.csv:1: 3 numbers to a line, and no header that tells which are x and y"),
        ("xu,yu,xl,yl\n0,0,0,0\n1,0,0,0\n1,1,0,0\n", "o.csv:2: 4 numbers to a line, and no header"),
        ("x,y,x,y\n0,0,0,0\n1,0,0,0\n1,1,0,0\n", "o.csv:2: 4 numbers to a line, and no header"),
        ("z,x\n0,0\n1,0\n1,1\n", "o.csv: column x stands second in the header, and none is y: z,x"),
        (
            "x,y\n0,0\n1,0\nCamber line\n1,1\n",
            "o.csv:4: `Camber line` in `Camber line` is not a number (text may stand",
        ),
        ("x;y\n1.000;0,5\n1;0\n1;1\n", "o.csv:2: `1.000;0,5`: decimal points and decimal commas in one file"),
        ("x;y\n1.000,5;0,5\n1;0\n1;1\n2;1\n", "o.csv:2: `1.000,5` in `1.000,5;0,5` is not a number (decimal commas go"),
        ("x,y\n\"1,5\",\"2\"\n1,0\n1,1\n2,1\n", "o.csv:2: `1,5` in `\"1,5\",\"2\"` is not a number (decimal commas go"),
        ("2412\n0 0\n1 0\n1 1\n", "o.csv:1: `2412` stands alone and is not the number of the 3 lines below"),
        ("a\n1 0\n0 0\n1 1\n999.0 999.0\n1 2\n0 2\n", "o.csv:5: 999 999 parts two outlines"),
        ("0,0\n1,0\n", "o.csv: has 2 points; an outline needs at least 3"),
        ("  0\nSECTION\n  2\nENTITIES\n", "o.csv: is a DXF drawing, which is not read"),
        ("PK\u{3}\u{4}\0\0", "o.csv: is a spreadsheet or an archive"),
        ("\u{7f}ELF\0\0\0", "o.csv: is not text"),
        (
            "s\n3. 3.\n0 0\n.5 .1\n1 0\n\n0 0\n.5 -.1\n",
            "o.csv:2: `3 3` is far from all other points, and does not count the 5",
        ),
        ("s\n3. 3.\n1 0\n.5 .1\n0 0\n\n0 0\n.5 -.1\n1 0\n", "o.csv:2: the line counts 3 and 3 points, but"),
    ] {
        let done = reads(text);
        assert!(done.as_ref().is_err_and(|e| e.starts_with(told)), "{text}\n{done:?}");
    }
    let many: String = (0..100_001_i64).map(|k| format!("{k},{}\n", k * k)).collect();
    let told = "o.csv: has 100001 points; at most 100000 are taken (every 2th of them would do)";
    assert_eq!(reads(many).unwrap_err(), told);
}

#[test]
fn lednicer_s_surfaces_become_one_line_in_selig_s_order() {
    let around = vec![[1.0, 0.01], [0.5, 0.1], [0.0, 0.0], [0.5, -0.1], [1.0, -0.01]];
    let joined = |more: &str| format!(" ({more}upper and lower surface, joined)");
    for head in ["s 1\n 3.  3.\n\n", "s 1\n3 3\n"] {
        let text = format!("{head}0 0\n0.5 0.1\n1 0.01\n\n0 0\n.5 -.1\n1 -.01\n");
        assert_eq!(reads(text), Ok((around.clone(), joined("`s 1`, "))));
    }
    // Without counts: two blocks, both from the nose.
    let blocks = "s 1\n0 0\n0.5 0.1\n1 0.01\n\n0 0\n.5 -.1\n1 -.01\n";
    assert_eq!(reads(blocks), Ok((around.clone(), joined("`s 1`, "))));
    // Noses that differ both stay, and so do tails that do not.
    let text = "s 1\n3 3\n0 .001\n.5 .1\n1 0\n\n0 -.001\n.5 -.1\n1 0\n";
    let apart = vec![[1.0, 0.0], [0.5, 0.1], [0.0, 0.001], [0.0, -0.001], [0.5, -0.1], [1.0, 0.0]];
    assert_eq!(reads(text).map(|r| r.0), Ok(apart));
    // A blank line in points that go round changes nothing, whole numbers neither.
    let round = "3,3\n0,4\n\n-3,-3\n4,-5\n";
    assert_eq!(reads(round).map(|r| r.0), Ok(vec![[3.0, 3.0], [0.0, 4.0], [-3.0, -3.0], [4.0, -5.0]]));
    // Selig's order is left as it is.
    let selig = "s 1\n1 .01\n.5 .1\n0 0\n\n.5 -.1\n1 -.01\n";
    assert_eq!(reads(selig).map(|r| r.0), Ok(around));
}

/// Numbers of many sizes.
fn random(seed: &mut u64) -> f64 {
    let mut next = || {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    (next() - 0.5) * 10f64.powf(12.0 * next() - 6.0)
}

#[test]
fn points_written_in_any_way_come_back_to_the_last_bit() {
    let seed = &mut 1;
    for round in 0..300 {
        let n = 3 + round % 20;
        let points: Points = (0..n).map(|_| [random(seed), random(seed)]).collect();
        for (separator, comma) in
            [(",", false), (";", false), (";", true), ("\t", false), ("\t", true), ("  ", false), (" ", true)]
        {
            for head in ["", "x,y\n", "Some wing 3\n", "# x\n\u{feff}"] {
                for (end, exponent) in [("\n", false), ("\r\n", true), ("\r", false)] {
                    let number = |x: f64| {
                        let text = if exponent { format!("{x:e}") } else { format!("{x:?}") };
                        if comma { text.replace('.', ",") } else { text }
                    };
                    let head = if head.starts_with('#') { "# x\n" } else { head }.replace(',', separator);
                    let rows = points.iter().map(|p| format!("{}{separator}{}\n", number(p[0]), number(p[1])));
                    let text = format!("{head}{}", rows.collect::<String>()).replace('\n', end);
                    assert_eq!(reads(&text).map(|r| r.0), Ok(points.clone()), "{text}");
                }
            }
        }
    }
}

#[test]
fn sections_written_as_selig_and_lednicer_do_come_back_to_the_last_bit() {
    for (name, tail) in [("0012", Tail::Blunt), ("2412", Tail::Sharp), ("6716", Tail::Blunt), ("23012", Tail::Sharp)] {
        for count in [21, 41, 161] {
            let mut points = Naca::new(name, tail).unwrap().outline(1.0, count).unwrap();
            if tail == Tail::Sharp {
                // As such files have it.
                points.push(points[0]);
            }
            let nose = points.iter().position(|p| *p == [0.0; 2]).unwrap();
            let rows = |points: &mut dyn Iterator<Item = &[f64; 2]>, separator: &str| -> String {
                points.map(|p| format!("  {:?}{separator}{:?}\n", p[0], p[1])).collect()
            };
            for separator in ["  ", "\t"] {
                let selig = format!("NACA {name}\n{}", rows(&mut points.iter(), separator));
                assert_eq!(reads(selig).map(|r| r.0), Ok(points.clone()));
                let (upper, lower) = (&points[..=nose], &points[nose..]);
                let [a, b] = [upper, lower].map(<[_]>::len);
                let surfaces =
                    [rows(&mut upper.iter().rev(), separator), rows(&mut lower.iter(), separator)].join("\n");
                for counts in [format!("{a}. {b}.\n\n"), format!("\t{a}\t{b}\n"), "\n".to_owned()] {
                    let text = format!("NACA {name}\n{counts}{surfaces}");
                    assert_eq!(reads(&text).map(|r| r.0), Ok(points.clone()), "{text}");
                }
            }
        }
    }
}

#[test]
fn sections_by_formula_have_the_thickness_camber_and_tail_of_their_names() {
    let outline = |name: &str, tail, n| Naca::new(name, tail).and_then(|s| s.outline(2.0, n)).unwrap();
    for (name, tail, area) in [
        // Area of a symmetric section: twice the integral of its half thickness.
        ("0012", Tail::Sharp, 0.081_706),
        ("0012", Tail::Blunt, 0.082_21),
        ("NACA 2412", Tail::Blunt, f64::NAN),
        ("naca23012", Tail::Sharp, f64::NAN),
        ("6721", Tail::Blunt, f64::NAN),
    ] {
        let points = outline(name, tail, 401);
        assert_eq!(points.len(), if tail == Tail::Sharp { 400 } else { 401 });
        assert!(points.windows(2).all(|w| w[0] != w[1]) && points.first() != points.last());
        assert_eq!(points[200], [0.0, 0.0]);
        let told = description(&points);
        assert!(told.contains("points, counter-clockwise, chord (along x) 2"), "{told}");
        let enclosed: f64 = told.split("them ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
        assert!(area.is_nan() || (enclosed / 4.0 - area).abs() < 2e-5, "{name}: {enclosed}");
    }
    // Both corners of a blunt tail: 0.0021/0.2 of the thickness.
    let blunt = outline("0012", Tail::Blunt, 161);
    assert!((blunt[0][1] - 2.0 * 0.00126).abs() < 1e-15 && blunt[160] == [2.0, -blunt[0][1]]);
    assert_eq!(outline("4412", Tail::Sharp, 161)[0], [2.0, 0.0]);
    // Thickness, camber and its place, between points of one station.
    for (name, thick, camber, place) in
        [("4415", 0.15, 0.04, 0.4), ("23012", 0.12, 0.0184, 0.15), ("21012", 0.12, 0.011, 0.05)]
    {
        let points = outline(name, Tail::Blunt, 2001);
        let pairs = (0..1000).map(|k| (points[k], points[2000 - k]));
        let mean = pairs.clone().map(|(a, b)| [0.25 * (a[0] + b[0]), 0.25 * (a[1] + b[1])]);
        let highest = mean.max_by(|a, b| a[1].total_cmp(&b[1])).unwrap();
        assert!((highest[1] - camber).abs() < 2e-4 && (highest[0] - place).abs() < 4e-3, "{name}: {highest:?}");
        let most = pairs.map(|(a, b)| 0.5 * (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max);
        assert!((most - thick).abs() < 1e-4, "{name}: {most}");
    }
    // Published ordinates of the 2412 (Abbott and von Doenhoff): at the station 0.3 of the mean line.
    let n = Naca::new("2412", Tail::Blunt).unwrap().outline(1.0, 4001).unwrap();
    let near = |x: f64, side: f64| {
        let of = |p: &&[f64; 2]| (p[1] * side < 0.0, (p[0] - x).abs());
        n.iter().min_by(|a, b| of(a).partial_cmp(&of(b)).unwrap()).unwrap()[1]
    };
    assert!((near(0.2974, 1.0) - 0.0788).abs() < 1e-4 && (near(0.3026, -1.0) + 0.0412).abs() < 1e-4);
}

#[test]
fn sections_that_are_not_known_are_refused_by_name() {
    for (name, told) in [
        ("24520", "known are those of four digits"),
        ("23112", "reflex"),
        ("2012", "both 0 or neither"),
        ("0412", "both 0 or neither"),
        ("2400", "thickness in percent, which is 0"),
        ("26012", "known are"),
        ("03012", "known are"),
        ("64-215", "known are"),
        ("", "known are"),
        ("24é", "known are"),
        ("naca", "known are"),
    ] {
        let done = Naca::new(name, Tail::Blunt);
        assert!(done.as_ref().is_err_and(|e| e.contains(told) && e.contains(name)), "{name}: {done:?}");
    }
    let section = Naca::new("0012", Tail::Blunt).unwrap();
    for count in [0, 19, 160, 10_003] {
        assert!(section.outline(1.0, count).unwrap_err().contains(&format!("is {count}")));
    }
}
