// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/formats.h"
#include "decomp/io/text_scanner.h"

namespace decomp::io {

namespace {

/// Reads the statements of an OBJ file that carry a surface: v and f. Groups, normals and textures
/// are passed over.
class ObjParser {
  public:
    ObjParser(std::string_view bytes, std::string_view name) : scanner_(bytes, name) {}

    Result<mesh::TriMesh> parse() {
        while (!scanner_.at_end()) {
            const std::string_view word = scanner_.word_in_line();
            Status status;
            if (word == "v") {
                status = vertex();
            } else if (word == "f") {
                status = face();
            }
            if (!status) {
                return fail(status.error());
            }
            scanner_.next_line();
        }
        return std::move(mesh_);
    }

  private:
    Status vertex() {
        Eigen::Vector3d point;
        for (int axis = 0; axis < 3; ++axis) {
            if (!to_number(scanner_.word_in_line(), point[axis])) {
                return scanner_.expected("a coordinate");
            }
        }
        if (!point.allFinite()) {
            return scanner_.error("io.not_finite", "a coordinate that is no number");
        }
        mesh_.points.push_back(point);
        return {};
    }

    /// The next word of the statement, which a backslash at the end of a line continues on the next
    /// one.
    std::string_view word_of_statement() {
        std::string_view word = scanner_.word_in_line();
        while (word == "\\") {
            scanner_.next_line();
            word = scanner_.word_in_line();
        }
        return word;
    }

    Status face() {
        corners_.clear();
        for (std::string_view word = word_of_statement(); !word.empty();
             word = word_of_statement()) {
            const bool continued = word.back() == '\\';
            word = word.substr(0, word.size() - (continued ? 1 : 0));
            std::int64_t index = 0;
            if (!to_integer(word.substr(0, word.find('/')), index)) {
                return scanner_.expected("the number of a vertex");
            }
            const auto count = static_cast<std::int64_t>(mesh_.points.size());
            const std::int64_t corner = index < 0 ? count + index : index - 1;
            if (corner < 0 || corner >= count) {
                return scanner_.error("io.index_out_of_range",
                                      "a face names vertex " + std::to_string(index) +
                                          ", but only " + std::to_string(count) + " precede it");
            }
            corners_.push_back(static_cast<std::uint32_t>(corner));
            if (continued) {
                scanner_.next_line();
            }
        }
        if (corners_.size() < 3) {
            return scanner_.error("io.syntax", "a face with fewer than three corners");
        }
        append_polygon(mesh_, corners_);
        return {};
    }

    TextScanner scanner_;
    mesh::TriMesh mesh_;
    std::vector<std::uint32_t> corners_;
};

}  // namespace

Result<mesh::TriMesh> parse_obj(std::string_view bytes, std::string_view name) {
    return ObjParser(bytes, name).parse();
}

}  // namespace decomp::io
