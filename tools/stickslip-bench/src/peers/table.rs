//! Tables in Markdown.

/// A table that prints itself row by row, so that long measurements show what they have.
pub struct Table;

impl Table {
    /// Prints a title and the heads of the columns.
    pub fn new(title: &str, heads: &[&str]) -> Self {
        println!("\n**{title}**\n");
        println!("{}", line(heads.iter().map(|h| h.to_string())));
        println!("|{}", "---|".repeat(heads.len()));
        Table
    }

    /// Prints a row.
    pub fn row(&self, cells: impl IntoIterator<Item = String>) {
        println!("{}", line(cells));
    }
}

/// A row of a table.
fn line(cells: impl IntoIterator<Item = String>) -> String {
    let cells: Vec<String> = cells.into_iter().collect();
    format!("| {} |", cells.join(" | "))
}

#[cfg(test)]
mod tests {
    use super::line;

    #[test]
    fn a_row_has_bars_around_and_between_its_cells() {
        assert_eq!(line(["a".to_string(), "b".to_string()]), "| a | b |");
    }
}
