// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/tets/child_process_detail.h"
#include "decomp/tets/meshers_detail.h"

#include <dlfcn.h>
#include <gmshc.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <numeric>
#include <string>
#include <vector>

namespace decomp::tets {

namespace {

// HXT (10) is ten times faster, but numbers its points by their addresses in memory: its tets
// differ with whatever was allocated before.
constexpr double kDelaunay = 1;

constexpr int kTriangle = 2;  // element types of the MSH format
constexpr int kTetrahedron = 4;

/// The functions of gmsh that are used. The library is loaded on first use: it brings 40 MB and
/// half of OpenCASCADE with it, which no other verb needs.
struct Gmsh {
    decltype(&gmshInitialize) initialize = nullptr;
    decltype(&gmshFree) release = nullptr;
    decltype(&gmshOptionSetNumber) set_number = nullptr;
    decltype(&gmshModelAdd) add_model = nullptr;
    decltype(&gmshModelAddDiscreteEntity) add_discrete_entity = nullptr;
    decltype(&gmshModelMeshAddNodes) add_nodes = nullptr;
    decltype(&gmshModelMeshAddElementsByType) add_elements = nullptr;
    decltype(&gmshModelGeoAddSurfaceLoop) add_surface_loop = nullptr;
    decltype(&gmshModelGeoAddVolume) add_volume = nullptr;
    decltype(&gmshModelGeoSynchronize) synchronise = nullptr;
    decltype(&gmshModelMeshGenerate) generate = nullptr;
    decltype(&gmshModelMeshGetNodes) get_nodes = nullptr;
    decltype(&gmshModelMeshGetElementsByType) get_elements = nullptr;
    std::string fault;  ///< why it could not be loaded
};

template <class Function>
bool find(void* library, const char* name, Function& out) {
    out = reinterpret_cast<Function>(dlsym(library, name));
    return out != nullptr;
}

/// The library whose header this was compiled with.
std::string library_name() {
    return "libgmsh.so." + std::to_string(GMSH_API_VERSION_MAJOR) + "." +
           std::to_string(GMSH_API_VERSION_MINOR);
}

Gmsh load() {
    Gmsh g;
    void* library = dlopen(library_name().c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (library == nullptr) {
        g.fault = dlerror();
        return g;
    }
    const bool whole = find(library, "gmshInitialize", g.initialize) &&

                       find(library, "gmshFree", g.release) &&
                       find(library, "gmshOptionSetNumber", g.set_number) &&
                       find(library, "gmshModelAdd", g.add_model) &&
                       find(library, "gmshModelAddDiscreteEntity", g.add_discrete_entity) &&
                       find(library, "gmshModelMeshAddNodes", g.add_nodes) &&
                       find(library, "gmshModelMeshAddElementsByType", g.add_elements) &&
                       find(library, "gmshModelGeoAddSurfaceLoop", g.add_surface_loop) &&
                       find(library, "gmshModelGeoAddVolume", g.add_volume) &&
                       find(library, "gmshModelGeoSynchronize", g.synchronise) &&
                       find(library, "gmshModelMeshGenerate", g.generate) &&
                       find(library, "gmshModelMeshGetNodes", g.get_nodes) &&
                       find(library, "gmshModelMeshGetElementsByType", g.get_elements);
    if (!whole) {
        g.fault = "it lacks a function of its interface";
        return g;
    }
    int fault = 0;
    g.initialize(0, nullptr, 0, &fault);
    if (fault != 0) {
        g.fault = "it does not start";
    }
    return g;
}

/// Memory that gmsh allocated.
template <class T>
struct Array {
    explicit Array(const Gmsh& gmsh) : g(&gmsh) {}

    Array(const Array&) = delete;
    Array& operator=(const Array&) = delete;

    ~Array() {
        if (data != nullptr) {
            g->release(data);
        }
    }

    const Gmsh* g;
    T* data = nullptr;
    std::size_t size = 0;
};

tl::unexpected<Error> failed(const char* what) {
    return fail("tets.failed", std::string("gmsh could not ") + what);
}

Status set_options(const Gmsh& g) {
    const std::vector<std::pair<const char*, double>> options{
        {"General.Terminal", 0},
        {"General.AbortOnError", 0},
        {"General.NumThreads", 1},
        {"Mesh.MaxNumThreads3D", 1},
        {"Mesh.Algorithm3D", kDelaunay},
        {"Mesh.Optimize", 1},
        {"Mesh.MeshSizeExtendFromBoundary", 1},
    };
    for (const auto& [name, value] : options) {
        int fault = 0;
        g.set_number(name, value, &fault);
        if (fault != 0) {
            return fail("tets.failed", std::string("gmsh has no option ") + name);
        }
    }
    return {};
}

Status put_surface(const Gmsh& g, const mesh::TriMesh& surface) {
    int fault = 0;
    g.add_model("hew", &fault);
    const int face = fault == 0 ? g.add_discrete_entity(2, 1, nullptr, 0, &fault) : 0;
    if (fault != 0) {
        return failed("take a surface");
    }
    std::vector<std::size_t> tags(surface.points.size());
    std::iota(tags.begin(), tags.end(), std::size_t{1});
    std::vector<double> coordinates;
    coordinates.reserve(3 * surface.points.size());
    for (const Eigen::Vector3d& p : surface.points) {
        coordinates.insert(coordinates.end(), {p.x(), p.y(), p.z()});
    }
    g.add_nodes(2, face, tags.data(), tags.size(), coordinates.data(), coordinates.size(), nullptr,
                0, &fault);
    if (fault != 0) {
        return failed("take the points of the surface");
    }
    std::vector<std::size_t> corners;
    corners.reserve(3 * surface.triangles.size());
    for (const mesh::Triangle& t : surface.triangles) {
        corners.insert(corners.end(),
                       {std::size_t{t[0]} + 1, std::size_t{t[1]} + 1, std::size_t{t[2]} + 1});
    }
    g.add_elements(face, kTriangle, nullptr, 0, corners.data(), corners.size(), &fault);
    if (fault != 0) {
        return failed("take the triangles of the surface");
    }
    int faces[] = {face};
    int loop = g.add_surface_loop(faces, 1, -1, &fault);
    if (fault == 0) {
        g.add_volume(&loop, 1, -1, &fault);
    }
    if (fault == 0) {
        g.synchronise(&fault);
    }
    if (fault != 0) {
        return failed("make a volume of the surface");
    }
    return {};
}

Result<TetMesh> take_tets(const Gmsh& g, const mesh::TriMesh& surface) {
    Array<std::size_t> tags(g);
    Array<double> coordinates(g);
    Array<double> unused(g);
    int fault = 0;
    g.get_nodes(&tags.data, &tags.size, &coordinates.data, &coordinates.size, &unused.data,
                &unused.size, -1, -1, 0, 0, &fault);
    if (fault != 0) {
        return failed("give back the points");
    }
    Array<std::size_t> elements(g);
    Array<std::size_t> corners(g);
    g.get_elements(kTetrahedron, &elements.data, &elements.size, &corners.data, &corners.size, -1,
                   0, 1, &fault);
    if (fault != 0 || corners.size == 0) {
        return failed("fill the surface");
    }
    // New points are numbered after the surface's, by rising tag; the surface's keep their bits.
    TetMesh mesh;
    mesh.points = surface.points;
    std::size_t highest = 0;
    for (std::size_t i = 0; i < tags.size; ++i) {
        highest = std::max(highest, tags.data[i]);
    }
    std::vector<Eigen::Vector3d> at(highest + 1);
    std::vector<char> known(highest + 1, 0);
    for (std::size_t i = 0; i < tags.size; ++i) {
        at[tags.data[i]] = {coordinates.data[3 * i], coordinates.data[3 * i + 1],
                            coordinates.data[3 * i + 2]};
        known[tags.data[i]] = 1;
    }
    std::vector<std::uint32_t> number(highest + 1, 0);
    for (std::size_t tag = 1; tag <= highest; ++tag) {
        if (tag <= surface.points.size()) {
            number[tag] = static_cast<std::uint32_t>(tag - 1);
        } else if (known[tag] != 0) {
            number[tag] = static_cast<std::uint32_t>(mesh.points.size());
            mesh.points.push_back(at[tag]);
        }
    }
    mesh.tets.reserve(corners.size / 4);
    for (std::size_t i = 0; i + 4 <= corners.size; i += 4) {
        Tet tet{};
        for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t tag = corners.data[i + k];
            if (tag > highest || known[tag] == 0) {
                return failed("give back a tet whose corners it knows");
            }
            tet.at(k) = number[tag];
        }
        mesh.tets.push_back(tet);
    }
    return mesh;
}

Result<TetMesh> tets_in_this_process(const Gmsh& g, const mesh::TriMesh& surface) {
    if (Status status = set_options(g); !status) {
        return fail(status.error());
    }
    if (Status status = put_surface(g, surface); !status) {
        return fail(status.error());
    }
    int fault = 0;
    g.generate(3, &fault);
    if (fault != 0) {
        return failed("fill the surface");
    }
    return take_tets(g, surface);
}

template <class T>
void append(std::string& out, const T* data, std::size_t count) {
    out.append(reinterpret_cast<const char*>(data), count * sizeof(T));
}

/// One letter, then the new points and the tets, or the message of the error.
std::string packed(const Result<TetMesh>& mesh, std::size_t known_points) {
    if (!mesh) {
        return "E" + mesh.error().message;
    }
    std::string out = "T";
    const std::uint64_t added = mesh->points.size() - known_points;
    append(out, &added, 1);
    for (std::size_t i = known_points; i < mesh->points.size(); ++i) {
        append(out, mesh->points[i].data(), 3);
    }
    append(out, mesh->tets.data(), mesh->tets.size());
    return out;
}

Result<TetMesh> unpacked(const std::string& bytes, const mesh::TriMesh& surface) {
    if (bytes.empty() || bytes[0] != 'T') {
        return fail("tets.failed", bytes.empty() ? "no answer" : bytes.substr(1));
    }
    TetMesh mesh{surface.points, {}};
    std::uint64_t added = 0;
    std::memcpy(&added, bytes.data() + 1, sizeof(added));
    const char* at = bytes.data() + 1 + sizeof(added);
    for (std::uint64_t i = 0; i < added; ++i, at += 3 * sizeof(double)) {
        Eigen::Vector3d point;
        std::memcpy(point.data(), at, 3 * sizeof(double));
        mesh.points.push_back(point);
    }
    const auto rest = static_cast<std::size_t>(bytes.data() + bytes.size() - at);
    mesh.tets.resize(rest / sizeof(Tet));
    std::memcpy(mesh.tets.data(), at, rest);
    return mesh;
}

}  // namespace

Result<TetMesh> gmsh_tets(const mesh::TriMesh& surface) {
    static std::mutex mutex;
    const std::scoped_lock lock(mutex);
    static const Gmsh g = load();
    if (!g.fault.empty()) {
        return fail("tets.no_mesher", library_name() + " cannot be used: " + g.fault, {},
                    "install it; tools/packages.txt names it");
    }
    // gmsh's random numbers go on from call to call: each call works on a fresh copy of the
    // library, so that equal surfaces give equal tets. Nor do its crashes spread.
    const Result<std::string> answer = in_child_process(
        [&] { return packed(tets_in_this_process(g, surface), surface.points.size()); });
    if (!answer) {
        return fail(answer.error());
    }
    return unpacked(*answer, surface);
}

}  // namespace decomp::tets
