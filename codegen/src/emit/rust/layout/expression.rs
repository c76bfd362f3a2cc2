//! Expressions: on one line if they fit, else each kind is broken in its way.

use syn::{Expr, ExprBinary, ExprStruct, FieldValue};

use super::flat::{borrow, flat, member, tokens};
use super::shape::{Shape, is_broken, line_break, width};
use super::{brackets, chain, control};

/// Lays out an expression; `None` if it does not fit.
pub fn rewrite(expr: &Expr, shape: Shape) -> Option<String> {
    flat(expr).filter(|text| width(text) + chain::kept(expr) <= shape.width()).or_else(|| broken(expr, shape))
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
        Expr::Paren(paren) => Some(format!("({})", shape.behind(1).keeping(1).rewrite(&paren.expr)?)),
        Expr::Reference(known) => prefixed(borrow(known.mutability.is_some()), &known.expr, shape),
        Expr::Return(known) => prefixed("return ", known.expr.as_ref()?, shape),
        Expr::Struct(known) => structure(known, shape),
        Expr::Tuple(tuple) => brackets::broken("", ['(', ')'], &tuple.elems, shape),
        Expr::Unary(unary) => prefixed(&tokens(&unary.op), &unary.expr, shape),
        _ => None,
    }
}

fn prefixed(prefix: &str, expr: &Expr, shape: Shape) -> Option<String> {
    Some(format!("{prefix}{}", shape.behind(width(prefix)).rewrite(expr)?))
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
    let mut text = shape.rewrite(left)?;
    for operand in operands.into_iter().rev() {
        let operand = next.behind(width(&operator) + 1).keeping(shape.after).rewrite(operand)?;
        let is_orphan = !is_broken(&text) && shape.column + width(&text) <= next.indent;
        let start = if is_orphan { " ".to_owned() } else { line_break(next.indent) };
        text = format!("{text}{start}{operator} {operand}");
    }
    Some(text)
}

/// Lays out the fields of a struct, each on its line.
fn structure(known: &ExprStruct, shape: Shape) -> Option<String> {
    let nested = shape.nested();
    let fields = known.fields.iter().map(|known| Some(field(known, nested)? + ","));
    let rest = known.rest.iter().map(|rest| Some(format!("..{}", nested.line().behind(2).rewrite(rest)?)));
    let lines: Option<Vec<_>> = fields.chain(rest).collect();
    let start = line_break(nested.indent);
    let lines = lines?.join(&start);
    Some(format!("{} {{{start}{lines}{}}}", tokens(&known.path), line_break(shape.indent)))
}

fn field(known: &FieldValue, shape: Shape) -> Option<String> {
    let name = member(&known.member);
    if known.colon_token.is_none() {
        return Some(name);
    }
    let line = shape.line().keeping(1);
    if let Some(value) = line.behind(width(&name) + 2).rewrite(&known.expr) {
        return Some(format!("{name}: {value}"));
    }
    let below = line.nested().keeping(1);
    Some(format!("{name}:{}{}", line_break(below.indent), below.rewrite(&known.expr)?))
}
