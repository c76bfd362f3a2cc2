//! Mistakes in statements and in what a function returns.

use syn::{Block, Expr, ReceiverKind, ReturnType, Signature, Stmt, Type, parse_quote};

use super::{Kind, Walk, text};

/// Returns what is left of a statement when it is left out.
pub fn left_out(statement: &Stmt) -> Option<Stmt> {
    match statement {
        Stmt::Expr(Expr::Assign(_) | Expr::MethodCall(_) | Expr::Call(_), Some(_)) => Some(parse_quote!({})),
        _ => None,
    }
}

impl Walk {
    /// A function returns nothing, the opposite, or what it was given.
    pub fn result(&mut self, signature: &Signature, body: &mut Block) {
        if let Some(result) = nothing(signature)
            && !is_only(body, &result)
        {
            self.offer(Kind::Result, body, parse_quote!({ #result }));
        } else if is_bool(signature)
            && let Some(Stmt::Expr(result, None)) = body.stmts.last_mut()
        {
            self.condition(result);
        }
    }
}

fn is_only(body: &Block, result: &Expr) -> bool {
    matches!(body.stmts.as_slice(), [Stmt::Expr(only, None)] if text(only) == text(result))
}

fn is_bool(signature: &Signature) -> bool {
    matches!(&signature.output, ReturnType::Type(_, output) if text(output) == "bool")
}

fn nothing(signature: &Signature) -> Option<Expr> {
    let ReturnType::Type(_, output) = &signature.output else { return None };
    let Type::Path(output) = &**output else { return None };
    let takes_self = signature.receiver().is_some_and(|receiver| matches!(receiver.kind, ReceiverKind::Value));
    match output.path.segments.last()?.ident.to_string().as_str() {
        "Option" => Some(parse_quote!(None)),
        "Vec" => Some(parse_quote!(Vec::new())),
        "String" => Some(parse_quote!(String::new())),
        "TokenStream" => Some(parse_quote!(TokenStream::new())),
        "Self" if takes_self => Some(parse_quote!(self)),
        _ => None,
    }
}
