//! Blocks, closures, conditions and choices.

use syn::{Arm, Block, Expr, ExprClosure, ExprIf, ExprMatch, Item, ItemConst, Pat, Stmt, parse_quote};

use super::assignment::{assigned, is_better_below};
use super::flat::{flat, pattern, patterns, tokens};
use super::shape::{STEP, Shape, is_broken, line_break, width};

/// Patterns that are no wider than this share lines.
const SHORT: usize = 20;

/// Lays out statements, each on its line.
pub fn statements(statements: &[Stmt], shape: Shape) -> String {
    let indent = " ".repeat(shape.indent);
    let lines = statements.iter().map(|known| format!("{indent}{}", statement(known, shape)));
    lines.collect::<Vec<_>>().join("\n")
}

fn statement(known: &Stmt, shape: Shape) -> String {
    let text = match known {
        Stmt::Local(local) => local.init.as_ref().and_then(|init| {
            let before = format!("{}let {} =", " ".repeat(shape.indent), pattern(&local.pat));
            Some(format!("{};", assigned(&before, &init.expr, shape.line(), 1)?.trim_start()))
        }),
        Stmt::Expr(expr, end) => {
            let end = if end.is_some() { ";" } else { "" };
            shape.keeping(end.len()).rewrite(expr).or_else(|| flat(expr)).map(|text| text + end)
        }
        Stmt::Item(Item::Const(item)) => {
            let before = format!("{}{}", " ".repeat(shape.indent), before_value(item));
            assigned(&before, &item.expr, shape.line(), 1).map(|text| format!("{};", text.trim_start()))
        }
        Stmt::Item(_) | Stmt::Macro(_) => None,
    };
    text.unwrap_or_else(|| tokens(known))
}

/// Returns what stands before the value of a constant.
fn before_value(ItemConst { ident, ty, .. }: &ItemConst) -> String {
    let text = prettyplease::unparse(&parse_quote!(const #ident: #ty = ();));
    text.trim_end().trim_end_matches(" ();").to_owned()
}

/// Lays out a block.
pub fn block(block: &Block, shape: Shape) -> String {
    format!("{{\n{}{}}}", statements(&block.stmts, shape.nested()), line_break(shape.indent))
}

/// Lays out a closure: with its body on the same line, or in a block.
pub fn closure(closure: &ExprClosure, shape: Shape) -> Option<String> {
    let head = format!("|{}| ", patterns(&closure.inputs));
    let body = shape.behind(width(&head)).rewrite(&closure.body);
    let body = body.filter(|body| !is_broken(body) || stays_open(&closure.body));
    let in_block = || in_block(&closure.body, shape);
    Some(head + &body.or_else(in_block)?)
}

/// Tests whether a broken body of a closure needs no block.
fn stays_open(body: &Expr) -> bool {
    match body {
        Expr::Block(_) | Expr::Match(_) | Expr::Struct(_) => true,
        Expr::Reference(reference) => stays_open(&reference.expr),
        Expr::Try(tried) => stays_open(&tried.expr),
        Expr::Unary(unary) => stays_open(&unary.expr),
        _ => false,
    }
}

fn in_block(body: &Expr, shape: Shape) -> Option<String> {
    let body = shape.nested().rewrite(body)?;
    Some(format!("{{{}{body}{}}}", line_break(shape.indent + STEP), line_break(shape.indent)))
}

/// Lays out a condition with its blocks.
pub fn condition(known: &ExprIf, shape: Shape) -> Option<String> {
    let test = Shape { after: 2, ..shape.behind(3) }.rewrite(&known.cond)?;
    let start = if is_broken(&test) { line_break(shape.indent) } else { " ".to_owned() };
    let then = block(&known.then_branch, shape);
    let otherwise = match &known.else_branch {
        None => String::new(),
        Some((_, otherwise)) => format!(" else {}", shape.rewrite(otherwise)?),
    };
    Some(format!("if {test}{start}{then}{otherwise}"))
}

/// Lays out a choice, each arm on lines of its own.
pub fn choice(known: &ExprMatch, shape: Shape) -> Option<String> {
    let nested = shape.nested();
    let arms: Option<Vec<_>> = known.arms.iter().map(|known| arm(known, nested)).collect();
    let start = line_break(nested.indent);
    let arms = arms?.join(&start);
    let room = Shape { after: 0, ..shape.behind(6) };
    let subject = room.rewrite(&known.expr)?;
    let is_full = !is_broken(&subject) && width(&subject) + 2 > room.width();
    let (end, open) = (line_break(shape.indent), if is_full { line_break(shape.indent) } else { " ".to_owned() });
    Some(format!("match {subject}{open}{{{start}{arms}{end}}}"))
}

fn arm(known: &Arm, shape: Shape) -> Option<String> {
    let pattern = cases(&known.pat, shape.keeping(5));
    if let Expr::Block(body) = &*known.body {
        return Some(format!("{pattern} => {}", block(&body.block, shape)));
    }
    let last = pattern
        .lines()
        .next_back()
        .map_or(0, |line| if is_broken(&pattern) { width(line.trim_start()) } else { width(line) });
    let same = shape.behind(last + 4).keeping(1).rewrite(&known.body);
    if let Some(same) = same.as_ref().filter(|same| !is_broken(same)) {
        return Some(format!("{pattern} => {same},"));
    }
    let below = shape.nested().rewrite(&known.body);
    match (same, below) {
        (Some(same), Some(below)) if can_open(&known.body) && !is_better_below(&same, &below) => {
            Some(format!("{pattern} => {same},"))
        }
        (_, Some(below)) => {
            Some(format!("{pattern} => {{{}{below}{}}}", line_break(shape.indent + STEP), line_break(shape.indent)))
        }
        (same, None) => Some(format!("{pattern} => {},", same?)),
    }
}

/// Tests whether the body of an arm can begin on the line of its pattern although it is broken.
fn can_open(body: &Expr) -> bool {
    match body {
        Expr::Array(_)
        | Expr::Call(_)
        | Expr::Closure(_)
        | Expr::Match(_)
        | Expr::MethodCall(_)
        | Expr::Struct(_)
        | Expr::Tuple(_) => true,
        Expr::Cast(cast) => can_open(&cast.expr),
        Expr::Reference(reference) => can_open(&reference.expr),
        Expr::Try(tried) => can_open(&tried.expr),
        Expr::Unary(unary) => can_open(&unary.expr),
        _ => false,
    }
}

/// Lays out the pattern of an arm: several short ones on as few lines as they need, others on one line or on one each.
fn cases(known: &Pat, shape: Shape) -> String {
    let whole = pattern(known);
    let Pat::Or(or) = known else { return whole };
    if width(&whole) <= shape.width() {
        return whole;
    }
    let cases: Vec<_> = or.cases.iter().map(pattern).collect();
    let are_short = or.cases.iter().zip(&cases).all(|(case, text)| is_short(case) && width(text) <= SHORT);
    let start = line_break(shape.indent);
    let mut text = String::new();
    let mut column = 0;
    for case in cases {
        let fits = are_short && column + 3 + width(&case) <= shape.width();
        match (column, fits) {
            (0, _) => column = width(&case),
            (_, true) => {
                text.push_str(" | ");
                column += 3 + width(&case);
            }
            (_, false) => {
                text = text + &start + "| ";
                column = 2 + width(&case);
            }
        }
        text.push_str(&case);
    }
    text
}

fn is_short(case: &Pat) -> bool {
    match case {
        Pat::Lit(_) | Pat::Wild(_) | Pat::Ident(_) => true,
        Pat::Tuple(tuple) => tuple.elems.len() <= 1,
        Pat::TupleStruct(known) => known.path.segments.len() <= 1 && known.elems.len() <= 1,
        _ => false,
    }
}
