//! Renders that stop, go on elsewhere, and are put together.
#![allow(clippy::unwrap_used)] // Helpers of tests are not seen as tests.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Duration;

use nephroid_session::{
    Checkpoint, CheckpointErrorKind, CheckpointFile, CheckpointInfo, Control, Event, Extent, Job, MergeError,
    Outcome, Output, PictureInfo, Session, compile, gaps, merge, resume, scene_hash, write_checkpoint,
};
use proptest::prelude::*;
use scenefile::SceneDesc;
use scenefile::desc::{Camera, IntegratorKind, Light, LightKind, Material, Object, Shape, Texture};

const MINUTE: Duration = Duration::from_secs(60);

/// A textured ball, with its texture in `folder`.
fn desc(folder: &Path, integrator: IntegratorKind) -> SceneDesc {
    let picture = film::encode_png_bytes(2, 1, &[[255, 0, 0], [0, 255, 9]], &[]).unwrap();
    std::fs::write(folder.join("wood.png"), picture).unwrap();
    let mut desc = SceneDesc { base: folder.to_owned(), ..SceneDesc::default() };
    desc.film.size = [9, 7];
    desc.render.passes = 8;
    desc.render.seed = u64::MAX;
    desc.render.integrator = integrator;
    desc.photon_map.photons = 300;
    desc.photon_map.caustic_photons = 300;
    desc.camera = Some(Camera { position: [0.0, 0.0, 4.0], ..Camera::default() }.into());
    desc.textures.insert("wood".into(), Texture::image("wood.png").into());
    let ball = Shape::Sphere { center: [0.0; 3], radius: 1.0 };
    let wood = scenefile::desc::ColorDesc::Texture("wood".into());
    let material = Material::from(scenefile::desc::MaterialKind::Diffuse { color: wood });
    desc.objects.push(Object::new(ball, material).into());
    desc.lights.push(Light::from(LightKind::Environment { radiance: [1.0; 3] }).into());
    desc
}

fn session(desc: &SceneDesc, passes: Range<u64>, threads: usize) -> Session {
    let job = Job::new(desc, compile(desc, 1).unwrap().scene).unwrap();
    Session::new(Job { passes, ..job }, threads).unwrap()
}

/// Renders a range into a checkpoint.
fn part(desc: &SceneDesc, passes: Range<u64>, path: &Path) -> PathBuf {
    let file = CheckpointFile::create(path).unwrap();
    let info = CheckpointInfo::new(desc).unwrap();
    let mut session = session(desc, passes, 2).with_checkpoint(file, info, MINUTE);
    assert_eq!(session.run(&mut |_| Control::Continue), Ok(Outcome::Finished));
    assert_eq!(session.is_saved(), Some(true));
    path.to_owned()
}

fn exr(film: &film::Film, desc: &SceneDesc, folder: &Path) -> Vec<u8> {
    let path = folder.join("out.exr");
    Output::new(&path).unwrap().write(film, &PictureInfo::new(desc, scene_hash(desc).unwrap())).unwrap();
    std::fs::read(path).unwrap()
}

#[test]
fn straight_resumed_and_merged_renders_give_the_same_bytes() {
    for integrator in [IntegratorKind::Path, IntegratorKind::PhotonMap, IntegratorKind::Sppm] {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let desc = desc(folder.path(), integrator);
        let mut straight = session(&desc, 0..8, 1);
        straight.run(&mut |_| Control::Continue).unwrap();
        let expected = exr(straight.film(), &desc, folder.path());

        // Stopped after two passes, then resumed thrice: one more, a total of six, the rest.
        let file = CheckpointFile::create(&at("a.neph")).unwrap();
        let info = CheckpointInfo::new(&desc).unwrap();
        let mut stopped = session(&desc, 0..8, 3).with_checkpoint(file, info, MINUTE);
        let stop = &mut |event: Event<'_>| match event {
            Event::PassDone { .. } => Control::Stop,
            _ => Control::Continue,
        };
        assert_eq!(stopped.run(stop), Ok(Outcome::Stopped));
        let begun = stopped.done();
        drop(stopped);
        let steps = [(Extent::More(1), begun + 1), (Extent::Total(6), 6), (Extent::Total(8), 8)];
        for (threads, (extent, done)) in (1..).zip(steps) {
            let mut again =
                resume(&at("a.neph"), extent.into(), MINUTE, threads, &scenefile::load).unwrap().session;
            assert_eq!(again.run(&mut |_| Control::Continue), Ok(Outcome::Finished));
            assert_eq!((again.done(), again.is_saved()), (done, Some(true)));
        }
        let resumed = Checkpoint::read(&at("a.neph")).unwrap();
        assert_eq!(&resumed.film, straight.film());
        assert!(exr(&resumed.film, &resumed.info.desc, folder.path()) == expected);

        // Ranges in any order, merged in two steps.
        let parts = [(3..5, "b"), (0..3, "c"), (6..8, "d"), (5..6, "e")]
            .map(|(passes, name)| part(&desc, passes, &at(name).with_extension("neph")));
        let two = merge(&[&parts[2], &parts[0]]).unwrap();
        assert_eq!(gaps(two.film.pass_ranges()), std::slice::from_ref(&(5..6)));
        two.write(&at("f.neph")).unwrap();
        let all = merge(&[&parts[3], &at("f.neph"), &parts[1]]).unwrap();
        assert_eq!(all.info.passes, 0..8);
        assert!(exr(&all.film, &all.info.desc, folder.path()) == expected, "{integrator:?}");
        // And a gap is filled by going on.
        let mut filled =
            resume(&at("f.neph"), Extent::AsAsked.into(), MINUTE, 1, &scenefile::load).unwrap().session;
        assert_eq!((filled.done(), filled.missing()), (4, 1));
        filled.run(&mut |_| Control::Continue).unwrap();
        assert_eq!(filled.film().pass_ranges(), std::slice::from_ref(&(3..8)));
    }
}

#[test]
fn what_does_not_belong_together_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let first = desc(folder.path(), IntegratorKind::Path);
    let a = part(&first, 0..4, &at("a.neph"));
    let mut second = first.clone();
    second.render.max_depth = Some(4);
    second.render.seed = 5;
    second.objects[0].material = Some(Material::diffuse(0.5).into());
    let b = part(&second, 4..8, &at("b.neph"));
    let mut third = first.clone();
    third.film.size = [9, 8];
    let c = part(&third, 4..8, &at("c.neph"));
    let d = part(&first, 2..6, &at("d.neph"));
    std::fs::write(at("wood.png"), film::encode_png_bytes(1, 1, &[[0; 3]], &[]).unwrap()).unwrap();
    let e = part(&first, 4..8, &at("e.neph"));
    std::fs::write(at("no.neph"), "no checkpoint").unwrap();
    let said = |other: &Path| {
        let errors = merge(&[&a, &other.to_path_buf()]).unwrap_err();
        errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    let expected: [(&Path, &[&str]); 6] = [
        (&b, &["a.neph", "b.neph", "render.max_depth: not given, 4", "render.seed: ", "color"]),
        (&c, &["c.neph", "film.size: [9, 7], [9, 8]"]),
        (&d, &["d.neph", "passes 2..4"]),
        (&e, &["e.neph", "the content of wood.png"]),
        (&a, &["passes 0..4"]),
        (&at("no.neph"), &["no.neph", "no checkpoint"]),
    ];
    for (other, parts) in expected {
        let said = said(other);
        assert!(parts.iter().all(|part| said.contains(part)), "{parts:?}: {said}");
    }
    assert!(matches!(merge::<PathBuf>(&[]).unwrap_err()[..], [MergeError::None]));
}

#[test]
fn files_that_were_changed_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let a = part(&desc(folder.path(), IntegratorKind::Path), 0..2, &at("a.neph"));
    let said = || resume(&a, Extent::More(1).into(), MINUTE, 1, &scenefile::load).unwrap_err().to_string();
    std::fs::write(at("wood.png"), film::encode_png_bytes(1, 1, &[[0; 3]], &[]).unwrap()).unwrap();
    assert!(said().contains("wood.png") && said().contains("changed"), "{}", said());
    std::fs::remove_file(at("wood.png")).unwrap();
    assert!(said().contains("wood.png") && said().contains("cannot be read"), "{}", said());
}

/// A scene of another program goes on from its own file, however large it is, and is known again.
#[test]
fn imported_scenes_are_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let whole = desc(folder.path(), IntegratorKind::Path);
    let mut large = whole.clone();
    // Many megabytes of text, more than a scene file may have.
    let n = 400_000;
    let shape = Shape::Triangles {
        positions: (0..n + 2).map(|i| [i as f32 / 7.0, (i % 2) as f32, -3.0]).collect(),
        indices: (0..n).map(|i| [i, i + 1, i + 2]).collect(),
        vertex_normals: vec![],
        uvs: vec![],
        uvs2: vec![],
        colors: vec![],
        normals: Default::default(),
    };
    large.objects.push(Object::new(shape, Material::diffuse(0.5)).into());
    assert!(CheckpointInfo::new(&large).is_err());
    let read = |changed: bool| {
        let mut read = large.clone();
        // What the command line set comes from the checkpoint.
        read.render.passes = 1;
        read.film.size = [1, 1];
        if let (true, Shape::Triangles { positions, .. }) = (changed, &mut read.objects[1].value.shape.value)
        {
            positions[77][1] += 1e-3;
        }
        move |path: &Path, set: &[String]| {
            assert!(path.is_absolute() && path.ends_with("a.other") && set == ["k=1".to_owned()]);
            scenefile::Loaded {
                desc: Some(read.clone()),
                diagnostics: Vec::new(),
                sources: scenefile::Sources::default(),
            }
        }
    };
    let file = CheckpointFile::create(&at("a.neph")).unwrap();
    let info = CheckpointInfo::of_import(&large, &at("a.other"), &["k=1".into()]).unwrap();
    assert_eq!(info.hash, scene_hash(&large).unwrap());
    let mut first = session(&large, 0..2, 2).with_checkpoint(file, info, MINUTE);
    assert_eq!(first.run(&mut |_| Control::Continue), Ok(Outcome::Finished));
    drop(first);
    let go_on = |changed| resume(&at("a.neph"), Extent::Total(4).into(), MINUTE, 1, &read(changed));
    let said = go_on(true).unwrap_err().to_string();
    assert!(said.contains("a.other") && said.contains("changed"), "{said}");
    let mut second = go_on(false).unwrap().session;
    assert_eq!(second.run(&mut |_| Control::Continue), Ok(Outcome::Finished));
    let mut straight = session(&large, 0..4, 1);
    straight.run(&mut |_| Control::Continue).unwrap();
    let picture = |session: &Session| exr(session.film(), &large, folder.path());
    assert_eq!(picture(&second), picture(&straight));
}

#[test]
fn time_that_was_asked_for_is_spent_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.neph");
    let desc = desc(folder.path(), IntegratorKind::Path);
    let info = CheckpointInfo::new(&desc).unwrap();
    let job = Job::new(&desc, compile(&desc, 1).unwrap().scene).unwrap().endless();
    let file = CheckpointFile::create(&path).unwrap();
    let mut session = Session::new(job, 1)
        .unwrap()
        .with_time(Duration::from_secs(3600))
        .with_checkpoint(file, info, MINUTE);
    session.run(&mut |_| Control::Stop).unwrap();
    drop(session);
    let mut resumed = resume(&path, Extent::AsAsked.into(), MINUTE, 1, &scenefile::load).unwrap();
    assert_eq!(resumed.info.time, Some(Duration::from_secs(3600)));
    let mut left = Duration::ZERO;
    let observer = &mut |event: Event<'_>| {
        if let Event::PassDone { remaining, .. } = event {
            left = remaining.time.unwrap();
        }
        Control::Stop
    };
    resumed.session.run(observer).unwrap();
    drop(resumed);
    let (info, _) = Checkpoint::read_head(&path).unwrap();
    assert!(left < Duration::from_secs(3600) && info.elapsed > Duration::ZERO);
    assert!(left + info.elapsed > Duration::from_secs(3590), "{left:?} {info:?}");
    assert_eq!(info.time, Some(Duration::from_secs(3600)));
    // Two more passes, and nothing is said of time any more.
    let mut more = resume(&path, Extent::More(2).into(), MINUTE, 1, &scenefile::load).unwrap().session;
    assert_eq!(more.run(&mut |_| Control::Continue), Ok(Outcome::Finished));
    drop(more);
    let again = resume(&path, Extent::AsAsked.into(), MINUTE, 1, &scenefile::load).unwrap();
    assert_eq!((again.session.missing(), again.session.done()), (0, 4));
    drop(again);
    let wrong = resume(&path, Extent::Total(1).into(), MINUTE, 1, &scenefile::load).unwrap_err().to_string();
    assert!(wrong.contains("4 passes already"), "{wrong}");
}

#[test]
fn a_checkpoint_belongs_to_one_writer() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.neph");
    let busy =
        |path: &Path| matches!(CheckpointFile::open(path).unwrap_err().kind(), CheckpointErrorKind::Busy);
    let file = CheckpointFile::create(&path).unwrap();
    assert!(busy(&path) && busy(&folder.path().join("./a.neph")));
    assert!(file.is(&folder.path().join("./a.neph")));
    drop(file);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    std::fs::write(&path, "something").unwrap();
    let kind = |e: nephroid_session::CheckpointError| format!("{:?}", e.kind());
    assert_eq!(kind(CheckpointFile::create(&path).unwrap_err()), "Exists");
    assert_eq!(kind(CheckpointFile::create(&folder.path().join("a.exr")).unwrap_err()), "Name");
    assert!(kind(CheckpointFile::open(folder.path()).unwrap_err()).contains("IsFolder"));
    assert!(
        kind(CheckpointFile::create(&folder.path().join("no/a.neph")).unwrap_err()).contains("MissingFolder")
    );
}

#[test]
fn checkpoints_come_while_passes_go_and_failures_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let desc = desc(folder.path(), IntegratorKind::Path);
    let home = folder.path().join("home");
    std::fs::create_dir(&home).unwrap();
    let path = home.join("a.neph");
    let file = CheckpointFile::create(&path).unwrap();
    let info = CheckpointInfo::new(&desc).unwrap();
    let mut session =
        session(&desc, 0..film::Film::MAX_PASSES, 2).with_checkpoint(file, info, Duration::ZERO);
    let (mut written, mut failed) = (Vec::new(), Vec::new());
    let observer = &mut |event: Event<'_>| {
        match event {
            Event::CheckpointWritten { passes, bytes, .. } => {
                assert_eq!(std::fs::metadata(&path).unwrap().len(), bytes);
                assert_eq!(Checkpoint::read(&path).unwrap().film.passes(), passes);
                written.push(passes);
                if written.len() == 2 {
                    std::fs::remove_dir_all(&home).unwrap();
                }
            }
            Event::CheckpointFailed { passes, error } => {
                assert!(error.to_string().contains("a.neph"), "{error}");
                failed.push(passes);
                std::fs::create_dir_all(&home).unwrap();
            }
            _ => {}
        }
        if written.len() >= 3 && !failed.is_empty() { Control::Stop } else { Control::Continue }
    };
    assert_eq!(session.run(observer), Ok(Outcome::Stopped));
    assert!(written.is_sorted() && written.last() == Some(&session.done()), "{written:?} {failed:?}");
}

/// Bytes of a small checkpoint.
fn small(folder: &Path) -> Vec<u8> {
    let desc = desc(folder, IntegratorKind::Path);
    let mut session = session(&desc, 0..2, 1);
    session.run(&mut |_| Control::Continue).unwrap();
    let mut bytes = Vec::new();
    write_checkpoint(&mut bytes, &CheckpointInfo::new(&desc).unwrap(), session.film()).unwrap();
    bytes
}

#[test]
fn every_flipped_bit_and_every_cut_is_noticed() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = small(folder.path());
    let path = folder.path().join("a.neph");
    let read = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        Checkpoint::read(&path)
    };
    assert!(read(&bytes).is_ok());
    let mut runner = proptest::test_runner::TestRunner::new(ProptestConfig {
        cases: 1000,
        failure_persistence: None,
        ..ProptestConfig::default()
    });
    let damage = (0..bytes.len(), 0u8..9);
    runner
        .run(&damage, |(at, bit)| {
            let damaged = match bit {
                8 => bytes[..at].to_vec(),
                bit => {
                    let mut bytes = bytes.clone();
                    bytes[at] ^= 1 << bit;
                    bytes
                }
            };
            prop_assert!(read(&damaged).is_err(), "{at} {bit}");
            Ok(())
        })
        .unwrap();
    let mut longer = bytes.clone();
    longer.push(0);
    assert!(read(&longer).is_err());
    let other = [&bytes[..8], &[9, 0, 0, 0], &bytes[12..]].concat();
    assert!(read(&other).unwrap_err().to_string().contains("format 9"));
}
