//! Pictures of scenes that stand on pages of the book, rendered from there.

use testkit::markdown;

use crate::root;

/// A page whose first block of TOML is a scene.
pub struct Page {
    /// Of the page and of its picture in docs/book/pictures/, without ending.
    pub name: &'static str,
    /// What its command line adds to the scene.
    pub arguments: &'static [&'static str],
}

pub const PAGES: &[Page] = &[
    Page { name: "first-picture", arguments: &["--denoise"] },
    Page { name: "product-light", arguments: &["--passes", "256", "--denoise"] },
    Page { name: "lux", arguments: &["--denoise"] },
];

impl Page {
    /// The scene on the page.
    ///
    /// # Errors
    /// Where the page cannot be read, or has none.
    pub fn scene(&self) -> Result<String, String> {
        let path = root().join("docs/book").join(self.name).with_extension("md");
        let text = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let block = markdown::blocks(&text).into_iter().find(|block| block.language == "toml");
        block.map(|block| block.text).ok_or_else(|| format!("{} has no scene", path.display()))
    }
}
