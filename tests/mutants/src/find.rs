//! Changes that are possible in a file.

use crate::active::compiled;
use proc_macro2::Span;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{BinOp, Expr, Lit, ReturnType, Type, UnOp};

/// A change of a piece of a file: what is inserted before and behind the piece, which is switched by it.
#[derive(Clone, Debug)]
pub struct Mutant {
    /// From the repository's root.
    pub file: String,
    /// With the type that it belongs to.
    pub function: String,
    pub line: usize,
    /// Of the piece, from 1.
    pub column: usize,
    pub kind: &'static str,
    /// The whole line.
    pub code: String,
    pub before: String,
    pub after: String,
    /// Bytes of the piece.
    pub start: usize,
    pub end: usize,
    pub form: Form,
}

/// How a switch is written.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Form {
    /// The piece or `after`.
    Expression,
    /// The piece or nothing.
    Statement,
    /// `after` or nothing, where the piece is empty.
    Insertion,
}

impl Mutant {
    /// What is inserted before and behind the piece, for the switch `id`.
    pub fn switch(&self, id: usize) -> (String, &'static str) {
        match self.form {
            Form::Expression => (format!("(if crate::mutant::on({id}) {{ {} }} else {{ ", self.after), " })"),
            Form::Statement => (format!("if !crate::mutant::on({id}) {{ "), " }"),
            Form::Insertion => (format!(" if crate::mutant::on({id}) {{ {} }} ", self.after), ""),
        }
    }

    /// The change in words.
    pub fn change(&self) -> String {
        match self.form {
            Form::Expression => format!("{} → {}", self.before, self.after),
            Form::Statement => format!("{} → (nothing)", self.before),
            Form::Insertion => format!("begins with {}", self.after),
        }
    }
}

/// Every change of a file, in order, and the modules that are declared there but not compiled (or tests).
pub fn mutants(file: &str, text: &str) -> Result<(Vec<Mutant>, Vec<String>), String> {
    let tree = syn::parse_file(text).map_err(|error| format!("{file}: {error}"))?;
    let mut finder = Finder { file, text, place: Vec::new(), found: Vec::new(), idle: Vec::new() };
    if compiled(&tree.attrs) {
        finder.visit_file(&tree);
    }
    finder.found.sort_by_key(|m| (m.start, std::cmp::Reverse(m.end)));
    Ok((finder.found, finder.idle))
}

/// The text of a file without the modules and functions that are not compiled, or are tests.
pub fn without_tests(text: &str) -> Result<String, String> {
    let tree = syn::parse_file(text).map_err(|error| error.to_string())?;
    let (mut out, mut at) = (String::new(), 0);
    for item in &tree.items {
        let attributes = match item {
            syn::Item::Fn(x) => &x.attrs,
            syn::Item::Mod(x) => &x.attrs,
            _ => continue,
        };
        if !compiled(attributes) {
            let range = item.span().byte_range();
            out.push_str(text.get(at..range.start).unwrap_or_default().trim_end());
            at = range.end;
        }
    }
    out.push_str(text.get(at..).unwrap_or_default().trim_end());
    Ok(out)
}

struct Finder<'a> {
    file: &'a str,
    text: &'a str,
    /// Types and functions around.
    place: Vec<String>,
    found: Vec<Mutant>,
    idle: Vec<String>,
}

/// A piece of source on one line, without its comments.
fn plain(text: &str) -> String {
    let words = text.lines().filter_map(|line| line.split("//").next()).flat_map(str::split_whitespace);
    words.collect::<Vec<_>>().join(" ")
}

impl Finder<'_> {
    fn source(&self, span: Span) -> &str {
        self.text.get(span.byte_range()).unwrap_or_default()
    }

    fn add(&mut self, span: Span, kind: &'static str, form: Form, after: String) {
        let (range, start) = (span.byte_range(), span.start());
        let line = start.line;
        self.found.push(Mutant {
            file: self.file.into(),
            function: self.place.join("::"),
            line,
            column: start.column + 1,
            kind,
            code: plain(self.text.lines().nth(line - 1).unwrap_or_default()),
            before: if form == Form::Insertion { String::new() } else { plain(self.source(span)) },
            after,
            start: range.start,
            end: if form == Form::Insertion { range.start } else { range.end },
            form,
        });
    }

    fn within(&mut self, name: String, visit: impl FnOnce(&mut Self)) {
        self.place.push(name);
        visit(self);
        self.place.pop();
    }

    /// A function that returns at once, and what is inside.
    fn function(&mut self, signature: &syn::Signature, block: &syn::Block) {
        if signature.constness.is_some() {
            return;
        }
        self.within(signature.ident.to_string(), |finder| {
            let value = match &signature.output {
                ReturnType::Default => Some("return;"),
                ReturnType::Type(_, kind) => early(kind),
            };
            if let Some(value) = value.filter(|_| !block.stmts.is_empty()) {
                let span = block.stmts[0].span();
                finder.add(span, "early return", Form::Insertion, value.into());
            }
            visit::visit_block(finder, block);
        });
    }
}

/// The return of a default, for the types that have one.
fn early(kind: &Type) -> Option<&'static str> {
    let Type::Path(path) = kind else { return None };
    let last = path.path.segments.last()?;
    match last.ident.to_string().as_str() {
        "R" => Some("return R::zero();"),
        "f64" | "f32" => Some("return 0.0;"),
        "bool" => Some("return false;"),
        "Result" => match &last.arguments {
            syn::PathArguments::AngleBracketed(arguments) => match arguments.args.first()? {
                syn::GenericArgument::Type(Type::Tuple(unit)) if unit.elems.is_empty() => Some("return Ok(());"),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    }
}

/// Another operator, and the kind of the change.
fn other(operator: &BinOp) -> Option<(&'static str, &'static str)> {
    Some(match operator {
        BinOp::Add(_) => ("-", "arithmetic"),
        BinOp::Sub(_) => ("+", "arithmetic"),
        BinOp::Mul(_) => ("/", "arithmetic"),
        BinOp::Div(_) => ("*", "arithmetic"),
        BinOp::AddAssign(_) => ("-=", "arithmetic"),
        BinOp::SubAssign(_) => ("+=", "arithmetic"),
        BinOp::MulAssign(_) => ("/=", "arithmetic"),
        BinOp::DivAssign(_) => ("*=", "arithmetic"),
        BinOp::Lt(_) => ("<=", "comparison"),
        BinOp::Le(_) => ("<", "comparison"),
        BinOp::Gt(_) => (">=", "comparison"),
        BinOp::Ge(_) => (">", "comparison"),
        BinOp::Eq(_) => ("!=", "comparison"),
        BinOp::Ne(_) => ("==", "comparison"),
        BinOp::And(_) => ("||", "logic"),
        BinOp::Or(_) => ("&&", "logic"),
        _ => return None,
    })
}

/// Another number.
fn another(lit: &Lit) -> Option<String> {
    match lit {
        Lit::Float(x) => {
            let value: f64 = x.base10_parse().ok()?;
            let one = [0.0, 0.5, 2.0].contains(&value);
            Some(if one { format!("1.0{}", x.suffix()) } else { format!("(2.0{} * {x})", x.suffix()) })
        }
        Lit::Int(x) => Some(format!("{}{}", x.base10_parse::<u64>().ok()?.checked_add(1)?, x.suffix())),
        _ => None,
    }
}

/// Another constant of the scalar type.
fn constant(text: &str) -> Option<&'static str> {
    Some(match text {
        "R::one()" => "R::TWO",
        "R::zero()" | "R::HALF" | "R::TWO" => "R::one()",
        "R::PI" => "R::TAU",
        "R::TAU" => "R::PI",
        _ => return None,
    })
}

fn has_let(expression: &Expr) -> bool {
    match expression {
        Expr::Let(_) => true,
        Expr::Binary(binary) => has_let(&binary.left) || has_let(&binary.right),
        _ => false,
    }
}

/// Whether a call is written for what it does, which `drop` and constructors are not.
fn acts(expression: &Expr) -> bool {
    match expression {
        Expr::MethodCall(_) => true,
        Expr::Call(call) => match &*call.func {
            Expr::Path(path) => path.path.segments.last().is_some_and(|last| {
                last.ident != "drop" && last.ident.to_string().starts_with(|first: char| first.is_lowercase())
            }),
            _ => false,
        },
        Expr::Try(inner) => acts(&inner.expr),
        _ => false,
    }
}

impl<'ast> Visit<'ast> for Finder<'_> {
    fn visit_item(&mut self, item: &'ast syn::Item) {
        let attributes = match item {
            syn::Item::Fn(x) => &x.attrs,
            syn::Item::Impl(x) => &x.attrs,
            syn::Item::Mod(x) => &x.attrs,
            syn::Item::Trait(x) => &x.attrs,
            // Nothing in them is switched at run time.
            _ => return,
        };
        if compiled(attributes) {
            visit::visit_item(self, item);
        } else if let syn::Item::Mod(module) = item
            && module.content.is_none()
        {
            self.idle.push(module.ident.to_string());
        }
    }

    fn visit_item_impl(&mut self, item: &'ast syn::ItemImpl) {
        let shown = |path: &syn::Path| path.segments.last().is_some_and(|s| s.ident == "Debug" || s.ident == "Display");
        if item.trait_.as_ref().is_some_and(|(_, path, _)| shown(path)) {
            return;
        }
        let name = match &*item.self_ty {
            Type::Path(path) => path.path.segments.last().map(|s| s.ident.to_string()).unwrap_or_default(),
            other => plain(self.source(other.span())),
        };
        self.within(name, |finder| item.items.iter().for_each(|item| finder.visit_impl_item(item)));
    }

    fn visit_item_trait(&mut self, item: &'ast syn::ItemTrait) {
        self.within(item.ident.to_string(), |finder| item.items.iter().for_each(|item| finder.visit_trait_item(item)));
    }

    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        self.function(&item.sig, &item.block);
    }

    fn visit_impl_item(&mut self, item: &'ast syn::ImplItem) {
        if let syn::ImplItem::Fn(item) = item
            && compiled(&item.attrs)
        {
            self.function(&item.sig, &item.block);
        }
    }

    fn visit_trait_item(&mut self, item: &'ast syn::TraitItem) {
        if let syn::TraitItem::Fn(item) = item
            && let Some(block) = &item.default
            && compiled(&item.attrs)
        {
            self.function(&item.sig, block);
        }
    }

    fn visit_stmt(&mut self, statement: &'ast syn::Stmt) {
        let attributes: &[syn::Attribute] = match statement {
            syn::Stmt::Local(local) => &local.attrs,
            syn::Stmt::Macro(_) => return,
            _ => &[],
        };
        if !compiled(attributes) {
            return;
        }
        if let syn::Stmt::Expr(expression, Some(_)) = statement
            && acts(expression)
        {
            self.add(statement.span(), "statement", Form::Statement, String::new());
        }
        visit::visit_stmt(self, statement);
    }

    fn visit_expr(&mut self, expression: &'ast Expr) {
        match expression {
            Expr::Binary(x) => {
                if let Some((operator, kind)) = other(&x.op)
                    && !has_let(expression)
                {
                    let (left, right) = (self.source(x.left.span()), self.source(x.right.span()));
                    let after = plain(&format!("{left} {operator} {right}"));
                    self.add(expression.span(), kind, Form::Expression, after);
                }
            }
            Expr::Unary(x) if matches!(x.op, UnOp::Neg(_) | UnOp::Not(_)) => {
                let kind = if matches!(x.op, UnOp::Neg(_)) { "sign" } else { "logic" };
                let after = plain(self.source(x.expr.span()));
                self.add(expression.span(), kind, Form::Expression, after);
            }
            Expr::Lit(x) => {
                if let Some(after) = another(&x.lit) {
                    self.add(expression.span(), "number", Form::Expression, after);
                }
            }
            Expr::Path(_) | Expr::Call(_) => {
                if let Some(after) = constant(&plain(self.source(expression.span()))) {
                    self.add(expression.span(), "number", Form::Expression, after.into());
                }
            }
            // The length of an array is no value of a run.
            Expr::Repeat(x) => return self.visit_expr(&x.expr),
            Expr::Const(_) | Expr::Macro(_) => return,
            _ => {}
        }
        visit::visit_expr(self, expression);
    }

    fn visit_pat(&mut self, _: &'ast syn::Pat) {}
    fn visit_type(&mut self, _: &'ast Type) {}
    fn visit_path_arguments(&mut self, _: &'ast syn::PathArguments) {}
    fn visit_angle_bracketed_generic_arguments(&mut self, _: &'ast syn::AngleBracketedGenericArguments) {}
    fn visit_generics(&mut self, _: &'ast syn::Generics) {}
    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}
}

#[cfg(test)]
mod test {
    use super::without_tests;

    #[test]
    fn text_without_tests_does_not_change_with_them() {
        let code = "fn f() -> usize {\n    1\n}\n";
        let tested = format!("{code}\n/// Claims.\n#[cfg(test)]\nmod tests {{\n    #[test]\n    fn one() {{}}\n}}\n");
        assert_eq!(without_tests(code).unwrap(), code.trim_end());
        assert_eq!(without_tests(&tested).unwrap(), code.trim_end());
    }
}
