// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/step_surroundings.h"

#include "cam/job/lone_part.h"
#include "decomp/solid/make_solid.h"

#include <array>
#include <utility>

namespace cam::job {

using decomp::fail;
using decomp::Result;
using decomp::Run;
using decomp::brep::StepBody;

namespace {

constexpr double kExactMm = 1e-3;  // a block has no curves to look for
constexpr std::array<double, 3> kStockColour{0.86, 0.80, 0.66};
constexpr std::array<double, 3> kFixtureColour{0.55, 0.57, 0.60};

/// Corner i has the larger x, y, z where bit 0, 1, 2 of i is set.
decomp::mesh::TriMesh block(const Eigen::AlignedBox3d& box) {
    decomp::mesh::TriMesh mesh;
    for (int i = 0; i < 8; ++i) {
        mesh.points.emplace_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
    }
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

Result<StepBody> body_of(std::string name, decomp::mesh::TriMesh mesh, double tolerance_mm,
                         std::array<double, 3> colour, const Run& run) {
    decomp::part::Part part;
    part.id = name;
    part.mesh = std::move(mesh);
    auto made = decomp::solid::make_solid(part, {.tolerance_mm = tolerance_mm}, run);
    if (!made) {
        return fail(made.error());
    }
    return StepBody{std::move(name), std::move(made->solid), colour};
}

}  // namespace

Result<StepBody> stock_body(const PartFacts& part, double room_mm, const Run& run) {
    const Eigen::Vector3d half(part.extent_mm.x() / 2 + room_mm, part.extent_mm.y() / 2 + room_mm,
                               0);
    const Eigen::AlignedBox3d box(-half,
                                  half + Eigen::Vector3d(0, 0, part.extent_mm.z() + room_mm));
    return body_of("stock", block(box), kExactMm, kStockColour, run);
}

Result<std::vector<StepBody>> fixture_bodies(const StepWish& wish, double tolerance_mm, Run& run) {
    std::vector<StepBody> bodies;
    bodies.reserve(wish.fixtures.size());
    for (const std::string& file : wish.fixtures) {
        MeshRequest request;
        request.path = file;
        auto mesh = read_solid(request, run);
        if (!mesh) {
            return fail(mesh.error());
        }
        const std::string name =
            wish.fixtures.size() == 1 ? "fixture" : "fixture-" + std::to_string(bodies.size() + 1);
        auto body = body_of(name, std::move(*mesh), tolerance_mm, kFixtureColour, run);
        if (!body) {
            return fail(body.error());
        }
        bodies.push_back(std::move(*body));
    }
    return bodies;
}

}  // namespace cam::job
