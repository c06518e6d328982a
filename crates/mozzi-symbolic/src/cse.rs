//! Names for sub-expressions that occur more than once: equal ones are one node; then pairs of factors or terms that
//! several nodes share become nodes, the most frequent first.

use crate::derivation::Formula;
use crate::expression::Expression;
use crate::rational::Rational;
use std::collections::{BTreeMap, HashMap};

/// A node; the factors and terms are sorted.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum Node {
    Leaf(Expression),
    Product(Vec<usize>),
    /// Terms with their signs, true for a minus; the first is positive.
    Sum(Vec<(usize, bool)>),
}

#[derive(Default)]
struct Graph {
    nodes: Vec<Node>,
    known: HashMap<Node, usize>,
}

/// A node and whether it is taken with a minus.
type Signed = (usize, bool);

/// A pair of factors, or of terms and whether their signs differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Pair {
    Factors(usize, usize),
    Terms(usize, usize, bool),
}

impl Graph {
    fn id(&mut self, node: Node) -> usize {
        if let Some(&id) = self.known.get(&node) {
            return id;
        }
        self.nodes.push(node.clone());
        self.known.insert(node, self.nodes.len() - 1);
        self.nodes.len() - 1
    }

    fn product(&mut self, mut factors: Vec<usize>) -> usize {
        factors.sort_unstable();
        match factors[..] {
            [] => self.id(Node::Leaf(Expression::Number(Rational::ONE))),
            [one] => one,
            _ => self.id(Node::Product(factors)),
        }
    }

    fn sum(&mut self, mut terms: Vec<Signed>) -> Signed {
        terms.sort_unstable();
        let negative = terms[0].1;
        if terms.len() == 1 {
            return terms[0];
        }
        terms.iter_mut().for_each(|term| term.1 ^= negative);
        (self.id(Node::Sum(terms)), negative)
    }

    fn add(&mut self, expression: &Expression) -> Signed {
        match expression {
            Expression::Number(x) => (self.id(Node::Leaf(Expression::Number(x.abs()))), x.is_negative()),
            Expression::Atom(_) | Expression::Named(_) => (self.id(Node::Leaf(expression.clone())), false),
            Expression::Power(base, k) if *k > 1 => {
                let (base, negative) = self.add(base);
                (self.product(vec![base; *k as usize]), negative && k % 2 == 1)
            }
            Expression::Power(..) => (self.id(Node::Leaf(expression.clone())), false),
            Expression::Product(x, factors) => {
                let (mut ids, mut negative) = (Vec::new(), x.is_negative());
                if !x.abs().is_one() {
                    ids.push(self.id(Node::Leaf(Expression::Number(x.abs()))));
                }
                for factor in factors {
                    let (id, minus) = self.add(factor);
                    negative ^= minus;
                    match &self.nodes[id] {
                        Node::Product(inner) => ids.extend(inner.clone()),
                        _ => ids.push(id),
                    }
                }
                (self.product(ids), negative)
            }
            Expression::Sum(terms) => {
                let terms = terms.iter().map(|term| self.add(term)).collect();
                self.sum(terms)
            }
        }
    }

    /// The nodes that the roots need.
    fn alive(&self, roots: &[Signed]) -> Vec<usize> {
        let mut is_alive = vec![false; self.nodes.len()];
        let mut stack: Vec<usize> = roots.iter().map(|root| root.0).collect();
        while let Some(id) = stack.pop() {
            if !std::mem::replace(&mut is_alive[id], true) {
                stack.extend(self.parts(id));
            }
        }
        (0..self.nodes.len()).filter(|&id| is_alive[id]).collect()
    }

    fn parts(&self, id: usize) -> Vec<usize> {
        match &self.nodes[id] {
            Node::Leaf(_) => Vec::new(),
            Node::Product(factors) => factors.clone(),
            Node::Sum(terms) => terms.iter().map(|term| term.0).collect(),
        }
    }

    fn pairs(&self, id: usize) -> Vec<Pair> {
        let mut pairs = Vec::new();
        match &self.nodes[id] {
            Node::Leaf(_) => {}
            Node::Product(factors) if factors.len() > 2 => {
                for (k, &a) in factors.iter().enumerate() {
                    pairs.extend(factors[k + 1..].iter().map(|&b| Pair::Factors(a, b)));
                }
            }
            Node::Sum(terms) if terms.len() > 2 => {
                for (k, a) in terms.iter().enumerate() {
                    pairs.extend(terms[k + 1..].iter().map(|b| Pair::Terms(a.0, b.0, a.1 != b.1)));
                }
            }
            Node::Product(factors) => pairs.push(Pair::Factors(factors[0], factors[1])),
            Node::Sum(terms) => pairs.push(Pair::Terms(terms[0].0, terms[1].0, terms[0].1 != terms[1].1)),
        }
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// A node with a pair replaced by the pair's own node, if it has it and is longer.
    fn without(&mut self, id: usize, pair: Pair) -> Option<Node> {
        match (self.nodes[id].clone(), pair) {
            (Node::Product(mut factors), Pair::Factors(a, b)) if factors.len() > 2 => {
                let i = factors.iter().position(|&x| x == a)?;
                factors.remove(i);
                let j = factors.iter().position(|&x| x == b)?;
                factors.remove(j);
                factors.push(self.product(vec![a, b]));
                factors.sort_unstable();
                Some(Node::Product(factors))
            }
            (Node::Sum(mut terms), Pair::Terms(a, b, differ)) if terms.len() > 2 => {
                let i = terms.iter().position(|x| x.0 == a)?;
                let first = terms.remove(i);
                let j = terms.iter().position(|x| x.0 == b && (x.1 != first.1) == differ)?;
                terms.remove(j);
                let (pair, negative) = self.sum(vec![(a, false), (b, differ)]);
                terms.push((pair, negative ^ first.1));
                terms.sort_unstable();
                Some(Node::Sum(terms))
            }
            _ => None,
        }
    }

    /// Replaces nodes in all nodes that have them.
    fn share(&mut self, roots: &[Signed]) {
        loop {
            let alive = self.alive(roots);
            let mut counts: HashMap<Pair, usize> = HashMap::new();
            for &id in &alive {
                self.pairs(id).into_iter().for_each(|pair| *counts.entry(pair).or_default() += 1);
            }
            let mut frequent: Vec<(usize, Pair)> =
                counts.into_iter().filter(|(_, count)| *count > 1).map(|(pair, count)| (count, pair)).collect();
            frequent.sort_unstable_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
            let Some(&(most, _)) = frequent.first() else { return };
            // all pairs of this count, as far as they do not meet in a node
            let mut touched = vec![false; self.nodes.len()];
            let mut has_changed = false;
            for (_, pair) in frequent.into_iter().take_while(|(count, _)| *count == most) {
                let having: Vec<usize> = alive.iter().copied().filter(|&id| self.pairs(id).contains(&pair)).collect();
                let longer = having.iter().filter(|&&id| self.parts(id).len() > 2).count();
                if having.iter().any(|&id| touched[id]) || longer == 0 {
                    continue;
                }
                for id in having {
                    touched[id] = true;
                    if let Some(node) = self.without(id, pair) {
                        self.nodes[id] = node;
                        has_changed = true;
                    }
                }
            }
            if !has_changed {
                return;
            }
        }
    }
}

/// Letters of names: the first that is free is taken.
const LETTERS: [&str; 3] = ["x", "z", "y"];

/// A letter that with a number is none of these names: x₁ may be an entry of a vector x. Without one nothing is named.
pub(crate) fn free_letter(taken: &[String]) -> Option<&'static str> {
    let is_numbered = |name: &String, letter: &str| {
        name.strip_prefix(letter).is_some_and(|rest| rest.chars().all(|c| c.is_ascii_digit()))
    };
    let is_free = |letter: &&&str| !taken.iter().any(|name| is_numbered(name, letter));
    LETTERS.iter().find(is_free).copied()
}

/// Names sub-expressions of these formulas; the names in the order in which they are needed.
pub(crate) fn name(formulas: &mut [Formula]) -> Vec<Expression> {
    let mut graph = Graph::default();
    let mut roots = Vec::new();
    for formula in formulas.iter() {
        roots.extend(formula.entries.iter().chain(&formula.denominator).map(|root| graph.add(root)));
    }
    graph.share(&roots);
    let mut uses = vec![0_usize; graph.nodes.len()];
    let mut distinct = roots.clone();
    distinct.sort_unstable();
    distinct.dedup_by_key(|root| root.0);
    distinct.iter().for_each(|root| uses[root.0] += 1);
    for id in graph.alive(&roots) {
        let mut parts = graph.parts(id);
        if let Node::Product(_) = graph.nodes[id] {
            parts.dedup(); // a square is one use
        }
        parts.iter().for_each(|&part| uses[part] += 1);
    }
    let mut writer = Writer { graph: &graph, uses: &uses, named: BTreeMap::new(), names: Vec::new() };
    let mut written = roots.iter().map(|&(id, negative)| {
        let expression = writer.write(id);
        if negative { expression.negated() } else { expression }
    });
    for formula in formulas.iter_mut() {
        for entry in formula.entries.iter_mut().chain(&mut formula.denominator) {
            if let Some(expression) = written.next() {
                *entry = expression;
            }
        }
    }
    drop(written);
    writer.names
}

struct Writer<'a> {
    graph: &'a Graph,
    uses: &'a [usize],
    named: BTreeMap<usize, usize>,
    names: Vec<Expression>,
}

impl Writer<'_> {
    fn write(&mut self, id: usize) -> Expression {
        if let Some(&name) = self.named.get(&id) {
            return Expression::Named(name);
        }
        let expression = match self.graph.nodes[id].clone() {
            Node::Leaf(expression) => return expression,
            Node::Product(factors) => {
                let (mut k, mut parts) = (Rational::ONE, Vec::<(Expression, i32)>::new());
                for factor in factors {
                    match self.write(factor) {
                        Expression::Number(x) => k = &k * &x,
                        other => match parts.iter_mut().find(|(part, _)| *part == other) {
                            Some((_, power)) => *power += 1,
                            None => parts.push((other, 1)),
                        },
                    }
                }
                let power = |(base, k): (Expression, i32)| match k {
                    1 => base,
                    _ => Expression::Power(Box::new(base), k),
                };
                Expression::product(k, parts.into_iter().map(power).collect())
            }
            Node::Sum(terms) => {
                let mut parts: Vec<Expression> = Vec::new();
                for (term, negative) in terms {
                    let part = self.write(term);
                    parts.push(if negative { part.negated() } else { part });
                }
                parts.sort_by_key(Expression::is_negative);
                Expression::sum(parts)
            }
        };
        if self.uses[id] < 2 {
            return expression;
        }
        self.names.push(expression);
        self.named.insert(id, self.names.len() - 1);
        Expression::Named(self.names.len() - 1)
    }
}
