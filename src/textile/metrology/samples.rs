//! Small files of every format, made byte by byte for tests.

use super::{Coding, HeightOptions, LengthUnit, Measured, frt, gsf, npy, tmd, x3p};
use crate::metrology::About;
use selvedge_foundation::files::{Archive, Number, deflate};
use selvedge_foundation::numerics::Grid;
use std::path::Path;

/// A map of 12 × 7 points, µm, with `n_missing` missing points in its first row.
pub(super) fn map(n_missing: usize) -> Measured {
    let heights = (0_u32..84).map(|i| {
        let (column, row) = (f64::from(i % 12), f64::from(i / 12));
        (0.7 * column).sin() * 5.0 + row * 0.25
    });
    let mut heights_um = Grid::from_rows(12, heights.collect()).unwrap();
    heights_um.row_mut(0)[..n_missing].fill(f64::NAN);
    Measured {
        heights_um,
        step_mm: [0.05, 0.04],
        about: About {
            format: "test",
            title: "a cloth".to_owned(),
            instrument: "tester & co".to_owned(),
            date: "2012-01-02T03:04:05".to_owned(),
            comment: "a < b".to_owned(),
        },
        warnings: Vec::new(),
        layers: Vec::new(),
    }
}

/// One file of every format and layout, with what has to be asked for.
pub(super) fn all() -> Vec<(&'static str, Vec<u8>, HeightOptions)> {
    let path = Path::new("sample");
    let asked = HeightOptions {
        height_unit: Some(LengthUnit::Micrometre),
        length_unit: Some(LengthUnit::Millimetre),
        step_mm: Some(0.05),
        ..HeightOptions::default()
    };
    let none = HeightOptions::default();
    let written = |name| super::write(&map(0), Path::new(name)).unwrap();
    let coded = |number, is_list| x3p::write(&map(2), Coding { number, is_list }, path).unwrap();
    vec![
        ("x3p f64", coded(Number::F64, false), none.clone()),
        ("x3p i16", coded(Number::I16, false), none.clone()),
        ("x3p list", coded(Number::F32, true), none.clone()),
        ("x3p places", with_places(), none.clone()),
        ("sur", sur([16, 0]), none.clone()),
        ("sur packed", sur([32, 1]), none.clone()),
        ("gwy", gwy(), none.clone()),
        ("gsf", gsf::write(&map(2)), none.clone()),
        ("npy", npy::write(&map(2)), asked.clone()),
        ("png", written("map.png"), none.clone()),
        ("tiff", written("map.tiff"), none.clone()),
        ("tmd", tmd(), none.clone()),
        ("frt", frt(), none.clone()),
        ("two columns", two_columns().into_bytes(), none.clone()),
        ("valid", valid().into_bytes(), none.clone()),
        ("matrix", matrix().into_bytes(), none),
    ]
}

/// Rows from the top, as most files have them.
fn from_top(measured: &Measured) -> impl Iterator<Item = f64> + '_ {
    let rows = (0..measured.heights_um.height()).rev();
    rows.flat_map(|row| measured.heights_um.row(row).to_vec())
}

/// An X3P list whose y axis is absolute.
fn with_places() -> Vec<u8> {
    let axis = |name: &str, kind: &str| {
        format!(
            "<C{name}><AxisType>{kind}</AxisType><DataType>D</DataType>\
             <Increment>5e-5</Increment><Offset/></C{name}>"
        )
    };
    let data: Vec<String> = (0..84)
        .zip(map(2).heights_um.values())
        .map(|(i, height)| {
            if height.is_nan() {
                return "<Datum/>".to_owned();
            }
            let y = f64::from(i / 12) * 4e-5;
            format!("<Datum>{y};{}</Datum>", height * 1e-6)
        })
        .collect();
    let xml = format!(
        "\u{feff}<p:ISO5436_2 xmlns:p=\"u\"><Record1><FeatureType>SUR</FeatureType><Axes>\
         {}{}{}</Axes></Record1><Record3><MatrixDimension><SizeX>12</SizeX><SizeY>7</SizeY>\
         <SizeZ>1</SizeZ></MatrixDimension><DataList>{}</DataList></Record3></p:ISO5436_2>",
        axis("X", "I"),
        axis("Y", "A"),
        axis("Z", "A"),
        data.concat()
    );
    Archive::pack(&[("cloth/main.xml", xml.as_bytes())], Path::new("sample")).unwrap()
}

/// A Digital Surf file: x in mm, y in µm, heights in nm; two missing points. `[bits, is_packed]`.
pub(super) fn sur([bits, is_packed]: [u16; 2]) -> Vec<u8> {
    let map = map(2);
    let raw = from_top(&map).map(|z| if z.is_nan() { -6002.0 } else { z * 1000.0 });
    let number = if bits == 16 { Number::I16 } else { Number::I32 };
    let points = number.encode(raw);
    let mut bytes = vec![0; 512];
    let mut put = |at: usize, part: &[u8]| bytes[at..at + part.len()].copy_from_slice(part);
    put(
        0,
        if is_packed == 1 {
            b"DSCOMPRESSED"
        } else {
            b"DIGITAL SURF"
        },
    );
    put(14, &1_u16.to_le_bytes());
    put(18, &2_u16.to_le_bytes());
    put(20, b"a cloth");
    put(50, b"tester");
    put(86, &1_u16.to_le_bytes());
    put(98, &bits.to_le_bytes());
    for (at, value) in [
        (100, -6000),
        (104, 7000),
        (108, 12),
        (112, 7),
        (116, 84_i32),
    ] {
        put(at, &value.to_le_bytes());
    }
    for (at, value) in [(120, 0.05_f32), (124, 40.0), (128, 1.0), (474, 0.0)] {
        put(at, &value.to_le_bytes());
    }
    for (at, unit) in [(180, b"mm".as_slice()), (196, b"\xb5m"), (212, b"nm")] {
        put(at, unit);
    }
    for (at, part) in [
        (306, 5_u16),
        (308, 4),
        (310, 3),
        (312, 2),
        (314, 1),
        (316, 2012),
    ] {
        put(at, &part.to_le_bytes());
    }
    put(334, &4_u16.to_le_bytes());
    bytes.extend(b"note");
    if is_packed == 1 {
        let (first, second) = points.split_at(100);
        bytes.extend(2_u32.to_le_bytes());
        let packed = [first, second].map(deflate);
        for (raw, packed) in [first, second].iter().zip(&packed) {
            bytes.extend(u32::try_from(raw.len()).unwrap().to_le_bytes());
            bytes.extend(u32::try_from(packed.len()).unwrap().to_le_bytes());
        }
        bytes.extend(packed.concat());
    } else {
        bytes.extend(points);
    }
    bytes
}

fn text_of(text: &str) -> Vec<u8> {
    [text.as_bytes(), b"\0"].concat()
}

fn object(class: &str, components: &[Vec<u8>]) -> Vec<u8> {
    let inner = components.concat();
    let n = u32::try_from(inner.len()).unwrap().to_le_bytes();
    [text_of(class), n.to_vec(), inner].concat()
}

fn component(name: &str, kind: u8, data: &[u8]) -> Vec<u8> {
    [text_of(name), vec![kind], data.to_vec()].concat()
}

fn field(numbers: impl Iterator<Item = f64>, unit: &str) -> Vec<u8> {
    let data = Number::F64.encode(numbers);
    let counted = [84_u32.to_le_bytes().as_slice(), &data].concat();
    let unit = object("GwySIUnit", &[component("unitstr", b's', &text_of(unit))]);
    object(
        "GwyDataField",
        &[
            component("xres", b'i', &12_i32.to_le_bytes()),
            component("yres", b'i', &7_i32.to_le_bytes()),
            component("xreal", b'd', &(12.0 * 5e-5_f64).to_le_bytes()),
            component("yreal", b'd', &(7.0 * 4e-5_f64).to_le_bytes()),
            component("unknown", b'S', &[1, 0, 0, 0, b'x', 0]),
            component("si_unit_xy", b'o', &unit),
            component("si_unit_z", b'o', &unit),
            component("data", b'D', &counted),
        ],
    )
}

/// A Gwyddion file with a second channel and a mask over two points.
fn gwy() -> Vec<u8> {
    let map = map(2);
    let heights = from_top(&map).map(|z| if z.is_nan() { 0.0 } else { z * 1e-6 });
    let mask = from_top(&map).map(|z| f64::from(u8::from(z.is_nan())));
    let title = text_of("a cloth");
    let container = object(
        "GwyContainer",
        &[
            component("/3/data", b'o', &field([1.0; 84].into_iter(), "V")),
            component("/0/data", b'o', &field(heights, "m")),
            component("/0/data/title", b's', &title),
            component("/0/mask", b'o', &field(mask, "")),
        ],
    );
    [b"GWYP".to_vec(), container].concat()
}

fn tmd() -> Vec<u8> {
    let mut bytes = [tmd::MAGIC, b"\r\n\0", b"Created by tests\r\n\0"].concat();
    bytes.extend(12_u32.to_le_bytes());
    bytes.extend(7_u32.to_le_bytes());
    for extent_mm in [0.6_f32, 0.28, 0.0, 0.0] {
        bytes.extend(extent_mm.to_le_bytes());
    }
    bytes.extend(Number::F32.encode(from_top(&map(2)).map(|z| z * 1e-3)));
    bytes
}

fn frt() -> Vec<u8> {
    let map = map(2);
    let block = |tag: u16, data: &[u8]| {
        let n = u32::try_from(data.len()).unwrap().to_le_bytes();
        [tag.to_le_bytes().as_slice(), &n, data].concat()
    };
    let grid: Vec<u8> = [12_u32, 7, 16]
        .into_iter()
        .flat_map(u32::to_le_bytes)
        .collect();
    let counts = map.heights_um.values().iter();
    let counts = counts.map(|z| if z.is_nan() { 1.0 } else { (z + 10.0) * 1000.0 });
    [
        frt::MAGIC.to_vec(),
        b"0\x04\0".to_vec(),
        block(0x66, &grid),
        block(0x67, &Number::F64.encode([6e-4, 2.8e-4].into_iter())),
        block(
            0x6C,
            &[vec![0; 4], 1e-9_f64.to_le_bytes().to_vec()].concat(),
        ),
        block(0x0B, &Number::U16.encode(counts)),
    ]
    .concat()
}

fn rows(line: impl Fn(f64) -> String) -> String {
    (0..60).map(|i| line(f64::from(i))).collect()
}

fn two_columns() -> String {
    let row = |i: f64| format!("{:.1},{:.5},,\n", i * 5.0 / 3.0, (0.3 * i).sin());
    format!(
        "Scan\nID,0\nLength,100 um\n\nScan Data\nLateral um,Raw Micrometer,\n{}",
        rows(row)
    )
}

fn valid() -> String {
    let row = |i: f64| {
        let valid = u8::from(!(i - 7.0).abs().lt(&2.5));
        format!(
            "{:.4};{:.6};{valid}\n",
            8.0 + i * 5e-4,
            100.0 + 1e-3 * (0.3 * i).sin()
        )
    };
    format!("X;Y;valid\n[mm];[mm];[1/0]\n{}", rows(row))
}

fn matrix() -> String {
    let row = |i: f64| {
        let cells: Vec<String> = (0..6)
            .map(|k| format!("{:e}", i * 1e-8 + f64::from(k)))
            .collect();
        format!("{}\n", cells.join("\t"))
    };
    format!(
        "# Channel: Z\n# Width: 10.00 µm\n# Height: 20.00 µm\n# Value units: m\n{}",
        rows(row)
    )
}
