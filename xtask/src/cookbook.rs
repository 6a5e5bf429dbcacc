//! `cargo xtask cookbook`: the pictures of docs/cookbook/, and the scenes that its pages quote.

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use crate::{Outcome, pictures, root};

/// Recipes: the page's name, and the scene below scenes/cookbook/.
pub const RECIPES: [(&str, &str); 10] = [
    ("pool", "pool.toml"),
    ("ring", "ring.toml"),
    ("whisky", "whisky.toml"),
    ("coffee-cup", "coffee-cup.toml"),
    ("wine-glass", "wine-glass.toml"),
    ("headlight", "headlight.toml"),
    ("office", "office.toml"),
    ("window", "window.toml"),
    ("underwater", "underwater.toml"),
    ("product", "perfume.glb"),
];

/// The command line that makes a recipe's picture, as its page has it, without the name of the program.
pub fn command(name: &str, scene: &str) -> Vec<String> {
    let more: &[&str] = if name == "product" { PRODUCT } else { &[] };
    let output = format!("{name}.png");
    let path = format!("scenes/cookbook/{scene}");
    let words = [path.as_str()].into_iter().chain(more.iter().copied()).chain(["--denoise", "-o", &output]);
    words.map(Into::into).collect()
}

/// What a model without a camera is to be seen with.
const PRODUCT: &[&str] = &["--size", "800x1000", "--passes", "46"];

const QUALITY: u8 = 90;

/// Renders the pictures named, or all; `--pages` writes scenes into the pages instead, `--jpeg FILE.png FILE.jpg` converts one picture.
pub fn run(arguments: &[String]) -> Outcome {
    match arguments {
        [flag] if flag == "--pages" => RECIPES.iter().try_for_each(|(name, scene)| quote(name, scene)),
        [flag, from, to] if flag == "--jpeg" => jpeg(Path::new(from), Path::new(to)),
        names => {
            if let Some(name) = names.iter().find(|name| !RECIPES.iter().any(|recipe| recipe.0 == **name)) {
                let all = RECIPES.map(|recipe| recipe.0).join(", ");
                return Err(format!("no recipe is called `{name}`; there are {all}"));
            }
            let nephroid = pictures::build()?;
            for (name, scene) in RECIPES {
                if names.is_empty() || names.iter().any(|other| other == name) {
                    render(&nephroid, name, scene)?;
                }
            }
            Ok(())
        }
    }
}

fn render(nephroid: &Path, name: &str, scene: &str) -> Outcome {
    let folder = root().join("target/cookbook");
    std::fs::create_dir_all(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let picture = folder.join(format!("{name}.png"));
    let mut words = command(name, scene);
    words[0] = root().join(&words[0]).display().to_string();
    words.pop();
    let start = Instant::now();
    pictures::render(name, Command::new(nephroid).args(words).arg(&picture))?;
    println!("{name}: {:.0} s", start.elapsed().as_secs_f64());
    jpeg(&picture, &root().join(format!("docs/cookbook/{name}.jpg")))
}

fn jpeg(from: &Path, to: &Path) -> Outcome {
    let bytes = pictures::jpeg(&pictures::open(from)?, QUALITY)?;
    std::fs::write(to, bytes).map_err(|e| format!("{}: {e}", to.display()))
}

/// Writes a recipe's scene into the `toml` block of its page.
fn quote(name: &str, scene: &str) -> Outcome {
    let path = root().join(format!("docs/cookbook/{name}.md"));
    let page = read(&path)?;
    let new = quoted(name, scene, &page)?;
    if new == page {
        Ok(())
    } else {
        std::fs::write(&path, new).map_err(|e| format!("{}: {e}", path.display()))
    }
}

/// The page with the scene in its `toml` block; as it is, where the scene is no TOML file.
fn quoted(name: &str, scene: &str, page: &str) -> Result<String, String> {
    const START: &str = "```toml\n";
    if !scene.ends_with(".toml") {
        return Ok(page.into());
    }
    let block = page.split_once(START).and_then(|(head, rest)| Some((head, rest.split_once("```\n")?.1)));
    let Some((head, tail)) = block else {
        return Err(format!("docs/cookbook/{name}.md has no block of toml for its scene"));
    };
    let text = read(&root().join("scenes/cookbook").join(scene))?;
    Ok(format!("{head}{START}{text}```\n{tail}"))
}

fn read(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_quote_their_scenes_and_give_their_commands() {
        for (name, scene) in RECIPES {
            let page = read(&root().join(format!("docs/cookbook/{name}.md"))).unwrap();
            assert!(
                quoted(name, scene, &page).unwrap() == page,
                "cargo xtask cookbook --pages: {name}.md is stale"
            );
            let line = format!("\nnephroid {}\n", command(name, scene).join(" "));
            assert!(page.contains(&line), "{name}.md lacks the command{line}");
            assert!(root().join(format!("docs/cookbook/{name}.jpg")).is_file(), "{name}.jpg is missing");
        }
    }
}
