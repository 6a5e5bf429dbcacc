//! A program that ends in the middle of writing. Alone in its process: nothing can be written afterwards.
#![allow(clippy::unwrap_used)] // Helpers of tests are not seen as tests.

use std::fs;
use std::io::Write;

use nephroid_film::{
    check_writable, discard_leftovers, discard_unfinished, write_atomically, write_atomically_with,
};

#[test]
fn nothing_half_written_is_left_and_what_was_there_stays() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let names = || fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect::<Vec<_>>();
    for (name, stays) in [(".a.exr-aB3xY9.part", false), (".a.exr-.part", true), (".b.exr-aB3xY9.part", true)]
    {
        let path = folder.path().join(name);
        fs::write(&path, "left").unwrap();
        discard_leftovers(&folder.path().join("a.exr"));
        assert_eq!(path.exists(), stays, "{name}");
        fs::remove_file(path).ok();
    }
    write_atomically(&path, b"old").unwrap();
    let failed = write_atomically_with(&path, |out| {
        out.write_all(&[1; 100])?;
        Err(std::io::ErrorKind::StorageFull.into())
    });
    assert!(failed.unwrap_err().to_string().contains("no space"));
    assert_eq!(names(), ["a.exr"]);
    let cut_short = write_atomically_with(&path, |out| {
        out.write_all(b"new")?;
        out.flush()?;
        assert_eq!(names().len(), 2);
        discard_unfinished();
        assert_eq!(names(), ["a.exr"]);
        Ok(())
    });
    assert!(cut_short.unwrap_err().to_string().contains("ending"));
    assert!(write_atomically(&path, b"late").is_err() && check_writable(&path).is_err());
    assert_eq!(names(), ["a.exr"]);
    assert_eq!(fs::read(&path).unwrap(), b"old");
}
