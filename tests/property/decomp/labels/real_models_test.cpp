// SPDX-License-Identifier: GPL-3.0-or-later
// Labels of scans, statues and mechanical parts, found through HEW_MODELS.
#include "decomp/io/read_mesh.h"
#include "decomp/labels/label.h"
#include "decomp/labels/report.h"
#include "decomp/mesh/check.h"
#include "decomp/proxy/proxy.h"
#include "decomp/repair/repair.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace {

using decomp::labels::LabelReport;

class RealModels : public testing::Test {
  protected:
    void SetUp() override {
        const char* models = std::getenv("HEW_MODELS");
        if (models == nullptr) {
            GTEST_SKIP() << "HEW_MODELS is not set";
        }
        folder_ = models;
    }

    /// The surface to label, of a model first remeshed to about `input` triangles (0: as it is).
    decomp::mesh::TriMesh surface(const std::string& model, int input = 0) {
        const auto read = decomp::io::read_mesh(folder_ / model, {}, run_);
        EXPECT_TRUE(read) << model;
        auto volume = decomp::repair::repair(*read, {}, run_)->mesh;
        if (input > 0) {
            volume = decomp::proxy::make_proxy(volume, {.triangles = input}, run_)->surface;
        }
        const auto proxy = decomp::proxy::make_proxy(volume, {}, run_);
        EXPECT_TRUE(proxy) << model;
        EXPECT_FALSE(proxy->wrapped) << model;
        return proxy->surface;
    }

    LabelReport labelled(const decomp::mesh::TriMesh& surface, double compactness) {
        const auto labels = decomp::labels::label(surface, {}, {.compactness = compactness}, run_);
        EXPECT_TRUE(labels);
        return decomp::labels::report(surface, *labels);
    }

    std::filesystem::path folder_;
    decomp::Run run_;
};

TEST_F(RealModels, AllTwelveAreLabelledValidlyWithAtMostThreeTurningPoints) {
    const std::vector<std::pair<std::string, double>> models{
        {"paper/av_angel1.mesh", 5},     {"paper/av_duck.mesh", 5},
        {"paper/av_moai.mesh", 3},       {"paper/av_fandisk.mesh", 4},
        {"paper/hfd_BU.obj", 9},         {"paper/hfd_maxplank.obj", 7},
        {"paper/cinolib_3holes.obj", 3}, {"real/od_spot.obj", 5},
        {"real/od_hammer.obj", 5},       {"real/tm_plate_holes.stl", 5},
        {"real/av_chamfer.mesh", 5},     {"real/od_nefertiti_lr.obj", 5}};
    int turning_points = 0;
    for (const auto& [model, compactness] : models) {
        const LabelReport is = labelled(surface(model), compactness);
        EXPECT_TRUE(is.valid()) << model;
        EXPECT_GT(is.fidelity, 0.75) << model;
        turning_points += is.turning_points;
    }
    EXPECT_LE(turning_points, 3);
}

TEST_F(RealModels, ChartsHardlyDependOnTheResolutionOfTheInput) {
    const auto near = [](int a, int b) {
        return std::abs(a - b) <= std::max(2, std::max(a, b) / 5);
    };
    const int bu = labelled(surface("paper/hfd_BU.obj"), 9).charts;
    for (const int triangles : {7000, 25000}) {
        EXPECT_TRUE(near(labelled(surface("paper/hfd_BU.obj", triangles), 9).charts, bu))
            << triangles;
    }
    const int moai = labelled(surface("paper/av_moai.mesh"), 3).charts;
    for (const int triangles : {5000, 10000}) {
        EXPECT_TRUE(near(labelled(surface("paper/av_moai.mesh", triangles), 3).charts, moai))
            << triangles;
    }
}

TEST_F(RealModels, ChartsRiseAtMostOnceWhileCompactnessRises) {
    for (const char* model :
         {"paper/hfd_BU.obj", "paper/av_moai.mesh", "paper/av_fandisk.mesh", "real/od_spot.obj"}) {
        const auto one = surface(model);
        int rises = 0;
        int before = 1000;
        for (int compactness = 1; compactness <= 10; ++compactness) {
            const int charts = labelled(one, compactness).charts;
            rises += charts > before ? 1 : 0;
            before = charts;
        }
        EXPECT_LE(rises, 1) << model;
    }
}

}  // namespace
