"""Works out offsets with shapely and compares them with outlines made elsewhere.

Standard input: a JSON list of cases. A case has `contour` and `outlines`, as lists of elements [x0, y0, x1, y1] or
[x0, y0, x1, y1, cx, cy, sense] (sense 1 counter-clockwise, -1 clockwise; equal ends are a full circle); `by`, mm, positive
to grow; and `mitre`, 0 for round corners, else the limit of sharp ones.
Standard output: a JSON list with, for each case, both areas, both extents, how many pieces each has, the area in
one and not in the other; how far ours are off the distance, how far they miss what shapely has at the distance, and how
far the boundaries are apart, each at the most.
"""

import json
import math
import sys

import numpy
import shapely

# How far an arc may stand off its chords, mm.
SAGITTA = 2e-5
# Between two samples of a straight, mm.
STEP = 0.05
# What is at the distance, mm.
TRUE = 3e-4


def nodes(elements):
    """The ring as many short lines; arcs are drawn through points on their circle."""
    points = []
    for e in elements:
        points.append((e[0], e[1]))
        if len(e) == 4:
            continue
        x0, y0, x1, y1, cx, cy, sense = e
        radius = math.hypot(x0 - cx, y0 - cy)
        start = math.atan2(y0 - cy, x0 - cx)
        turn = (math.atan2(y1 - cy, x1 - cx) - start) * sense % (2 * math.pi)
        if (x0, y0) == (x1, y1):
            turn = 2 * math.pi
        if radius == 0:
            continue
        step = 2 * math.acos(max(0.0, 1 - SAGITTA / radius))
        count = max(1, math.ceil(turn / step))
        for n in range(1, count):
            angle = start + sense * turn * n / count
            points.append((cx + radius * math.cos(angle), cy + radius * math.sin(angle)))
    return points


def region(outlines):
    """What lies inside the rings run counter-clockwise and outside those run clockwise."""
    rings = [shapely.LinearRing(points) for points in map(nodes, outlines) if len(points) > 2]
    grown = shapely.union_all([shapely.Polygon(ring) for ring in rings if ring.is_ccw])
    holes = shapely.union_all([shapely.Polygon(ring) for ring in rings if not ring.is_ccw])
    return shapely.difference(grown, holes)


def samples(geometry):
    return shapely.points(shapely.get_coordinates(shapely.segmentize(geometry.boundary, STEP)))


def distances(points, geometry):
    """How far points are from a boundary."""
    parts = []
    for line in shapely.get_parts(geometry.boundary):
        at = shapely.get_coordinates(line)
        parts.append(numpy.stack([at[:-1], at[1:]], axis=1))
    tree = shapely.STRtree(shapely.linestrings(numpy.concatenate(parts)))
    return tree.query_nearest(points, return_distance=True, all_matches=False)[1]


def farthest(points, geometry):
    if len(points) == 0 or geometry.is_empty:
        return 0.0 if len(points) == 0 else 1e9
    return float(distances(points, geometry).max())


def pieces(geometry):
    """Parts and holes that are more than a trace."""
    parts = [part for part in shapely.get_parts(geometry) if part.area > 1e-4]
    holes = [hole for part in parts for hole in part.interiors if shapely.Polygon(hole).area > 1e-4]
    return [len(parts), len(holes)]


def judged(case):
    contour = shapely.Polygon(nodes(case["contour"]))
    by = case["by"]
    # As fine about the corners as the contour itself.
    quarter = max(8, math.ceil(math.pi / 4 / math.acos(1 - min(0.5, SAGITTA / abs(by)))))
    style = {"join_style": "mitre", "mitre_limit": case["mitre"]} if case["mitre"] else {"join_style": "round"}
    theirs = contour.buffer(by, quad_segs=quarter, **style)
    ours = region(case["outlines"])
    mine, others = samples(ours), samples(theirs)
    off = abs(distances(mine, contour) - abs(by)).max() if len(mine) else 0.0
    # A buffer leaves out what is less than a hundredth of the distance deep, so not all of it is at the distance.
    true = others[abs(distances(others, contour) - abs(by)) < TRUE] if len(others) else others
    return {
        "valid": bool(contour.is_valid),
        "areas": [ours.area, theirs.area],
        "extents": [[] if it.is_empty else list(it.bounds) for it in (ours, theirs)],
        "pieces": [pieces(ours), pieces(theirs)],
        "apart": ours.symmetric_difference(theirs).area,
        "length": theirs.length,
        "off": float(off),
        "missed": farthest(true, ours),
        "farthest": max(farthest(mine, theirs), farthest(others, ours)),
    }


print(json.dumps([judged(case) for case in json.load(sys.stdin)]))
