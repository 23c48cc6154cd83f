// SPDX-License-Identifier: GPL-3.0-or-later
#include "cam/job/maker_detail.h"
#include "cam/orient/choose_build.h"
#include "decomp/io/read_tets.h"
#include "decomp/map/quantise.h"
#include "decomp/partition/partition.h"
#include "decomp/polycube/generate.h"
#include "decomp/tets/pair.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace cam::job {

using decomp::fail;
using decomp::Result;

profile::FdmMachine Maker::judged_machine() const {
    profile::FdmMachine machine = setup_.machine;
    if (job_.options.max_size_mm) {
        const Eigen::Vector3d excess =
            (orient::usable_mm(machine) - *job_.options.max_size_mm).cwiseMax(0);
        machine.chamber.min_mm.head<2>() += excess.head<2>() / 2;
        machine.chamber.max_mm.head<2>() -= excess.head<2>() / 2;
        machine.chamber.max_mm.z() -= excess.z();
    }
    return machine;
}

namespace {

using Map = std::shared_ptr<const decomp::pipeline::PolycubeMap>;

/// What a partition by this map would put into the wrong part: the score of a start.
double vote_error(const decomp::tets::Pair& pair, const decomp::tets::Lattice& lattice,
                  const decomp::mesh::TriMesh& volume) {
    decomp::Run quiet;
    decomp::partition::PartitionOptions options;
    options.limit_cuts = false;
    options.check_rounded = false;
    const auto found = decomp::partition::partition(volume, pair, lattice, options, quiet);
    return found ? found->figures.mislabeled_share : 1;
}

Result<Map> made_map(const decomp::mesh::TriMesh& model, decomp::Run& run) {
    auto made = decomp::polycube::generate(model, {}, vote_error, run);
    if (!made) {
        return fail(made.error());
    }
    decomp::pipeline::PolycubeMap map;
    map.pair = std::move(made->pair);
    map.lattice = std::move(made->lattice);
    map.tier = made->tier;
    return std::make_shared<const decomp::pipeline::PolycubeMap>(std::move(map));
}

}  // namespace

bool Maker::makes_polycube() const {
    if (!job_.options.polycube.empty()) {
        return false;
    }
    if (by_hand_.plan) {
        const auto& origin = by_hand_.plan->origin;
        return origin.polycube == "made" && origin.tier != "T4" &&
               std::any_of(by_hand_.edits.begin(), by_hand_.edits.end(), [](const auto& edit) {
                   return edit.kind == decomp::plan::Edit::Kind::Split;
               });
    }
    return job_.options.mode != "sections" && (job_.options.boxes || job_.options.mode == "paper");
}

Result<Map> Maker::map_for(const decomp::mesh::TriMesh& model, decomp::Run& run) const {
    const std::vector<std::string>& files = job_.options.polycube;
    if (makes_polycube()) {
        decomp::Run seeded = run;
        seeded.seed = by_hand_.plan ? by_hand_.plan->origin.seed : run.seed;
        return made_map(model, seeded);
    }
    if (files.empty()) {
        return Map();
    }
    if (files.size() != 2) {
        return fail("job.polycube", "a polycube is two files of tets, the shape and its polycube");
    }
    auto shape =
        decomp::io::read_tets(files[0], {.scale = job_.options.scale, .unit = job_.options.unit});
    auto polycube = decomp::io::read_tets(files[1], {});
    if (!shape || !polycube) {
        return fail(shape ? polycube.error() : shape.error());
    }
    auto pair = decomp::tets::pair_of(std::move(*shape), std::move(*polycube));
    if (!pair) {
        return fail(pair.error());
    }
    using RowMajor = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
    const Eigen::Matrix3d turn =
        Eigen::Map<const RowMajor>(job_.model.model_from_file.data()).topLeftCorner<3, 3>();
    for (Eigen::Vector3d& point : pair->shape) {
        point = turn * point;
    }
    decomp::pipeline::PolycubeMap map;
    map.pair = std::move(*pair);
    map.lattice = decomp::map::lattice_of(map.pair);
    map.tier = "imported";
    return std::make_shared<const decomp::pipeline::PolycubeMap>(std::move(map));
}

}  // namespace cam::job
