//! Code on one line.

use quote::ToTokens;
use syn::punctuated::Punctuated;
use syn::{Expr, ExprMethodCall, FieldValue, Member, Pat, Path, RangeLimits, Stmt};

/// Writes an expression on one line; `None` if it never stands on one.
pub fn flat(expr: &Expr) -> Option<String> {
    Some(match expr {
        Expr::Array(array) => format!("[{}]", all(&array.elems)?),
        Expr::Assign(assign) => format!("{} = {}", flat(&assign.left)?, flat(&assign.right)?),
        Expr::Binary(binary) => format!("{} {} {}", flat(&binary.left)?, tokens(&binary.op), flat(&binary.right)?),
        Expr::Call(call) => format!("{}({})", flat(&call.func)?, all(&call.args)?),
        Expr::Cast(cast) => format!("{} as {}", flat(&cast.expr)?, tokens(&cast.ty)),
        Expr::Closure(closure) => format!("|{}| {}", patterns(&closure.inputs), flat(&closure.body)?),
        Expr::Field(field) => format!("{}.{}", flat(&field.base)?, member(&field.member)),
        Expr::If(known) => {
            let (_, otherwise) = known.else_branch.as_ref()?;
            let [Stmt::Expr(then, None)] = known.then_branch.stmts.as_slice() else { return None };
            let Expr::Block(otherwise) = &**otherwise else { return None };
            let [Stmt::Expr(otherwise, None)] = otherwise.block.stmts.as_slice() else { return None };
            format!("if {} {{ {} }} else {{ {} }}", flat(&known.cond)?, flat(then)?, flat(otherwise)?)
        }
        Expr::Index(index) => format!("{}[{}]", flat(&index.expr)?, flat(&index.index)?),
        Expr::MethodCall(call) => format!("{}.{}({})", flat(&call.receiver)?, method(call), all(&call.args)?),
        Expr::Paren(paren) => format!("({})", flat(&paren.expr)?),
        Expr::Path(known) if known.qself.is_none() => path(&known.path),
        Expr::Range(range) => {
            let [start, end] =
                [&range.start, &range.end].map(|end| end.as_ref().map_or_else(|| Some(String::new()), |end| flat(end)));
            format!("{}{}{}", start?, limits(&range.limits), end?)
        }
        Expr::Reference(reference) => format!("{}{}", borrow(reference.mutability.is_some()), flat(&reference.expr)?),
        Expr::Repeat(repeat) => format!("[{}; {}]", flat(&repeat.expr)?, flat(&repeat.len)?),
        Expr::Return(known) => match &known.expr {
            None => "return".to_owned(),
            Some(value) => format!("return {}", flat(value)?),
        },
        Expr::Struct(known) => {
            let rest = known.rest.iter().map(|rest| Some(format!("..{}", flat(rest)?)));
            let fields: Option<Vec<_>> = known.fields.iter().map(field).chain(rest).collect();
            format!("{} {{ {} }}", path(&known.path), fields?.join(", "))
        }
        Expr::Try(tried) => format!("{}?", flat(&tried.expr)?),
        Expr::Tuple(tuple) => format!("({})", all(&tuple.elems)?),
        Expr::Unary(unary) => format!("{}{}", tokens(&unary.op), flat(&unary.expr)?),
        Expr::Match(known) if known.arms.is_empty() => format!("match {} {{}}", flat(&known.expr)?),
        Expr::Block(_) | Expr::Match(_) => return None,
        other => tokens(other),
    })
}

fn all<P>(items: &Punctuated<Expr, P>) -> Option<String> {
    Some(items.iter().map(flat).collect::<Option<Vec<_>>>()?.join(", "))
}

fn field(known: &FieldValue) -> Option<String> {
    let (name, value) = (member(&known.member), flat(&known.expr)?);
    Some(if known.colon_token.is_some() { format!("{name}: {value}") } else { name })
}

/// Writes the name of a method with its generic arguments.
pub fn method(call: &ExprMethodCall) -> String {
    let arguments = call.turbofish.as_ref().map(|known| tokens(known).replace(" ,", ","));
    format!("{}{}", call.method, arguments.unwrap_or_default())
}

/// Writes the name or the number of a field.
pub fn member(member: &Member) -> String {
    tokens(member)
}

/// Writes what stands before a value that is borrowed.
pub fn borrow(is_mutable: bool) -> &'static str {
    if is_mutable { "&mut " } else { "&" }
}

/// Writes patterns, separated by commas.
pub fn patterns<P>(patterns: &Punctuated<Pat, P>) -> String {
    patterns.iter().map(pattern).collect::<Vec<_>>().join(", ")
}

/// Writes a pattern on one line.
pub fn pattern(known: &Pat) -> String {
    match known {
        Pat::Or(or) => or.cases.iter().map(pattern).collect::<Vec<_>>().join(" | "),
        Pat::Range(range) => {
            let [start, end] = [&range.start, &range.end].map(|end| end.as_ref().map_or_else(String::new, tokens));
            format!("{start}{}{end}", limits(&range.limits))
        }
        Pat::Tuple(tuple) => format!("({})", patterns(&tuple.elems)),
        Pat::TupleStruct(known) => format!("{}({})", path(&known.path), patterns(&known.elems)),
        other => tokens(other),
    }
}

fn limits(limits: &RangeLimits) -> &'static str {
    match limits {
        RangeLimits::HalfOpen(_) => "..",
        RangeLimits::Closed(_) => "..=",
    }
}

/// Writes a path. Most have no arguments, so their names suffice.
fn path(known: &Path) -> String {
    if known.leading_colon.is_some() || known.segments.iter().any(|segment| !segment.arguments.is_none()) {
        return tokens(known);
    }
    known.segments.iter().map(|segment| segment.ident.to_string()).collect::<Vec<_>>().join("::")
}

/// Writes tokens without blanks round the separators of a path, and before and in brackets.
pub fn tokens(code: &impl ToTokens) -> String {
    let text = code.to_token_stream().to_string();
    if text.starts_with('"') || !text.contains(' ') {
        return text;
    }
    text.replace(" :: ", "::")
        .replace(":: ", "::")
        .replace("- ", "-")
        .replace(" <", "<")
        .replace("< ", "<")
        .replace(" >", ">")
}
