# SPDX-License-Identifier: GPL-3.0-or-later
import dataclasses
import json
import math
import pickle
from fractions import Fraction

import numpy as np
import pytest

import exactvo
from exactvo import lp

SEED = 20261


def random_problems(count, lines, *, order="F", infeasible=False):
    """Unit normals and a witness that keeps them all; or, of the first three, offsets that contradict each other."""
    rng = np.random.default_rng(SEED)
    normals, offsets, preferred = lp.batch_arrays(count, lines)
    angle = rng.uniform(0, 2 * np.pi, (count, lines))
    if infeasible:
        angle[:, :3] = rng.uniform(0, 2 * np.pi, (count, 1)) + np.array([0, 2.1, 4.2])
    normals[..., 0], normals[..., 1] = np.cos(angle), np.sin(angle)
    witness = rng.uniform(-0.5, 0.5, (count, 1, 2))
    offsets[:] = (normals * witness).sum(axis=2) - rng.uniform(0, 1, (count, lines))
    if infeasible:
        offsets[:, :3] += 1.5
    preferred[:] = rng.uniform(-2, 2, (count, 2))
    return tuple(np.array(a, order=order) for a in (normals, offsets, preferred))


def test_solves_and_proves_what_the_readme_says():
    answer = lp.solve([(-1, 0)], [-0.5], (2, 0), max_speed=2)
    assert answer.status == "optimal" and answer.check() == "none"
    assert math.isclose(answer.velocity[0], 0.5) and answer.velocity[1] == 0.0
    assert answer.active[0].kind == "constraint" and answer.active[0].index == 0


def test_without_constraints_the_preferred_velocity_is_the_answer():
    assert lp.solve([], [], (1, 2)).velocity == (1.0, 2.0)


def test_soft_constraints_give_and_hard_ones_do_not():
    normals, offsets = [(0, 1), (0, -1)], [0.5, 0.0]
    relaxed = lp.solve(normals, offsets, (1, 0), max_speed=3, soft=[True, False])
    assert relaxed.status == "relaxed" and math.isclose(relaxed.violation, 0.5) and relaxed.check() == "none"
    assert lp.solve(normals, offsets, (1, 0), max_speed=3).status == "infeasible"


def test_a_changed_certificate_is_not_accepted():
    answer = lp.solve([(-1, 0), (0, 1)], [-0.5, 0.25], (2, 0), max_speed=2)
    moved = dataclasses.replace(answer.certificate, velocity=(0.6, 0.25))
    assert lp.check(answer.problem, moved) == "velocity"
    better = dataclasses.replace(answer.certificate, gap=-1.0)
    assert lp.check(answer.problem, better) in ("malformed", "bound")
    absurd = dataclasses.replace(answer.certificate, bound=(lp.Term("constraint", 17, (1.0,)),))
    assert lp.check(answer.problem, absurd) == "malformed"


@pytest.mark.parametrize("solver", ["batch", "certified", "exact"])
@pytest.mark.parametrize("infeasible", [False, True])
def test_the_program_gives_the_same_numbers(program, solver, infeasible):
    normals, offsets, preferred = random_problems(20, 8, infeasible=infeasible)
    lines = [
        json.dumps({
            "bound": {"disc": 1.5},
            "preferred": preferred[i].tolist(),
            "constraints": [
                {"normal": n.tolist(), "offset": c, "priority": "soft" if infeasible else "hard"} for n, c in zip(normals[i], offsets[i])
            ],
        })
        for i in range(20)
    ]  # fmt: skip
    printed = [json.loads(line) for line in program("lp", "-", "--json", "--solver", solver, input="\n".join(lines)).splitlines()]
    for i in range(20):
        answer = lp.solve(
            normals[i], offsets[i], preferred[i], max_speed=1.5, soft=np.full(8, infeasible), solver=solver
        )
        assert list(answer.velocity) == printed[i]["velocity"]
        assert answer.status == printed[i]["status"]
        assert answer.violation == printed[i]["violation"]


@pytest.mark.parametrize("count", [1, 3, 16, 100])
@pytest.mark.parametrize("order", ["F", "C"])
def test_a_batch_agrees_with_single_problems(count, order):
    normals, offsets, preferred = random_problems(count, 10, order=order)
    batch = lp.solve_batch(normals, offsets, preferred, max_speed=2.0, prove=True)
    assert len(batch) == count and batch.proven.all() and not batch.status.any()
    for i in range(count):
        single = lp.solve(normals[i], offsets[i], preferred[i], max_speed=2.0)
        assert np.allclose(batch.velocity[i], single.velocity, atol=1e-9)
        for n, c in zip(normals[i], offsets[i]):  # exactly, in rationals
            v = [Fraction(x) for x in batch.velocity[i].tolist()]
            assert Fraction(float(n[0])) * v[0] + Fraction(float(n[1])) * v[1] >= Fraction(float(c))


def test_both_orders_and_threads_give_the_same_bits():
    fortran, c_order = random_problems(1000, 12), random_problems(1000, 12, order="C")
    a = lp.solve_batch(*fortran, max_speed=2.0)
    b = lp.solve_batch(*c_order, max_speed=np.full(1000, 2.0))
    c = lp.solve_batch(*fortran, max_speed=2.0, parallel=True)
    assert a.velocity.tobytes() == b.velocity.tobytes() == c.velocity.tobytes()


def test_arrays_in_fortran_order_are_not_copied():
    arrays = random_problems(64, 10)
    assert not lp.solve_batch(*arrays, max_speed=2.0, copy=False).copied
    assert lp.solve_batch(*(np.ascontiguousarray(a) for a in arrays), max_speed=2.0).copied
    with pytest.raises(exactvo.ArgumentError, match="normals.*Fortran"):
        lp.solve_batch(np.ascontiguousarray(arrays[0]), *arrays[1:], max_speed=2.0, copy=False)
    with pytest.raises(exactvo.ArgumentError, match="offsets.*float64"):
        lp.solve_batch(arrays[0], arrays[1].astype(np.float32), arrays[2], max_speed=2.0, copy=False)
    with pytest.raises(exactvo.ArgumentError, match="preferred"):
        lp.solve_batch(*arrays[:2], np.ascontiguousarray(arrays[2]), max_speed=2.0, copy=False)


def test_strided_and_integer_arrays_are_taken():
    normals, offsets, preferred = random_problems(40, 10)
    wide = np.zeros((80, 10, 2))
    wide[::2] = normals
    a = lp.solve_batch(wide[::2], offsets, preferred, max_speed=2)
    assert a.velocity.tobytes() == lp.solve_batch(normals, offsets, preferred, max_speed=2).velocity.tobytes()
    ints = lp.solve_batch(np.array([[[-1, 0]]]), np.array([[-1]]), [[3, 0]], max_speed=5)
    assert math.isclose(ints.velocity[0, 0], 1.0)


def test_the_arrays_of_an_answer_outlive_it_and_cannot_be_written():
    velocity = lp.solve_batch(*random_problems(16, 10), max_speed=2.0).velocity
    assert np.isfinite(velocity).all()
    with pytest.raises(ValueError):
        velocity[0, 0] = 1.0


@pytest.mark.parametrize("infeasible", [False, True])
def test_certificates_of_a_batch_as_arrays_are_checked(infeasible):
    problems = random_problems(200, 8, infeasible=infeasible)
    hard = 0 if infeasible else None
    batch = lp.solve_batch(*problems, max_speed=2.0, hard=hard, certificates=True)
    assert set(np.unique(batch.status)) == ({1} if infeasible else {0})
    certificates = batch.certificates
    assert certificates.present.all()
    assert lp.check_batch(*problems, certificates, max_speed=2.0, hard=hard).all()
    other = random_problems(200, 8)[1] + 0.75  # half-planes that were moved are not proven
    assert not lp.check_batch(problems[0], other, problems[2], certificates, max_speed=2.0, hard=hard).all()
    wrong = dataclasses.replace(certificates, velocity=certificates.velocity + 1.0)
    assert not lp.check_batch(*problems, wrong, max_speed=2.0, hard=hard).any()
    again = pickle.loads(pickle.dumps(certificates))
    assert lp.check_batch(*problems, again, max_speed=2.0, hard=hard).all()


@pytest.mark.parametrize(
    "change, where",
    [
        (dict(normals=[(1, 0, 0)]), "normals"),
        (dict(normals=[(0, 0)]), "normals"),
        (dict(normals="up"), "normals"),
        (dict(normals=[(math.nan, 0)]), "normals"),
        (dict(offsets=[1, 2]), "offsets"),
        (dict(offsets=[math.inf]), "offsets"),
        (dict(preferred=(1, 2, 3)), "preferred"),
        (dict(preferred="ab"), "preferred"),
        (dict(preferred=(1, math.nan)), "preferred"),
        (dict(preferred=7), "preferred"),
        (dict(max_speed=0), "max_speed"),
        (dict(max_speed=-1), "max_speed"),
        (dict(max_speed="fast"), "max_speed"),
        (dict(max_speed_x=math.nan), "max_speed_x"),
        (dict(soft=[True, False]), "soft"),
        (dict(objective="nearst"), "objective"),
        (dict(objective="farthest"), "max_speed"),
        (dict(solver="exat"), "solver"),
    ],
)
def test_a_wrong_argument_is_named(change, where):
    given = dict(normals=[(1, 0)], offsets=[0.0], preferred=(1, 0), max_speed=math.inf) | change
    arrays = [given.pop(name) for name in ("normals", "offsets", "preferred")]
    with pytest.raises(exactvo.ArgumentError) as caught:
        lp.solve(*arrays, **given)
    assert caught.value.where == where and caught.value.code == "E_ARGUMENT"


def test_a_mistyped_word_gets_a_suggestion():
    with pytest.raises(exactvo.ArgumentError, match='did you mean "certified"'):
        lp.solve([], [], (0, 0), solver="certfied")


@pytest.mark.parametrize(
    "change, where",
    [
        (dict(normals=np.ones((4, 2, 2))), "normals"),  # not of unit length
        (dict(normals=np.zeros((4, 2))), "normals"),
        (dict(offsets=np.zeros((4, 3))), "offsets"),
        (dict(offsets=np.full((4, 2), math.inf)), "normals"),
        (dict(preferred=np.zeros((3, 2))), "preferred"),
        (dict(preferred=np.full((4, 2), math.nan)), "preferred"),
        (dict(max_speed=math.inf), "max_speed"),
        (dict(max_speed=np.zeros(4)), "max_speed"),
        (dict(hard=3), "hard"),
        (dict(hard=[0, 1]), "hard"),
        (dict(hard=-1), "hard"),
    ],
)
def test_a_wrong_array_of_a_batch_is_named(change, where):
    normals, offsets, preferred = lp.batch_arrays(4, 2)
    given = dict(normals=normals, offsets=offsets, preferred=preferred, max_speed=1.0) | change
    arrays = [given.pop(name) for name in ("normals", "offsets", "preferred")]
    with pytest.raises(exactvo.ArgumentError) as caught:
        lp.solve_batch(*arrays, **given)
    assert caught.value.where == where


@pytest.mark.parametrize("count", [15, 16, 17])
def test_lines_that_are_not_copied_are_looked_at_where_preferred_is(count):
    normals, offsets, _ = lp.batch_arrays(count, 2)
    normals[count - 1, 1] = (2.0, 0.0)
    with pytest.raises(exactvo.ArgumentError) as caught:
        lp.solve_batch(normals, offsets, [(0.0, 0.0)] * count, max_speed=1.0)
    assert caught.value.where == "normals"


def test_an_empty_batch_is_an_answer():
    assert len(lp.solve_batch(*lp.batch_arrays(0, 5), max_speed=1.0)) == 0
    free = lp.solve_batch(*lp.batch_arrays(3, 0), max_speed=1.0)
    assert (free.velocity == 0).all()


def test_solutions_are_pickled():
    answer = lp.solve([(-1, 0)], [-0.5], (2, 0), max_speed=2)
    again = pickle.loads(pickle.dumps(answer))
    assert again == answer and again.check() == "none"


@pytest.mark.parametrize("given", [{}, {"prove": True}, {"certificates": True}], ids=str)
def test_answers_of_a_batch_are_pickled(given):
    arrays = lp.batch_arrays(40, 3)
    random = np.random.default_rng(7)
    turn = random.uniform(0, 2 * np.pi, (40, 3))
    arrays[0][:] = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    arrays[1][:] = random.uniform(-1, 0.5, (40, 3))
    arrays[2][:] = random.uniform(-1, 1, (40, 2))
    answer = lp.solve_batch(*arrays, max_speed=1.5, **given)
    again = pickle.loads(pickle.dumps(answer))
    for name in ("velocity", "violation", "status", "active", "proven"):
        one, other = getattr(answer, name), getattr(again, name)
        assert (one is None) == (other is None) and (one is None or one.tobytes() == other.tobytes())
        assert other is None or not other.flags.writeable
    assert (again.copied, again.scalar_count, again.exact_count) == (answer.copied, answer.scalar_count, answer.exact_count)
    assert repr(again) == repr(answer)
    if "certificates" in given:
        assert (lp.check_batch(*arrays, again.certificates, max_speed=1.5) == again.certificates.present).all()
        assert again.certificates.present.any()
    else:
        assert again.certificates is None
