// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cut/complex.h"

#include "decomp/base/assert.h"
#include "decomp/cut/build.h"
#include "decomp/cut/cells.h"
#include "decomp/cut/exact.h"
#include "decomp/cut/shells.h"
#include "decomp/cut/split.h"
#include "decomp/cut/splitter.h"
#include "decomp/cut/volume.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace decomp::cut {

namespace {

/// A vertex farther from a plane than this many steps is not on it.
constexpr double kCloseSteps = 1e-3;

}  // namespace

Complex::Complex(std::unique_ptr<State> state) : state_(std::move(state)) {}

Complex::Complex(const Complex& other) : state_(std::make_unique<State>(*other.state_)) {}

Complex& Complex::operator=(const Complex& other) {
    if (this != &other) {
        state_ = std::make_unique<State>(*other.state_);
    }
    return *this;
}

Complex::Complex(Complex&&) noexcept = default;
Complex& Complex::operator=(Complex&&) noexcept = default;
Complex::~Complex() = default;

Result<Complex> Complex::from_volume(const mesh::TriMesh& volume) {
    auto state = std::make_unique<State>();
    if (Status built = build_cells(volume, *state); !built) {
        return fail(built.error());
    }
    return Complex(std::move(state));
}

std::int32_t Complex::region_count() const { return state_->regions; }

Result<std::int32_t> Complex::add_plane(State& state, const part::Plane& plane) {
    if (!plane.normal.allFinite() || plane.normal.isZero(0) || !std::isfinite(plane.offset_mm)) {
        return fail("cut.bad_plane", "the plane has no normal or a coefficient that is not finite");
    }
    std::vector<part::Plane>& planes = state.planes;
    const auto known = std::find_if(planes.begin(), planes.end(), [&](const part::Plane& p) {
        return p.normal == plane.normal && p.offset_mm == plane.offset_mm;
    });
    const auto index = static_cast<std::int32_t>(known - planes.begin());
    if (known == planes.end()) {
        planes.push_back(plane);
    }
    return index;
}

Result<std::vector<std::int32_t>> Complex::split(std::int32_t region, const part::Plane& plane) {
    DECOMP_ASSERT(region >= 0 && region < state_->regions);
    const std::size_t planes_before = state_->planes.size();
    const Result<std::int32_t> index = add_plane(*state_, plane);
    if (!index) {
        return fail(index.error());
    }
    Result<std::vector<std::int32_t>> ids = split_region(*state_, region, *index);
    if (!ids || ids->size() == 1) {
        state_->planes.resize(planes_before);
        return ids;
    }
    state_->steps.push_back({Step::Kind::Split, region, plane, {}, *ids});
    return ids;
}

Result<std::vector<SectionPiece>> Complex::section(std::int32_t region,
                                                   const part::Plane& plane) const {
    DECOMP_ASSERT(region >= 0 && region < state_->regions);
    State copy = *state_;
    const Result<std::int32_t> index = add_plane(copy, plane);
    if (!index) {
        return fail(index.error());
    }
    const Result<std::vector<SectionPart>> parts = section_of(copy, region, *index);
    if (!parts) {
        return fail(parts.error());
    }
    std::vector<SectionPiece> out;
    out.reserve(parts->size());
    for (const SectionPart& part : *parts) {
        out.push_back(part.piece);
    }
    return out;
}

Result<std::vector<std::int32_t>> Complex::split(std::int32_t region, const part::Plane& plane,
                                                 const std::vector<std::int32_t>& pieces) {
    return split_some(region, plane, [&](const std::vector<SectionPiece>&) { return pieces; });
}

Result<std::vector<std::int32_t>> Complex::split_near(
    std::int32_t region, const part::Plane& plane, const std::vector<Eigen::Vector3d>& inside_mm) {
    return split_some(region, plane, [&](const std::vector<SectionPiece>& section) {
        std::vector<std::int32_t> nearest;
        for (const Eigen::Vector3d& point : inside_mm) {
            const auto best = std::min_element(section.begin(), section.end(),
                                               [&](const SectionPiece& l, const SectionPiece& r) {
                                                   return (l.inside_mm - point).squaredNorm() <
                                                          (r.inside_mm - point).squaredNorm();
                                               });
            if (best != section.end()) {
                nearest.push_back(static_cast<std::int32_t>(best - section.begin()));
            }
        }
        return nearest;
    });
}

Result<std::vector<std::int32_t>> Complex::split_some(std::int32_t region, const part::Plane& plane,
                                                      const Choose& choose) {
    DECOMP_ASSERT(region >= 0 && region < state_->regions);
    const std::size_t planes_before = state_->planes.size();
    const Result<std::int32_t> index = add_plane(*state_, plane);
    if (!index) {
        return fail(index.error());
    }
    const auto undo = [&] { state_->planes.resize(planes_before); };
    const Result<std::vector<SectionPart>> section = section_of(*state_, region, *index);
    if (!section) {
        undo();
        return fail(section.error());
    }
    std::vector<SectionPiece> described;
    described.reserve(section->size());
    for (const SectionPart& part : *section) {
        described.push_back(part.piece);
    }
    const std::vector<std::int32_t> pieces = choose(described);
    Result<std::vector<std::int32_t>> ids =
        split_region_at(*state_, region, *index, *section, pieces);
    if (!ids || ids->size() == 1) {
        undo();
        return ids;
    }
    Step step{Step::Kind::SplitAt, region, plane, {}, *ids};
    for (const std::int32_t piece : pieces) {
        step.inside_mm.push_back(described[static_cast<std::size_t>(piece)].inside_mm);
    }
    state_->steps.push_back(std::move(step));
    return ids;
}

part::Plane Complex::nudged_off_vertices(std::int32_t region, const part::Plane& plane,
                                         double step_mm) const {
    const Cells& cells = *state_;
    std::vector<std::int32_t> vertices;
    std::vector<Ref> leaves;
    for (const FaceSide& side : sides_of(cells, region)) {
        cells.expand(cells.face(side.face), leaves);
        for (const Ref leaf : leaves) {
            vertices.push_back(cells.tail(leaf));
        }
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    const double length = plane.normal.norm();
    part::Plane best = plane;
    double best_clearance = -1;
    for (const int steps : {0, 1, -1, 2, -2, 3, -3, 4, -4}) {
        const part::Plane moved{plane.normal, plane.offset_mm + steps * step_mm * length};
        double clearance = HUGE_VAL;
        for (const std::int32_t vertex : vertices) {
            const double distance =
                std::abs(moved.normal.dot(cells.point(vertex)) - moved.offset_mm) / length;
            if (distance < clearance &&
                (distance > kCloseSteps * step_mm || side_of_plane(cells, vertex, moved) != 0)) {
                clearance = distance;
            }
        }
        if (clearance > best_clearance) {
            best = moved;
            best_clearance = clearance;
        }
        if (clearance >= step_mm / 2) {
            break;
        }
    }
    return best;
}

void Complex::merge(std::int32_t into, std::int32_t from) {
    DECOMP_ASSERT(into >= 0 && into < state_->regions && from >= 0 && from < state_->regions);
    if (into == from) {
        return;
    }
    for (Face& face : state_->faces) {
        face.inside = face.inside == from ? into : face.inside;
        face.outside = face.outside == from ? into : face.outside;
    }
    std::erase_if(state_->faces, [](const Face& face) { return face.inside == face.outside; });
    state_->steps.push_back({Step::Kind::Merge, into, {}, {}, {from}});
}

const std::vector<Step>& Complex::steps() const { return state_->steps; }

bool Complex::touch(std::int32_t a, std::int32_t b) const {
    return std::any_of(state_->faces.begin(), state_->faces.end(), [&](const Face& face) {
        return (face.inside == a && face.outside == b) || (face.inside == b && face.outside == a);
    });
}

const std::vector<part::Plane>& Complex::planes() const { return state_->planes; }

bool Complex::is_empty(std::int32_t region) const {
    return std::none_of(state_->faces.begin(), state_->faces.end(),
                        [&](const Face& face) { return face.bounds(region); });
}

double Complex::volume_mm3(std::int32_t region) const {
    return approximate_volume(*state_, sides_of(*state_, region));
}

std::string Complex::exact_volume_mm3(std::int32_t region) const {
    return exact_volume(*state_, sides_of(*state_, region));
}

bool Complex::volumes_sum_exactly() const { return tiles_input_exactly(*state_); }

}  // namespace decomp::cut
