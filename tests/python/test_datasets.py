# SPDX-License-Identifier: GPL-3.0-or-later
import json
import pickle

import numpy as np
import pytest

import exactvo
from exactvo import datasets

BOWTIE = "POLYGON((0 0, 4 4, 4 0, 0 4, 0 0))\n"
SQUARE = "POLYGON((10 0, 12 0, 12 2, 10 2, 10 0))\n"


@pytest.fixture
def floor(source):
    return source / "datasets/data/office/floor.geojson"


def test_a_floor_is_read_in_metres(floor):
    file = datasets.read(floor)
    assert len(file) == 46 and file.obstacles.bounds == (0, 0, 30, 20) and file.counts["done"] == 46
    assert file.properties and isinstance(file.properties[0], dict)
    assert any("metres" in note for note in file.notes)
    assert file[0] == file.obstacles[0] and file.__geo_interface__["type"] == "GeometryCollection"


def test_a_bad_obstacle_is_named_by_place_and_code(tmp_path):
    path = tmp_path / "map.wkt"
    path.write_text(SQUARE + BOWTIE)
    with pytest.raises(exactvo.DataError) as caught:
        datasets.read(path)
    error = caught.value
    assert error.code == "E_SELF_INTERSECTION" and error.file == str(path) and "ring 0" in error.where
    file = datasets.read(path, skip_invalid=True)
    assert len(file) == 1 and [e.code for e in file.rejected] == ["E_SELF_INTERSECTION"]
    assert file.findings[-1].code == "E_SELF_INTERSECTION" and not file.findings[-1].repaired
    repaired = datasets.read(path, repair=True)
    assert len(repaired) == 3 and repaired.counts["repaired"] == 1


def test_a_polygon_is_repaired_exactly():
    bowtie = np.array([(0, 0), (4, 4), (4, 0), (0, 4)], dtype=float)
    done = datasets.repair(bowtie)
    assert done and done.recombined and done.moved == 0.0 and len(done.polygons) == 2
    assert done.after["area"] == 8.0 and done.problems[0].code == "E_SELF_INTERSECTION"
    assert not datasets.repair([(0, 0), (1, 1), (2, 2)]) and datasets.repair([(0, 0), (1, 1), (2, 2)]).refused == "E_ZERO_AREA"
    assert datasets.repair([(0, 0), (1, float("nan")), (2, 2)]).refused == "E_NOT_FINITE"
    with_hole = datasets.repair([[(0, 0), (4, 0), (4, 4), (0, 4)], [(1, 1), (1, 2), (2, 2), (2, 1)]])
    assert len(with_hole.polygons[0].holes) == 1 and not with_hole.recombined
    with pytest.raises(exactvo.ArgumentError):
        datasets.repair(np.zeros((3, 3)))


@pytest.mark.parametrize("suffix", [".wkt", ".geojson", ".gpkg", ".fgb", ".csv"])
def test_obstacles_come_back_from_a_file(tmp_path, suffix):
    shapes = exactvo.obstacles([np.array([(0, 0), (4, 0), (4, 4.5), (0, 4)]), exactvo.Wall([(5, 5), (6, 7)])], ids=["a", "b"])
    lost = datasets.write(tmp_path / ("map" + suffix), shapes)
    again = datasets.read(tmp_path / ("map" + suffix))
    assert list(again.obstacles) == list(shapes)
    assert bool(lost) == (suffix == ".wkt")
    if not lost:
        assert [p["id"] for p in again.properties] == ["a", "b"]


def test_the_program_converts_to_the_same_bytes(program, floor, tmp_path):
    program("convert", floor, tmp_path / "theirs.geojson")
    datasets.convert(floor, tmp_path / "ours.geojson")
    assert (tmp_path / "ours.geojson").read_bytes() == (tmp_path / "theirs.geojson").read_bytes()


def test_the_program_generates_the_same_obstacles(program, tmp_path):
    program("generate", "star", "--seed", 3, "--count", 5, "--out", tmp_path / "stars.wkt")
    theirs = datasets.read(tmp_path / "stars.wkt")
    assert list(datasets.generate("star", 5, seed=3)) == list(theirs.obstacles)


def test_a_batch_is_the_program_s(program, tmp_path):
    (tmp_path / "maps").mkdir()
    (tmp_path / "maps" / "a.wkt").write_text(SQUARE + BOWTIE)
    (tmp_path / "maps" / "b.wkt").write_text("nonsense")
    shares = []
    summary = datasets.batch(tmp_path / "maps", tmp_path / "ours", write=["geojson"], jobs=1, progress=lambda s: shares.append(s))
    program("batch", tmp_path / "maps", "--out", tmp_path / "theirs", "--jobs", 1, "--write", "measurements,geojson")
    theirs = json.loads((tmp_path / "theirs" / "summary.json").read_text())
    assert summary.complete and summary.files.read == 2 and summary.obstacles.rejected == {"E_SELF_INTERSECTION": 1}
    assert summary.obstacles_out == 1 and theirs["done"] == summary.obstacles.done
    for name in ("obstacles", "pieces", "hulls", "ellipses", "facades"):  # all but the command line in their first line
        ours, printed = ((tmp_path / who / f"{name}.geojson").read_bytes().split(b"\n", 1) for who in ("ours", "theirs"))
        assert ours[1] == printed[1] and len(ours[1]) > 100
    again = datasets.batch([tmp_path / "maps"], tmp_path / "ours", write=["geojson"], jobs=1, resume=True)
    assert again == summary
    with pytest.raises(exactvo.DataError) as caught:
        datasets.batch([tmp_path / "maps"], tmp_path / "ours", write=["pictures"], jobs=1, resume=True)
    assert caught.value.code == "E_OTHER_RUN"
    with pytest.raises(exactvo.MissingFileError):
        datasets.batch(tmp_path / "absent", tmp_path / "more")


def test_wkt_text_is_parsed():
    file = datasets.parse_wkt(SQUARE)
    assert file[0].outer.tolist() == [[10, 0], [12, 0], [12, 2], [10, 2]]
    with pytest.raises(exactvo.DataError) as caught:
        datasets.parse_wkt("POLYGON((0 0, 1 x))")
    assert caught.value.code in ("E_NUMBER", "E_FORMAT_SYNTAX")


@pytest.mark.parametrize(
    "call, where",
    [
        (lambda path: datasets.read(path, format="geojsn"), "format"),
        (lambda path: datasets.read(path, units="feet"), "units"),
        (lambda path: datasets.read(path, unknown="wall"), "unknown"),
        (lambda path: datasets.read(path, cell_size=-1), "cell_size"),
        (lambda path: datasets.generate("stars"), "kind"),
        (lambda path: datasets.batch(path, path.parent / "out", write=["geojsn"]), "write"),
        (lambda path: datasets.repair([]), "rings"),
    ],
)
def test_a_wrong_argument_is_named(floor, call, where):
    with pytest.raises(exactvo.ArgumentError) as caught:
        call(floor)
    assert caught.value.where == where


def test_errors_name_arguments_and_no_options_of_the_program(tmp_path):
    mystery = tmp_path / "mystery.xyz"
    mystery.write_text("abc\n")
    with pytest.raises(exactvo.DataError, match="name it with `format`: wkt") as caught:
        exactvo.datasets.read(mystery)
    assert "`format`" in caught.value.expected and "--" not in str(caught.value)
    with pytest.raises(exactvo.DataError, match="name it with `format`: ") as caught:
        exactvo.check(mystery, radius=0.1)
    assert "--" not in str(caught.value)
    table = tmp_path / "t.csv"
    table.write_text("t,id,x_in,y_in\n0,A,0,0\n")
    with pytest.raises(exactvo.DataError, match="`scale` says the metres") as caught:
        exactvo.check(table, radius=0.1)
    assert "--" not in str(caught.value)
    table.write_text("0 1 0 0\n1 1 1 0\n")
    (note,) = exactvo.check(table, radius=0.1).notes
    assert note.endswith("one frame counts as 1 s (`frame_rate`)")
    walls = tmp_path / "walls.wkt"
    walls.write_text("LINESTRING (0 0, 1 0)\n")
    exactvo.datasets.batch(walls, tmp_path / "batch", progress=lambda done: False)
    with pytest.raises(exactvo.DataError, match="another `out`, or an empty one") as caught:
        exactvo.datasets.batch(walls, tmp_path / "batch", repair=True, resume=True)
    assert "--" not in str(caught.value)


def test_files_that_cannot_be_used_are_refused(tmp_path):
    with pytest.raises(FileNotFoundError):
        datasets.read(tmp_path / "absent.geojson")
    (tmp_path / "what.xyz").write_text("?")
    with pytest.raises(exactvo.DataError) as caught:
        datasets.read(tmp_path / "what.xyz")
    assert caught.value.code == "E_FORMAT_UNKNOWN"
    with pytest.raises(exactvo.DataError) as caught:
        datasets.write(tmp_path / "what.xyz" / "map.wkt", [np.eye(3, 2)])
    assert caught.value.code == "E_FILE_UNWRITABLE"
    with pytest.raises(exactvo.DataError) as caught:
        datasets.write(tmp_path / "map.docx", [np.eye(3, 2)])
    assert caught.value.code == "E_FORMAT_UNKNOWN"


def test_files_are_pickled(floor):
    file = datasets.read(floor)
    again = pickle.loads(pickle.dumps(file))
    assert again.obstacles == file.obstacles and again.properties == file.properties
