//! What varies from cell to cell of a pictured cloth: felt as scanned, or synthesized.

use selvedge_foundation::numerics::{Grid, median};
use selvedge_foundation::progress::Progress;
use selvedge_foundation::quantity::level_db;
use selvedge_textile::picture::brightness::Brightness;
use selvedge_textile::picture::shading::{Light, Method, ShadingOptions};
use selvedge_textile::picture::{Analysis, Autocorrelation, Relief, ReliefOf};
use selvedge_textile::surface::Representation;
use selvedge_textile::tactile::{Filters, Levels};
use selvedge_textile::{HeightScale, Library, PictureTextile};

use crate::picture::{cloth, real_analysis};
use crate::program::Lab;

const SYNTHESIZED: [&str; 16] = [
    "picture",
    "cloth.png",
    "--out",
    "made",
    "--px-per-mm",
    "8",
    "--shading",
    "dark-is-deep",
    "--light",
    "45,30",
    "--relief-um",
    "100",
    "--textile",
    "cloth",
    "--relief-of",
    "synthesized",
];

#[test]
fn synthesized_cloth_is_made_again_of_its_manifest() {
    let lab = Lab::new();
    lab.write("cloth.png", cloth());
    lab.print(&[&SYNTHESIZED[..], &["--extent-mm", "25"]].concat());
    let manifest = lab.read("cloth/textile.toml");
    assert!(manifest.contains("[source.synthesis]"), "{manifest}");
    assert!(manifest.contains("size_mm = [25.0, 25.0]"), "{manifest}");
    let stroke = lab.read("cloth/warp_forward.csv");
    // 25 mm at 8 px/mm, and somewhat more, so that cells close.
    let n = stroke.lines().count();
    assert!((200..270).contains(&n), "{n} rows");
    lab.print(&["textile", "rebuild", "cloth"]);
    assert_eq!(lab.read("cloth/warp_forward.csv"), stroke, "the same cloth");
    let other = manifest.replace("]\nseed = 1\n", "]\nseed = 2\n");
    assert_ne!(other, manifest);
    lab.write("cloth/textile.toml", other);
    lab.print(&["textile", "rebuild", "cloth"]);
    assert_ne!(lab.read("cloth/warp_forward.csv"), stroke, "other cloth");
    let wide = manifest.replace("size_mm = [25.0, 25.0]", "size_mm = [1000.0, 1000.0]");
    lab.write("cloth/textile.toml", wide);
    let line = lab.refuse(&["textile", "rebuild", "cloth"]);
    assert!(line.contains("more than 16 million"), "{line}");
}

#[test]
fn what_has_no_lattice_is_felt_all_the_same_and_has_no_cell() {
    let lab = Lab::new();
    let mut random = selvedge_foundation::numerics::Random::new(5);
    let noise = selvedge_foundation::files::Rgb8Image {
        width: 150,
        height: 150,
        pixels: (0..150 * 150)
            .map(|_| [selvedge_foundation::numerics::to_byte(60.0 + 80.0 * random.uniform()); 3])
            .collect(),
    };
    lab.write("cloth.png", noise.to_png("cloth.png".as_ref()).unwrap());
    let said = lab.print(&SYNTHESIZED);
    assert!(
        said.contains("no lattice") && said.contains("cloth: the textile"),
        "{said}"
    );
    let manifest = lab.read("cloth/textile.toml");
    assert!(
        manifest.contains("[source.synthesis]") && !manifest.contains("lattice_px"),
        "{manifest}"
    );
    let line = lab.refuse(&[&SYNTHESIZED[..15], &["cell"]].concat());
    assert!(line.contains("no lattice and so no cell"), "{line}");
    let line = lab.refuse(&[&SYNTHESIZED[..15], &["picture", "--extent-mm", "20"]].concat());
    assert!(line.contains("--relief-of synthesized"), "{line}");
}

/// Real pictures that are small.
const REAL: [&str; 3] = [
    "licensed/gimp_greyweave.png",
    "licensed/inkscape_cloth.png",
    "licensed/hsst_2024_9_11_14_28_3_725_1792_0.jpg",
];

/// Heights of a picture as a textile has them, and its levels, dB re 1 µm.
fn felt(analysis: &Analysis, extent_mm: Option<f64>) -> (Grid<f64>, [f64; 2]) {
    let found = analysis.found.as_ref().ok();
    let ground = (ReliefOf::Picture, &analysis.luminance);
    let brightness = Brightness::ground(ground, found, Some(12.0), 2).unwrap();
    let options = ShadingOptions {
        method: Method::DarkIsDeep,
        ..ShadingOptions::default()
    };
    let of = |progress: &mut Progress<'_>| {
        let light = Light {
            slant_deg: 45.0,
            tilt_deg: 30.0,
        };
        Relief::of(brightness, Some(light), &options, progress)
    };
    let relief = Progress::unheard(of).unwrap();
    let about = PictureTextile {
        name: "cloth".to_owned(),
        px_per_mm: 12.0,
        scale: HeightScale::ReliefUm(200.0),
        extent_mm,
        representation: Representation::Areal,
        ..PictureTextile::default()
    };
    let tile = found.map(|found| &found.tile);
    let made = PictureTextile::files_of(&relief.shape, &relief.brightness, tile, &about).unwrap();
    let textile = Library::of_files("cloth", made.files)
        .load("cloth")
        .unwrap();
    let levels = Levels::of(textile.surface(), &Filters::default());
    (made.map.heights_um().clone(), levels.mean_um.map(level_db))
}

/// The largest ρ of a part beyond so many samples.
fn most_alike(cloth: &Grid<f64>, size: [usize; 2], beyond: f64) -> f64 {
    let part = cloth.part([0, 0, size[0], size[1]]).unwrap();
    let rho = Autocorrelation::of(&part, 2);
    let [right, down] = rho.reach().map(usize::cast_signed);
    let shifts = (0..=down).flat_map(|y| (-right..=right).map(move |x| [x, y]));
    let is_beyond = |[x, y]: &[isize; 2]| (*x as f64).hypot(*y as f64) > beyond;
    let all = shifts.filter(is_beyond).filter_map(|[x, y]| rho.at(x, y));
    all.fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn synthesized_cloth_is_felt_like_its_scan_and_repeats_less() {
    let mut off_db = Vec::new();
    for name in REAL {
        let analysis = match real_analysis(name) {
            Ok(analysis) => analysis,
            Err(why) => {
                println!("skipped: {why}");
                continue;
            }
        };
        let (scan, scan_db) = felt(&analysis, None);
        let (made, made_db) = felt(&analysis, Some(40.0));
        let size = [scan.width(), scan.height()];
        assert!(made.width() > size[0] && made.height() > size[1], "{name}");
        let found = analysis.found.as_ref();
        let cell = found.map_or(5.0, |found| found.lattice.basis().longer());
        let [here, there] = [&scan, &made].map(|cloth| most_alike(cloth, size, 1.1 * cell));
        println!("{name}: {scan_db:.1?} dB, synthesized {made_db:.1?} dB; ρ {here:.2}, {there:.2}");
        assert!(
            there <= here + 0.03,
            "{name}: {there} and {here} in the scan"
        );
        off_db.extend([0, 1].map(|band| (made_db[band] - scan_db[band]).abs()));
    }
    if !off_db.is_empty() {
        let off_db = median(&mut off_db);
        assert!(off_db < 1.5, "{off_db} dB in the median");
    }
}
