//! Expressions: on one line if they fit, else each kind is broken in its way.

use syn::{Expr, ExprBinary, ExprStruct, FieldValue};

use super::flat::{borrow, flat, member, tokens};
use super::shape::{STEP, Shape, breaks, first_line, is_broken, line_break, width};
use super::{brackets, chain, control};

/// Lays out an expression; `None` if it does not fit.
pub fn rewrite(expr: &Expr, shape: Shape) -> Option<String> {
    flat(expr).filter(|text| width(text) + chain::tries(expr) <= shape.width()).or_else(|| broken(expr, shape))
}

fn broken(expr: &Expr, shape: Shape) -> Option<String> {
    match expr {
        Expr::Array(array) => brackets::broken("", ['[', ']'], &array.elems, shape),
        Expr::Binary(binary) => operation(binary, shape),
        Expr::Block(block) => Some(control::block(&block.block, shape)),
        Expr::Call(call) => brackets::broken(&flat(&call.func)?, ['(', ')'], &call.args, shape),
        Expr::Closure(closure) => control::closure(closure, shape),
        Expr::Field(_) | Expr::MethodCall(_) | Expr::Try(_) => chain::broken(expr, shape),
        Expr::If(known) => control::condition(known, shape),
        Expr::Match(known) => control::choice(known, shape),
        Expr::Paren(paren) => Some(format!("({})", rewrite(&paren.expr, shape.behind(1).keeping(1))?)),
        Expr::Reference(known) => prefixed(borrow(known.mutability.is_some()), &known.expr, shape),
        Expr::Return(known) => prefixed("return ", known.expr.as_ref()?, shape),
        Expr::Struct(known) => structure(known, shape),
        Expr::Tuple(tuple) => brackets::broken("", ['(', ')'], &tuple.elems, shape),
        Expr::Unary(unary) => prefixed(&tokens(&unary.op), &unary.expr, shape),
        _ => None,
    }
}

fn prefixed(prefix: &str, expr: &Expr, shape: Shape) -> Option<String> {
    Some(format!("{prefix}{}", rewrite(expr, shape.behind(width(prefix)))?))
}

/// Lays out operands of the same operator, each on its line.
fn operation(binary: &ExprBinary, shape: Shape) -> Option<String> {
    let operator = tokens(&binary.op);
    let mut operands = vec![&*binary.right];
    let mut left = &*binary.left;
    while let Expr::Binary(inner) = left
        && tokens(&inner.op) == operator
    {
        operands.push(&inner.right);
        left = &inner.left;
    }
    let next = shape.nested();
    let mut text = rewrite(left, shape)?;
    for operand in operands.into_iter().rev() {
        let operand = rewrite(operand, next.behind(width(&operator) + 1).keeping(shape.after))?;
        let is_orphan = !is_broken(&text) && shape.column + width(&text) <= next.indent;
        let start = if is_orphan { " ".to_owned() } else { line_break(next.indent) };
        text = format!("{text}{start}{operator} {operand}");
    }
    Some(text)
}

/// Lays out the fields of a struct, each on its line.
fn structure(known: &ExprStruct, shape: Shape) -> Option<String> {
    let nested = shape.nested();
    let fields: Option<Vec<_>> = known.fields.iter().map(|known| field(known, nested.indent)).collect();
    let start = line_break(nested.indent);
    let fields = fields?.join(&format!(",{start}"));
    Some(format!("{} {{{start}{fields},{}}}", tokens(&known.path), line_break(shape.indent)))
}

fn field(known: &FieldValue, indent: usize) -> Option<String> {
    let name = member(&known.member);
    if known.colon_token.is_none() {
        return Some(name);
    }
    let line = Shape::line(indent).keeping(1);
    match rewrite(&known.expr, line.behind(width(&name) + 2)) {
        Some(value) => Some(format!("{name}: {value}")),
        None => {
            Some(format!("{name}:{}{}", line_break(indent + STEP), rewrite(&known.expr, line.nested().keeping(1))?))
        }
    }
}

/// Lays out a value behind what stands before it, on the same line or on the next one; `after` columns follow.
pub fn assigned(before: &str, value: &Expr, indent: usize, after: usize) -> Option<String> {
    let shape = Shape { column: width(before) + 1, ..Shape::line(indent) }.keeping(after);
    let same = rewrite(value, shape);
    if let Some(same) = same.as_ref().filter(|same| !is_broken(same)) {
        return Some(format!("{before} {same}"));
    }
    let below = Shape::line(indent + STEP).keeping(after);
    let next = rewrite(value, below);
    let fits = |next: &str| width(first_line(next)) <= below.width();
    match (same, next) {
        (Some(same), Some(next)) if !fits(&next) || !is_better_below(&same, &next) => Some(format!("{before} {same}")),
        (_, Some(next)) => Some(format!("{before}{}{next}", line_break(indent + STEP))),
        (Some(same), None) => Some(format!("{before} {same}")),
        (None, None) => Some(format!("{before} {}", flat(value)?)),
    }
}

/// Tests whether a broken text is better begun on a line of its own.
pub fn is_better_below(same: &str, below: &str) -> bool {
    let opens = |text: &str, bracket| first_line(text).ends_with(bracket);
    !is_broken(below)
        || breaks(same) > breaks(below) + 1
        || ['(', '{', '['].into_iter().any(|bracket| opens(same, bracket) && !opens(below, bracket))
}
