//! Chains of calls and fields.

use syn::Expr;

use super::brackets;
use super::flat::{flat, member, method};
use super::shape::{STEP, Shape, first_line, is_broken, line_break, width};

/// A link of a chain.
struct Link<'a> {
    expr: &'a Expr,
    /// How many question marks follow.
    tries: usize,
}

impl Link<'_> {
    fn rewrite(&self, shape: Shape) -> Option<String> {
        let shape = shape.keeping(self.tries);
        let text = self.flat().filter(|text| width(text) <= shape.width());
        Some(text.or_else(|| self.broken(shape))? + &"?".repeat(self.tries))
    }

    fn flat(&self) -> Option<String> {
        match self.expr {
            Expr::MethodCall(call) => {
                let arguments: Option<Vec<_>> = call.args.iter().map(flat).collect();
                Some(format!(".{}({})", method(call), arguments?.join(", ")))
            }
            Expr::Field(field) => Some(format!(".{}", member(&field.member))),
            _ => None,
        }
    }

    fn broken(&self, shape: Shape) -> Option<String> {
        let Expr::MethodCall(call) = self.expr else { return None };
        brackets::broken(&format!(".{}", method(call)), ['(', ')'], &call.args, shape)
    }
}

/// Returns how many columns rustfmt keeps free behind a chain that ends with question marks: two for each.
pub fn kept(expr: &Expr) -> usize {
    match expr {
        Expr::Try(tried) if brackets::is_chain(&tried.expr) => 2 + kept(&tried.expr),
        _ => 0,
    }
}

/// Returns the root of a chain, and its links in order.
fn links(expr: &Expr) -> (&Expr, Vec<Link<'_>>) {
    let (mut root, mut marks, mut links) = (expr, 0, Vec::new());
    loop {
        root = match root {
            Expr::Try(tried) => {
                marks += 1;
                &tried.expr
            }
            Expr::MethodCall(call) => {
                links.push(Link { expr: root, tries: std::mem::take(&mut marks) });
                &call.receiver
            }
            Expr::Field(field) => {
                links.push(Link { expr: root, tries: std::mem::take(&mut marks) });
                &field.base
            }
            _ => {
                links.reverse();
                return (root, links);
            }
        };
    }
}

/// Lays out a chain that does not fit on one line.
///
/// If that is enough, only its last link is broken. Else each link has its line.
pub fn broken(expr: &Expr, shape: Shape) -> Option<String> {
    let (root, links) = links(expr);
    let mut root = shape.rewrite(root)?;
    let mut links = links.into_iter().peekable();
    let short = STEP.saturating_sub(shape.column - shape.indent);
    while width(&root) <= short && !is_broken(&root) && links.peek().is_some() {
        let link = links.next()?;
        root = format!("{root}{}", link.rewrite(shape.behind(width(&root)))?);
    }
    let links: Vec<_> = links.collect();
    let Some((last, others)) = links.split_last() else { return Some(root) };
    let indent = if is_broken(&root) { shape.indent } else { shape.indent + STEP };
    let own = Shape { indent, column: indent, after: 0, ..shape };
    let others: Vec<_> = others.iter().map(|link| link.rewrite(own)).collect::<Option<_>>()?;
    let is_flat = std::iter::once(&root).chain(&others).all(|text| !is_broken(text));
    let before = if is_flat { root.clone() + &others.concat() } else { last_line(&root).to_owned() };
    let alone = last.rewrite(own.keeping(shape.after));
    let place = if is_flat { shape } else { own.keeping(shape.after) };
    let taken = width(&before) + 2 * last.tries;
    let behind = Some(place.behind(taken)).filter(|_| is_flat || is_extended(&before));
    let budget = shape.behind(taken).width();
    let behind = behind.and_then(|shape| last.rewrite(shape));
    let behind = behind.filter(|text| is_better(text, alone.as_deref(), budget));
    match behind {
        Some(text) if is_flat => Some(before + &text),
        text => {
            let texts = std::iter::once(root).chain(others).chain([text.or(alone)?]).collect::<Vec<_>>();
            (!shape.keeps_chains).then(|| texts.join(&line_break(indent)))
        }
    }
}

fn last_line(text: &str) -> &str {
    text.lines().next_back().unwrap_or("")
}

/// Tests whether a line only closes brackets.
fn is_extended(line: &str) -> bool {
    line.chars().all(|letter| matches!(letter, '(' | ')' | ']' | '}' | '?' | '>' | ' '))
}

/// Tests whether the last link is better broken as behind the others than on its own line.
fn is_better(text: &str, alone: Option<&str>, budget: usize) -> bool {
    let lines = text.lines().count();
    let fits = width(first_line(text)) <= budget;
    fits && (lines >= 5 || alone.is_none_or(|alone| alone.lines().count() >= lines))
}
