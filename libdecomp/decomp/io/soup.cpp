// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/formats.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

namespace decomp::io {

namespace {

constexpr std::uint32_t kUnset = std::numeric_limits<std::uint32_t>::max();

std::uint64_t mixed(const Eigen::Vector3d& point) {
    std::uint64_t hash = 0x9E3779B97F4A7C15ULL;
    for (int axis = 0; axis < 3; ++axis) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(point[axis])) * 0xBF58476D1CE4E5B9ULL;
        hash ^= hash >> 29U;
    }
    return hash;
}

/// Twice the signed area of a, b, c in the plane.
double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// The polygon projected along the largest component of its normal (Newell), so that it runs
/// counter-clockwise.
std::vector<Eigen::Vector2d> projected(const mesh::TriMesh& mesh,
                                       const std::vector<std::uint32_t>& corners) {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    const Eigen::Vector3d origin = mesh.points[corners[0]];
    for (std::size_t i = 0; i < corners.size(); ++i) {
        normal += (mesh.points[corners[i]] - origin)
                      .cross(mesh.points[corners[(i + 1) % corners.size()]] - origin);
    }
    int drop = 0;
    normal.cwiseAbs().maxCoeff(&drop);
    int u = (drop + 1) % 3;
    int v = (drop + 2) % 3;
    if (normal[drop] < 0) {
        std::swap(u, v);
    }
    std::vector<Eigen::Vector2d> flat;
    flat.reserve(corners.size());
    for (const std::uint32_t corner : corners) {
        flat.emplace_back(mesh.points[corner][u], mesh.points[corner][v]);
    }
    return flat;
}

bool is_ear(const std::vector<Eigen::Vector2d>& flat, const std::vector<std::uint32_t>& ring,
            std::size_t i) {
    const std::size_t n = ring.size();
    const Eigen::Vector2d& a = flat[ring[(i + n - 1) % n]];
    const Eigen::Vector2d& b = flat[ring[i]];
    const Eigen::Vector2d& c = flat[ring[(i + 1) % n]];
    if (turn(a, b, c) <= 0) {
        return false;
    }
    for (const std::uint32_t other : ring) {
        const Eigen::Vector2d& p = flat[other];
        // A point in the same place as a corner is the other bank of a slit: it does not block the
        // ear.
        if (p != a && p != b && p != c && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 &&
            turn(c, a, p) >= 0) {
            return false;
        }
    }
    return true;
}

/// Cuts ears off a simple polygon. Where none is left (it crosses itself) the next corner goes.
void append_ears(mesh::TriMesh& mesh, const std::vector<std::uint32_t>& corners,
                 const std::vector<Eigen::Vector2d>& flat) {
    std::vector<std::uint32_t> ring(corners.size());
    std::iota(ring.begin(), ring.end(), 0U);
    std::size_t i = 0;
    while (ring.size() > 3) {
        const std::size_t n = ring.size();
        std::size_t tried = 0;
        for (; tried < n && !is_ear(flat, ring, (i + tried) % n); ++tried) {
        }
        i = (i + tried) % n;
        mesh.triangles.push_back(
            {corners[ring[(i + n - 1) % n]], corners[ring[i]], corners[ring[(i + 1) % n]]});
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
        i %= ring.size();
    }
    mesh.triangles.push_back({corners[ring[0]], corners[ring[1]], corners[ring[2]]});
}

}  // namespace

void merge_equal_points(mesh::TriMesh& mesh) {
    const std::size_t slots = std::bit_ceil(mesh.points.size() * 2 + 1);
    std::vector<std::uint32_t> table(slots, kUnset);
    std::vector<std::uint32_t> new_index(mesh.points.size());
    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const Eigen::Vector3d point = mesh.points[i].array() + 0.0;  // -0 + 0 is +0
        std::size_t slot = mixed(point) & (slots - 1);
        while (table[slot] != kUnset && mesh.points[table[slot]] != point) {
            slot = (slot + 1) & (slots - 1);
        }
        if (table[slot] == kUnset) {
            table[slot] = kept;
            mesh.points[kept++] = point;
        }
        new_index[i] = table[slot];
    }
    mesh.points.resize(kept);
    for (auto& triangle : mesh.triangles) {
        for (auto& corner : triangle) {
            corner = new_index[corner];
        }
    }
}

void drop_unused_points(mesh::TriMesh& mesh) {
    std::vector<std::uint32_t> new_index(mesh.points.size(), kUnset);
    for (const auto& triangle : mesh.triangles) {
        for (const auto corner : triangle) {
            new_index[corner] = 0;
        }
    }
    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        if (new_index[i] != kUnset) {
            mesh.points[kept] = mesh.points[i];
            new_index[i] = kept++;
        }
    }
    mesh.points.resize(kept);
    for (auto& triangle : mesh.triangles) {
        for (auto& corner : triangle) {
            corner = new_index[corner];
        }
    }
}

void append_polygon(mesh::TriMesh& mesh, const std::vector<std::uint32_t>& corners) {
    if (corners.size() < 3) {
        return;
    }
    if (corners.size() == 3) {
        mesh.triangles.push_back({corners[0], corners[1], corners[2]});
        return;
    }
    const std::vector<Eigen::Vector2d> flat = projected(mesh, corners);
    const std::size_t n = corners.size();
    bool fan = true;
    for (std::size_t i = 0; i < n && fan; ++i) {
        fan = turn(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) > 0;
    }
    // Every turn to the left is not enough for a star that winds twice: its fan turns back
    // somewhere.
    for (std::size_t i = 1; i + 1 < n && fan; ++i) {
        fan = turn(flat[0], flat[i], flat[i + 1]) > 0;
    }
    if (!fan) {
        append_ears(mesh, corners, flat);
        return;
    }
    for (std::size_t i = 1; i + 1 < n; ++i) {
        mesh.triangles.push_back({corners[0], corners[i], corners[i + 1]});
    }
}

}  // namespace decomp::io
