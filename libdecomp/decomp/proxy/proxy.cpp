// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/proxy/proxy.h"

#include "decomp/mesh/check.h"
#include "decomp/mesh/measure.h"
#include "decomp/proxy/remesh.h"
#include "decomp/proxy/thickness.h"
#include "decomp/repair/distance.h"
#include "decomp/repair/intersect.h"
#include "decomp/repair/wrap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace decomp::proxy {

namespace {

constexpr std::size_t kCollapseFactor = 4;  // times the target: what the remesher starts from
constexpr double kThinShare = 0.05;         // of the surface may be thinner than what L is made for
constexpr double kEdgesPerThickness = 2;
constexpr std::size_t kThicknessSamples = 2000;
constexpr double kLeastTriangles = 1500;
constexpr double kMostTriangles = 10000;
constexpr double kVolumeError = 0.03;
constexpr double kDistanceEdges = 2;  // the proxy may lie so many edge lengths off
constexpr double kShellEdges = 2;     // a shell smaller than that is dropped
constexpr std::size_t kTunnelSamples = 6000;
constexpr double kLeastTunnelShare = 0.002;  // of the area; less is noise in a crease
constexpr double kMostTunnelShare = 0.02;    // more would make the surface fine altogether
constexpr std::size_t kDistanceSamples = 4000;
constexpr double kWrapAlphaEdges = 0.7;
constexpr double kWrapOffsetShare = 1.0 / 30;  // of alpha

constexpr double kNothingSharp = 180;

/// One way to make the surface; the next is taken when it comes out unsound.
struct Rung {
    double finer;     // factor of the edge length
    bool sharp;       // keep sharp edges
    bool from_input;  // rather than from the collapsed surface
};

// A little finer, or without edges to keep, is another mesh altogether, and mostly a sound one.
constexpr std::array<Rung, 7> kLadder{{{1, true, false},
                                       {0.93, true, false},
                                       {1, false, false},
                                       {1, true, true},
                                       {1, false, true},
                                       {0.71, false, true},
                                       {0.5, false, true}}};

/// The edge length at which equilateral triangles cover the surface.
double edge_for(const mesh::TriMesh& surface, double triangles) {
    return std::sqrt(4 * mesh::area_mm2(surface) / (std::sqrt(3.0) * triangles));
}

double triangles_for(const mesh::TriMesh& surface) {
    const double thickness = thickness_mm(surface, kThinShare, kThicknessSamples);
    if (thickness <= 0) {
        return kMostTriangles;
    }
    const double edge = thickness / kEdgesPerThickness;
    return std::clamp(4 * mesh::area_mm2(surface) / (std::sqrt(3.0) * edge * edge), kLeastTriangles,
                      kMostTriangles);
}

std::vector<mesh::TriMesh> shells_of(const mesh::TriMesh& mesh) {
    std::vector<std::uint32_t> parent(mesh.points.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&](std::uint32_t i) {
        while (parent[i] != i) {
            i = parent[i] = parent[parent[i]];
        }
        return i;
    };
    for (const auto& t : mesh.triangles) {
        parent[root(t[1])] = root(t[0]);
        parent[root(t[2])] = root(t[0]);
    }
    constexpr auto kNone = static_cast<std::size_t>(-1);
    std::vector<std::size_t> shell_of(mesh.points.size(), kNone);
    std::vector<std::uint32_t> index(mesh.points.size(), 0);
    std::vector<bool> placed(mesh.points.size(), false);
    std::vector<mesh::TriMesh> shells;
    for (const auto& t : mesh.triangles) {
        std::size_t& shell = shell_of[root(t[0])];
        if (shell == kNone) {
            shell = shells.size();
            shells.emplace_back();
        }
        mesh::Triangle moved{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = t.at(k);
            if (!placed[v]) {
                placed[v] = true;
                index[v] = static_cast<std::uint32_t>(shells[shell].points.size());
                shells[shell].points.push_back(mesh.points[v]);
            }
            moved.at(k) = index[v];
        }
        shells[shell].triangles.push_back(moved);
    }
    return shells;
}

mesh::TriMesh joined(const std::vector<mesh::TriMesh>& shells) {
    mesh::TriMesh out;
    for (const auto& shell : shells) {
        const auto shift = static_cast<std::uint32_t>(out.points.size());
        out.points.insert(out.points.end(), shell.points.begin(), shell.points.end());
        for (const auto& t : shell.triangles) {
            out.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
        }
    }
    return out;
}

/// A sample of the triangles, evenly by index.
mesh::TriMesh thinned(const mesh::TriMesh& mesh, std::size_t triangles) {
    const std::size_t stride = mesh.triangles.size() / triangles + 1;
    mesh::TriMesh out;
    out.points = mesh.points;
    for (std::size_t i = 0; i < mesh.triangles.size(); i += stride) {
        out.triangles.push_back(mesh.triangles[i]);
    }
    return out;
}

class Maker {
  public:
    Maker(const mesh::TriMesh& volume, const ProxyOptions& options, Run& run)
        : volume_(volume), options_(options), run_(run) {}

    Result<Proxy> make() {
        if (auto fault = prepare()) {
            return tl::make_unexpected(std::move(*fault));
        }
        const auto target = static_cast<double>(options_.triangles);
        const double first =
            edge_for(kept_, options_.triangles > 0 ? target : triangles_for(coarse_));
        has_narrow_tunnels_ = narrow_tunnels(kNarrowEdges * first);
        for (const Rung& rung : kLadder) {
            if (run_.cancelled()) {
                return cancelled();
            }
            if (auto proxy =
                    attempt(rung.from_input ? kept_ : coarse_, rung.finer * first,
                            rung.sharp ? options_.sharp_angle_deg : kNothingSharp, false)) {
                return std::move(*proxy);
            }
            run_.log(LogLevel::Debug, "a stand-in surface was refused: " + reason_);
        }
        for (const double edge : {first, first / std::sqrt(2.0)}) {
            if (run_.cancelled()) {
                return cancelled();
            }
            const double alpha = kWrapAlphaEdges * edge;
            const auto around = repair::wrap(kept_, alpha, kWrapOffsetShare * alpha);
            if (!around) {
                continue;
            }
            if (auto proxy = attempt(*around, edge, kNothingSharp, true)) {
                run_.warn("the stand-in surface was made around a wrap: " + reason_);
                return std::move(*proxy);
            }
        }
        return fail("proxy.failed", "no sound coarse surface came out: " + reason_, "",
                    "ask for more triangles, or mend the model");
    }

  private:
    std::optional<Error> prepare() {
        const double diagonal = mesh::diagonal_mm(volume_);
        if (volume_.triangles.empty() || !(mesh::volume_mm3(volume_) > 0)) {
            return Error{"proxy.empty",
                         "the volume encloses nothing",
                         "",
                         "give a closed, outward oriented volume",
                         {}};
        }
        if ((options_.triangles != 0 && (options_.triangles < 500 || options_.triangles > 50000)) ||
            !(options_.sharp_angle_deg >= 10 && options_.sharp_angle_deg <= 180)) {
            return Error{"proxy.options",
                         "the number of triangles or the sharp angle is out of range",
                         "",
                         "triangles 0 or 500 to 50000, angle 10 to 180 degrees",
                         {}};
        }
        const double rough =
            edge_for(volume_, options_.triangles > 0 ? options_.triangles : kMostTriangles);
        std::vector<mesh::TriMesh> shells = shells_of(volume_);
        const std::size_t before = shells.size();
        std::erase_if(shells, [&](const mesh::TriMesh& shell) {
            return before > 1 &&
                   mesh::diagonal_mm(shell) < std::min(kShellEdges * rough, diagonal / 2);
        });
        dropped_ = before - shells.size();
        kept_ = dropped_ == 0 ? volume_ : joined(shells);
        if (dropped_ > 0) {
            run_.info("the stand-in surface leaves out " + std::to_string(dropped_) +
                      " shells smaller than its edges");
        }
        const auto target = static_cast<std::size_t>(
            options_.triangles > 0 ? options_.triangles : static_cast<int>(kMostTriangles));
        coarse_ = kept_;
        if (kept_.triangles.size() > kCollapseFactor * target) {
            if (auto fewer = collapsed(kept_, kCollapseFactor * target)) {
                coarse_ = std::move(*fewer);
            }
        }
        return std::nullopt;
    }

    /// Whether a small part of the surface lines tunnels narrower than that.
    [[nodiscard]] bool narrow_tunnels(double narrow_mm) const {
        const mesh::TopologyReport is = mesh::check_topology(kept_);
        if (is.euler_characteristic == 2 * static_cast<long>(is.components)) {
            return false;  // no handle, no tunnel
        }
        const std::size_t stride = coarse_.triangles.size() / kTunnelSamples + 1;
        const std::vector<double> widths = tunnel_widths_mm(coarse_, stride);
        double narrow = 0;
        for (std::size_t i = 0; i < widths.size(); ++i) {
            if (widths[i] < narrow_mm) {
                narrow +=
                    static_cast<double>(stride) * mesh::double_area_normal(coarse_, i).norm() / 2;
            }
        }
        const double share = narrow / mesh::area_mm2(coarse_);
        return share > kLeastTunnelShare && share < kMostTunnelShare;
    }

    std::optional<Proxy> attempt(const mesh::TriMesh& from, double edge_mm, double sharp_deg,
                                 bool wrapped) {
        auto surface = remeshed(from, {.edge_mm = edge_mm,
                                       .sharp_angle_deg = sharp_deg,
                                       .fine_tunnels = has_narrow_tunnels_});
        if (!surface) {
            reason_ = "remeshing broke down";
            return std::nullopt;
        }
        Proxy proxy;
        proxy.surface = std::move(*surface);
        proxy.edge_mm = edge_mm;
        proxy.wrapped = wrapped;
        proxy.shells_dropped = dropped_;
        proxy.volume_share = mesh::volume_mm3(proxy.surface) / mesh::volume_mm3(volume_);
        if (!sound(proxy)) {
            return std::nullopt;
        }
        proxy.distance_mm =
            std::max(repair::farthest_mm(thinned(kept_, kDistanceSamples), proxy.surface),
                     repair::farthest_mm(thinned(proxy.surface, kDistanceSamples), kept_));
        if (!wrapped && proxy.distance_mm > kDistanceEdges * edge_mm) {
            reason_ = "the surface went astray";
            return std::nullopt;
        }
        return proxy;
    }

    /// Whether the surface bounds a volume much like the input; says why not.
    bool sound(const Proxy& proxy) {
        const mesh::TopologyReport is = mesh::check_topology(proxy.surface);
        if (!is.manifold() || is.degenerate_triangles > 0) {
            reason_ = "the surface is no manifold";
            return false;
        }
        if (!proxy.wrapped) {
            const mesh::TopologyReport was = mesh::check_topology(kept_);
            if (is.components != was.components ||
                is.euler_characteristic != was.euler_characteristic) {
                reason_ = "shells or handles were lost";
                return false;
            }
            if (std::abs(proxy.volume_share - 1) > kVolumeError) {
                reason_ = "the volume changed";
                return false;
            }
        }
        if (!(proxy.volume_share > 0) || !repair::self_intersections(proxy.surface, 1).empty()) {
            reason_ = "the surface runs into itself";
            return false;
        }
        return true;
    }

    const mesh::TriMesh& volume_;
    const ProxyOptions& options_;
    Run& run_;
    mesh::TriMesh kept_;    // the volume without the shells that are dropped
    mesh::TriMesh coarse_;  // kept_, collapsed
    std::size_t dropped_ = 0;
    bool has_narrow_tunnels_ = false;
    std::string reason_;  // why the last attempt was refused
};

}  // namespace

Result<Proxy> make_proxy(const mesh::TriMesh& volume, const ProxyOptions& options, Run& run) {
    return Maker(volume, options, run).make();
}

}  // namespace decomp::proxy
