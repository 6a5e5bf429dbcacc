//! `cargo xtask book`: checks what the pages of the repository link to, and makes a site of docs/ by mdBook.

mod links;
mod preprocess;
mod site;
mod words;

use std::process::Command;

use crate::{Outcome, root};

/// Where links of the site lead that leave docs/.
const REPOSITORY: &str = env!("CARGO_PKG_REPOSITORY");

/// Where mdBook writes the site (book.toml says so to it), from the root.
const SITE: &str = "target/book";

/// Checks and builds; `--check` builds nothing. mdBook itself calls this with `--preprocess` (see book.toml).
pub fn run(arguments: &[String]) -> Outcome {
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        [] => {
            check()?;
            build()
        }
        ["--check"] => check(),
        ["--preprocess"] => preprocess::run(),
        ["--preprocess", "supports", _] => Ok(()),
        _ => Err("usage: cargo xtask book [--check]".into()),
    }
}

fn check() -> Outcome {
    links::check(&root())?;
    words::check(&root())
}

fn build() -> Outcome {
    let status = match Command::new("mdbook").arg("build").current_dir(root()).status() {
        Ok(status) => status,
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
            println!(
                "The links are good. mdBook makes the site and is not on the PATH: `cargo install mdbook --locked`"
            );
            return Ok(());
        }
        Err(e) => return Err(format!("mdbook does not start: {e}")),
    };
    if !status.success() {
        return Err("mdbook failed".into());
    }
    site::check(&root().join(SITE))?;
    println!("{SITE}/index.html");
    Ok(())
}

#[cfg(test)]
mod tests {
    #[test]
    fn all_links_lead_somewhere() {
        if let Err(wrong) = super::links::check(&super::root()) {
            panic!("{wrong}");
        }
    }
}
