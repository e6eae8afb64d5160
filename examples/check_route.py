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
import sys
from fractions import Fraction


def number(x):
    if type(x) not in (int, float):
        raise ValueError("not a number: %r" % (x,))
    return Fraction(float(x))


def point(p):
    rounded = tuple(number(x) for x in p[:2])
    if len(p) == 2:
        return rounded
    exact = tuple(Fraction(text) if text else near for text, near in zip(p[2:], rounded))
    if len(p) != 4 or any(abs(e - n) > abs(n) / 2**52 + Fraction(1, 2**1074) for e, n in zip(exact, rounded)):
        raise ValueError("a fraction that is not what is rounded: %r" % (p,))
    return exact


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
        rings = [data["polygon"]] + data.get("holes", []) if self.is_solid else [data["polyline"]]
        rings = [[point(p) for p in ring] for ring in rings]
        self.edges = [e for ring in rings for e in zip(ring, ring[1:] + ring[:1] if self.is_solid else ring[1:])]


def edge_of(obstacles, c):
    if min(c["obstacle"], c["edge"]) < 0:
        raise ValueError("a negative number of an edge")
    return obstacles[c["obstacle"]].edges[c["edge"]]


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
    radius, start, goal = number(c["radius"]), point(c["start"]), point(c["goal"])
    if radius <= 0:
        return "no radius"
    if c["kind"] == "route":
        points = [point(p) for p in c["points"]]
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
    end, by = {"start": start, "goal": goal}[c["end"]], obstacles[abs(c["obstacle"])]
    inside = by.is_solid and is_inside(end, by.edges)
    proven = inside if c["inside"] else square_to(end, edge_of(obstacles, c)) < radius * radius
    return "" if proven else "not inside" if c["inside"] else "far enough away"


def main():
    obstacles, count, wrong = None, 0, 0
    for line in filter(str.strip, open(sys.argv[1]) if len(sys.argv) > 1 else sys.stdin):
        try:
            answer = json.loads(line)
            c = answer.get("certificate", answer)
            listed, obstacles = c.get("obstacles"), None if "obstacles" in c else obstacles
            obstacles = obstacles if listed is None else [Obstacle(o) for o in listed]
            why = check(c, obstacles) or ("another status" if answer.get("status", c["kind"]) != c["kind"] else "")
        except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
            why = "not a certificate: %r" % error
        count, wrong = count + 1, wrong + bool(why)
        print("%d: not proven: %s\n" % (count, why) if why else "", end="")
    print("%d certificates, %d proven" % (count, count - wrong))
    sys.exit(2 if count == 0 else bool(wrong))


main()
