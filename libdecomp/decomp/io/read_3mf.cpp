// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/formats.h"
#include "decomp/io/lib3mf_handle.h"
#include "decomp/io/package_census.h"

#include <Eigen/Geometry>
#include <lib3mf/Model/COM/NMR_DLLInterfaces.h>

#include <exception>

namespace decomp::io {

namespace {

using Handle = Lib3mfHandle<&NMR::lib3mf_release>;

constexpr std::size_t kMostTriangles = 50'000'000;  // over all instances

double length_of_unit_mm(DWORD unit) {
    switch (unit) {
        case NMR::MODELUNIT_MICROMETER:
            return 0.001;
        case NMR::MODELUNIT_CENTIMETER:
            return 10;
        case NMR::MODELUNIT_INCH:
            return 25.4;
        case NMR::MODELUNIT_FOOT:
            return 304.8;
        case NMR::MODELUNIT_METER:
            return 1000;
        default:
            return 1;
    }
}

Eigen::Affine3d map_of(const NMR::MODELTRANSFORM& transform) {
    Eigen::Affine3d map = Eigen::Affine3d::Identity();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            map.matrix()(row, column) = transform.m_fFields[row][column];
        }
    }
    return map;
}

/// Collects the instances that the build items of one package place; the census has bounded them.
class PackageReader {
  public:
    explicit PackageReader(std::string_view name) : name_(name) {}

    Result<ScaledMesh> read(std::string_view bytes) {
        if (NMR::lib3mf_createmodel(model_.out()) != 0) {
            return refused(model_);
        }
        Handle reader;
        // The interface takes the buffer as writable, and leaves it alone.
        auto* buffer = reinterpret_cast<BYTE*>(const_cast<char*>(bytes.data()));
        if (NMR::lib3mf_model_queryreader(model_.get(), MODELREADERCLASS_3MF, reader.out()) != 0) {
            return refused(model_);
        }
        if (NMR::lib3mf_reader_readfrombuffer(reader.get(), buffer, bytes.size()) != 0) {
            return refused(reader);
        }
        DWORD unit = NMR::MODELUNIT_MILLIMETER;
        Handle items;
        if (NMR::lib3mf_model_getunit(model_.get(), &unit) != 0 ||
            NMR::lib3mf_model_getbuilditems(model_.get(), items.out()) != 0) {
            return refused(model_);
        }
        BOOL more = 0;
        while (NMR::lib3mf_builditemiterator_movenext(items.get(), &more) == 0 && more != 0) {
            if (decomp::Status status = add_item(items); !status) {
                return fail(status.error());
            }
        }
        return ScaledMesh{std::move(mesh_), length_of_unit_mm(unit)};
    }

  private:
    [[nodiscard]] tl::unexpected<Error> refused(const Handle& object) const {
        DWORD code = 0;
        LPCSTR words = nullptr;
        NMR::lib3mf_getlasterror(object.get(), &code, &words);
        return fail("io.threemf", words != nullptr ? words : "lib3mf error " + std::to_string(code),
                    std::string(name_), "save the package again from its program");
    }

    decomp::Status add_item(const Handle& items) {
        Handle item;
        Handle object;
        NMR::MODELTRANSFORM transform{};
        if (NMR::lib3mf_builditemiterator_getcurrent(items.get(), item.out()) != 0) {
            return refused(items);
        }
        if (NMR::lib3mf_builditem_getobjectresource(item.get(), object.out()) != 0 ||
            NMR::lib3mf_builditem_getobjecttransform(item.get(), &transform) != 0) {
            return refused(item);
        }
        return add_object(object, map_of(transform));
    }

    decomp::Status add_object(const Handle& object, const Eigen::Affine3d& placed) {
        BOOL is_mesh = 0;
        if (NMR::lib3mf_object_ismeshobject(object.get(), &is_mesh) != 0) {
            return refused(object);
        }
        if (is_mesh != 0) {
            return add_mesh(object, placed);
        }
        DWORD count = 0;
        if (NMR::lib3mf_componentsobject_getcomponentcount(object.get(), &count) != 0) {
            return refused(object);
        }
        for (DWORD i = 0; i < count; ++i) {
            Handle component;
            Handle inner;
            NMR::MODELTRANSFORM transform{};
            if (NMR::lib3mf_componentsobject_getcomponent(object.get(), i, component.out()) != 0) {
                return refused(object);
            }
            if (NMR::lib3mf_component_getobjectresource(component.get(), inner.out()) != 0 ||
                NMR::lib3mf_component_gettransform(component.get(), &transform) != 0) {
                return refused(component);
            }
            if (decomp::Status status = add_object(inner, placed * map_of(transform)); !status) {
                return status;
            }
        }
        return {};
    }

    decomp::Status add_mesh(const Handle& object, const Eigen::Affine3d& placed) {
        DWORD points = 0;
        DWORD faces = 0;
        if (NMR::lib3mf_meshobject_getvertexcount(object.get(), &points) != 0 ||
            NMR::lib3mf_meshobject_gettrianglecount(object.get(), &faces) != 0) {
            return refused(object);
        }
        if (mesh_.triangles.size() + faces > kMostTriangles ||
            mesh_.points.size() + points > kMostTriangles) {
            return fail("io.too_large", "more than 50 million triangles over all instances",
                        std::string(name_));
        }
        std::vector<NMR::MODELMESHVERTEX> vertices(points);
        std::vector<NMR::MODELMESHTRIANGLE> triangles(faces);
        if ((points > 0 && NMR::lib3mf_meshobject_getvertices(object.get(), vertices.data(), points,
                                                              nullptr) != 0) ||
            (faces > 0 && NMR::lib3mf_meshobject_gettriangleindices(object.get(), triangles.data(),
                                                                    faces, nullptr) != 0)) {
            return refused(object);
        }
        const auto first = static_cast<std::uint32_t>(mesh_.points.size());
        for (const auto& vertex : vertices) {
            const Eigen::Vector3d point =
                placed * Eigen::Vector3d(vertex.m_fPosition[0], vertex.m_fPosition[1],
                                         vertex.m_fPosition[2]);
            if (!point.allFinite()) {
                return fail("io.not_finite", "a coordinate that is no number", std::string(name_));
            }
            mesh_.points.push_back(point);
        }
        const bool mirrored = placed.linear().determinant() < 0;
        for (const auto& t : triangles) {
            for (const DWORD corner : t.m_nIndices) {
                if (corner >= points) {
                    return fail("io.index_out_of_range",
                                "a triangle names a vertex that its object does not hold",
                                std::string(name_));
                }
            }
            const std::uint32_t b = first + t.m_nIndices[mirrored ? 2 : 1];
            const std::uint32_t c = first + t.m_nIndices[mirrored ? 1 : 2];
            mesh_.triangles.push_back({first + t.m_nIndices[0], b, c});
        }
        return {};
    }

    std::string_view name_;
    Handle model_;
    mesh::TriMesh mesh_;
};

}  // namespace

Result<ScaledMesh> parse_3mf(std::string_view bytes, std::string_view name) {
    if (const auto census = count_package(bytes, name); !census) {
        return fail(census.error());
    }
    try {
        return PackageReader(name).read(bytes);
    } catch (const std::exception& error) {
        return fail("io.threemf", error.what(), std::string(name));
    }
}

}  // namespace decomp::io
