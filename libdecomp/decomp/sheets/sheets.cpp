// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/sheets/sheets.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace decomp::sheets {

namespace {

constexpr double kHardlyTurned = 0.0873;  // radians: 5 degrees

using CellPair = std::pair<std::int32_t, std::int32_t>;

/// Sheets are told apart by flood, and by their boxes too where they are split.
struct SheetKey {
    std::int32_t flood = -1;
    std::int32_t lower = -1;
    std::int32_t upper = -1;

    // clang-tidy 14 takes the 0 inside a defaulted comparison for a null pointer.
    // NOLINTNEXTLINE(modernize-use-nullptr)
    auto operator<=>(const SheetKey&) const = default;
};

void add_once(std::vector<std::int32_t>& values, std::int32_t value) {
    const auto place = std::lower_bound(values.begin(), values.end(), value);
    if (place == values.end() || *place != value) {
        values.insert(place, value);
    }
}

class Builder {
  public:
    Builder(const cells::CellComplex& cells, const SheetOptions& options)
        : cells_(cells),
          options_(options),
          axes_(options.axes ? *options.axes : axes_of(cells)),
          boxes_(sweep(cells, options.sweep)) {
        Eigen::AlignedBox3d bounds;
        for (const cells::SubTet& tet : cells.tets) {
            for (const std::uint32_t corner : tet.corners) {
                bounds.extend(cells.shape[corner]);
            }
        }
        out_.diagonal_mm = bounds.diagonal().norm();
    }

    Sheets build() {
        gather({});
        std::set<std::int32_t> uneven;
        for (std::size_t i = 0; i < out_.sheets.size(); ++i) {
            const Sheet& sheet = out_.sheets[i];
            if (sheet.lower.size() + sheet.upper.size() > 2 &&
                residual(sheet.samples, fitted_plane(sheet.samples, axis(sheet))).rms_mm >
                    options_.split_rms_share * out_.diagonal_mm) {
                uneven.insert(floods_[i]);
            }
        }
        if (!uneven.empty()) {
            gather(uneven);
        }
        share_planes();
        out_.box_of_cell = std::move(boxes_.box_of_cell);
        out_.boxes = std::move(boxes_.boxes);
        return std::move(out_);
    }

  private:
    [[nodiscard]] Eigen::Vector3d axis(const Sheet& sheet) const { return axes_.col(sheet.axis); }

    [[nodiscard]] std::int32_t box(std::int32_t cell) const {
        return boxes_.box_of_cell[static_cast<std::size_t>(cell)];
    }

    /// Collects the sheets with their samples; floods in `uneven` are split by their boxes.
    void gather(const std::set<std::int32_t>& uneven) {
        out_.sheets.clear();
        floods_.clear();
        std::map<SheetKey, std::size_t> number;
        std::map<CellPair, std::size_t> sheet_of_face;
        for (const LatticeFace& face : boxes_.faces) {
            const std::int32_t lower = box(face.lower);
            const std::int32_t upper = box(face.upper);
            if (!face.marked || lower == upper) {
                continue;
            }
            const SheetKey key = uneven.contains(face.flood) ? SheetKey{face.flood, lower, upper}
                                                             : SheetKey{face.flood, -1, -1};
            const auto [entry, is_new] = number.try_emplace(key, out_.sheets.size());
            if (is_new) {
                Sheet sheet;
                sheet.axis = face.axis;
                sheet.level = face.plane;
                out_.sheets.push_back(std::move(sheet));
                floods_.push_back(face.flood);
            }
            add_once(out_.sheets[entry->second].lower, lower);
            add_once(out_.sheets[entry->second].upper, upper);
            sheet_of_face[{face.lower, face.upper}] = entry->second;
        }
        for (const cells::SheetPiece& piece : cells_.pieces) {
            const auto found = sheet_of_face.find({piece.lower, piece.upper});
            if (found == sheet_of_face.end()) {
                continue;
            }
            Sheet& sheet = out_.sheets[found->second];
            sheet.area_mm2 += piece.area_mm2;
            for (std::size_t k = 0; k < 3; ++k) {
                const Eigen::Vector3d point = (2 * cells_.shape[piece.corners.at(k)] +
                                               cells_.shape[piece.corners.at((k + 1) % 3)] +
                                               cells_.shape[piece.corners.at((k + 2) % 3)]) /
                                              4;
                sheet.samples.push_back({point, piece.area_mm2 / 3});
            }
        }
    }

    [[nodiscard]] std::vector<Sample> samples_of(const std::vector<std::size_t>& group) const {
        std::vector<Sample> out;
        for (const std::size_t i : group) {
            out.insert(out.end(), out_.sheets[i].samples.begin(), out_.sheets[i].samples.end());
        }
        return out;
    }

    /// True when no sheet of the group lies farther from the plane than from its own by more than
    /// the given share.
    [[nodiscard]] bool suits(const std::vector<std::size_t>& group, const part::Plane& plane,
                             double share) const {
        return std::all_of(group.begin(), group.end(), [&](std::size_t i) {
            return residual(out_.sheets[i].samples, plane).rms_mm <
                   own_rms_[i] + share * out_.diagonal_mm;
        });
    }

    void share_planes() {
        std::vector<std::size_t> order(out_.sheets.size());
        for (std::size_t i = 0; i < order.size(); ++i) {
            order[i] = i;
            const Sheet& sheet = out_.sheets[i];
            own_rms_.push_back(
                residual(sheet.samples, fitted_plane(sheet.samples, axis(sheet))).rms_mm);
        }
        std::stable_sort(order.begin(), order.end(), [&](std::size_t l, std::size_t r) {
            return out_.sheets[l].area_mm2 > out_.sheets[r].area_mm2;
        });
        std::vector<std::vector<std::size_t>> groups;
        for (const std::size_t i : order) {
            const Sheet& sheet = out_.sheets[i];
            const auto joins = [&](const std::vector<std::size_t>& group) {
                const Sheet& other = out_.sheets[group.front()];
                if (other.axis != sheet.axis || other.level != sheet.level) {
                    return false;
                }
                std::vector<std::size_t> both = group;
                both.push_back(i);
                return suits(both, fitted_plane(samples_of(both), axis(sheet)),
                             options_.share_rms_share);
            };
            const auto found = std::find_if(groups.begin(), groups.end(), joins);
            if (found == groups.end()) {
                groups.push_back({i});
            } else {
                found->push_back(i);
            }
        }
        for (const std::vector<std::size_t>& group : groups) {
            add_plane(group);
        }
    }

    void add_plane(const std::vector<std::size_t>& group) {
        const Sheet& first = out_.sheets[group.front()];
        const std::vector<Sample> samples = samples_of(group);
        SheetPlane out;
        out.axis = first.axis;
        out.level = first.level;
        out.plane = fitted_plane(samples, axis(first));
        const part::Plane straight = fitted_offset(samples, axis(first));
        const double tilt = std::acos(std::clamp(out.plane.normal.dot(straight.normal), -1.0, 1.0));
        if (tilt > options_.most_tilt) {
            out.rejected = true;
            out.plane = straight;
        } else if (tilt < options_.snap_angle && suits(group, straight, options_.snap_rms_share)) {
            out.snapped = true;
            out.plane = straight;
        }
        for (const std::size_t i : group) {
            out_.sheets[i].plane = static_cast<std::int32_t>(out_.planes.size());
            out_.sheets[i].residual = residual(out_.sheets[i].samples, out.plane);
        }
        out_.planes.push_back(out);
    }

    const cells::CellComplex& cells_;
    const SheetOptions& options_;
    Eigen::Matrix3d axes_;
    Boxes boxes_;
    Sheets out_;
    std::vector<std::int32_t> floods_;  // of each sheet
    std::vector<double> own_rms_;
};

/// Where the edges of a tet cross a plane of polycube space, in the shape.
std::vector<Eigen::Vector3d> mapped_crossings(const cells::CellComplex& cells,
                                              const cells::SubTet& tet, int axis,
                                              double coordinate) {
    std::vector<Eigen::Vector3d> out;
    for (const std::uint32_t a : tet.corners) {
        const double height_a = cells.polycube[a][axis] - coordinate;
        for (const std::uint32_t b : tet.corners) {
            const double height_b = cells.polycube[b][axis] - coordinate;
            if (height_a < 0 && height_b >= 0) {
                const double t = height_a / (height_a - height_b);
                out.emplace_back(cells.shape[a] + t * (cells.shape[b] - cells.shape[a]));
            }
        }
    }
    return out;
}

}  // namespace

Eigen::Matrix3d axes_of(const cells::CellComplex& cells) {
    Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
    for (const cells::SubTet& tet : cells.tets) {
        Eigen::Matrix3d shape;
        Eigen::Matrix3d polycube;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t corner = tet.corners.at(static_cast<std::size_t>(k) + 1);
            shape.col(k) = cells.shape[corner] - cells.shape[tet.corners[0]];
            polycube.col(k) = cells.polycube[corner] - cells.polycube[tet.corners[0]];
        }
        const Eigen::FullPivLU<Eigen::Matrix3d> solver(shape);
        if (!tet.flipped && solver.isInvertible()) {
            mean += tet.volume_mm3 * polycube * solver.inverse();
        }
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(mean, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Matrix3d turn = svd.matrixV() * svd.matrixU().transpose();
    return Eigen::AngleAxisd(turn).angle() < kHardlyTurned ? Eigen::Matrix3d::Identity().eval()
                                                           : turn;
}

Sheets sheets_of(const cells::CellComplex& cells, const SheetOptions& options) {
    return Builder(cells, options).build();
}

std::optional<part::Plane> mapped_plane(const cells::CellComplex& cells,
                                        const std::vector<char>& cell_wanted, int axis,
                                        double coordinate) {
    std::vector<Sample> samples;
    Eigen::Vector3d towards = Eigen::Vector3d::Zero();
    for (const cells::SubTet& tet : cells.tets) {
        if (tet.flipped || cell_wanted[static_cast<std::size_t>(tet.cell)] == 0) {
            continue;
        }
        const std::vector<Eigen::Vector3d> crossings =
            mapped_crossings(cells, tet, axis, coordinate);
        // Three crossings are a triangle; four, listed row by row, a quadrilateral with the last
        // two the wrong way round.
        for (std::size_t k = 0; k + 2 < crossings.size(); ++k) {
            const Eigen::Vector3d cross =
                (crossings[k + 1] - crossings[k]).cross(crossings[k + 2] - crossings[k]);
            samples.push_back(
                {(crossings[k] + crossings[k + 1] + crossings[k + 2]) / 3, cross.norm() / 2});
        }
        Eigen::Matrix3d edges;
        Eigen::Vector3d rises;
        for (int k = 0; k < 3; ++k) {
            const auto corner = tet.corners.at(static_cast<std::size_t>(k) + 1);
            edges.row(k) = (cells.shape[corner] - cells.shape[tet.corners[0]]).transpose();
            rises[k] = cells.polycube[corner][axis] - cells.polycube[tet.corners[0]][axis];
        }
        if (!crossings.empty() && tet.volume_mm3 > 0) {
            towards += tet.volume_mm3 * edges.fullPivLu().solve(rises);
        }
    }
    if (samples.empty() || towards.isZero(0) || !towards.allFinite()) {
        return std::nullopt;
    }
    return fitted_plane(samples, towards);
}

}  // namespace decomp::sheets
