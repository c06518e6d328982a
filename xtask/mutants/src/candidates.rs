//! Places of a source file where a fault can be put: another operator, sign, index or function, a term or a statement
//! less, exchanged arguments, a condition that never holds.

use std::ops::Range;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{BinOp, Expr, Lit, Stmt, UnOp};

/// A piece of a file, and what replaces it.
pub struct Fault {
    pub file: String,
    pub at: Range<usize>,
    pub kind: &'static str,
    /// None where a statement is left out.
    pub instead: Option<String>,
}

/// All faults that are known for a file. Tests, constants, patterns and the writing of texts have none.
pub fn candidates(file: &str, text: &str) -> Result<Vec<Fault>, syn::Error> {
    let mut finder = Finder { file, text, faults: Vec::new() };
    finder.visit_file(&syn::parse_file(text)?);
    Ok(finder.faults)
}

struct Finder<'a> {
    file: &'a str,
    text: &'a str,
    faults: Vec<Fault>,
}

impl Finder<'_> {
    fn text(&self, item: &impl Spanned) -> String {
        self.text[item.span().byte_range()].to_string()
    }

    fn add(&mut self, item: &impl Spanned, kind: &'static str, instead: impl Into<Option<String>>) {
        let (file, at) = (self.file.to_string(), item.span().byte_range());
        self.faults.push(Fault { file, at, kind, instead: instead.into() });
    }
}

/// `#[test]` or `#[cfg(test)]`.
fn is_test(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        syn::Meta::Path(path) => path.is_ident("test"),
        syn::Meta::List(list) => list.path.is_ident("cfg") && list.tokens.to_string() == "test",
        syn::Meta::NameValue(_) => false,
    })
}

/// Operators that are taken for another.
fn others(op: &BinOp) -> &'static [&'static str] {
    match op {
        BinOp::Add(_) => &["-"],
        BinOp::Sub(_) => &["+"],
        BinOp::Mul(_) => &["/"],
        BinOp::Div(_) => &["*"],
        BinOp::Rem(_) => &["/"],
        BinOp::Lt(_) => &["<=", ">"],
        BinOp::Le(_) => &["<", ">"],
        BinOp::Gt(_) => &[">=", "<"],
        BinOp::Ge(_) => &[">", "<"],
        BinOp::Eq(_) => &["!="],
        BinOp::Ne(_) => &["=="],
        BinOp::And(_) => &["||"],
        BinOp::Or(_) => &["&&"],
        BinOp::Shl(_) => &[">>"],
        BinOp::Shr(_) => &["<<"],
        BinOp::BitAnd(_) => &["|"],
        BinOp::BitOr(_) => &["&"],
        BinOp::AddAssign(_) => &["-="],
        BinOp::SubAssign(_) => &["+="],
        BinOp::MulAssign(_) => &["/="],
        BinOp::DivAssign(_) => &["*="],
        _ => &[],
    }
}

impl<'ast> Visit<'ast> for Finder<'_> {
    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        if !is_test(&item.attrs) {
            visit::visit_item_mod(self, item);
        }
    }

    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        if item.sig.constness.is_none() && !is_test(&item.attrs) {
            visit::visit_item_fn(self, item);
        }
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        if item.sig.constness.is_none() && item.sig.ident != "fmt" && !is_test(&item.attrs) {
            visit::visit_impl_item_fn(self, item);
        }
    }

    /// Kernels stand in `pass! { … }`, which leaves them as they are.
    fn visit_item_macro(&mut self, item: &'ast syn::ItemMacro) {
        if let (true, Ok(inside)) = (item.mac.path.is_ident("pass"), item.mac.parse_body::<syn::File>()) {
            Visit::visit_file(self, &inside);
        }
    }

    fn visit_item_const(&mut self, _: &'ast syn::ItemConst) {}
    fn visit_item_static(&mut self, _: &'ast syn::ItemStatic) {}
    fn visit_impl_item_const(&mut self, _: &'ast syn::ImplItemConst) {}
    fn visit_trait_item_const(&mut self, _: &'ast syn::TraitItemConst) {}
    fn visit_expr_const(&mut self, _: &'ast syn::ExprConst) {}
    fn visit_pat(&mut self, _: &'ast syn::Pat) {}
    fn visit_type(&mut self, _: &'ast syn::Type) {}
    fn visit_generic_argument(&mut self, _: &'ast syn::GenericArgument) {}
    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}

    fn visit_expr_repeat(&mut self, repeat: &'ast syn::ExprRepeat) {
        self.visit_expr(&repeat.expr);
    }

    fn visit_stmt(&mut self, statement: &'ast Stmt) {
        if let Stmt::Expr(expression, Some(_)) = statement {
            let is_compound = |op: &BinOp| others(op).iter().any(|other| other.len() == 2 && other.ends_with('='));
            match expression {
                Expr::Assign(_) | Expr::Call(_) | Expr::MethodCall(_) => self.add(expression, "no statement", None),
                Expr::Binary(binary) if is_compound(&binary.op) => self.add(expression, "no statement", None),
                _ => {}
            }
        }
        visit::visit_stmt(self, statement);
    }

    fn visit_expr_if(&mut self, expression: &'ast syn::ExprIf) {
        let condition = self.text(&expression.cond);
        if !condition.contains("let ") {
            self.add(&expression.cond, "never", "false".to_string());
            self.add(&expression.cond, "opposite", format!("!({condition})"));
        }
        visit::visit_expr_if(self, expression);
    }

    fn visit_expr_binary(&mut self, binary: &'ast syn::ExprBinary) {
        let (left, right) = (self.text(&binary.left), self.text(&binary.right));
        if !left.contains("let ") && !right.contains("let ") {
            for other in others(&binary.op) {
                self.add(binary, "operator", format!("{left} {other} {right}"));
            }
            match binary.op {
                BinOp::Add(_) | BinOp::Mul(_) => self.add(binary, "right alone", right),
                BinOp::Sub(_) => self.add(binary, "right alone", format!("-({right})")),
                _ => {}
            }
            if matches!(binary.op, BinOp::Add(_) | BinOp::Sub(_) | BinOp::Mul(_)) {
                self.add(binary, "left alone", left);
            }
        }
        visit::visit_expr_binary(self, binary);
    }

    fn visit_expr_unary(&mut self, unary: &'ast syn::ExprUnary) {
        if matches!(unary.op, UnOp::Neg(_) | UnOp::Not(_)) {
            self.add(unary, "no sign", self.text(&unary.expr));
        }
        visit::visit_expr_unary(self, unary);
    }

    fn visit_expr_lit(&mut self, literal: &'ast syn::ExprLit) {
        match &literal.lit {
            Lit::Float(number) => {
                let value =
                    number.base10_parse::<f64>().map_or(1.0, |value| if value == 0.0 { 1.0 } else { 2.0 * value });
                self.add(literal, "number", format!("{value:?}{}", number.suffix()));
            }
            Lit::Bool(value) => self.add(literal, "number", (!value.value).to_string()),
            _ => {}
        }
    }

    fn visit_expr_index(&mut self, expression: &'ast syn::ExprIndex) {
        let index = &*expression.index;
        match index {
            Expr::Lit(syn::ExprLit { lit: Lit::Int(number), .. }) => {
                let other = number.base10_parse::<usize>().map_or(0, |k| if k == 0 { 1 } else { k - 1 });
                self.add(index, "index", other.to_string());
            }
            Expr::Path(_) => self.add(index, "index", format!("{}.max(1) - 1", self.text(index))),
            _ => {}
        }
        visit::visit_expr_index(self, expression);
    }

    fn visit_expr_call(&mut self, call: &'ast syn::ExprCall) {
        let arguments: Vec<String> = call.args.iter().map(|argument| self.text(argument)).collect();
        match &arguments[..] {
            [a, b] if a != b => self.add(call, "exchanged", format!("{}({b}, {a})", self.text(&call.func))),
            _ => {}
        }
        visit::visit_expr_call(self, call);
    }

    fn visit_expr_method_call(&mut self, call: &'ast syn::ExprMethodCall) {
        let (on, name) = (self.text(&call.receiver), call.method.to_string());
        let arguments: Vec<String> = call.args.iter().map(|argument| self.text(argument)).collect();
        let other = match name.as_str() {
            "sin" => "cos",
            "cos" => "sin",
            "min" => "max",
            "max" => "min",
            "any" => "all",
            "all" => "any",
            _ => "",
        };
        if !other.is_empty() {
            self.add(call, "function", format!("{on}.{other}({})", arguments.join(", ")));
        }
        match (name.as_str(), &arguments[..]) {
            ("transpose" | "transposed" | "inverse" | "abs" | "sqrt" | "recip" | "rev", []) => {
                self.add(call, "no function", on);
            }
            ("cross" | "dot" | "copysign" | "atan2", [a]) => {
                self.add(call, "exchanged", format!("({a}).{name}({on})"));
            }
            (_, [a, b]) if a != b => self.add(call, "exchanged", format!("{on}.{name}({b}, {a})")),
            _ => {}
        }
        visit::visit_expr_method_call(self, call);
    }
}
