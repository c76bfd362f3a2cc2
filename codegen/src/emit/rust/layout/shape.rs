//! Where code is laid out, and how much fits there.

use syn::Expr;

/// The longest line.
pub const LONGEST: usize = 120;

/// How far the content of a block or of brackets is indented.
pub const STEP: usize = 4;

/// The place where an expression begins.
#[derive(Clone, Copy)]
pub struct Shape {
    /// Indentation of its last line, and least indentation of the lines before.
    pub indent: usize,
    /// The column in which it begins.
    pub column: usize,
    /// Number of columns that are kept for the text after it.
    pub after: usize,
    /// Whether the links of chains must stay on one line.
    pub keeps_chains: bool,
    /// Lays out an expression that begins there; `None` if it does not fit.
    pub rewrite: fn(&Expr, Self) -> Option<String>,
}

impl Shape {
    /// Returns the place of a whole line, where expressions are laid out by a function.
    pub fn new(indent: usize, rewrite: fn(&Expr, Self) -> Option<String>) -> Self {
        Self { indent, column: indent, after: 0, keeps_chains: false, rewrite }
    }

    /// Lays out an expression that begins here; `None` if it does not fit.
    pub fn rewrite(self, expr: &Expr) -> Option<String> {
        (self.rewrite)(expr, self)
    }

    /// Returns the place of the whole line on which this one lies.
    pub fn line(self) -> Self {
        Self { column: self.indent, after: 0, keeps_chains: false, ..self }
    }

    /// Returns the place behind some columns.
    pub fn behind(self, columns: usize) -> Self {
        Self { column: self.column + columns, ..self }
    }

    /// Returns the same place with more columns kept for the text after it.
    pub fn keeping(self, columns: usize) -> Self {
        Self { after: self.after + columns, ..self }
    }

    /// Returns the place of a line that is indented further.
    pub fn nested(self) -> Self {
        let indent = self.indent + STEP;
        Self { indent, column: indent, after: 0, ..self }
    }

    /// Returns how much fits on the first line.
    pub fn width(self) -> usize {
        LONGEST.saturating_sub(self.column + self.after)
    }
}

/// Returns how many columns a text takes.
pub fn width(text: &str) -> usize {
    text.chars().count()
}

/// Returns the first line of a text.
pub fn first_line(text: &str) -> &str {
    text.lines().next().unwrap_or("")
}

/// Returns the line break before a line with this indentation.
pub fn line_break(indent: usize) -> String {
    format!("\n{}", " ".repeat(indent))
}

/// Tests whether a text has several lines.
pub fn is_broken(text: &str) -> bool {
    text.contains('\n')
}

/// Counts the line breaks of a text.
pub fn breaks(text: &str) -> usize {
    text.matches('\n').count()
}
