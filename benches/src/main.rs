//! `cargo xtask bench`.
#![allow(clippy::print_stdout, clippy::print_stderr)] // it reports

use std::path::PathBuf;
use std::process::ExitCode;

use nephroid_benches::table::{BARS, Row, Rows, json, table};
use nephroid_benches::{checkpoint, memory, pairs, paths, rays, report, search, threads};

const USAGE: &str = "usage: cargo xtask bench [--quick] [--only PREFIX] [--json FILE]
  --quick        smaller inputs, fewer rounds: whether all runs, not how fast
  --only PREFIX  what measures the names that start with it, and those alone
  --json FILE    writes {name: ratio}, > 1 where we are faster";

/// A part of the measurement: the starts of the names that it measures, and the function.
type Group = (&'static [&'static str], fn(&mut Rows, bool) -> Result<(), String>);

const GROUPS: &[Group] = &[
    (&["search.", "threads.search"], |rows, quick| figureless(rows, |results| search::run(results, quick))),
    (&["rays."], |rows, quick| {
        figureless(rows, |results| {
            rays::run(results, quick);
            Ok(())
        })
    }),
    (&["paths."], paths::run),
    (&["report."], |_, quick| report::run(quick)),
    (&["threads.path", "threads.photon_map", "threads.sppm", "threads.vcm", "threads.auto"], threads::run),
    (&["pairs."], pairs::pairs),
    (&["auto."], pairs::default_cost),
    (&["memory."], memory::run),
    (&["checkpoint."], |_, quick| checkpoint::run(quick)),
];

/// Measurements whose figures stand in what they print.
fn figureless(
    rows: &mut Rows,
    run: impl FnOnce(&mut Vec<(String, f64)>) -> Result<(), String>,
) -> Result<(), String> {
    let mut results = Vec::new();
    let outcome = run(&mut results);
    rows.extend(results.into_iter().map(|(name, ratio)| Row::new(name, ratio)));
    outcome
}

#[derive(Default)]
struct Arguments {
    quick: bool,
    only: String,
    json: Option<PathBuf>,
}

fn parse(mut words: impl Iterator<Item = String>) -> Result<Arguments, String> {
    let mut arguments = Arguments::default();
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or_else(|| format!("{word} wants a value\n{USAGE}"));
        match word.as_str() {
            "--quick" => arguments.quick = true,
            "--only" => arguments.only = value()?,
            "--json" => arguments.json = Some(value()?.into()),
            _ => return Err(format!("what is `{word}`?\n{USAGE}")),
        }
    }
    Ok(arguments)
}

/// Whether a group measures names that start with `only`.
fn wanted(starts: &[&str], only: &str) -> bool {
    starts.iter().any(|start| start.starts_with(only) || only.starts_with(start))
}

fn run() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if let Some((memory::PROBE, probed)) = words.split_first().map(|(first, rest)| (first.as_str(), rest)) {
        return memory::be_probed(probed);
    }
    let arguments = parse(words.into_iter())?;
    let only = arguments.only.as_str();
    let groups: Vec<&Group> = GROUPS.iter().filter(|(starts, _)| wanted(starts, only)).collect();
    if groups.is_empty() {
        return Err(format!("nothing that is measured starts with `{only}`"));
    }
    if let Some(path) = &arguments.json {
        // What cannot be written is said before an hour is spent.
        std::fs::write(path, "{}\n").map_err(|e| format!("{}: {e}", path.display()))?;
    }
    let mut rows = Rows::new();
    let mut errors = Vec::new();
    for (_, measure) in groups {
        errors.extend(measure(&mut rows, arguments.quick).err());
    }
    rows.retain(|row| row.name.starts_with(only));
    let expected: Vec<&str> = BARS.iter().map(|(name, _)| *name).filter(|n| n.starts_with(only)).collect();
    if !(rows.is_empty() && expected.is_empty()) {
        println!("\n{}", table(&rows, &expected));
    }
    if let Some(path) = &arguments.json {
        std::fs::write(path, json(&rows)).map_err(|e| format!("{}: {e}", path.display()))?;
    }
    if errors.is_empty() { Ok(()) } else { Err(errors.join("\n")) }
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arguments(text: &str) -> Result<Arguments, String> {
        parse(text.split_whitespace().map(str::to_owned))
    }

    #[test]
    fn arguments_are_read() {
        let all = arguments("--quick --only rays --json out.json").unwrap();
        assert!(all.quick);
        assert_eq!((all.only.as_str(), all.json), ("rays", Some("out.json".into())));
        assert!(arguments("--only").is_err());
        assert!(arguments("--fast").is_err());
    }

    #[test]
    fn prefixes_choose_groups() {
        let chosen =
            |only: &str| -> Vec<usize> { (0..GROUPS.len()).filter(|&i| wanted(GROUPS[i].0, only)).collect() };
        assert_eq!(chosen(""), [0, 1, 2, 3, 4, 5, 6, 7, 8]);
        assert_eq!(chosen("search"), [0]);
        assert_eq!(chosen("rays.room.camera"), [1]);
        assert_eq!(chosen("threads"), [0, 4]);
        assert_eq!(chosen("pairs.vcm"), [5]);
        assert_eq!(chosen("nothing"), Vec::<usize>::new());
    }

    #[test]
    fn every_bar_has_its_group() {
        for (name, _) in BARS {
            assert_eq!(GROUPS.iter().filter(|(starts, _)| wanted(starts, name)).count(), 1, "{name}");
        }
    }
}
