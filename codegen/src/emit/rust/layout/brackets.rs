//! What stands in brackets: arguments, and the elements of arrays and tuples.

use syn::punctuated::Punctuated;
use syn::{Expr, Token};

use super::control::closure;
use super::flat::flat;
use super::shape::{STEP, Shape, breaks, first_line, is_broken, line_break, width};

/// Elements that are no wider than this share lines.
const SHORT: usize = 10;

/// Lays out items in brackets that do not fit on one line.
///
/// If that is enough, only the last item is broken. Else each has its line. The text before stands on the same line as
/// the opening bracket.
pub fn broken(before: &str, brackets: [char; 2], items: &Punctuated<Expr, Token![,]>, shape: Shape) -> Option<String> {
    let [open, close] = brackets;
    let items: Vec<_> = items.iter().collect();
    let inside = shape.behind(width(before) + 1).keeping(1);
    if let Some(items) = last_broken(before, &items, inside, shape) {
        return Some(format!("{before}{open}{items}{close}"));
    }
    let nested = shape.nested().keeping(1);
    let lines: Vec<_> = items.iter().map(|item| nested.rewrite(item)).collect::<Option<_>>()?;
    let are_short = items.iter().zip(&lines).all(|(item, line)| is_simple(item) && width(line) <= SHORT);
    let (start, end) = (line_break(nested.indent), line_break(shape.indent));
    let lines = if are_short { filled(&lines, nested) } else { lines.join(&format!(",{start}")) };
    Some(format!("{before}{open}{start}{lines},{end}{close}"))
}

/// Breaks only the last item.
fn last_broken(before: &str, items: &[&Expr], inside: Shape, outer: Shape) -> Option<String> {
    let (last, others) = items.split_last()?;
    let joins = items.len() == 1 && width(before) < STEP;
    if !joins && !can_be_last(last, items.len()) {
        return None;
    }
    let others: String = others.iter().map(|item| Some(flat(item)? + ", ")).collect::<Option<_>>()?;
    let shape = inside.behind(width(&others));
    let keeps_chains = shape.keeps_chains || (!joins && is_chain(last));
    let text = match last {
        Expr::Closure(known) => closure(known, shape),
        other => Shape { keeps_chains, ..shape }.rewrite(other),
    };
    let text = text.filter(|text| width(first_line(text)) <= shape.width())?;
    let fits_alone =
        || outer.nested().keeping(1).rewrite(last).is_some_and(|alone| items.len() == 1 && !is_broken(&alone));
    (breaks(&text) != 1 || !fits_alone()).then(|| others + &text)
}

/// Tests whether an item can be broken while those before it stay on the line.
fn can_be_last(item: &Expr, count: usize) -> bool {
    match item {
        Expr::Closure(_) | Expr::Block(_) => true,
        Expr::Array(_)
        | Expr::Call(_)
        | Expr::If(_)
        | Expr::Match(_)
        | Expr::MethodCall(_)
        | Expr::Struct(_)
        | Expr::Tuple(_) => count == 1,
        Expr::Cast(cast) => can_be_last(&cast.expr, count),
        Expr::Reference(reference) => can_be_last(&reference.expr, count),
        Expr::Try(tried) => can_be_last(&tried.expr, count),
        Expr::Unary(unary) => can_be_last(&unary.expr, count),
        _ => false,
    }
}

/// Tests for a chain, whatever stands before it.
pub fn is_chain(item: &Expr) -> bool {
    match item {
        Expr::MethodCall(_) => true,
        Expr::Cast(cast) => is_chain(&cast.expr),
        Expr::Reference(reference) => is_chain(&reference.expr),
        Expr::Try(tried) => is_chain(&tried.expr),
        Expr::Unary(unary) => is_chain(&unary.expr),
        _ => false,
    }
}

fn is_simple(item: &Expr) -> bool {
    match item {
        Expr::Lit(_) => true,
        Expr::Path(path) => path.path.segments.len() <= 1,
        Expr::Reference(reference) => is_simple(&reference.expr),
        Expr::Unary(unary) => is_simple(&unary.expr),
        _ => false,
    }
}

/// Puts items on as few lines as they need.
fn filled(items: &[String], shape: Shape) -> String {
    let mut column = 0;
    let mut text = String::new();
    for item in items {
        if column > 0 && column + 2 + width(item) > shape.width() {
            text = text + "," + &line_break(shape.indent);
            column = 0;
        } else if column > 0 {
            text.push_str(", ");
            column += 2;
        }
        text.push_str(item);
        column += width(item);
    }
    text
}
