// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/boundary.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace decomp::solid {

namespace {

constexpr double kSameAngle = 1e-9;
constexpr double kClear = 1e-4;  ///< radians between a seam and any hole
constexpr double kShortestMm = 1e-6;
constexpr int kTries = 90;

using Path = std::vector<Eigen::Vector3d>;

/// How often a closed path crosses this angle about the axis.
int crossings(const Surface& surface, const Path& path, double angle) {
    int count = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const double from = angle_about(surface, path[i]);
        const double turn = turn_between(from, angle_about(surface, path[(i + 1) % path.size()]));
        const double offset = turn_between(from, angle);
        // Half open, so that a point on the angle counts once.
        count +=
            (turn > 0 && offset >= 0 && offset < turn) || (turn < 0 && offset <= 0 && offset > turn)
                ? 1
                : 0;
    }
    return count;
}

bool is_clear(const Surface& surface, const std::vector<Path>& walk, const std::vector<int>& round,
              double angle) {
    for (std::size_t i = 0; i < walk.size(); ++i) {
        if (round[i] != 0) {
            if (crossings(surface, walk[i], angle) != 1) {
                return false;
            }
            continue;
        }
        if (crossings(surface, walk[i], angle) != 0 ||
            std::any_of(walk[i].begin(), walk[i].end(), [&](const Eigen::Vector3d& p) {
                return std::abs(turn_between(angle, angle_about(surface, p))) < kClear;
            })) {
            return false;
        }
    }
    return true;
}

/// Lets a loop that uses an edge use the new half after it too.
void insert_half(Loop& loop, std::int32_t number, std::int32_t added) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
        if (loop[i].edge != number) {
            continue;
        }
        const bool reversed = loop[i].reversed;
        const auto at = loop.begin() + static_cast<std::ptrdiff_t>(i);
        loop.insert(reversed ? at : at + 1, EdgeUse{added, reversed});
        ++i;
    }
}

/// Cuts an edge in two at parameter t, everywhere it is used.
void split_edge(Solid& solid, std::int32_t number, std::int32_t vertex, double t) {
    const auto added = static_cast<std::int32_t>(solid.edges.size());
    solid.edges.push_back(solid.edges[static_cast<std::size_t>(number)]);
    solid.edges.back().from = vertex;
    solid.edges.back().t0 = t;
    solid.edges[static_cast<std::size_t>(number)].to = vertex;
    solid.edges[static_cast<std::size_t>(number)].t1 = t;
    for (Face& face : solid.faces) {
        for (Loop& loop : face.loops) {
            insert_half(loop, number, added);
        }
    }
}

/// The parameter of an edge that goes round the axis where it is at an angle about it: where it
/// crosses the half plane of that angle.
double parameter_at(const Surface& surface, const Edge& edge, double angle) {
    const AxisLine line = axis_of(surface);
    const Eigen::Vector3d u = reference_direction(line.axis);
    const Eigen::Vector3d v = line.axis.cross(u);
    const Eigen::Vector3d out = std::cos(angle) * u + std::sin(angle) * v;
    const Eigen::Vector3d square = line.axis.cross(out);
    if (const auto* straight = std::get_if<LineCurve>(&edge.curve)) {
        return square.dot(line.origin - straight->origin) / square.dot(straight->direction);
    }
    const auto& conic = std::get<EllipseCurve>(edge.curve);
    const double along = square.dot(conic.major);
    const double across = square.dot(conic.minor);
    const double spread = std::acos(
        std::clamp(square.dot(line.origin - conic.centre) / std::hypot(along, across), -1.0, 1.0));
    const double middle = std::atan2(across, along);
    const auto is_ahead = [&](double t) {
        return out.dot(point_at(edge.curve, t) - line.origin) > 0;
    };
    const double t = is_ahead(middle + spread) ? middle + spread : middle - spread;
    // Within the edge, but for rounding.
    constexpr double kRound = 2 * std::numbers::pi;
    return t - kRound * std::floor((t - edge.t0 + kSameAngle) / kRound);
}

bool spans(const Surface& surface, const Edge& edge, double angle) {
    constexpr int kPieces = 16;
    for (int i = 0; i < kPieces; ++i) {
        const double t0 = edge.t0 + (edge.t1 - edge.t0) * i / kPieces;
        const double t1 = edge.t0 + (edge.t1 - edge.t0) * (i + 1) / kPieces;
        const double from = angle_about(surface, point_at(edge.curve, t0));
        const double turn = turn_between(from, angle_about(surface, point_at(edge.curve, t1)));
        const double offset = turn_between(from, angle);
        if ((turn > 0 && offset >= 0 && offset <= turn) ||
            (turn < 0 && offset <= 0 && offset >= turn)) {
            return true;
        }
    }
    return false;
}

/// The vertex of a rim at this angle, made where there is none.
std::optional<std::int32_t> vertex_at(Solid& solid, std::int32_t face, std::size_t loop,
                                      double angle) {
    const Surface surface = solid.faces[static_cast<std::size_t>(face)].surface;
    const Loop rim = solid.faces[static_cast<std::size_t>(face)].loops[loop];
    if (rim.size() == 1 && solid.edges[static_cast<std::size_t>(rim[0].edge)].from < 0) {
        Edge& edge = solid.edges[static_cast<std::size_t>(rim[0].edge)];
        // The parameter starts anew where the seam meets the rim.
        edge.t0 = parameter_at(surface, edge, angle);
        edge.t1 = edge.t0 + 2 * std::numbers::pi;
        edge.from = edge.to = static_cast<std::int32_t>(solid.vertices.size());
        solid.vertices.push_back(point_at(edge.curve, edge.t0));
        return edge.from;
    }
    for (const EdgeUse& use : rim) {
        const Edge& edge = solid.edges[static_cast<std::size_t>(use.edge)];
        for (const std::int32_t v : {edge.from, edge.to}) {
            if (std::abs(turn_between(
                    angle, angle_about(surface, solid.vertices[static_cast<std::size_t>(v)]))) <
                kSameAngle) {
                return v;
            }
        }
    }
    for (const EdgeUse& use : rim) {
        const Edge edge = solid.edges[static_cast<std::size_t>(use.edge)];
        if (spans(surface, edge, angle)) {
            const double t = parameter_at(surface, edge, angle);
            const auto vertex = static_cast<std::int32_t>(solid.vertices.size());
            solid.vertices.push_back(point_at(edge.curve, t));
            split_edge(solid, use.edge, vertex, t);
            return vertex;
        }
    }
    return std::nullopt;
}

/// The loop turned so that it starts at this vertex.
Loop started_at(const Solid& solid, const Loop& loop, std::int32_t vertex) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Edge& edge = solid.edges[static_cast<std::size_t>(loop[i].edge)];
        if ((loop[i].reversed ? edge.to : edge.from) == vertex) {
            Loop turned = loop;
            std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(i),
                        turned.end());
            return turned;
        }
    }
    return {};
}

/// The first angle about the axis at which an edge along it is in nobody's way.
std::optional<double> clear_angle(const Solid& solid, std::size_t face,
                                  const std::vector<std::size_t>& rims,
                                  const std::vector<Path>& walk, const std::vector<int>& round) {
    const Surface& surface = solid.faces[face].surface;
    // Where a rim has vertices anyhow, the seam starts at one.
    std::vector<double> angles;
    for (const std::size_t i : rims) {
        for (const EdgeUse& use : solid.faces[face].loops[i]) {
            const std::int32_t v = solid.edges[static_cast<std::size_t>(use.edge)].from;
            if (v >= 0) {
                angles.push_back(angle_about(surface, solid.vertices[static_cast<std::size_t>(v)]));
            }
        }
    }
    for (int i = 0; i < kTries; ++i) {
        angles.push_back(turn_between(0, 2 * std::numbers::pi * i / kTries));
    }
    const auto clear = std::find_if(angles.begin(), angles.end(), [&](double angle) {
        return is_clear(surface, walk, round, angle);
    });
    return clear == angles.end() ? std::nullopt : std::optional(*clear);
}

/// An arc of a torus from one vertex to another at the same angle about the axis, over the side of
/// the tube that lies to the left of who goes round the axis, seen from outside the solid; -1
/// where they are one.
std::int32_t add_meridian(Solid& solid, const Face& face, const TorusSurface& torus,
                          std::int32_t from, std::int32_t to, int round) {
    const Eigen::Vector3d& start = solid.vertices[static_cast<std::size_t>(from)];
    const Eigen::Vector3d& end = solid.vertices[static_cast<std::size_t>(to)];
    const Eigen::Vector3d d = start - torus.centre;
    const Eigen::Vector3d out = (d - torus.axis * torus.axis.dot(d)).normalized();
    const Eigen::Vector3d normal = normal_at(torus, start) * (face.outward ? 1 : -1);
    const Eigen::Vector3d left = normal.cross(round * torus.axis.cross(out));
    EllipseCurve circle{torus.centre + torus.major_mm * out, torus.minor_mm * out,
                        torus.minor_mm * torus.axis, true};
    if (normal_at(torus, start).cross(left).dot(out.cross(torus.axis)) < 0) {
        circle.minor = -circle.minor;
    }
    const double t0 = parameter_of(circle, start);
    double t1 = parameter_of(circle, end);
    t1 += t1 < t0 ? 2 * std::numbers::pi : 0;
    if ((t1 - t0) * torus.minor_mm < kShortestMm) {
        return -1;
    }
    solid.edges.push_back({circle, from, to, t0, t1});
    return static_cast<std::int32_t>(solid.edges.size()) - 1;
}

/// A straight edge between two vertices; -1 where they are one.
std::int32_t add_line(Solid& solid, std::int32_t from, std::int32_t to) {
    const Eigen::Vector3d& start = solid.vertices[static_cast<std::size_t>(from)];
    const Eigen::Vector3d way = solid.vertices[static_cast<std::size_t>(to)] - start;
    if (way.norm() < kShortestMm) {
        return -1;
    }
    solid.edges.push_back({LineCurve{start, way.normalized()}, from, to, 0, way.norm()});
    return static_cast<std::int32_t>(solid.edges.size()) - 1;
}

/// The face gets this loop in place of those that go round its axis.
void set_outer(Face& face, const Loop& outer, const std::vector<int>& round) {
    std::vector<Loop> loops{outer};
    for (std::size_t i = 0; i < round.size(); ++i) {
        if (round[i] == 0) {
            loops.push_back(face.loops[i]);
        }
    }
    face.loops = std::move(loops);
}

std::vector<std::size_t> rims_of(const std::vector<int>& round) {
    std::vector<std::size_t> rims;
    for (std::size_t i = 0; i < round.size(); ++i) {
        if (round[i] != 0) {
            rims.push_back(i);
        }
    }
    return rims;
}

}  // namespace

bool add_seam(Solid& solid, std::int32_t face, const std::vector<Path>& walk,
              const std::vector<int>& round) {
    const auto f = static_cast<std::size_t>(face);
    const std::vector<std::size_t> rims = rims_of(round);
    const auto angle = clear_angle(solid, f, rims, walk, round);
    if (!angle) {
        return false;
    }
    const auto start = vertex_at(solid, face, rims.at(0), *angle);
    const auto end = vertex_at(solid, face, rims.at(1), *angle);
    if (!start || !end) {
        return false;
    }
    const Loop first = started_at(solid, solid.faces[f].loops[rims[0]], *start);
    const Loop second = started_at(solid, solid.faces[f].loops[rims[1]], *end);
    const Surface surface = solid.faces[f].surface;
    const auto* torus = std::get_if<TorusSurface>(&surface);
    const std::int32_t seam = torus == nullptr ? add_line(solid, *start, *end)
                                               : add_meridian(solid, solid.faces[f], *torus, *start,
                                                              *end, round[rims[0]]);
    if (first.empty() || second.empty() || seam < 0) {
        return false;
    }
    Loop whole = first;
    whole.push_back({seam, false});
    whole.insert(whole.end(), second.begin(), second.end());
    whole.push_back({seam, true});
    set_outer(solid.faces[f], whole, round);
    return true;
}

bool add_apex(Solid& solid, std::int32_t face, const std::vector<Path>& walk,
              const std::vector<int>& round) {
    const auto f = static_cast<std::size_t>(face);
    const Surface surface = solid.faces[f].surface;
    const auto* cone = std::get_if<ConeSurface>(&surface);
    const std::vector<std::size_t> rims = rims_of(round);
    const auto angle = cone == nullptr ? std::nullopt : clear_angle(solid, f, rims, walk, round);
    const auto start = angle ? vertex_at(solid, face, rims.at(0), *angle) : std::nullopt;
    if (!start) {
        return false;
    }
    Loop whole = started_at(solid, solid.faces[f].loops[rims[0]], *start);
    solid.vertices.push_back(cone->apex);
    const std::int32_t seam =
        add_line(solid, *start, static_cast<std::int32_t>(solid.vertices.size()) - 1);
    if (whole.empty() || seam < 0) {
        return false;
    }
    whole.push_back({seam, false});
    whole.push_back({seam, true});
    set_outer(solid.faces[f], whole, round);
    return true;
}

}  // namespace decomp::solid
