//! The entities that are cut, as their numbers stand in the file; and the `dxf` crate's work, which is to make them of
//! their group codes.
//!
//! The crate alone would lose things in silence: an entity it cannot read ends its section, kinds it does not know vanish,
//! a spline's points without Z are dropped, and nothing tells the line. So `records` checks every pair first and hands
//! over, a batch at a time, only the entities that are cut, with the codes that matter and values that are what they
//! must be; and what comes back is held against what was handed over.

use dxf::Drawing;
use dxf::entities::{Entity as Parsed, EntityType};

/// An entity's numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Figure {
    Line {
        start: [f64; 2],
        end: [f64; 2],
    },
    /// An arc, counter-clockwise in its own plane, angles in degrees.
    Arc {
        centre: [f64; 2],
        radius: f64,
        from: f64,
        to: f64,
        facing: Facing,
    },
    Circle {
        centre: [f64; 2],
        radius: f64,
        facing: Facing,
    },
    /// A part of an ellipse, parameters in radians.
    Ellipse {
        centre: [f64; 2],
        major: [f64; 2],
        ratio: f64,
        from: f64,
        to: f64,
        facing: Facing,
    },
    Polyline {
        vertices: Vec<Vertex>,
        closed: bool,
        facing: Facing,
    },
    Spline(Box<Nurbs>),
    Insert(Box<Insert>),
    /// Not cut; why is told by its kind.
    Uncut(Uncut),
}

/// A vertex of a polyline, with the bulge of the way to the next: the tangent of a quarter of the arc's angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vertex {
    pub(super) at: [f64; 2],
    pub(super) bulge: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Nurbs {
    pub(super) degree: i32,
    pub(super) knots: Vec<f64>,
    pub(super) weights: Vec<f64>,
    pub(super) controls: Vec<[f64; 2]>,
    pub(super) fit_points: usize,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Insert {
    /// Which block: a number given by `records` for its name.
    pub(super) block: u32,
    pub(super) at: [f64; 2],
    pub(super) scale: [f64; 2],
    /// Degrees.
    pub(super) rotation: f64,
    pub(super) columns: i16,
    pub(super) rows: i16,
    pub(super) spacing: [f64; 2],
    pub(super) facing: Facing,
}

/// Which way an entity's plane looks.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Facing {
    /// Extrusion (0, 0, 1).
    Up,
    /// Extrusion (0, 0, −1): the entity's X is the drawing's −X.
    Down,
    /// Any other.
    Tilted,
}

/// Why an entity is not cut.
#[derive(Clone, Copy, Debug, Eq, Hash, Ord, PartialEq, PartialOrd)]
pub(super) enum Uncut {
    /// Its kind is none that is cut; the number is given by `records` for its name.
    Kind(u32),
    /// It is invisible.
    Invisible,
    /// It belongs to a sheet of paper, not to the model.
    Paper,
    /// A polyline that is a mesh.
    Mesh,
}

/// A kind of entity that is cut.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Kind {
    Line,
    Arc,
    Circle,
    Ellipse,
    LwPolyline,
    Polyline,
    Vertex,
    Spline,
    Insert,
}

/// What a code of an entity holds.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Holds {
    /// A number.
    Number,
    /// A whole number of 16 bits.
    Whole,
}

impl Kind {
    pub(super) fn named(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"LINE" => Self::Line,
            b"ARC" => Self::Arc,
            b"CIRCLE" => Self::Circle,
            b"ELLIPSE" => Self::Ellipse,
            b"LWPOLYLINE" => Self::LwPolyline,
            b"POLYLINE" => Self::Polyline,
            b"VERTEX" => Self::Vertex,
            b"SPLINE" => Self::Spline,
            b"INSERT" => Self::Insert,
            _ => return None,
        })
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Line => "LINE",
            Self::Arc => "ARC",
            Self::Circle => "CIRCLE",
            Self::Ellipse => "ELLIPSE",
            Self::LwPolyline => "LWPOLYLINE",
            Self::Polyline => "POLYLINE",
            Self::Vertex => "VERTEX",
            Self::Spline => "SPLINE",
            Self::Insert => "INSERT",
        }
    }

    /// What a code holds, if it has to do with the shape.
    pub(super) fn holds(self, code: i32) -> Option<Holds> {
        let numbers: &[i32] = match self {
            Self::Line => &[10, 20, 11, 21],
            Self::Arc => &[10, 20, 40, 50, 51, 210, 220, 230],
            Self::Circle => &[10, 20, 40, 210, 220, 230],
            Self::Ellipse => &[10, 20, 11, 21, 40, 41, 42, 210, 220, 230],
            Self::LwPolyline => &[10, 20, 42, 210, 220, 230],
            Self::Polyline => &[210, 220, 230],
            Self::Vertex => &[10, 20, 42],
            Self::Spline => &[10, 20, 40, 41, 11, 21],
            Self::Insert => &[10, 20, 41, 42, 43, 44, 45, 50, 210, 220, 230],
        };
        let wholes: &[i32] = match self {
            Self::LwPolyline | Self::Polyline | Self::Vertex => &[70],
            Self::Spline | Self::Insert => &[70, 71],
            Self::Line | Self::Arc | Self::Circle | Self::Ellipse => &[],
        };
        if numbers.contains(&code) {
            Some(Holds::Number)
        } else {
            wholes.contains(&code).then_some(Holds::Whole)
        }
    }

    /// The codes without which it has no shape.
    pub(super) fn required(self) -> &'static [i32] {
        match self {
            Self::Line => &[10, 20, 11, 21],
            Self::Arc => &[10, 20, 40, 50, 51],
            Self::Circle => &[10, 20, 40],
            Self::Ellipse => &[10, 20, 11, 21, 40],
            Self::Vertex | Self::Insert => &[10, 20],
            Self::Spline => &[71],
            Self::LwPolyline | Self::Polyline => &[],
        }
    }

    /// Whether a code tells how high it lies.
    pub(super) fn has_height(self, code: i32) -> bool {
        match self {
            Self::Line => matches!(code, 30 | 31),
            // The height of its centre does not matter, that of its axis does.
            Self::Ellipse => code == 31,
            Self::Spline | Self::Vertex => code == 30,
            _ => false,
        }
    }

    /// Whether a code may be there more than once.
    pub(super) fn repeats(self, code: i32) -> bool {
        match self {
            Self::LwPolyline => matches!(code, 10 | 20 | 42),
            Self::Spline => matches!(code, 10 | 20 | 40 | 41 | 11 | 21),
            _ => false,
        }
    }
}

/// Makes figures of a batch of entities in the text of a DXF section; as many as there are, in order. None when the
/// crate cannot read them.
pub(super) fn parse(entities: &[u8]) -> Option<Vec<(Kind, Figure)>> {
    let head: &[u8] = b"0\nSECTION\n2\nENTITIES\n";
    let tail: &[u8] = b"0\nENDSEC\n0\nEOF\n";
    let drawing =
        Drawing::load(&mut std::io::Read::chain(std::io::Read::chain(head, entities), tail)).ok()?;
    drawing.entities().map(figure).collect()
}

fn figure(entity: &Parsed) -> Option<(Kind, Figure)> {
    let xy = |p: &dxf::Point| [p.x, p.y];
    let figure = match &entity.specific {
        EntityType::Line(line) => (Kind::Line, Figure::Line { start: xy(&line.p1), end: xy(&line.p2) }),
        EntityType::Arc(arc) => {
            let (centre, facing) = (xy(&arc.center), facing(&arc.normal));
            let (from, to) = (arc.start_angle, arc.end_angle);
            (Kind::Arc, Figure::Arc { centre, radius: arc.radius, from, to, facing })
        }
        EntityType::Circle(circle) => {
            let (centre, facing) = (xy(&circle.center), facing(&circle.normal));
            (Kind::Circle, Figure::Circle { centre, radius: circle.radius, facing })
        }
        EntityType::Ellipse(ellipse) => {
            let figure = Figure::Ellipse {
                centre: xy(&ellipse.center),
                major: [ellipse.major_axis.x, ellipse.major_axis.y],
                ratio: ellipse.minor_axis_ratio,
                from: ellipse.start_parameter,
                to: ellipse.end_parameter,
                facing: facing(&ellipse.normal),
            };
            (Kind::Ellipse, figure)
        }
        EntityType::LwPolyline(polyline) => {
            let vertices = polyline.vertices.iter();
            let figure = Figure::Polyline {
                vertices: vertices.map(|v| Vertex { at: [v.x, v.y], bulge: v.bulge }).collect(),
                closed: polyline.flags & 1 != 0,
                facing: facing(&polyline.extrusion_direction),
            };
            (Kind::LwPolyline, figure)
        }
        // 16: a mesh of polygons; 64: one of faces.
        EntityType::Polyline(polyline) if polyline.flags & (16 | 64) != 0 => {
            (Kind::Polyline, Figure::Uncut(Uncut::Mesh))
        }
        EntityType::Polyline(polyline) => {
            // 16: a control point of a smoothed polyline, which the way does not touch.
            let vertices = polyline.vertices().filter(|v| v.flags & 16 == 0);
            let figure = Figure::Polyline {
                vertices: vertices.map(|v| Vertex { at: xy(&v.location), bulge: v.bulge }).collect(),
                closed: polyline.flags & 1 != 0,
                facing: facing(&polyline.normal),
            };
            (Kind::Polyline, figure)
        }
        EntityType::Spline(spline) => {
            let nurbs = Nurbs {
                degree: spline.degree_of_curve,
                knots: spline.knot_values.clone(),
                weights: spline.weight_values.clone(),
                controls: spline.control_points.iter().map(xy).collect(),
                fit_points: spline.fit_points.len(),
            };
            (Kind::Spline, Figure::Spline(Box::new(nurbs)))
        }
        EntityType::Insert(insert) => {
            let insert = Insert {
                block: 0,
                at: xy(&insert.location),
                scale: [insert.x_scale_factor, insert.y_scale_factor],
                rotation: insert.rotation,
                columns: insert.column_count,
                rows: insert.row_count,
                spacing: [insert.column_spacing, insert.row_spacing],
                facing: facing(&insert.extrusion_direction),
            };
            (Kind::Insert, Figure::Insert(Box::new(insert)))
        }
        _ => return None,
    };
    Some(figure)
}

fn facing(normal: &dxf::Vector) -> Facing {
    let flat = normal.x.abs().max(normal.y.abs()) <= 1e-9 * normal.z.abs();
    match normal.z {
        z if flat && z > 0.0 => Facing::Up,
        z if flat && z < 0.0 => Facing::Down,
        _ => Facing::Tilted,
    }
}
