// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/cells/cells.h"

#include "decomp/cells/divide.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace decomp::cells {

namespace {

constexpr double kOnPlane = 1e-9;  // of the lattice's extent

/// A face that two sub-tets share.
struct InnerFace {
    std::array<std::uint32_t, 3> corners{};
    std::uint32_t a = 0;
    std::uint32_t b = 0;
};

Status check(const tets::Pair& pair, const tets::Lattice& lattice) {
    const auto finite = [](const Eigen::Vector3d& p) { return p.allFinite(); };
    if (pair.tets.empty() || pair.shape.size() != pair.polycube.size() ||
        !std::all_of(pair.shape.begin(), pair.shape.end(), finite) ||
        !std::all_of(pair.polycube.begin(), pair.polycube.end(), finite)) {
        return fail("cells.bad_pair",
                    "the pair holds no tets, or its points do not belong together");
    }
    for (const tets::Tet& tet : pair.tets) {
        for (const std::uint32_t corner : tet) {
            if (corner >= pair.shape.size()) {
                return fail("cells.bad_pair", "a tet names a point that is missing");
            }
        }
    }
    for (const std::vector<double>& planes : lattice.planes) {
        const bool ascending =
            std::adjacent_find(planes.begin(), planes.end(),
                               [](double l, double r) { return !(l < r); }) == planes.end();
        if (planes.size() < 2 || !ascending) {
            return fail("cells.bad_lattice", "the planes of the polycube do not ascend");
        }
    }
    return {};
}

/// Six times the signed volume.
double determinant(const std::vector<Eigen::Vector3d>& points, const tets::Tet& tet) {
    const Eigen::Vector3d& o = points[tet[0]];
    return (points[tet[1]] - o).cross(points[tet[2]] - o).dot(points[tet[3]] - o);
}

double area(const CellComplex& complex, const std::array<std::uint32_t, 3>& t) {
    const Eigen::Vector3d& o = complex.shape[t[0]];
    return (complex.shape[t[1]] - o).cross(complex.shape[t[2]] - o).norm() / 2;
}

/// Marks the tets whose turn differs from that of most of the volume.
void mark_flipped(CellComplex& complex) {
    double balance = 0;
    for (SubTet& tet : complex.tets) {
        const double in_shape = determinant(complex.shape, tet.corners);
        const double in_polycube = determinant(complex.polycube, tet.corners);
        tet.volume_mm3 = std::abs(in_shape) / 6;
        complex.volume_mm3 += tet.volume_mm3;
        const double product = in_shape * in_polycube;
        balance += product > 0 ? tet.volume_mm3 : product < 0 ? -tet.volume_mm3 : 0;
    }
    const double turn = balance < 0 ? -1 : 1;
    for (SubTet& tet : complex.tets) {
        tet.flipped = turn * determinant(complex.shape, tet.corners) *
                          determinant(complex.polycube, tet.corners) <=
                      0;
        complex.flipped += tet.flipped ? 1 : 0;
        complex.flipped_share += tet.flipped ? tet.volume_mm3 : 0;
    }
    complex.flipped_share /= complex.volume_mm3 > 0 ? complex.volume_mm3 : 1;
}

/// The corners of a tet but one, ascending.
std::array<std::uint32_t, 3> sorted_face(const tets::Tet& tet, std::size_t skip) {
    std::array<std::uint32_t, 3> out{};
    std::size_t n = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        if (k != skip) {
            out.at(n++) = tet.at(k);
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

std::vector<InnerFace> inner_faces(const CellComplex& complex) {
    struct Half {
        std::array<std::uint32_t, 3> corners;
        std::uint32_t tet;
    };

    std::vector<Half> halves;
    halves.reserve(complex.tets.size() * 4);
    for (std::uint32_t i = 0; i < complex.tets.size(); ++i) {
        const tets::Tet& t = complex.tets[i].corners;
        for (std::size_t skip = 0; skip < 4; ++skip) {
            halves.push_back({sorted_face(t, skip), i});
        }
    }
    std::sort(halves.begin(), halves.end(), [](const Half& l, const Half& r) {
        return l.corners != r.corners ? l.corners < r.corners : l.tet < r.tet;
    });
    std::vector<InnerFace> out;
    for (std::size_t i = 0; i + 1 < halves.size(); ++i) {
        if (halves[i].corners == halves[i + 1].corners) {
            out.push_back({halves[i].corners, halves[i].tet, halves[i + 1].tet});
        }
    }
    return out;
}

std::array<int, 3> index_of(const CellComplex& complex, const SubTet& tet,
                            const tets::Lattice& lattice) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const std::uint32_t corner : tet.corners) {
        centre += complex.polycube[corner] / 4;
    }
    std::array<int, 3> out{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::vector<double>& planes = lattice.planes.at(axis);
        out.at(axis) = static_cast<int>(std::upper_bound(planes.begin() + 1, planes.end() - 1,
                                                         centre[static_cast<Eigen::Index>(axis)]) -
                                        (planes.begin() + 1));
    }
    return out;
}

/// Sub-tets of one index that hang together.
void group(CellComplex& complex, const std::vector<InnerFace>& faces,
           const tets::Lattice& lattice) {
    std::vector<std::array<int, 3>> index;
    index.reserve(complex.tets.size());
    for (const SubTet& tet : complex.tets) {
        index.push_back(index_of(complex, tet, lattice));
    }
    std::vector<std::uint32_t> parent(complex.tets.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&](std::uint32_t i) {
        while (parent[i] != i) {
            i = parent[i] = parent[parent[i]];
        }
        return i;
    };
    for (const InnerFace& face : faces) {
        if (index[face.a] == index[face.b]) {
            const std::uint32_t a = root(face.a);
            const std::uint32_t b = root(face.b);
            parent[std::max(a, b)] = std::min(a, b);
        }
    }
    for (std::uint32_t i = 0; i < complex.tets.size(); ++i) {
        const std::uint32_t r = root(i);
        if (r == i) {
            complex.tets[i].cell = static_cast<std::int32_t>(complex.cells.size());
            complex.cells.push_back({index[i], 0});
        } else {
            complex.tets[i].cell = complex.tets[r].cell;
        }
        complex.cells[static_cast<std::size_t>(complex.tets[i].cell)].volume_mm3 +=
            complex.tets[i].volume_mm3;
    }
}

void list_contacts(CellComplex& complex, const std::vector<InnerFace>& faces) {
    std::map<std::pair<std::int32_t, std::int32_t>, double> areas;
    for (const InnerFace& face : faces) {
        const std::int32_t a = complex.tets[face.a].cell;
        const std::int32_t b = complex.tets[face.b].cell;
        if (a != b) {
            areas[std::minmax(a, b)] += area(complex, face.corners);
        }
    }
    complex.contacts.clear();
    for (const auto& [ends, sum] : areas) {
        complex.contacts.push_back({ends.first, ends.second, sum});
    }
}

void list_pieces(CellComplex& complex, const std::vector<InnerFace>& faces) {
    for (const InnerFace& face : faces) {
        std::int32_t lower = complex.tets[face.a].cell;
        std::int32_t upper = complex.tets[face.b].cell;
        if (lower == upper) {
            continue;
        }
        int steps = 0;
        std::size_t axis = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const int step = complex.cells[static_cast<std::size_t>(upper)].index.at(k) -
                             complex.cells[static_cast<std::size_t>(lower)].index.at(k);
            steps += std::abs(step);
            axis = step != 0 ? k : axis;
        }
        if (steps != 1) {
            continue;
        }
        if (complex.cells[static_cast<std::size_t>(upper)].index.at(axis) <
            complex.cells[static_cast<std::size_t>(lower)].index.at(axis)) {
            std::swap(lower, upper);
        }
        complex.pieces.push_back({face.corners, static_cast<int>(axis),
                                  complex.cells[static_cast<std::size_t>(upper)].index.at(axis),
                                  lower, upper, area(complex, face.corners)});
    }
}

}  // namespace

Result<CellComplex> cells_of(const tets::Pair& pair, const tets::Lattice& lattice,
                             const CellOptions& options) {
    if (Status sound = check(pair, lattice); !sound) {
        return fail(sound.error());
    }
    CellComplex out;
    out.shape = pair.shape;
    out.polycube = pair.polycube;
    out.tets.reserve(pair.tets.size());
    for (const tets::Tet& tet : pair.tets) {
        out.tets.push_back({tet, -1, 0, false});
    }
    mark_flipped(out);
    if (!(out.volume_mm3 > 0)) {
        return fail("cells.bad_pair", "the tets enclose no volume");
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::vector<double>& planes = lattice.planes.at(axis);
        for (std::size_t k = 1; k + 1 < planes.size(); ++k) {
            divide_at(out, static_cast<int>(axis), planes[k],
                      kOnPlane * (planes.back() - planes.front()));
        }
    }
    for (SubTet& tet : out.tets) {
        tet.volume_mm3 = std::abs(determinant(out.shape, tet.corners)) / 6;
    }
    const std::vector<InnerFace> faces = inner_faces(out);
    group(out, faces, lattice);
    list_contacts(out, faces);
    absorb_small(out, options.absorb_share * out.volume_mm3);
    list_contacts(out, faces);
    list_pieces(out, faces);
    return out;
}

}  // namespace decomp::cells
