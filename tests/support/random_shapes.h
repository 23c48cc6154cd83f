// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "decomp/base/rng.h"
#include "decomp/mesh/tri_mesh.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <vector>

/// Closed shapes drawn by a seed: the zero set of a field, by marching tetrahedra.
namespace tests {

using Field = std::function<double(const Eigen::Vector3d&)>;

/// The surface of {field < 0} within [-1, 1]^3, sampled `cells` times a side: closed, manifold,
/// outward. The field counts as positive on the border.
inline decomp::mesh::TriMesh zero_set(const Field& field, int cells) {
    const auto side = static_cast<std::size_t>(cells) + 1;
    std::vector<double> values(side * side * side);
    const auto at = [&](std::size_t i, std::size_t j, std::size_t k) {
        return (i * side + j) * side + k;
    };
    const auto place = [&](std::size_t n) {
        const double step = 2.0 / cells;
        return Eigen::Vector3d(-1 + step * static_cast<double>(n / side / side),
                               -1 + step * static_cast<double>(n / side % side),
                               -1 + step * static_cast<double>(n % side));
    };
    for (std::size_t n = 0; n < values.size(); ++n) {
        const Eigen::Vector3d p = place(n);
        constexpr double kLeast = 1e-3;  // no sample lies on the surface: no slivers
        const double value = p.cwiseAbs().maxCoeff() > 0.999 ? 1.0 : field(p);
        values[n] = std::abs(value) < kLeast ? kLeast : value;
    }
    decomp::mesh::TriMesh mesh;
    std::map<std::array<std::size_t, 2>, std::uint32_t> crossings;
    const auto crossing = [&](std::size_t a, std::size_t b) {
        const auto [found, fresh] =
            crossings.emplace(std::array<std::size_t, 2>{std::min(a, b), std::max(a, b)},
                              static_cast<std::uint32_t>(mesh.points.size()));
        if (fresh) {
            const std::size_t low = std::min(a, b);
            const std::size_t high = std::max(a, b);
            const double t = std::clamp(values[low] / (values[low] - values[high]), 0.05, 0.95);
            mesh.points.emplace_back(50 * ((1 - t) * place(low) + t * place(high)));
        }
        return found->second;
    };
    constexpr std::array<std::array<std::size_t, 3>, 6> kOrders{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    for (std::size_t i = 0; i + 1 < side; ++i) {
        for (std::size_t j = 0; j + 1 < side; ++j) {
            for (std::size_t k = 0; k + 1 < side; ++k) {
                for (std::size_t o = 0; o < kOrders.size(); ++o) {
                    std::array<std::size_t, 3> corner{i, j, k};
                    std::array<std::size_t, 4> tet{at(i, j, k), 0, 0, 0};
                    for (std::size_t s = 0; s < 3; ++s) {
                        ++corner.at(kOrders.at(o).at(s));
                        tet.at(s + 1) = at(corner[0], corner[1], corner[2]);
                    }
                    if (o >= 3) {
                        std::swap(tet[2], tet[3]);
                    }
                    // Inner corners first, by an even permutation.
                    std::array<std::size_t, 4> order{0, 1, 2, 3};
                    std::stable_partition(order.begin(), order.end(),
                                          [&](std::size_t c) { return values[tet.at(c)] < 0; });
                    int inversions = 0;
                    for (std::size_t a = 0; a < 4; ++a) {
                        for (std::size_t b = a + 1; b < 4; ++b) {
                            inversions += order.at(a) > order.at(b) ? 1 : 0;
                        }
                    }
                    std::array<std::size_t, 4> t{};
                    int inner = 0;
                    for (std::size_t a = 0; a < 4; ++a) {
                        t.at(a) = tet.at(order.at(a));
                        inner += values[t.at(a)] < 0 ? 1 : 0;
                    }
                    if (inversions % 2 == 1) {
                        inner <= 2 ? std::swap(t[2], t[3]) : std::swap(t[0], t[1]);
                    }
                    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
                        mesh.triangles.push_back({a, b, c});
                    };
                    if (inner == 1) {
                        add(crossing(t[0], t[1]), crossing(t[0], t[2]), crossing(t[0], t[3]));
                    } else if (inner == 2) {
                        const std::uint32_t ac = crossing(t[0], t[2]);
                        const std::uint32_t ad = crossing(t[0], t[3]);
                        const std::uint32_t bc = crossing(t[1], t[2]);
                        const std::uint32_t bd = crossing(t[1], t[3]);
                        add(ac, ad, bd);
                        add(ac, bd, bc);
                    } else if (inner == 3) {
                        add(crossing(t[3], t[0]), crossing(t[3], t[1]), crossing(t[3], t[2]));
                    }
                }
            }
        }
    }
    return mesh;
}

/// Distance to the closed or open curve through these points.
inline double curve_distance(const Eigen::Vector3d& p, const std::vector<Eigen::Vector3d>& curve) {
    double least = 10;
    for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
        const Eigen::Vector3d d = curve[i + 1] - curve[i];
        const double t = std::clamp((p - curve[i]).dot(d) / d.squaredNorm(), 0.0, 1.0);
        least = std::min(least, (p - curve[i] - t * d).norm());
    }
    return least;
}

inline double box_field(const Eigen::Vector3d& p, const Eigen::Vector3d& half) {
    const Eigen::Vector3d q = p.cwiseAbs() - half;
    return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}

/// A shape of one of seven families, which seed % 7 names: heaps of boxes, cylinders and balls;
/// blobs; tori of genus 1 to 4; thin plates; springs; knots; bumpy balls.
inline decomp::mesh::TriMesh random_shape(std::uint64_t seed) {
    decomp::Rng rng(seed + 1);
    constexpr double kPi = std::numbers::pi;
    const auto point = [&](double reach) {
        return Eigen::Vector3d(rng.uniform(-reach, reach), rng.uniform(-reach, reach),
                               rng.uniform(-reach, reach));
    };
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(rng.uniform(0, kPi),
                          (point(1) + Eigen::Vector3d(0, 0, 1e-3)).normalized())
            .toRotationMatrix();
    Field field;
    switch (seed % 7) {
        case 0: {
            struct Solid {
                int kind;
                Eigen::Vector3d centre, half;
            };

            std::vector<Solid> solids;
            const auto count = 3 + rng.below(5);
            for (std::uint64_t i = 0; i < count; ++i) {
                solids.push_back({static_cast<int>(rng.below(3)), point(0.45),
                                  Eigen::Vector3d(rng.uniform(0.15, 0.45), rng.uniform(0.15, 0.45),
                                                  rng.uniform(0.15, 0.45))});
            }
            solids.push_back({0, Eigen::Vector3d::Zero(), Eigen::Vector3d(0.5, 0.12, 0.12)});
            solids.push_back({0, Eigen::Vector3d::Zero(), Eigen::Vector3d(0.12, 0.5, 0.12)});
            field = [solids](const Eigen::Vector3d& p) {
                double least = 10;
                for (const Solid& s : solids) {
                    const Eigen::Vector3d q = p - s.centre;
                    const double mine = s.kind == 0   ? box_field(q, s.half)
                                        : s.kind == 1 ? q.norm() - s.half.x()
                                                      : std::max(q.head<2>().norm() - s.half.x(),
                                                                 std::abs(q.z()) - s.half.z());
                    least = std::min(least, mine);
                }
                return least;
            };
            break;
        }
        case 1: {
            std::vector<Eigen::Vector4d> balls;
            const auto count = 3 + rng.below(6);
            for (std::uint64_t i = 0; i < count; ++i) {
                const Eigen::Vector3d c = point(0.45);
                balls.emplace_back(c.x(), c.y(), c.z(), rng.uniform(0.15, 0.3));
            }
            field = [balls](const Eigen::Vector3d& p) {
                double sum = 0;
                for (const Eigen::Vector4d& b : balls) {
                    sum += std::exp(1 - (p - b.head<3>()).squaredNorm() / (b.w() * b.w()));
                }
                return 0.5 * (1 - sum);
            };
            break;
        }
        case 2: {
            const int genus = 1 + static_cast<int>(rng.below(4));
            const double tube = rng.uniform(0.08, 0.14);
            field = [genus, tube, turn](const Eigen::Vector3d& p) {
                const Eigen::Vector3d q = turn * p;
                double least = 10;
                const double ring = 0.75 / (genus + 1);
                for (int g = 0; g < genus; ++g) {
                    const Eigen::Vector3d c(1.7 * ring * (g - (genus - 1) / 2.0), 0, 0);
                    const Eigen::Vector2d around((q - c).head<2>().norm() - ring, q.z());
                    least = std::min(least, around.norm() - tube);
                }
                return least;
            };
            break;
        }
        case 3: {
            const double thick = rng.uniform(0.05, 0.09);
            const double wave = rng.uniform(0, 0.15);
            field = [thick, wave, turn](const Eigen::Vector3d& p) {
                const Eigen::Vector3d q = turn * p;
                return box_field(Eigen::Vector3d(q.x(), q.y(), q.z() - wave * std::sin(5 * q.x())),
                                 Eigen::Vector3d(0.55, 0.4, thick));
            };
            break;
        }
        case 4:
        case 5: {
            std::vector<Eigen::Vector3d> curve;
            const double turns = rng.uniform(1.5, 3.2);
            for (int i = 0; i <= 160; ++i) {
                const double t = i / 160.0;
                if (seed % 7 == 4) {
                    curve.emplace_back(0.5 * std::cos(2 * kPi * turns * t),
                                       0.5 * std::sin(2 * kPi * turns * t), 1.4 * t - 0.7);
                } else {
                    const double u = 2 * kPi * t;
                    curve.emplace_back(0.25 * (std::sin(u) + 2 * std::sin(2 * u)),
                                       0.25 * (std::cos(u) - 2 * std::cos(2 * u)),
                                       -0.3 * std::sin(3 * u));
                }
            }
            const double tube = rng.uniform(0.08, 0.12);
            field = [curve, tube](const Eigen::Vector3d& p) {
                return curve_distance(p, curve) - tube;
            };
            break;
        }
        default: {
            const double a = rng.uniform(3, 7);
            const double b = rng.uniform(3, 7);
            const double high = rng.uniform(0.03, 0.12);
            field = [a, b, high, turn](const Eigen::Vector3d& p) {
                const Eigen::Vector3d q = turn * p;
                return q.norm() - 0.6 -
                       high * std::sin(a * q.x()) * std::sin(b * q.y()) * std::cos(a * q.z());
            };
        }
    }
    return zero_set(field, 48);
}

}  // namespace tests
