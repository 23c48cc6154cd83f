// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/mill_proof.h"

#include "cam/millproof/prove.h"
#include "cam/millproof/record.h"
#include "cam/render/render.h"
#include "decomp/base/number.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tools {

namespace {

constexpr std::size_t kFaultsTold = 8;
constexpr double kColourRangeMm = 0.5;

Eigen::AlignedBox3d moved(const Eigen::AlignedBox3d& box, const Eigen::Isometry3d& map) {
    Eigen::AlignedBox3d out;
    out.extend(map * box.min());
    out.extend(map * box.max());
    return out;
}

// What the proof is told of a set-up; `here` is the part in that set-up's frame and outlives the
// job.
cam::millproof::MillJob mill_job(const decomp::mesh::TriMesh& here, const cam::path::MillPlan& plan,
                                 std::size_t set_up, const cam::profile::MillSetup& setup) {
    const cam::path::MillProgram& planned = plan.programs[set_up];
    cam::millproof::MillJob job;
    job.part = &here;
    job.stock = planned.stock;
    job.safe_z = planned.safe_z;
    job.floor_z = planned.floor_z;
    job.border_holds = planned.hold == cam::path::Hold::Frame;
    job.keep_outs = planned.keep_outs;
    const Eigen::Isometry3d turn =
        planned.from_model.map() * plan.programs.front().from_model.map().inverse();
    for (const auto& keep : plan.keeps) {
        job.keeps.push_back(moved(keep.box, turn));
    }
    for (const auto& tool : plan.tools) {
        job.tools.push_back({tool, 0});
    }
    job.machine = setup.machine;
    job.dialect = setup.dialect;
    return job;
}

std::string proof_text(const cam::millproof::MillProof& proof) {
    const auto& figures = proof.figures;
    std::string text = std::string("  proof: ") + (proof.passed() ? "passed" : "FAILED") +
                       "; gouge " + decomp::decimal(figures.max_gouge_mm, 3) + ", rest " +
                       decomp::decimal(figures.excess_999_mm, 3) + " mm (99.9 %), out of reach " +
                       decomp::decimal(100 * figures.unreachable, 1) + " %, rapids into stock " +
                       std::to_string(figures.rapid_hits) + "\n";
    for (std::size_t i = 0; i < proof.faults.size() && i < kFaultsTold; ++i) {
        const auto& fault = proof.faults[i];
        text +=
            "    " + fault.kind + ", line " + std::to_string(fault.line) + ": " + fault.what + "\n";
    }
    if (proof.faults.size() > kFaultsTold) {
        text += "    and " + std::to_string(proof.faults.size() - kFaultsTold) + " more\n";
    }
    return text;
}

/// What remains of the block, from the front and above.
decomp::Result<std::string> picture_of(const cam::millproof::DeviationMesh& stock,
                                       decomp::Run& run) {
    namespace render = cam::render;
    const auto paint = [](double deviation_mm) {
        const auto rgb = cam::millproof::deviation_colour(deviation_mm, kColourRangeMm);
        return render::Rgb{rgb[0], rgb[1], rgb[2]};
    };
    render::Item item;
    item.mesh = &stock.mesh;
    item.triangle_colours.reserve(stock.colours.size());
    for (const auto& rgb : stock.colours) {
        item.triangle_colours.push_back({rgb[0], rgb[1], rgb[2]});
    }
    render::ViewOptions options;
    options.margin = 0.08;
    options.edges = false;
    const std::string range = decomp::decimal(kColourRangeMm, 1) + " MM";
    options.legend = {{paint(0), "AS THE PART"},
                      {paint(kColourRangeMm), range + " LEFT OR MORE"},
                      {paint(-kColourRangeMm), range + " TOO DEEP OR MORE"},
                      {paint(std::nan("")), "BESIDE THE PART"}};
    return render::render_meshes_png({item}, options, run);
}

}  // namespace

decomp::Result<ProvedMilling> prove_milling(const std::string& program,
                                            const cam::path::MillPlan& plan, std::size_t set_up,
                                            const decomp::mesh::TriMesh& part,
                                            const cam::profile::MillSetup& setup,
                                            decomp::Run& run) {
    decomp::mesh::TriMesh here = part;
    for (Eigen::Vector3d& p : here.points) {
        p = plan.programs[set_up].from_model * p;
    }
    const auto job = mill_job(here, plan, set_up, setup);
    // Ridges as high as was asked for are no fault: they come on top of what counts as reached.
    cam::millproof::ProofOptions options;
    options.max_excess_mm =
        std::max(options.max_excess_mm, options.reach_mm + plan.scallop_mm + plan.tolerance_mm);
    const auto proof = cam::millproof::prove(program, job, options);
    if (!proof) {
        return decomp::fail(proof.error());
    }
    const auto& figures = proof->figures;
    ProvedMilling out;
    out.passed = proof->passed();
    out.sidecar = cam::millproof::proof_json(*proof, program, job, options, setup.hash);
    const auto stock = cam::millproof::deviation_mesh(proof->stock, job, kColourRangeMm, 2);
    out.stock = cam::millproof::deviation_ply(stock);
    auto picture = picture_of(stock, run);
    if (!picture) {
        return decomp::fail(picture.error());
    }
    out.picture = std::move(*picture);
    out.figures = {{"passed", out.passed},
                   {"seconds", figures.seconds},
                   {"cut_mm", figures.cut_mm},
                   {"rapid_mm", figures.rapid_mm},
                   {"lines", figures.lines},
                   {"max_gouge_mm", figures.max_gouge_mm},
                   {"max_excess_mm", figures.max_excess_mm},
                   {"excess_999_mm", figures.excess_999_mm},
                   {"unreachable_percent", 100 * figures.unreachable},
                   {"rapid_hits", figures.rapid_hits},
                   {"faults", proof->faults.size()}};
    out.text = proof_text(*proof);
    return out;
}

}  // namespace tools
