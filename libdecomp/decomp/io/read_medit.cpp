// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/formats.h"
#include "decomp/io/text_scanner.h"

#include <algorithm>
#include <limits>

namespace decomp::io {

namespace {

constexpr std::int64_t kMostRows = std::numeric_limits<std::uint32_t>::max();

/// One kind of element of the file that matters here.
struct Section {
    std::string_view keyword;
    std::size_t corners;
};

constexpr Section kTriangles{"Triangles", 3};
constexpr Section kQuadrilaterals{"Quadrilaterals", 4};
constexpr Section kTetrahedra{"Tetrahedra", 4};
constexpr Section kHexahedra{"Hexahedra", 8};

/// Reads a Medit ASCII file (Frey, INRIA RT-0253): keyword, count, rows; unknown keywords are
/// passed over.
class MeditParser {
  public:
    MeditParser(std::string_view bytes, std::string_view name) : scanner_(bytes, name) {}

    Result<mesh::TriMesh> surface() {
        if (Status status = sections(); !status) {
            return fail(status.error());
        }
        if (!cells_.tetrahedra.empty() || !cells_.hexahedra.empty()) {
            return boundary_of(cells_, std::move(mesh_));
        }
        for (std::size_t i = 0; i + 3 <= triangles_.size(); i += 3) {
            mesh_.triangles.push_back({triangles_[i], triangles_[i + 1], triangles_[i + 2]});
        }
        for (std::size_t i = 0; i + 4 <= quads_.size(); i += 4) {
            append_polygon(mesh_, {quads_[i], quads_[i + 1], quads_[i + 2], quads_[i + 3]});
        }
        return std::move(mesh_);
    }

    Result<Volume> volume() {
        if (Status status = sections(); !status) {
            return fail(status.error());
        }
        return Volume{std::move(mesh_.points), std::move(cells_)};
    }

  private:
    Status sections() {
        for (std::string_view word = scanner_.word(); !word.empty() && word != "End";
             word = scanner_.word()) {
            if (Status status = section(word); !status) {
                return status;
            }
        }
        return {};
    }

    Status section(std::string_view keyword) {
        if (keyword == "Dimension") {
            return dimension();
        }
        if (keyword == "Vertices") {
            return vertices();
        }
        if (keyword == kTriangles.keyword) {
            return rows(kTriangles, triangles_);
        }
        if (keyword == kQuadrilaterals.keyword) {
            return rows(kQuadrilaterals, quads_);
        }
        if (keyword == kTetrahedra.keyword) {
            return rows(kTetrahedra, cells_.tetrahedra);
        }
        if (keyword == kHexahedra.keyword) {
            return rows(kHexahedra, cells_.hexahedra);
        }
        const char first = keyword.front();
        const bool number =
            (first >= '0' && first <= '9') || first == '-' || first == '+' || first == '.';
        const bool letter = lower(first) >= 'a' && lower(first) <= 'z';
        if (!number && !letter) {
            return scanner_.expected("a keyword");
        }
        return {};  // a section of no use here: its numbers come by here too
    }

    Status dimension() {
        std::int64_t value = 0;
        if (!scanner_.integer(value)) {
            return scanner_.expected("the dimension");
        }
        if (value != 3) {
            return scanner_.error("io.unsupported",
                                  "a mesh of dimension " + std::to_string(value) + ", not 3");
        }
        return {};
    }

    Result<std::size_t> count() {
        std::int64_t value = 0;
        if (!scanner_.integer(value)) {
            return scanner_.expected("a count");
        }
        if (value < 0 || value > kMostRows) {
            return scanner_.error("io.too_large", "a count of " + std::to_string(value));
        }
        return static_cast<std::size_t>(value);
    }

    Status vertices() {
        const Result<std::size_t> wanted = count();
        if (!wanted) {
            return fail(wanted.error());
        }
        mesh_.points.reserve(std::min(*wanted, scanner_.rest() / 8));
        double reference = 0;
        for (std::size_t i = 0; i < *wanted; ++i) {
            Eigen::Vector3d point;
            for (int axis = 0; axis < 3; ++axis) {
                if (!scanner_.number(point[axis])) {
                    return scanner_.expected("a coordinate");
                }
            }
            if (!point.allFinite()) {
                return scanner_.error("io.not_finite", "a coordinate that is no number");
            }
            if (!scanner_.number(reference)) {
                return scanner_.expected("the reference of a vertex");
            }
            mesh_.points.push_back(point);
        }
        return {};
    }

    Status rows(const Section& kind, std::vector<std::uint32_t>& out) {
        const Result<std::size_t> wanted = count();
        if (!wanted) {
            return fail(wanted.error());
        }
        out.reserve(std::min(*wanted, scanner_.rest() / (2 * kind.corners)) * kind.corners);
        std::int64_t value = 0;
        for (std::size_t i = 0; i < *wanted; ++i) {
            for (std::size_t k = 0; k < kind.corners; ++k) {
                if (!scanner_.integer(value)) {
                    return scanner_.expected("the number of a vertex");
                }
                if (value < 1 || static_cast<std::size_t>(value) > mesh_.points.size()) {
                    return scanner_.error("io.index_out_of_range",
                                          "an element names vertex " + std::to_string(value) +
                                              " of " + std::to_string(mesh_.points.size()) +
                                              " (the first is 1)");
                }
                out.push_back(static_cast<std::uint32_t>(value - 1));
            }
            if (!scanner_.integer(value)) {
                return scanner_.expected("the reference of an element");
            }
        }
        return {};
    }

    TextScanner scanner_;
    mesh::TriMesh mesh_;
    Cells cells_;
    std::vector<std::uint32_t> triangles_;
    std::vector<std::uint32_t> quads_;
};

}  // namespace

Result<mesh::TriMesh> parse_medit(std::string_view bytes, std::string_view name) {
    return MeditParser(bytes, name).surface();
}

Result<Volume> parse_medit_volume(std::string_view bytes, std::string_view name) {
    return MeditParser(bytes, name).volume();
}

}  // namespace decomp::io
