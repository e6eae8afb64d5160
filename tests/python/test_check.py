# SPDX-License-Identifier: GPL-3.0-or-later
"""`exactvo.check`: did bodies on trajectories collide?"""
import json
import sqlite3

import numpy as np
import pytest

import exactvo

EAST = np.array([(0, 0, 0), (1, 10, 0)], dtype=float)
NORTH = np.array([(0, 5, -5), (1, 5, 5)], dtype=float)
FIRST = 0.5 - 0.5**0.5 / 20  # discs of radius 0.25 m


def kinds_of_input(folder):
    """The same two trajectories, by all ways in which they can be given."""
    rows = [(t, name, x, y) for name, array in (("A", EAST), ("B", NORTH)) for t, x, y in array]
    path = folder / "t.csv"
    path.write_text("t,id,x,y\n" + "".join(f"{t},{name},{x},{y}\n" for t, name, x, y in sorted(rows)))
    columns = {"t": [r[0] for r in rows], "id": [r[1] for r in rows], "x": [r[2] for r in rows], "y": [r[3] for r in rows]}
    yield "dict of arrays", {"A": EAST, "B": NORTH}, {}
    yield "dict of lists", {"A": EAST.tolist(), "B": NORTH.tolist()}, {}
    yield "dict of columns", columns, {}
    yield "path", path, {}
    yield "text of a path", str(path), {}
    yield "array", np.array([(t, "AB".index(name), x, y) for t, name, x, y in rows]), {}
    positions = np.stack([EAST[:, 1:], NORTH[:, 1:]], axis=1)
    yield "positions", positions, {"time": [0, 1]}


def test_all_kinds_of_input_say_the_same(tmp_path):
    judged = 0
    for kind, trajectories, more in kinds_of_input(tmp_path):
        answer = exactvo.check(trajectories, radius=0.25, **more)
        assert not answer.clear and answer.overlaps == 1 and answer.contacts == 0, kind
        (event,) = answer.events
        assert event.kind == "overlap" and {event.body, event.other} in ({"A", "B"}, {"0", "1"}), kind
        assert event.first[0] <= FIRST <= event.first[1] and event.first[1] - event.first[0] < 1e-9, kind
        assert event.clearance[0] <= -0.5 <= event.clearance[1] and event.depth >= 0.5, kind
        assert event.place == pytest.approx((5, 0)) and not event.with_obstacle, kind
        assert set(answer.speeds.values()) == {10.0} and answer.rows == 4, kind
        judged += 1
    assert judged == 7


def test_tables_of_pandas(tmp_path):
    pandas = pytest.importorskip("pandas")
    table = pandas.DataFrame({"time": [0, 1, 0, 1], "agent_id": [7, 7, 9, 9], "x": [0, 10, 5, 5], "y": [0, 0, -5, 5]})
    answer = exactvo.check(table, radius=0.25)
    assert [(e.body, e.other) for e in answer.events] == [("7", "9")]
    events = answer.to_dataframe()
    assert list(events["kind"]) == ["overlap"] and events["first_low"][0] <= FIRST <= events["first_high"][0]
    assert len(exactvo.check(table, radius=0.01, between="none").to_dataframe()) == 0


def test_the_program_says_the_same(tmp_path, program):
    paths = {kind: given for kind, given, _ in kinds_of_input(tmp_path)}
    lines = [json.loads(line) for line in program("check", paths["path"], "--radius", 0.25, "--json").splitlines()]
    (event,) = exactvo.check(paths["dict of arrays"], radius=0.25).events
    assert (event.first, event.last, event.clearance) == tuple(tuple(lines[0][k]) for k in ("first", "last", "clearance"))


def test_contact_is_clear_and_near_pairs_are_listed():
    answer = exactvo.check({"A": [(0, 0, 0), (1, 4, 0)], "B": [(0, 2, 1), (1, 2, 1)]}, radius=0.5)
    assert answer.clear and answer.contacts == 1 and answer.events[0].depth == 0
    apart = exactvo.check({"A": [(0, 0, 0), (1, 4, 0)], "B": [(0, 2, 1), (1, 2, 1)]}, radius=0.4, near=0.5)
    assert apart.clear and apart.events == ()
    (approach,) = apart.approaches
    assert approach.clearance[0] <= 0.2 <= approach.clearance[1] + 1e-12 and approach.other == "B"


def test_maps_footprints_and_radii():
    walls = [exactvo.Wall([(5, -1), (5, 1)])]
    assert exactvo.check({"A": EAST}, map=walls, radius=0.2).events[0].other == 0
    assert exactvo.check({"A": EAST}, map=[[(3, 1), (4, 1), (4, 2)]], radius=0.9).clear
    box = [(-1, -0.4), (1, -0.4), (1, 0.4), (-1, 0.4)]
    beside = [exactvo.Wall([(0, 0.5), (10, 0.5)])]
    assert exactvo.check({"A": EAST}, map=beside, footprint=box).clear
    assert not exactvo.check({"A": EAST}, map=beside, footprint=box, radius=0.2).clear
    turned = np.array([(0, 0, 0, np.pi / 2), (1, 10, 0, np.pi / 2)])
    assert not exactvo.check({"A": turned}, map=beside, footprint=box).clear
    two = {"A": EAST, "B": [(0, 0, 0.6), (1, 10, 0.6)]}
    assert exactvo.check(two, radius={"A": 0.1, "B": 0.45}).clear
    positions = np.array([[(0, 0), (0, 0.6)], [(10, 0), (10, 0.6)]])
    assert not exactvo.check(positions, time=[0, 1], radius=[0.2, 0.45]).clear


def test_the_map_of_a_file(tmp_path):
    (tmp_path / "map.wkt").write_text("LINESTRING (5 -1, 5 1)\n")
    assert exactvo.check({"A": EAST}, map=tmp_path / "map.wkt", radius=0.1).overlaps == 1


def test_pages_and_certificates_are_written(tmp_path, program):
    page, proofs = tmp_path / "check.html", tmp_path / "proofs.jsonl"
    near = {"A": EAST, "B": [(0, 0, 0.6), (1, 10, 0.6)]}
    (tmp_path / "map.wkt").write_text("LINESTRING (5 -1, 5 1)\n")
    answer = exactvo.check(near, map=tmp_path / "map.wkt", radius=0.25, near=0.5, page=page, certificates=str(proofs))
    assert answer.overlaps == 2 and "1 certificate for motions that come near and stay clear, none for 2 that touch" in answer.notes[-1]
    assert page.read_text().startswith("<!DOCTYPE html>")
    assert "1 certificate, 1 valid, 2 none" in program("audit", "--certificate", proofs)
    # The program's proofs of the same are the same.
    path = tmp_path / "t.csv"
    path.write_text("t,id,x,y\n0,A,0,0\n0,B,0,0.6\n1,A,10,0\n1,B,10,0.6\n")
    program("check", path, "--map", tmp_path / "map.wkt", "--radius", 0.25, "--near", 0.5, "--certificates", tmp_path / "others.jsonl")
    assert (tmp_path / "others.jsonl").read_text() == proofs.read_text()


def test_files_that_would_be_overwritten_are_refused(tmp_path):
    path = tmp_path / "t.csv"
    path.write_text("t,id,x,y\n0,A,0,0\n")
    for more in ({"certificates": path}, {"page": tmp_path / "x.html", "certificates": tmp_path / "x.html"}, {"page": tmp_path / "x.txt"}):
        with pytest.raises(exactvo.ArgumentError):
            exactvo.check(path, radius=0.25, **more)
    assert path.read_text().startswith("t,id")
    chart = tmp_path / "map.wkt"
    chart.write_text("LINESTRING (5 -1, 5 1)\n")
    (tmp_path / "link.wkt").symlink_to(chart)
    for name in ("map.wkt", "link.wkt"):
        with pytest.raises(exactvo.ArgumentError):
            exactvo.check({"A": EAST}, map=chart, radius=0.25, certificates=tmp_path / name)
    for k in range(2):  # again over its own proofs, not over the rows
        assert exactvo.check(tmp_path, radius=0.25, certificates=tmp_path / "proofs.jsonl", page=tmp_path / "check.html").clear
        with pytest.raises(exactvo.ArgumentError):
            exactvo.check(tmp_path, radius=0.25, certificates=path)
    assert path.read_text().startswith("t,id") and chart.read_text().startswith("LINE")
    with pytest.raises(exactvo.DataError):
        exactvo.check(path, radius=0.25, certificates=tmp_path)


def test_cubics_have_the_speeds_of_the_program(tmp_path, program):
    path = tmp_path / "t.csv"
    path.write_text("t,id,x,y,vx,vy\n0,A,0,0,0,4\n1,A,1,0,0,4\n")
    assert exactvo.check(path, radius=0.1, between="cubic").speeds == {"A": 4.0}
    assert "greatest speed: 4 m/s" in program("check", path, "--radius", 0.1, "--between", "cubic")


def test_databases_of_jupedsim(tmp_path):
    path = tmp_path / "what? 50%.sqlite"
    with sqlite3.connect(path) as database:
        database.execute("CREATE TABLE trajectory_data (frame INTEGER, id INTEGER, pos_x REAL, pos_y REAL, ori_x REAL, ori_y REAL)")
        database.execute("CREATE TABLE metadata (key TEXT NOT NULL UNIQUE PRIMARY KEY, value TEXT NOT NULL)")
        database.execute("INSERT INTO metadata VALUES ('fps', '25')")
        rows = [(25 * t, k, x, y, 1, 0) for k, array in ((7, EAST), (9, NORTH)) for t, x, y in array]
        database.executemany("INSERT INTO trajectory_data VALUES (?, ?, ?, ?, ?, ?)", [(int(r[0]), *r[1:]) for r in rows])
    try:
        answer = exactvo.check(path, radius=0.25)
    except exactvo.DataError as error:
        if error.code == "E_FORMAT_UNAVAILABLE":
            pytest.skip("a build without SQLite")
        raise
    (event,) = answer.events
    assert answer.format == "jupedsim-sqlite" and (event.body, event.other) == ("7", "9")
    assert event.first[0] <= FIRST <= event.first[1]
    with sqlite3.connect(path) as database:
        database.execute("UPDATE trajectory_data SET pos_x = 'x' WHERE frame = 25 AND id = 9")
    with pytest.raises(exactvo.DataError) as caught:
        exactvo.check(path, radius=0.25)
    assert (caught.value.code, caught.value.where) == ("E_NUMBER", "row 4")
    other = tmp_path / "other.sqlite"
    with sqlite3.connect(other) as database:
        database.execute("CREATE TABLE others (frame INTEGER)")
    (tmp_path / "cut.sqlite").write_bytes(path.read_bytes()[:5000])
    for bad in (other, tmp_path / "cut.sqlite"):
        with pytest.raises(exactvo.DataError) as caught:
            exactvo.check(bad, radius=0.25)
        assert caught.value.code == "E_FORMAT_SYNTAX"


def test_between_rows():
    rows = {"t": [0, 1, 0, 1], "id": list("AABB"), "x": [0, 4, 2, 2], "y": [0, 0, 0.9, 0.9], "vx": [4, 4, 0, 0], "vy": [3, -3, 0, 0]}
    clear = {between: exactvo.check(rows, radius=0.2, between=between).clear for between in ("straight", "hold", "cubic", "none")}
    assert clear == {"straight": True, "hold": True, "cubic": False, "none": True}


def test_recordings_and_absent_robots():
    run = exactvo.simulate({"name": "one", "time_limit": 5, "robots": [
        {"id": "a", "position": [0, 0], "goal": [4, 0]}, {"id": "b", "position": [4, 0.1], "goal": [0, 0.1]}]})
    radius = run.scenario.robots[0].radius
    assert exactvo.check(run, radius=radius).clear
    positions = np.array(run.position)
    positions[:, 1] = np.nan
    alone = exactvo.check(positions, time=run.time, radius=100.0)
    assert alone.clear and [body.rows for body in alone.bodies] == [len(run.time)]


TWO = {"name": "two", "time_limit": 5, "guidance": "none", "obstacles": [{"id": "wall", "polyline": [[2, -2], [2, 2]]}], "robots": [
    {"id": "a", "position": [0, 0], "goal": [1, 0], "radius": 0.4}, {"id": "b", "position": [0, 1], "goal": [1, 1], "radius": 0.5}]}  # fmt: skip


def test_a_run_brings_its_radii_obstacles_and_ids(tmp_path, program):
    run = exactvo.simulate(TWO)
    run.write(tmp_path / "recording.jsonl")
    answers = [exactvo.check(given, near=2) for given in (run, tmp_path, tmp_path / "recording.jsonl")]
    for answer in answers:
        assert answer.clear and [body.id for body in answer.bodies] == ["a", "b"]
        assert {(a.body, a.with_obstacle) for a in answer.approaches} == {("a", False), ("a", True), ("b", True)}
        least = {a.body: a.clearance for a in answer.approaches if a.with_obstacle}
        assert least["a"] == pytest.approx((0.62, 0.62), abs=0.03) and least["b"] == pytest.approx((0.52, 0.52), abs=0.03)
    assert len({answer.approaches for answer in answers}) == 1
    for given in (run, tmp_path):
        with pytest.raises((exactvo.ArgumentError, exactvo.DataError), match="scale"):
            exactvo.check(given, scale=2)
    lines = [json.loads(line) for line in program("check", tmp_path, "--near", 2, "--json").splitlines()]
    assert sorted(tuple(line["approach"]) for line in lines if "approach" in line) == sorted(a.clearance for a in answers[0].approaches)
    assert not exactvo.check(run, radius=0.6).clear and exactvo.check(run, map=[], radius=0.4, near=2).approaches[0].other == "b"
    with pytest.raises(exactvo.DataError):
        exactvo.check(tmp_path / "none")


BURGER = {"name": "a Burger", "time_limit": 60, "arrival_tolerance": 0.02, "robots": [
    {"id": "R1", "position": [0, 0], "heading": 90, "radius": 0.105, "goal": [0, 1],
     "kinematics": {"type": "differential", "wheel_separation": 0.16, "max_wheel_speed": 0.22, "max_wheel_acceleration": 1}}]}  # fmt: skip
LONG = [(-1, -0.1), (0.5, -0.1), (0.5, 0.1), (-1, 0.1)]


def test_bodies_of_robots_on_wheels_are_about_the_axle(tmp_path):
    run = exactvo.simulate(BURGER)
    run.write(tmp_path / "recording.jsonl")
    behind, beside = [exactvo.Wall([(-0.05, -0.95), (0.05, -0.95)])], [exactvo.Wall([(-0.9, -0.5), (-0.9, 1.5)])]
    close, ahead = [exactvo.Wall([(-0.05, -0.1), (0.05, -0.1)])], [exactvo.Wall([(-0.05, 1.06), (0.05, 1.06)])]
    for given in (tmp_path, run):
        answer = exactvo.check(given, map=behind, footprint=LONG)
        assert answer.overlaps == 1 and answer.events[0].first[0] == 0 and "places of robots on wheels are the axle's centre" in answer.notes
        assert exactvo.check(given, map=beside, footprint=LONG).clear
        assert exactvo.check(given, map=close, radius=0.105).overlaps == 1
        assert exactvo.check(given, map=ahead, radius=0.105).clear and exactvo.check(given, map=ahead, radius={"R1": 0.105}).clear
        assert exactvo.check(given, map=ahead).overlaps == 1  # the disc about the reference point


def test_runs_with_a_footprint_are_refused_without_one(tmp_path):
    body = {**BURGER["robots"][0], "footprint": {"polygon": [[-0.2, -0.1], [0.05, -0.1], [0.05, 0.1], [-0.2, 0.1]]}}
    del body["radius"]
    run = exactvo.simulate({**BURGER, "robots": [body]})
    run.write(tmp_path / "recording.jsonl")
    for given in (tmp_path, run):
        with pytest.raises(exactvo.DataError, match="which has a footprint") as caught:
            exactvo.check(given)
        assert caught.value.code == "E_SCENARIO"
        assert exactvo.check(given, footprint=body["footprint"]["polygon"]).clear
    assert caught.value.file == "trajectories" and str(caught.value).startswith("trajectories: ")


def test_moving_obstacles_of_a_run_are_left_out_and_the_answer_says_so(tmp_path):
    cart = {"id": "cart", "polygon": [[5, 5], [6, 5], [6, 6], [5, 6]], "path": [[0, 0], [1, 0]], "speed": 0.5}
    run = exactvo.simulate({**TWO, "moving_obstacles": [cart]})
    run.write(tmp_path / "recording.jsonl")
    for given in (run, tmp_path):
        assert exactvo.check(given).notes == ("1 moving obstacle left out",)


def test_unknown_cells_of_a_map_are_free_or_blocked_and_the_answer_says_which(tmp_path):
    (tmp_path / "map.pgm").write_bytes(b"P5 4 4 255\n" + bytes([254, 254, 205, 254] * 4))
    (tmp_path / "map.yaml").write_text(
        "image: map.pgm\nresolution: 1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    through = {"A": [(0, 0.5, 0.5), (1, 3.5, 0.5)]}
    free = exactvo.check(through, map=tmp_path / "map.yaml", radius=0.1)
    assert free.clear and any("unknown" in note for note in free.notes)
    assert exactvo.check(through, map=tmp_path / "map.yaml", unknown="blocked", radius=0.1).overlaps == 1
    for options, where in (({"map": tmp_path / "map.yaml", "unknown": "bloked"}, "unknown"), ({"unknown": "blocked"}, "unknown")):
        with pytest.raises(exactvo.ArgumentError) as caught:
            exactvo.check(through, radius=0.1, **options)
        assert caught.value.where == where


def test_findings():
    t = np.arange(60.0)
    x = np.where(t >= 20, t + 50, t)
    there = t != 40
    answer = exactvo.check({"A": np.stack([t, x, 0 * t], axis=1)[there]}, radius=0.2)
    (jump,), (gap,) = answer.jumps, answer.gaps
    assert (jump.row, jump.length, jump.speed) == (21, 51.0, 51.0)
    assert (gap.row, gap.start, gap.end) == (41, 39.0, 41.0)


@pytest.mark.parametrize(
    ("given", "options", "where"),
    [
        ({"A": EAST}, {}, "radius"),
        ({"A": EAST}, {"radius": -1}, "radius"),
        ({"A": EAST}, {"radius": {"B": 1}}, "radius"),
        ({"A": EAST}, {"radius": [1, 2]}, "radius"),
        ({"A": EAST[:, :2]}, {"radius": 1}, "trajectories['A']"),
        ({}, {"radius": 1}, "trajectories"),
        ({"x": [1], "y": [2]}, {"radius": 1}, "trajectories"),
        ({"t": [0], "x": [1, 2], "y": [2]}, {"radius": 1}, "x"),
        ({"t": [0], "id": ["A"], "x_in": [1], "y_in": [2]}, {"radius": 1}, "trajectories"),
        (np.zeros((2, 3)), {"radius": 1}, "trajectories"),
        (np.zeros((2, 3, 2)), {"radius": 1}, "trajectories"),
        (np.zeros((2, 3, 2)), {"radius": 1, "time": [0]}, "time"),
        ({"A": EAST}, {"radius": 1, "time": [0, 1]}, "time"),
        ({"A": EAST}, {"radius": 1, "between": "quintic"}, "between"),
        ({"A": EAST}, {"radius": 1, "map": 3}, "map"),
        ({"A": EAST}, {"footprint": [[(0, 0), (1, 0), (0, 1)], [(0, 0), (1, 0), (0, 1)]]}, "footprint"),
    ],
)
def test_wrong_arguments_are_named(given, options, where):
    with pytest.raises(exactvo.ArgumentError) as caught:
        exactvo.check(given, **options)
    assert caught.value.where == where


def test_tables_are_read_as_csv_is(tmp_path):
    """Names, units, frames and quaternions: the same reader answers for both, and notes the same."""
    rows = [(0, "A", 0, 0), (500, "A", 250, 0), (1000, "A", 500, 100)]
    turned = [(0, 0, 0, 0), (0, 0, 1, 1), (0, 0, 1, 0)]
    tables = [
        ("t_ms,id,x_mm,y_mm", rows, {}, 'read by their names: "t_ms" in ms, "x_mm" in mm, "y_mm" in mm'),
        ("Time [ms],robot,X (cm),Y (cm)", rows, {}, 'read by their names: "Time [ms]" in ms, "X (cm)" in cm, "Y (cm)" in cm'),
        ("frame,id,x,y", rows, {"frame_rate": 25, "scale": 0.001}, None),
        ("frame,id,x,y", rows, {}, "times are frames, since no frame rate is known: one frame counts as 1 s (`frame_rate`)"),
        ("t,id,x,y", rows, {"frame_rate": 25}, "`frame_rate` has no effect: the file has times, and no numbers of frames"),
        ("t,id,x,y,qx,qy,qz,qw", [(*row, *q) for row, q in zip(rows, turned)], {}, None),
        ("t,id,x_cm,y_cm,vx,vy", [(*row, 1, 1) for row in rows], {}, '"vx" and "vy" are left out, since their names do not state the unit (vx_mm_s, "vx [cm/s]")'),
    ]
    footprint = [(0, -0.01), (0.1, 0), (0, 0.01)]
    for names, written, options, note in tables:
        path = tmp_path / "table.csv"
        path.write_text("\n".join([names, *(",".join(map(str, row)) for row in written)]) + "\n")
        table = {name: [row[k] for row in written] for k, name in enumerate(names.split(","))}
        theirs, ours = (exactvo.check(given, footprint=footprint, **options) for given in (path, table))
        assert ours.speeds == theirs.speeds and ours.bodies[0].end == theirs.bodies[0].end, names
        assert ours.notes[: len(theirs.notes)] == theirs.notes and (note is None or note in ours.notes), names
    for names in (["t", "id", "x", "x_mm", "y"], ["t", "id", "X", "x", "y"]):
        with pytest.raises(exactvo.DataError, match="header"):
            exactvo.check({name: [0] for name in names}, radius=1)
    with pytest.raises(exactvo.DataError, match="no row"):
        exactvo.check({"A": np.zeros((0, 3))}, radius=1)


def test_bad_rows_are_named(tmp_path):
    back, second_place, second_heading = [(1, 0, 0), (0, 1, 0)], [(0, 0, 0), (0, 1, 0)], [(0, 0, 0, 0), (0, 0, 0, 1)]
    for rows, code in (([(0, 0, 0), (1, np.nan, 0)], "E_NOT_FINITE"), *((bad, "E_RANGE") for bad in (back, second_place, second_heading))):
        with pytest.raises(exactvo.DataError) as caught:
            exactvo.check({"A": rows}, radius=1)
        assert (caught.value.code, caught.value.where) == (code, "row 2")
    with pytest.raises(exactvo.MissingFileError):
        exactvo.check(tmp_path / "missing.csv", radius=1)
    assert "csv" in exactvo.collisions.trajectory_formats()


def test_rows_without_an_owner_are_refused():
    columns = {"t": [0, 0, 1, 1], "x": [0, 5, 10, 5], "y": [0, -5, 0, 5]}
    with pytest.raises(exactvo.ArgumentError, match="a column id"):
        exactvo.check(columns, radius=0.25)
    assert exactvo.check(dict(columns, name=["a", "b", "a", "b"]), radius=0.25).overlaps == 1
    for nobody in (None, float("nan")):
        with pytest.raises(exactvo.ArgumentError, match="an id in every row"):
            exactvo.check(dict(columns, id=["a", "b", nobody, "b"]), radius=0.25)


def test_footprints_that_turn_are_decided_between_rows():
    box = np.array([(-0.5, -0.5), (1, -0.5), (1, 0.5), (-0.5, 0.5)])
    turning = {"A": np.array([(0, 0, 0, 0), (1, 0, 0, 1.6)])}  # t, x, y, theta
    wall = [exactvo.Wall([(-3, 1.08), (3, 1.08)])]  # beyond both poses, and within the swing of a corner
    answer = exactvo.check(turning, footprint=box, map=wall)
    assert answer.overlaps == 1 and not answer.clear and 0.3 < answer.events[0].first[0] < answer.events[0].last[1] < 1
    assert exactvo.check(turning, footprint=box, map=wall, between="none").clear
    with pytest.raises(exactvo.DataError, match="cubics"):
        exactvo.check(turning, footprint=box, between="cubic")
    # Two corners that meet tip to tip while both turn, to a rounding.
    tips = np.array([(-3, 0), (0, -3), (3, 0), (0, 3)])
    open_answer = exactvo.check({"A": [(0, 0, 0, -0.5), (1, 0, 0, 0.5)], "B": [(0, 6, 0, -0.5), (1, 6, 0, 0.5)]}, footprint=tips, near=0)
    assert open_answer.overlaps == 0 and open_answer.open == 1 and not open_answer.clear
    assert open_answer.events[0].kind == "close"
