// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/partition/partition.h"

#include "decomp/partition/cuts.h"
#include "decomp/partition/heal.h"
#include "decomp/partition/votes.h"
#include "decomp/sheets/paper.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace decomp::partition {

namespace {

constexpr std::array<double, 4> kOtherNudges{5.0 / 3, 7.0 / 3, 10.0 / 3, 5};

/// For each atom the first of its piece: those of one label that hang together.
std::vector<std::size_t> pieces_of(const std::vector<Atom>& atoms,
                                   const std::vector<std::int32_t>& labels) {
    std::map<std::int32_t, std::size_t> number;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        number[atoms[i].region] = i;
    }
    std::vector<std::size_t> piece(atoms.size());
    std::iota(piece.begin(), piece.end(), 0U);
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        for (const part::FacetSource& source : atoms[i].part.sources) {
            if (!source.is_cut()) {
                continue;
            }
            const std::size_t other = number.at(source.neighbour);
            if (labels[other] == labels[i] && piece[other] != piece[i]) {
                const auto [into, from] = std::minmax(piece[i], piece[other]);
                std::replace(piece.begin(), piece.end(), std::size_t{from}, std::size_t{into});
            }
        }
    }
    return piece;
}

/// Joins atoms of one label that touch: everything between them vanishes. A label may have several
/// pieces only where no neighbour could take them.
std::vector<BoxPart> merged(cut::Complex& complex, const std::vector<Atom>& atoms,
                            const std::vector<std::int32_t>& labels) {
    const std::vector<std::size_t> piece = pieces_of(atoms, labels);
    std::map<std::size_t, Tally> tallies;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        Tally& tally = tallies.try_emplace(piece[i], atoms[i].tally.size(), 0.0).first->second;
        for (std::size_t box = 0; box < tally.size(); ++box) {
            tally[box] += atoms[i].tally[box];
        }
        if (piece[i] != i) {
            complex.merge(atoms[piece[i]].region, atoms[i].region);
        }
    }
    std::vector<BoxPart> out;
    for (const auto& [first, tally] : tallies) {
        BoxPart part;
        part.region = atoms[first].region;
        const auto label = static_cast<std::size_t>(labels[first]);
        const double all = std::accumulate(tally.begin(), tally.end(), 0.0);
        if (label < tally.size()) {
            part.box = labels[first];
            part.votes_share = all > 0 ? tally[label] / all : 0;
        }
        out.push_back(part);
    }
    std::sort(out.begin(), out.end(), [](const BoxPart& l, const BoxPart& r) {
        return std::tie(l.box, l.region) < std::tie(r.box, r.region);
    });
    return out;
}

void measure(const Ballot& ballot, const std::vector<Atom>& atoms,
             const std::vector<std::int32_t>& labels, const std::vector<BoxPart>& parts,
             Figures& figures) {
    double placed = 0;
    double right = 0;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
        placed += std::accumulate(atoms[i].tally.begin(), atoms[i].tally.end(), 0.0);
        const auto label = static_cast<std::size_t>(labels[i]);
        right += label < atoms[i].tally.size() ? atoms[i].tally[label] : 0;
    }
    figures.mislabeled_share = placed > 0 ? 1 - right / placed : 1;
    for (std::size_t box = 0; box < ballot.of_boxes().size(); ++box) {
        figures.collapsed_boxes += std::none_of(
            parts.begin(), parts.end(),
            [&](const BoxPart& part) { return part.box == static_cast<std::int32_t>(box); });
    }
}

}  // namespace

namespace {

/// Cut by planes that are nudged by this share of the diagonal.
Result<Partition> attempt(const cut::Complex& uncut, const cells::CellComplex& cells,
                          const sheets::Sheets& sheets, const PartitionOptions& options,
                          const Run& run) {
    Partition out{uncut, cells, sheets, {}, {}};
    const Ballot ballot(cells, sheets);
    const Result<std::vector<Atom>> atoms =
        cut_by_votes(out.complex, ballot, out.sheets, options, out.figures, run);
    if (!atoms) {
        return fail(atoms.error());
    }
    const std::vector<std::int32_t> labels = healed_labels(
        out.complex, *atoms, options.least_thickness_share * sheets.diagonal_mm, out.figures);
    out.parts = merged(out.complex, *atoms, labels);
    measure(ballot, *atoms, labels, out.parts, out.figures);
    return out;
}

Status rounds_well(const Partition& found, const Run& run) {
    std::vector<std::int32_t> order;
    for (const BoxPart& part : found.parts) {
        order.push_back(part.region);
    }
    const Result<part::Assembly> assembly = found.complex.assemble(order, run);
    return assembly ? Status{} : fail(assembly.error());
}

}  // namespace

Result<Partition> partition(const mesh::TriMesh& volume, const tets::Pair& pair,
                            const tets::Lattice& lattice, const PartitionOptions& options,
                            Run& run) {
    const Result<cells::CellComplex> cells = cells::cells_of(pair, lattice, options.cells);
    if (!cells) {
        return fail(cells.error());
    }
    const Result<cut::Complex> complex = cut::Complex::from_volume(volume);
    if (!complex) {
        return fail(complex.error());
    }
    const sheets::Sheets sheets = options.paper
                                      ? sheets::paper_sheets(*cells, lattice, options.sheets)
                                      : sheets::sheets_of(*cells, options.sheets);
    Result<Partition> out = attempt(*complex, *cells, sheets, options, run);
    for (const double factor : kOtherNudges) {
        if (!out || !options.check_rounded) {
            break;
        }
        const Status sound = rounds_well(*out, run);
        if (sound) {
            break;
        }
        if (sound.error().code != "cut.rounding_intersects") {
            return fail(sound.error());
        }
        PartitionOptions other = options;
        other.nudge_share *= factor;
        out = attempt(*complex, *cells, sheets, other, run);
    }
    return out;
}

}  // namespace decomp::partition
