// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/formats.h"
#include "decomp/io/ply_cursor.h"

#include <algorithm>
#include <array>
#include <limits>

namespace decomp::io {

namespace {

constexpr std::int64_t kMostRows = std::numeric_limits<std::uint32_t>::max();

struct Property {
    std::string name;
    PlyType type = PlyType::Float;
    bool list = false;
    PlyType count_type = PlyType::UChar;
};

struct Element {
    std::string name;
    std::size_t rows = 0;
    std::vector<Property> properties;
};

struct Header {
    PlyEncoding encoding = PlyEncoding::Ascii;
    std::vector<Element> elements;
    std::vector<std::string> comments;
    std::size_t body = 0;  ///< byte after "end_header\n"
    std::size_t lines = 0;
};

Result<Property> parse_property(TextScanner& scanner) {
    Property property;
    std::string_view word = scanner.word_in_line();
    if (word == "list") {
        property.list = true;
        if (!ply_type(scanner.word_in_line(), property.count_type)) {
            return scanner.expected("the type of a count");
        }
        if (property.count_type == PlyType::Float || property.count_type == PlyType::Double) {
            return scanner.error("io.syntax", "a list whose count is no integer");
        }
        word = scanner.word_in_line();
    }
    if (!ply_type(word, property.type)) {
        return scanner.expected("the type of a property");
    }
    property.name = std::string(scanner.word_in_line());
    if (property.name.empty()) {
        return scanner.expected("the name of a property");
    }
    return property;
}

Status parse_header_line(std::string_view word, TextScanner& scanner, std::string_view bytes,
                         Header& header) {
    if (word == "format") {
        const std::string_view encoding = scanner.word_in_line();
        if (!ply_encoding(encoding, header.encoding)) {
            return scanner.expected("ascii, binary_little_endian or binary_big_endian");
        }
    } else if (word == "comment") {
        const std::size_t begin = std::min(scanner.offset() + 1, bytes.size());
        std::string_view text = bytes.substr(begin, bytes.find('\n', begin) - begin);
        text = text.substr(0, text.find('\r'));
        header.comments.emplace_back(text);
    } else if (word == "element") {
        Element element;
        element.name = std::string(scanner.word_in_line());
        std::int64_t rows = 0;
        if (!to_integer(scanner.word_in_line(), rows)) {
            return scanner.expected("the number of rows of an element");
        }
        if (rows < 0 || rows > kMostRows) {
            return scanner.error("io.too_large", "an element of " + std::to_string(rows) + " rows");
        }
        element.rows = static_cast<std::size_t>(rows);
        header.elements.push_back(std::move(element));
    } else if (word == "property") {
        if (header.elements.empty()) {
            return scanner.error("io.syntax", "a property before any element");
        }
        Result<Property> property = parse_property(scanner);
        if (!property) {
            return fail(property.error());
        }
        header.elements.back().properties.push_back(std::move(*property));
    } else if (word != "obj_info" && word != "ply" && !word.empty()) {
        return scanner.expected("a line of a PLY header");
    }
    return {};
}

Result<Header> parse_header(std::string_view bytes, std::string_view name) {
    Header header;
    TextScanner scanner(bytes, name, '\0');
    do {
        ++header.lines;
        const std::string_view word = scanner.word_in_line();
        if (word == "end_header") {
            scanner.next_line();
            header.body = scanner.offset();
            return header;
        }
        if (Status status = parse_header_line(word, scanner, bytes, header); !status) {
            return fail(status.error());
        }
    } while (scanner.next_line());
    return fail("io.truncated", "the file ends within its header", std::string(name),
                "save or download the file again");
}

/// Which numbers of a row matter: the place of each wanted property, or none.
std::size_t place_of(const Element& element, std::string_view name) {
    std::size_t place = 0;
    while (place < element.properties.size() && element.properties[place].name != name) {
        ++place;
    }
    return place;
}

/// Reads the rows of the elements one after another.
class BodyParser {
  public:
    BodyParser(const Header& header, std::string_view bytes, std::string_view name,
               const std::vector<std::string_view>& columns)
        : header_(header), cursor_(bytes, header.body, name, header.encoding), columns_(columns) {
        contents_.comments = header.comments;
        contents_.columns.resize(columns.size());
    }

    Result<PlyContents> parse() {
        for (const Element& element : header_.elements) {
            Status status;
            if (element.name == "vertex") {
                status = vertices(element);
            } else if (element.name == "face") {
                status = faces(element);
            } else {
                status = other_rows(element);
            }
            if (!status) {
                return fail(status.error());
            }
        }
        return std::move(contents_);
    }

  private:
    /// Reads one property: a number into value, or a list into list_.
    bool read(const Property& property, double& value) {
        if (!property.list) {
            return cursor_.read(property.type, value);
        }
        double count = 0;
        if (!cursor_.read(property.count_type, count)) {
            return false;
        }
        list_.clear();
        if (count < 0 || count > static_cast<double>(cursor_.rest())) {
            cursor_.mark_absurd_list();
            return false;
        }
        for (double i = 0; i < count; ++i) {
            double entry = 0;
            if (!cursor_.read(property.type, entry)) {
                return false;
            }
            list_.push_back(entry);
        }
        return true;
    }

    Status vertices(const Element& element) {
        const std::array<std::size_t, 3> axes{place_of(element, "x"), place_of(element, "y"),
                                              place_of(element, "z")};
        for (const std::size_t place : axes) {
            if (place == element.properties.size() || element.properties[place].list) {
                return cursor_.error("io.syntax", "vertices without x, y and z");
            }
        }
        auto& points = contents_.mesh.points;
        points.reserve(std::min(element.rows, cursor_.rest() / 3));
        std::vector<double> row(element.properties.size());
        for (std::size_t i = 0; i < element.rows; ++i) {
            for (std::size_t k = 0; k < row.size(); ++k) {
                if (!read(element.properties[k], row[k])) {
                    return cursor_.unreadable();
                }
            }
            const Eigen::Vector3d point(row[axes[0]], row[axes[1]], row[axes[2]]);
            if (!point.allFinite()) {
                return cursor_.error("io.not_finite",
                                     "vertex " + std::to_string(i) + " is no number");
            }
            points.push_back(point);
        }
        return {};
    }

    Status faces(const Element& element) {
        std::size_t corners = place_of(element, "vertex_indices");
        if (corners == element.properties.size()) {
            corners = place_of(element, "vertex_index");
        }
        if (corners == element.properties.size() || !element.properties[corners].list) {
            return cursor_.error("io.syntax", "faces without a list vertex_indices");
        }
        contents_.mesh.triangles.reserve(std::min(element.rows, cursor_.rest() / 4));
        std::vector<std::size_t> wanted;
        for (const std::string_view column : columns_) {
            wanted.push_back(place_of(element, column));
        }
        std::vector<double> row(element.properties.size());
        for (std::size_t i = 0; i < element.rows; ++i) {
            for (std::size_t k = 0; k < row.size(); ++k) {
                if (!read(element.properties[k], row[k])) {
                    return cursor_.unreadable();
                }
                if (k == corners && !take_corners()) {
                    return cursor_.error("io.index_out_of_range",
                                         "face " + std::to_string(i) +
                                             " names a vertex that is not among the " +
                                             std::to_string(contents_.mesh.points.size()));
                }
            }
            append_polygon(contents_.mesh, corners_);
            append_columns(wanted, row);
        }
        return {};
    }

    bool take_corners() {
        corners_.clear();
        for (const double entry : list_) {
            if (!(entry >= 0 && entry < static_cast<double>(contents_.mesh.points.size()))) {
                return false;
            }
            corners_.push_back(static_cast<std::uint32_t>(entry));
        }
        return true;
    }

    void append_columns(const std::vector<std::size_t>& wanted, const std::vector<double>& row) {
        for (std::size_t c = 0; c < wanted.size(); ++c) {
            if (wanted[c] < row.size()) {
                const double value = std::clamp(row[wanted[c]], -2147483648.0, 2147483647.0);
                contents_.columns[c].resize(contents_.mesh.triangles.size(),
                                            static_cast<std::int32_t>(value));
            }
        }
    }

    Status other_rows(const Element& element) {
        if (element.properties.empty()) {
            return {};
        }
        double ignored = 0;
        for (std::size_t i = 0; i < element.rows; ++i) {
            for (const Property& property : element.properties) {
                if (!read(property, ignored)) {
                    return cursor_.unreadable();
                }
            }
        }
        return {};
    }

    const Header& header_;
    PlyCursor cursor_;
    const std::vector<std::string_view>& columns_;
    PlyContents contents_;
    std::vector<double> list_;
    std::vector<std::uint32_t> corners_;
};

}  // namespace

Result<PlyContents> parse_ply(std::string_view bytes, std::string_view name,
                              const std::vector<std::string_view>& columns) {
    const Result<Header> header = parse_header(bytes, name);
    if (!header) {
        return fail(header.error());
    }
    return BodyParser(*header, bytes, name, columns).parse();
}

}  // namespace decomp::io
