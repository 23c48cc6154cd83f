// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/package_census.h"

#include "decomp/io/zip_directory.h"

#include <expat.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace decomp::io {

namespace {

constexpr std::uint64_t kMostUnpackedBytes = 2'000'000'000;
constexpr std::uint64_t kMostInstances = 100'000;
constexpr int kDeepest = 32;  // components within components

/// A file of the package, and the id of an object in it.
using ObjectKey = std::pair<std::string, std::string>;

struct Components {
    std::map<ObjectKey, std::vector<ObjectKey>> of_object;
    std::vector<ObjectKey> placed;  ///< by build items
};

/// "path" of "http://…/production path" and of "path": prefixes are free, local names are not.
std::string_view local_name(std::string_view name) {
    const std::size_t space = name.rfind(' ');
    return space == std::string_view::npos ? name : name.substr(space + 1);
}

/// Notes objects, components and build items of one model file; nothing else is looked at.
class ModelScan {
  public:
    ModelScan(std::string file, Components& out) : file_(std::move(file)), out_(out) {
        XML_SetUserData(parser_.get(), this);
        XML_SetElementHandler(parser_.get(), &begin_element, &end_element);
        XML_SetStartDoctypeDeclHandler(parser_.get(), &refuse_document_type);
    }

    [[nodiscard]] bool take(std::string_view piece) {
        return XML_Parse(parser_.get(), piece.data(), static_cast<int>(piece.size()), 0) ==
               XML_STATUS_OK;
    }

    [[nodiscard]] bool finish() { return XML_Parse(parser_.get(), nullptr, 0, 1) == XML_STATUS_OK; }

  private:
    static void begin_element(void* self, const char* name, const char** attributes) {
        static_cast<ModelScan*>(self)->begin(local_name(name), attributes);
    }

    static void end_element(void* self, const char* name) {
        if (local_name(name) == "object") {
            static_cast<ModelScan*>(self)->object_.clear();
        }
    }

    static void refuse_document_type(void* self, const char* /*name*/, const char* /*system*/,
                                     const char* /*public_id*/, int /*internal*/) {
        XML_StopParser(static_cast<ModelScan*>(self)->parser_.get(), XML_FALSE);
    }

    void begin(std::string_view element, const char** attributes) {
        const bool object = element == "object";
        const bool component = element == "component";
        if (!object && !component && element != "item") {
            return;
        }
        ObjectKey key{file_, {}};
        for (; *attributes != nullptr; attributes += 2) {
            const std::string_view attribute = local_name(attributes[0]);
            if (attribute == (object ? "id" : "objectid")) {
                key.second = attributes[1];
            } else if (attribute == "path" && !object) {
                key.first = attributes[1];
                key.first.erase(0, key.first.find_first_not_of('/'));
            }
        }
        if (object) {
            object_ = key.second;
            out_.of_object[std::move(key)];
        } else if (component) {
            out_.of_object[{file_, object_}].push_back(std::move(key));
        } else {
            out_.placed.push_back(std::move(key));
        }
    }

    struct Free {
        void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
    };

    std::unique_ptr<std::remove_pointer_t<XML_Parser>, Free> parser_{
        XML_ParserCreateNS(nullptr, ' ')};
    std::string file_;
    std::string object_;  ///< the one being defined
    Components& out_;
};

/// Instances below each object, every object once; saturates above the limit.
class InstanceCount {
  public:
    explicit InstanceCount(const Components& components) : components_(components) {}

    /// Nothing when components nest too deep, as in a circle they do.
    std::optional<std::uint64_t> of(const ObjectKey& object, int depth = 0) {
        if (depth > kDeepest) {
            return std::nullopt;
        }
        // What was counted at another depth may still be too deep here: `height` tells.
        if (const auto known = known_.find(object); known != known_.end()) {
            return depth + known->second.height > kDeepest ? std::nullopt
                                                           : std::optional(known->second.instances);
        }
        Known result;
        if (const auto found = components_.of_object.find(object);
            found != components_.of_object.end()) {
            for (const ObjectKey& component : found->second) {
                const auto below = of(component, depth + 1);
                if (!below) {
                    return std::nullopt;
                }
                result.instances = std::min(result.instances + *below, kMostInstances + 1);
                result.height = std::max(result.height, known_[component].height + 1);
            }
        }
        known_[object] = result;
        return result.instances;
    }

  private:
    struct Known {
        std::uint64_t instances = 1;
        int height = 0;
    };

    const Components& components_;
    std::map<ObjectKey, Known> known_;
};

bool is_model(const std::string& name) {
    const std::string_view ending = ".model";
    return name.size() >= ending.size() && name.ends_with(ending);
}

}  // namespace

Result<PackageCensus> count_package(std::string_view archive, std::string_view name) {
    const auto broken = [&](std::string what) {
        return fail("io.threemf", std::move(what), std::string(name), "save or download it again");
    };
    const auto entries = zip_entries(archive);
    if (!entries) {
        return broken("the package is no zip archive with a directory");
    }
    PackageCensus census;
    for (const ZipEntry& entry : *entries) {
        census.unpacked_bytes += std::min(entry.unpacked_bytes, kMostUnpackedBytes + 1);
        if (census.unpacked_bytes > kMostUnpackedBytes) {
            return fail("io.too_large", "a package that unpacks to more than 2 GB",
                        std::string(name));
        }
    }
    Components components;
    for (const ZipEntry& entry : *entries) {
        if (is_model(entry.name)) {
            ModelScan scan(entry.name, components);
            bool sound = true;
            const bool whole = unpack(archive, entry, [&](std::string_view piece) {
                sound = scan.take(piece);
                return sound;
            });
            if (!whole || !sound || !scan.finish()) {
                return broken("'" + entry.name + "' is broken: its packing or its XML");
            }
        } else if (!unpack(archive, entry, [](std::string_view) { return true; })) {
            return broken("'" + entry.name + "' cannot be unpacked");
        }
    }
    InstanceCount count(components);
    for (const ObjectKey& object : components.placed) {
        const auto instances = count.of(object);
        if (!instances) {
            return fail("io.threemf", "components nested more than 32 deep, or in a circle",
                        std::string(name));
        }
        census.instances += *instances;
        if (census.instances > kMostInstances) {
            return fail("io.too_large", "more than 100 000 instances of objects",
                        std::string(name));
        }
    }
    return census;
}

}  // namespace decomp::io
