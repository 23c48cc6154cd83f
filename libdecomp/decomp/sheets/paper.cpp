// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/sheets/paper.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

namespace decomp::sheets {

namespace {

constexpr double kNearParallel = 0.17;  // sine of about 10 degrees
constexpr double kFarthest = 0.05;      // of the diagonal: moves beyond are refused
constexpr double kSamePlane = 1e-3;     // of the diagonal
constexpr double kFlat = 1e-12;         // a tet without volume in polycube space, in its own units

/// Indices of lattice planes along x, y, z.
using LatticePoint = std::array<int, 3>;

/// A corner of boxes in the shape.
struct Corner {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    std::vector<part::Plane> planes;  ///< that it has been put on
};

/// What lies between two boxes.
struct Side {
    std::size_t sheet = 0;
    std::array<LatticePoint, 4> corners{};  ///< around it
};

/// Barycentric coordinates of a point in a tet of polycube space; nothing for a flat tet.
std::optional<Eigen::Vector4d> barycentric(const cells::CellComplex& cells,
                                           const cells::SubTet& tet, const Eigen::Vector3d& point) {
    const Eigen::Vector3d& origin = cells.polycube[tet.corners[0]];
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) {
        edges.col(k) = cells.polycube[tet.corners.at(static_cast<std::size_t>(k) + 1)] - origin;
    }
    const double scale = edges.cwiseAbs().maxCoeff();
    if (!(std::abs(edges.determinant()) > kFlat * scale * scale * scale)) {
        return std::nullopt;
    }
    const Eigen::Vector3d rest = edges.inverse() * (point - origin);
    return Eigen::Vector4d(1 - rest.sum(), rest.x(), rest.y(), rest.z());
}

class Flattener {
  public:
    Flattener(const cells::CellComplex& cells, const tets::Lattice& lattice,
              const SheetOptions& options)
        : cells_(cells),
          lattice_(lattice),
          options_(options),
          axes_(options.axes ? *options.axes : axes_of(cells)) {
        Boxes boxes = sweep(cells, options.sweep);
        out_.boxes = std::move(boxes.boxes);
        out_.box_of_cell = std::move(boxes.box_of_cell);
        Eigen::AlignedBox3d bounds;
        for (const cells::SubTet& tet : cells.tets) {
            for (const std::uint32_t corner : tet.corners) {
                bounds.extend(cells.shape[corner]);
            }
        }
        out_.diagonal_mm = bounds.diagonal().norm();
        list_sides(boxes.faces);
        gather_samples();
    }

    Sheets run() {
        map_corners();
        const std::vector<std::size_t> order = largest_first();
        std::vector<char> queued(sides_.size(), 0);
        for (const std::size_t start : order) {
            if (queued[start] == 0) {
                flatten_from(start, order, queued);
            }
        }
        for (const Side& side : sides_) {
            report(side);
        }
        return std::move(out_);
    }

  private:
    void map_corners() {
        for (const Side& side : sides_) {
            const Sheet& sheet = out_.sheets[side.sheet];
            for (const LatticePoint& at : side.corners) {
                if (!corners_.contains(at)) {
                    corners_[at].point = mapped_back(at, sheet.lower[0], sheet.upper[0]);
                }
            }
        }
    }

    [[nodiscard]] std::vector<std::size_t> largest_first() const {
        std::vector<std::size_t> order(sides_.size());
        for (std::size_t i = 0; i < order.size(); ++i) {
            order[i] = i;
        }
        std::stable_sort(order.begin(), order.end(), [&](std::size_t l, std::size_t r) {
            return out_.sheets[sides_[l].sheet].area_mm2 > out_.sheets[sides_[r].sheet].area_mm2;
        });
        return order;
    }

    /// Flattens a side, then those that touch it, the larger first, and so on.
    void flatten_from(std::size_t start, const std::vector<std::size_t>& order,
                      std::vector<char>& queued) {
        std::deque<std::size_t> queue{start};
        queued[start] = 1;
        while (!queue.empty()) {
            const std::size_t next = queue.front();
            queue.pop_front();
            flatten(sides_[next]);
            for (const std::size_t other : order) {
                if (queued[other] == 0 && touch(sides_[next], sides_[other])) {
                    queued[other] = 1;
                    queue.push_back(other);
                }
            }
        }
    }

    void list_sides(const std::vector<LatticeFace>& faces) {
        std::map<std::tuple<std::int32_t, std::int32_t, int, int>, std::size_t> number;
        for (const LatticeFace& face : faces) {
            const std::int32_t lower = out_.box_of_cell[static_cast<std::size_t>(face.lower)];
            const std::int32_t upper = out_.box_of_cell[static_cast<std::size_t>(face.upper)];
            if (!face.marked || lower == upper) {
                continue;
            }
            const auto [entry, is_new] =
                number.try_emplace({lower, upper, face.axis, face.plane}, sides_.size());
            sheet_of_face_[{face.lower, face.upper}] = entry->second;
            if (!is_new) {
                continue;
            }
            Sheet sheet;
            sheet.axis = face.axis;
            sheet.level = face.plane;
            sheet.lower = {lower};
            sheet.upper = {upper};
            out_.sheets.push_back(std::move(sheet));
            sides_.push_back({entry->second, corners_between(lower, upper, face)});
        }
    }

    /// The corners of the rectangle that two boxes share.
    [[nodiscard]] std::array<LatticePoint, 4> corners_between(std::int32_t lower,
                                                              std::int32_t upper,
                                                              const LatticeFace& face) const {
        const Box& a = out_.boxes[static_cast<std::size_t>(lower)];
        const Box& b = out_.boxes[static_cast<std::size_t>(upper)];
        const auto u = static_cast<std::size_t>((face.axis + 1) % 3);
        const auto v = static_cast<std::size_t>((face.axis + 2) % 3);
        std::array<LatticePoint, 4> out{};
        for (std::size_t k = 0; k < 4; ++k) {
            LatticePoint& at = out.at(k);
            at.at(static_cast<std::size_t>(face.axis)) = face.plane;
            at.at(u) = k == 0 || k == 3 ? std::max(a.low.at(u), b.low.at(u))
                                        : std::min(a.high.at(u), b.high.at(u));
            at.at(v) =
                k < 2 ? std::max(a.low.at(v), b.low.at(v)) : std::min(a.high.at(v), b.high.at(v));
        }
        return out;
    }

    void gather_samples() {
        for (const cells::SheetPiece& piece : cells_.pieces) {
            const auto found = sheet_of_face_.find({piece.lower, piece.upper});
            if (found == sheet_of_face_.end()) {
                continue;
            }
            Sheet& sheet = out_.sheets[found->second];
            sheet.area_mm2 += piece.area_mm2;
            Eigen::Vector3d middle = Eigen::Vector3d::Zero();
            for (const std::uint32_t corner : piece.corners) {
                middle += cells_.shape[corner] / 3;
            }
            sheet.samples.push_back({middle, piece.area_mm2});
        }
    }

    /// Where a lattice point lies in the shape: in the tet of the two boxes that holds it, or in
    /// the one that it is least outside of, drawn to its surface.
    [[nodiscard]] Eigen::Vector3d mapped_back(const LatticePoint& at, std::int32_t lower,
                                              std::int32_t upper) const {
        Eigen::Vector3d there;
        for (std::size_t k = 0; k < 3; ++k) {
            there[static_cast<Eigen::Index>(k)] =
                lattice_.planes.at(k)[static_cast<std::size_t>(at.at(k))];
        }
        double least_outside = std::numeric_limits<double>::infinity();
        Eigen::Vector3d best = Eigen::Vector3d::Zero();
        for (const cells::SubTet& tet : cells_.tets) {
            const std::int32_t box = out_.box_of_cell[static_cast<std::size_t>(tet.cell)];
            if (tet.flipped || (box != lower && box != upper)) {
                continue;
            }
            const auto weights = barycentric(cells_, tet, there);
            if (!weights) {
                continue;
            }
            Eigen::Vector4d clamped = weights->cwiseMax(0);
            clamped /= clamped.sum();
            Eigen::Vector3d in_polycube = Eigen::Vector3d::Zero();
            Eigen::Vector3d in_shape = Eigen::Vector3d::Zero();
            for (int k = 0; k < 4; ++k) {
                const std::uint32_t corner = tet.corners.at(static_cast<std::size_t>(k));
                in_polycube += clamped[k] * cells_.polycube[corner];
                in_shape += clamped[k] * cells_.shape[corner];
            }
            const double outside = (in_polycube - there).norm();
            if (outside < least_outside) {
                least_outside = outside;
                best = in_shape;
            }
        }
        return best;
    }

    static bool touch(const Side& a, const Side& b) {
        return std::any_of(a.corners.begin(), a.corners.end(), [&](const LatticePoint& at) {
            return std::find(b.corners.begin(), b.corners.end(), at) != b.corners.end();
        });
    }

    [[nodiscard]] part::Plane plane_for(const std::vector<Eigen::Vector3d>& fixed,
                                        const std::vector<Eigen::Vector3d>& free,
                                        const Eigen::Vector3d& towards) const {
        part::Plane out;
        if (fixed.size() == 1 || fixed.size() == 2) {
            // Through the fixed corner, or about the pivot edge: the least squares of the others.
            const Eigen::Vector3d pivot = fixed.size() == 2
                                              ? Eigen::Vector3d((fixed[1] - fixed[0]).normalized())
                                              : Eigen::Vector3d(Eigen::Vector3d::Zero());
            Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
            for (const Eigen::Vector3d& point : free) {
                Eigen::Vector3d from = point - fixed[0];
                from -= pivot.dot(from) * pivot;
                spread += from * from.transpose();
            }
            // The pivot's direction must not be taken for the normal.
            spread += 4 * spread.trace() * pivot * pivot.transpose();
            out.normal =
                Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
            out.offset_mm = out.normal.dot(fixed[0]);
        } else {
            std::vector<Sample> samples;
            for (const Eigen::Vector3d& point : fixed.size() == 3 ? fixed : all(fixed, free)) {
                samples.push_back({point, 1});
            }
            out = fitted_plane(samples, towards);
        }
        if (out.normal.dot(towards) < 0) {
            out.normal = -out.normal;
            out.offset_mm = -out.offset_mm;
        }
        return out;
    }

    static std::vector<Eigen::Vector3d> all(std::vector<Eigen::Vector3d> points,
                                            const std::vector<Eigen::Vector3d>& more) {
        points.insert(points.end(), more.begin(), more.end());
        return points;
    }

    void flatten(const Side& side) {
        Sheet& sheet = out_.sheets[side.sheet];
        const Eigen::Vector3d axis = axes_.col(sheet.axis);
        std::vector<Eigen::Vector3d> fixed;
        std::vector<Eigen::Vector3d> free;
        for (const LatticePoint& at : side.corners) {
            const Corner& corner = corners_.at(at);
            (corner.planes.empty() ? free : fixed).push_back(corner.point);
        }
        SheetPlane made;
        made.axis = sheet.axis;
        made.level = sheet.level;
        made.plane = plane_for(fixed, free, axis);
        if (std::acos(std::clamp(made.plane.normal.dot(axis), -1.0, 1.0)) > options_.most_tilt) {
            made.plane = fitted_offset(sheet.samples, axis);
            made.rejected = true;
        }
        sheet.plane = shared(side, made);
        if (sheet.plane < 0) {
            sheet.plane = static_cast<std::int32_t>(out_.planes.size());
            out_.planes.push_back(made);
        }
        const part::Plane& plane = out_.planes[static_cast<std::size_t>(sheet.plane)].plane;
        for (const LatticePoint& at : side.corners) {
            Corner& corner = corners_.at(at);
            corner.point = put_on(corner, plane);
            corner.planes.push_back(plane);
        }
    }

    /// An earlier plane of the same level that the corners of the side lie on as they are: sides
    /// name one plane, not two that differ by next to nothing. -1 if there is none.
    [[nodiscard]] std::int32_t shared(const Side& side, const SheetPlane& made) const {
        for (std::size_t i = 0; i < out_.planes.size(); ++i) {
            const SheetPlane& plane = out_.planes[i];
            const bool fits =
                std::all_of(side.corners.begin(), side.corners.end(), [&](const LatticePoint& at) {
                    return std::abs(plane.plane.normal.dot(corners_.at(at).point) -
                                    plane.plane.offset_mm) < kSamePlane * out_.diagonal_mm;
                });
            if (plane.axis == made.axis && plane.level == made.level && fits) {
                return static_cast<std::int32_t>(i);
            }
        }
        return -1;
    }

    /// A corner moved onto a plane without leaving those that it lies on.
    [[nodiscard]] Eigen::Vector3d put_on(const Corner& corner, const part::Plane& plane) const {
        const double height = plane.normal.dot(corner.point) - plane.offset_mm;
        if (corner.planes.size() > 2) {
            return corner.point;
        }
        Eigen::Vector3d way = plane.normal;
        if (corner.planes.size() == 1) {
            const Eigen::Vector3d& own = corner.planes[0].normal;
            way = plane.normal - own.dot(plane.normal) * own;
        } else if (corner.planes.size() == 2) {
            way = corner.planes[0].normal.cross(corner.planes[1].normal);
        }
        const double rise = way.dot(plane.normal);
        if (way.norm() < kNearParallel || std::abs(rise) < kNearParallel * way.norm()) {
            return corner.point;
        }
        const Eigen::Vector3d move = -height / rise * way;
        return move.norm() > kFarthest * out_.diagonal_mm ? corner.point
                                                          : Eigen::Vector3d(corner.point + move);
    }

    void report(const Side& side) {
        Sheet& sheet = out_.sheets[side.sheet];
        std::vector<Sample> samples;
        for (const LatticePoint& at : side.corners) {
            sheet.corners.push_back(corners_.at(at).point);
            samples.push_back({corners_.at(at).point, 1});
        }
        sheet.residual =
            residual(samples, out_.planes[static_cast<std::size_t>(sheet.plane)].plane);
    }

    const cells::CellComplex& cells_;
    const tets::Lattice& lattice_;
    const SheetOptions& options_;
    Eigen::Matrix3d axes_;
    Sheets out_;
    std::vector<Side> sides_;
    std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> sheet_of_face_;
    std::map<LatticePoint, Corner> corners_;
};

}  // namespace

Sheets paper_sheets(const cells::CellComplex& cells, const tets::Lattice& lattice,
                    const SheetOptions& options) {
    return Flattener(cells, lattice, options).run();
}

}  // namespace decomp::sheets
