// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/formats.h"
#include "decomp/io/text_scanner.h"

#include <algorithm>
#include <string>

namespace decomp::io {

namespace {

constexpr std::int64_t kVtkTetra = 10;
constexpr std::int64_t kVtkHexahedron = 12;

/// Reads a legacy VTK file (ASCII, UNSTRUCTURED_GRID), versions 1 to 5: points and cells; whatever
/// stands before, between and after is passed over.
class VtkParser {
  public:
    VtkParser(std::string_view bytes, std::string_view name) : scanner_(bytes, name, '\0') {}

    Result<Volume> parse() {
        // Two lines that may hold anything: the version and a title.
        if (!scanner_.next_line() || !scanner_.next_line()) {
            return scanner_.error("io.truncated", "the file ends in its header");
        }
        if (const std::string_view coding = scanner_.word();
            !equals_ignoring_case(coding, "ASCII")) {
            return scanner_.error("io.unsupported", "a VTK file that is not ASCII",
                                  "save it as legacy VTK, ASCII");
        }
        for (std::string_view word = scanner_.word(); !word.empty(); word = scanner_.word()) {
            Status status;
            if (equals_ignoring_case(word, "DATASET")) {
                if (!equals_ignoring_case(scanner_.word(), "UNSTRUCTURED_GRID")) {
                    return scanner_.error("io.unsupported", "a VTK dataset without cells",
                                          "save it as an unstructured grid");
                }
            } else if (equals_ignoring_case(word, "POINTS")) {
                status = points();
            } else if (equals_ignoring_case(word, "CELLS")) {
                status = cells();
            } else if (equals_ignoring_case(word, "CELL_TYPES")) {
                status = types();
            } else if (equals_ignoring_case(word, "CELL_DATA") ||
                       equals_ignoring_case(word, "POINT_DATA")) {
                break;
            }
            if (!status) {
                return fail(status.error());
            }
        }
        return volume();
    }

  private:
    Result<std::size_t> count() {
        std::int64_t value = 0;
        if (!scanner_.integer(value)) {
            return scanner_.expected("a count");
        }
        if (value < 0 || static_cast<std::uint64_t>(value) > scanner_.rest()) {
            return scanner_.error("io.too_large", "a count of " + std::to_string(value) +
                                                      ", more than the file can hold");
        }
        return static_cast<std::size_t>(value);
    }

    Status points() {
        const Result<std::size_t> wanted = count();
        if (!wanted) {
            return fail(wanted.error());
        }
        scanner_.word();  // the type of the numbers
        volume_.points.reserve(std::min(*wanted, scanner_.rest() / 6));
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
            volume_.points.push_back(point);
        }
        return {};
    }

    /// "CELLS n size" and n rows of corners; since version 5 "CELLS n+1 size", OFFSETS,
    /// CONNECTIVITY.
    Status cells() {
        const Result<std::size_t> first = count();
        const Result<std::size_t> second = first ? count() : first;
        if (!second) {
            return fail(second.error());
        }
        std::string_view word = scanner_.word();
        if (equals_ignoring_case(word, "OFFSETS")) {
            return offsets_and_corners(*first, *second);
        }
        for (std::size_t i = 0; i < *first; ++i) {
            std::int64_t corners = 0;
            if (!to_integer(i == 0 ? word : scanner_.word(), corners) || corners < 0) {
                return scanner_.expected("the number of a cell's corners");
            }
            begin_.push_back(corners_.size());
            for (std::int64_t k = 0; k < corners; ++k) {
                if (Status status = corner(); !status) {
                    return status;
                }
            }
        }
        begin_.push_back(corners_.size());
        return {};
    }

    Status offsets_and_corners(std::size_t offsets, std::size_t corners) {
        scanner_.word();  // the type of the numbers
        for (std::size_t i = 0; i < offsets; ++i) {
            std::int64_t value = 0;
            if (!scanner_.integer(value)) {
                return scanner_.expected("an offset");
            }
            if (value < 0 || static_cast<std::size_t>(value) > corners ||
                (!begin_.empty() && static_cast<std::size_t>(value) < begin_.back())) {
                return scanner_.error("io.index_out_of_range", "an offset that does not rise");
            }
            begin_.push_back(static_cast<std::size_t>(value));
        }
        if (!equals_ignoring_case(scanner_.word(), "CONNECTIVITY")) {
            return scanner_.expected("CONNECTIVITY");
        }
        scanner_.word();
        for (std::size_t i = 0; i < corners; ++i) {
            if (Status status = corner(); !status) {
                return status;
            }
        }
        return {};
    }

    Status corner() {
        std::int64_t value = 0;
        if (!scanner_.integer(value)) {
            return scanner_.expected("the number of a point");
        }
        if (value < 0 || static_cast<std::size_t>(value) >= volume_.points.size()) {
            return scanner_.error("io.index_out_of_range",
                                  "a cell names point " + std::to_string(value) + " of " +
                                      std::to_string(volume_.points.size()) + " (the first is 0)");
        }
        corners_.push_back(static_cast<std::uint32_t>(value));
        return {};
    }

    Status types() {
        const Result<std::size_t> wanted = count();
        if (!wanted) {
            return fail(wanted.error());
        }
        for (std::size_t i = 0; i < *wanted; ++i) {
            std::int64_t value = 0;
            if (!scanner_.integer(value)) {
                return scanner_.expected("the type of a cell");
            }
            types_.push_back(value);
        }
        return {};
    }

    Result<Volume> volume() {
        if (begin_.size() < 2 || types_.size() + 1 != begin_.size()) {
            return scanner_.error("io.empty", "the file holds no cells with their types");
        }
        for (std::size_t i = 0; i < types_.size(); ++i) {
            const std::size_t size = begin_[i + 1] - begin_[i];
            std::vector<std::uint32_t>* into = nullptr;
            if (types_[i] == kVtkTetra && size == 4) {
                into = &volume_.cells.tetrahedra;
            } else if (types_[i] == kVtkHexahedron && size == 8) {
                into = &volume_.cells.hexahedra;
            } else {
                continue;  // surfaces, lines and the like bound the cells that matter
            }
            into->insert(into->end(), corners_.begin() + static_cast<std::ptrdiff_t>(begin_[i]),
                         corners_.begin() + static_cast<std::ptrdiff_t>(begin_[i + 1]));
        }
        return std::move(volume_);
    }

    TextScanner scanner_;
    Volume volume_;
    std::vector<std::size_t> begin_;
    std::vector<std::uint32_t> corners_;
    std::vector<std::int64_t> types_;
};

}  // namespace

Result<Volume> parse_vtk_volume(std::string_view bytes, std::string_view name) {
    return VtkParser(bytes, name).parse();
}

}  // namespace decomp::io
