# SPDX-License-Identifier: GPL-3.0-or-later
"""Many runs of one scenario as one table."""
import csv
import json

import pytest

import exactvo

TWO = {
    "name": "two", "time_limit": 20,
    "robots": [{"id": "A", "position": [0, 0], "goal": [8, 0.1]}, {"id": "B", "position": [8, 0], "goal": [0, 0]}],
}  # fmt: skip


def numbers_of(run):
    return {key: run.metrics[key] for key in ("all_arrived", "last_arrival_time", "min_robot_clearance", "steps", "outcome")}


def test_each_row_is_the_run_that_its_values_say():
    limits = [1.5, 20]
    rows = exactvo.sweep(TWO, {"method": ["orca", "ivo"], "/time_limit": limits, "/margins/robot": (0, 0.3)})
    assert [(r["method"], r["/time_limit"], r["/margins/robot"]) for r in rows] == [
        (m, t, g) for m in ("orca", "ivo") for t in limits for g in (0, 0.3)
    ]
    for row in rows:
        run = exactvo.simulate({**TWO, "time_limit": row["/time_limit"], "margins": {"robot": row["/margins/robot"]}}, method=row["method"])
        assert {key: row[key] for key in numbers_of(run)} == numbers_of(run)
        assert row["collisions"] == 0
    assert len({row["steps"] for row in rows}) > 2, "the values make a difference"
    assert rows == exactvo.sweep(TWO, {"method": ["orca", "ivo"], "/time_limit": limits, "/margins/robot": (0, 0.3)}, jobs=3)


def test_seeds_of_random_robots_and_a_table(tmp_path):
    crowd = {"name": "c", "time_limit": 1, "robots": [{"random": {"count": 5, "low": [0, 0], "high": [9, 9]}, "radius": 0.3}]}
    scenario, table = tmp_path / "c.json", tmp_path / "deep" / "sweep.csv"
    scenario.write_text(json.dumps(crowd))
    rows = exactvo.sweep(scenario, {"/robots/0/random/seed": range(4)}, table=table, method="orca", liveness="off")
    assert len({row["jitter"] for row in rows}) == 4
    assert all(row["decisions_count"] == 5 * row["steps"] and row["decisions_relaxed"] >= 0 for row in rows)
    with open(table, newline="") as file:
        read = list(csv.DictReader(file))
    assert [row["/robots/0/random/seed"] for row in read] == ["0", "1", "2", "3"]
    assert [float(row["jitter"]) for row in read] == [row["jitter"] for row in rows]
    assert exactvo.sweep(crowd, {"/robots/0/random/seed": [2]}, method="orca", liveness="off")[0]["jitter"] == rows[2]["jitter"]


def test_files_of_the_scenario_are_found_from_its_folder(tmp_path):
    (tmp_path / "wall.wkt").write_text("LINESTRING (4 -1, 4 1)\n")
    (tmp_path / "s.json").write_text(json.dumps({**TWO, "obstacles": [{"file": "wall.wkt"}]}))
    with_wall, without = exactvo.sweep(tmp_path / "s.json", {}), exactvo.sweep(TWO, {})
    assert with_wall[0]["min_obstacle_clearance"] > 0 and without[0]["min_obstacle_clearance"] is None
    assert exactvo.sweep(exactvo.Scenario(tmp_path / "s.json"), {}) == with_wall


@pytest.mark.parametrize(
    ("vary", "where"),
    [({"metod": ["orca"]}, "vary"), ({"method": "orca"}, "vary"), ({"/robots/9/radius": [1]}, "vary"), ({"/name/x": [1]}, "vary"),
     ({"method": ["best"]}, "method"), ([("method", "orca")], "vary"), ({"threads": [1]}, "vary")],
)  # fmt: skip
def test_what_cannot_be_varied_is_named(vary, where):
    with pytest.raises(exactvo.ArgumentError) as error:
        exactvo.sweep(TWO, vary)
    assert error.value.where == where


def test_a_wrong_value_is_wrong_data_and_nothing_is_written(tmp_path):
    with pytest.raises(exactvo.DataError) as error:
        exactvo.sweep(TWO, {"/time_limit": [1, -1]}, table=tmp_path / "t.csv")
    assert error.value.where == "/time_limit" and not list(tmp_path.iterdir())
    (tmp_path / "file").write_text("")
    with pytest.raises(exactvo.DataError) as unwritable:
        exactvo.sweep(TWO, {}, table=tmp_path / "file" / "t.csv")
    assert unwritable.value.code == "E_FILE_UNWRITABLE"
    for table in ("t.txt", 3):
        with pytest.raises(exactvo.ArgumentError):
            exactvo.sweep(TWO, {}, table=table)
