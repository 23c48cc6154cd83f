// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/map/quantise.h"
#include "decomp/mesh/measure.h"
#include "decomp/polycube/candidate_detail.h"
#include "decomp/sections/profile.h"
#include "decomp/tets/measure.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace decomp::polycube {

namespace {

constexpr int kVoxels = 24;             // along the longest side
constexpr std::size_t kMostPlanes = 4;  // inner ones, an axis
constexpr double kLeastGap = 0.08;      // of the extent, between planes
constexpr double kOffCentre = 0.0137;   // of a voxel: rays keep off the edges of aligned meshes

/// The sorted heights at which the ray up from (x, y) meets the surface.
std::vector<double> crossings(const mesh::TriMesh& mesh, double x, double y) {
    std::vector<double> out;
    for (const mesh::Triangle& t : mesh.triangles) {
        const Eigen::Vector3d& a = mesh.points[t[0]];
        const Eigen::Vector3d& b = mesh.points[t[1]];
        const Eigen::Vector3d& c = mesh.points[t[2]];
        if (x < std::min({a.x(), b.x(), c.x()}) || x > std::max({a.x(), b.x(), c.x()}) ||
            y < std::min({a.y(), b.y(), c.y()}) || y > std::max({a.y(), b.y(), c.y()})) {
            continue;
        }
        const auto side = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
            return (q.x() - p.x()) * (y - p.y()) - (q.y() - p.y()) * (x - p.x());
        };
        const double u = side(b, c);
        const double v = side(c, a);
        const double w = side(a, b);
        const double sum = u + v + w;
        if (sum != 0 && (u >= 0) == (v >= 0) && (v >= 0) == (w >= 0)) {
            out.push_back((u * a.z() + v * b.z() + w * c.z()) / sum);
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

/// The six tets of a box lead from its lowest corner to its highest, along the axes in these
/// orders; the last three are mirrored.
constexpr std::array<std::array<std::size_t, 3>, 6> kOrders{
    {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};

using GridPoint = std::array<int, 3>;

/// Tets that share the points of a grid.
class VoxelTets {
  public:
    VoxelTets(Eigen::Vector3d low, Eigen::Vector3d step)
        : low_(std::move(low)), step_(std::move(step)) {}

    /// The voxels from this one upwards whose centres lie inside: above an odd number of crossings.
    void add_column(GridPoint lowest, int layers, const std::vector<double>& heights) {
        for (; lowest[2] < layers; ++lowest[2]) {
            const double z = low_.z() + (lowest[2] + 0.5) * step_.z();
            const auto below = std::count_if(heights.begin(), heights.end(),
                                             [&](double height) { return height < z; });
            if (below % 2 != 0) {
                add(lowest);
            }
        }
    }

    tets::TetMesh take() { return std::move(out_); }

  private:
    void add(const GridPoint& lowest) {
        for (std::size_t o = 0; o < kOrders.size(); ++o) {
            GridPoint at = lowest;
            tets::Tet tet{};
            tet[0] = point(at);
            for (std::size_t s = 0; s < 3; ++s) {
                ++at.at(kOrders.at(o).at(s));
                tet.at(s + 1) = point(at);
            }
            if (o >= 3) {
                std::swap(tet[2], tet[3]);
            }
            out_.tets.push_back(tet);
        }
    }

    std::uint32_t point(const GridPoint& at) {
        const auto [found, fresh] =
            number_.emplace(at, static_cast<std::uint32_t>(out_.points.size()));
        if (fresh) {
            out_.points.emplace_back(low_ +
                                     step_.cwiseProduct(Eigen::Vector3d(at[0], at[1], at[2])));
        }
        return found->second;
    }

    Eigen::Vector3d low_;
    Eigen::Vector3d step_;
    tets::TetMesh out_;
    std::map<GridPoint, std::uint32_t> number_;
};

/// The box alone, six tets.
tets::TetMesh box_tets(const Eigen::AlignedBox3d& box) {
    tets::TetMesh out;
    for (std::uint32_t c = 0; c < 8; ++c) {
        out.points.emplace_back((c & 1U) != 0 ? box.max().x() : box.min().x(),
                                (c & 2U) != 0 ? box.max().y() : box.min().y(),
                                (c & 4U) != 0 ? box.max().z() : box.min().z());
    }
    for (const auto& order : kOrders) {
        tets::Tet tet{0, 0, 0, 0};
        for (std::size_t s = 0; s < 3; ++s) {
            tet.at(s + 1) = tet.at(s) | (1U << order.at(s));
        }
        if (tets::six_volumes(out.points, tet) < 0) {
            std::swap(tet[2], tet[3]);
        }
        out.tets.push_back(tet);
    }
    return out;
}

/// Voxels whose centres lie inside, six tets each.
tets::TetMesh voxel_tets(const mesh::TriMesh& mesh) {
    const Eigen::AlignedBox3d box = mesh::bounds(mesh);
    const double edge = box.sizes().maxCoeff() / kVoxels;
    GridPoint size{};
    for (int d = 0; d < 3; ++d) {
        size.at(static_cast<std::size_t>(d)) =
            std::max(1, static_cast<int>(std::lround(box.sizes()[d] / edge)));
    }
    const Eigen::Vector3d step =
        box.sizes().cwiseQuotient(Eigen::Vector3d(size[0], size[1], size[2]));
    VoxelTets voxels(box.min(), step);
    for (int i = 0; i < size[0]; ++i) {
        for (int j = 0; j < size[1]; ++j) {
            const std::vector<double> heights =
                crossings(mesh, box.min().x() + (i + 0.5 + kOffCentre) * step.x(),
                          box.min().y() + (j + 0.5 - kOffCentre) * step.y());
            voxels.add_column({i, j, 0}, size[2], heights);
        }
    }
    tets::TetMesh out = voxels.take();
    // Thinner than a voxel everywhere: the box stands for it.
    return out.tets.empty() ? box_tets(box) : out;
}

/// The strongest events along an axis, not too near to each other or to the ends.
std::vector<double> planes_along(const mesh::TriMesh& mesh, int axis) {
    const sections::Profile profile(mesh, Eigen::Vector3d::Unit(axis));
    std::vector<sections::Event> events = profile.events();
    std::stable_sort(events.begin(), events.end(),
                     [](const auto& a, const auto& b) { return a.strength > b.strength; });
    std::vector<double> planes{profile.low_mm(), profile.high_mm()};
    const double gap = kLeastGap * (profile.high_mm() - profile.low_mm());
    for (const sections::Event& event : events) {
        if (planes.size() >= kMostPlanes + 2) {
            break;
        }
        if (std::all_of(planes.begin(), planes.end(),
                        [&](double plane) { return std::abs(plane - event.t_mm) >= gap; })) {
            planes.push_back(event.t_mm);
        }
    }
    std::sort(planes.begin(), planes.end());
    return planes;
}

}  // namespace

Polycube identity_polycube(const mesh::TriMesh& volume, const Eigen::Matrix3d& rotation) {
    Eigen::Affine3d turn = Eigen::Affine3d::Identity();
    turn.linear() = rotation;
    const mesh::TriMesh turned = rotation.isIdentity(0) ? volume : mesh::transformed(volume, turn);
    Polycube out;
    tets::TetMesh tets = voxel_tets(turned);
    out.pair.polycube = std::move(tets.points);
    out.pair.tets = std::move(tets.tets);
    for (const Eigen::Vector3d& p : out.pair.polycube) {
        out.pair.shape.emplace_back(rotation.transpose() * p);
    }
    for (int axis = 0; axis < 3; ++axis) {
        out.lattice.planes.at(static_cast<std::size_t>(axis)) = planes_along(turned, axis);
    }
    out.labels = map::labels_of(out.pair);
    out.rotation = rotation;
    out.tier = "T4";
    out.figures.start = "identity";
    out.figures.tets = out.pair.tets.size();
    out.figures.symmetric_dirichlet = 1;
    out.figures.fidelity = 1;
    return out;
}

}  // namespace decomp::polycube
