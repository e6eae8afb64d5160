#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks the certificates that `exactvo route --json` prints, in rational numbers and with nothing of ExactVO.

    exactvo route map.wkt --from 1,1 --to 9,9 --radius 0.4 --json | python3 check_route.py
    python3 check_route.py answers.jsonl        # exit status 1 if one is not proven, 2 if there is none
A number in JSON is a double and thereby a rational number; a coordinate that is no double stands as "numerator/
denominator" beside its rounded value. Obstacles stand in the first certificate of a file. What is claimed:
    route       every piece between two points keeps a radius away from every edge, and the start is in no polygon
    separated   each side of a closed polygon lies on an edge or is shorter than two radii, so that the disc's centre
                cannot cross it, and exactly one of start and goal lies inside (by the parity of crossings)
    blocked     the start or goal lies in a polygon, or nearer than a radius to an edge"""
import json
import math
import re
import sys
from fractions import Fraction

KINDS = ("route", "separated", "blocked")


def number(x):
    if type(x) not in (int, float):
        raise ValueError("not a number: %r" % (x,))
    return Fraction(float(x))


def index(x):
    if type(x) is not int or x < 0:
        raise ValueError("not a count: %r" % (x,))
    return x


def coordinate(near, text):  # the double is one of the two next to the fraction
    if text and not re.fullmatch("-?[0-9]+(/[0-9]+)?", text):
        raise ValueError("not a fraction: %r" % text)
    exact = Fraction(text or near)
    if not math.nextafter(near, -math.inf) < exact < math.nextafter(near, math.inf):
        raise ValueError("a fraction that is not what is rounded: %r" % text)
    return exact


def point(p, sizes=(2, 4)):
    rounded = tuple(number(x) for x in p[:2])
    if type(p) is not list or len(p) not in sizes:
        raise ValueError("not a point: %r" % (p,))
    return rounded if len(p) == 2 else tuple(coordinate(float(n), t) for n, t in zip(rounded, p[2:]))


def minus(a, b):
    return a[0] - b[0], a[1] - b[1]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1]


def turn(a, b, p):
    (ux, uy), (vx, vy) = minus(b, a), minus(p, a)
    return ux * vy - uy * vx


def square_to(p, edge):  # the squared distance
    a, b = edge
    along, to = minus(b, a), minus(p, a)
    length = dot(along, along)
    share = min(max(dot(to, along) / length, 0), 1) if length else 0
    rest = to[0] - share * along[0], to[1] - share * along[1]
    return dot(rest, rest)


def come_nearer(s, t, square):
    (a, b), (c, d) = s, t
    cross = turn(a, b, c) * turn(a, b, d) < 0 and turn(c, d, a) * turn(c, d, b) < 0
    return cross or min(square_to(a, t), square_to(b, t), square_to(c, s), square_to(d, s)) < square


def is_inside(p, edges):
    """Whether a ray from p to the right crosses an odd number of edges."""
    up = ((a, b) for a, b in edges if (a[1] > p[1]) != (b[1] > p[1]))
    return sum((turn(a, b, p) > 0) == (b[1] > a[1]) for a, b in up) % 2 == 1


class Obstacle:
    def __init__(self, data):
        self.is_solid = "polygon" in data
        if self.is_solid == ("polyline" in data):
            raise ValueError("not an obstacle: %r" % data)
        rings = [data["polygon"]] + listed(data.get("holes", [])) if self.is_solid else [data["polyline"]]
        rings = [[point(p, (2,)) for p in listed(ring)] for ring in rings]
        if any(len(ring) < 2 + self.is_solid for ring in rings):
            raise ValueError("too few points: %r" % data)
        self.edges = [e for ring in rings for e in zip(ring, ring[1:] + ring[:1] if self.is_solid else ring[1:])]


def listed(x):
    if type(x) is not list:
        raise ValueError("not a list: %r" % (x,))
    return x


def edge_of(obstacles, c):
    return obstacles[index(c["obstacle"])].edges[index(c["edge"])]


def too_near(piece, radius, obstacles):
    (ax, ay), (bx, by) = piece
    x0, x1, y0, y1 = min(ax, bx) - radius, max(ax, bx) + radius, min(ay, by) - radius, max(ay, by) + radius
    for i, obstacle in enumerate(obstacles):
        for k, ((cx, cy), (dx, dy)) in enumerate(obstacle.edges):
            if max(cx, dx) < x0 or min(cx, dx) > x1 or max(cy, dy) < y0 or min(cy, dy) > y1:
                continue
            if come_nearer(piece, ((cx, cy), (dx, dy)), radius * radius):
                return "nearer than the radius to edge %d of obstacle %d" % (k, i)
    return ""


def not_free(p, radius, obstacles):
    inside = any(o.is_solid and is_inside(p, o.edges) for o in obstacles)
    return "inside an obstacle" if inside else too_near((p, p), radius, obstacles)


def check(c, obstacles):
    """Empty where the certificate proves its claim, else what is wrong."""
    radius, start, goal = number(c["radius"]), point(c["start"], (2,)), point(c["goal"], (2,))
    if radius <= 0:
        return "no radius"
    if c["kind"] == "route":
        points = [point(p) for p in listed(c["points"])]
        if points[0] != start or points[-1] != goal:
            return "not from the start to the goal"
        pieces = list(zip(points, points[1:]))
        length = sum(float(dot(minus(b, a), minus(b, a))) ** 0.5 for a, b in pieces)
        if abs(c["length"] - length) > 2**-40 * length or not 0 <= c["lower_bound"] <= length * (1 + 2**-30):
            return "another length"
        return not_free(start, radius, obstacles) or "".join(too_near(p, radius, obstacles) for p in pieces)
    if c["kind"] == "separated":
        ends = [point(q["point"]) for q in c["chain"]]
        sides = list(zip(ends, ends[1:] + ends[:1]))
        for k, ((p, q), side) in enumerate(zip(sides, c["chain"])):
            edge = edge_of(obstacles, side)
            if square_to(p, edge) != 0 or (not side["gap"] and square_to(q, edge) != 0):
                return "side %d: not on its edge" % k
            if side["gap"] and dot(minus(q, p), minus(q, p)) >= 4 * radius * radius:
                return "side %d: a gap of two radii or more" % k
        if is_inside(start, sides) == is_inside(goal, sides):
            return "start and goal are on one side"
        return not_free(start, radius, obstacles) or not_free(goal, radius, obstacles)
    if c["kind"] != "blocked":
        return "of no known kind"
    end, by = {"start": start, "goal": goal}[c["end"]], obstacles[index(c["obstacle"])]
    inside = by.is_solid and is_inside(end, by.edges)
    proven = inside if c["inside"] else square_to(end, edge_of(obstacles, c)) < radius * radius
    return "" if proven else "not inside" if c["inside"] else "far enough away"


def agrees(beside, c):
    """Whether what stands beside a certificate is what it says (docs/guide/routes.md lists what nobody compares)."""
    route, gaps = c["kind"] == "route", [q for q in c.get("chain", []) if q["gap"]]
    said = {"status": c["kind"], "length": None, "lower_bound": None, "points": None, "needed_width": 2 * c["radius"]}
    said.update((key, c[key]) for key in ("radius", "start", "goal") + ("length", "lower_bound") * route)
    said.update({"points": [p[:2] for p in c["points"]]} if route else {})
    widest, gap_list, end = beside.get("widest_radius"), beside.get("gaps"), beside.get("blocked")
    return (all(beside[key] == value for key, value in said.items() if key in beside)
            and ("widest_radius" not in beside or (number(widest) >= number(c["radius"])) == route)
            and ("gaps" not in beside or [g["from"] for g in listed(gap_list)] == [q["point"][:2] for q in gaps])
            and ("blocked" not in beside or all(end[key] == c[key] for key in ("end", "inside"))))


def once(pairs):
    if len(dict(pairs)) < len(pairs):
        raise ValueError("a member twice")
    return dict(pairs)


def values_in(text):  # one value, or one a line
    try:
        return [json.loads(text, object_pairs_hook=once)]
    except (RecursionError, ValueError):
        return [line for line in text.splitlines() if line.strip()]


def main():
    obstacles, count, wrong = None, 0, 0
    text = open(sys.argv[1], encoding="utf-8-sig").read() if len(sys.argv) > 1 else sys.stdin.read().lstrip("\ufeff")
    pending = values_in(text)[::-1]
    while pending:
        answer, why = pending.pop(), ""
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
            why = check(c, obstacles) or ("" if c is answer or agrees(answer, c) else "of another answer")
        except (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError) as error:
            why = "not a certificate: %r" % error
        count, wrong = count + 1, wrong + bool(why)
        print("%d: not proven: %s\n" % (count, why[:200]) if why else "", end="")
    print("%d certificates, %d proven" % (count, count - wrong))
    sys.exit(2 if count == 0 else bool(wrong))


main()
