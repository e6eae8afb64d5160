# SPDX-License-Identifier: GPL-3.0-or-later
"""The velocity nearest a preferred one within half-planes and a speed bound, with a certificate.

>>> import exactvo
>>> answer = exactvo.lp.solve([(-1, 0)], [-0.5], (2, 0), max_speed=2)   # v_x <= 0.5
>>> answer.status, answer.check(), "%.6f %.6f" % answer.velocity        # rounded inward: never more than 0.5
('optimal', 'none', '0.500000 0.000000')

A half-plane is { v : normal . v >= offset }, offset in m/s. Equations (12) and (13) of the paper; docs/guide/linear-program.md.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from operator import index
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _exactvo
from ._calls import explain_calls, is_whole
from .errors import ArgumentError
from .shapes import Floats, Point

__all__ = [
    "BatchCertificates",
    "BatchSolution",
    "Certificate",
    "Problem",
    "STATUSES",
    "Solution",
    "Term",
    "batch_arrays",
    "check",
    "check_batch",
    "solve",
    "solve_batch",
]

#: The words behind the numbers in `BatchSolution.status`.
STATUSES = ("optimal", "relaxed", "infeasible", "no-interior")
#: The words behind the numbers that `check_batch` gives; 255 is "there is no certificate".
_CERTIFICATE_ERRORS = ("none", "malformed", "velocity", "contradiction", "bound", "vertex")


@dataclass(frozen=True)
class Term:
    """A constraint, or a part of the speed bound, and its multiplier (dimensionless, the exact sum of `multiplier`)."""

    kind: str  #: "constraint", "disc", "box-right", "box-left", "box-top" or "box-bottom"
    index: int  #: of the constraint; 0 for a part of the speed bound
    multiplier: tuple[float, ...]


@dataclass(frozen=True)
class Certificate:
    """Why an answer is right, as numbers that `check` multiplies out in rationals (vo/lp/certificate.h has the inequalities)."""

    status: str
    velocity: tuple[float, float]  #: m/s
    violation: float  #: m/s: no constraint that may give is violated by more
    contradiction: tuple[Term, ...]  #: relaxed, infeasible: these cannot all hold
    bound: tuple[Term, ...]  #: why no velocity is better than by `gap`
    gap: float  #: nearest: of |v - preferred|^2, m^2/s^2; a rounding error in size
    vertex: tuple[tuple[str, int], ...] = ()

    def _fields(self) -> tuple[Any, ...]:
        terms = [tuple((t.kind, t.index, t.multiplier) for t in group) for group in (self.contradiction, self.bound)]
        return (self.status, self.velocity, self.violation, terms[0], terms[1], self.gap, self.vertex)


@dataclass(frozen=True, eq=False)
class Problem:
    """What was asked. See `solve` for the meaning and units of the fields."""

    normals: Floats
    offsets: Floats
    preferred: tuple[float, float]
    max_speed: float = math.inf
    max_speed_x: float = math.inf
    max_speed_y: float = math.inf
    soft: npt.NDArray[np.bool_] | None = None
    objective: str = "nearest"

    def _fields(self) -> tuple[Any, ...]:
        return (
            self.normals, self.offsets, self.preferred, self.soft, self.max_speed, self.max_speed_x, self.max_speed_y, self.objective,
        )  # fmt: skip

    def __repr__(self) -> str:
        return f"Problem({len(self.offsets)} constraints, preferred={self.preferred}, max_speed={self.max_speed:g})"


@dataclass(frozen=True)
class Solution:
    """The answer: a value whatever it is. `relaxed` violates soft constraints as little as possible; `infeasible`: the hard
    ones contradict each other; `no-interior`: what must hold can be held, but by no double that was found."""

    velocity: tuple[float, float]  #: m/s
    status: str  #: one of STATUSES
    violation: float  #: m/s |normal|; 0 where optimal
    active: tuple[Term, ...]  #: what binds, with multipliers
    certificate: Certificate | None  #: with solver "certified" or "exact"
    exact_stage: bool  #: the double answer could not be certified
    problem: Problem = field(repr=False, compare=False)

    def check(self) -> str:
        """"none" where the certificate proves the answer, in rationals; else what is wrong with it, as `check`. Raises
        `ArgumentError` where there is no certificate."""
        if self.certificate is None:
            raise ArgumentError("certificate", "None", 'a certificate: solve(..., solver="certified")')
        return check(self.problem, self.certificate)


def _terms(native: tuple[Any, ...]) -> tuple[Term, ...]:
    return tuple(Term(kind, index, tuple(m) if isinstance(m, tuple) else (m,)) for kind, index, m in native)


def _certificate(native: tuple[Any, ...]) -> Certificate:
    status, velocity, violation, contradiction, bound, gap, vertex = native
    return Certificate(status, velocity, violation, _terms(contradiction), _terms(bound), gap, tuple(vertex))


def solve(
    normals: npt.ArrayLike,
    offsets: npt.ArrayLike,
    preferred: Point,
    *,
    max_speed: float = math.inf,
    max_speed_x: float = math.inf,
    max_speed_y: float = math.inf,
    soft: npt.ArrayLike | None = None,
    objective: str = "nearest",
    solver: str = "certified",
) -> Solution:
    """The velocity nearest `preferred` that satisfies every constraint.

    normals       m x 2; into the allowed side, any length but 0
    offsets       m; m/s times |normal|: allowed is { v : normal . v >= offset }
    preferred     m/s
    max_speed     m/s: |v| at most; `max_speed_x`, `max_speed_y`: |v_x|, |v_y| at most
    soft          m truth values: which constraints may give where all contradict each other; none unless said
    objective     "nearest" preferred, or "farthest" along it (a direction; needs a finite bound)
    solver        "certified": with a certificate, never wrong; "exact": every branch in exact arithmetic;
                  "batch": doubles alone, no certificate

    Raises `ArgumentError`. Released from the interpreter's lock while it works.
    """
    n = np.array(normals, dtype=np.float64).reshape(-1, 2) if np.size(normals) == 0 else np.asarray(normals)
    native = _exactvo.lp_solve(n, offsets, preferred, soft, max_speed, max_speed_x, max_speed_y, objective, solver)
    velocity, status, violation, active, certificate, exact_stage = native
    problem = Problem(
        np.array(n, dtype=np.float64),
        np.array(offsets, dtype=np.float64),
        (float(preferred[0]), float(preferred[1])),
        max_speed, max_speed_x, max_speed_y,
        None if soft is None else np.array(soft, dtype=np.bool_),
        objective,
    )  # fmt: skip
    return Solution(
        velocity, status, violation, _terms(active), None if certificate is None else _certificate(certificate), exact_stage, problem
    )


def check(problem: Problem, certificate: Certificate) -> str:
    """"none" where the certificate proves its claim about the problem; else what fails: "malformed", "velocity",
    "contradiction", "bound" or "vertex". Exact: rational arithmetic throughout, and knows no solver. Any certificate may
    be given, also a broken one. Raises `ArgumentError` for a problem that is none."""
    return _exactvo.lp_check(*(problem._fields() + (certificate._fields(),)))


@dataclass(frozen=True, eq=False)
class BatchCertificates:
    """The certificates of a batch as arrays, one row per problem. A binding is the index of a line, -1 nothing, -2 the disc."""

    present: npt.NDArray[np.bool_]  #: n: whether there is one
    status: npt.NDArray[np.uint8]  #: n
    velocity: Floats  #: n x 2, m/s
    violation: Floats  #: n, m/s
    gap: Floats  #: n, m^2/s^2
    bound: npt.NDArray[np.int32]  #: n x 3 bindings
    bound_multiplier: Floats  #: n x 3 x parts: the multiplier is the exact sum of its parts
    contradiction: npt.NDArray[np.int32]  #: n x 3 bindings
    contradiction_multiplier: Floats  #: n x 3 x parts
    vertex: npt.NDArray[np.int32]  #: n x 2 bindings

    def __repr__(self) -> str:
        return f"BatchCertificates({int(np.count_nonzero(self.present))} of {len(self.present)})"


@dataclass(frozen=True, eq=False, repr=False)
class BatchSolution:
    """The answers of a batch. Its arrays are read-only; one row per problem."""

    velocity: Floats  #: n x 2, m/s
    violation: Floats  #: n, m/s: how much the constraint violated most is violated; 0 where optimal
    status: npt.NDArray[np.uint8]  #: n numbers into `STATUSES`; 0 is optimal
    active: npt.NDArray[np.int32]  #: n x 3: the lines that bind, -1 where there are fewer
    proven: npt.NDArray[np.bool_] | None  #: n: whether the answer is proven; None unless `prove` or `certificates` was asked for
    certificates: BatchCertificates | None  #: None unless `certificates` was asked for
    copied: bool  #: whether an array had to be laid out anew
    scalar_count: int  #: problems that the lanes handed to the scalar solver
    exact_count: int  #: problems that needed exact arithmetic to be proven

    def __len__(self) -> int:
        return len(self.status)

    def __repr__(self) -> str:
        counts = np.bincount(self.status, minlength=4)
        words = ", ".join(f"{n} {word}" for n, word in zip(counts, STATUSES) if n)
        return f"BatchSolution({len(self)} problems: {words or 'none'})"

    def __setstate__(self, state: dict[str, Any]) -> None:
        for value in state.values():
            if isinstance(value, np.ndarray):
                value.flags.writeable = False
        self.__dict__.update(state)


def solve_batch(
    normals: npt.ArrayLike,
    offsets: npt.ArrayLike,
    preferred: npt.ArrayLike,
    *,
    max_speed: float | npt.ArrayLike,
    hard: int | npt.ArrayLike | None = None,
    prove: bool = False,
    certificates: bool = False,
    copy: bool = True,
    parallel: bool = False,
) -> BatchSolution:
    """n problems of m lines each, one per SIMD lane.

    normals       n x m x 2, unit length to 1e-3
    offsets       n x m, m/s: allowed is { v : normal . v >= offset }
    preferred     n x 2, m/s
    max_speed     m/s, for all or n of them
    hard          the first so many lines of each problem are hard, the rest may give; all unless said
    prove         prove every answer in doubles with their rounding errors, exactly where that fails: `proven`
    certificates  certificates as arrays (slower: microseconds a problem)
    parallel      on as many threads as there are; the same bits

    Float64 arrays in Fortran order are used where they lie, others are copied; `copy=False` refuses those. `batch_arrays`
    makes such arrays. Pad a problem with fewer lines by normal (1, 0), offset -1e30. Raises `ArgumentError`. The
    interpreter's lock is released for more than 64 lines.
    """
    answer = _exactvo.lp_solve_batch(normals, offsets, preferred, max_speed, hard, prove, certificates, copy, parallel)
    if certificates:
        answer["certificates"] = BatchCertificates(**answer["certificates"])
    return BatchSolution(**answer)


def check_batch(
    normals: npt.ArrayLike,
    offsets: npt.ArrayLike,
    preferred: npt.ArrayLike,
    certificates: BatchCertificates,
    *,
    max_speed: float | npt.ArrayLike,
    hard: int | npt.ArrayLike | None = None,
) -> npt.NDArray[np.bool_]:
    """Which certificates prove their answers: n truth values. Exact, as `check`; the problems as for `solve_batch`.
    Raises `ArgumentError`."""
    codes = _exactvo.lp_check_batch(normals, offsets, preferred, max_speed, hard, vars(certificates))
    proven: npt.NDArray[np.bool_] = codes == _CERTIFICATE_ERRORS.index("none")
    return proven


def batch_arrays(problems: int, lines: int) -> tuple[Floats, Floats, Floats]:
    """(normals, offsets, preferred) for `solve_batch`, in the order that needs no copy; every line always holds. Raises
    `ArgumentError`."""
    for name, value in (("problems", problems), ("lines", lines)):
        if not is_whole(value) or value < 0:
            raise ArgumentError(name, repr(value)[:60], "a whole number, 0 or more")
    problems, lines = index(problems), index(lines)
    normals = np.zeros((problems, lines, 2), order="F")
    normals[..., 0] = 1.0
    offsets = np.full((problems, lines), -1e30, order="F")
    return normals, offsets, np.zeros((problems, 2), order="F")


explain_calls(__name__)
