// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/repair/shells.h"

#include "decomp/mesh/measure.h"
#include "decomp/repair/soup.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace decomp::repair {

namespace {

struct Shell {
    mesh::TriMesh mesh;
    Eigen::AlignedBox3d box;
    double volume_mm3 = 0;
    Eigen::Vector3d inner_point =
        Eigen::Vector3d::Zero();      ///< on the shell, amid its largest triangle
    std::vector<std::size_t> around;  ///< shells that contain it
    bool turn = false;
    bool drop = false;
    bool is_void = false;

    [[nodiscard]] bool faces_outward() const { return (volume_mm3 > 0) != turn; }
};

Eigen::Vector3d point_on(const mesh::TriMesh& mesh) {
    std::size_t largest = 0;
    double best = -1;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const double area = mesh::double_area_normal(mesh, i).squaredNorm();
        if (area > best) {
            best = area;
            largest = i;
        }
    }
    const auto& t = mesh.triangles[largest];
    return (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]) / 3;
}

std::vector<Shell> shells_of(const mesh::TriMesh& mesh, const Components& parts) {
    std::vector<Shell> shells(parts.count);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        shells[parts.of_triangle[i]].mesh.triangles.push_back(mesh.triangles[i]);
    }
    for (Shell& shell : shells) {
        // Points of its own, so that measuring a small shell does not cost the size of the whole
        // mesh.
        std::vector<std::uint32_t> used;
        for (const auto& triangle : shell.mesh.triangles) {
            used.insert(used.end(), triangle.begin(), triangle.end());
        }
        std::sort(used.begin(), used.end());
        used.erase(std::unique(used.begin(), used.end()), used.end());
        for (const std::uint32_t point : used) {
            shell.mesh.points.push_back(mesh.points[point]);
        }
        for (auto& triangle : shell.mesh.triangles) {
            for (auto& corner : triangle) {
                corner = static_cast<std::uint32_t>(
                    std::lower_bound(used.begin(), used.end(), corner) - used.begin());
            }
        }
        shell.box = mesh::bounds(shell.mesh);
        shell.volume_mm3 = mesh::volume_mm3(shell.mesh);
        shell.inner_point = point_on(shell.mesh);
    }
    return shells;
}

void find_nesting(std::vector<Shell>& shells) {
    for (std::size_t inner = 0; inner < shells.size(); ++inner) {
        for (std::size_t outer = 0; outer < shells.size(); ++outer) {
            if (inner != outer && shells[outer].box.contains(shells[inner].box) &&
                std::abs(winding_number(shells[outer].mesh, shells[inner].inner_point)) > 0.5) {
                shells[inner].around.push_back(outer);
            }
        }
    }
}

/// From the outside in: turns a shell with its outermost, then drops what bounds no change between
/// solid and nothing.
void judge(std::vector<Shell>& shells, const std::vector<std::size_t>& outside_in,
           ShellReport& report) {
    for (const std::size_t s : outside_in) {
        Shell& shell = shells[s];
        const auto outermost =
            std::find_if(shell.around.begin(), shell.around.end(),
                         [&](std::size_t o) { return shells[o].around.empty(); });
        const Shell& root = outermost == shell.around.end() ? shell : shells[*outermost];
        shell.turn = root.volume_mm3 < 0;
        report.turned += shell.turn ? 1U : 0U;
        long winding = 0;
        for (const std::size_t outer : shell.around) {
            winding += shells[outer].faces_outward() ? 1 : -1;
        }
        const bool solid_outside = winding > 0;
        const bool solid_inside = winding + (shell.faces_outward() ? 1 : -1) > 0;
        shell.drop = solid_inside == solid_outside;
        shell.is_void = solid_outside && !solid_inside;
    }
}

void alternate(std::vector<Shell>& shells, ShellReport& report) {
    for (Shell& shell : shells) {
        shell.is_void = shell.around.size() % 2 == 1;
        shell.turn = (shell.volume_mm3 > 0) == shell.is_void;
        report.alternated += shell.turn ? 1U : 0U;
    }
}

}  // namespace

double winding_number(const mesh::TriMesh& mesh, const Eigen::Vector3d& point) {
    // Van Oosterom and Strackee 1983: the solid angle of a triangle from its three corner vectors.
    double sum = 0;
    for (const auto& t : mesh.triangles) {
        const Eigen::Vector3d a = mesh.points[t[0]] - point;
        const Eigen::Vector3d b = mesh.points[t[1]] - point;
        const Eigen::Vector3d c = mesh.points[t[2]] - point;
        const double la = a.norm();
        const double lb = b.norm();
        const double lc = c.norm();
        sum += std::atan2(a.dot(b.cross(c)),
                          la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return sum / (2 * std::numbers::pi);
}

ShellReport arrange_shells(mesh::TriMesh& mesh, bool trust_senses) {
    const Components parts = components(mesh);
    std::vector<Shell> shells = shells_of(mesh, parts);
    find_nesting(shells);
    ShellReport report;
    if (trust_senses) {
        std::vector<std::size_t> outside_in(shells.size());
        std::iota(outside_in.begin(), outside_in.end(), std::size_t{0});
        std::stable_sort(outside_in.begin(), outside_in.end(), [&](std::size_t a, std::size_t b) {
            return shells[a].around.size() < shells[b].around.size();
        });
        judge(shells, outside_in, report);
    } else {
        alternate(shells, report);
    }
    std::vector<bool> wanted(shells.size());
    for (std::size_t s = 0; s < shells.size(); ++s) {
        wanted[s] = !shells[s].drop;
        report.dropped += shells[s].drop ? 1U : 0U;
        report.dropped_volume_mm3 += shells[s].drop ? std::abs(shells[s].volume_mm3) : 0;
        report.shells += shells[s].drop ? 0U : 1U;
        report.voids += !shells[s].drop && shells[s].is_void ? 1U : 0U;
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (shells[parts.of_triangle[i]].turn) {
            std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
        }
    }
    if (report.dropped > 0) {
        mesh = extract(mesh, parts, wanted);
    }
    return report;
}

}  // namespace decomp::repair
