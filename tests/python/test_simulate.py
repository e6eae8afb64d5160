# SPDX-License-Identifier: GPL-3.0-or-later
import json
import pickle
import warnings

import numpy as np
import pytest

import exactvo

TWO = {
    "name": "two",
    "time_limit": 20,
    "robots": [
        {"id": "R1", "position": [0, 0], "goal": [6, 0]},
        {"id": "R2", "position": [6, 0.5], "goal": [0, 0.5]},
    ],
    "obstacles": [{"id": "wall", "polyline": [[3, -3], [3, -1]]}],
}
RUN_DEPENDENT = ("wall_time", "provenance")


def comparable(metrics):
    return {key: value for key, value in metrics.items() if key not in RUN_DEPENDENT}


@pytest.mark.parametrize("method", exactvo.METHODS)
def test_the_program_gives_the_same_metrics(program, source, method):
    scenario = source / "datasets/data/paper/A2.json"
    printed = json.loads(program("simulate", scenario, "--method", method, "--json"))
    run = exactvo.simulate(scenario, method=method)
    assert comparable(run.metrics) == comparable(printed)
    assert run.method == method and run.outcome == printed["outcome"]


def test_the_program_records_the_same_rows(program, source, tmp_path):
    program("simulate", source / "datasets/data/paper/B1.json", "--out", tmp_path / "B1", "--no-figures")
    theirs = exactvo.read_recording(tmp_path / "B1")
    ours = exactvo.simulate(source / "datasets/data/paper/B1.json")
    for name in ("time", "position", "velocity", "preferred", "chosen", "status"):
        assert getattr(ours, name).tobytes() == getattr(theirs, name).tobytes(), name
    assert ours.metrics["formation_position_error"] == theirs.metrics["formation_position_error"]


def said(call):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        call()
    assert all(w.category is exactvo.ScenarioWarning and w.filename == __file__ for w in caught), [str(w.filename) for w in caught]
    return [str(w.message) for w in caught]


def test_a_scene_in_another_unit_is_warned_of():
    small = {**TWO, "robots": [{**r, "radius": 0.001} for r in TWO["robots"]], "obstacles": []}
    for k, robot in enumerate(small["robots"]):
        robot["position"], robot["goal"] = [0.05 * k, 0.0], [0.05 - 0.05 * k, 0.01]
    texts = said(lambda: exactvo.simulate(small))
    assert texts == exactvo.Scenario(small).warnings and "2 robots within arrival_tolerance" in texts[0]
    assert said(lambda: exactvo.simulate(TWO)) == []
    with warnings.catch_warnings():
        warnings.simplefilter("error", exactvo.ScenarioWarning)
        with pytest.raises(exactvo.ScenarioWarning):
            exactvo.simulate(small)


def test_moved_slots_are_reported(source):
    scene = json.loads((source / "datasets/data/paper/B1.json").read_text())
    scene["time_limit"] = 1
    moved = "formation: recentre moves every slot by (-0.3333, -0.3333)"
    assert any(text.startswith(moved) for text in said(lambda: exactvo.simulate(scene)))
    scene["formation"]["recentre"] = False
    assert not any(text.startswith("formation: recentre") for text in said(lambda: exactvo.simulate(scene)))


def test_a_sweep_says_each_warning_once():
    sealed = {**TWO, "time_limit": 1, "obstacles": [{"polyline": [[4, -2], [8, -2], [8, 2], [4, 2], [4, -2]]}]}
    texts = said(lambda: exactvo.sweep(sealed, {"method": ["ivo", "orca"], "/time_step": [0.05, 0.1]}, jobs=2))
    assert len(texts) == len(set(texts)) and any("goal of R1" in text for text in texts)


def test_arrays_are_views_a_row_a_step():
    run = exactvo.simulate(TWO)
    steps = len(run)
    assert run.time.shape == (steps,) and run.position.shape == (steps, 2, 2) and run.status.shape == (steps, 2)
    assert run.position.tobytes() == run.position.tobytes()
    assert run.position.__array_interface__["data"] == run.position.__array_interface__["data"]
    assert not run.position.flags.owndata and not run.position.flags.writeable
    assert run.position[0].tolist() == [[0, 0], [6, 0.5]] and run.metrics["all_arrived"]
    step = np.diff(run.time)[:, None, None]
    assert np.allclose(np.diff(run.position, axis=0), step * run.chosen[:-1], atol=1e-9)
    position = run.position
    del run
    assert np.isfinite(position).all()


def test_decisions_carry_their_half_planes_and_pass_the_audit(tmp_path):
    run = exactvo.simulate(TWO, record_all=True)
    k = int(np.argmax([len(run.half_planes(step, 0)) for step in range(len(run) - 1)]))
    planes = run.half_planes(k, 0)
    assert planes and {p.source for p in planes} <= {"enclosure", "obstacle edge", "robot", "moving obstacle"}
    for p in planes:
        assert p.certified and p.half_plane.violation(run.chosen[k, 0]) <= 1e-9
    report = run.audit()
    assert report["unsafe"] == 0 and report["collisions"] == 0
    run.write(tmp_path / "recording.jsonl")
    again = exactvo.read_recording(tmp_path)
    assert again.position.tobytes() == run.position.tobytes()
    ours, read = comparable(run.metrics), comparable(again.metrics)
    for planning in ("plans", "routes"):  # what planning came to stands in no recording
        assert ours.pop(planning) is not None and read.pop(planning) is None
    assert read == ours
    with pytest.raises(IndexError):
        run.half_planes(10**9, 0)
    with pytest.raises(IndexError):
        run.half_planes(0, 2)


def test_the_dataframe_has_a_row_for_each_robot_and_step():
    pytest.importorskip("pandas")
    run = exactvo.simulate(TWO)
    frame = run.to_dataframe()
    assert len(frame) == 2 * len(run) and list(frame["robot"][:2]) == ["R1", "R2"]
    last = frame[frame["robot"] == "R2"].iloc[-1]
    assert (last["x"], last["y"]) == tuple(run.position[-1, 1]) and last["mode"] == "arrived"
    assert (frame["time"].to_numpy()[::2] == run.time).all()


def test_runs_are_drawn_and_animated(tmp_path):
    pytest.importorskip("matplotlib")
    run = exactvo.simulate(dict(TWO, obstacles=TWO["obstacles"] + [{"id": "box", "polygon": [[2, 2], [4, 2], [4, 4], [2, 4]]}]))
    axes = run.plot()
    assert axes.get_xlabel() == "x [m]" and axes.get_aspect() in (1.0, "equal")
    assert len(axes.lines) >= 4
    axes.figure.savefig(tmp_path / "run.png")
    assert (tmp_path / "run.png").stat().st_size > 5000
    run.animate(speed=10, frames_per_second=5).save(tmp_path / "run.gif", writer="pillow")
    assert (tmp_path / "run.gif").stat().st_size > 5000


def test_scenarios_are_built_from_arrays():
    wall = exactvo.Wall([(3, -3), (3, -1)])
    built = exactvo.Scenario.build([(0, 0), (6, 0.5)], [(6, 0), (0, 0.5)], obstacles=[wall], name="two", time_limit=20)
    assert len(built.robots) == 2 and built.obstacles[0] == wall
    assert exactvo.simulate(built).position.tobytes() == exactvo.simulate(TWO).position.tobytes()
    again = pickle.loads(pickle.dumps(built))
    assert again.to_json() == built.to_json()
    with pytest.raises(exactvo.ArgumentError, match="goals"):
        exactvo.Scenario.build([(0, 0)], [(1, 1), (2, 2)])
    with pytest.raises(exactvo.ArgumentError, match="starts"):
        exactvo.Scenario.build([0, 0], [(1, 1)])


def test_goals_out_of_reach_are_reported_before_the_run():
    ring = exactvo.Wall([(4, -1), (6, -1), (6, 1), (4, 1), (4, -1)])
    scenario = exactvo.Scenario.build([(0, 0)], [(5, 0)], obstacles=[ring], time_limit=5)
    assert len(scenario.warnings) == 1 and "R1" in scenario.warnings[0]
    assert exactvo.simulate(scenario).warnings == scenario.warnings


def test_a_run_is_stopped_by_its_progress():
    long = dict(TWO, time_limit=1e5, arrival_tolerance=1e-3, guidance="none")
    long["robots"] = [{"id": "R1", "position": [0, 0], "goal": [1e5, 0]}]
    seen = []

    def stop(time):
        seen.append(time)
        return False

    run = exactvo.simulate(long, progress=stop)
    assert len(seen) == 1 and run.time[-1] < 1e5 / 3

    def fail(time):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        exactvo.simulate(long, progress=fail)


@pytest.mark.parametrize("option", ["method", "guidance", "liveness", "controller", "integrator"])
def test_an_unknown_word_is_refused_with_the_known_ones(option):
    with pytest.raises(exactvo.ArgumentError, match="one of") as caught:
        exactvo.simulate(TWO, **{option: "nonsense"})
    assert caught.value.where == option


def test_a_mistyped_method_gets_a_suggestion():
    with pytest.raises(exactvo.ArgumentError, match='did you mean "ivo-edge"'):
        exactvo.simulate(TWO, method="ivo_edge")


@pytest.mark.parametrize(
    "change, code, where",
    [
        (dict(robots=[{"id": "R1", "position": [0, 0], "goal": [1, 0], "radius": -1}]), "E_RANGE", "/robots/0/radius"),
        (dict(robts=[]), "E_KEY_UNKNOWN", "/robts"),
        (dict(time_limit="long"), "E_TYPE", "/time_limit"),
        (dict(robots=[TWO["robots"][0], dict(TWO["robots"][0], id="R2")]), "E_SCENARIO", None),
    ],
)
def test_wrong_data_says_which_field(change, code, where):
    with pytest.raises(exactvo.DataError) as caught:
        exactvo.simulate(TWO | change)
    assert caught.value.code == code and (where is None or caught.value.where == where)
    again = pickle.loads(pickle.dumps(caught.value))
    assert (again.code, again.file, again.where, str(again)) == (code, "<dict>", caught.value.where, str(caught.value))


def test_files_that_are_missing_or_no_json_are_refused(tmp_path):
    with pytest.raises(exactvo.MissingFileError) as caught:
        exactvo.simulate(tmp_path / "absent.json")
    assert isinstance(caught.value, FileNotFoundError) and caught.value.file.endswith("absent.json")
    assert caught.value.code == "E_FILE_MISSING"
    (tmp_path / "cut.json").write_text('{"name": "x", ')
    with pytest.raises(exactvo.DataError) as caught:
        exactvo.simulate(tmp_path / "cut.json")
    assert caught.value.code == "E_JSON_SYNTAX" and "line" in caught.value.where
    with pytest.raises(exactvo.ArgumentError, match="scenario"):
        exactvo.simulate(3)
    with pytest.raises(exactvo.MissingFileError):
        exactvo.read_recording(tmp_path)
    (tmp_path / "recording.jsonl").write_text("{}\n")
    with pytest.raises(exactvo.DataError):
        exactvo.read_recording(tmp_path)


def test_joint_plans_are_those_of_the_recording(tmp_path):
    """Two head-on in a corridor with a siding."""
    wall = [(-12, 0), (12, 0), (12, 1.5), (5.7, 1.5), (5.7, 2.9), (4.3, 2.9), (4.3, 1.5), (-12, 1.5), (-12, 0)]
    scenario = exactvo.Scenario.build([(-10, 0.75), (10, 0.75)], [(10, 0.75), (-10, 0.75)], obstacles=[exactvo.Wall(wall)], max_speed=1.5, time_limit=25)
    run = exactvo.simulate(scenario)
    assert run.plans
    for plan in run.plans:
        assert plan.robots == (0, 1) and len(plan.movers) == len(plan.places) > 0
        assert np.array_equal(plan.starts, run.position[plan.from_row][list(plan.robots)])
        assert sum(len(plan.path(robot)) - 1 for robot in plan.robots) == len(plan.places)
        assert np.array_equal(plan.path(0)[0], plan.starts[0])
        assert {"by-plan", "going-back"} & set(run.mode[plan.row])
    report = run.audit()
    assert report["points"]["plans"]["asked"] == report["points"]["plans"]["proven"] == sum(len(p.robots) + len(p.places) for p in run.plans)
    run.write(tmp_path / "recording.jsonl")
    again = exactvo.read_recording(tmp_path / "recording.jsonl").plans
    assert [p.row for p in again] == [p.row for p in run.plans] and np.array_equal(again[0].places, run.plans[0].places)
    assert exactvo.simulate(scenario, liveness="off").plans == ()


CROSSING = {
    "name": "crossing",
    "time_step": 0.1,
    "time_limit": 60,
    "guidance": "none",
    "robots": [
        {"id": f"R{k}", "position": [4 * x, 4 * y], "goal": [-4 * x, -4 * y], "radius": 0.3, "max_speed": 1}
        for k, (x, y) in enumerate([(1, 0.1), (0, 1), (-1, 0), (0, -1)])
    ],
}


# Where nothing turns robots aside, four that cross stop in the middle.
RIGHT = np.array([(np.cos(0.4), -np.sin(0.4)), (np.sin(0.4), np.cos(0.4))])


def test_steering_sets_the_preferred_velocities():
    seen = []

    def steering(now):
        seen.append(now.time)
        assert now.position.shape == now.velocity.shape == now.preferred.shape == (4, 2)
        return 0.5 * now.preferred @ RIGHT

    run = exactvo.simulate(CROSSING, steering=steering)
    assert seen == run.time[:-1].tolist()
    assert np.hypot(*run.preferred[:-1].reshape(-1, 2).T).max() <= 0.5 + 1e-12
    assert "steered" in run.mode and run.metrics["arrived"] == 4
    assert run.metrics["collisions"] == [] and run.audit()["points"]["choices"]["refuted"] == 0

    def in_place(now):
        now.preferred[:] = 0.5 * now.preferred @ RIGHT

    assert exactvo.simulate(CROSSING, steering=in_place).position.tobytes() == run.position.tobytes()


def test_own_half_planes_hold_and_are_recorded():
    def half_planes(now):
        return [exactvo.OwnHalfPlane(k, exactvo.vo.HalfPlane((1.0, 0.0), -0.25), hard=k % 2 == 0) for k in range(4)]

    run = exactvo.simulate(CROSSING, half_planes=half_planes)
    own = run.own_half_planes(5, 2)
    assert [o.half_plane.offset for o in own] == [-0.25] and own[0].hard and run.own_stage(5, 2) == "held"
    assert run.chosen[:-1, ::2, 0].min() >= -0.25
    assert run.audit()["points"]["choices"]["refuted"] == 0
    assert exactvo.simulate(CROSSING).own_stage(5, 2) == "none"


@pytest.mark.parametrize(
    "rules, where",
    [
        ({"steering": lambda now: now.preferred[:2]}, "steering"),
        ({"steering": lambda now: now.preferred * np.nan}, "steering"),
        ({"half_planes": lambda now: [1]}, "half_planes"),
        ({"half_planes": lambda now: [exactvo.OwnHalfPlane(4, exactvo.vo.HalfPlane((1.0, 0.0), 0.0))]}, "half_planes"),
        ({"half_planes": lambda now: [exactvo.OwnHalfPlane(0, exactvo.vo.HalfPlane((0.0, 0.0), 0.0))]}, "half_planes"),
    ],
)
def test_answers_that_are_none_end_the_run(rules, where):
    with pytest.raises(exactvo.ArgumentError) as refused:
        exactvo.simulate(CROSSING, **rules)
    assert refused.value.where == where


def test_options_that_a_scenario_cannot_have_are_named(source):
    braking = exactvo.Scenario.build([[-3, 0]], [[3, 0]], acceleration={"max": 2.0})
    calls = [
        (braking, {"half_planes": lambda now: []}, "half_planes", "with an acceleration", "steering"),
        (braking, {"method": "rvo"}, "method", "cannot promise to brake in time", "another method"),
        (exactvo.Scenario(source / "datasets/data/paper/B1.json"), {"steering": lambda now: None}, "steering", "in a formation", "controller"),
    ]
    for scenario, options, where, found, expected in calls:
        with pytest.raises(exactvo.ArgumentError) as refused:
            exactvo.simulate(scenario, **options)
        assert refused.value.code == "E_ARGUMENT" and refused.value.where == where
        assert found in refused.value.found and expected in refused.value.expected
        assert "requires" not in str(refused.value)


def test_what_steering_raises_ends_the_run():
    def steering(now):
        raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError, match="mine"):
        exactvo.simulate(CROSSING, steering=steering)
