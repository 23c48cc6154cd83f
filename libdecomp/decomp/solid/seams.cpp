// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/boundary.h"

#include <algorithm>
#include <array>
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

/// The parameter of an edge at an angle about the axis, by bisection: the angle runs one way.
double parameter_at(const Surface& surface, const Edge& edge, double angle) {
    double low = edge.t0;
    double high = edge.t1;
    const double start = angle_about(surface, point_at(edge.curve, low));
    const double goal = turn_between(start, angle);
    for (int i = 0; i < 200; ++i) {
        const double middle = (low + high) / 2;
        const double here = turn_between(start, angle_about(surface, point_at(edge.curve, middle)));
        const bool before = goal > 0 ? here >= 0 && here < goal : here <= 0 && here > goal;
        (before ? low : high) = middle;
    }
    return (low + high) / 2;
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
        Edge whole = edge;
        whole.t1 = whole.t0 + std::numbers::pi;
        if (!spans(surface, whole, angle)) {
            whole.t0 = whole.t1;
            whole.t1 = edge.t1;
        }
        edge.t0 = parameter_at(surface, whole, angle);
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

}  // namespace

bool add_seam(Solid& solid, std::int32_t face, const std::vector<Path>& walk,
              const std::vector<int>& round) {
    const auto f = static_cast<std::size_t>(face);
    const Surface surface = solid.faces[f].surface;
    std::array<std::size_t, 2> rim{0, 0};
    int rims = 0;
    for (std::size_t i = 0; i < round.size(); ++i) {
        if (round[i] != 0) {
            rim.at(static_cast<std::size_t>(rims++)) = i;
        }
    }
    // Where a rim has vertices anyhow, the seam starts at one.
    std::vector<double> angles;
    for (const std::size_t i : rim) {
        for (const EdgeUse& use : solid.faces[f].loops[i]) {
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
    if (clear == angles.end()) {
        return false;
    }
    const auto start = vertex_at(solid, face, rim[0], *clear);
    const auto end = vertex_at(solid, face, rim[1], *clear);
    if (!start || !end) {
        return false;
    }
    const Eigen::Vector3d way = solid.vertices[static_cast<std::size_t>(*end)] -
                                solid.vertices[static_cast<std::size_t>(*start)];
    if (way.norm() < kShortestMm) {
        return false;
    }
    const Loop first = started_at(solid, solid.faces[f].loops[rim[0]], *start);
    const Loop second = started_at(solid, solid.faces[f].loops[rim[1]], *end);
    if (first.empty() || second.empty()) {
        return false;
    }
    const auto seam = static_cast<std::int32_t>(solid.edges.size());
    solid.edges.push_back(
        {LineCurve{solid.vertices[static_cast<std::size_t>(*start)], way.normalized()}, *start,
         *end, 0, way.norm()});
    Loop whole = first;
    whole.push_back({seam, false});
    whole.insert(whole.end(), second.begin(), second.end());
    whole.push_back({seam, true});
    std::vector<Loop> loops{whole};
    for (std::size_t i = 0; i < round.size(); ++i) {
        if (round[i] == 0) {
            loops.push_back(solid.faces[f].loops[i]);
        }
    }
    solid.faces[f].loops = std::move(loops);
    return true;
}

}  // namespace decomp::solid
