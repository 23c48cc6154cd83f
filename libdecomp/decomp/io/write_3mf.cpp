// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/io/write_3mf.h"

#include "decomp/base/hash.h"
#include "decomp/io/lib3mf_handle.h"

#include <lib3mf/Model/COM/NMR_DLLInterfaces.h>

namespace decomp::io {

namespace {

using Handle = Lib3mfHandle<&NMR::lib3mf_release>;

tl::unexpected<Error> refused(const Handle& object, const std::string& step) {
    DWORD code = 0;
    LPCSTR words = nullptr;
    NMR::lib3mf_getlasterror(object.get(), &code, &words);
    return fail("io.threemf",
                step + ": " + (words != nullptr ? words : "lib3mf error " + std::to_string(code)));
}

/// lib3mf would draw random identifiers: these are of the same form and depend on the name alone
/// (RFC 9562, version 8).
std::string uuid_of(const std::string& name) {
    std::string hex = sha256_hex(name);
    hex[12] = '8';
    hex[16] = '8';
    return hex.substr(0, 8) + '-' + hex.substr(8, 4) + '-' + hex.substr(12, 4) + '-' +
           hex.substr(16, 4) + '-' + hex.substr(20, 12);
}

NMR::MODELTRANSFORM transform_of(const Eigen::Isometry3d& map) {
    NMR::MODELTRANSFORM transform{};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            transform.m_fFields[row][column] = static_cast<float>(map.matrix()(row, column));
        }
    }
    return transform;
}

decomp::Status add_object(const Handle& model, const ThreemfObject& object, std::size_t index) {
    std::vector<NMR::MODELMESHVERTEX> vertices;
    vertices.reserve(object.mesh.points.size());
    for (const auto& p : object.mesh.points) {
        const Eigen::Vector3f f = p.cast<float>();
        vertices.push_back({{f.x() + 0.0F, f.y() + 0.0F, f.z() + 0.0F}});
    }
    std::vector<NMR::MODELMESHTRIANGLE> triangles;
    triangles.reserve(object.mesh.triangles.size());
    for (const auto& t : object.mesh.triangles) {
        triangles.push_back({{t[0], t[1], t[2]}});
    }
    const std::string place = std::to_string(index) + " " + object.id;
    Handle mesh;
    if (NMR::lib3mf_model_addmeshobject(model.get(), mesh.out()) != 0) {
        return refused(model, "object " + object.id);
    }
    if (NMR::lib3mf_object_setnameutf8(mesh.get(), object.id.c_str()) != 0 ||
        NMR::lib3mf_object_setuuidutf8(mesh.get(), uuid_of("object " + place).c_str()) != 0 ||
        NMR::lib3mf_meshobject_setgeometry(mesh.get(), vertices.data(),
                                           static_cast<DWORD>(vertices.size()), triangles.data(),
                                           static_cast<DWORD>(triangles.size())) != 0) {
        return refused(mesh, "object " + object.id);
    }
    NMR::MODELTRANSFORM transform = transform_of(object.placed_from_mesh);
    Handle item;
    if (NMR::lib3mf_model_addbuilditem(model.get(), mesh.get(), &transform, item.out()) != 0 ||
        NMR::lib3mf_builditem_setuuidutf8(item.get(), uuid_of("item " + place).c_str()) != 0) {
        return refused(model, "placing object " + object.id);
    }
    return {};
}

}  // namespace

Result<std::string> threemf_bytes(const std::vector<ThreemfObject>& objects) {
    Handle model;
    if (NMR::lib3mf_createmodel(model.out()) != 0) {
        return refused(model, "creating a model");
    }
    if (NMR::lib3mf_model_setunit(model.get(), NMR::MODELUNIT_MILLIMETER) != 0 ||
        NMR::lib3mf_model_setbuilduuidutf8(model.get(), uuid_of("build").c_str()) != 0) {
        return refused(model, "describing the build");
    }
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (decomp::Status status = add_object(model, objects[i], i); !status) {
            return fail(status.error());
        }
    }
    Handle writer;
    ULONG64 size = 0;
    if (NMR::lib3mf_model_querywriter(model.get(), MODELWRITERCLASS_3MF, writer.out()) != 0 ||
        NMR::lib3mf_writer_getstreamsize(writer.get(), &size) != 0) {
        return refused(model, "preparing the file");
    }
    std::string bytes(size, '\0');
    if (NMR::lib3mf_writer_writetobuffer(writer.get(), reinterpret_cast<BYTE*>(bytes.data()),
                                         size) != 0) {
        return refused(writer, "writing the file");
    }
    return bytes;
}

}  // namespace decomp::io
