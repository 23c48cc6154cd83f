// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/proxy/orientation.h"

#include "decomp/base/rng.h"
#include "decomp/mesh/measure.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

namespace decomp::proxy {

namespace {

constexpr std::uint64_t kSeed = 20260101;
constexpr int kSamples = 2000;
constexpr std::size_t kRefined = 6;   // of the samples, the best that lie apart are improved
constexpr std::size_t kOptima = 3;    // local optima of the misalignment that are kept
constexpr double kLeastGain = 0.005;  // a turn that gains less is not worth it
constexpr double kApartDeg = 10;
constexpr double kFirstStep = 0.1;  // rad
constexpr double kLastStep = 1e-3;  // rad
constexpr double kStepFactor = 0.7;
constexpr int kTriesPerStep = 20;
constexpr std::size_t kMostNormals = 1000;

using Cost = std::function<double(const Eigen::Matrix3d&)>;

struct Scored {
    Eigen::Matrix3d rotation;
    double cost = 0;
};

/// Uniform over all rotations (Shoemake 1992).
Eigen::Matrix3d random_rotation(Rng& rng) {
    const double u = rng.uniform();
    const double a = 2 * std::numbers::pi * rng.uniform();
    const double b = 2 * std::numbers::pi * rng.uniform();
    const double s = std::sqrt(1 - u);
    const double c = std::sqrt(u);
    return Eigen::Quaterniond(c * std::cos(b), s * std::sin(a), s * std::cos(a), c * std::sin(b))
        .toRotationMatrix();
}

/// Row i is the axis order[i], turned round where bit i of `signs` is set.
Eigen::Matrix3d signed_permutation(const std::array<int, 3>& order, unsigned signs) {
    Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
    for (int row = 0; row < 3; ++row) {
        m(row, order.at(static_cast<std::size_t>(row))) =
            ((signs >> static_cast<unsigned>(row)) & 1U) != 0 ? -1 : 1;
    }
    return m;
}

std::vector<Eigen::Matrix3d> made_axis_rotations() {
    std::vector<Eigen::Matrix3d> made;
    std::array<int, 3> order{0, 1, 2};
    do {
        for (unsigned signs = 0; signs < 8; ++signs) {
            const Eigen::Matrix3d m = signed_permutation(order, signs);
            if (m.determinant() > 0) {
                made.push_back(m);
            }
        }
    } while (std::next_permutation(order.begin(), order.end()));
    return made;
}

/// The 24 rotations that map the axes onto axes.
const std::vector<Eigen::Matrix3d>& axis_rotations() {
    static const std::vector<Eigen::Matrix3d> all = made_axis_rotations();
    return all;
}

double angle(const Eigen::Matrix3d& rotation) {
    return std::acos(std::clamp((rotation.trace() - 1) / 2, -1.0, 1.0));
}

/// The rotation that names the axes like `rotation` does, up to a renaming, and turns least.
Eigen::Matrix3d least_turn(const Eigen::Matrix3d& rotation) {
    Eigen::Matrix3d best = rotation;
    for (const auto& renamed : axis_rotations()) {
        if (angle(renamed * rotation) < angle(best) - kLastStep) {
            best = renamed * rotation;
        }
    }
    return best;
}

bool near(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
    return angle(least_turn(a * b.transpose())) < kApartDeg * std::numbers::pi / 180;
}

/// Descends by random small turns, ever smaller.
Scored refined(Scored from, const Cost& cost, Rng& rng) {
    for (double step = kFirstStep; step > kLastStep; step *= kStepFactor) {
        for (int k = 0; k < kTriesPerStep; ++k) {
            const Eigen::Vector3d axis = random_rotation(rng).col(0);
            const Eigen::Matrix3d turned =
                Eigen::AngleAxisd(step, axis).toRotationMatrix() * from.rotation;
            const double found = cost(turned);
            if (found < from.cost) {
                from = {turned, found};
            }
        }
    }
    return from;
}

/// Local optima, best first, no two near each other.
std::vector<Scored> optima(const Cost& cost) {
    Rng rng(kSeed);
    std::vector<Scored> sampled;
    for (int i = 0; i < kSamples; ++i) {
        const Eigen::Matrix3d rotation = random_rotation(rng);
        sampled.push_back({rotation, cost(rotation)});
    }
    const auto cheaper = [](const Scored& a, const Scored& b) { return a.cost < b.cost; };
    std::stable_sort(sampled.begin(), sampled.end(), cheaper);
    std::vector<Scored> spread;
    for (const auto& s : sampled) {
        const bool new_one = std::none_of(spread.begin(), spread.end(), [&](const Scored& other) {
            return near(s.rotation, other.rotation);
        });
        if (new_one && spread.size() < kRefined) {
            spread.push_back(s);
        }
    }
    for (auto& s : spread) {
        s = refined(s, cost, rng);
    }
    std::stable_sort(spread.begin(), spread.end(), cheaper);
    std::vector<Scored> apart;
    for (const auto& s : spread) {
        if (std::none_of(apart.begin(), apart.end(),
                         [&](const Scored& o) { return near(s.rotation, o.rotation); })) {
            apart.push_back(s);
        }
    }
    return apart;
}

/// Normals, as long as twice the area, of at most about kMostNormals triangles.
std::vector<Eigen::Vector3d> normals_of(const mesh::TriMesh& surface) {
    std::vector<Eigen::Vector3d> normals;
    const std::size_t stride = surface.triangles.size() / kMostNormals + 1;
    for (std::size_t i = 0; i < surface.triangles.size(); i += stride) {
        normals.push_back(mesh::double_area_normal(surface, i));
    }
    return normals;
}

double l1_mean(const std::vector<Eigen::Vector3d>& normals, const Eigen::Matrix3d& rotation) {
    double sum = 0;
    double area = 0;
    for (const auto& n : normals) {
        sum += (rotation * n).lpNorm<1>();
        area += n.norm();
    }
    return area > 0 ? sum / area : 1;
}

/// Points that are farthest in some direction: those that bound every box around the surface.
std::vector<Eigen::Vector3d> outermost(const mesh::TriMesh& surface) {
    Rng rng(kSeed);
    std::vector<std::size_t> chosen;
    for (int i = 0; i < kSamples / 4; ++i) {
        const Eigen::Vector3d direction = random_rotation(rng).col(0);
        std::size_t best = 0;
        double farthest = -std::numeric_limits<double>::infinity();
        for (std::size_t p = 0; p < surface.points.size(); ++p) {
            const double reach = direction.dot(surface.points[p]);
            if (reach > farthest) {
                farthest = reach;
                best = p;
            }
        }
        chosen.push_back(best);
    }
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    std::vector<Eigen::Vector3d> points;
    points.reserve(chosen.size());
    for (const std::size_t p : chosen) {
        points.push_back(surface.points[p]);
    }
    return points;
}

double box_volume(const std::vector<Eigen::Vector3d>& points, const Eigen::Matrix3d& rotation) {
    Eigen::AlignedBox3d box;
    for (const auto& p : points) {
        box.extend(rotation * p);
    }
    return box.volume();
}

Eigen::Matrix3d principal_axes(const mesh::TriMesh& surface) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    double area = 0;
    std::vector<std::pair<double, Eigen::Vector3d>> centres;
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
        const auto& t = surface.triangles[i];
        const double weight = mesh::double_area_normal(surface, i).norm();
        centres.emplace_back(
            weight, (surface.points[t[0]] + surface.points[t[1]] + surface.points[t[2]]) / 3);
        mean += weight * centres.back().second;
        area += weight;
    }
    mean /= area;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const auto& [weight, centre] : centres) {
        spread += weight * (centre - mean) * (centre - mean).transpose();
    }
    Eigen::Matrix3d axes =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().transpose();
    if (axes.determinant() < 0) {
        axes.row(2) *= -1;
    }
    return axes;
}

}  // namespace

double misalignment(const mesh::TriMesh& surface, const Eigen::Matrix3d& rotation) {
    std::vector<Eigen::Vector3d> normals;
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
        normals.push_back(mesh::double_area_normal(surface, i));
    }
    return l1_mean(normals, rotation);
}

std::vector<Eigen::Matrix3d> orientation_candidates(const mesh::TriMesh& surface) {
    std::vector<Eigen::Matrix3d> candidates{Eigen::Matrix3d::Identity()};
    if (surface.triangles.empty()) {
        return candidates;
    }
    const auto add = [&](const Eigen::Matrix3d& rotation) {
        const bool known =
            std::any_of(candidates.begin(), candidates.end(),
                        [&](const Eigen::Matrix3d& other) { return near(rotation, other); });
        if (!known) {
            candidates.push_back(least_turn(rotation));
        }
    };
    const std::vector<Eigen::Vector3d> normals = normals_of(surface);
    const Cost aligned = [&](const Eigen::Matrix3d& r) { return l1_mean(normals, r); };
    const std::vector<Scored> found = optima(aligned);
    const double unturned = aligned(Eigen::Matrix3d::Identity());
    for (std::size_t i = 0; i < std::min(kOptima, found.size()); ++i) {
        const bool gains = found[i].cost < (1 - kLeastGain) * unturned;
        if (i == 0 && gains) {
            candidates.push_back(
                least_turn(found[i].rotation));  // a slight tilt is straightened too
        } else if (i > 0) {
            add(found[i].rotation);
        }
    }
    add(principal_axes(surface));
    const std::vector<Eigen::Vector3d> hull = outermost(surface);
    const auto boxes = optima([&](const Eigen::Matrix3d& r) { return box_volume(hull, r); });
    if (!boxes.empty()) {
        add(boxes.front().rotation);
    }
    return candidates;
}

}  // namespace decomp::proxy
