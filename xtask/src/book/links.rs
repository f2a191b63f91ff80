//! Links between the two books: in the sources they lead from one `src` folder to the other, where they are built the second book is inside of the first.

use std::path::{Path, PathBuf};

/// Where the second book is inside of the first one.
const SECOND: &str = "verification";

/// Rewrites the links between the books in all pages of both, then checks that every link of a page leads to a file.
pub fn connect(book: &Path) -> Result<(), String> {
    let mut pages = Vec::new();
    collect(book, &mut pages)?;
    let mut wrong = Vec::new();
    for page in pages {
        let text = read(&page)?;
        let inside = page.strip_prefix(book).unwrap_or(&page);
        let rewritten = rewritten(&text, inside);
        let folder = page.parent().unwrap_or(book);
        for link in links(&rewritten) {
            if !folder.join(link).exists() {
                wrong.push(format!("{}: {link}", inside.display()));
            }
        }
        if rewritten != text {
            std::fs::write(&page, rewritten).map_err(|e| format!("{}: {e}", page.display()))?;
        }
    }
    match wrong.is_empty() {
        true => Ok(()),
        false => Err(format!("links that lead nowhere:\n{}", wrong.join("\n"))),
    }
}

/// The page at a path inside of the built books, with links that lead to the other book.
fn rewritten(text: &str, page: &Path) -> String {
    let up = |levels: usize| "../".repeat(levels);
    let depth = page.components().count() - 1;
    let (from, to) = match page.starts_with(SECOND) {
        true => (format!("{}src/", up(depth + 1)), up(depth)),
        false => (
            format!("{}{SECOND}/src/", up(depth + 1)),
            format!("{}{SECOND}/", up(depth)),
        ),
    };
    text.replace(&format!("href=\"{from}"), &format!("href=\"{to}"))
}

/// The links of a page to files of the books, without what follows a `#`.
fn links(text: &str) -> impl Iterator<Item = &str> {
    let all = text.split("href=\"").skip(1);
    let targets = all.filter_map(|rest| rest.split(['"', '#', '?']).next());
    targets.filter(|link| !link.is_empty() && !link.contains(':') && !link.starts_with('/'))
}

/// The pages under a folder; those for printing have the links of all pages and are left out.
fn collect(folder: &Path, pages: &mut Vec<PathBuf>) -> Result<(), String> {
    let entries = std::fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    for entry in entries {
        let path = entry
            .map_err(|e| format!("{}: {e}", folder.display()))?
            .path();
        if path.is_dir() {
            collect(&path, pages)?;
        } else if path.extension().is_some_and(|e| e == "html") && !path.ends_with("print.html") {
            pages.push(path);
        }
    }
    Ok(())
}

fn read(page: &Path) -> Result<String, String> {
    std::fs::read_to_string(page).map_err(|e| format!("{}: {e}", page.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_between_the_books_follow_the_folders_where_they_are_built() {
        let built = |link: &str, page: &str| {
            let text = format!("<a href=\"{link}\">");
            let text = rewritten(&text, Path::new(page));
            links(&text).map(str::to_string).collect::<Vec<_>>()
        };
        let second = "verification/decks.html";
        assert_eq!(
            built("../verification/src/decks.html", "gallery.html"),
            [second]
        );
        assert_eq!(
            built(
                "../../verification/src/decks.html#punch1",
                "topics/wear.html"
            ),
            [format!("../{second}")]
        );
        assert_eq!(
            built("../../src/topics/wear.html", second),
            ["../topics/wear.html"]
        );
        assert_eq!(built("tolerances.html", second), ["tolerances.html"]);
    }

    #[test]
    fn only_links_to_files_of_the_books_are_checked() {
        let text = "<a href=\"https://toml.io\"><a href=\"#top\"><a href=\"a.html#b\"><a href=\"mailto:a@b\">";
        assert_eq!(links(text).collect::<Vec<_>>(), ["a.html"]);
    }
}
