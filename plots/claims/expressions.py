# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluates arithmetic and comparisons in text, with named values and functions. No other Python code is allowed."""

import ast
import math
import operator

OPERATORS = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.USub: operator.neg, ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt,
    ast.GtE: operator.ge, ast.Eq: operator.eq}


class Missing(Exception):
    """A necessary number is missing."""


class DividedByZero(Missing):
    """The number is a quotient by zero."""


def evaluate(text, names, call):
    """The value of an expression. `names` maps names to values; `call(name, arguments)` evaluates
    functions and may raise Missing. Raises DividedByZero, Missing for NaN, ValueError
    for anything that is not arithmetic."""

    def value_of(node):
        if isinstance(node, ast.Constant) and isinstance(node.value, (int, float, str)):
            return node.value
        if isinstance(node, ast.Name) and node.id in names:
            return names[node.id]
        if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
            return OPERATORS[type(node.op)](value_of(node.left), value_of(node.right))
        if isinstance(node, ast.UnaryOp) and type(node.op) in OPERATORS:
            return OPERATORS[type(node.op)](value_of(node.operand))
        if isinstance(node, ast.Compare) and all(type(op) in OPERATORS for op in node.ops):
            sides = [value_of(side) for side in (node.left, *node.comparators)]
            return all(OPERATORS[type(op)](left, right)
                       for op, left, right in zip(node.ops, sides, sides[1:]))
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
            return call(node.func.id, [value_of(argument) for argument in node.args])
        raise ValueError(f"`{text}`: `{ast.unparse(node)}` is not understood")

    try:
        value = value_of(ast.parse(text, mode="eval").body)
    except ZeroDivisionError:
        raise DividedByZero(f"`{text}` divides by zero") from None
    except (SyntaxError, TypeError) as error:
        raise ValueError(f"`{text}`: {error}") from None
    if isinstance(value, float) and math.isnan(value):
        raise Missing(f"`{text}` is not a number")
    return value
