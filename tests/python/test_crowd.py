# SPDX-License-Identifier: GPL-3.0-or-later
import math
import pickle
import threading

import numpy as np
import pytest

import exactvo


def grid(count, spacing=2.5):
    side = math.isqrt(count - 1) + 1
    k = np.arange(count)
    return np.stack([spacing * (k % side), spacing * (k // side)], axis=1).astype(float)


def test_two_robots_swap_places():
    crowd = exactvo.Crowd()
    crowd.add_robots([(0, 0), (10, 0.5)], radius=0.5, max_speed=1.5)
    crowd.head_for([(10, 0), (0, 0.5)])
    nearest = math.inf
    for _ in range(60):
        report = crowd.step()
        assert report.robots == 2 and report.relaxed == 0
        nearest = min(nearest, float(np.linalg.norm(crowd.positions[0] - crowd.positions[1])))
    assert nearest >= 1.0 - 1e-5 and np.allclose(crowd.positions, [(10, 0), (0, 0.5)], atol=0.1)
    assert crowd.time == 15.0 and len(crowd) == 2 and crowd.kept.all()


def test_a_refused_call_leaves_no_robot_id_and_no_wall():
    crowd = exactvo.Crowd()
    crowd.add_robot((0, 0))
    with pytest.raises(exactvo.CrowdError):
        crowd.add_robots([(5, 5), (5000, 0)])
    assert crowd.positions.shape == (1, 2)
    crowd.head_for([(1, 1)])
    with pytest.raises(exactvo.CrowdError):
        crowd.add_obstacles([exactvo.Wall([(0, 2), (1, 2)]), exactvo.Wall([(0, 2), (2e12, 2)])])
    with pytest.raises(exactvo.CrowdError):
        crowd.remove_obstacle(0)


def test_a_hundred_thousand_robots_are_stepped_without_a_copy():
    count = 100_000
    crowd = exactvo.Crowd(threads=0)
    positions = grid(count)
    ids = crowd.add_robots(positions)
    assert len(ids) == count and np.array_equal(crowd.positions, positions)
    seen, velocities, preferred = crowd.positions, crowd.velocities, crowd.preferred
    addresses = [a.__array_interface__["data"][0] for a in (seen, velocities, preferred)]
    preferred[:] = (0.7, 0.2)
    before = seen.copy()
    crowd.step(2)
    assert [a.__array_interface__["data"][0] for a in (crowd.positions, crowd.velocities, crowd.preferred)] == addresses
    assert seen.base is not None and not seen.flags.owndata and not seen.flags.writeable
    assert np.array_equal(seen, crowd.positions) and not np.array_equal(seen, before)
    moved = np.linalg.norm(seen - before, axis=1)
    assert moved.max() <= 2 * 0.25 * 1.5 + 1e-6 and moved.mean() > 0.1
    with pytest.raises(ValueError):
        seen[0, 0] = 1.0


def test_old_views_stay_valid_when_robots_are_added():
    crowd = exactvo.Crowd()
    crowd.add_robots(grid(10))
    old = crowd.positions
    crowd.add_robots(grid(2000) + (100, 100), radius=0.3)
    crowd.step()
    assert old.shape == (10, 2) and np.isfinite(old).all() and crowd.positions.shape == (2010, 2)


def test_removed_robots_are_nan_and_their_ids_come_again():
    crowd = exactvo.Crowd()
    ids = crowd.add_robots(grid(5))
    crowd.remove_robot(int(ids[2]))
    crowd.step()
    assert np.isnan(crowd.positions[2]).all() and len(crowd) == 4
    assert crowd.add_robot((50, 50)) == 2 and crowd.positions[2].tolist() == [50.0, 50.0]
    with pytest.raises(exactvo.CrowdError):
        crowd.remove_robot(77)


def test_the_lock_is_released_and_a_second_thread_is_refused():
    crowd = exactvo.Crowd()
    crowd.add_robots(grid(20_000))
    crowd.preferred[:] = (0.5, 0.0)
    ticks, done = [], threading.Event()

    def count():
        while not done.is_set():
            ticks.append(1)

    counter = threading.Thread(target=count)
    worker = threading.Thread(target=crowd.step, args=(20,))
    counter.start()
    worker.start()
    refused = 0
    while worker.is_alive():
        try:
            crowd.explain(0)
        except exactvo.ArgumentError:
            refused += 1
    done.set()
    counter.join()
    assert refused > 0 and len(ticks) > 100 and crowd.time == 5.0


def test_threads_and_snapshots_give_the_same_bits():
    made = []
    for threads in (1, 2):
        crowd = exactvo.Crowd(threads=threads)
        crowd.add_robots(grid(500, 1.5))
        crowd.add_obstacles([exactvo.Wall([(-5, 10), (40, 10)])])
        crowd.preferred[:] = np.random.default_rng(5).uniform(-1, 1, (500, 2))
        crowd.step(10)
        made.append(crowd)
    assert made[0].digest == made[1].digest
    again = pickle.loads(pickle.dumps(made[0]))
    assert again.time == made[0].time and np.array_equal(again.positions, made[0].positions)
    for crowd in (made[0], again):
        crowd.step(5)
    assert again.digest == made[0].digest
    assert exactvo.Crowd.restored(made[0].snapshot()).digest == made[0].digest


def test_no_robot_crosses_a_wall():
    crowd = exactvo.Crowd()
    crowd.add_robots(grid(50, 1.5) + (0, 2))
    crowd.add_obstacles([exactvo.Wall([(-100, 0), (100, 0)])])
    crowd.preferred[:] = (0, -1.5)
    crowd.step(100)
    assert (crowd.positions[:, 1] >= 0.5 - 1e-5).all()


def test_explain_says_what_step_will_choose():
    crowd = exactvo.Crowd()
    crowd.add_robots([(0, 0), (3, 0.25)])
    crowd.preferred[:] = [(1.5, 0), (-1.5, 0)]
    crowd.step()
    told = crowd.explain(0)
    assert told.neighbours[0].robot == 1 and told.neighbours[0].half_plane.violation(told.chosen) <= 0 and told.kept
    crowd.step()
    assert crowd.velocities[0].tolist() == list(told.chosen)


def test_kinds_have_one_number_and_options_are_theirs():
    crowd = exactvo.Crowd()
    a = crowd.add_robot((0, 0), radius=0.3)
    b = crowd.add_robot((5, 0), kind=exactvo.RobotKind(radius=0.3))
    assert crowd.kind_of(a) == crowd.kind_of(b) == exactvo.RobotKind(radius=0.3)
    with pytest.raises(TypeError, match="radios.*did you mean 'radius'"):
        crowd.add_robot((9, 0), radios=0.3)


def stepped(crowd):
    crowd.step()


def raises_coincident(crowd):
    crowd.add_robots([(1, 1), (1, 1)])
    crowd.step()


def raises_not_finite(crowd):
    crowd.add_robot((0, 0))
    crowd.preferred[:] = math.nan
    crowd.step()


def raises_beyond_lattice_in_a_step(crowd):
    crowd.add_robot((4095.9, 0))
    crowd.preferred[:] = (1.5, 0)
    crowd.step(10)


def too_many_kinds(crowd):
    for k in range(2**14 + 1):
        crowd.add_kind(exactvo.RobotKind(radius=1 + k / 2**14))


@pytest.mark.parametrize(
    "call, code",
    [
        (raises_coincident, "coincident"),
        (raises_not_finite, "not-finite"),
        (raises_beyond_lattice_in_a_step, "beyond-lattice"),
        (too_many_kinds, "too-many"),
        (lambda c: c.add_robot((1e9, 0)), "beyond-lattice"),
        (lambda c: c.add_robots([(0, 0), (1e9, 0)]), "beyond-lattice"),
        (lambda c: c.add_robot((0, 0), radius=-1), "out-of-range"),
        (lambda c: c.add_robot((0, 0), radius=math.nan), "not-finite"),
        (lambda c: c.add_robot((0, 0), kind=7), "unknown-kind"),
        (lambda c: c.add_robot((0, 0), kind=70000), "unknown-kind"),
        (lambda c: c.remove_robot(3), "unknown-robot"),
        (lambda c: c.explain(-1), "unknown-robot"),
        (lambda c: c.remove_obstacle(3), "unknown-obstacle"),
        (lambda c: c.step(-1), "out-of-range"),
        (lambda c: exactvo.Crowd.restored(b"nothing"), "bad-snapshot"),
        (lambda c: exactvo.Crowd(time_step=0), "out-of-range"),
        (lambda c: exactvo.Crowd(threads=-1), "out-of-range"),
        (lambda c: exactvo.Crowd(position_step=0.3), "out-of-range"),
    ],
)
def test_every_refusal_has_its_code(call, code):
    crowd = exactvo.Crowd()
    with pytest.raises(exactvo.CrowdError) as caught:
        call(crowd)
    assert caught.value.code == code and caught.value.where == "crowd"
    assert pickle.loads(pickle.dumps(caught.value)).code == code


def test_all_robots_are_added_or_none():
    crowd = exactvo.Crowd()
    with pytest.raises(exactvo.CrowdError):
        crowd.add_robots([(0, 0), (1e9, 0)])
    assert len(crowd) == 0


@pytest.mark.parametrize(
    "call, where",
    [
        (lambda c: exactvo.Crowd(precision="single"), "precision"),
        (lambda c: c.add_robots([(0, 0, 0)]), "positions"),
        (lambda c: c.add_robot("here"), "position"),
        (lambda c: c.head_for([(0, 0)]), "goals"),
    ],
)
def test_a_wrong_argument_is_named(call, where):
    with pytest.raises(exactvo.ArgumentError) as caught:
        call(exactvo.Crowd())
    assert caught.value.where == where
