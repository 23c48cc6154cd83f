// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/fdm/slice.h"

#include "cam/polygon/boolean.h"
#include "decomp/base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

namespace cam::fdm {

namespace {

using decomp::mesh::Triangle;
using decomp::mesh::TriMesh;
using polygon::Path;
using polygon::Paths;
using polygon::Point;

constexpr std::uint32_t kNone = ~0U;

/// A vertex on the nanometre grid.
struct GridPoint {
    std::int64_t x, y, z;
};

/// Side i of a triangle runs from corner i to corner i + 1.
struct Side {
    std::uint32_t far_end;  ///< the higher of its two vertices
    bool upward;            ///< runs from the lower to the higher vertex index
    std::uint32_t slot;     ///< 3 * triangle + i
};

/// All sides by their lower vertex: side k of vertex v is sides[first[v] + k]. A counting sort,
/// since meshes may have millions of triangles.
struct SidesByVertex {
    std::vector<std::uint32_t> first;
    std::vector<Side> sides;
};

SidesByVertex sides_by_vertex(const TriMesh& mesh) {
    const auto count = static_cast<std::uint32_t>(3 * mesh.triangles.size());
    const auto ends = [&](std::uint32_t slot) {
        const Triangle& t = mesh.triangles[slot / 3];
        return std::pair(t.at(slot % 3), t.at((slot + 1) % 3));
    };
    SidesByVertex out;
    out.first.assign(mesh.points.size() + 1, 0);
    for (std::uint32_t slot = 0; slot < count; ++slot) {
        const auto [a, b] = ends(slot);
        ++out.first[std::min(a, b) + 1];
    }
    for (std::size_t v = 0; v + 1 < out.first.size(); ++v) {
        out.first[v + 1] += out.first[v];
    }
    out.sides.resize(count);
    std::vector<std::uint32_t> next(out.first.begin(), out.first.end() - 1);
    for (std::uint32_t slot = 0; slot < count; ++slot) {
        const auto [a, b] = ends(slot);
        out.sides[next[std::min(a, b)]++] = {std::max(a, b), a < b, slot};
    }
    return out;
}

/// Element `slot` is the triangle on the other side of that side; nothing when a side has no
/// partner, with its triangle in `open_triangle`.
std::optional<std::vector<std::uint32_t>> neighbours_across_sides(const TriMesh& mesh,
                                                                  std::uint32_t& open_triangle) {
    const SidesByVertex by_vertex = sides_by_vertex(mesh);
    std::vector<std::uint32_t> across(by_vertex.sides.size(), kNone);
    const auto partners = [&](const Side& a, const Side& b) {
        return a.far_end == b.far_end && a.upward != b.upward && across[b.slot] == kNone;
    };
    for (std::size_t v = 0; v + 1 < by_vertex.first.size(); ++v) {
        const auto end = by_vertex.sides.begin() + by_vertex.first[v + 1];
        for (auto a = by_vertex.sides.begin() + by_vertex.first[v]; a != end; ++a) {
            if (across[a->slot] != kNone) {
                continue;
            }
            const auto b =
                std::find_if(a + 1, end, [&](const Side& side) { return partners(*a, side); });
            if (b == end) {
                open_triangle = a->slot / 3;
                return std::nullopt;
            }
            across[a->slot] = b->slot / 3;
            across[b->slot] = a->slot / 3;
        }
    }
    return across;
}

/// Triangles that each height crosses, ascending within a height.
struct Crossings {
    std::vector<std::size_t> first;  ///< one more than there are heights
    std::vector<std::uint32_t> triangles;
};

Crossings triangles_by_height(const TriMesh& mesh, const std::vector<GridPoint>& grid,
                              const std::vector<std::int64_t>& heights) {
    // A triangle is crossed at height z when its lowest corner is below z and its highest is not.
    const auto range = [&](const Triangle& t) {
        const auto [low, high] = std::minmax({grid[t[0]].z, grid[t[1]].z, grid[t[2]].z});
        const auto begin = std::upper_bound(heights.begin(), heights.end(), low);
        return std::pair(static_cast<std::size_t>(begin - heights.begin()),
                         static_cast<std::size_t>(std::upper_bound(begin, heights.end(), high) -
                                                  heights.begin()));
    };
    Crossings out;
    out.first.assign(heights.size() + 1, 0);
    for (const Triangle& t : mesh.triangles) {
        const auto [begin, end] = range(t);
        for (std::size_t k = begin; k < end; ++k) {
            ++out.first[k + 1];
        }
    }
    for (std::size_t k = 0; k < heights.size(); ++k) {
        out.first[k + 1] += out.first[k];
    }
    out.triangles.resize(out.first.back());
    std::vector<std::size_t> next(out.first.begin(), out.first.end() - 1);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto [begin, end] = range(mesh.triangles[i]);
        for (std::size_t k = begin; k < end; ++k) {
            out.triangles[next[k]++] = i;
        }
    }
    return out;
}

/// Where the edge from `low` to `high` meets the height; both triangles of an edge ask with the
/// same ends.
Point on_edge(const GridPoint& low, const GridPoint& high, std::int64_t z) {
    const double t = static_cast<double>(z - low.z) / static_cast<double>(high.z - low.z);
    return {low.x + std::llround(t * static_cast<double>(high.x - low.x)),
            low.y + std::llround(t * static_cast<double>(high.y - low.y))};
}

/// The side by which the section leaves a crossed triangle: the one that rises through the plane.
/// Material is then on the left, so that outer loops run counter-clockwise.
std::uint32_t rising_side(const Triangle& t, const std::vector<GridPoint>& grid, std::int64_t z) {
    for (std::uint32_t i = 0; i < 3; ++i) {
        if (grid[t.at(i)].z < z && grid[t.at((i + 1) % 3)].z >= z) {
            return i;
        }
    }
    return kNone;
}

/// The loops of one section.
Paths trace(const TriMesh& mesh, const std::vector<GridPoint>& grid,
            const std::vector<std::uint32_t>& across, const Crossings& crossings, std::size_t level,
            std::int64_t z) {
    const auto begin =
        crossings.triangles.begin() + static_cast<std::ptrdiff_t>(crossings.first[level]);
    const auto end =
        crossings.triangles.begin() + static_cast<std::ptrdiff_t>(crossings.first[level + 1]);
    std::vector<char> visited(static_cast<std::size_t>(end - begin), 0);
    const auto slot_of = [&](std::uint32_t triangle) {
        return static_cast<std::size_t>(std::lower_bound(begin, end, triangle) - begin);
    };
    Paths loops;
    for (std::size_t start = 0; start < visited.size(); ++start) {
        if (visited[start] != 0) {
            continue;
        }
        Path loop;
        for (std::size_t slot = start; visited[slot] == 0;) {
            visited[slot] = 1;
            const std::uint32_t triangle = begin[static_cast<std::ptrdiff_t>(slot)];
            const Triangle& t = mesh.triangles[triangle];
            const std::uint32_t side = rising_side(t, grid, z);
            const Point p = on_edge(grid[t.at(side)], grid[t.at((side + 1) % 3)], z);
            if (loop.empty() || loop.back() != p) {
                loop.push_back(p);
            }
            slot = slot_of(across[3 * triangle + side]);
        }
        loops.push_back(std::move(loop));
    }
    return loops;
}

}  // namespace

decomp::Result<std::vector<Paths>> slice(const TriMesh& mesh,
                                         const std::vector<std::int64_t>& heights,
                                         const decomp::Run& run) {
    std::uint32_t open_triangle = kNone;
    const auto across = neighbours_across_sides(mesh, open_triangle);
    if (!across) {
        return decomp::fail("fdm.open_mesh", "the mesh has a hole: it cannot be sliced",
                            "triangle " + std::to_string(open_triangle),
                            "repair the mesh first (hew repair, or hew make, which does)");
    }
    std::vector<GridPoint> grid(mesh.points.size());
    std::transform(mesh.points.begin(), mesh.points.end(), grid.begin(), [](const auto& p) {
        return GridPoint{polygon::nanometres(p.x()), polygon::nanometres(p.y()),
                         polygon::nanometres(p.z())};
    });
    const Crossings crossings = triangles_by_height(mesh, grid, heights);
    std::vector<Paths> out(heights.size());
    decomp::for_each_index(run, heights.size(), [&](std::size_t k) {
        const Paths loops = trace(mesh, grid, *across, crossings, k, heights[k]);
        out[k] = polygon::region_of(polygon::simplified(loops, kSliceToleranceMm));
    });
    if (run.cancelled()) {
        return decomp::cancelled();
    }
    return out;
}

}  // namespace cam::fdm
