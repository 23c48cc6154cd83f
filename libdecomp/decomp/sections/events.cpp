// SPDX-License-Identifier: GPL-3.0-or-later
#include "decomp/sections/profile.h"

#include <algorithm>
#include <cmath>

namespace decomp::sections {

namespace {

constexpr double kLeastNeck = 0.08;  // strength below which a waist is noise
constexpr double kPlateau = 0.005;   // relative rise within which a waist counts as flat
constexpr double kLeastJump =
    0.25;  // of the largest |dA/dt| and, per section, of the mean area's change
constexpr std::size_t kStableRun = 3;  // stations that a topology must last to count
constexpr int kGoldenSteps = 40;
constexpr int kBisections = 24;

/// The largest area met on the way from station i in one direction before a deeper one.
double rim(const std::vector<Station>& stations, std::size_t i, int direction) {
    double highest = stations[i].area_mm2;
    for (auto k = static_cast<std::ptrdiff_t>(i) + direction;
         k >= 0 && k < static_cast<std::ptrdiff_t>(stations.size()); k += direction) {
        const double area = stations[static_cast<std::size_t>(k)].area_mm2;
        if (area < stations[i].area_mm2) {
            break;
        }
        highest = std::max(highest, area);
    }
    return highest;
}

/// Minimum of a function of one variable by golden section; about 1e-8 of the interval.
template <class Function>
double golden_minimum(double low, double high, const Function& value) {
    constexpr double kRatio = 0.6180339887498949;
    double a = high - kRatio * (high - low);
    double b = low + kRatio * (high - low);
    double at_a = value(a);
    double at_b = value(b);
    for (int i = 0; i < kGoldenSteps; ++i) {
        if (at_a <= at_b) {
            high = b;
            b = a;
            at_b = at_a;
            a = high - kRatio * (high - low);
            at_a = value(a);
        } else {
            low = a;
            a = b;
            at_a = at_b;
            b = low + kRatio * (high - low);
            at_b = value(b);
        }
    }
    return at_a <= at_b ? a : b;
}

}  // namespace

void Profile::add_necks(std::vector<Event>& events) const {
    for (std::size_t i = 1; i + 1 < stations_.size(); ++i) {
        const double area = stations_[i].area_mm2;
        // The first station of a plateau of equal areas stands for all.
        if (area >= stations_[i - 1].area_mm2 || area > stations_[i + 1].area_mm2) {
            continue;
        }
        const double rims = std::min(rim(stations_, i, -1), rim(stations_, i, +1));
        const double strength = rims > 0 ? 1 - area / rims : 0;
        if (strength < kLeastNeck) {
            continue;
        }
        std::size_t first = i;
        std::size_t last = i;
        while (first > 0 && stations_[first - 1].area_mm2 <= area * (1 + kPlateau)) {
            --first;
        }
        while (last + 1 < stations_.size() &&
               stations_[last + 1].area_mm2 <= area * (1 + kPlateau)) {
            ++last;
        }
        Event event;
        event.kind = EventKind::Neck;
        event.strength = strength;
        if (last - first > 4) {
            event.t_mm = (stations_[first].t_mm + stations_[last].t_mm) / 2;
        } else {
            event.t_mm = golden_minimum(stations_[i - 1].t_mm, stations_[i + 1].t_mm,
                                        [&](double t) { return measure(t, false).area_mm2; });
        }
        event.area_mm2 = measure(event.t_mm, false).area_mm2;
        events.push_back(event);
    }
}

void Profile::add_jumps(std::vector<Event>& events) const {
    if (stations_.size() < 8) {
        return;
    }
    std::vector<double> rates(stations_.size() - 1);
    double mean_area = 0;
    for (std::size_t i = 0; i + 1 < stations_.size(); ++i) {
        rates[i] = std::abs(stations_[i + 1].area_mm2 - stations_[i].area_mm2);
        mean_area += stations_[i].area_mm2 / static_cast<double>(stations_.size());
    }
    // The ends of the shape are not events.
    const double largest = *std::max_element(rates.begin() + 2, rates.end() - 2);
    for (std::size_t i = 2; i + 3 < stations_.size(); ++i) {
        if (rates[i] < rates[i - 1] || rates[i] <= rates[i + 1] ||
            rates[i] < kLeastJump * largest || rates[i] < kLeastJump / 4 * mean_area) {
            continue;
        }
        Station low = stations_[i];
        Station high = stations_[i + 1];
        for (int step = 0; step < kBisections; ++step) {
            const Station middle = measure((low.t_mm + high.t_mm) / 2, false);
            const bool below = std::abs(middle.area_mm2 - low.area_mm2) >
                               std::abs(high.area_mm2 - middle.area_mm2);
            (below ? high : low) = middle;
        }
        Event event;
        event.kind = EventKind::Jump;
        event.t_mm = (low.t_mm + high.t_mm) / 2;
        event.area_mm2 = std::min(low.area_mm2, high.area_mm2);
        event.strength = rates[i] / largest;
        events.push_back(event);
    }
}

void Profile::add_topology_changes(std::vector<Event>& events) const {
    const auto same = [](const Station& a, const Station& b) {
        return a.outlines == b.outlines && a.holes == b.holes;
    };

    struct Stretch {
        std::size_t first, last;
    };

    std::vector<Stretch> stretches;
    for (std::size_t first = 0; first < stations_.size();) {
        std::size_t last = first;
        while (last + 1 < stations_.size() && same(stations_[first], stations_[last + 1])) {
            ++last;
        }
        if (last - first + 1 >= kStableRun) {
            stretches.push_back({first, last});
        }
        first = last + 1;
    }
    for (std::size_t i = 0; i + 1 < stretches.size(); ++i) {
        Station low = stations_[stretches[i].last];
        Station high = stations_[stretches[i + 1].first];
        if (same(low, high)) {
            continue;
        }
        const Station before = low;
        for (int step = 0; step < kBisections / 2; ++step) {
            const Station middle = measure((low.t_mm + high.t_mm) / 2, true);
            (same(middle, before) ? low : high) = middle;
        }
        Event event;
        event.kind = EventKind::Topology;
        event.t_mm = low.area_mm2 <= high.area_mm2 ? low.t_mm : high.t_mm;
        event.area_mm2 = std::min(low.area_mm2, high.area_mm2);
        event.strength = 1;
        events.push_back(event);
    }
}

std::vector<Event> Profile::events() const {
    std::vector<Event> events;
    if (!stations_.empty()) {
        add_necks(events);
        add_jumps(events);
        add_topology_changes(events);
    }
    std::stable_sort(events.begin(), events.end(),
                     [](const Event& a, const Event& b) { return a.t_mm < b.t_mm; });
    return events;
}

}  // namespace decomp::sections
