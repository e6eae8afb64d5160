#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks the certificates that `exactvo route --json` prints, in rational numbers and with nothing of ExactVO.
    python3 check_route.py [answers.jsonl]      # exit status 1 if one is not proven, 2 if there is none
A number in JSON is a double and thereby rational; what is no double stands as "numerator/denominator" beside it.
Obstacles stand in the first certificate of a file. docs/guide/routes.md says why this proves a claim:
    route       every piece between two points keeps a radius away from every edge, and the start is in no polygon
    separated   each side of a closed polygon lies on an edge or is shorter than two radii, and start and goal lie on
                different sides of it (by the parity of crossings)
    blocked     the start or goal lies in a polygon, or nearer than a radius to an edge
Radius 0 is a point. Its start and goal may lie on edges, where some direction between two of them leads out of all
polygons; on its way it touches no edge."""
import argparse, functools, json, math, re, sys
from fractions import Fraction

KINDS = ("route", "separated", "blocked")

def require(ok, what):
    if not ok:
        raise ValueError("%.200s" % (what,))
    return what

def number(x):
    return Fraction(float(require(type(x) in (int, float), x)))

def listed(x):
    return require(type(x) is list, x)

def coordinate(near, text):  # the double is one of the two next to the fraction
    exact = Fraction(require(not text or re.fullmatch("-?[0-9]+(/[0-9]+)?", text), text) or near)
    require(math.nextafter(near, -math.inf) < exact < math.nextafter(near, math.inf), text)
    return exact

def point(p, sizes=(2, 4)):
    require(len(listed(p)) in sizes, p)
    rounded = tuple(number(x) for x in p[:2])
    return tuple(coordinate(float(n), t) for n, t in zip(rounded, p[2:])) if p[2:] else rounded

def dot(a, b, c, d):  # ab.cd
    return (b[0] - a[0]) * (d[0] - c[0]) + (b[1] - a[1]) * (d[1] - c[1])

def turn(a, b, p):
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])

def square_to(p, edge):  # the squared distance
    a, b = edge
    share = min(max(dot(a, b, a, p) / dot(a, b, a, b), 0), 1) if a != b else 0
    foot = a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])
    return dot(foot, p, foot, p)

RIGHT = (Fraction(1), Fraction(0))

def height(p, d, x):  # above 0: x lies to the left of the ray from p along d
    return x[1] - p[1] if d is RIGHT else d[0] * (x[1] - p[1]) - d[1] * (x[0] - p[0])

def is_inside(p, edges, d=RIGHT):  # whether the ray from p along d crosses an odd number of edges; those that p lies on do not count
    across = ((a, b, height(p, d, b) > 0) for a, b in edges if (height(p, d, a) > 0) != (height(p, d, b) > 0))
    return sum(turn(a, b, p) != 0 and (turn(a, b, p) > 0) == left for a, b, left in across) % 2 == 1

def angle_order(u, v):  # counter-clockwise from the right
    half = [d[1] < 0 or (d[1] == 0 and d[0] < 0) for d in (u, v)]
    t = u[0] * v[1] - u[1] * v[0]
    return half[0] - half[1] or (t < 0) - (t > 0)

def between(u, v):  # a direction passed on the turn from u to v; from u to itself it is a whole turn
    t = u[0] * v[1] - u[1] * v[0]
    if t == 0:
        return (-u[0], -u[1]) if u[0] * v[0] + u[1] * v[1] > 0 else (-u[1], u[0])
    return (u[0] + v[0], u[1] + v[1]) if t > 0 else (-u[0] - v[0], -u[1] - v[1])

def open_directions(p, obstacles):  # one into each part of the free space that p, a point, lies on the border of
    ends = [e for o in obstacles for e, box in zip(o.edges, o.boxes) if holds(box, p) and square_to(p, e) == 0]
    along = sorted(((q[0] - p[0], q[1] - p[1]) for e in ends for q in e if q != p), key=functools.cmp_to_key(angle_order))
    along = [u for u, v in zip(along, along[1:] + [None]) if v is None or angle_order(u, v)]
    found = [between(u, v) for u, v in zip(along, along[1:] + along[:1])] or [RIGHT]
    return [d for d in found if not any(o.is_solid and is_inside(p, o.edges, d) for o in obstacles)]

def holds(box, p):
    return all(low <= x <= high for (low, high), x in zip(box, p))

class Obstacle:
    def __init__(self, data):
        self.is_solid = "polygon" in data
        require(self.is_solid != ("polyline" in data), data)
        rings = [data["polygon"]] + listed(data.get("holes", [])) if self.is_solid else [data["polyline"]]
        rings = [[point(p, (2,)) for p in listed(ring)] for ring in rings]
        require(all(len(ring) >= 2 + self.is_solid for ring in rings), data)
        self.edges = [e for ring in rings for e in zip(ring, ring[1:] + ring[:1] if self.is_solid else ring[1:])]
        self.boxes = [[(float(min(x)), float(max(x))) for x in zip(*e)] for e in self.edges]  # of doubles: as they are

def named(things, index):
    require(type(index) is int and index >= 0, index)
    return things[index]

def touch(p, q, a, b, p_may, q_may):  # whether pq and ab have a point in common other than an end of pq that may
    p_on, q_on = square_to(p, (a, b)) == 0, square_to(q, (a, b)) == 0
    if (p_on and not p_may) or (q_on and not q_may) or (p_on and q_on and p != q):
        return True
    return any(square_to(x, (p, q)) == 0 and not (p_may and x == p) and not (q_may and x == q) for x in (a, b))

def require_clear(p, q, radius, obstacles, p_may=False, q_may=False):
    (west, east), (south, north) = [(math.nextafter(float(min(x) - radius), -math.inf), math.nextafter(float(max(x) + radius), math.inf))
                                    for x in zip(p, q)]  # rounded outwards: most edges are outside, and doubles compare faster
    for i, obstacle in enumerate(obstacles):
        for k, ((a, b), (x, y)) in enumerate(zip(obstacle.edges, obstacle.boxes)):
            if x[1] < west or x[0] > east or y[1] < south or y[0] > north:
                continue
            across = turn(p, q, a) * turn(p, q, b) < 0 and turn(a, b, p) * turn(a, b, q) < 0
            nearest = min(square_to(p, (a, b)), square_to(q, (a, b)), square_to(a, (p, q)), square_to(b, (p, q)))
            is_near = nearest < radius * radius or (radius == 0 and touch(p, q, a, b, p_may, q_may))
            require(not across and not is_near, "too near to edge %d of obstacle %d" % (k, i))

def check(c, obstacles):
    """Raises an error where the certificate does not prove its claim."""
    kind, radius, start, goal = c["kind"], number(c["radius"]), point(c["start"], (2,)), point(c["goal"], (2,))
    require(kind in KINDS and radius >= 0, "no such kind, or no radius")
    if kind == "blocked":
        end, by = {"start": start, "goal": goal}[c["end"]], named(obstacles, c["obstacle"])
        if c["inside"]:
            return require(by.is_solid and is_inside(end, by.edges) and all(square_to(end, e) for e in by.edges), "an end that is not inside")
        distance = square_to(end, named(by.edges, c["edge"]))
        return require(distance < radius * radius or (radius == distance == 0 and not open_directions(end, obstacles)), "an end that is not blocked so")
    ways = [open_directions(p, obstacles) if radius == 0 else [RIGHT] for p in (start, goal)]
    require(all(ways) and (radius == 0 or not any(o.is_solid and is_inside(p, o.edges) for p in (start, goal) for o in obstacles)), "an end inside")
    if kind == "route":
        points = [point(p) for p in listed(c["points"])]
        require(points[0] == start and points[-1] == goal, "not from the start to the goal")
        pieces = list(zip(points, points[1:])) or [(start, goal)]
        ahead = (pieces[0][1][0] - start[0], pieces[0][1][1] - start[1])
        require(start == goal or not any(o.is_solid and is_inside(start, o.edges, ahead) for o in obstacles), "into an obstacle")
        length = sum(float(dot(p, q, p, q)) ** 0.5 for p, q in pieces)
        require(abs(c["length"] - length) <= 2**-40 * length, "another length")
        require(0 <= c["lower_bound"] <= length * (1 + 2**-30), "a bound of more than the length")
    else:
        ends, pieces = [point(q["point"]) for q in c["chain"]], [(start, start), (goal, goal)]
        sides = list(zip(ends, ends[1:] + ends[:1]))
        for (p, q), side in zip(sides, c["chain"]):
            edge, gap = named(named(obstacles, side["obstacle"]).edges, side["edge"]), side["gap"]
            require(square_to(p, edge) == 0 and (gap or square_to(q, edge) == 0), "a side that is not on its edge")
            require(not gap or dot(p, q, p, q) < 4 * radius * radius, "a gap of two radii or more")
        about = [{is_inside(p, sides, d) for d in way} for p, way in zip((start, goal), ways)]
        require(about in ([{True}, {False}], [{False}, {True}]), "start and goal are on one side, or the chain passes through one")
    for k, (p, q) in enumerate(pieces):
        may = kind == "separated"
        require_clear(p, q, radius, obstacles, may or k == 0, may or k + 1 == len(pieces))

def once(pairs):
    return require(len(dict(pairs)) == len(pairs), "a member twice") and dict(pairs)

def main():
    obstacles, count, wrong = None, 0, 0
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("answers", nargs="?", type=argparse.FileType(encoding="utf-8"), default=sys.stdin, help="by default stdin")
    text = parser.parse_args().answers.read().lstrip("\ufeff")
    try:  # one value, or one a line
        pending = [json.loads(text, object_pairs_hook=once)]
    except (RecursionError, ValueError):
        pending = [line for line in text.splitlines() if line.strip()][::-1]
    while pending:
        answer = pending.pop()
        try:
            answer = json.loads(answer, object_pairs_hook=once) if type(answer) is str else answer
            if type(answer) is list:
                pending += answer[::-1]
                continue
            c = answer if answer.get("kind") in KINDS else answer.get("certificate")
            if c is None and answer.get("status") not in KINDS:
                continue
            listing, obstacles = c.get("obstacles"), None if "obstacles" in c else obstacles
            obstacles = [Obstacle(o) for o in listed(listing)] if "obstacles" in c else obstacles
            require(obstacles is not None, "no obstacles: neither in it nor in one before it")
            check(c, obstacles)
        except (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError) as error:
            wrong += 1
            print("%d: not proven: %r" % (count + 1, error))
        count += 1
    print("%d certificate%s, %d proven" % (count, "" if count == 1 else "s", count - wrong))
    sys.exit(2 if count == 0 else bool(wrong))

main()
