# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of calls in the caller's words. A call that fails for an argument of the wrong type is compared with the signature
afterwards, so that a call that succeeds pays for one Python frame only."""

from __future__ import annotations

import difflib
import functools
import inspect
import operator
import os
import sys
from collections.abc import Callable
from typing import Any

from .errors import ArgumentError, ExactVOError


def is_whole(value: Any) -> bool:
    try:
        operator.index(value)
    except TypeError:
        return False
    return True


def is_number(value: Any) -> bool:
    try:
        float(value)
    except (TypeError, ValueError, OverflowError):
        return False
    return not isinstance(value, (str, bytes)) and getattr(value, "ndim", 0) == 0


def _is_pair(value: Any) -> bool:
    try:
        return not isinstance(value, (str, bytes)) and len(value) == 2 and all(is_number(value[k]) for k in range(2))
    except (TypeError, KeyError, IndexError):
        return False


def _is_sequence(value: Any) -> bool:
    return not isinstance(value, (str, bytes, dict)) and hasattr(value, "__iter__") and getattr(value, "ndim", 1) > 0


def _is_array(value: Any) -> bool:
    import numpy as np

    try:
        return not isinstance(value, (str, bytes)) and np.asarray(value, dtype=np.float64).ndim > 0
    except (TypeError, ValueError, OverflowError):
        return False


def _is_texts(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and all(isinstance(v, str) for v in value)


#: What a parameter takes, by the words of its annotation. Others are left to the function.
_TAKES: dict[str, tuple[Callable[[Any], bool], str]] = {
    "int": (is_whole, "a whole number"),
    "bool": (lambda v: isinstance(v, (bool, int)) or type(v).__name__ in ("bool_", "bool"), "True or False"),
    "str": (lambda v: isinstance(v, str), "text"),
    "bytes": (lambda v: isinstance(v, bytes), "bytes"),
    "float": (is_number, "a number"),
    "Number": (is_number, "a number"),
    "Point": (_is_pair, "two finite numbers (x, y)"),
    "npt.ArrayLike": (_is_array, "an array of numbers"),
    "PathLike": (lambda v: isinstance(v, (str, os.PathLike)), "a path"),
    "os.PathLike[str]": (lambda v: isinstance(v, os.PathLike), "a path"),
    "dict[str, Any]": (lambda v: isinstance(v, dict), "a dict"),
    "tuple[str, ...]": (_is_texts, "a sequence of text"),
    "Sequence[str]": (_is_texts, "a sequence of text"),
    "None": (lambda v: v is None, "None"),
}


def _shown(value: Any) -> str:
    shape = getattr(value, "shape", ())
    text = f"an array of shape {shape}" if shape else " ".join(repr(value).split())
    return text if len(text) <= 60 else text[:60] + "..."


def _instances_of(kind: type) -> tuple[Callable[[Any], bool], str]:
    return (lambda value: isinstance(value, kind)), f"a {kind.__name__}"


def _takes(annotation: str, names: dict[str, Any]) -> tuple[Callable[[Any], bool], str] | None:
    """None where nothing is known of one of the alternatives. `names` are those of the function's module."""
    known: list[tuple[Callable[[Any], bool], str]] = []
    for word in (part.strip() for part in annotation.split(" | ")):
        if word.startswith("Callable["):
            known.append((callable, "a function"))
        elif word.startswith("npt.NDArray["):
            known.append(_TAKES["npt.ArrayLike"])
        elif word not in _TAKES and word.startswith(("Sequence[", "Iterable[")):
            known.append((_is_sequence, "a sequence"))
        elif word in _TAKES:
            known.append(_TAKES[word])
        elif inspect.isclass(names.get(word)):
            known.append(_instances_of(names[word]))
        else:
            return None
    words = list(dict.fromkeys(expected for _, expected in known))
    return (lambda value: any(fits(value) for fits, _ in known)), " or ".join(words)


def _unknown_keyword(name: str, signature: inspect.Signature, count: int, given: dict[str, Any]) -> TypeError | None:
    """`count` is how many arguments were given by position."""
    parameters = [p for p in signature.parameters.values() if p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY)]
    known = [p.name for p in parameters if p.name != "self"]
    meant = known
    if any(p.kind == p.VAR_KEYWORD for p in signature.parameters.values()):  # any name is taken, but one may be missing
        meant = [p.name for p in parameters[count:] if p.default is p.empty and p.name not in given]
        if not meant:
            return None
    for word in given:
        if word not in known:
            near = difflib.get_close_matches(word, meant, n=1, cutoff=0.6)
            takes = f"; did you mean {near[0]!r}?" if near else f": it takes {', '.join(known) or 'none'}"
            return TypeError(f"{name}() got an unexpected keyword argument {word!r}{takes}")
    return None


def _explanation(function: Callable[..., Any], args: tuple[Any, ...], given: dict[str, Any]) -> Exception | None:
    """What is wrong with the arguments, or None where nothing is seen."""
    signature = inspect.signature(function)
    name = function.__qualname__.replace(".__init__", "")
    unknown = _unknown_keyword(name, signature, len(args), given)
    if unknown is not None:
        return unknown
    try:
        bound = signature.bind(*args, **given)
    except TypeError:
        return None
    for parameter, value in bound.arguments.items():
        of = signature.parameters[parameter]
        if of.kind in (of.VAR_POSITIONAL, of.VAR_KEYWORD) or of.annotation is of.empty or value is of.default:
            continue
        takes = _takes(str(of.annotation), vars(sys.modules[function.__module__]))
        if takes is not None and not takes[0](value):
            return ArgumentError(parameter, _shown(value), takes[1])
    for parameter, value in bound.arguments.items():
        if signature.parameters[parameter].annotation == "int" and not -(2**31) <= value < 2**31:
            return ArgumentError(parameter, _shown(value), "a whole number within 2^31")
    return None


def _explained(function: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(function)
    def call(*args: Any, **given: Any) -> Any:
        try:
            return function(*args, **given)
        except ExactVOError:
            raise
        except (TypeError, ValueError, AttributeError, OverflowError, LookupError) as error:
            explanation = _explanation(function, args, given)
            if explanation is None:
                raise
            try:
                raise explanation from (None if isinstance(explanation, TypeError) else error)
            finally:
                del explanation  # it holds this frame, which would hold it, and the arguments, until the next collection

    return call


def _explain_class(kind: type) -> None:
    for name, member in list(vars(kind).items()):
        if name.startswith("_") and name != "__init__":
            continue
        if isinstance(member, staticmethod):
            setattr(kind, name, staticmethod(_explained(member.__func__)))
        elif inspect.isfunction(member):
            setattr(kind, name, _explained(member))


def explain_calls(module_name: str) -> None:
    """Every public function and method of the module from now on; called at the module's end."""
    module = sys.modules[module_name]
    for name in vars(module)["__all__"]:
        value = getattr(module, name)
        if getattr(value, "__module__", None) != module_name:
            continue
        if inspect.isfunction(value):
            setattr(module, name, _explained(value))
        elif inspect.isclass(value) and not issubclass(value, tuple):
            _explain_class(value)
