# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever a caller passes, the answer is in the caller's words: the argument's name, what was found, what was expected."""
import importlib
import inspect
import pkgutil
import sys
from pathlib import Path

import numpy as np
import pytest

import exactvo

sys.path.insert(0, str(Path(__file__).parent))
from good_calls import JUNK, good_calls, two_robots  # noqa: E402

# These errors name no argument: a name, row or file is missing, or Python-RVO2 raises the same.
ANSWERS = (exactvo.ExactVOError, IndexError)


@pytest.fixture(scope="module")
def calls(tmp_path_factory):
    return good_calls(tmp_path_factory.mktemp("calls"))


def public_calls():
    folder = Path(exactvo.__file__).parent
    for module_name in sorted(m.name for m in pkgutil.iter_modules([str(folder)])):
        if module_name.startswith("_") or module_name == "errors":
            continue
        module = importlib.import_module(f"exactvo.{module_name}")
        for name in module.__all__:
            value = getattr(module, name)
            if inspect.isfunction(value):
                yield f"{module_name}.{name}"
            elif inspect.isclass(value):
                for member, of in vars(value).items():
                    if not member.startswith("_") and (inspect.isfunction(of) or isinstance(of, staticmethod)):
                        yield f"{module_name}.{name}.{member}"


def test_every_public_function_has_a_call_that_succeeds(calls):
    needs_a_browser = {"explorer.ExplorerPage.open"}
    missing = set(public_calls()) - {name for name, _, _ in calls} - needs_a_browser
    if importlib.util.find_spec("matplotlib") and importlib.util.find_spec("pandas"):
        assert not missing
    with pytest.raises(exactvo.ArgumentError, match="at least one"):
        exactvo.view()
    for name, function, given in calls:
        if name != "explorer.view":  # takes recordings, which have no name
            function(**given)


def test_no_wrong_argument_meets_the_extension_unnamed(calls, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # some junk is a path to write to
    unnamed = []
    for name, function, given in calls:
        for argument in given:
            for junk in JUNK:
                if callable(junk) and argument in ("steering", "half_planes"):
                    continue  # what a user's function raises is passed on
                try:
                    function(**dict(given, **{argument: junk}))
                except ANSWERS:
                    pass
                except RuntimeError as error:
                    assert name == "rvo2.PyRVOSimulator.addObstacle" and "Error adding obstacle" in str(error)
                except ValueError as error:
                    if not str(error).startswith("Either pass only 'pos'"):  # Python-RVO2's own words
                        unnamed.append((name, argument, repr(junk)[:30], error))
                except Exception as error:
                    unnamed.append((name, argument, repr(junk)[:30], error))
    assert not unnamed, f"{len(unnamed)}, first {unnamed[0]}"


def test_a_mistyped_keyword_gets_the_nearest_one(calls):
    tried = 0
    for name, function, given in calls:
        for argument in given:
            if len(argument) < 4 or "<lambda>" in getattr(function, "__qualname__", "") or name == "explorer.view":
                continue
            mistyped = dict(given)
            mistyped[argument[:-2] + argument[-1]] = mistyped.pop(argument)
            with pytest.raises((TypeError, exactvo.DataError)) as caught:  # a field of a scenario: its reader says it
                function(**mistyped)
            assert f"did you mean '{argument}'" in str(caught.value) or f'did you mean "{argument}"' in str(caught.value), (name, str(caught.value))
            tried += 1
    assert tried > 60
    with pytest.raises(TypeError, match="radios.*did you mean 'radius'"):
        two_robots().add_robot((9, 9), radios=0.3)
    with pytest.raises(TypeError, match=r"unexpected keyword argument 'colour': it takes count$"):
        two_robots().step(colour=3)


def test_a_word_in_capitals_gets_the_one_that_is_meant():
    scenario = {"name": "one", "robots": [{"id": "R", "position": [0, 0], "goal": [1, 0]}]}
    with pytest.raises(exactvo.ArgumentError, match='did you mean "ivo"'):
        exactvo.simulate(scenario, method="IVO")


def test_a_half_step_is_refused_by_name():
    with pytest.raises(exactvo.ArgumentError, match=r"^count: found 1\.5, expected a whole number$"):
        two_robots().step(1.5)


def test_ids_are_taken_as_add_robots_gives_them():
    crowd = exactvo.Crowd()
    ids = crowd.add_robots([(0, 0), (5, 0)])  # uint32, which the extension refused
    assert crowd.kind_of(ids[1]) == exactvo.RobotKind() and crowd.explain(ids[1]).robot == 1
    crowd.remove_robot(ids[1])
    assert len(crowd) == 1


def test_scenarios_take_numbers_and_arrays_of_numpy():
    robots = [{"id": "R1", "position": np.zeros(2), "goal": np.array([1, 0]), "radius": np.float32(0.5)}]
    assert exactvo.Scenario({"name": "numpy", "robots": robots}).robots[0].radius == 0.5


def test_an_error_in_a_callback_stays_what_it_is():
    def fail(time):
        return {}["no such key"]

    with pytest.raises(KeyError, match="no such key"):
        exactvo.simulate({"name": "far", "time_limit": 1e5, "robots": [{"id": "R1", "position": [0, 0], "goal": [1e5, 0]}]}, progress=fail)
