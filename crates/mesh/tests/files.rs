//! Files by their extension.

use std::path::Path;

use nephroid_mesh::{Place, read};

#[test]
fn extensions_choose_the_reader_and_errors_name_the_path() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let good = write("a.OBJ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_eq!(read(&good).unwrap().indices, [[0, 1, 2]]);

    let bad = write("b.ply", "v 0 0 0\n");
    let error = read(&bad).unwrap_err();
    assert_eq!((error.path.as_deref(), error.place), (Some(bad.as_path()), Place::Line(1)));
    assert!(error.to_string().starts_with(&bad.display().to_string()));

    let error = read(write("c.fbx", "solid")).unwrap_err();
    assert!(error.message.contains("`.fbx`") && error.help.contains(".ply"));
    let missing = Path::new("no such folder/d.ply");
    assert_eq!(read(missing).unwrap_err().path.as_deref(), Some(missing));
}
