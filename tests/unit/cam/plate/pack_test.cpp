// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/plate/pack.h"

#include "cam/orient/choose_build.h"
#include "cam/profile/bed_area.h"
#include "cam/profile/read_profile.h"
#include "decomp/base/rng.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace {

using cam::plate::Footprint;
using cam::plate::pack;
using cam::plate::Placement;
using Eigen::Vector2d;

cam::profile::FdmMachine machine() {
    return cam::profile::read_fdm_setup("flashforge-creator-pro")->machine;
}

Footprint rectangle(double width, double depth) {
    return {"r",
            {{-width / 2, -depth / 2},
             {width / 2, -depth / 2},
             {width / 2, depth / 2},
             {-width / 2, depth / 2}},
            10};
}

double distance_to_segment(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
    const Vector2d ab = b - a;
    const double t =
        ab.squaredNorm() > 0 ? std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0) : 0.0;
    return (p - a - t * ab).norm();
}

bool contains(const std::vector<Vector2d>& polygon, const Vector2d& p) {
    bool inside = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const Vector2d& a = polygon[i];
        const Vector2d& b = polygon[j];
        if ((a.y() > p.y()) != (b.y() > p.y()) &&
            p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) {
            inside = !inside;
        }
    }
    return inside;
}

/// Brute force, sharing nothing with the packer: corners against edges both ways; 0 when one lies
/// in the other.
double distance(const std::vector<Vector2d>& p, const std::vector<Vector2d>& q) {
    if (contains(p, q.front()) || contains(q, p.front())) {
        return 0;
    }
    double least = 1e300;
    for (std::size_t i = 0; i < p.size(); ++i) {
        for (std::size_t j = 0; j < q.size(); ++j) {
            least = std::min({least, distance_to_segment(p[i], q[j], q[(j + 1) % q.size()]),
                              distance_to_segment(q[j], p[i], p[(i + 1) % p.size()])});
        }
    }
    return least;
}

std::vector<Vector2d> moved(const Footprint& part, const Placement& placement) {
    std::vector<Vector2d> out = part.outline;
    for (Vector2d& point : out) {
        point += placement.offset;
    }
    return out;
}

void expect_sound(const std::vector<Footprint>& parts, const std::vector<Placement>& placements,
                  const cam::profile::FdmMachine& on) {
    ASSERT_EQ(placements.size(), parts.size());
    const cam::profile::BedArea area = cam::profile::bed_area(on);
    std::set<int> plates;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        EXPECT_EQ(placements[i].part, i);
        plates.insert(placements[i].plate);
        for (const Vector2d& point : moved(parts[i], placements[i])) {
            EXPECT_GE((point - area.min_mm).minCoeff(), -1e-5);
            EXPECT_GE((area.max_mm - point).minCoeff(), -1e-5);
        }
        for (std::size_t k = 0; k < i; ++k) {
            if (placements[i].plate == placements[k].plate) {
                EXPECT_GE(distance(moved(parts[i], placements[i]), moved(parts[k], placements[k])),
                          on.process.part_spacing_mm - 1e-5);
            }
        }
    }
    EXPECT_EQ(*plates.begin(), 0);
    EXPECT_EQ(*plates.rbegin(), static_cast<int>(plates.size()) - 1);
}

int plate_count(const std::vector<Placement>& placements) {
    int most = -1;
    for (const Placement& placement : placements) {
        most = std::max(most, placement.plate);
    }
    return most + 1;
}

TEST(Pack, OnePartLiesInTheMiddleOfTheBed) {
    const auto placements = pack({rectangle(50, 30)}, machine());
    ASSERT_TRUE(placements);
    EXPECT_NEAR(placements->front().offset.norm(), 0, 1e-9);
    const auto corner =
        pack({rectangle(50, 30)}, cam::profile::read_fdm_setup("prusa-mk3s")->machine);
    EXPECT_NEAR((corner->front().offset - Vector2d(125, 105)).norm(), 0, 1e-9);
}

TEST(Pack, APartThatFillsTheBedFitsAndOneALittleLargerDoesNot) {
    const Vector2d room = cam::profile::bed_area(machine()).size_mm();
    EXPECT_TRUE(pack({rectangle(room.x(), room.y())}, machine()));
    const auto large = pack(
        {rectangle(20, 20), {"P07", rectangle(room.x() + 0.01, room.y()).outline, 5}}, machine());
    ASSERT_FALSE(large);
    EXPECT_EQ(large.error().code, "plate.part_too_large");
    EXPECT_EQ(large.error().where, "P07");
    Footprint tall = rectangle(10, 10);
    tall.height_mm = 148.1;
    EXPECT_FALSE(pack({tall}, machine()));
}

TEST(Pack, APartThatJustPassesItsJudgeFitsAPlate) {
    for (const char* name : {"flashforge-creator-pro", "prusa-mk3s"}) {
        for (const char* brim : {"0", "5"}) {
            const auto on = cam::profile::read_fdm_setup(
                                name, "", {std::string("process.brim_width_mm=") + brim})
                                ->machine;
            Eigen::Vector3d size = cam::orient::usable_mm(on);
            if (on.process.brim_width_mm > 0) {
                size.head<2>().array() += 2 * cam::orient::border_mm(on);
            }
            Footprint part = rectangle(size.x(), size.y());
            part.height_mm = size.z();
            const auto placements = pack({part}, on);
            EXPECT_TRUE(placements) << placements.error().text();
        }
    }
}

TEST(Pack, EqualSquaresFillTheirRows) {
    // 215 x 136 mm hold 4 x 2 squares of 45 mm with 6 mm between them, 3 x 46 + 2 x 6 = 150 would
    // be too high
    std::vector<Footprint> parts(8, rectangle(45, 45));
    auto placements = pack(parts, machine());
    ASSERT_TRUE(placements);
    expect_sound(parts, *placements, machine());
    EXPECT_EQ(plate_count(*placements), 1);
    parts.push_back(rectangle(45, 45));
    EXPECT_EQ(plate_count(pack(parts, machine()).value()), 2);
}

TEST(Pack, ManySmallPartsFillThePlate) {
    const std::vector<Footprint> parts(70, rectangle(14, 14));
    const auto placements = pack(parts, machine());
    ASSERT_TRUE(placements);
    expect_sound(parts, *placements, machine());
    // 11 columns and 7 rows of 20 mm less one gap fit on the first plate
    EXPECT_EQ(plate_count(*placements), 1);
}

TEST(Pack, NoPartsNeedNoPlate) { EXPECT_TRUE(pack({}, machine())->empty()); }

TEST(Pack, TrianglesNestAcrossTheirBoxes) {
    // two right triangles whose boxes do not fit beside each other share a plate
    const Footprint lower{"a", {{0, 0}, {120, 0}, {0, 120}}, 10};
    const Footprint upper{"b", {{120, 120}, {0, 120}, {120, 0}}, 10};
    const std::vector<Footprint> parts = {lower, upper};
    const auto placements = pack(parts, machine());
    ASSERT_TRUE(placements);
    expect_sound(parts, *placements, machine());
    EXPECT_EQ(plate_count(*placements), 1);
}

TEST(Pack, RandomHullsKeepTheirDistance) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        decomp::Rng rng(seed);
        std::vector<Footprint> parts;
        for (int i = 0; i < 12; ++i) {
            Footprint part{"P", {}, rng.uniform(5, 140)};
            const double a = rng.uniform(8, 60);
            const double b = rng.uniform(8, 60);
            const double turn = rng.uniform(0, 3);
            const int corners = 3 + static_cast<int>(rng.below(20));
            for (int k = 0; k < corners; ++k) {
                const double angle = 2 * std::numbers::pi * k / corners;
                const Vector2d p(a * std::cos(angle), b * std::sin(angle));
                part.outline.emplace_back(std::cos(turn) * p.x() - std::sin(turn) * p.y(),
                                          std::sin(turn) * p.x() + std::cos(turn) * p.y());
            }
            parts.push_back(part);
        }
        const auto placements = pack(parts, machine());
        ASSERT_TRUE(placements) << placements.error().text();
        expect_sound(parts, *placements, machine());
        const auto again = pack(parts, machine());
        for (std::size_t i = 0; i < parts.size(); ++i) {
            EXPECT_EQ(again->at(i).offset, placements->at(i).offset);
        }
    }
}

}  // namespace
