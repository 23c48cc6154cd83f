// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/solid/facets.h"

#include "decomp/mesh/measure.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>

namespace decomp::solid {

namespace {

void sort_once(std::vector<std::uint32_t>& numbers) {
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace

Facets::Facets(const part::Part& part, const Adjacency& adjacency, Regions& regions)
    : mesh_(part.mesh),
      adjacency_(adjacency),
      regions_(regions),
      flat_count_(static_cast<std::uint32_t>(regions.all.size())),
      facets_(regions.all.size()),
      facet_of_(part.mesh.triangles.size()) {
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
        const std::int32_t region = regions_.of[t];
        if (region < 0) {
            facet_of_[t] = static_cast<std::uint32_t>(facets_.size());
            facets_.emplace_back();
        } else {
            facet_of_[t] = static_cast<std::uint32_t>(region);
        }
        Facet& facet = facets_[facet_of_[t]];
        facet.triangles.push_back(t);
        facet.normal += mesh::double_area_normal(mesh_, t);
        facet.cut = !part.sources.empty() && part.sources[t].is_cut();
        facet.points.insert(facet.points.end(), mesh_.triangles[t].begin(),
                            mesh_.triangles[t].end());
    }
    for (Facet& facet : facets_) {
        facet.area_mm2 = facet.normal.norm() / 2;
        facet.normal.normalize();
        sort_once(facet.points);
    }
    taken_.assign(facets_.size(), false);
    mark_.assign(facets_.size(), 0);
}

const PlaneSurface& Facets::plane(std::uint32_t flat) const {
    return std::get<PlaneSurface>(regions_.all[flat].surface);
}

double Facets::angle_between(std::uint32_t f, std::uint32_t g) const {
    return std::atan2(facets_[f].normal.cross(facets_[g].normal).norm(),
                      facets_[f].normal.dot(facets_[g].normal));
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> Facets::pairs(double least,
                                                                   double most) const {
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> pairs;
    for (std::uint32_t h = 0; h < adjacency_.twin.size(); ++h) {
        const std::uint32_t f = facet_of_[h / 3];
        const std::uint32_t g = across(h);
        if (f >= g || !is_flat(g) || !usable(f) || !usable(g)) {
            continue;
        }
        const double angle = angle_between(f, g);
        if (angle > least && angle < most) {
            pairs[{f, g}] = std::min(facets_[f].area_mm2, facets_[g].area_mm2);
        }
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order;
    order.reserve(pairs.size());
    for (const auto& [pair, area] : pairs) {
        order.push_back(pair);
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](const auto& a, const auto& b) { return pairs[a] > pairs[b]; });
    return order;
}

std::vector<Fan> Facets::fans(std::size_t least) const {
    std::vector<std::size_t> count(mesh_.points.size(), 0);
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
        for (const std::uint32_t p : mesh_.triangles[t]) {
            count[p] += is_flat(facet_of_[t]) ? mesh_.triangles.size() : 1;
        }
    }
    std::map<std::uint32_t, Fan> fans;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
        for (const std::uint32_t p : mesh_.triangles[t]) {
            if (count[p] >= least && count[p] < mesh_.triangles.size()) {
                Fan& fan = fans[p];
                fan.point = p;
                fan.facets.push_back(facet_of_[t]);
            }
        }
    }
    std::vector<Fan> all;
    all.reserve(fans.size());
    for (auto& [point, fan] : fans) {
        all.push_back(std::move(fan));
    }
    return all;
}

std::vector<std::uint32_t> Facets::gather(std::uint32_t seed,
                                          const std::function<bool(std::uint32_t)>& belongs) {
    std::vector<std::uint32_t> found;
    if (!belongs(seed)) {
        return found;
    }
    ++stamp_;
    found.push_back(seed);
    mark_[seed] = stamp_;
    for (std::size_t i = 0; i < found.size(); ++i) {
        for_each_halfedge(found[i], [&](std::uint32_t h) {
            const std::uint32_t g = across(h);
            if (mark_[g] != stamp_ && usable(g) && belongs(g)) {
                mark_[g] = stamp_;
                found.push_back(g);
            }
        });
    }
    return found;
}

std::vector<std::uint32_t> Facets::neighbours_of(const std::vector<std::uint32_t>& found) const {
    std::vector<std::uint32_t> around;
    for (const std::uint32_t f : found) {
        for_each_halfedge(f, [&](std::uint32_t h) {
            if (const std::uint32_t g = across(h); is_flat_outside(g)) {
                around.push_back(g);
            }
        });
    }
    return by_area(std::move(around));
}

std::vector<std::uint32_t> Facets::curved_neighbours_of(
    const std::vector<std::uint32_t>& found) const {
    std::vector<std::uint32_t> around;
    for (const std::uint32_t f : found) {
        for_each_halfedge(f, [&](std::uint32_t h) {
            const std::int32_t r = regions_.of[adjacency_.twin[h] / 3];
            if (r >= static_cast<std::int32_t>(flat_count_)) {
                around.push_back(static_cast<std::uint32_t>(r));
            }
        });
    }
    sort_once(around);
    std::stable_sort(around.begin(), around.end(), [&](std::uint32_t a, std::uint32_t b) {
        return region(a).area_mm2 > region(b).area_mm2;
    });
    return around;
}

std::vector<std::uint32_t> Facets::flat_around(const std::vector<std::uint32_t>& found) const {
    std::vector<std::uint32_t> around;
    for (const std::uint32_t f : found) {
        for_each_halfedge(f, [&](std::uint32_t h) {
            if (const std::uint32_t g = across(h); is_flat(g) && !taken_[g]) {
                around.push_back(g);
            }
        });
    }
    return by_area(std::move(around));
}

std::vector<std::vector<std::uint32_t>> Facets::curved_facets() const {
    std::vector<std::vector<std::uint32_t>> curved(regions_.all.size() - flat_count_);
    for (std::uint32_t f = 0; f < facets_.size(); ++f) {
        if (taken_[f]) {
            const std::int32_t r = regions_.of[facets_[f].triangles[0]];
            curved[static_cast<std::size_t>(r) - flat_count_].push_back(f);
        }
    }
    return curved;
}

std::vector<std::uint32_t> Facets::points_of(const std::vector<std::uint32_t>& found) const {
    std::vector<std::uint32_t> points;
    for (const std::uint32_t f : found) {
        points.insert(points.end(), facets_[f].points.begin(), facets_[f].points.end());
    }
    sort_once(points);
    return points;
}

std::vector<std::uint32_t> Facets::by_area(std::vector<std::uint32_t> facets) const {
    sort_once(facets);
    std::stable_sort(facets.begin(), facets.end(), [&](std::uint32_t a, std::uint32_t b) {
        return facets_[a].area_mm2 > facets_[b].area_mm2;
    });
    return facets;
}

void Facets::keep(const std::vector<std::uint32_t>& found, const Surface& surface, bool outward,
                  double sagitta_mm) {
    Region region{surface, outward, 0, sagitta_mm};
    for (const std::uint32_t f : found) {
        taken_[f] = true;
        region.area_mm2 += facets_[f].area_mm2;
        for (const std::uint32_t t : facets_[f].triangles) {
            regions_.of[t] = static_cast<std::int32_t>(regions_.all.size());
        }
    }
    regions_.all.push_back(region);
}

}  // namespace decomp::solid
