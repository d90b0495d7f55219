//! Writing X3P: incremental x and y, heights in any of the four number types, binary or listed.

use std::path::Path;

use crate::metrology::Measured;
use selvedge_foundation::files::{Archive, FileError, Number, md5_hex, push_number, xml_text};

/// How heights are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Coding {
    /// The type: `I16`, `I32`, `F32` or `F64`. Whole numbers are counts of a step that the
    /// highest relief fills.
    pub number: Number,
    /// As a list in the XML instead of a binary member.
    pub is_list: bool,
}

impl Default for Coding {
    /// Binary float64: what was read comes back bit by bit.
    fn default() -> Self {
        Self {
            number: Number::F64,
            is_list: false,
        }
    }
}

/// Name spaces of the root.
const ROOT: &str = "p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\" \
     xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" \
     xsi:schemaLocation=\"http://www.opengps.eu/2008/ISO5436_2 \
     http://www.opengps.eu/2008/ISO5436_2/ISO5436_2.xsd\"";

/// The z axis: what a stored number means.
struct ZAxis {
    number: Number,
    letter: char,
    is_whole: bool,
    increment_m: f64,
    offset_m: f64,
}

impl ZAxis {
    fn of(measured: &Measured, number: Number, path: &Path) -> Result<Self, FileError> {
        let (letter, largest) = match number {
            Number::I16 => ('I', f64::from(i16::MAX)),
            Number::I32 => ('L', f64::from(i32::MAX)),
            Number::F32 => ('F', 0.0),
            Number::F64 => ('D', 0.0),
            Number::U8 | Number::U16 | Number::U32 => {
                let mend = "choose int16, int32, float32 or float64";
                return Err(FileError::whole(path, "X3P has no such number type", mend));
            }
        };
        let [low, high] = measured.range_um().map(|um| um * 1e-6);
        let is_whole = largest > 0.0;
        let span = 0.5 * (high - low);
        Ok(Self {
            number,
            letter,
            is_whole,
            increment_m: if is_whole && span > 0.0 {
                span / largest
            } else {
                1.0
            },
            offset_m: if is_whole { 0.5 * (low + high) } else { 0.0 },
        })
    }

    /// The number that stands for a height, µm.
    fn stored(&self, height_um: f64) -> f64 {
        let metres = height_um * 1e-6;
        if self.is_whole {
            ((metres - self.offset_m) / self.increment_m).round()
        } else {
            metres
        }
    }
}

/// Writes a map or a profile. The same map gives the same bytes.
///
/// # Errors
/// A number type that X3P does not have.
pub fn write(measured: &Measured, coding: Coding, path: &Path) -> Result<Vec<u8>, FileError> {
    let z = ZAxis::of(measured, coding.number, path)?;
    let heights = measured.heights_um.values();
    let (mut data, mut valid, mut record) = (Vec::new(), Vec::new(), String::new());
    if coding.is_list {
        list(heights, &z, &mut record);
    } else {
        let stored = heights.iter().map(|height| z.stored(*height));
        data = z.number.encode(stored);
        link(
            "PointDataLink",
            "bindata/data.bin",
            "PointData",
            &data,
            &mut record,
        );
        if z.is_whole {
            let bits = heights.chunks(8).map(|eight| {
                let bits = eight.iter().rev();
                bits.fold(0_u8, |byte, height| byte << 1 | u8::from(!height.is_nan()))
            });
            valid = bits.collect();
            link(
                "ValidPointsLink",
                "bindata/valid.bin",
                "ValidPoints",
                &valid,
                &mut record,
            );
        }
        record = format!("    <DataLink>\n{record}    </DataLink>\n");
    }
    let xml = xml(measured, &z, &record);
    let checksum = format!("{} *main.xml", md5_hex(xml.as_bytes()));
    let mut members: Vec<(&str, &[u8])> = vec![("main.xml", xml.as_bytes())];
    if !data.is_empty() {
        members.push(("bindata/data.bin", &data));
    }
    if !valid.is_empty() {
        members.push(("bindata/valid.bin", &valid));
    }
    members.push(("md5checksum.hex", checksum.as_bytes()));
    Archive::pack(&members, path)
}

fn list(heights: &[f64], z: &ZAxis, record: &mut String) {
    record.push_str("    <DataList>\n");
    for height in heights {
        if height.is_nan() {
            record.push_str("      <Datum/>\n");
        } else {
            record.push_str("      <Datum>");
            push_number(record, z.stored(*height));
            record.push_str("</Datum>\n");
        }
    }
    record.push_str("    </DataList>\n");
}

fn link(element: &str, name: &str, checked: &str, data: &[u8], record: &mut String) {
    let md5 = md5_hex(data);
    let lines = format!(
        "      <{element}>{name}</{element}>\n      \
         <MD5Checksum{checked}>{md5}</MD5Checksum{checked}>\n"
    );
    record.push_str(&lines);
}

fn xml(measured: &Measured, z: &ZAxis, record: &str) -> String {
    let (width, height) = (measured.heights_um.width(), measured.heights_um.height());
    let feature = if measured.is_profile() { "PRF" } else { "SUR" };
    let axis = |name: &str, kind: char, number: char, [increment_m, offset_m]: [f64; 2]| {
        format!(
            "      <{name}>\n        <AxisType>{kind}</AxisType>\n        \
             <DataType>{number}</DataType>\n        \
             <Increment>{increment_m:e}</Increment>\n        \
             <Offset>{offset_m:e}</Offset>\n      </{name}>\n"
        )
    };
    let [x_m, y_m] = measured.step_mm.map(|step_mm| step_mm / 1000.0);
    let kind = if z.is_whole { 'I' } else { 'A' };
    let axes = [
        axis("CX", 'I', 'D', [x_m, 0.0]),
        axis("CY", 'I', 'D', [y_m, 0.0]),
        axis("CZ", kind, z.letter, [z.increment_m, z.offset_m]),
    ]
    .concat();
    let about = &measured.about;
    let [date, instrument, comment] =
        [&about.date, &about.instrument, &about.comment].map(|text| xml_text(text));
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<{ROOT}>\n  <Record1>\n    \
         <Revision>ISO5436 - 2000</Revision>\n    <FeatureType>{feature}</FeatureType>\n    \
         <Axes>\n{axes}    </Axes>\n  </Record1>\n  <Record2>\n    <Date>{date}</Date>\n    \
         <Instrument>\n      <Manufacturer>{instrument}</Manufacturer>\n      \
         <Model></Model>\n      \
         <Serial></Serial>\n      <Version></Version>\n    </Instrument>\n    \
         <CalibrationDate></CalibrationDate>\n    <ProbingSystem>\n      <Type></Type>\n      \
         <Identification></Identification>\n    </ProbingSystem>\n    \
         <Comment>{comment}</Comment>\n  </Record2>\n  <Record3>\n    <MatrixDimension>\n      \
         <SizeX>{width}</SizeX>\n      <SizeY>{height}</SizeY>\n      <SizeZ>1</SizeZ>\n    \
         </MatrixDimension>\n{record}  </Record3>\n  <Record4>\n    \
         <ChecksumFile>md5checksum.hex</ChecksumFile>\n  </Record4>\n</p:ISO5436_2>\n"
    )
}
