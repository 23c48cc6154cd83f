// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/oracle/decomp/partition/checker.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>

namespace tests {

namespace {

using decomp::mesh::TriMesh;
using decomp::part::Assembly;
using decomp::part::Part;
using Point = std::array<double, 3>;

Point exact(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

Eigen::AlignedBox3d box_of(const TriMesh& mesh) {
    Eigen::AlignedBox3d out;
    for (const auto& t : mesh.triangles) {
        for (const auto v : t) {
            out.extend(mesh.points[v]);
        }
    }
    return out;
}

/// Sum of signed tets over the origin.
double enclosed(const TriMesh& mesh) {
    long double sum = 0;
    for (const auto& t : mesh.triangles) {
        sum += mesh.points[t[0]].cross(mesh.points[t[1]]).dot(mesh.points[t[2]]);
    }
    return static_cast<double>(sum / 6);
}

/// The angle that a mesh fills, seen from a point, over 4 pi: 1 inside, 0 outside (van Oosterom and
/// Strackee 1983).
double winding(const TriMesh& mesh, const Eigen::Vector3d& point) {
    double sum = 0;
    for (const auto& t : mesh.triangles) {
        const Eigen::Vector3d a = mesh.points[t[0]] - point;
        const Eigen::Vector3d b = mesh.points[t[1]] - point;
        const Eigen::Vector3d c = mesh.points[t[2]] - point;
        const double la = a.norm();
        const double lb = b.norm();
        const double lc = c.norm();
        sum += 2 * std::atan2(a.dot(b.cross(c)),
                              la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return sum / (4 * std::numbers::pi);
}

void check_surface(const Part& part, std::set<Fault>& faults) {
    std::map<std::pair<Point, Point>, int> directed;
    for (const auto& t : part.mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            ++directed[{exact(part.mesh.points[t.at(k)]),
                        exact(part.mesh.points[t.at((k + 1) % 3)])}];
        }
    }
    for (const auto& [edge, count] : directed) {
        const auto back = directed.find({edge.second, edge.first});
        const int reverse = back == directed.end() ? 0 : back->second;
        if (count + reverse != 2 && count != reverse) {
            faults.insert(Fault::Open);
        } else if (count != reverse) {
            faults.insert(Fault::Misoriented);
        }
    }
    if (!(enclosed(part.mesh) > 0)) {
        faults.insert(Fault::Misoriented);
    }
}

/// Shells that enclose something; voids are no bodies.
int bodies(const TriMesh& mesh) {
    std::vector<std::size_t> parent(mesh.points.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&](std::size_t i) {
        while (parent[i] != i) {
            i = parent[i] = parent[parent[i]];
        }
        return i;
    };
    for (const auto& t : mesh.triangles) {
        parent[root(t[0])] = root(t[1]);
        parent[root(t[1])] = root(t[2]);
    }
    std::map<std::size_t, TriMesh> shells;
    for (const auto& t : mesh.triangles) {
        TriMesh& shell = shells[root(t[0])];
        shell.points = mesh.points;
        shell.triangles.push_back(t);
    }
    return static_cast<int>(std::count_if(shells.begin(), shells.end(),
                                          [](const auto& s) { return enclosed(s.second) > 0; }));
}

using Corners = std::array<Point, 3>;

Corners rotated(Corners c) {
    std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
    return c;
}

void check_twins(const Assembly& assembly, std::set<Fault>& faults) {
    using Cap = std::pair<std::array<int, 2>, Corners>;
    std::map<Cap, int> caps;
    for (std::size_t i = 0; i < assembly.parts.size(); ++i) {
        const Part& part = assembly.parts[i];
        for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
            if (part.sources[t].plane < 0) {
                continue;
            }
            const auto& tri = part.mesh.triangles[t];
            const int other = part.sources[t].neighbour;
            const Corners own{exact(part.mesh.points[tri[0]]), exact(part.mesh.points[tri[1]]),
                              exact(part.mesh.points[tri[2]])};
            const int self = static_cast<int>(i);
            const bool first = self < other;
            const Corners seen = rotated(first ? own : Corners{own[0], own[2], own[1]});
            caps[{{std::min(self, other), std::max(self, other)}, seen}] += first ? 1 : -1;
        }
    }
    for (const auto& [cap, balance] : caps) {
        if (balance != 0) {
            faults.insert(Fault::Twin);
        }
    }
}

void check_planes(const Assembly& assembly, double tolerance, std::set<Fault>& faults) {
    for (const Part& part : assembly.parts) {
        for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
            const int index = part.sources[t].plane;
            if (index < 0) {
                continue;
            }
            const auto& plane = assembly.planes.at(static_cast<std::size_t>(index));
            for (const auto v : part.mesh.triangles[t]) {
                const double height =
                    (plane.normal.dot(part.mesh.points[v]) - plane.offset_mm) / plane.normal.norm();
                if (std::abs(height) > tolerance) {
                    faults.insert(Fault::NotPlanar);
                }
            }
        }
    }
}

void check_points(const Assembly& assembly, const TriMesh& shape, int points,
                  std::set<Fault>& faults) {
    // Uniform points, and points close to facets of the caps, where faults are likely.
    std::mt19937 random(7);
    const Eigen::AlignedBox3d box = box_of(shape);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Eigen::Vector3d> where;
    for (int i = 0; i < points / 2; ++i) {
        where.emplace_back(
            box.min() +
            Eigen::Vector3d(unit(random), unit(random), unit(random)).cwiseProduct(box.sizes()));
    }
    std::vector<Eigen::Vector3d> caps;
    for (const Part& part : assembly.parts) {
        for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
            const auto& tri = part.mesh.triangles[t];
            const Eigen::Vector3d& a = part.mesh.points[tri[0]];
            const Eigen::Vector3d cross =
                (part.mesh.points[tri[1]] - a).cross(part.mesh.points[tri[2]] - a);
            if (part.sources[t].plane >= 0 && cross.norm() > 1e-8 * box.diagonal().squaredNorm()) {
                const Eigen::Vector3d middle =
                    (a + part.mesh.points[tri[1]] + part.mesh.points[tri[2]]) / 3;
                caps.emplace_back(middle + 1e-4 * box.diagonal().norm() * cross.normalized());
            }
        }
    }
    std::shuffle(caps.begin(), caps.end(), random);
    caps.resize(std::min(caps.size(), static_cast<std::size_t>(points / 2)));
    where.insert(where.end(), caps.begin(), caps.end());
    for (const Eigen::Vector3d& p : where) {
        const double in_shape = winding(shape, p);
        int inside = 0;
        for (const Part& part : assembly.parts) {
            inside += winding(part.mesh, p) > 0.5 ? 1 : 0;
        }
        const int wanted = in_shape > 0.5 ? 1 : 0;
        if (inside < wanted) {
            faults.insert(Fault::Gap);
        } else if (inside > wanted) {
            faults.insert(Fault::Overlap);
        }
    }
}

}  // namespace

std::set<Fault> faults_of(const Assembly& assembly, const TriMesh& shape,
                          const CheckOptions& options) {
    std::set<Fault> faults;
    const double diagonal = box_of(shape).diagonal().norm();
    double sum = 0;
    for (const Part& part : assembly.parts) {
        check_surface(part, faults);
        if (bodies(part.mesh) != 1) {
            faults.insert(Fault::Components);
        }
        if (crosses_itself(part.mesh)) {
            faults.insert(Fault::Crossing);
        }
        sum += enclosed(part.mesh);
    }
    check_twins(assembly, faults);
    check_planes(assembly, options.planar_mm * diagonal, faults);
    check_points(assembly, shape, options.points, faults);
    const double volume = enclosed(shape);
    if (std::abs(sum - volume) > options.volume * volume) {
        faults.insert(Fault::Volume);
    }
    return faults;
}

}  // namespace tests
