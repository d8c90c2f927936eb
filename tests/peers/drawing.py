"""Writes drawings with ezdxf and says where their entities go; reads and audits drawings and says the same of them.

write FILE VERSION FORMAT SEED: a drawing of random entities, each on a layer of its own.
read FILE: what is in a drawing; how many errors the audit finds.

Points are ezdxf's own: no formula of this file makes an entity of one kind out of another.
"""

import json
import math
import random
import sys

import ezdxf

POINTS = 2000


def ways(entity):
    """The points along an entity, one list for each simple part of it."""
    kind = entity.dxftype()
    if kind == "INSERT":
        for one in entity.multi_insert() if entity.mcount > 1 else [entity]:
            for part in one.virtual_entities():
                yield from ways(part)
    elif kind in ("LWPOLYLINE", "POLYLINE"):
        for part in entity.virtual_entities():
            yield from ways(part)
    elif kind == "LINE":
        yield [entity.dxf.start, entity.dxf.end]
    elif kind == "ARC":
        yield list(entity.vertices(entity.angles(POINTS)))
    elif kind == "CIRCLE":
        yield list(entity.vertices(360 * n / POINTS for n in range(POINTS + 1)))
    elif kind == "ELLIPSE":
        yield list(entity.vertices(entity.params(POINTS)))
    elif kind == "SPLINE":
        yield list(entity.construction_tool().approximate(POINTS))
    else:
        raise ValueError(kind)


def described(entity):
    parts = list(ways(entity))
    length = sum(a.distance(b) for part in parts for a, b in zip(part, part[1:]))
    every = [p for part in parts for p in part[:: max(1, len(part) // 50)] + part[-1:]]
    return {
        "kind": entity.dxftype(),
        "layer": entity.dxf.layer,
        "length": length,
        "points": [[p.x, p.y] for p in every],
    }


class Any:
    """Random entities into a layout or a block."""

    def __init__(self, seed, doc):
        self.random = random.Random(seed)
        self.doc = doc

    def number(self, low=-50.0, high=50.0):
        return self.random.uniform(low, high)

    def point(self):
        return (self.number(), self.number())

    def facing(self):
        return (0, 0, self.random.choice([1, -1]))

    def bulge(self):
        return self.random.choice([0, self.number(-3, 3), 1, -1])

    def controls(self, least):
        return [self.point() for _ in range(self.random.randint(least, 9))]

    def line(self, into, **attributes):
        into.add_line(self.point(), self.point(), dxfattribs=attributes)

    def arc(self, into, **attributes):
        start, extrusion = self.number(-400, 400), self.facing()
        sweep = self.random.choice([90, self.number(5, 355)])
        into.add_arc(self.point(), self.number(0.5, 40), start, start + sweep, dxfattribs={"extrusion": extrusion, **attributes})

    def circle(self, into, **attributes):
        into.add_circle(self.point(), self.number(0.5, 40), dxfattribs={"extrusion": self.facing(), **attributes})

    def polyline(self, into, **attributes):
        points = [(*self.point(), self.bulge()) for _ in range(self.random.randint(2, 7))]
        closed = self.random.random() < 0.5
        into.add_polyline2d(points, format="xyb", close=closed, dxfattribs={"extrusion": self.facing(), **attributes})

    def lwpolyline(self, into, **attributes):
        points = [(*self.point(), self.bulge()) for _ in range(self.random.randint(2, 7))]
        closed = self.random.random() < 0.5
        into.add_lwpolyline(points, format="xyb", close=closed, dxfattribs={"extrusion": self.facing(), **attributes})

    def ellipse(self, into, **attributes):
        start = self.number(-7, 7)
        sweep = self.random.choice([math.tau, self.number(0.1, 6.2)])
        into.add_ellipse(
            self.point(), self.point(), self.number(0.05, 1), start, start + sweep,
            dxfattribs={"extrusion": self.facing(), **attributes},
        )

    def spline(self, into, **attributes):
        degree = self.random.randint(2, 5)
        controls = self.controls(degree + 1)
        weights = [self.number(0.3, 4) for _ in controls]
        what = self.random.randint(0, 3)
        if what == 0:
            into.add_open_spline(controls, degree=degree, dxfattribs=attributes)
        elif what == 1:
            into.add_rational_spline(controls, weights, degree=degree, dxfattribs=attributes)
        elif what == 2:
            into.add_closed_spline(controls, degree=degree, dxfattribs=attributes)
        else:
            into.add_cad_spline_control_frame(self.controls(4), dxfattribs=attributes)

    def insert(self, into, **attributes):
        size = self.number(0.2, 3) * self.random.choice([1, -1])
        even = self.random.random() < 0.5
        insert = into.add_blockref(
            # ezdxf has no insert that shears, which one turned in one scaled unevenly does.
            self.random.choice(["ONE", "TWO"]) if even else "ONE",
            self.point(),
            dxfattribs={
                "xscale": size,
                "yscale": abs(size) * self.random.choice([1, -1]) if even else self.number(0.2, 3),
                "zscale": abs(size),
                "rotation": self.random.choice([0, 90, self.number(0, 360)]),
                "extrusion": self.facing(),
                **attributes,
            },
        )
        if self.random.random() < 0.4:
            insert.grid(size=(self.random.randint(1, 3), self.random.randint(1, 3)), spacing=(self.number(60, 90), self.number(60, 90)))


def write(name, version, form, seed):
    doc = ezdxf.new(version, units=4)
    any_of = Any(int(seed), doc)
    kinds = [any_of.line, any_of.arc, any_of.circle, any_of.polyline, any_of.insert]
    if version != "R12":
        kinds += [any_of.lwpolyline, any_of.ellipse, any_of.spline]
    one = doc.blocks.new("ONE", base_point=any_of.point())
    for kind in kinds:
        if kind != any_of.insert:
            kind(one, layer="0")
    two = doc.blocks.new("TWO", base_point=any_of.point())
    two.add_blockref("ONE", any_of.point(), dxfattribs={"rotation": any_of.number(0, 360), "xscale": 0.5, "yscale": 0.5, "zscale": 0.5})
    any_of.line(two, layer="0")
    space = doc.modelspace()
    for n in range(8 * len(kinds)):
        layer = f"E{n}"
        doc.layers.add(layer)
        kinds[n % len(kinds)](space, layer=layer)
    entities = [described(entity) for entity in space]
    # What stands on other layers by way of an insert stands on layer 0 in the block, and so on the insert's.
    doc.saveas(name, fmt=form)
    return {"entities": entities}


def read(name):
    doc = ezdxf.readfile(name)
    audit = doc.audit()
    return {
        "errors": [error.message for error in audit.errors + audit.fixes],
        "units": doc.header.get("$INSUNITS", 0),
        "layers": [layer.dxf.name for layer in doc.layers],
        "entities": [described(entity) for entity in doc.modelspace()],
    }


json.dump({"write": write, "read": read}[sys.argv[1]](*sys.argv[2:]), sys.stdout)
