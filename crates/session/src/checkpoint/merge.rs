use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use film::FilmHead;

use super::difference::differences;
use super::{Checkpoint, CheckpointError, CheckpointErrorKind, CheckpointInfo};
use crate::ranges::{common, hull, said};

/// Why checkpoints do not add up.
#[derive(Debug)]
#[non_exhaustive]
pub enum MergeError {
    /// One cannot be used.
    Checkpoint(CheckpointError),
    /// Two hold the same passes.
    Overlap {
        /// One file.
        first: PathBuf,
        /// The other.
        second: PathBuf,
        /// Passes that both hold.
        passes: Vec<Range<u64>>,
    },
    /// Two are of different scenes or settings.
    Different {
        /// One file.
        first: PathBuf,
        /// The other.
        second: PathBuf,
        /// What differs: keys of the description with both values, or files.
        what: Vec<String>,
    },
    /// There is nothing to merge.
    None,
}

impl fmt::Display for MergeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Checkpoint(error) => write!(f, "{error}"),
            Self::Overlap { first, second, passes } => write!(
                f,
                "cannot merge {} and {}: both hold {}",
                first.display(),
                second.display(),
                said(passes)
            ),
            Self::Different { first, second, what } => {
                write!(f, "cannot merge {} and {}: they differ", first.display(), second.display())?;
                what.iter().try_for_each(|line| write!(f, "\n  {line}"))
            }
            Self::None => write!(f, "there is nothing to merge"),
        }
    }
}

impl std::error::Error for MergeError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Checkpoint(error) => Some(error),
            _ => None,
        }
    }
}

/// Adds up checkpoints of one scene with the same settings that hold different passes. The film is the same as if one
/// render had made all passes, in whatever order they are given.
///
/// The description is the first one's, the passes asked for reach from the first to the last that there is, what time
/// was spent is added up, and neither a time nor pictures are asked for.
///
/// Memory: two films, the sum and the one that is read. All files are looked at before the first film is read.
///
/// # Errors
/// Everything that keeps them from adding up.
pub fn merge<P: AsRef<Path>>(paths: &[P]) -> Result<Checkpoint, Vec<MergeError>> {
    check(paths)?;
    let one = |error| vec![error];
    let unreadable = |error| one(MergeError::Checkpoint(error));
    let Some((first, rest)) = paths.split_first() else { return Err(one(MergeError::None)) };
    let mut sum = Checkpoint::read(first.as_ref()).map_err(unreadable)?;
    for path in rest {
        let path = path.as_ref();
        let part = Checkpoint::read(path).map_err(unreadable)?;
        sum.film.merge(&part.film).map_err(|e| {
            unreadable(CheckpointError::new(path, CheckpointErrorKind::Content(e.to_string())))
        })?;
        sum.info.elapsed += part.info.elapsed;
        sum.info.timings.merge(&part.info.timings);
    }
    sum.info.passes = hull(sum.film.pass_ranges()).unwrap_or(sum.info.passes);
    sum.info.time = None;
    sum.info.outputs.clear();
    Ok(sum)
}

/// Looks at the heads of all files.
fn check<P: AsRef<Path>>(paths: &[P]) -> Result<(), Vec<MergeError>> {
    let (mut heads, mut errors) = (Vec::new(), Vec::new());
    for path in paths {
        match Checkpoint::read_head(path.as_ref()) {
            Ok((info, head)) => heads.push((path.as_ref(), info, head)),
            Err(error) => errors.push(MergeError::Checkpoint(error)),
        }
    }
    if let Some((first, rest)) = heads.split_first() {
        errors.extend(rest.iter().filter_map(|other| different(first, other)));
    }
    for (i, (first, _, one)) in heads.iter().enumerate() {
        for (second, _, other) in &heads[i + 1..] {
            let passes = common(&one.passes, &other.passes);
            if !passes.is_empty() {
                errors.push(MergeError::Overlap { first: first.into(), second: second.into(), passes });
            }
        }
    }
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

type Head<'a> = (&'a Path, CheckpointInfo, FilmHead);

fn different((first, a, film): &Head<'_>, (second, b, other): &Head<'_>) -> Option<MergeError> {
    let mut what = differences(&a.desc, &b.desc);
    // Files that only one has show in the description.
    for (name, hash) in &a.files {
        if b.files.iter().any(|(n, h)| n == name && h != hash) {
            what.push(format!("the content of {}", name.display()));
        }
    }
    if film.layers != other.layers {
        what.push(format!("layers: [{}], [{}]", film.layers.join(", "), other.layers.join(", ")));
    }
    if what.is_empty() && a.hash != b.hash {
        what.push(format!("the scene: {}, {}", a.hash, b.hash));
    }
    let (first, second) = (first.to_path_buf(), second.to_path_buf());
    (!what.is_empty()).then_some(MergeError::Different { first, second, what })
}
