//! The way through a kernel on which its operations are counted.

use std::collections::HashMap;
use std::ops::Range;

use wgpu::naga::valid::{FunctionInfo, ModuleInfo};
use wgpu::naga::{
    BinaryOperator, Block, Constant, Expression, Function, Handle, Literal, LocalVariable, MathFunction, Module,
    Override, ScalarKind, Statement, TypeInner, UnaryOperator, VectorSize,
};

use super::stretch::{Item, MARK, Operations, Stretch};
use crate::gpu::source::Constants;

/// A kernel with all of its functions.
pub struct WholeKernel<'a> {
    pub module: &'a Module,
    pub info: &'a ModuleInfo,
    pub constants: &'a Constants,
    pub source: &'a str,
}

/// A function on the way through it.
struct Walk<'a> {
    whole: &'a WholeKernel<'a>,
    function: &'a Function,
    info: &'a FunctionInfo,
    /// Values of its variables, as far as they are known.
    known: HashMap<Handle<LocalVariable>, f64>,
    /// And of calls.
    results: HashMap<Handle<Expression>, f64>,
}

impl<'a> WholeKernel<'a> {
    pub fn function(&'a self, function: &'a Function, info: &'a FunctionInfo) -> Stretch {
        let mut walk = Walk { whole: self, function, info, known: HashMap::new(), results: HashMap::new() };
        for (variable, declared) in function.local_variables.iter() {
            if let Some(value) = declared.init.and_then(|init| walk.value(init)) {
                walk.known.insert(variable, value);
            }
        }
        walk.block(&function.body).0
    }

    /// What a function returns, whatever it is called with, if that is all that it does.
    fn always(&'a self, function: &'a Function, info: &'a FunctionInfo) -> Option<f64> {
        let walk = Walk { whole: self, function, info, known: HashMap::new(), results: HashMap::new() };
        match function.body.last() {
            Some(Statement::Return { value: Some(value) }) if function.body.len() == 1 => walk.value(*value),
            _ => None,
        }
    }

    fn literal(literal: Literal) -> Option<f64> {
        Some(match literal {
            Literal::F32(value) => f64::from(value),
            Literal::U32(value) => f64::from(value),
            Literal::I32(value) => f64::from(value),
            Literal::Bool(value) => f64::from(u8::from(value)),
            _ => return None,
        })
    }

    fn global(&self, expression: Handle<Expression>) -> Option<f64> {
        match self.module.global_expressions[expression] {
            Expression::Literal(literal) => WholeKernel::literal(literal),
            _ => None,
        }
    }

    fn constant(&self, constant: Handle<Constant>) -> Option<f64> {
        self.global(self.module.constants[constant].init)
    }

    fn overridden(&self, constant: Handle<Override>) -> Option<f64> {
        let declared = &self.module.overrides[constant];
        let given = self.constants.iter().find(|(name, _)| Some(*name) == declared.name.as_deref());
        given.map(|(_, value)| *value).or_else(|| declared.init.and_then(|init| self.global(init)))
    }
}

impl Walk<'_> {
    /// What is counted, and whether the block leaves what it stands in.
    fn block(&mut self, block: &Block) -> (Stretch, bool) {
        let mut all = Stretch::default();
        for (statement, span) in block.span_iter() {
            match statement {
                Statement::Emit(range) => {
                    for expression in range.clone() {
                        all.count(self.cost(expression));
                    }
                }
                Statement::Block(inner) => {
                    let (inner, left) = self.block(inner);
                    all.append(inner);
                    if left {
                        return (all, true);
                    }
                }
                Statement::If { condition, accept, reject } => {
                    if let Some(value) = self.value(*condition) {
                        let (taken, left) = self.block(if value == 0.0 { reject } else { accept });
                        all.append(taken);
                        if left {
                            return (all, true);
                        }
                        continue;
                    }
                    let text = self.text(span.to_range());
                    // Both sides of `&&` and `||`.
                    let logical = !text.starts_with("if")
                        && self.stored(accept).is_some_and(|own| self.stored(reject) == Some(own));
                    let mark = self.mark(span.to_range());
                    for (mark, arm) in [(mark, accept), (String::new(), reject)] {
                        let before = self.known.clone();
                        let (inner, _) = self.block(arm);
                        self.known = before;
                        if logical {
                            all.append(inner);
                        } else if !arm.is_empty() {
                            all.0.push(Item::Inner(mark, inner));
                        }
                    }
                    self.forget(accept);
                    self.forget(reject);
                }
                Statement::Loop { body, continuing, .. } => {
                    let turns = self.turns(body);
                    self.forget(body);
                    self.forget(continuing);
                    let (mut turn, _) = self.block(body);
                    turn.append(self.block(continuing).0);
                    match turns {
                        Some(turns) => {
                            all.count(turn.straight() * turns);
                            all.0.extend(turn.0.into_iter().filter(|item| matches!(item, Item::Inner(..))));
                        }
                        None => all.0.push(Item::Inner(self.mark(span.to_range()), turn)),
                    }
                }
                Statement::Switch { cases, .. } => {
                    for case in cases {
                        let (inner, _) = self.block(&case.body);
                        self.forget(&case.body);
                        all.0.push(Item::Inner(String::new(), inner));
                    }
                }
                Statement::Call { function, result, .. } => {
                    let called = &self.whole.module.functions[*function];
                    if let (Some(result), Some(value)) =
                        (result, self.whole.always(called, &self.whole.info[*function]))
                    {
                        self.results.insert(*result, value);
                    }
                    all.append(self.whole.function(called, &self.whole.info[*function]));
                    self.forget_of(statement);
                }
                Statement::Atomic { .. } => all.count(Operations { floating: 0.0, integer: 1.0 }),
                Statement::Store { pointer, value } => {
                    if let Expression::LocalVariable(variable) = self.function.expressions[*pointer] {
                        match self.value(*value) {
                            Some(value) => self.known.insert(variable, value),
                            None => self.known.remove(&variable),
                        };
                    }
                }
                Statement::Return { .. } | Statement::Break | Statement::Continue | Statement::Kill => {
                    return (all, true);
                }
                _ => {}
            }
        }
        (all, false)
    }

    /// The source from here to the end of the line.
    fn text(&self, range: Option<Range<usize>>) -> String {
        let rest = range.and_then(|range| self.whole.source.get(range.start..)).unwrap_or_default();
        rest.lines().next().unwrap_or_default().to_owned()
    }

    /// What the line before the statement calls it, as `// bench: NAME`.
    fn mark(&self, range: Option<Range<usize>>) -> String {
        let before = range.and_then(|range| self.whole.source.get(..range.start)).unwrap_or_default();
        let line_before = before.lines().rev().nth(usize::from(!before.ends_with('\n')));
        line_before.and_then(|line| line.trim().strip_prefix(MARK)).unwrap_or_default().to_owned()
    }

    /// How often a loop runs that counts from a known number to a literal one.
    fn turns(&self, body: &Block) -> Option<f64> {
        let condition = body.iter().find_map(|statement| match statement {
            Statement::If { condition, .. } => Some(*condition),
            _ => None,
        })?;
        let Expression::Binary { op: BinaryOperator::Less, left, right } = self.function.expressions[condition] else {
            return None;
        };
        let Expression::Load { pointer } = self.function.expressions[left] else { return None };
        let Expression::LocalVariable(variable) = self.function.expressions[pointer] else { return None };
        let end = match self.function.expressions[right] {
            Expression::Literal(literal) => WholeKernel::literal(literal)?,
            Expression::Constant(constant) => self.whole.constant(constant)?,
            _ => return None,
        };
        Some(end - self.known.get(&variable)?)
    }

    /// The variable in which a block stores last of all.
    fn stored(&self, block: &Block) -> Option<Handle<LocalVariable>> {
        match block.last()? {
            Statement::Store { pointer, .. } => match self.function.expressions[*pointer] {
                Expression::LocalVariable(variable) => Some(variable),
                _ => None,
            },
            Statement::Block(inner) => self.stored(inner),
            _ => None,
        }
    }

    /// What a block may store in is unknown after it.
    fn forget(&mut self, block: &Block) {
        for statement in block {
            match statement {
                Statement::Block(inner) => self.forget(inner),
                Statement::If { accept, reject, .. } => {
                    self.forget(accept);
                    self.forget(reject);
                }
                Statement::Loop { body, continuing, .. } => {
                    self.forget(body);
                    self.forget(continuing);
                }
                Statement::Switch { cases, .. } => cases.iter().for_each(|case| self.forget(&case.body)),
                other => self.forget_of(other),
            }
        }
    }

    fn forget_of(&mut self, statement: &Statement) {
        let pointers = match statement {
            Statement::Store { pointer, .. } => std::slice::from_ref(pointer),
            Statement::Call { arguments, .. } => arguments.as_slice(),
            _ => &[],
        };
        for pointer in pointers {
            if let Expression::LocalVariable(variable) = self.function.expressions[*pointer] {
                self.known.remove(&variable);
            }
        }
    }

    /// A number that is known before the kernel runs.
    fn value(&self, expression: Handle<Expression>) -> Option<f64> {
        let truth = |yes: bool| f64::from(u8::from(yes));
        match self.function.expressions[expression] {
            Expression::Literal(literal) => WholeKernel::literal(literal),
            Expression::Constant(constant) => self.whole.constant(constant),
            Expression::Override(constant) => self.whole.overridden(constant),
            Expression::CallResult(_) => self.results.get(&expression).copied(),
            Expression::Load { pointer } => match self.function.expressions[pointer] {
                Expression::LocalVariable(variable) => self.known.get(&variable).copied(),
                _ => None,
            },
            Expression::Unary { op: UnaryOperator::LogicalNot, expr } => Some(truth(self.value(expr)? == 0.0)),
            Expression::Binary { op, left, right } => {
                let (left, right) = (self.value(left), self.value(right));
                match (op, left, right) {
                    (BinaryOperator::LogicalAnd, Some(0.0), _) | (BinaryOperator::LogicalAnd, _, Some(0.0)) => {
                        Some(0.0)
                    }
                    (_, Some(left), Some(right)) => match op {
                        BinaryOperator::Equal => Some(truth(left == right)),
                        BinaryOperator::NotEqual => Some(truth(left != right)),
                        BinaryOperator::Less => Some(truth(left < right)),
                        BinaryOperator::LessEqual => Some(truth(left <= right)),
                        BinaryOperator::Greater => Some(truth(left > right)),
                        BinaryOperator::GreaterEqual => Some(truth(left >= right)),
                        BinaryOperator::LogicalAnd => Some(truth(left != 0.0 && right != 0.0)),
                        BinaryOperator::LogicalOr => Some(truth(left != 0.0 || right != 0.0)),
                        _ => None,
                    },
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// Whether an expression is made of constants alone.
    fn is_constant(&self, expression: Handle<Expression>) -> bool {
        match &self.function.expressions[expression] {
            Expression::Literal(_) | Expression::Constant(_) | Expression::Override(_) | Expression::ZeroValue(_) => {
                true
            }
            Expression::Splat { value: inner, .. }
            | Expression::Unary { expr: inner, .. }
            | Expression::As { expr: inner, .. } => self.is_constant(*inner),
            Expression::Compose { components, .. } => components.iter().all(|inner| self.is_constant(*inner)),
            Expression::Binary { left, right, .. } => self.is_constant(*left) && self.is_constant(*right),
            Expression::Math { arg, arg1, arg2, .. } => {
                self.is_constant(*arg) && [arg1, arg2].iter().all(|arg| arg.is_none_or(|arg| self.is_constant(arg)))
            }
            _ => false,
        }
    }

    /// Components of a value, and whether they are of floating point.
    fn shape(&self, expression: Handle<Expression>) -> (f64, bool) {
        let number = |size: VectorSize| f64::from(size as u8);
        match *self.info[expression].ty.inner_with(&self.whole.module.types) {
            TypeInner::Scalar(scalar) => (1.0, scalar.kind == ScalarKind::Float),
            TypeInner::Vector { size, scalar } => (number(size), scalar.kind == ScalarKind::Float),
            _ => (1.0, false),
        }
    }

    fn cost(&self, expression: Handle<Expression>) -> Operations {
        if self.is_constant(expression) {
            return Operations::default();
        }
        let (components, mut floating) = self.shape(expression);
        let number = match self.function.expressions[expression] {
            Expression::Binary { left, .. } => {
                // Of a comparison what is compared.
                floating = self.shape(left).1;
                components.max(self.shape(left).0)
            }
            Expression::Unary { op: UnaryOperator::BitwiseNot, .. } | Expression::Select { .. } => components,
            Expression::As { expr, convert: Some(_), .. } => {
                floating |= self.shape(expr).1;
                components
            }
            Expression::Relational { argument, .. } => self.shape(argument).0 - 1.0,
            Expression::Math { fun, arg, .. } => {
                let of_each = self.shape(arg).0;
                match fun {
                    MathFunction::Dot => 2.0 * of_each - 1.0,
                    MathFunction::Length => 2.0 * of_each,
                    MathFunction::Normalize => 3.0 * of_each,
                    MathFunction::Distance => 3.0 * of_each,
                    MathFunction::Cross => 9.0,
                    MathFunction::Fma | MathFunction::Clamp => 2.0 * components,
                    _ => components,
                }
            }
            _ => 0.0,
        };
        if floating {
            Operations { floating: number, integer: 0.0 }
        } else {
            Operations { floating: 0.0, integer: number }
        }
    }
}
