//! `selvedge picture` of a folder.

use crate::picture::cloth;
use crate::program::Lab;

#[test]
fn a_folder_of_pictures_becomes_a_folder_each_and_a_table() {
    let lab = Lab::new();
    lab.write("scans/b.png", cloth());
    lab.write("scans/a.PNG", cloth());
    lab.write("scans/notes.txt", "no picture");
    let line = lab.print(&["picture", "scans", "--out", "made"]);
    assert!(line.ends_with("made/pictures.csv: 2 pictures\n"), "{line}");
    for name in ["a", "b"] {
        assert!(
            lab.read(&format!("made/{name}/periodicity.json"))
                .contains("lattice")
        );
    }
    let table = lab.read("made/pictures.csv");
    let rows: Vec<&str> = table.lines().collect();
    assert!(
        rows[1].starts_with("a.PNG,160,140,") && rows[2].starts_with("b.png,"),
        "{table}"
    );
    // What is none is told, and the others go on; two of one name have both ends.
    lab.write("scans/b.jpg", "no picture either");
    let told = lab.run(&["picture", "scans", "--out", "more"]);
    let said = "1 of 3 pictures could not be analysed";
    assert!(told.code == 2 && told.err.contains(said), "{told:?}");
    assert!(lab.read("more/b.png/periodicity.json").contains("lattice"));
    let table = lab.read("more/pictures.csv");
    assert!(
        table.lines().nth(2).unwrap().starts_with("b.jpg,,,"),
        "{table}"
    );
    lab.write("empty/notes.txt", "no picture");
    let line = lab.refuse(&["picture", "empty", "--out", "none"]);
    assert!(line.contains("there is no picture in it"), "{line}");
}
